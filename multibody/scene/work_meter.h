// The work account of an integrated run.
#pragma once

#include <SimTKsimbody.h>

#include <functional>

namespace bentaxis::multibody {

/// Integrates the power of applied loads, and of drives, along with the motion: two more state
/// variables of the system.
class WorkMeter {
 public:
  /// @param matter  must outlive the system, like `forces`
  /// @param unit    J, of the two variables: an integrator holds their errors to its accuracy times
  /// that
  /// @param drives  power of all drives, W, in a state realized to Acceleration
  WorkMeter(const SimTK::MultibodySystem& system, const SimTK::SimbodyMatterSubsystem& matter,
            SimTK::GeneralForceSubsystem& forces, std::function<double(const SimTK::State&)> drives,
            double unit = 1);

  /// Work since time 0, J.
  double of_loads(const SimTK::State& state) const;
  double of_drives(const SimTK::State& state) const;
  /// Power of all applied loads, W. @param state  realized to Dynamics
  double power_of_loads(const SimTK::State& state) const;

 private:
  class Implementation;
  Implementation* implementation_;  // owned by its force element
};

}  // namespace bentaxis::multibody
