// The continuous inputs of a pump, one by one: for sensitivities, rounding and perturbed copies.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/standard_registry.h"

namespace bentaxis {

/// One number of a pump's description, SI.
struct PumpInput {
  std::string name;   ///< path in PumpParameters: "geometry.tilt"
  double* value;      ///< in the pump it was listed from
  NumberRange range;  ///< in which validate() wants it
};

/// Every number of `pump` but the number of pistons, in the order of the case file; then data of
/// the real piston and of the port plate where present.
/// @param pump  must outlive the list
std::vector<PumpInput> continuous_inputs(PumpParameters& pump,
                                         const Registry& registry = standard_registry());

}  // namespace bentaxis
