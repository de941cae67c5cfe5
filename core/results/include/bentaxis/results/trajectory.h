// Motion of a pump in time, as a simulation by either model finds it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/column.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/oil.h"
#include "bentaxis/results/teeth.h"

namespace bentaxis {

/// What every simulation is asked for; a model adds its own choices to it.
struct SimulationOptions {
  /// Wanted error of every reaction, of its peak, at the end of an unexcited motion. Impacts make
  /// errors grow; how much is measured, not asked for.
  double error = 1e-8;
  /// Relative error per step instead of the one chosen for `error`.
  std::optional<double> accuracy;
  bool body_loads = false;  ///< Trajectory::loads too
};

/// A flank of the teeth that touches or leaves, or a piston and the wall of its bore.
struct ToothEvent {
  double time_s = 0;
  bool touch = true;          ///< or leaves
  int flank = 1;              ///< +1: the shaft pushes the block towards +psi; -1: towards -psi
  double shaft_speed = 0;     ///< rad/s, theta'
  double block_speed = 0;     ///< rad/s, psi'
  double approach_speed = 0;  ///< m/s, of the two flanks along the line of action
  double impulse = 0;  ///< Ns, of the tooth force from this touch until the flanks leave, or the
                       ///< end; 0 where they leave and of walls
  int piston = 0;      ///< 1..N, of walls; `flank` then is the sign of theta - psi
};

/// What a simulation cost and how well it kept what must hold.
struct TrajectoryRecord {
  long steps = 0;
  long evaluations = 0;       ///< of the equations of motion
  double seconds = 0;         ///< of wall-clock time
  double work_of_loads = 0;   ///< J, pressure, friction, weight, viscous, teeth, coupling's damper
  double work_of_drives = 0;  ///< J, what turns the shaft; of a motor its torque on the rotor
  double kinetic_energy_gained = 0;    ///< J, of all bodies, the rotor's too
  double potential_energy_gained = 0;  ///< J, in teeth and coupling, where the model has them
  /// J, work less energy gained at the end; what constraints and integration created or lost.
  double work_residual = 0;
  double worst_work_residual = 0;  ///< J, largest magnitude at any row
  double drift = 0;  ///< m, worst error of a constraint; 0 where motion has no constraints
  double share_out_of_contact = 0;  ///< of the time, compliant teeth; 0 where they are rigid
  std::vector<ToothEvent> events;
  std::string choice;  ///< method and tolerance, and why
};

/// Energy that went by a place of the oil's circuit, J, from the start to the end.
struct OilEnergy {
  OilPlace place;
  double energy = 0;
};

/// The oil of a simulation in which it follows the motion.
struct OilHistory {
  std::vector<OilColumn> columns;
  std::vector<double> values;  ///< row-major, rows of the trajectory
  std::vector<OilEnergy> energies;
  double energy_gained = 0;    ///< J, stored in the oil
  double energy_residual = 0;  ///< J, sources less everything else at the end; must vanish
  double worst_energy_residual = 0;
  double mass_in = 0, mass_out = 0, mass_gained = 0;  ///< kg
  double mass_residual = 0, worst_mass_residual = 0;  ///< kg
  /// J, work of the pressures on the pistons by the mechanical model; with that of the pistons on
  /// the oil, which comes from the volumes of the chambers, it must vanish.
  double pressure_work = 0;
  double exchange_residual = 0, worst_exchange_residual = 0;  ///< J, their sum

  double value(std::size_t row, std::size_t column) const {
    return values[row * columns.size() + column];
  }
};

/// The columns of trajectory_columns(), in their order.
enum class StateColumn : std::size_t { time, theta, psi, shaft_speed, block_speed, motor_speed };

/// A simulated motion: rows at 0, duration/samples, .., duration.
struct Trajectory {
  /// State columns as trajectory_columns() has them.
  MotionTable table;
  std::vector<double> lag;  ///< theta - psi, rad, per row, with its own digits
  TrajectoryRecord record;
  std::optional<OilHistory> oil;   ///< where oil is simulated too
  std::vector<TeethAction> teeth;  ///< per row, where the contact is that of teeth
  BodyLoadTable loads;             ///< on all bodies, a row per row, where they were asked for

  /// A state in the unit of its column: s, deg, rpm.
  double state(std::size_t row, StateColumn column) const {
    return table.state(row, static_cast<std::size_t>(column));
  }
};

/// time_s, theta_deg, psi_deg, shaft_rpm, block_rpm, and motor_rpm where a motor drives.
std::vector<std::string> trajectory_columns(const DriveSpec& drive);

/// The same with units and meanings.
std::vector<Column> state_columns(const DriveSpec& drive);

/// Times of the rows of a simulation, s.
std::vector<double> trajectory_times(const DriveSpec& drive);

/// An empty trajectory table of a model, ready for append_trajectory_row().
MotionTable trajectory_table(const std::string& model, const ChannelLayout& layout,
                             const DriveSpec& drive);

/// Adds a row: the values of trajectory_columns() in their units, and channels and checks in SI.
/// @throws ComputationError naming model, channel and time where a value is not finite
void append_trajectory_row(MotionTable& table, const std::vector<double>& state,
                           const std::vector<double>& row, const MotionChecks& checks);

/// What the teeth of a simulation do: time_s, then the columns of results/teeth.h.
MotionTable teeth_table_of(const Trajectory& run, const Gear& gear);

/// The drive of a case that can be simulated.
/// @throws InputError naming the key where [drive] is missing or cannot be simulated with the
/// pump: dry friction that jumps (`regularization_m_per_s` = 0) where speeds may vanish.
const DriveSpec& drive_of(const Case& the_case);

/// Speed of the shaft at the start, rad/s.
/// @param usual  where the drive does not say
double start_speed(const DriveSpec& drive, double usual);

/// Whether dry friction jumps and the motion depends on it: `regularization_m_per_s` = 0 of a shaft
/// or a block that moves freely.
bool friction_jumps(const Case& the_case);

/// @throws InputError where friction_jumps(), which equations of motion in independent coordinates
///         do not follow
void require_smooth_friction(const Case& the_case);

}  // namespace bentaxis
