// Power of what acts on a pump from outside and of its friction. Internal.
#pragma once

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/instant.h"
#include "prepared.h"
#include "simulation/responses.h"

namespace bentaxis::analytic::simulation {

class Loads {
 public:
  Loads(const PumpParameters& pump, const Assumptions& assumptions)
      : pump_(prepare(pump, assumptions)), torque_factor_(pump.friction.shaft_torque_factor) {}

  /// Of pressure, ring friction and weight on the pistons, of Cc, Cs and the torque's share of
  /// (38): all but what the drive feeds in, W. The rest of the weight does no work.
  double power(const Instant& instant, double drive_torque, const PistonPowers& pistons) const;
  /// Of the pressures on the pistons alone, W.
  double pressure_power(const Instant& instant) const;

 private:
  PreparedPump pump_;
  double torque_factor_;
};

}  // namespace bentaxis::analytic::simulation
