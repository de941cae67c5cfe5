// A case that Python reads and changes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/registry.h"

namespace bentaxis::python {

/// A case as the text of its file and what was changed since, read anew at every change: so that a
/// value is refused for what, and in the words in which, `--set` refuses it, and defaults follow
/// the parameters that they are made of.
class PythonCase {
 public:
  /// Key and value as TOML.
  using Changes = std::vector<std::pair<std::string, std::string>>;

  /// @throws InputError
  static PythonCase read(const std::filesystem::path& file, const Changes& changes);
  /// @param file    in messages, and where files that the case names are
  /// @param sha256  of the file's bytes; empty where the text was not read from it
  PythonCase(std::string text, const std::filesystem::path& file, const Changes& changes,
             std::string sha256 = {});

  /// All together or, where they are refused, none. @throws InputError
  void change(const Changes& changes);

  const Case& get() const { return case_; }
  /// For a computation, during which Python may change this one.
  Case copy() const { return case_; }
  const std::string& text() const { return text_; }
  const std::filesystem::path& file() const { return file_; }
  const Changes& changes() const { return changes_; }
  const std::string& sha256() const { return sha256_; }

  /// Keys that have a value in this case, in the order of the file.
  std::vector<std::string> keys() const;
  /// Nothing where there is no such parameter or it has no value here.
  std::optional<Value> value(const std::string& key) const;

 private:
  std::string text_;
  std::filesystem::path file_;  // absolute
  std::string sha256_;
  Changes changes_;  // one per key
  Case case_;
};

/// Every key of a case file.
std::vector<std::string> all_keys();
/// nullptr where there is none.
const Parameter* parameter_called(const std::string& key);

}  // namespace bentaxis::python
