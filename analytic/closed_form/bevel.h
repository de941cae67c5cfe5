// Straight bevel gears with spherical involutes on the unit sphere about O2: cones, the plane of
// action, and where a tip's edge meets the mate's flank. docs/teeth.md.
#pragma once

#include <array>

#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/parameters.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// A tip's edge that is past the end of the path of contact, against the mate's flank: the great
/// circle through it that is tangent to the mate's base circle is the flank's normal. It is the
/// path's own, turned about the mate's axis.
struct Corner {
  double gap = 0;  ///< rad, what the pair lacks against a flank without end
  double arc = 0;  ///< rad, from the edge to where its great circle touches the mate's base circle
  double turn_sine = 0, turn_cosine = 1;  ///< of the angle by which the great circle is turned
  double lever = 0;  ///< moment of a unit force on unit distance about the axis of the edge's gear
};

/// All of the shape that flanks +1 need; flanks -1 are their mirror image in x. Vectors of the
/// plane of action have the components (u, n, m) along u0 towards O4, n0 along the force on the
/// block at O4, and m0 = u0 x n0.
struct Bevel {
  BevelGeometry at;
  double pitch = 0;  ///< p = 2 pi / Z, rad, rounded, and what rounding took
  double pitch_rest = 0;
  double sin_base = 0, cos_base = 0;
  double roll = 0;          ///< rad, arc from O4 to where the path touches a base circle
  double tip_roll = 0;      ///< rad, arc of a tip from there
  Vec3<double> u0, n0, m0;  ///< in S1
  Vec3<double> block_axis;  ///< z2 in (u, n, m)

  /// Polar angle of a point of a flank from its own axis, rad, by its arc from the base circle.
  double cone(double arc) const;
  /// @param past  rad, > 0, angle of its own gear since the edge was at the end of the path
  Corner corner(double past) const;
  /// A vector in (u, n, m) turned about the block's axis.
  Vec3<double> turned(const Vec3<double>& v, const Corner& corner) const;
  Vec3<double> to_s1(const Vec3<double>& v) const { return v.x * u0 + v.y * n0 + v.z * m0; }

 private:
  friend Bevel bevel(const PumpParameters& pump);
  // Of the edge, c0 + c1 cos + c2 sin of the angle past: along z2, towards O4 across it, and across
  // both, turned back by the angle from O4 to where the path touches the base circle.
  using Harmonic = std::array<double, 3>;
  Harmonic along_, towards_, across_;
  Harmonic lever_;  // about the axis of the edge's gear, by the turn
};

Bevel bevel(const PumpParameters& pump);

/// @throws InputError where teeth of this shape cannot mesh
void require_mesh(const Gear& gear, const Bevel& bevel);

}  // namespace bentaxis::analytic::closed_form
