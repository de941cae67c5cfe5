// [pump]: main dimensions.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

std::string not_assembled(const Case& c) {
  const Geometry& g = c.pump.geometry;
  const AssemblyMargin margin = assembly_margin(g);
  if (g.piston_length > margin.longest_distance) return "";
  return "must be > " + short_text(margin.longest_distance * 1e3) +
         ": the pump cannot be assembled at theta = " + short_text(margin.theta_deg) +
         " deg, where " + short_text((margin.longest_distance - g.piston_length) * 1e3) +
         " mm are missing (set by joint_circle_radius_mm, bore_circle_radius_mm, axis_offset_mm, "
         "tilt_deg)";
}

}  // namespace

Table pump_table() {
  return {
      .name = "pump",
      .meaning = "main dimensions",
      .differentiable = always,
      .parameters =
          {choice("type", FIELD(c.pump.type), {"bent_axis", "bent_axis_bevel"}, "bent_axis",
                  "kind of mechanism; bent_axis_bevel: a bevel gear drives the block, an error "
                  "with another "
                  "kind of `[transfer]`"),
           number("pistons", "N", FIELD(c.pump.geometry.pistons), kNoUnit, {1, kMaxPistons},
                  kRequired, "number of pistons",
                  {.also = {"z", "n", "number_of_pistons", "piston_count", "piston_number",
                            "num_pistons"},
                   .changes_model = true}),
           number("tilt_deg", "alpha", FIELD(c.pump.geometry.tilt), kAngle, {0, 90, false, true},
                  kRequired, "angle between shaft axis z1 and block axis z2",
                  {.also = {"tilt_angle", "swash_angle", "swivel_angle", "bend_angle", "bent_angle",
                            "block_angle", "angle"},
                   .scaling = Scaling::sine}),
           number("joint_circle_radius_mm", "Ra", FIELD(c.pump.geometry.joint_circle_radius),
                  kMillimetres, kPositive, kRequired,
                  "radius of the circle of joint centres A, about z1",
                  {.also = {"joint_radius", "ball_circle_radius", "drive_plate_radius",
                            "flange_radius"},
                   .plausible = {4,
                                 250,
                                 "no pump is of this size",
                                 {slips::kMetres, slips::kInches, slips::kCentimetres,
                                  slips::kMicrometres, slips::kTenth}}}),
           number("bore_circle_radius_mm", "Rd", FIELD(c.pump.geometry.bore_circle_radius),
                  kMillimetres, kPositive, kRequired, "radius of the circle of bore axes, about z2",
                  {.also = {"bore_radius", "block_radius", "pitch_circle_radius",
                            "cylinder_circle_radius"}}),
           number("axis_offset_mm", "b", FIELD(c.pump.geometry.axis_offset), kMillimetres, kAny,
                  kRequired, "z1 of O2: from the joint plane to the point where the axes meet"),
           number("piston_length_mm", "b1", FIELD(c.pump.geometry.piston_length), kMillimetres,
                  kPositive, kRequired, "A to B",
                  {.range_words = "> 0, and long enough to be assembled over the whole turn"}),
           number("bore_diameter_mm", "Dpi", FIELD(c.pump.geometry.bore_diameter), kMillimetres,
                  kPositive, kRequired, "cylinder diameter; piston area A_p = pi Dpi^2/4",
                  {.also = {"piston_diameter", "bore", "cylinder_diameter"}})},
      .rules = {after("piston_length_mm", not_assembled)}};
}

}  // namespace bentaxis::tables
