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
          {{.key = "inertia",
            .field = FIELD(c.pump.piston.inertia),
            .words = piston_inertia_names(),
            .meaning = "two point masses at A and B; a rigid body; or three point masses at A, "
                       "centre of mass and B with the real piston's mass, centre and transverse "
                       "inertia (no spin)"},
           {.key = "mass_kg",
            .field = FIELD(c.pump.piston.mass),
            .symbol = "m_pi",
            .unit = kKilograms,
            .range = kNotNegative,
            .meaning = "mass of a piston, m in theory.md"},
           {.key = "joint_mass_fraction",
            .field = FIELD(c.pump.piston.joint_mass_fraction),
            .symbol = "chi",
            .range = {0, 1},
            .fallback = {0.5},
            .meaning = "lumped: share of the mass at A; mA = chi m, mB = (1 - chi) m",
            .plausible = {.low = 0.1,
                          .high = 0.9,
                          .why = "the centre of mass would lie next to A or B",
                          .slips = {{10, "ten times too small?"}, {1e2, "in hundredths?"}}}},
           {.key = "contact_mm",
            .field = FIELD(c.pump.piston.contact),
            .symbol = "s_C",
            .unit = kMillimetres,
            .range = kPositive,
            .fallback = {.words = "`piston_length_mm`"},
            .meaning = "from A along the piston's axis to C, where the bore force Rc acts (32); "
                       "pressure and friction stay at B",
            .part = &kRingContact},
           {.key = "centre_of_mass_mm",
            .field = FIELD(c.pump.piston.real->centre_of_mass),
            .symbol = "s_G (Gpi)",
            .unit = kMillimetres,
            .range_words = "dynamically equivalent: strictly between A and B, unless It = 0",
            .meaning = "from A along the piston's axis",
            .part = &kRealPiston},
           {.key = "transverse_inertia_kg_mm2",
            .field = FIELD(c.pump.piston.real->transverse_inertia),
            .symbol = "It",
            .unit = kInertia,
            .range = kNotNegative,
            .meaning = "about the centre of mass, across the axis",
            .part = &kRealPiston},
           {.key = "axial_inertia_kg_mm2",
            .field = FIELD(c.pump.piston.real->axial_inertia),
            .symbol = "Ia",
            .unit = kInertia,
            .range = kNotNegative,
            .range_here = [](const Case& c) -> std::optional<NumberRange> {
              const auto& real = c.pump.piston.real;
              if (!real) return std::nullopt;
              return NumberRange{0, 2 * in_file_unit(real->transverse_inertia, kInertia)};
            },
            .range_words = "[0, 2 It]",
            .meaning = "about the axis",
            .part = &kRealPiston},
           {.key = "spin_rpm",
            .field = FIELD(c.pump.piston.real->spin),
            .symbol = "w_s",
            .unit = kRotation,
            .fallback = {0.0},
            .meaning = "real: axial component of the absolute angular velocity, positive along A "
                       "to B",
            .part = &kRealPiston}},
      .rules = {{.key = "inertia", .after = "", .broken = [](const Case& c) {
                   return piston_inertia_refusal(c.pump.piston.inertia, c.pump);
                 }}}};
}

}  // namespace bentaxis::tables
