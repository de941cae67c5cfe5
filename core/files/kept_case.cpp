#include "bentaxis/files/kept_case.h"

#include <algorithm>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/text.h"

namespace bentaxis {
namespace {

constexpr const char* kRoot = "/bentaxis-kept-case/";  // a path that no file has

// A name that no other curve has.
std::string name_for(const std::filesystem::path& file,
                     const std::vector<KeptCase::Curve>& others) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(others.begin(), others.end(),
                       [&](const KeptCase::Curve& other) { return other.name == name; });
  };
  std::string name = "curves/" + file.filename().string();
  for (int i = 2; taken(name); ++i)
    name = "curves/" + std::to_string(i) + "_" + file.filename().string();
  return name;
}

// A curve's bytes, which must be those that the case was read from.
std::string curve_of(const Case& the_case, const std::filesystem::path& file) {
  std::string bytes = bytes_of(file);
  const std::string sha256 = sha256_of(bytes);
  const auto is_other = [&](const InputFile& read) {
    return read.file == file && read.sha256 != sha256;
  };
  if (std::any_of(the_case.inputs.begin(), the_case.inputs.end(), is_other))
    throw InputError(file.string() + ": has changed since the case was read: read the case again");
  return bytes;
}

}  // namespace

std::string bytes_of(const std::filesystem::path& file) {
  return read_input_file(file, {"an input file", kLargestTable});
}

KeptCase kept_case(const Case& the_case) {
  KeptCase kept;
  Case copy = the_case;
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters) {
      const auto* curve = std::get_if<CurveField>(&parameter.field);
      if (curve == nullptr || !is_active(table, parameter, standard_registry(), copy)) continue;
      std::filesystem::path* file = curve->file.write(copy);
      if (file == nullptr || file->empty()) continue;
      kept.curves.push_back({name_for(*file, kept.curves), curve_of(the_case, *file)});
      *file = kRoot + kept.curves.back().name;
    }
  // The writer names curves by their whole paths.
  kept.text = replace_all(case_text(copy), std::string("\"") + kRoot, "\"");
  return kept;
}

}  // namespace bentaxis
