// [delivery_line].
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kDeliveryLine = part_of_hydraulics<&HydraulicData::delivery_line>();

}  // namespace

Table delivery_line_table() {
  return {.name = "delivery_line",
          .meaning = "pipe between delivery volume and load, in which waves run",
          .part = &kDeliveryLine,
          .parameters = {{.key = "length_m",
                          .field = FIELD(c.hydraulics->delivery_line->length),
                          .symbol = "L",
                          .unit = kMetres,
                          .range = {1e-3, 1000},
                          .meaning = "from the delivery volume to the load"},
                         {.key = "diameter_mm",
                          .field = FIELD(c.hydraulics->delivery_line->diameter),
                          .symbol = "D",
                          .unit = kMillimetres,
                          .range = {0.1, 1e4},
                          .meaning = "inside"},
                         {.key = "bandwidth_Hz",
                          .field = FIELD(c.hydraulics->delivery_line->bandwidth),
                          .symbol = "f",
                          .unit = {"Hz"},
                          .range = {1, 1e6},
                          .range_words = "[1, 1e+06], at most 48 modes",
                          .fallback = {1000.0},
                          .meaning = "up to which waves in it are right to 1e-3",
                          .practice = "8 times the pistons' frequency"},
                         {.key = "wave_speed_m_per_s",
                          .field = FIELD(c.hydraulics->delivery_line->wave_speed),
                          .symbol = "c",
                          .unit = {"m/s"},
                          .range = {0, 1e5},
                          .fallback = {0.0},
                          .meaning = "0: that of the oil at `delivery_bar`, in a rigid pipe",
                          .practice = "hose: 600..900"}}};
}

}  // namespace bentaxis::tables
