#include "bentaxis/results/trajectory.h"

#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/time_signal.h"

namespace bentaxis {

std::vector<std::string> trajectory_columns(const DriveSpec& drive) {
  std::vector<std::string> names = {"time_s", "theta_deg", "psi_deg", "shaft_rpm", "block_rpm"};
  if (drive.kind == DriveKind::motor) names.emplace_back("motor_rpm");
  return names;
}

std::vector<Column> state_columns(const DriveSpec& drive) {
  std::vector<Column> columns;
  for (const std::string& name : trajectory_columns(drive)) columns.push_back(state_column(name));
  return columns;
}

std::vector<double> trajectory_times(const DriveSpec& drive) {
  std::vector<double> times;
  for (int i = 0; i <= drive.samples; ++i) times.push_back(drive.duration * i / drive.samples);
  return times;
}

MotionTable trajectory_table(const std::string& model, const ChannelLayout& layout,
                             const DriveSpec& drive) {
  MotionTable table;
  table.state_names = trajectory_columns(drive);
  table.results.name = model;
  table.results.channels = layout.channels();
  for (Channel& channel : motion_channels()) table.results.channels.push_back(std::move(channel));
  return table;
}

void append_trajectory_row(MotionTable& table, const std::vector<double>& state,
                           const std::vector<double>& row, const MotionChecks& checks) {
  ResultTable& results = table.results;
  table.states.insert(table.states.end(), state.begin(), state.end());
  results.theta_deg.push_back(state[1]);
  const std::size_t first = results.values.size();
  results.values.insert(results.values.end(), row.begin(), row.end());
  results.values.insert(results.values.end(),
                        {checks.tooth_law, checks.ring_power, checks.power_balance});
  for (std::size_t c = 0; c < results.columns(); ++c) {
    double& value = results.values[first + c];
    if (std::isinf(value) || is_stray_nan(value))
      throw ComputationError(results.name + " model: " + results.channels[c].name +
                             " is not finite at " + number_text(state[0]) + " s");
    value /= results.channels[c].unit_in_si;
  }
}

MotionTable teeth_table_of(const Trajectory& run, const Gear& gear) {
  MotionTable table{{"time_s"}, {}, teeth_table(run.table.results.name)};
  for (std::size_t row = 0; row < run.teeth.size(); ++row) {
    table.states.push_back(run.table.state(row, 0));
    append_teeth(table.results, run.table.results.theta_deg[row], gear, run.teeth[row]);
  }
  return table;
}

double start_speed(const DriveSpec& drive, double usual) {
  if (drive.kind == DriveKind::speed && !drive.curve.time.empty())
    return TimeSignal(drive.curve).value(0);
  return drive.start_speed.value_or(usual);
}

const DriveSpec& drive_of(const Case& the_case) {
  const auto refuse = [&](const std::string& why) {
    throw InputError((the_case.file.empty() ? "" : the_case.file.string() + ": ") + why);
  };
  if (!the_case.drive)
    refuse(
        "table [drive] is missing: a simulation needs a drive of the shaft and duration_s, as in "
        "cases/bap63_start_up.toml");
  const DriveSpec& drive = *the_case.drive;
  if (drive.start_speed && drive.kind == DriveKind::speed)
    refuse(
        "[drive] start_rpm: must be left out with kind = \"speed\", which says how the shaft turns "
        "from the start");
  if (drive.kind != DriveKind::speed && the_case.pump.friction.piston_coulomb > 0 &&
      the_case.pump.friction.regularization == 0)
    refuse(
        "[friction] regularization_m_per_s = 0: must be > 0 where the shaft may come to rest, "
        "which [drive] kind = \"" +
        std::string(drive.kind == DriveKind::torque ? "torque" : "motor") + "\" allows");
  return drive;
}

bool friction_jumps(const Case& the_case) {
  const bool free = (the_case.drive && the_case.drive->kind != DriveKind::speed) ||
                    the_case.pump.block_moves_freely();
  return free && the_case.pump.friction.piston_coulomb > 0 &&
         the_case.pump.friction.regularization == 0;
}

void require_smooth_friction(const Case& the_case) {
  if (friction_jumps(the_case))
    throw InputError((the_case.file.empty() ? "" : the_case.file.string() + ": ") +
                     "[friction] regularization_m_per_s = 0: must be > 0 where the oil follows the "
                     "motion or coordinates are independent: discontinuous friction cannot be "
                     "integrated there");
}

}  // namespace bentaxis
