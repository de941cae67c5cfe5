// From one communication point to the next: as the simulation without them, and under what changes.
#include "bentaxis/coupled/stepper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/pump/time_signal.h"
#include "pump_in_time.h"

namespace bentaxis::test {
namespace {

constexpr double kTolerance = 1e-9;
constexpr double kPascal = 1e5;  // per bar

Case rated(double duration, int samples) {
  Case c = shipped_case("bap63_rated_hydraulic");
  c.drive = steady_speed(duration, samples);
  return c;
}

Case short_case(const std::string& name, double duration, int samples) {
  Case c = shipped_case(name);
  c.drive->duration = duration;
  c.drive->samples = samples;
  return c;
}

struct Stepped {
  Rows rows;
  long steps = 0;
};

// Rows at `samples` equal parts of the drive's duration, `between` communication points for each.
Stepped stepped(PumpInTime& pump, int between = 1) {
  const DriveSpec& drive = *pump.the_case.drive;
  coupled::Stepper stepper("analytic", *pump.mechanics, *pump.oil, kTolerance);
  stepper.start(0, pump.start(), drive.duration);
  Stepped result;
  result.rows.add(pump.row(0, stepper.state()));
  const int points = drive.samples * between;
  for (int i = 1; i <= points; ++i) {
    stepper.step_to(drive.duration * i / points);
    if (i % between == 0) result.rows.add(pump.row(stepper.time(), stepper.state()));
  }
  result.steps = stepper.steps();
  return result;
}

// Written before the first run: the same steps, so the same rows, however many points there are.
void expect_as_simulated(Case the_case, bool running) {
  PumpInTime pump(std::move(the_case), running);
  const Trajectory run = pump.simulate();
  const Stepped few = stepped(pump), many = stepped(pump, 25);
  EXPECT_EQ(few.steps, run.record.steps);
  EXPECT_EQ(many.steps, run.record.steps);
  EXPECT_LT(few.rows.apart(rows_of(run)), 1e-12);
  EXPECT_LT(many.rows.apart(rows_of(run)), 1e-12);
}

TEST(Stepper, GivenSpeedIsAsSimulated) { expect_as_simulated(rated(0.01, 40), true); }

TEST(Stepper, MotorFromRestIsAsSimulated) {
  expect_as_simulated(short_case("bap63_start_up", 0.02, 40), false);
}

TEST(Stepper, SpeedOverTimeIsAsSimulated) {
  expect_as_simulated(short_case("bap63_reversal", 0.04, 40), true);
}

TEST(Stepper, TorqueIsAsSimulated) {
  Case c = rated(0.01, 40);
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 250;
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  expect_as_simulated(std::move(c), true);
}

TEST(Stepper, CompliantTeethAreAsSimulated) {
  expect_as_simulated(short_case("bap63_tooth_rattle", 0.01, 40), false);
}

// Beyond the expected end too, points cost next to nothing.
TEST(Stepper, GoesOnOverPointsBeyondTheEnd) {
  PumpInTime pump(rated(0.01, 40));
  const auto steps = [&](int points) {
    coupled::Stepper stepper("analytic", *pump.mechanics, *pump.oil, kTolerance);
    stepper.start(0, pump.start(), 0.001);
    for (int i = 1; i <= points; ++i) stepper.step_to(0.01 * i / points);
    return stepper.steps();
  };
  EXPECT_LT(steps(5000), 1.1 * static_cast<double>(steps(10)));
}

// What cannot be followed beyond a point is not met at it; what can leaves it where it stood.
TEST(Stepper, FailureLeavesTheLastPoint) {
  Case c = rated(0.01, 20);
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 250;
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  PumpInTime pump(c);
  coupled::Stepper stepper("analytic", *pump.mechanics, *pump.oil, kTolerance);
  stepper.start(0, pump.start(), 0.01);
  stepper.step_to(0.001);
  const std::vector<double> here = pump.row(0.001, stepper.state());
  Surroundings impossible;
  impossible.torque = std::nan("");
  stepper.set_inputs(impossible);
  EXPECT_THROW(stepper.step_to(0.002), ComputationError);
  EXPECT_EQ(stepper.time(), 0.001);
  Surroundings outside;
  outside.torque = 250;
  stepper.set_inputs(outside);
  EXPECT_EQ(pump.row(0.001, stepper.state())[1], here[1]);
  stepper.step_to(0.002);
  EXPECT_EQ(stepper.time(), 0.002);
}

// A state that was kept goes on: by another stepper, of another pump.
TEST(Stepper, KeptStateGoesOn) {
  Case c = rated(0.01, 20);
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 250;
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  PumpInTime pump(c), other(c, pump);
  coupled::Stepper stepper("analytic", *pump.mechanics, *pump.oil, kTolerance);
  stepper.start(0, pump.start(), 0.01);
  stepper.step_to(0.0037);
  const coupled::SystemState kept = stepper.state();
  stepper.step_to(0.01);
  coupled::Stepper second("analytic", *other.mechanics, *other.oil, kTolerance);
  second.start(0.0037, kept, 0.01);
  second.step_to(0.01);
  Rows a, b;
  a.add(pump.row(0.01, stepper.state()));
  b.add(other.row(0.01, second.state()));
  EXPECT_LT(a.apart(b), 1e-6);
}

TEST(Stepper, InterleavedPumpsAreAsAlone) {
  PumpInTime one(rated(0.01, 20));
  Case slower = rated(0.01, 20);
  slower.drive->kind = DriveKind::torque;
  slower.drive->torque = 200;
  slower.pump.shaft.axial_inertia = slower.pump.block.axial_inertia = 2e-3;
  PumpInTime two(slower);
  const Stepped alone[] = {stepped(one), stepped(two)};
  PumpInTime* pumps[] = {&one, &two};
  std::unique_ptr<coupled::Stepper> steppers[2];
  Rows rows[2];
  for (int p = 0; p < 2; ++p) {
    steppers[p] = std::make_unique<coupled::Stepper>("analytic", *pumps[p]->mechanics,
                                                     *pumps[p]->oil, kTolerance);
    steppers[p]->start(0, pumps[p]->start(), 0.01);
    rows[p].add(pumps[p]->row(0, steppers[p]->state()));
  }
  for (int i = 1; i <= 20; ++i)
    for (int p = 0; p < 2; ++p) {
      steppers[p]->step_to(0.01 * i / 20);
      rows[p].add(pumps[p]->row(steppers[p]->time(), steppers[p]->state()));
    }
  for (int p = 0; p < 2; ++p) EXPECT_EQ(rows[p].apart(alone[p].rows), 0);
}

// Surroundings that say what the case says change nothing but where steps begin.
TEST(Surroundings, WhatTheCaseSaysChangesNothing) {
  PumpInTime pump(rated(0.01, 20));
  const Rows alone = stepped(pump).rows;
  const double omega = rad_per_second(pump.the_case.operation.speed_rpm);
  coupled::Stepper stepper("analytic", *pump.mechanics, *pump.oil, kTolerance);
  stepper.start(0, pump.start(), 0.01);
  Rows rows;
  rows.add(pump.row(0, stepper.state()));
  for (int i = 1; i <= 20; ++i) {
    // Said anew at each point, so that each is a start.
    Surroundings outside;
    outside.time = stepper.time();
    outside.shaft = AxisMotion{omega * outside.time, omega, 0};
    outside.suction = 0;
    outside.load_share = 1;
    stepper.set_inputs(outside);
    stepper.step_to(0.01 * i / 20);
    rows.add(pump.row(stepper.time(), stepper.state()));
  }
  EXPECT_GT(rows.apart(alone), 0);  // it did start anew
  EXPECT_LT(rows.apart(alone), 1e-6);
}

// A speed over time, told from outside at points: between them the speed is the chord
// of the curve, which errs by h^2/8 of its second derivative. Half the step: a quarter of the
// error.
TEST(Surroundings, SpeedToldAtPointsIsTheCurve) {
  const double duration = 0.04;
  Case braked = short_case("bap63_reversal", duration, 20);
  const double omega = rad_per_second(braked.operation.speed_rpm);
  braked.drive->curve.time = {0, 0.01, 0.03, 0.04};
  braked.drive->curve.value = {omega, 0.9 * omega, 0.4 * omega, 0.3 * omega};
  PumpInTime pump(braked);
  const Rows truth = rows_of(pump.simulate());
  const TimeSignal curve(pump.the_case.drive->curve);
  Case without = pump.the_case;
  without.drive->curve = {};
  const auto told = [&](int points) {
    PumpInTime steered(without, pump);
    coupled::Stepper stepper("analytic", *steered.mechanics, *steered.oil, kTolerance);
    stepper.start(0, steered.start(), duration);
    Rows rows;
    for (int i = 0; i <= points; ++i) {
      const double now = duration * i / points, next = duration * (i + 1) / points;
      stepper.step_to(now);
      Surroundings outside;
      outside.time = now;
      const AxisMotion at = steered.mechanics->shaft(now, stepper.state().motion);
      outside.shaft = AxisMotion{at.angle, curve.value(now),
                                 (curve.value(next) - curve.value(now)) / (next - now)};
      stepper.set_inputs(outside);
      if (i % (points / 20) == 0) {
        std::vector<double> row = steered.row(now, stepper.state());
        rows.add({row[1], row[2], row[row.size() - 6], row[row.size() - 3]});
      }
    }
    return rows;
  };
  Rows some;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::vector<double>& row = truth[i];
    some.add({row[1], row[2], row[row.size() - 6], row[row.size() - 3]});
  }
  const double coarse = told(100).apart(some), fine = told(400).apart(some);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, coarse / 6);
}

// A load that is told a share has that share's size.
TEST(Surroundings, LoadShareIsThatOfTheLoad) {
  Case c = short_case("bap63_reversal", 0.01, 10);
  c.drive = steady_speed(0.01, 10);
  PumpInTime pump(c);
  Case smaller = c;
  smaller.hydraulics->load->area *= 0.8;
  PumpInTime truth(smaller, pump);
  const Rows wanted = stepped(truth).rows;
  coupled::Stepper stepper("analytic", *pump.mechanics, *pump.oil, kTolerance);
  stepper.start(0, pump.start(), 0.01);
  Surroundings outside;
  outside.load_share = 0.8;
  stepper.set_inputs(outside);
  Rows rows;
  rows.add(pump.row(0, stepper.state()));
  for (int i = 1; i <= 10; ++i) {
    stepper.step_to(0.001 * i);
    rows.add(pump.row(stepper.time(), stepper.state()));
  }
  EXPECT_LT(rows.apart(wanted), 1e-9);
}

// An ideal trace between other ports is that of a case with these.
TEST(Surroundings, PortsOfAnIdealTrace) {
  Case c = short_case("bap63_tooth_rattle", 0.005, 10);
  PumpInTime pump(c, false);
  Case other = c;
  other.pressure.ports = {3 * kPascal, 200 * kPascal};
  PumpInTime truth(other, false);
  EXPECT_TRUE(pump.oil->takes().suction && pump.oil->takes().delivery);
  Surroundings outside;
  outside.suction = 3 * kPascal;
  outside.delivery = 200 * kPascal;
  pump.oil->set_inputs(outside);
  OilLoads a, b;
  for (double angle = 0; angle < 7; angle += 0.1) {
    const AxisMotion block{angle, 100, 0};
    pump.oil->loads(0, block, nullptr, a);
    truth.oil->loads(0, block, nullptr, b);
    for (std::size_t k = 0; k < a.chamber_pressure.size(); ++k)
      EXPECT_NEAR(a.chamber_pressure[k], b.chamber_pressure[k], 1e-8 * 200 * kPascal);
    EXPECT_EQ(a.ports.delivery, b.ports.delivery);
  }
}

// Another pressure in the tank: chambers settle about it as in the case that has it.
TEST(Surroundings, SuctionPressureIsThatOfTheTank) {
  Case c = rated(0.08, 40);
  PumpInTime pump(c);
  Case boosted = c;
  boosted.pressure.ports.suction = 5 * kPascal;
  PumpInTime truth(boosted, pump);
  const coupled::SystemState start = pump.start();
  const auto pressures = [&](PumpInTime& of, const Surroundings& outside) {
    coupled::Stepper stepper("analytic", *of.mechanics, *of.oil, kTolerance);
    stepper.start(0, start, 0.01);
    stepper.set_inputs(outside);
    Rows rows;
    for (int i = 1; i <= 20; ++i) {
      stepper.step_to(0.0005 * i);
      OilLoads loads;
      of.oil->loads(0, {}, stepper.state().oil.data(), loads);
      rows.add(loads.chamber_pressure);
    }
    return rows;
  };
  Surroundings outside;
  outside.suction = 5 * kPascal;
  EXPECT_LT(pressures(pump, outside).apart(pressures(truth, {})), 1e-7);
}

TEST(Surroundings, WhatTheDriveDoesNotTakeIsRefused) {
  PumpInTime pump(rated(0.01, 10));
  Surroundings outside;
  outside.torque = 10;
  EXPECT_THAT(refusal([&] { pump.mechanics->set_inputs(outside); }),
              testing::HasSubstr("[drive] kind: must be \"torque\""));
}

// Both models under the same motion from outside.
TEST(Surroundings, BothModelsTakeThem) {
  Case c = rated(0.01, 10);
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  c.drive->curve = {};
  PumpInTime pump(c);
  const auto other = multibody::mechanics(c, c.multibody);
  Surroundings outside;
  outside.time = 0.001;
  outside.shaft = AxisMotion{0.2, 120, 3000};
  pump.mechanics->set_inputs(outside);
  other->set_inputs(outside);
  const MotionVector y{};
  OilLoads loads;
  loads.chamber_pressure = {1e5, 2e6, 2.7e7, 2.6e7, 1e4};
  loads.ports = {0, 2.7e7};
  std::vector<double> state[2], rows[2];
  MotionChecks checks{};
  for (int m = 0; m < 2; ++m) {
    Mechanics& model = m == 0 ? *pump.mechanics : *other;
    rows[m].resize(model.layout().size());
    model.row(0.002, y, loads, state[m], rows[m], checks);
    const double since = 0.001;
    EXPECT_NEAR(state[m][1], (0.2 + 120 * since + 1500 * since * since) / kRadPerDegree, 1e-9);
    EXPECT_NEAR(state[m][3], 123 / kRadPerSecondPerRpm, 1e-9);
  }
  const std::size_t torque = pump.mechanics->layout().Td();
  EXPECT_NEAR(rows[0][torque], rows[1][torque], 1e-7 * std::abs(rows[0][torque]));
}

// A partner that says nothing, and is told what the table has.
TEST(Exchange, PartnerIsToldTheRows) {
  PumpInTime pump(rated(0.01, 20));
  const Trajectory alone = pump.simulate();
  Rows told;
  std::vector<std::string> names;
  coupled::Options options;
  options.exchange = coupled::Exchange{0.0005, [&](const coupled::PumpOutputs& outputs) {
                                         told.add(outputs.values);
                                         names = outputs.names;
                                         EXPECT_EQ(outputs["time_s"], outputs.time);
                                         EXPECT_THROW(outputs["nothing"], InputError);
                                         return Surroundings{};
                                       }};
  const Trajectory run = pump.simulate(options);
  EXPECT_EQ(rows_of(run).apart(rows_of(alone)), 0);
  EXPECT_EQ(run.record.steps, alone.record.steps);
  ASSERT_EQ(told.size(), 20U);  // none at the end
  Rows shown;
  for (std::size_t i = 0; i < 20; ++i) shown.add(row_of(alone, i));
  EXPECT_LT(told.apart(shown), 1e-12);
  ASSERT_EQ(names.size(), told[0].size());
  EXPECT_EQ(names[1], "theta_deg");
  EXPECT_EQ(names.back(), alone.oil->columns.back().name);
}

// A partner in a loop: a torque that falls with the speed, as a motor's. The more points, the
// nearer to the motor itself, whose rotor and stiff coupling add next to nothing.
TEST(Exchange, BalancesCloseWhileAPartnerSteers) {
  Case c = rated(0.02, 40);
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 294;
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  PumpInTime pump(c);
  const double omega = rad_per_second(c.operation.speed_rpm);
  const auto steered = [&](double step) {
    coupled::Options options;
    options.exchange = coupled::Exchange{
        step, [&](const coupled::PumpOutputs& outputs) {
          Surroundings outside;
          outside.torque = 294 - 2 * (outputs["shaft_rpm"] * kRadPerSecondPerRpm - omega);
          return outside;
        }};
    return pump.simulate(options);
  };
  const Trajectory coarse = steered(4e-4), fine = steered(1e-4), finest = steered(2.5e-5);
  EXPECT_LT(rows_of(fine).apart(rows_of(finest)), rows_of(coarse).apart(rows_of(finest)) / 2);
  const double work = std::abs(finest.record.work_of_drives);
  EXPECT_LT(finest.record.worst_work_residual, 1e-5 * work);
  EXPECT_LT(finest.oil->worst_energy_residual, 1e-5 * work);
  EXPECT_LT(finest.oil->worst_mass_residual, 1e-6 * finest.oil->mass_out);
  // The pump is given back as the case has it.
  const Trajectory after = pump.simulate(), fresh = PumpInTime(c, pump).simulate();
  EXPECT_EQ(rows_of(after).apart(rows_of(fresh)), 0);
}

// Either model: the same partner, the same motion.
TEST(Exchange, BothModelsAreSteeredAlike) {
  Case c = rated(0.002, 4);
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 250;
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  PumpInTime pump(c);
  coupled::Options options;
  options.exchange = coupled::Exchange{5e-4, [](const coupled::PumpOutputs& outputs) {
                                         Surroundings outside;
                                         outside.torque = 300 + outputs["p_1_bar"];
                                         outside.suction = 1e5 * outputs.time / 0.002;
                                         return outside;
                                       }};
  const Trajectory analytic = pump.simulate(options);
  const auto mechanics = multibody::mechanics(c, c.multibody);
  const Trajectory other = coupled::simulate("multibody", *mechanics, *pump.oil, *c.drive, options);
  const ResultTable &a = analytic.table.results, &b = other.table.results;
  ASSERT_EQ(a.rows(), b.rows());
  const std::size_t torque = a.find("Td_z1_Nm");
  EXPECT_GT(std::abs(a.at(4, torque) - a.at(0, torque)), 1);
  for (std::size_t row = 0; row < a.rows(); ++row)
    for (std::size_t column = 0; column < analytic.table.state_names.size(); ++column)
      EXPECT_NEAR(analytic.table.state(row, column), other.table.state(row, column),
                  1e-7 * (1 + std::abs(analytic.table.state(row, column))));
  for (std::size_t i = 0; i < analytic.oil->values.size(); ++i)
    EXPECT_NEAR(analytic.oil->values[i], other.oil->values[i],
                1e-6 * (1 + std::abs(analytic.oil->values[i])));
}

// A speed in steps: bodies that are taken along are work of what turns the shaft.
TEST(Exchange, SpeedInStepsKeepsTheBalances) {
  Case c = rated(0.02, 40);
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  PumpInTime pump(c);
  coupled::Options options;
  options.exchange =
      coupled::Exchange{1e-3, [](const coupled::PumpOutputs& outputs) {
                          Surroundings outside;
                          outside.shaft = AxisMotion{0, 150 + 1000 * outputs.time, 0};
                          return outside;
                        }};
  const Trajectory run = pump.simulate(options);
  EXPECT_LT(run.record.worst_work_residual, 1e-6 * std::abs(run.record.work_of_drives));
  // 20 speeds from 150 in steps of 1, each for 1 ms.
  EXPECT_NEAR(run.table.state(40, 1), (150 + 9.5) * 0.02 / kRadPerDegree, 1e-7);
}

TEST(Exchange, RefusesWhatMakesNoSense) {
  PumpInTime pump(rated(0.01, 10));
  coupled::Options options;
  options.exchange =
      coupled::Exchange{0, [](const coupled::PumpOutputs&) { return Surroundings{}; }};
  EXPECT_THAT(refusal([&] { pump.simulate(options); }), testing::HasSubstr("must be > 0"));
  options.exchange = coupled::Exchange{1e-3, [](const coupled::PumpOutputs&) {
                                         Surroundings outside;
                                         outside.torque = 1;
                                         return outside;
                                       }};
  EXPECT_THAT(refusal([&] { pump.simulate(options); }), testing::HasSubstr("[drive] kind"));
}

// Touches of teeth go on over points at which something else changes, and are listed once.
TEST(Exchange, TouchesAreListedOnce) {
  PumpInTime pump(short_case("bap63_tooth_rattle", 0.01, 40), false);
  const Trajectory alone = pump.simulate();
  coupled::Options options;
  int points = 0;
  options.exchange = coupled::Exchange{1e-4, [&](const coupled::PumpOutputs&) {
                                         Surroundings outside;
                                         // The same pressure, said in another way each time.
                                         outside.delivery = 275e5 + 1e-6 * (points++ % 2);
                                         return outside;
                                       }};
  const Trajectory run = pump.simulate(options);
  ASSERT_FALSE(alone.record.events.empty());
  ASSERT_EQ(run.record.events.size(), alone.record.events.size());
  for (std::size_t i = 0; i < alone.record.events.size(); ++i) {
    const ToothEvent &a = alone.record.events[i], &b = run.record.events[i];
    EXPECT_EQ(a.touch, b.touch);
    EXPECT_NEAR(a.time_s, b.time_s, 1e-6);
    EXPECT_NEAR(a.impulse, b.impulse, 1e-3 * std::abs(a.impulse) + 1e-6);
  }
  EXPECT_NEAR(run.record.share_out_of_contact, alone.record.share_out_of_contact, 1e-4);
}

}  // namespace
}  // namespace bentaxis::test
