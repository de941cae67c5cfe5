// [accumulator] at the delivery volume.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kAccumulator = part_of_hydraulics<&HydraulicData::accumulator>();

std::string accumulator_refusal(const Case& c) {
  return !delivery_is_held(c) || find(c, &HydraulicData::delivery_line) != nullptr
             ? ""
             : "the delivery volume is held at a pressure (constant_pressure, or delivery_bar = "
               "0): an accumulator has no effect there";
}

}  // namespace

Table accumulator_table() {
  return {
      .name = "accumulator",
      .meaning = "gas spring at the delivery volume",
      .part = &kAccumulator,
      .parameters = {number("gas_volume_l", "V_g", FIELD(c.hydraulics->accumulator->gas_volume),
                            kLitres, {1e-6, 1e4}, kRequired, "of the gas at the precharge"),
                     number(
                         "precharge_bar", "p_g", FIELD(c.hydraulics->accumulator->precharge), kBar,
                         {0, 10000}, kRequired,
                         "gauge pressure of the gas without oil; below it the accumulator is empty",
                         {.practice = "0.6..0.9 of the working pressure"}),
                     number("gas_exponent", "n_g", FIELD(c.hydraulics->accumulator->exponent),
                            kNoUnit, {1, 1.67}, {1.4}, "polytropic exponent of the gas",
                            {.practice = "fast: 1.4, at high pressure more; slow: 1"}),
                     number("inlet_area_mm2", "a_g", FIELD(c.hydraulics->accumulator->inlet_area),
                            kSquareMillimetres, kPositive, {100.0},
                            "orifice between it and the delivery volume")},
      .rules = {at_end("gas_volume_l", accumulator_refusal)}};
}

}  // namespace bentaxis::tables
