#include "bentaxis/pump/characters.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string_view>

namespace bentaxis {
namespace {

// The next character of a text in UTF-8: its code and its length in bytes; length 0 where it is no
// valid one.
struct Character {
  std::uint32_t code = 0;
  std::size_t length = 0;
};

Character character_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(at);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || at + length > text.size()) return {};
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte(at + i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kFirstOfLength = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kFirstOfLength[length] || surrogate || code > 0x10FFFF) return {};
  return {code, length};
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

void append_utf8(std::string& out, std::uint32_t code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0U | code >> 6U);
    out += static_cast<char>(0x80U | (code & 0x3FU));
  } else {
    out += static_cast<char>(0xE0U | code >> 12U);
    out += static_cast<char>(0x80U | (code >> 6U & 0x3FU));
    out += static_cast<char>(0x80U | (code & 0x3FU));
  }
}

}  // namespace

bool has_control_characters(const std::string& text, bool spaces) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    const bool space = c.code == '\t' || c.code == '\n' || c.code == '\r';
    if (c.length > 0 && is_control(c.code) && (spaces || !space)) return true;
    at += std::max<std::size_t>(c.length, 1);
  }
  return false;
}

std::string without_control_characters(const std::string& text, bool spaces) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    const bool space = c.code == '\t' || c.code == '\n';
    if (c.length > 0 && is_control(c.code) && (spaces || !space)) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\u%04X", c.code);
      out += escaped;
    } else if (c.length == 0 && static_cast<unsigned char>(text[at]) < 0xA0) {
      // Some terminals take such a byte by itself for a control character.
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\x%02X", static_cast<unsigned char>(text[at]));
      out += escaped;
    } else {
      out.append(text, at, std::max<std::size_t>(c.length, 1));
    }
    at += std::max<std::size_t>(c.length, 1);
  }
  return out;
}

std::string plain_text(std::string_view text, std::size_t most) {
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    const std::size_t length = std::max<std::size_t>(c.length, 1);
    if (plain.size() + length > most) {
      plain += "..";
      break;
    }
    if (c.length == 0)
      plain += '?';
    else if (is_control(c.code))
      plain += ' ';
    else
      plain += text.substr(at, length);
    at += length;
  }
  while (!plain.empty() && plain.back() == ' ') plain.pop_back();
  return plain;
}

bool is_utf8(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    if (c.length == 0) return false;
    at += c.length;
  }
  return true;
}

std::string utf8_of_windows_1252(const std::string& text) {
  // Of the bytes 0x80 to 0x9F; 0: stands for none.
  constexpr std::array<std::uint32_t, 32> kMiddle = {
      0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};
  constexpr std::uint32_t kReplacement = 0xFFFD;
  std::string out;
  for (const char c : text) {
    std::uint32_t code = static_cast<unsigned char>(c);
    if (code >= 0x80 && code < 0xA0) code = kMiddle[code - 0x80];
    append_utf8(out, code == 0 && c != '\0' ? kReplacement : code);
  }
  return out;
}

}  // namespace bentaxis
