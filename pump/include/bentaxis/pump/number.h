// Numbers as text, and the value of what was not computed.
#pragma once

#include <string>

namespace bentaxis {

/// Marks a value that a run did not compute: an empty field in a file, never 0. A NaN with a bit
/// pattern of its own, so that a NaN that arithmetic produced by mistake is told apart from it.
double not_computed();
inline bool is_computed(double value) { return value == value; }
/// Whether a value is a NaN that arithmetic produced.
bool is_stray_nan(double value);

/// Appends the shortest text that reads back to the same double; nothing where not computed.
void append_number(std::string& text, double value);

/// The same as a string of its own.
std::string number_text(double value);

}  // namespace bentaxis
