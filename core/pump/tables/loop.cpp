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
  return {
      .name = "loop",
      .meaning =
          "closed circuit: the load leads into a volume at the suction port, and a charge supply "
          "at `suction_bar` feeds either side through a check valve",
      .part = &kLoop,
      .parameters =
          {number("volume_l", "V_l", FIELD(c.hydraulics->loop->volume), kLitres, kPositive, {0.5},
                  "of the closed loop at the suction port"),
           number("charge_area_mm2", "a_c", FIELD(c.hydraulics->loop->charge_area),
                  kSquareMillimetres, kPositive, {50.0}, "of each check valve, fully open"),
           number("charge_opening_bar", "", FIELD(c.hydraulics->loop->opening), kBar, {1e-3, 1000},
                  {1.0},
                  "pressure difference over which its area increases linearly from 0 to that")},
      .rules = {at_end("volume_l", loop_refusal)}};
}

}  // namespace bentaxis::tables
