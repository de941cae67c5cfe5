#include "bentaxis/designs/optimise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/pareto.h"
#include "bentaxis/designs/robust.h"
#include "bentaxis/designs/sensitivity.h"
#include "bentaxis/files/csv_rows.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/stopwatch.h"
#include "bentaxis/study/memory.h"
#include "bentaxis/study/reporting.h"

namespace bentaxis::designs {
namespace {

constexpr std::size_t kFastPiece = 64;  // designs computed at a time, at most; of slow ones one
constexpr std::size_t kPieces = 8;      // that a batch is cut in, at least
constexpr std::size_t kMaxEvaluations = 100000000;
// Steps of differences, as a part of a range: of the closed form, and of pressures that an
// integrator computes to a tolerance.
constexpr double kSmoothStep = 1e-5, kRoughStep = 1e-3;

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
    const auto trimmed = [](std::string part) {
      part.erase(0, part.find_first_not_of(' '));
      part.erase(part.find_last_not_of(' ') + 1);
      return part;
    };
    const std::string limit = trimmed(text.substr(at + 2));
    const auto number = number_in(limit);
    if (!number || !std::isfinite(*number))
      throw InputError(what + ": \"" + limit + "\" must be a number in the output's unit");
    return {trimmed(text.substr(0, at)), sign[0] == '<', *number};
  }
  throw InputError(what + ": must be \"OUTPUT <= NUMBER\" or \"OUTPUT >= NUMBER\"");
}

// A variable of the search: its values, or where they are listed their places.
struct SearchVariable {
  double low, high;
  bool whole;
};
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

struct Optimiser::Implementation {
  Case base;
  OptimisePlan plan;
  std::vector<SearchVariable> variables;
  std::vector<std::size_t> objectives;         // outputs with a direction
  Evaluator evaluator;                         // of designs and conditions
  std::optional<QuantileEvaluator> quantiles;  // of these, where quantiles are asked for
  Evaluation own;
  std::vector<double> scales;  // of constraints

  static Family family_of(const Case& base, const OptimisePlan& plan) {
    std::vector<Variable> all;
    for (const Varied& varied : plan.designs.varied) all.push_back(varied.variable);
    const auto& conditions = plan.conditions.variables;
    all.insert(all.end(), conditions.begin(), conditions.end());
    return {base, std::move(all)};
  }

  Implementation(Case the_case, OptimisePlan the_plan)
      : base(std::move(the_case)),
        plan(std::move(the_plan)),
        evaluator(family_of(base, plan), plan.computed, plan.designs.model) {
    for (const Varied& varied : plan.designs.varied) variables.push_back(search_variable(varied));
    for (std::size_t k = 0; k < plan.designs.direction.size(); ++k)
      if (plan.designs.direction[k] != 0) objectives.push_back(k);
    if (plan.robust()) {
      std::vector<QuantileOutput> wanted;
      for (std::size_t k = 0; k < computed(); ++k)
        if (plan.quantiles[k]) wanted.push_back({plan.computed[k], *plan.quantiles[k]});
      quantiles.emplace(base, evaluator.family().variables(), std::move(wanted), plan.samples,
                        plan.search.seed, plan.designs.model);
    }
    // Designs with their outputs twice, their costs, constraints and violation, and a reason each.
    const double numbers = static_cast<double>(variables.size() + 2 * outputs() +
                                               objectives.size() + plan.constraints.size() + 1);
    study::require_memory(
        static_cast<double>(plan.evaluations()) * (numbers * sizeof(double) + sizeof(std::string)),
        fmt::format("optimise: {} designs of {} variables and {} outputs", plan.evaluations(),
                    variables.size(), outputs()),
        "lower --population, --generations or --restarts");
    std::vector<double> values;
    for (const Varied& varied : plan.designs.varied) values.push_back(varied.variable.value(base));
    std::vector<double> raw(rows() * computed());
    own.reason = compute(values, raw);
    own.values = outputs_in(raw);
    for (const Constraint& c : plan.constraints) {
      const double here = std::abs(own.values[c.output]);
      scales.push_back(std::max(std::abs(c.limit), std::isfinite(here) ? here : 0));
      if (!(scales.back() > 0)) scales.back() = 1;
    }
    if (own.reason.empty()) own.reason = violated(raw);
  }

  std::size_t outputs() const { return plan.designs.outputs.size(); }
  std::size_t computed() const { return plan.computed.size(); }  // of each row
  std::size_t rows() const { return plan.conditions.rows.size(); }

  // Values of the parameters at a point of the search.
  std::vector<double> values_at(std::span<const double> x) const {
    std::vector<double> values(x.begin(), x.end());
    for (std::size_t k = 0; k < values.size(); ++k)
      if (const auto& levels = plan.designs.varied[k].levels; !levels.empty())
        values[k] = levels[static_cast<std::size_t>(values[k])];
    return values;
  }
  // The reverse, of the nearest point of the search.
  std::vector<double> point_of(const std::vector<double>& values) const {
    std::vector<double> x = values;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (const auto& levels = plan.designs.varied[k].levels; !levels.empty())
        x[k] = static_cast<double>(std::min_element(levels.begin(), levels.end(),
                                                    [&](double a, double b) {
                                                      return std::abs(a - values[k]) <
                                                             std::abs(b - values[k]);
                                                    }) -
                                   levels.begin());
      x[k] = std::clamp(x[k], variables[k].low, variables[k].high);
      if (variables[k].whole) x[k] = std::round(x[k]);
    }
    return x;
  }

  // Quantiles in the places of what they are of. @return why there are none
  std::string put_quantiles(std::span<const double> values, std::span<double> raw) const {
    std::vector<double> found(computed());  // as many as there may be
    std::string why = quantiles->evaluate(values, found);
    auto next = found.begin();
    for (std::size_t k = 0; k < computed(); ++k)
      if (plan.quantiles[k]) raw[k] = *next++;
    return why;
  }

  // Outputs of one design at every operating point, row by row. @return why it has none
  std::string compute(std::span<const double> values, std::span<double> raw) const {
    std::string reason;
    for (std::size_t row = 0; row < rows(); ++row) {
      std::vector<double> all(values.begin(), values.end());
      const auto& condition = plan.conditions.rows[row];
      all.insert(all.end(), condition.values.begin(), condition.values.end());
      const auto here = raw.subspan(row * computed(), computed());
      std::string why;
      evaluator.evaluate(1, all, here, {&why, 1});
      if (why.empty() && quantiles) why = put_quantiles(all, here);
      if (!why.empty() && reason.empty())
        reason = rows() == 1 ? why : plan.conditions.name_of(row) + ": " + why;
    }
    if (!reason.empty()) std::fill(raw.begin(), raw.end(), not_computed());
    return reason;
  }

  // The same of several designs.
  void compute(std::span<const double> values, std::span<double> raw,
               std::span<std::string> reasons) const {
    if (rows() == 1 && plan.conditions.variables.empty() && !quantiles)
      return evaluator.evaluate(reasons.size(), values, raw, reasons);
    const std::size_t n = variables.size(), m = rows() * computed();
    for (std::size_t i = 0; i < reasons.size(); ++i)
      reasons[i] = compute(values.subspan(i * n, n), raw.subspan(i * m, m));
  }

  double value_at(std::size_t output, std::size_t row, std::span<const double> raw) const {
    return raw[row * computed() + plan.taken[output].from];
  }
  // How far a design is beyond a constraint at its worst operating point, in the output's unit.
  double beyond(const Constraint& c, std::span<const double> raw) const {
    double worst = -std::numeric_limits<double>::infinity();
    const auto& only = plan.taken[c.output].row;
    for (std::size_t row = 0; row < rows(); ++row) {
      if (only && row != *only) continue;
      const double value = value_at(c.output, row, raw);
      const double over = c.at_most ? value - c.limit : c.limit - value;
      if (!(over <= worst)) worst = over;  // NaN stays
      if (std::isnan(worst)) break;
    }
    return worst;
  }
  double mean(std::size_t output, std::span<const double> raw) const {
    if (const auto& only = plan.taken[output].row) return value_at(output, *only, raw);
    if (rows() == 1) return value_at(output, 0, raw);
    double sum = 0, shares = 0;
    for (std::size_t row = 0; row < rows(); ++row) {
      sum += plan.conditions.rows[row].share * value_at(output, row, raw);
      shares += plan.conditions.rows[row].share;
    }
    return sum / shares;
  }
  // As Optimisation has them.
  std::vector<double> outputs_in(std::span<const double> raw) const {
    std::vector<double> values;
    for (std::size_t k = 0; k < outputs(); ++k) values.push_back(mean(k, raw));
    for (const Constraint& c : plan.constraints)
      if (plan.designs.direction[c.output] == 0)
        values[c.output] = c.limit + (c.at_most ? 1 : -1) * beyond(c, raw);
    return values;
  }
  // The constraints that a design violates; "" where none.
  std::string violated(std::span<const double> raw) const {
    std::string text;
    for (const Constraint& c : plan.constraints)
      if (const double over = beyond(c, raw); !(over <= 0))
        text += fmt::format(
            "{}{}: {}", text.empty() ? "" : "; ", plan.text(c),
            std::isnan(over) ? "has no value" : fmt::format("exceeded by {:.4g}", over));
    return text;
  }
  // Costs and constraints of a design as the search wants them.
  void numbers_of(std::span<const double> raw, std::span<double> numbers) const {
    std::size_t next = 0;
    for (const std::size_t k : objectives)
      numbers[next++] = -plan.designs.direction[k] * mean(k, raw);
    for (std::size_t i = 0; i < plan.constraints.size(); ++i)
      numbers[next++] = beyond(plan.constraints[i], raw) / scales[i];
  }

  // Exact derivatives where every one of them is.
  bool differentiate(std::span<const double> x, std::span<double> jacobian) const {
    if (!evaluator.fast() || rows() != 1 || !plan.conditions.variables.empty() || quantiles)
      return false;
    for (const SearchVariable& v : variables)
      if (v.whole) return false;
    Case here = base;
    evaluator.family().make(values_at(x), here);
    std::vector<Variable> varied;
    for (const Varied& v : plan.designs.varied) varied.push_back(v.variable);
    std::vector<Output> wanted;
    std::vector<double> factors;
    for (const std::size_t k : objectives) {
      wanted.push_back(plan.designs.outputs[k]);
      factors.push_back(-plan.designs.direction[k]);
    }
    for (std::size_t i = 0; i < plan.constraints.size(); ++i) {
      wanted.push_back(plan.designs.outputs[plan.constraints[i].output]);
      factors.push_back((plan.constraints[i].at_most ? 1 : -1) / scales[i]);
    }
    const auto is_exact = [](const Output& o) { return o.source == Source::curve; };
    if (!std::all_of(wanted.begin(), wanted.end(), is_exact)) return false;  // by differences there
    const Sensitivities found = sensitivities(here, varied, wanted, plan.designs.model);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      for (std::size_t k = 0; k < varied.size(); ++k) {
        const Derivative& d = found.derivatives[i][k];
        if (d.way != Way::exact || !std::isfinite(d.value)) return false;
        jacobian[i * varied.size() + k] = factors[i] * d.value;
      }
    return true;
  }

  Optimisation run(const OptimiseWork& work, const Progress& progress) const;
};

namespace {

// Batches of designs: computed by threads and processes, kept in a folder, taken from there.
class Batches {
 public:
  using Compute = std::function<void(std::span<const double> values, std::span<double> raw,
                                     std::span<std::string> reasons)>;
  Batches(const OptimiseWork& work, std::size_t piece, Compute compute)
      : work_(work), piece_(piece), compute_(std::move(compute)) {}

  // A batch of the size of all.
  SweepBlock make(std::vector<double> values, std::size_t designs, std::size_t numbers,
                  const std::function<void()>& tick) {
    SweepBlock block;
    block.first = next_ * designs;
    block.designs = designs;
    block.values = std::move(values);
    const std::size_t number = next_++;
    if (auto found = found_in(number, block.values); all_have(found.has_value())) {
      ++kept_;
      return std::move(*found);
    }
    fill(block, numbers, tick);
    keep(number, block);
    return block;
  }

  // Designs outside of batches, each of which is kept by itself where `keeps`.
  SweepBlock make_singles(std::vector<double> values, std::size_t designs, std::size_t numbers,
                          bool keeps, const std::function<void()>& tick) {
    SweepBlock block;
    block.designs = designs;
    block.values = std::move(values);
    if (!keeps || work_.parts == nullptr) {
      fill(block, numbers, tick);
      return block;
    }
    const BlockLayout& layout = work_.parts->record().layout;
    const std::size_t width = block.values.size() / designs;
    block.results.resize(designs * numbers);
    block.reasons.resize(designs);
    const auto take = [&](std::size_t i, const SweepBlock& from, std::size_t place) {
      std::copy_n(from.results.begin() + static_cast<std::ptrdiff_t>(place * numbers), numbers,
                  block.results.begin() + static_cast<std::ptrdiff_t>(i * numbers));
      block.reasons[i] = from.reasons[place];
    };
    SweepBlock missing;
    std::vector<std::size_t> places;
    const std::size_t first = next_single_;
    next_single_ += designs;
    for (std::size_t i = 0; i < designs; ++i) {
      const auto from = block.values.begin() + static_cast<std::ptrdiff_t>(i * width);
      const std::vector<double> here(from, from + static_cast<std::ptrdiff_t>(width));
      const auto found = found_in(layout.blocks() + first + i, here);
      if (all_have(found.has_value())) {
        ++kept_singles_;
        take(i, *found, 0);
      } else {
        places.push_back(i);
        missing.values.insert(missing.values.end(), here.begin(), here.end());
      }
    }
    missing.designs = places.size();
    if (places.empty()) return block;
    fill(missing, numbers, tick);
    for (std::size_t k = 0; k < places.size(); ++k) {
      take(places[k], missing, k);
      SweepBlock single;
      single.first = layout.designs + first + places[k];
      single.designs = 1;
      const auto from = missing.values.begin() + static_cast<std::ptrdiff_t>(k * width);
      single.values.assign(from, from + static_cast<std::ptrdiff_t>(width));
      const auto result = missing.results.begin() + static_cast<std::ptrdiff_t>(k * numbers);
      single.results.assign(result, result + static_cast<std::ptrdiff_t>(numbers));
      single.reasons = {missing.reasons[k]};
      keep(layout.blocks() + first + places[k], single);
    }
    return block;
  }
  std::size_t kept() const { return kept_; }
  std::size_t kept_singles() const { return kept_singles_; }

 private:
  // What an earlier run has kept under this number, where it is of these values.
  std::optional<SweepBlock> found_in(std::size_t number, const std::vector<double>& values) const {
    if (work_.parts == nullptr || !work_.resume) return std::nullopt;
    auto found = work_.parts->read(number);
    if (found && found->values != values) found.reset();
    return found;
  }
  void keep(std::size_t number, const SweepBlock& block) const {
    if (work_.parts != nullptr && work_.rank == 0) work_.parts->keep(number, block);
  }
  // All processes take a batch from the folder, or none does.
  bool all_have(bool one) const {
    double count = one ? 1 : 0;
    if (work_.ranks > 1 && work_.sum) work_.sum({&count, 1});
    return count == static_cast<double>(work_.ranks);
  }

  void fill(SweepBlock& block, std::size_t numbers, const std::function<void()>& tick) {
    const std::size_t width = block.values.size() / block.designs;
    block.results.assign(block.designs * numbers, 0);
    block.reasons.assign(block.designs, "");
    const std::size_t size = std::clamp<std::size_t>(block.designs / kPieces, 1, piece_);
    const std::size_t pieces = (block.designs + size - 1) / size;
    // One by one where it is all there is: threads cost more than a design.
    study::Reporting reporting(1, [&](double) { tick(); });
    const auto piece = [&](std::size_t p) {
      if (p % work_.ranks != work_.rank) return;
      reporting.tick();
      const std::size_t first = p * size, count = std::min(size, block.designs - first);
      compute_(std::span<const double>(block.values).subspan(first * width, count * width),
               std::span(block.results).subspan(first * numbers, count * numbers),
               std::span(block.reasons).subspan(first, count));
    };
    if (pieces == 1)
      piece(0);
    else
      numerics::parallel_for(work_.threads, pieces, piece);
    if (work_.ranks > 1 && work_.sum) work_.sum(block.results);
  }

  const OptimiseWork& work_;
  std::size_t piece_;
  Compute compute_;
  std::size_t next_ = 0, kept_ = 0, next_single_ = 0, kept_singles_ = 0;
};

// Of a design that another process computed, or an earlier run: NaN says that there are no values.
constexpr const char* kElsewhere = "has no values";

}  // namespace

Optimisation Optimiser::Implementation::run(const OptimiseWork& work,
                                            const Progress& progress) const {
  const Stopwatch watch;
  Optimisation found;
  found.plan = plan;
  found.own = own;
  SweepResult& designs = found.designs;
  designs.plan = plan.designs;
  designs.base = base;
  const std::size_t n = variables.size(), m = outputs();
  const std::size_t all = plan.evaluations();
  Batches batches(work, evaluator.fast() ? kFastPiece : 1,
                  [this](auto values, auto raw, auto reasons) { compute(values, raw, reasons); });

  SearchProblem problem;
  for (const SearchVariable& v : variables) {
    problem.low.push_back(v.low);
    problem.high.push_back(v.high);
    problem.whole.push_back(v.whole);
  }
  problem.objectives = objectives.size();
  problem.constraints = plan.constraints.size();
  problem.step = evaluator.fast() ? kSmoothStep : kRoughStep;
  problem.differentiate = [this](auto x, auto jacobian) { return differentiate(x, jacobian); };
  std::vector<double> numbers;  // of all designs, for the volumes of fronts
  const auto tell = [&] {
    if (progress)
      progress(std::min(1.0, static_cast<double>(designs.designs) / static_cast<double>(all)));
  };
  const auto block_at = [&](std::size_t count, std::span<const double> points, bool batch) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
      const auto one = values_at(points.subspan(i * n, n));
      values.insert(values.end(), one.begin(), one.end());
    }
    // Of the closed form a design takes less time than its file.
    return batch ? batches.make(std::move(values), count, rows() * computed(), tell)
                 : batches.make_singles(std::move(values), count, rows() * computed(),
                                        !evaluator.fast(), tell);
  };
  problem.evaluate = [&](std::size_t count, std::span<const double> points,
                         std::span<double> results) {
    const Stopwatch evaluation;
    SweepBlock block =
        block_at(count, points, count == plan.search.population && designs.designs < all);
    found.evaluation_seconds += evaluation.seconds();
    for (std::size_t i = 0; i < count; ++i) {
      const auto raw = std::span<const double>(block.results)
                           .subspan(i * rows() * computed(), rows() * computed());
      const auto row = results.subspan(i * problem.numbers(), problem.numbers());
      numbers_of(raw, row);
      const std::vector<double> measured = outputs_in(raw);
      found.measured.insert(found.measured.end(), measured.begin(), measured.end());
      found.violations.push_back(violation(problem, row));
      std::string reason = std::move(block.reasons[i]);
      if (reason.empty()) reason = violated(raw);
      if (reason.empty() && found.violations.back() > 0) reason = kElsewhere;
      if (reason.empty())
        designs.results.insert(designs.results.end(), measured.begin(), measured.end());
      else
        designs.results.insert(designs.results.end(), m, not_computed());
      if (!reason.empty()) designs.infeasible.emplace_back(designs.designs + i, std::move(reason));
    }
    designs.values.insert(designs.values.end(), block.values.begin(), block.values.end());
    designs.designs += count;
    numbers.insert(numbers.end(), results.begin(), results.end());
    tell();
  };
  std::vector<double> start;
  for (const Varied& varied : plan.designs.varied) start.push_back(varied.variable.value(base));
  found.search = search(problem, point_of(start), plan.search);
  designs.all_infeasible = designs.infeasible.size();
  designs.plan.samples = designs.designs;
  if (std::all_of(found.violations.begin(), found.violations.end(),
                  [](double wrong) { return std::isinf(wrong); }))
    throw ComputationError("optimise: no design has values; the first: " +
                           designs.infeasible.front().second);

  // The front, what is chosen of it, and how much of it each search finds alone.
  const std::vector<std::size_t> front = pareto_front(designs.results, plan.designs.direction);
  const auto cost = [&](std::size_t design, std::size_t k) {
    return numbers[design * problem.numbers() + k];
  };
  std::vector<double> low(problem.objectives, std::numeric_limits<double>::infinity());
  std::vector<double> high(problem.objectives, -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < problem.objectives; ++k) {
    std::optional<std::size_t> best;
    for (const std::size_t design : front) {
      low[k] = std::min(low[k], cost(design, k));
      high[k] = std::max(high[k], cost(design, k));
      if (!best || cost(design, k) < cost(*best, k)) best = design;
    }
    const Output& output = plan.designs.outputs[objectives[k]];
    if (best)
      found.chosen.push_back(
          {(plan.designs.direction[objectives[k]] < 0 ? "lowest " : "largest ") + output.name,
           *best});
  }
  if (problem.objectives > 1 && !front.empty()) {
    const auto distance = [&](std::size_t design) {
      double sum = 0;
      for (std::size_t k = 0; k < problem.objectives; ++k)
        if (high[k] > low[k]) sum += std::pow((cost(design, k) - low[k]) / (high[k] - low[k]), 2);
      return sum;
    };
    found.chosen.push_back(
        {"balanced", *std::min_element(front.begin(), front.end(),
                                       [&](auto a, auto b) { return distance(a) < distance(b); })});
  }
  constexpr std::size_t kMaxVolume = 3;
  const bool has_volume = !front.empty() && problem.objectives <= kMaxVolume;
  // Of costs, `width` numbers apart, of the points from .. to - 1 that are allowed.
  const auto volume_of = [&](std::span<const double> costs, std::span<const double> violations) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < violations.size(); ++i) {
      if (violations[i] > 0) continue;
      for (std::size_t k = 0; k < problem.objectives; ++k) {
        const double width = high[k] - low[k], above = costs[i * problem.numbers() + k] - low[k];
        shares.push_back(width > 0 ? above / width : above);
      }
    }
    // A tenth beyond its worst point, so that the ends of the front count.
    return hypervolume(shares, std::vector<double>(problem.objectives, 1.1));
  };
  const double whole = has_volume ? volume_of(numbers, found.violations) : not_computed();
  if (has_volume) {
    std::size_t from = 0;
    for (std::size_t i = 0; i < plan.search.restarts; ++i) {
      const std::size_t count = found.search.evaluations[i], width = problem.numbers();
      found.shares_of_front.push_back(
          volume_of(std::span<const double>(numbers).subspan(from * width, count * width),
                    std::span<const double>(found.violations).subspan(from, count)) /
          whole);
      from += count;
    }
  }
  designs.seconds = watch.seconds();
  if (plan.comparison == SearchComparisonChoice::yes ||
      (plan.comparison == SearchComparisonChoice::fast && evaluator.fast()))
    for (const bool is_grid : {false, true}) {
      const std::vector<double> points =
          is_grid ? grid_search_points(problem, designs.designs)
                  : random_search_points(problem, designs.designs, plan.search.seed);
      SearchComparison one;
      one.name = is_grid ? "grid" : "random";
      one.evaluations = points.size() / n;
      one.best.assign(problem.objectives, not_computed());
      std::vector<double> costs(one.evaluations * problem.numbers()), violations;
      const Stopwatch evaluation;
      for (std::size_t from = 0; from < one.evaluations; from += plan.search.population) {
        const std::size_t count = std::min(plan.search.population, one.evaluations - from);
        const SweepBlock block =
            block_at(count, std::span<const double>(points).subspan(from * n, count * n), false);
        for (std::size_t i = 0; i < count; ++i) {
          const std::size_t width = rows() * computed();
          const auto row =
              std::span<double>(costs).subspan((from + i) * problem.numbers(), problem.numbers());
          numbers_of(std::span<const double>(block.results).subspan(i * width, width), row);
          violations.push_back(violation(problem, row));
          if (violations.back() > 0) continue;
          ++one.feasible;
          for (std::size_t k = 0; k < problem.objectives; ++k) {
            const double value = -plan.designs.direction[objectives[k]] * row[k];
            if (!is_computed(one.best[k]) ||
                plan.designs.direction[objectives[k]] * (value - one.best[k]) > 0)
              one.best[k] = value;
          }
        }
      }
      one.seconds = evaluation.seconds();
      one.share_of_front = has_volume ? volume_of(costs, violations) / whole : not_computed();
      found.comparisons.push_back(std::move(one));
    }
  found.kept = batches.kept();
  found.kept_singles = batches.kept_singles();
  if (work.rank == 0) found.validity = validity_of_chosen(found);
  return found;
}

Optimiser::Optimiser(Case base, OptimisePlan plan)
    : implementation_(std::make_unique<Implementation>(std::move(base), std::move(plan))) {}
Optimiser::~Optimiser() = default;
Optimiser::Optimiser(Optimiser&&) noexcept = default;

const OptimisePlan& Optimiser::plan() const { return implementation_->plan; }

std::size_t Optimiser::batches() const {
  return plan().search.restarts * (plan().search.generations + 1);
}

SweepRecord Optimiser::record(const std::string& program) const {
  const Implementation& it = *implementation_;
  SweepRecord record = record_of(Sweep(it.base, it.plan.designs), program);
  std::string all =
      record.identity + "\noptimise " + search_libraries() +
      fmt::format("\n{} {} {} {}", it.plan.search.population, it.plan.search.generations,
                  it.plan.search.restarts, it.plan.search.seed);
  if (it.plan.robust()) all += fmt::format("\nsamples {}", it.plan.samples);
  for (std::size_t k = 0; k < it.plan.designs.outputs.size(); ++k)
    all += fmt::format("\n{}", it.plan.designs.direction[k]);
  for (const Constraint& c : it.plan.constraints) all += "\n" + it.plan.text(c);
  for (const DutyCycle::Row& row : it.plan.conditions.rows) {
    all += "\n" + number_text(row.share);
    for (std::size_t k = 0; k < row.values.size(); ++k)
      all += " " + it.plan.conditions.variables[k].name() + " " + number_text(row.values[k]);
  }
  const std::string identity = sha256_of(all);
  record.plan.replace(record.plan.find(record.identity), record.identity.size(), identity);
  record.identity = identity;
  record.layout = {it.plan.evaluations(), it.plan.search.population, it.variables.size(),
                   it.rows() * it.computed(), true};
  return record;
}

Optimisation Optimiser::run(const OptimiseWork& work, const Progress& progress) const {
  return implementation_->run(work, progress);
}

Case case_of(const Optimisation& found, std::size_t design) {
  std::vector<Variable> variables;
  for (const Varied& varied : found.plan.designs.varied) variables.push_back(varied.variable);
  const std::size_t n = variables.size();
  Case chosen = found.designs.base;
  Family(found.designs.base, std::move(variables))
      .make(std::span<const double>(found.designs.values).subspan(design * n, n), chosen);
  return chosen;
}

namespace {

// The designs that are wanted, with what was measured of them.
std::string designs_csv(const Optimisation& found, const std::vector<std::size_t>& wanted) {
  const std::size_t n = found.plan.designs.varied.size(), m = found.plan.designs.outputs.size();
  std::vector<std::string> header = {"design"};
  for (const Varied& varied : found.plan.designs.varied) header.push_back(varied.variable.name());
  for (const Output& o : found.plan.designs.outputs) header.push_back(o.name);
  header.emplace_back("violation");
  header.emplace_back("reason");
  CsvRows csv;
  csv.row(header);
  std::vector<std::string> reasons(found.evaluated());
  for (const auto& [design, reason] : found.designs.infeasible) reasons[design] = reason;
  for (const std::size_t design : wanted) {
    std::vector<std::string> values;
    for (std::size_t k = 0; k < n; ++k)
      values.push_back(
          found.plan.designs.varied[k].variable.text(found.designs.values[design * n + k]));
    const auto first = found.measured.begin() + static_cast<std::ptrdiff_t>(design * m);
    const double wrong = found.violations[design];
    csv.row(design, values, std::vector<double>(first, first + static_cast<std::ptrdiff_t>(m)),
            std::isfinite(wrong) ? wrong : not_computed(), reasons[design]);
  }
  return std::move(csv).text();
}

}  // namespace

std::string evaluations_csv(const Optimisation& found) {
  std::vector<std::size_t> all(found.evaluated());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return designs_csv(found, all);
}

std::string front_csv(const Optimisation& found) {
  return designs_csv(found, pareto_front(found.designs.results, found.plan.designs.direction));
}

}  // namespace bentaxis::designs
