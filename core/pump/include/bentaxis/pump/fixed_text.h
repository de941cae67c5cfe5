// Numbers with a fixed number of decimals, for tables that people read.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace bentaxis {

/// A number with so many decimals. What rounds to 0 has no sign: "0.00", never "-0.00".
/// @param signs  "+" before a positive number too
inline std::string fixed_text(double value, int decimals, bool signs = false) {
  std::array<char, 400> buffer;  // more digits than any double has before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals);
  std::string text(buffer.data(), end.ptr);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  if (zero && text.front() == '-') text.erase(0, 1);
  return signs && !zero && value > 0 ? "+" + text : text;
}

}  // namespace bentaxis
