// Many inline joints as one constraint.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

namespace bentaxis::multibody {

/// Inline joints of many followers on parallel lines of one base, with the equations of Simbody's
/// PointOnLine: 2k and 2k + 1 are the distances of follower k's point from its line along the axes
/// line.perp() and line x line.perp(), both fixed in the base.
///
/// One constraint, because Simbody asks every constraint for every column of its matrices: what it
/// does for an acceleration grows as equations x constraints.
class InlineJoints : public SimTK::Constraint::Custom {
 public:
  /// @param points          one of each line, in the base's frame
  /// @param followers       as many
  /// @param follower_point  of every follower, in its frame
  InlineJoints(SimTK::MobilizedBody& base, const SimTK::UnitVec3& line,
               const std::vector<SimTK::Vec3>& points,
               const std::vector<SimTK::MobilizedBody>& followers,
               const SimTK::Vec3& follower_point);

  /// Errors of the second derivatives of the equations, m/s2, as the constraint itself finds them
  /// where its bodies hang on ground: of these equations alone, while Simbody's own call asks every
  /// constraint.
  /// @param state          realized to Velocity
  /// @param accelerations  of all bodies in Ground, by MobilizedBodyIndex
  /// @param errors         as many as there are equations, in their order
  void acceleration_errors(const SimTK::State& state,
                           const SimTK::Vector_<SimTK::SpatialVec>& accelerations,
                           std::vector<double>& errors) const;
};

}  // namespace bentaxis::multibody
