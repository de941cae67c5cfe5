// [operation]: how the pump runs.
#include "tables/entries.h"

namespace bentaxis::tables {

Table operation_table() {
  return {.name = "operation",
          .meaning = "how the pump runs",
          .parameters = {
              {.key = "speed_rpm",
               .field = FIELD(c.operation.speed_rpm),
               .symbol = "omega",
               .unit = kSpeed,
               .meaning = "speed of shaft and block, positive about +z1, +z2; the sign gives the "
                          "direction"},
              {.key = "gravity_m_per_s2",
               .field = FIELD(c.pump.gravity),
               .symbol = "g",
               .unit = {"m/s2"},
               .fallback = {9.80665},
               .meaning = "along -y1"},
              {.key = "revolutions",
               .field = FIELD(c.operation.revolutions),
               .range = kCount,
               .fallback = {1},
               .meaning = "of an integrated run"},
              {.key = "samples_per_revolution",
               .field = FIELD(c.operation.samples_per_revolution),
               .range = kCount,
               .fallback = {720},
               .meaning = "angles of a turn, equally far apart"}}};
}

}  // namespace bentaxis::tables
