#include "bentaxis/files/case_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/full_key.h"
#include "bentaxis/pump/input_limits.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/words.h"

namespace bentaxis {
namespace {

constexpr const char* kUncertainty = "uncertainty";  // the table whose keys are parameters

// The numbers of a registry by name: what a distribution can be of.
std::set<std::string> numbers_of(const Registry& registry) {
  std::set<std::string> names;
  for (const Table& table : registry.tables)
    for (const Parameter& parameter : table.parameters)
      for (const std::string& name : number_names(table, parameter)) names.insert(name);
  return names;
}

// Reads the tables of a registry in their order, which keeps the first error the one nearest to the
// top.
class CaseReader {
 public:
  CaseReader(const TomlFile& file, const Registry& registry)
      : registry_(registry), top_(file.root(&result_.entries)) {
    result_.file = file.file();
  }

  Case read() {
    for (const Table& table : registry_.tables)
      top_.expect(table.name.substr(0, table.name.find('.')));
    top_.expect(kUncertainty);
    for (const Table& table : registry_.tables) read_table(table);
    for (const auto& [name, parent] : parents_) parent.finish();
    if (top_.has(kUncertainty)) read_uncertainty(top_.table(kUncertainty));
    top_.finish();
    return std::move(result_);
  }

 private:
  bool holds(const When& when) const { return bentaxis::holds(when, registry_, result_); }

  void read_table(const Table& table) {
    if (table.name.empty()) {
      read_keys(top_, table);
      return;
    }
    const auto dot = table.name.rfind('.');
    TableReader* const parent = dot == std::string::npos ? &top_ : below(table.name.substr(0, dot));
    const std::string key = table.name.substr(dot + 1);  // npos + 1 is 0
    const bool present = parent != nullptr && parent->has(key);
    if (table.part != nullptr && !present && !holds(table.part->needed)) return;
    if (table.presence == Presence::silent && !present) {
      for (const Parameter& parameter : table.parameters)
        if (const auto value = default_of(parameter, result_)) store(parameter, result_, *value);
      return;
    }
    TableReader in =
        table.presence == Presence::required ? parent->table(key) : parent->optional_table(key);
    if (table.part != nullptr) table.part->create(result_);
    read_keys(in, table);
    in.finish([&](const std::string& word) { return key_suggestion(registry_, table.name, word); });
    check_rules(in, table, "");
    if (table.part != nullptr && table.part->remove != nullptr && !holds(table.part->needed))
      table.part->remove(result_);
  }

  // What the distributions mean is not known here, but what they are of.
  void read_uncertainty(TableReader in) {
    const std::string correlation = "correlation";
    const std::set<std::string> numbers = numbers_of(registry_);
    for (const std::string& key : in.keys()) {
      if (key == correlation) continue;
      if (numbers.count(key) == 0)
        in.fail(key, "not a number of this case" + suggestion(key, numbers));
      result_.uncertainty.parameters.push_back({key, in.text(key)});
    }
    for (const TableReader::Link& link : in.links(correlation)) {
      for (const std::string& name : {link.first, link.second})
        if (!in.has(name)) in.fail(correlation, name + " has no distribution in this table");
      if (!(link.number >= -1 && link.number <= 1))
        in.fail(correlation, number_text(link.number) + " must be in [-1, 1]");
      result_.uncertainty.correlations.push_back({link.first, link.second, link.number});
    }
    in.finish();
  }

  // A table that holds tables only; null where it is missing.
  TableReader* below(const std::string& name) {
    if (const auto known = parents_.find(name); known != parents_.end()) return &known->second;
    if (!top_.has(name)) return nullptr;
    return &parents_.emplace(name, top_.table(name)).first->second;
  }

  void read_keys(TableReader& in, const Table& table) {
    for (const Parameter& parameter : table.parameters) in.expect(parameter.key);
    for (const Parameter& parameter : table.parameters) {
      if (parameter.part != nullptr && !parameter.part->exists(result_) &&
          (holds(parameter.part->needed) || is_complete(in, table, parameter.part)))
        parameter.part->create(result_);
      read_key(in, table, parameter);
      check_rules(in, table, parameter.key);
    }
    for (const Parameter& parameter : table.parameters)
      if (parameter.part != nullptr && parameter.part->belongs_to != nullptr &&
          in.has(parameter.key) && !parameter.part->exists(result_)) {
        const Parameter* const missing = first_missing(in, table, parameter.part);
        in.fail(parameter.key,
                "must have " + (missing != nullptr ? missing->key : parameter.part->belongs_to) +
                    " beside it");
      }
  }

  // The first key of a part that has no default and is not given; null where there is none.
  static const Parameter* first_missing(TableReader& in, const Table& table, const Part* part) {
    for (const Parameter& p : table.parameters)
      if (p.part == part && !p.fallback.value && p.fallback.computed == nullptr && !in.has(p.key))
        return &p;
    return nullptr;
  }
  static bool is_complete(TableReader& in, const Table& table, const Part* part) {
    return first_missing(in, table, part) == nullptr;
  }

  void check_rules(const TableReader& in, const Table& table, const std::string& after) const {
    for (const Rule& rule : table.rules)
      if (rule.after == after)
        if (const std::string why = rule.broken(result_); !why.empty()) in.fail(rule.key, why);
  }

  void read_key(TableReader& in, const Table& table, const Parameter& parameter) {
    const bool active = is_asked_for(parameter, registry_, result_);
    read_.insert(table.name + "." + parameter.key);
    if (!in.has(parameter.key)) {
      if (!active) return;
      if (!default_of(parameter, result_)) {
        look_for_other_word(in, table, parameter);
        in.missing_too(missing_after(in, table, parameter));
      }
    }
    if (const auto* curve = std::get_if<CurveField>(&parameter.field)) {
      std::optional<std::string> fallback;
      if (const auto value = default_of(parameter, result_))
        fallback = std::get<std::string>(*value);
      const std::string name = in.text(parameter.key, fallback);
      if (active && name != fallback) read_curve(in, parameter, *curve, name);
      return;
    }
    store(parameter, result_, value_in(in, parameter));
  }

  // The keys of a table after one that are missing too, of those known to be asked for by now.
  std::vector<std::string> missing_after(TableReader& in, const Table& table,
                                         const Parameter& first) const {
    std::vector<std::string> keys;
    for (const Parameter* p = &first + 1; p < table.parameters.data() + table.parameters.size();
         ++p)
      if ((p->active.words.empty() || read_.count(p->active.table + "." + p->active.key) > 0) &&
          is_asked_for(*p, registry_, result_) && !default_of(*p, result_) && !in.has(p->key))
        keys.push_back(p->key);
    return keys;
  }

  // Where a required key is missing, another word for it may be there.
  void look_for_other_word(TableReader& in, const Table& table, const Parameter& parameter) const {
    for (const std::string& key : in.keys())
      if (meant_key(registry_, table.name, key) == table.name + "." + parameter.key)
        in.may_mean(key, parameter.key);
  }

  Value value_in(TableReader& in, const Parameter& p) const {
    const auto fallback = default_of(p, result_);
    const auto or_default = [&](auto type) -> std::optional<decltype(type)> {
      if (!fallback) return std::nullopt;
      return std::get<decltype(type)>(*fallback);
    };
    if (std::holds_alternative<IntegerField>(p.field))
      return in.integer(p.key, static_cast<int>(p.range.low), static_cast<int>(p.range.high),
                        or_default(0));
    if (std::holds_alternative<FlagField>(p.field)) return in.flag(p.key, or_default(true).value());
    if (std::holds_alternative<TextField>(p.field))
      return in.text(p.key, or_default(std::string()));
    if (std::holds_alternative<PairField>(p.field)) {
      std::optional<std::pair<double, double>> pair;
      if (const auto both = or_default(std::array<double, 2>())) pair = {(*both)[0], (*both)[1]};
      const auto [first, second] = in.pair(p.key, range_of(p, result_), pair);
      for (const double value : {first, second}) require_si(in, p, value);
      return std::array{first, second};
    }
    if (std::holds_alternative<NumberField>(p.field)) {
      const double value = in.number(p.key, range_of(p, result_), or_default(0.0));
      require_si(in, p, value);
      return value;
    }
    std::optional<std::size_t> index;
    if (const auto word = or_default(std::string()))
      index = std::find(p.words.begin(), p.words.end(), *word) - p.words.begin();
    return p.words[in.choice(p.key, p.words, index)];
  }

  // A number of the file may lose digits in SI, or what is computed of it leave the range of
  // double.
  static void require_si(TableReader& in, const Parameter& p, double value) {
    const double si = p.unit.to_si == nullptr ? value : p.unit.to_si(value);
    if (in.has(p.key) && value != 0 && !(std::isnormal(si) && std::abs(si) <= kLargestInput))
      in.fail(p.key, "must be 0 or, in SI units, of a magnitude between 2.3e-308 and " +
                         number_text(kLargestInput));
  }

  void read_curve(const TableReader& in, const Parameter& parameter, const CurveField& field,
                  const std::string& name) {
    const std::filesystem::path file =
        result_.file.parent_path() / std::u8string(name.begin(), name.end());
    if (!std::filesystem::exists(file)) in.fail(parameter.key, "no such file: " + file.string());
    if (std::filesystem::is_directory(file))
      in.fail(parameter.key, "is a directory: " + file.string());
    store(parameter, result_, file.string());
    if (field.opening != nullptr) {
      *field.opening(result_) = read_opening_table(file);
    } else if (field.stroke != nullptr) {
      *field.stroke(result_) = read_stroke_table(file);
    } else if (field.drive != nullptr) {
      DriveSpec& drive = *field.drive(result_);
      drive.curve = read_drive_curve(file, drive.kind);
    } else if (field.share != nullptr) {
      *field.share(result_) = read_share_curve(file);
    } else if (field.teeth != nullptr) {
      read_tooth_errors(file, *field.teeth(result_));
    } else if (field.walls != nullptr) {
      field.walls(result_)->deviation =
          read_clearance_deviations(file, result_.pump.geometry.pistons);
    } else {
      result_.pressure.curve = read_pressure_curve(file);
      PressureTrace{result_.pressure};  // refuses a curve that cannot be a periodic spline
    }
  }

  const Registry& registry_;
  Case result_;
  TableReader top_;
  std::map<std::string, TableReader> parents_;
  std::set<std::string> read_;  // TABLE.KEY of what has been asked for
};

// The change "TABLE.KEY=VALUE", of a key that the registry knows.
void apply_change(TomlFile& file, const std::string& change, const Registry& registry) {
  const auto fail = [&](const std::string& why) {
    throw InputError("--set " + one_line(change) + ": " + why);
  };
  const auto equals = change.find('=');
  const std::string name(trimmed(change.substr(0, equals), " "));
  if (equals == std::string::npos || name.empty() || one_line(change) != change)
    fail("must be TABLE.KEY=VALUE, in one line");
  const auto dot = name.rfind('.');
  const std::string table = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::string key = name.substr(dot + 1);  // npos + 1 is 0
  std::set<std::string> tables, keys;
  for (const Table& known : registry.tables) {
    if (!known.name.empty()) tables.insert(known.name);
    if (known.name == table)
      for (const Parameter& parameter : known.parameters) keys.insert(parameter.key);
  }
  if (keys.empty()) fail("unknown table [" + table + "]" + suggestion(table, tables));
  if (keys.count(key) == 0)
    fail("unknown key \"" + key + "\"" + (table.empty() ? "" : " in [" + table + "]") +
         key_suggestion(registry, table, key));
  file.change(table, key, std::string(trimmed(change.substr(equals + 1), " ")));
}

Case case_of(TomlFile toml, const std::vector<std::string>& changes, const Registry& registry,
             const InputLog& inputs) {
  for (const std::string& change : changes) apply_change(toml, change, registry);
  Case the_case = CaseReader(toml, registry).read();
  the_case.inputs = inputs.noted();
  return the_case;
}

}  // namespace

Case parse_case(const std::string& text, const std::filesystem::path& file,
                const std::vector<std::string>& changes, const Registry& registry) {
  const InputLog inputs(InputLog::Threads::own);
  return case_of({text, file}, changes, registry, inputs);
}

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& changes,
               const Registry& registry) {
  const InputLog inputs(InputLog::Threads::own);
  return case_of(TomlFile::read(file, "case file"), changes, registry, inputs);
}

}  // namespace bentaxis
