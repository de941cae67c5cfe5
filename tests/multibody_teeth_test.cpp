// Bevel teeth of the multibody model: against the closed form and against each other, at given
// motion and as equations of motion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/analytic/budget.h"
#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/teeth.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/pump/error.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
double length(const Vector& a) { return distance(a, {}); }

Case teeth_case() {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_teeth.toml");
}

double arm_of(const Gear& gear) { return gear.pitch_diameter / 2 * std::cos(gear.pressure_angle); }
Vector block_axis(const PumpParameters& pump) {
  return {0, std::sin(pump.geometry.tilt), std::cos(pump.geometry.tilt)};
}

// Teeth with everything that they may have, which mesh.
PumpParameters random_teeth(RandomPump& random, PumpParameters pump) {
  for (;;) {
    ToothData& teeth = *pump.gear.teeth;
    teeth.count = static_cast<int>(random.in(18, 41));
    pump.gear.pitch_diameter = random.in(0.08, 0.12);
    pump.gear.pressure_angle = random.in(0.3, 0.44);
    const double module = pump.gear.pitch_diameter / teeth.count;
    teeth.face_width = random.in(0.01, 0.025);
    teeth.addendum = random.in(0.85, 1) * module;
    teeth.dedendum = 1.25 * module;
    teeth.backlash = random.in(0, 1) < 0.3 ? 0 : random.in(0, 80e-6);
    teeth.dissipation = random.in(0, 2);
    teeth.tip_relief = random.in(0, 1) < 0.3 ? 0 : random.in(0, 15e-6);
    teeth.relief_height = random.in(0.2, 0.9) * module;
    teeth.lead_crowning = random.in(0, 1) < 0.3 ? 0 : random.in(0, 10e-6);
    for (ToothErrors* errors : {&teeth.shaft, &teeth.block}) {
      errors->runout = random.in(0, 15e-6);
      errors->runout_angle = random.in(-3, 3);
      errors->pitch.clear();
      for (int i = 0; i < teeth.count; ++i) errors->pitch.push_back(random.in(-5e-6, 5e-6));
    }
    try {
      analytic::BevelTeeth{pump};
      return pump;
    } catch (const InputError&) {
    }
  }
}

Instant turning(const Case& the_case, double theta, double speed) {
  Instant now;
  now.turn(theta, speed);
  now.chamber_pressure.assign(static_cast<std::size_t>(the_case.pump.geometry.pistons), 0);
  for (std::size_t k = 0; k < now.chamber_pressure.size(); ++k)
    now.chamber_pressure[k] = k < now.chamber_pressure.size() / 2 ? 275e5 : 1e5;
  now.ports = {0, 275e5};
  return now;
}

void expect_alike(const TeethAction& a, const TeethAction& b, double tolerance) {
  double largest = 1;
  for (const PairContact& pair : a.pairs) largest = std::max(largest, pair.force);
  const double off = scaled(tolerance) * largest;
  EXPECT_NEAR(a.lag, b.lag, 1e-15);
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    const PairContact &p = a.pairs[i], &q = b.pairs[i];
    EXPECT_EQ(p.flank, q.flank);
    EXPECT_EQ(p.shaft_tooth, q.shaft_tooth);
    EXPECT_EQ(p.block_tooth, q.block_tooth);
    EXPECT_NEAR(p.force, q.force, off) << i;
    if (p.force == 0 || q.force == 0) continue;
    EXPECT_NEAR(p.approach, q.approach, scaled(1e-16)) << i;
    EXPECT_LT(distance(p.point, q.point), scaled(1e-11)) << i;
    EXPECT_LT(distance(p.normal, q.normal), scaled(1e-12)) << i;
  }
  EXPECT_LT(distance(a.force, b.force), off);
  EXPECT_LT(distance(a.moment, b.moment), 0.1 * off);
}

// The same teeth under the same lag: the contact search against the closed form.
TEST(MultibodyTeeth, ActAsTheClosedFormDoesAtALag) {
  RandomPump random(161);
  const Case the_case = teeth_case();
  int carrying = 0, two_flanks = 0;
  for (int n = 0; n < 40; ++n) {
    const PumpParameters pump = random_teeth(random, the_case.pump);
    const analytic::BevelTeeth closed(pump);
    multibody::Model model(pump, the_case.multibody, 1);
    std::vector<double> values(model.layout().size());
    for (int i = 0; i < 10; ++i) {
      Instant now = turning(the_case, random.in(-20, 20), random.in(-200, 200));
      const double play = pump.gear.teeth->backlash / 2 + random.in(-10e-6, 30e-6);
      now.lag =
          ToothLag{(random.in(0, 1) < 0.5 ? -1 : 1) * play / arm_of(pump.gear), random.in(-5, 5)};
      model.evaluate(now, values);
      const TeethAction expected = closed.act(now.shaft.angle, now.shaft.speed, *now.lag);
      expect_alike(expected, model.teeth(), 1e-10);
      double forces[2] = {};
      for (std::size_t p = 0; p < expected.pairs.size(); ++p)
        forces[p / kPairsPerFlank] += expected.pairs[p].force;
      carrying += forces[0] + forces[1] > 0;
      two_flanks += forces[0] > 0 && forces[1] > 0;
    }
  }
  EXPECT_GT(carrying, 200);
  EXPECT_GT(two_flanks, 3);
}

TEST(MultibodyTeeth, RestWhereTheClosedFormDoes) {
  RandomPump random(162);
  const Case the_case = teeth_case();
  int signs[2] = {};
  for (int n = 0; n < 20; ++n) {
    const PumpParameters pump = random_teeth(random, the_case.pump);
    const analytic::BevelTeeth closed(pump);
    multibody::Model model(pump, the_case.multibody, 1);
    std::vector<double> values(model.layout().size());
    MotionChecks checks;
    for (int i = 0; i < 10; ++i) {
      Instant now = turning(the_case, random.in(-4, 7), random.in(-200, 200));
      for (double& pressure : now.chamber_pressure) pressure = random.in(0, 275e5);
      model.evaluate(now, values, &checks);
      const double direction = now.shaft.speed < 0 ? -1 : 1;
      const double torque = direction * values[model.layout().Rcs()] * arm_of(pump.gear);
      ++signs[torque > 0];
      const ToothLag lag = closed.rest(now.shaft.angle, torque);
      EXPECT_NEAR(model.teeth().lag, lag.angle, scaled(1e-14)) << torque;
      EXPECT_NEAR(dot(model.teeth().moment, block_axis(pump)), torque, scaled(1e-10) * 10);
      EXPECT_NEAR(checks.tooth_law * arm_of(pump.gear), torque, scaled(1e-10) * 10);
      EXPECT_NEAR(checks.power_balance, 0, scaled(1e-7));
      EXPECT_NEAR(values[model.layout().power_residual()], 0, scaled(1e-9));
    }
  }
  EXPECT_GT(signs[0], 20);
  EXPECT_GT(signs[1], 20);
}

// A turn of the pump with teeth at rest under its loads, with and without what teeth may have.
// Teeth of unequal pitch without backlash are wedged: of no torque they stand where both flanks
// press alike, not where one just touches.
TEST(MultibodyTeeth, WedgedTeethRestWithoutTorque) {
  Case the_case = teeth_case();
  PumpParameters& pump = the_case.pump;
  ToothData& teeth = *pump.gear.teeth;
  teeth.backlash = 0;
  for (int tooth = 1; tooth <= teeth.count; ++tooth)
    teeth.shaft.pitch.push_back(tooth % 2 == 0 ? -15e-6 : 15e-6);
  teeth.block.pitch.assign(teeth.count, 0.0);
  pump.piston.mass = pump.block.mass = 0;
  pump.friction = {};
  multibody::Model model(pump, the_case.multibody, 1, multibody::Scene::full,
                         multibody::Method::residual);
  const analytic::BevelTeeth closed(pump);
  std::vector<double> values(model.layout().size());
  for (const double theta : {0.4, 1.1, 1.6, 3.3}) {
    Instant now = turning(the_case, theta, 150);
    now.chamber_pressure.assign(now.chamber_pressure.size(), 0);
    now.ports = {0, 0};
    model.evaluate(now, values);
    ASSERT_NEAR(values[model.layout().Rcs()], 0, 1e-9);
    const TeethAction& action = model.teeth();
    double plus = 0, minus = 0;
    for (const PairContact& pair : action.pairs) (pair.flank > 0 ? plus : minus) += pair.force;
    EXPECT_GT(plus, 1000);
    EXPECT_GT(minus, 1000);
    EXPECT_NEAR(dot(action.moment, block_axis(pump)), 0, scaled(1e-9));
    EXPECT_NEAR(action.lag, closed.rest(theta, 0).angle, scaled(1e-14));
  }
}

// A flexibility so small that no lag in double gives the torque: the parts are numbers all the
// same.
TEST(MultibodyTeeth, BudgetOfTeethAsStiffAsRigidIsFinite) {
  Case the_case = teeth_case();
  the_case.pump.gear.teeth->youngs_modulus = 1e24;
  multibody::Model model(the_case.pump, the_case.multibody, 1);
  std::vector<double> values(model.layout().size());
  for (int deg = 0; deg < 72; deg += 3) {
    model.evaluate(turning(the_case, deg * kRadPerDegree, 157), values);
    for (const double part : model.budget().drive) EXPECT_TRUE(std::isfinite(part)) << deg;
  }
}

TEST(MultibodyTeeth, AreTheTwinOfTheClosedFormOverATurn) {
  RandomPump random(163);
  for (const int kind : {0, 1, 2, 3}) {
    Case the_case = teeth_case();
    if (kind == 0) the_case.pump.gear.teeth->backlash = 0;
    if (kind >= 2) the_case.pump = random_teeth(random, the_case.pump);
    if (kind == 3) the_case.operation.speed_rpm = -900;
    const Samples samples = one_turn(the_case);
    ASSERT_EQ(samples.theta_deg.size(), 360U);
    ResultTable closed_teeth, teeth;
    const ResultTable closed =
        analytic::run(the_case, the_case.analytic, samples, {}, &closed_teeth);
    const ResultTable found = multibody::run_driven(the_case, the_case.multibody, samples, {},
                                                    multibody::Scene::full, {}, nullptr, &teeth);
    const Worst worst = worst_difference(closed, found);
    EXPECT_LT(worst.over_peak, scaled(1e-8)) << worst.channel << " of " << kind;
    const Worst of_teeth = worst_difference(closed_teeth, teeth);
    EXPECT_LT(of_teeth.over_peak, scaled(1e-8)) << of_teeth.channel << " of " << kind;
    const std::vector<double> force = column(found, "Rcs_z4_N");
    EXPECT_LT(*std::min_element(force.begin(), force.end()), -1);
    EXPECT_GT(*std::max_element(force.begin(), force.end()), 1);
  }
}

TEST(MultibodyTeeth, MultipliersAndInverseDynamicsFindTheSameReactions) {
  Case the_case = teeth_case();
  const Samples samples = one_turn(the_case);
  for (const FlankShape shape : {FlankShape::involute, FlankShape::octoid}) {
    the_case.multibody.flanks = shape;
    const ResultTable a =
        multibody::run_driven(the_case, the_case.multibody, samples, {}, multibody::Scene::full,
                              multibody::Method::multipliers);
    const ResultTable b =
        multibody::run_driven(the_case, the_case.multibody, samples, {}, multibody::Scene::full,
                              multibody::Method::residual);
    const Worst worst = worst_difference(a, b);
    EXPECT_LT(worst.over_peak, scaled(1e-10)) << worst.channel;
  }
}

// Octoids carry the same torque at the same ratio: what they change are places and directions.
TEST(MultibodyTeeth, OctoidsDifferFromInvolutesByWhereTheyTouch) {
  Case the_case = teeth_case();
  const Samples samples = one_turn(the_case);
  const ResultTable involute = multibody::run_driven(the_case, the_case.multibody, samples);
  the_case.multibody.flanks = FlankShape::octoid;
  const ResultTable octoid = multibody::run_driven(the_case, the_case.multibody, samples);
  const Worst worst = worst_difference(involute, octoid, true);
  EXPECT_GT(worst.over_peak, 1e-6);
  EXPECT_LT(worst.over_peak, 3e-2) << worst.channel;
  const double force = involute.peak(involute.channels[involute.find("Rcs_z4_N")].group);
  const std::vector<double> a = column(involute, "Rcs_z4_N"), b = column(octoid, "Rcs_z4_N");
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9 * force);
}

// What each cause needs of the drive adds up to Td, though corners take a little more or less from
// the shaft than they give the block: that goes into the teeth.
TEST(MultibodyTeeth, BudgetAddsUp) {
  const Case the_case = teeth_case();
  multibody::Model model(the_case.pump, the_case.multibody, 1);
  ASSERT_TRUE(model.has_teeth());
  analytic::BudgetModel twin(the_case.pump, the_case.analytic);
  std::vector<double> values(model.layout().size());
  double lost = 0;
  for (int deg = 0; deg < 40; ++deg) {
    const Instant now = turning(the_case, deg * kRadPerDegree, 157);
    model.evaluate(now, values);
    double closed = 0;
    Budget expected = twin.evaluate(now);
    for (const double part : expected.drive) closed += part;
    EXPECT_NEAR(closed, values[model.layout().Td()], scaled(1e-9) * 300);
    Budget budget = model.budget();
    for (std::size_t c = 0; c < kCauses; ++c)
      EXPECT_NEAR(budget.drive[c], expected.drive[c], scaled(1e-9) * 300)
          << to_string(static_cast<Cause>(c));
    double drive = 0, carrying = 0;
    for (const double part : budget.drive) drive += part;
    for (const double part : budget.carrying) carrying += part;
    EXPECT_NEAR(drive, values[model.layout().Td()], scaled(1e-11) * 300);
    EXPECT_NEAR(carrying, values[model.layout().Rcs()] * arm_of(the_case.pump.gear),
                scaled(1e-11) * 300);
    EXPECT_NEAR(budget.carrying_torque, carrying, scaled(1e-11) * 300);
    const double into_teeth = model.teeth().moment[2] - carrying;
    EXPECT_NEAR(budget.drive_of(Cause::teeth), into_teeth, scaled(1e-11) * 300);
    lost = std::max(lost, std::abs(into_teeth));
  }
  EXPECT_GT(lost, 1e-5);
}

Case moving_case(DriveKind kind) {
  Case the_case = teeth_case();
  the_case.drive->kind = kind;
  the_case.drive->torque = kind == DriveKind::speed ? 0 : 300;
  if (kind == DriveKind::motor) {
    the_case.drive->motor.emplace();
    the_case.drive->motor->rotor_inertia = 0.05;
    the_case.drive->motor->coupling_stiffness = 2e4;
    the_case.drive->motor->torque_slope = 8;
  }
  return the_case;
}

// Accelerations are those at which the law's torque is what the block's balance takes.
TEST(MultibodyTeeth, MoveAsTheirLawSays) {
  RandomPump random(164);
  int carrying = 0;
  for (const DriveKind kind : {DriveKind::speed, DriveKind::torque, DriveKind::motor})
    for (int n = 0; n < 12; ++n) {
      Case the_case = moving_case(kind);
      the_case.pump = random_teeth(random, the_case.pump);
      if (n % 3 == 0) the_case.multibody.flanks = FlankShape::octoid;
      const auto mechanics = multibody::mechanics(the_case, the_case.multibody);
      ASSERT_TRUE(mechanics->compliant());
      for (const double scale : mechanics->scales()) EXPECT_GT(scale, 0);
      const Instant loaded = turning(the_case, 0, 0);
      const OilLoads loads{loaded.chamber_pressure, loaded.ports};
      MotionVector y = mechanics->start();
      const double time = random.in(0, 0.1);
      const double play = the_case.pump.gear.teeth->backlash / 2 + random.in(-5e-6, 20e-6);
      y[kLag] = (n % 2 == 0 ? 1 : -1) * play / arm_of(the_case.pump.gear);
      y[kLagRate] = random.in(-2, 2);
      MotionVector dy;
      mechanics->rates(time, y, loads, dy);

      Instant now;
      now.shaft = mechanics->shaft(time, y);
      now.block = mechanics->block(time, y);
      now.shaft.acceleration = dy[kTurnRate];
      now.block.acceleration = dy[kTurnRate] - dy[kLagRate];
      now.chamber_pressure = loads.chamber_pressure;
      now.ports = loads.ports;
      now.lag = ToothLag{y[kLag], y[kLagRate]};
      multibody::Model model(the_case.pump, the_case.multibody, 1);
      std::vector<double> values(model.layout().size());
      MotionChecks checks;
      model.evaluate(now, values, &checks);
      const double rcs = (now.shaft.speed < 0 ? -1 : 1) * values[model.layout().Rcs()];
      EXPECT_NEAR(checks.tooth_law, rcs, scaled(1e-9) * std::max(1e3, std::abs(rcs)));
      EXPECT_NEAR(checks.power_balance, 0, scaled(1e-6));
      if (kind != DriveKind::speed) {
        const double drive = kind == DriveKind::torque
                                 ? the_case.drive->torque
                                 : the_case.drive->motor->coupling_stiffness * y[kTwist];
        EXPECT_NEAR(values[model.layout().Td()], drive, scaled(1e-9) * 300);
      }
      EXPECT_NEAR(dy[kImpulse], std::abs(checks.tooth_law), scaled(1e-10) * 1e3);

      TeethAction action;
      ASSERT_TRUE(mechanics->teeth(time, y, action));
      expect_alike(model.teeth(), action, 1e-10);
      carrying += length(action.force) > 0;

      std::vector<double> state, row;
      MotionChecks of_row;
      mechanics->row(time, y, loads, state, row, of_row);
      double peak = 0;
      for (int axis = 0; axis < 3; ++axis)
        peak = std::max(peak, std::abs(row[model.layout().Rb1(axis)]));
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(row[model.layout().Rb1(axis)], values[model.layout().Rb1(axis)],
                    scaled(1e-9) * peak);
      for (int axis = 0; axis < 2; ++axis)
        EXPECT_NEAR(row[model.layout().Rcn(axis)], values[model.layout().Rcn(axis)],
                    scaled(1e-9) * peak);
      EXPECT_NEAR(of_row.tooth_law, checks.tooth_law, scaled(1e-9) * 1e3);
      EXPECT_NEAR(of_row.power_balance, 0, scaled(1e-6));

      // Work of loads and drive is what the bodies gain.
      EXPECT_EQ(mechanics->potential_energy(y) == 0, kind != DriveKind::motor);
    }
  EXPECT_GT(carrying, 20);
}

TEST(MultibodyTeeth, AccelerateAsTheClosedFormDoes) {
  RandomPump random(165);
  for (const DriveKind kind : {DriveKind::speed, DriveKind::torque, DriveKind::motor})
    for (int n = 0; n < 12; ++n) {
      Case the_case = moving_case(kind);
      the_case.pump = random_teeth(random, the_case.pump);
      const auto found = multibody::mechanics(the_case, the_case.multibody);
      const auto closed = analytic::mechanics(the_case, the_case.analytic);
      const Instant loaded = turning(the_case, 0, 0);
      const OilLoads loads{loaded.chamber_pressure, loaded.ports};
      MotionVector y = found->start();
      const double time = random.in(0, 0.1);
      const double play = the_case.pump.gear.teeth->backlash / 2 + random.in(-5e-6, 20e-6);
      y[kLag] = (n % 2 == 0 ? 1 : -1) * play / arm_of(the_case.pump.gear);
      y[kLagRate] = random.in(-2, 2);
      MotionVector a, b;
      closed->rates(time, y, loads, a);
      found->rates(time, y, loads, b);
      for (const std::size_t i : {kTurnRate, kLagRate, kTwistRate})
        EXPECT_NEAR(a[i], b[i], scaled(1e-9) * std::max(1e4, std::abs(a[i]))) << i;
      for (const std::size_t i : {kWorkOfLoads, kWorkOfDrive})
        EXPECT_NEAR(a[i], b[i], scaled(1e-8) * 1e4) << i;
      EXPECT_NEAR(a[kImpulse], b[kImpulse], scaled(1e-9) * std::max(1e3, a[kImpulse]));
      for (const int flank : {1, -1}) {
        EXPECT_NEAR(closed->approach(time, y, flank), found->approach(time, y, flank), 1e-15);
        EXPECT_NEAR(closed->approach_rate(time, y, flank), found->approach_rate(time, y, flank),
                    1e-12);
      }
    }
}

// The approach is continuous as pairs come and go, and its rate is the flanks' closing speed.
TEST(MultibodyTeeth, ApproachIsContinuousAndItsRateTheClosingSpeed) {
  Case the_case = teeth_case();
  the_case.pump.gear.teeth->lead_crowning = 3e-6;
  const auto mechanics = multibody::mechanics(the_case, the_case.multibody);
  for (const int flank : {1, -1})
    for (const double press : {-20e-6, 5e-6}) {
      double last = 0;
      for (int i = 0; i <= 2000; ++i) {
        const double time = 0.005 * i / 2000;
        MotionVector y = mechanics->start();
        y[kLag] = flank * (25e-6 + press) / arm_of(the_case.pump.gear);
        const double approach = mechanics->approach(time, y, flank);
        if (i > 0) {
          EXPECT_NEAR(approach, last, 1e-8) << time;
        }
        last = approach;
        EXPECT_NEAR(mechanics->approach_rate(time, y, flank), 0, 1e-12);
        y[kLagRate] = 1;
        const double rate = mechanics->approach_rate(time, y, flank);
        constexpr double kStep = 1e-9;
        y[kLag] += kStep;
        EXPECT_NEAR((mechanics->approach(time, y, flank) - approach) / kStep, rate, 1e-4);
      }
    }
}

Trajectory moved(const Case& the_case, Mechanics& mechanics, double tolerance) {
  const PressureTrace pressure(the_case.pressure);
  const auto oil =
      coupled::prescribed_oil(the_case.pump.geometry.pistons, pressure, the_case.pressure.ports);
  coupled::Options options;
  options.tolerance = tolerance;
  return coupled::simulate("teeth", mechanics, *oil, *the_case.drive, options);
}

double worst_lag(const Trajectory& a, const Trajectory& b) {
  double worst = a.lag.size() == b.lag.size() ? 0 : 1e300;
  for (std::size_t i = 0; i < std::min(a.lag.size(), b.lag.size()); ++i)
    worst = std::max(worst, std::abs(a.lag[i] - b.lag[i]));
  return worst;
}

// Both models integrated by the same method: they are apart by what the tolerance leaves.
TEST(MultibodyTeeth, MoveAsTheClosedFormDoes) {
  Case the_case = teeth_case();
  the_case.drive->duration = 8e-3;
  the_case.drive->samples = 100;
  const auto found = multibody::mechanics(the_case, the_case.multibody);
  const auto closed = analytic::mechanics(the_case, the_case.analytic);
  const Trajectory a = moved(the_case, *closed, 1e-11), b = moved(the_case, *found, 1e-11);
  const Trajectory loose = moved(the_case, *closed, 1e-9);
  const double error = worst_lag(a, loose);
  EXPECT_GT(error, 1e-13);
  EXPECT_LT(worst_lag(a, b), scaled(0.1) * error);
  EXPECT_LT(error, 1e-8);
  ASSERT_EQ(a.record.events.size(), b.record.events.size());
  for (std::size_t i = 0; i < a.record.events.size(); ++i) {
    EXPECT_EQ(a.record.events[i].flank, b.record.events[i].flank);
    EXPECT_NEAR(a.record.events[i].time_s, b.record.events[i].time_s, scaled(1e-8));
    EXPECT_NEAR(a.record.events[i].impulse, b.record.events[i].impulse, scaled(1e-5));
  }
  const Worst worst = worst_difference(a.table.results, b.table.results, true);
  EXPECT_LT(worst.over_peak, scaled(1e-6)) << worst.channel;
}

// Through impacts on both flanks: a tenth of the tolerance leaves less error, and energy and work
// balance.
TEST(MultibodyTeeth, MotionConvergesAndKeepsTheBalanceOfWork) {
  for (const FlankShape shape : {FlankShape::involute, FlankShape::octoid}) {
    Case the_case = teeth_case();
    the_case.multibody.flanks = shape;
    the_case.drive->duration = 8e-3;
    the_case.drive->samples = 100;
    const auto mechanics = multibody::mechanics(the_case, the_case.multibody);
    const Trajectory best = moved(the_case, *mechanics, 1e-12);
    double before = 1e300;
    for (const double tolerance : {1e-7, 1e-9}) {
      const Trajectory motion = moved(the_case, *mechanics, tolerance);
      const double off = worst_lag(motion, best);
      EXPECT_LT(off, before / 5);
      before = off;
    }
    EXPECT_LT(before, 1e-9);
    EXPECT_LT(best.record.worst_work_residual, 1e-8);
    int touches[2] = {};
    for (const ToothEvent& event : best.record.events)
      if (event.touch) ++touches[event.flank > 0];
    EXPECT_GT(touches[0], 0);
    EXPECT_GT(touches[1], 0);
  }
}

TEST(MultibodyTeeth, AreRefusedWhereSimbodyIntegratesItself) {
  const Case the_case = teeth_case();
  const PressureTrace pressure(the_case.pressure);
  const auto message = [](const auto& job) -> std::string {
    try {
      job();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(message([&] { multibody::simulate(the_case, the_case.multibody, pressure); }),
              testing::HasSubstr("[gear] contact = \"teeth\""));
  EXPECT_THAT(message([&] {
                multibody::run_integrated(the_case, the_case.multibody, one_turn(the_case),
                                          pressure, {});
              }),
              testing::HasSubstr("[gear] contact = \"teeth\""));
}

}  // namespace
}  // namespace bentaxis::test
