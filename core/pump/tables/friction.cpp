// [friction] of pistons, block and shaft.
#include "tables/entries.h"

namespace bentaxis::tables {

Table friction_table() {
  return {.name = "friction",
          .meaning = "friction of pistons, block and shaft",
          .presence = Presence::optional,
          .parameters = {{.key = "piston_coulomb_N",
                          .field = FIELD(c.pump.friction.piston_coulomb),
                          .symbol = "Fc",
                          .unit = kNewtons,
                          .range = kNotNegative,
                          .fallback = {0.0},
                          .meaning = "Coulomb part of the piston friction Fpf"},
                         {.key = "piston_viscous_N_s_per_m",
                          .field = FIELD(c.pump.friction.piston_viscous),
                          .symbol = "cv",
                          .unit = {"N s/m"},
                          .range = kNotNegative,
                          .fallback = {0.0},
                          .meaning = "viscous part of Fpf"},
                         {.key = "regularization_m_per_s",
                          .field = FIELD(c.pump.friction.regularization),
                          .symbol = "v_reg",
                          .unit = {"m/s"},
                          .range = kNotNegative,
                          .fallback = {0.01},
                          .meaning = "the Coulomb part grows as tanh(v/v_reg); 0 means sign(v)"},
                         {.key = "block_viscous_Nm_per_rpm",
                          .field = FIELD(c.pump.friction.block_viscous),
                          .symbol = "Cc (also C)",
                          .unit = kTorquePerSpeed,
                          .range = kNotNegative,
                          .fallback = {0.0},
                          .meaning = "viscous torque of the block"},
                         {.key = "shaft_viscous_Nm_per_rpm",
                          .field = FIELD(c.pump.friction.shaft_viscous),
                          .symbol = "Cs",
                          .unit = kTorquePerSpeed,
                          .range = kNotNegative,
                          .fallback = {0.0},
                          .meaning = "viscous torque of the shaft"},
                         {.key = "shaft_torque_factor",
                          .field = FIELD(c.pump.friction.shaft_torque_factor),
                          .symbol = "Ct",
                          .range = {0, 1, true},
                          .fallback = {1.0},
                          .meaning = "1 - Ct of the drive torque is lost"}}};
}

}  // namespace bentaxis::tables
