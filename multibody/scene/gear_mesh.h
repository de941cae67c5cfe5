// The bevel gear as a constraint: the tooth force acts along the fixed line of the flank that
// carries.
#pragma once

#include <SimTKsimbody.h>

#include <memory>

#include "bentaxis/pump/parameters.h"

namespace bentaxis::multibody {

/// Lines of action in Ground, unit vectors. Along either a positive force turns the block the same
/// way.
struct ToothLines {
  SimTK::Vec3 positive;  ///< k4 of the flank whose force is positive
  SimTK::Vec3 negative;  ///< of the other flank; the same where one line serves either sign
};

/// What of a gear is not in a state. Whoever changes it invalidates the state's accelerations.
struct GearSetting {
  bool negative = false;  ///< the flank whose force is negative carries
  /// rad/s2, of the block less the shaft's: 0 where the teeth are in mesh.
  double relative_acceleration = 0;
};

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
  /// @param block_frame  orientation in Ground of the frame in which the block turns about z
  GearMesh(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
           SimTK::MobilizedBody& block, const SimTK::Vec3& point, const ToothLines& lines,
           const SimTK::Rotation& block_frame);

  /// Force on the block along line(), N. State realized to Acceleration.
  double tooth_force(const SimTK::State& state) const;

  const SimTK::Vec3& point() const { return point_; }
  /// Of the flank that carries a force of this sign; where the flanks share one line, that.
  const SimTK::Vec3& line_for(double force) const {
    return force < 0 ? lines_.negative : lines_.positive;
  }
  /// Of the flank that carries now.
  const SimTK::Vec3& line() const { return setting_->negative ? lines_.negative : lines_.positive; }
  /// Moment arm of either line about the block's axis, m: negative where a positive force turns the
  /// block towards -psi.
  double arm() const { return arm_; }
  bool has_two_flanks() const { return lines_.positive != lines_.negative; }

  GearSetting& setting() const { return *setting_; }

 private:
  GearMesh(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
           SimTK::MobilizedBody& block, const SimTK::Vec3& point, const ToothLines& lines,
           const SimTK::Rotation& block_frame, const std::shared_ptr<GearSetting>& setting);

  SimTK::Vec3 point_;
  ToothLines lines_;
  double arm_;
  std::shared_ptr<GearSetting> setting_;
};

/// Point and lines of action of a pump's gear (19)-(22): the pitch cones of two wheels with equal
/// tooth counts touch at O4, and the lines turn with the direction of rotation.
SimTK::Vec3 mesh_point_of(const PumpParameters& pump);
ToothLines tooth_lines_of(const PumpParameters& pump, double omega);

/// The gear of a pump between its shaft and block.
/// @param frame  in which the block turns about z
/// @param omega  its sign counts; 0 is positive
std::unique_ptr<GearMesh> gear_of(const PumpParameters& pump, SimTK::SimbodyMatterSubsystem& matter,
                                  SimTK::MobilizedBody& shaft, SimTK::MobilizedBody& block,
                                  const SimTK::Rotation& frame, double omega);

/// Angle of a body about its fixed axis of rotation, in (-pi, pi]: `frame` has that axis as z.
double turn_angle(const SimTK::Rotation& body_in_ground, const SimTK::Rotation& frame);

}  // namespace bentaxis::multibody
