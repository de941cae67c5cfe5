// What a sweep is asked for: options and study files become a plan, and back.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bentaxis/designs/sweep.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/study/spaced_values.h"

namespace bentaxis::designs {
namespace {

constexpr int kMaxValues = 1000000;
constexpr std::size_t kMaxDesigns = 1000000000;

// Parts between commas that stand in no brackets.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char letter : text) {
    if (letter == '(') ++depth;
    if (letter == ')') --depth;
    if (letter == ',' && depth == 0)
      parts.emplace_back();
    else if (letter != ' ' || depth > 0)
      parts.back() += letter;
  }
  return parts;
}

// What stands in the brackets of log(..).
std::optional<std::string> in_log(const std::string& text) {
  if (!text.starts_with("log(") || !text.ends_with(")")) return std::nullopt;
  return text.substr(4, text.size() - 5);
}

// FROM:TO:#N in equal ratios.
std::vector<double> log_levels(const std::string& what, const std::string& text) {
  std::vector<double> levels = study::spaced_values(what, text, "", kMaxValues);
  if (levels.size() < 2 || text.find('#') == std::string::npos || !(levels.front() > 0))
    throw InputError(what + " log(" + text +
                     "): must be log(FROM:TO:#N) with 0 < FROM < TO, N > 1");
  const double from = levels.front(), ratio = levels.back() / from;
  const auto steps = static_cast<double>(levels.size() - 1);
  for (std::size_t i = 1; i + 1 < levels.size(); ++i)
    levels[i] = from * std::pow(ratio, static_cast<double>(i) / steps);
  return levels;
}

bool is_distribution(const std::string& text) {
  return text.find('(') != std::string::npos && !in_log(text);
}

Varied varied(const std::string& name, const std::string& values, Sampling sampling,
              const Case& base) {
  Varied v{.variable = Variable(name, base), .levels = {}};
  const std::string what = name + " = " + values;
  if (values.empty()) throw InputError(name + ": needs values, as in " + name + "=FROM:TO:STEP");
  if (sampling == Sampling::grid) {
    if (is_distribution(values))
      throw InputError(what + ": a grid has no distributions; --sampling lhs, sobol or random has");
    if (v.variable.words().empty() && values.find_first_of(",(") == std::string::npos &&
        std::count(values.begin(), values.end(), ':') == 1)
      throw InputError(what + ": must be FROM:TO:STEP or FROM:TO:#N of a grid; --sampling lhs, " +
                       "sobol or random takes a range without steps");
    v.levels = levels_of(values, v.variable);
    return v;
  }
  if (is_distribution(values)) {
    v.distribution = distribution(values, name, v.variable.value(base));
    if (!v.variable.words().empty())
      throw InputError(what + ": words have no distribution; list those that are wanted");
    return v;
  }
  if (std::count(values.begin(), values.end(), ':') != 1) {
    v.levels = levels_of(values, v.variable);
    return v;
  }
  // FROM:TO: uniform in between, of whole numbers with both ends as likely as the others.
  const std::size_t colon = values.find(':');
  const double half = v.variable.discrete() ? 0.5 : 0;
  const double from = v.variable.value_of(values.substr(0, colon)),
               to = v.variable.value_of(values.substr(colon + 1));
  if (!(from - half < to + half))
    throw InputError(name + " = " + values + ": must be FROM:TO with FROM < TO");
  v.distribution = distribution(
      "uniform(" + number_text(from - half) + ", " + number_text(to + half) + ")", name);
  return v;
}

std::string text_list(const std::vector<std::string>& texts) {
  return "[" + joined(texts, ", ", toml_text) + "]";
}

}  // namespace

const std::vector<std::string>& sampling_words() {
  static const std::vector<std::string> words = {"grid", "lhs", "sobol", "random"};
  return words;
}

std::string to_string(Sampling sampling) {
  return sampling_words()[static_cast<std::size_t>(sampling)];
}

std::size_t SweepPlan::size() const {
  if (sampling != Sampling::grid) return samples;
  double count = 1;
  for (const Varied& v : varied) count *= static_cast<double>(v.levels.size());
  if (count > static_cast<double>(kMaxDesigns))
    throw InputError("a grid of " + rounded_text(count) + " designs: at most " +
                     std::to_string(kMaxDesigns));
  return static_cast<std::size_t>(count);
}

std::vector<double> levels_of(const std::string& text, const Variable& variable) {
  std::vector<double> levels;
  for (const std::string& part : parts_of(text)) {
    std::vector<double> some;
    if (const auto inner = in_log(part))
      some = log_levels(variable.name(), *inner);
    else if (part.find(':') != std::string::npos && variable.words().empty())
      some = study::spaced_values(variable.name(), part, variable.unit(), kMaxValues);
    else
      some = {variable.value_of(part)};
    append(levels, some);
  }
  for (const double level : levels)
    if (variable.discrete() && level != std::round(level))
      throw InputError(variable.name() + " = " + number_text(level) + ": must be a whole number");
  return levels;
}

SweepRequest read_sweep_request(const std::filesystem::path& file) {
  const TomlFile toml = TomlFile::read(file, "study file");
  TableReader top = toml.root();
  SweepRequest request;
  request.sampling = static_cast<Sampling>(top.choice("sampling", sampling_words(), 0));
  constexpr int kMax = std::numeric_limits<int>::max();
  request.samples = static_cast<std::size_t>(top.integer("samples", 0, kMax, 0));
  request.seed = static_cast<std::uint64_t>(top.integer("seed", 0, kMax, 1));
  request.model = static_cast<study::Model>(top.choice("model", {"analytic", "multibody"}, 0));
  request.check_share = top.number("check", {0, 1}, 0.0);
  request.outputs = top.texts("output");
  request.minimise = top.texts("minimise");
  request.maximise = top.texts("maximise");
  for (TableReader& one : top.tables("vary")) {
    const std::string name = one.text("parameter");
    request.vary.emplace_back(name, one.text("values"));
    one.finish();
  }
  // Written beside finished blocks (sweep_parts.h); such a file is a study file too.
  TableReader record = top.optional_table("record");
  for (const std::string& key : record.keys()) record.any(key);
  record.finish();
  top.finish();
  return request;
}

SweepPlan sweep_plan(const SweepRequest& request, const Case& base) {
  SweepPlan plan;
  plan.sampling = request.sampling;
  plan.samples = request.samples;
  plan.seed = request.seed;
  plan.model = request.model;
  plan.check_share = request.check_share;
  for (const auto& [name, values] : request.vary)
    plan.varied.push_back(varied(name, values, request.sampling, base));
  if (plan.varied.empty())
    throw InputError("--vary: name at least one parameter, as in pump.tilt_deg=20:40:5");
  if (plan.sampling == Sampling::grid && plan.samples > 0)
    throw InputError("--samples: a grid has none; --sampling lhs, sobol or random has");
  if (plan.sampling != Sampling::grid && plan.samples == 0)
    throw InputError("--samples: --sampling " + to_string(plan.sampling) +
                     " needs a number of points");
  if (plan.sampling != Sampling::grid && plan.samples > kMaxDesigns)
    throw InputError("--samples " + std::to_string(plan.samples) + ": must be in [1, " +
                     std::to_string(kMaxDesigns) + "] with --sampling " + to_string(plan.sampling));
  const auto add = [&](const std::string& name, int direction) {
    const Output wanted = output(name, base);
    auto found = std::find(plan.outputs.begin(), plan.outputs.end(), wanted);
    if (found == plan.outputs.end()) {
      plan.outputs.push_back(wanted);
      plan.direction.push_back(0);
      found = plan.outputs.end() - 1;
    }
    int& now = plan.direction[static_cast<std::size_t>(found - plan.outputs.begin())];
    if (now * direction < 0)
      throw InputError("output " + wanted.name + ": cannot be both minimised and maximised");
    if (direction != 0) now = direction;
  };
  for (const std::string& name : request.outputs) add(name, 0);
  for (const std::string& name : request.minimise) add(name, -1);
  for (const std::string& name : request.maximise) add(name, +1);
  if (plan.outputs.empty()) throw InputError("--output: name at least one, as in max:Rb1_z1");
  plan.size();  // refuses what cannot be counted
  return plan;
}

std::string plan_text(const SweepPlan& plan) {
  std::string text = "sampling = " + toml_text(to_string(plan.sampling)) + "\n";
  if (plan.sampling != Sampling::grid)
    text += "samples = " + std::to_string(plan.samples) + "\nseed = " + std::to_string(plan.seed) +
            "\n";
  text += "model = " + toml_text(study::to_string(plan.model)) + "\n";
  text += "check = " + number_text(plan.check_share) + "\n";
  std::vector<std::string> names, smaller, larger;
  for (std::size_t i = 0; i < plan.outputs.size(); ++i) {
    names.push_back(plan.outputs[i].name);
    if (plan.direction[i] < 0) smaller.push_back(names.back());
    if (plan.direction[i] > 0) larger.push_back(names.back());
  }
  text += "output = " + text_list(names) + "\n";
  if (!smaller.empty()) text += "minimise = " + text_list(smaller) + "\n";
  if (!larger.empty()) text += "maximise = " + text_list(larger) + "\n";
  for (const Varied& v : plan.varied) {
    const std::string levels =
        joined(v.levels, ",", [&](double level) { return v.variable.text(level); });
    text += "\n[[vary]]\nparameter = " + toml_text(v.variable.name()) +
            "\nvalues = " + toml_text(v.levels.empty() ? v.distribution.text() : levels) + "\n";
  }
  return text;
}

}  // namespace bentaxis::designs
