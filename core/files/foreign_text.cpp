// Text tables: what parts the fields, how numbers are written, request files.
#include <algorithm>
#include <array>
#include <set>

#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "foreign_grid.h"

namespace bentaxis::foreign {
namespace {

// How the fields of a line are told apart: blanks stand for any number of blanks and tabs.
struct Style {
  char separator, decimal;
  const char* words;
};
// Where several explain a file as well, the first is taken.
constexpr std::array<Style, 9> kStyles = {{
    {',', '.', "text, separated by commas"},
    {';', '.', "text, separated by semicolons"},
    {';', ',', "text, separated by semicolons, decimal comma"},
    {'\t', '.', "text, separated by tabs"},
    {'\t', ',', "text, separated by tabs, decimal comma"},
    {' ', '.', "text, separated by blanks"},
    {' ', ',', "text, separated by blanks, decimal comma"},
    {',', ',', "text, separated by commas, quoted decimal commas"},
    {'|', '.', "text, separated by bars"},
}};
// The style shows in this many lines, taken evenly over the file.
constexpr std::size_t kTriedLines = 400;

struct Line {
  unsigned number;
  std::string_view text;
};

std::vector<Line> lines_of(std::string_view content) {
  std::vector<Line> lines;
  for (unsigned number = 1; !content.empty(); ++number) {
    const auto end = std::min(content.find('\n'), content.size());
    std::string_view line = content.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back({number, line});
    content.remove_prefix(std::min(end + 1, content.size()));
  }
  return lines;
}

void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  const bool blanks = separator == ' ';
  const auto parts = [&](char c) { return blanks ? c == ' ' || c == '\t' : c == separator; };
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && (line[at] == ' ' || (line[at] == '\t' && separator != '\t'))) ++at;
    if (blanks && at >= line.size()) return;
    if (at < line.size() && line[at] == '"') {
      std::size_t end = at + 1;
      while (end < line.size() &&
             (line[end] != '"' || (end + 1 < line.size() && line[end + 1] == '"')))
        end += line[end] == '"' ? 2 : 1;
      fields.push_back(trimmed(line.substr(at + 1, std::min(end, line.size()) - at - 1)));
      at = std::min(end + 1, line.size());
      while (at < line.size() && !parts(line[at])) ++at;
    } else {
      const std::size_t from = at;
      while (at < line.size() && !parts(line[at])) ++at;
      fields.push_back(trimmed(line.substr(from, at - from)));
    }
    if (at >= line.size()) return;
    ++at;
    if (at >= line.size() && !blanks) {
      fields.emplace_back();
      return;
    }
  }
}

// Numbers that a style finds in some lines, less what it does not understand in rows of numbers.
double score(const std::vector<Line>& lines, const Style& style) {
  std::vector<std::string_view> fields;
  double sum = 0;
  const std::size_t stride = 1 + lines.size() / kTriedLines;
  for (std::size_t i = 0; i < lines.size(); i += stride) {
    split(lines[i].text, style.separator, fields);
    double numbers = 0, others = 0, value = 0;
    int digits = 0;
    for (const auto field : fields)
      (parse_number(field, style.decimal, value, digits) ? numbers : others) +=
          field.empty() ? 0 : 1;
    if (numbers >= 2 && numbers > others) sum += numbers - 2 * others;
  }
  return sum;
}

std::string as_utf8(const std::string& content, bool big_endian) {
  std::string out;
  for (std::size_t i = 2; i + 1 < content.size(); i += 2) {
    const auto high = static_cast<unsigned char>(content[big_endian ? i : i + 1]);
    const auto low = static_cast<unsigned char>(content[big_endian ? i + 1 : i]);
    const unsigned code = high * 256U + low;
    if (code < 0x80) {
      out += static_cast<char>(code);
    } else if (code < 0x800) {
      out += static_cast<char>(0xC0 | (code >> 6));
      out += static_cast<char>(0x80 | (code & 0x3F));
    } else {
      out += static_cast<char>(0xE0 | (code >> 12));
      out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
      out += static_cast<char>(0x80 | (code & 0x3F));
    }
  }
  return out;
}

// Characters behind the decimal point, with an exponent; 0 without one.
std::size_t decimals(std::string_view field, char decimal) {
  const auto point = field.rfind(decimal);
  return point == std::string_view::npos ? 0 : field.size() - point;
}

// Whether the last of some numbers is cut: those before it all have one length behind their point,
// and it has less. Asked where a text does not end its last line.
bool last_is_cut(const std::vector<std::string_view>& numbers, char decimal) {
  constexpr std::size_t kTelling = 7;  // as few as these show no format
  if (numbers.size() < kTelling) return false;
  const std::size_t length = decimals(numbers.front(), decimal);
  return std::all_of(numbers.begin(), numbers.end() - 1,
                     [&](auto number) { return decimals(number, decimal) == length; }) &&
         decimals(numbers.back(), decimal) < length;
}

[[noreturn]] void refuse_cut_number(const std::string& place) {
  throw InputError(place +
                   ": the last line does not end, and its last number is shorter than those above "
                   "it: the file is truncated");
}

// A request file: a line with the time alone, then a line per request with its number and values;
// the same requests at each time. Becomes one row per time. False where the text is none.
bool requests(const std::vector<Line>& lines, bool ended, Grid& grid) {
  struct Block {
    Line time;
    std::vector<Line> lines;
  };
  std::vector<Block> blocks;
  std::vector<std::string_view> fields;
  std::size_t width = 0;
  // Once three times have been as long as each other this is a request file, and nothing else.
  const auto established = [&] {
    if (blocks.size() < 4 || width < 4) return false;
    const std::size_t length = blocks[blocks.size() - 2].lines.size();
    return length > 0 && blocks[blocks.size() - 3].lines.size() == length &&
           blocks[blocks.size() - 4].lines.size() == length;
  };
  const auto refuse = [&](const Line& line) {
    throw InputError(grid.place({line.number, {}}, 0) + ": " + std::to_string(fields.size()) +
                     " fields, other lines have " + std::to_string(width) +
                     " numbers, the first of them a request's: is the file truncated?");
  };
  for (const Line& line : lines) {
    split(line.text, ' ', fields);
    double value = 0;
    int digits = 0;
    const bool all = !fields.empty() && std::all_of(fields.begin(), fields.end(), [&](auto field) {
      return parse_number(field, '.', value, digits);
    });
    if (!all) {
      if (!fields.empty() && established()) refuse(line);
      if (!fields.empty() && blocks.size() > 2) return false;
      if (!fields.empty()) blocks.clear();
      continue;
    }
    if (fields.size() == 1) {
      blocks.push_back({line, {}});
    } else {
      if (blocks.empty()) continue;
      if (width == 0) width = fields.size();
      if (fields.size() != width ||
          fields.front().find_first_not_of("0123456789") != std::string_view::npos) {
        if (established()) refuse(line);
        return false;
      }
      blocks.back().lines.push_back(line);
    }
  }
  while (!blocks.empty() && blocks.front().lines.empty()) blocks.erase(blocks.begin());
  if (blocks.size() < 3 || width < 4) return false;
  for (const Block& block : blocks)
    if (block.lines.size() != blocks.front().lines.size())
      throw InputError(grid.place({block.time.number, {}}, 0) + ": the time " +
                       std::string(trimmed(block.time.text)) + " has " +
                       std::to_string(block.lines.size()) + " requests, others have " +
                       std::to_string(blocks.front().lines.size()));
  if (!ended) {
    std::vector<std::string_view> last_numbers;
    for (const Block& block : blocks)
      for (const Line& line : block.lines) {
        split(line.text, ' ', fields);
        last_numbers.push_back(fields.back());
      }
    if (last_is_cut(last_numbers, '.'))
      refuse_cut_number(grid.place({blocks.back().lines.back().number, {}}, 0));
  }
  // The eight values of a request of forces, displacements or functions.
  constexpr std::array<const char*, 8> kComponents = {"MAG",  "X",  "Y",  "Z",
                                                      "RMAG", "RX", "RY", "RZ"};
  const auto text = [&](std::string words) {
    grid.storage.push_back(std::move(words));
    return Cell{grid.storage.back()};
  };
  Row names{blocks.front().time.number, {text("TIME")}};
  for (const Line& line : blocks.front().lines) {
    split(line.text, ' ', fields);
    for (std::size_t i = 1; i < width; ++i)
      names.cells.push_back(text("REQ_" + std::string(fields.front()) + "." +
                                 (width == 9 ? kComponents[i - 1] : "U" + std::to_string(i))));
  }
  grid.rows.push_back(names);
  for (const Block& block : blocks) {
    Row row{block.time.number, {}};
    const auto add = [&](std::string_view field) {
      Cell cell{field};
      cell.number = parse_number(field, '.', cell.value, cell.digits);
      row.cells.push_back(cell);
    };
    add(trimmed(block.time.text));
    for (const Line& line : block.lines) {
      split(line.text, ' ', fields);
      for (std::size_t i = 1; i < width; ++i) add(fields[i]);
    }
    grid.rows.push_back(std::move(row));
  }
  return true;
}

}  // namespace

ForeignTable read_text(const std::filesystem::path& file, std::string content) {
  ForeignTable table;
  table.file = file;
  if (content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF"))
    content = as_utf8(content, content.starts_with("\xFE\xFF"));
  else if (!is_utf8(content))
    content = utf8_of_windows_1252(content);
  if (content.starts_with("\xEF\xBB\xBF")) content.erase(0, 3);
  if (content.find('\0') != std::string::npos)
    throw InputError(file.string() +
                     ": is neither text nor a format that can be read (.xlsx, .mat)");
  const std::vector<Line> lines = lines_of(content);
  if (std::all_of(lines.begin(), lines.end(),
                  [](const Line& line) { return trimmed(line.text).empty(); }))
    throw InputError(file.string() + ": is empty");
  Grid grid;
  grid.place = [&](const Row& row, std::size_t) {
    return file.string() + ":" + std::to_string(row.line);
  };
  const bool ended = content.back() == '\n';
  if (requests(lines, ended, grid)) {
    table.format = "ADAMS request file";
    fill(grid, table);
    return table;
  }
  const Style* best = nullptr;
  double most = 0;
  for (const Style& style : kStyles)
    if (const double found = score(lines, style); found > most) {
      most = found;
      best = &style;
    }
  if (best == nullptr)
    throw InputError(file.string() +
                     ": holds no table of numbers: no two lines with at least two numbers each");
  table.format = best->words;
  grid.blanks = best->separator == ' ';
  grid.fixed_width = true;
  std::vector<std::string_view> fields;
  std::size_t cells = 0;
  for (const Line& line : lines) {
    split(line.text, best->separator, fields);
    Row row{line.number, {}};
    cells += fields.size();
    if (fields.size() > kMaxColumns || cells > kMaxCells)
      throw InputError(grid.place(row, 0) + ": a table has at most " + std::to_string(kMaxColumns) +
                       " columns and " + std::to_string(kMaxCells) + " fields");
    for (const auto field : fields) {
      Cell cell{field};
      cell.number = parse_number(field, best->decimal, cell.value, cell.digits);
      row.cells.push_back(cell);
    }
    grid.rows.push_back(std::move(row));
  }
  if (!ended) {
    const std::size_t width = grid.rows.back().cells.size();
    std::vector<std::string_view> last_numbers;
    for (const Row& row : grid.rows)
      if (row.cells.size() == width && width > 0 && row.cells.back().number)
        last_numbers.push_back(row.cells.back().text);
    if (width > 0 && grid.rows.back().cells.back().number &&
        last_is_cut(last_numbers, best->decimal))
      refuse_cut_number(grid.place(grid.rows.back(), 0));
  }
  fill(grid, table);
  return table;
}

}  // namespace bentaxis::foreign
