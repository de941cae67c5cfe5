// All commands, in the groups in which the help text lists them.
#pragma once

#include <vector>

#include "commands.h"

namespace bentaxis::cli {

/// Adds every command to the program, with its group, its example and the former names of options.
std::vector<Command> add_commands(ProgramParser& program);

}  // namespace bentaxis::cli
