// Simbody's sign and frame conventions for reactions, each wrapped once.
//
// Simbody 3.7 reports constraint forces and multipliers with the sign opposite to applied forces,
// and mobilizer reactions with the sign of applied forces. Here every value is what the second body
// exerts on the first, in Ground. tests/simbody_conventions_test.cpp pins each against a free-body
// diagram.
#pragma once

#include <SimTKsimbody.h>

namespace bentaxis::multibody {

/// Force (at the body's origin) and moment that a constraint exerts on one of its bodies.
/// @param state  realized to Acceleration
SimTK::SpatialVec constraint_force_on(const SimTK::State& state,
                                      const SimTK::Constraint& constraint,
                                      const SimTK::MobilizedBody& body);

/// The same for multipliers of 1: the directions in which a constraint of one equation acts.
/// @param state  realized to Velocity
SimTK::SpatialVec unit_constraint_force_on(const SimTK::State& state,
                                           const SimTK::Constraint& constraint,
                                           const SimTK::MobilizedBody& body);

/// Forces and moments of all mobilizers on their bodies at the outboard frame's origin M.
/// Index by MobilizedBodyIndex.
void joint_forces(const SimTK::State& state, const SimTK::SimbodyMatterSubsystem& matter,
                  SimTK::Vector_<SimTK::SpatialVec>& forces);

/// Generalized force that a one-equation speed or acceleration constraint applies to its mobility.
template <class OneMobilityConstraint>
double applied_generalized_force(const SimTK::State& state, const OneMobilityConstraint& drive) {
  return -drive.getMultiplier(state);
}

/// ADAMS' inline joint: keeps a point of the follower on a line of the base by two equations, the
/// distance along two axes across the line, both fixed in the base. Simbody's PointOnLine, or one
/// of InlineJoints, with its axes and signs made explicit.
class InlineJoint {
 public:
  InlineJoint() = default;
  InlineJoint(SimTK::MobilizedBody& base, const SimTK::UnitVec3& line, const SimTK::Vec3& point,
              SimTK::MobilizedBody& follower, const SimTK::Vec3& follower_point)
      : InlineJoint(SimTK::Constraint::PointOnLine(base, line, point, follower, follower_point), 0,
                    line) {}
  /// Of a constraint with more equations: two of them.
  /// @param first  of its position equations
  InlineJoint(const SimTK::Constraint& constraint, int first, const SimTK::UnitVec3& line)
      : constraint_(constraint),
        first_(first),
        x_(line.perp()),
        y_(line % SimTK::Vec3(line.perp())) {}

  const SimTK::Constraint& constraint() const { return constraint_; }

  /// The two axes, in the base's frame: equation i is the follower point's distance along axis i.
  const SimTK::Vec3& axis_x() const { return x_; }
  const SimTK::Vec3& axis_y() const { return y_; }

  /// First of its two rows among the position errors and multipliers of a state.
  /// @param state  realized to Instance
  int first_row(const SimTK::State& state) const;

  /// Force on the follower, in the base's frame, whose components along the two axes are these.
  SimTK::Vec3 force_in_base(double along_x, double along_y) const {
    return along_x * x_ + along_y * y_;
  }
  /// Force on the follower, in the base's frame. @param state  realized to Acceleration
  SimTK::Vec3 force_in_base(const SimTK::State& state) const;

 private:
  SimTK::Constraint constraint_;
  int first_ = 0;
  SimTK::Vec3 x_, y_;
};

}  // namespace bentaxis::multibody
