// The two ways a request can fail. The command line maps them to exit statuses 2 and 3.
#pragma once

#include <stdexcept>
#include <string>

#include "bentaxis/pump/characters.h"

namespace bentaxis {

/// The input (case file, curve, option, path) cannot be used. The text is one line that names the
/// file, the line or key, the value and the allowed range. Exit status 2. Control characters of
/// what it quotes are escaped.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& text)
      : std::runtime_error(without_control_characters(text)) {}
};

/// A computation on valid input failed. The text says which model, where in the turn, and why.
/// Exit status 3. Control characters are escaped too.
class ComputationError : public std::runtime_error {
 public:
  explicit ComputationError(const std::string& text)
      : std::runtime_error(without_control_characters(text)) {}
};

/// The user asked to stop (Ctrl-C). Nothing is left half-written.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace bentaxis
