// Joints by which the shaft turns the block: what they let the block do, and what they carry.
#pragma once

#include <SimTKsimbody.h>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/instant.h"

namespace bentaxis::multibody {

/// A constant-velocity joint, or one or two universal joints, between shaft and block, as one
/// equation between the two bodies. What it carries is what Simbody finds with the equation.
///
/// - Constant velocity: the bodies are each other's mirror image in the plane that bisects their
///   axes. Their axes across then keep xs.yb = ys.xb, whatever way the bodies lie. No direction of
///   a couple is given: it is the gradient of this equation by the rotation of either body.
/// - Universal: the cross holds the arm of the shaft's fork at a right angle to that of the block's
///   fork. This is Simbody's own constraint of a constant angle. The cross has no mass, and no body
///   stands for it: tests/simbody_conventions_test.cpp holds the equation to a universal mobilizer.
/// - Double universal: the shaft between the crosses holds in each cross an arm across its own axis
///   and across the arm of the other fork. Its two forks are parallel, so that the arms of shaft
///   and block lie in one plane with the line of the crosses' centres. That is the equation; its
///   gradient by places and rotations of the bodies is force and couple. The shaft between them has
///   no mass, which no body of Simbody may lack: tests/simbody_conventions_test.cpp holds the
///   equation to two universal mobilizers with a slider between them.
class BlockJoint {
 public:
  /// @param pump  with a joint as its transfer
  BlockJoint(const PumpParameters& pump, SimTK::MobilizedBody& shaft, SimTK::MobilizedBody& block);

  void disable(SimTK::State& state) const { constraint_.disable(state); }
  /// Couple about O2, Nm, and force at O2, N, that the joint exerts on the block, in Ground; their
  /// opposites act on the shaft.
  /// @param state  realized to Acceleration
  SimTK::SpatialVec on_block(const SimTK::State& state) const;
  /// The same for a multiplier of 1: the directions that the equation gives them, and their sizes.
  /// @param state  realized to Velocity
  SimTK::SpatialVec unit_on_block(const SimTK::State& state) const;
  SimTK::SpatialVec unit_on_shaft(const SimTK::State& state) const;

 private:
  SimTK::SpatialVec unit_on(const SimTK::State& state, const SimTK::MobilizedBody& body) const;
  SimTK::SpatialVec about_centre(const SimTK::State& state, const SimTK::MobilizedBody& body,
                                 SimTK::SpatialVec force) const;

  SimTK::MobilizedBody shaft_, block_;
  SimTK::Vec3 centre_;  // O2 in Ground
  SimTK::Constraint constraint_;
};

/// How a joint moves the block: shaft and block alone on pins, and Simbody's equation of the joint
/// with its derivatives.
class JointMotion {
 public:
  /// @param pump  with a joint as its transfer
  explicit JointMotion(const PumpParameters& pump);
  JointMotion(const JointMotion&) = delete;
  JointMotion& operator=(const JointMotion&) = delete;

  /// Motion of the block beside a motion of the shaft; its angle is within 90 deg of the shaft's.
  AxisMotion block(const AxisMotion& shaft);

 private:
  double error_at(double shaft_angle, double block_angle);

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::MobilizedBody::Pin shaft_, block_;
  SimTK::State state_;
};

}  // namespace bentaxis::multibody
