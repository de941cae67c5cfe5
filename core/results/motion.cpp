#include "bentaxis/results/motion.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {

void States::instant(std::size_t row, Instant& instant) const {
  if (row >= motion.size() || (row + 1) * pistons > chamber_pressure.size())
    throw InputError("states: row " + std::to_string(row + 1) + " of " +
                     std::to_string(motion.size()) + " states and " +
                     std::to_string(chamber_pressure.size()) + " chamber pressures of " +
                     std::to_string(pistons) + " pistons");
  const MotionState& state = motion[row];
  const double theta_deg = std::fmod(state.theta_deg, 360.0);
  const double turns_deg = state.theta_deg - theta_deg;
  instant.shaft = {radians(theta_deg), state.shaft_speed, state.shaft_acceleration};
  instant.block = {radians(state.psi_deg - turns_deg), state.block_speed, state.block_acceleration};
  instant.ports = state.ports;
  const auto first = chamber_pressure.begin() + static_cast<std::ptrdiff_t>(row) * pistons;
  instant.chamber_pressure.assign(first, first + pistons);
}

std::vector<Channel> motion_channels() {
  const auto channel = [](const std::string& name, const std::string& meaning,
                          const std::string& unit, ChannelKind kind) {
    Channel c;
    c.quantity = name;
    c.name = name + "_" + unit;
    c.meaning = meaning;
    c.unit = unit;
    c.group = name;
    c.kind = kind;
    return c;
  };
  Channel law = channel("Rcs_law", "force that the contact law of the teeth gives at this approach",
                        "N", ChannelKind::derived);
  law.on_body = "block";
  law.by_body = "shaft";
  law.point = "O4";
  Channel ring = channel("ring_power",
                         "power of the bore forces on the play between pistons and bores, where "
                         "they do not act at B",
                         "W", ChannelKind::derived);
  ring.on_body = "pistons";
  ring.by_body = "block";
  Channel balance = channel("power_balance", "power of all loads less the change of kinetic energy",
                            "W", ChannelKind::check);
  balance.on_body = "pump";
  return {law, ring, balance};
}

MotionTable tabulate_states(const std::string& name, const ChannelLayout& layout,
                            const States& states, const EvaluateMotion& evaluate,
                            const Progress& progress) {
  MotionTable table;
  table.state_names = states.header;
  table.states = states.given;
  ResultTable& results = table.results;
  results.name = name;
  results.channels = layout.channels();
  for (Channel& channel : motion_channels()) results.channels.push_back(std::move(channel));
  Instant instant;
  std::vector<double> row;
  for (std::size_t i = 0; i < states.rows(); ++i) {
    states.instant(i, instant);
    row.assign(layout.size(), not_computed());
    MotionChecks checks{not_computed(), not_computed(), not_computed()};
    evaluate(instant, row, checks);
    row.insert(row.end(), {checks.tooth_law, checks.ring_power, checks.power_balance});
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (std::isinf(row[c]) || is_stray_nan(row[c]))
        throw ComputationError(name + " model: " + results.channels[c].name +
                               " is not finite in state " + std::to_string(i + 1));
      row[c] /= results.channels[c].unit_in_si;
    }
    results.theta_deg.push_back(states.motion[i].theta_deg);
    results.values.insert(results.values.end(), row.begin(), row.end());
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(states.rows()));
  }
  return table;
}

}  // namespace bentaxis
