// Reads every channel from a Simbody state.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "bentaxis/multibody/pump_system.h"
#include "bentaxis/pump/channels.h"

namespace bentaxis::multibody {

/// Velocities that the power balance is taken with: one pump state's own, or a virtual one at
/// standstill.
struct WorkRate {
  const SimTK::State& state;  ///< realized to Velocity
  double omega;               ///< shaft speed in that state, not 0
};

/// Fills all channels (SI, ordered by `layout`) from a dynamics state realized to Acceleration.
/// @param pressure  chamber pressures in force, Pa
void read_channels(const PumpSystem& pump, const SimTK::State& state, const WorkRate& rate,
                   double omega_dot, const std::vector<double>& pressure,
                   const ChannelLayout& layout, std::vector<double>& values);

}  // namespace bentaxis::multibody
