// [port_plate]: the lands of the fixed plate.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kPortPlate = part_at([](auto& c) { return &c.pump.port_plate; });

std::string inner_land_refusal(const Case& c) {
  const PortPlate& p = *c.pump.port_plate;
  return p.r1 < p.r2 ? "" : "must be [r1, r2] with 0 <= r1 < r2";
}

std::string outer_land_refusal(const Case& c) {
  const PortPlate& p = *c.pump.port_plate;
  return p.r2 < p.r3 && p.r3 < p.r4 ? "" : "must be [r3, r4] with r2 < r3 < r4";
}

}  // namespace

Table port_plate_table() {
  return {
      .name = "port_plate",
      .meaning =
          "lands of the fixed port plate: full port pressure between r2 and r3, falling linearly "
          "to 0 at r1 and r4",
      .part = &kPortPlate,
      .differentiable = always,
      .parameters =
          {number("inner_land_mm", "r1, r2",
                  pair_at(PLACE(c.pump.port_plate->r1), PLACE(c.pump.port_plate->r2)), kMillimetres,
                  kNotNegative, kRequired, "radii of the inner sealing land",
                  {.range_words = "[r1, r2], 0 <= r1 < r2"}),
           number("outer_land_mm", "r3, r4",
                  pair_at(PLACE(c.pump.port_plate->r3), PLACE(c.pump.port_plate->r4)), kMillimetres,
                  kNotNegative, kRequired, "radii of the outer sealing land",
                  {.range_words = "[r3, r4], r2 < r3 < r4"}),
           number("delivery_arc_deg", "psi_d1, psi_d2", ARC(c.pump.port_plate->delivery), kDegrees,
                  kAny, kRequired, "delivery port; psi = 0 is +y2, psi grows as theta",
                  {.range_words = "[from, to], from < to <= from + 360"}),
           number("suction_arc_deg", "psi_s1, psi_s2", ARC(c.pump.port_plate->suction), kDegrees,
                  kAny, kRequired, "suction port, likewise",
                  {.range_words = "[from, to], from < to <= from + 360"})},
      .rules = {after("inner_land_mm", inner_land_refusal),
                after("outer_land_mm", outer_land_refusal),
                after("delivery_arc_deg",
                      [](const Case& c) { return arc_refusal(c.pump.port_plate->delivery); }),
                after("suction_arc_deg",
                      [](const Case& c) { return arc_refusal(c.pump.port_plate->suction); })}};
}

}  // namespace bentaxis::tables
