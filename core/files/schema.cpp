#include "bentaxis/files/schema.h"

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/words.h"

namespace bentaxis {
namespace {

using Json = nlohmann::ordered_json;

bool is_integer(const Parameter& p) { return std::holds_alternative<IntegerField>(p.field); }
bool has_default(const Parameter& p) {
  return p.fallback.value.has_value() || p.fallback.computed != nullptr;
}
bool always_required(const Parameter& p) {
  return !has_default(p) && p.active.words.empty() && p.part == nullptr;
}

// The condition under which a parameter without a default is required, where it is not always.
const When* required_when(const Parameter& p) {
  if (has_default(p)) return nullptr;
  if (!p.active.words.empty()) return &p.active;
  return p.part != nullptr && !p.part->needed.words.empty() ? &p.part->needed : nullptr;
}

Json json_of(const Value& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

// ---- JSON Schema
// ---------------------------------------------------------------------------------

void add_range(Json& schema, const NumberRange& range, bool integer) {
  const auto bound = [&](double value) {
    return integer ? Json(static_cast<long>(value)) : Json(value);
  };
  if (std::isfinite(range.low))
    schema[range.low_open ? "exclusiveMinimum" : "minimum"] = bound(range.low);
  if (std::isfinite(range.high) && range.high != std::numeric_limits<int>::max())
    schema[range.high_open ? "exclusiveMaximum" : "maximum"] = bound(range.high);
}

std::string description(const Parameter& p) {
  std::string text = p.symbol.empty() ? p.meaning : p.symbol + ": " + p.meaning;
  if (p.unit.name[0] != '\0') text += ", " + std::string(p.unit.name);
  if (!p.range_words.empty()) text += "; " + p.range_words;
  if (!p.fallback.words.empty()) text += "; default: " + p.fallback.words;
  if (!p.active.words.empty()) text += "; with " + to_text(p.active);
  return text;
}

Json schema_of(const Parameter& p) {
  Json schema;
  schema["description"] = description(p);
  if (std::holds_alternative<NumberField>(p.field) || is_integer(p)) {
    schema["type"] = is_integer(p) ? "integer" : "number";
    add_range(schema, p.range, is_integer(p));
  } else if (std::holds_alternative<FlagField>(p.field)) {
    schema["type"] = "boolean";
  } else if (std::holds_alternative<PairField>(p.field)) {
    Json item = {{"type", "number"}};
    add_range(item, p.range, false);
    schema["type"] = "array";
    schema["items"] = item;
    schema["minItems"] = schema["maxItems"] = 2;
  } else {
    schema["type"] = "string";
    if (!p.words.empty()) schema["enum"] = p.words;
  }
  if (p.fallback.value) schema["default"] = json_of(*p.fallback.value);
  return schema;
}

// "Where the key is one of these words": of an object that has the key.
Json condition(const When& when) {
  return {{"properties", {{when.key, {{"enum", when.words}}}}}, {"required", {when.key}}};
}

Json object(const std::string& meaning) {
  Json schema;
  if (!meaning.empty()) schema["description"] = meaning;
  schema["type"] = "object";
  schema["properties"] = Json::object();
  schema["additionalProperties"] = false;
  return schema;
}

void add_keys(Json& schema, const Table& table) {
  std::map<std::string, std::pair<When, Json>> needed;  // by the words of the condition
  for (const Parameter& p : table.parameters) {
    schema["properties"][p.key] = schema_of(p);
    if (always_required(p)) schema["required"].push_back(p.key);
    if (const When* when = required_when(p); when != nullptr && when->table == table.name) {
      auto& entry = needed.try_emplace(to_text(*when), *when, Json::array()).first->second;
      entry.second.push_back(p.key);
    }
  }
  for (const auto& [words, entry] : needed)
    schema["allOf"].push_back(
        {{"if", condition(entry.first)}, {"then", {{"required", entry.second}}}});
}

// ---- Markdown
// ------------------------------------------------------------------------------------

std::string code(const std::string& text) { return "`" + text + "`"; }

std::string range_cell(const Parameter& p) {
  if (!p.range_words.empty()) return p.range_words;
  if (!p.words.empty()) {
    std::string words;
    for (const std::string& word : p.words) words += (words.empty() ? "\"" : ", \"") + word + "\"";
    return words;
  }
  if (std::holds_alternative<FlagField>(p.field)) return "true, false";
  if (std::holds_alternative<NumberField>(p.field) || is_integer(p)) {
    NumberRange range = p.range;
    if (range.high == std::numeric_limits<int>::max())
      range.high = std::numeric_limits<double>::infinity();
    const bool any = !std::isfinite(range.low) && !std::isfinite(range.high);
    std::string text = any ? "" : range.text();
    if (text.starts_with("in ")) text = text.substr(3);
    return is_integer(p) ? "integer " + text : text;
  }
  return "";
}

std::string default_cell(const Parameter& p) {
  if (!p.fallback.words.empty()) return p.fallback.words;
  return p.fallback.value ? to_text(*p.fallback.value) : "required";
}

std::string meaning_cell(const Parameter& p) {
  const When* when = !p.active.words.empty() ? &p.active
                     : p.part != nullptr     ? &p.part->needed
                                             : nullptr;
  if (when != nullptr && when->words.empty()) return p.meaning;
  return p.meaning + (when != nullptr ? " (with " + code(to_text(*when)) + ")" : "");
}

Json uncertainty_schema() {
  Json schema = object("distributions of parameters that are not known exactly, by name");
  schema["additionalProperties"] = {{"type", "string"},
                                    {"description",
                                     "normal(mean, s), uniform(low, high), triangular(low, mode, "
                                     "high), lognormal(median, s), normal(s), relative(s)"}};
  Json name = {{"type", "string"}};
  schema["properties"]["correlation"] = {
      {"description", "pairs of parameters with their correlation, in [-1, 1]"},
      {"type", "array"},
      {"items",
       {{"type", "array"},
        {"items", {name, name, {{"type", "number"}, {"minimum", -1}, {"maximum", 1}}}},
        {"minItems", 3},
        {"maxItems", 3}}}};
  return schema;
}

}  // namespace

std::string case_schema(const Registry& registry) {
  Json schema;
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "bentaxis case file";
  schema.update(object(""));
  for (const Table& table : registry.tables) {
    if (table.name.empty()) {
      add_keys(schema, table);
      continue;
    }
    Json* parent = &schema;
    std::string key = table.name;
    if (const auto dot = key.find('.'); dot != std::string::npos) {
      Json& outer = schema["properties"][key.substr(0, dot)];
      if (outer.is_null()) outer = object("");
      parent = &outer;
      key = key.substr(dot + 1);
    }
    Json child = object(table.meaning);
    add_keys(child, table);
    (*parent)["properties"][key] = child;
    if (table.part == nullptr && table.presence == Presence::required)
      (*parent)["required"].push_back(key);
    if (table.part != nullptr && !table.part->needed.words.empty()) {
      const When& when = table.part->needed;
      Json met = {{"properties", {{when.table, condition(when)}}}, {"required", {when.table}}};
      // Also where the key is left out, if its default is one of the words.
      const auto& fallback = parameter_of(registry, when.table, when.key).fallback.value;
      const auto* const word = fallback ? std::get_if<std::string>(&*fallback) : nullptr;
      if (word != nullptr && contains(when.words, *word)) {
        met.erase("required");
        met["properties"][when.table].erase("required");
      }
      schema["allOf"].push_back({{"if", met}, {"then", {{"required", {key}}}}});
    }
  }
  schema["properties"]["uncertainty"] = uncertainty_schema();
  return schema.dump(2) + "\n";
}

std::string markdown_table(const std::string& name, const Registry& registry) {
  std::set<std::string> names;
  const Table* table = nullptr;
  for (const Table& known : registry.tables) {
    names.insert(known.name);
    if (known.name == name) table = &known;
  }
  if (table == nullptr) throw InputError("no table [" + name + "]" + suggestion(name, names));
  bool with_practice = false;
  bool with_symbols = false;
  for (const Parameter& p : table->parameters) {
    with_practice = with_practice || !p.practice.empty();
    with_symbols = with_symbols || !p.symbol.empty();
  }
  std::string text = "| key |";
  std::string rule = "|---|";
  const auto column = [&](const char* heading) {
    text += " " + std::string(heading) + " |";
    rule += "---|";
  };
  if (with_symbols) column("symbol");
  for (const char* heading : {"meaning", "range", "default"}) column(heading);
  if (with_practice) column("in practice, source");
  text += "\n" + rule + "\n";
  const auto cell = [&](const std::string& content) {
    text += content.empty() ? " |" : " " + content + " |";
  };
  for (const Parameter& p : table->parameters) {
    text += "|";
    cell(code(p.key));
    if (with_symbols) cell(p.symbol);
    cell(meaning_cell(p));
    cell(range_cell(p));
    cell(default_cell(p));
    if (with_practice) cell(p.practice);
    text += "\n";
  }
  return text;
}

}  // namespace bentaxis
