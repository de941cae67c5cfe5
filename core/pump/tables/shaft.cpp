// [shaft].
#include "tables/entries.h"

namespace bentaxis::tables {

Table shaft_table() {
  return {
      .name = "shaft",
      .meaning = "shaft",
      .differentiable = always,
      .parameters = {number("mass_kg", "ms", FIELD(c.pump.shaft.mass), kKilograms, kNotNegative,
                            kRequired, "mass"),
                     number("centre_of_mass_z_mm", "z_s", FIELD(c.pump.shaft.centre_of_mass_z),
                            kMillimetres, kAny, kRequired, "z1 of the centre of mass"),
                     number("axial_inertia_kg_mm2", "I_s", FIELD(c.pump.shaft.axial_inertia),
                            kInertia, kNotNegative, {in_file_unit(kUsualShaftInertia, kInertia)},
                            "about z1; acts only where the speed changes")}};
}

}  // namespace bentaxis::tables
