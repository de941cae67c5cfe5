#include "plain_text.h"

namespace bentaxis::fmu {
namespace {

unsigned char byte_of(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

// Bytes of the character that begins here (RFC 3629); 0: there is none.
std::size_t character_at(std::string_view text, std::size_t at) {
  const unsigned first = byte_of(text, at);
  if (first < 0x80) return 1;
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte_of(text, at + i) & 0xC0U) != 0x80) return 0;
  const unsigned second = byte_of(text, at + 1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool beyond = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || beyond ? 0 : size;
}

bool is_control(std::string_view text, std::size_t at) {
  const unsigned first = byte_of(text, at);
  return first < ' ' || first == 0x7F || (first == 0xC2 && byte_of(text, at + 1) < 0xA0);
}

}  // namespace

std::string plain_text(std::string_view text, std::size_t most) {
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_at(text, at);
    const std::string_view character = text.substr(at, size);
    if (plain.size() + (size == 0 ? 1 : size) > most) {
      plain += "..";
      break;
    }
    if (size == 0)
      plain += '?';
    else if (is_control(text, at))
      plain += ' ';
    else
      plain += character;
    at += size == 0 ? 1 : size;
  }
  while (!plain.empty() && plain.back() == ' ') plain.pop_back();
  return plain;
}

}  // namespace bentaxis::fmu
