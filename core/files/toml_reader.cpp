#include "bentaxis/files/toml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/words.h"
#include "toml_parser.h"

namespace bentaxis {
namespace {

std::string shortened(const std::string& text) {
  if (text.size() <= kShownOfValue) return text;
  std::size_t end = kShownOfValue;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "..";
}

// A number at the start of a text as it is written there; empty where it is another one.
std::string literal(const std::string& text, std::size_t at, double value) {
  const auto ends = text.find_first_not_of("0123456789abcdefinxoABCDEFX+-._", at);
  std::string word = at < text.size() ? text.substr(at, ends - at) : "";
  std::string digits = word;
  std::erase(digits, '_');
  std::string_view rest = digits;
  if (rest.starts_with('+')) rest.remove_prefix(1);
  const bool hexadecimal = rest.starts_with("0x");
  if (hexadecimal) rest.remove_prefix(2);
  double number = 0;
  const auto [stop, error] =
      std::from_chars(rest.data(), rest.data() + rest.size(), number,
                      hexadecimal ? std::chars_format::hex : std::chars_format::general);
  const bool same = error == std::errc() && stop == rest.data() + rest.size() && number == value;
  return same ? word : "";
}

std::string quoted(const toml::node& node) {
  std::ostringstream out;
  out << toml::default_formatter(node, toml::format_flags::none);
  std::string text = out.str();
  if (const auto newline = text.find('\n'); newline != std::string::npos) text.resize(newline);
  return text;
}

// Takes the file apart into table by table; null where a key on the way is no table.
toml::table* table_at(toml::table& root, const std::string& name) {
  toml::table* table = &root;
  std::istringstream parts(name);
  for (std::string part; table != nullptr && std::getline(parts, part, '.');) {
    table->insert(part, toml::table{});  // unless it is there
    table = table->get_as<toml::table>(part);
  }
  return table;
}

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

}  // namespace

std::string toml_text(const std::string& text) {
  const toml::value<std::string> value(text);
  std::ostringstream out;
  out << toml::default_formatter(value, toml::format_flags::allow_unicode_strings);
  return out.str();
}

std::string one_line(const std::string& text) {
  const bool plain =
      std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  return plain ? text : toml_text(text);
}

// Places of positions in a text; columns count characters, which are one byte or more. Goes on from
// the position before where it can: values are asked for in their order, more or less.
class Offsets {
 public:
  std::size_t of(const std::string& text, const toml::source_position& position) {
    if (position.line < line_ || (position.line == line_ && position.column < column_)) *this = {};
    for (; line_ < position.line; ++line_) {
      const std::size_t end = text.find('\n', at_);
      if (end == std::string::npos) return text.size();
      at_ = end + 1;
      column_ = 1;
    }
    const auto starts_character = [&](std::size_t i) {
      return (static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U;
    };
    for (; column_ < position.column && at_ < text.size(); ++column_) do
        ++at_;
      while (at_ < text.size() && !starts_character(at_));
    return at_;
  }

 private:
  std::size_t at_ = 0;
  toml::source_index line_ = 1, column_ = 1;
};

// A parsed file, and what was changed in it: "pump.tilt_deg" -> the value as given.
struct Document {
  std::string text;
  toml::table table;
  std::map<std::string, std::string> changes;
  Offsets offsets = {};
};

struct TableReader::Node {
  std::shared_ptr<Document> file;
  const toml::node* node;

  const toml::table* table() const { return node->as_table(); }
};

TableReader::TableReader(std::string file, std::string name, std::shared_ptr<const Node> table,
                         int line, std::vector<InputEntry>* entries)
    : file_(std::move(file)),
      name_(std::move(name)),
      table_(std::move(table)),
      line_(line),
      entries_(entries) {}

bool TableReader::has(const std::string& key) {
  known_.insert(key);
  return table_ != nullptr && table_->table()->contains(key);
}

double TableReader::number(const std::string& key, NumberRange range,
                           std::optional<double> fallback) {
  const auto node = find(key, range.text(), fallback.has_value());
  return node ? number_of(*node, key, range) : defaulted(key, *fallback);
}

int TableReader::integer(const std::string& key, int low, int high, std::optional<int> fallback) {
  const NumberRange range{static_cast<double>(low), static_cast<double>(high)};
  const std::string wanted =
      "an integer " +
      (high == std::numeric_limits<int>::max() ? ">= " + number_text(low) : range.text());
  const auto node = find(key, wanted, fallback.has_value());
  if (!node) return static_cast<int>(defaulted(key, *fallback));
  if (!node->node->is_integer()) fail_at(*node, key, "must be " + wanted);
  const auto value = node->node->as_integer()->get();
  if (value < low) fail_at(*node, key, "must be " + wanted);
  if (value > high) fail_at(*node, key, "must be an integer " + range.text());
  record(key, written(*node, key));
  return static_cast<int>(value);
}

std::string TableReader::text(const std::string& key, std::optional<std::string> fallback) {
  const auto node = find(key, "a text", fallback.has_value());
  if (!node) {
    record(key, *fallback, true);
    return *fallback;
  }
  if (!node->node->is_string()) fail_at(*node, key, "must be a text in quotes");
  record(key, node->node->as_string()->get());
  return node->node->as_string()->get();
}

std::string TableReader::any(const std::string& key) {
  return written(*find(key, "a value", false), key);
}

bool TableReader::flag(const std::string& key, bool fallback) {
  const auto node = find(key, "true or false", true);
  if (!node) return fallback;
  if (!node->node->is_boolean()) fail_at(*node, key, "must be true or false");
  record(key, quoted(*node->node));
  return node->node->as_boolean()->get();
}

std::size_t TableReader::choice(const std::string& key, const std::vector<std::string>& words,
                                std::optional<std::size_t> fallback) {
  const std::string wanted = "\"" + joined(words, "\" or \"") + "\"";
  const auto node = find(key, wanted, fallback.has_value());
  if (!node) {
    record(key, words[*fallback], true);
    return *fallback;
  }
  const auto* value = node->node->as_string();
  const auto it = value == nullptr ? words.end() : std::find(words.begin(), words.end(), **value);
  if (it == words.end()) fail_at(*node, key, "must be " + wanted);
  record(key, **value);
  return static_cast<std::size_t>(it - words.begin());
}

std::pair<double, double> TableReader::pair(const std::string& key, NumberRange range,
                                            std::optional<std::pair<double, double>> fallback) {
  const auto node = find(key, "a pair of numbers [a, b]", fallback.has_value());
  if (!node) {
    record(key, "[" + number_text(fallback->first) + ", " + number_text(fallback->second) + "]",
           true);
    return *fallback;
  }
  const toml::array* array = node->node->as_array();
  if (array == nullptr || array->size() != 2)
    fail_at(*node, key, "must be a pair of numbers [a, b]");
  const std::pair values{number_of({node->file, &(*array)[0]}, key, range, false),
                         number_of({node->file, &(*array)[1]}, key, range, false)};
  record(key, written(*node, key));
  return values;
}

std::vector<double> TableReader::numbers(const std::string& key) {
  const auto node = find(key, "a list of numbers", true);
  std::vector<double> values;
  if (!node) return values;
  const toml::array* array = node->node->as_array();
  if (array == nullptr) fail_at(*node, key, "must be a list of numbers [1, 2.5]");
  for (const toml::node& item : *array)
    values.push_back(number_of({node->file, &item}, key, kAny, false));
  record(key, quoted(*node->node));
  return values;
}

std::vector<std::string> TableReader::texts(const std::string& key) {
  const auto node = find(key, "a list of texts", true);
  std::vector<std::string> values;
  if (!node) return values;
  const toml::array* array = node->node->as_array();
  if (array == nullptr) fail_at(*node, key, "must be a list of texts [\"a\", \"b\"]");
  for (const toml::node& item : *array) {
    if (!item.is_string()) fail_at(*node, key, "must be a list of texts [\"a\", \"b\"]");
    values.push_back(item.as_string()->get());
  }
  record(key, quoted(*node->node));
  return values;
}

std::vector<TableReader::Link> TableReader::links(const std::string& key) {
  const char* const wanted = "must be a list of lists [[\"a\", \"b\", 0.5]]";
  const auto node = find(key, "a list of lists", true);
  std::vector<Link> links;
  if (!node) return links;
  const toml::array* all = node->node->as_array();
  if (all == nullptr) fail_at(*node, key, wanted);
  for (const toml::node& item : *all) {
    const toml::array* one = item.as_array();
    if (one == nullptr || one->size() != 3 || !(*one)[0].is_string() || !(*one)[1].is_string())
      fail_at(*node, key, wanted);
    links.push_back({(*one)[0].as_string()->get(), (*one)[1].as_string()->get(),
                     number_of({node->file, &(*one)[2]}, key, kAny, false)});
  }
  record(key, written(*node, key));
  return links;
}

TableReader TableReader::table(const std::string& key) {
  if (!has(key))
    throw InputError(place(line_) + "table [" + (name_.empty() ? "" : name_ + ".") + key +
                     "] is missing" + misspelt(key));
  return below(key, {table_->file, table_->table()->get(key)});
}

TableReader TableReader::optional_table(const std::string& key) {
  if (has(key)) return table(key);
  return {file_, (name_.empty() ? "" : name_ + ".") + key, nullptr, line_, entries_};
}

std::vector<TableReader> TableReader::tables(const std::string& key) {
  std::vector<TableReader> list;
  if (!has(key)) return list;
  const Node all{table_->file, table_->table()->get(key)};
  const toml::array* array = all.node->as_array();
  if (array == nullptr) fail_at(all, key, "must be a list of tables [[" + key + "]]");
  for (const toml::node& item : *array) list.push_back(below(key, {table_->file, &item}));
  return list;
}

TableReader TableReader::below(const std::string& key, const Node& node) {
  const std::string name = (name_.empty() ? "" : name_ + ".") + key;
  if (!node.node->is_table())
    throw InputError(place(line_of(*node.node)) + name + " = " + shortened(quoted(*node.node)) +
                     ": must be a table [" + name + "]");
  return {file_, name, std::make_shared<const Node>(node), line_of(*node.node), entries_};
}

std::vector<std::string> TableReader::keys() const {
  std::vector<std::string> names;
  if (table_ != nullptr)
    for (const auto& [key, node] : *table_->table()) names.emplace_back(key.str());
  return names;
}

void TableReader::finish(const std::function<std::string(const std::string&)>& meant) const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_->table()) {
    const std::string word(key.str());
    if (known_.count(word) > 0) continue;
    std::string message =
        node.is_table() && name_.empty()
            ? "unknown table [" + word + "]"
            : "unknown key \"" + word + "\"" + (name_.empty() ? "" : " in [" + name_ + "]");
    message += meant ? meant(word) : suggestion(word, known_);
    if (change_of(word) != nullptr)
      throw InputError(place_of({table_->file, &node}, word) + message);
    throw InputError(place(line_of(node) > 0 ? line_of(node) : line_) + message);
  }
}

void TableReader::fail(const std::string& key, const std::string& why) const {
  const toml::node* node = table_ == nullptr ? nullptr : table_->table()->get(key);
  if (node != nullptr) fail_at({table_->file, node}, key, why);
  throw InputError(place(line_) + label(key) + ": " + why);
}

std::string TableReader::misspelt(const std::string& key) const {
  constexpr double kAlike = 0.7;  // the key that is there may also be one that is asked for later
  if (table_ == nullptr) return "";
  std::optional<std::string> word;
  if (const auto other = other_words_.find(key); other != other_words_.end()) word = other->second;
  std::set<std::string> unknown;
  for (const auto& [found, node] : *table_->table())
    if (const std::string name(found.str()); known_.count(name) + expected_.count(name) == 0)
      unknown.insert(name);
  if (!word) word = meant(key, unknown, kAlike);
  if (!word) return "";
  return "; is \"" + *word + "\" in line " + std::to_string(line_of(*table_->table()->get(*word))) +
         " meant?";
}

std::string TableReader::place(int line) const {
  return file_ + (line > 0 ? ":" + std::to_string(line) : "") + ": ";
}

std::string TableReader::label(const std::string& key) const {
  return (name_.empty() ? "" : "[" + name_ + "] ") + key;
}

void TableReader::fail_at(const Node& node, const std::string& key, const std::string& why) const {
  if (change_of(key) != nullptr) throw InputError(place_of(node, key) + why);
  // Of a list only the beginning, which is not worth the time that all of it takes.
  throw InputError(place_of(node, key) + label(key) + " = " + shortened(written(node, key)) + ": " +
                   why);
}

const std::string* TableReader::change_of(const std::string& key) const {
  if (table_ == nullptr) return nullptr;
  const auto& changes = table_->file->changes;
  const auto found = changes.find(name_.empty() ? key : name_ + "." + key);
  return found == changes.end() ? nullptr : &found->second;
}

// A value as whoever wrote it wrote it: toml++ prints 24.92 with its 17 digits.
std::string TableReader::written(const Node& node, const std::string& key) const {
  if (const toml::array* array = node.node->as_array(); array != nullptr) {
    const auto text_of = [&](const toml::node& item) { return written({node.file, &item}, key); };
    return "[" + joined(*array, ", ", text_of) + "]";
  }
  if (!node.node->is_number()) return quoted(*node.node);
  const double value = *node.node->value<double>();
  const std::string* const change = change_of(key);
  std::string word =
      change != nullptr
          ? literal(*change, 0, value)
          : literal(node.file->text,
                    node.file->offsets.of(node.file->text, node.node->source().begin), value);
  if (!word.empty()) return word;
  return node.node->is_integer() || !std::isfinite(value) ? quoted(*node.node) : number_text(value);
}

// Where a value comes from: file and line, or the change with the value as given.
std::string TableReader::place_of(const Node& node, const std::string& key) const {
  if (const std::string* value = change_of(key); value != nullptr)
    return "--set " + (name_.empty() ? "" : name_ + ".") + key + "=" + shortened(*value) + ": ";
  return place(line_of(*node.node));
}

std::optional<TableReader::Node> TableReader::find(const std::string& key,
                                                   const std::string& wanted, bool optional) {
  known_.insert(key);
  const toml::node* node = table_ == nullptr ? nullptr : table_->table()->get(key);
  if (node != nullptr) return Node{table_->file, node};
  if (!optional) {
    std::string too;
    for (const std::string& other : missing_too_)
      too += (too.empty() ? "; missing too: " : ", ") + other;
    throw InputError(place(line_) + label(key) + " is missing: must be " + wanted + misspelt(key) +
                     too);
  }
  return std::nullopt;
}

double TableReader::number_of(const Node& node, const std::string& key, NumberRange range,
                              bool recorded) {
  double value = 0;
  if (node.node->is_integer()) {
    value = static_cast<double>(node.node->as_integer()->get());
  } else if (node.node->is_floating_point()) {
    value = node.node->as_floating_point()->get();
  } else {
    const auto text = node.node->value<std::string>();
    fail_at(node, key,
            "must be " + range.text_of("a number") + (text ? decimal_point_hint(*text) : ""));
  }
  if (!std::isfinite(value)) fail_at(node, key, "must be " + range.text_of("a finite number"));
  if (!range.contains(value)) fail_at(node, key, "must be " + range.text());
  if (recorded) record(key, written(node, key));
  return value;
}

double TableReader::defaulted(const std::string& key, double value) {
  record(key, number_text(value), true);
  return value;
}

void TableReader::record(const std::string& key, std::string value, bool by_default) {
  if (entries_ != nullptr)
    entries_->push_back({name_, key, std::move(value), by_default, change_of(key) != nullptr});
}

TomlFile::TomlFile(const std::string& text, std::filesystem::path file) : file_(std::move(file)) {
  try {
    check_toml_encoding(text);
    const auto document =
        std::make_shared<Document>(Document{text, parsed_toml(text, file_.string()), {}});
    root_ =
        std::make_shared<const TableReader::Node>(TableReader::Node{document, &document->table});
  } catch (const toml::parse_error& error) {
    std::string what = slip_in(text, error.source().begin.line);
    if (what.empty()) what = error.description();
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw InputError(file_.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                     what);
  } catch (const TomlRefusal& refusal) {
    throw InputError(file_.string() + (refusal.line > 0 ? ":" + std::to_string(refusal.line) : "") +
                     ": " + refusal.why);
  }
}

TomlFile TomlFile::read(const std::filesystem::path& file, const std::string& what) {
  const std::string name = "a " + what;
  const std::string text = read_input_file(file, {name.c_str(), kLargestSettings});
  InputLog::note(file, text);
  return {text, file};
}

void TomlFile::change(const std::string& table, const std::string& key, const std::string& value) {
  toml::table* const parent = table_at(root_->file->table, table);
  if (parent == nullptr) return;  // the file has no table there, which whoever reads it refuses
  const std::string name = table.empty() ? key : table + "." + key;
  toml::table parsed;
  try {
    try {
      parsed = parsed_toml("value = " + value, "");
    } catch (const toml::parse_error&) {
      try {
        parsed = parsed_toml("value = " + toml_text(value), "");  // a bare word
      } catch (const toml::parse_error&) {
      }
      if (parsed["value"].value<std::string>() != value)
        throw InputError("--set " + name + ": must be text in UTF-8");
    }
  } catch (const TomlRefusal& refusal) {
    throw InputError("--set " + name + ": " + refusal.why);
  }
  if (parsed.size() != 1) throw InputError("--set " + name + ": must be one value");
  parent->insert_or_assign(key, std::move(*parsed.get("value")));
  root_->file->changes[name] = value;
}

TableReader TomlFile::root(std::vector<InputEntry>* entries) const {
  return {file_.string(), "", root_, 0, entries};
}

}  // namespace bentaxis
