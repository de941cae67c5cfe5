// [operation]: how the pump runs.
#include "tables/entries.h"

namespace bentaxis::tables {

Table operation_table() {
  return {
      .name = "operation",
      .meaning = "how the pump runs",
      .parameters = {
          {.key = "speed_rpm",
           .field = FIELD(c.operation.speed_rpm),
           .symbol = "omega",
           .unit = kSpeed,
           .meaning = "speed of shaft and block, positive about +z1, +z2; the sign gives the "
                      "direction",
           .differentiable = always},
          {.key = "gravity_m_per_s2",
           .field = FIELD(c.pump.gravity),
           .symbol = "g",
           .unit = {"m/s2"},
           .fallback = {9.80665},
           .meaning = "along -y1",
           .differentiable = always,
           .in_fmu = InFmu::tunable,
           .plausible = {.low = 1.5,
                         .high = 20,
                         .why = "it is 9.81 on earth, 1.6 on the moon, positive along -y1",
                         .slips = {slips::kSign,
                                   {1e-3, "in mm/s2?"},
                                   {1e-2, "in cm/s2?"},
                                   {9.80665, "in g?"},
                                   slips::kTenth,
                                   slips::kTenfold,
                                   slips::kThousandfold}}},
          {.key = "revolutions",
           .field = FIELD(c.operation.revolutions),
           .range = kCount,
           .fallback = {1},
           .meaning = "of an integrated run",
           .plausible = {.low = 0, .high = 1e4, .why = "every turn is alike"}},
          {.key = "samples_per_revolution",
           .field = FIELD(c.operation.samples_per_revolution),
           .range = kCount,
           .fallback = {720},
           .meaning = "angles of a turn, equally far apart",
           .plausible = {.low = 6,
                         .high = 1e6,
                         .why = "a turn is seen from 6 angles on; 1e6 are every second of arc"}}}};
}

}  // namespace bentaxis::tables
