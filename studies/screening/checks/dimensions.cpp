// Main dimensions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bentaxis/pump/counted.h"
#include "checks/check.h"

namespace bentaxis::study::checks {

std::vector<Check> dimensions() {
  return {
      {"pump-size", "Ra below {0:g} or above {1:g} mm: no bent-axis pump is of this size", "pump",
       "joint_circle_radius_mm"},
      {"tilt-in-radians", "0 < tilt < 1 deg. 0 is an idealisation and accepted",
       [](const Facts& f) { return f.g.tilt != 0 && deg(f.g.tilt) < 1; },
       [](const Facts& f) {
         const double tilt = deg(f.g.tilt);
         return fmt::format("tilt_deg = {:.6g} is below 1 deg: in radians it would be {:.4g} deg",
                            tilt, deg(tilt));
       }},
      {"tilt-beyond-45", "tilt above 46 deg: bent-axis pumps have at most 45",
       [](const Facts& f) {
         return outside("tilt_deg", deg(f.g.tilt), 0, 46, "deg",
                        fmt::format("bent-axis pumps have at most 45 deg; measured from the other "
                                    "axis it would be {:.4g}",
                                    90 - deg(f.g.tilt)));
       }},
      {"radii-exchanged",
       "Rd > Ra, and exchanged the pistons would tilt less: the projection of the joint circle is "
       "an "
       "ellipse with half axes Ra and Ra cos(tilt), and the bores should lie between the two",
       [](const Facts& f) { return f.g.bore_circle_radius > f.g.joint_circle_radius; },
       [](const Facts& f) -> std::string {
         const Geometry& g = f.g;
         Geometry exchanged = g;
         std::swap(exchanged.bore_circle_radius, exchanged.joint_circle_radius);
         const double then = assembly_margin(exchanged).longest_distance;
         const double now = assembly_margin(g).longest_distance;
         if (then >= now) return "";
         return fmt::format(
             "bore_circle_radius_mm = {:.6g} exceeds joint_circle_radius_mm = {:.6g}: the bores "
             "should lie between {:.4g} (Ra cos tilt) and Ra; exchanged, no joint would be farther "
             "than {:.3g} mm from its bore's axis instead of {:.3g}",
             mm(g.bore_circle_radius), mm(g.joint_circle_radius),
             mm(g.joint_circle_radius) * std::cos(g.tilt), mm(then), mm(now));
       }},
      {"bores-overlap",
       "bore >= distance of neighbouring bore axes 2 Rd sin(180 deg/N), or >= 2 Rd",
       [](const Facts& f) { return f.g.bore_diameter >= f.bore_room; },
       [](const Facts& f) {
         return fmt::format(
             "bore_diameter_mm = {:.6g} is not below {:.4g}, {}: the bores overlap{}",
             mm(f.g.bore_diameter), mm(f.bore_room),
             f.g.pistons > 2 ? fmt::format("the distance of {} neighbours on Rd", f.g.pistons)
                             : "twice Rd",
             guess(mm(f.g.bore_diameter), mm(f.bore_room) / 2, mm(f.bore_room) * 0.97,
                   {kDiameter, kTenth, kMicrometres}));
       }},
      {"bores-touch",
       "the stress in the wall between neighbouring bores would exceed 1000 MPa: highest pressure "
       "x "
       "bore / wall, or is thinner than 2 % of the bore",
       [](const Facts& f) { return f.g.pistons >= 3 && f.g.bore_diameter < f.spacing; },
       [](const Facts& f) -> std::string {
         const double wall = f.spacing - f.g.bore_diameter;
         const double stress = f.highest * f.g.bore_diameter / wall;
         if (stress <= kYield && wall >= 0.02 * f.g.bore_diameter) return "";
         return fmt::format(
             "bore_diameter_mm = {:.6g} leaves a wall of {:.3g} mm to the next bore: {:.4g} MPa at "
             "{:.4g} bar, steel yields at {:.4g}",
             mm(f.g.bore_diameter), mm(wall), stress / 1e6, bar(f.highest), kYield / 1e6);
       }},
      {"bore-small",
       "bore below half of the distance of neighbours (less than 3 pistons: 0.3 Rd): a radius, or "
       "metres",
       [](const Facts& f) {
         return mm(f.g.bore_diameter) < mm(least_filling(f.g.pistons) * f.bore_room);
       },
       [](const Facts& f) {
         return outside("bore_diameter_mm", mm(f.g.bore_diameter),
                        mm(least_filling(f.g.pistons) * f.bore_room), mm(f.bore_room), "mm",
                        fmt::format("the block would be solid between {} on Rd = {:.4g}",
                                    counted(f.g.pistons, "bore"), mm(f.g.bore_circle_radius)),
                        {kRadius, kCentimetres, kInches, kMetres});
       }},
      {"axis-offset", "b outside +-Ra/2",
       [](const Facts& f) {
         const double most = mm(f.g.joint_circle_radius) / 2;
         return outside(f, "pump", "axis_offset_mm", -most, most,
                        "the axes meet far from the plane of the joints", {kMicrometres, kTenth});
       }},
      {"piston-tilt",
       "largest tilt of a piston in its bore above atan(Dpi / 4 stroke), at most 15 deg: a shank "
       "of "
       "half the bore meets the bore's edge",
       [](const Facts& f) -> std::string {
         const double most = std::min(std::atan2(f.bore / 4, f.derived.stroke), 15 * kRadPerDegree);
         if (f.derived.largest_tilt <= most) return "";
         return fmt::format(
             "the pistons tilt up to {:.3g} deg in their bores: over a stroke of {:.4g} mm a shank "
             "of half the bore's diameter allows {:.3g} (joint_circle_radius_mm = {:.6g}, "
             "bore_circle_radius_mm = {:.6g} where Ra (1 + cos tilt)/2 = {:.4g} minimises the "
             "tilt, "
             "axis_offset_mm = {:.6g}, piston_length_mm = {:.6g})",
             deg(f.derived.largest_tilt), mm(f.derived.stroke), deg(most),
             mm(f.g.joint_circle_radius), mm(f.g.bore_circle_radius),
             mm(f.g.joint_circle_radius) * (1 + std::cos(f.g.tilt)) / 2, mm(f.g.axis_offset),
             mm(f.g.piston_length));
       }},
      {"piston-length",
       "b1 below the stroke (the shaft would meet the block) or half the bore, or above 4 Ra",
       [](const Facts& f) {
         return outside(
             f, "pump", "piston_length_mm", mm(std::max(f.derived.stroke, f.bore / 2)),
             mm(4 * f.g.joint_circle_radius),
             fmt::format("a piston is longer than its stroke of {:.4g} mm or half its bore, and "
                         "shorter than 4 Ra",
                         mm(f.derived.stroke)),
             {kTenth, kCentimetres, kInches, kMicrometres, kMetres});
       }},
  };
}

}  // namespace bentaxis::study::checks
