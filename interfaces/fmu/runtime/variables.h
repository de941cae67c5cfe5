// The variables of a unit: one list, from which its description is written and by which it answers.
// Internal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bentaxis/fmu/unit.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/surroundings.h"

namespace bentaxis::fmu {

enum class Causality { independent, parameter, input, output, local };
enum class Variability { fixed, tunable, discrete, continuous };

/// What a variable stands for in the plant.
enum class Role {
  time,
  parameter,   ///< number of the registry; `table`, `key`, `place` (0, or 1: second of a pair)
  input,       ///< `input`
  state,       ///< index of a continuous state, `place`
  derivative,  ///< of that state
  output,      ///< place in Plant::outputs()
  flag,        ///< place in Plant::flags(); Boolean
  indicator,   ///< event indicator `place` (FMI 3 lists them)
};
enum class Input {
  speed,
  acceleration,
  torque,
  suction,
  delivery,
  load_share,
  load_share_replaces_curve  ///< Boolean
};

struct Variable {
  std::uint32_t reference = 0;
  std::string name;         ///< "pump.tilt_deg", "drive_speed", "Td_Nm", "state.shaft_angle"
  std::string description;  ///< with body, acting body, point, frame where it is a reaction
  std::string unit;  ///< as files and CSVs name it: "mm", "bar", "Nm", "rad/s"; "" or "-": none
  Causality causality = Causality::output;
  Variability variability = Variability::continuous;
  bool boolean = false;
  std::optional<double> start;  ///< parameters, inputs, states: in `unit`; flags: 0 or 1
  std::optional<double> least,
      most;  ///< range, of parameters; bounds that are excluded are left out
  std::optional<double> nominal;
  std::optional<std::uint32_t> state;  ///< of a derivative: reference of its state
  Role role = Role::output;
  Input input = Input::speed;
  std::string table, key;
  std::size_t place = 0;
};

/// Whether it can be read, an input also set, while a step of co-simulation is computed (FMI 3).
inline bool has_intermediate_values(const Variable& it) {
  return !it.boolean && (it.role == Role::input || it.role == Role::output);
}

/// What a unit is besides its case: kept beside it, in resources/unit.txt, "key value" per line.
struct UnitChoice {
  Drive drive = Drive::speed;
  double tolerance = 1e-9;  ///< of a step of co-simulation, as in coupled::Options
  /// Nm, start value of the input drive_torque; without it: that of the case, or 0.
  std::optional<double> start_torque = {};
  bool si_outputs = false;  ///< as in UnitOptions
};

/// All variables of a unit, `reference` rising from 0 and equal to the place in the list. The same
/// case and choice give the same list: the description and the library agree because both ask here.
/// @throws InputError where the case cannot be simulated so
std::vector<Variable> variables_of(const Case& the_case, const UnitChoice& choice);

/// The case with values of its parameters, by reference and in their units.
/// @throws InputError where a file that says the same would be refused
Case case_with(Case the_case, const std::vector<Variable>& variables,
               const std::vector<double>& values);

/// The least gauge pressure that an input may have, Pa: 1 Pa absolute.
double least_pressure(const Case& the_case);

/// The case with its [drive] as the choice has it: a unit of a case without [drive] starts at the
/// speed of [operation].
Case with_drive(Case the_case, Drive drive);

}  // namespace bentaxis::fmu
