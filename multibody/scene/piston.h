// The pistons: what they weigh, how they hang on shaft and block, and the power of their inertia.
#pragma once

#include <SimTKsimbody.h>

#include <optional>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "conventions.h"
#include "scene/inline_joints.h"

namespace bentaxis::multibody {

/// A piston as a Simbody body: origin A, axis z towards B.
struct PistonBody {
  SimTK::MassProperties properties;
  /// Whether it can turn about its own axis: a body without inertia there must not.
  bool free_to_spin = false;

  /// About its joint A, kg m2. Where it is 0 there is no equation of motion.
  double inertia_about_joint() const { return properties.getInertia().getMoments()[0]; }
};

/// The piston of a pump as lumped masses, as a rigid body or as three point masses.
/// @throws InputError where the pump has no data for that
/// @throws ComputationError for inertia without mass
PistonBody piston_body(const PumpParameters& pump, PistonInertia inertia);

/// All pistons of a scene, each on a spherical joint at A to the shaft and with B kept on its
/// bore's axis by an inline joint to the block.
struct Pistons {
  std::vector<SimTK::MobilizedBody> bodies;
  std::vector<InlineJoint> bores;
  std::optional<InlineJoints> all_bores;  ///< the constraint that they are parts of
  std::vector<SimTK::Vec3> joint_points;  ///< A in the shaft's frame
  std::vector<SimTK::Vec3> bore_points;   ///< a point of the bore's axis in the block's frame
};
Pistons add_pistons(const Geometry& geometry, const PistonBody& piston, SimTK::MobilizedBody& shaft,
                    SimTK::MobilizedBody& block);

/// Power of a piston's inertia and weight along the velocities of `rate`, W: its point masses
/// (lumped, dynamically equivalent) or rigid body (real).
/// @param state         realized to Velocity
/// @param acceleration  of the body at A
/// @param rate          velocities of the body at A, its own or virtual ones
double piston_power(const PumpParameters& pump, PistonInertia inertia,
                    const SimTK::MobilizedBody& piston, const SimTK::State& state,
                    const SimTK::SpatialVec& acceleration, const SimTK::SpatialVec& rate);

}  // namespace bentaxis::multibody
