// The multibody model of pumps whose block is turned by a joint or by tapered pistons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/results/max_abs.h"
#include "support.h"
#include "transfers/frozen_lag.h"

namespace bentaxis::test {
namespace {

using multibody::Method;

std::filesystem::path transfer_file(const std::string& name) {
  const std::string set = name.rfind("pistons_seven_free", 0) == 0 ? "motion" : "transfers";
  return std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / set / name;
}

// Columns of a motion, not of a ChannelLayout.
bool is_state(const std::string& name) {
  return name == "time_s" || name == "theta_deg" || name == "shaft_rpm" || name == "block_rpm";
}

// A stored case and its curves, of 20 digits.
struct Stored {
  explicit Stored(const std::string& name)
      : the_case(read_case(transfer_file(name + "/case.toml"))),
        curves(read_numeric_csv(transfer_file(name + "/reference.csv"))) {}

  // Largest difference of each group from the curves, and its peak there.
  struct Off {
    double difference = 0, peak = 0;
  };
  std::map<std::string, Off> differences(const ResultTable& table) const {
    std::map<std::string, Off> off;
    for (std::size_t c = 0; c < curves.header.size(); ++c) {
      if (is_state(curves.header[c])) continue;
      const std::size_t at = table.find(curves.header[c]);
      if (at == table.columns()) {
        ADD_FAILURE() << "no column " << curves.header[c];
        continue;
      }
      Off& of = off[table.channels[at].group];
      for (std::size_t row = 0; row < table.rows(); ++row) {
        update_max_abs(of.difference, table.at(row, at) - curves.rows[row][c]);
        update_max_abs(of.peak, curves.rows[row][c]);
      }
    }
    return off;
  }

  Case the_case;
  NumericTable curves;
};

ResultTable turn(const Case& the_case, std::optional<Method> method = {}) {
  const PressureTrace pressure(the_case.pressure);
  return multibody::run_driven(the_case, the_case.multibody, sample_case(the_case, pressure), {},
                               multibody::Scene::full, method);
}

// A wall's force is a stiffness times a small difference of lengths: round-off of the lengths.
double wall_round_off(const PumpParameters& pump) {
  constexpr double kEps = 2.2e-16;
  return pump.transfer.wall
             ? 4 * kEps * pump.geometry.joint_circle_radius * pump.transfer.wall->stiffness
             : 0;
}

// Of the peak of each reaction.
constexpr double kDriven = 1e-10;
constexpr double kSimulated = 1e-5;

class StoredTurn : public testing::TestWithParam<std::pair<const char*, Method>> {};

TEST_P(StoredTurn, agrees_with_the_curves) {
  const Stored stored(GetParam().first);
  const ResultTable table = turn(stored.the_case, GetParam().second);
  for (const auto& [group, off] : stored.differences(table)) {
    if (std::getenv("BENTAXIS_SHOW_RESIDUALS") != nullptr)
      std::cout << group << " " << off.difference << " of " << off.peak << "\n";
    EXPECT_LE(off.difference, kDriven * off.peak + wall_round_off(stored.the_case.pump)) << group;
  }
}

INSTANTIATE_TEST_SUITE_P(Multibody, StoredTurn,
                         testing::Values(std::pair{"constant_velocity", Method::multipliers},
                                         std::pair{"constant_velocity", Method::residual},
                                         std::pair{"cardan", Method::multipliers},
                                         std::pair{"cardan", Method::residual},
                                         std::pair{"pistons_seven", Method::multipliers},
                                         std::pair{"pistons_seven", Method::residual}));

// Small pumps that no stored curve has: even numbers of pistons, reversed, real pistons, axes that
// do not meet in the plane of the joints, circles of different radius.
Case unseen(const std::string& name, int pistons, bool reversed, double offset_mm) {
  Case c = Stored(name).the_case;
  c.pump.geometry.pistons = pistons;
  c.pump.geometry.axis_offset = offset_mm * 1e-3;
  c.pump.block.axial_inertia = 2.5e-3;
  if (reversed) c.operation.speed_rpm = -1200;
  PistonMass::Real real;
  real.centre_of_mass = 19e-3;
  real.transverse_inertia = 24e-6;
  real.axial_inertia = 5e-6;
  real.spin = 30;
  c.pump.piston.real = real;
  c.multibody.inertia = PistonInertia::real;
  c.operation.samples_per_revolution = 40;
  return c;
}

// The same pump with two crosses instead of its joint.
Case with_two_crosses(Case c, double distance_mm, double phase_deg) {
  c.pump.transfer.kind = TransferKind::double_cardan;
  c.pump.transfer.cardan = CardanJoint{radians(phase_deg)};
  c.pump.transfer.double_cardan = DoubleCardanJoint{distance_mm * 1e-3};
  return c;
}

std::vector<Case> joints() {
  std::vector<Case> cases;
  for (const char* const name : {"constant_velocity", "cardan"}) {
    cases.push_back(Stored(name).the_case);
    cases.push_back(unseen(name, 6, true, -0.8));
    cases.push_back(unseen(name, 9, false, 1.3));
  }
  cases.push_back(
      read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases/bap63_double_cardan.toml"));
  for (std::size_t i = 0; i < 3; ++i)
    cases.push_back(with_two_crosses(cases[i], 9 + 6 * static_cast<double>(i),
                                     70 * static_cast<double>(i) - 30));
  return cases;
}

Instant at_angle(const Case& the_case, double theta_deg) {
  return instant_at(the_case, theta_deg, rad_per_second(the_case.operation.speed_rpm));
}

using Vec = std::array<double, 3>;
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The joints do no work, and carry the couple of the mechanism: of a constant-velocity joint along
// the bisector of the axes, of a universal joint across both arms of its cross. Shaft and block get
// opposite couples: the free bodies of both close.
TEST(MultibodyTransfer, joints_are_ideal) {
  for (const Case& c : joints()) {
    multibody::Model model(c.pump, c.multibody, c.operation.speed_rpm);
    const ChannelLayout& at = model.layout();
    std::vector<double> row(at.size());
    const double s = std::sin(c.pump.geometry.tilt), cosine = std::cos(c.pump.geometry.tilt);
    for (const double theta : {7.0, 93.0, 151.0, 222.0, 338.0}) {
      const Instant instant = at_angle(c, theta);
      model.evaluate(instant, row);
      const AxisMotion block = model.block_beside(instant.shaft);
      const Vec couple{row[at.TcsJoint(0)], row[at.TcsJoint(1)], row[at.TcsJoint(2)]};
      const double size = std::sqrt(dot(couple, couple));
      const Vec z1{0, -s, cosine}, z2{0, 0, 1};  // in S2
      EXPECT_NEAR(dot(couple, z2) * block.speed - dot(couple, z1) * instant.shaft.speed, 0,
                  1e-12 * size * std::abs(instant.shaft.speed));
      if (c.pump.transfer.is_even()) {
        const double half = c.pump.geometry.tilt / 2;
        EXPECT_NEAR(couple[0], 0, 1e-12 * size);
        EXPECT_NEAR(couple[1] * std::cos(half) + couple[2] * std::sin(half), 0, 1e-12 * size);
      } else {
        const double phase = c.pump.transfer.cardan->phase;
        const double t = instant.shaft.angle - phase, r = block.angle - phase;
        // The arm of the shaft's fork in S2, and that of the block's.
        const Vec a1{std::cos(t), std::sin(t) * cosine, std::sin(t) * s};
        const Vec a2{-std::sin(r), std::cos(r), 0};
        EXPECT_NEAR(dot(a1, a2), 0, 1e-14);
        EXPECT_NEAR(dot(couple, a1), 0, 1e-12 * size);
        EXPECT_NEAR(dot(couple, a2), 0, 1e-12 * size);
      }
      if (at.has(Quantity::Fcs)) {
        // Across the arms of both forks.
        const double t = instant.shaft.angle - c.pump.transfer.phase();
        const Vec force{row[at.Fcs(0)], row[at.Fcs(1)], row[at.Fcs(2)]};
        const Vec a1{std::cos(t), std::sin(t) * cosine, std::sin(t) * s};
        const Vec a2{std::cos(t), std::sin(t), 0};
        const double large = std::sqrt(dot(force, force));
        EXPECT_GT(large, 0);
        EXPECT_NEAR(dot(force, a1), 0, 1e-12 * large);
        EXPECT_NEAR(dot(force, a2), 0, 1e-12 * large);
      }
      for (const BodySum& sum : sums_of(model.body_loads())) {
        EXPECT_LE(sum.force_over_sum, 1e-12) << sum.body << " at " << theta;
        EXPECT_LE(sum.moment_over_sum, 1e-12) << sum.body << " at " << theta;
      }
      EXPECT_NEAR(row[at.power_residual()], 0, 1e-10);
    }
  }
}

// The joint's motion: rates are those of the angle, by differences.
TEST(MultibodyTransfer, joints_move_the_block_by_one_law_of_angle_speed_and_acceleration) {
  for (const Case& c : joints()) {
    multibody::Model model(c.pump, c.multibody, 1);
    constexpr double kStep = 1e-4, kSpeed = 140, kAcceleration = 800;  // s, rad/s, rad/s2
    for (const double angle : {0.3, 1.9, 4.4}) {
      const auto moved = [&](double time) {
        return model.block_beside({angle + kSpeed * time + kAcceleration * time * time / 2,
                                   kSpeed + kAcceleration * time, kAcceleration});
      };
      const AxisMotion before = moved(-kStep), here = moved(0), after = moved(kStep);
      EXPECT_NEAR((after.angle - before.angle) / (2 * kStep), here.speed, 2e-4 * kSpeed);
      EXPECT_NEAR((after.speed - before.speed) / (2 * kStep), here.acceleration,
                  2e-4 * kSpeed * kSpeed);
    }
  }
}

// Without tilt a universal joint is a constant-velocity joint.
TEST(MultibodyTransfer, a_universal_joint_without_tilt_has_a_constant_velocity) {
  Case cardan = Stored("cardan").the_case;
  cardan.pump.geometry.tilt = 0;
  Case constant = cardan;
  constant.pump.transfer.kind = TransferKind::constant_velocity;
  const ResultTable a = turn(cardan), b = turn(constant);
  for (std::size_t row = 0; row < a.rows(); ++row)
    for (const Channel& channel : b.channels) {
      if (channel.kind != ChannelKind::reaction) continue;
      const double x = a.at(row, a.find(channel.name)), y = b.at(row, b.find(channel.name));
      if (!is_computed(y)) continue;
      EXPECT_NEAR(x, y, 1e-11 * b.peak(channel.group) + 1e-12) << channel.name;
    }
}

// The gear's torque, and what the shaft's joints take, do not depend on what carries the block at a
// constant ratio.
TEST(MultibodyTransfer, a_constant_velocity_joint_needs_the_torque_of_the_gear) {
  const Case joint = Stored("constant_velocity").the_case;
  const Case gear = reference_case("bap63_rated");
  const ResultTable a = turn(joint);
  const PressureTrace pressure(gear.pressure);
  Case same = gear;
  same.operation.samples_per_revolution = joint.operation.samples_per_revolution;
  const ResultTable b = turn(same);
  for (const Channel& channel : b.channels) {
    if (channel.quantity != "Rs" && channel.quantity != "Rc" && channel.quantity != "Td") continue;
    for (std::size_t row = 0; row < a.rows(); ++row)
      EXPECT_NEAR(a.at(row, a.find(channel.name)), b.at(row, b.find(channel.name)),
                  1e-12 * b.peak(channel.group))
          << channel.name;
  }
}

// Free bodies, power, and no torque from outside, at the frozen lag.
TEST(MultibodyTransfer, pumps_with_touching_pistons_are_in_balance) {
  std::vector<Case> cases = {Stored("pistons_seven").the_case};
  cases.push_back(unseen("pistons_seven", 6, true, -0.4));
  cases.push_back(unseen("pistons_seven", 8, false, 0.6));
  cases.back().pump.geometry.bore_circle_radius = 21.8e-3;
  for (Case& c : cases) {
    const double omega = rad_per_second(c.operation.speed_rpm);
    const PressureTrace pressure(c.pressure);
    for (const Method method : {Method::multipliers, Method::residual}) {
      multibody::Model model(c.pump, c.multibody, omega, multibody::Scene::full, method);
      const ChannelLayout& at = model.layout();
      std::vector<double> row(at.size());
      for (const double theta : {11.0, 100.0, 217.0, 301.0}) {
        model.evaluate_at_frozen_lag(theta, omega, pressure, c.pressure.ports, row);
        for (const BodySum& sum : sums_of(model.body_loads())) {
          EXPECT_LE(sum.force_over_sum, 1e-11) << sum.body << " at " << theta;
          EXPECT_LE(sum.moment_over_sum, 1e-11) << sum.body << " at " << theta;
        }
        EXPECT_NEAR(row[at.power_residual()], 0, 1e-8) << theta;
        // Seen as a given state, the lag needs no torque from outside.
        Instant given = at_angle(c, theta);
        given.block.angle -= row[at.lag()];
        for (int k = 0; k < at.pistons(); ++k) given.chamber_pressure[k] = row[at.pressure(k)];
        std::vector<double> again(at.size());
        model.evaluate(given, again);
        EXPECT_NEAR(again[at.Tb()], 0, 1e-9 * c.pump.geometry.joint_circle_radius * 1e4);
        for (int k = 0; k < at.pistons(); ++k)
          EXPECT_NEAR(again[at.Rw(k, 0)], row[at.Rw(k, 0)], 4 * wall_round_off(c.pump));
        // A block that lags more is pushed forward: it has to be held back.
        given.block.angle -= std::copysign(1e-5, row[at.lag()]);
        model.evaluate(given, again);
        EXPECT_LT(std::copysign(1.0, row[at.lag()]) * again[at.Tb()], 0);
      }
    }
  }
}

// The stiffer the walls, the nearer the lag to the end of the free play: in proportion to 1/k.
TEST(MultibodyTransfer, lag_tends_to_the_end_of_the_free_play_as_walls_grow_stiff) {
  Case c = Stored("pistons_seven").the_case;
  const double omega = rad_per_second(c.operation.speed_rpm);
  const PressureTrace pressure(c.pressure);
  const auto lag_at = [&](double factor) {
    Case stiff = c;
    stiff.pump.transfer.wall->stiffness *= factor;
    multibody::Model model(stiff.pump, stiff.multibody, omega);
    std::vector<double> row(model.layout().size());
    model.evaluate_at_frozen_lag(50, omega, pressure, c.pressure.ports, row);
    return row[model.layout().lag()];
  };
  // From walls so stiff on that a single one carries.
  const double soft = lag_at(1e2), stiff = lag_at(1e4), rigid = lag_at(1e6);
  const double first = soft - stiff, second = stiff - rigid;
  EXPECT_GT(first, 0);
  // In proportion but for the curvature of the geometry.
  EXPECT_NEAR(first / second, 100, 1);
}

// The rules that choose a lag, on moments made for them: one falls within the free play, walls push
// back beyond it.
TEST(MultibodyTransfer, follows_the_rules_for_the_lag) {
  using multibody::LagRule;
  const multibody::FreePlay play{-0.01, 0.02};
  const auto found = [&](const std::function<double(double)>& load, double omega = 1) {
    const auto moment = [&](double lag, bool walls) {
      const double pressed = lag - std::clamp(lag, play.low, play.high);
      return load(lag) + (walls ? 1e5 * pressed : 0);
    };
    return multibody::find_frozen_lag(play, moment, 100, omega);
  };
  const auto expect = [](const multibody::FrozenLag& lag, LagRule rule, double value) {
    EXPECT_EQ(lag.rule, rule);
    EXPECT_NEAR(lag.lag, value, 1e-14);
  };
  // A load below the round-off of its scale is none, where it is so everywhere.
  expect(found([](double) { return 1e-11; }), LagRule::unloaded, 0.005);
  // A drag pushes back, to the driving side; reversed, the same push is to the trailing side.
  expect(found([](double) { return -40; }), LagRule::driving_side, 0.0204);
  expect(found([](double) { return -40; }, -1), LagRule::trailing_side, 0.0204);
  expect(found([](double) { return 30; }), LagRule::trailing_side, -0.0103);
  expect(found([](double) { return 30; }, -1), LagRule::driving_side, -0.0103);
  // Struts under pressure push away from the middle: both sides have a root, omega chooses.
  const auto struts = [](double lag) { return -2000 * (lag - 0.003); };
  EXPECT_GT(found(struts).lag, play.high);
  EXPECT_LT(found(struts, -1).lag, play.low);
  EXPECT_GT(found(struts, 0).lag, play.high);
  // A load that centres the block: the root in the free play that is nearest to its middle.
  expect(found([](double lag) { return 2000 * (lag - 0.003); }), LagRule::within_play, 0.003);
  const auto three = [](double lag) {
    return 1e9 * (lag + 0.004) * (lag - 0.0071) * (lag - 0.018);
  };
  expect(found(three), LagRule::within_play, 0.0071);
  // The first root outwards counts, not a later one.
  const auto twice = [](double lag) { return lag < 0.03 ? -100 : -100 - 1e6 * (lag - 0.03); };
  expect(found(twice), LagRule::driving_side, 0.021);
}

// The ends of the free play are where the first piston on either side touches.
TEST(MultibodyTransfer, finds_the_free_play_and_refuses_what_has_none) {
  Case c = Stored("pistons_seven").the_case;
  const multibody::FreePlay play = multibody::free_play(c.pump, radians(50));
  multibody::Model model(c.pump, c.multibody, 1);
  const ChannelLayout& at = model.layout();
  const auto touching = [&](double lag) {
    Instant instant = at_angle(c, 50);
    instant.block.angle -= lag;
    std::vector<double> row(at.size());
    model.evaluate(instant, row);
    int walls = 0;
    for (int k = 0; k < at.pistons(); ++k) walls += row[at.Rw(k, 0)] != 0 || row[at.Rw(k, 1)] != 0;
    return walls;
  };
  constexpr double kNear = 1e-9;
  EXPECT_EQ(touching(play.high - kNear) + touching(play.low + kNear), 0);
  EXPECT_EQ(touching(play.high + kNear), 1);
  EXPECT_EQ(touching(play.low - kNear), 1);
  c.pump.transfer.wall->clearance = 1e-4;
  EXPECT_THROW(multibody::free_play(c.pump, radians(50)), InputError);
  c.pump.transfer.wall->clearance = 0.1;
  EXPECT_THROW(multibody::free_play(c.pump, radians(50)), InputError);
}

// Cases without a stored curve, against the closed form.
double worst_difference(const ResultTable& a, const ResultTable& b, double round_off) {
  double worst = 0;
  for (std::size_t c = 0; c < a.columns(); ++c) {
    const Channel& channel = a.channels[c];
    if (channel.kind == ChannelKind::check || channel.group == "xh_yh") continue;
    const std::size_t other = b.find(channel.name);
    for (std::size_t row = 0; row < a.rows(); ++row) {
      EXPECT_EQ(is_computed(a.at(row, c)), is_computed(b.at(row, other))) << channel.name;
      if (!is_computed(a.at(row, c)) || a.at(row, c) == b.at(row, other)) continue;
      const double off = std::max(0.0, std::abs(a.at(row, c) - b.at(row, other)) - round_off);
      EXPECT_LE(off, kDriven * a.peak(channel.group)) << channel.name << " at " << a.theta_deg[row];
      update_max_abs(worst, off / a.peak(channel.group));
    }
  }
  return worst;
}

TEST(MultibodyTransfer, agrees_with_the_closed_form_on_unseen_cases) {
  std::vector<Case> cases = joints();
  cases.push_back(unseen("pistons_seven", 6, true, -0.4));
  cases.push_back(unseen("pistons_seven", 8, false, 0.6));
  cases.back().pump.geometry.bore_circle_radius = 21.8e-3;
  cases.push_back(unseen("pistons_seven", 9, false, -0.2));
  cases.back().pump.transfer.wall->exponent = 1.5;
  for (const Case& c : cases) {
    const Samples samples = sample_case(c, PressureTrace(c.pressure));
    Case real = c;
    real.analytic = c.multibody;
    const double worst = worst_difference(analytic::run(real, real.analytic, samples), turn(c),
                                          10 * wall_round_off(c.pump));
    if (std::getenv("BENTAXIS_SHOW_RESIDUALS") != nullptr)
      std::cout << to_string(c.pump.transfer.kind) << " " << c.pump.geometry.pistons
                << " pistons: " << worst << " of peak\n";
  }
}

// Given states: walls in and out of contact, on either side, approaching and leaving; accelerating.
TEST(MultibodyTransfer, agrees_with_the_closed_form_at_given_states) {
  const std::string names[] = {"constant_velocity", "cardan", "pistons_seven", "double_cardan"};
  for (const std::string& name : names) {
    const bool two = name == "double_cardan";
    Case c = unseen(two ? "constant_velocity" : name, 7, false, 0.3);
    if (two) c = with_two_crosses(c, 12, 50);
    multibody::Model multibody(c.pump, c.multibody, 1);
    const analytic::Model closed(c.pump, c.multibody);
    const ChannelLayout& at = closed.layout();
    std::vector<double> a(at.size()), b(at.size());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    std::map<std::string, double> off, peak;
    for (int i = 0; i < 40; ++i) {
      Instant instant = at_angle(c, 180 + 180 * any(random));
      instant.shaft.speed *= 1 + 0.3 * any(random);
      instant.shaft.acceleration = 3000 * any(random);
      instant.block = multibody.block_beside(instant.shaft);
      if (c.pump.transfer.kind == TransferKind::pistons) {
        instant.block.angle -= 0.02 * any(random);
        instant.block.speed *= 1 + 0.05 * any(random);
        instant.block.acceleration = 3000 * any(random);
      }
      closed.evaluate(instant, a);
      multibody.evaluate(instant, b);
      for (std::size_t k = 0; k < at.size(); ++k) {
        const Channel& channel = at.channels()[k];
        if (channel.kind == ChannelKind::check || channel.group == "xh_yh") continue;
        ASSERT_EQ(is_computed(a[k]), is_computed(b[k])) << channel.name;
        if (!is_computed(a[k])) continue;
        update_max_abs(off[channel.group], a[k] - b[k]);
        update_max_abs(peak[channel.group], a[k]);
      }
    }
    for (const auto& [group, difference] : off)
      EXPECT_LE(difference, kDriven * peak[group] + 10 * wall_round_off(c.pump))
          << name << " " << group;
  }
}

// A clearance of its own for each piston: at constant speed, at given states and in time.
TEST(MultibodyTransfer, clearances_of_each_piston_are_those_of_the_closed_form) {
  const auto with = [](Case c, std::vector<double> um) {
    for (double& each : um) each *= 1e-6;
    c.pump.transfer.wall->deviation = um;
    return c;
  };
  std::vector<Case> cases = {
      with(Stored("pistons_seven").the_case, {12, -7, 0, 30, -22, 5, 1}),
      with(unseen("pistons_seven", 6, true, -0.4), {0, 40, -15, -30, 8, 0}),
      with(unseen("pistons_seven", 9, false, -0.2), {0, 3, -6, 9, -12, 15, -18, 21, -24})};
  cases[2].pump.transfer.wall->exponent = 1.5;
  for (const Case& c : cases) {
    const Samples samples = sample_case(c, PressureTrace(c.pressure));
    Case real = c;
    real.analytic = c.multibody;
    const ResultTable closed = analytic::run(real, real.analytic, samples);
    worst_difference(closed, turn(c), 10 * wall_round_off(c.pump));
    // The clearances matter.
    Case equal = real;
    equal.pump.transfer.wall->deviation.clear();
    const ResultTable other = analytic::run(equal, equal.analytic, samples);
    double off = 0;
    for (std::size_t row = 0; row < closed.rows(); ++row)
      update_max_abs(off,
                     closed.at(row, closed.find("lag_deg")) - other.at(row, other.find("lag_deg")));
    EXPECT_GT(off, 1e-2);
    const multibody::FreePlay play = multibody::free_play(c.pump, radians(50));
    const analytic::FreePlay same = analytic::Model(c.pump, c.multibody).free_play(radians(50));
    EXPECT_NEAR(play.low, same.low, 1e-13);
    EXPECT_NEAR(play.high, same.high, 1e-13);
  }
  const Case moving = with(Stored("pistons_seven_free").the_case, {8, -5, 0, 12, -10, 3, 0});
  SimulationOptions options;
  options.error = 1e-6;
  const PressureTrace pressure(moving.pressure);
  const ResultTable a = analytic::simulate(moving, moving.analytic, pressure).table.results;
  const ResultTable b =
      multibody::simulate(moving, moving.multibody, pressure, options).table.results;
  for (const char* name : {"Rw_1_x2_N", "Rw_4_y2_N", "Rb1_x1_N", "Td_z1_Nm", "lag_deg"})
    for (std::size_t row = 0; row < a.rows(); ++row)
      EXPECT_NEAR(a.at(row, a.find(name)), b.at(row, b.find(name)),
                  kSimulated * a.peak(a.channels[a.find(name)].group))
          << name << " " << row;
}

// Deviations of zero leave every bit.
TEST(MultibodyTransfer, clearances_without_deviations_change_no_bit) {
  const Case c = Stored("pistons_seven").the_case;
  Case same = c;
  same.pump.transfer.wall->deviation.assign(7, 0.0);
  const ResultTable a = turn(c), b = turn(same);
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (is_computed(a.values[i]) || is_computed(b.values[i])) {
      ASSERT_EQ(a.values[i], b.values[i]) << i;
    }
  }
}

// A joint in time, at constant speed: the turn of the driven mode, found by integration.
TEST(MultibodyTransfer, simulates_joints) {
  for (const char* const name : {"constant_velocity", "cardan"}) {
    const Stored stored(name);
    Case c = stored.the_case;
    c.drive.emplace();
    c.drive->duration = 0.04;
    c.drive->samples = 72;
    SimulationOptions options;
    options.error = 1e-6;
    const Trajectory run = multibody::simulate(c, c.multibody, PressureTrace(c.pressure), options);
    Trajectory turn = run;  // without its last row, which begins the next turn
    turn.table.results.theta_deg.pop_back();
    for (const auto& [group, off] : stored.differences(turn.table.results))
      EXPECT_LE(off.difference, kSimulated * off.peak) << name << " " << group;
  }
}

// Two crosses in time: the turn of the driven mode, and a shaft that runs free under a torque
// against the closed form.
TEST(MultibodyTransfer, simulates_two_crosses) {
  Case c = with_two_crosses(Stored("constant_velocity").the_case, 15, 20);
  c.drive.emplace();
  c.drive->duration = 0.04;
  c.drive->samples = 72;
  SimulationOptions options;
  options.error = 1e-6;
  const PressureTrace pressure(c.pressure);
  const ResultTable run = multibody::simulate(c, c.multibody, pressure, options).table.results;
  const ResultTable driven = turn(c);
  const std::size_t force = run.find("Fcs_x2_N");
  ASSERT_LT(force, run.columns());
  ASSERT_EQ(run.rows(), driven.rows() + 1);
  for (const Channel& channel : driven.channels) {
    if (channel.kind != ChannelKind::reaction || channel.quantity == "Rcs") continue;
    for (std::size_t row = 0; row < driven.rows(); ++row)
      ASSERT_NEAR(run.at(row, run.find(channel.name)), driven.at(row, driven.find(channel.name)),
                  kSimulated * driven.peak(channel.group))
          << channel.name << " " << row;
  }
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 310;
  c.drive->duration = 0.02;
  const ResultTable a = analytic::simulate(c, c.multibody, pressure).table.results;
  const ResultTable b = multibody::simulate(c, c.multibody, pressure, options).table.results;
  for (const char* name : {"Fcs_x2_N", "Fcs_y2_N", "Rb1_x1_N", "Rcn_y2_N", "Rs_2_z2_N"})
    for (std::size_t row = 0; row < a.rows(); ++row)
      ASSERT_NEAR(a.at(row, a.find(name)), b.at(row, b.find(name)),
                  kSimulated * a.peak(a.channels[a.find(name)].group))
          << name << " " << row;
}

// Each parameter of the table, off by a millionth in this model's case, is noticed by the curves.
TEST(MultibodyTransfer, notices_every_parameter_of_the_table) {
  const auto worst = [](const Stored& stored, const Case& the_case) {
    double most = 0;
    for (const auto& [group, off] : stored.differences(turn(the_case)))
      most = std::max(most, (off.difference - wall_round_off(the_case.pump)) / off.peak);
    return most;
  };
  const double kOff = 1 + 1e-6;
  const Stored cardan("cardan"), pistons("pistons_seven");
  Case c = cardan.the_case;
  c.pump.transfer.cardan->phase *= kOff;
  EXPECT_GT(worst(cardan, c), 10 * kDriven);
  // Of two crosses, against the closed form.
  const Case two = with_two_crosses(Stored("constant_velocity").the_case, 15, 20);
  const ResultTable closed =
      analytic::run(two, two.multibody, sample_case(two, PressureTrace(two.pressure)));
  const auto off_by = [&](const Case& other) {
    const ResultTable found = turn(other);
    double most = 0;
    for (std::size_t column = 0; column < closed.columns(); ++column) {
      if (closed.channels[column].kind != ChannelKind::reaction) continue;
      for (std::size_t row = 0; row < closed.rows(); ++row)
        if (is_computed(closed.at(row, column)))
          update_max_abs(most, (closed.at(row, column) - found.at(row, column)) /
                                   closed.peak(closed.channels[column].group));
    }
    return most;
  };
  EXPECT_LT(off_by(two), kDriven);
  Case wrong = two;
  wrong.pump.transfer.cardan->phase *= kOff;
  EXPECT_GT(off_by(wrong), 10 * kDriven);
  wrong = two;
  wrong.pump.transfer.double_cardan->cross_distance *= kOff;
  EXPECT_GT(off_by(wrong), 10 * kDriven);
  const auto with = [&](double WallContact::*field) {
    Case off = pistons.the_case;
    (*off.pump.transfer.wall).*field *= kOff;
    return worst(pistons, off);
  };
  EXPECT_GT(with(&WallContact::from_joint), 10 * kDriven);
  EXPECT_GT(with(&WallContact::clearance), 10 * kDriven);
  EXPECT_GT(with(&WallContact::stiffness), 10 * kDriven);
  EXPECT_GT(with(&WallContact::dissipation), 10 * kDriven);
  EXPECT_GT(with(&WallContact::exponent), 10 * kDriven);
}

// Simulated rows against a stored trajectory: largest difference of each group, of its peak.
TEST(MultibodyTransfer, simulates_touching_pistons) {
  const Stored stored("pistons_seven_free");
  SimulationOptions options;
  options.error = 1e-6;
  const Trajectory run = multibody::simulate(stored.the_case, stored.the_case.multibody,
                                             PressureTrace(stored.the_case.pressure), options);
  ASSERT_EQ(run.table.results.rows(), stored.curves.rows.size());
  for (const auto& [group, off] : stored.differences(run.table.results)) {
    if (std::getenv("BENTAXIS_SHOW_RESIDUALS") != nullptr)
      std::cout << group << " " << off.difference / off.peak << " of " << off.peak << "\n";
    EXPECT_LE(off.difference, kSimulated * off.peak) << group;
  }
}

}  // namespace
}  // namespace bentaxis::test
