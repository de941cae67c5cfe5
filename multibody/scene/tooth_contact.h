// What compliant teeth do to each other: the contact law, and the force element it makes.
#pragma once

#include <SimTKsimbody.h>

#include "bentaxis/pump/parameters.h"
#include "scene/gear_mesh.h"

namespace bentaxis::multibody {

/// Force of one flank on the other, N: Hunt and Crossley's law. It begins at 0, grows with the
/// approach and never pulls.
/// @param approach  how far the flanks are pressed into each other along the line of action, m;
///                  below 0: the gap between them
/// @param rate      of the approach, m/s
double flank_force(const ToothCompliance& teeth, double approach, double rate);

/// Force of a tooth between two flanks, N, signed towards +psi: the shaft's tooth lies in a gap
/// that is wider than it is by the backlash.
/// @param advance  of the shaft's pitch circle before the block's along the line of action that
///                 pushes the block towards +psi, m, from the middle of the gap
/// @param rate     of the advance, m/s
double tooth_force(const ToothCompliance& teeth, double advance, double rate);

/// Which branch of the contact law holds. Within one the force is smooth; an integration lands
/// where it changes.
struct ToothBranch {
  int flank = 0;  ///< +1: the shaft pushes the block towards +psi, -1: towards -psi, 0: none
  bool released = false;  ///< so fast apart that the flank, still pressed in, follows no more
};

/// The branch that holds at a state. @param advance, rate  as of tooth_force()
ToothBranch tooth_branch_at(const ToothCompliance& teeth, double advance, double rate);

/// Energy that the spring of a flank holds, J; none where it does not touch.
double flank_energy(const ToothCompliance& teeth, double approach);

/// Compliant teeth between shaft and block, as a force element.
///
/// How far the shaft's teeth are ahead is a variable of its own, the integral of the bodies'
/// sliding past each other at the mesh point along the line of action: the difference of two angles
/// that grow would lose its digits.
class CompliantTeeth {
 public:
  /// @param gear    where and along which lines; outlives the system, like the other arguments
  /// @param branch  read at every evaluation
  CompliantTeeth(SimTK::GeneralForceSubsystem& forces, const ToothCompliance& teeth,
                 const GearMesh& gear, const SimTK::MobilizedBody& shaft,
                 const SimTK::MobilizedBody& block, const ToothBranch& branch);

  /// Of the shaft's teeth before the block's, m, from the middle of the gap; and its rate, m/s.
  /// @param state  realized to Velocity, of the rate
  double advance(const SimTK::State& state) const;
  void set_advance(SimTK::State& state, double advance) const;
  double rate(const SimTK::State& state) const;
  /// How far a flank is pressed in, m, and how fast.
  double approach(const SimTK::State& state, int flank) const;
  double approach_rate(const SimTK::State& state, int flank) const;
  /// Force of the branch that holds, N, signed towards +psi.
  double force(const SimTK::State& state) const;
  /// Energy that a spring of this law holds, J.
  double elastic_energy(const SimTK::State& state) const;
  /// Impulse of the teeth since time 0, whichever flank carries, Ns.
  double impulse(const SimTK::State& state) const;
  /// Scale of the approach, m: that at `kUnitForce`.
  double unit() const { return unit_; }

 private:
  class Element;
  ToothCompliance teeth_;
  double unit_;
  Element* element_;  // owned by its force subsystem
};

}  // namespace bentaxis::multibody
