// [block]: the cylinder block.
#include "tables/entries.h"

namespace bentaxis::tables {

Table block_table() {
  return {
      .name = "block",
      .meaning = "cylinder block",
      .differentiable = always,
      .parameters = {
          number("mass_kg", "mc", FIELD(c.pump.block.mass), kKilograms, kNotNegative, kRequired,
                 "mass"),
          number("centre_of_mass_z_mm", "z_c", FIELD(c.pump.block.centre_of_mass_z), kMillimetres,
                 kAny, kRequired, "z2 of the centre of mass"),
          number("pin_z_mm", "z_pin", FIELD(c.pump.block.pin_z), kMillimetres, kAny, kRequired,
                 "z2 of the mean contact point of the guide pin"),
          number("bottom_area_mm2", "Ac", FIELD(c.pump.block.bottom_area), kSquareMillimetres,
                 kNotNegative, {0.0},
                 "area per bore on which the chamber pressure presses the block onto the plate"),
          number("spring_force_N", "Fm", FIELD(c.pump.block.spring_force), kNewtons, kNotNegative,
                 {0.0}, "spring between shaft and block, which pushes them apart"),
          number("axial_inertia_kg_mm2", "I_c", FIELD(c.pump.block.axial_inertia), kInertia,
                 kNotNegative, {in_file_unit(kUsualBlockInertia, kInertia)},
                 "about z2; acts only where the speed changes")}};
}

}  // namespace bentaxis::tables
