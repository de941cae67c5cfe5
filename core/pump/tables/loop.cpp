// [loop]: a closed circuit.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kLoop = part_of_hydraulics<&HydraulicData::loop>();

std::string loop_refusal(const Case& c) {
  if (find(c, &HydraulicData::suction_line) != nullptr)
    return "a closed loop has no tank to draw from: leave out [suction_line]";
  return delivery_is_held(c) ? "a closed loop needs a load between its sides: not "
                               "constant_pressure, and not delivery_bar = 0"
                             : "";
}

}  // namespace

Table loop_table() {
  return {.name = "loop",
          .meaning =
              "closed circuit: the load leads into a volume at the suction port, and a "
              "charge supply at `suction_bar` feeds either side through a check valve",
          .part = &kLoop,
          .parameters = {{.key = "volume_l",
                          .field = FIELD(c.hydraulics->loop->volume),
                          .symbol = "V_s",
                          .unit = kLitres,
                          .range = kPositive,
                          .fallback = {0.5},
                          .meaning = "of the closed loop at the suction port"},
                         {.key = "charge_area_mm2",
                          .field = FIELD(c.hydraulics->loop->charge_area),
                          .symbol = "a_c",
                          .unit = kSquareMillimetres,
                          .range = kPositive,
                          .fallback = {50.0},
                          .meaning = "of each check valve, fully open"},
                         {.key = "charge_opening_bar",
                          .field = FIELD(c.hydraulics->loop->opening),
                          .unit = kBar,
                          .range = {1e-3, 1000},
                          .fallback = {1.0},
                          .meaning = "pressure difference over which its area grows from 0 to "
                                     "that, in proportion"}},
          .rules = {{.key = "volume_l", .after = "", .broken = loop_refusal}}};
}

}  // namespace bentaxis::tables
