// [suction_line].
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kSuctionLine = part_of_hydraulics<&HydraulicData::suction_line>();

}  // namespace

Table suction_line_table() {
  return {.name = "suction_line",
          .meaning = "pipe from the tank, which is at `suction_bar`, to the suction port",
          .part = &kSuctionLine,
          .parameters = {
              {.key = "length_m",
               .field = FIELD(c.hydraulics->suction_line->length),
               .symbol = "L_s",
               .unit = kMetres,
               .range = {1e-3, 1000},
               .meaning = "the oil in it is one mass"},
              {.key = "diameter_mm",
               .field = FIELD(c.hydraulics->suction_line->diameter),
               .symbol = "D_s",
               .unit = kMillimetres,
               .range = {0.1, 1e4},
               .meaning = "inside"},
              {.key = "loss_coefficient",
               .field = FIELD(c.hydraulics->suction_line->loss),
               .symbol = "zeta",
               .range = kNotNegative,
               .fallback = {1.0},
               .meaning = "pressure lost over the dynamic pressure in the pipe; laminar friction "
                          "is added where there is `[oil]`",
               .practice = "entry 0.5, bend 0.3, filter more"},
              {.key = "volume_l",
               .field = FIELD(c.hydraulics->suction_line->volume),
               .symbol = "V_s",
               .unit = kLitres,
               .range = kPositive,
               .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                              const SuctionLineData* line = find(c, &HydraulicData::suction_line);
                              if (line == nullptr) return std::nullopt;
                              return kPi / 8 * line->diameter * line->diameter * line->length * 1e3;
                            },
                            .words = "half of the pipe's"},
               .meaning = "between the suction line and the suction port"}}};
}

}  // namespace bentaxis::tables
