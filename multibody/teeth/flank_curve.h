// Shapes of straight bevel teeth, as curves on the unit sphere about O2.
#pragma once

#include <SimTKsimbody.h>

#include <memory>

#include "bentaxis/pump/parameters.h"

namespace bentaxis::multibody {

/// A point of a flank's curve.
struct FlankPoint {
  SimTK::Vec3 point;         ///< unit vector from O2
  SimTK::Vec3 tangent;       ///< unit vector, towards the tip
  SimTK::Vec3 tangent_rate;  ///< its derivative by the roll: the curve's curvature
  double rate = 0;           ///< d point / d roll = rate * tangent; 0 where a curve ends in a cusp

  /// Out of the tooth: the way its force on the mate points. Its great circle has the tangent as
  /// pole, or the tangent reversed.
  SimTK::Vec3 outward() const { return tangent % point; }
  double polar_angle() const { return std::atan2(std::hypot(point[0], point[1]), point[2]); }
};

/// One flank of a gear's tooth, in the gear's frame: z along the cone axis away from O2, x towards
/// the flank's point on the pitch cone. The flank looks towards -y, the tooth lies towards +y.
/// Flanks that look towards +y are mirrored.
///
/// The parameter is the roll: the angle, rad, that the gear has turned towards -y, of a shaft,
/// since the point on the pitch cone was in contact with a mate of the same kind, were both perfect
/// and without play.
class FlankCurve {
 public:
  virtual ~FlankCurve() = default;
  virtual FlankPoint at(double roll) const = 0;
  /// Roll at a polar angle between the curve's own beginning and pi/2.
  double roll_at(double polar_angle) const;
  /// Where the curve begins: a cusp, under which a flank of this kind has no points. < 0.
  virtual double first_roll() const = 0;
};

/// The curve that a point of a great circle draws that rolls on the base circle without slipping.
class SphericalInvolute : public FlankCurve {
 public:
  /// @param pitch_cone  delta, rad, in (0, pi/2)
  SphericalInvolute(double pitch_cone, double pressure_angle);
  FlankPoint at(double roll) const override;
  double first_roll() const override { return -pitch_roll_; }
  double base_cone() const;

 private:
  double sine_, cosine_;  // of the base cone
  double pitch_roll_ = 0, pitch_azimuth_ = 0;
};

/// What the plane flank of a crown gear envelops that rolls with the gear: on the flank's great
/// circle that point touches which is nearest to the pitch point.
class Octoid : public FlankCurve {
 public:
  Octoid(double pitch_cone, double pressure_angle);
  FlankPoint at(double roll) const override;
  double first_roll() const override { return first_roll_; }

 private:
  double sine_, cosine_;  // of the pitch cone
  double lean_sine_, lean_cosine_;
  double first_roll_ = 0;
};

std::unique_ptr<FlankCurve> flank_curve(FlankShape shape, double pitch_cone, double pressure_angle);

}  // namespace bentaxis::multibody
