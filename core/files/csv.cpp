#include "bentaxis/files/csv.h"

// Single-threaded reading keeps the library free of threads it does not need.
#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

#include <algorithm>
#include <string_view>

#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis {
namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

// Whether a table is not separated by commas: by semicolons, tabs or blanks, or is no plain text.
// Judged by its first line alone, so that a file of ours is held to its format line by line.
bool is_foreign(std::string_view content) {
  for (const std::string_view start : {"PK\x03\x04", "MATLAB", "\x89HDF", "\xFF\xFE", "\xFE\xFF"})
    if (content.starts_with(start)) return true;
  const auto from = content.find_first_not_of(" \t\r\n");
  if (from == std::string_view::npos) return false;
  std::string_view line = content.substr(from);
  line = trimmed(line.substr(0, line.find('\n')));
  if (line.find('\0') != std::string_view::npos) return false;
  return line.find_first_of(";\t") != std::string_view::npos ||
         (line.find(',') == std::string_view::npos && line.find(' ') != std::string_view::npos);
}

}  // namespace

NumericTable read_numeric_csv(const std::filesystem::path& file, bool allow_empty) {
  const std::string content = read_input_file(file, {"a table", kLargestTable});
  if (!is_foreign(content)) return numeric_csv_of(content, file, allow_empty);
  ForeignTable table = table_of(content, file);
  for (std::size_t i = 0; i < table.rows.size() && !allow_empty; ++i)
    for (std::size_t c = 0; c < table.rows[i].size(); ++c)
      if (!is_computed(table.rows[i][c]))
        throw InputError(table.place(i) + ": " + table.header[c] +
                         " = \"\": must be a finite number");
  return table;
}

NumericTable numeric_csv_of(const std::string& content, const std::filesystem::path& file,
                            bool allow_empty) {
  InputLog::note(file, content);
  if (const auto at = content.find('\0'); at != std::string::npos)
    throw InputError(file.string() + ":" +
                     std::to_string(1 + std::count(content.data(), content.data() + at, '\n')) +
                     ": holds a byte 0: must be text");
  NumericTable table;
  try {
    io::LineReader reader(file.string(), content.data(), content.data() + content.size());
    while (char* text = reader.next_line()) {
      const std::string where = file.string() + ":" + std::to_string(reader.get_file_line());
      if (trimmed(text).empty()) continue;
      const auto fields = split(text);
      if (table.header.empty()) {
        table.header.assign(fields.begin(), fields.end());
        for (const std::string& name : table.header)
          if (has_control_characters(name, true))
            throw InputError(where + ": the column name \"" + without_control_characters(name) +
                             "\" holds a control character");
        continue;
      }
      if (fields.size() != table.header.size())
        throw InputError(where + ": " + std::to_string(fields.size()) + " fields, the header has " +
                         std::to_string(table.header.size()));
      std::vector<double> row;
      row.reserve(fields.size());
      for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto field = fields[i];
        const auto value = number_in(field);
        if (!value && !(field.empty() && allow_empty))
          throw InputError(where + ": " + table.header[i] + " = \"" +
                           without_control_characters(std::string(field)) +
                           "\": must be a finite number");
        row.push_back(value.value_or(not_computed()));
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

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + "\"";
}

namespace {

bool is_written(const ResultTable& table, std::size_t column) {
  if (!is_of_given_motion(table.channels[column])) return true;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (is_computed(table.at(row, column))) return true;
  return false;
}

// A text that is handed on whenever enough of it has come together.
class Pieces {
 public:
  explicit Pieces(const TextSink& write) : write_(write) {}
  std::string& next() {
    constexpr std::size_t kEnough = 1 << 20;
    if (piece.size() >= kEnough) end();
    return piece;
  }
  void end() {
    write_(piece);
    piece.clear();
  }
  std::string piece;

 private:
  const TextSink& write_;
};

template <class Writes>
std::string text_of(const Writes& writes) {
  std::string text;
  writes([&](const std::string& piece) { text += piece; });
  return text;
}

}  // namespace

std::string to_csv(const MotionTable& table) {
  return text_of([&](const TextSink& write) { write_csv(table, write); });
}

void write_csv(const MotionTable& table, const TextSink& write) {
  const ResultTable& results = table.results;
  Pieces text(write);
  std::vector<std::size_t> columns;  // those that the states do not have already: given pressures
  const auto& names = table.state_names;
  for (const std::string& name : names) text.piece += name + ",";
  for (std::size_t c = 0; c < results.columns(); ++c)
    if (is_written(results, c) && !contains(names, results.channels[c].name)) {
      columns.push_back(c);
      text.piece += results.channels[c].name + ",";
    }
  text.piece.back() = '\n';
  std::vector<double> line;
  for (std::size_t row = 0; row < results.rows(); ++row) {
    line.clear();
    for (std::size_t c = 0; c < names.size(); ++c) line.push_back(table.state(row, c));
    for (const std::size_t c : columns) line.push_back(results.at(row, c));
    append_csv_row(text.next(), line[0], line.data() + 1, line.size() - 1);
  }
  text.end();
}

std::string oil_csv(const Trajectory& run) {
  return text_of([&](const TextSink& write) { write_oil_csv(run, write); });
}

void write_oil_csv(const Trajectory& run, const TextSink& write) {
  Pieces text(write);
  text.piece = "time_s";
  for (const OilColumn& column : run.oil->columns) text.piece += "," + column.name;
  text.piece += "\n";
  const std::size_t columns = run.oil->columns.size();
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    append_csv_row(text.next(), run.table.state(row, 0), run.oil->values.data() + row * columns,
                   columns);
  text.end();
}

std::string csv_header(const std::vector<Channel>& channels) {
  std::string text = "theta_deg";
  for (const Channel& channel : channels) text += "," + channel.name;
  return text + "\n";
}

void append_csv_row(std::string& text, double theta_deg, const double* values, std::size_t count) {
  append_number(text, theta_deg);
  for (std::size_t column = 0; column < count; ++column) {
    text += ',';
    append_number(text, values[column]);
  }
  text += '\n';
}

std::string to_csv(const ResultTable& table) {
  return text_of([&](const TextSink& write) { write_csv(table, write); });
}

void write_csv(const ResultTable& table, const TextSink& write,
               const std::function<bool(const Channel&)>& wanted) {
  std::vector<Channel> channels;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.columns(); ++c)
    if ((!wanted || wanted(table.channels[c])) && is_written(table, c)) {
      columns.push_back(c);
      channels.push_back(table.channels[c]);
    }
  Pieces text(write);
  text.piece = csv_header(channels);
  std::vector<double> line(columns.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) line[i] = table.at(row, columns[i]);
    append_csv_row(text.next(), table.theta_deg[row], line.data(), line.size());
  }
  text.end();
}

}  // namespace bentaxis
