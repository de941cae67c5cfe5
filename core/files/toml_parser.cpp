#include "toml_parser.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/words.h"

namespace bentaxis {
namespace {

// Tables and lists below each other. What reads, prints or frees them calls itself for each level.
constexpr int kDeepest = 32;
// Entries of a list, and keys of a table.
constexpr std::size_t kLongestList = 10000;

// The parser makes a level of each part of a dotted key and of each bracket, however many there
// are: they are counted before it reads. What is no TOML at all is left to the parser.
class Depth {
 public:
  explicit Depth(std::string_view text) : text_(text) {}

  // The first line that is too deep; 0 where none is.
  std::size_t line_too_deep() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (c == '"' || c == '\'') {
        skip_text(c);
        continue;
      }
      if (c == '\n') ++line_;
      if (c == '.') ++dots_;
      if (c == '[' || c == '{') {
        outside_.push_back(dots_);
        ++depth_of_outside_;
        depth_of_outside_ += dots_;
        dots_ = 0;
      } else if ((c == ']' || c == '}') && !outside_.empty()) {
        dots_ = outside_.back();
        depth_of_outside_ -= dots_ + 1;
        outside_.pop_back();
      } else if (c == ',' || c == '\n') {
        dots_ = 0;
      }
      if (depth_of_outside_ + dots_ > kDeepest) return line_;
      ++at_;
    }
    return 0;
  }

 private:
  // To behind a text in quotes, of one line or of several.
  void skip_text(char quote) {
    const std::string three(3, quote);
    const bool several_lines = text_.substr(at_, 3) == three;
    at_ += several_lines ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') {
        if (!several_lines) return;  // the parser refuses it
        ++line_;
      }
      if (text_[at_] == '\\' && quote == '"') {
        ++at_;
        if (at_ < text_.size() && text_[at_] == '\n') ++line_;
      } else if (several_lines ? text_.substr(at_, 3) == three : text_[at_] == quote) {
        at_ += several_lines ? 3 : 1;
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
  int dots_ = 0, depth_of_outside_ = 0;
  std::vector<int> outside_;
};

void check_text(const std::string& text, std::size_t line, const char* what) {
  if (has_control_characters(text, false))
    throw TomlRefusal{line, std::string(what) + " " + toml_text(text).substr(0, kShownOfValue) +
                                " holds a control character"};
}

void check_node(const toml::node& node, int depth) {
  const std::size_t line = node.source().begin.line;
  if (depth > kDeepest)
    throw TomlRefusal{
        line, "tables and lists are nested more than " + std::to_string(kDeepest) + " levels deep"};
  const auto check_length = [&](const char* what, std::size_t size) {
    if (size > kLongestList)
      throw TomlRefusal{line, std::string(what) + " of " + std::to_string(size) +
                                  " entries: must have at most " + std::to_string(kLongestList)};
  };
  if (const toml::table* const table = node.as_table(); table != nullptr) {
    check_length("a table", table->size());
    for (const auto& [key, below] : *table) {
      check_text(std::string(key.str()), below.source().begin.line, "the key");
      check_node(below, depth + 1);
    }
  } else if (const toml::array* const array = node.as_array(); array != nullptr) {
    check_length("a list", array->size());
    for (const toml::node& below : *array) check_node(below, depth + 1);
  } else if (const auto* const text = node.as_string(); text != nullptr) {
    check_text(text->get(), line, "the text");
  }
}

}  // namespace

toml::table parsed_toml(const std::string& text, const std::string& file) {
  if (const std::size_t line = Depth(text).line_too_deep(); line > 0)
    throw TomlRefusal{line, "keys, tables or lists are nested more than " +
                                std::to_string(kDeepest) + " levels deep"};
  toml::table table = toml::parse(text, file);
  check_node(table, 0);
  return table;
}

void check_toml_encoding(const std::string& text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw TomlRefusal{0, "is in UTF-16: save it as UTF-8"};
  if (text.find('\n') == std::string::npos && text.find('\r') != std::string::npos)
    throw TomlRefusal{
        0, "its lines end with a carriage return alone: save it with line feeds (LF or CR LF)"};
  if (is_utf8(text)) return;
  std::size_t line = 1;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1, ++line) {
    end = text.find('\n', at);
    if (!is_utf8(text.substr(at, end - at)))
      throw TomlRefusal{
          line,
          "a letter that is not in UTF-8, as one of Latin-1 or Windows-1252: save the "
          "file as UTF-8"};
  }
}

std::string slip_in(const std::string& text, std::size_t line) {
  std::istringstream lines(text);
  std::string found;
  for (std::size_t i = 0; i < line; ++i) std::getline(lines, found);
  const std::size_t start = found.find_first_not_of(" \t", found.find('=') + 1);
  if (found.find('=') == std::string::npos || start == std::string::npos) return "";
  const std::string value = found.substr(start, found.find_first_of(" \t\r#", start) - start);
  const std::string hint = decimal_point_hint(value);
  if (!hint.empty()) return one_line(found.substr(0, start) + value) + hint;
  const auto in_a_word = [](unsigned char letter) { return std::isalnum(letter) || letter == '_'; };
  if (value.empty() || !std::isalpha(static_cast<unsigned char>(value.front())) ||
      !std::all_of(value.begin(), value.end(), in_a_word))
    return "";
  return one_line(found.substr(0, start) + value) + "; words need quotes: \"" + value + "\"";
}

}  // namespace bentaxis
