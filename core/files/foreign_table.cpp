#include "bentaxis/files/foreign_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "foreign_grid.h"

namespace bentaxis {
namespace foreign {
namespace {

// A column of fewer different values does not show its digits: 0 and 275 are exact.
constexpr std::size_t kTellingValues = 8;
// A message shows no more of a cell than this.
constexpr std::size_t kShown = 60;

std::string shown(std::string_view text) {
  const bool longer = text.size() > kShown;
  return "\"" + one_line(std::string(text.substr(0, kShown))) + (longer ? ".." : "") + "\"";
}

bool blank(const Row& row) {
  return std::all_of(row.cells.begin(), row.cells.end(),
                     [](const Cell& c) { return !c.number && c.text.empty(); });
}

// Mostly numbers, and at least two of them.
bool numeric(const Row& row) {
  std::size_t numbers = 0, texts = 0;
  for (const Cell& cell : row.cells) {
    numbers += cell.number;
    texts += !cell.number && !cell.text.empty();
  }
  return numbers >= 2 && numbers >= texts;
}

// Rows [begin, end) of numbers; blank rows may lie between.
struct Run {
  std::size_t begin = 0, end = 0, rows = 0;
};

std::vector<Run> runs_of(const Grid& grid) {
  std::vector<Run> runs;
  bool inside = false;
  for (std::size_t i = 0; i < grid.rows.size(); ++i) {
    if (blank(grid.rows[i])) continue;
    if (!numeric(grid.rows[i])) {
      inside = false;
      continue;
    }
    if (!inside) runs.push_back({i, i, 0});
    inside = true;
    runs.back().end = i + 1;
    ++runs.back().rows;
  }
  return runs;
}

std::size_t width_of(const Grid& grid, const Run& run) {
  std::size_t width = 0;
  for (std::size_t i = run.begin; i < run.end; ++i)
    width = std::max(width, grid.rows[i].cells.size());
  return width;
}

// What most lines have: of lines of several widths the others are wrong.
std::size_t usual_width(const Grid& grid, const Run& run) {
  std::map<std::size_t, std::size_t> lines;
  for (std::size_t i = run.begin; i < run.end; ++i)
    if (!blank(grid.rows[i])) ++lines[grid.rows[i].cells.size()];
  const auto most = std::max_element(
      lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == lines.end() ? 0 : most->first;
}

// Texts of a line above the numbers, one per column; empty where they are not as many.
std::vector<std::string> texts_of(const Grid& grid, const Row& row, std::size_t width) {
  std::vector<std::string> texts;
  for (const Cell& cell : row.cells) texts.emplace_back(cell.text);
  while (texts.size() > width && texts.back().empty()) texts.pop_back();
  if (grid.blanks && texts.size() != width) {
    // Names with blanks in them stand at least two blanks apart. An empty cell has no place in the
    // line.
    const auto filled = [](const Cell& cell) { return !cell.text.empty(); };
    const auto first = std::find_if(row.cells.begin(), row.cells.end(), filled);
    const auto last = std::find_if(row.cells.rbegin(), row.cells.rend(), filled);
    if (first == row.cells.end()) return {};
    const char* const end_of_line = last->text.data() + last->text.size();
    const std::string_view line(first->text.data(),
                                static_cast<std::size_t>(end_of_line - first->text.data()));
    texts.clear();
    for (std::size_t at = 0; at < line.size();) {
      const auto end = std::min(line.find("  ", at), line.size());
      if (end > at) texts.emplace_back(trimmed(line.substr(at, end - at)));
      at = end + 2;
    }
    std::erase(texts, "");
    if (texts.size() != width) return {};
  }
  if (texts.size() > width) return {};
  texts.resize(width);
  return texts;
}

std::string without_brackets(const std::string& text) {
  const auto closing = [](char c) {
    return c == '[' ? ']' : c == '(' ? ')' : c == '<' ? '>' : ' ';
  };
  if (text.size() > 2 && closing(text.front()) == text.back() && text.back() != ' ')
    return std::string(trimmed(std::string_view(text).substr(1, text.size() - 2)));
  return text;
}

bool are_units(const std::vector<std::string>& texts) {
  std::size_t known = 0;
  for (const auto& text : texts) {
    const std::string bare = without_brackets(text);
    if (bare.empty() || bare == "-") continue;
    if (!known_unit(bare).empty())
      ++known;
    else if (bare == text)
      return false;  // neither a unit nor in brackets
  }
  return known > 0;
}

struct Heading {
  std::vector<std::string> names, units;
};

// Names and units: from the lines above the first row of numbers.
Heading heading_above(const Grid& grid, std::size_t begin, std::size_t top, std::size_t width) {
  Heading heading{std::vector<std::string>(width), std::vector<std::string>(width)};
  std::vector<std::vector<std::string>> above;  // nearest first
  std::size_t count = 0;
  for (std::size_t i = begin; i-- > top && count < 4;) {
    if (blank(grid.rows[i])) {
      if (count > 0) break;
      continue;
    }
    ++count;
    above.push_back(texts_of(grid, grid.rows[i], width));
  }
  const auto filled = [](const std::vector<std::string>& texts) {
    return static_cast<std::size_t>(
        std::count_if(texts.begin(), texts.end(), [](const auto& t) { return !t.empty(); }));
  };
  std::size_t next = 0;
  if (next < above.size() && are_units(above[next])) {
    for (std::size_t i = 0; i < width; ++i) heading.units[i] = without_brackets(above[next][i]);
    ++next;
  }
  if (next >= above.size() || 2 * filled(above[next]) < width) return heading;
  heading.names = above[next++];
  if (next < above.size() && next == 1 && are_units(above[next])) {
    for (std::size_t i = 0; i < width; ++i) heading.units[i] = without_brackets(above[next][i]);
    return heading;
  }
  // Names that repeat are told apart by the line above: a name there counts up to the next one.
  const std::set<std::string> different(heading.names.begin(), heading.names.end());
  if (different.size() < width && next < above.size() && filled(above[next]) >= 2) {
    std::string group;
    for (std::size_t i = 0; i < width; ++i) {
      if (!above[next][i].empty()) group = above[next][i];
      if (!group.empty()) heading.names[i] = group + "." + heading.names[i];
    }
  }
  return heading;
}

// The title of one of several tables: the nearest line above its names that is no row of numbers.
std::string title_above(const Grid& grid, std::size_t begin, std::size_t top) {
  bool names = true;
  for (std::size_t i = begin; i-- > top;) {
    if (blank(grid.rows[i])) continue;
    const Row& row = grid.rows[i];
    std::string text;
    for (const Cell& cell : row.cells)
      if (!cell.text.empty()) text += (text.empty() ? "" : " ") + std::string(cell.text);
    if (!names && !are_units({text})) return text;
    names = false;
  }
  return "";
}

void read_run(const Grid& grid, const Run& run, std::size_t top, const std::string& title,
              ForeignTable& table) {
  const std::size_t width = width_of(grid, run), usual = usual_width(grid, run);
  Heading heading = heading_above(grid, run.begin, top, width);
  // A column of texts is none of numbers.
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < width; ++c)
    if (std::any_of(grid.rows.begin() + static_cast<std::ptrdiff_t>(run.begin),
                    grid.rows.begin() + static_cast<std::ptrdiff_t>(run.end),
                    [&](const Row& row) { return c < row.cells.size() && row.cells[c].number; }))
      columns.push_back(c);
  const bool first = table.rows.empty();
  DifferentNames names(table.header);
  for (const std::size_t c : columns) {
    if (!first && c == columns.front()) continue;  // the same in every table
    std::string name =
        heading.names[c].empty() ? "column " + std::to_string(c + 1) : heading.names[c];
    if (!title.empty() && c != columns.front()) name.insert(0, title + ".");
    table.units.push_back(heading.units[c].empty() ? unit_in_name(name) : heading.units[c]);
    table.header.push_back(names.different(name));
  }
  std::vector<int> digits(columns.size(), 0);
  std::vector<std::set<double>> different(columns.size());
  std::size_t index = 0;
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const Row& row = grid.rows[i];
    if (blank(row)) continue;
    if (grid.fixed_width && row.cells.size() != usual)
      throw InputError(grid.place(row, 0) + ": " + std::to_string(row.cells.size()) +
                       " fields, other lines have " + std::to_string(usual));
    std::vector<double> values;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const Cell cell = columns[k] < row.cells.size() ? row.cells[columns[k]] : Cell{};
      if (!cell.number && !cell.text.empty())
        throw InputError(grid.place(row, columns[k]) + ": " +
                         (heading.names[columns[k]].empty()
                              ? "column " + std::to_string(columns[k] + 1)
                              : heading.names[columns[k]]) +
                         " = " + shown(cell.text) + ": must be a finite number");
      values.push_back(cell.number ? cell.value : not_computed());
      if (!cell.number) continue;
      digits[k] = std::max(digits[k], cell.digits);
      if (different[k].size() < kTellingValues) different[k].insert(cell.value);
    }
    if (first) {
      table.rows.push_back(std::move(values));
      table.lines.push_back(row.line);
    } else {
      auto& whole = table.rows[index++];
      whole.insert(whole.end(), values.begin() + 1, values.end());
    }
  }
  for (std::size_t k = first ? 0 : 1; k < columns.size(); ++k)
    table.digits.push_back(different[k].size() < kTellingValues ? 0 : digits[k]);
}

// Whether two tables below each other are over the same first column.
bool same_first_column(const Grid& grid, const Run& a, const Run& b) {
  if (a.rows != b.rows) return false;
  std::vector<double> first[2];
  const Run* runs[] = {&a, &b};
  for (int k = 0; k < 2; ++k)
    for (std::size_t i = runs[k]->begin; i < runs[k]->end; ++i) {
      const auto& cells = grid.rows[i].cells;
      if (blank(grid.rows[i])) continue;
      const auto cell =
          std::find_if(cells.begin(), cells.end(), [](const Cell& c) { return c.number; });
      first[k].push_back(cell->value);
    }
  return first[0] == first[1];
}

}  // namespace

bool parse_number(std::string_view text, char decimal, double& value, int& digits) {
  if (text.empty() || text.size() > 63) return false;
  if (text.front() == '+') text.remove_prefix(1);
  std::array<char, 64> buffer{};
  std::size_t n = 0, first_group = 0;
  const char thousands = decimal == ',' ? '.' : ',';
  bool point = false, grouped = false, exponent = false;
  digits = 0;
  std::size_t since = 0;  // digits since the last group separator
  for (const char c : text) {
    if (c == decimal && !point) {
      if (grouped && since != 3) return false;
      point = true;
      buffer[n++] = '.';
    } else if (c == thousands && !point && !exponent) {
      // 1.234,56: three digits in each group, and a decimal sign behind; 1.234 alone could be both.
      if (since == 0 || since > 3 || (grouped && since != 3)) return false;
      if (!grouped) first_group = since;
      grouped = true;
      since = 0;
    } else {
      if (c >= '0' && c <= '9') {
        ++since;
        if (!exponent && (digits > 0 || c != '0')) ++digits;
      } else if (c == 'e' || c == 'E' || c == 'd' || c == 'D') {
        exponent = true;
      } else if (c != '-' && c != '+') {
        return false;  // nan, inf and words
      }
      buffer[n++] = c == 'd' || c == 'D' ? 'e' : c;
    }
  }
  if (grouped && (!point || first_group == 0)) return false;
  const auto number = number_in({buffer.data(), n});
  value = number.value_or(value);
  return number.has_value();
}

bool is_plain_table(const Grid& grid) {
  const auto head = std::find_if_not(grid.rows.begin(), grid.rows.end(), blank);
  if (head == grid.rows.end() || head->cells.size() < 2) return false;
  const auto all = [](const Row& row, auto is) {
    return std::all_of(row.cells.begin(), row.cells.end(), is);
  };
  std::size_t rows = 0;
  for (auto row = head + 1; row != grid.rows.end(); ++row) {
    if (blank(*row)) continue;
    if (row->cells.size() != head->cells.size()) return false;
    if (!all(*row, [](const Cell& cell) { return cell.number; })) return false;
    ++rows;
  }
  return rows > 0 &&
         all(*head, [](const Cell& cell) { return !cell.number && !cell.text.empty(); });
}

void fill(const Grid& grid, ForeignTable& table) {
  std::vector<Run> runs = runs_of(grid);
  const auto longest = std::max_element(runs.begin(), runs.end(),
                                        [](const Run& a, const Run& b) { return a.rows < b.rows; });
  if (longest == runs.end() || (longest->rows < 2 && !is_plain_table(grid)))
    throw InputError(table.file.string() + (table.sheet.empty() ? "" : ", sheet " + table.sheet) +
                     ": holds no table of numbers");
  const Run main = *longest;
  // Lines of a title may hold numbers too; of the table's own width they are rows.
  std::erase_if(runs, [&, width = width_of(grid, main)](const Run& run) {
    return run.begin < main.begin && run.rows < 3 && width_of(grid, run) != width;
  });
  const bool several = runs.size() > 1 && std::all_of(runs.begin(), runs.end(), [&](const Run& r) {
                         return same_first_column(grid, runs.front(), r);
                       });
  if (runs.size() > 1 && !several) {
    const std::size_t after = runs.front().end;
    std::size_t bad = after;
    while (bad < grid.rows.size() && blank(grid.rows[bad])) ++bad;
    const Row& row = grid.rows[bad];
    std::size_t column = 0;
    while (column + 1 < row.cells.size() &&
           (row.cells[column].number || row.cells[column].text.empty()))
      ++column;
    throw InputError(grid.place(row, column) + ": " + shown(row.cells[column].text) +
                     ": must be a finite number, as in the rows before and after");
  }
  std::size_t top = 0;
  for (const Run& run : runs) {
    read_run(grid, run, top, several ? title_above(grid, run.begin, top) : "", table);
    top = run.end;
  }
  for (std::size_t i = top; i < grid.rows.size(); ++i)
    for (std::size_t c = 0; c < grid.rows[i].cells.size(); ++c)
      if (grid.rows[i].cells[c].number)
        throw InputError(grid.place(grid.rows[i], c) +
                         ": a number below the table that does not belong to a row of it");
}

}  // namespace foreign

std::string ForeignTable::place(std::size_t row) const {
  if (row >= lines.size()) return file.string();
  if (sheet.empty()) return file.string() + ":" + std::to_string(lines[row]);
  return file.string() + ", " + sheet + ", row " + std::to_string(lines[row]);
}

std::string known_unit(const std::string& text) {
  // What columns of other programs hold.
  static const std::set<std::string> quantities = {"Force", "Torque", "Length",         "Pressure",
                                                   "Angle", "Time",   "AngularVelocity"};
  std::string bare;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "·") == 0) {  // in two bytes
      ++i;
      continue;
    }
    if (text[i] != ' ' && text[i] != '*' && text[i] != '.' && text[i] != '-' && text[i] != '_' &&
        text[i] != '\xB7')
      bare += text[i];
  }
  const auto name_of = [](const UnitOfMeasure* unit) {
    return unit != nullptr && quantities.count(unit->quantity) > 0 ? unit->name : "";
  };
  if (std::string name = name_of(find_written_unit(bare)); !name.empty()) return name;
  return name_of(find_unit_by_word(lower_case(bare)));
}

std::string unit_in_name(const std::string& name) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}, {'<', '>'}}) {
    const auto from = name.rfind(open);
    const auto to = from == std::string::npos ? from : name.find(close, from);
    if (to == std::string::npos) continue;
    std::string inner = name.substr(from + 1, to - from - 1);
    if (!known_unit(inner).empty()) return inner;
  }
  // Behind the last of these: torque_Nmm, "Kraft in kN", "F / N"
  const auto last = name.find_last_of("_ /,;");
  if (last == std::string::npos || last + 1 >= name.size()) return "";
  const std::string end = name.substr(last + 1);
  // Single letters are rather an axis or a number; the last words of our own names are units.
  if (end == "n" || end == "in" || end == "min") {
    const auto before = name.find_last_not_of(' ', last);
    const bool said = before != std::string::npos && name[before] == '/';
    return said || name.find(" in ") != std::string::npos ? end : "";
  }
  return known_unit(end).empty() ? "" : end;
}

ForeignTable read_table(const std::filesystem::path& file, const std::string& sheet) {
  return table_of(read_input_file(file, {"a table", kLargestTable}), file, sheet);
}

namespace {

ForeignTable unchecked_table_of(std::string content, const std::filesystem::path& file,
                                const std::string& sheet) {
  if (content.starts_with("PK\x03\x04")) return foreign::read_workbook(file, content, sheet);
  const std::string extension = lower_case(file.extension().string());
  if (content.starts_with("MATLAB ") || content.starts_with("\x89HDF") ||
      (extension == ".mat" && content.find('\0') != std::string::npos))
    return foreign::read_matlab(file, content, sheet);
  if (content.starts_with("\xD0\xCF\x11\xE0"))
    throw InputError(file.string() +
                     ": is an .xls file from before 2007: save it as .xlsx or as CSV");
  if (content.starts_with("# Created by Octave"))
    throw InputError(file.string() + ": is Octave's own text format: save it with -v7");
  if (!sheet.empty())
    throw InputError(file.string() + ": is text and has no sheet \"" + sheet + "\"");
  return foreign::read_text(file, std::move(content));
}

// Tab and line feed become blanks, as in a workbook's cell of two lines.
std::string plain_name(std::string name, const std::filesystem::path& file, const char* what) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  if (!is_utf8(name)) name = utf8_of_windows_1252(name);
  if (has_control_characters(name, true))
    throw InputError(file.string() + ": the " + what + " \"" + without_control_characters(name) +
                     "\" holds a control character");
  return name;
}

}  // namespace

ForeignTable table_of(const std::string& content, const std::filesystem::path& file,
                      const std::string& sheet) {
  InputLog::note(file, content);
  ForeignTable table = unchecked_table_of(content, file, sheet);
  for (std::string& name : table.header) name = plain_name(name, file, "column name");
  for (std::string& unit : table.units) unit = plain_name(unit, file, "unit");
  return table;
}

}  // namespace bentaxis
