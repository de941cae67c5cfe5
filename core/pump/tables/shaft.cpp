// [shaft].
#include "tables/entries.h"

namespace bentaxis::tables {

Table shaft_table() {
  return {.name = "shaft",
          .meaning = "shaft",
          .differentiable = always,
          .parameters = {{.key = "mass_kg",
                          .field = FIELD(c.pump.shaft.mass),
                          .symbol = "ms",
                          .unit = kKilograms,
                          .range = kNotNegative,
                          .meaning = "mass"},
                         {.key = "centre_of_mass_z_mm",
                          .field = FIELD(c.pump.shaft.centre_of_mass_z),
                          .symbol = "Gs",
                          .unit = kMillimetres,
                          .meaning = "z1 of the centre of mass"},
                         {.key = "axial_inertia_kg_mm2",
                          .field = FIELD(c.pump.shaft.axial_inertia),
                          .symbol = "I_s",
                          .unit = kInertia,
                          .range = kNotNegative,
                          .fallback = {in_file_unit(kUsualShaftInertia, kInertia)},
                          .meaning = "about z1; acts only where the speed changes"}}};
}

}  // namespace bentaxis::tables
