#include "python_case.h"

#include <algorithm>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"

namespace bentaxis::python {
namespace {

std::string key_of(const bentaxis::Table& table, const Parameter& parameter) {
  return (table.name.empty() ? "" : table.name + ".") + parameter.key;
}

// Of two for one key the last counts, in the place of the first.
void add(PythonCase::Changes& all, const PythonCase::Changes& more) {
  for (const auto& [key, value] : more) {
    const auto same = [&key = key](const auto& one) { return one.first == key; };
    const auto old = std::find_if(all.begin(), all.end(), same);
    if (old != all.end())
      old->second = value;
    else
      all.emplace_back(key, value);
  }
}

Case parsed(const std::string& text, const std::filesystem::path& file,
            const PythonCase::Changes& changes) {
  std::vector<std::string> lines;
  for (const auto& [key, value] : changes) lines.push_back(key + "=" + value);
  return parse_case(text, file, lines);
}

}  // namespace

PythonCase PythonCase::read(const std::filesystem::path& file, const Changes& changes) {
  const std::filesystem::path place = std::filesystem::absolute(file).lexically_normal();
  const std::string text = read_input_file(place, {"a case file", kLargestSettings});
  return {text, place, changes, sha256_of(text)};
}

PythonCase::PythonCase(std::string text, const std::filesystem::path& file, const Changes& changes,
                       std::string sha256)
    : text_(std::move(text)),
      file_(std::filesystem::absolute(file).lexically_normal()),
      sha256_(std::move(sha256)) {
  change(changes);
}

void PythonCase::change(const Changes& changes) {
  Changes all = changes_;
  add(all, changes);
  Case changed = parsed(text_, file_, all);
  if (!sha256_.empty()) changed.inputs.insert(changed.inputs.begin(), {file_, sha256_});
  case_ = std::move(changed);
  changes_ = std::move(all);
}

std::vector<std::string> PythonCase::keys() const {
  std::vector<std::string> keys;
  for (const bentaxis::Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters)
      if (is_active(table, parameter, standard_registry(), case_) && value_of(parameter, case_))
        keys.push_back(key_of(table, parameter));
  return keys;
}

std::optional<Value> PythonCase::value(const std::string& key) const {
  const Parameter* const parameter = parameter_called(key);
  if (parameter == nullptr) return std::nullopt;
  return value_of(*parameter, case_);
}

std::vector<std::string> all_keys() {
  std::vector<std::string> keys;
  for (const bentaxis::Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters) keys.push_back(key_of(table, parameter));
  return keys;
}

const Parameter* parameter_called(const std::string& key) {
  for (const bentaxis::Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters)
      if (key_of(table, parameter) == key) return &parameter;
  return nullptr;
}

}  // namespace bentaxis::python
