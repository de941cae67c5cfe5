// [suction_line].
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kSuctionLine = part_of_hydraulics<&HydraulicData::suction_line>();

}  // namespace

Table suction_line_table() {
  return {
      .name = "suction_line",
      .meaning = "pipe from the tank, which is at `suction_bar`, to the suction port",
      .part = &kSuctionLine,
      .parameters = {
          number("length_m", "L_s", FIELD(c.hydraulics->suction_line->length), kMetres,
                 {1e-3, 1000}, kRequired, "the oil in it is one mass"),
          number("diameter_mm", "D_s", FIELD(c.hydraulics->suction_line->diameter), kMillimetres,
                 {0.1, 1e4}, kRequired, "inside"),
          number("loss_coefficient", "zeta", FIELD(c.hydraulics->suction_line->loss), kNoUnit,
                 kNotNegative, {1.0},
                 "pressure loss over the dynamic pressure in the pipe; laminar friction is added "
                 "where there is `[oil]`",
                 {.practice = "entry 0.5, bend 0.3, filter more"}),
          number("volume_l", "V_s", FIELD(c.hydraulics->suction_line->volume), kLitres, kPositive,
                 {.computed = [](const Case& c) -> std::optional<Value> {
                    const SuctionLineData* line = find(c, &HydraulicData::suction_line);
                    if (line == nullptr) return std::nullopt;
                    return kPi / 8 * line->diameter * line->diameter * line->length * 1e3;
                  },
                  .words = "half of the pipe's"},
                 "between the suction line and the suction port")}};
}

}  // namespace bentaxis::tables
