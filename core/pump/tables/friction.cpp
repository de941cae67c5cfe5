// [friction] of pistons, block and shaft.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

// The lag of pistons that carry the block follows from a balance of torques, which must not jump.
std::string jump_refusal(const Case& c) {
  const Friction& friction = c.pump.friction;
  return c.pump.transfer.kind == TransferKind::pistons && friction.piston_coulomb > 0 &&
                 friction.regularization == 0
             ? "must be > 0 beside [transfer] kind = \"pistons\" and piston_coulomb_N > 0"
             : "";
}

}  // namespace

Table friction_table() {
  return {
      .name = "friction",
      .meaning = "friction of pistons, block and shaft",
      .presence = Presence::optional,
      .differentiable = always,
      .in_fmu = InFmu::tunable,
      .parameters = {number("piston_coulomb_N", "Fc", FIELD(c.pump.friction.piston_coulomb),
                            kNewtons, kNotNegative, {0.0},
                            "Coulomb part of the piston friction Fpf"),
                     number("piston_viscous_N_s_per_m", "cv", FIELD(c.pump.friction.piston_viscous),
                            {"N s/m"}, kNotNegative, {0.0}, "viscous part of Fpf"),
                     number("regularization_m_per_s", "v_reg",
                            FIELD(c.pump.friction.regularization), {"m/s"}, kNotNegative, {0.01},
                            "the Coulomb part grows as tanh(v/v_reg); 0 means sign(v)",
                            {.in_fmu = InFmu::fixed}),
                     number("block_viscous_Nm_per_rpm", "Cc", FIELD(c.pump.friction.block_viscous),
                            kTorquePerSpeed, kNotNegative, {0.0}, "viscous torque of the block"),
                     number("shaft_viscous_Nm_per_rpm", "Cs", FIELD(c.pump.friction.shaft_viscous),
                            kTorquePerSpeed, kNotNegative, {0.0}, "viscous torque of the shaft"),
                     number("shaft_torque_factor", "Ct", FIELD(c.pump.friction.shaft_torque_factor),
                            kNoUnit, {0, 1, true}, {1.0}, "1 - Ct of the drive torque is lost")},
      .rules = {at_end("regularization_m_per_s", jump_refusal)}};
}

}  // namespace bentaxis::tables
