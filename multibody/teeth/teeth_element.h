// Bevel teeth between shaft and block as a force element.
#pragma once

#include <SimTKsimbody.h>

#include "teeth/bevel_teeth.h"

namespace bentaxis::multibody {

/// How the teeth stand to each other. Changed by whoever runs the pump, who then invalidates the
/// state's forces: the difference of two bodies' angles that grow would lose the lag's digits.
struct TeethSetting {
  ToothLag lag;
  bool dissipation = true;  ///< false: forces as at rest
  bool apart = false;       ///< nothing acts
};

/// Finds at each evaluation where the flanks of shaft and block touch, and pushes them apart there:
/// a force on the block and its opposite on the shaft.
class TeethElement {
 public:
  /// @param forces  subsystem that owns the element
  /// @param origin  O2 in Ground
  /// All arguments outlive the system.
  TeethElement(SimTK::GeneralForceSubsystem& forces, const BevelTeeth& teeth,
               const SimTK::MobilizedBody& shaft, const SimTK::MobilizedBody& block,
               const SimTK::Vec3& origin, const TeethSetting& setting);

  /// What the teeth do. @param state  realized to Velocity
  TeethAction action(const SimTK::State& state) const;
  /// The lag at which they rest under a torque about z2 on the block, Nm.
  ToothLag rest(const SimTK::State& state, double torque_on_block) const;
  /// Of the shaft's teeth towards the block's, as BevelTeeth::closing().
  const BevelTeeth& teeth() const { return teeth_; }
  const SimTK::Force& force() const { return force_; }

 private:
  class Element;
  const BevelTeeth& teeth_;
  const SimTK::MobilizedBody& shaft_;
  const TeethSetting& setting_;
  SimTK::Force force_;
};

}  // namespace bentaxis::multibody
