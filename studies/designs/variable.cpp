#include "bentaxis/designs/variable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/full_key.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/pump/words.h"

namespace bentaxis::designs {
namespace {

const Parameter* find(const std::string& name, const Table*& table) {
  const Registry& registry = standard_registry();
  for (const Table& t : registry.tables)
    for (const Parameter& p : t.parameters)
      if (full_key(t, p) == name) {
        table = &t;
        return &p;
      }
  return nullptr;
}

std::set<std::string> known() {
  std::set<std::string> names;
  for (const Table& t : standard_registry().tables)
    for (const Parameter& p : t.parameters)
      if (!std::holds_alternative<TextField>(p.field) &&
          !std::holds_alternative<CurveField>(p.field)) {
        const std::vector<std::string> numbers = number_names(t, p);
        names.insert(numbers.begin(), numbers.end());
        if (numbers.empty()) names.insert(full_key(t, p));
      }
  return names;
}

// What is probably meant by a name that is none, as the end of a message.
std::string meant_by(const std::string& name) {
  const auto point = name.rfind('.');
  const std::string table = point == std::string::npos ? "" : name.substr(0, point);
  const auto meant =
      meant_key(standard_registry(), table, name.substr(point + 1));  // npos + 1 is 0
  if (meant) return "; did you mean \"" + *meant + "\"?";
  return suggestion(name, known());
}

// Of "30-40" or "30..40": how a range is written.
std::string range_hint(const std::string& text) {
  const auto between = text.find_first_of("-.~", 1);
  if (between == std::string::npos || !number_in(text.substr(0, between))) return "";
  const auto second = text.find_first_not_of("-.~", between);
  if (second == std::string::npos || !number_in(text.substr(second))) return "";
  return "; a range is FROM:TO:STEP or FROM:TO:#NUMBER";
}

// Of the texts "1" and "2" the place in a pair.
int end_of(const std::string& name) {
  if (name.ends_with(".1")) return 0;
  return name.ends_with(".2") ? 1 : -1;
}

}  // namespace

Variable::Variable(const std::string& name, const Case& base) : name_(name) {
  parameter_ = find(name, table_);
  if (parameter_ == nullptr) {
    end_ = end_of(name);
    if (end_ >= 0) parameter_ = find(name.substr(0, name.size() - 2), table_);
    if (parameter_ == nullptr || !std::holds_alternative<PairField>(parameter_->field))
      throw InputError(name + ": no such parameter" + meant_by(name));
  } else if (std::holds_alternative<PairField>(parameter_->field)) {
    throw InputError(name + ": is a pair: " + name + ".1 or " + name + ".2 can vary");
  }
  const Parameter& p = *parameter_;
  if (std::holds_alternative<TextField>(p.field) || std::holds_alternative<CurveField>(p.field))
    throw InputError(name + ": is not a number, word or flag: it cannot vary");
  if (std::holds_alternative<FlagField>(p.field)) words_ = {"false", "true"};
  if (std::holds_alternative<ChoiceField>(p.field)) words_ = p.words;
  integer_ = std::holds_alternative<IntegerField>(p.field);
  // Nothing forbids it here, but the case leaves it out: it has no value to vary about.
  if (p.part != nullptr && p.part->needed.words.empty() && !p.part->exists(base))
    throw InputError(name + ": is not in this case: give it a value there or by --set, then it " +
                     "can vary");
  if (!is_active(*table_, p, standard_registry(), base) || !bentaxis::value_of(p, base))
    throw InputError(name + ": has no effect in this case" +
                     (p.active.words.empty()
                          ? std::string()
                          : ": needs [" + p.active.table + "] " + to_text(p.active)));
}

std::string Variable::symbol() const {
  const std::string& all = parameter_->symbol;
  const std::size_t comma = all.find(", ");
  if (end_ < 0 || comma == std::string::npos) return all;
  return end_ == 0 ? all.substr(0, comma) : all.substr(comma + 2);
}

NumberRange Variable::range(const Case& the_case) const {
  if (!words_.empty()) return {0, static_cast<double>(words_.size() - 1)};
  return range_of(*parameter_, the_case);
}

double Variable::value(const Case& the_case) const {
  const auto value = bentaxis::value_of(*parameter_, the_case);
  if (!value) throw InputError(name_ + ": does not exist in this case");
  if (const auto* number = std::get_if<double>(&*value)) return *number;
  if (const auto* number = std::get_if<int>(&*value)) return *number;
  if (const auto* flag = std::get_if<bool>(&*value)) return *flag ? 1 : 0;
  if (const auto* pair = std::get_if<std::array<double, 2>>(&*value))
    return (*pair)[static_cast<std::size_t>(end_)];
  const auto word = std::find(words_.begin(), words_.end(), std::get<std::string>(*value));
  return static_cast<double>(word - words_.begin());
}

void Variable::put(Case& the_case, double value) const {
  const Parameter& p = *parameter_;
  if (discrete() && (value != std::round(value) || std::abs(value) > 1e9))
    throw InputError(name_ + " = " + number_text(value) + ": must be a whole number");
  if (!words_.empty()) {
    const auto index = static_cast<std::size_t>(value);
    if (value < 0 || index >= words_.size())
      throw InputError(name_ + " = " + number_text(value) +
                       ": must be the index of a word, from 0");
    store(p, the_case,
          words_.size() == 2 && std::holds_alternative<FlagField>(p.field) ? Value(index == 1)
                                                                           : Value(words_[index]));
  } else if (integer_) {
    store(p, the_case, static_cast<int>(value));
  } else if (const auto* pair = std::get_if<PairField>(&p.field)) {
    if (is_there(p, the_case))
      *(end_ == 0 ? pair->first : pair->second).write(the_case) =
          p.unit.to_si == nullptr ? value : p.unit.to_si(value);
  } else {
    store(p, the_case, value);
  }
}

std::string Variable::text(double value) const {
  if (words_.empty()) return number_text(value);
  const auto index = static_cast<std::size_t>(value);
  return index < words_.size() ? words_[index] : number_text(value);
}

double Variable::value_of(const std::string& text) const {
  if (!words_.empty()) {
    const auto word = std::find(words_.begin(), words_.end(), text);
    if (word == words_.end())
      throw InputError(name_ + " = " + text + ": must be one of its words" +
                       suggestion(text, {words_.begin(), words_.end()}));
    return static_cast<double>(word - words_.begin());
  }
  const auto value = number_in(text);
  if (!value)
    throw InputError(name_ + " = " + text + ": must be a number" + decimal_point_hint(text) +
                     range_hint(text));
  if (integer_ && *value != std::round(*value))
    throw InputError(name_ + " = " + text + ": must be a whole number");
  return *value;
}

Family::Family(Case base, std::vector<Variable> variables)
    : base_(std::move(base)), variables_(std::move(variables)) {
  std::set<std::string> names;
  for (const Variable& v : variables_)
    if (!names.insert(v.name()).second)
      throw InputError(v.name() + ": is specified more than once");
  const auto pair_of = [](const std::string& name) {
    return end_of(name) < 0 ? name : name.substr(0, name.size() - 2);
  };
  for (const Table& table : standard_registry().tables)
    for (const Parameter& p : table.parameters) {
      if (p.fallback.computed == nullptr) continue;
      const auto varies = [&](const Variable& v) {
        return v.name() == table.name + "." + p.key ||
               pair_of(v.name()) == table.name + "." + p.key;
      };
      const auto defaulted = [&](const InputEntry& entry) {
        return entry.table == table.name && entry.key == p.key && entry.defaulted;
      };
      const bool silent = table.presence == Presence::silent &&
                          std::none_of(base_.entries.begin(), base_.entries.end(),
                                       [&](const InputEntry& e) { return e.table == table.name; });
      if (std::none_of(variables_.begin(), variables_.end(), varies) && !base_.entries.empty() &&
          (silent || std::any_of(base_.entries.begin(), base_.entries.end(), defaulted)))
        followers_.push_back({&table, &p});
    }
}

void Family::make(std::span<const double> values, Case& scratch) const {
  if (values.size() != variables_.size())
    throw InputError("a design of " + std::to_string(values.size()) + " values for " +
                     std::to_string(variables_.size()) + " variables");
  for (std::size_t i = 0; i < values.size(); ++i) variables_[i].put(scratch, values[i]);
  for (const Follower& f : followers_)
    if (const auto value = default_of(*f.parameter, scratch)) store(*f.parameter, scratch, *value);
  validate(scratch);
}

}  // namespace bentaxis::designs
