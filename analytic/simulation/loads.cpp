#include "simulation/loads.h"

#include "closed_form/piston.h"
#include "turning.h"

namespace bentaxis::analytic::simulation {

double Loads::power(const Instant& instant, double drive_torque,
                    const PistonPowers& pistons) const {
  const closed_form::Pump<double>& p = pump_.numbers;
  double power = -(1 - torque_factor_) * drive_torque * instant.shaft.speed -
                 p.shaft.viscous * instant.shaft.speed * instant.shaft.speed -
                 p.block.viscous * instant.block.speed * instant.block.speed;
  for (std::size_t k = 0; k < pump_.phase_sin.size(); ++k) power += pistons[k];
  return power;
}

double Loads::pressure_power(const Instant& instant) const {
  const closed_form::Pump<double>& p = pump_.numbers;
  double power = 0;
  with_state<double>(pump_.transfer, p, instant, [&](const auto& state) {
    for (std::size_t k = 0; k < pump_.phase_sin.size(); ++k) {
      const double sine = pump_.phase_sin[k], cosine = pump_.phase_cos[k];
      const auto m = closed_form::piston_motion(p.frame, p.piston, state,
                                                state.sine * cosine - state.cosine * sine,
                                                state.cosine * cosine + state.sine * sine);
      power -= p.piston.area * instant.chamber_pressure[k] * m.ring_velocity(state.rate());
    }
  });
  return power;
}

}  // namespace bentaxis::analytic::simulation
