// Bearings of the shaft.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "checks/check.h"

namespace bentaxis::study::checks {

std::vector<Check> bearings() {
  return {
      {"bearing-side",
       "a bearing at z1 > -Ra/4: on the pistons' side, or in the plane of the joints",
       [](const Facts& f) {
         const auto one = [&](const char* key) {
           return outside(f, "bearings", key, -HUGE_VAL, -mm(f.g.joint_circle_radius) / 4,
                          "the shaft extends from the joints towards -z1, the pistons towards +z1",
                          {kSign, kMetres, kCentimetres});
         };
         return first_of({one("tapered_z_mm"), one("cylindrical_z_mm")});
       }},
      {"bearings-exchanged",
       "the tapered bearing is farther from the joints than the cylindrical one",
       [](const Facts& f) {
         const Bearings& b = f.pump.bearings;
         return b.tapered_z < b.cylindrical_z && b.cylindrical_z <= 0;
       },
       [](const Facts& f) {
         return fmt::format(
             "tapered_z_mm = {:.6g} is farther from the joints than cylindrical_z_mm = {:.6g}: the "
             "tapered bearing, which takes the thrust, sits next to the pistons",
             mm(f.pump.bearings.tapered_z), mm(f.pump.bearings.cylindrical_z));
       }},
      {"bearings-close", "bearings less than Ra/4 apart: two do not fit",
       [](const Facts& f) -> std::string {
         const double apart = std::abs(f.pump.bearings.tapered_z - f.pump.bearings.cylindrical_z);
         if (apart >= f.g.joint_circle_radius / 4) return "";
         return fmt::format(
             "tapered_z_mm and cylindrical_z_mm are {:.3g} mm apart, less than a quarter of Ra = "
             "{:.4g}: two bearings do not fit",
             mm(apart), mm(f.g.joint_circle_radius));
       }},
      {"ball-bearing",
       "balls of a ball bearing that overlap, or fill less than a quarter of their circle",
       [](const Facts& f) {
         const BearingRatings& b = f.the_case.ratings;
         return (b.tapered && b.tapered->balls) || (b.cylindrical && b.cylindrical->balls);
       },
       [](const Facts& f) {
         const auto one = [](const char* bearing, const auto& rating) -> std::string {
           if (!rating || !rating->balls) return "";
           const BallGeometry& balls = *rating->balls;
           const double filled =
               balls.balls * std::asin(std::min(1.0, balls.ball_diameter / balls.pitch_diameter)) /
               kPi;
           if (filled >= 0.25 && filled <= 1) return "";
           return fmt::format(
               "{0}_balls = {1}, {0}_ball_diameter_mm = {2:.4g}, {0}_ball_pitch_diameter_mm = "
               "{3:.4g}: "
               "the balls fill {4:.3g} % of their circle; 40 to 80 are usual, and above 100 they "
               "overlap",
               bearing, balls.balls, mm(balls.ball_diameter), mm(balls.pitch_diameter),
               100 * filled);
         };
         const BearingRatings& b = f.the_case.ratings;
         return first_of({one("tapered", b.tapered), one("cylindrical", b.cylindrical)});
       }},
      {"bearing-far", "the nearer bearing farther than 5 Ra or the other farther than 10 Ra",
       [](const Facts& f) {
         const Bearings& b = f.pump.bearings;
         const bool tapered_nearer = std::abs(b.tapered_z) < std::abs(b.cylindrical_z);
         const auto one = [&](const char* key, bool nearer) {
           return outside(
               f, "bearings", key, -(nearer ? 5 : 10) * mm(f.g.joint_circle_radius), HUGE_VAL,
               nearer ? "5 Ra from the pistons that it carries" : "10 Ra from the pistons",
               {kTenth, kMicrometres});
         };
         return first_of(
             {one("tapered_z_mm", tapered_nearer), one("cylindrical_z_mm", !tapered_nearer)});
       }},
  };
}

}  // namespace bentaxis::study::checks
