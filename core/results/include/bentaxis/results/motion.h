// Motion of shaft and block as an input, and results along it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis {

/// How shaft and block move at an instant. Angles do not wrap.
struct MotionState {
  double theta_deg = 0, psi_deg = 0;
  double shaft_speed = 0, block_speed = 0;                ///< rad/s
  double shaft_acceleration = 0, block_acceleration = 0;  ///< rad/s2
  PortPressures ports;                                    ///< Pa gauge
};

/// States of a pump, one per row.
struct States {
  int pistons = 0;
  std::vector<double> time;  ///< s, or empty
  std::vector<MotionState> motion;
  std::vector<double> chamber_pressure;  ///< row-major, one column per piston, Pa gauge
  std::vector<std::string> header;       ///< the columns they were given in
  std::vector<double> given;             ///< row-major, as given

  std::size_t rows() const { return motion.size(); }
  /// Copies a state into `instant`. Both angles are reduced by the same whole turns, exactly.
  /// @throws InputError where there is no such row
  void instant(std::size_t row, Instant& instant) const;
};

/// What a model finds at an instant beside a row of reactions, of pumps whose block moves on its
/// own.
struct MotionChecks {
  double tooth_law;      ///< N, force of the contact law, signed towards +psi; not_computed() where
                         ///< teeth are rigid
  double ring_power;     ///< W, of Rc on the play between piston and bore; 0 where it acts at B
  double power_balance;  ///< W, power of all loads less the change of kinetic energy: must vanish
};

/// The channels of MotionChecks, in their order: they stand behind those of a ChannelLayout.
std::vector<Channel> motion_channels();

/// Results along a motion: what each row was given or integrated to, and the results there.
struct MotionTable {
  std::vector<std::string> state_names;  ///< columns before the results, as in a file: "psi_deg"
  std::vector<double> states;            ///< row-major
  ResultTable results;                   ///< channels of a ChannelLayout and then motion_channels()

  double state(std::size_t row, std::size_t column) const {
    return states[row * state_names.size() + column];
  }
};

/// Computes the row of an instant, SI, in the order of a ChannelLayout, and the checks.
using EvaluateMotion =
    std::function<void(const Instant&, std::vector<double>& row, MotionChecks& checks)>;

/// Fills a table at given states, as tabulate() does along a turn.
/// @throws ComputationError naming model, channel and state where a value is not finite.
MotionTable tabulate_states(const std::string& name, const ChannelLayout& layout,
                            const States& states, const EvaluateMotion& evaluate,
                            const Progress& progress = {});

}  // namespace bentaxis
