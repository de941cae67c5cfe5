// [piston]: mass properties of one piston.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kRealPiston = part_at([](auto& c) { return &c.pump.piston.real; },
                                 {"piston", "inertia", {"real", "dynamically_equivalent"}});
// A single key without which something else is meant.
const Part kRingContact = part_at([](auto& c) { return &c.pump.piston.contact; });

}  // namespace

Table piston_table() {
  return {
      .name = "piston",
      .meaning = "mass properties of one piston",
      .differentiable = always,
      .parameters =
          {choice(
               "inertia", FIELD(c.pump.piston.inertia), piston_inertia_names(), kRequired,
               "two point masses at A and B; a rigid body; or three point masses at A, centre of "
               "mass and B with the real piston's mass, centre and transverse inertia (no spin)"),
           number("mass_kg", "m_pi", FIELD(c.pump.piston.mass), kKilograms, kNotNegative, kRequired,
                  "mass of a piston"),
           number("joint_mass_fraction", "chi", FIELD(c.pump.piston.joint_mass_fraction), kNoUnit,
                  {0, 1}, {0.5}, "lumped: fraction of the mass at A; mA = chi m, mB = (1 - chi) m",
                  {.plausible = {0.1,
                                 0.9,
                                 "the centre of mass would lie next to A or B",
                                 {{10, "ten times too small?"}, {1e2, "in hundredths?"}}}}),
           number("contact_mm", "s_C", FIELD(c.pump.piston.contact), kMillimetres, kPositive,
                  {.words = "`piston_length_mm`"},
                  "from A along the piston's axis to C, where the bore force Rc acts (32); "
                  "pressure and friction stay at B",
                  {.part = &kRingContact}),
           number("centre_of_mass_mm", "s_G", FIELD(c.pump.piston.real->centre_of_mass),
                  kMillimetres, kAny, kRequired, "from A along the piston's axis",
                  {.range_words = "dynamically equivalent: strictly between A and B, unless It = 0",
                   .part = &kRealPiston}),
           number("transverse_inertia_kg_mm2", "It", FIELD(c.pump.piston.real->transverse_inertia),
                  kInertia, kNotNegative, kRequired, "about the centre of mass, across the axis",
                  {.part = &kRealPiston}),
           number("axial_inertia_kg_mm2", "Ia", FIELD(c.pump.piston.real->axial_inertia), kInertia,
                  kNotNegative, kRequired, "about the axis",
                  {.range_here = [](const Case& c) -> std::optional<NumberRange> {
                     const auto& real = c.pump.piston.real;
                     if (!real) return std::nullopt;
                     return NumberRange{0, 2 * in_file_unit(real->transverse_inertia, kInertia)};
                   },
                   .range_words = "[0, 2 It]",
                   .part = &kRealPiston}),
           number("spin_rpm", "omega_s", FIELD(c.pump.piston.real->spin), kRotation, kAny, {0.0},
                  "real: axial component of the absolute angular velocity, positive along A to B",
                  {.part = &kRealPiston})},
      .rules = {at_end("inertia", [](const Case& c) {
        return piston_inertia_refusal(c.pump.piston.inertia, c.pump);
      })}};
}

}  // namespace bentaxis::tables
