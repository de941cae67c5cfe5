// How large a pump is drawn: its own dimensions, and sizes of what the case does not give in
// proportion to them. Of the picture and of the pump in space alike.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {

struct PumpOutline {
  explicit PumpOutline(const PumpParameters& pump)
      : geometry(pump.geometry),
        sine(std::sin(pump.geometry.tilt)),
        cosine(std::cos(pump.geometry.tilt)),
        size(std::max({geometry.joint_circle_radius, geometry.bore_circle_radius,
                       std::min(geometry.piston_length, 4 * geometry.joint_circle_radius),
                       std::min(geometry.bore_diameter, 4 * geometry.bore_circle_radius)})),
        bore(std::min(geometry.bore_diameter, 2 * size)),
        ball(0.28 * bore),
        flange_radius(geometry.joint_circle_radius + 1.25 * ball),
        flange(0.22 * size),
        shaft_radius(0.42 * geometry.joint_circle_radius),
        shaft_end(-std::min(std::max({-pump.bearings.tapered_z, -pump.bearings.cylindrical_z,
                                      0.6 * size}),
                            kFar * size) -
                  0.3 * size),
        near(piston_end(0)),
        far(piston_end(kPi)),
        block_from(std::min(near, far) - 0.5 * bore),
        bore_bottom(std::max(near, far) + 0.3 * bore),
        block_to(std::max(near, far) + 0.55 * bore),
        block_radius(geometry.bore_circle_radius + 0.72 * bore),
        plate(0.22 * bore),
        has_gear(pump.transfer.kind == TransferKind::gear),
        gear_radius(has_gear ? pump.gear.pitch_diameter / 2 : 0),
        gear_z(geometry.axis_offset - gear_radius * std::tan(geometry.tilt / 2)),
        bearing_half(0.13 * size),
        bearing_height(0.34 * size) {}

  static constexpr double kFar = 3.2;        ///< of the pump's size: what lies beyond is named only
  static constexpr double kGearFace = 0.72;  ///< of the pitch cone: there its teeth begin

  /// Of the joint that carries the block, from O2.
  double transfer_radius() const { return 0.5 * geometry.joint_circle_radius; }
  bool is_far(double length) const { return std::abs(length) > kFar * size; }

  /// x2, y2 of the joint of a piston at chamber angle theta (9).
  std::array<double, 2> joint(double theta) const {
    return {-geometry.joint_circle_radius * std::sin(theta),
            geometry.joint_circle_radius * std::cos(theta) * cosine + geometry.axis_offset * sine};
  }
  /// z2 of B of a piston at chamber angle theta (11), m; of the joint where it does not reach.
  double piston_end(double theta) const {
    const auto [x, y] = joint(theta);
    const double z =
        geometry.joint_circle_radius * std::cos(theta) * sine - geometry.axis_offset * cosine;
    const double dx = -geometry.bore_circle_radius * std::sin(theta) - x;
    const double dy = geometry.bore_circle_radius * std::cos(theta) - y;
    return z + std::sqrt(std::max(
                   0.0, geometry.piston_length * geometry.piston_length - dx * dx - dy * dy));
  }

  const Geometry& geometry;
  double sine, cosine;  ///< of the tilt
  // All in m; z of the shaft in S1, of the block in S2.
  double size;  ///< what the pump is seen by; what is far larger is named only
  double bore, ball, flange_radius, flange, shaft_radius, shaft_end;
  double near, far;  ///< z of B at 0 and at 180 degrees
  double block_from, bore_bottom, block_to, block_radius, plate;
  bool has_gear;
  double gear_radius, gear_z;  ///< pitch circle, of the shaft's gear; 0 where there is none
  double bearing_half, bearing_height;
};

}  // namespace bentaxis::study
