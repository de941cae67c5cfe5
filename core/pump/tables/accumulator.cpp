// [accumulator] at the delivery volume.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kAccumulator = part_of_hydraulics<&HydraulicData::accumulator>();

std::string accumulator_refusal(const Case& c) {
  return !delivery_is_held(c) || find(c, &HydraulicData::delivery_line) != nullptr
             ? ""
             : "the delivery volume is held at a pressure (constant_pressure, or delivery_bar = 0):"
               " an accumulator does nothing there";
}

}  // namespace

Table accumulator_table() {
  return {.name = "accumulator",
          .meaning = "gas spring at the delivery volume",
          .part = &kAccumulator,
          .parameters = {{.key = "gas_volume_l",
                          .field = FIELD(c.hydraulics->accumulator->gas_volume),
                          .symbol = "V_g",
                          .unit = kLitres,
                          .range = {1e-6, 1e4},
                          .meaning = "of the gas at the precharge"},
                         {.key = "precharge_bar",
                          .field = FIELD(c.hydraulics->accumulator->precharge),
                          .symbol = "p_g",
                          .unit = kBar,
                          .range = {0, 10000},
                          .meaning = "gauge pressure of the gas without oil; below it the gas "
                                     "expands no further",
                          .practice = "0.6..0.9 of the working pressure"},
                         {.key = "gas_exponent",
                          .field = FIELD(c.hydraulics->accumulator->exponent),
                          .symbol = "n_g",
                          .range = {1, 1.67},
                          .fallback = {1.4},
                          .meaning = "polytropic exponent of the gas",
                          .practice = "fast: 1.4, at high pressure more; slow: 1"},
                         {.key = "inlet_area_mm2",
                          .field = FIELD(c.hydraulics->accumulator->inlet_area),
                          .symbol = "a_g",
                          .unit = kSquareMillimetres,
                          .range = kPositive,
                          .fallback = {100.0},
                          .meaning = "orifice between it and the delivery volume"}},
          .rules = {{.key = "gas_volume_l", .after = "", .broken = accumulator_refusal}}};
}

}  // namespace bentaxis::tables
