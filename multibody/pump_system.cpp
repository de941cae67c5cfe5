#include "pump_system.h"

#include <cmath>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "conventions.h"

namespace bentaxis::multibody {

using SimTK::Inertia;
using SimTK::MassProperties;
using SimTK::Real;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Transform;
using SimTK::UnitVec3;
using SimTK::Vec3;
using SimTK::Vector;

namespace {

// Constraint errors (m) the projection is asked to reach: below the round-off of positions, so that
// it goes on until Newton's step no longer helps.
constexpr double kAssemblyGoal = 1e-17;
// An error this small cannot be improved: round-off of coordinates of 0.1 m.
constexpr double kRoundOff = 5e-17;
// What an assembly must reach to count as one.
constexpr double kAssemblyTolerance = 1e-12;
// Singular values of the scaled constraint matrix below this share of the largest count as zero.
constexpr double kRankTolerance = 1e-11;
// A step in theta up to which the last assembly is a better start than a fresh guess.
constexpr double kNearby = 0.2;

// Prescribes rotation about the joint's z axis, for a pin (1 coordinate) or a ball (quaternion).
class TurningMotion : public SimTK::Motion::Custom::Implementation {
 public:
  TurningMotion(const Turning& turning, bool is_ball) : turning_(turning), is_ball_(is_ball) {}
  TurningMotion* clone() const override { return new TurningMotion(*this); }
  SimTK::Motion::Level getLevel(const State&) const override { return SimTK::Motion::Position; }
  SimTK::Motion::Method getLevelMethod(const State&) const override {
    return SimTK::Motion::Prescribed;
  }
  void calcPrescribedPosition(const State& s, int, Real* q) const override {
    const double angle = turning_.angle(s.getTime());
    if (!is_ball_) {
      q[0] = angle;
      return;
    }
    q[0] = std::cos(angle / 2);
    q[1] = q[2] = 0;
    q[3] = std::sin(angle / 2);
  }
  void calcPrescribedPositionDot(const State& s, int, Real* qdot) const override {
    const double angle = turning_.angle(s.getTime());
    if (!is_ball_) {
      qdot[0] = turning_.omega;
      return;
    }
    qdot[0] = -std::sin(angle / 2) * turning_.omega / 2;
    qdot[1] = qdot[2] = 0;
    qdot[3] = std::cos(angle / 2) * turning_.omega / 2;
  }
  void calcPrescribedPositionDotDot(const State& s, int, Real* qdotdot) const override {
    const double angle = turning_.angle(s.getTime());
    const double half = turning_.omega / 2;
    const double half_dot = turning_.omega_dot / 2;
    if (!is_ball_) {
      qdotdot[0] = turning_.omega_dot;
      return;
    }
    qdotdot[0] = -std::cos(angle / 2) * half * half - std::sin(angle / 2) * half_dot;
    qdotdot[1] = qdotdot[2] = 0;
    qdotdot[3] = -std::sin(angle / 2) * half * half + std::cos(angle / 2) * half_dot;
  }

 private:
  const Turning& turning_;
  bool is_ball_;
};

// A body that is symmetric about z with its centre of mass on z. Simbody takes the centre's share
// off again and refuses a body where rounding then leaves less than nothing.
MassProperties symmetric_body(double mass, double centre_z, double transverse_about_origin,
                              double axial) {
  const double of_centre = mass * centre_z * centre_z;
  transverse_about_origin = std::max(transverse_about_origin, of_centre * (1 + 8 * SimTK::Eps));
  return {mass, Vec3(0, 0, centre_z),
          Inertia(transverse_about_origin, transverse_about_origin, axial)};
}

// Inertia of shaft and block across their axis never acts (the axes do not tilt) but must be
// positive for Simbody; an axial inertia of 0 likewise does not act at constant speed.
double nominal_inertia(double given) {
  constexpr double kAny = 1e-3;  // kg m2
  return given > 0 ? given : kAny;
}

// A point mass on a piston's axis, from A.
struct PointMass {
  double mass = 0;
  double z = 0;
};

// Masses at A, at the centre of mass and at B with the real piston's mass, centre and transverse
// inertia: the middle one is what the outer two, with their common centre there, leave over.
std::vector<PointMass> three_point_masses(const PistonMass& piston, double length) {
  const auto& real = *piston.real;
  const double from_a = real.centre_of_mass;
  const double outer =
      real.transverse_inertia > 0 ? real.transverse_inertia / (from_a * (length - from_a)) : 0;
  return {{outer * (length - from_a) / length, 0},
          {piston.mass - outer, from_a},
          {outer * from_a / length, length}};
}

ComputationError no_assembly(double theta) {
  return ComputationError("multibody model: no assembly found at theta = " +
                          std::to_string(theta / kRadPerDegree) + " deg");
}
// Nor does a mass on a fixed axis act but by its weight: one of 0 gets next to nothing, because
// Simbody has no inertia without mass.
double nominal_mass(double given) {
  constexpr double kNextToNothing = 1e-30;  // kg
  return given > 0 ? given : kNextToNothing;
}

}  // namespace

// Force element without force: integrates the power of loads and drives along with the motion.
class PumpSystem::WorkMeter : public SimTK::Force::Custom::Implementation {
 public:
  explicit WorkMeter(const PumpSystem& owner) : owner_(owner) {}
  void calcForce(const State&, SimTK::Vector_<SpatialVec>&, SimTK::Vector_<Vec3>&,
                 Vector&) const override {}
  Real calcPotentialEnergy(const State&) const override { return 0; }
  void realizeTopology(State& state) const override {
    first_ = owner_.forces_.allocateZ(state, Vector(2, Real(0)));
  }
  void realizeAcceleration(const State& state) const override {
    const auto& forces = owner_.system_.getRigidBodyForces(state, SimTK::Stage::Dynamics);
    double loads = 0;
    for (SimTK::MobilizedBodyIndex i(1); i < owner_.matter_.getNumBodies(); ++i) {
      const SpatialVec& v = owner_.matter_.getMobilizedBody(i).getBodyVelocity(state);
      loads += SimTK::dot(forces[i][0], v[0]) + SimTK::dot(forces[i][1], v[1]);
    }
    double drives = 0;
    if (owner_.drive_ == Drive::constant_speed)
      drives += owner_.drive_torque(state) * owner_.shaft_.getBodyAngularVelocity(state)[2];
    if (!owner_.has_gear())
      drives += owner_.imposed_block_torque(state) * owner_.block_.getOneU(state, 0);
    Vector& rate = owner_.forces_.updZDot(state);
    rate[first_] = loads;
    rate[first_ + 1] = drives;
  }
  double value(const State& state, int which) const {
    return owner_.forces_.getZ(state)[first_ + which];
  }

 private:
  const PumpSystem& owner_;
  mutable SimTK::ZIndex first_;
};

PumpSystem::PumpSystem(const PumpParameters& pump, const Assumptions& assumptions, double omega,
                       Drive drive)
    : pump_(pump), assumptions_(assumptions), drive_(drive), matter_(system_), forces_(system_) {
  if (drive == Drive::torque && !(pump.shaft.axial_inertia > 0 && pump.block.axial_inertia > 0))
    throw InputError("a shaft that runs free needs axial inertias of shaft and block above 0");
  inputs_.rest_speed = piston_rest_speed(pump.geometry, omega);
  inputs_.chamber_pressure = [](double, std::vector<double>& p) {
    std::fill(p.begin(), p.end(), 0.0);
  };
  add_shaft_and_block(omega);
  SimTK::Force::UniformGravity(forces_, matter_, Vec3(0, -pump_.gravity, 0));
  add_pistons();
  PumpLoads(forces_, pump_, assumptions_, bodies_, inputs_,
            is_prescribed() ? LoadedBodies::pistons : LoadedBodies::all);
  if (drive_ == Drive::constant_speed || drive_ == Drive::torque) {
    work_ = new WorkMeter(*this);
    SimTK::Force::Custom(forces_, work_);
  }

  system_.realizeTopology();
  assembly_ = system_.getDefaultState();
  dynamics_ = system_.getDefaultState();
  if (!is_prescribed()) {
    // Assembly: shaft and block follow the prescribed turning, so what holds them is switched off.
    cylindrical_.constraint().disable(assembly_);
    if (drive_ == Drive::constant_speed) speed_.disable(assembly_);
    if (drive_ == Drive::given_acceleration) acceleration_.disable(assembly_);
    if (has_gear()) gear_->disable(assembly_);
    // Dynamics: joints and constraints hold them; an imposed block keeps its motion.
    shaft_motion_.disable(dynamics_);
    if (has_gear()) block_motion_.disable(dynamics_);
  }
  system_.realize(assembly_, SimTK::Stage::Instance);
  system_.realize(dynamics_, SimTK::Stage::Instance);
  solver_ = std::make_unique<PistonSolver>(
      system_, matter_, shaft_, block_, bodies_.pistons, bores_, pump_.geometry.piston_length,
      pistons_free_to_spin_ ? pump_.piston.real->spin : 0, dynamics_);
}

void PumpSystem::add_shaft_and_block(double omega) {
  const Geometry& g = pump_.geometry;
  const Vec3 c1(0, 0, pump_.bearings.tapered_z);
  const Vec3 c2(0, 0, pump_.bearings.cylindrical_z);
  bodies_.block_frame = Rotation(-g.tilt, SimTK::XAxis);
  bodies_.block_origin = Vec3(0, 0, g.axis_offset);
  bodies_.shaft_origin = c1;

  const double zs = pump_.shaft.centre_of_mass_z;
  const double shaft_inertia = nominal_inertia(pump_.shaft.axial_inertia);
  const double shaft_mass = nominal_mass(pump_.shaft.mass);
  shaft_ = SimTK::MobilizedBody::Ball(
      matter_.updGround(), Transform(c1),
      SimTK::Body::Rigid(
          symmetric_body(shaft_mass, zs, shaft_inertia + shaft_mass * zs * zs, shaft_inertia)),
      Transform(c1));
  const double zc = pump_.block.centre_of_mass_z;
  const double block_inertia = nominal_inertia(pump_.block.axial_inertia);
  const double block_mass = nominal_mass(pump_.block.mass);
  block_ = SimTK::MobilizedBody::Pin(
      matter_.updGround(), Transform(bodies_.block_frame, bodies_.block_origin),
      SimTK::Body::Rigid(
          symmetric_body(block_mass, zc, block_inertia + block_mass * zc * zc, block_inertia)),
      Transform());
  bodies_.shaft = shaft_;
  bodies_.block = block_;
  shaft_motion_ = SimTK::Motion::Custom(shaft_, new TurningMotion(turning_, true));
  block_motion_ = SimTK::Motion::Custom(block_, new TurningMotion(turning_, false));
  if (is_prescribed()) return;

  cylindrical_ = InlineJoint(matter_.updGround(), UnitVec3(SimTK::ZAxis), c2, shaft_, c2);
  constexpr int kAboutZ = 2;
  if (drive_ == Drive::constant_speed)
    speed_ = SimTK::Constraint::ConstantSpeed(shaft_, SimTK::MobilizerUIndex(kAboutZ), omega);
  if (drive_ == Drive::given_acceleration)
    acceleration_ =
        SimTK::Constraint::ConstantAcceleration(shaft_, SimTK::MobilizerUIndex(kAboutZ), 0);
  if (has_gear()) {
    // (19)-(22): pitch cones of 90 deg - alpha/2 touch at O4.
    const double radius = pump_.gear.pitch_diameter / 2;
    const double cone = kPi / 2 - g.tilt / 2;
    const double sign = omega < 0 ? -1 : 1;
    const double ap = pump_.gear.pressure_angle;
    const Vec3 mesh_point(0, radius, -radius / std::tan(cone) + g.axis_offset);
    const Vec3 line =
        sign * Vec3(-std::cos(ap), std::sin(ap) * std::cos(cone), std::sin(ap) * std::sin(cone));
    gear_ = std::make_unique<GearMesh>(matter_, shaft_, block_, mesh_point, UnitVec3(line),
                                       bodies_.block_frame);
  }
}

void PumpSystem::add_pistons() {
  const Geometry& g = pump_.geometry;
  const PistonMass& mass = pump_.piston;
  const double length = g.piston_length;
  if (assumptions_.inertia != PistonInertia::lumped && mass.mass == 0 && mass.real &&
      (mass.real->transverse_inertia > 0 || mass.real->axial_inertia > 0))
    throw ComputationError(
        "multibody model: a piston with inertia (transverse_ or axial_inertia_kg_mm2) but without "
        "mass "
        "(mass_kg = 0) is no body in Simbody; the analytic model has no such limit");
  MassProperties properties;
  if (assumptions_.inertia == PistonInertia::lumped) {
    const double at_ring = (1 - mass.joint_mass_fraction) * mass.mass;
    properties = symmetric_body(mass.mass, (1 - mass.joint_mass_fraction) * length,
                                at_ring * length * length, 0);
    pistons_free_to_spin_ = false;
  } else if (const std::string why = piston_inertia_refusal(assumptions_.inertia, pump_);
             !why.empty()) {
    throw InputError(to_string(assumptions_.inertia) + " pistons: " + why);
  } else if (assumptions_.inertia == PistonInertia::dynamically_equivalent) {
    double about_joint = 0;
    double moment = 0;
    for (const PointMass& point : three_point_masses(mass, length)) {
      moment += point.mass * point.z;
      about_joint += point.mass * point.z * point.z;
    }
    properties = symmetric_body(mass.mass, mass.mass > 0 ? moment / mass.mass : 0, about_joint, 0);
    pistons_free_to_spin_ = false;
  } else {
    const auto& real = *mass.real;
    properties = symmetric_body(
        mass.mass, real.centre_of_mass,
        real.transverse_inertia + mass.mass * real.centre_of_mass * real.centre_of_mass,
        real.axial_inertia);
    pistons_free_to_spin_ = real.axial_inertia > 0;
  }
  piston_inertia_about_joint_ = properties.getInertia().getMoments()[0];

  for (int k = 0; k < g.pistons; ++k) {
    const Rotation phase(-2 * kPi * k / g.pistons, SimTK::ZAxis);
    const Vec3 joint = phase * Vec3(0, g.joint_circle_radius, 0);
    const Vec3 bore = phase * Vec3(0, g.bore_circle_radius, 0);
    joint_points_.push_back(joint);
    bore_points_.push_back(bore);
    const SimTK::Body::Rigid body(properties);
    SimTK::MobilizedBody piston;
    // A body without inertia about its own axis must not have that freedom.
    if (pistons_free_to_spin_)
      piston = SimTK::MobilizedBody::Ball(shaft_, Transform(joint), body, Transform());
    else
      piston = SimTK::MobilizedBody::LineOrientation(shaft_, Transform(joint), body, Transform());
    bodies_.pistons.push_back(piston);
    bores_.emplace_back(block_, UnitVec3(SimTK::ZAxis), bore, piston, Vec3(0, 0, length));
  }
}

void PumpSystem::require_piston_inertia() const {
  if (!(piston_inertia_about_joint_ > 0))
    throw ComputationError(
        "multibody model: a piston without inertia about its joint A (mass 0, or all of it at A) "
        "has no equation of motion in Simbody; use --reactions residual, or the analytic model");
}

void PumpSystem::guess_pistons() {
  // Parallel to the block axis: Newton's method then climbs to the positive root of (12).
  const Rotation shaft_to_block = ~Rotation(turning_.theta, SimTK::ZAxis) * bodies_.block_frame;
  for (const auto& piston : bodies_.pistons) piston.setQToFitRotation(assembly_, shaft_to_block);
}

void PumpSystem::assemble(double theta, double omega) {
  turning_.theta = theta;
  turning_.omega = omega;
  // Time only tells Simbody that the prescribed angle has changed.
  turning_.start = assembly_.getTime() + 1;
  assembly_.setTime(turning_.start);
  const bool nearby = assembled_theta_ && std::abs(theta - *assembled_theta_) < kNearby;
  assembled_theta_.reset();

  SimTK::ProjectOptions options(kAssemblyGoal);
  options.setOption(SimTK::ProjectOptions::DontThrow);
  options.setOption(SimTK::ProjectOptions::ForceProjection);
  options.setOption(SimTK::ProjectOptions::ForceFullNewton);
  SimTK::ProjectResults results;
  Vector no_estimate;
  bool done = false;
  for (const bool fresh : {!nearby, true}) {
    if (done) break;
    system_.realize(assembly_, SimTK::Stage::Time);
    if (fresh) guess_pistons();
    system_.prescribeQ(assembly_);
    system_.realize(assembly_, SimTK::Stage::Position);
    // Far from the solution the projection may stop early without harm: go on from there.
    constexpr int kAttempts = 30;
    double before = SimTK::Infinity;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      results = SimTK::ProjectResults();
      system_.projectQ(assembly_, no_estimate, options, results);
      // projectQ leaves quaternions unnormalized when it gives up short of its goal.
      matter_.normalizeQuaternions(assembly_);
      system_.realize(assembly_, SimTK::Stage::Position);
      const double after = assembly_.getQErr().normInf();
      done = after <= kAssemblyTolerance;
      if (after <= kRoundOff || !(after < before / 2)) break;
      before = after;
    }
    const Vec3 z2(bodies_.block_frame.z());
    for (const auto& piston : bodies_.pistons)
      done = done && SimTK::dot(z2, Vec3(piston.getBodyRotation(assembly_).z())) > 0;
  }
  if (!done) throw no_assembly(theta);

  system_.prescribeU(assembly_);
  system_.realize(assembly_, SimTK::Stage::Velocity);
  options.setRequiredAccuracy(1e-12 * std::max(1.0, std::abs(omega)));
  results = SimTK::ProjectResults();
  system_.projectU(assembly_, no_estimate, options, results);
  system_.realize(assembly_, SimTK::Stage::Velocity);
  if (pistons_free_to_spin_) set_piston_spins();
  assembled_theta_ = theta;
}

// The inline joint leaves a piston's spin free; projection would leave some value of its own. The
// absolute angular velocity is e x e' plus the spin about e.
void PumpSystem::set_piston_spins() {
  const Vec3 ring(0, 0, pump_.geometry.piston_length);
  std::vector<Vec3> rates;
  for (const auto& piston : bodies_.pistons) {
    const Vec3 axis(piston.getBodyRotation(assembly_).z());
    const Vec3 tip = piston.findStationVelocityInGround(assembly_, ring) -
                     piston.getBodyOriginVelocity(assembly_);
    rates.push_back(axis % tip / pump_.geometry.piston_length + pump_.piston.real->spin * axis);
  }
  const Vec3 shaft_rate = shaft_.getBodyAngularVelocity(assembly_);
  const Rotation shaft = shaft_.getBodyRotation(assembly_);
  for (std::size_t k = 0; k < rates.size(); ++k)
    bodies_.pistons[k].setUToFitAngularVelocity(assembly_, ~shaft * (rates[k] - shaft_rate));
  system_.realize(assembly_, SimTK::Stage::Velocity);
}

void PumpSystem::copy_assembly_to_dynamics() {
  dynamics_.setTime(assembly_.getTime());
  dynamics_.updQ() = assembly_.getQ();
  dynamics_.updU() = assembly_.getU();
}

bool PumpSystem::solve_placement() {
  Vector& q = dynamics_.updQ();
  const int shaft = shaft_.getFirstQIndex(dynamics_);
  q[shaft] = std::cos(placed_theta_ / 2);
  q[shaft + 1] = q[shaft + 2] = 0;
  q[shaft + 3] = std::sin(placed_theta_ / 2);
  q[block_.getFirstQIndex(dynamics_)] = placed_theta_;
  if (!(solver_->solve_positions(dynamics_) <= kAssemblyTolerance)) return false;
  const Vec3 z2(bodies_.block_frame.z());
  for (const auto& piston : bodies_.pistons)
    if (!(SimTK::dot(z2, Vec3(piston.getBodyRotation(dynamics_).z())) > 0)) return false;
  return true;
}

// A's distance from its bore's axis fixes the piston's direction across that axis, its length the
// rest; of the two roots the one along z2. A guess: Simbody's own equations judge it, and where
// they do not hold to round-off its placement goes on from there.
bool PumpSystem::guess_placement(double theta) {
  const Rotation shaft(theta, SimTK::ZAxis);
  const Rotation block = bodies_.block_frame * Rotation(theta, SimTK::ZAxis);
  const Rotation to_block(~block * shaft);
  const Vec3 origin = ~block * bodies_.block_origin;
  Vector& q = dynamics_.updQ();
  for (std::size_t k = 0; k < bodies_.pistons.size(); ++k) {
    const Vec3 across =
        (bore_points_[k] + origin - to_block * joint_points_[k]) / pump_.geometry.piston_length;
    const double along = 1 - across[0] * across[0] - across[1] * across[1];
    if (!(along > 0)) return false;
    const Vec3 axis = ~to_block * Vec3(across[0], across[1], std::sqrt(along));
    // The turn that takes z to the axis the shortest way; a turn about the piston's own axis
    // changes nothing.
    SimTK::Vec4 quaternion(axis.norm() + axis[2], -axis[1], axis[0], 0);
    quaternion /= quaternion.norm();
    const int first_q = bodies_.pistons[k].getFirstQIndex(dynamics_);
    for (int i = 0; i < 4; ++i) q[first_q + i] = quaternion[i];
  }
  return true;
}

void PumpSystem::place(double theta, double omega, double omega_dot) {
  placed_theta_ = theta;
  placed_omega_dot_ = omega_dot;
  if (!(guess_placement(theta) && solve_placement())) {
    assemble(theta, omega);
    copy_assembly_to_dynamics();
    if (!solve_placement()) throw no_assembly(theta);
  }
  // What is prescribed in this state (both bodies, or an imposed block) moves with the rest.
  turning_.theta = theta;
  turning_.start = dynamics_.getTime();
  turning_.omega = omega;
  turning_.omega_dot = omega_dot;
  Vector& u = dynamics_.updU();
  u = 0;
  u[shaft_.getFirstUIndex(dynamics_) + 2] = omega;
  u[block_.getFirstUIndex(dynamics_)] = omega;
  const double rate_error = solver_->solve_speeds(dynamics_);
  if (!(rate_error <= kAssemblyTolerance * std::max(1.0, std::abs(omega))))
    throw ComputationError(
        "multibody model: no speeds found that keep the pistons in their bores at "
        "theta = " +
        std::to_string(theta / kRadPerDegree) + " deg");
}

void PumpSystem::constrained_accelerations(Vector& udot) {
  udot.resize(dynamics_.getNU());
  udot = 0;
  udot[shaft_.getFirstUIndex(dynamics_) + 2] = placed_omega_dot_;
  udot[block_.getFirstUIndex(dynamics_)] = placed_omega_dot_;
  solver_->solve_accelerations(dynamics_, udot);
}

double PumpSystem::drive_torque(const State& state) const {
  switch (drive_) {
    case Drive::constant_speed:
      return applied_generalized_force(state, speed_);
    case Drive::given_acceleration:
      return applied_generalized_force(state, acceleration_);
    case Drive::torque:
    case Drive::prescribed:
      break;
  }
  return 0;
}

double PumpSystem::imposed_block_torque(const State& state) const {
  Vector torques;
  matter_.findMotionForces(state, torques);
  return -block_.getOneFromUPartition(state, 0, torques);
}

void PumpSystem::set_acceleration(State& state, double omega_dot) const {
  if (acceleration_.getAcceleration(state) != omega_dot)
    acceleration_.setAcceleration(state, omega_dot);
}

double PumpSystem::work_of_loads(const State& state) const { return work_->value(state, 0); }
double PumpSystem::work_of_drives(const State& state) const { return work_->value(state, 1); }

double PumpSystem::gear_phase(const State& state) const {
  return std::remainder(turn_angle(block_.getBodyRotation(state), bodies_.block_frame) -
                            turn_angle(shaft_.getBodyRotation(state), Rotation()),
                        2 * kPi);
}

PumpSystem::Rank PumpSystem::constraint_rank(const State& state) const {
  SimTK::Matrix g;
  matter_.calcG(state, g);
  Rank result;
  result.equations = g.nrow();
  result.mobilities = g.ncol();
  // Rows are in units of the constraints (speeds of points, angular speed): scaled to length 1.
  for (int i = 0; i < g.nrow(); ++i) g[i] /= std::max(g[i].norm(), 1e-300);
  SimTK::FactorSVD svd(g);
  Vector singular_values;
  svd.getSingularValues(singular_values);
  for (int i = 0; i < singular_values.size(); ++i)
    if (singular_values[i] > kRankTolerance * singular_values[0]) ++result.rank;
  return result;
}

}  // namespace bentaxis::multibody
