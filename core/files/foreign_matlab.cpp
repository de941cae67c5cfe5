// MATLAB files: vectors and columns of matrices of the same length, in structures too.
#include <charconv>
#include <cmath>
#include <map>
#include <memory>

#include "bentaxis/files/module.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "foreign_grid.h"
#include "matio_module.h"

namespace bentaxis::foreign {
namespace {

const MatioFunctions& matio() {
  static const Module loaded(BENTAXIS_MATIO_MODULE);
  return loaded.table<MatioFunctions>("kBentaxisMatio", "MATLAB files");
}

struct Column {
  std::string name;
  std::vector<double> values;
  bool single = false;  ///< in single precision
};

// Columns of every length, and lists of texts, which may be names.
struct Found {
  std::map<std::size_t, std::vector<Column>> by_length;
  std::map<std::string, std::vector<std::string>> texts;  ///< by variable
};

template <class T>
std::vector<double> converted(const matvar_t& variable, std::size_t count) {
  const T* data = static_cast<const T*>(variable.data);
  return {data, data + count};
}

std::vector<double> numbers_of(const matvar_t& variable, std::size_t count) {
  using Conversion = std::vector<double> (*)(const matvar_t&, std::size_t);
  static const std::map<int, Conversion> conversions = {
      {MAT_C_DOUBLE, converted<double>},     {MAT_C_SINGLE, converted<float>},
      {MAT_C_INT8, converted<mat_int8_t>},   {MAT_C_UINT8, converted<mat_uint8_t>},
      {MAT_C_INT16, converted<mat_int16_t>}, {MAT_C_UINT16, converted<mat_uint16_t>},
      {MAT_C_INT32, converted<mat_int32_t>}, {MAT_C_UINT32, converted<mat_uint32_t>},
      {MAT_C_INT64, converted<mat_int64_t>}, {MAT_C_UINT64, converted<mat_uint64_t>}};
  const auto found = conversions.find(variable.class_type);
  return found == conversions.end() ? std::vector<double>() : found->second(variable, count);
}

std::vector<std::string> char_rows(const matvar_t& variable) {
  std::vector<std::string> texts(variable.dims[0]);
  const auto letter = [&](std::size_t i) {
    switch (variable.data_type) {
      case MAT_T_UINT16:
      case MAT_T_UTF16:
        return static_cast<char>(static_cast<const mat_uint16_t*>(variable.data)[i]);
      case MAT_T_UINT32:
      case MAT_T_UTF32:
        return static_cast<char>(static_cast<const mat_uint32_t*>(variable.data)[i]);
      default:
        return static_cast<const char*>(variable.data)[i];
    }
  };
  for (std::size_t column = 0; column < variable.dims[1]; ++column)
    for (std::size_t row = 0; row < variable.dims[0]; ++row)
      texts[row] += letter(column * variable.dims[0] + row);
  for (auto& text : texts) text = std::string(trimmed(text.substr(0, text.find('\0'))));
  return texts;
}

void collect(const matvar_t* variable, const std::string& name, int depth, Found& found) {
  constexpr int kDeepest = 8;
  if (variable == nullptr || variable->data == nullptr || depth > kDeepest) return;
  std::size_t count = 1;
  for (int i = 0; i < variable->rank; ++i) count *= variable->dims[i];
  if (variable->class_type == MAT_C_STRUCT) {
    auto* mutable_variable = const_cast<matvar_t*>(variable);
    const auto fields = matio().number_of_fields(mutable_variable);
    char* const* names = matio().field_names(mutable_variable);
    for (std::size_t element = 0; element < count; ++element)
      for (unsigned field = 0; field < fields; ++field)
        collect(
            matio().field(mutable_variable, field, element),
            name + (count > 1 ? "(" + std::to_string(element + 1) + ")" : "") + "." + names[field],
            depth + 1, found);
    return;
  }
  if (variable->rank != 2) return;
  if (variable->class_type == MAT_C_CELL) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) {
      const matvar_t* cell = static_cast<matvar_t* const*>(variable->data)[i];
      if (cell == nullptr || cell->class_type != MAT_C_CHAR || cell->data == nullptr ||
          cell->rank != 2 || cell->dims[0] != 1) {
        collect(cell, name + "{" + std::to_string(i + 1) + "}", depth + 1, found);
        continue;
      }
      texts.push_back(char_rows(*cell).front());
    }
    if (texts.size() == count && count > 0) found.texts[name] = texts;
    return;
  }
  if (variable->class_type == MAT_C_CHAR) {
    if (variable->dims[0] >= 1) found.texts[name] = char_rows(*variable);
    return;
  }
  if (variable->isComplex != 0 || variable->class_type == MAT_C_SPARSE) return;
  const std::vector<double> all = numbers_of(*variable, count);
  if (all.size() != count || count < 3) return;
  std::size_t rows = variable->dims[0], columns = variable->dims[1];
  const bool across = rows < columns;  // a signal per row
  if (across) std::swap(rows, columns);
  for (std::size_t c = 0; c < columns; ++c) {
    Column column;
    column.name = columns == 1 ? name : name + "(:," + std::to_string(c + 1) + ")";
    column.single = variable->class_type == MAT_C_SINGLE;
    for (std::size_t r = 0; r < rows; ++r)
      column.values.push_back(across ? all[r * columns + c] : all[c * rows + r]);
    found.by_length[rows].push_back(std::move(column));
  }
}

// Significant digits of the shortest text that reads back to the value.
int digits_of(double value, bool single) {
  char text[64];
  const auto end = single ? std::to_chars(text, text + 64, static_cast<float>(value)).ptr
                          : std::to_chars(text, text + 64, value).ptr;
  double again = 0;
  int digits = 0;
  parse_number({text, static_cast<std::size_t>(end - text)}, '.', again, digits);
  return digits;
}

}  // namespace

ForeignTable read_matlab(const std::filesystem::path& file, const std::string& content,
                         const std::string& wanted) {
  const auto fail = [&](const std::string& why) { throw InputError(file.string() + ": " + why); };
  check_matlab_structure(file, content);
  matio().log_init("bentaxis");
  matio().log_init_func("bentaxis", [](int, char*) {});  // what is wrong is said below
  const std::unique_ptr<mat_t, int (*)(mat_t*)> in(matio().open(file.c_str(), MAT_ACC_RDONLY),
                                                   matio().close);
  if (!in) fail("is not a MATLAB file, or it is damaged");
  Found found;
  std::string names;
  while (matvar_t* next = matio().read_next(in.get())) {
    const std::unique_ptr<matvar_t, void (*)(matvar_t*)> variable(next, matio().free);
    const std::string name = next->name == nullptr ? "" : next->name;
    if (name.empty() || name.front() == '#' || name.starts_with("__")) continue;
    names += (names.empty() ? "" : ", ") + name;
    if (!wanted.empty() && name != wanted) continue;
    if (next->class_type == MAT_C_OPAQUE && wanted == name)
      fail(name + " is an object (table, timeseries): save its vectors in a structure");
    collect(next, name, 0, found);
  }
  if (!wanted.empty() && (", " + names + ",").find(", " + wanted + ",") == std::string::npos)
    fail("has no variable \"" + wanted + "\"; its variables: " + names);
  std::vector<Column>* columns = nullptr;
  for (auto& [length, list] : found.by_length)
    if (length >= 3 && list.size() >= 2 && (columns == nullptr || list.size() >= columns->size()))
      columns = &list;
  if (columns == nullptr) fail("has no two vectors of the same length; its variables: " + names);
  if (columns->size() > kMaxColumns)
    fail("has " + std::to_string(columns->size()) + " vectors of the same length: at most " +
         std::to_string(kMaxColumns) + " are read");
  ForeignTable table;
  table.file = file;
  table.sheet = wanted;
  table.format = "MATLAB file";
  // Names of as many texts as there are columns: of the name of which is first, units of the other.
  std::vector<std::string> given, units;
  for (const auto& [name, texts] : found.texts) {
    if (texts.size() != columns->size()) continue;
    const bool all_units = std::all_of(texts.begin(), texts.end(), [](const std::string& text) {
      return text.empty() || text == "-" || text == "1" || !known_unit(text).empty();
    });
    (all_units ? units : given) = texts;
  }
  for (std::size_t c = 0; c < columns->size(); ++c) {
    const Column& column = (*columns)[c];
    table.header.push_back(given.empty() ? column.name : given[c]);
    table.units.push_back(units.empty() ? unit_in_name(table.header.back()) : units[c]);
    int digits = 0;
    for (std::size_t row = 0; row < column.values.size(); ++row) {
      if (std::isinf(column.values[row]))
        fail(column.name + ", element " + std::to_string(row + 1) +
             ": is infinite: must be a finite number");
      if (std::isfinite(column.values[row]))
        digits = std::max(digits, digits_of(column.values[row], column.single));
    }
    table.digits.push_back(digits);
  }
  for (std::size_t row = 0; row < columns->front().values.size(); ++row) {
    std::vector<double> values;
    for (const Column& column : *columns)
      values.push_back(std::isnan(column.values[row]) ? not_computed() : column.values[row]);
    table.rows.push_back(std::move(values));
    table.lines.push_back(static_cast<unsigned>(row + 1));
  }
  DifferentNames names_so_far;
  for (std::string& name : table.header) name = names_so_far.different(name);
  return table;
}

}  // namespace bentaxis::foreign
