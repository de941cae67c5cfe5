#include "published.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "console.h"

namespace bentaxis::cli {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One [[row]] with errors that name the line.
class RowReader {
 public:
  RowReader(const std::string& file, const toml::table& table) : file_(file), table_(table) {}

  std::string text(const std::string& key) {
    const auto value = find(key).value<std::string>();
    if (!value) fail(key, "must be a text");
    return *value;
  }
  double number(const std::string& key, double fallback) {
    const auto node = find(key);
    if (!node) return fallback;
    if (!node.is_number()) fail(key, "must be a number");
    return *node.value<double>();
  }
  bool flag(const std::string& key, bool fallback) {
    const auto node = find(key);
    if (!node) return fallback;
    if (!node.is_boolean()) fail(key, "must be true or false");
    return *node.value<bool>();
  }
  template <class Value>
  Value choice(const std::string& key, const std::vector<std::pair<std::string, Value>>& words) {
    const std::string word = text(key);
    std::string allowed;
    for (const auto& [name, value] : words) {
      if (name == word) return value;
      allowed += (allowed.empty() ? "\"" : " or \"") + name + "\"";
    }
    fail(key, "must be " + allowed);
  }
  void finish() const {
    for (const auto& [key, node] : table_)
      if (known_.count(std::string(key.str())) == 0) fail(std::string(key.str()), "is unknown");
  }
  [[noreturn]] void fail(const std::string& key, const std::string& why) const {
    const toml::node* node = table_.get(key);
    const auto line = (node != nullptr ? node->source() : table_.source()).begin.line;
    throw InputError(file_ + ":" + std::to_string(line) + ": [[row]] " + key + ": " + why);
  }

 private:
  toml::node_view<const toml::node> find(const std::string& key) {
    known_.insert(key);
    return table_[key];
  }

  const std::string& file_;
  const toml::table& table_;
  std::set<std::string> known_;
};

}  // namespace

std::vector<PublishedRow> read_published(const std::string& file) {
  toml::table root;
  try {
    root = toml::parse_file(file);
  } catch (const toml::parse_error& error) {
    throw InputError(file + ":" + std::to_string(error.source().begin.line) + ": " +
                     std::string(error.description()));
  }
  const toml::array* array = root["row"].as_array();
  if (array == nullptr || root.size() != 1)
    throw InputError(file + ": must hold tables [[row]] and nothing else");
  std::vector<PublishedRow> rows;
  for (const toml::node& node : *array) {
    if (!node.is_table()) throw InputError(file + ": row must be a table [[row]]");
    RowReader in(file, *node.as_table());
    PublishedRow row;
    row.quantity = in.text("quantity");
    row.channel = in.text("channel");
    using Statistic = PublishedRow::Statistic;
    row.statistic = in.choice<Statistic>("statistic", {{"range", Statistic::range},
                                                       {"mean", Statistic::mean},
                                                       {"magnitude", Statistic::magnitude},
                                                       {"at", Statistic::at}});
    row.theta_deg = in.number("theta_deg", 0);
    row.low = in.number("low", -kInfinity);
    row.high = in.number("high", kInfinity);
    if (!(row.low <= row.high)) in.fail("low", "must not exceed high");
    row.paper = in.text("paper");
    row.status = in.choice<std::string>("status", {{"used to infer", "used to infer"},
                                                   {"calibrated", "calibrated"},
                                                   {"predicted", "predicted"}});
    row.where = in.text("where");
    row.piston_friction = in.flag("piston_friction", true);
    row.block_viscous = in.flag("block_viscous", true);
    row.find_pressure = in.flag("find_pressure", false);
    if (row.find_pressure && !(row.low > 0)) in.fail("find_pressure", "needs low > 0");
    in.finish();
    rows.push_back(std::move(row));
  }
  return rows;
}

Measured measure(const PublishedRow& row, const ResultTable& table) {
  const std::size_t column = table.find(row.channel);
  if (column == table.columns())
    throw InputError("published numbers: no channel \"" + row.channel + "\"");
  double low = kInfinity, high = -kInfinity, sum = 0, magnitude = 0, nearest = kInfinity, at = 0;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double value = table.at(i, column);
    if (!is_computed(value)) return {value, value};
    low = std::min(low, value);
    high = std::max(high, value);
    sum += value;
    magnitude = std::max(magnitude, std::abs(value));
    const double distance = std::abs(table.theta_deg[i] - row.theta_deg);
    if (distance < nearest) nearest = distance, at = value;
  }
  switch (row.statistic) {
    case PublishedRow::Statistic::range:
      return {low, high};
    case PublishedRow::Statistic::mean:
      low = sum / static_cast<double>(table.rows());
      break;
    case PublishedRow::Statistic::magnitude:
      low = magnitude;
      break;
    case PublishedRow::Statistic::at:
      low = at;
      break;
  }
  return {low, low};
}

nlohmann::json shown(const Measured& measured) {
  if (!is_computed(measured.low)) return nullptr;
  if (measured.low == measured.high) return measured.low;
  return fmt::format("{:.5g} .. {:.5g}", measured.low, measured.high);
}

namespace {

// One turn of a case whose pressure is there.
ResultTable driven(const Case& the_case, study::Model model) {
  return study::run_turn({the_case, {}, PressureTrace(the_case.pressure)}, model, progress_of);
}

}  // namespace

Verdicts set_against(const std::vector<PublishedRow>& rows, const study::OperatingPoint& point) {
  std::map<std::tuple<bool, bool>, std::pair<ResultTable, ResultTable>> variants;
  Verdicts verdicts;
  compare::PublishedSection section;
  section.models = {"analytic", "multibody"};
  for (const PublishedRow& row : rows) {
    const std::tuple key{row.piston_friction, row.block_viscous};
    if (variants.count(key) == 0) {
      if (row.piston_friction && row.block_viscous) {
        variants[key] = {point.analytic, point.multibody};
      } else {
        Case changed = point.the_case();
        if (!row.piston_friction)
          changed.analytic.piston_friction = changed.multibody.piston_friction = false;
        if (!row.block_viscous) changed.pump.friction.block_viscous = 0;
        variants[key] = {driven(changed, study::Model::analytic),
                         driven(changed, study::Model::multibody)};
      }
    }
    const auto& [analytic, multibody] = variants[key];
    const Measured first = measure(row, analytic), second = measure(row, multibody);
    const bool inside = first.inside(row) && second.inside(row);
    std::string where = row.where;
    if (row.find_pressure)
      where += fmt::format(
          "; needs a mean delivery pressure of {:.1f} bar",
          study::delivery_pressure_for(
              point, row.quantity, row.low,
              [&](const ResultTable& table) { return measure(row, table).low; }, progress_of) /
              kPascalPerBar);
    const std::size_t column = analytic.find(row.channel);
    compare::PublishedRow shown_row;
    shown_row.number.quantity = row.quantity;
    shown_row.number.unit = analytic.channels[column].unit;
    shown_row.number.status = row.status;
    shown_row.printed = row.paper;
    for (const Measured& value : {first, second})
      shown_row.values.emplace_back(compare::PublishedValue{value.low, value.high});
    shown_row.verdict =
        inside ? compare::PublishedVerdict::inside : compare::PublishedVerdict::outside;
    shown_row.where = where;
    section.rows.push_back(std::move(shown_row));
    const nlohmann::json value = shown(first);
    verdicts.lines.push_back(
        fmt::format("{:<44} {:>22} {:<3} {:<8} {:<14} paper {} ({})", row.quantity,
                    value.is_string() ? value.get<std::string>() : fmt::format("{:.6g}", first.low),
                    analytic.channels[column].unit, inside ? "inside" : "OUTSIDE", row.status,
                    row.paper, where));
    verdicts.inside = verdicts.inside && inside;
  }
  verdicts.table = {
      "Used to infer: the number went into the geometry of this case, which is not published. "
      "Calibrated: a parameter was set so that the number comes out. Only predicted rows say "
      "something about the models; a window is the range of a printed axis, in which the lost "
      "curve "
      "must have been.",
      std::move(section)};
  return verdicts;
}

}  // namespace bentaxis::cli
