#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bentaxis/designs/optimise.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "optimise_pieces.h"

namespace bentaxis::designs {
namespace {

constexpr std::size_t kMaxEvaluations = 100000000;

// The parts of "max:Rb1_z1 <= 5000".
struct ConstraintText {
  std::string output;
  bool at_most;
  double limit;
};

ConstraintText parsed(const std::string& text) {
  const std::string what = "--subject-to \"" + text + "\"";
  for (const char* sign : {"<=", ">="}) {
    const std::size_t at = text.find(sign);
    if (at == std::string::npos) continue;
    const std::string limit(trimmed(std::string_view(text).substr(at + 2)));
    const auto number = number_in(limit);
    if (!number || !std::isfinite(*number))
      throw InputError(what + ": \"" + limit + "\" must be a number in the output's unit");
    return {std::string(trimmed(std::string_view(text).substr(0, at))), sign[0] == '<', *number};
  }
  throw InputError(what + ": must be \"OUTPUT <= NUMBER\" or \"OUTPUT >= NUMBER\"");
}

// The share that "q95:" before the name of an output asks for, which is taken from the name.
std::optional<double> quantile_in(std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos || !name.starts_with('q')) return std::nullopt;
  const std::string percent = name.substr(1, colon - 1);
  const auto number = number_in(percent);
  if (!number) return std::nullopt;
  if (!(*number > 0 && *number < 100))
    throw InputError("output " + name + ": q" + percent +
                     ": must be above 0 and below 100, in percent of the pumps of a design");
  name.erase(0, colon + 1);
  return *number / 100;
}

// An output with the quantile that "q95:" before its name asks for and the row that "@N" behind it
// does; what is computed for it is added to the plan.
std::pair<Output, OptimisePlan::Taken> taken_of(const std::string& text, OptimisePlan& plan,
                                                const Case& base) {
  const std::size_t at = text.rfind('@');
  std::string name = text.substr(0, at);
  const std::optional<double> quantile = quantile_in(name);
  Output wanted = output(name, base);
  OptimisePlan::Taken taken;
  while (taken.from < plan.computed.size() &&
         !(plan.computed[taken.from] == wanted && plan.quantiles[taken.from] == quantile))
    ++taken.from;
  if (taken.from == plan.computed.size()) {
    plan.computed.push_back(wanted);
    plan.quantiles.push_back(quantile);
  }
  if (quantile) {
    wanted.name = fmt::format("q{:g}:{}", 100 * *quantile, wanted.name);
    wanted.meaning = fmt::format("{:g} % of the pumps under [uncertainty] stay below: {}",
                                 100 * *quantile, wanted.meaning);
  }
  if (at != std::string::npos) {
    const auto row = number_in(text.substr(at + 1));
    const std::size_t rows = plan.conditions.rows.size();
    if (plan.conditions.file.empty() || !row || *row != std::floor(*row) || !(*row >= 1) ||
        !(*row <= static_cast<double>(rows)))
      throw InputError("output " + text + ": " + text.substr(at) +
                       (plan.conditions.file.empty()
                            ? " names a row of --conditions, which is not given"
                            : " must be a row of " + plan.conditions.file.string() + ", 1 to " +
                                  std::to_string(rows)));
    taken.row = static_cast<std::size_t>(*row) - 1;
    wanted.name += "@" + std::to_string(*taken.row + 1);
    wanted.meaning += ", at " + plan.conditions.name_of(*taken.row);
  }
  return {wanted, taken};
}

}  // namespace

SearchVariable search_variable(const Varied& varied) {
  const std::string& name = varied.variable.name();
  if (!varied.levels.empty()) {
    if (varied.levels.size() < 2)
      throw InputError("--vary " + name + ": needs two values at least, or FROM:TO");
    return {0, static_cast<double>(varied.levels.size() - 1), true};
  }
  if (varied.distribution.shape != Shape::uniform)
    throw InputError("--vary " + name + "=" + varied.distribution.text() +
                     ": optimise takes FROM:TO or a list of values");
  const double from = varied.distribution.numbers[0], to = varied.distribution.numbers[1];
  if (!varied.variable.discrete()) return {from, to, false};
  if (!(std::floor(to) > std::ceil(from)))
    throw InputError("--vary " + name + ": needs two whole numbers at least");
  return {std::ceil(from), std::floor(to), true};
}

std::string OptimisePlan::text(const Constraint& constraint) const {
  const Output& output = designs.outputs[constraint.output];
  return output.name + (constraint.at_most ? " <= " : " >= ") + number_text(constraint.limit) +
         (output.unit.empty() ? "" : " " + output.unit);
}

bool OptimisePlan::robust() const {
  return std::any_of(quantiles.begin(), quantiles.end(),
                     [](const auto& share) { return share.has_value(); });
}

std::size_t OptimisePlan::evaluations() const {
  return search.restarts * (search.generations + 1) * search.population;
}

OptimiseRequest read_optimise_request(const std::filesystem::path& file) {
  const TomlFile toml = TomlFile::read(file, "study file");
  TableReader top = toml.root();
  OptimiseRequest request;
  request.minimise = top.texts("minimise");
  request.maximise = top.texts("maximise");
  request.outputs = top.texts("output");
  request.subject_to = top.texts("subject_to");
  request.model = static_cast<study::Model>(top.choice("model", {"analytic", "multibody"}, 0));
  if (const std::string conditions = top.text("conditions", ""); !conditions.empty())
    request.conditions = file.parent_path() / conditions;
  SearchOptions& search = request.search;
  const auto count = [&](const char* key, int least, int most, std::size_t& value) {
    value = static_cast<std::size_t>(top.integer(key, least, most, static_cast<int>(value)));
  };
  count("population", 8, kMaxPopulation, search.population);
  count("generations", 0, kMaxGenerations, search.generations);
  count("restarts", 1, kMaxRestarts, search.restarts);
  search.seed = static_cast<std::uint64_t>(
      top.integer("seed", 0, std::numeric_limits<int>::max(), static_cast<int>(search.seed)));
  search.refine = top.flag("refine", search.refine);
  count("samples", 1, kMaxSamples, request.samples);
  request.comparison = static_cast<SearchComparisonChoice>(
      top.choice("comparison", {"fast", "yes", "no"}, static_cast<int>(request.comparison)));
  for (TableReader& one : top.tables("vary")) {
    const std::string name = one.text("parameter");
    request.vary.emplace_back(name, one.text("values"));
    one.finish();
  }
  top.finish();
  return request;
}

OptimisePlan optimise_plan(const OptimiseRequest& request, const Case& base) {
  if (request.minimise.empty() && request.maximise.empty())
    throw InputError("optimise: name an objective, as in --minimise peak:Rb1");
  OptimisePlan plan;
  plan.search = request.search;
  plan.samples = request.samples;
  plan.comparison = request.comparison;
  const SearchOptions& search = plan.search;
  if (static_cast<double>(search.restarts) * static_cast<double>(search.generations + 1) *
          static_cast<double>(search.population) >
      static_cast<double>(kMaxEvaluations))
    throw InputError("optimise: more than " + std::to_string(kMaxEvaluations) +
                     " designs; lower --population, --generations or --restarts");
  if (!request.conditions.empty()) plan.conditions = read_duty_cycle(request.conditions, base);
  std::vector<Output> outputs;
  std::vector<int> directions;
  const auto add = [&](const std::string& text, int direction) {
    const auto [wanted, taken] = taken_of(text, plan, base);
    auto found = std::find(outputs.begin(), outputs.end(), wanted);
    if (found == outputs.end()) {
      outputs.push_back(wanted);
      directions.push_back(0);
      plan.taken.push_back(taken);
      found = outputs.end() - 1;
    }
    const auto place = static_cast<std::size_t>(found - outputs.begin());
    if (directions[place] * direction < 0)
      throw InputError("output " + wanted.name + ": cannot be both minimised and maximised");
    if (direction != 0) directions[place] = direction;
    return place;
  };
  for (const std::string& name : request.minimise) add(name, -1);
  for (const std::string& name : request.maximise) add(name, +1);
  for (const std::string& name : request.outputs) add(name, 0);
  for (const std::string& text : request.subject_to) {
    const ConstraintText limit = parsed(text);
    plan.constraints.push_back({add(limit.output, 0), limit.at_most, limit.limit});
  }
  SweepRequest designs;
  designs.sampling = Sampling::sobol;
  designs.samples = plan.evaluations();
  designs.seed = search.seed;
  designs.vary = request.vary;
  designs.outputs = {plan.computed.front().name};
  designs.model = request.model;
  plan.designs = sweep_plan(designs, base);
  plan.designs.outputs = std::move(outputs);
  plan.designs.direction = std::move(directions);
  for (const Varied& varied : plan.designs.varied) search_variable(varied);
  for (const Variable& condition : plan.conditions.variables)
    for (const Varied& varied : plan.designs.varied)
      if (varied.variable.name() == condition.name())
        throw InputError("--vary " + condition.name() + ": " + request.conditions.string() +
                         " gives it for every operating point");
  return plan;
}

}  // namespace bentaxis::designs
