// Reactions of a placed pump, by either method, and the channels that follow from them.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "bentaxis/results/channels.h"
#include "pump_system.h"

namespace bentaxis::multibody {

/// Forces found at an instant, all in Ground, on the first body named.
struct Reactions {
  struct OnPiston {
    SimTK::Vec3 joint;       ///< by the shaft, at A
    SimTK::Vec3 bore;        ///< by the block, at B
    double axis_moment = 0;  ///< about its own axis, that would have to be supplied: must vanish
    SimTK::SpatialVec acceleration;  ///< of the body at A: angular, linear
    SimTK::Transform place;          ///< of the body: A and its axes
  };
  std::vector<OnPiston> pistons;
  // Not found where shaft and block are prescribed:
  SimTK::SpatialVec block_hold;      ///< by film and pin together, about O2: moment, force
  SimTK::Vec3 tapered, cylindrical;  ///< on the shaft by its bearings
  double drive = 0;                  ///< torque about z1 on the shaft after proportional losses, Nm
  double tooth = 0;                  ///< tooth force on the block along the line of action, N
  double imposed = 0;  ///< torque about z2 that an imposed motion applies to the block
};

/// From a dynamics state realized to Acceleration: Simbody's multipliers and joint reactions.
void reactions_from_multipliers(const PumpSystem& pump, const SimTK::State& state,
                                Reactions& reactions);

/// By inverse dynamics at the last placement: the generalized forces that given accelerations leave
/// to be supplied, and the free bodies of pistons, block and shaft. No mass matrix is factored and
/// no multiplier solved for.
class ResidualSolver {
 public:
  explicit ResidualSolver(PumpSystem& pump) : pump_(pump) {}
  /// Realizes the dynamics state to Dynamics and finds accelerations too.
  void solve(Reactions& reactions);

 private:
  using Loads = SimTK::Vector_<SimTK::SpatialVec>;  // on the bodies
  void solve_block_and_shaft(Reactions& reactions, const Loads& loads);
  /// Force and moment about the body's origin that its motion needs beyond the applied loads.
  SimTK::SpatialVec needed(const SimTK::MobilizedBody& body, const Loads& loads) const;

  PumpSystem& pump_;
  SimTK::Vector udot_, residual_;
  SimTK::Vector_<SimTK::SpatialVec> accelerations_;
  std::vector<SimTK::Vec3> bore_;
};

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

/// Fills the channels of block and shaft and the power balance. Channels of the pistons first.
/// @param pressure  chamber pressures in force, Pa
void read_pump_channels(const PumpSystem& pump, const SimTK::State& state,
                        const Reactions& reactions, const WorkRate& rate, double omega_dot,
                        const std::vector<double>& pressure, const ChannelLayout& layout,
                        std::vector<double>& values);

/// All channels of a full pump from a dynamics state realized to Acceleration.
void read_channels(const PumpSystem& pump, const SimTK::State& state, const WorkRate& rate,
                   double omega_dot, const std::vector<double>& pressure,
                   const ChannelLayout& layout, std::vector<double>& values);

}  // namespace bentaxis::multibody
