#include "placement/placement.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {

using SimTK::Rotation;
using SimTK::Vec3;
using SimTK::Vector;

namespace {

// Constraint errors (m) the projection is asked to reach: below the round-off of positions, so that
// it goes on until Newton's step no longer helps.
constexpr double kAssemblyGoal = 1e-17;
// An error this small cannot be improved: round-off of coordinates of 0.1 m.
constexpr double kPositionRoundOff = 5e-17;
// A step in theta, rad, up to which the last assembly is a better start than a fresh guess: pistons
// move by a fraction of the bore's radius. A guess follows where it fails.
constexpr double kNearby = 0.2;

std::string where(double theta, double psi) {
  const std::string at = " at theta = " + std::to_string(theta / kRadPerDegree) + " deg";
  return psi == theta ? at : at + ", psi = " + std::to_string(psi / kRadPerDegree) + " deg";
}

ComputationError no_assembly(const AxisMotion& shaft, const AxisMotion& block) {
  return ComputationError("multibody model: no assembly found" + where(shaft.angle, block.angle));
}

// The speeds that constraint equations are held to follow the faster body.
double speed_scale(const AxisMotion& shaft, const AxisMotion& block) {
  return std::max({1.0, std::abs(shaft.speed), std::abs(block.speed)});
}

}  // namespace

Placement::Placement(PumpSystem& pump)
    : pump_(pump),
      system_(pump.system()),
      matter_(pump.matter()),
      bodies_(pump.bodies()),
      assembly_(pump.assembly()),
      dynamics_(pump.dynamics()),
      solver_(system_, matter_, bodies_.shaft, bodies_.block, pump.pistons(),
              pump.pump().geometry.piston_length,
              pump.pistons_free_to_spin() ? pump.pump().piston.real->spin : 0, dynamics_) {}

void Placement::guess_pistons() {
  // Parallel to the block axis: Newton's method then climbs to the positive root of (12).
  const Rotation shaft_to_block =
      ~Rotation(pump_.shaft_turning().theta, SimTK::ZAxis) * bodies_.block_frame;
  for (const auto& piston : bodies_.pistons) piston.setQToFitRotation(assembly_, shaft_to_block);
}

void Placement::set_turning(const AxisMotion& shaft, const AxisMotion& block, double time) {
  const auto set = [time](Turning& turning, const AxisMotion& motion) {
    turning = {motion.angle, time, motion.speed, motion.acceleration};
  };
  set(pump_.shaft_turning(), shaft);
  set(pump_.block_turning(), block);
}

void Placement::assemble(const AxisMotion& shaft, const AxisMotion& block) {
  // Time only tells Simbody that the prescribed angles have changed.
  assembly_.setTime(assembly_.getTime() + 1);
  set_turning(shaft, block, assembly_.getTime());
  const bool nearby = assembled_ && std::abs(shaft.angle - assembled_->shaft) < kNearby &&
                      std::abs(block.angle - assembled_->block) < kNearby;
  assembled_.reset();

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
      if (after <= kPositionRoundOff || !(after < before / 2)) break;
      before = after;
    }
    const Vec3 z2(bodies_.block_frame.z());
    for (const auto& piston : bodies_.pistons)
      done = done && SimTK::dot(z2, Vec3(piston.getBodyRotation(assembly_).z())) > 0;
  }
  if (!done) throw no_assembly(shaft, block);

  system_.prescribeU(assembly_);
  system_.realize(assembly_, SimTK::Stage::Velocity);
  options.setRequiredAccuracy(kAssemblyTolerance * speed_scale(shaft, block));
  results = SimTK::ProjectResults();
  system_.projectU(assembly_, no_estimate, options, results);
  system_.realize(assembly_, SimTK::Stage::Velocity);
  if (pump_.pistons_free_to_spin()) set_piston_spins();
  assembled_ = Angles{shaft.angle, block.angle};
}

// The inline joint leaves a piston's spin free; projection would leave some value of its own. The
// absolute angular velocity is e x e' plus the spin about e.
void Placement::set_piston_spins() {
  const Vec3 ring(0, 0, pump_.pump().geometry.piston_length);
  std::vector<Vec3> rates;
  for (const auto& piston : bodies_.pistons) {
    const Vec3 axis(piston.getBodyRotation(assembly_).z());
    const Vec3 tip = piston.findStationVelocityInGround(assembly_, ring) -
                     piston.getBodyOriginVelocity(assembly_);
    rates.push_back(axis % tip / pump_.pump().geometry.piston_length +
                    pump_.pump().piston.real->spin * axis);
  }
  const Vec3 shaft_rate = bodies_.shaft.getBodyAngularVelocity(assembly_);
  const Rotation shaft = bodies_.shaft.getBodyRotation(assembly_);
  for (std::size_t k = 0; k < rates.size(); ++k)
    bodies_.pistons[k].setUToFitAngularVelocity(assembly_, ~shaft * (rates[k] - shaft_rate));
  system_.realize(assembly_, SimTK::Stage::Velocity);
}

void Placement::copy_assembly_to_dynamics() {
  dynamics_.setTime(assembly_.getTime());
  dynamics_.updQ() = assembly_.getQ();
  dynamics_.updU() = assembly_.getU();
}

bool Placement::solve_placement() {
  Vector& q = dynamics_.updQ();
  const int shaft = bodies_.shaft.getFirstQIndex(dynamics_);
  q[shaft] = std::cos(placed_shaft_.angle / 2);
  q[shaft + 1] = q[shaft + 2] = 0;
  q[shaft + 3] = std::sin(placed_shaft_.angle / 2);
  q[bodies_.block.getFirstQIndex(dynamics_)] = placed_block_.angle;
  if (!(solver_.solve_positions(dynamics_) <= kAssemblyTolerance)) return false;
  const Vec3 z2(bodies_.block_frame.z());
  for (const auto& piston : bodies_.pistons)
    if (!(SimTK::dot(z2, Vec3(piston.getBodyRotation(dynamics_).z())) > 0)) return false;
  return true;
}

// A's distance from its bore's axis fixes the piston's direction across that axis, its length the
// rest; of the two roots the one along z2. A guess: Simbody's own equations judge it, and where
// they do not hold to round-off its placement goes on from there.
bool Placement::guess_placement() {
  const Rotation shaft(placed_shaft_.angle, SimTK::ZAxis);
  const Rotation block = bodies_.block_frame * Rotation(placed_block_.angle, SimTK::ZAxis);
  const Rotation to_block(~block * shaft);
  const Vec3 origin = ~block * bodies_.block_origin;
  const Pistons& pistons = pump_.pistons();
  Vector& q = dynamics_.updQ();
  for (std::size_t k = 0; k < bodies_.pistons.size(); ++k) {
    const Vec3 across = (pistons.bore_points[k] + origin - to_block * pistons.joint_points[k]) /
                        pump_.pump().geometry.piston_length;
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

void Placement::place(const AxisMotion& shaft, const AxisMotion& block, double rotor_speed) {
  placed_shaft_ = shaft;
  placed_block_ = block;
  if (!(guess_placement() && solve_placement())) {
    assemble(shaft, block);
    copy_assembly_to_dynamics();
    if (!solve_placement()) throw no_assembly(shaft, block);
  }
  // What is prescribed in this state (both bodies, or an imposed block) moves with the rest.
  set_turning(shaft, block, dynamics_.getTime());
  Vector& u = dynamics_.updU();
  u = 0;
  u[bodies_.shaft.getFirstUIndex(dynamics_) + 2] = shaft.speed;
  u[bodies_.block.getFirstUIndex(dynamics_)] = block.speed;
  if (pump_.drive_torque() != nullptr)
    pump_.drive_torque()->set_rotor_speed(dynamics_, rotor_speed);
  const double rate_error = solver_.solve_speeds(dynamics_);
  if (!(rate_error <= kAssemblyTolerance * speed_scale(shaft, block)))
    throw ComputationError(
        "multibody model: no velocities found that satisfy the constraints of the pistons" +
        where(shaft.angle, block.angle));
}

void Placement::constrained_accelerations(Vector& udot) {
  udot.resize(dynamics_.getNU());
  udot = 0;
  udot[bodies_.shaft.getFirstUIndex(dynamics_) + 2] = placed_shaft_.acceleration;
  udot[bodies_.block.getFirstUIndex(dynamics_)] = placed_block_.acceleration;
  solver_.solve_accelerations(dynamics_, udot);
}

}  // namespace bentaxis::multibody
