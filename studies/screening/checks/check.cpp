#include "checks/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/text.h"

namespace bentaxis::study::checks {

std::string Check::found(const Facts& facts) const {
  if (!applies(facts)) return "";
  return text != nullptr ? text(facts) : implausible(facts, table, key);
}

std::string Check::words() const {
  if (table == nullptr) return doubtful;
  const PlausibleRange& range = parameter_of(standard_registry(), table, key).plausible;
  return fmt::format(fmt::runtime(doubtful), range.low, range.high);
}

std::string guess(double value, double low, double high, const Slips& slips) {
  constexpr double kFarSlip = 3;
  const double off = value > high ? value / high : low / value;
  for (const Slip& slip : slips) {
    const double meant = value * slip.factor;
    const double moved = std::max(std::abs(slip.factor), 1 / std::abs(slip.factor));
    if (meant >= low && meant <= high &&
        (moved <= kFarSlip || !(off > 0) || moved <= kFarSlip * off * off))
      return fmt::format("; {} {:.4g} would do", slip.words, meant);
  }
  return "";
}

std::string outside(const std::string& key, double value, double low, double high,
                    const std::string& unit, const std::string& why, const Slips& slips) {
  if (value >= low && value <= high) return "";
  const bool below = value < low;
  return fmt::format("{} = {:.6g} is {} {:.4g}{}: {}{}", key, value, below ? "below" : "above",
                     below ? low : high, unit_after(unit), why, guess(value, low, high, slips));
}

std::string outside(const Facts& f, const char* table_name, const std::string& shown, double low,
                    double high, const std::string& why, const Slips& slips) {
  const Table& table = table_of(standard_registry(), table_name);
  const Parameter& parameter =
      parameter_of(standard_registry(), table_name, shown.substr(shown.rfind(' ') + 1));
  const auto value = value_of(parameter, f.the_case);
  const bool unused = table.part != nullptr && !table.part->needed.words.empty() &&
                      !holds(table.part->needed, standard_registry(), f.the_case);
  if (unused || !value) return "";
  const auto* const whole = std::get_if<int>(&*value);
  return outside(shown, whole != nullptr ? *whole : std::get<double>(*value), low, high,
                 parameter.unit.name, why, slips);
}

std::string implausible(const Facts& f, const char* table, const char* key) {
  const auto& [low, high, why, slips] = parameter_of(standard_registry(), table, key).plausible;
  return outside(f, table, key, low, high, why, slips);
}

std::string first_of(std::initializer_list<std::string> texts) {
  for (const std::string& text : texts)
    if (!text.empty()) return text;
  return "";
}

}  // namespace bentaxis::study::checks
