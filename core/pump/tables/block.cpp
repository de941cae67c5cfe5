// [block]: the cylinder block.
#include "tables/entries.h"

namespace bentaxis::tables {

Table block_table() {
  return {
      .name = "block",
      .meaning = "cylinder block",
      .differentiable = always,
      .parameters = {
          {.key = "mass_kg",
           .field = FIELD(c.pump.block.mass),
           .symbol = "mc",
           .unit = kKilograms,
           .range = kNotNegative,
           .meaning = "mass"},
          {.key = "centre_of_mass_z_mm",
           .field = FIELD(c.pump.block.centre_of_mass_z),
           .symbol = "Gt",
           .unit = kMillimetres,
           .meaning = "z2 of the centre of mass"},
          {.key = "pin_z_mm",
           .field = FIELD(c.pump.block.pin_z),
           .symbol = "Hcn",
           .unit = kMillimetres,
           .meaning = "z2 of the mean contact point of the guide pin"},
          {.key = "bottom_area_mm2",
           .field = FIELD(c.pump.block.bottom_area),
           .symbol = "Ac",
           .unit = kSquareMillimetres,
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "area per bore on which the chamber pressure pushes the block to the plate"},
          {.key = "spring_force_N",
           .field = FIELD(c.pump.block.spring_force),
           .symbol = "Fm",
           .unit = kNewtons,
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "spring between shaft and block, pushes them apart"},
          {.key = "axial_inertia_kg_mm2",
           .field = FIELD(c.pump.block.axial_inertia),
           .symbol = "I_c",
           .unit = kInertia,
           .range = kNotNegative,
           .fallback = {in_file_unit(kUsualBlockInertia, kInertia)},
           .meaning = "about z2; acts only where the speed changes"}}};
}

}  // namespace bentaxis::tables
