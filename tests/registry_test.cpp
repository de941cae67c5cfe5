// One description of each parameter: what is made from it, and the border that it event_functions.
#include "bentaxis/pump/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/rounding.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/schema.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/validate.h"
#include "network.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::string rated_text() { return case_text(reference_case("bap63_rated")); }

// ---- A parameter more
// ----------------------------------------------------------------------------

// The standard registry with gravity under another key, in another unit, bounded and required.
Registry with_gravity_in_feet() {
  Registry registry = standard_registry();
  for (Table& table : registry.tables)
    if (table.name == "operation")
      for (Parameter& parameter : table.parameters)
        if (parameter.key == "gravity_m_per_s2") {
          parameter.key = "gravity_ft_per_s2";
          parameter.unit = {"ft/s2", [](double feet) { return feet * 0.3048; }};
          parameter.path = {"gravity_in_feet"};
          parameter.symbol = "g_ft";
          parameter.range = {-100, 100};
          parameter.fallback = {};
          parameter.meaning = "along -y1, in feet";
        }
  return registry;
}

std::string text_in_feet(const std::string& value) {
  std::string text = rated_text();
  const auto from = text.find("gravity_m_per_s2");
  return text.replace(from, text.find('\n', from) - from,
                      value.empty() ? "" : "gravity_ft_per_s2 = " + value);
}

Case read_in_feet(const std::string& text, const std::vector<std::string>& changes = {}) {
  static const Registry registry = with_gravity_in_feet();
  return parse_case(text, "x.toml", changes, registry);
}

TEST(ParameterOfATestRegistry, IsRead) {
  EXPECT_EQ(read_in_feet(text_in_feet("32.0")).pump.gravity, 32 * 0.3048);
  EXPECT_THAT(refusal([] { read_in_feet(text_in_feet("101")); }),
              HasSubstr("[operation] gravity_ft_per_s2 = 101: must be in [-100, 100]"));
  EXPECT_THAT(refusal([] { read_in_feet(text_in_feet("")); }),
              HasSubstr("gravity_ft_per_s2 is missing"));
  EXPECT_THAT(refusal([] { read_in_feet(rated_text()); }),
              HasSubstr("gravity_ft_per_s2 is missing"));
  EXPECT_THAT(refusal([] { parse_case(text_in_feet("32.0"), "x.toml"); }),
              HasSubstr("unknown key \"gravity_ft_per_s2\""));
}

TEST(ParameterOfATestRegistry, IsValidated) {
  const Registry registry = with_gravity_in_feet();
  Case the_case = read_in_feet(text_in_feet("32.0"));
  EXPECT_NO_THROW(validate(the_case, registry));
  the_case.pump.gravity = 101 * 0.3048;
  EXPECT_EQ(refusal([&] { validate(the_case.pump, registry); }),
            "[operation] gravity_ft_per_s2 = 101: must be in [-100, 100]");
  EXPECT_NO_THROW(validate(the_case.pump));
}

TEST(ParameterOfATestRegistry, IsWritten) {
  const Registry registry = with_gravity_in_feet();
  const Case the_case = read_in_feet(text_in_feet("31.9"));
  const std::string text = case_text(the_case, registry);
  EXPECT_THAT(text, HasSubstr("gravity_ft_per_s2 = 31.9\n"));
  EXPECT_THAT(text, Not(HasSubstr("gravity_m_per_s2")));
  EXPECT_EQ(read_in_feet(text).pump.gravity, the_case.pump.gravity);
}

TEST(ParameterOfATestRegistry, CanBeSet) {
  const Case the_case = read_in_feet(text_in_feet("32.0"), {"operation.gravity_ft_per_s2=30"});
  EXPECT_EQ(the_case.pump.gravity, 30 * 0.3048);
  EXPECT_EQ(
      refusal([] { read_in_feet(text_in_feet("32.0"), {"operation.gravity_ft_per_s2=200"}); }),
      "--set operation.gravity_ft_per_s2=200: must be in [-100, 100]");
}

TEST(ParameterOfATestRegistry, IsInTheSchemaAndTheTables) {
  const Registry registry = with_gravity_in_feet();
  const auto schema = nlohmann::json::parse(case_schema(registry));
  const auto& operation = schema["properties"]["operation"];
  EXPECT_EQ(operation["properties"]["gravity_ft_per_s2"],
            (nlohmann::json{{"description", "g_ft: along -y1, in feet, ft/s2"},
                            {"type", "number"},
                            {"minimum", -100.0},
                            {"maximum", 100.0}}));
  EXPECT_THAT(operation["required"], Contains("gravity_ft_per_s2"));
  EXPECT_THAT(
      markdown_table("operation", registry),
      HasSubstr("| `gravity_ft_per_s2` | g_ft | along -y1, in feet | [-100, 100] | required |"));
}

TEST(ParameterOfATestRegistry, IsPerturbed) {
  const Registry registry = with_gravity_in_feet();
  PumpParameters pump = reference_case("bap63_rated").pump;
  std::vector<std::string> names;
  for (const PumpInput& input : continuous_inputs(pump, registry)) {
    names.push_back(input.name);
    if (input.name == "gravity_in_feet") {
      EXPECT_EQ(input.value, &pump.gravity);
      EXPECT_EQ(input.range.high, 100 * 0.3048);
    }
  }
  EXPECT_THAT(names, Contains("gravity_in_feet"));
  EXPECT_THAT(names, Not(Contains("gravity")));
}

// ---- The registry itself
// -------------------------------------------------------------------------

// What a table, an axis or an editor calls a parameter by: no two are called the same.
TEST(Registry, ParametersAreToldApart) {
  std::set<std::string> names, meanings;
  for (const Table& table : standard_registry().tables) {
    std::set<std::string> symbols;
    for (const Parameter& p : table.parameters) {
      const std::string name = table.name + "." + p.key;
      EXPECT_TRUE(names.insert(name).second) << name;
      EXPECT_TRUE(meanings.insert(p.symbol + ": " + p.meaning + " " + p.unit.name).second)
          << name << ": " << p.meaning;
      if (p.symbol.empty()) continue;
      const std::size_t comma = p.symbol.find(", ");
      EXPECT_TRUE(comma != std::string::npos || !std::holds_alternative<PairField>(p.field))
          << name;
      for (const std::string& symbol :
           comma == std::string::npos
               ? std::vector<std::string>{p.symbol}
               : std::vector<std::string>{p.symbol.substr(0, comma), p.symbol.substr(comma + 2)})
        EXPECT_TRUE(symbols.insert(symbol).second) << name << ": " << symbol;
    }
  }
  EXPECT_GT(names.size(), 150);
}

// Seeded draws and sums depend on it: the order of the file, then the parts a pump may lack.
TEST(Registry, ContinuousInputsKeepTheirOrder) {
  PumpParameters pump = reference_case("asymmetric_ports").pump;
  std::vector<std::string> names;
  for (const PumpInput& input : continuous_inputs(pump)) names.push_back(input.name);
  EXPECT_EQ(names.front(), "geometry.tilt");
  const auto place = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  const auto count = static_cast<std::ptrdiff_t>(names.size());
  const auto gravity = place("gravity");
  EXPECT_LT(place("geometry.bore_diameter"), place("gear.pitch_diameter"));
  EXPECT_LT(place("piston.joint_mass_fraction"), place("shaft.mass"));
  EXPECT_EQ(place("friction.shaft_torque_factor"), gravity - 1);
  EXPECT_EQ(place("piston.real.centre_of_mass"), gravity + 1);
  EXPECT_EQ(place("port_plate.r1"), place("piston.real.spin") + 1);
  EXPECT_EQ(place("port_plate.suction.to_deg"), count - 1);
}

// No number of PumpParameters is left out: the struct has no other doubles than those listed.
TEST(Registry, ListsEveryNumberOfAPump) {
  PumpParameters pump = reference_case("asymmetric_ports").pump;
  pump.piston.contact.emplace();
  pump.gear.contact = ToothContact::compliant;
  pump.gear.compliance.emplace();
  std::set<const void*> places;
  for (const PumpInput& input : continuous_inputs(pump)) places.insert(input.value);
  constexpr std::size_t kNumbers =
      (sizeof(ToothCompliance) + sizeof(Bearings) + sizeof(PistonMass::Real) + sizeof(Shaft) +
       sizeof(Block) + sizeof(Friction) + sizeof(PortPlate)) /
          sizeof(double) +
      6 + 2 + 3 + 1;  // Geometry without N, Gear's and PistonMass's own, gravity
  EXPECT_EQ(places.size(), kNumbers);
}

TEST(Registry, ListsEveryNumberOfTheTeeth) {
  PumpParameters pump = reference_case("asymmetric_ports").pump;
  std::set<std::string> before, names;
  for (const PumpInput& input : continuous_inputs(pump)) before.insert(input.name);
  pump.gear.contact = ToothContact::teeth;
  pump.gear.teeth.emplace();
  std::set<const void*> places;
  for (const PumpInput& input : continuous_inputs(pump))
    if (before.count(input.name) == 0) places.insert(input.value);
  const auto* first = reinterpret_cast<const char*>(&*pump.gear.teeth);
  for (const void* place : places) {
    EXPECT_GE(static_cast<const char*>(place), first);
    EXPECT_LT(static_cast<const char*>(place), first + sizeof(ToothData));
  }
  // From face_width to rim_ratio without a gap, and two of each gear.
  const ToothData& teeth = *pump.gear.teeth;
  constexpr std::size_t kOfGears = 4;
  EXPECT_EQ(places.size(),
            static_cast<std::size_t>(&teeth.rim_ratio - &teeth.face_width) + 1 + kOfGears);
}

// ---- Teeth

Case with_teeth(std::vector<std::string> changes, const std::filesystem::path& file = "case.toml") {
  changes.insert(changes.begin(),
                 {"gear.contact=teeth", "gear.tooth_number=20", "gear.face_width_mm=12"});
  std::string text = rated_text();
  for (const char* own : {"contact", "flanks"}) {  // of rigid teeth, as they are written
    const auto at = text.find(std::string("\n") + own + " = ") + 1;
    text.erase(at, text.find('\n', at) - at + 1);
  }
  return parse_case(text, file, changes);
}

TEST(Teeth, AreReadWithTheirDefaults) {
  const Case the_case = with_teeth({"gear.backlash_um=40", "gear.dissipation_s_per_m=0.3"});
  const Gear& gear = the_case.pump.gear;
  ASSERT_TRUE(gear.teeth);
  EXPECT_FALSE(gear.compliance);
  EXPECT_EQ(gear.flanks, Flanks::two);
  const double module = gear.pitch_diameter / 20;
  EXPECT_EQ(gear.teeth->count, 20);
  EXPECT_NEAR(gear.teeth->addendum, module, 1e-15);
  EXPECT_NEAR(gear.teeth->dedendum, 1.25 * module, 1e-15);
  EXPECT_NEAR(gear.teeth->relief_height, 0.5 * module, 1e-15);
  EXPECT_DOUBLE_EQ(gear.teeth->backlash, 40e-6);
  EXPECT_DOUBLE_EQ(gear.teeth->dissipation, 0.3);
  EXPECT_DOUBLE_EQ(gear.teeth->youngs_modulus, 206e9);
  // Written and read again.
  const Case again = parse_case(case_text(the_case), "again.toml");
  EXPECT_DOUBLE_EQ(again.pump.gear.teeth->addendum, gear.teeth->addendum);
  EXPECT_EQ(again.pump.gear.contact, ToothContact::teeth);
}

TEST(Teeth, AreRefusedByName) {
  EXPECT_THAT(refusal([] { with_teeth({"gear.flanks=one"}); }),
              HasSubstr("compliant teeth have two flanks"));
  EXPECT_THAT(refusal([] { with_teeth({"pump.tilt_deg=0"}); }),
              HasSubstr("bevel teeth need [pump] tilt_deg >= 0.0001"));
  EXPECT_THAT(refusal([] { with_teeth({"gear.rim_ratio=1.2"}); }),
              HasSubstr("gear.rim_ratio=1.2: must be in [1.4, 7]"));
  EXPECT_THAT(refusal([] { with_teeth({"gear.tooth_number=4"}); }), HasSubstr("in [5, 400]"));
  EXPECT_THAT(refusal([] {
                parse_case(rated_text(), "case.toml", {"gear.contact=teeth", "gear.flanks=two"});
              }),
              HasSubstr("tooth_number"));
}

TEST(Teeth, PitchErrorsAreReadToothByTooth) {
  const Scratch scratch;
  const auto file = scratch.path() / "errors.csv";
  const auto write = [&](const std::string& lines) {
    std::ofstream(file) << "tooth,shaft_um,block_um\n" << lines;
  };
  const auto read = [&] {
    return with_teeth({"gear.pitch_error_file=errors.csv"}, scratch.path() / "case.toml");
  };
  std::string lines;
  for (int i = 1; i <= 20; ++i)
    lines += std::to_string(i) + "," + std::to_string(i) + ",-" + std::to_string(2 * i) + "\n";
  write(lines);
  const ToothData teeth = *read().pump.gear.teeth;
  ASSERT_EQ(teeth.shaft.pitch.size(), 20U);
  EXPECT_DOUBLE_EQ(teeth.shaft.pitch[2], 3e-6);
  EXPECT_DOUBLE_EQ(teeth.block.pitch[19], -40e-6);
  write("1,0,0\n");
  EXPECT_THAT(refusal(read), HasSubstr("has 1 tooth, must be tooth_number = 20"));
  write("2" + lines.substr(1));
  EXPECT_THAT(refusal(read), HasSubstr(":2: tooth"));
}

// A case made in memory starts from the defaults of the file.
TEST(Registry, DefaultsAreThoseOfANewCase) {
  const Case fresh;
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters)
      if (const auto value = value_of(parameter, fresh); value && parameter.fallback.value) {
        EXPECT_EQ(*value, *parameter.fallback.value) << table.name << " " << parameter.key;
      }
}

TEST(Registry, EveryNumberHasAMeaningAndItsUnitInItsKey) {
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters) {
      EXPECT_FALSE(parameter.meaning.empty()) << parameter.key;
      std::string unit;  // "kg mm2" -> "_kg_mm2", "N s/m" -> "_N_s_per_m"
      for (const char c : std::string(parameter.unit.name))
        unit += c == ' ' ? "_" : c == '/' ? "_per_" : std::string(1, c);
      EXPECT_TRUE(unit.empty() || parameter.key.ends_with("_" + unit)) << parameter.key;
    }
}

TEST(Registry, FileUnitsReadBackToTheSameBits) {
  RandomPump random(61);
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters) {
      if (parameter.unit.to_si == nullptr) continue;
      for (int n = 0; n < 200; ++n) {
        const double value = random.in(-1, 1) * std::pow(10, random.in(-6, 6));
        const double si = parameter.unit.to_si(value);
        EXPECT_EQ(parameter.unit.to_si(in_file_unit(si, parameter.unit)), si) << parameter.key;
        const double plain = std::round(value * 1000) / 1000;
        EXPECT_EQ(number_text(in_file_unit(parameter.unit.to_si(plain), parameter.unit)),
                  number_text(plain))
            << parameter.key;
      }
    }
}

// A plausible range is one of a number, leaves room, and holds what stands there by default.
TEST(Registry, PlausibleRangesHoldTheDefaults) {
  int ranges = 0;
  for (const Table& table : standard_registry().tables)
    for (const Parameter& p : table.parameters) {
      const PlausibleRange& range = p.plausible;
      if (range.why.empty()) {
        EXPECT_TRUE(range.slips.empty()) << p.key;
        continue;
      }
      ++ranges;
      EXPECT_LT(range.low, range.high) << p.key;
      EXPECT_TRUE(std::holds_alternative<NumberField>(p.field) ||
                  std::holds_alternative<IntegerField>(p.field))
          << p.key;
      if (!p.fallback.value || p.active.words == std::vector<std::string>{"hydraulic"}) continue;
      const auto* const whole = std::get_if<int>(&*p.fallback.value);
      const double value = whole != nullptr ? *whole : std::get<double>(*p.fallback.value);
      EXPECT_GE(value, range.low) << p.key;
      EXPECT_LE(value, range.high) << p.key;
    }
  EXPECT_GE(ranges, 15);
}

// Keys of a bearing's rating that is not given whole have defaults from keys that are not there.
TEST(Registry, KeysOfARatingThatIsNotWholeAreCheckedAndUnused) {
  for (const std::string key : {"tapered_e", "tapered_Y0"}) {
    EXPECT_FALSE(parse_case(rated_text(), "x.toml", {"bearings." + key + "=0.4"}).ratings.tapered);
    EXPECT_EQ(refusal([&] { parse_case(rated_text(), "x.toml", {"bearings." + key + "=-1"}); }),
              "--set bearings." + key + "=-1: must be " + (key == "tapered_e" ? "> 0" : ">= 0"));
  }
}

// Tables of the hydraulic side may stand in a case without one: checked and unused.
TEST(Registry, KeysOfDataThatACaseLacksAreUnused) {
  for (const char* unused :
       {"[load]\nkind = \"orifice\"\nfile = \"no_such.csv\"", "[oil]\nviscosity_100C_cSt = 6.0",
        "[leakage]\npiston_gap_um = 10.0\npiston_gap_kind = \"engaged\"",
        "[suction_line]\nlength_m = 1.0\ndiameter_mm = 30.0",
        "[delivery_line]\nlength_m = 1.0\ndiameter_mm = 30.0",
        "[accumulator]\ngas_volume_l = 1.0\nprecharge_bar = 100.0", "[loop]\nvolume_l = 0.5"}) {
    Case the_case;
    EXPECT_EQ(refusal([&] {
                the_case = parse_case(rated_text() + "\n" + unused + "\n", "x.toml");
                validate(the_case);
              }),
              "accepted")
        << unused;
    EXPECT_FALSE(the_case.hydraulics) << unused;
    EXPECT_EQ(case_text(the_case), rated_text()) << unused;
  }
}

// ---- --set
// ---------------------------------------------------------------------------------------

Case changed(const std::vector<std::string>& changes) {
  return parse_case(rated_text(), "x.toml", changes);
}
std::string why(const std::string& change) {
  return refusal([&] { changed({change}); });
}

TEST(Set, ReadsAsIfTheFileSaidSo) {
  EXPECT_EQ(changed({"pump.tilt_deg=35"}).pump.geometry.tilt, radians(35));
  EXPECT_EQ(changed({"pump.tilt_deg = 35.5 "}).pump.geometry.tilt, radians(35.5));
  EXPECT_EQ(changed({"name=a longer name"}).name, "a longer name");
  EXPECT_EQ(changed({"name=\"quoted = too\""}).name, "quoted = too");
  EXPECT_EQ(changed({"assumptions.analytic.gear=imposed"}).analytic.gear, BlockDrive::imposed);
  EXPECT_EQ(changed({"assumptions.multibody.piston_friction=false"}).multibody.piston_friction,
            false);
  EXPECT_EQ(changed({"port_plate.delivery_arc_deg=[180, 350]"}).pump.port_plate->delivery.to_deg,
            350);
  EXPECT_EQ(changed({"operation.speed_rpm=-100", "operation.speed_rpm=200"}).operation.speed_rpm,
            200);
  // The same text as a file that says so.
  std::string text = rated_text();
  const auto at = text.find("tilt_deg = ");
  text.replace(at, text.find('\n', at) - at, "tilt_deg = 35");
  EXPECT_EQ(case_text(changed({"pump.tilt_deg=35"})), case_text(parse_case(text, "x.toml")));
}

// A range that follows from another number is converted there and back.
TEST(Set, BoundsFromOtherNumbersAllowForTheirRounding) {
  std::mt19937 engine(1);
  for (int n = 0; n < 1000; ++n) {
    const double transverse = std::uniform_real_distribution<double>(1, 100)(engine);
    EXPECT_NO_THROW(changed({"piston.centre_of_mass_mm=20",
                             "piston.transverse_inertia_kg_mm2=" + number_text(transverse),
                             "piston.axial_inertia_kg_mm2=" + number_text(2 * transverse)}));
  }
}

TEST(Set, IsRecorded) {
  for (const InputEntry& entry : changed({"pump.tilt_deg=35", "name=other"}).entries)
    EXPECT_EQ(entry.changed, entry.key == "tilt_deg" || entry.key == "name") << entry.key;
}

TEST(Set, RefusesInOneLineThatNamesKeyValueAndRange) {
  EXPECT_EQ(why("pump.tilt_deg=95"), "--set pump.tilt_deg=95: must be in [0, 90)");
  EXPECT_EQ(why("pump.tilt_deg=steep"), "--set pump.tilt_deg=steep: must be a number, in [0, 90)");
  EXPECT_EQ(why("pump.tilt_deg="), "--set pump.tilt_deg=: must be a number, in [0, 90)");
  EXPECT_EQ(why("pump.tilt_deg=nan"),
            "--set pump.tilt_deg=nan: must be a finite number, in [0, 90)");
  EXPECT_EQ(why("pump.pistons=5.5"), "--set pump.pistons=5.5: must be an integer in [1, 99]");
  EXPECT_EQ(why("bearings.cylindrical_z_mm=-26"),
            "--set bearings.cylindrical_z_mm=-26: must differ from tapered_z_mm");
  EXPECT_EQ(why("pump.tilt_degg=40"),
            "--set pump.tilt_degg=40: unknown key \"tilt_degg\" in [pump]; did you mean "
            "\"tilt_deg\"?");
  EXPECT_EQ(why("pumps.tilt_deg=40"),
            "--set pumps.tilt_deg=40: unknown table [pumps]; did you mean \"pump\"?");
  EXPECT_THAT(why("title=40"), HasSubstr("unknown key \"title\"; allowed: name, schema"));
  for (const char* bad : {"", "=", "pump.tilt_deg", "=3", "pump.tilt_deg=1\n[gear]", "a\nb=2"}) {
    EXPECT_THAT(why(bad), HasSubstr("must be TABLE.KEY=VALUE")) << bad;
    EXPECT_EQ(why(bad).find('\n'), std::string::npos) << bad;
  }
  // Where the file itself is at fault, its line is named.
  EXPECT_THAT(why("pump.joint_circle_radius_mm=200"), HasSubstr("x.toml:"));
  EXPECT_THAT(why("pump.joint_circle_radius_mm=200"), HasSubstr("cannot be assembled"));
}

// ---- validation
// ----------------------------------------------------------------------------------

TEST(Validate, AcceptsEveryReferenceCaseAndRandomPumps) {
  for (const std::string& name : reference_cases())
    EXPECT_EQ(refusal([&] { validate(reference_case(name)); }), "accepted") << name;
  RandomPump random(62);
  for (int n = 0; n < 300; ++n) EXPECT_NO_THROW(validate(random.pump()));
}

// What was converted may leave a closed bound by its rounding, and no more.
TEST(Validate, HoldsConvertedBoundsToAFewUnitsInTheLastPlace) {
  PumpParameters pump = reference_case("asymmetric_ports").pump;
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  pump.gear.pressure_angle = radians(60) * (1 + kEpsilon);
  pump.piston.real->axial_inertia = 2 * pump.piston.real->transverse_inertia * (1 + 3 * kEpsilon);
  EXPECT_NO_THROW(validate(pump));
  pump.gear.pressure_angle = radians(60) * (1 + 1e-12);
  EXPECT_THROW(validate(pump), InputError);
  pump.gear.pressure_angle = 0;
  pump.piston.joint_mass_fraction = 1;
  EXPECT_NO_THROW(validate(pump));
  pump.piston.joint_mass_fraction = 1 + kEpsilon;
  EXPECT_THROW(validate(pump), InputError);
  pump.piston.joint_mass_fraction = 0.5;
  pump.geometry.tilt = radians(90);  // an open bound
  EXPECT_THROW(validate(pump), InputError);
}

TEST(Validate, HoldsBoundsFromOtherNumbersAlike) {
  PumpParameters pump = reference_case("seven_real_spinning").pump;
  PistonMass::Real& real = *pump.piston.real;
  real.axial_inertia = std::nextafter(2 * real.transverse_inertia, 1.0);
  EXPECT_NO_THROW(validate(pump));
  real.axial_inertia = 2 * real.transverse_inertia * (1 + 1e-12);
  EXPECT_THROW(validate(pump), InputError);
}

TEST(Validate, SaysWhatTheReaderSays) {
  const auto after = [](const std::function<void(Case&)>& change) {
    Case the_case = reference_case("asymmetric_ports");
    change(the_case);
    return refusal([&] { validate(the_case); });
  };
  EXPECT_EQ(after([](Case& c) { c.pump.geometry.pistons = 100; }),
            "[pump] pistons = 100: must be an integer in [1, 99]");
  EXPECT_EQ(after([](Case& c) { c.pump.geometry.tilt = radians(95); }),
            "[pump] tilt_deg = 95: must be in [0, 90)");
  EXPECT_THAT(after([](Case& c) { c.pump.block.mass = std::nan(""); }),
              HasSubstr("must be a finite number, >= 0"));
  EXPECT_THAT(after([](Case& c) { c.pump.geometry.piston_length = 1e-3; }),
              HasSubstr("[pump] piston_length_mm = 1: must be > "));
  EXPECT_EQ(after([](Case& c) { c.pump.piston.real->axial_inertia = 1; }),
            "[piston] axial_inertia_kg_mm2 = 1e+06: must be in [0, 48]");
  EXPECT_THAT(after([](Case& c) {
                c.pump.piston.inertia = PistonInertia::real;
                c.pump.piston.real.reset();
              }),
              HasSubstr("[piston] inertia = \"real\": needs centre_of_mass_mm"));
  EXPECT_THAT(after([](Case& c) { c.pump.bearings.cylindrical_z = c.pump.bearings.tapered_z; }),
              HasSubstr("must differ from tapered_z_mm"));
  EXPECT_THAT(after([](Case& c) { c.pump.port_plate->r2 = c.pump.port_plate->r3; }),
              HasSubstr("outer_land_mm"));
  EXPECT_THAT(after([](Case& c) {
                c.pump.port_plate->delivery = {0, 361};
              }),
              HasSubstr("from + 360"));
  EXPECT_EQ(after([](Case& c) { c.operation.samples_per_revolution = 0; }),
            "[operation] samples_per_revolution = 0: must be an integer >= 1");
  EXPECT_EQ(after([](Case& c) { c.pressure.transition_deg = 181; }),
            "[pressure] transition_deg = 181: must be in [0, 180]");
  EXPECT_EQ(after([](Case& c) { c.pressure.kind = PressureKind::hydraulic; }),
            "table [hydraulics] is missing");
}

TEST(Validate, HydraulicsToo) {
  const Case good = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                              "bap63_rated_hydraulic.toml");
  EXPECT_NO_THROW(validate(good));
  const auto after = [&](const std::function<void(Case&)>& change) {
    Case the_case = good;
    change(the_case);
    return refusal([&] { validate(the_case); });
  };
  EXPECT_THAT(after([](Case& c) { c.hydraulics->air_share = 0; }), HasSubstr("air_percent = 0"));
  EXPECT_THAT(after([](Case& c) { c.hydraulics->kidney_rounding_deg = 90; }),
              HasSubstr("kidney_rounding_deg = 90: must be in [0, "));
  EXPECT_THAT(after([](Case& c) {
                c.hydraulics->suction.arc = {0, 350};
              }),
              HasSubstr("port's arc and notches must not exceed 360 deg"));
  EXPECT_THAT(after([](Case& c) { c.hydraulics->case_pressure = -c.hydraulics->atmosphere; }),
              HasSubstr("case_bar = -1.01325: must be > -1.01325"));
  // Oil boils where the pressure is lowest: in the suction port or in the case.
  const auto boiling = [&](double suction, double in_case) {
    return after([=](Case& c) {
      c.hydraulics->cavitation = Cavitation::equilibrium;
      c.hydraulics->atmosphere = 1e5;
      c.hydraulics->vapour_pressure = 0.7e5;
      c.pressure.ports.suction = suction;
      c.hydraulics->case_pressure = in_case;
    });
  };
  EXPECT_EQ(boiling(-0.2e5, -0.2e5), "accepted");
  EXPECT_THAT(boiling(-0.4e5, 1e5), HasSubstr("must be < 0.6, the smaller absolute pressure"));
  EXPECT_THAT(boiling(1e5, -0.5e5), HasSubstr("must be < 0.5, the smaller absolute pressure"));
  EXPECT_THAT(after([](Case& c) { c.pressure.ports.suction = -2e5; }),
              HasSubstr("[hydraulics] atmosphere_bar = 1.01325: must exceed -suction_bar"));
  for (const OpeningTable& table :
       {OpeningTable{"", {0, 1}, {1, 1}}, OpeningTable{"", {0, 1, 2}, {1, 1}},
        OpeningTable{"", {0, 2, 1}, {1, 1, 1}}, OpeningTable{"", {0, 1, 360}, {1, 1, 1}},
        OpeningTable{"", {0, 1, 2}, {1, -1, 1}}, OpeningTable{"", {0, 1, 2}, {0, 0, 0}}})
    EXPECT_THAT(after([&](Case& c) { c.hydraulics->suction.table = table; }),
                HasSubstr("suction_opening_file"));
  EXPECT_NO_THROW(validate([&] {
    Case the_case = good;
    the_case.hydraulics->suction.table = {"", {0, 100, 200}, {0, 1e-6, 0}};
    return the_case;
  }()));
  const std::vector<double> four = {0, 90, 180, 270};
  for (const StrokeTable& table :
       {StrokeTable{"", {0, 90, 180}, {0, 1, 2}, false}, StrokeTable{"", four, {0, 1, 2}, false},
        StrokeTable{"", {0, 180, 90, 270}, {0, 1, 2, 1}, false},
        StrokeTable{"", {0, 90, 180, 360}, {0, 1, 2, 1}, false},
        StrokeTable{"", four, {1, 1, 1, 1}, false}, StrokeTable{"", four, {0, 1, NAN, 1}, false},
        StrokeTable{"", four, {0, 1, 2, 1}, true}})
    EXPECT_THAT(after([&](Case& c) { c.hydraulics->stroke = table; }), HasSubstr("stroke_file"));
  EXPECT_EQ(after([&](Case& c) {
              c.hydraulics->stroke = {"", four, {0, 8e-3, 16e-3, 8e-3}, false};
            }),
            "accepted");
  EXPECT_THAT(after([](Case& c) { c.hydraulics->suction.discharge_coefficient = 3; }),
              HasSubstr("suction_discharge_coefficient = 3: must be in (0, 2]"));
  EXPECT_THAT(after([](Case& c) { c.pressure.ports.delivery = -1; }),
              HasSubstr("delivery_bar = -1e-05: must be in [0, 10000]"));
}

// ---- The border of every model
// -------------------------------------------------------------------

// Each way into a model with a case, by name.
std::map<std::string, std::function<void(const Case&)>> borders() {
  const Samples samples = one_turn(reference_case("bap63_rated"));
  const PressureTrace trace(reference_case("bap63_rated").pressure);
  const auto zero = [](double) { return 0.0; };
  return {
      {"analytic model", [](const Case& c) { analytic::Model(c.pump, c.analytic); }},
      {"analytic run", [=](const Case& c) { analytic::run(c, c.analytic, samples); }},
      {"batch", [](const Case& c) { analytic::BatchModel(c.pump, c.analytic); }},
      {"batch of pumps", [](const Case& c) { analytic::PumpBatch({c.pump}, c.analytic); }},
      {"last of a batch of pumps",
       [](const Case& c) {
         PumpParameters good = reference_case("bap63_rated").pump;
         good.geometry.pistons = c.pump.geometry.pistons;
         if (good.geometry.pistons > kMaxPistons) throw InputError("the first is refused");
         analytic::PumpBatch({good, c.pump}, c.analytic);
       }},
      {"rounding", [](const Case& c) { analytic::RoundingEstimate(c.pump, c.analytic); }},
      {"multibody model", [](const Case& c) { multibody::Model(c.pump, c.multibody, 1); }},
      {"size of a scene",
       [](const Case& c) { multibody::scene_size(c.pump, c.multibody, multibody::Scene::full); }},
      {"driven run", [=](const Case& c) { multibody::run_driven(c, c.multibody, samples); }},
      {"integrated run",
       [=](const Case& c) {
         multibody::run_integrated(c, c.multibody, samples, PressureTrace(c.pressure), {});
       }},
      {"torque-driven run",
       [=](const Case& c) {
         multibody::run_torque_driven(c, c.multibody, samples, PressureTrace(c.pressure), zero, {});
       }},
      {"hydraulics", [](const Case& c) { hydraulics::Network{c}; }}};
}

// What a case file is refused for does not reach a model through the API.
TEST(Border, RefusesWhatTheReaderRefuses) {
  const std::map<std::string, std::function<void(Case&)>> faults = {
      {"pistons", [](Case& c) { c.pump.geometry.pistons = 100; }},
      {"tilt_deg", [](Case& c) { c.pump.geometry.tilt = -0.1; }},
      {"piston_length_mm", [](Case& c) { c.pump.geometry.piston_length = 1e-3; }},
      {"cylindrical_z_mm",
       [](Case& c) { c.pump.bearings.cylindrical_z = c.pump.bearings.tapered_z; }},
      {"joint_mass_fraction", [](Case& c) { c.pump.piston.joint_mass_fraction = 1.01; }},
      {"shaft_torque_factor", [](Case& c) { c.pump.friction.shaft_torque_factor = 0; }},
      {"mass_kg", [](Case& c) { c.pump.block.mass = std::nan(""); }},
      {"inner_land_mm", [](Case& c) { c.pump.port_plate->r1 = 1; }}};
  for (const auto& [border, enter] : borders())
    for (const auto& [key, spoil] : faults) {
      Case the_case = reference_case("bap63_rated");
      spoil(the_case);
      const std::string why_not = refusal(std::bind(enter, the_case));
      const bool many = border == "last of a batch of pumps" && key == "pistons";
      EXPECT_THAT(why_not, HasSubstr(many ? "the first is refused" : key + " = ")) << border;
    }
}

TEST(Border, AcceptsWhatIsRight) {
  const Case the_case = reference_case("bap63_rated");
  for (const auto& [border, enter] : borders()) {
    if (border == "hydraulics" || border.ends_with(" run")) continue;  // in tests of their own
    EXPECT_EQ(refusal(std::bind(enter, the_case)), "accepted") << border;
  }
}

TEST(Border, OnePressureForEachPiston) {
  const Case the_case = reference_case("bap63_rated");
  const std::string expected = "3 chamber pressures for 5 pistons";
  Instant instant;
  instant.turn(0.1, 100);
  instant.chamber_pressure.assign(3, 1e7);

  const analytic::Model analytic(the_case.pump, the_case.analytic);
  std::vector<double> values(analytic.layout().size());
  std::vector<long double> extended(values.size());
  EXPECT_THAT(refusal([&] { analytic.reactions(instant, values); }), HasSubstr(expected));
  EXPECT_THAT(refusal([&] { analytic.reactions(instant, extended); }), HasSubstr(expected));
  EXPECT_THAT(refusal([&] { analytic.evaluate(instant, values); }), HasSubstr(expected));
  EXPECT_THAT(refusal([&] { analytic.friction_power(instant, 0); }), HasSubstr(expected));

  for (const auto scene : {multibody::Scene::full, multibody::Scene::piston}) {
    multibody::Model multibody(the_case.pump, the_case.multibody, 1, scene);
    EXPECT_THAT(refusal([&] { multibody.evaluate(instant, values); }), HasSubstr(expected));
    if (scene == multibody::Scene::piston) {
      EXPECT_THAT(refusal([&] { multibody.evaluate_one(instant, values); }), HasSubstr(expected));
    }
  }

  const std::vector<analytic::Varying> chambers(3);
  analytic::BatchInstants instants;
  instants.count = 1;
  instants.chamber_pressure = chambers;
  const analytic::BatchModel batch(the_case.pump, the_case.analytic);
  const analytic::PumpBatch pumps({the_case.pump}, the_case.analytic);
  analytic::BatchColumns columns(batch.layout().reactions(), 1);
  const auto outputs = outputs_of(batch.layout(), analytic::ChannelGroup::all, columns);
  EXPECT_THAT(refusal([&] { batch.reactions(instants, outputs); }), HasSubstr(expected));
  EXPECT_THAT(refusal([&] { pumps.reactions(instants, outputs); }), HasSubstr(expected));
}

TEST(Border, RoomForEveryValue) {
  const Case the_case = reference_case("bap63_rated");
  Instant instant;
  instant.turn(0.1, 100);
  instant.chamber_pressure.assign(5, 1e7);
  const analytic::Model analytic(the_case.pump, the_case.analytic);
  multibody::Model multibody(the_case.pump, the_case.multibody, 1);
  std::vector<double> few(analytic.layout().reactions() - 1);
  EXPECT_THAT(refusal([&] { analytic.reactions(instant, few); }), HasSubstr("space for 36 values"));
  few.resize(analytic.layout().size() - 1);
  EXPECT_EQ(refusal([&] { analytic.reactions(instant, few); }), "accepted");
  EXPECT_THAT(refusal([&] { analytic.evaluate(instant, few); }), HasSubstr("space for"));
  EXPECT_THAT(refusal([&] { multibody.evaluate(instant, few); }), HasSubstr("space for"));
}

TEST(Border, SamplesAreThoseOfThePump) {
  const Case the_case = reference_case("bap63_rated");
  const Samples samples = one_turn(reference_case("offset_nine"));
  const PressureTrace trace(the_case.pressure);
  EXPECT_THAT(refusal([&] { analytic::run(the_case, the_case.analytic, samples); }),
              HasSubstr("9 chamber pressures for 5 pistons"));
  for (const auto scene : {multibody::Scene::full, multibody::Scene::piston})
    EXPECT_THAT(
        refusal([&] { multibody::run_driven(the_case, the_case.multibody, samples, {}, scene); }),
        HasSubstr("samples of 9 pistons for a pump with 5"));
  EXPECT_THAT(
      refusal([&] { multibody::run_integrated(the_case, the_case.multibody, samples, trace, {}); }),
      HasSubstr("samples of 9 pistons for a pump with 5"));
}

// The estimate moves inputs that stand on their bounds a little beyond them.
TEST(Border, RoundingIsEstimatedOnTheBoundsToo) {
  Case the_case = reference_case("seven_real_spinning");
  PumpParameters& pump = the_case.pump;
  pump.piston.joint_mass_fraction = 1;
  pump.friction.shaft_torque_factor = 1;
  pump.gear.pressure_angle = radians(60);
  pump.piston.real->axial_inertia = 2 * pump.piston.real->transverse_inertia;
  EXPECT_EQ(refusal([&] { analytic::RoundingEstimate(pump, the_case.analytic); }), "accepted");
}

// Numbers and pairs of a case file, by "table.key", as they stand in its text.
std::map<std::string, std::string> numbers_written(const std::string& text) {
  static const std::regex kHeading(R"(\[([a-z_.]+)\].*)");
  static const std::regex kEntry(R"(([A-Za-z0-9_]+) *= *([-+0-9\[][^#"]*[0-9\]]) *(#.*)?)");
  std::map<std::string, std::string> numbers;
  std::istringstream in(text);
  std::string table;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, match, kHeading)) table = match[1];
    if (std::regex_match(line, match, kEntry)) numbers[table + "." + match[1].str()] = match[2];
  }
  return numbers;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::filesystem::path> case_files() {
  const std::filesystem::path source(BENTAXIS_SOURCE_DIR);
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"cases", "reference_data"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder))
      if (entry.path().filename() == "case.toml" ||
          (entry.path().parent_path().filename() == "cases" && entry.path().extension() == ".toml"))
        files.push_back(entry.path());
  return files;
}

// 24.92 was reported as 24.920000000000002: toml++ prints 17 digits.
TEST(Numbers, AreReportedAsTheFileHasThem) {
  std::size_t compared = 0;
  for (const auto& file : case_files()) {
    SCOPED_TRACE(file);
    const auto numbers = numbers_written(text_of(file));
    for (const InputEntry& entry : read_case(file).entries) {
      const auto found = numbers.find(entry.table + "." + entry.key);
      if (entry.defaulted || found == numbers.end()) continue;
      EXPECT_EQ(entry.value, found->second) << entry.table << "." << entry.key;
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000);
}

// The way to SI and back: what is written is the number that was read.
TEST(Numbers, AreWrittenAsTheFileHadThem) {
  std::size_t compared = 0;
  for (const auto& file : case_files()) {
    SCOPED_TRACE(file);
    const auto read = numbers_written(text_of(file));
    for (const auto& [key, text] : numbers_written(case_text(read_case(file)))) {
      const auto found = read.find(key);
      if (found == read.end() || text[0] == '[') continue;
      const std::string shortest = number_text(std::stod(found->second));
      EXPECT_TRUE(text == shortest || text == shortest + ".0") << key << ": " << text;
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000);
}

TEST(Numbers, OddSpellingsStayAndSoDoChanges) {
  const auto value_in = [](const std::string& text, const std::string& key) {
    TomlFile file(text, "odd.toml");
    std::vector<InputEntry> entries;
    TableReader root = file.root(&entries);
    root.number(key, kAny);
    return entries.at(0).value;
  };
  EXPECT_EQ(value_in("a = 24.920", "a"), "24.920");
  EXPECT_EQ(value_in("a = 1_000.5 # b", "a"), "1_000.5");
  EXPECT_EQ(value_in("a = +2.5e-3", "a"), "+2.5e-3");
  EXPECT_EQ(value_in("a = 0x10", "a"), "0x10");
  EXPECT_EQ(value_in("\"\u00e9\u4e2d\" = 24.92", "\u00e9\u4e2d"), "24.92");
  EXPECT_EQ(value_in("b = {a = 1}\r\n\r\na = 24.92\r\n", "a"), "24.92");

  for (const InputEntry& entry : changed({"pump.joint_circle_radius_mm=24.920"}).entries) {
    if (entry.key == "joint_circle_radius_mm") {
      EXPECT_EQ(entry.value, "24.920");
    }
  }
  try {
    changed({"pump.joint_circle_radius_mm=-24.92"});
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("joint_circle_radius_mm=-24.92:"));
  }
}

}  // namespace
}  // namespace bentaxis::test
