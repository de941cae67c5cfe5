#include "simulation/loads.h"

#include <cmath>

#include "closed_form/friction.h"
#include "closed_form/piston.h"
#include "turning.h"

namespace bentaxis::analytic::simulation {

namespace {

// use(piston's motion, its place in the pump, rate of the path's parameter, speed of the shaft)
template <class Use>
void for_each_piston(const PreparedPump& pump, const Instant& instant, const Use& use) {
  const closed_form::Pump<double>& p = pump.numbers;
  with_state<double>(pump.transfer, p, instant, [&](const auto& state) {
    for (std::size_t k = 0; k < pump.phase_sin.size(); ++k) {
      const double sine = pump.phase_sin[k], cosine = pump.phase_cos[k];
      use(closed_form::piston_motion(p.frame, p.piston, state,
                                     state.sine * cosine - state.cosine * sine,
                                     state.cosine * cosine + state.sine * sine),
          k, state.rate(), state.omega);
    }
  });
}

}  // namespace

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
  double power = 0;
  for_each_piston(pump_, instant, [&](const auto& m, std::size_t k, double rate, double) {
    power -= pump_.numbers.piston.area * instant.chamber_pressure[k] * m.ring_velocity(rate);
  });
  return power;
}

}  // namespace bentaxis::analytic::simulation
