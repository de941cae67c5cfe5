// What the drive torque is needed for, cause by cause, and what presses the block onto its plate.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/results/result_table.h"
#include "bentaxis/results/samples.h"

namespace bentaxis {

/// What needs drive torque. Spring and port-plate film are not among them: they act where nothing
/// moves.
enum class Cause {
  pressure,         ///< of the oil on the pistons
  piston_friction,  ///< of the rings in the bores
  weight,           ///< of the pistons
  inertia,          ///< of the pistons, and of shaft and block where the speed changes
  block_friction,   ///< Cc
  shaft_friction,   ///< Cs
  torque_factor,    ///< (1 - Ct) Td
  ring,             ///< bore forces that do not act at B, on the play between piston and bore
  teeth,            ///< resolved teeth: what their deformation stores and gives back
};
inline constexpr std::size_t kCauses = 9;

/// "pressure", "piston_friction", ..: in the names of columns.
const char* to_string(Cause cause);

/// Torques and forces of one instant by cause, each from its own load alone; SI.
struct Budget {
  std::array<double, kCauses> drive = {};  ///< of the drive torque Td
  /// Of the torque Tcs that carries the block round: what goes through the gear, and then is a part
  /// of `drive`; where the block's speed is imposed, what that motion supplies instead of Td.
  std::array<double, kCauses> carrying = {};
  double drive_torque = 0;     ///< Td as the model finds it, which `drive` must add up to
  double carrying_torque = 0;  ///< Tcs, which `carrying` must add up to

  double pressing = 0;  ///< on the block along z2: chambers, friction, spring, weight, tooth force
  double separating = 0;  ///< of the port-plate lands on the block along z2; 0 without a plate
  double film = 0;        ///< Fh, which must hold the two

  double& drive_of(Cause cause) { return drive[static_cast<std::size_t>(cause)]; }
  double& carrying_of(Cause cause) { return carrying[static_cast<std::size_t>(cause)]; }
};

/// Budgets of a run as a table: Td_CAUSE_Nm of each cause and Td_z1_Nm; Tcs_CAUSE_Nm and Tcs_z2_Nm;
/// Fpress_z2_N, Fland_z2_N; and what must vanish: both torques and the forces of the block less the
/// sum of their parts.
/// @param ring   whether the bore forces do work: without it the table has no columns of
/// Cause::ring
/// @param teeth  whether the teeth are resolved: likewise for Cause::teeth
ResultTable budget_table(const std::string& model, bool ring = false, bool teeth = false);
/// Adds the row of an instant.
/// @throws ComputationError where a value is not finite
void append_budget(ResultTable& table, double theta_deg, const Budget& budget);

/// Column of a cause's part of Td, of Tcs: "Td_pressure_Nm", "Tcs_pressure_Nm".
std::string drive_column(Cause cause);
std::string carrying_column(Cause cause);

}  // namespace bentaxis
