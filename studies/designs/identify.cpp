#include "bentaxis/designs/identify.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "bentaxis/designs/points.h"
#include "bentaxis/numerics/object_pool.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/published_section.h"
#include "bentaxis/study/run.h"
#include "turn_statistics.h"

namespace bentaxis::designs {
namespace {

constexpr auto kModel = study::Model::analytic;

// Value of a column at an angle that the table has.
double at_angle(const ResultTable& table, std::size_t column, double theta_deg) {
  const auto& theta = table.theta_deg;
  const auto row = std::lower_bound(theta.begin(), theta.end(), wrap_degrees(theta_deg));
  return table.at(static_cast<std::size_t>(row - theta.begin()), column);
}

double outside(double value, double low, double high) {
  if (value < low) return value - low;
  return value > high ? value - high : 0;
}

double prior_residual(const Distribution& prior, double x) {
  return prior.shape == Shape::normal ? (x - prior.numbers[0]) / prior.numbers[1]
                                      : std::log(x / prior.numbers[0]) / prior.numbers[1];
}

}  // namespace

struct DataModel::Implementation {
  // One run of the model: a condition of the data under a variant of the publication.
  struct State {
    std::size_t condition = 0;
    compare::PublishedVariant variant;
    std::vector<std::size_t> data;  // that are read off it
    std::vector<Output> outputs;    // of them, in their order
    std::vector<double> angles;     // of the records among them, deg in a turn, rising
    bool table = false;             // whether one of them needs the curves over a whole turn
    bool kernel = false;            // whether `wanted` has all columns they need
  };
  // The cases of a condition, and which unknowns act in it.
  struct Branch {
    Family family;
    std::vector<std::size_t> unknowns;
    std::vector<double> settings;
  };

  Case base;
  IdentificationData data;
  std::vector<Branch> branches;  // one per condition
  std::vector<State> states;
  std::vector<std::size_t> places;
  std::size_t numbers = 0;
  std::vector<std::size_t> wanted;  // columns that the kernel computes, rising

  // Designs by the kernel, at one set of angles.
  struct Turn {
    KernelTurn turn;
    std::optional<analytic::BatchColumns> columns;
    ResultTable table;  // of the wanted columns
  };
  // What one thread works in.
  struct Scratch {
    std::vector<Case> of_branch;
    Case the_case;
    Turn whole;                  // at the samples of the case
    std::vector<Turn> of_state;  // at the angles of its records
  };
  mutable numerics::ObjectPool<Scratch> scratches;

  Scratch fresh() const {
    Scratch scratch;
    scratch.of_branch.assign(branches.size(), base);
    for (const State& state : states) {
      scratch.of_state.push_back({KernelTurn(state.angles), {}, {}});
      scratch.of_state.back().table.theta_deg = state.angles;
    }
    const ChannelLayout layout(base.pump);
    const auto name = [&](Turn& turn) {
      for (const std::size_t column : wanted)
        turn.table.channels.push_back(layout.channels()[column]);
    };
    name(scratch.whole);
    for (Turn& turn : scratch.of_state) name(turn);
    return scratch;
  }
  std::size_t place_in_table(std::size_t column) const {
    return static_cast<std::size_t>(std::lower_bound(wanted.begin(), wanted.end(), column) -
                                    wanted.begin());
  }

  // Lets the kernel compute what it can.
  void use_kernel() {
    const ChannelLayout layout(base.pump);
    const auto gives = [&](std::size_t column) {
      return column < layout.reactions() || (layout.has(Quantity::Tcs) && column == layout.Tcs());
    };
    std::set<std::size_t> all;
    for (State& state : states) {
      state.kernel = stays_in_reach(branches[state.condition].family) &&
                     base.analytic.flanks == FlankShape::involute &&
                     base.analytic.gear == BlockDrive::mesh;
      std::set<std::size_t> columns;
      for (const std::size_t i : state.data) {
        const Datum& datum = data.data[i];
        if (datum.curve) columns.insert(datum.curve->column);
        if (datum.output && datum.output->source == Source::curve)
          columns.insert(datum.output->columns.begin(), datum.output->columns.end());
        else if (datum.output && datum.output->source != Source::derived)
          state.kernel = false;
        if (datum.printed)
          for (const std::string& name : datum.printed->channels)
            columns.insert(static_cast<std::size_t>(
                std::find_if(layout.channels().begin(), layout.channels().end(),
                             [&](const Channel& c) { return c.name == name; }) -
                layout.channels().begin()));
      }
      state.kernel = state.kernel && std::all_of(columns.begin(), columns.end(), gives);
      if (state.kernel) all.insert(columns.begin(), columns.end());
    }
    wanted.assign(all.begin(), all.end());
  }

  // Fills the table of a turn by the kernel. @return false where the general way has to say what
  // is wrong
  bool tabulate(const Case& the_case, const Assumptions& assumptions, Turn& turn) const {
    if (assumptions.gear != BlockDrive::mesh) return false;
    turn.turn.become(the_case, assumptions);
    const ChannelLayout& layout = turn.turn.model().layout();
    const analytic::BatchInstants instants = turn.turn.instants();
    const std::size_t rows = instants.count;
    ResultTable& table = turn.table;
    if (table.rows() != rows) {
      table.theta_deg.resize(rows);
      for (std::size_t i = 0; i < rows; ++i)
        table.theta_deg[i] = 360.0 * static_cast<double>(i) / static_cast<double>(rows);
    }
    if (table.values.size() != rows * wanted.size() || !turn.columns) {
      turn.columns.emplace(layout.reactions(), rows);
      table.values.resize(rows * wanted.size());
    }
    // The torque on the block is the tooth force's on its arm.
    const auto is_carrying = [&](std::size_t column) {
      return layout.has(Quantity::Tcs) && column == layout.Tcs();
    };
    const auto source = [&](std::size_t column) {
      return is_carrying(column) ? layout.Rcs() : column;
    };
    analytic::BatchOutputs outputs(layout.reactions());
    for (const std::size_t column : wanted)
      outputs[source(column)] = turn.columns->column(source(column));
    turn.turn.model().reactions(instants, outputs);
    const Gear& gear = the_case.pump.gear;
    for (std::size_t c = 0; c < wanted.size(); ++c) {
      double factor = 1 / table.channels[c].unit_in_si;
      if (is_carrying(wanted[c])) factor *= gear.pitch_diameter / 2 * std::cos(gear.pressure_angle);
      const double* values = turn.columns->column(source(wanted[c]));
      for (std::size_t row = 0; row < rows; ++row) {
        if (!std::isfinite(values[row])) return false;
        table.values[row * wanted.size() + c] = factor * values[row];
      }
    }
    return true;
  }

  double value_of(const Output& output, const Scratch& scratch) const {
    if (output.source == Source::derived) return derived_value(output, scratch.the_case.pump);
    const ResultTable& table = scratch.whole.table;
    std::vector<double> curve(table.rows());
    for (std::size_t row = 0; row < curve.size(); ++row) {
      double square = 0, value = 0;
      for (const std::size_t column : output.columns) {
        value = table.at(row, place_in_table(column));
        square += value * value;
      }
      curve[row] = output.columns.size() > 1 ? std::sqrt(square) : value;
    }
    return statistic_of(output.statistic, curve);
  }

  // Of a state that the kernel serves. @return as tabulate()
  bool read_off_kernel(const State& state, Scratch& scratch, std::span<double> results) const {
    Assumptions assumptions = scratch.the_case.analytic;
    study::apply_variant(state.variant, scratch.the_case, assumptions);
    Turn& at_records = scratch.of_state[static_cast<std::size_t>(&state - states.data())];
    const Case& the_case = scratch.the_case;
    if (!state.angles.empty() && !tabulate(the_case, assumptions, at_records)) return false;
    const bool turns = state.table || !state.outputs.empty();
    if (turns && !tabulate(the_case, assumptions, scratch.whole)) return false;
    read_table(
        state, {&scratch.whole.table, study::facts_of(the_case, assumptions)}, at_records.table,
        [&](std::size_t column) { return place_in_table(column); }, results);
    for (const std::size_t i : state.data)
      if (data.data[i].output) results[places[i]] = value_of(*data.data[i].output, scratch);
    return true;
  }

  // What is read off curves: printed numbers of a turn, and records at their own angles.
  template <class PlaceOf>
  void read_table(const State& state, const compare::PublishedRun& run,
                  const ResultTable& at_records, const PlaceOf& place_of,
                  std::span<double> results) const {
    for (const std::size_t i : state.data) {
      const Datum& datum = data.data[i];
      const std::size_t place = places[i];
      if (datum.printed) {
        const auto value = compare::value_of(*datum.printed, run);
        if (!value) throw ComputationError(datum.what + ": is not computed");
        results[place] = value->low;
        if (datum.size() == 2) results[place + 1] = value->high;
      } else if (datum.curve) {
        for (std::size_t k = 0; k < datum.size(); ++k)
          results[place + k] =
              at_angle(at_records, place_of(datum.curve->column), datum.curve->theta_deg[k]);
      }
    }
  }

  Branch branch_of(const Condition& condition) const {
    std::vector<Variable> variables;
    std::vector<std::size_t> acting;
    for (std::size_t i = 0; i < data.unknowns.size(); ++i) {
      const Unknown& u = data.unknowns[i];
      if (!u.condition.empty() && u.condition != condition.name) continue;
      const bool set = std::any_of(
          condition.settings.begin(), condition.settings.end(),
          [&](const auto& setting) { return setting.first.name() == u.variable.name(); });
      if (set && u.condition.empty()) continue;  // the condition says what it is there
      variables.push_back(u.variable);
      acting.push_back(i);
    }
    std::vector<double> settings;
    for (const auto& setting : condition.settings) {
      // An unknown of this condition is the setting that is not known exactly.
      const auto is_set = [&](const Variable& v) { return v.name() == setting.first.name(); };
      if (std::any_of(variables.begin(), variables.end(), is_set)) continue;
      variables.push_back(setting.first);
      settings.push_back(setting.second);
    }
    return {Family(base, std::move(variables)), std::move(acting), std::move(settings)};
  }

  void make(const Branch& branch, std::span<const double> x, Case& scratch) const {
    std::vector<double> values;
    for (const std::size_t i : branch.unknowns) values.push_back(x[i]);
    values.insert(values.end(), branch.settings.begin(), branch.settings.end());
    branch.family.make(values, scratch);
  }

  void read_off(const State& state, const Case& the_case, std::span<double> results) const {
    std::optional<study::PreparedCase> prepared;
    if (!state.outputs.empty()) {
      const std::vector<double> values = outputs_of(state.outputs, the_case, prepared, kModel);
      std::size_t next = 0;
      for (const std::size_t i : state.data)
        if (data.data[i].output) results[places[i]] = values[next++];
    }
    if (!state.table && state.angles.empty()) return;
    if (!prepared) prepared.emplace(study::prepare(the_case));
    study::PreparedCase& ready = *prepared;
    compare::PublishedRun run;
    Assumptions assumptions = the_case.analytic;
    study::apply_variant(state.variant, ready.the_case, assumptions);
    run.facts = study::facts_of(ready.the_case, assumptions);
    const study::RunOptions options = {.assumptions = assumptions};
    const ResultTable table = state.table ? study::run(ready, options).table : ResultTable{};
    run.table = &table;
    const ResultTable at_records =
        state.angles.empty() ? ResultTable{} : study::run_at_angles(ready, state.angles, options);
    read_table(
        state, run, at_records, [](std::size_t column) { return column; }, results);
  }
};

DataModel::DataModel(Case base, IdentificationData data, bool kernel) {
  auto made = std::make_unique<Implementation>();
  made->base = std::move(base);
  made->data = std::move(data);
  IdentificationData& all = made->data;
  const std::string files =
      all.files.empty() ? "identify"
                        : joined(all.files, ", ", [](const auto& file) { return file.string(); });
  if (all.unknowns.empty())
    throw InputError(files + ": nothing is unknown: give [[unknown]] there, or --vary");
  std::set<std::string> names;
  for (const Unknown& u : all.unknowns)
    if (!names.insert(u.name()).second)
      throw InputError(files + ": " + u.name() + ": is unknown twice, in the data or by --vary");
  for (const Condition& condition : all.conditions)
    made->branches.push_back(made->branch_of(condition));
  std::map<std::pair<std::size_t, std::string>, std::size_t> index;
  for (std::size_t i = 0; i < all.data.size(); ++i) {
    const Datum& datum = all.data[i];
    made->places.push_back(made->numbers);
    made->numbers += datum.size();
    if (datum.use == Use::left_out) continue;
    const auto [at, fresh] =
        index.try_emplace({datum.condition, datum.variant}, made->states.size());
    if (fresh) {
      Implementation::State state;
      state.condition = datum.condition;
      for (const auto& variant : all.variants)
        if (variant.name == datum.variant) state.variant = variant;
      made->states.push_back(std::move(state));
    }
    Implementation::State& state = made->states[at->second];
    state.data.push_back(i);
    if (datum.output)
      state.outputs.push_back(*datum.output);
    else if (datum.curve)
      for (const double theta_deg : datum.curve->theta_deg)
        state.angles.push_back(wrap_degrees(theta_deg));
    else
      state.table = true;
  }
  if (std::none_of(all.data.begin(), all.data.end(),
                   [](const Datum& d) { return d.use == Use::fitted; }))
    throw InputError(files +
                     ": contain nothing to which unknowns can be fitted: [[number]], "
                     "[[window]] or [[curve]] with use = \"fitted\"");
  for (Implementation::State& state : made->states) sort_once(state.angles);
  if (kernel) made->use_kernel();
  implementation_ = std::move(made);
}

DataModel::~DataModel() = default;
DataModel::DataModel(DataModel&&) noexcept = default;

const Case& DataModel::base() const { return implementation_->base; }
const IdentificationData& DataModel::data() const { return implementation_->data; }
std::size_t DataModel::place_of(std::size_t datum) const { return implementation_->places[datum]; }
std::size_t DataModel::numbers() const { return implementation_->numbers; }

std::vector<double> DataModel::start() const {
  std::vector<double> x;
  for (const Unknown& u : data().unknowns) {
    double value = u.variable.value(base());
    for (const Condition& condition : data().conditions)
      if (condition.name == u.condition)
        for (const auto& [variable, set] : condition.settings)
          if (variable.name() == u.variable.name()) value = set;
    x.push_back(std::clamp(value, u.low, u.high));
  }
  return x;
}

bool DataModel::predict(std::span<const double> x, std::span<double> numbers) const {
  const Implementation& self = *implementation_;
  std::fill(numbers.begin(), numbers.end(), not_computed());
  auto scratch = self.scratches.take([&] { return self.fresh(); });
  const std::string reason = study::reason_of([&] {
    for (const Implementation::State& state : self.states) {
      Case& the_case = scratch->of_branch[state.condition];
      self.make(self.branches[state.condition], x, the_case);
      scratch->the_case = the_case;
      if (!state.kernel || !self.read_off_kernel(state, *scratch, numbers))
        self.read_off(state, the_case, numbers);
    }
  });
  self.scratches.give_back(std::move(scratch));
  return reason.empty();
}

double DataModel::residual(const Datum& datum, std::size_t number, double model) const {
  if (datum.curve)
    return (model - datum.curve->values[number]) / datum.curve->uncertainties[number];
  if (datum.value) return (model - *datum.value) / datum.uncertainty;
  return outside(model, datum.low, datum.high) / datum.uncertainty;
}

LeastSquaresProblem DataModel::problem(std::optional<std::size_t> without,
                                       bool bounds_as_prior) const {
  LeastSquaresProblem problem;
  problem.parameters = size();
  for (const Datum& datum : data().data)
    if (datum.use == Use::fitted) problem.residuals += datum.size();
  for (const Unknown& u : data().unknowns) {
    problem.low.push_back(u.low);
    problem.high.push_back(u.high);
    problem.residuals += u.prior || bounds_as_prior;
  }
  problem.evaluate = [this, without, bounds_as_prior](std::span<const double> x,
                                                      std::span<double> residuals) {
    std::vector<double> numbers(this->numbers());
    if (!predict(x, numbers)) return false;
    std::size_t next = 0;
    for (std::size_t i = 0; i < data().data.size(); ++i) {
      const Datum& datum = data().data[i];
      if (datum.use != Use::fitted) continue;
      for (std::size_t k = 0; k < datum.size(); ++k)
        residuals[next++] = i == without ? 0 : residual(datum, k, numbers[place_of(i) + k]);
    }
    for (std::size_t i = 0; i < size(); ++i) {
      const Unknown& u = data().unknowns[i];
      if (u.prior)
        residuals[next++] = prior_residual(*u.prior, x[i]);
      else if (bounds_as_prior)
        residuals[next++] = (x[i] - (u.low + u.high) / 2) / ((u.high - u.low) / std::sqrt(12.0));
    }
    return std::all_of(residuals.begin(), residuals.end(),
                       [](double r) { return std::isfinite(r); });
  };
  return problem;
}

Case DataModel::pump(std::span<const double> x) const {
  Case made = base();
  implementation_->make(implementation_->branches.front(), x, made);
  return made;
}

ResultTable DataModel::turn(std::span<const double> x) const {
  return study::run_turn(study::prepare(pump(x)), kModel);
}

namespace {

// Of the sum of squares: nothing against the 3.84 that matter.
constexpr double kSame = 0.01;

// Of fits that are one minimum to the eye, the one that changes the case least.
std::size_t nearest_of_best(const DataModel& model, const std::vector<LeastSquaresFit>& fits) {
  const std::vector<double> start = model.start();
  std::size_t best = 0;
  double nearest = HUGE_VAL;
  for (std::size_t f = 0; f < fits.size(); ++f) {
    if (fits[f].sum_of_squares > fits[0].sum_of_squares + kSame) break;
    double distance = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
      const Unknown& u = model.data().unknowns[i];
      distance += std::pow((fits[f].x[i] - start[i]) / (u.high - u.low), 2);
    }
    if (distance < nearest) {
      nearest = distance;
      best = f;
    }
  }
  return best;
}

// The fit once more, with every unknown held to the case's own value so weakly that the sum of
// squares can rise by kSame at most: what the data leave open stays as it was.
LeastSquaresFit moved_least(const DataModel& model, const LeastSquaresFit& fit) {
  const std::vector<double> start = model.start();
  const std::size_t n = model.size();
  const LeastSquaresProblem whole = model.problem();
  LeastSquaresProblem problem = whole;
  problem.residuals += n;
  problem.evaluate = [&](std::span<const double> x, std::span<double> residuals) {
    if (!whole.evaluate(x, residuals.first(whole.residuals))) return false;
    for (std::size_t i = 0; i < n; ++i)
      residuals[whole.residuals + i] = std::sqrt(kSame / static_cast<double>(n)) *
                                       (x[i] - start[i]) / (whole.high[i] - whole.low[i]);
    return true;
  };
  LeastSquaresFit moved =
      least_squares(problem, fit.x, {.most_iterations = 60, .enough = 1e-3 * kSame});
  moved.residuals.resize(whole.residuals);
  moved.jacobian.resize(whole.residuals * n);
  moved.sum_of_squares = sum_of_squares(moved.residuals);
  return moved;
}

std::vector<Minimum> minima_of(const std::vector<LeastSquaresFit>& fits) {
  constexpr double kApart = 0.01;
  std::vector<Minimum> minima;
  for (const LeastSquaresFit& fit : fits) {
    if (minima.empty() || fit.sum_of_squares > minima.back().sum_of_squares + kApart)
      minima.push_back({fit.x, fit.sum_of_squares, 0});
    ++minima.back().starts;
  }
  return minima;
}

}  // namespace

Identification identify(const DataModel& model, const IdentifyOptions& options,
                        const study::PartProgress& progress_of) {
  Identification result;
  std::vector<std::vector<double>> starts = {model.start()};
  std::vector<double> numbers(model.numbers());
  const auto further = latin_hypercube(
      model.size(), static_cast<std::size_t>(std::max(options.starts - 1, 1)), options.seed);
  for (int s = 0; s + 1 < options.starts; ++s) {
    std::vector<double> x(model.size());
    further->point(static_cast<std::size_t>(s), x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Unknown& u = model.data().unknowns[i];
      x[i] = u.low + x[i] * (u.high - u.low);
    }
    starts.push_back(std::move(x));
  }
  const std::vector<LeastSquaresFit> fits =
      least_squares(model.problem(), starts, {.most_iterations = 60, .enough = 1e-3},
                    options.threads, progress_of("fit"));
  if (fits.empty())
    throw ComputationError("identify: no start between the bounds is a feasible pump");
  result.fit = moved_least(model, fits[nearest_of_best(model, fits)]);
  result.minima = minima_of(fits);
  result.numbers = numbers;
  model.predict(result.fit.x, result.numbers);
  result.goodness = goodness_of(model, result.fit);
  result.worst = worst_residuals(model, result.fit);
  const bool refuted = result.goodness.refuted();
  std::vector<double> jacobian = result.fit.jacobian;
  if (refuted)
    for (double& slope : jacobian) slope /= result.goodness.birge_ratio();
  result.held = held_unknowns(model, result.fit);
  std::vector<std::size_t> at_bound;
  for (const HeldUnknown& held : result.held) at_bound.push_back(held.unknown);
  result.information = information_of(model, result.fit.x, jacobian, at_bound);
  if (refuted)
    result.further =
        further_unknowns(model, result.fit, options.threads, progress_of("further unknowns"));
  if (options.leave_one_out)
    result.left_out =
        leave_one_out(model, result.fit, options.threads, progress_of("leave one out"));
  // What follows says how well things are known if the model is right.
  if (options.profiles && !refuted)
    result.profiles = profiles_of(model, result.fit, options.threads, progress_of("profiles"));
  if (options.posterior && !refuted) {
    result.posterior = posterior_of(model, result.fit, options, progress_of("posterior"));
    bands_of(model, options, result, progress_of("bands"));
  }
  return result;
}

}  // namespace bentaxis::designs
