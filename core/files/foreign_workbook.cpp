// Excel workbooks (Office Open XML): the values of a sheet.
#include <zip.h>

#include <map>
#include <memory>
#include <new>
#include <optional>
#include <pugixml.hpp>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "foreign_grid.h"

namespace bentaxis::foreign {
namespace {

// A part of a workbook that is longer than this when unpacked is no table of curves.
constexpr zip_uint64_t kLargestPart = 256 * kMebibyte;

class Archive {
 public:
  /// `content` must outlive it.
  Archive(const std::filesystem::path& file, const std::string& content) : file_(file.string()) {
    zip_source_t* const source =
        zip_source_buffer_create(content.data(), content.size(), 0, nullptr);
    if (source == nullptr) throw std::bad_alloc();
    archive_.reset(zip_open_from_source(source, ZIP_RDONLY, nullptr));
    if (archive_) return;
    zip_source_free(source);
    fail("is a damaged or truncated zip archive");
  }
  [[noreturn]] void fail(const std::string& why) const { throw InputError(file_ + ": " + why); }

  std::optional<std::string> part(const std::string& name) const {
    zip_stat_t facts;
    if (zip_stat(archive_.get(), name.c_str(), 0, &facts) != 0) return std::nullopt;
    if ((facts.valid & ZIP_STAT_SIZE) == 0 || facts.size > kLargestPart)
      fail(name + " is larger than 256 MiB when unpacked");
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> in(
        zip_fopen(archive_.get(), name.c_str(), 0), zip_fclose);
    std::string text(facts.size, '\0');
    if (!in ||
        zip_fread(in.get(), text.data(), text.size()) != static_cast<zip_int64_t>(text.size()))
      fail(name + " cannot be unpacked: the file is damaged");
    return text;
  }
  std::optional<pugi::xml_document> xml(const std::string& name) const {
    const auto text = part(name);
    if (!text) return std::nullopt;
    pugi::xml_document document;
    if (!document.load_buffer(text->data(), text->size(),
                              pugi::parse_default | pugi::parse_ws_pcdata))
      fail(name + " is not XML: the file is damaged");
    return document;
  }

 private:
  struct Close {
    void operator()(zip_t* archive) const { zip_discard(archive); }
  };
  std::string file_;
  std::unique_ptr<zip_t, Close> archive_;
};

// Elements are compared by their names without prefix.
std::string_view local(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const auto colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}
pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  for (const auto& below : node.children())
    if (local(below) == name) return below;
  return {};
}

// The text of a string item: its own and that of its runs, without phonetic hints.
std::string text_of(const pugi::xml_node& item) {
  std::string text;
  for (const auto& below : item.children()) {
    if (local(below) == "t") text += below.child_value();
    if (local(below) == "r") text += child(below, "t").child_value();
  }
  return text;
}

std::string column_letters(std::size_t column) {
  std::string letters;
  for (std::size_t n = column + 1; n > 0; n = (n - 1) / 26)
    letters.insert(letters.begin(), static_cast<char>('A' + (n - 1) % 26));
  return letters;
}

// Column and row of "C12", from 0 and 1.
std::pair<std::size_t, unsigned> cell_place(std::string_view reference) {
  std::size_t column = 0;
  unsigned row = 0;
  for (const char c : reference) {
    if (c >= 'A' && c <= 'Z') column = column * 26 + static_cast<std::size_t>(c - 'A' + 1);
    if (c >= '0' && c <= '9') row = row * 10 + static_cast<unsigned>(c - '0');
    if (column > kMaxColumns) break;
  }
  return {column == 0 ? 0 : column - 1, row};
}

struct Sheet {
  std::string name, part;
};

std::vector<Sheet> sheets_of(const Archive& archive) {
  const auto book = archive.xml("xl/workbook.xml");
  const auto relations = archive.xml("xl/_rels/workbook.xml.rels");
  if (!book || !relations)
    archive.fail(archive.part("content.xml") ? "is an OpenDocument file: save it as .xlsx"
                                             : "is a zip archive, but not an .xlsx workbook");
  std::map<std::string, std::string> targets;
  for (const auto& relation : relations->document_element().children())
    targets[relation.attribute("Id").value()] = relation.attribute("Target").value();
  std::vector<Sheet> sheets;
  for (const auto& sheet : child(book->document_element(), "sheets").children()) {
    std::string id;
    for (const auto& attribute : sheet.attributes())
      if (std::string_view(attribute.name()).ends_with(":id")) id = attribute.value();
    const std::string& target = targets[id];
    if (target.empty()) continue;
    sheets.push_back({sheet.attribute("name").value(),
                      target.front() == '/' ? target.substr(1) : "xl/" + target});
  }
  return sheets;
}

Grid grid_of(const Archive& archive, const std::filesystem::path& file, const Sheet& sheet,
             const std::vector<std::string>& shared) {
  Grid grid;
  grid.place = [file, name = sheet.name](const Row& row, std::size_t column) {
    return file.string() + ", " + name + "!" + column_letters(column) + std::to_string(row.line);
  };
  const auto document = archive.xml(sheet.part);
  if (!document) archive.fail("sheet " + sheet.name + ": " + sheet.part + " is missing");
  const auto stored = [&](std::string text) -> std::string_view {
    grid.storage.push_back(std::move(text));
    return grid.storage.back();
  };
  unsigned line = 0;
  std::size_t cells = 0;
  bool comma = false;  // numbers that are texts may have a decimal comma
  for (const auto& row : child(document->document_element(), "sheetData").children()) {
    if (local(row) != "row") continue;
    line = row.attribute("r").as_uint(line + 1);
    Row out{line, {}};
    std::size_t next = 0;
    for (const auto& cell : row.children()) {
      if (local(cell) != "c") continue;
      const std::string_view reference = cell.attribute("r").value();
      const std::size_t column = reference.empty() ? next : cell_place(reference).first;
      next = column + 1;
      if (column >= kMaxColumns)
        archive.fail("sheet " + sheet.name + ": more than " + std::to_string(kMaxColumns) +
                     " columns");
      const std::string_view type = cell.attribute("t").value();
      std::string text =
          type == "inlineStr" ? text_of(child(cell, "is")) : child(cell, "v").child_value();
      if (type == "s") {
        const std::size_t index = static_cast<std::size_t>(std::strtoul(text.c_str(), nullptr, 10));
        if (index >= shared.size())
          throw InputError(grid.place(out, column) + ": refers to a text that is missing");
        text = shared[index];
      }
      Cell value{stored(std::string(trimmed(text)))};
      const bool words = type == "s" || type == "inlineStr" || type == "str";
      if (type != "e") {
        value.number = parse_number(value.text, '.', value.value, value.digits);
        if (!value.number && words) {
          value.number = parse_number(value.text, ',', value.value, value.digits);
          comma = comma || value.number;
        } else if (words && comma && value.text.find('.') != std::string_view::npos) {
          throw InputError(grid.place(out, column) + ": \"" + one_line(std::string(value.text)) +
                           "\": a decimal point, where others have a decimal comma");
        }
      }
      if (out.cells.size() <= column) {
        cells += column + 1 - out.cells.size();
        if (cells > kMaxCells)
          archive.fail("sheet " + sheet.name + ": more than " + std::to_string(kMaxCells) +
                       " cells");
        out.cells.resize(column + 1);
      }
      out.cells[column] = value;
    }
    grid.rows.push_back(std::move(out));
  }
  return grid;
}

bool has_numbers(const Grid& grid) {
  int rows = 0;
  for (const Row& row : grid.rows) {
    int numbers = 0;
    for (const Cell& cell : row.cells) numbers += cell.number;
    rows += numbers >= 2;
  }
  return rows >= 3 || is_plain_table(grid);
}

}  // namespace

ForeignTable read_workbook(const std::filesystem::path& file, const std::string& content,
                           const std::string& sheet) {
  const Archive archive(file, content);
  const auto sheets = sheets_of(archive);
  std::vector<std::string> shared;
  if (const auto texts = archive.xml("xl/sharedStrings.xml"))
    for (const auto& item : texts->document_element().children())
      if (local(item) == "si") shared.push_back(text_of(item));
  std::string names;
  for (const Sheet& one : sheets) {
    names += (names.empty() ? "" : ", ") + one.name;
    if (!sheet.empty() && one.name != sheet) continue;
    const Grid grid = grid_of(archive, file, one, shared);
    if (sheet.empty() && !has_numbers(grid)) continue;
    ForeignTable table;
    table.file = file;
    table.sheet = one.name;
    table.format = "Excel workbook";
    fill(grid, table);
    return table;
  }
  archive.fail(sheet.empty() ? "has no sheet with a table of numbers; its sheets: " + names
                             : "has no sheet \"" + sheet + "\"; its sheets: " + names);
}

}  // namespace bentaxis::foreign
