#include "bentaxis/results/column.h"

#include <algorithm>

namespace bentaxis {

Column state_column(const std::string& name) {
  static const std::vector<Column> columns = {
      {"time_s", "time", "s"},
      {"theta_deg", "angle of the shaft, theta", "deg"},
      {"psi_deg", "angle of the block, psi", "deg"},
      {"shaft_rpm", "speed of the shaft", "rpm"},
      {"block_rpm", "speed of the block", "rpm"},
      {"motor_rpm", "speed of the motor's rotor", "rpm"},
      {"theta_rpm", "speed of the shaft", "rpm"},
      {"psi_rpm", "speed of the block", "rpm"},
      {"theta_rad_per_s2", "acceleration of the shaft", "rad/s2"},
      {"psi_rad_per_s2", "acceleration of the block", "rad/s2"},
      {"suction_bar", "pressure in the suction port, gauge", "bar"},
      {"delivery_bar", "pressure in the delivery port, gauge", "bar"}};
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const Column& column) { return column.name == name; });
  return found == columns.end() ? Column{name, ""} : *found;
}

}  // namespace bentaxis
