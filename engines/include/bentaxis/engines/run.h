// Runs an engine on a mechanism: its module is found at run time and runs in a process of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/engines/mechanism.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::engines {

/// Engines that the program has modules for, where their libraries are installed.
const std::vector<std::string>& known_engines();

/// Those of them whose modules are there.
std::vector<std::string> installed_engines();

/// Integration by an engine: from the first state on, a step from a state to the one after the
/// next, at the loads of the states.
struct Integrated {
  double interval = 0;   ///< time between two states, s
  int first = 0;         ///< state of the first result; the ones before let joints settle
  int every = 2;         ///< states from result to result
  std::string settings;  ///< "NAME=VALUE NAME=VALUE" of the engine; "": its defaults
};

/// What an engine says of a mechanism, or why it says nothing.
struct Answer {
  std::string failure;         ///< one line; "": there are values
  std::string text;            ///< engine, version and method
  std::vector<double> values;  ///< results x (actions + supports), SI
  double residual = 0;         ///< largest share of what joints carry beyond their supports
  double seconds = 0;          ///< of the whole process
  double turn_seconds = 0;     ///< integrated: of the steps from the first result on
};

/// A setting that an engine has where it integrates.
struct Setting {
  std::string name;
  std::vector<std::string> values;  ///< the default, then those of a sweep
  std::string least, most;          ///< of a number; "": not told
  bool is_integer = false;

  /// @return what a value must be where it is not allowed: "a number in [0, 1]"; else ""
  std::string refusal(const std::string& value) const;
};

/// Whether an engine of this name is known, or there is a module of it.
bool is_engine(const std::string& name);

/// Looks for bentaxis_engine_NAME.so in the folders of BENTAXIS_ENGINE_PATH (parted by colons),
/// then where the program's modules are. An engine that crashes or does not end in ten minutes ends
/// nothing else.
/// @param integrated  nothing: inverse dynamics at the motion of the states
/// @throws what `progress` throws; the engine is then ended
Answer run_engine(const std::string& name, const Mechanism& mechanism, const Progress& progress,
                  const std::optional<Integrated>& integrated = {});

/// The settings of an engine; none where it cannot be asked.
std::vector<Setting> settings_of(const std::string& name);

}  // namespace bentaxis::engines
