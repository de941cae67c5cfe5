// The two ways a request can fail. The command line maps them to exit statuses 2 and 3.
#pragma once

#include <stdexcept>
#include <string>

namespace bentaxis {

/// The input (case file, curve, option, path) cannot be used. The text is one line that names the
/// file, the line or key, the value and the allowed range. Exit status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A computation on valid input failed. The text says which model, where in the turn, and why.
/// Exit status 3.
class ComputationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user asked to stop (Ctrl-C). Nothing is left half-written.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace bentaxis
