// What the timing of the ports does: verdicts on it, with known answers.
#include "bentaxis/study/timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/files/case_file.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/turn_summary.h"
#include "network.h"
#include "support.h"
#include "timing_record.h"

namespace bentaxis::study {
namespace {

using hydraulics::AngleInterval;
using hydraulics::SteadyState;
using hydraulics::Timing;
using test::scaled;

Case rated() {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                   "bap63_rated_hydraulic.toml");
}

// Pistons whose z_B is a cosine; ports that open to one another exactly at the dead centres, with
// straight ends and no notches; no leakage, next to no air.
Case plain_ports() {
  Case the_case = rated();
  Geometry& g = the_case.pump.geometry;
  g.axis_offset = 0;
  g.bore_circle_radius = g.joint_circle_radius * (1 + std::cos(g.tilt)) / 2;
  HydraulicData& h = *the_case.hydraulics;
  h.delivery = {{180 + 26, 360 - 26}};
  h.suction = {{26, 180 - 26}};
  h.kidney_width_deg = 52;
  h.kidney_rounding_deg = 0;
  h.air_share = 1e-7;
  h.leakage = 0;
  the_case.pressure.ports.suction = pascals(1);
  return the_case;
}

double stroke_volume(const Case& the_case) {
  return hydraulics::Network(the_case).chamber().swept();
}

const TimingRow& row_of(const std::vector<TimingRow>& rows, const std::string& code) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const TimingRow& r) { return r.code == code; });
}

double extent(const std::vector<AngleInterval>& all) {
  double sum = 0;
  for (const AngleInterval& s : all) sum += s.to_deg - s.from_deg;
  return sum;
}

TEST(Stretches, StraightLinesAreCutWhereTheyCrossAndGoOnOverZero) {
  const auto all = hydraulics::intervals_below({0, 90, 90, 180, 270, 360}, {-1, 1, 1, 3, 1, -1}, 0);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_DOUBLE_EQ(all[0].from_deg, 315);
  EXPECT_DOUBLE_EQ(all[0].to_deg, 405);
  EXPECT_TRUE(hydraulics::intervals_below({0, 180, 360}, {0, 0, 0}, 0).empty());
  const auto whole = hydraulics::intervals_below({0, 180, 360}, {-1, -2, -1}, 0);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_DOUBLE_EQ(whole[0].to_deg - whole[0].from_deg, 360);
}

TEST(Timing, StretchesAreThoseOfTheSummary) {
  Case the_case = rated();
  the_case.operation.speed_rpm = 3000;  // oil tears
  the_case.hydraulics->vapour_pressure = pascals(0.02);
  const SteadyState state = hydraulics::steady_state(the_case);
  EXPECT_NEAR(extent(state.timing.below_saturation), state.summary.below_saturation_deg, 0.01);
  EXPECT_NEAR(extent(state.timing.below_vapour), state.summary.below_vapour_deg, 0.01);
  EXPECT_GT(state.summary.below_vapour_deg, 1);
  for (const AngleInterval& s : state.timing.below_vapour) {
    EXPECT_LT(state.computed->gauge((s.from_deg + s.to_deg) / 2), state.summary.vapour);
    EXPECT_NEAR(state.computed->gauge(s.from_deg), state.summary.vapour, 10);  // Pa
  }
  double open = 0;
  for (const auto& c : state.timing.connected) open += c.where.to_deg - c.where.from_deg;
  EXPECT_NEAR(open, state.summary.both_open_deg, 1e-9);
}

// Nothing is compressed before a port opens at once and wide: what fills the chamber comes back.
TEST(Timing, BackflowIsWhatFillsTheChamber) {
  Case the_case = plain_ports();
  the_case.hydraulics->kidney_height = 1;  // m
  const SteadyState state = hydraulics::steady_state(the_case);
  const Timing& t = state.timing;
  const hydraulics::Network network(the_case);
  const double largest = stroke_volume(the_case) + the_case.hydraulics->dead_volume;
  const double rise = state.summary.delivery_mean - pascals(1);
  // The delivery volume's own pressure at the opening is off its mean by a few bar of 275, and the
  // piston moves while the port opens.
  EXPECT_NEAR(t.filling / (largest * rise / the_case.hydraulics->bulk_modulus), 1, 0.02);
  EXPECT_NEAR(t.backflow / t.filling, 1, 0.05);
  EXPECT_LT(t.through(), 1e-6 * t.backflow);
  ASSERT_FALSE(t.backflow_where.empty());
  EXPECT_NEAR(t.backflow_where[0].from_deg, 180, 0.1);
}

// The same from the table of the turn, a twentieth of a degree at a time.
TEST(Timing, BackflowIsTheIntegralOfTheFlow) {
  Case the_case = rated();
  the_case.operation.samples_per_revolution = 7200;
  const SteadyState state = hydraulics::steady_state(the_case);
  const ResultTable& table = state.table;
  double back = 0, through = 0, fastest = 0;
  const double seconds = 60 / the_case.operation.speed_rpm / static_cast<double>(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double out = -table.at(row, table.find("Qd_1_l_per_min")) * kLitrePerMinute;
    const double to_suction = -table.at(row, table.find("Qs_1_l_per_min")) * kLitrePerMinute;
    back += std::max(0.0, out) * seconds;
    through += std::max(0.0, std::min(out, to_suction)) * seconds;
    fastest = std::max(fastest, out);
  }
  EXPECT_NEAR(state.timing.backflow / back, 1, 1e-4);
  EXPECT_NEAR(state.timing.through() / through, 1, 1e-4);
  EXPECT_NEAR(state.timing.largest_backflow / fastest, 1, 1e-3);
  EXPECT_GT(through, 0);
}

// So slowly that the piston's flow is nothing: two orifices in series.
TEST(Timing, ShortCircuitIsTheFlowThroughBothOpeningsInSeries) {
  Case the_case = plain_ports();
  the_case.operation.speed_rpm = 2;
  HydraulicData& h = *the_case.hydraulics;
  h.delivery.arc.from_deg = 180 + 26 - 4;  // 4 degrees of negative overlap
  h.kidney_height = 1e-3;
  h.transition_pressure = pascals(0.01);
  the_case.pressure.ports.delivery = pascals(100);
  h.load.emplace().kind = LoadKind::constant_pressure;
  const SteadyState state = hydraulics::steady_state(the_case);
  ASSERT_EQ(state.timing.connected.size(), 1U);
  const auto& c = state.timing.connected[0];
  EXPECT_NEAR(c.where.from_deg, 176, 1e-9);
  EXPECT_NEAR(c.where.to_deg, 180, 1e-9);
  const hydraulics::Network network(the_case);
  double volume = 0, largest = 0;
  constexpr int kParts = 2000;
  for (int i = 0; i < kParts; ++i) {
    const double theta = 176 + 4 * (i + 0.5) / kParts;
    const double s = network.suction().area(theta), d = network.delivery().area(theta);
    const double area = 1 / std::sqrt(1 / (s * s) + 1 / (d * d));
    largest = std::max(largest, area);
    volume += h.discharge_coefficient * area * std::sqrt(2 * pascals(99) / state.summary.density) *
              (4.0 / kParts) * network.seconds_per_degree();
  }
  EXPECT_NEAR(c.largest_area / largest, 1, 1e-4);
  EXPECT_NEAR(c.largest_area_deg, 178, 0.01);
  // The piston's own flow, and densities half a per cent apart.
  EXPECT_NEAR(c.through / volume, 1, 0.02);
}

// A chamber closed over the outer dead centre and beyond: pressure by the law of the oil.
TEST(Timing, TrappedOilFollowsTheLawOfTheOil) {
  Case the_case = plain_ports();
  HydraulicData& h = *the_case.hydraulics;
  h.suction.arc.to_deg = 180 - 26 - 5;      // closed from 175 degrees on
  h.delivery.arc.from_deg = 180 + 26 + 40;  // open from 220
  const SteadyState state = hydraulics::steady_state(the_case);
  ASSERT_EQ(state.timing.trapped.size(), 1U);
  const auto& t = state.timing.trapped[0];
  EXPECT_NEAR(t.where.from_deg, 175, 1e-9);
  EXPECT_NEAR(t.where.to_deg, 220, 1e-9);
  const hydraulics::Network network(the_case);
  const auto volume = [&](double deg) { return network.chamber().volume(radians(deg)).value; };
  EXPECT_NEAR(t.swept, volume(180) - volume(220), 1e-6 * t.swept);
  const auto& fluid = network.fluid();
  const double start = fluid.density(state.computed->gauge(175));
  EXPECT_NEAR(fluid.density(t.greatest) * volume(220) / (start * volume(175)), 1, 1e-6);
  EXPECT_NEAR(t.greatest_deg, 220, 1e-6);
  EXPECT_GT(t.greatest, 1.5 * state.summary.delivery_mean);
  EXPECT_LT(t.least, pascals(1));
  const auto rows = timing_rows(the_case, state);
  EXPECT_TRUE(row_of(rows, "trapped-oil").flagged);
  EXPECT_TRUE(row_of(rows, "overshoot").flagged);
  EXPECT_NEAR(row_of(rows, "trapped-oil").value,
              (t.greatest - state.summary.delivery_mean) / kPascalPerBar, 1e-9);
  EXPECT_FALSE(row_of(rows, "ports-connected").flagged);
}

// What docs/hydraulics.md says that the plate was chosen by.
TEST(TimedPlate, MeetsItsCriteria) {
  const struct { double rpm, bar; } points[] = {{1500, 275}, {1600, 350}, {2350, 0}};
  for (const auto& [rpm, bar] : points) {
    Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                              "bap63_rated_timed_plate.toml");
    the_case.operation.speed_rpm = rpm;
    the_case.pressure.ports.delivery = pascals(bar);
    const SteadyState state = hydraulics::steady_state(the_case);
    EXPECT_GE(state.summary.chamber_least, pascals(-0.8)) << rpm;
    EXPECT_LE(state.summary.both_open_deg, 6) << rpm;
    EXPECT_LE(state.timing.through(), 0.005 * stroke_volume(the_case)) << rpm;
    if (bar > 0) {
      EXPECT_LE(state.summary.overshoot, 0.05 * pascals(bar)) << rpm;
    }
  }
}

TEST(Verdicts, AReasonOfTheCaseSilencesOne) {
  Case the_case = rated();
  const SteadyState state = hydraulics::steady_state(the_case);
  const auto names = [&] {
    std::vector<std::string> list;
    for (const auto& warning : timing_warnings(timing_rows(the_case, state)))
      list.push_back(warning.name);
    return list;
  };
  EXPECT_THAT(names(), testing::ElementsAre("below-saturation", "ports-connected", "short-circuit",
                                            "backflow"));
  the_case.meant = "below-saturation: it draws its oil in; backflow: notches leak";
  EXPECT_THAT(names(), testing::ElementsAre("ports-connected", "short-circuit"));
  the_case.meant = "connected: no such verdict";
  EXPECT_THROW(names(), InputError);
}

TEST(Verdicts, OvershootIsHeldToATenthOfTheMeanPressureAndAtLeastTenBar) {
  Case the_case = rated();
  for (const double delivery : {275, 50}) {
    the_case.pressure.ports.delivery = pascals(delivery);
    const SteadyState state = hydraulics::steady_state(the_case);
    const auto rows = timing_rows(the_case, state);
    EXPECT_NEAR(*row_of(rows, "overshoot").limit,
                delivery == 275 ? state.summary.delivery_mean * 1e-6 : 10, 1e-9);
    double widest = 0;
    for (const auto& c : state.timing.connected) widest = std::max(widest, c.largest_area);
    EXPECT_GT(widest, 0);
    EXPECT_DOUBLE_EQ(row_of(rows, "connected-area").value, widest * 1e6);
  }
}

// The suction port's drop is largest in mid-suction, where its opening is whole: kidney area and
// the pistons' greatest speed give the flow, the orifice the drop.
TEST(SuctionSpeed, IsThatOfTheOrificesDrop) {
  Case the_case = plain_ports();
  HydraulicData& h = *the_case.hydraulics;
  h.transition_pressure = pascals(1e-3);
  const double limit = pascals(0.4);
  const hydraulics::Network network(the_case);
  const double area = network.suction().area(90);
  const double speed_of_oil =
      std::sqrt(2 * (pascals(1) - limit) / network.fluid().density(pascals(1)));
  const double rpm = h.discharge_coefficient * area * speed_of_oil / (stroke_volume(the_case) / 2) *
                     60 / (2 * kPi);
  for (const double own : {rpm / 3, rpm * 1.1, rpm * 6}) {
    the_case.operation.speed_rpm = own;
    const SuctionSpeed found = suction_speed(the_case, limit);
    ASSERT_TRUE(found.rpm.has_value()) << own;
    EXPECT_NEAR(*found.rpm / rpm, 1, 5e-3);  // the search's 1e-3, and compression
    EXPECT_EQ(suction_speed_row(the_case, found).flagged, own > rpm);
    EXPECT_LE(found.solves, 25);
  }
}

TEST(SuctionSpeed, EndsAtItsBoundsAndWhenAsked) {
  Case the_case = plain_ports();
  const SuctionSpeed never = suction_speed(the_case, pascals(1.5));
  EXPECT_FALSE(never.rpm.has_value());
  EXPECT_NEAR(never.searched_from, 0.05 * 1500, 1e-9);
  const TimingRow row = suction_speed_row(the_case, never);
  EXPECT_TRUE(row.flagged);
  EXPECT_THAT(timing_warnings({row})[0].text, testing::HasSubstr("below a pressure: < 75 rpm"));
  the_case.hydraulics->kidney_height = 1;  // m
  const SuctionSpeed always = suction_speed(the_case, pascals(0.5));
  EXPECT_FALSE(always.rpm.has_value());
  EXPECT_FALSE(suction_speed_row(the_case, always).flagged);
  EXPECT_EQ(suction_speed_row(the_case, always).bound.substr(0, 2), "> ");
  EXPECT_THROW(suction_speed(the_case, 0, [](double) { throw Interrupted(); }), Interrupted);
}

// Oil that is not compressible, no leakage, no way from port to port: what a chamber holds at the
// end of suction is what it delivers.
Case without_losses() {
  Case the_case = plain_ports();
  HydraulicData& h = *the_case.hydraulics;
  h.bulk_modulus = 1e12;
  return the_case;
}

TEST(Filling, IsWhatTheVolumetricEfficiencyLacks) {
  Case the_case = without_losses();
  for (const double rpm : {1000.0, 5000.0}) {
    the_case.operation.speed_rpm = rpm;
    const SteadyState state = hydraulics::steady_state(the_case);
    ASSERT_TRUE(state.timing.filled.has_value());
    const auto& filled = *state.timing.filled;
    EXPECT_NEAR(filled.at_deg, 180, 1e-6);
    EXPECT_NEAR(1 - filled.loss, state.summary.volumetric_efficiency, 2e-4) << rpm;
    // The whole chamber, dead volume included.
    const double full = 1 + the_case.hydraulics->dead_volume / stroke_volume(the_case);
    EXPECT_NEAR(filled.loss, (1 - filled.ratio) * full, 1e-9) << rpm;
  }
}

TEST(Filling, SaysNoWhereChambersAreNotFilledAndYesWhereTheyAre) {
  Case the_case = rated();
  const struct {
    double rpm;
    bool filled;
  } points[] = {{1500, true}, {4600, false}};
  for (const auto& [rpm, filled] : points) {
    the_case.operation.speed_rpm = rpm;
    const SteadyState state = hydraulics::steady_state(the_case);
    const auto rows = timing_rows(the_case, state);
    const TimingRow& row = row_of(rows, "filling");
    EXPECT_EQ(row.flagged, !filled) << rpm;
    EXPECT_EQ(*row.limit, 1);
    EXPECT_EQ(row.text.substr(0, 6), filled ? "filled" : "not fi");
    if (filled) continue;
    // Half of the oil is missing, and so is half of the flow.
    EXPECT_LT(state.summary.volumetric_efficiency, 0.55);
    EXPECT_GT(row.value, 35);
    EXPECT_THAT(timing_warnings(rows),
                testing::Contains(testing::Field(&Warning::name, testing::Eq("filling"))));
    the_case.meant = "filling: it is to starve";
    EXPECT_EQ(row_of(timing_rows(the_case, state), "filling").meant, "it is to starve");
  }
}

// Backwards the oil comes from elsewhere; a port that is never open alone has no end of suction.
TEST(Filling, IsNotJudgedWhereThereIsNoSuctionStroke) {
  Case the_case = plain_ports();
  the_case.hydraulics->load = LoadData{};
  the_case.hydraulics->load->kind = LoadKind::constant_pressure;
  the_case.operation.speed_rpm = -1500;
  const SteadyState state = hydraulics::steady_state(the_case);
  EXPECT_FALSE(state.timing.filled.has_value());
  for (const auto& row : timing_rows(the_case, state)) EXPECT_NE(row.code, "filling");
}

TEST(TimingAnswer, CountsWhatExceedsALimitAndWhatIsMeant) {
  const auto row = [](const char* quantity, bool flagged, const char* meant) {
    TimingRow made;
    made.quantity = quantity;
    made.limit = 1;
    made.flagged = flagged;
    made.meant = meant;
    return made;
  };
  const TimingRow fine = row("fine", false, ""), high = row("high", true, ""),
                  wide = row("wide", true, ""), meant = row("meant", true, "so it is");
  TimingRow unlimited = row("unlimited", false, "");
  unlimited.limit.reset();
  EXPECT_EQ(timing_answer({fine, unlimited}), "Port timing: within all limits.");
  EXPECT_EQ(timing_answer({fine, meant, unlimited}),
            "Port timing: 1 of 2 quantities with a limit does not keep it, as intended.");
  EXPECT_EQ(
      timing_answer({fine, high, wide}),
      "Port timing: 2 of 3 quantities with a limit do not keep it: high, wide (pressure --advise: "
      "what to change).");
  EXPECT_EQ(
      timing_answer({high, meant, fine}),
      "Port timing: 1 of 3 quantities with a limit does not keep it: high; 1 more as intended "
      "(pressure --advise: what to change).");
}

TEST(FillingSpeed, LosesOnePercentAndPressureLimitsNameTheirLoss) {
  Case the_case = rated();
  const SuctionSpeed found = filling_speed(the_case);
  ASSERT_TRUE(found.rpm.has_value());
  const TimingRow row = suction_speed_row(the_case, found);
  EXPECT_EQ(row.code, "filling-speed");
  EXPECT_FALSE(row.flagged);
  // At the speed that is stated, in its four digits, chambers fill, and both verdicts say so.
  EXPECT_EQ(std::round(*found.rpm), *found.rpm);
  the_case.operation.speed_rpm = *found.rpm;
  EXPECT_FALSE(
      row_of(timing_rows(the_case, hydraulics::steady_state(the_case)), "filling").flagged);
  EXPECT_FALSE(suction_speed_row(the_case, filling_speed(the_case)).flagged);
  // A little above it neither does.
  the_case.operation.speed_rpm = *found.rpm * 1.002;
  EXPECT_TRUE(row_of(timing_rows(the_case, hydraulics::steady_state(the_case)), "filling").flagged);
  EXPECT_TRUE(suction_speed_row(the_case, filling_speed(the_case)).flagged);
  the_case = rated();
  for (const auto& [factor, filled] : {std::pair{0.995, true}, {1.005, false}}) {
    the_case.operation.speed_rpm = *found.rpm * factor;
    EXPECT_EQ(hydraulics::steady_state(the_case).timing.filled->loss <= 0.01, filled) << factor;
  }
  // Vapour pressure is first reached where half of the stroke is lost already.
  the_case = rated();
  const HydraulicData& h = *the_case.hydraulics;
  const SuctionSpeed vapour = suction_speed(the_case, h.vapour_pressure - h.atmosphere);
  ASSERT_TRUE(vapour.rpm.has_value());
  EXPECT_GT(*vapour.rpm, *found.rpm);
  EXPECT_THAT(suction_speed_row(the_case, vapour).text, testing::EndsWith(": not filled"));
  // At the case's own speed already lost.
  the_case.operation.speed_rpm = *found.rpm * 1.5;
  EXPECT_TRUE(suction_speed_row(the_case, filling_speed(the_case)).flagged);
}

}  // namespace
}  // namespace bentaxis::study
