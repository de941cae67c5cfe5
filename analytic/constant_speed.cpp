// A block that does not turn as the shaft does, at constant speed: behind a universal joint, and
// carried by pistons, where its lag is frozen at each angle (docs/transfer.md).
#include "bentaxis/analytic/constant_speed.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/model.h"
#include "bentaxis/numerics/root.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "closed_form/reactions.h"
#include "prepared.h"

namespace bentaxis::analytic {
namespace {

// Torques below this share of the load scale are round-off (rule 1).
constexpr double kNoLoad = 1e-12;
// Angles of a turn at which a case must have free play, besides its samples.
constexpr int kFreePlayAngles = 3600;
// A root is sought outwards in steps that double from the first to the largest, rad.
constexpr double kFirstStep = 1e-7, kLargestStep = 5e-4;
// Steps between the middle and either end of the free play in which its roots are sought.
constexpr int kFreeSteps = 64;

double sine_of(const PreparedPump& pump, double sine, double cosine, std::size_t k) {
  return sine * pump.phase_cos[k] - cosine * pump.phase_sin[k];
}
double cosine_of(const PreparedPump& pump, double sine, double cosine, std::size_t k) {
  return cosine * pump.phase_cos[k] + sine * pump.phase_sin[k];
}

FreePlay free_play_of(const PreparedPump& pump, double theta) {
  const closed_form::Pump<double>& p = pump.numbers;
  const double radius = p.piston.joint_radius;
  const double versine = p.joint.versine;
  const double mean = radius * (1 - versine / 2);  // Rm
  const double swing = radius * versine / 2;       // E
  const double offset = p.frame.offset_y;          // beta
  const double bore = p.piston.bore_radius;
  const double sine = std::sin(theta), cosine = std::cos(theta);
  FreePlay play{-1e300, 1e300};
  bool bounded = false, touches = false;
  for (std::size_t k = 0; k < pump.phase_sin.size(); ++k) {
    const double reach = pump.clearance(k) / p.wall.share;  // H
    const double s = sine_of(pump, sine, cosine, k);
    const double c = cosine_of(pump, sine, cosine, k);
    const double re = mean - swing * (c - s) * (c + s) + offset * c;
    const double im = 2 * swing * s * c - offset * s;
    const double size = std::hypot(re, im);
    const double q = (size * size + bore * bore - reach * reach) / (2 * bore * size);
    if (q >= 1) touches = true;
    if (q < -1 || q >= 1) continue;
    bounded = true;
    const double argument = std::atan2(im, re);
    const double half = std::acos(q);
    if (half - argument < play.high) {
      play.high = half - argument;
      play.high_piston = static_cast<int>(k);
    }
    if (-half - argument > play.low) {
      play.low = -half - argument;
      play.low_piston = static_cast<int>(k);
    }
  }
  play.exists = bounded && !touches && play.low < play.high;
  return play;
}

[[noreturn]] void refuse_play(const PumpParameters& pump, double theta) {
  const WallContact& wall = *pump.transfer.wall;
  const double share = 1 - wall.from_joint / pump.geometry.piston_length;
  const double needed =
      share * pump.geometry.joint_circle_radius * (1 - std::cos(pump.geometry.tilt)) / 2;
  throw InputError(
      "[transfer] clearance_mm = " + rounded_text(wall.clearance * 1e3, 6) +
      (wall.deviation.empty()
           ? std::string()
           : " with " + wall.deviation_file.filename().string() + ", smallest clearance " +
                 rounded_text(wall.smallest_clearance() * 1e3, 6) + " mm") +
      ": the block has no free play at theta = " + rounded_text(theta / kRadPerDegree, 6) +
      " deg: must exceed about (1 - l_c/b1) Ra (1 - cos alpha)/2 = " +
      rounded_text(needed * 1e3, 6) + " mm, and leave a piston that can touch");
}

// The block's balance at a lag: all torques about z2, with frozen rates.
class Balance {
 public:
  Balance(const PreparedPump& pump, const Instant& instant, const PressureTrace& pressure)
      : pump_(pump), pressure_(pressure), theta_(instant.shaft.angle) {
    state_.sine = std::sin(theta_);
    state_.cosine = std::cos(theta_);
    state_.omega = state_.block_omega = instant.shaft.speed;
    state_.omega_dot = state_.block_omega_dot = 0;
  }

  /// Pressure of a chamber, Pa.
  double pressure(double lag, std::size_t k) const {
    const int pistons = static_cast<int>(pump_.phase_sin.size());
    return pressure_(
        piston_angle_deg((theta_ - lag) / kRadPerDegree, static_cast<int>(k) + 1, pistons));
  }

  /// NaN where a piston does not reach its bore.
  double torque(double lag, bool walls) {
    const closed_form::Pump<double>& p = pump_.numbers;
    state_.lead(std::sin(-lag / 2), std::cos(lag / 2));
    closed_form::BlockLoad<double> load = {0, 0, 0, {0, 0, 0}};
    for (std::size_t k = 0; k < pump_.phase_sin.size(); ++k) {
      const auto m = closed_form::piston_motion(p.frame, p.piston, state_,
                                                sine_of(pump_, state_.sine, state_.cosine, k),
                                                cosine_of(pump_, state_.sine, state_.cosine, k));
      if (!(m.axis.z > 0)) return std::nan("");
      const double friction =
          closed_form::friction_force(pump_.friction, p.friction, m.ring_velocity(1), state_.omega);
      const double chamber = pressure(lag, k);
      auto f = closed_form::piston_forces(p.piston, m, 1.0, 0.0, friction, chamber);
      if (walls) {
        const auto at = closed_form::wall_approach(p.wall, m, pump_.clearance(k));
        const double wall = closed_form::wall_force(p.wall, at, closed_form::WallMode::by_law);
        closed_form::add_wall(p.wall, m, wall * at.x, wall * at.y, f, load);
      }
      closed_form::add_piston(p.block, m, f, friction, chamber, load);
    }
    return -closed_form::carrying_torque(p.block, load, state_.block_omega, 0.0);
  }

  // Ra times the largest force of pressure, inertia or weight on one piston.
  double scale() const {
    const closed_form::Pump<double>& p = pump_.numbers;
    double pressure = 0;
    for (std::size_t k = 0; k < pump_.phase_sin.size(); ++k)
      pressure = std::max(pressure, std::abs(this->pressure(0, k)));
    const double radius = p.piston.joint_radius;
    return radius *
           std::max({p.piston.area * pressure, p.piston.mass * state_.omega * state_.omega * radius,
                     p.piston.mass * std::hypot(p.piston.gravity_y, p.piston.gravity_z)});
  }

  [[noreturn]] void fail() const {
    throw ComputationError("analytic model: no lag balances the block at theta = " +
                           rounded_text(theta_ / kRadPerDegree, 6) +
                           " deg before a piston leaves its bore: the walls are too soft for "
                           "the load, [transfer] stiffness_N_per_um");
  }

  // The first root beyond an end of the free play: side +1 above, -1 below.
  double root_outwards(double end, int side) {
    const auto along = [&](double way) { return side * torque(end + side * way, true); };
    double low = 0, at_low = side * torque(end, false);
    for (double step = kFirstStep;; step = std::min(2 * step, kLargestStep)) {
      const double high = low + step;
      const double at_high = along(high);
      if (!(high < kPi) || std::isnan(at_high)) fail();
      if (at_high >= 0)
        return end + side * numerics::root_between(along, low, high, at_low, at_high);
      low = high;
      at_low = at_high;
    }
  }

  // The root in the free play that is nearest to its middle; there is one.
  double root_within(double low, double high) {
    const auto free = [&](double lag) { return torque(lag, false); };
    const double middle = (low + high) / 2;
    const double step = (high - low) / 2 / kFreeSteps;
    const double at_middle = free(middle);
    double up = at_middle, down = at_middle;
    for (int i = 1; i <= kFreeSteps; ++i) {
      const double above = middle + i * step, below = middle - i * step;
      const double next_up = free(above), next_down = free(below);
      const bool in_upper = (next_up <= 0) != (up <= 0);
      const bool in_lower = (next_down <= 0) != (down <= 0);
      const auto upper = [&] {
        return numerics::root_between(free, above - step, above, up, next_up);
      };
      const auto lower = [&] {
        return numerics::root_between(free, below, below + step, next_down, down);
      };
      if (in_upper && in_lower) {
        const double a = upper(), b = lower();
        return a - middle <= middle - b ? a : b;
      }
      if (in_upper) return upper();
      if (in_lower) return lower();
      up = next_up;
      down = next_down;
    }
    return middle;  // the torque vanishes at the ends alone, to round-off
  }

 private:
  const PreparedPump& pump_;
  const PressureTrace& pressure_;
  double theta_;
  closed_form::WallState<double> state_ = {};
};

}  // namespace

FreePlay Model::free_play(double theta) const {
  return prepared_->transfer == TransferKind::pistons ? free_play_of(*prepared_, theta)
                                                      : FreePlay();
}

FrozenLag Model::frozen_lag(const Instant& instant, const PressureTrace& pressure) const {
  const FreePlay play = free_play_of(*prepared_, instant.shaft.angle);
  if (!play.exists) refuse_play(pump_, instant.shaft.angle);
  Balance balance(*prepared_, instant, pressure);
  FrozenLag lag;
  lag.low = play.low;
  lag.high = play.high;
  const double middle = (play.low + play.high) / 2;
  const double below = balance.torque(play.low, false);
  const double above = balance.torque(play.high, false);
  if (std::isnan(below) || std::isnan(above)) balance.fail();
  const double nothing = kNoLoad * balance.scale();
  if (std::max({std::abs(below), std::abs(above), std::abs(balance.torque(middle, false))}) <=
      nothing) {
    lag.rule = FrozenLag::Rule::no_load;
    lag.angle = middle;
    return lag;
  }
  const bool upper = above<0, lower = below> 0;
  if (!upper && !lower) {
    lag.rule = FrozenLag::Rule::free;
    lag.angle = balance.root_within(play.low, play.high);
    return lag;
  }
  lag.rule = upper && lower ? FrozenLag::Rule::driving : FrozenLag::Rule::one_side;
  const bool take_upper = upper && lower ? !(instant.shaft.speed < 0) : upper;
  lag.angle = balance.root_outwards(take_upper ? play.high : play.low, take_upper ? 1 : -1);
  return lag;
}

void Model::place_at_constant_speed(Instant& instant, const PressureTrace& pressure,
                                    LagRules* rules) const {
  const int pistons = layout_.pistons();
  const auto set_pressures = [&](double lead) {
    const double psi_deg = (instant.shaft.angle + lead) / kRadPerDegree;
    for (int k = 0; k < pistons; ++k)
      instant.chamber_pressure[static_cast<std::size_t>(k)] =
          pressure(piston_angle_deg(psi_deg, k + 1, pistons));
  };
  if (pump_.transfer.is_uneven_joint()) {
    instant.block = block_motion(instant.shaft);
    set_pressures(instant.block.angle - instant.shaft.angle);
  } else if (prepared_->transfer == TransferKind::pistons) {
    const FrozenLag lag = frozen_lag(instant, pressure);
    instant.block = {instant.shaft.angle - lag.angle, instant.shaft.speed, 0};
    instant.lag = ToothLag{lag.angle, 0};
    set_pressures(-lag.angle);
    if (rules != nullptr) rules->count(lag);
  }
}

void evaluate_at_constant_speed(const Model& model, const Instant& placed,
                                std::vector<double>& values, TeethAction* teeth) {
  model.evaluate(placed, values, nullptr, teeth);
  if (model.layout().has(Quantity::Tb)) values[model.layout().Tb()] = not_computed();
}

void LagRules::count(const FrozenLag& lag) {
  ++rows[static_cast<std::size_t>(lag.rule)];
  const int now = lag.angle > lag.high ? 1 : lag.angle < lag.low ? -1 : 0;
  if (now != 0 && side != 0 && now != side) ++side_changes;
  if (now != 0) side = now;
}

std::string LagRules::text() const {
  const auto rows_of = [&](FrozenLag::Rule rule) {
    return std::to_string(rows[static_cast<std::size_t>(rule)]);
  };
  return "rows by rule: " + rows_of(FrozenLag::Rule::one_side) + " with a root on one side, " +
         rows_of(FrozenLag::Rule::driving) + " with roots on both (the driving side is taken), " +
         rows_of(FrozenLag::Rule::free) + " within the free play, " +
         rows_of(FrozenLag::Rule::no_load) + " without load; the side changes " +
         std::to_string(side_changes) + " times between rows, where a real block jumps";
}

void require_free_play(const Case& the_case) {
  if (the_case.pump.transfer.kind != TransferKind::pistons) return;
  const PreparedPump pump = prepare(validate(the_case).pump, Assumptions());
  const int samples = the_case.operation.samples_per_revolution;
  for (const int count : {kFreePlayAngles, samples})
    for (int i = 0; i < count; ++i) {
      const double theta = radians(360.0 * i / count);
      if (!free_play_of(pump, theta).exists) {
        try {
          refuse_play(the_case.pump, theta);
        } catch (const InputError& error) {
          if (the_case.file.empty()) throw;
          throw InputError(the_case.file.string() + ": " + error.what());
        }
      }
    }
}

}  // namespace bentaxis::analytic
