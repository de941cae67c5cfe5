#include "bentaxis/compare/published.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <tuple>

#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::compare {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::vector<std::string> kStatuses = {"used to infer the geometry", "calibrated",
                                            "predicted"};
const std::vector<std::string> kMeasures = {"fact",  "mean", "minimum",      "maximum",   "largest",
                                            "range", "at",   "sign_changes", "main_order"};

FactRanges read_ranges(TableReader in) {
  FactRanges ranges;
  for (const auto& key : in.keys()) {
    ranges[key] = in.pair(key, kAny);
    if (!(ranges[key].first <= ranges[key].second))
      in.fail(key, "must be [low, high], low <= high");
  }
  in.finish();
  return ranges;
}

template <class Item>
void must_be_known(const TableReader& in, const std::string& key, const std::string& name,
                   const std::vector<Item>& items) {
  if (name.empty()) return;
  if (std::none_of(items.begin(), items.end(), [&](const Item& item) { return item.name == name; }))
    in.fail(key, "is not defined in this file");
}

PublishedNumber read_number(TableReader in, const Published& published) {
  PublishedNumber n;
  n.quantity = in.text("quantity");
  n.where = in.text("where");
  n.status = kStatuses[in.choice("status", kStatuses)];
  n.condition = in.text("condition", "");
  must_be_known(in, "condition", n.condition, published.conditions);
  n.variant = in.text("variant", "");
  must_be_known(in, "variant", n.variant, published.variants);
  n.minus = in.text("minus", "");
  must_be_known(in, "minus", n.minus, published.variants);
  n.study = in.text("study", "");
  n.unit = in.text("unit", "");
  n.note = in.text("note", "");
  n.not_comparable = in.text("not_comparable", "");
  n.repeats = in.flag("repeats", false);
  n.measure = static_cast<Measure>(in.choice("measure", kMeasures));
  if (n.measure == Measure::fact) {
    n.fact = in.text("fact");
  } else {
    n.channels = in.texts("channels");
    if (n.channels.empty()) in.fail("channels", "at least one column must be named");
  }
  if (n.measure == Measure::at) n.at_deg = in.number("at_deg", {0, 360, false, true});
  if (in.has("over_deg")) {
    std::tie(n.from_deg, n.to_deg) = in.pair("over_deg", {0, 360});
    if (!(n.from_deg < n.to_deg)) in.fail("over_deg", "must be [from, to] with from < to");
  }
  n.factor = in.number("factor", kAny, 1.0);
  n.times = in.text("times", "");
  n.low = -kInfinity;
  n.high = kInfinity;
  if (in.has("value")) {
    n.value = in.number("value", kAny);
    n.tolerance = in.number("tolerance", kNotNegative);
    in.text("tolerance_reason");
    n.low = *n.value - n.tolerance;
    n.high = *n.value + n.tolerance;
  } else if (in.has("window")) {
    std::tie(n.low, n.high) = in.pair("window", kAny);
    if (!(n.low < n.high)) in.fail("window", "must be [low, high] with low < high");
  } else if (in.has("above")) {
    n.low = in.number("above", kAny);
  } else if (in.has("below")) {
    n.high = in.number("below", kAny);
  } else {
    in.fail("value", "one of value, window, above, below must be given");
  }
  n.find_pressure = in.flag("find_pressure", false);
  if (n.find_pressure && !(n.low > 0 && n.high == kInfinity))
    in.fail("find_pressure", "needs above > 0");
  in.finish();
  return n;
}

std::string number_of(double value) { return fmt::format("{:.6g}", value); }

std::string printed(const PublishedNumber& n) {
  if (n.value) {
    std::string text = number_of(*n.value);
    if (n.tolerance > 0) text += " ± " + number_of(n.tolerance);
    return text + unit_after(n.unit);
  }
  const std::string unit = unit_after(n.unit);
  if (n.high == kInfinity) return "above " + number_of(n.low) + unit;
  if (n.low == -kInfinity) return "below " + number_of(n.high) + unit;
  return "window " + number_of(n.low) + " to " + number_of(n.high) + unit;
}

// The facts that a range does not hold for, in words; "" where all hold.
std::string unmet(const FactRanges& ranges, const Facts& facts) {
  for (const auto& [name, range] : ranges) {
    const auto it = facts.find(name);
    if (it == facts.end()) return name + " is unknown";
    if (!(it->second >= range.first && it->second <= range.second))
      return fmt::format("{} is {:g}, there {}", name, it->second,
                         range.first == range.second
                             ? number_of(range.first)
                             : number_of(range.first) + " to " + number_of(range.second));
  }
  return "";
}

// How often a periodic curve changes sign.
int sign_changes(const std::vector<double>& curve) {
  int changes = 0;
  for (std::size_t i = 0; i < curve.size(); ++i)
    changes += (curve[i] < 0) != (curve[(i + 1) % curve.size()] < 0);
  return changes;
}

// Order of the largest harmonic. By Parseval's theorem the squares of all add up to those of the
// samples: what is left says when none further can be larger.
int main_order(const std::vector<double>& theta_deg, const std::vector<double>& curve) {
  int best = 0;
  const auto count = static_cast<double>(curve.size());
  const double mean = std::accumulate(curve.begin(), curve.end(), 0.0) / count;
  double largest = -1, left = 0;  // squares of amplitudes
  for (const double value : curve) left += (value - mean) * (value - mean);
  left *= count / 2;  // of an order and its negative, half each
  for (int order = 1; 2 * order < static_cast<int>(curve.size()) && largest < left; ++order) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < curve.size(); ++i)
      sum += curve[i] * std::polar(1.0, order * radians(theta_deg[i]));
    left -= std::norm(sum);
    if (std::norm(sum) > largest) {
      largest = std::norm(sum);
      best = order;
    }
  }
  return best;
}

// On the straight line between the samples around the angle, so that the number does not jump with
// the number of samples; the sample itself where it is one.
std::optional<double> value_at(double at_deg, const std::vector<double>& theta_deg,
                               const std::vector<double>& curve) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < theta_deg.size(); ++i) points.emplace_back(theta_deg[i], curve[i]);
  std::sort(points.begin(), points.end());
  points.emplace_back(points.front().first + 360, points.front().second);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& [a, u] = points[i];
    const auto& [b, v] = points[i + 1];
    if (at_deg >= a && at_deg <= b && b > a) return u + (v - u) * (at_deg - a) / (b - a);
  }
  return std::nullopt;
}

}  // namespace

std::string PublishedCondition::mismatch(const Facts& of_case) const {
  return unmet(facts, of_case);
}

std::string Published::mismatch(const Facts& facts) const { return unmet(identity, facts); }

Published read_published(const std::filesystem::path& file) {
  const TomlFile toml = TomlFile::read(file, "file of printed numbers");
  TableReader in = toml.root();
  Published published;
  in.integer("schema", 1, 1);
  published.name = in.text("pump");
  published.identity = read_ranges(in.table("identity"));
  for (TableReader& item : in.tables("condition")) {
    PublishedCondition condition{item.text("name"), item.text("text"),
                                 read_ranges(item.table("facts"))};
    item.finish();
    published.conditions.push_back(std::move(condition));
  }
  for (TableReader& item : in.tables("variant")) {
    PublishedVariant variant{item.text("name"), item.text("text"), {}};
    TableReader set = item.table("set");
    for (const auto& key : set.keys()) variant.set[key] = set.number(key, kAny);
    item.finish();
    published.variants.push_back(std::move(variant));
  }
  for (TableReader& item : in.tables("number"))
    published.numbers.push_back(read_number(std::move(item), published));
  if (published.numbers.empty()) in.fail("number", "at least one [[number]] is needed");
  in.finish();
  return published;
}

void PublishedSummary::count(const PublishedRow& row) {
  if (row.number.repeats) return;
  const bool any = row.verdict != PublishedVerdict::not_comparable;
  const bool inside = row.verdict == PublishedVerdict::inside;
  predicted += row.number.predicted();
  (row.number.predicted() ? predicted_comparable : other_comparable) += any;
  (row.number.predicted() ? predicted_inside : other_inside) += inside;
}

std::string PublishedSummary::text(const std::string& where) const {
  return fmt::format(
      "Only predicted rows are validation: {} of {} can be compared {}, {} of them "
      "inside. {} further rows were used to infer the geometry or calibrated ({} inside): their "
      "agreement is no evidence.",
      predicted_comparable, predicted, where, predicted_inside, other_comparable, other_inside);
}

std::optional<PublishedValue> value_of(const PublishedNumber& n, const PublishedRun& run) {
  const auto fact = [&](const std::string& name) -> std::optional<double> {
    const auto it = run.facts.find(name);
    return it == run.facts.end() ? std::nullopt : std::optional(it->second);
  };
  double factor = n.factor;
  if (!n.times.empty()) {
    if (!fact(n.times)) return std::nullopt;
    factor *= *fact(n.times);
  }
  if (n.measure == Measure::fact) {
    const auto value = fact(n.fact);
    if (!value) return std::nullopt;
    return PublishedValue{factor * *value, factor * *value};
  }
  if (run.table == nullptr) return std::nullopt;
  const ResultTable& table = *run.table;
  std::vector<std::size_t> columns;
  for (const auto& name : n.channels) {
    columns.push_back(table.find(name));
    if (columns.back() == table.columns()) return std::nullopt;
  }
  std::vector<double> theta, curve;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double angle = wrap_degrees(table.theta_deg[row]);
    if (angle < n.from_deg || angle > n.to_deg) continue;
    double square = 0, value = 0;
    for (const std::size_t column : columns) {
      value = table.at(row, column);
      if (!is_computed(value)) return std::nullopt;
      square += value * value;
    }
    theta.push_back(angle);
    curve.push_back(factor * (n.channels.size() > 1 ? std::sqrt(square) : value));
  }
  if (curve.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(curve.begin(), curve.end());
  const auto one = [](double v) { return PublishedValue{v, v}; };
  switch (n.measure) {
    case Measure::fact:
      break;
    case Measure::mean: {
      double sum = 0;
      for (const double v : curve) sum += v;
      return one(sum / static_cast<double>(curve.size()));
    }
    case Measure::minimum:
      return one(*low);
    case Measure::maximum:
      return one(*high);
    case Measure::largest:
      return one(std::max(std::abs(*low), std::abs(*high)));
    case Measure::range:
      return PublishedValue{*low, *high};
    case Measure::at:
      if (const auto value = value_at(n.at_deg, theta, curve)) return one(*value);
      return std::nullopt;
    case Measure::sign_changes:
      return one(sign_changes(curve));
    case Measure::main_order:
      return one(main_order(theta, curve));
  }
  return std::nullopt;
}

std::optional<PublishedValue> value_of(const PublishedNumber& n, const RunOfVariant& run) {
  auto value = value_of(n, run(n.variant));
  if (!value || n.minus.empty()) return value;
  const auto other = value_of(n, run(n.minus));
  if (!other) return other;
  return PublishedValue{value->low - other->high, value->high - other->low};
}

PublishedVariant Published::variant(const std::string& variant_name) const {
  const auto it = std::find_if(variants.begin(), variants.end(),
                               [&](const PublishedVariant& v) { return v.name == variant_name; });
  return it == variants.end() ? PublishedVariant{} : *it;
}

const char* to_string(PublishedVerdict verdict) {
  switch (verdict) {
    case PublishedVerdict::inside:
      return "inside";
    case PublishedVerdict::outside:
      return "outside";
    case PublishedVerdict::not_comparable:
      break;
  }
  return "not comparable";
}

std::string text_of(const PublishedValue& value) {
  if (value.low == value.high) return number_of(value.low);
  return fmt::format("{:.5g} to {:.5g}", value.low, value.high);
}

bool PublishedSection::calibrated() const {
  return std::none_of(rows.begin(), rows.end(), [](const PublishedRow& row) {
    return row.number.calibrated() && row.verdict == PublishedVerdict::outside;
  });
}

PublishedSection judge_published(
    const Published& published, const std::vector<std::string>& models,
    const std::function<PublishedRun(const std::string&, const PublishedVariant&)>& run,
    const std::string& study) {
  PublishedSection section;
  section.models = models;
  std::map<std::pair<std::string, std::string>, PublishedRun> runs;  // by model and variant
  const auto run_of = [&](const std::string& model, const std::string& name) -> PublishedRun& {
    auto it = runs.find({model, name});
    if (it != runs.end()) return it->second;
    return runs.emplace(std::pair(model, name), run(model, published.variant(name))).first->second;
  };
  const auto number_of_model = [&](const PublishedNumber& n, const std::string& model) {
    return value_of(n, [&](const std::string& name) { return run_of(model, name); });
  };
  for (const auto& n : published.numbers) {
    if (!n.study.empty() && n.study != study) continue;
    const auto condition =
        std::find_if(published.conditions.begin(), published.conditions.end(),
                     [&](const PublishedCondition& c) { return c.name == n.condition; });
    const bool conditional = condition != published.conditions.end();
    const PublishedVariant variant = published.variant(n.variant);
    std::string why = n.not_comparable;
    // What a variant sets is not asked of the case.
    FactRanges wanted = conditional ? condition->facts : FactRanges();
    for (const auto& [name, value] : variant.set) wanted.erase(name);
    PublishedRow row;
    row.number = n;
    row.printed = printed(n);
    row.at = conditional ? condition->text : "";
    if (!variant.text.empty()) row.at += (row.at.empty() ? "" : "; ") + variant.text;
    if (!n.minus.empty()) row.at += " minus " + published.variant(n.minus).text;
    bool any = false, inside = true;
    std::string reasons;
    for (const std::string& model : models) {
      row.values.emplace_back();
      if (!why.empty()) continue;
      // A case at another condition is not run under the variants of this one.
      std::string reason = unmet(wanted, run_of(model, "").facts);
      if (reason.empty()) {
        if (const auto value = number_of_model(n, model)) {
          row.values.back() = value;
          any = true;
          inside = inside && value->inside(n);
          continue;
        }
        reason = "not computed";
      }
      if (reasons.find(reason) == std::string::npos)
        reasons += (reasons.empty() ? "" : "; ") + reason;
    }
    if (!any && why.empty()) why = reasons;
    row.verdict = !any     ? PublishedVerdict::not_comparable
                  : inside ? PublishedVerdict::inside
                           : PublishedVerdict::outside;
    row.where = n.where;
    if (!n.note.empty()) row.where += ". " + n.note;
    if (n.repeats) row.where += ". Duplicates another row: not counted";
    if (!any && !why.empty()) row.where += ". Not comparable: " + why;
    section.summary.count(row);
    section.rows.push_back(std::move(row));
  }
  return section;
}

}  // namespace bentaxis::compare
