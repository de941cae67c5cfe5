// Sections of a report, put together piece by piece.
#pragma once

#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

using Row = std::vector<Cell>;

/// A cell of any value: counts of every type are counts, and what an optional lacks is no value.
template <class Value>
Cell cell_of(const Value& value) {
  if constexpr (std::is_same_v<Value, Cell> || std::is_same_v<Value, bool> ||
                std::is_floating_point_v<Value>)
    return value;
  else if constexpr (std::is_integral_v<Value>)
    return static_cast<long>(value);
  else if constexpr (std::is_convertible_v<const Value&, std::string>)
    return std::string(value);
  else
    return value ? cell_of(*value) : Cell();
}

template <class Value>
void add_cells(Row& row, const Value& value) {
  constexpr bool kList = requires { value.begin(); };
  if constexpr (kList && !std::is_convertible_v<const Value&, std::string>)
    for (const auto& one : value) row.push_back(cell_of(one));
  else
    row.push_back(cell_of(value));
}

/// Cells of values, and of lists of values, behind each other.
template <class... Values>
Row row_of(const Values&... values) {
  Row row;
  (add_cells(row, values), ...);
  return row;
}

/// A section that gets its columns, rows and facts one after the other.
struct NewSection : Section {
  explicit NewSection(std::string section_title, std::string section_text = {}) {
    title = std::move(section_title);
    text = std::move(section_text);
  }

  /// Names of further columns, and lists of names.
  template <class... Names>
  void columns(const Names&... names) {
    (add_columns(names), ...);
  }
  /// A row of the table; what it lacks at its end is empty.
  template <class... Values>
  void row(const Values&... values) {
    table.rows.push_back(row_of(values...));
    if (table.rows.back().size() < table.columns.size())
      table.rows.back().resize(table.columns.size());
  }
  void fact(std::string name, std::string value) {
    facts.emplace_back(std::move(name), std::move(value));
  }
  /// @param value  as fmt::format has it, with its arguments
  template <class First, class... More>
  void fact(std::string name, fmt::format_string<First, More...> value, First&& first,
            More&&... more) {
    fact(std::move(name),
         fmt::format(value, std::forward<First>(first), std::forward<More>(more)...));
  }
  /// Further sentences of the text, likewise.
  void say(const std::string& sentences) { text += (text.empty() ? "" : " ") + sentences; }
  template <class First, class... More>
  void say(fmt::format_string<First, More...> sentences, First&& first, More&&... more) {
    say(fmt::format(sentences, std::forward<First>(first), std::forward<More>(more)...));
  }

 private:
  void add_columns(const std::string& name) { table.columns.push_back(name); }
  void add_columns(const std::vector<std::string>& names) {
    for (const std::string& name : names) table.columns.push_back(name);
  }
};

}  // namespace bentaxis::report
