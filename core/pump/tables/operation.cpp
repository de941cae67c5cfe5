// [operation]: how the pump runs.
#include "tables/entries.h"

namespace bentaxis::tables {

Table operation_table() {
  return {
      .name = "operation",
      .meaning = "how the pump runs",
      .parameters = {
          number("speed_rpm", "omega", FIELD(c.operation.speed_rpm), kSpeed, kAny, kRequired,
                 "speed of shaft and block, positive about +z1, +z2; the sign gives the direction",
                 {.also = {"rpm", "n", "shaft_speed", "rotational_speed", "drive_speed", "omega"},
                  .differentiable = always}),
          number("gravity_m_per_s2", "g", FIELD(c.pump.gravity), {"m/s2"}, kAny, {9.80665},
                 "along -y1",
                 {.differentiable = always,
                  .in_fmu = InFmu::tunable,
                  .plausible = {1.5,
                                20,
                                "it is 9.81 on earth, 1.6 on the moon, positive along -y1",
                                {slips::kSign,
                                 {1e-3, "in mm/s2?"},
                                 {1e-2, "in cm/s2?"},
                                 {9.80665, "in g?"},
                                 slips::kTenth,
                                 slips::kTenfold,
                                 slips::kThousandfold}}}),
          number("revolutions", "", FIELD(c.operation.revolutions), kNoUnit, kCount, {1},
                 "of an integrated run", {.plausible = {0, 1e4, "all turns are equal"}}),
          number("samples_per_revolution", "", FIELD(c.operation.samples_per_revolution), kNoUnit,
                 kCount, {720}, "equally spaced angles per turn",
                 {.also = {"samples", "steps_per_revolution", "angles", "points_per_turn"},
                  .plausible = {
                      6, 1e6,
                      "at least 6 angles resolve a turn; 1e6 are about one per second of arc"}})}};
}

}  // namespace bentaxis::tables
