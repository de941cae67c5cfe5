// A tooth of either gear as pictures draw it, on the sphere about O2: without errors, relief and
// crowning, which are micrometres.
#pragma once

#include <cmath>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {

/// Angles are seen from O2, rad: polar ones from the axis of the gear's cone.
class BevelTooth {
 public:
  /// @param pump  whose gear has teeth
  explicit BevelTooth(const PumpParameters& pump)
      : teeth_(*pump.gear.teeth),
        pitch_(2 * kPi / teeth_.count),
        pitch_cone_(kPi / 2 - pump.geometry.tilt / 2),
        base_cone_(std::asin(std::sin(pitch_cone_) * std::cos(pump.gear.pressure_angle))),
        distance_(pump.gear.pitch_diameter / 2 / std::sin(pitch_cone_)) {}

  int count() const { return teeth_.count; }
  double pitch() const { return pitch_; }
  double pitch_cone() const { return pitch_cone_; }
  double tip() const { return pitch_cone_ + std::atan(teeth_.addendum / distance_); }
  double root() const { return pitch_cone_ - std::atan(teeth_.dedendum / distance_); }
  /// m from O2: of O4, and of the ends of the face width.
  double distance() const { return distance_; }
  double inside() const { return distance_ - teeth_.face_width / 2; }
  double outside() const { return distance_ + teeth_.face_width / 2; }

  /// Of the tooth at a polar angle, on either side of its middle.
  double half_angle(double polar) const {
    const double play =
        teeth_.backlash / (4 * distance_ * std::sin(base_cone_));  // its part of the backlash
    return pitch_ / 4 - play + involute(pitch_cone_) - involute(polar);
  }

 private:
  // How far a spherical involute has turned from where it leaves its base cone.
  double involute(double polar) const {
    if (polar <= base_cone_) return 0;
    const double arc = std::acos(std::cos(polar) / std::cos(base_cone_));
    return arc / std::sin(base_cone_) - std::atan2(std::tan(arc), std::sin(base_cone_));
  }

  const ToothData& teeth_;
  double pitch_, pitch_cone_, base_cone_, distance_;
};

}  // namespace bentaxis::study
