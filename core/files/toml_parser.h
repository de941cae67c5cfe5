// The one place where TOML is parsed. Internal.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace bentaxis {

/// What is wrong with a text, and in which line; 0: with all of it.
struct TomlRefusal {
  std::size_t line;
  std::string why;
};

/// A message shows no more of a value than this, in bytes.
inline constexpr std::size_t kShownOfValue = 80;

/// @param file  for the parser's messages
/// @throws TomlRefusal where the text is nested too deeply, too long or holds control characters;
///         toml::parse_error
toml::table parsed_toml(const std::string& text, const std::string& file);

/// An editor's way of writing text that TOML does not know. @throws TomlRefusal
void check_toml_encoding(const std::string& text);

/// What is wrong with a line that TOML refuses, where it is a decimal comma or a word without
/// quotes; else empty.
std::string slip_in(const std::string& text, std::size_t line);

}  // namespace bentaxis
