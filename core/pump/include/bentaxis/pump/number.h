// Numbers as text, and the value of what was not computed.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace bentaxis {

/// Marks a value that a run did not compute: an empty field in a file, never 0. A NaN with a bit
/// pattern of its own, so that a NaN that arithmetic produced by mistake is told apart from it.
double not_computed();
inline bool is_computed(double value) { return value == value; }
/// Whether a value is a NaN that arithmetic produced.
bool is_stray_nan(double value);

/// The finite number that a text is, as written in files and on command lines, and nothing else.
std::optional<double> number_in(std::string_view text);

/// Appends the shortest text that reads back to the same double; nothing where not computed.
void append_number(std::string& text, double value);

/// The same as a string of its own.
std::string number_text(double value);

/// The nearest number of so many significant decimal digits.
double rounded(double value, int digits);

/// To so many significant digits, for people. No locale of the process changes it.
std::string rounded_text(double value, int digits = 3);
/// The same on the allowed side of a limit: not above `value`, not below it.
std::string rounded_down_text(double value);
std::string rounded_up_text(double value);

/// Allowed values of a number, with the text an engineer sees when it is left. What is not finite
/// lies in no range.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  double slack = 0;  ///< of itself, by which a closed bound may be left

  bool contains(double value) const;
  std::string text() const;  ///< "in [0, 90)"
  /// "a number, in [0, 90)"; "a finite number" where any is allowed.
  std::string text_of(const std::string& kind) const;
};
inline constexpr NumberRange kAny{};
inline constexpr NumberRange kPositive{0, std::numeric_limits<double>::infinity(), true};
inline constexpr NumberRange kNotNegative{0, std::numeric_limits<double>::infinity()};

}  // namespace bentaxis
