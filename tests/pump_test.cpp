// Shared module: case files, pressure, curves as CSV, channels, tables, output folders.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/load_scale.h"
#include "bentaxis/results/periodic_lines.h"
#include "bentaxis/results/samples.h"
#include "closed_form/film.h"
#include "loads/film.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

std::string default_text() {
  std::ifstream in(reference_folder() / "bap63_rated" / "case.toml");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no \"" + from + "\" in the case");
  return text.replace(at, from.size(), to);
}

std::string message(const std::string& text) {
  try {
    parse_case(text, "x.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// ---- case file ---------------------------------------------------------------------------------

TEST(CaseFile, ReadsEveryKeyInSi) {
  const Case c = reference_case("asymmetric_ports");
  EXPECT_EQ(c.pump.geometry.pistons, 5);
  EXPECT_DOUBLE_EQ(c.pump.geometry.tilt, 40 * kPi / 180);
  EXPECT_DOUBLE_EQ(c.pump.geometry.joint_circle_radius, 0.02492);
  EXPECT_DOUBLE_EQ(c.pump.geometry.axis_offset, 1e-4);
  EXPECT_DOUBLE_EQ(c.pump.gear.pressure_angle, kPi / 9);
  EXPECT_DOUBLE_EQ(c.pump.bearings.cylindrical_z, -0.068);
  ASSERT_TRUE(c.pump.piston.real);
  EXPECT_DOUBLE_EQ(c.pump.piston.real->transverse_inertia, 24e-6);
  EXPECT_DOUBLE_EQ(c.pump.piston.real->spin, 700 * kPi / 30);
  EXPECT_DOUBLE_EQ(c.pump.block.bottom_area, 250e-6);
  EXPECT_DOUBLE_EQ(c.pump.friction.block_viscous, 0.0054 * 30 / kPi);
  EXPECT_DOUBLE_EQ(c.operation.speed_rpm, -1800);
  EXPECT_DOUBLE_EQ(c.pressure.ports.suction, 5e5);
  EXPECT_DOUBLE_EQ(c.pressure.delivery_start_deg, 170);
  ASSERT_TRUE(c.pump.port_plate);
  EXPECT_DOUBLE_EQ(c.pump.port_plate->r4, 0.026);
  EXPECT_DOUBLE_EQ(c.pump.port_plate->delivery.from_deg, 196);
}

TEST(CaseFile, FillsInDefaults) {
  const Case c = reference_case("noload_1500_lumped");
  EXPECT_DOUBLE_EQ(c.pump.shaft.axial_inertia, 2000e-6);
  EXPECT_DOUBLE_EQ(c.pump.block.axial_inertia, 1500e-6);
  EXPECT_EQ(c.operation.revolutions, 1);
  EXPECT_FALSE(c.pump.port_plate);
  const Case bare = parse_case(with(default_text(), "samples_per_revolution = 72\n", ""), "x.toml");
  EXPECT_EQ(bare.operation.samples_per_revolution, 720);
  const auto is_default = [&](const std::string& key) {
    for (const InputEntry& entry : bare.entries)
      if (entry.key == key) return entry.defaulted;
    return false;
  };
  EXPECT_TRUE(is_default("samples_per_revolution"));
  EXPECT_FALSE(is_default("tilt_deg"));
}

TEST(CaseFile, IntegerServesAsANumberButNotTheReverse) {
  EXPECT_NO_THROW(parse_case(with(default_text(), "tilt_deg = 40.0", "tilt_deg = 40"), "x.toml"));
  EXPECT_THAT(message(with(default_text(), "pistons = 5", "pistons = 5.0")),
              HasSubstr("x.toml:5: [pump] pistons = 5.0: must be an integer in [1, 99]"));
}

struct BadCase {
  std::string from, to, expected;
};

TEST(CaseFile, RefusesWithFileLineKeyValueAndRange) {
  const std::vector<BadCase> bad = {
      {"tilt_deg = 40.0", "tilt_deg = 90", "x.toml:6: [pump] tilt_deg = 90: must be in [0, 90)"},
      {"tilt_deg = 40.0", "tilt_deg = -1", "must be in [0, 90)"},
      {"tilt_deg = 40.0", "tilt_deg = \"40\"", "tilt_deg = \"40\": must be a number"},
      {"tilt_deg = 40.0", "tilt_deg = nan", "finite"},
      {"tilt_deg = 40.0", "tilt_degg = 40.0", "is \"tilt_degg\" in line 6 meant?"},
      {"tilt_deg = 40.0", "tilt_deg = 40.0\nweight = 3", "unknown key \"weight\" in [pump]"},
      {"pistons = 5", "pistons = 0", "[1, 99]"},
      {"pistons = 5", "pistons = 100", "[1, 99]"},
      {"bore_diameter_mm = 22.5", "bore_diameter_mm = 0", "must be > 0"},
      {"piston_length_mm = 46.0", "piston_length_mm = 2.9", "cannot be assembled at theta = 180"},
      {"piston_length_mm = 46.0", "piston_length_mm = inf", "finite"},
      {"piston_length_mm = 46.0", "piston_length_mm = 5e-324",
       "[pump] piston_length_mm = 5e-324: must be 0 or, in SI units, of a magnitude"},
      {"delivery_bar = 275.0", "delivery_bar = 1e10",
       "[pressure] delivery_bar = 1e10: must be in [-1e+09, 1e+09]"},
      {"mass_kg = 0.09", "mass_kg = 1e31",
       "[piston] mass_kg = 1e31: must be 0 or, in SI units, of a magnitude between 2.3e-308 and "
       "1e+30"},
      {"cylindrical_z_mm = -68.0", "cylindrical_z_mm = -26", "must differ from tapered_z_mm"},
      {"pressure_angle_deg = 20.0", "pressure_angle_deg = 61", "in [0, 60]"},
      {"inertia = \"lumped\"", "inertia = \"solid\"", "\"lumped\" or \"real\""},
      {"inertia = \"lumped\"", "inertia = \"real\"", "centre_of_mass_mm is missing"},
      {"mass_kg = 0.09", "mass_kg = -0.09", "must be >= 0"},
      {"joint_mass_fraction = 0.5", "joint_mass_fraction = 1.5", "in [0, 1]"},
      {"shaft_torque_factor = 0.99", "shaft_torque_factor = 0", "in (0, 1]"},
      {"samples_per_revolution = 72", "samples_per_revolution = 0", "an integer >= 1"},
      {"kind = \"ideal\"", "kind = \"curve\"", "file is missing"},
      {"transition_deg = 20.0", "transition_deg = 181", "in [0, 180]"},
      {"inner_land_mm = [17.2, 19.0]", "inner_land_mm = [19.0, 17.2]", "r1 < r2"},
      {"outer_land_mm = [24.2, 26.0]", "outer_land_mm = [18, 26.0]", "r2 < r3"},
      {"delivery_arc_deg = [189.0, 345.0]", "delivery_arc_deg = [0, 361]", "from + 360"},
      {"delivery_arc_deg = [189.0, 345.0]", "delivery_arc_deg = 3", "pair"},
      {"[gear]", "[geer]", "table [gear] is missing; is \"geer\" in line 13 meant?"},
      {"[port_plate]", "[portplate]", "unknown table [portplate]"},
      {"schema = 1", "schema = 2", "schema = 2"},
      {"name = ", "nam = ", "name is missing"},
      {"tilt_deg = 40.0", "tilt_deg = = 40", "x.toml:6:"}};
  for (const BadCase& b : bad) {
    const std::string text = message(with(default_text(), b.from, b.to));
    EXPECT_THAT(text, HasSubstr(b.expected)) << b.to;
    EXPECT_EQ(text.find('\n'), std::string::npos) << b.to;
  }
}

TEST(CaseFile, AxialInertiaIsBoundedByTwiceTheTransverse) {
  std::ifstream in(reference_folder() / "asymmetric_ports" / "case.toml");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(message(with(text, "axial_inertia_kg_mm2 = 5.0", "axial_inertia_kg_mm2 = 48.1")),
              HasSubstr("in [0, 48]"));
  EXPECT_EQ(message(with(text, "axial_inertia_kg_mm2 = 5.0", "axial_inertia_kg_mm2 = 48")),
            "accepted");
}

TEST(CaseFile, EachModelMayHaveItsOwnAssumptions) {
  const std::string extra =
      "\n[assumptions.multibody]\npiston_friction = false\ngear = \"imposed\"\n";
  const Case c = parse_case(default_text() + extra, "x.toml");
  EXPECT_TRUE(c.analytic == (Assumptions{true, PistonInertia::lumped, BlockDrive::mesh}));
  EXPECT_TRUE(c.multibody == (Assumptions{false, PistonInertia::lumped, BlockDrive::imposed}));
  EXPECT_THAT(message(default_text() + "\n[assumptions.simscape]\n"), HasSubstr("simscape"));
  EXPECT_THAT(message(default_text() + "\n[assumptions.analytic]\ninertia = \"real\"\n"),
              HasSubstr("needs centre_of_mass_mm"));
}

// ---- assembly ----------------------------------------------------------------------------------

TEST(Assembly, MarginIsTheLargestDistanceOverTheTurn) {
  RandomPump random(31);
  for (int n = 0; n < 200; ++n) {
    const Geometry g = random.pump().geometry;
    double largest = 0;
    for (int i = 0; i < 3600; ++i) {
      const double t = 2 * kPi * i / 3600;
      const double x = (g.bore_circle_radius - g.joint_circle_radius) * std::sin(t);
      const double y =
          (g.bore_circle_radius - g.joint_circle_radius * std::cos(g.tilt)) * std::cos(t) -
          g.axis_offset * std::sin(g.tilt);
      largest = std::max(largest, std::hypot(x, y));
      ASSERT_NEAR(joint_distance(g, t, t), std::hypot(x, y), 1e-15);
    }
    EXPECT_NEAR(assembly_margin(g).longest_distance, largest, 1e-7);
    EXPECT_GE(assembly_margin(g).longest_distance, largest * (1 - 1e-14));
  }
}

// ---- pressure ----------------------------------------------------------------------------------

PressureSpec ideal(double width, double start = 180) {
  PressureSpec spec;
  spec.ports = {1e5, 2e7};
  spec.transition_deg = width;
  spec.delivery_start_deg = start;
  return spec;
}

TEST(Pressure, IdealTraceFollowsItsDefinition) {
  const PressureTrace trace(ideal(20));
  EXPECT_DOUBLE_EQ(trace(180), (1e5 + 2e7) / 2);
  EXPECT_DOUBLE_EQ(trace(170), 1e5);
  EXPECT_DOUBLE_EQ(trace(190), 2e7);
  EXPECT_DOUBLE_EQ(trace(270), 2e7);
  EXPECT_DOUBLE_EQ(trace(0), (1e5 + 2e7) / 2);
  EXPECT_DOUBLE_EQ(trace(90), 1e5);
  const double t = 5.0 / 20;
  EXPECT_NEAR(trace(175), 1e5 + (2e7 - 1e5) * t * t * (3 - 2 * t), 1e-7);
  EXPECT_NEAR(trace(355) - 1e5, 2e7 - trace(175), 1e-7);
  EXPECT_DOUBLE_EQ(trace(175), trace(175 - 720));
  const std::vector<double> edges = {10, 170, 190, 350};
  EXPECT_EQ(trace.edges_deg(), edges);
}

TEST(Pressure, StepTakesItsEdgeWithinRoundOff) {
  const PressureTrace trace(ideal(0));
  EXPECT_DOUBLE_EQ(trace(180), 2e7);
  EXPECT_DOUBLE_EQ(trace(180 - 1e-10), 2e7);  // counts as on the edge
  EXPECT_DOUBLE_EQ(trace(180 - 1e-8), 1e5);
  EXPECT_DOUBLE_EQ(trace(360 - 1e-8), 2e7);
  EXPECT_DOUBLE_EQ(trace(360), 1e5);
  EXPECT_DOUBLE_EQ(trace(-1e-10), 1e5);
  EXPECT_EQ(trace.edges_deg(), (std::vector<double>{0, 180}));
}

// Just below 0 lies, after rounding, a whole turn: that is 0 again.
TEST(Angles, WrapToATurn) {
  EXPECT_EQ(wrap_degrees(-1e-20), 0);
  EXPECT_EQ(wrap_degrees(360), 0);
  EXPECT_EQ(wrap_degrees(-90), 270);
  EXPECT_EQ(wrap_degrees(725), 5);
}

TEST(Pressure, SplineIsPeriodicSmoothAndOfFourthOrder) {
  const auto error = [](int points) {
    PressureSpec spec;
    spec.kind = PressureKind::curve;
    for (int i = 0; i < points; ++i) {
      const double angle = 360.0 * i / points + 3;
      spec.curve.theta_deg.push_back(angle);
      spec.curve.pressure.push_back(std::sin(radians(angle)) + 0.3 * std::cos(radians(3 * angle)));
    }
    const PressureTrace trace(spec);
    double worst = 0;
    for (double x = -400; x < 800; x += 1.7)
      worst = std::max(worst,
                       std::abs(trace(x) - std::sin(radians(x)) - 0.3 * std::cos(radians(3 * x))));
    return worst;
  };
  EXPECT_NEAR(std::log2(error(60) / error(120)), 4, 0.15);
  EXPECT_LT(error(800), 1e-8);
}

TEST(Pressure, CurveIsRefusedWithTheReason) {
  PressureSpec spec;
  spec.kind = PressureKind::curve;
  spec.file = "p.csv";
  spec.curve = {{0, 100}, {1, 2}};
  EXPECT_THROW(PressureTrace{spec}, InputError);
  spec.curve = {{0, 100, 100}, {1, 2, 3}};
  EXPECT_THROW(PressureTrace{spec}, InputError);
  spec.curve = {{0, 100, 360}, {1, 2, 3}};
  EXPECT_THROW(PressureTrace{spec}, InputError);
  spec.curve = {{0, 100, 359.9}, {1, 2, 3}};
  EXPECT_NO_THROW(PressureTrace{spec});
}

// ---- port plate: closed form against quadrature ------------------------------------------------

TEST(PortPlateForce, ClosedFormEqualsQuadrature) {
  RandomPump random(41);
  for (int n = 0; n < 100; ++n) {
    const double r1 = random.in(0, 0.02);
    const double r2 = r1 + random.in(1e-4, 5e-3);
    const double r3 = r2 + random.in(1e-4, 5e-3);
    const double r4 = r3 + random.in(1e-4, 5e-3);
    const double from = random.in(-400, 400);
    const PortArc arc{from, from + random.in(1, 360)};
    const PortPlate plate{r1, r2, r3, r4, arc, arc};
    const auto raw = analytic::closed_form::raw(plate);
    const auto closed = analytic::closed_form::land_force(raw, raw.delivery);
    const multibody::FilmLoad sum = multibody::film_load(plate, {0, 1e6});
    EXPECT_NEAR(closed.force_z * 1e6 / sum.force_z, 1, 1e-13);
    EXPECT_NEAR(closed.moment_x * 1e6, sum.moment_x, 1e-13 * std::abs(sum.force_z) * r4 + 1e-13);
    EXPECT_NEAR(closed.moment_y * 1e6, sum.moment_y, 1e-13 * std::abs(sum.force_z) * r4 + 1e-13);
  }
}

TEST(PortPlateForce, FullRingHasNoMoment) {
  const PortPlate plate{0.01, 0.012, 0.02, 0.022, {0, 360}, {0, 360}};
  const auto raw = analytic::closed_form::raw(plate);
  const auto f = analytic::closed_form::land_force(raw, raw.delivery);
  // Cones of linear pressure: volume of a frustum difference.
  const auto cone = [](double r) { return kPi * r * r * r / 3; };
  const double expected = (cone(0.022) - cone(0.02)) / 0.002 - (cone(0.012) - cone(0.01)) / 0.002;
  EXPECT_NEAR(f.force_z, -expected, 1e-15);
  EXPECT_NEAR(f.moment_x, 0, 1e-18);
  EXPECT_NEAR(f.moment_y, 0, 1e-18);
}

// ---- CSV, channels, table ----------------------------------------------------------------------

TEST(Csv, RefusesWhatIsNotANumber) {
  const Scratch scratch;
  const auto why = [&](const std::string& text) {
    try {
      read_numeric_csv(scratch.file("a.csv", text));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(why("a,b\n1,2\n"), "accepted");
  EXPECT_EQ(why("a,b\r\n 1 , 2e3 \r\n"), "accepted");
  EXPECT_THAT(why("a,b\n1,x\n"), HasSubstr("a.csv:2: b = \"x\""));
  EXPECT_THAT(why("a,b\n1,nan\n"), HasSubstr("finite"));
  EXPECT_THAT(why("a,b\n1,2,3\n"), HasSubstr("3 fields, the header has 2"));
  EXPECT_THAT(why("a,b\n1,\n"), HasSubstr("\"\""));
  EXPECT_THAT(why(""), HasSubstr("is empty"));
  EXPECT_THROW(read_numeric_csv(scratch.path() / "missing.csv"), InputError);
  EXPECT_THROW(read_numeric_csv(scratch.path()), InputError);
}

TEST(Csv, NumbersReadBackToTheSameDouble) {
  RandomPump random(51);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.in(-1, 1) * std::pow(10, random.in(-30, 30));
    EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(number_text(-0.0), "0");
  EXPECT_EQ(number_text(not_computed()), "");
}

TEST(Channels, ColumnsAreTheFixedOnes) {
  const ChannelLayout layout(2);
  const std::vector<std::string> expected = {
      "Rs_1_x2_N", "Rs_1_y2_N", "Rs_1_z2_N", "Rc_1_x2_N", "Rc_1_y2_N", "Rs_2_x2_N",
      "Rs_2_y2_N", "Rs_2_z2_N", "Rc_2_x2_N", "Rc_2_y2_N", "Fh_z2_N",   "Th_x2_Nm",
      "Th_y2_Nm",  "Rcn_x2_N",  "Rcn_y2_N",  "Rcs_z4_N",  "Rb1_x1_N",  "Rb1_y1_N",
      "Rb1_z1_N",  "Rb2_x1_N",  "Rb2_y1_N",  "Td_z1_Nm",  "xh_x2_mm",  "yh_y2_mm"};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(layout.channels()[i].name, expected[i]);
}

// The index functions and the list of descriptions are written separately: they must agree.
TEST(Channels, IndicesPointAtTheirDescriptions) {
  for (const int n : {1, 5, 9}) {
    const ChannelLayout at(n);
    const auto& list = at.channels();
    const int k = n - 1;
    const std::string piston = std::to_string(n);
    EXPECT_EQ(list[at.Rs(k, 2)].name, "Rs_" + piston + "_z2_N");
    EXPECT_EQ(list[at.Rc(k, 1)].name, "Rc_" + piston + "_y2_N");
    EXPECT_EQ(list[at.Th(1)].name, "Th_y2_Nm");
    EXPECT_EQ(list[at.Rcn(1)].name, "Rcn_y2_N");
    EXPECT_EQ(list[at.Rcs()].name, "Rcs_z4_N");
    EXPECT_EQ(list[at.Rb1(2)].name, "Rb1_z1_N");
    EXPECT_EQ(list[at.Rb2(1)].name, "Rb2_y1_N");
    EXPECT_EQ(list[at.Td()].name, "Td_z1_Nm");
    EXPECT_EQ(list[at.yh()].name, "yh_y2_mm");
    EXPECT_EQ(list[at.Tcs()].name, "Tcs_z2_Nm");
    EXPECT_EQ(list[at.pressure(k)].name, "p_" + piston + "_bar");
    EXPECT_EQ(list[at.zB(k)].name, "zB_" + piston + "_z2_mm");
    EXPECT_EQ(list[at.Rs3(k, 1)].name, "Rs_" + piston + "_y3_N");
    EXPECT_EQ(list[at.Tc(k)].name, "Tc_" + piston + "_z2_Nm");
    EXPECT_EQ(list[at.power_residual()].name, "power_residual_Nm");
    EXPECT_EQ(list[at.axis_moment(k)].name, "axis_moment_" + piston + "_Nm");
    EXPECT_EQ(at.size(), at.axis_moment(k) + 1);
    EXPECT_EQ(at.reactions(), static_cast<std::size_t>(5 * n + 12));
  }
}

TEST(Table, StrayNanIsAnErrorAndTheMarkerIsNot) {
  const ChannelLayout layout(1);
  Samples samples;
  samples.theta_deg = {0, 90};
  samples.chamber_pressure = {0, 0};
  samples.pistons = 1;
  const auto fill = [&](double value) {
    return tabulate("test", layout, samples, [&](const Instant&, std::vector<double>& row) {
      std::fill(row.begin(), row.end(), 1.0);
      row[layout.Rcs()] = value;
    });
  };
  EXPECT_FALSE(is_computed(fill(not_computed()).at(1, layout.Rcs())));
  EXPECT_THROW(fill(std::sqrt(-1.0)), ComputationError);
  EXPECT_THROW(fill(std::numeric_limits<double>::quiet_NaN()), ComputationError);
  EXPECT_THROW(fill(std::numeric_limits<double>::infinity()), ComputationError);
  EXPECT_THAT(to_csv(fill(not_computed())), HasSubstr(",1,,1,"));
}

TEST(Table, PeakIsThatOfTheVectorOverAllPistons) {
  const ChannelLayout layout(2);
  Samples samples;
  samples.theta_deg = {0, 180};
  samples.chamber_pressure = {0, 0, 0, 0};
  samples.pistons = 2;
  const ResultTable t =
      tabulate("test", layout, samples, [&](const Instant& i, std::vector<double>& row) {
        std::fill(row.begin(), row.end(), 0.0);
        row[layout.Rs(1, 0)] = 3;
        row[layout.Rs(1, 1)] = i.shaft.angle > 1 ? -4 : 0;
      });
  EXPECT_DOUBLE_EQ(t.peak("Rs"), 5);
}

TEST(Channels, HaveTheirUnitInSi) {
  for (const Channel& channel : ChannelLayout(3).channels()) {
    const std::map<std::string, double> units = {{"mm", 1e-3}, {"bar", 1e5}};
    const auto it = units.find(channel.unit);
    EXPECT_EQ(channel.unit_in_si, it == units.end() ? 1 : it->second) << channel.name;
  }
}

TEST(Lists, AreSearchedJoinedAndExtended) {
  std::vector<std::string> list = {"a", "b"};
  EXPECT_TRUE(contains(list, "b"));
  EXPECT_FALSE(contains(list, "c"));
  add_once(list, "b");
  add_once(list, "c");
  EXPECT_EQ(joined(list), "a, b, c");
  EXPECT_EQ(joined(std::vector<std::string>{"", "", "x"}, "-"), "--x");
  EXPECT_EQ(joined(std::vector<std::string>()), "");
  EXPECT_EQ(joined(std::set<int>{2, 1}, " or ", [](int i) { return std::to_string(i); }), "1 or 2");
  std::vector<std::string> more = {"d"};
  append(list, more);
  append(list, std::vector<std::string>{"e"});
  EXPECT_EQ(joined(list, ""), "abcde");
  EXPECT_EQ(more[0], "d");
  std::vector<double> numbers = {3, 1, 2.5, 1, 2};
  sort_once(numbers);
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 2.5, 3}));
  sort_once(numbers, 0.75);
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3}));
}

TEST(Texts, AreTrimmedLoweredAndReplaced) {
  EXPECT_EQ(trimmed(" \ta b\r\n"), "a b");
  EXPECT_EQ(trimmed("\ta ", " "), "\ta");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(lower_case("AZaz[@09\xC4"), "azaz[@09\xC4");
  EXPECT_EQ(replace_all("aaa", "aa", "a"), "aa");
  EXPECT_EQ(replace_all("a.b.", ".", ".."), "a..b..");
  EXPECT_EQ(unit_after("Nm"), " Nm");
  EXPECT_EQ(unit_after(""), "");
}

// What a unit is, read from how it is written ("L/(min.bar)"): a second source of every entry of
// the table.
struct Measure {
  Dimension of;
  double factor = 1;

  void multiply(const Measure& other, int power) {
    for (int Dimension::*const base :
         {&Dimension::kg, &Dimension::m, &Dimension::s, &Dimension::kelvin, &Dimension::rad})
      of.*base += power * (other.of.*base);
    factor *= std::pow(other.factor, power);
  }
};

Measure measure_of_symbol(std::string symbol, bool with_prefix = true) {
  static const std::map<std::string, Measure> kSymbols = {
      {"1", {}},
      {"%", {{}, 0.01}},
      {"m", {{.m = 1}}},
      {"g", {{.kg = 1}, 1e-3}},
      {"s", {{.s = 1}}},
      {"min", {{.s = 1}, 60}},
      {"in", {{.m = 1}, 0.0254}},
      {"L", {{.m = 3}, 1e-3}},
      {"rad", {{.rad = 1}}},
      {"deg", {{.rad = 1}, std::numbers::pi / 180}},
      {"gon", {{.rad = 1}, std::numbers::pi / 200}},
      {"turn", {{.rad = 1}, 2 * std::numbers::pi}},
      {"rpm", {{.s = -1, .rad = 1}, std::numbers::pi / 30}},
      {"Hz", {{.s = -1}}},
      {"N", {{.kg = 1, .m = 1, .s = -2}}},
      {"kgf", {{.kg = 1, .m = 1, .s = -2}, 9.80665}},
      {"lbf", {{.kg = 1, .m = 1, .s = -2}, 0.45359237 * 9.80665}},
      {"ft", {{.m = 1}, 0.3048}},
      {"J", {{.kg = 1, .m = 2, .s = -2}}},
      {"W", {{.kg = 1, .m = 2, .s = -3}}},
      {"Pa", {{.kg = 1, .m = -1, .s = -2}}},
      {"bar", {{.kg = 1, .m = -1, .s = -2}, 1e5}},
      {"psi", {{.kg = 1, .m = -1, .s = -2}, 0.45359237 * 9.80665 / (0.0254 * 0.0254)}},
      {"cSt", {{.m = 2, .s = -1}, 1e-6}},
      {"K", {{.kelvin = 1}}},
      {"degC", {{.kelvin = 1}}}};
  static const std::map<char, double> kPrefixes = {
      {'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2}, {'k', 1e3}, {'M', 1e6}, {'G', 1e9}, {'d', 1e-1}};
  if (const auto found = kSymbols.find(symbol); found != kSymbols.end()) return found->second;
  if (with_prefix && symbol.starts_with("da")) {
    Measure measure = measure_of_symbol(symbol.substr(2), false);
    measure.factor *= 10;
    return measure;
  }
  const auto prefix = kPrefixes.find(symbol.empty() ? '?' : symbol[0]);
  if (!with_prefix || prefix == kPrefixes.end()) throw std::logic_error("no unit " + symbol);
  Measure measure = measure_of_symbol(symbol.substr(1), false);
  measure.factor *= prefix->second;
  return measure;
}

Measure measure_of(const std::string& text) {
  Measure whole;
  int sign = 1;
  bool inside = false;  // of parentheses: all of it is divided by
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(". /()", at), text.size());
    const std::size_t digits = std::min(text.find_first_of("0123456789", at + 1), end);
    const int power = digits == end ? 1 : std::stoi(text.substr(digits, end - digits));
    if (end > at) whole.multiply(measure_of_symbol(text.substr(at, digits - at)), sign * power);
    if (end == text.size()) break;
    inside = (inside || text[end] == '(') && text[end] != ')';
    if (text[end] == '/') sign = -1;
    if ((text[end] == '.' || text[end] == ' ') && !inside) sign = 1;
    at = end + 1;
  }
  return whole;
}

TEST(UnitsOfMeasure, AreWhatTheirNamesSay) {
  for (const UnitOfMeasure& unit : units_of_measure()) {
    const Measure measure = measure_of(unit.standard);
    EXPECT_EQ(unit.dimension, measure.of) << unit.standard;
    EXPECT_NEAR(unit.factor / measure.factor, 1, 1e-12) << unit.standard;
    EXPECT_EQ(unit.offset, unit.standard == "degC" ? 273.15 : 0) << unit.standard;
    if (unit.display.empty()) continue;
    EXPECT_NEAR(unit.display_factor * measure_of(unit.display).factor / measure.factor, 1, 1e-12)
        << unit.display;
    EXPECT_EQ(measure_of(unit.display).of, measure.of) << unit.display;
  }
}

// One load after the other on a pump that has none; bore of 20 mm.
TEST(LoadScale, IsTheLargestLoadApplied) {
  const auto scale = [](const std::function<void(PumpParameters&, Samples&)>& load) {
    Case the_case = reference_case("bap63_rated");
    PumpParameters& pump = the_case.pump;
    pump.geometry.bore_diameter = 0.02;
    pump.geometry.joint_circle_radius = 0.03;
    pump.geometry.bore_circle_radius = 0.04;
    pump.piston = {};
    pump.shaft.mass = pump.block.mass = pump.block.spring_force = pump.block.bottom_area = 0;
    pump.friction = {};
    pump.gravity = 0;
    pump.port_plate.reset();
    Samples samples;
    samples.pistons = 1;
    samples.omega = -200;
    samples.theta_deg = {0, 120, 240};
    samples.chamber_pressure = {0, 0, 0};
    samples.ports = {0, 0};
    load(pump, samples);
    return load_scale(the_case, samples);
  };
  using P = PumpParameters;
  const double area = kPi / 4 * 0.02 * 0.02;
  EXPECT_EQ(scale([](P&, Samples&) {}).force, 0);
  const auto chamber = scale([](P&, Samples& s) { s.chamber_pressure = {1e6, -2e6, 1e6}; });
  EXPECT_DOUBLE_EQ(chamber.force, 2e6 * area);
  EXPECT_DOUBLE_EQ(chamber.moment, 2e6 * area * 0.04);
  EXPECT_DOUBLE_EQ(scale([](P&, Samples& s) { s.ports.delivery = 3e6; }).force, 3e6 * area);
  EXPECT_DOUBLE_EQ(scale([](P&, Samples& s) { s.ports.suction = -3e6; }).force, 3e6 * area);
  for (const double bottom : {1e-4, 1e-3})  // below and above that of the bore
    EXPECT_DOUBLE_EQ(scale([&](P& p, Samples& s) {
                       s.ports.delivery = 3e6;
                       p.block.bottom_area = bottom;
                     }).force,
                     3e6 * std::max(area, bottom));
  EXPECT_DOUBLE_EQ(scale([](P& p, Samples& s) {
                     s.ports.delivery = 3e6;
                     p.port_plate = PortPlate{0.02, 0.03, 0.04, 0.05, {}, {}};
                   }).force,
                   3e6 * kPi / 2 * (0.05 * 0.05 - 0.02 * 0.02));
  EXPECT_DOUBLE_EQ(scale([](P& p, Samples&) { p.friction.piston_viscous = 50; }).force,
                   50 * 200 * 0.04 * std::sin(radians(40)));
  EXPECT_EQ(scale([](P& p, Samples&) { p.block.spring_force = 400; }).force, 400);
  EXPECT_EQ(scale([](P& p, Samples&) { p.friction.piston_coulomb = 30; }).force, 30);
  EXPECT_DOUBLE_EQ(scale([](P& p, Samples&) { p.piston.mass = 0.1; }).force, 0.1 * 4e4 * 0.04);
  EXPECT_DOUBLE_EQ(scale([](P& p, Samples&) {
                     p.piston.mass = 0.1;
                     p.geometry.joint_circle_radius = 0.05;
                   }).force,
                   0.1 * 4e4 * 0.05);
  for (const double gravity : {9.81, -9.81})
    EXPECT_DOUBLE_EQ(scale([&](P& p, Samples&) {
                       p.gravity = gravity;
                       p.shaft.mass = 3;
                       p.block.mass = 2;
                     }).force,
                     29.43);
  EXPECT_DOUBLE_EQ(scale([](P& p, Samples&) { p.friction.block_viscous = 0.05; }).moment, 10);
  EXPECT_DOUBLE_EQ(scale([](P& p, Samples&) { p.friction.shaft_viscous = 0.02; }).moment, 4);
}

TEST(Samples, PartsOfARunAreItsRows) {
  Case c = reference_case("reversed");
  c.operation.samples_per_revolution = 5;
  const PressureTrace pressure(c.pressure);
  const Samples all = sample_case(c, pressure, 2);
  ASSERT_EQ(all.theta_deg.size(), 10U);
  const Samples part = sample_case(c, pressure, 2, false, {3, 4});
  EXPECT_EQ(part.theta_deg,
            std::vector<double>(all.theta_deg.begin() + 3, all.theta_deg.begin() + 7));
  const auto first = all.chamber_pressure.begin() + 3 * all.pistons;
  EXPECT_EQ(part.chamber_pressure, std::vector<double>(first, first + 4 * all.pistons));
  EXPECT_EQ(sample_case(c, pressure, 2, false, {8, 100}).theta_deg.size(), 2U);
  EXPECT_TRUE(sample_case(c, pressure, 2, false, {2, 0}).theta_deg.empty());
  // At given angles the same.
  const Samples some = sample_angles(c, pressure, {all.theta_deg[3], all.theta_deg[1]});
  EXPECT_EQ(some.theta_deg, (std::vector<double>{all.theta_deg[3], all.theta_deg[1]}));
  EXPECT_EQ(some.omega, all.omega);
  for (int k = 0; k < all.pistons; ++k) {
    EXPECT_EQ(some.chamber_pressure[k], all.chamber_pressure[3 * all.pistons + k]);
    EXPECT_EQ(some.chamber_pressure[all.pistons + k], all.chamber_pressure[all.pistons + k]);
  }
}

TEST(PeriodicLines, GoThroughThePointsAndAcrossTheEndOfTheTurn) {
  const std::vector<double> theta = {350, 10, 100, 200}, values = {1, 3, 12, not_computed()};
  EXPECT_EQ(on_lines(theta, values, theta),
            (std::vector<double>{1, 3, 12, 12 + 100.0 / 250 * (1 - 12)}));
  EXPECT_EQ(on_lines(theta, values, {0, 360, -5, 55, 375, 225}),
            (std::vector<double>{2, 2, 1.5, 7.5, 3.5, 6.5}));
  EXPECT_EQ(on_lines({40}, {7}, {0, 40, 300}), (std::vector<double>{7, 7, 7}));
  EXPECT_FALSE(is_computed(on_lines({40}, {not_computed()}, {40}).at(0)));
}

// More rows than are held at a time; a sink that is given too many ends it.
TEST(Table, StreamedRowsAreAllOfThemOnce) {
  Case c = reference_case("bap63_rated");
  c.operation.samples_per_revolution = 10000;
  const ChannelLayout layout(c.pump.geometry.pistons);
  std::vector<double> theta;
  stream_rows(
      "streamed", layout, c, PressureTrace(c.pressure),
      [&](const Instant&, std::vector<double>& row) { row.assign(layout.size(), 1.0); },
      [&](double theta_deg, const std::vector<double>&) {
        theta.push_back(theta_deg);
        if (theta.size() > 10000) throw std::logic_error("too many rows");
      },
      {});
  EXPECT_EQ(theta, sample_case(c, PressureTrace(c.pressure)).theta_deg);
}

TEST(Samples, ARowNeedsAnAngleAndAPressureForEachPiston) {
  Samples samples;
  samples.pistons = 3;
  samples.theta_deg = {0, 120};
  samples.chamber_pressure = {1, 2, 3, 4, 5};
  Instant instant;
  samples.instant(0, instant);
  EXPECT_EQ(instant.chamber_pressure, (std::vector<double>{1, 2, 3}));
  EXPECT_THROW(samples.instant(1, instant), InputError);
  samples.chamber_pressure.resize(9);
  EXPECT_THROW(samples.instant(2, instant), InputError);
}

TEST(Samples, FallBackwardsAndReduceExactly) {
  Case c = reference_case("reversed");
  c.operation.samples_per_revolution = 4;
  const Samples s = sample_case(c, PressureTrace(c.pressure), 2, true);
  const std::vector<double> expected = {0, -90, -180, -270, -360, -450, -540, -630};
  EXPECT_EQ(s.theta_deg, expected);
  Instant i;
  s.instant(5, i);
  EXPECT_DOUBLE_EQ(i.shaft.angle, -kPi / 2);
}

// ---- writing case files
// --------------------------------------------------------------------------

TEST(CaseWriter, EveryReferenceCaseReadsBackAsItself) {
  for (const std::string& name : reference_cases()) {
    Case the_case = reference_case(name);
    const std::string text = case_text(the_case);
    Case again = parse_case(text, "/written.toml");
    EXPECT_EQ(case_text(again), text) << name;
    EXPECT_EQ(again.name, the_case.name);
    EXPECT_EQ(again.pump.geometry.pistons, the_case.pump.geometry.pistons);
    EXPECT_EQ(again.operation.speed_rpm, the_case.operation.speed_rpm);
    EXPECT_EQ(again.pressure.ports.delivery, the_case.pressure.ports.delivery);
    EXPECT_EQ(again.pressure.curve.pressure, the_case.pressure.curve.pressure);
    EXPECT_TRUE(again.analytic == the_case.analytic && again.multibody == the_case.multibody);
    const auto before = continuous_inputs(the_case.pump);
    const auto after = continuous_inputs(again.pump);
    ASSERT_EQ(before.size(), after.size()) << name;
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_EQ(*before[i].value, *after[i].value) << name << " " << before[i].name;
  }
}

TEST(CaseWriter, NamesAreQuoted) {
  Case the_case = reference_case("zero_tilt");
  the_case.name = "a \"pump\" \\ of one line \xc3\xbc";
  EXPECT_EQ(parse_case(case_text(the_case), "/written.toml").name, the_case.name);
  // Control characters are written as escapes, so that the line stays whole, and refused when read.
  the_case.name = "two\nlines\x01";
  const std::string text = case_text(the_case);
  EXPECT_THAT(text, HasSubstr("two\\nlines\\u0001"));
  EXPECT_THROW(parse_case(text, "/written.toml"), InputError);
}

// A limit in a message must itself be allowed.
TEST(Number, LimitsAreRoundedToTheirAllowedSide) {
  EXPECT_EQ(rounded_text(3.4567), "3.46");
  EXPECT_EQ(rounded_down_text(3.4567), "3.45");
  EXPECT_EQ(rounded_up_text(3.4567), "3.46");
  EXPECT_EQ(rounded_down_text(3.4512), "3.45");
  EXPECT_EQ(rounded_up_text(3.4512), "3.46");
  EXPECT_EQ(rounded_up_text(9.996), "10");
  EXPECT_EQ(rounded_down_text(9.996), "9.99");
  EXPECT_EQ(rounded_down_text(-0.012345), "-0.0124");
  EXPECT_EQ(rounded_up_text(2), "2");
}

TEST(NumberRange, SlackIsAShareOfTheBound) {
  NumberRange range{-4, 8};
  range.slack = 0.25;
  for (const double within : {-5.0, -4.0, 0.0, 10.0}) EXPECT_TRUE(range.contains(within)) << within;
  for (const double beyond : {-5.1, 10.1}) EXPECT_FALSE(range.contains(beyond)) << beyond;
  range.low = 0;  // of nothing it is nothing
  EXPECT_FALSE(range.contains(-1e-300));
}

TEST(Words, WhatIsAlikeWasMeant) {
  const std::set<std::string> keys = {"joint_circle_radius_mm", "bore_circle_radius_mm",
                                      "tilt_deg"};
  EXPECT_EQ(meant("joint_radius_mm", keys), "joint_circle_radius_mm");
  EXPECT_EQ(meant("tilt", keys), "tilt_deg");
  EXPECT_EQ(meant("TILT_DEG", keys), "tilt_deg");
  EXPECT_EQ(meant("frobnicate", keys), std::nullopt);
  EXPECT_EQ(meant("tilt", {}), std::nullopt);
  EXPECT_EQ(meant("tilt", keys, 0.9), std::nullopt);
  EXPECT_EQ(suggestion("spring", {"block", "gear"}), "; allowed: block, gear");
  EXPECT_EQ(suggestion("gaer", {"block", "gear"}), "; did you mean \"gear\"?");
  std::set<std::string> many;
  for (int i = 10; i < 51; ++i) many.insert("n" + std::to_string(i));
  EXPECT_EQ(suggestion("xyz", many),
            "; allowed: n10, n11, n12, n13, n14, n15, n16, n17, n18, n19 and 31 more, in docs/");
}

TEST(Words, DecimalCommasAreToldFromLists) {
  EXPECT_EQ(decimal_point_hint("40,0"), "; decimals follow a point: 40.0");
  EXPECT_EQ(decimal_point_hint("-1,5e-3"), "; decimals follow a point: -1.5e-3");
  for (const char* other : {"40", "40.0", "40,", ",5", "1,2,3", "1,5mm", "", "-", "a,b"})
    EXPECT_EQ(decimal_point_hint(other), "") << other;
}

}  // namespace
}  // namespace bentaxis::test
