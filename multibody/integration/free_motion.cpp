#include "integration/free_motion.h"

namespace bentaxis::multibody {

using SimTK::State;
using SimTK::Vec3;
using SimTK::Vector;

FreeMotion::FreeMotion(PumpSystem& pump, Placement& placement)
    : pump_(pump),
      placement_(placement),
      shaft_u_(pump.bodies().shaft.getFirstUIndex(pump.dynamics()) + 2),
      block_u_(pump.bodies().block.getFirstUIndex(pump.dynamics())) {}

// Speeds of all mobilities as shaft and block turn so, and their momenta.
void FreeMotion::allow(double shaft, double block, Vector& speeds, Vector& momenta) const {
  const State& state = pump_.dynamics();
  speeds.resize(state.getNU());
  speeds = 0;
  speeds[shaft_u_] = shaft;
  speeds[block_u_] = block;
  placement_.piston_solver().allowed_speeds(
      state, shaft * Vec3(0, 0, 1), block * Vec3(pump_.bodies().block_frame.z()), 0, speeds);
  pump_.matter().multiplyByM(state, speeds, momenta);
}

FreeMotion::Accelerations FreeMotion::solve(bool shaft_is_free, double ratio) {
  const State& state = pump_.dynamics();
  const auto& system = pump_.system();
  system.realize(state, SimTK::Stage::Dynamics);
  placement_.constrained_accelerations(udot_);
  pump_.matter().calcResidualForceIgnoringConstraints(
      state, system.getMobilityForces(state, SimTK::Stage::Dynamics),
      system.getRigidBodyForces(state, SimTK::Stage::Dynamics), udot_, residual_);

  Accelerations found;
  found.shaft = udot_[shaft_u_];
  found.block = udot_[block_u_];
  const DriveTorque* drive = pump_.drive_torque();
  if (drive != nullptr && drive->has_rotor()) {
    // It turns on its own: nothing but forces ties it to the shaft.
    const double missing = -residual_[drive->rotor_u(state)];
    found.rotor = missing / drive->rotor_inertia();
  }
  if (pump_.has_rigid_gear() || pump_.joint() != nullptr) {
    allow(1, ratio, by_shaft_, shaft_momenta_);
    const double missing = -(~by_shaft_ * residual_);
    if (!shaft_is_free) {
      found.torque_on_shaft = -missing;
      return found;
    }
    const double more = missing / (~by_shaft_ * shaft_momenta_);
    found.shaft += more;
    found.block += ratio * more;
    return found;
  }
  allow(1, 0, by_shaft_, shaft_momenta_);
  allow(0, 1, by_block_, block_momenta_);
  const double on_shaft = -(~by_shaft_ * residual_);
  const double on_block = -(~by_block_ * residual_);
  const double mixed = ~by_shaft_ * block_momenta_;
  const double block = ~by_block_ * block_momenta_;
  if (!shaft_is_free) {
    const double more = on_block / block;
    found.block += more;
    found.torque_on_shaft = mixed * more - on_shaft;
    return found;
  }
  const double shaft = ~by_shaft_ * shaft_momenta_;
  const double determinant = shaft * block - mixed * mixed;
  found.shaft += (block * on_shaft - mixed * on_block) / determinant;
  found.block += (shaft * on_block - mixed * on_shaft) / determinant;
  return found;
}

}  // namespace bentaxis::multibody
