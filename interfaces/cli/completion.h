// What can follow on a command line, from what the parser knows; the scripts that make a shell ask.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "command_parser.h"

namespace bentaxis::cli {

/// What can stand in place of the last word.
struct Completion {
  enum class Kind { nothing, words, files, folders };
  Kind kind = Kind::nothing;
  std::vector<std::pair<std::string, std::string>> words;  ///< each with what it is
};

/// @param typed  the words after the program's name; the last, perhaps empty, is to be completed
Completion complete(const CommandInfo& program, const std::vector<std::string>& typed);

/// As the scripts read it: the kind, then a line per word, "WORD\tWHAT".
std::string completion_text(const Completion& completion);

/// Shells there are scripts for.
const std::vector<std::string>& completed_shells();
/// The script for one of them. It asks `bentaxis completion words` and knows no command itself.
std::string completion_script(const std::string& shell);

}  // namespace bentaxis::cli
