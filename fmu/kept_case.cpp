#include "kept_case.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/registry.h"

namespace bentaxis::fmu {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  if (!in || !(bytes << in.rdbuf())) throw InputError(file.string() + ": cannot be read");
  std::string all = std::move(bytes).str();
  if (all.find('\0') != std::string::npos)
    throw InputError(file.string() +
                     ": is a workbook or a .mat file, which a unit cannot read: save it as CSV");
  return all;
}

constexpr const char* kRoot = "/bentaxis-unit/";  // a path that no file has

// A name in the archive that no other curve has; the same file has one name.
std::string name_for(const std::filesystem::path& file, const std::vector<ArchiveFile>& others) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(others.begin(), others.end(),
                       [&](const ArchiveFile& other) { return other.name == name; });
  };
  std::string name = "curves/" + file.filename().string();
  for (int i = 2; taken(name); ++i)
    name = "curves/" + std::to_string(i) + "_" + file.filename().string();
  return name;
}

}  // namespace

KeptCase kept_case(const Case& the_case) {
  KeptCase kept;
  Case copy = the_case;
  copy.uncertainty = {};  // a unit has one value of each
  const View view = view_of(copy);
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters) {
      const auto* curve = std::get_if<CurveField>(&parameter.field);
      if (curve == nullptr || !is_active(table, parameter, standard_registry(), as_const(view)))
        continue;
      std::filesystem::path* file = curve->file.write(view);
      if (file == nullptr || file->empty()) continue;
      kept.curves.push_back({name_for(*file, kept.curves), bytes_of(*file)});
      *file = kRoot + kept.curves.back().name;
    }
  kept.text = case_text(copy);
  // The writer names curves by their whole paths.
  const std::string whole = std::string("\"") + kRoot;
  for (std::size_t at = kept.text.find(whole); at != std::string::npos;
       at = kept.text.find(whole, at))
    kept.text.replace(at, whole.size(), "\"");
  return kept;
}

}  // namespace bentaxis::fmu
