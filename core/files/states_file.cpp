// The motion of another simulator or a rig: states of shaft and block, with pressures.
#include <cmath>
#include <map>
#include <set>

#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/joint.h"
#include "refused_value.h"

namespace bentaxis {
namespace {

// The columns that say how shaft and block move, in the order of their use.
constexpr const char* kMotionColumns[] = {"theta_deg", "psi_deg",          "theta_rpm",
                                          "psi_rpm",   "theta_rad_per_s2", "psi_rad_per_s2"};

}  // namespace

States read_states(const std::filesystem::path& file, const Case& the_case,
                   const PressureTrace& pressure) {
  return states_of(read_numeric_csv(file), file, file.string() + ":1", the_case, pressure);
}

States states_of(const NumericTable& table, const std::filesystem::path& file,
                 const std::string& head, const Case& the_case, const PressureTrace& pressure) {
  const int pistons = the_case.pump.geometry.pistons;
  std::map<std::string, std::size_t> columns;
  std::set<std::string> known(std::begin(kMotionColumns), std::end(kMotionColumns));
  known.insert({"time_s", "suction_bar", "delivery_bar"});
  const auto chamber = [](int k) { return "p_" + std::to_string(k + 1) + "_bar"; };
  for (int k = 0; k < pistons; ++k) known.insert(chamber(k));
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const std::string& name = table.header[c];
    if (known.count(name) == 0)
      throw InputError(head + ": unknown column \"" + name + "\"" + suggestion(name, known));
    if (!columns.emplace(name, c).second)
      throw InputError(head + ": column \"" + name + "\" is a duplicate column");
  }
  const auto has = [&](const std::string& name) { return columns.count(name) > 0; };
  const auto require = [&](const std::string& name) {
    if (!has(name)) throw InputError(head + ": column \"" + name + "\" is missing");
  };
  // A joint says how the block moves: its columns may be left out, all of them.
  const bool joint = the_case.pump.transfer.is_joint();
  const bool block_given = !joint || has("psi_deg") || has("psi_rpm") || has("psi_rad_per_s2");
  for (const char* const name : kMotionColumns)
    if (block_given || std::string(name).rfind("psi_", 0) != 0) require(name);
  const bool pressures = has(chamber(0));
  for (int k = 0; k < pistons; ++k)
    if (has(chamber(k)) || pressures) {
      require(chamber(0));
      require(chamber(k));
    }
  if (table.rows.empty()) throw InputError(file.string() + ": has no states");

  States states;
  states.pistons = pistons;
  states.header = table.header;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    const auto at = [&](const std::string& name) { return row[columns.at(name)]; };
    states.given.insert(states.given.end(), row.begin(), row.end());
    if (has("time_s")) {
      if (i > 0 && at("time_s") < states.time.back())
        refuse_value(file, table, i, columns.at("time_s"),
                     ">= " + number_text(states.time.back()) + " (times must not decrease)");
      states.time.push_back(at("time_s"));
    }
    MotionState state;
    state.theta_deg = at("theta_deg");
    state.shaft_speed = rad_per_second(at("theta_rpm"));
    state.shaft_acceleration = at("theta_rad_per_s2");
    if (block_given) {
      state.psi_deg = at("psi_deg");
      state.block_speed = rad_per_second(at("psi_rpm"));
      state.block_acceleration = at("psi_rad_per_s2");
    }
    if (joint) {
      // The lead alone keeps its digits over many turns.
      const double turned = std::fmod(state.theta_deg, 360.0);
      const AxisMotion block = joint_motion(
          the_case.pump, {radians(turned), state.shaft_speed, state.shaft_acceleration});
      MotionState law = state;
      law.psi_deg = the_case.pump.transfer.is_even()
                        ? state.theta_deg
                        : state.theta_deg + (block.angle - radians(turned)) / kRadPerDegree;
      law.block_speed = block.speed;
      law.block_acceleration = block.acceleration;
      constexpr double kMatch = 1e-9;  // deg, and of the shaft's rates
      const auto hold = [&](const char* name, double given, double wanted, double unit,
                            double tolerance) {
        if (block_given && !(std::abs(given - wanted) <= tolerance))
          refuse_value(file, table, i, columns.at(name),
                       number_text(wanted / unit) + ", as [transfer] kind = \"" +
                           to_string(the_case.pump.transfer.kind) + "\" turns the block");
      };
      hold("psi_deg", state.psi_deg, law.psi_deg, 1, kMatch);
      hold("psi_rpm", state.block_speed, law.block_speed, kRadPerSecondPerRpm,
           kMatch * std::abs(state.shaft_speed));
      hold("psi_rad_per_s2", state.block_acceleration, law.block_acceleration, 1,
           kMatch * (std::abs(state.shaft_acceleration) + state.shaft_speed * state.shaft_speed));
      state = law;
    }
    const Geometry& geometry = the_case.pump.geometry;
    for (int k = 0; k < pistons; ++k) {
      const double phase = 360.0 * k / pistons;
      const double needed = joint_distance(geometry, radians(state.theta_deg - phase),
                                           radians(state.psi_deg - phase));
      if (!(needed < geometry.piston_length))
        refuse_value(file, table, i, columns.at(block_given ? "psi_deg" : "theta_deg"),
                     "closer to theta_deg = " + number_text(state.theta_deg) +
                         ": the pump cannot be assembled, piston " + std::to_string(k + 1) +
                         " would have to be longer than " + number_text(needed * 1e3) + " mm");
    }
    state.ports = the_case.pressure.ports;
    if (has("suction_bar")) state.ports.suction = pascals(at("suction_bar"));
    if (has("delivery_bar")) state.ports.delivery = pascals(at("delivery_bar"));
    states.motion.push_back(state);
    for (int k = 0; k < pistons; ++k)
      states.chamber_pressure.push_back(
          pressures ? pascals(at(chamber(k)))
                    : pressure(piston_angle_deg(state.psi_deg, k + 1, pistons)));
  }
  return states;
}

}  // namespace bentaxis
