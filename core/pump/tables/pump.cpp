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
      .parameters = {{.key = "type",
                      .field = ChoiceField{},
                      .words = {"bent_axis_bevel"},
                      .fallback = {std::string("bent_axis_bevel")},
                      .meaning = "kind of mechanism"},
                     {.key = "pistons",
                      .field = FIELD(c.pump.geometry.pistons),
                      .symbol = "N",
                      .range = {1, kMaxPistons},
                      .meaning = "number of pistons",
                      .changes_model = true},
                     {.key = "tilt_deg",
                      .field = FIELD(c.pump.geometry.tilt),
                      .symbol = "alpha",
                      .unit = kAngle,
                      .range = {0, 90, false, true},
                      .meaning = "angle between shaft axis z1 and block axis z2",
                      .scaling = Scaling::sine},
                     {.key = "joint_circle_radius_mm",
                      .field = FIELD(c.pump.geometry.joint_circle_radius),
                      .symbol = "Ra",
                      .unit = kMillimetres,
                      .range = kPositive,
                      .meaning = "radius of the circle of joint centres A, about z1",
                      .plausible = {.low = 4,
                                    .high = 250,
                                    .why = "no pump has this size",
                                    .slips = {slips::kMetres, slips::kInches, slips::kCentimetres,
                                              slips::kMicrometres, slips::kTenth}}},
                     {.key = "bore_circle_radius_mm",
                      .field = FIELD(c.pump.geometry.bore_circle_radius),
                      .symbol = "Rd",
                      .unit = kMillimetres,
                      .range = kPositive,
                      .meaning = "radius of the circle of bore axes, about z2"},
                     {.key = "axis_offset_mm",
                      .field = FIELD(c.pump.geometry.axis_offset),
                      .symbol = "b",
                      .unit = kMillimetres,
                      .meaning = "z1 of O2: from the joint plane to the point where the axes meet"},
                     {.key = "piston_length_mm",
                      .field = FIELD(c.pump.geometry.piston_length),
                      .symbol = "b1",
                      .unit = kMillimetres,
                      .range = kPositive,
                      .range_words = "> 0, and long enough to be assembled over the whole turn",
                      .meaning = "A to B"},
                     {.key = "bore_diameter_mm",
                      .field = FIELD(c.pump.geometry.bore_diameter),
                      .symbol = "Dpi",
                      .unit = kMillimetres,
                      .range = kPositive,
                      .meaning = "cylinder diameter; piston area A = pi Dpi^2/4"}},
      .rules = {{.key = "piston_length_mm", .after = "piston_length_mm", .broken = not_assembled}}};
}

}  // namespace bentaxis::tables
