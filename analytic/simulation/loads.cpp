#include "simulation/loads.h"

#include <cmath>

#include "closed_form/friction.h"
#include "closed_form/piston.h"
#include "turning.h"

namespace bentaxis::analytic::simulation {

double Loads::power(const Instant& instant, double drive_torque) const {
  const closed_form::Pump<double>& p = pump_.numbers;
  double power = -(1 - torque_factor_) * drive_torque * instant.shaft.speed -
                 p.shaft.viscous * instant.shaft.speed * instant.shaft.speed -
                 p.block.viscous * instant.block.speed * instant.block.speed;
  with_state<double>(instant, [&](const auto& state) {
    for (std::size_t k = 0; k < pump_.phase_sin.size(); ++k) {
      const double sine = pump_.phase_sin[k], cosine = pump_.phase_cos[k];
      const auto m = closed_form::piston_motion(p.frame, p.piston, state,
                                                state.sine * cosine - state.cosine * sine,
                                                state.cosine * cosine + state.sine * sine);
      const double ring = m.ring_velocity(state.rate());
      const double axial =
          closed_form::friction_force(pump_.friction, p.friction, ring, state.omega) -
          p.piston.area * instant.chamber_pressure[k];
      const auto falling = [&](const auto& joint, const auto& axis, double gravity) {
        return gravity * state.rate() * (p.piston.mass * joint + p.piston.static_moment * axis);
      };
      power += axial * ring + falling(m.joint_first.y, m.axis_first.y, p.piston.gravity_y) +
               falling(m.joint_first.z, m.axis_first.z, p.piston.gravity_z);
    }
  });
  return power;
}

}  // namespace bentaxis::analytic::simulation
