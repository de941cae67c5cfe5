// The channels of a result table that follow from reactions.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "bentaxis/results/channels.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/motion.h"
#include "reactions/reactions.h"

namespace bentaxis::multibody {

/// Velocities that the power balance is taken with: one pump state's own, or a virtual one at
/// standstill.
struct WorkRate {
  const SimTK::State& state;  ///< realized to Velocity
  double omega;               ///< shaft speed in that state, not 0
};

/// Fills the channels of one piston (SI, ordered by `layout`).
/// @param index    of the piston in the pump system
/// @param channel  of the piston in the layout
void read_piston_channels(const PumpSystem& pump, const Reactions& reactions, std::size_t index,
                          int channel, double pressure, const ChannelLayout& layout,
                          std::vector<double>& values);

/// How shaft and block turn at an instant.
struct AxisMotions {
  AxisMotion shaft, block;
  bool locked() const { return shaft == block; }
};

/// Fills the channels of block and shaft and, where the block is locked to the shaft, the power
/// balance. Channels of the pistons first.
/// @param pressure  chamber pressures in force, Pa
void read_pump_channels(const PumpSystem& pump, const SimTK::State& state,
                        const Reactions& reactions, const WorkRate& rate, const AxisMotions& motion,
                        const std::vector<double>& pressure, const ChannelLayout& layout,
                        std::vector<double>& values);

/// All channels of a full pump from a dynamics state realized to Acceleration.
void read_channels(const PumpSystem& pump, const SimTK::State& state, const WorkRate& rate,
                   const AxisMotions& motion, const std::vector<double>& pressure,
                   const ChannelLayout& layout, std::vector<double>& values);

/// All channels of a pump that is simulated, and the checks.
/// @param state  dynamics state realized by realize_with_flank()
void read_motion_row(const PumpSystem& pump, const SimTK::State& state, const AxisMotions& motion,
                     const std::vector<double>& pressure, const ChannelLayout& layout,
                     std::vector<double>& values, MotionChecks& checks);

}  // namespace bentaxis::multibody
