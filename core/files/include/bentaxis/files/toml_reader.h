// Strict reading of TOML files: every key is asked for by name, has a type and a range, and what
// was not asked for is an error. Case files and descriptions of reference data are read with it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {

/// A text as TOML writes it: in quotes, escaped.
std::string toml_text(const std::string& text);
/// A text for a message: control characters are escaped.
std::string one_line(const std::string& text);

/// One table of a file. Remembers which keys were asked for, so that the rest are errors. All
/// errors are InputError with one line: file, line, key, value, what is allowed.
class TableReader {
 public:
  bool has(const std::string& key);
  /// A key that will be asked for: it is none that was misspelt.
  void expect(const std::string& key) { expected_.insert(key); }
  /// A key of the file that may be another word for `key`, which is said where that is missing.
  void may_mean(const std::string& word, const std::string& key) { other_words_[key] = word; }
  /// Keys that the table lacks as well, which is said where one is missing.
  void missing_too(std::vector<std::string> keys) { missing_too_ = std::move(keys); }
  /// Line of the table's heading, or of a key of it; 0 where unknown.
  int line() const { return line_; }

  double number(const std::string& key, NumberRange range, std::optional<double> fallback = {});
  int integer(const std::string& key, int low, int high, std::optional<int> fallback = {});
  std::string text(const std::string& key, std::optional<std::string> fallback = {});
  bool flag(const std::string& key, bool fallback);
  /// Any value, as text: for those who pass it on.
  std::string any(const std::string& key);
  /// One of a few words; returns its index.
  std::size_t choice(const std::string& key, const std::vector<std::string>& words,
                     std::optional<std::size_t> fallback = {});
  /// [a, b].
  std::pair<double, double> pair(const std::string& key, NumberRange range,
                                 std::optional<std::pair<double, double>> fallback = {});
  /// [1, 2.5, ...], finite; empty where the key is missing.
  std::vector<double> numbers(const std::string& key);
  /// ["a", "b", ...]; empty where the key is missing.
  std::vector<std::string> texts(const std::string& key);
  /// [["a", "b", 0.5], ...]: two texts and a number each; empty where the key is missing.
  struct Link {
    std::string first, second;
    double number = 0;
  };
  std::vector<Link> links(const std::string& key);

  /// A table below this one; an error where it is missing or no table.
  TableReader table(const std::string& key);
  /// The same, read as an empty table where it is missing.
  TableReader optional_table(const std::string& key);
  /// [[key]]; empty where missing.
  std::vector<TableReader> tables(const std::string& key);
  /// Names of all keys of this table, in the order of the alphabet: for tables whose keys are
  /// names.
  std::vector<std::string> keys() const;

  /// Every key that is there must have been asked for.
  /// @param meant  what is probably meant by a key that was not, as the end of a message; by
  ///               default the nearest of those that were
  void finish(const std::function<std::string(const std::string&)>& meant = {}) const;
  /// Refuses the value of a key.
  [[noreturn]] void fail(const std::string& key, const std::string& why) const;
  /// "; is "..." meant?" where a key of the table was probably meant to be `key`.
  std::string misspelt(const std::string& key) const;

 private:
  friend class TomlFile;
  struct Node;  // keeps the parsed file alive
  TableReader(std::string file, std::string name, std::shared_ptr<const Node> table, int line,
              std::vector<InputEntry>* entries);

  std::string place(int line) const;
  std::string place_of(const Node& node, const std::string& key) const;
  const std::string* change_of(const std::string& key) const;
  std::string label(const std::string& key) const;
  std::string written(const Node& node, const std::string& key) const;
  [[noreturn]] void fail_at(const Node& node, const std::string& key, const std::string& why) const;
  std::optional<Node> find(const std::string& key, const std::string& wanted, bool optional);
  double number_of(const Node& node, const std::string& key, NumberRange range,
                   bool recorded = true);
  double defaulted(const std::string& key, double value);
  void record(const std::string& key, std::string value, bool by_default = false);
  TableReader below(const std::string& key, const Node& node);

  std::string file_, name_;
  std::shared_ptr<const Node> table_;  // null where the table is missing
  int line_ = 0;
  std::vector<InputEntry>* entries_ = nullptr;
  std::set<std::string> known_, expected_;
  std::map<std::string, std::string> other_words_;
  std::vector<std::string> missing_too_;
};

/// A parsed TOML file.
class TomlFile {
 public:
  /// Parses text already in memory; `file` is used in messages. @throws InputError
  TomlFile(const std::string& text, std::filesystem::path file);
  /// Reads a file; `what` says in a message what it should have been ("case file").
  /// @throws InputError
  static TomlFile read(const std::filesystem::path& file, const std::string& what);

  /// Sets a key as if the file said so; messages then name the change instead of file and line.
  /// @param table  "pump", "assumptions.analytic"; "" for the top level
  /// @param value  as in TOML, or a bare word for a text. @throws InputError where it is neither
  void change(const std::string& table, const std::string& key, const std::string& value);

  const std::filesystem::path& file() const { return file_; }
  /// The top level. Keys read are appended to `entries` where given.
  TableReader root(std::vector<InputEntry>* entries = nullptr) const;

 private:
  std::filesystem::path file_;
  std::shared_ptr<const TableReader::Node> root_;
};

}  // namespace bentaxis
