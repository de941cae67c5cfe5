// [delivery_line].
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kDeliveryLine = part_of_hydraulics<&HydraulicData::delivery_line>();

}  // namespace

Table delivery_line_table() {
  return {
      .name = "delivery_line",
      .meaning = "pipe between delivery volume and load, with pressure waves",
      .part = &kDeliveryLine,
      .parameters = {
          number("length_m", "L", FIELD(c.hydraulics->delivery_line->length), kMetres, {1e-3, 1000},
                 kRequired, "from the delivery volume to the load"),
          number("diameter_mm", "D", FIELD(c.hydraulics->delivery_line->diameter), kMillimetres,
                 {0.1, 1e4}, kRequired, "inside"),
          number("bandwidth_Hz", "f", FIELD(c.hydraulics->delivery_line->bandwidth), {"Hz"},
                 {1, 1e6}, {1000.0}, "up to which its waves are accurate to 1e-3",
                 {.range_words = "[1, 1e+06], at most 48 modes",
                  .practice = "8 times the pistons' frequency"}),
          number("wave_speed_m_per_s", "c", FIELD(c.hydraulics->delivery_line->wave_speed), {"m/s"},
                 {0, 1e5}, {0.0}, "0: that of the oil at `delivery_bar`, in a rigid pipe",
                 {.practice = "hose: 600..900"})}};
}

}  // namespace bentaxis::tables
