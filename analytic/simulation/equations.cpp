#include "simulation/equations.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic::simulation {
namespace {

// Bevel teeth replaced by two rigid flanks at O4.
PumpParameters with_flanks(PumpParameters pump) {
  if (pump.gear.contact == ToothContact::teeth) {
    pump.gear.contact = ToothContact::rigid;
    pump.gear.teeth.reset();
  }
  return pump;
}

PumpParameters with_ideal_rings(PumpParameters pump) {
  pump.piston.contact.reset();
  return with_flanks(pump);
}

std::optional<TimeSignal> curve_of(const DriveSpec& drive) {
  if (drive.curve.time.empty()) return {};
  return TimeSignal(drive.curve);
}

}  // namespace

Equations::Equations(const Case& the_case, const Assumptions& assumptions,
                     const PressureTrace& pressure)
    : drive_(drive_of(the_case)),
      pressure_(pressure),
      omega_(rad_per_second(the_case.operation.speed_rpm)),
      torque_factor_(the_case.pump.friction.shaft_torque_factor),
      model_(the_case.pump, assumptions),
      responses_(with_flanks(the_case.pump), assumptions),
      ideal_(with_ideal_rings(the_case.pump), assumptions),
      loads_(the_case.pump, assumptions),
      pump_(the_case.pump),
      assumptions_(assumptions),
      ring_off_(the_case.pump.piston.contact.has_value()),
      law_(closed_form::tooth_law(the_case.pump.gear)),
      arm_(the_case.pump.transfer.kind == TransferKind::gear
               ? the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle)
               : 1),
      curve_(curve_of(drive_)) {
  if (assumptions.gear == BlockDrive::imposed)
    throw InputError(
        "gear = \"imposed\": must be \"mesh\" in a simulation, in which the shaft drives the "
        "block");
  if (the_case.pump.gear.contact == ToothContact::rigid) law_.reset();
  if (the_case.pump.transfer.kind == TransferKind::pistons) {
    walls_.emplace(the_case.pump, assumptions);
    wall_modes.assign(static_cast<std::size_t>(the_case.pump.geometry.pistons),
                      closed_form::WallMode::by_law);
  }
  if (the_case.pump.gear.contact == ToothContact::teeth) bevel_.emplace(the_case.pump);
  start_speed_ = start_speed(*the_case.drive, rad_per_second(the_case.operation.speed_rpm));
  values_.resize(model_.layout().size());
  instant_.chamber_pressure.resize(model_.layout().pistons());
  instant_.ports = the_case.pressure.ports;

  // Sizes of what acts, over a turn without acceleration.
  constexpr int kAngles = 36;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * kPi * i / kAngles;
    instant_.turn(angle, start_speed_);
    set_pressures(angle);
    const Response r = respond({0, 0});
    torque_scale_ = std::max(torque_scale_, std::abs(r.drive_torque));
    tooth_scale_ = std::max(tooth_scale_, std::abs(r.tooth_force));
  }
  torque_scale_ = std::max({torque_scale_, std::abs(drive_.torque), 1e-6});
  for (const double value : drive_.curve.value)
    if (drive_.kind != DriveKind::speed) torque_scale_ = std::max(torque_scale_, std::abs(value));
  tooth_scale_ = std::max(tooth_scale_, 0.1 * torque_scale_ / arm_);
  const Response still = respond({0, 0});
  shaft_inertia_ = std::abs(respond({1e5, 1e5}).drive_torque - still.drive_torque) / 1e5;
  block_inertia_ = std::abs(respond({0, 1e5}).tooth_force - still.tooth_force) * arm_ / 1e5;
  // What turns the block is then a torque of its own, not one of the shaft.
  if (walls_) shaft_inertia_ += block_inertia_;
  // Rounding leaves this much of nothing.
  constexpr double kMinInertia = 1e-14;
  if (drive_.kind != DriveKind::speed && !(shaft_inertia_ > kMinInertia))
    throw InputError("[shaft] axial_inertia_kg_mm2: must be > 0 where a torque drives the shaft");
  if (compliant() && !(block_inertia_ > kMinInertia))
    throw InputError(walls_
                         ? "[block] axial_inertia_kg_mm2: must be > 0 where pistons carry the block"
                         : "[block] axial_inertia_kg_mm2: must be > 0 where the teeth are "
                           "compliant");
  probe_ = torque_scale_ / std::max(shaft_inertia_, kMinInertia);
}

Response Equations::respond(const Accelerations<double>& by, PistonPowers* powers) {
  ++evaluations_;
  return responses_.at(instant_, by, modes(), powers);
}

std::array<Response, 2> Equations::respond(const Accelerations<double>& first,
                                           const Accelerations<double>& second) {
  evaluations_ += 2;
  return responses_.at(instant_, first, second, modes(), &piston_powers_);
}

void Equations::set_inputs(const Surroundings& outside) {
  require_drive(drive_, outside);
  outside_ = outside;
}

AxisMotion Equations::shaft(double time, const State& y) const {
  if (drive_.kind != DriveKind::speed)
    return {start_speed_ * time + y[kTurn], start_speed_ + y[kTurnRate], 0};
  if (outside_.shaft) return outside_.shaft_at(time);
  if (curve_) return {curve_->integral(time), curve_->value(time), curve_->slope(time)};
  return {omega_ * time, omega_, 0};
}

// A joint's block follows from the shaft.
AxisMotion Equations::block(const AxisMotion& shaft, const State& y) const {
  if (pump_.transfer.is_joint()) return model_.block_motion(shaft);
  return {shaft.angle - y[kLag], shaft.speed - y[kLagRate], shaft.acceleration};
}

double Equations::block_angle(double time, const State& y) const {
  return block(shaft(time, y), y).angle;
}

double Equations::block_speed(double time, const State& y) const {
  return block(shaft(time, y), y).speed;
}

const std::vector<WallPath>& Equations::wall_paths(double time, const State& y) const {
  AxisMotion shaft_there = shaft(time, y);
  AxisMotion block_there = block(shaft_there, y);
  shaft_there.acceleration = instant_.shaft.acceleration;
  block_there.acceleration = instant_.block.acceleration;
  const ToothLag lag{y[kLag], y[kLagRate]};
  if (!paths_.empty() && at_walls_.shaft == shaft_there && at_walls_.block == block_there &&
      at_walls_.lag->angle == lag.angle && at_walls_.lag->rate == lag.rate)
    return paths_;
  at_walls_.shaft = shaft_there;
  at_walls_.block = block_there;
  at_walls_.lag = lag;
  walls_->find(at_walls_, paths_);
  return paths_;
}

State Equations::start(const SimulationOptions& options) const {
  State y = {};
  if (drive_.kind != DriveKind::speed) y[kTurnRate] = options.start_speed;
  if (compliant()) y[kLag] = options.start_lag;
  if (options.disturbance != 0) {
    const State scale = scales();
    if (compliant()) y[kLag] += options.disturbance * scale[kLag];
    if (drive_.kind != DriveKind::speed) y[kTurnRate] += options.disturbance * scale[kTurnRate];
  }
  if (drive_.kind == DriveKind::motor && start_speed_ != 0)
    y[kTwist] =
        (curve_ ? curve_->value(start_speed_) : drive_.torque) / drive_.motor->coupling_stiffness;
  return y;
}

State Equations::scales() const {
  // Pressure changes over some tenths of a radian; speeds by the energy that a load feeds there.
  constexpr double kAngle = 0.1;
  State scale;
  scale.fill(1);
  scale[kTurn] = kAngle;
  scale[kTurnRate] = kAngle * std::max({std::abs(omega_), std::abs(start_speed_),
                                        std::sqrt(torque_scale_ * kAngle / shaft_inertia_)});
  if (compliant()) {
    double stiffness = 0;  // Nm/rad
    if (law_) {
      const double approach =
          kToothApproach *
          std::pow(tooth_scale_ / (law_->stiffness * kToothApproach), 1 / law_->exponent);
      stiffness = law_->exponent * tooth_scale_ / approach * arm_ * arm_;
    } else if (walls_) {
      stiffness = walls_->torsional_stiffness(tooth_scale_);
    } else {
      stiffness = bevel_->stiffness() * arm_ * arm_;
    }
    const double reduced = drive_.kind == DriveKind::speed
                               ? block_inertia_
                               : block_inertia_ * (1 - block_inertia_ / (2 * shaft_inertia_));
    scale[kLag] = std::min(kAngle, tooth_scale_ * arm_ / stiffness);
    scale[kLagRate] = scale[kLag] * std::sqrt(stiffness / reduced);
  }
  if (drive_.kind == DriveKind::motor) {
    const MotorData& motor = *drive_.motor;
    const double stiffness = motor.coupling_stiffness;
    scale[kTwist] = std::min(kAngle, torque_scale_ / stiffness);
    scale[kTwistRate] =
        scale[kTwist] * std::sqrt(stiffness * (1 / motor.rotor_inertia + 1 / shaft_inertia_));
  }
  scale[kWorkOfLoads] = scale[kWorkOfDrive] = torque_scale_;
  scale[kImpulse] = (walls_ ? tooth_scale_ / walls_->arm() : tooth_scale_) * 1e-3;
  for (double& size : scale) size = std::exp2(std::round(std::log2(size)));  // exact to divide by
  return scale;
}

std::vector<double> Equations::breakpoints() const {
  return curve_ && drive_.kind != DriveKind::motor ? curve_->breakpoints() : std::vector<double>();
}

void Equations::set_speeds(double time, const State& y) {
  instant_.shaft = shaft(time, y);
  instant_.block = block(instant_.shaft, y);
  if (walls_) instant_.lag = ToothLag{y[kLag], y[kLagRate]};
}

void Equations::set_pressures(double block_angle) {
  const int pistons = model_.layout().pistons();
  const double psi_deg = block_angle / kRadPerDegree;
  for (int k = 0; k < pistons; ++k)
    instant_.chamber_pressure[k] = pressure_(piston_angle_deg(psi_deg, k + 1, pistons));
}

void Equations::at_own_angle(double time, const State& y) {
  const double psi = block_angle(time, y);
  const bool on_edge = std::min(psi - from_angle, to_angle - psi) <= kAtEdge;
  set_pressures(on_edge ? a_hair_within(psi) : psi);
}

double Equations::a_hair_within(double angle) const {
  constexpr double kHair = 1e-10;
  return std::clamp(angle, from_angle + kHair, std::max(to_angle - kHair, from_angle + kHair));
}

double Equations::motor_torque(double rotor_speed) const {
  return curve_ ? curve_->value(rotor_speed)
                : drive_.torque - drive_.motor->torque_slope * (rotor_speed - omega_);
}

double Equations::spring_force(double approach) const {
  const double share = approach / kToothApproach;
  return law_->stiffness * kToothApproach *
         (law_->exponent == 1 ? share
                              : std::copysign(std::pow(std::abs(share), law_->exponent), share));
}

// Of a flank that presses: the law goes on beyond the end of contact, where rates() is asked on the
// way to an event.
double Equations::flank_force(double approach, double rate) const {
  return spring_force(approach) * (1 + law_->dissipation * rate);
}

Motion Equations::motion(double time, const State& y) {
  set_speeds(time, y);
  set_pressures(a_hair_within(instant_.block.angle));
  return teeth_alone_ ? accelerate_block(y) : accelerate(time, y);
}

void Equations::set_loads(const OilLoads& loads) {
  instant_.chamber_pressure = loads.chamber_pressure;
  instant_.ports = loads.ports;
}

Teeth Equations::teeth_at(const State& y) const {
  Teeth now;
  if (!law_) return now;
  for (const int flank : {1, -1}) {
    if (!(approach(y, flank) > 0)) continue;
    const bool pushes = 1 + law_->dissipation * approach_rate(y, flank) > 0;
    (pushes ? now.pressing : now.idle) = flank;
  }
  return now;
}

Motion Equations::motion_under_loads(double time, const State& y) {
  set_speeds(time, y);
  teeth = teeth_at(y);
  return accelerate(time, y);
}

BevelTeeth::Approach Equations::approach_of_teeth(double time, const State& y, int flank) const {
  const AxisMotion turning = shaft(time, y);
  return bevel_->approach(turning.angle, turning.speed, {y[kLag], y[kLagRate]}, flank);
}

// Of drives that give a torque.
double Equations::drive_torque_at(double time, const State& y) const {
  if (const auto torque = outside_.torque_at(time)) return *torque;
  if (drive_.kind == DriveKind::torque) return curve_ ? curve_->value(time) : drive_.torque;
  return drive_.motor->coupling_stiffness * y[kTwist] +
         drive_.motor->coupling_damping * y[kTwistRate];
}

double Equations::tooth_force(const State& y) const {
  if (!law_ || teeth.pressing == 0) return 0;
  return teeth.pressing *
         flank_force(approach(y, teeth.pressing), approach_rate(y, teeth.pressing));
}

// As smooth as the law beyond the end of contact, where the force is below 0.
double Equations::pressing_force(const Motion& m) const {
  return law_ ? teeth.pressing * m.tooth_force : std::abs(m.tooth_force);
}

double Equations::tooth_acceleration(const State& y) const {
  return std::abs(tooth_force(y)) * arm_ / block_inertia_;
}

// What the teeth do at the instant, by their law.
void Equations::find_tooth_force(const State& y, Motion& m) {
  if (law_) m.tooth_force = tooth_force(y);
  if (!bevel_) return;
  instant_.lag = ToothLag{y[kLag], y[kLagRate]};
  const BevelTeeth::Wrench w =
      bevel_->wrench(instant_.shaft.angle, instant_.shaft.speed, *instant_.lag);
  m.shaft_moment = -BevelTeeth::about_shaft_axis(w.moment);
  m.tooth_force = bevel_->about_block_axis(w.moment) / arm_;
}

// By the contact law, where the shaft's motion is given: nothing else is known of it then.
Motion Equations::accelerate_block(const State& y) {
  Motion m;
  m.tooth_force = tooth_force(y);
  const double given = instant_.shaft.acceleration;
  evaluations_ += 2;
  const auto [still, by_block] = responses_.tooth_forces(instant_, {given, 0}, {given, probe_});
  instant_.block.acceleration = (m.tooth_force - still) / (by_block - still) * probe_;
  m.shaft = instant_.shaft;
  m.block = instant_.block;
  return m;
}

// Of the instant, whose speeds and pressures are set.
Motion Equations::accelerate(double time, const State& y) {
  Motion m;
  const bool speed_given = drive_.kind == DriveKind::speed;
  const double given = instant_.shaft.acceleration;
  if (!speed_given) m.drive_torque = drive_torque_at(time, y);
  double shaft = given, block = given;
  if (!compliant()) {
    if (!speed_given) {
      const auto [still, moved] = respond({0, 0}, {probe_, probe_});
      shaft = block = (m.drive_torque - still.drive_torque) /
                      (moved.drive_torque - still.drive_torque) * probe_;
    }
  } else {
    find_tooth_force(y, m);
    // Td beyond what it is with the force at O4.
    const double more = bevel_ ? -(m.shaft_moment + m.tooth_force * arm_) / torque_factor_ : 0.0;
    const auto [still, by_block] = respond({given, 0}, {given, probe_});
    const double block_force = by_block.tooth_force - still.tooth_force;
    const double block_torque = by_block.drive_torque - still.drive_torque;
    const double force = m.tooth_force - still.tooth_force;
    if (speed_given) {
      block = force / block_force;  // in probes
      m.drive_torque = still.drive_torque + block * block_torque + more;
    } else {
      const Response by_shaft = respond({probe_, 0});
      const double shaft_force = by_shaft.tooth_force - still.tooth_force;
      const double shaft_torque = by_shaft.drive_torque - still.drive_torque;
      const double torque = m.drive_torque - more - still.drive_torque;
      const double determinant = shaft_torque * block_force - block_torque * shaft_force;
      shaft = (torque * block_force - block_torque * force) / determinant * probe_;
      block = (shaft_torque * force - torque * shaft_force) / determinant;
    }
    block *= probe_;
  }
  instant_.shaft.acceleration = shaft;
  instant_.block.acceleration = block;
  if (speed_given && !compliant())
    m.drive_torque = respond({shaft, block}, &piston_powers_).drive_torque;
  if (pump_.transfer.is_joint()) instant_.block = model_.block_motion(instant_.shaft);
  m.shaft = instant_.shaft;
  m.block = instant_.block;
  return m;
}

void Equations::rates(double time, const State& y, State& dy) {
  const Motion m = motion(time, y);
  if (!teeth_alone_) {
    add_rates(time, y, m, dy);
    return;
  }
  dy.fill(0);
  dy[kLag] = y[kLagRate];
  dy[kLagRate] = m.shaft.acceleration - m.block.acceleration;
  dy[kImpulse] = pressing_force(m);
}

void Equations::rates_under_loads(double time, const State& y, State& dy) {
  const Motion m = motion_under_loads(time, y);
  add_rates(time, y, m, dy);
  if (walls_) dy[kImpulse] = wall_force_;
}

double Equations::pressure_power(double time, const State& y) {
  set_speeds(time, y);
  return loads_.pressure_power(instant_);
}

void Equations::add_rates(double time, const State& y, const Motion& m, State& dy) {
  dy.fill(0);
  const double shaft_speed = m.shaft.speed;
  double loads = loads_.power(instant_, m.drive_torque, piston_powers_);
  if (ring_off_) {
    MotionChecks checks{};
    model_.evaluate(instant_, values_, &checks);
    loads += checks.ring_power;
  }
  double drive = m.drive_torque * shaft_speed;
  if (drive_.kind != DriveKind::speed) {
    dy[kTurn] = y[kTurnRate];
    dy[kTurnRate] = m.shaft.acceleration;
  }
  if (compliant()) {
    dy[kLag] = y[kLagRate];
    dy[kLagRate] = m.shaft.acceleration - m.block.acceleration;
    dy[kImpulse] = pressing_force(m);
  }
  if (bevel_) loads += m.shaft_moment * shaft_speed + m.tooth_force * arm_ * m.block.speed;
  if (walls_) {
    // What the walls take in beyond what their springs hold.
    const std::vector<WallPath>& paths = wall_paths(time, y);
    wall_force_ = 0;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const auto [distance, rate, rate_dot] = paths[k];
      if (!(distance > 0)) continue;
      const double spring = walls_->spring(distance);
      const bool pushes =
          wall_modes[k] == closed_form::WallMode::pressing ||
          (wall_modes[k] == closed_form::WallMode::by_law && 1 + walls_->dissipation() * rate > 0);
      const double force = pushes ? spring * (1 + walls_->dissipation() * rate) : 0.0;
      wall_force_ += force;
      loads -= (force - spring) * rate;
    }
  }
  if (law_) {
    // What the flanks take in beyond what their springs hold.
    for (const int flank : {1, -1}) {
      const double x = approach(y, flank);
      if (x > 0)
        loads -= (teeth.pressing == flank ? flank * m.tooth_force : 0.0) * approach_rate(y, flank) -
                 spring_force(x) * approach_rate(y, flank);
    }
  }
  if (drive_.kind == DriveKind::motor) {
    const MotorData& motor = *drive_.motor;
    const double rotor_speed = shaft_speed + y[kTwistRate];
    const double torque = motor_torque(rotor_speed);
    const double rotor = (torque - m.drive_torque) / motor.rotor_inertia;
    dy[kTwist] = y[kTwistRate];
    dy[kTwistRate] = rotor - m.shaft.acceleration;
    loads -= motor.coupling_damping * y[kTwistRate] * y[kTwistRate];
    drive = torque * rotor_speed;
  }
  dy[kWorkOfLoads] = loads;
  dy[kWorkOfDrive] = drive;
}

void Equations::row(double time, const State& y, const Motion& m, std::vector<double>& state,
                    std::vector<double>& row, MotionChecks& checks) const {
  row.assign(model_.layout().size(), not_computed());
  model_.evaluate(instant_, row, &checks);
  // The motion is free: nothing acts on the block from outside.
  if (walls_) row[model_.layout().Tb()] = not_computed();
  // By the lag's own digits.
  if (law_ || bevel_) checks.tooth_law = m.tooth_force;
  const double psi = pump_.transfer.is_joint() ? m.block.angle : m.shaft.angle - y[kLag];
  state = {time, m.shaft.angle / kRadPerDegree, psi / kRadPerDegree,
           m.shaft.speed / kRadPerSecondPerRpm, m.block.speed / kRadPerSecondPerRpm};
  if (drive_.kind == DriveKind::motor)
    state.push_back((m.shaft.speed + y[kTwistRate]) / kRadPerSecondPerRpm);
}

std::vector<BodyLoad> Equations::body_loads() {
  if (!body_loads_) body_loads_.emplace(pump_, assumptions_);
  return body_loads_->evaluate(instant_);
}

double Equations::kinetic_energy(double time, const State& y) {
  set_speeds(time, y);
  evaluations_ += 3;
  const auto [still, by_shaft] = ideal_.at(instant_, {0, 0}, {probe_, 0}, modes());
  const Response by_block = ideal_.at(instant_, {0, probe_}, modes());
  // The mass matrix is what the torques on shaft and block gain by accelerations: the gear's acts
  // on both.
  const double mixed = arm_ * (by_shaft.tooth_force - still.tooth_force);
  const double block = arm_ * (by_block.tooth_force - still.tooth_force);
  // A gear's force acts on both bodies; a joint's block has no motion of its own.
  const double of_gear = pump_.transfer.kind == TransferKind::gear ? mixed : 0.0;
  const double shaft = torque_factor_ * (by_shaft.drive_torque - still.drive_torque) - of_gear;
  const double theta = instant_.shaft.speed;
  const double psi = instant_.block.speed;
  double energy =
      (shaft * theta * theta + 2 * mixed * theta * psi + block * psi * psi) / 2 / probe_;
  if (drive_.kind == DriveKind::motor)
    energy += drive_.motor->rotor_inertia * std::pow(theta + y[kTwistRate], 2) / 2;
  return energy;
}

double Equations::wall_energy(double time, const State& y) const {
  double energy = 0;
  if (walls_)
    for (const WallPath& path : wall_paths(time, y))
      if (path.distance > 0)
        energy += walls_->spring(path.distance) * path.distance / (walls_->exponent() + 1);
  return energy;
}

double Equations::potential_energy(const State& y) const {
  double energy = 0;
  if (law_)
    for (const int flank : {1, -1}) {
      const double x = approach(y, flank);
      if (x > 0) energy += spring_force(x) * x / (law_->exponent + 1);
    }
  if (drive_.kind == DriveKind::motor)
    energy += drive_.motor->coupling_stiffness * y[kTwist] * y[kTwist] / 2;
  return energy;
}

}  // namespace bentaxis::analytic::simulation
