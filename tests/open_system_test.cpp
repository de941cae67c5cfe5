// States, rates and events for an integrator outside: by one of the test's own.
#include "bentaxis/coupled/open_system.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "bentaxis/coupled/stepper.h"
#include "pump_in_time.h"

namespace bentaxis::test {
namespace {

constexpr double kTolerance = 1e-10;

Case rated() {
  Case c = shipped_case("bap63_rated_hydraulic");
  c.drive = steady_speed(0.01, 10);
  return c;
}

Case with_torque() {
  Case c = rated();
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 250;
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  return c;
}

// The classical Runge-Kutta method of order 4, with events: a step over one is shortened until it
// ends there.
class RungeKutta {
 public:
  using Outside = std::function<Surroundings(double time)>;
  RungeKutta(coupled::OpenSystem& system, Outside outside)
      : system_(system), outside_(std::move(outside)) {}

  void run(double end, double step) {
    while (system_.time() < end) {
      double h = std::min(step, end - system_.time());
      if (const auto breakpoint = system_.next_breakpoint())
        h = std::min(h, *breakpoint - system_.time());
      const double time = system_.time();
      const std::vector<double> values = system_.values();
      signs(before_);
      advance(time, values, h);
      if (signs(after_); after_ != before_) {
        double low = 0, high = h;
        for (int i = 0; i < 45 && high - low > 1e-15; ++i) {
          const double middle = (low + high) / 2;
          advance(time, values, middle);
          signs(after_);
          (after_ == before_ ? low : high) = middle;
        }
        advance(time, values, high);
        ++events;
        system_.pass_event();
      }
      EXPECT_FALSE(system_.beyond());
    }
  }
  int events = 0;

 private:
  void signs(std::vector<bool>& signs) {
    system_.indicator_values(indicators_);
    signs.clear();
    for (const double value : indicators_) signs.push_back(value > 0);
  }
  void set(double time, const std::vector<double>& values) {
    system_.set_time(time);
    system_.set(values);
    if (outside_) system_.set_inputs(outside_(time));
  }
  void advance(double time, const std::vector<double>& y, double h) {
    std::array<std::vector<double>, 4> k;
    const double at[] = {0, h / 2, h / 2, h};
    for (std::size_t stage = 0; stage < 4; ++stage) {
      std::vector<double> here = y;
      for (std::size_t i = 0; i < y.size() && stage > 0; ++i)
        here[i] += at[stage] * k[stage - 1][i];
      set(time + at[stage], here);
      ASSERT_TRUE(system_.rates(k[stage]));
    }
    std::vector<double> next = y;
    for (std::size_t i = 0; i < y.size(); ++i)
      next[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    set(time + h, next);
  }

  coupled::OpenSystem& system_;
  Outside outside_;
  std::vector<bool> before_, after_;
  std::vector<double> indicators_;
};

// Rows at the end by both ways.
double apart_at(double end, PumpInTime& by_steps, PumpInTime& open, coupled::OpenSystem& system) {
  coupled::Stepper stepper("analytic", *by_steps.mechanics, *by_steps.oil, kTolerance);
  stepper.start(0, by_steps.start(), end);
  stepper.step_to(end);
  const std::vector<double> a = by_steps.row(end, stepper.state());
  const std::vector<double> b = open.row(end, system.state());
  double worst = 0;
  for (std::size_t c = 0; c < a.size(); ++c)
    if (!std::isnan(a[c])) worst = std::max(worst, std::abs(a[c] - b[c]) / (1 + std::abs(a[c])));
  return worst;
}

// Written before the first run: 1e-6 of each column (of 1 in its unit at least). Edges of five
// chambers at four places each, some 12 in 90 degrees: the events of the way are as many.
TEST(OpenSystem, GivenSpeedIsAsStepped) {
  PumpInTime pump(rated()), open(rated(), pump);
  const double omega = rad_per_second(pump.the_case.operation.speed_rpm);
  coupled::OpenSystem system(*open.mechanics, *open.oil, true);
  system.start(0, open.start());
  EXPECT_EQ(system.states()[0].name, "shaft_angle");
  EXPECT_EQ(system.states()[0].unit, "rad");
  EXPECT_EQ(system.states().size(), system.values().size());
  RungeKutta integrator(system, [&](double) {
    Surroundings outside;
    outside.shaft = AxisMotion{-7, omega, 0};  // the angle is a state
    return outside;
  });
  integrator.run(0.004, 2e-7);
  int edges = 0;
  for (const double edge : open.oil->edges_deg())
    if (edge > 0 && edge < omega * 0.004 / kRadPerDegree) ++edges;
  EXPECT_EQ(integrator.events, edges);
  EXPECT_NEAR(system.values()[0], omega * 0.004, 1e-12);
  EXPECT_LT(apart_at(0.004, pump, open, system), 1e-6);
}

TEST(OpenSystem, TorqueIsAsStepped) {
  PumpInTime pump(with_torque()), open(with_torque(), pump);
  coupled::OpenSystem system(*open.mechanics, *open.oil, false);
  system.start(0, open.start());
  EXPECT_EQ(system.states()[1].name, "shaft_speed");
  EXPECT_NEAR(system.values()[1], rad_per_second(pump.the_case.operation.speed_rpm), 1e-12);
  RungeKutta integrator(system, {});
  integrator.run(0.004, 2e-7);
  EXPECT_GT(integrator.events, 3);
  EXPECT_LT(apart_at(0.004, pump, open, system), 1e-6);
  // Angle and speed of the shaft itself, not what they are relative to.
  const AxisMotion shaft = open.mechanics->shaft(0.004, system.state().motion);
  EXPECT_NEAR(system.values()[0], shaft.angle, 1e-12);
  EXPECT_NEAR(system.values()[1], shaft.speed, 1e-12);
}

// The case's own speed over time: no state of the shaft, and breakpoints at which a step must end.
TEST(OpenSystem, KnotsOfACurveAreKept) {
  Case c = rated();
  const double omega = rad_per_second(c.operation.speed_rpm);
  c.drive->curve.time = {0, 0.001, 0.0021, 0.004};
  c.drive->curve.value = {omega, 0.95 * omega, 0.4 * omega, 0.5 * omega};
  PumpInTime pump(c), open(c, pump);
  coupled::OpenSystem system(*open.mechanics, *open.oil, false);
  system.start(0, open.start());
  EXPECT_THAT(system.states()[0].name, testing::StartsWith("oil."));
  EXPECT_EQ(system.next_breakpoint(), 0.001);
  system.set_time(0.001);
  EXPECT_EQ(system.next_breakpoint(), 0.0021);
  system.set_time(0.01);
  EXPECT_EQ(system.next_breakpoint(), std::nullopt);
  system.start(0, open.start());
  RungeKutta integrator(system, {});
  integrator.run(0.004, 2e-7);
  EXPECT_LT(apart_at(0.004, pump, open, system), 1e-6);
}

TEST(OpenSystem, MotorIsAsStepped) {
  Case c = shipped_case("bap63_start_up");
  c.drive->duration = 0.002;
  PumpInTime pump(c, false), open(c, pump);
  coupled::OpenSystem system(*open.mechanics, *open.oil, false);
  system.start(0, open.start());
  EXPECT_THAT(system.states()[2].name, testing::HasSubstr("twist"));
  RungeKutta integrator(system, {});
  integrator.run(0.002, 2e-7);
  EXPECT_LT(apart_at(0.002, pump, open, system), 1e-6);
}

// Touches of compliant teeth: impacts, which magnify errors.
TEST(OpenSystem, TouchesOfTeethAreEvents) {
  Case c = shipped_case("bap63_tooth_rattle");
  c.drive->duration = 0.004;
  PumpInTime pump(c, false), open(c, pump);
  coupled::OpenSystem system(*open.mechanics, *open.oil, true);
  system.start(0, open.start());
  const double omega = rad_per_second(c.operation.speed_rpm);
  std::vector<std::string> names;
  for (const coupled::OpenIndicator& is : system.indicators()) names.push_back(is.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"flank_plus", "flank_minus"}));
  RungeKutta integrator(system, [&](double) {
    Surroundings outside;
    outside.shaft = AxisMotion{0, omega, 0};
    return outside;
  });
  integrator.run(0.004, 2e-7);
  const Trajectory run = [&] {
    PumpInTime again(c, pump);
    coupled::Options options;
    options.times = {0, 0.004};
    return again.simulate(options);
  }();
  EXPECT_GE(static_cast<std::size_t>(integrator.events), run.record.events.size());
  ASSERT_GT(run.record.events.size(), 2U);
  EXPECT_LT(apart_at(0.004, pump, open, system), 1e-4);
}

// Backwards over edges too, and to and fro over one.
TEST(OpenSystem, EdgesBothWays) {
  PumpInTime pump(rated());
  coupled::OpenSystem system(*pump.mechanics, *pump.oil, true);
  system.start(0, pump.start());
  std::vector<double> values, state = system.values();
  const auto at = [&](double angle, double speed) {
    state[0] = angle;
    system.set(state);
    Surroundings outside;
    outside.shaft = AxisMotion{0, speed, 0};
    system.set_inputs(outside);
    system.indicator_values(values);
    return std::min(values[0], values[1]);
  };
  const double edge = radians(pump.oil->edges_deg()[1]);
  const double before = edge - 1e-3, after = edge + 1e-3;
  at(before, 100);
  system.pass_event();
  for (const double speed : {100.0, -100.0}) {
    const double from = speed > 0 ? before : after, to = speed > 0 ? after : before;
    EXPECT_GT(at(from, speed), 0) << speed;
    EXPECT_LT(at(to, speed), 0) << speed;
    EXPECT_TRUE(system.beyond());
    system.pass_event();
    EXPECT_GT(at(to, speed), 0) << speed;
    EXPECT_FALSE(system.beyond());
  }
  // On the edge it enters what lies ahead.
  at(edge, -100);
  system.pass_event();
  EXPECT_GT(at(edge - 1e-6, -100), 0);
}

TEST(OpenSystem, SettingWhatItTellsChangesNothing) {
  PumpInTime pump(with_torque());
  coupled::OpenSystem system(*pump.mechanics, *pump.oil, false);
  system.start(0, pump.start());
  system.set_time(0.3);
  const std::vector<double> values = system.values();
  EXPECT_NEAR(values[0], 0, 1e-12);  // time alone does not turn it
  std::vector<double> before, after;
  system.rates(before);
  system.set(values);
  system.rates(after);
  EXPECT_EQ(values, system.values());
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace bentaxis::test
