// CSV files as they are written: a heading, and rows of fields of any kind.
#pragma once

#include <concepts>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bentaxis/files/csv.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {

/// A field that is in quotation marks whatever it says.
struct Quoted {
  std::string text;
};

/// CSV text, row by row: numbers with all digits, what was not computed as an empty field.
class CsvRows {
 public:
  CsvRows() = default;
  /// @param header  its first line
  explicit CsvRows(const std::string& header) : text_(header + "\n") {}

  template <class... Fields>
  void row(const Fields&... fields) {
    (add(fields), ...);
    text_.back() = '\n';
  }
  std::string text() && { return std::move(text_); }

 private:
  void add(double value) {
    append_number(text_, value);
    text_ += ',';
  }
  void add(std::integral auto count) { text_ += std::to_string(count) + ','; }
  void add(const std::string& text) { text_ += csv_text(text) + ','; }
  void add(const char* text) { add(std::string(text)); }
  void add(const Quoted& field) {
    text_ += '"';
    for (const char letter : field.text) text_ += letter == '"' ? "\"\"" : std::string(1, letter);
    text_ += "\",";
  }
  template <class Field>
  void add(const std::vector<Field>& fields) {
    for (const Field& field : fields) add(field);
  }
  template <class... Kinds>
  void add(const std::variant<Kinds...>& cell) {
    std::visit([this](const auto& value) { add(value); }, cell);
  }
  void add(std::monostate) { text_ += ','; }

  std::string text_;
};

}  // namespace bentaxis
