// Oil, pump and drive as one system: small systems whose motion is known, then the pump.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <latch>
#include <map>
#include <numeric>
#include <thread>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/coupled/tooth_watch.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/pump/error.h"
#include "support.h"
#include "system.h"

namespace bentaxis::test {
namespace {

using coupled::Options;
using coupled::simulate;
using coupled::steady;
using coupled::SteadyMotion;

constexpr int kPistons = 5;
constexpr double kStroke = 1e-5;  // m3, of a toy chamber

DriveSpec drive_for(double duration, int samples) {
  DriveSpec drive;
  drive.kind = DriveKind::torque;
  drive.duration = duration;
  drive.samples = samples;
  return drive;
}

Options within(double tolerance) {
  Options options;
  options.tolerance = tolerance;
  return options;
}

// One body: J w' = torque + swing cos(N theta) - spring theta - viscous w - drag w|w| + pressures.
class OneShaft : public Mechanics {
 public:
  double inertia = 0.01, torque = 0, swing = 0, spring = 0, viscous = 0, drag = 0, start_speed = 0;
  double strange_after = 1e300;  // s: no accelerations then
  std::optional<double> given_speed;
  mutable long asked = 0;

  const ChannelLayout& layout() const override { return layout_; }
  MotionVector start() const override { return {}; }
  MotionVector scales() const override {
    MotionVector s;
    s.fill(1);
    s[kTurn] = 0.1;
    s[kTurnRate] = 10;
    s[kWorkOfLoads] = s[kWorkOfDrive] = 10;
    return s;
  }
  bool shaft_is_free() const override { return !given_speed; }
  bool compliant() const override { return false; }
  bool has_motor() const override { return false; }
  std::vector<double> breakpoints() const override { return {}; }
  AxisMotion shaft(double time, const MotionVector& y) const override {
    const double speed = given_speed.value_or(start_speed);
    return {speed * time + y[kTurn], speed + y[kTurnRate], 0};
  }
  AxisMotion block(double time, const MotionVector& y) const override { return shaft(time, y); }
  double approach(double, const MotionVector&, int) const override { return -1; }
  double approach_rate(double, const MotionVector&, int) const override { return 0; }
  void rates(double time, const MotionVector& y, const OilLoads& loads, MotionVector& dy) override {
    ++asked;
    if (time > strange_after) throw ComputationError("the shaft has melted");
    const AxisMotion m = shaft(time, y);
    const double by_oil = pressure_power(time, y, loads);
    const double friction = -(viscous + drag * std::abs(m.speed)) * m.speed;
    const double driving = torque + swing * std::cos(kPistons * m.angle) - spring * m.angle;
    dy.fill(0);
    double slope = 0;
    for (int k = 0; k < kPistons; ++k)
      slope += loads.chamber_pressure[k] * volume_slope(m.angle, k);
    if (!given_speed) {
      dy[kTurn] = y[kTurnRate];
      dy[kTurnRate] = (driving + friction + slope) / inertia;
    }
    dy[kWorkOfLoads] = by_oil + friction * m.speed;
    dy[kWorkOfDrive] = (given_speed ? -friction - slope : driving) * m.speed;
  }
  double pressure_power(double time, const MotionVector& y, const OilLoads& loads) override {
    const AxisMotion m = shaft(time, y);
    double power = 0;
    for (int k = 0; k < kPistons; ++k)
      power += loads.chamber_pressure[k] * volume_slope(m.angle, k) * m.speed;
    return power;
  }
  void row(double time, const MotionVector& y, const OilLoads&, std::vector<double>& state,
           std::vector<double>& row, MotionChecks& checks) override {
    const AxisMotion m = shaft(time, y);
    state = {time, m.angle / kRadPerDegree, m.angle / kRadPerDegree, m.speed / kRadPerSecondPerRpm,
             m.speed / kRadPerSecondPerRpm};
    row.assign(layout_.size(), not_computed());
    checks = {0, 0, 0};
  }
  double kinetic_energy(double time, const MotionVector& y) override {
    return inertia / 2 * std::pow(shaft(time, y).speed, 2);
  }
  double potential_energy(const MotionVector&) const override { return 0; }

  /// V_k = .. + stroke/2 cos(psi - 72 k).
  static double volume_slope(double angle, int k) {
    return -kStroke / 2 * std::sin(angle - 2 * kPi * k / kPistons);
  }

 private:
  ChannelLayout layout_{kPistons};
};

// Chambers of a linear spring of oil between two ports of linear resistance that open as the sine
// does, and a volume with a linear load. All rates are linear in the pressures.
class LinearOil : public Oil {
 public:
  double softness = 2e-14;  // m3/Pa of a chamber: V/K
  double opening = 5e-10;   // m3/s/Pa of a port, fully open
  double delivery_softness = 1e-12, load = 1e-10;
  static constexpr double kDensity = 850;

  int pistons() const override { return kPistons; }
  int states() const override { return kPistons + 1; }
  std::vector<double> start() const override { return std::vector<double>(kPistons + 1, 0.0); }
  std::vector<double> scales() const override { return std::vector<double>(kPistons + 1, 1e7); }
  std::vector<double> edges_deg() const override {
    std::vector<double> edges;
    for (int i = 0; i < 2 * kPistons; ++i) edges.push_back(180.0 / kPistons * i);
    return edges;
  }
  std::vector<double> breakpoint_times;
  std::vector<double> breakpoints() const override { return breakpoint_times; }
  std::vector<int> order_after_period() const override {
    std::vector<int> order;  // after 72 degrees piston k+1 is where piston k was
    for (int k = 0; k < kPistons; ++k) order.push_back((k + 1) % kPistons);
    order.push_back(kPistons);
    return order;
  }
  static double chamber(double angle, int k) { return angle - 2 * kPi * k / kPistons; }
  double to_delivery(double angle) const { return opening * std::max(0.0, std::sin(angle)); }
  double to_suction(double angle) const { return opening * std::max(0.0, -std::sin(angle)); }

  bool rates(double, const AxisMotion&, const AxisMotion& block, const double* p,
             double* dp) const override {
    dp[kPistons] = -load * p[kPistons];
    for (int k = 0; k < kPistons; ++k) {
      const double a = chamber(block.angle, k);
      const double out = to_delivery(a) * (p[k] - p[kPistons]);
      dp[k] = (-OneShaft::volume_slope(block.angle, k) * block.speed - out - to_suction(a) * p[k]) /
              softness;
      dp[kPistons] += out;
    }
    dp[kPistons] /= delivery_softness;
    return true;
  }
  void jacobian(double, const AxisMotion&, const AxisMotion& block, const double*,
                double* j) const override {
    constexpr int kSize = kPistons + 1;
    std::fill(j, j + kSize * kSize, 0.0);
    j[kPistons * kSize + kPistons] = -load / delivery_softness;
    for (int k = 0; k < kPistons; ++k) {
      const double a = chamber(block.angle, k);
      j[k * kSize + k] = -(to_delivery(a) + to_suction(a)) / softness;
      j[kPistons * kSize + k] = to_delivery(a) / softness;
      j[k * kSize + kPistons] = to_delivery(a) / delivery_softness;
      j[kPistons * kSize + kPistons] -= to_delivery(a) / delivery_softness;
    }
  }
  void loads(double, const AxisMotion&, const double* p, OilLoads& loads) const override {
    loads.chamber_pressure.assign(p, p + kPistons);
    loads.ports = {0, p[kPistons]};
  }
  std::vector<OilPlace> places() const override {
    return {{"pistons", "pistons", PowerUse::source},
            {"load", "load", PowerUse::delivered},
            {"ports", "ports", PowerUse::loss}};
  }
  void powers(double, const AxisMotion&, const AxisMotion& block, const double* p, double* power,
              double& mass_in, double& mass_out) const override {
    power[0] = power[2] = mass_in = 0;
    for (int k = 0; k < kPistons; ++k) {
      const double a = chamber(block.angle, k);
      power[0] -= p[k] * OneShaft::volume_slope(block.angle, k) * block.speed;
      power[2] += to_delivery(a) * std::pow(p[k] - p[kPistons], 2) + to_suction(a) * p[k] * p[k];
      mass_in -= to_suction(a) * p[k] * kDensity;
    }
    power[1] = load * p[kPistons] * p[kPistons];
    mass_out = load * p[kPistons] * kDensity;
  }
  void stored(double, const AxisMotion&, const AxisMotion& block, const double* p, double& energy,
              double& mass) const override {
    energy = delivery_softness * p[kPistons] * p[kPistons] / 2;
    mass = delivery_softness * p[kPistons] * kDensity;
    for (int k = 0; k < kPistons; ++k) {
      energy += softness * p[k] * p[k] / 2;
      mass += kDensity * (softness * p[k] + kStroke * (1 + std::cos(chamber(block.angle, k)) / 2));
    }
  }
  std::vector<OilColumn> columns() const override { return {{"p_bar", "delivery pressure"}}; }
  void row(double, const AxisMotion&, const AxisMotion&, const double* p,
           double* values) const override {
    values[0] = p[kPistons] / 1e5;
  }
};

// A pump that starts from rest against its load.
OneShaft starting_pump() {
  OneShaft shaft;
  shaft.torque = 40;
  shaft.viscous = 0.05;
  return shaft;
}

PressureTrace no_pressure() {
  PressureSpec spec;
  spec.transition_deg = 20;
  return PressureTrace(spec);
}

std::vector<double> angles(const Trajectory& t) {
  std::vector<double> values;
  for (std::size_t row = 0; row < t.lag.size(); ++row)
    values.push_back(radians(t.table.state(row, 1)));
  return values;
}

double worst_apart(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = a.size() == b.size() ? 0 : 1e300;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

// ---- the integration ---------------------------------------------------------------------------

// Written for 1.0.0, whose names of these two were others.
class ShaftOf100 : public OneShaft {
 public:
  bool told = false;
  std::vector<double> breakpoints() const override { return Mechanics::breakpoints(); }
  std::vector<double> knots() const override { return {0.5, 1}; }
  void surround(const Surroundings& /*outside*/) override { told = true; }
};

class ShaftOfToday : public OneShaft {
 public:
  std::vector<double> breakpoints() const override { return {2}; }
};

TEST(NamesOf100, OverriddenAreCalled) {
  ShaftOf100 shaft;
  Mechanics& mechanics = shaft;
  EXPECT_THAT(mechanics.breakpoints(), testing::ElementsAre(0.5, 1));
  mechanics.set_inputs({});
  EXPECT_TRUE(shaft.told);
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
TEST(NamesOf100, CalledReachThoseOfToday) {
  ShaftOfToday shaft;
  Mechanics& mechanics = shaft;
  EXPECT_THAT(mechanics.knots(), testing::ElementsAre(2));
  EXPECT_THROW(mechanics.surround({}), std::logic_error);  // it takes nothing
  const PressureTrace pressure = no_pressure();
  const auto oil = coupled::prescribed_oil(kPistons, pressure, {});
  Surroundings outside;
  outside.delivery = 3e5;
  oil->surround(outside);
  OilLoads loads;
  oil->loads(0, {}, nullptr, loads);
  EXPECT_EQ(*std::max_element(loads.chamber_pressure.begin(), loads.chamber_pressure.end()), 3e5);
}
#pragma GCC diagnostic pop

// Forwards, to a stop, and backwards, over edges in both directions: known in closed form. The
// second comes to its stop on an edge, to rounding.
TEST(Integration, ThroughStandstillAndBack) {
  const PressureTrace pressure = no_pressure();
  const auto oil = coupled::prescribed_oil(kPistons, pressure, {});
  ASSERT_FALSE(oil->edges_deg().empty());
  for (const double top : {1.0, radians(oil->edges_deg()[3]), 0.0}) {
    OneShaft shaft;
    shaft.inertia = 0.01;
    shaft.torque = -2;
    const double slowing = shaft.torque / shaft.inertia;
    shaft.start_speed = std::sqrt(2 * -slowing * top);
    const Trajectory t = simulate("toy", shaft, *oil, drive_for(0.5, 500), within(1e-10));
    for (std::size_t row = 0; row < t.lag.size(); ++row) {
      const double time = t.table.state(row, 0);
      ASSERT_NEAR(radians(t.table.state(row, 1)),
                  shaft.start_speed * time + slowing * time * time / 2, scaled(1e-8))
          << time;
    }
    EXPECT_LT(t.record.steps, 20000);
    EXPECT_FALSE(t.oil.has_value());
  }
}

// Swings about an edge of the ports and comes to rest on it.
TEST(Integration, RestOnAnEdgeDoesNotChatter) {
  for (const double viscous : {0.2, 0.02}) {
    LinearOil oil;
    oil.opening = 1e-7;
    OneShaft shaft;
    shaft.spring = 30;
    shaft.viscous = viscous;
    shaft.start_speed = 30;
    ASSERT_EQ(oil.edges_deg().front(), 0);
    const Trajectory t = simulate("toy", shaft, oil, drive_for(20, 20), within(1e-8));
    EXPECT_NEAR(angles(t).back(), 0, 1e-6);
    EXPECT_LT(t.record.steps, 20000);
  }
}

// A block between two springs under a steady pull, without friction, at a given speed of the shaft:
// lag'' = -pull - w^2 overlap.
class Bouncing : public OneShaft {
 public:
  double pull = 10, stiffness = 1e8, half_backlash = 1e-3, first_rate = 0;

  Bouncing() { given_speed = 1; }
  bool compliant() const override { return true; }
  MotionVector start() const override {
    MotionVector y{};
    y[kLag] = -half_backlash;
    y[kLagRate] = first_rate;
    return y;
  }
  MotionVector scales() const override {
    MotionVector s = OneShaft::scales();
    s[kLag] = 1e-5;
    s[kLagRate] = 0.1;
    return s;
  }
  AxisMotion block(double time, const MotionVector& y) const override {
    AxisMotion m = shaft(time, y);
    m.angle -= y[kLag];
    m.speed -= y[kLagRate];
    return m;
  }
  double approach(double, const MotionVector& y, int flank) const override {
    return flank * y[kLag] - half_backlash;
  }
  double approach_rate(double, const MotionVector& y, int flank) const override {
    return flank * y[kLagRate];
  }
  void rates(double, const MotionVector& y, const OilLoads&, MotionVector& dy) override {
    dy.fill(0);
    dy[kLag] = y[kLagRate];
    dy[kLagRate] = -pull;
    for (const int flank : {1, -1}) {
      const double force = stiffness * std::max(0.0, approach(0, y, flank));
      dy[kLagRate] -= flank * force;
      dy[kImpulse] += force;
    }
  }
};

TEST(Teeth, BouncesAreWhereTheyMustBe) {
  const PressureTrace pressure = no_pressure();
  const auto oil = coupled::prescribed_oil(kPistons, pressure, {});
  Bouncing block;
  block.first_rate = 0.19;  // it nearly gets to the other flank: 1.805 of 2 mm
  const double flight = 2 * block.first_rate / block.pull;
  const double w = std::sqrt(block.stiffness);
  const double contact = 2 / w * (kPi - std::atan(block.first_rate * w / block.pull));
  DriveSpec drive = drive_for(10.5 * (flight + contact), 10);
  drive.kind = DriveKind::speed;
  const Trajectory t = simulate("toy", block, *oil, drive, within(1e-11));
  ASSERT_EQ(t.record.events.size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) {
    const ToothEvent& event = t.record.events[i];
    EXPECT_EQ(event.touch, i % 2 == 0);
    EXPECT_EQ(event.flank, -1);
    const std::size_t bounces = i / 2;
    const double since = flight + (event.touch ? 0 : contact);
    EXPECT_NEAR(event.time_s, static_cast<double>(bounces) * (flight + contact) + since,
                scaled(1e-8));
    EXPECT_NEAR(event.approach_speed, event.touch ? 0.19 : -0.19, scaled(1e-8));
    EXPECT_NEAR(event.shaft_speed - event.block_speed, event.touch ? -0.19 : 0.19, scaled(1e-8));
    // What turns it round, and holds it against the pull.
    EXPECT_NEAR(event.impulse, event.touch ? 2 * 0.19 + block.pull * contact : 0, scaled(1e-8));
  }
  EXPECT_NEAR(t.record.share_out_of_contact, 1 - 10 * contact / drive.duration, scaled(1e-8));
}

// A touch far shorter than the steps of the flight, which are long: a parabola is followed exactly.
TEST(Teeth, GrazingTouchIsSeen) {
  const PressureTrace pressure = no_pressure();
  const auto oil = coupled::prescribed_oil(kPistons, pressure, {});
  Bouncing block;
  constexpr double kDepth = 1e-8;
  block.first_rate = std::sqrt(2 * block.pull * (2 * block.half_backlash + kDepth));
  DriveSpec drive = drive_for(1.5 * block.first_rate / block.pull, 3);
  drive.kind = DriveKind::speed;
  const Trajectory t = simulate("toy", block, *oil, drive, within(1e-9));
  ASSERT_EQ(t.record.events.size(), 2U);
  const ToothEvent& touch = t.record.events[0];
  EXPECT_EQ(touch.flank, 1);
  const double speed = std::sqrt(2 * block.pull * kDepth);
  EXPECT_NEAR(touch.approach_speed, speed, 1e-3 * speed);
  EXPECT_NEAR(touch.time_s, (block.first_rate - speed) / block.pull, 1e-6);
  EXPECT_FALSE(t.record.events[1].touch);
  // The pull helps the spring.
  const double w = std::sqrt(block.stiffness);
  const double contact = 2 / w * std::atan(speed * w / block.pull);
  EXPECT_NEAR(t.record.events[1].time_s - touch.time_s, contact, 1e-3 * contact);
  EXPECT_NEAR(touch.impulse, 2 * speed - block.pull * contact, 1e-3 * speed);
}

TEST(Integration, BalancesCloseWithTheTolerance) {
  std::map<double, Trajectory> runs;
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    OneShaft shaft = starting_pump();
    LinearOil oil;
    runs[tolerance] = simulate("toy", shaft, oil, drive_for(0.2, 50), within(tolerance));
  }
  double before = 0;
  const double input = runs[1e-10].record.work_of_drives;
  EXPECT_GT(input, 100);
  for (auto run = runs.begin(); run != runs.end(); ++run) {
    const OilHistory& oil = *run->second.oil;
    const double worst = std::max({run->second.record.worst_work_residual,
                                   oil.worst_energy_residual, oil.worst_exchange_residual}) /
                         input;
    const double mass = oil.worst_mass_residual / oil.mass_in;
    EXPECT_LT(worst, scaled(1e3) * run->first);
    EXPECT_LT(mass, scaled(1e3) * run->first);
    EXPECT_GT(worst, before);
    before = worst;
    // The pistons' work is not nothing.
    EXPECT_GT(oil.energies[0].energy, 1);
    EXPECT_GT(oil.mass_in, 1e-3);
  }
  const std::vector<double> exact = angles(runs[1e-10]);
  const double loose = worst_apart(angles(runs[1e-6]), exact);
  const double tight = worst_apart(angles(runs[1e-8]), exact);
  EXPECT_LT(tight, scaled(loose / 10));
  EXPECT_LT(loose, 1e-3);
}

TEST(Integration, RowsAndHistoryAreOfTheSameInstants) {
  OneShaft shaft = starting_pump();
  LinearOil oil;
  const Trajectory t = simulate("toy", shaft, oil, drive_for(0.1, 7));
  ASSERT_EQ(t.lag.size(), 8U);
  ASSERT_EQ(t.oil->values.size(), 8U);
  Options options;
  options.times = {0, t.table.state(3, 0), 0.1};
  OneShaft again = starting_pump();
  const Trajectory some = simulate("toy", again, oil, drive_for(0.1, 7), options);
  ASSERT_EQ(some.lag.size(), 3U);
  EXPECT_EQ(some.table.state(1, 1), t.table.state(3, 1));
  EXPECT_EQ(some.oil->value(1, 0), t.oil->value(3, 0));
  EXPECT_NE(some.record.choice.find("BDF"), std::string::npos);
}

// A torque that begins to rise at a breakpoint of its own, and what it was asked for.
class RisingTorque : public OneShaft {
 public:
  double rises_at = 0.0333;
  bool tells = true;  // of the breakpoint
  std::vector<double> times;

  RisingTorque() : OneShaft(starting_pump()) {}
  std::vector<double> breakpoints() const override {
    return tells ? std::vector<double>{rises_at} : std::vector<double>{};
  }
  void rates(double time, const MotionVector& y, const OilLoads& loads, MotionVector& dy) override {
    times.push_back(time);
    torque = 40 + 1e4 * std::max(0.0, time - rises_at);
    OneShaft::rates(time, y, loads, dy);
  }
  // A step ended there, and no other reached over it.
  bool stopped_at(double breakpoint) const {
    const auto beyond =
        std::find_if(times.begin(), times.end(), [&](double t) { return t > breakpoint; });
    return beyond != times.end() && std::find(times.begin(), beyond, breakpoint) != beyond &&
           std::all_of(beyond, times.end(), [&](double t) { return t >= breakpoint; });
  }
};

TEST(Integration, KnotsEndSteps) {
  LinearOil oil;
  oil.breakpoint_times = {0.05};
  RisingTorque shaft, silent;
  const Trajectory with = simulate("toy", shaft, oil, drive_for(0.1, 5), within(1e-10));
  EXPECT_TRUE(shaft.stopped_at(shaft.rises_at));
  EXPECT_TRUE(shaft.stopped_at(0.05));
  oil.breakpoint_times = {};
  silent.tells = false;
  const Trajectory without = simulate("toy", silent, oil, drive_for(0.1, 5), within(1e-10));
  EXPECT_FALSE(silent.stopped_at(shaft.rises_at));
  EXPECT_FALSE(silent.stopped_at(0.05));
  EXPECT_LT(worst_apart(angles(with), angles(without)), scaled(1e-7));
}

TEST(Integration, DisturbanceMovesTheStart) {
  OneShaft shaft = starting_pump(), other = starting_pump();
  LinearOil oil;
  Options moved = within(1e-10);
  moved.disturbance = 1e-3;
  const Trajectory a = simulate("toy", shaft, oil, drive_for(0.01, 1), within(1e-10));
  const Trajectory b = simulate("toy", other, oil, drive_for(0.01, 1), moved);
  EXPECT_NEAR(radians(b.table.state(0, 3) - a.table.state(0, 3)) * 6, 1e-3 * 10, 1e-12);
  EXPECT_NEAR(b.oil->value(0, 0) - a.oil->value(0, 0), 1e-3 * 100, 1e-9);
}

TEST(Integration, FailuresNameModelTimeAndCause) {
  OneShaft shaft = starting_pump();
  shaft.strange_after = 0.05;
  LinearOil oil;
  try {
    simulate("toy", shaft, oil, drive_for(0.1, 5));
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_NE(std::string(error.what()).find("toy model"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(" 0.0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("melted"), std::string::npos) << error.what();
  }
  OneShaft other = starting_pump();
  EXPECT_THROW(simulate("toy", other, oil, drive_for(0.1, 5), {},
                        [](double done) {
                          EXPECT_LE(done, 1);
                          if (done > 0.5) throw Interrupted();
                        }),
               Interrupted);
}

// What Newton's method is given is the derivative of the rates.
TEST(Integration, JacobianIsThatOfTheRates) {
  OneShaft shaft = starting_pump();
  shaft.start_speed = 20;
  shaft.swing = 3;
  LinearOil oil;
  coupled::System system(shaft, oil, true);
  coupled::SystemState state{shaft.start(), oil.start()};
  state.motion[kTurn] = 0.3;
  state.motion[kTurnRate] = -4;
  for (std::size_t i = 0; i < state.oil.size(); ++i) state.oil[i] = 1e6 * (1 + double(i * i));
  std::vector<double> y, dy(system.scale().size()), up = dy, down = dy;
  system.scaled(state, y);
  const std::size_t n = y.size();
  ASSERT_EQ(n, 4U + kPistons + 1);
  ASSERT_TRUE(system.rates(0.01, y.data(), dy.data()));
  std::vector<double> j(n * n);
  system.jacobian(0.01, y.data(), dy.data(), false, j.data());
  double size = 0;
  for (std::size_t c = 0; c < n; ++c) {
    const double step = 1e-5, held = y[c];
    y[c] = held + step;
    system.rates(0.01, y.data(), up.data());
    y[c] = held - step;
    system.rates(0.01, y.data(), down.data());
    y[c] = held;
    double largest = 1e-3;
    for (std::size_t r = 0; r < n; ++r)
      largest = std::max(largest, std::abs(up[r] - down[r]) / (2 * step));
    size += largest;
    for (std::size_t r = 0; r < n; ++r)
      EXPECT_NEAR(j[c * n + r], (up[r] - down[r]) / (2 * step), 1e-4 * largest) << r << "," << c;
  }
  EXPECT_GT(size, 100);
}

// ---- periodic motion ---------------------------------------------------------------------------

// J/2 d(w^2)/dpsi = T + S cos(N psi) - c w^2 is linear in w^2.
TEST(Steady, QuadraticDragHasItsKnownCycleAndMultiplier) {
  const PressureTrace pressure = no_pressure();
  const auto oil = coupled::prescribed_oil(kPistons, pressure, {});
  for (const double sign : {1.0, -1.0}) {
    OneShaft shaft;
    shaft.torque = sign * 10;
    shaft.swing = 8;
    shaft.drag = 0.002;
    shaft.start_speed = sign * 30;
    const SteadyMotion motion = steady("toy", shaft, *oil, drive_for(1, 20), within(1e-11));
    const double decay = 2 * shaft.drag / shaft.inertia;
    ASSERT_EQ(motion.multipliers.size(), 1U);
    EXPECT_NEAR(motion.multipliers[0].real(), std::exp(-decay * 2 * kPi / kPistons), scaled(1e-6));
    EXPECT_TRUE(motion.stable());
    // w^2 = T/c + 2 S/J (a cos + N sin)/(a^2 + N^2); backwards the swing drives the other way.
    const double a = sign * decay;
    const double square = sign * shaft.torque / shaft.drag +
                          2 * shaft.swing / shaft.inertia * a / (a * a + kPistons * kPistons);
    const double speed = sign * std::sqrt(square);
    EXPECT_NEAR(shaft.shaft(0, motion.motion).speed, speed, scaled(1e-8) * std::abs(speed));
    EXPECT_EQ(shaft.block(0, motion.motion).angle, 0);
    EXPECT_LT(motion.residual, 1e-9);
    EXPECT_NEAR(motion.turn.table.state(20, 2), sign * 360, 1e-6);
    EXPECT_NEAR(motion.turn.table.state(20, 3), motion.turn.table.state(0, 3), 1e-6);
    EXPECT_NEAR(motion.turn.table.state(20, 0), kPistons * motion.period_s, 1e-14);
    EXPECT_NEAR(motion.speed, sign * 2 * kPi / kPistons / motion.period_s, 1e-9);
  }
}

// A heavy rotor loses a thousandth of a disturbance over a period: it is a thousand times as far
// off as what changes over one.
TEST(Steady, SlowDecayDoesNotHideTheError) {
  const PressureTrace pressure = no_pressure();
  const auto oil = coupled::prescribed_oil(kPistons, pressure, {});
  for (const double tolerance : {1e-7, 1e-9}) {
    OneShaft shaft;
    shaft.inertia = 10;
    const double decay = -std::log(0.999) / (2 * kPi / kPistons);
    shaft.drag = decay * shaft.inertia / 2;
    shaft.torque = shaft.drag * 50 * 50;
    shaft.swing = 4000;
    shaft.start_speed = 47;
    const SteadyMotion motion = steady("toy", shaft, *oil, drive_for(1, 20), within(tolerance));
    EXPECT_NEAR(motion.multipliers[0].real(), 0.999, scaled(1e-6));
    const double square =
        50 * 50 + 2 * shaft.swing / shaft.inertia * decay / (decay * decay + kPistons * kPistons);
    const double off = std::abs(shaft.shaft(0, motion.motion).speed - std::sqrt(square)) /
                       shaft.scales()[kTurnRate];
    EXPECT_LT(off, scaled(30) * tolerance);
    EXPECT_LT(off, scaled(3) * motion.error);
    EXPECT_LE(motion.error, 30 * tolerance);
    EXPECT_LT(motion.residual, motion.error);
  }
}

// Likewise a large accumulator, among states that are fast.
TEST(Steady, SlowDecayOfOneStateIsSeenAmongOthers) {
  LinearOil oil;
  oil.delivery_softness = 3e-9;
  OneShaft shaft;
  shaft.given_speed = 50;
  DriveSpec drive = drive_for(1, 10);
  drive.kind = DriveKind::speed;
  const SteadyMotion exact = steady("toy", shaft, oil, drive, within(1e-10));
  for (const double tolerance : {1e-6, 1e-8}) {
    const SteadyMotion motion = steady("toy", shaft, oil, drive, within(tolerance));
    EXPECT_GT(motion.multipliers[0].real(), 0.998);
    EXPECT_LT(worst_apart(motion.oil, exact.oil) / oil.scales()[0], scaled(30) * tolerance);
    EXPECT_LE(motion.error, 30 * tolerance);
  }
}

// At a given speed the map of a linear oil is affine: its derivative by plain Runge-Kutta steps.
TEST(Steady, LinearOilAtGivenSpeedHasItsOwnMultipliers) {
  for (const double speed : {50.0, -50.0}) {
    LinearOil oil;
    OneShaft shaft;
    shaft.given_speed = speed;
    DriveSpec drive = drive_for(1, 10);
    drive.kind = DriveKind::speed;
    const SteadyMotion motion = steady("toy", shaft, oil, drive, within(1e-10));
    EXPECT_NEAR(motion.period_s, 2 * kPi / kPistons / 50, 1e-15);
    EXPECT_EQ(motion.multipliers.size(), kPistons + 1U);
    // The slowest is that of the delivery volume. Power iteration with the homogeneous equations.
    std::vector<double> p(kPistons + 1, 1.0), next(p.size());
    const auto homogeneous = [&](double time, const std::vector<double>& at) {
      std::vector<double> rate(p.size());
      const AxisMotion still{speed * time, 0, 0};  // no displacement
      oil.rates(time, still, still, at.data(), rate.data());
      return rate;
    };
    const auto moved = [](const std::vector<double>& at, const std::vector<double>& by, double h) {
      std::vector<double> to = at;
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += h * by[i];
      return to;
    };
    double multiplier = 0;
    constexpr int kSteps = 20000;
    const double h = motion.period_s / kSteps;
    for (int period = 0; period < 12; ++period) {
      for (int i = 0; i < kSteps; ++i) {
        const auto k1 = homogeneous(h * i, p);
        const auto k2 = homogeneous(h * (i + 0.5), moved(p, k1, h / 2));
        const auto k3 = homogeneous(h * (i + 0.5), moved(p, k2, h / 2));
        const auto k4 = homogeneous(h * (i + 1), moved(p, k3, h));
        for (std::size_t j = 0; j < p.size(); ++j)
          p[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
      }
      const std::vector<int> order = oil.order_after_period();
      for (std::size_t j = 0; j < p.size(); ++j) {
        const auto other = static_cast<std::size_t>(order[j]);
        speed > 0 ? next[j] = p[other] : next[other] = p[j];
      }
      p = next;
      multiplier = p[kPistons];
      for (double& value : p) value /= multiplier;
    }
    EXPECT_GT(multiplier, 0.05);
    EXPECT_LT(multiplier, 0.99);
    EXPECT_NEAR(motion.multipliers[0].real(), multiplier, scaled(1e-6));
    // And it is where a long run comes to.
    OneShaft same;
    same.given_speed = speed;
    Options options = within(1e-11);
    const double periods = std::ceil(30 / -std::log(multiplier));
    options.times = {0, periods * motion.period_s};
    const Trajectory run = simulate("toy", same, oil, drive, options);
    EXPECT_NEAR(run.oil->value(1, 0) * 1e5, motion.oil[kPistons], scaled(1e-2));
    EXPECT_GT(std::abs(motion.oil[kPistons]), 1e4);
  }
}

// Pump and load together: from the steady state a disturbance decays as the largest multiplier
// says.
TEST(Steady, LongRunDecaysTowardsItAsTheMultiplierSays) {
  OneShaft shaft = starting_pump();
  shaft.inertia = 0.2;
  shaft.start_speed = 70;
  LinearOil oil;
  const SteadyMotion motion = steady("toy", shaft, oil, drive_for(1, 10), within(1e-11));
  ASSERT_EQ(motion.multipliers.size(), kPistons + 2U);
  EXPECT_LE(motion.iterations, 6);  // forward differences are good enough to begin with
  EXPECT_TRUE(motion.stable());
  const double expected = std::abs(motion.multipliers[0]);
  EXPECT_EQ(motion.multipliers[0].imag(), 0);
  OneShaft same = shaft;
  Options options = within(1e-11);
  options.times = {0};
  constexpr int kTurns = 3;
  for (int i = 1; i < 5; ++i) options.times.push_back(kTurns * i * kPistons * motion.period_s);
  const Trajectory run = simulate("toy", same, oil, drive_for(1, 1), options);
  // Seen at the steady period what is left falls by the multiplier; a shift in time stays.
  std::vector<double> speed;
  for (std::size_t row = 1; row < 5; ++row) speed.push_back(run.table.state(row, 3));
  const double seen =
      std::pow((speed[3] - speed[2]) / (speed[2] - speed[1]), 1.0 / (kTurns * kPistons));
  EXPECT_GT(std::abs(speed[3] - speed[2]), 1e-4);
  EXPECT_NEAR(seen, expected, scaled(1e-3));
  EXPECT_GT(expected, 0.5);
  EXPECT_NEAR(motion.speed / kRadPerSecondPerRpm, speed[3], 5);
}

TEST(Steady, RefusesWhatHasNoPeriodicMotion) {
  LinearOil oil;
  OneShaft shaft = starting_pump();
  DriveSpec curve = drive_for(1, 10);
  curve.curve.time = {0, 1, 2, 3};
  EXPECT_THROW(steady("toy", shaft, oil, curve), InputError);
  LinearOil stepped;
  stepped.breakpoint_times = {0.5};
  EXPECT_THROW(steady("toy", shaft, stepped, drive_for(1, 10)), InputError);
  const PressureTrace pressure = no_pressure();
  const auto empty = coupled::prescribed_oil(kPistons, pressure, {});
  OneShaft running_away;
  running_away.torque = 10;
  running_away.start_speed = 20;
  EXPECT_THROW(steady("toy", running_away, *empty, drive_for(1, 10)), ComputationError);
  OneShaft resting;
  resting.viscous = 1;
  EXPECT_THROW(steady("toy", resting, oil, drive_for(1, 10)), ComputationError);
  OneShaft still;
  still.given_speed = 0;
  EXPECT_THROW(steady("toy", still, oil, drive_for(1, 10)), ComputationError);
  OneShaft swinging;
  swinging.spring = 30;
  swinging.start_speed = 100;
  swinging.viscous = 1e-3;
  EXPECT_THROW(steady("toy", swinging, oil, drive_for(1, 10)), ComputationError);
}

// ---- the pump under a prescribed pressure ------------------------------------------------------

// A step from 10 bar to 200 bar at 0 deg of each chamber, and back at 180 deg.
TEST(PrescribedOil, HasAtAJumpThePressureOfTheSideThatTheBlockTurnsTo) {
  PressureSpec spec;
  spec.ports = {10e5, 200e5};
  spec.transition_deg = 0;
  spec.delivery_start_deg = 180;
  const PressureTrace pressure(spec);
  const auto oil = coupled::prescribed_oil(kPistons, pressure, spec.ports);
  OilLoads loads;
  const auto first = [&](double angle, double speed) {
    oil->loads(0, {angle, speed, 0}, nullptr, loads);
    return loads.chamber_pressure.front();
  };
  for (const double turns : {0.0, -3.0, 1000.0}) {
    const double jump = 2 * kPi * turns;
    EXPECT_EQ(first(jump, 10), 10e5);
    EXPECT_EQ(first(jump, 0), 10e5);
    EXPECT_EQ(first(jump, -10), 200e5);
    EXPECT_EQ(first(jump + 1e-9, -10), 10e5);
    EXPECT_EQ(first(jump - 1e-9, 10), 200e5);
    EXPECT_EQ(first(jump + kPi, 10), 200e5);
    EXPECT_EQ(first(jump + kPi, -10), 10e5);
  }
}

Case motion_case(const std::string& name) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion" / name /
                   "case.toml");
}

Trajectory prescribed(const Case& the_case, double tolerance) {
  const PressureTrace pressure(the_case.pressure);
  const auto oil =
      coupled::prescribed_oil(the_case.pump.geometry.pistons, pressure, the_case.pressure.ports);
  const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
  return simulate("analytic", *mechanics, *oil, *the_case.drive, within(tolerance));
}

// Largest difference of reactions over their peak, until a time.
double from_reference(const std::string& name, const Trajectory& t, double until) {
  const NumericTable reference =
      read_numeric_csv(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion" /
                       name / "reference.csv");
  const ResultTable& table = t.table.results;
  double worst = reference.rows.size() == t.lag.size() ? 0 : 1e300;
  int compared = 0;
  for (std::size_t c = 0; c < reference.header.size(); ++c) {
    const std::size_t column = table.find(reference.header[c]);
    if (column >= table.columns() || table.channels[column].kind != ChannelKind::reaction) continue;
    const double peak = table.peak(table.channels[column].group);
    for (std::size_t row = 0; row < t.lag.size() && peak > 0; ++row)
      if (reference.rows[row][0] <= until)
        worst = std::max(worst, std::abs(table.at(row, column) - reference.rows[row][c]) / peak);
    ++compared;
  }
  return compared > 30 ? worst : 1e300;
}

struct Expected {
  const char* name;
  double until, growth;  // s; of errors by impacts
};
class PrescribedPressure : public testing::TestWithParam<Expected> {};

TEST_P(PrescribedPressure, MeetsTheStoredTrajectory) {
  const Expected& expected = GetParam();
  const Case the_case = motion_case(expected.name);
  double loose = 0;
  for (const double tolerance : {1e-8, 1e-10}) {
    const Trajectory t = prescribed(the_case, tolerance);
    const double error = from_reference(expected.name, t, expected.until);
    // Errors of all steps may add up.
    EXPECT_LT(error, scaled(tolerance) * expected.growth * static_cast<double>(t.record.steps));
    EXPECT_LT(t.record.worst_work_residual,
              scaled(1e4) * tolerance * std::abs(t.record.work_of_loads));
    if (loose != 0) {
      EXPECT_LT(error, loose / 5);
    }
    loose = error;
  }
}

TEST(PrescribedOil, HasTheEdgesOfAllChambersOnce) {
  PressureSpec spec;
  spec.transition_deg = 20;
  const PressureTrace pressure(spec);
  const auto two = coupled::prescribed_oil(2, pressure, {});
  EXPECT_THAT(two->edges_deg(), testing::Pointwise(testing::DoubleNear(1e-9), {10, 170, 190, 350}));
  EXPECT_EQ(coupled::prescribed_oil(5, pressure, {})->edges_deg().size(), 20U);
  spec.transition_deg = 0;
  const PressureTrace jumps(spec);
  const auto four = coupled::prescribed_oil(4, jumps, {});
  EXPECT_THAT(four->edges_deg(), testing::Pointwise(testing::DoubleNear(1e-9), {0, 90, 180, 270}));
}

// Pressure that jumps: no step may see both sides.
TEST(PrescribedOil, MayJump) {
  Case the_case = motion_case("constant_torque");
  the_case.pressure.transition_deg = 0;
  const Trajectory a =
      analytic::simulate(the_case, the_case.analytic, PressureTrace(the_case.pressure));
  const Trajectory b = prescribed(the_case, 1e-10);
  for (std::size_t row = 0; row < a.lag.size(); ++row)
    EXPECT_NEAR(a.table.state(row, 3), b.table.state(row, 3), scaled(1e-6) * 1500);
}

// Touches as the analytic simulation finds them, which lands on them by a method of its own.
TEST(Teeth, TouchesAreThoseOfTheAnalyticSimulation) {
  for (const double backlash : {20e-6, 0.0}) {
    Case the_case = motion_case("rattle");
    the_case.pump.gear.compliance->backlash = backlash;
    the_case.drive->duration = 0.012;
    const Trajectory a =
        analytic::simulate(the_case, the_case.analytic, PressureTrace(the_case.pressure));
    const Trajectory b = prescribed(the_case, 1e-11);
    ASSERT_EQ(a.record.events.size(), b.record.events.size()) << backlash;
    EXPECT_GT(a.record.events.size(), 4U);
    double impulse = 0;
    for (const ToothEvent& event : a.record.events) impulse = std::max(impulse, event.impulse);
    for (std::size_t i = 0; i < a.record.events.size(); ++i) {
      const ToothEvent& x = a.record.events[i];
      const ToothEvent& y = b.record.events[i];
      EXPECT_EQ(x.touch, y.touch) << i;
      EXPECT_EQ(x.flank, y.flank) << i;
      EXPECT_NEAR(x.time_s, y.time_s, scaled(1e-8)) << i;
      EXPECT_NEAR(x.approach_speed, y.approach_speed, scaled(1e-5)) << i;
      EXPECT_NEAR(x.block_speed, y.block_speed, scaled(1e-3)) << i;
      EXPECT_NEAR(x.impulse, y.impulse, scaled(1e-5) * impulse) << i;
    }
    EXPECT_NEAR(a.record.share_out_of_contact, b.record.share_out_of_contact, scaled(1e-5));
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, PrescribedPressure,
                         testing::Values(Expected{"constant_torque", 1, 1},
                                         Expected{"motor_driven", 1, 1},
                                         Expected{"rattle", 0.012, 100}),
                         [](const auto& test) { return test.param.name; });

// ---- the pump with its oil ---------------------------------------------------------------------

Case rated_pump(DriveKind kind) {
  Case c = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                     "bap63_rated_hydraulic.toml");
  DriveSpec drive;
  drive.kind = kind;
  drive.torque = 292.5;
  if (kind == DriveKind::motor) drive.motor = MotorData{8, 0.05, 5000, 2};
  drive.duration = 0.5;
  drive.samples = 72;
  c.drive = drive;
  return c;
}

// At a given speed the oil comes to the periodic state that the hydraulics find directly.
TEST(PumpWithOil, LongRunAtConstantSpeedIsThePeriodicState) {
  Case the_case = rated_pump(DriveKind::speed);
  the_case.hydraulics->tolerance = 1e-11;
  const auto state = hydraulics::steady_state(the_case);
  const auto oil = hydraulics::oil_in_time(the_case, hydraulics::at_rest(state));
  const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
  Options options = within(1e-11);
  options.times = {0};
  constexpr int kTurns = 12;
  const double turn = 60 / the_case.operation.speed_rpm;
  for (int i = 0; i <= 360; ++i) options.times.push_back((kTurns + i / 360.0) * turn);
  const Trajectory t = simulate("analytic", *mechanics, *oil, *the_case.drive, options);
  double worst = 0, far = 0;
  for (std::size_t row = 0; row < t.lag.size(); ++row)
    for (int k = 1; k <= 5; ++k) {
      const double theta = piston_angle_deg(t.table.state(row, 1), k, 5);
      const double apart = std::abs(t.oil->value(row, static_cast<std::size_t>(k - 1)) * 1e5 -
                                    state.computed->gauge(theta)) /
                           state.computed->peak;
      (row == 0 ? far : worst) = std::max(row == 0 ? far : worst, apart);
    }
  // At a whole turn, without the error of the curve.
  double states = 0;
  for (std::size_t k = 0; k < 5; ++k)
    states = std::max(states, std::abs(t.oil->value(1, k) * 1e5 -
                                       state.summary.atmosphere * std::expm1(state.states[k])) /
                                  state.computed->peak);
  EXPECT_LT(states, scaled(1e-9)) << states;
  EXPECT_GT(far, 0.1);
  EXPECT_LT(worst, scaled(1e-8));
  const OilHistory& h = *t.oil;
  EXPECT_LT(h.worst_energy_residual, scaled(1e-8) * h.energies[0].energy);
  EXPECT_LT(h.worst_exchange_residual, scaled(1e-8) * h.energies[0].energy);
  EXPECT_LT(h.worst_mass_residual, scaled(1e-8) * h.mass_in);
}

// Seen once a period, what is left falls as its two largest multipliers say: differences d of one
// value have d2 = (m1 + m2) d1 - m1 m2 d0.
std::complex<double> seen_multiplier(const std::vector<double>& values, std::size_t from) {
  const auto d = [&](std::size_t i) { return values[from + i + 1] - values[from + i]; };
  const double determinant = d(1) * d(1) - d(0) * d(2);
  const double sum = (d(2) * d(1) - d(0) * d(3)) / determinant;
  const double product = (d(2) * d(2) - d(1) * d(3)) / determinant;
  const std::complex<double> root = std::sqrt(std::complex<double>(sum * sum / 4 - product));
  return sum / 2 + (sum > 0 ? root : -root);
}

TEST(PumpWithOil, DisturbancesUnderAMotorDecayAsTheMultipliersSay) {
  for (const double rotor : {0.05, 2.0}) {
    Case the_case = rated_pump(DriveKind::motor);
    the_case.drive->motor->rotor_inertia = rotor;
    const auto state = hydraulics::steady_state(the_case);
    const auto oil = hydraulics::oil_in_time(the_case, hydraulics::running(state));
    const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
    const SteadyMotion motion = steady("analytic", *mechanics, *oil, *the_case.drive, within(1e-9));
    EXPECT_TRUE(motion.stable());
    Options options = within(1e-11);
    options.times = {0};
    for (int i = 1; i <= 28; ++i) options.times.push_back(i * motion.period_s);
    const Trajectory run = simulate("analytic", *mechanics, *oil, *the_case.drive, options);
    // Of the rotor: that of the shaft has ripple, of which a shift in time shows more.
    std::vector<double> speed;
    for (std::size_t row = 0; row < run.lag.size(); ++row) speed.push_back(run.table.state(row, 5));
    // A light rotor has two multipliers of one size, a heavy one alone the largest.
    const std::complex<double> seen =
        rotor < 1 ? seen_multiplier(speed, 6)
                  : std::pow((speed[28] - speed[20]) / (speed[20] - speed[12]), 1 / 8.0);
    EXPECT_GT(std::abs(speed[6] - speed[5]), 1e-4);
    EXPECT_NEAR(std::abs(seen), std::abs(motion.multipliers[0]), scaled(1e-3));
    EXPECT_NEAR(std::abs(seen.imag()), std::abs(motion.multipliers[0].imag()), scaled(1e-3));
  }
}

TEST(PumpWithOil, PeriodicMotionIsWhereALongRunComesTo) {
  Case the_case = rated_pump(DriveKind::motor);
  the_case.pump.gear.contact = ToothContact::compliant;
  the_case.pump.gear.flanks = Flanks::two;
  the_case.pump.gear.compliance = ToothCompliance{1e8, 1, 0.5, 20e-6};
  the_case.drive->samples = 36;
  const auto state = hydraulics::steady_state(the_case);
  const auto oil = hydraulics::oil_in_time(the_case, hydraulics::running(state));
  const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
  const SteadyMotion motion = steady("analytic", *mechanics, *oil, *the_case.drive, within(1e-10));
  const double turn = 5 * motion.period_s;
  EXPECT_NEAR(motion.turn.table.state(36, 2), 360, scaled(1e-6));
  // From when the block is at a whole turn of its own, by its speed there.
  double start = 7 * turn;
  Trajectory run;
  Options options = within(1e-10);
  for (int i = 0; i < 3; ++i) {
    options.times = {0, start};
    run = simulate("analytic", *mechanics, *oil, *the_case.drive, options);
    const double angle = run.table.state(1, 2);
    start += (360 * std::round(angle / 360) - angle) / (6 * run.table.state(1, 4));
  }
  options.times = {0};
  for (int row = 0; row <= 36; ++row) options.times.push_back(start + turn * row / 36);
  run = simulate("analytic", *mechanics, *oil, *the_case.drive, options);
  const ResultTable& found = motion.turn.table.results;
  const ResultTable& seen = run.table.results;
  double worst = 0;
  for (std::size_t c = 0; c < found.columns(); ++c) {
    const double peak = found.peak(found.channels[c].group);
    if (found.channels[c].kind != ChannelKind::reaction || peak == 0) continue;
    for (std::size_t row = 0; row < found.rows(); ++row)
      worst = std::max(worst, std::abs(found.at(row, c) - seen.at(row + 1, c)) / peak);
  }
  double pressures = 0;
  for (std::size_t row = 0; row < found.rows(); ++row)
    for (std::size_t k = 0; k < 5; ++k)
      pressures = std::max(pressures,
                           std::abs(motion.turn.oil->value(row, k) - run.oil->value(row + 1, k)) /
                               state.computed->peak * 1e5);
  EXPECT_LT(pressures, scaled(1e-7));
  EXPECT_LT(worst, scaled(1e-6));
}

// To the last bit: nothing is shared but the case, which does not change.
TEST(PumpWithOil, SimulationsInTwoThreadsAreAsAlone) {
  const Case the_case = rated_pump(DriveKind::motor);
  const auto state = hydraulics::steady_state(the_case);
  using Simulation = std::function<Trajectory()>;
  const auto follow = [&](Mechanics& mechanics, double until) {
    const auto oil = hydraulics::oil_in_time(the_case, hydraulics::at_rest(state));
    Options options;
    for (int i = 0; i <= 10; ++i) options.times.push_back(until * i / 10);
    return simulate("a", mechanics, *oil, *the_case.drive, options);
  };
  // About as long as each other.
  const Simulation analytic = [&] {
    return follow(*analytic::mechanics(the_case, the_case.analytic), 0.02);
  };
  const Simulation multibody = [&] {
    return follow(*multibody::mechanics(the_case, the_case.multibody), 0.002);
  };
  const auto expect_same = [](const Trajectory& a, const Trajectory& b) {
    EXPECT_EQ(a.table.states, b.table.states);
    EXPECT_EQ(a.oil->values, b.oil->values);
    EXPECT_EQ(a.record.steps, b.record.steps);
    ASSERT_EQ(a.table.results.values.size(), b.table.results.values.size());
    for (std::size_t i = 0; i < a.table.results.values.size(); ++i) {
      const double x = a.table.results.values[i], y = b.table.results.values[i];
      ASSERT_TRUE(x == y || (!is_computed(x) && !is_computed(y))) << i;
    }
  };
  const Trajectory by_analytic = analytic();
  const Trajectory by_multibody = multibody();
  EXPECT_GT(by_analytic.record.steps, 100);
  const auto both = [&](const Simulation& one, const Trajectory& alone, const Simulation& other,
                        const Trajectory& other_alone) {
    Trajectory a, b;
    {
      std::latch start(2);
      const auto go = [&](const Simulation& simulation, Trajectory& to) {
        start.arrive_and_wait();
        to = simulation();
      };
      const std::jthread first([&] { go(one, a); });
      const std::jthread second([&] { go(other, b); });
    }
    expect_same(a, alone);
    expect_same(b, other_alone);
  };
  both(analytic, by_analytic, multibody, by_multibody);
  both(analytic, by_analytic, analytic, by_analytic);
  both(multibody, by_multibody, multibody, by_multibody);
}

TEST(ContactInterval, TwoAsOneHaveTheirSumsAndTheLargerForce) {
  const coupled::ContactInterval a{0.1, 0.02, 0.05, 0.03, 900, 7, 3, 2, 0.4};
  const coupled::ContactInterval b{0.2, 0.01, 0.15, 0.04, 700, 5, 4, 6, 0.9};
  for (const auto& sum : {a + b, b + a}) {
    EXPECT_DOUBLE_EQ(sum.duration, 0.3);
    EXPECT_DOUBLE_EQ(sum.apart, 0.03);
    EXPECT_DOUBLE_EQ(sum.plus, 0.2);
    EXPECT_DOUBLE_EQ(sum.minus, 0.07);
    EXPECT_EQ(sum.largest, 900);
    EXPECT_EQ(sum.impulse, 12);
    EXPECT_EQ(sum.separations, 7);
    EXPECT_EQ(sum.impacts, 8);
    EXPECT_EQ(sum.largest_hit, 0.9);
  }
}

}  // namespace
}  // namespace bentaxis::test
