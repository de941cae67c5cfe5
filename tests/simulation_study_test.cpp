// What a simulation's results say, of results put together by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bentaxis/files/case_file.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/motion_answers.h"
#include "bentaxis/study/simulation.h"
#include "bentaxis/study/simulation_document.h"
#include "bentaxis/study/state_doubts.h"
#include "differences.h"
#include "event_match.h"
#include "pressure_steps.h"

namespace bentaxis::study {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SimulationStudy, ColumnsOfTheOilThatAreCompared) {
  const Case the_case = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_start_up.toml");
  const auto oil = hydraulics::oil_in_time(the_case, {});
  std::map<std::string, Compared> compared;
  for (const OilColumn& column : oil->columns()) compared[column.name] = compared_column(column);
  const auto is = [&](const std::string& name, const std::string& group, const std::string& unit,
                      bool judged) {
    ASSERT_EQ(compared.count(name), 1U) << name;
    EXPECT_EQ(compared[name].group, group) << name;
    EXPECT_EQ(compared[name].unit, unit) << name;
    EXPECT_EQ(compared[name].judged, judged) << name;
  };
  const int pistons = the_case.pump.geometry.pistons;
  for (int k = 1; k <= pistons; ++k) is("p_" + std::to_string(k) + "_bar", "p", "bar", true);
  is("p_delivery_bar", "p_delivery", "bar", true);
  is("p_suction_bar", "p_suction", "bar", true);
  is("flow_suction_l_per_min", "flow_suction", "l/min", false);
  is("flow_delivery_l_per_min", "flow_delivery", "l/min", false);
  is("leakage_l_per_min", "leakage", "l/min", false);
  is("power_useful_W", "", "W", true);
}

TEST(SimulationStudy, EveryColumnOverTimeHasAKnownUnit) {
  const Case the_case =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_motor_start.toml");
  std::vector<Column> columns = state_columns(*the_case.drive);
  ASSERT_EQ(columns.size(), 6U);
  EXPECT_EQ(columns[static_cast<std::size_t>(StateColumn::time)].unit, "s");
  EXPECT_EQ(columns[static_cast<std::size_t>(StateColumn::psi)].name, "psi_deg");
  EXPECT_EQ(columns[static_cast<std::size_t>(StateColumn::shaft_speed)].name, "shaft_rpm");
  EXPECT_EQ(columns[static_cast<std::size_t>(StateColumn::block_speed)].name, "block_rpm");
  EXPECT_EQ(columns[static_cast<std::size_t>(StateColumn::motor_speed)].name, "motor_rpm");
  const Case with_oil = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_start_up.toml");
  for (Column& column : hydraulics::oil_in_time(with_oil, {})->columns())
    columns.push_back(std::move(column));
  for (const Column& column : columns) {
    ASSERT_NE(find_unit_of_measure(column.unit), nullptr) << column.name;
    EXPECT_FALSE(column.meaning.empty()) << column.name;
  }
}

TEST(SimulationStudy, RowsAreJudgedUntilADisturbanceHasGrownTooLarge) {
  const std::vector<double> growth = {1, 30, 1000, 1200, 5};
  EXPECT_EQ(judged_rows(growth, 1e-5, 1e-9), 5U);
  EXPECT_EQ(judged_rows(growth, 0.1 / 1100, 1e-9), 3U);
  EXPECT_EQ(judged_rows(growth, 1e-9, 0.1 / 1100), 3U);  // the disturbance itself
  EXPECT_EQ(judged_rows(growth, 0.0033, 1e-9), 2U);
  EXPECT_EQ(judged_rows(growth, 0.0034, 1e-9), 1U);
  EXPECT_EQ(judged_rows(growth, 0.1, 1e-9), 1U);  // the limit itself is judged
  EXPECT_EQ(judged_rows({1}, 1e-9, 0.1), 1U);
  EXPECT_EQ(judged_rows(growth, 0.1001, 1e-9), 0U);
  EXPECT_EQ(judged_rows({}, 1e-6, 1e-9), 0U);
}

ToothEvent touch(double time_s, int flank, double impulse) {
  ToothEvent event;
  event.time_s = time_s;
  event.flank = flank;
  event.impulse = impulse;
  return event;
}

TEST(SimulationStudy, TouchesThatBelongTogether) {
  ToothEvent leaves = touch(2.5, 1, 0);
  leaves.touch = false;
  const EventMatch match =
      match_events({touch(1, 1, 8), touch(2, -1, 5), leaves, touch(3, 1, 2), touch(9, 1, 50)},
                   {touch(1.25, 1, 7), touch(1.875, -1, 6), leaves, touch(3.5, 1, 0)}, 3.5);
  EXPECT_EQ(match.touches[0], 3U);
  EXPECT_EQ(match.touches[1], 3U);  // the end itself counts
  EXPECT_EQ(match.matched, 3U);
  EXPECT_EQ(match.time_s, 0.5);
  EXPECT_EQ(match.impulse, 2.0 / 8);
  EXPECT_EQ(match.mean_impulse[0], 5);
  EXPECT_EQ(match.largest_impulse[0], 8);
  EXPECT_DOUBLE_EQ(match.mean_impulse[1], 13.0 / 3);
  EXPECT_EQ(match.largest_impulse[1], 7);
}

TEST(SimulationStudy, ATouchThatOneModelLacksMatchesNone) {
  // Of the other flank; of the same one, but the next is nearer; in either model.
  const std::vector<ToothEvent> few = {touch(1, 1, 4), touch(3, 1, 4)};
  const std::vector<ToothEvent> flank = {touch(1, 1, 4), touch(2, -1, 4), touch(3.125, 1, 4)};
  const std::vector<ToothEvent> twice = {touch(0.5, 1, 4), touch(1.125, 1, 3), touch(3, 1, 4)};
  for (const auto* more : {&flank, &twice}) {
    for (const EventMatch& match : {match_events(few, *more, 5), match_events(*more, few, 5)}) {
      EXPECT_EQ(match.matched, 2U);
      EXPECT_EQ(match.time_s, 0.125);
      EXPECT_EQ(match.impulse, more == &twice ? 0.25 : 0);
    }
  }
  // As near is not nearer; what follows on the other flank is none of it.
  EXPECT_EQ(match_events({touch(2, 1, 4)}, {touch(1.5, 1, 4), touch(2.5, 1, 2)}, 5).impulse, 0);
  EXPECT_EQ(match_events({touch(2, 1, 4)}, {touch(1.5, 1, 4), touch(2.25, -1, 2)}, 5).time_s, 0.5);
  const EventMatch none = match_events({}, {touch(1, 1, 4)}, 5);
  EXPECT_EQ(none.matched, 0U);
  EXPECT_EQ(none.touches[1], 1U);
  EXPECT_EQ(none.mean_impulse[0], 0);
}

TEST(SimulationStudy, TimeForAnErrorLiesBetweenTheEfforts) {
  SimulationResult r;
  const auto add = [&](Model model, double error, double seconds) {
    Effort effort{model, "", 0, error, seconds, 0, 0};
    r.effort.push_back(effort);
  };
  add(Model::analytic, 1e-2, 1);
  add(Model::analytic, 1e-4, 2);
  add(Model::analytic, 1e-8, 32);
  add(Model::analytic, 0, 1e-3);
  add(Model::analytic, not_computed(), 1e-3);
  add(Model::multibody, 1e-5, 7);
  // Straight in logarithms: a quarter of the way from 1e-4 to 1e-8 is 2 x 16^(1/4).
  EXPECT_NEAR(r.seconds_for(Model::analytic, 1e-5), 4, 1e-12);
  EXPECT_NEAR(r.seconds_for(Model::analytic, 1e-7), 16, 1e-12);
  EXPECT_EQ(r.seconds_for(Model::analytic, 1e-4), 2);
  EXPECT_EQ(r.seconds_for(Model::analytic, 0.5), 1);
  EXPECT_FALSE(is_computed(r.seconds_for(Model::analytic, 1e-9)));
  EXPECT_EQ(r.seconds_for(Model::multibody, 1e-4), 7);
  EXPECT_FALSE(is_computed(r.seconds_for(Model::multibody, 1e-6)));
  add(Model::multibody, 1e-3, 9);  // slower and worse
  EXPECT_EQ(r.seconds_for(Model::multibody, 1e-4), 7);
}

SimulationResult result(double of_allowed, double judged_until_s) {
  SimulationResult r;
  r.ready.the_case.drive.emplace();
  r.ready.the_case.drive->duration = 2.5;
  r.judged_until_s = judged_until_s;
  r.growth = {1, 37};
  GroupDifference group;
  group.group = "Rs";
  group.in_time = 3e-7;
  group.time_s = group.allowed_s = 0.75;
  group.of_allowed = of_allowed;
  r.groups = {group};
  return r;
}

TEST(SimulationStudy, HeadlineOfBothModels) {
  EXPECT_EQ(result(0.25, 2.5).headline(),
            "The trajectories agree: largest difference 3.0e-07 of peak (Rs, at 0.75 s), 0.25 of "
            "the tolerance (1e-06 of peak times the measured amplification of disturbances); "
            "disturbances of the initial state are amplified 37 times");
  EXPECT_TRUE(result(1, 2.5).agrees());
  EXPECT_FALSE(result(1.0001, 2.5).agrees());
  EXPECT_THAT(result(1.5, 2.5).headline(), HasSubstr("The models differ: "));
  EXPECT_THAT(result(0.5, 1.25).headline(),
              HasSubstr(". Results after 1.25 s are not compared: disturbances are amplified "
                        "4e+01 times by the end"));
  EXPECT_THAT(result(0.5, 2.5 * (1 - 5e-13)).headline(), Not(HasSubstr("are not compared")));
  EXPECT_THAT(result(0.5, 2.5 * (1 - 2e-12)).headline(), HasSubstr("are not compared"));
  SimulationResult r = result(0.5, 2.5);
  r.checks = {{"multibody", "work", "J", 6, 0, 2, 1}, {"analytic", "power", "W", 1, 0, 2, 1}};
  // The motions agree: what failed comes first, and no group that agrees is said to differ.
  EXPECT_THAT(r.headline(),
              testing::StartsWith("A check fails: multibody: work is 3.0e+00 of its scale, 1 "
                                  "allowed. The motions agree: largest difference"));
  EXPECT_THAT(r.headline(), Not(HasSubstr("models differ")));
  EXPECT_THAT(r.headline(), Not(HasSubstr("power")));
  EXPECT_FALSE(r.agrees());
  r.groups.clear();
  EXPECT_EQ(r.worst(), nullptr);
  EXPECT_THAT(r.headline(), HasSubstr("The models cannot be compared"));
  r.checks.clear();
  EXPECT_FALSE(r.agrees());
  r.choice.only = Model::analytic;
  EXPECT_TRUE(r.agrees());
  EXPECT_EQ(r.headline(), "2.5 s simulated by the analytic model; work and power balance");
  r.checks = {{"analytic", "power", "W", 3, 0, 2, 1}};
  EXPECT_EQ(r.headline(),
            "2.5 s simulated by the analytic model; work and power do not balance. A check fails: "
            "analytic: power is 1.5e+00 of its scale, 1 allowed");
}

// Disturbances grow: what exceeds its tolerance most need not be the largest difference.
TEST(SimulationStudy, HeadlineStatesTheLargestDifference) {
  SimulationResult r = result(0.25, 2.5);
  GroupDifference late;
  late.group = "Fh";
  late.in_time = 4e-5;
  late.time_s = late.allowed_s = 2.25;
  late.of_allowed = 0.125;
  GroupDifference flow = late;
  flow.group = "leakage";
  flow.in_time = 0.5;
  flow.judged = false;
  flow.of_allowed = not_computed();
  r.groups = {late, flow, r.groups[0]};
  sort_groups(r.groups);
  EXPECT_EQ(r.worst()->group, "Rs");
  EXPECT_EQ(r.largest()->group, "Fh");
  EXPECT_THAT(r.headline(),
              testing::StartsWith(
                  "The trajectories agree: largest difference 4.0e-05 of peak (Fh, at 2.25 s), at "
                  "most 0.25 of the tolerance (Rs, at 0.75 s; 1e-06 of peak times the measured "
                  "amplification of disturbances); disturbances"));
  // Of one group too: its largest difference is later than that over its tolerance.
  r = result(0.25, 2.5);
  r.groups[0].allowed_s = 0.5;
  EXPECT_THAT(r.headline(),
              HasSubstr("(Rs, at 0.75 s), at most 0.25 of the tolerance (Rs, at 0.5"));
}

TEST(SimulationStudy, HeadlineCountsTheRowsBetweenSteps) {
  SimulationResult r = result(0.25, 2.5);
  r.analytic.emplace().lag.assign(8, 0);
  EXPECT_THAT(r.headline(), Not(HasSubstr("Not compared")));
  r.rows_at_steps = 3;
  const char* const said =
      "ot compared: 3 of 8 rows, at which the models stand on different sides of a step of the "
      "pressure";
  EXPECT_THAT(r.headline(), testing::EndsWith(said));
  r.rows_at_steps = 8;
  r.groups.clear();
  EXPECT_THAT(r.headline(), testing::StartsWith("The models cannot be compared. Not compared: 8"));
}

TEST(SimulationStudy, HeadlineOfAPeriodicMotion) {
  SimulationResult r = result(0.5, 2.5);
  r.choice.steady = true;
  PeriodicMotion motion;
  motion.speed = 1500 * kRadPerSecondPerRpm;
  motion.multipliers = {{0.3, -0.4}, 0.1};
  EXPECT_TRUE(motion.stable());
  r.periodic[1] = motion;
  EXPECT_EQ(r.headline(),
            "Both models find the same periodic motion: largest difference 3.0e-07 of peak (Rs), "
            "1e-06 allowed; 1500 rpm, stable: a disturbance is multiplied by 0.5 per N-th of "
            "a turn");
  motion.multipliers = {1};
  EXPECT_FALSE(motion.stable());
  motion.speed *= 2;
  r.periodic[0] = motion;  // the analytic one where both are
  EXPECT_THAT(r.headline(), HasSubstr("3000 rpm, unstable: a disturbance is multiplied by 1 per"));
  r.groups[0].of_allowed = 2;
  EXPECT_THAT(r.headline(), HasSubstr("The periodic motions differ: "));
  r.groups[0].of_allowed = 0.5;
  r.checks = {{"both", "period", "s", 6, 0, 2, 1}};
  EXPECT_THAT(r.headline(), testing::StartsWith("A check fails: both: period is 3.0e+00 of its "
                                                "scale, 1 allowed; 3000 rpm"));
  r.checks.clear();
  r.periodic[0]->multipliers.clear();
  EXPECT_TRUE(r.periodic[0]->stable());
  r.choice.only = Model::analytic;
  EXPECT_EQ(r.headline(),
            "periodic motion of the analytic model found: 3000 rpm, without states that could be "
            "disturbed");
}

// A value that is missing or not finite in either run is no agreement, whatever the others say.
TEST(SimulationStudy, AMissingValueIsNoAgreement) {
  const ChannelLayout layout(3);
  DriveSpec drive;
  Trajectory run;
  run.table = trajectory_table("analytic", layout, drive);
  for (const double time : {0.0, 0.5, 1.0}) {
    std::vector<double> state(run.table.state_names.size(), 0);
    state[0] = time;
    append_trajectory_row(run.table, state, std::vector<double>(layout.size(), 100), {});
    run.lag.push_back(0);
  }
  const std::vector<double> allowed(3, 1e-6);
  std::map<std::string, double> scales;
  for (const Channel& channel : layout.channels()) scales[channel.group] = 1000;
  const auto judged = [&](const Trajectory& first, const Trajectory& second,
                          const Trajectory* turned) {
    SimulationResult r = result(0, 2.5);
    r.groups = group_differences(first, second, turned, scales, allowed);
    sort_groups(r.groups);
    return r;
  };
  EXPECT_TRUE(judged(run, run, &run).agrees());
  EXPECT_EQ(judged(run, run, &run).worst()->over_angle, 0);
  const std::size_t columns = run.table.results.columns();
  const std::size_t place = columns + run.table.results.find("Rcs_z4_N");
  Trajectory off = run;
  off.table.results.values[place] += 0.01;
  EXPECT_FALSE(judged(run, off, nullptr).agrees());
  EXPECT_NEAR(judged(run, off, nullptr).worst()->of_allowed, 10, 1e-6);
  for (const double wrong : {not_computed(), HUGE_VAL, -HUGE_VAL}) {
    Trajectory other = run;
    other.table.results.values[place] = wrong;
    for (const auto& [first, second] : {std::pair{&run, &other}, std::pair{&other, &run},
                                        std::pair{&other, &other}, std::pair{&off, &other}}) {
      const SimulationResult r = judged(*first, *second, nullptr);
      EXPECT_FALSE(r.agrees()) << wrong;
      EXPECT_EQ(r.worst()->group, "Rcs");
      EXPECT_EQ(r.worst()->time_s, 0.5);
      EXPECT_EQ(r.headline(),
                "The models cannot be compared: at 0.5 s a value of Rcs is missing "
                "or not finite");
    }
    for (const GroupDifference& group : judged(run, run, &other).groups)
      EXPECT_EQ(is_computed(group.over_angle), group.group != "Rcs") << group.group;
  }
  // What the first run leaves at 0, and nothing else gives a scale, differs from anything else.
  scales["Rcs"] = 0;
  Trajectory idle = run;
  idle.table.results.values[place] = 0;
  const SimulationResult r = judged(idle, run, nullptr);
  EXPECT_FALSE(r.agrees());
  EXPECT_EQ(r.worst()->group, "Rcs");
}

// Runs of one row per angle of the block, deg, in which every chamber has the pressure of a trace;
// Rs follows it.
Case stepped_case() {
  return read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_motor_start.toml",
                   {"pressure.transition_deg=0"});
}
Trajectory run_at_angles(const Case& the_case, const std::vector<double>& block_deg) {
  const ChannelLayout at(the_case.pump);
  const PressureTrace pressure(the_case.pressure);
  Trajectory run;
  run.table = trajectory_table("analytic", at, *the_case.drive);
  for (const double angle : block_deg) {
    std::vector<double> state(run.table.state_names.size(), 0);
    state[static_cast<std::size_t>(StateColumn::time)] = 0.5 * static_cast<double>(run.lag.size());
    state[static_cast<std::size_t>(StateColumn::psi)] = angle;
    std::vector<double> values(at.size(), 0);
    for (int k = 0; k < at.pistons(); ++k)
      values[at.pressure(k)] = values[at.Rs(k, 2)] =
          pressure(piston_angle_deg(angle, k + 1, at.pistons()));
    append_trajectory_row(run.table, state, values, {});
    run.lag.push_back(0);
  }
  return run;
}

TEST(PressureSteps, AreWhereRunsStandOnDifferentSides) {
  const Case the_case = stepped_case();
  const PressureSteps steps(the_case.pressure, the_case.pump);
  const auto between = [&](double first, double second, double angle_error) {
    return steps.between(run_at_angles(the_case, {first}), run_at_angles(the_case, {second}), 0,
                         angle_error);
  };
  constexpr double kError = 1e-6;  // rad, 5.7e-5 deg
  // Piston 1 steps at 0 and 180 deg, piston 2 at 72 deg later.
  for (const double edge : {0.0, 180.0, 72.0, 360.0 * 50 + 180}) {
    EXPECT_TRUE(between(edge - 1e-5, edge + 1e-5, kError)) << edge;
    EXPECT_TRUE(between(edge + 1e-5, edge - 1e-5, kError)) << edge;
    EXPECT_FALSE(between(edge - 1e-5, edge - 2e-5, kError)) << edge << ": on one side";
    EXPECT_FALSE(between(edge - 1e-4, edge + 1e-5, kError)) << edge << ": too far for an error";
    EXPECT_FALSE(between(edge - 1e-5, edge + 1e-4, kError)) << edge;
    EXPECT_TRUE(between(edge - 1e-4, edge + 1e-4, 1e-5)) << edge;
  }
  EXPECT_FALSE(between(30, 31, kError));
  EXPECT_FALSE(PressureSteps().between(run_at_angles(the_case, {-1e-5}),
                                       run_at_angles(the_case, {1e-5}), 0, kError));
  // A smooth rise has no step, however steep.
  const Case smooth = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_motor_start.toml",
                                {"pressure.transition_deg=1e-3"});
  EXPECT_FALSE(
      PressureSteps(smooth.pressure, smooth.pump)
          .between(run_at_angles(smooth, {179.9999}), run_at_angles(smooth, {180.0001}), 0, 1e-5));
}

// Simbody may stand on an edge, or a hair before it, and have the pressure behind it.
TEST(PressureSteps, AModelOnAnEdgeMayHaveEitherPressure) {
  const Case the_case = stepped_case();
  const PressureSteps steps(the_case.pressure, the_case.pump);
  const auto at = [&](double angle, double side) {
    Trajectory run = run_at_angles(the_case, {side});
    run.table.states[static_cast<std::size_t>(StateColumn::psi)] = angle;
    return run;
  };
  EXPECT_TRUE(steps.between(at(180, 179), at(180, 181), 0, 0));
  EXPECT_TRUE(steps.between(at(180, 179), at(180 - 1e-10, 181), 0, 0));
  EXPECT_TRUE(steps.between(at(180 + 1e-10, 179), at(180, 181), 0, 0));
  // Not where it is off the edge: that is a wrong pressure.
  EXPECT_FALSE(steps.between(at(180 - 1e-6, 179), at(180 - 1e-6, 181), 0, 1e-6));
  EXPECT_FALSE(steps.between(at(180 + 1e-6, 179), at(180 + 1e-6, 181), 0, 1e-6));
}

TEST(PressureSteps, AWrongPressureIsFound) {
  const Case the_case = stepped_case();
  const PressureSteps steps(the_case.pressure, the_case.pump);
  const ChannelLayout at(the_case.pump);
  const Trajectory first = run_at_angles(the_case, {20, 180 - 1e-5, 200, 180 - 1e-5});
  const Trajectory second = run_at_angles(the_case, {20, 180 + 1e-5, 200, 180 - 1e-5});
  const std::vector<double> allowed(4, 1e-6);
  const Scales scales = scales_of(the_case, first, 1e-6);
  const auto worst = [&](const Trajectory& other, const PressureSteps& known) {
    SimulationResult r = result(0, 2.5);
    r.groups = group_differences(first, other, &first, scales, allowed, known);
    sort_groups(r.groups);
    return *r.worst();
  };
  EXPECT_EQ(worst(second, steps).in_time, 0);
  EXPECT_EQ(worst(second, steps).over_angle, 0);
  // Were it compared, the step would be the difference.
  EXPECT_GT(worst(second, {}).of_allowed, 1e5);
  EXPECT_EQ(worst(second, {}).time_s, 0.5);
  // Wrong away from the step; at the step in another chamber, or by another value; or where both
  // runs stand on one side of it.
  const auto spoilt = [&](std::size_t row, int piston, double factor) {
    Trajectory other = second;
    for (const std::size_t c : {at.pressure(piston), at.Rs(piston, 2)})
      other.table.results.values[row * other.table.results.columns() + c] =
          factor * 1e7 / other.table.results.channels[c].unit_in_si;
    return other;
  };
  for (const auto& [row, piston] :
       {std::pair<std::size_t, int>{0, 0}, {2, 3}, {1, 1}, {1, 0}, {3, 0}}) {
    EXPECT_GT(worst(spoilt(row, piston, 1.25), steps).of_allowed, 1e3) << row << " " << piston;
    EXPECT_EQ(worst(spoilt(row, piston, 1.25), steps).allowed_s, 0.5 * static_cast<double>(row));
  }
}

// A run put together by hand: two rows, of a pump whose teeth give way.
SimulationResult written(double speed_rpm, double fastest_rpm) {
  SimulationResult r = result(0.5, 2.5);
  r.ready.the_case = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_tooth_rattle.toml");
  r.ready.the_case.operation.speed_rpm = speed_rpm;
  r.choice.only = Model::analytic;
  r.oil_follows = true;
  const int pistons = r.ready.the_case.pump.geometry.pistons;
  Trajectory run;
  run.table = trajectory_table("analytic", ChannelLayout(pistons), *r.ready.the_case.drive);
  run.oil.emplace();
  for (int k = 0; k < pistons; ++k) run.oil->columns.push_back({"p_1_bar", "pressure"});
  for (const double rpm : {speed_rpm, fastest_rpm}) {
    std::vector<double> state(run.table.state_names.size(), 0);
    state[3] = rpm;
    append_trajectory_row(run.table, state, std::vector<double>(ChannelLayout(pistons).size(), 0),
                          {});
    run.lag.push_back(0);
    run.oil->values.insert(run.oil->values.end(), run.oil->columns.size(), 10);
  }
  run.record.share_out_of_contact = 0.125;
  r.analytic = run;
  return r;
}

TEST(SimulationDocument, SaysWhereTheShaftRunsAway) {
  const auto said = [](double speed_rpm, double fastest_rpm) {
    std::vector<std::string> names;
    const report::Document document = simulation_document(written(speed_rpm, fastest_rpm), {}, {});
    for (const auto& warning : *document.warnings) names.push_back(warning.name);
    return names;
  };
  EXPECT_THAT(said(1500, 4400), testing::IsEmpty());
  EXPECT_THAT(said(1500, -4600), testing::ElementsAre("course-overspeed"));
  EXPECT_THAT(said(-0.5, 1.6), testing::ElementsAre("course-overspeed"));
  EXPECT_THAT(said(0, 1.6), testing::IsEmpty());  // from rest nothing is usual
}

// A run of which only the shaft's speed, the drive torque, the delivery pressure and the point of
// the film force are set, by row at 0, 0.1, .. s.
struct Row {
  double rpm, torque, delivery_bar, xh_mm;
};
Trajectory run_of(const Case& the_case, const std::vector<Row>& rows) {
  const ChannelLayout layout(the_case.pump.geometry.pistons);
  Trajectory run;
  run.table = trajectory_table("analytic", layout, *the_case.drive);
  run.oil.emplace();
  run.oil->columns.push_back({"p_delivery_bar", "pressure"});
  for (const Row& row : rows) {
    std::vector<double> state(run.table.state_names.size(), 0);
    state[static_cast<std::size_t>(StateColumn::time)] = 0.1 * static_cast<double>(run.lag.size());
    state[static_cast<std::size_t>(StateColumn::shaft_speed)] = row.rpm;
    std::vector<double> values(layout.size(), 0);
    values[layout.Td()] = row.torque;
    values[layout.xh()] = row.xh_mm / 1e3;
    append_trajectory_row(run.table, state, values, {});
    run.lag.push_back(0);
    run.oil->values.push_back(row.delivery_bar);
  }
  run.record.work_of_drives = 1234;
  return run;
}

TEST(MotionAnswers, AreThoseOfTheRows) {
  const Case the_case = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_start_up.toml");
  const double plate = the_case.pump.port_plate->r4 * 1e3;
  // 95 % of 1000 rpm is passed on the way up, lost again, and made for good after 0.3 s.
  const MotionAnswers a = motion_answers(run_of(the_case, {{0, 5, 0, 0},
                                                           {960, -80, 120, plate + 1},
                                                           {900, 20, 300, plate + 3},
                                                           {940, 20, 250, plate - 1},
                                                           {1040, 20, 210, 0},
                                                           {1000, 20, 200, -plate - 2}}),
                                         the_case);
  EXPECT_EQ(a.first_rpm, 0);
  EXPECT_EQ(a.last_rpm, 1000);
  ASSERT_TRUE(a.reached_s.has_value());
  EXPECT_NEAR(*a.reached_s, 0.31, 1e-12);
  EXPECT_NEAR(a.largest_torque, -80, 1e-12);
  EXPECT_NEAR(a.largest_torque_s, 0.1, 1e-15);
  EXPECT_EQ(a.drive_work, 1234);
  ASSERT_TRUE(a.delivery.has_value());
  EXPECT_EQ(a.delivery->highest_bar, 300);
  EXPECT_NEAR(a.delivery->highest_s, 0.2, 1e-15);
  EXPECT_EQ(a.delivery->end_bar, 200);
  ASSERT_TRUE(a.beyond_plate.has_value());
  EXPECT_EQ(a.beyond_plate->share, 0.5);
  EXPECT_NEAR(a.beyond_plate->largest_mm, plate + 3, 1e-9);
  EXPECT_NEAR(a.beyond_plate->largest_s, 0.2, 1e-15);
  EXPECT_NEAR(a.beyond_plate->plate_mm, plate, 1e-12);
}

// Speed over time, s -> rpm, at 4000 rows a second; the angle follows from it.
Trajectory run_at(const Case& the_case, double seconds, const std::function<double(double)>& rpm) {
  Trajectory run;
  run.table = trajectory_table("analytic", ChannelLayout(the_case.pump), *the_case.drive);
  const std::vector<double> values(ChannelLayout(the_case.pump).size(), 0);
  constexpr double kStep = 1 / 4000.0;
  double theta = 0;
  for (int i = 0; i * kStep <= seconds; ++i) {
    std::vector<double> state(run.table.state_names.size(), 0);
    state[static_cast<std::size_t>(StateColumn::time)] = i * kStep;
    state[static_cast<std::size_t>(StateColumn::shaft_speed)] = rpm(i * kStep);
    state[static_cast<std::size_t>(StateColumn::theta)] = theta;
    theta += 6 * rpm((i + 0.5) * kStep) * kStep;
    append_trajectory_row(run.table, state, values, {});
    run.lag.push_back(0);
  }
  return run;
}

// The instant at which a simulation ends decides nothing: the pistons let the speed ripple.
TEST(MotionAnswers, SpeedAtTheEndIsAMean) {
  const Case the_case = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_start_up.toml");
  const double frequency = the_case.pump.geometry.pistons * 2000.0 / 60;
  const auto rpm = [&](double time) {
    return 2000 - 500 * std::exp(-time / 0.01) + 8 * std::sin(2 * kPi * frequency * time);
  };
  for (const double seconds : {0.098, 0.0985, 0.099, 0.0995, 0.1}) {
    const MotionAnswers a = motion_answers(run_at(the_case, seconds, rpm), the_case);
    EXPECT_NEAR(a.end_rpm, 2000, 0.5) << seconds;
    ASSERT_TRUE(a.reached_s.has_value());
    EXPECT_NEAR(*a.reached_s, 0.03, 0.004);
    EXPECT_TRUE(a.settled);
  }
  const auto accelerating = [](double time) { return 1800 * time; };
  const MotionAnswers a = motion_answers(run_at(the_case, 0.1, accelerating), the_case);
  EXPECT_FALSE(a.settled);
  EXPECT_EQ(a.end_rpm, a.last_rpm) << "not a part of a turn yet";
  // A ripple above a twentieth of the change: the speed is never near its mean for good.
  const auto rippling = [&](double time) {
    return 2000 - (time < 0.01 ? 20 : 0) + 8 * std::sin(2 * kPi * frequency * time);
  };
  for (const double seconds : {0.0976, 0.0984, 0.0993})
    EXPECT_FALSE(
        motion_answers(run_at(the_case, seconds, rippling), the_case).reached_s.has_value());
}

TEST(MotionAnswers, SayThatTheShaftTurnsBackwards) {
  const Case the_case = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_start_up.toml");
  const auto backwards = [&](const std::vector<double>& speeds) {
    std::vector<Row> rows;
    for (const double rpm : speeds) rows.push_back({rpm, 1, 0, 0});
    return motion_answers(run_of(the_case, rows), the_case).backwards;
  };
  const auto found = backwards({0, -100, -300, -50, 1000});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->rpm, -300);
  EXPECT_NEAR(found->at_s, 0.2, 1e-15);
  EXPECT_TRUE(backwards({0, 100, -1000}).has_value());
  EXPECT_FALSE(backwards({0, -49, 1000}).has_value());      // hardly
  EXPECT_FALSE(backwards({-500, -300, 1000}).has_value());  // a reversal
  EXPECT_FALSE(backwards({0, 500, 1000}).has_value());
  EXPECT_FALSE(backwards({100, -10, 0}).has_value());  // stops
}

TEST(MotionAnswers, SayWhichWallIsLoadedMostAndWhenNoneIs) {
  const Case the_case =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_tapered_pistons.toml",
                {"drive.kind=speed", "drive.duration_s=1", "drive.samples=4"});
  const ChannelLayout at(the_case.pump);
  Trajectory run;
  run.table = trajectory_table("analytic", at, *the_case.drive);
  const double forces[4][2] = {{30, 40}, {0, 0}, {300, -400}, {5, 0}};
  for (int row = 0; row < 4; ++row) {
    std::vector<double> state(run.table.state_names.size(), 0);
    state[static_cast<std::size_t>(StateColumn::time)] = 0.1 * row;
    std::vector<double> values(at.size(), 0);
    for (int axis = 0; axis < 2; ++axis) values[at.Rw(row, axis)] = forces[row][axis];
    append_trajectory_row(run.table, state, values, {});
    run.lag.push_back(0.01 * (row + 1));
  }
  const MotionAnswers answers = motion_answers(run, the_case);
  ASSERT_TRUE(answers.walls.has_value());
  EXPECT_NEAR(answers.walls->largest_N, 500, 1e-12);
  EXPECT_NEAR(answers.walls->largest_s, 0.2, 1e-15);
  EXPECT_EQ(answers.walls->piston, 3);
  EXPECT_EQ(answers.walls->loose, 0.25);
  EXPECT_NEAR(answers.walls->lag_deg[0], 0.01 / kRadPerDegree, 1e-12);
  EXPECT_NEAR(answers.walls->lag_deg[1], 0.04 / kRadPerDegree, 1e-12);
}

TEST(MotionAnswers, SayNothingOfWhatIsNotThere) {
  Case the_case = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_start_up.toml");
  const double plate = the_case.pump.port_plate->r4 * 1e3;
  Trajectory run = run_of(the_case, {{1500, 1, 0, plate}, {1460, 1, 0, 0}, {1490, 1, 0, 0}});
  EXPECT_FALSE(motion_answers(run, the_case).reached_s.has_value());  // 0.7 % of its speed
  EXPECT_FALSE(motion_answers(run, the_case).beyond_plate.has_value());
  run.oil.reset();
  EXPECT_FALSE(motion_answers(run, the_case).delivery.has_value());
  EXPECT_FALSE(motion_answers(run, the_case).walls.has_value());
  // What slows down makes a change too; it may begin where it has made it.
  const auto falling =
      motion_answers(run_of(the_case, {{1500, 0, 0, 0}, {500, 0, 0, 0}}), the_case);
  EXPECT_NEAR(falling.reached_s.value(), 0.095, 1e-12);
  run = run_of(the_case, {{1500, 1, 0, plate + 1}, {500, 1, 0, plate + 1}});
  EXPECT_EQ(motion_answers(run, the_case).beyond_plate.value().share, 1);
  the_case.pump.port_plate.reset();
  EXPECT_FALSE(motion_answers(run, the_case).beyond_plate.has_value());
}

TEST(SimulationDocument, ShowsContactAndEffort) {
  SimulationResult r = written(1500, 1500);
  r.effort = {{Model::analytic, "steps", 1e-6, 1e-7, 2, 10, 20}};
  const std::string text = report::compact_json(simulation_document(r, {}, {}));
  EXPECT_THAT(text, HasSubstr("share of the time out of contact"));
  EXPECT_THAT(text, HasSubstr("\"12.5 %\""));
  const auto at = text.find("\"label\":\"time of the run\"");
  ASSERT_NE(at, std::string::npos);
  const std::string axis =
      text.substr(text.rfind('{', at), text.find('}', at) - text.rfind('{', at));
  EXPECT_THAT(axis, HasSubstr("\"log\":true"));
}

TEST(StateDoubts, NameBothPressures) {
  States states;
  states.pistons = 1;
  states.motion.resize(1);
  states.chamber_pressure = {-1.1e5};
  const auto warnings = state_doubts(Case{}, states);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].name, "states-vacuum");
  EXPECT_THAT(warnings[0].text,
              testing::ContainsRegex("-1\\.1 bar is below absolute zero, -1\\.01[0-9]+ bar gauge"));
}

TEST(SimulationStudy, PeriodicOilWithoutOilIsRefused) {
  Case the_case;
  the_case.drive.emplace();
  SimulationChoice choice;
  choice.oil = OilInTime::periodic;
  EXPECT_THROW(prepare_simulation(the_case, choice), InputError);
}

}  // namespace
}  // namespace bentaxis::study
