// Applied loads of the pump as one Simbody force element, and what they depend on.
#pragma once

#include <SimTKsimbody.h>

#include <functional>
#include <optional>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"

namespace bentaxis::multibody {

/// Where an applied load comes from. Weight is Simbody's own element.
enum class LoadSource { pressure, piston_friction, block_friction, shaft_friction, spring, film };

/// What the loads depend on besides the state. Changed by whoever runs the pump, between
/// realizations; the pump's force element reads it.
struct LoadInputs {
  /// Chamber pressures (Pa gauge) at a shaft angle theta, rad in (-pi, pi], and a block angle psi,
  /// rad, which does not wrap.
  std::function<void(double theta, double psi, std::vector<double>& pressure)> chamber_pressure;
  PortPressures ports;
  /// They change from one evaluation to the next: the film is not integrated anew but put together
  /// from the loads of either port, in which it is linear.
  bool ports_change = false;
  /// Torque about z1 on the shaft at angle theta where the shaft runs free; empty where driven.
  std::function<double(double theta)> shaft_torque;
  double rest_speed =
      0;  ///< m/s, below which a piston counts as at rest in the sign law of friction
  /// Way each piston is taken to move, +1 or -1, where dry friction jumps with it; empty: as it
  /// moves.
  std::vector<double> held_direction;
  /// The one source that acts; empty: all of them.
  std::optional<LoadSource> only;
};

/// The bodies the loads act on; A and B of each piston at z = 0 and z = length of its frame.
struct PumpBodies {
  SimTK::MobilizedBody shaft;
  SimTK::MobilizedBody block;
  std::vector<SimTK::MobilizedBody> pistons;
  SimTK::Rotation block_frame;  ///< S2 in Ground
  SimTK::Vec3 block_origin;     ///< O2 in Ground
  SimTK::Vec3 shaft_origin;     ///< C1 in Ground
};

/// Which bodies are loaded: where shaft and block are prescribed, loads on them change nothing.
enum class LoadedBodies { all, pistons };

/// Adds pressure on pistons and block, friction, spring, port-plate film and viscous torques.
/// Weight is not among them (Simbody's own gravity element).
/// @param inputs  must outlive the system
class PumpLoads : public SimTK::Force::Custom {
 public:
  PumpLoads(SimTK::GeneralForceSubsystem& forces, const PumpParameters& pump,
            const Assumptions& assumptions, const PumpBodies& bodies, const LoadInputs& inputs,
            LoadedBodies loaded);
};

/// Axial force on a piston along z2 at B: pressure and friction, N.
struct AxialLoad {
  double pressure = 0;
  double friction = 0;
};
/// @param direction  0, or the way the piston is taken to move where dry friction jumps
AxialLoad axial_load(const PumpParameters& pump, const Assumptions& assumptions, double pressure,
                     double velocity, double rest_speed, double direction = 0);

/// Power of the chamber pressures on all that moves, W.
/// @param state  realized to Velocity
double pressure_power(const PumpParameters& pump, const PumpBodies& bodies,
                      const std::vector<double>& pressure, const SimTK::State& state);

}  // namespace bentaxis::multibody
