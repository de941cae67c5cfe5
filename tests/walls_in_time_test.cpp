// Pistons that carry the block while pump and oil are integrated together: mechanics of both
// models, touches, stored trajectory, balances.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/coupled/open_system.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/coupled/stepper.h"
#include "bentaxis/coupled/tooth_watch.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"
#include "support.h"

namespace bentaxis::test {
namespace {

const std::filesystem::path kRoot(BENTAXIS_SOURCE_DIR);
const std::filesystem::path kFree = kRoot / "reference_data" / "motion" / "pistons_seven_free";

Case free_pistons() { return read_case(kFree / "case.toml"); }

// The same pump with the circuit and the oil of the rated one; what it starts with is at rest.
Case pistons_with_oil(DriveKind kind) {
  Case the_case = free_pistons();
  const Case rated = read_case(kRoot / "cases" / "bap63_rated_hydraulic.toml");
  the_case.hydraulics = rated.hydraulics;
  the_case.pressure = rated.pressure;
  the_case.drive->kind = kind;
  if (kind != DriveKind::speed) {
    the_case.pump.shaft.axial_inertia = 0.004;
    the_case.drive->torque = 250;
    the_case.drive->start_speed = 150;
  }
  return the_case;
}

coupled::Options within(double tolerance) {
  coupled::Options options;
  options.tolerance = tolerance;
  return options;
}

std::unique_ptr<Mechanics> mechanics_of(const Case& the_case, bool multibody) {
  return multibody ? multibody::mechanics(the_case, the_case.multibody)
                   : analytic::mechanics(the_case, the_case.analytic);
}

Trajectory prescribed(const Case& the_case, double tolerance, bool multibody = false) {
  const PressureTrace pressure(the_case.pressure);
  const auto oil =
      coupled::prescribed_oil(the_case.pump.geometry.pistons, pressure, the_case.pressure.ports);
  return coupled::simulate(multibody ? "multibody" : "analytic", *mechanics_of(the_case, multibody),
                           *oil, *the_case.drive, within(tolerance));
}

Trajectory with_oil(const Case& the_case, double tolerance, bool multibody) {
  const auto oil = hydraulics::oil_in_time(the_case, {});
  return coupled::simulate("pump", *mechanics_of(the_case, multibody), *oil, *the_case.drive,
                           within(tolerance));
}

double worst_apart(const Trajectory& a, const Trajectory& b) {
  const ResultTable& x = a.table.results;
  const ResultTable& y = b.table.results;
  double worst = 0;
  int compared = 0;
  for (std::size_t c = 0; c < x.columns(); ++c) {
    const double peak = x.peak(x.channels[c].group);
    if (x.channels[c].kind != ChannelKind::reaction || !(peak > 0)) continue;
    for (std::size_t row = 0; row < x.rows(); ++row) {
      if (!is_computed(x.at(row, c))) continue;
      worst = std::max(worst, std::abs(x.at(row, c) - y.at(row, c)) / peak);
      ++compared;
    }
  }
  return compared > 1000 ? worst : 1e300;
}

// States within the free play, at its ends and well into a wall.
struct RandomWalls {
  explicit RandomWalls(RandomPump& random) : the_case(free_pistons()) {
    DriveSpec& drive = *the_case.drive;
    drive.kind = static_cast<DriveKind>(static_cast<int>(random.in(0, 2.999)));
    the_case.pump.shaft.axial_inertia = random.in(1e-3, 1e-2);
    the_case.pump.transfer.wall->exponent = random.in(1, 2);
    the_case.pump.transfer.wall->dissipation = random.in(0, 2);
    if (drive.kind == DriveKind::motor) drive.motor = MotorData{8, 0.05, 5000, 2};
    drive.torque = 200;
    for (int k = 0; k < the_case.pump.geometry.pistons; ++k)
      loads.chamber_pressure.push_back(random.in(0, 4e7));
    loads.ports = {random.in(-1e5, 1e6), random.in(0, 4e7)};
    time = random.in(0, 0.1);
    y[kLag] = random.in(-0.028, 0.028);
    y[kLagRate] = random.in(-3, 3);
    if (drive.kind != DriveKind::speed) {
      y[kTurn] = random.in(-4, 7);
      y[kTurnRate] = random.in(-200, 200);
    }
    if (drive.kind == DriveKind::motor) {
      y[kTwist] = random.in(-0.1, 0.1);
      y[kTwistRate] = random.in(-20, 20);
    }
  }
  double torque() const {
    const Geometry& g = the_case.pump.geometry;
    double force = 0;
    for (const double p : loads.chamber_pressure)
      force += p * kPi / 4 * std::pow(g.bore_diameter, 2);
    return force * g.joint_circle_radius;
  }

  Case the_case;
  OilLoads loads;
  double time = 0;
  MotionVector y{};
};

TEST(WallMechanics, BothModelsAgreeAtRandomStates) {
  RandomPump random(301);
  int touching = 0, apart = 0, several = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    const RandomWalls at(random);
    const auto a = mechanics_of(at.the_case, false);
    const auto b = mechanics_of(at.the_case, true);
    ASSERT_EQ(a->contacts(), (std::vector<int>{1, 2, 3, 4, 5, 6, 7}));
    ASSERT_EQ(b->contacts(), a->contacts());
    double wall = 0, sum = 0;  // of the law, N
    int count = 0;
    const WallContact& law = *at.the_case.pump.transfer.wall;
    for (const int piston : a->contacts()) {
      const double x = a->approach(at.time, at.y, piston);
      const double rate = a->approach_rate(at.time, at.y, piston);
      EXPECT_NEAR(x, b->approach(at.time, at.y, piston), 1e-14);
      EXPECT_NEAR(rate, b->approach_rate(at.time, at.y, piston), 1e-12);
      if (x <= 0) continue;
      const double force = law.stiffness * kWallApproach *
                           std::pow(x / kWallApproach, law.exponent) *
                           std::max(0.0, 1 + law.dissipation * rate);
      sum += force;
      wall = std::max(wall, force);
      ++count;
    }
    touching += count > 0;
    several += count > 1;
    apart += count == 0;
    const double torque = at.torque() + wall * at.the_case.pump.geometry.joint_circle_radius;
    const double round_off = 1e-14 * law.stiffness *
                             std::pow(wall / law.stiffness / 1e-6 + 1, 0.5) *
                             at.the_case.pump.geometry.joint_circle_radius * 10;
    MotionVector by_a, by_b;
    a->rates(at.time, at.y, at.loads, by_a);
    b->rates(at.time, at.y, at.loads, by_b);
    const double inertia = at.the_case.pump.block.axial_inertia;
    for (const std::size_t i : {kTurnRate, kLagRate, kTwistRate})
      EXPECT_NEAR(by_a[i], by_b[i], (scaled(1e-10) * torque + round_off) / inertia) << i;
    for (const std::size_t i : {kWorkOfLoads, kWorkOfDrive})
      EXPECT_NEAR(by_a[i], by_b[i], (scaled(1e-10) * torque + round_off) * 300) << i;
    EXPECT_NEAR(by_a[kImpulse], sum, scaled(1e-12) * sum);
    EXPECT_NEAR(by_b[kImpulse], sum, scaled(1e-9) * (sum + 1) + 100 * round_off);
    EXPECT_NEAR(a->elastic_energy(at.time, at.y), b->elastic_energy(at.time, at.y),
                scaled(1e-9) * (1 + a->elastic_energy(at.time, at.y)));
    const MotionVector scales_a = a->scales(), scales_b = b->scales();
    for (std::size_t i = 0; i < kMotionStates; ++i)
      if (by_a[i] != 0) {
        EXPECT_NEAR(std::log10(scales_a[i] / scales_b[i]), 0, 1.5) << i;
      }
  }
  EXPECT_GT(touching, 15);
  EXPECT_GT(several, 2);
  EXPECT_GT(apart, 15);
}

TEST(WallMechanics, WorkIsTheEnergyGained) {
  RandomPump random(302);
  for (int n = 0; n < 40; ++n) {
    const RandomWalls at(random);
    for (const bool multibody : {false, true}) {
      const auto mechanics = mechanics_of(at.the_case, multibody);
      MotionVector dy;
      mechanics->rates(at.time, at.y, at.loads, dy);
      constexpr double kStep = 1e-7;  // s
      const auto energy = [&](double step) {
        MotionVector y = at.y;
        for (std::size_t i = 0; i < y.size(); ++i) y[i] += step * dy[i];
        return mechanics->kinetic_energy(at.time + step, y) +
               mechanics->elastic_energy(at.time + step, y);
      };
      const double gained =
          (8 * (energy(kStep) - energy(-kStep)) - (energy(2 * kStep) - energy(-2 * kStep))) /
          (12 * kStep);
      double wall = dy[kImpulse];
      EXPECT_NEAR(dy[kWorkOfLoads] + dy[kWorkOfDrive], gained,
                  scaled(1e-7) * (at.torque() * 300 + wall))
          << n << (multibody ? " multibody" : " analytic");
    }
  }
}

// Stored to 50 digits: made by another program, touch by touch.
TEST(WallsUnderPressure, MeetTheStoredTrajectory) {
  const Case the_case = free_pistons();
  const NumericTable reference = read_numeric_csv(kFree / "reference.csv");
  for (const bool multibody : {false, true}) {
    const Trajectory t = prescribed(the_case, 1e-11, multibody);
    ASSERT_EQ(reference.rows.size(), t.lag.size());
    const ResultTable& table = t.table.results;
    int compared = 0;
    for (std::size_t c = 0; c < reference.header.size(); ++c) {
      const std::size_t column = table.find(reference.header[c]);
      if (column >= table.columns() || table.channels[column].kind != ChannelKind::reaction)
        continue;
      const double peak = table.peak(table.channels[column].group);
      if (!(peak > 0)) continue;
      double worst = 0;
      for (std::size_t row = 0; row < t.lag.size(); ++row)
        worst = std::max(worst, std::abs(table.at(row, column) - reference.rows[row][c]) / peak);
      // As the stored curves' README says of integrations: growth of errors by impacts.
      EXPECT_LT(worst, scaled(multibody ? 1e-5 : 1e-6)) << reference.header[c] << multibody;
      ++compared;
    }
    EXPECT_GT(compared, 40);
  }
}

// Touches as the analytic simulation finds them, which lands on them by a method of its own.
TEST(WallsUnderPressure, TouchesAreThoseOfTheAnalyticSimulation) {
  const Case the_case = free_pistons();
  const Trajectory a =
      analytic::simulate(the_case, the_case.analytic, PressureTrace(the_case.pressure));
  const Trajectory b = prescribed(the_case, 1e-11);
  // A wall that is still pressed in but gives no force is a release there, and none here.
  const auto touches = [](const Trajectory& t) {
    std::vector<ToothEvent> all;
    for (const ToothEvent& event : t.record.events)
      if (event.touch && event.approach_speed > 1e-6) all.push_back(event);
    return all;
  };
  const auto x = touches(a), y = touches(b);
  ASSERT_EQ(x.size(), y.size());
  EXPECT_GT(x.size(), 10U);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(x[i].piston, y[i].piston) << i;
    EXPECT_EQ(x[i].flank, y[i].flank) << i;
    EXPECT_NEAR(x[i].time_s, y[i].time_s, scaled(1e-8)) << i;
    EXPECT_NEAR(x[i].approach_speed, y[i].approach_speed, scaled(1e-5)) << i;
  }
  EXPECT_NEAR(a.record.share_out_of_contact, b.record.share_out_of_contact, 0.02);
}

// Times on either side, apart and how often a piston left, from the list of touches alone.
TEST(WallsUnderPressure, WatchAddsUpTheTouchesOfAllPistons) {
  const Case the_case = free_pistons();
  const Trajectory run = prescribed(the_case, 1e-10);
  const double end = the_case.drive->duration;
  coupled::ContactInterval wanted;
  std::map<int, int> side;  // of the pistons that touch
  double since = 0;
  const auto pass = [&](double until) {
    const auto any = [&](int wanted_side) {
      return std::any_of(side.begin(), side.end(),
                         [&](const auto& one) { return one.second == wanted_side; });
    };
    if (any(1)) wanted.plus += until - since;
    if (any(-1)) wanted.minus += until - since;
    if (side.empty()) wanted.apart += until - since;
    since = until;
  };
  for (const ToothEvent& event : run.record.events) {
    pass(event.time_s);
    wanted.separations += event.touch ? 0 : 1;
    if (event.touch)
      side[event.piston] = event.flank;
    else
      side.erase(event.piston);
  }
  pass(end);
  const PressureTrace pressure(the_case.pressure);
  const auto oil = coupled::prescribed_oil(7, pressure, the_case.pressure.ports);
  const auto mechanics = mechanics_of(the_case, false);
  coupled::ToothWatch watch("analytic", *mechanics, *oil, 1e-10, 1e-3);
  watch.start(mechanics->start());
  const coupled::ContactInterval found = watch.run_to(end);
  EXPECT_GT(wanted.separations, 10);
  EXPECT_GT(wanted.apart, 0.01 * end);
  EXPECT_EQ(found.separations, wanted.separations);
  EXPECT_NEAR(found.apart, wanted.apart, scaled(1e-6) * end);
  EXPECT_NEAR(found.plus, wanted.plus, scaled(1e-6) * end);
  EXPECT_NEAR(found.minus, wanted.minus, scaled(1e-6) * end);
}

TEST(WallsWithOil, BothModelsMoveAlike) {
  for (const DriveKind kind : {DriveKind::speed, DriveKind::torque}) {
    Case the_case = pistons_with_oil(kind);
    the_case.drive->duration = 0.01;
    the_case.drive->samples = 50;
    const Trajectory a = with_oil(the_case, 1e-10, false);
    const Trajectory b = with_oil(the_case, 1e-10, true);
    EXPECT_LT(worst_apart(a, b), scaled(1e-5));
    // The block moves on its own, and so do the chambers.
    double play = 0;
    for (const double lag : a.lag) play = std::max(play, std::abs(lag));
    EXPECT_GT(play, 1e-3);
    EXPECT_GT(a.record.events.size(), 2U);
    ASSERT_EQ(a.record.events.size(), b.record.events.size());
  }
}

// Energy, mass, and what the pistons do to the oil against what the oil gets from its volumes: a
// stroke that were not that of theta and psi would show here.
TEST(WallsWithOil, BalancesCloseWithTheTolerance) {
  const Case the_case = pistons_with_oil(DriveKind::speed);
  double before = 1e300;
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    const Trajectory run = with_oil(the_case, tolerance, false);
    const double input = std::abs(run.record.work_of_drives);
    EXPECT_GT(input, 50);
    const OilHistory& oil = *run.oil;
    const double worst = std::max({run.record.worst_work_residual, oil.worst_energy_residual,
                                   oil.worst_exchange_residual}) /
                         input;
    EXPECT_LT(worst, scaled(1e4) * tolerance);
    EXPECT_LT(worst, before);
    EXPECT_LT(oil.worst_mass_residual / oil.mass_in, scaled(1e4) * tolerance);
    before = worst;
  }
}

// What an integration outside is given: rates, and the approach of every piston as an indicator.
TEST(WallsWithOil, OpenSystemHasAnIndicatorForEachPiston) {
  const Case the_case = pistons_with_oil(DriveKind::speed);
  const auto oil = hydraulics::oil_in_time(the_case, {});
  const auto mechanics = mechanics_of(the_case, false);
  coupled::OpenSystem system(*mechanics, *oil, false);
  std::vector<std::string> walls;
  for (const auto& indicator : system.indicators())
    if (indicator.name.rfind("wall_", 0) == 0) walls.push_back(indicator.name);
  EXPECT_EQ(walls.size(), 7U);
  coupled::SystemState state{mechanics->start(), oil->start()};
  state.motion[kLag] = 0.02;
  system.start(0, state);
  std::vector<double> values;
  system.indicator_values(values);
  ASSERT_EQ(values.size(), system.indicators().size());
  for (int k = 1; k <= 7; ++k)
    EXPECT_EQ(values[values.size() - 8 + k], mechanics->approach(0, state.motion, k));
}

TEST(WallsWithOil, StepperPassesOnTouchesWithTheirPiston) {
  const Case the_case = pistons_with_oil(DriveKind::speed);
  const auto oil = hydraulics::oil_in_time(the_case, {});
  const auto mechanics = mechanics_of(the_case, false);
  coupled::Stepper stepper("analytic", *mechanics, *oil, 1e-8);
  stepper.start(0, {mechanics->start(), oil->start()}, 0.02);
  int touches = 0;
  for (int i = 1; i <= 20; ++i) {
    stepper.step_to(0.001 * i);
    for (const auto& event : stepper.passed())
      if (event.kind == coupled::PassedEvent::Kind::touch) {
        EXPECT_GE(event.piston, 1);
        EXPECT_LE(event.piston, 7);
        ++touches;
      }
  }
  EXPECT_GT(touches, 2);
  // Step by step an event is at the end of its step; the next one does not tell it again.
  stepper.start(0, {mechanics->start(), oil->start()}, 0.02);
  std::vector<double> times;
  while (stepper.time() < 0.02) {
    stepper.step_towards(0.02);
    for (const auto& event : stepper.passed())
      if (event.kind == coupled::PassedEvent::Kind::touch) {
        EXPECT_EQ(event.time, stepper.time());
        times.push_back(event.time);
      }
  }
  EXPECT_EQ(static_cast<int>(times.size()), touches);
}

}  // namespace
}  // namespace bentaxis::test
