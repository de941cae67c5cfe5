// The bevel gear as a constraint: the tooth force acts along one fixed line.
#pragma once

#include <SimTKsimbody.h>

#include <memory>

#include "bentaxis/pump/parameters.h"

namespace bentaxis::multibody {

/// Keeps the block in phase with the shaft by equal and opposite forces along `line` at `point`.
///
/// One holonomic equation. Its error is the arc between the two pitch circles, so the integrator's
/// projection holds the phase; its rate is the sliding of the bodies past each other along the line
/// at the mesh point, line . (v_block - v_shaft), whose dual is the tooth force. The mesh point is
/// fixed in space: the constraint is not between material points (Simbody's NoSlip1D uses the
/// acceleration of material points and is wrong for a line with a part along the centripetal
/// acceleration, that is for any pressure angle).
class GearMesh : public SimTK::Constraint::Custom {
 public:
  /// @param point   mesh point O4 in Ground
  /// @param line    unit vector k4 in Ground: a positive tooth force pushes the block along it
  /// @param block_frame  orientation in Ground of the frame in which the block turns about z
  GearMesh(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
           SimTK::MobilizedBody& block, const SimTK::Vec3& point, const SimTK::UnitVec3& line,
           const SimTK::Rotation& block_frame);

  /// Force on the block along the line, N. State realized to Acceleration.
  double tooth_force(const SimTK::State& state) const;

  const SimTK::Vec3& point() const { return point_; }
  const SimTK::Vec3& line() const { return line_; }

 private:
  SimTK::Vec3 point_, line_;
};

/// The gear of a pump between its shaft and block (19)-(22): the pitch cones of two wheels with
/// equal tooth counts touch at O4, and the line of action turns with the direction of rotation.
/// @param frame  in which the block turns about z
/// @param omega  its sign counts; 0 is positive
std::unique_ptr<GearMesh> gear_of(const PumpParameters& pump, SimTK::SimbodyMatterSubsystem& matter,
                                  SimTK::MobilizedBody& shaft, SimTK::MobilizedBody& block,
                                  const SimTK::Rotation& frame, double omega);

/// Angle of a body about its fixed axis of rotation, in (-pi, pi]: `frame` has that axis as z.
double turn_angle(const SimTK::Rotation& body_in_ground, const SimTK::Rotation& frame);

}  // namespace bentaxis::multibody
