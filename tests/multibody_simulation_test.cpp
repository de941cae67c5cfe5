// The multibody model carried through time: against stored trajectories, against its own driven
// evaluation, by its accounts of work and events, and in cases that are hard to end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/results/max_abs.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using multibody::Integrator;
using multibody::SimulationMethod;

std::filesystem::path motion_file(const std::string& name, const std::string& file) {
  return std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion" / name / file;
}

// The first rows of a stored case.
Case stored_case(const std::string& name, int rows) {
  Case the_case = read_case(motion_file(name, "case.toml"));
  DriveSpec& drive = *the_case.drive;
  drive.duration *= static_cast<double>(rows) / drive.samples;
  drive.samples = rows;
  return the_case;
}

Trajectory simulate(const Case& the_case, double accuracy, const SimulationMethod& method = {}) {
  SimulationOptions options;
  options.accuracy = accuracy;
  return multibody::simulate(the_case, the_case.multibody, PressureTrace(the_case.pressure),
                             options, {}, method);
}

// Largest difference from the stored rows: of reactions over the peak of their group, of speeds
// over the largest (under "speed"), and of the lag in rad.
std::map<std::string, double> differences(const Trajectory& run, const std::string& name) {
  const NumericTable stored = read_numeric_csv(motion_file(name, "reference.csv"));
  const MotionTable& table = run.table;
  std::map<std::string, double> off;
  std::map<std::string, double> peak;
  for (std::size_t c = 0; c < stored.header.size(); ++c) {
    const std::string& column = stored.header[c];
    const bool speed = column.find("_rpm") != std::string::npos;
    if (!speed && c < table.state_names.size()) continue;
    std::string group = "speed";
    if (!speed) group = table.results.channels[table.results.find(column)].group;
    for (std::size_t row = 0; row < table.results.rows(); ++row) {
      const double have =
          speed ? table.state(row, c) : table.results.at(row, table.results.find(column));
      update_max_abs(off[group], have - stored.rows[row][c]);
    }
    for (const auto& row : stored.rows) update_max_abs(peak[group], row[c]);
  }
  for (auto& [group, difference] : off) difference /= peak[group];
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    update_max_abs(off["lag"], run.lag[row] - radians(stored.rows[row][1] - stored.rows[row][2]));
  return off;
}

double worst_of(std::map<std::string, double> off) {
  off.erase("lag");
  double worst = 0;
  for (const auto& [group, difference] : off) update_max_abs(worst, difference);
  return worst;
}

struct Stored {
  std::string name;
  int rows;         // before impacts make it sensitive
  double accuracy;  // at which every reaction is within 1e-6 of its peak
  double middle;    // between round-off and errors of the size of the motion
};

class StoredTrajectory : public testing::TestWithParam<Stored> {};

// 1e-6 of peak is asked for.
TEST_P(StoredTrajectory, IsReached) {
  const Trajectory run =
      simulate(stored_case(GetParam().name, GetParam().rows), GetParam().accuracy);
  const auto off = differences(run, GetParam().name);
  EXPECT_GE(off.size(), 11U);
  for (const auto& [group, difference] : off)
    EXPECT_LE(difference, scaled(group == "lag" ? 1e-9 : 1e-6)) << group;
  EXPECT_LE(run.record.drift, 1e-9);
  // Work of some hundred joules.
  EXPECT_LE(run.record.worst_work_residual, scaled(1e-6));
  const std::size_t balance = run.table.results.find("power_balance_W");
  for (std::size_t row = 0; row < run.table.results.rows(); ++row)
    EXPECT_NEAR(run.table.results.at(row, balance), 0, scaled(1e-6)) << row;  // of 45 kW
}

// The error against the steps taken falls by the order of the method.
TEST_P(StoredTrajectory, IsApproachedWithTheOrderOfTheIntegrator) {
  const Stored& stored = GetParam();
  struct Method {
    Integrator integrator;
    double loosen, order;
  };
  for (const Method& method :
       {Method{Integrator::runge_kutta_merson, 1, 4}, Method{Integrator::runge_kutta_3, 30, 3}}) {
    const Case the_case = stored_case(stored.name, stored.rows);
    const SimulationMethod how{method.integrator};
    const Trajectory coarse = simulate(the_case, 100 * method.loosen * stored.middle, how);
    const Trajectory fine = simulate(the_case, method.loosen * stored.middle, how);
    const double gain =
        worst_of(differences(coarse, stored.name)) / worst_of(differences(fine, stored.name));
    // Steps that rows, touches and the 20 edges of a turn ask for have nothing to do with errors.
    const double edges = 20 * fine.table.state(static_cast<std::size_t>(stored.rows), 1) / 360;
    const double landings =
        stored.rows + 2 * (edges + static_cast<double>(fine.record.events.size()));
    const double steps = (static_cast<double>(fine.record.steps) - landings) /
                         (static_cast<double>(coarse.record.steps) - landings);
    EXPECT_NEAR(std::log(gain) / std::log(steps), method.order, 1) << gain << " by " << steps;
    EXPECT_GT(gain, 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, StoredTrajectory,
                         testing::Values(Stored{"constant_torque", 30, 3e-10, 1e-9},
                                         Stored{"motor_driven", 12, 1e-10, 1e-8},
                                         Stored{"rattle", 8, 3e-10, 1e-8}),
                         [](const auto& test) { return test.param.name; });

// Each off by a hundredth of itself shows in the block's speed, which is right to 1e-5 rpm.
TEST(SimulatedMotion, EveryParameterOfMotionActs) {
  const Case the_case = stored_case("motor_driven", 5);
  const Trajectory right = simulate(the_case, 1e-7);
  const auto speed = [&](const Trajectory& run) { return run.table.state(5, 4); };
  const auto moved = [&](const std::function<double&(Case&)>& parameter) {
    Case other = the_case;
    parameter(other) *= 1.01;
    return std::abs(speed(simulate(other, 1e-7)) - speed(right));
  };
  using Parameter = std::function<double&(Case&)>;
  const std::map<std::string, Parameter> parameters = {
      {"torque", [](Case& c) -> double& { return c.drive->torque; }},
      {"slope", [](Case& c) -> double& { return c.drive->motor->torque_slope; }},
      {"rotor", [](Case& c) -> double& { return c.drive->motor->rotor_inertia; }},
      {"coupling stiffness", [](Case& c) -> double& { return c.drive->motor->coupling_stiffness; }},
      {"coupling damping", [](Case& c) -> double& { return c.drive->motor->coupling_damping; }},
      {"tooth stiffness", [](Case& c) -> double& { return c.pump.gear.compliance->stiffness; }},
      {"dissipation", [](Case& c) -> double& { return c.pump.gear.compliance->dissipation; }},
      {"backlash", [](Case& c) -> double& { return c.pump.gear.compliance->backlash; }},
      {"shaft", [](Case& c) -> double& { return c.pump.shaft.axial_inertia; }},
      {"block", [](Case& c) -> double& { return c.pump.block.axial_inertia; }},
      {"Ct", [](Case& c) -> double& { return c.pump.friction.shaft_torque_factor; }}};
  for (const auto& [name, parameter] : parameters) EXPECT_GT(moved(parameter), 1e-4) << name;
}

// A rigid gear at a given speed: the rows are those of the driven model at these angles.
TEST(SimulatedMotion, AtConstantSpeedItIsTheDrivenModel) {
  for (const double rpm : {1500.0, -1500.0}) {
    Case the_case = stored_case("rattle", 20);
    the_case.pump.gear.contact = ToothContact::rigid;
    the_case.operation.speed_rpm = rpm;
    const Trajectory run = simulate(the_case, 1e-8);
    multibody::Model model(the_case.pump, the_case.multibody, rpm);
    std::vector<double> v(model.layout().size());
    for (std::size_t row = 0; row < run.table.results.rows(); ++row) {
      const double theta = run.table.state(row, 1);
      EXPECT_NEAR(theta, rpm * 6 * run.table.state(row, 0), 1e-6);  // 1e-9 m of arc
      EXPECT_NEAR(run.table.state(row, 2), theta, 1e-6);
      model.evaluate(instant_at(the_case, theta, rad_per_second(rpm)), v);
      for (std::size_t c = 0; c < model.layout().reactions(); ++c) {
        const Channel& channel = model.layout().channels()[c];
        EXPECT_NEAR(run.table.results.at(row, c), v[c] / channel.unit_in_si, 2e-2)  // N of 3e4
            << channel.name << " at " << theta;
      }
    }
    EXPECT_TRUE(run.record.events.empty());
  }
}

// A row reports the law and not the branch a step was taken on: at its dead centre a piston is at
// rest, and dry friction that jumps has no force there.
TEST(SimulatedMotion, APistonAtADeadCentreHasNoDryFriction) {
  Case the_case = stored_case("rattle", 80);  // row 40 is half a turn
  the_case.pump.gear.contact = ToothContact::rigid;
  the_case.pump.friction.regularization = 0;
  the_case.pump.geometry.axis_offset = 0;  // a dead centre there, to the last digit
  const Trajectory run = simulate(the_case, 1e-8);
  multibody::Model model(the_case.pump, the_case.multibody, 1);
  std::vector<double> v(model.layout().size());
  const ResultTable& table = run.table.results;
  for (const std::size_t row : {0U, 40U}) {
    Instant i = instant_at(the_case, run.table.state(row, 1), rad_per_second(1500));
    i.turn(row == 0 ? 0 : kPi, rad_per_second(1500));
    model.evaluate(i, v);
    EXPECT_NEAR(table.at(row, table.find("Rs_1_z2_N")), v[model.layout().Rs(0, 2)], 1e-2) << row;
  }
}

// The shaft follows a curve of speed by its own integral; the block follows within the backlash.
TEST(SimulatedMotion, SpeedOverTimeIsFollowedFromRest) {
  Case the_case = stored_case("rattle", 20);
  the_case.drive->curve.time = {0, 0.002, 0.006, 0.02};
  the_case.drive->curve.value = {0, 40, 100, 100};
  const TimeSignal signal(the_case.drive->curve);
  const Trajectory run = simulate(the_case, 1e-7);
  for (std::size_t row = 0; row < run.table.results.rows(); ++row) {
    const double time = run.table.state(row, 0);
    EXPECT_NEAR(radians(run.table.state(row, 1)), signal.integral(time), 1e-10);
    EXPECT_NEAR(run.table.state(row, 3) * kRadPerSecondPerRpm, signal.value(time), 1e-7);
    EXPECT_LT(std::abs(run.lag[row]), 5e-4);
  }
  EXPECT_EQ(run.table.state(0, 4), 0);
  EXPECT_LT(run.record.worst_work_residual, 1e-4);
}

TEST(SimulatedMotion, AMotorStartsFromRestWithItsCouplingUnwound) {
  Case the_case = stored_case("motor_driven", 20);
  the_case.drive->start_speed = 0;
  const Trajectory run = simulate(the_case, 1e-7);
  const std::size_t td = run.table.results.find("Td_z1_Nm");
  EXPECT_EQ(run.table.results.at(0, td), 0);
  for (const std::size_t column : {3U, 4U, 5U}) {
    EXPECT_EQ(run.table.state(0, column), 0);
    EXPECT_GT(run.table.state(20, column), 100);
  }
  EXPECT_GT(run.table.results.at(20, td), 10);
  const TrajectoryRecord& record = run.record;
  EXPECT_GT(record.kinetic_energy_gained, 100);
  EXPECT_LT(record.worst_work_residual, 1e-4);
  EXPECT_NEAR(record.work_of_drives + record.work_of_loads,
              record.kinetic_energy_gained + record.potential_energy_gained, 1e-4);
  // At its own speed the coupling carries the torque from the start.
  const Trajectory turning = simulate(stored_case("motor_driven", 1), 1e-7);
  EXPECT_NEAR(turning.table.results.at(0, td), 292.5, 1e-10);
}

// Torque over speed from points on a line is the slope's law, also in the coupling at the start.
TEST(SimulatedMotion, AMotorsCurveOverSpeedIsItsTorque) {
  Case the_case = stored_case("motor_driven", 3);
  const Trajectory by_slope = simulate(the_case, 1e-7);
  DriveSpec& drive = *the_case.drive;
  for (const double speed : {-50., 0., 120., 300.}) {
    drive.curve.time.push_back(speed);
    drive.curve.value.push_back(drive.torque -
                                drive.motor->torque_slope * (speed - rad_per_second(1500)));
  }
  drive.torque = 0;
  drive.motor->torque_slope = 0;
  const Trajectory by_curve = simulate(the_case, 1e-7);
  EXPECT_GT(by_slope.table.state(3, 5), by_slope.table.state(0, 5) + 0.1);  // rpm
  for (std::size_t row = 0; row <= 3; ++row)
    for (const std::size_t column : {3, 4, 5})
      EXPECT_NEAR(by_curve.table.state(row, column), by_slope.table.state(row, column), 1e-9);
}

// Touches and leavings by turns, the force between them and none outside; the impulse is the
// force's integral.
TEST(SimulatedMotion, EventsTellWhenTeethTouch) {
  Case the_case = stored_case("rattle", 8);
  the_case.drive->samples = 800;
  const Trajectory run = simulate(the_case, 1e-7);
  const auto& events = run.record.events;
  ASSERT_GE(events.size(), 6U);
  const std::size_t rcs = run.table.results.find("Rcs_z4_N");
  const double step = run.table.state(1, 0);
  double apart = run.table.state(800, 0);
  for (std::size_t e = 0; e + 1 < events.size(); e += 2) {
    const ToothEvent& touch = events[e];
    const ToothEvent& leave = events[e + 1];
    ASSERT_TRUE(touch.touch);
    ASSERT_FALSE(leave.touch);
    EXPECT_EQ(touch.flank, leave.flank);
    EXPECT_GT(touch.approach_speed, 0);
    EXPECT_LT(leave.approach_speed, 0);
    // Arm times the difference of the speeds.
    const double arm =
        the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle);
    EXPECT_NEAR(touch.approach_speed, touch.flank * arm * (touch.shaft_speed - touch.block_speed),
                1e-9);
    apart -= leave.time_s - touch.time_s;
    double impulse = 0;
    for (std::size_t row = 0; row < run.table.results.rows(); ++row) {
      const double time = run.table.state(row, 0);
      if (time <= touch.time_s || time >= leave.time_s) continue;
      const double force = run.table.results.at(row, rcs);
      EXPECT_GT(force * touch.flank, 0) << time;
      impulse += std::abs(force) * step;
    }
    EXPECT_NEAR(touch.impulse, impulse, 1e-3 * impulse);
    EXPECT_EQ(leave.impulse, 0);
  }
  if (events.size() % 2 == 1) apart -= run.table.state(800, 0) - events.back().time_s;
  EXPECT_NEAR(run.record.share_out_of_contact, apart / run.table.state(800, 0), 1e-12);
  EXPECT_GT(run.record.share_out_of_contact, 0.5);
}

// Stiffer teeth come nearer to rigid ones on two flanks, in proportion to 1/k.
TEST(SimulatedMotion, RigidTeethAreTheLimitOfStiffOnes) {
  Case the_case = stored_case("rattle", 24);
  the_case.pump.friction.block_viscous = 0.0054 / kRadPerSecondPerRpm;  // keeps the flank loaded
  ToothCompliance& teeth = *the_case.pump.gear.compliance;
  teeth.backlash = 0;
  teeth.dissipation = 20;  // what rings at the start dies out
  Case rigid = the_case;
  rigid.pump.gear.contact = ToothContact::rigid;
  const Trajectory limit = simulate(rigid, 1e-7);
  const auto off = [&](double stiffness) {
    teeth.stiffness = stiffness;
    const Trajectory run = simulate(the_case, 1e-7);
    const std::size_t rcs = run.table.results.find("Rcs_z4_N");
    double worst = 0;
    for (std::size_t row = 14; row <= 24; ++row)
      update_max_abs(worst, run.table.results.at(row, rcs) - limit.table.results.at(row, rcs));
    return worst;
  };
  const double soft = off(1e8);
  const double stiff = off(4e8);
  EXPECT_NEAR(soft / stiff, 4, 0.4);
  EXPECT_LT(soft, 2);  // of some 300 N
}

TEST(SimulatedMotion, SaysHowFarItIsAndEndsAtOne) {
  const Case the_case = stored_case("rattle", 2);
  double done = 0;
  std::size_t calls = 0;
  multibody::simulate(the_case, the_case.multibody, PressureTrace(the_case.pressure), {},
                      [&](double share) {
                        EXPECT_GE(share, done);
                        done = share;
                        ++calls;
                      });
  EXPECT_EQ(done, 1);
  EXPECT_GT(calls, 10U);
}

TEST(SimulatedMotion, RefusesByNameWhatItCannotHave) {
  const auto refused = [](const Case& the_case, const std::string& what) {
    EXPECT_THAT([&] { simulate(the_case, 1e-6); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr(what)));
  };
  const Case torque = stored_case("constant_torque", 2);
  Case c = torque;
  c.pump.piston.contact = 41.5e-3;
  refused(c, "[piston] contact_mm = 41.5");
  c = torque;
  c.drive.reset();
  refused(c, "[drive]");
  c = torque;
  c.pump.friction.regularization = 0;
  refused(c, "regularization_m_per_s = 0");
  c = torque;
  c.pump.shaft.axial_inertia = 0;
  refused(c, "[shaft] axial_inertia_kg_mm2 = 0");
  c = stored_case("rattle", 2);
  c.pump.block.axial_inertia = 0;
  refused(c, "[block] axial_inertia_kg_mm2 = 0");
  c = torque;
  c.multibody.gear = BlockDrive::imposed;
  refused(c, "imposed");
  c = torque;
  c.pump.piston.mass = 0;
  refused(c, "analytic model");
}

// Each ends, and says how.
TEST(HardMotion, TeethWithoutPlayThatTouchAtNoSpeed) {
  Case the_case = stored_case("motor_driven", 10);
  the_case.pump.gear.compliance->backlash = 0;
  the_case.drive->start_speed = 0;
  const Trajectory run = simulate(the_case, 1e-7);
  EXPECT_LT(run.record.share_out_of_contact, 1e-3);  // none but the first instant
  EXPECT_LT(run.record.worst_work_residual, 1e-5);
  for (const ToothEvent& event : run.record.events) EXPECT_LT(std::abs(event.approach_speed), 0.2);
}

TEST(HardMotion, TeethOfHugeStiffness) {
  Case the_case = stored_case("rattle", 4);
  the_case.pump.gear.compliance->stiffness = 1e11;
  const Trajectory run = simulate(the_case, 1e-7);
  EXPECT_GE(run.record.events.size(), 4U);
  EXPECT_LT(run.record.worst_work_residual, 1e-5);
  // It bounces as hard as it came, but for the dissipation.
  for (std::size_t e = 0; e + 1 < run.record.events.size(); e += 2)
    EXPECT_NEAR(-run.record.events[e + 1].approach_speed / run.record.events[e].approach_speed, 1,
                0.1);
}

TEST(HardMotion, OnePistonAtDeadCentreUnderTorque) {
  Case the_case = stored_case("constant_torque", 40);
  the_case.pump.geometry.pistons = 1;
  the_case.drive->start_speed = 0;
  the_case.pump.gravity = 0;
  the_case.drive->torque = 0;
  const Trajectory still = simulate(the_case, 1e-7);
  EXPECT_NEAR(still.table.state(40, 1), 0, 1e-9);
  the_case.drive->torque = 50;
  const Trajectory turned = simulate(the_case, 1e-7);
  EXPECT_GT(turned.table.state(40, 1), 10);
  EXPECT_LT(turned.record.worst_work_residual, 1e-3);
}

TEST(HardMotion, DryFrictionThatJumpsAndPressureThatSteps) {
  Case the_case = stored_case("rattle", 20);
  the_case.pump.friction.regularization = 0;
  the_case.pressure.transition_deg = 0;
  const Trajectory run = simulate(the_case, 1e-7);
  EXPECT_LT(run.record.worst_work_residual, 1e-5);
  EXPECT_LT(run.record.steps, 5000);
}

// Where the pressure jumps steps end: three turns of jumps cost little more than three smooth ones.
TEST(HardMotion, StepsEndAtEdgesOfPressureInEveryTurn) {
  Case the_case = stored_case("rattle", 4);
  the_case.pump.gear.contact = ToothContact::rigid;
  the_case.drive->duration = 0.12;
  const auto steps = [&](double transition_deg) {
    the_case.pressure.transition_deg = transition_deg;
    return simulate(the_case, 1e-7).record.steps;
  };
  const long smooth = steps(20);
  const long jumping = steps(0);
  EXPECT_GE(jumping, 30);  // an edge of five pistons each, twice a turn
  EXPECT_LE(jumping, 2 * smooth);
}

// A pressure over the angle from a file has no edges: smooth all round.
TEST(SimulatedMotion, APressureCurveIsFollowed) {
  Case the_case = stored_case("rattle", 20);
  the_case.pump.gear.contact = ToothContact::rigid;
  const PressureTrace ideal(the_case.pressure);
  PressureSpec curve;
  curve.kind = PressureKind::curve;
  curve.ports = the_case.pressure.ports;
  for (int i = 0; i < 360; ++i) {
    curve.curve.theta_deg.push_back(i);
    curve.curve.pressure.push_back(ideal(i));
  }
  const Trajectory smooth = simulate(the_case, 1e-8);
  the_case.pressure = curve;
  const Trajectory followed = simulate(the_case, 1e-8);
  const ResultTable& table = smooth.table.results;
  for (std::size_t c = 0; c < table.columns(); ++c) {
    if (table.channels[c].kind != ChannelKind::reaction) continue;
    for (std::size_t row = 0; row < table.rows(); ++row)  // the curve is read between its degrees
      EXPECT_NEAR(table.at(row, c), followed.table.results.at(row, c),
                  1e-3 * table.peak(table.channels[c].group))
          << table.channels[c].name << ", row " << row;
  }
}

TEST(HardMotion, WhatWouldNotEndIsGivenUp) {
  const auto gives_up = [](const Case& the_case, long steps, const std::string& what) {
    EXPECT_THAT(
        [&] {
          simulate(the_case, 1e-8, {Integrator::runge_kutta_merson, steps});
        },
        testing::ThrowsMessage<ComputationError>(
            testing::AllOf(testing::HasSubstr("multibody model: simulation stopped at "),
                           testing::HasSubstr(what), testing::HasSubstr("very stiff teeth"))));
  };
  gives_up(stored_case("rattle", 20), 100, "100 steps are used");
  // More speed than the pump's parts would bear.
  Case the_case = stored_case("constant_torque", 2);
  the_case.drive->torque = 1e7;
  the_case.drive->duration = 10;
  gives_up(the_case, 21000, "would take more than 21000");
}

}  // namespace
}  // namespace bentaxis::test
