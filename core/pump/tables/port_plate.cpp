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
          "lands of the fixed port plate: full port pressure between r2 and r3, falling "
          "linearly to 0 at r1 and r4",
      .part = &kPortPlate,
      .differentiable = always,
      .parameters = {{.key = "inner_land_mm",
                      .field = pair_at(PLACE(c.pump.port_plate->r1), PLACE(c.pump.port_plate->r2)),
                      .symbol = "r1, r2",
                      .unit = kMillimetres,
                      .range = kNotNegative,
                      .range_words = "[r1, r2], 0 <= r1 < r2",
                      .meaning = "radii of the inner sealing land"},
                     {.key = "outer_land_mm",
                      .field = pair_at(PLACE(c.pump.port_plate->r3), PLACE(c.pump.port_plate->r4)),
                      .symbol = "r3, r4",
                      .unit = kMillimetres,
                      .range = kNotNegative,
                      .range_words = "[r3, r4], r2 < r3 < r4",
                      .meaning = "radii of the outer sealing land"},
                     {.key = "delivery_arc_deg",
                      .field = ARC(c.pump.port_plate->delivery),
                      .symbol = "psi_d1, psi_d2",
                      .unit = kDegrees,
                      .range_words = "[from, to], from < to <= from + 360",
                      .meaning = "delivery port; psi = 0 is +y2, psi grows as theta"},
                     {.key = "suction_arc_deg",
                      .field = ARC(c.pump.port_plate->suction),
                      .symbol = "psi_s1, psi_s2",
                      .unit = kDegrees,
                      .range_words = "[from, to], from < to <= from + 360",
                      .meaning = "suction port, likewise"}},
      .rules = {{.key = "inner_land_mm", .after = "inner_land_mm", .broken = inner_land_refusal},
                {.key = "outer_land_mm", .after = "outer_land_mm", .broken = outer_land_refusal},
                {.key = "delivery_arc_deg",
                 .after = "delivery_arc_deg",
                 .broken = [](const Case& c) { return arc_refusal(c.pump.port_plate->delivery); }},
                {.key = "suction_arc_deg", .after = "suction_arc_deg", .broken = [](const Case& c) {
                   return arc_refusal(c.pump.port_plate->suction);
                 }}}};
}

}  // namespace bentaxis::tables
