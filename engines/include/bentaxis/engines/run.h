// Runs an engine on a mechanism: its module is found at run time and runs in a process of its own.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/engines/mechanism.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::engines {

/// Engines that the program has modules for, where their libraries are installed.
const std::vector<std::string>& known_engines();

/// Those of them whose modules are there.
std::vector<std::string> installed_engines();

/// What an engine says of a mechanism, or why it says nothing.
struct Answer {
  std::string failure;         ///< one line; "": there are values
  std::string text;            ///< engine, version and method
  std::vector<double> values;  ///< samples x (actions + supports), SI
  double residual = 0;         ///< largest share of what joints carry beyond their supports
  double seconds = 0;          ///< of the whole process
};

/// Whether an engine of this name is known, or there is a module of it.
bool is_engine(const std::string& name);

/// Looks for bentaxis_engine_NAME.so in the folders of BENTAXIS_ENGINE_PATH (parted by colons),
/// then where the program's modules are. An engine that crashes or does not end in ten minutes ends
/// nothing else.
/// @throws what `progress` throws; the engine is then ended
Answer run_engine(const std::string& name, const Mechanism& mechanism, const Progress& progress);

}  // namespace bentaxis::engines
