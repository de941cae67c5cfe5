// Characters of texts that come from outside.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bentaxis {

/// Whether a text holds control characters: of ASCII, NUL among them, or of Unicode (U+0080 to
/// U+009F, in UTF-8). A terminal may act on them.
/// @param spaces  tab, line feed and carriage return count too
bool has_control_characters(const std::string& text, bool spaces);

/// A text with its control characters as `\u001B`, on one line. What stands for no character is
/// escaped where a terminal could take it for a control character.
/// @param spaces  tab and line feed are escaped too
std::string without_control_characters(const std::string& text, bool spaces = true);

/// One line of UTF-8: control characters become spaces, bytes that are no UTF-8 question marks.
/// @param most  bytes; longer text is cut between characters and ends in ".."
std::string plain_text(std::string_view text, std::size_t most);

/// Whether a text is valid UTF-8.
bool is_utf8(const std::string& text);
/// A text in Windows-1252, which is Latin-1 and more, in UTF-8.
std::string utf8_of_windows_1252(const std::string& text);

}  // namespace bentaxis
