// What is done to texts everywhere.
#pragma once

#include <string>
#include <string_view>

namespace bentaxis {

/// A text without the blanks at both its ends.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r\n");
/// A text with the letters of ASCII in lower case.
std::string lower_case(std::string_view text);
/// A text with every `from` as `to`, from left to right; what was put in is not looked at again.
std::string replace_all(std::string text, std::string_view from, std::string_view to);
/// " Nm" behind a number; "" where there is no unit.
std::string unit_after(const std::string& unit);

}  // namespace bentaxis
