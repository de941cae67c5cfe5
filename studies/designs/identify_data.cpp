#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bentaxis/designs/identify.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::designs {
namespace {

namespace fs = std::filesystem;

constexpr double kEdge = 0.01;  // softness of a window's edge, of the window or of its limit
constexpr NumberRange kPositiveNumber{0, HUGE_VAL, true, true};

// A value that a case file would be refused for is none of a study.
void require_allowed(const Variable& variable, double value, const char* what, const Case& base) {
  if (const NumberRange range = variable.range(base); !range.contains(value))
    throw InputError(variable.name() + ": " + what + " " + number_text(value) + " must be " +
                     range.text());
}

// "TABLE.KEY=VALUE".
std::pair<Variable, double> setting_of(const std::string& text, const Case& base) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw InputError("\"" + text + "\": must be \"TABLE.KEY=VALUE\"");
  Variable variable(text.substr(0, equals), base);
  const double value = variable.value_of(text.substr(equals + 1));
  require_allowed(variable, value, "the value", base);
  return {std::move(variable), value};
}

std::size_t index_of_condition(const IdentificationData& data, const std::string& name) {
  const auto found = std::find_if(data.conditions.begin(), data.conditions.end(),
                                  [&](const Condition& c) { return c.name == name; });
  return static_cast<std::size_t>(found - data.conditions.begin());
}

std::size_t read_condition_name(TableReader& in, const IdentificationData& data) {
  const std::string name = in.text("condition", "");
  const std::size_t index = index_of_condition(data, name);
  if (index == data.conditions.size()) {
    std::set<std::string> known;
    for (const Condition& c : data.conditions)
      if (!c.name.empty()) known.insert(c.name);  // the case's own has none
    in.fail("condition", "there is no [[condition]] of this name" + suggestion(name, known));
  }
  return index;
}

// Refusals of what a key names get file and line.
template <class Job>
auto under(TableReader& in, const std::string& key, const Job& job) {
  try {
    return job();
  } catch (const InputError& error) {
    in.fail(key, error.what());
  }
}

void check_bounds(const Unknown& unknown, const Case& base) {
  if (!(unknown.low < unknown.high))
    throw InputError(unknown.name() + ": the lower bound must be below the upper one");
  if (unknown.variable.discrete())
    throw InputError(unknown.name() + ": is not continuous: it cannot be identified");
  require_allowed(unknown.variable, unknown.low, "the lower bound", base);
  require_allowed(unknown.variable, unknown.high, "the upper bound", base);
}

Unknown read_unknown(TableReader in, const Case& base, const IdentificationData& data) {
  const std::string name = in.text("parameter");
  const auto [low, high] = in.pair("between", {});
  Unknown unknown{under(in, "parameter", [&] { return Variable(name, base); }), low, high};
  unknown.condition = data.conditions[read_condition_name(in, data)].name;
  if (in.has("prior")) {
    const std::string text = in.text("prior");
    unknown.prior = under(in, "prior", [&] { return distribution(text, name); });
    if (unknown.prior->shape != Shape::normal && unknown.prior->shape != Shape::lognormal)
      in.fail("prior", "must be normal or lognormal; bounds alone are a uniform one");
  }
  under(in, "between", [&] { check_bounds(unknown, base); });
  in.text("reason", "");  // for whoever reads the file
  in.finish();
  return unknown;
}

Use read_use(TableReader& in) {
  return in.choice("use", {"fitted", "predicted"}, 0) == 0 ? Use::fitted : Use::predicted;
}

// A number with its uncertainty, or a window.
Datum read_datum(TableReader in, bool window, const Case& base, const IdentificationData& data) {
  Datum datum;
  const std::string name = in.text("output");
  datum.output = under(in, "output", [&] { return output(name, base); });
  datum.what = datum.output->name;
  datum.unit = datum.output->unit;
  datum.where = in.text("where", "");
  if (window) {
    if (!in.has("above") && !in.has("below")) in.fail("above", "above or below is needed");
    datum.low = in.has("above") ? in.number("above", {}) : -HUGE_VAL;
    datum.high = in.has("below") ? in.number("below", {}) : HUGE_VAL;
    if (!(datum.low < datum.high)) in.fail("above", "must be less than below");
  } else {
    datum.value = in.number("value", {});
  }
  datum.uncertainty = in.number("uncertainty", kPositiveNumber);
  datum.condition = read_condition_name(in, data);
  datum.use = read_use(in);
  in.finish();
  return datum;
}

// A record of the rig: a curve for each of its channels.
std::vector<Datum> read_curves(TableReader in, const fs::path& folder, const Case& base,
                               const IdentificationData& data) {
  const fs::path file = folder / in.text("file");
  const NumericTable table = read_numeric_csv(file);
  if (table.header.empty() || table.header[0] != "theta_deg")
    in.fail("file", "its first column must be theta_deg");
  std::vector<std::string> channels = in.texts("channels");
  if (channels.empty()) channels.assign(table.header.begin() + 1, table.header.end());
  const bool relative = in.has("relative_uncertainty");
  const double uncertainty =
      in.number(relative ? "relative_uncertainty" : "uncertainty", kPositiveNumber);
  const std::size_t condition = read_condition_name(in, data);
  const Use use = read_use(in);
  const std::string where = in.text("where", file.filename().string());
  in.finish();
  const ChannelLayout layout(base.pump);
  std::vector<Datum> curves;
  for (const std::string& name : channels) {
    const auto channel = std::find_if(layout.channels().begin(), layout.channels().end(),
                                      [&](const Channel& c) { return c.name == name; });
    const auto column = std::find(table.header.begin(), table.header.end(), name);
    if (channel == layout.channels().end())
      in.fail("channels", "no channel of a run is named " + one_line(name));
    if (column == table.header.end())
      in.fail("channels", file.string() + " has no column " + one_line(name));
    Datum datum;
    datum.what = name + " over the turn";
    datum.where = where;
    datum.unit = channel->unit;
    datum.use = use;
    datum.condition = condition;
    datum.curve.emplace();
    datum.curve->column = static_cast<std::size_t>(channel - layout.channels().begin());
    double peak = 0;
    for (const auto& row : table.rows) {
      datum.curve->theta_deg.push_back(row[0]);
      datum.curve->values.push_back(row[static_cast<std::size_t>(column - table.header.begin())]);
      peak = std::max(peak, std::abs(datum.curve->values.back()));
    }
    datum.uncertainty = relative ? uncertainty * peak : uncertainty;
    if (!(datum.uncertainty > 0))
      in.fail("relative_uncertainty", name + " is 0 everywhere: it needs an uncertainty");
    datum.curve->uncertainties.assign(datum.curve->values.size(), datum.uncertainty);
    curves.push_back(std::move(datum));
  }
  return curves;
}

// Why a printed number cannot be fitted, or "".
std::string unfit(const compare::PublishedNumber& n) {
  if (!n.not_comparable.empty()) return n.not_comparable;
  if (n.repeats) return "says what another row says";
  if (!n.study.empty()) return "compared by the study " + n.study;
  if (n.measure == compare::Measure::sign_changes || n.measure == compare::Measure::main_order)
    return "a count: it does not change with small changes of a parameter";
  return "";
}

void read_published_rows(TableReader in, const fs::path& folder, IdentificationData& data) {
  const compare::Published published = compare::read_published(folder / in.text("file"));
  const double share = in.number("model_uncertainty", {0, 1});
  std::vector<std::string> fitted = in.texts("fit");
  if (fitted.empty()) fitted = {"used to infer the geometry", "calibrated"};
  const std::vector<std::string> unused = in.texts("leave_out");
  in.finish();
  data.variants.insert(data.variants.end(), published.variants.begin(), published.variants.end());
  for (const compare::PublishedNumber& n : published.numbers) {
    Datum datum;
    datum.what = n.quantity;
    datum.where = n.where;
    datum.unit = n.unit;
    datum.variant = n.variant;
    datum.printed = n;
    datum.condition = index_of_condition(data, n.condition);
    datum.use = contains(fitted, n.status) ? Use::fitted : Use::predicted;
    datum.reason = unfit(n);
    if (datum.condition == data.conditions.size()) {
      datum.condition = 0;
      datum.reason = "no [[condition]] \"" + n.condition + "\" is given";
    }
    if (contains(unused, n.quantity)) datum.reason = "left out by the file of data";
    if (!datum.reason.empty()) datum.use = Use::left_out;
    datum.value = n.value;
    datum.low = n.low;
    datum.high = n.high;
    if (n.value) {
      // What is printed lies evenly within its tolerance; what follows from the geometry alone is
      // right to that, a model of forces is not.
      const double model = n.measure == compare::Measure::fact ? 0 : share * std::abs(*n.value);
      datum.uncertainty = std::hypot(n.tolerance / std::sqrt(3.0), model);
    } else {
      double size = n.high - n.low;
      if (!std::isfinite(size)) size = std::isfinite(n.low) ? std::abs(n.low) : std::abs(n.high);
      datum.uncertainty = kEdge * (size > 0 ? size : 100);
    }
    data.data.push_back(std::move(datum));
  }
}

}  // namespace

std::string Unknown::name() const {
  return condition.empty() ? variable.name() : condition + ": " + variable.name();
}

Unknown unknown_of(const std::string& option, const std::string& text, const Case& base) {
  const std::size_t equals = text.find('='), colon = text.find(':', equals);
  if (equals == std::string::npos || colon == std::string::npos)
    throw InputError(option + " " + text + ": must be NAME=LOW:HIGH");
  Variable variable(text.substr(0, equals), base);
  const double low = variable.value_of(text.substr(equals + 1, colon - equals - 1));
  const double high = variable.value_of(text.substr(colon + 1));
  Unknown unknown{std::move(variable), low, high};
  try {
    check_bounds(unknown, base);
  } catch (const InputError& error) {
    throw InputError(option + " " + text + ": " + error.what());
  }
  return unknown;
}

std::size_t Datum::size() const {
  if (curve) return curve->values.size();
  return printed && printed->measure == compare::Measure::range ? 2 : 1;
}

void read_identification(const fs::path& file, const Case& base, IdentificationData& data) {
  const TomlFile toml = TomlFile::read(file, "file of data");
  data.files.push_back(file);
  TableReader in = toml.root();
  in.integer("schema", 1, 1);
  const fs::path folder = file.parent_path();
  for (TableReader& item : in.tables("condition")) {
    Condition condition{item.text("name")};
    if (index_of_condition(data, condition.name) < data.conditions.size())
      item.fail("name", "there is a condition of this name already");
    const auto texts = item.texts("set");
    under(item, "set", [&] {
      for (const std::string& text : texts) condition.settings.push_back(setting_of(text, base));
    });
    item.finish();
    data.conditions.push_back(std::move(condition));
  }
  for (TableReader& item : in.tables("unknown"))
    data.unknowns.push_back(read_unknown(std::move(item), base, data));
  for (const char* kind : {"number", "window"})
    for (TableReader& item : in.tables(kind))
      data.data.push_back(read_datum(std::move(item), kind == std::string("window"), base, data));
  for (TableReader& item : in.tables("curve"))
    for (Datum& curve : read_curves(std::move(item), folder, base, data))
      data.data.push_back(std::move(curve));
  if (in.has("published")) read_published_rows(in.table("published"), folder, data);
  in.finish();
}

}  // namespace bentaxis::designs
