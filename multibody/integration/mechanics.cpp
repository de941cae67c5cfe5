#include "bentaxis/multibody/mechanics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"
#include "integration/case_drive.h"
#include "integration/free_motion.h"
#include "loads/friction.h"
#include "placement/placement.h"
#include "reactions/body_loads.h"
#include "reactions/channels.h"
#include "reactions/solver_guard.h"

namespace bentaxis::multibody {

using SimTK::Stage;
using SimTK::State;

namespace {

// Where all bodies are, and how fast.
struct Posture {
  double time = 0;
  AxisMotion shaft, block;
  double rotor_speed = 0;
  double lag = 0, lag_rate = 0;  // theta - psi, with digits of its own
  double twist = 0;

  bool moves_as(const Posture& other) const {
    return time == other.time && shaft == other.shaft && block == other.block &&
           rotor_speed == other.rotor_speed;
  }
};

class MultibodyMechanics : public Mechanics {
 public:
  MultibodyMechanics(const Case& the_case, const Assumptions& assumptions)
      : pump_(the_case.pump),
        drive_(the_case),
        system_(pump_, assumptions, drive_.in_time()),
        placement_(system_),
        free_motion_(system_, placement_),
        load_reader_(system_),
        layout_(pump_),
        joint_(pump_.transfer.is_joint() ? std::make_unique<JointMotion>(pump_) : nullptr),
        arm_(arm_of(system_)) {
    system_.inputs().chamber_pressure = [this](double, double, std::vector<double>& p) {
      p = loads_.chamber_pressure;
    };
    system_.inputs().ports_change = true;
    scales_ = find_scales(the_case);
  }

  const ChannelLayout& layout() const override { return layout_; }
  MotionVector start() const override {
    MotionVector y = {};
    if (has_motor()) y[kTwist] = drive_.start_torque() / motor().coupling_stiffness;
    return y;
  }
  void surround(const Surroundings& outside) override { set_inputs(outside); }
  void set_inputs(const Surroundings& outside) override {
    drive_.set_inputs(outside);
    placed_.reset();
  }
  MotionVector scales() const override { return scales_; }
  bool shaft_is_free() const override { return !drive_.gives_speed(); }
  bool compliant() const override { return has_law() || has_bevel() || walls() != nullptr; }
  bool carried_by_pistons() const override { return walls() != nullptr; }
  bool has_motor() const override { return drive_.is_motor(); }
  std::vector<double> breakpoints() const override { return drive_.breakpoints(); }

  AxisMotion shaft(double time, const MotionVector& y) const override {
    if (drive_.gives_speed()) {
      const AxisMotion given = drive_.turning(time);
      return {given.angle, given.speed, 0};
    }
    const double speed = drive_.start_speed();
    return {speed * time + y[kTurn], speed + y[kTurnRate], 0};
  }
  AxisMotion block(double time, const MotionVector& y) const override {
    const AxisMotion motion = shaft(time, y);
    if (joint_) {
      const AxisMotion block = joint_->block(motion);
      return {block.angle, block.speed, 0};
    }
    return {motion.angle - y[kLag], motion.speed - y[kLagRate], 0};
  }
  double approach(double time, const MotionVector& y, int contact) const override {
    if (walls() != nullptr) return wall_touch(time, y, contact).approach;
    if (has_bevel()) return closing(time, y, contact).approach;
    return contact * arm_ * y[kLag] - law().backlash / 2;
  }
  double approach_rate(double time, const MotionVector& y, int contact) const override {
    if (walls() != nullptr) return wall_touch(time, y, contact).rate;
    if (has_bevel()) return closing(time, y, contact).rate;
    return contact * arm_ * y[kLagRate];
  }
  bool teeth(double time, const MotionVector& y, TeethAction& action) override {
    if (has_bevel())
      action = bevel().act(shaft(time, y).angle, shaft(time, y).speed, {y[kLag], y[kLagRate]});
    return has_bevel();
  }

  void rates(double time, const MotionVector& y, const OilLoads& loads, MotionVector& dy) override {
    translate_simbody_errors([&] { find_rates(posture(time, y), y, loads, dy); });
  }
  double pressure_power(double time, const MotionVector& y, const OilLoads& loads) override {
    require_pressures(loads);
    double power = 0;
    translate_simbody_errors([&] {
      place(posture(time, y));
      power = multibody::pressure_power(pump_, system_.bodies(), loads.chamber_pressure,
                                        system_.dynamics());
    });
    return power;
  }
  void row(double time, const MotionVector& y, const OilLoads& loads, std::vector<double>& state,
           std::vector<double>& row, MotionChecks& checks) override {
    translate_simbody_errors([&] { find_row(posture(time, y), loads, state, row, checks); });
  }
  std::vector<BodyLoad> body_loads(double time, const MotionVector& y,
                                   const OilLoads& loads) override {
    std::vector<BodyLoad> found;
    translate_simbody_errors([&] {
      TeethAction action;
      const bool touching = teeth(time, y, action);
      realize(posture(time, y), loads, [&](const State& state, const AxisMotions&) {
        Reactions reactions;
        reactions_from_multipliers(system_, state, reactions);
        found = load_reader_.read(state, state.getUDot(), reactions, loads.chamber_pressure,
                                  touching ? &action : nullptr);
      });
    });
    return found;
  }
  double kinetic_energy(double time, const MotionVector& y) override {
    double energy = 0;
    translate_simbody_errors([&] { energy = kinetic_energy_in(posture(time, y)); });
    return energy;
  }
  double potential_energy(const MotionVector& y) const override {
    double energy = 0;
    if (has_law())
      for (const int flank : {1, -1}) energy += flank_energy(law(), approach(0, y, flank));
    if (has_motor()) energy += motor().coupling_stiffness * y[kTwist] * y[kTwist] / 2;
    return energy;
  }
  double elastic_energy(double time, const MotionVector& y) const override {
    double energy = potential_energy(y);
    if (walls() != nullptr)
      translate_simbody_errors([&] {
        place(posture(time, y));
        energy += walls()->elastic_energy(system_.dynamics());
      });
    return energy;
  }

 private:
  const ToothCompliance& law() const { return *pump_.gear.compliance; }
  bool has_law() const { return system_.teeth() != nullptr; }
  const BoreWalls* walls() const { return system_.walls(); }
  WallTouch wall_touch(double time, const MotionVector& y, int piston) const {
    WallTouch touch;
    translate_simbody_errors([&] {
      place(posture(time, y));
      touch = walls()->touch(system_.dynamics(), static_cast<std::size_t>(piston) - 1);
    });
    return touch;
  }
  // About the block's axis: 1 where pistons carry it, whose torque is asked for.
  static double arm_of(const PumpSystem& system) {
    if (system.joint() != nullptr || system.walls() != nullptr) return 1;
    return system.gear().arm();
  }
  const BevelTeeth& bevel() const { return system_.bevel()->teeth(); }
  bool has_bevel() const { return system_.bevel() != nullptr; }
  BevelTeeth::Closing closing(double time, const MotionVector& y, int flank) const {
    const AxisMotion turning = shaft(time, y);
    return bevel().closing(turning.angle, turning.speed, {y[kLag], y[kLagRate]}, flank);
  }
  const MotorData& motor() const { return *drive_.spec().motor; }

  Posture posture(double time, const MotionVector& y) const {
    Posture now;
    now.time = time;
    now.shaft = shaft(time, y);
    now.block = block(time, y);
    if (drive_.gives_speed())
      now.shaft.acceleration = now.block.acceleration = drive_.turning(time).acceleration;
    if (joint_) now.block = joint_->block(now.shaft);
    if (has_motor()) now.rotor_speed = now.shaft.speed + y[kTwistRate];
    now.lag = y[kLag];
    now.lag_rate = y[kLagRate];
    now.twist = y[kTwist];
    return now;
  }

  void require_pressures(const OilLoads& loads) const;
  void place(const Posture& now) const;
  void load(const OilLoads& loads);
  void accelerate(const Posture& now, const OilLoads& loads);
  void find_rates(const Posture& now, const MotionVector& y, const OilLoads& loads,
                  MotionVector& dy);
  void add_work_rates(const Posture& now, const MotionVector& y, MotionVector& dy) const;
  template <class Use>
  void realize(const Posture& now, const OilLoads& loads, const Use& use);
  void find_row(const Posture& now, const OilLoads& loads, std::vector<double>& state,
                std::vector<double>& row, MotionChecks& checks);
  double kinetic_energy_in(const Posture& now);
  MotionVector find_scales(const Case& the_case);

  const PumpParameters& pump_;
  CaseDrive drive_;
  mutable PumpSystem system_;  // its state is where place() was asked for last
  mutable Placement placement_;
  FreeMotion free_motion_;
  BodyLoadReader load_reader_;
  ChannelLayout layout_;
  std::unique_ptr<JointMotion> joint_;  // of a pump with a joint
  double arm_;                          // m, of the teeth's line of action about the block's axis
  OilLoads loads_;
  FreeMotion::Accelerations found_;
  mutable std::optional<Posture> placed_;
  MotionVector scales_{};
};

void MultibodyMechanics::require_pressures(const OilLoads& loads) const {
  if (loads.chamber_pressure.size() != static_cast<std::size_t>(layout_.pistons()))
    throw InputError("multibody model: " + std::to_string(loads.chamber_pressure.size()) +
                     " chamber pressures for " + std::to_string(layout_.pistons()) + " pistons");
}

// Leaves the dynamics state realized to Velocity, with forces to be found anew.
void MultibodyMechanics::place(const Posture& now) const {
  State& state = system_.dynamics();
  if (!placed_ || !placed_->moves_as(now)) {
    placed_.reset();
    state.setTime(now.time);
    placement_.place(now.shaft, now.block, now.rotor_speed);
    const double fastest = std::max(std::abs(now.shaft.speed), std::abs(now.block.speed));
    // At standstill what speeds there are is round-off.
    system_.inputs().rest_speed = fastest == 0 ? std::numeric_limits<double>::infinity()
                                               : rest_speed_at(pump_.geometry, fastest);
    placed_ = now;
  }
  state.invalidateAllCacheAtOrAbove(Stage::Dynamics);
  if (has_bevel()) system_.teeth_setting().lag = {now.lag, now.lag_rate};
  if (has_law()) {
    system_.teeth()->set_advance(state, arm_ * now.lag);
    system_.tooth_branch() = tooth_branch_at(law(), arm_ * now.lag, arm_ * now.lag_rate);
  }
  if (has_motor()) system_.drive_torque()->set_twist(state, now.twist);
}

void MultibodyMechanics::load(const OilLoads& loads) {
  require_pressures(loads);
  loads_.chamber_pressure = loads.chamber_pressure;
  system_.inputs().ports = loads.ports;
}

void MultibodyMechanics::accelerate(const Posture& now, const OilLoads& loads) {
  load(loads);
  place(now);
  found_ = free_motion_.solve(shaft_is_free(),
                              joint_ ? joint_->block({now.shaft.angle, 1, 0}).speed : 1);
  if (!std::isfinite(found_.shaft + found_.block + found_.rotor + found_.torque_on_shaft))
    throw ComputationError("multibody model: no accelerations at " + short_text(now.time) + " s");
}

void MultibodyMechanics::find_rates(const Posture& now, const MotionVector& y,
                                    const OilLoads& loads, MotionVector& dy) {
  accelerate(now, loads);
  const State& state = system_.dynamics();
  dy.fill(0);
  if (shaft_is_free()) {
    dy[kTurn] = y[kTurnRate];
    dy[kTurnRate] = found_.shaft;
  }
  if (compliant()) {
    dy[kLag] = y[kLagRate];
    dy[kLagRate] = found_.shaft - found_.block;
    if (walls() != nullptr)
      dy[kImpulse] = walls()->total_force(state);
    else
      dy[kImpulse] = std::abs(has_bevel() ? system_.bevel_torque_on_block(state) / arm_
                                          : system_.teeth()->force(state));
  }
  if (has_motor()) {
    dy[kTwist] = y[kTwistRate];
    dy[kTwistRate] = found_.rotor - found_.shaft;
  }
  add_work_rates(now, y, dy);
}

// What is left to the loads is what dissipates or enters: springs are accounted for by their
// energy.
void MultibodyMechanics::add_work_rates(const Posture& now, const MotionVector& y,
                                        MotionVector& dy) const {
  const State& state = system_.dynamics();
  double drive = shaft_is_free() ? system_.drive_torque()->power(state)
                                 : found_.torque_on_shaft * now.shaft.speed;
  double total = system_.work().power_of_loads(state);
  if (drive_.gives_speed()) total += drive;  // a torque that is applied is among the loads
  // What turns the shaft is Ct Td (38): the rest of Td's work is lost, to friction that is a load.
  if (!has_motor()) drive /= pump_.friction.shaft_torque_factor;
  double elastic = 0;
  if (has_law())
    for (const int flank : {1, -1})
      elastic += flank_force(law(), approach(0, y, flank), 0) * approach_rate(0, y, flank);
  if (walls() != nullptr) elastic += walls()->elastic_power(state);
  if (has_motor()) elastic += motor().coupling_stiffness * y[kTwist] * y[kTwistRate];
  dy[kWorkOfLoads] = total - drive + elastic;
  dy[kWorkOfDrive] = drive;
}

// Calls use(state, motion) where accelerations and reactions are found.
template <class Use>
void MultibodyMechanics::realize(const Posture& now, const OilLoads& loads, const Use& use) {
  load(loads);
  place(now);
  State& dynamics = system_.dynamics();
  // However the row ends: the flank that carries is not known beforehand.
  struct FlankIsForgotten {
    MultibodyMechanics& of;
    ~FlankIsForgotten() {
      if (!of.system_.has_rigid_gear()) return;
      of.system_.gear().setting().negative = false;
      of.placed_.reset();
    }
  };
  const FlankIsForgotten forgotten{*this};
  realize_with_flank(system_, dynamics);
  require_accurate_forces(estimated_force_error(system_, dynamics), now.shaft.angle);
  AxisMotion shaft = now.shaft;
  AxisMotion block = now.block;
  shaft.acceleration = system_.bodies().shaft.getOneUDot(dynamics, 2);
  block.acceleration = system_.bodies().block.getOneUDot(dynamics, 0);
  use(dynamics, AxisMotions{shaft, block});
}

void MultibodyMechanics::find_row(const Posture& now, const OilLoads& loads,
                                  std::vector<double>& state, std::vector<double>& row,
                                  MotionChecks& checks) {
  realize(now, loads, [&](const State& dynamics, const AxisMotions& motion) {
    row.assign(layout_.size(), not_computed());
    read_motion_row(system_, dynamics, motion, loads.chamber_pressure, layout_, row, checks);
  });
  const auto rpm = [](double speed) { return speed / kRadPerSecondPerRpm; };
  state = {now.time, now.shaft.angle / kRadPerDegree, now.block.angle / kRadPerDegree,
           rpm(now.shaft.speed), rpm(now.block.speed)};
  if (has_motor()) state.push_back(rpm(now.rotor_speed));
}

double MultibodyMechanics::kinetic_energy_in(const Posture& now) {
  place(now);
  return system_.system().calcKineticEnergy(system_.dynamics());
}

// Sizes of what acts and of what it moves, the largest of a turn.
MotionVector MultibodyMechanics::find_scales(const Case& the_case) {
  constexpr int kAngles = 12;
  constexpr double kAngle = 0.1;        // rad, over which pressures change
  constexpr double kMinPressure = 1e5;  // Pa
  constexpr double kMinTorque = 1e-6;   // Nm
  constexpr double kOneTouch = 1e-3;    // s
  constexpr double kTouchShare = 0.1;
  const PortPressures& ports = the_case.pressure.ports;
  const double most = std::max({std::abs(ports.delivery), std::abs(ports.suction), kMinPressure});
  const auto pistons = static_cast<std::size_t>(layout_.pistons());
  const double start = drive_.start_speed();

  double torque = kMinTorque;
  double tooth = 0;  // N, that keeps the block with the shaft
  system_.teeth_setting().apart = system_.wall_setting().apart = true;
  double both = 0;               // kg m2
  double lag = SimTK::Infinity;  // kg m2, inertia that the teeth work against
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * kPi * i / kAngles;
    const auto turning = [&](double shaft_speed, double block_speed) {
      Posture now;
      now.shaft = {angle, shaft_speed, 0};
      now.block = {joint_ ? joint_->block({angle, 0, 0}).angle : angle, block_speed, 0};
      return now;
    };
    // The energy of their spin is the pistons' at any speed.
    const double spin = kinetic_energy_in(turning(0, 0));
    const auto inertia = [&](double shaft_speed, double block_speed) {
      return 2 * (kinetic_energy_in(turning(shaft_speed, block_speed)) - spin);
    };
    const double shaft = inertia(1, 0);
    const double block = inertia(0, 1);
    const double all = inertia(1, 1);
    const double mixed = (all - shaft - block) / 2;
    both = std::max(both, all);
    lag = std::min(lag, drive_.gives_speed() ? block : (shaft * block - mixed * mixed) / all);
    // Chambers that shrink are at the higher pressure.
    OilLoads loads{std::vector<double>(pistons, 0.0), ports};
    double pumped = 0;
    for (std::size_t k = 0; k < pistons; ++k) {
      std::vector<double> alone(pistons, 0.0);
      alone[k] = most;
      const double power = multibody::pressure_power(pump_, system_.bodies(), alone,
                                                     system_.dynamics());  // at 1 rad/s
      if (power < 0) loads.chamber_pressure[k] = most;
      pumped += std::max(0.0, -power);
    }
    torque = std::max(torque, pumped);
    // What acts at the start's speed, its inertia's share too; compliant teeth are apart.
    accelerate(turning(start, start), loads);
    const double on_block = mixed * found_.shaft + block * found_.block;
    const double on_shaft = shaft * found_.shaft + mixed * found_.block;
    const double drive =
        shaft_is_free() ? system_.torque_on_shaft(system_.dynamics()) : found_.torque_on_shaft;
    torque = std::max(torque, std::abs(on_shaft + on_block - drive));
    tooth = std::max(tooth, std::abs(on_block) / arm_);
  }
  const DriveSpec& spec = drive_.spec();
  if (!drive_.gives_speed()) {
    torque = std::max(torque, std::abs(spec.torque));
    for (const double value : spec.curve.value) torque = std::max(torque, std::abs(value));
  }
  placed_.reset();
  system_.teeth_setting().apart = system_.wall_setting().apart = false;

  MotionVector scale;
  scale.fill(1);
  scale[kTurn] = kAngle;
  const double omega = rad_per_second(the_case.operation.speed_rpm);
  if (shaft_is_free())
    scale[kTurnRate] =
        kAngle * std::max({std::abs(omega), std::abs(start), std::sqrt(torque * kAngle / both)});
  if (compliant()) {
    // Teeth that meet carry a good part of what the drive gives.
    tooth = std::max(tooth, kTouchShare * torque / arm_);
    double stiffness = 0;  // Nm/rad
    if (walls() != nullptr) {
      stiffness = walls()->torsional_stiffness(tooth * arm_);
    } else if (has_bevel()) {
      stiffness = tooth * arm_ / (bevel().rest(0, tooth * arm_).angle - bevel().rest(0, 0).angle);
    } else {
      const double approach =
          kToothApproach * std::pow(tooth / (law().stiffness * kToothApproach), 1 / law().exponent);
      stiffness = law().exponent * tooth / approach * arm_ * arm_;
    }
    scale[kLag] = std::min(kAngle, tooth * arm_ / stiffness);
    scale[kLagRate] = scale[kLag] * std::sqrt(stiffness / lag);
    scale[kImpulse] = tooth * kOneTouch;
    if (walls() != nullptr) scale[kImpulse] /= pump_.geometry.bore_circle_radius;
  }
  if (has_motor()) {
    const double stiffness = motor().coupling_stiffness;
    scale[kTwist] = std::min(kAngle, torque / stiffness);
    scale[kTwistRate] =
        scale[kTwist] * std::sqrt(stiffness * (1 / motor().rotor_inertia + 1 / both));
  }
  scale[kWorkOfLoads] = scale[kWorkOfDrive] = torque;  // of 1 rad
  return scale;
}

}  // namespace

std::unique_ptr<Mechanics> mechanics(const Case& the_case, const Assumptions& assumptions) {
  require_simulable(the_case, assumptions);
  require_smooth_friction(the_case);
  std::unique_ptr<Mechanics> mechanics;
  translate_simbody_errors(
      [&] { mechanics = std::make_unique<MultibodyMechanics>(the_case, assumptions); });
  return mechanics;
}

}  // namespace bentaxis::multibody
