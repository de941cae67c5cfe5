#include "bentaxis/pump/csv.h"

// Single-threaded reading keeps the library free of threads it does not need.
#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/result_table.h"

namespace bentaxis {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

NumericTable read_numeric_csv(const std::filesystem::path& file, bool allow_empty) {
  if (std::filesystem::is_directory(file))
    throw InputError(file.string() + ": is a folder, not a CSV file");
  NumericTable table;
  try {
    io::LineReader reader(file.string());
    while (char* text = reader.next_line()) {
      const std::string where = file.string() + ":" + std::to_string(reader.get_file_line());
      if (trimmed(text).empty()) continue;
      const auto fields = split(text);
      if (table.header.empty()) {
        table.header.assign(fields.begin(), fields.end());
        continue;
      }
      if (fields.size() != table.header.size())
        throw InputError(where + ": " + std::to_string(fields.size()) + " fields, the header has " +
                         std::to_string(table.header.size()));
      std::vector<double> row;
      row.reserve(fields.size());
      for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto field = fields[i];
        double value = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (field.empty() && allow_empty) {
          value = not_computed();
        } else if (error != std::errc() || end != field.data() + field.size() ||
                   !std::isfinite(value)) {
          throw InputError(where + ": " + table.header[i] + " = \"" + std::string(field) +
                           "\": must be a finite number");
        }
        row.push_back(value);
      }
      table.rows.push_back(std::move(row));
      table.lines.push_back(reader.get_file_line());
    }
  } catch (const io::error::base& error) {
    std::string what = error.what();
    while (!what.empty() && (what.back() == '\n' || what.back() == '.')) what.pop_back();
    throw InputError(file.string() + ": cannot be read: " + what);
  }
  if (table.header.empty()) throw InputError(file.string() + ": is empty");
  return table;
}

void append_number(std::string& text, double value) {
  if (!is_computed(value)) return;
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                    value == 0 ? 0.0 : value);  // no "-0"
  text.append(buffer.data(), result.ptr);
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

}  // namespace bentaxis
