#include "sampler.h"

#include <algorithm>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "runtime/machine.h"

namespace bentaxis::fmu {
namespace {

constexpr int kPoints = 64;  // of every set of parameters
constexpr int kPointsOfParameter = 24;
constexpr int kTries = 8;  // for parameters that are refused together
// Factors that differ by less are one: differences of linear relations are exact but for round-off.
constexpr double kOneFactor = 1e-7;
constexpr double kPascalOfLoad = 200e5;       // of a load whose size is sought
constexpr double kAreaOfLoad = 1e-5;          // m2
constexpr double kConductanceOfLoad = 5e-11;  // m3/(s Pa)

// A size at which oil flows through the load, of those whose size is found at the start.
double load_size_of(const Case& the_case) {
  if (!the_case.hydraulics) return 0;
  const LoadData load = the_case.hydraulics->load.value_or(LoadData());
  if (load.kind == LoadKind::relief_valve) return the_case.hydraulics->atmosphere + kPascalOfLoad;
  return load.kind == LoadKind::laminar ? kConductanceOfLoad : kAreaOfLoad;
}

bool same_kind(const Variable& a, const Variable& b) {
  return a.role == Role::output && b.role == Role::output && a.unit == b.unit;
}

bool begins_at_zero(const Variable& state) {
  return state.name == "state.shaft_angle" || state.name == "state.lag" ||
         state.name == "state.lag_rate";
}

}  // namespace

void Change::note(double scale, double change, double by) {
  if (!std::isfinite(change) || scale == 0) return;
  largest = std::max(largest, std::abs(change) / scale);
  const double factor_here = change / by;
  if (!factor) factor = factor_here;
  const double larger = std::max(std::abs(factor_here), std::abs(*factor));
  const double rounding = kRoundOff * scale / std::abs(by);
  if (std::abs(factor_here - *factor) > kOneFactor * larger + rounding) one_factor = false;
}

Sampler::Sampler(const Case& the_case, const UnitChoice& choice,
                 const std::vector<Variable>& variables)
    : case_(with_drive(the_case, choice.drive)), choice_(choice), variables_(variables) {
  for (const Variable& it : variables) {
    if (it.role == Role::output || it.role == Role::derivative || it.role == Role::indicator)
      unknowns_.push_back(&it);
    if (it.role == Role::time || it.role == Role::input || it.role == Role::state)
      knowns_.push_back(&it);
    if (it.role == Role::parameter) parameters_.push_back(&it);
    values_.push_back(it.role == Role::parameter ? it.start.value() : 0);
  }
  const Machine machine(case_, {});
  base_.motion.assign(kMotionStates, 0.0);
  const MotionVector motion = machine.mechanics->start();
  std::copy(motion.begin(), motion.end(), base_.motion.begin());
  base_.oil = machine.oil->start();
  base_.load_size = load_size_of(case_);
  breakpoints_ = machine.mechanics->breakpoints();
  for (const double breakpoint : machine.oil->breakpoints()) breakpoints_.push_back(breakpoint);
  std::sort(breakpoints_.begin(), breakpoints_.end());
}

std::unique_ptr<Plant> Sampler::plant_of(const std::vector<double>& parameters) const {
  return plant_from(base_, parameters);
}

std::unique_ptr<Plant> Sampler::plant_of_other_load() const {
  PlantState other = base_;
  other.load_size *= 1.1;
  return plant_from(other, values_);
}

std::unique_ptr<Plant> Sampler::plant_from(const PlantState& start,
                                           const std::vector<double>& parameters) const {
  try {
    auto plant = std::make_unique<Plant>(case_with(case_, variables_, parameters), choice_,
                                         Plant::Kind::model_exchange);
    PlantState state = start;
    state.inputs = plant->first_inputs();
    plant->set_state(state);
    return plant;
  } catch (const InputError&) {
  } catch (const ComputationError&) {
  }
  return nullptr;
}

bool Sampler::allowed(const std::vector<double>& parameters) const {
  try {
    case_with(case_, variables_, parameters);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<double> Sampler::other_parameters() {
  std::vector<double> values = values_;
  for (const Variable* it : parameters_) {
    double& value = values[it->reference];
    const double kept = value;
    for (int i = 0; i < kTries && value == kept; ++i) {
      value = kept == 0 ? random_.between(0.2, 1) * std::pow(0.1, i / 2)
                        : kept * random_.between(0.98, 1.02);
      if (!allowed(values)) value = kept;
    }
  }
  return values;
}

std::optional<std::vector<double>> Sampler::with_other(std::vector<double> values,
                                                       const Variable& parameter) const {
  double& value = values[parameter.reference];
  const double kept = value;
  for (const double factor : {0.99, 1.01, 0.999, 1.001}) {
    value = kept == 0 ? 1 - factor : kept * factor;
    if (allowed(values)) return values;
  }
  return std::nullopt;
}

std::optional<Changes> Sampler::changes_by_knowns(const std::vector<std::vector<double>>& sets,
                                                  Where where) {
  Changes changes(unknowns_.size(), std::vector<Change>(knowns_.size()));
  int points = 0;
  for (const std::vector<double>& parameters : sets) {
    const auto plant = plant_of(parameters);
    for (int p = 0; plant && p < kPoints; ++p) {
      const Point here = any_point(*plant, where);
      Values before, after;
      if (!values_at(*plant, here, true, before)) continue;
      ++points;
      const std::vector<double> scales = scales_at(before);
      for (std::size_t k = 0; k < knowns_.size(); ++k) {
        Point there = here;
        const double by = move(there, *knowns_[k]);
        if (!values_at(*plant, there, false, after)) continue;
        for (std::size_t u = 0; u < unknowns_.size(); ++u)
          changes[u][k].note(std::max(scales[u], std::abs(after[u])), after[u] - before[u], by);
      }
    }
  }
  if (points < kPoints) return std::nullopt;
  return changes;
}

std::vector<Sampler::Seen> Sampler::look_around(Plant& plant, Where where) {
  std::vector<Seen> seen;
  for (int p = 0; p < kPointsOfParameter; ++p) {
    Point point = any_point(plant, where);
    Values values;
    if (!values_at(plant, point, true, values)) continue;
    Values scales = scales_at(values);
    seen.push_back({std::move(point), std::move(values), std::move(scales)});
  }
  return seen;
}

double Sampler::any_speed(double omega) {
  return random_.sign() * omega * random_.power_of_ten(-3, 0.2);
}

Sampler::Point Sampler::any_point(const Plant& plant, Where where) {
  Point point;
  const double omega = std::max(std::abs(rad_per_second(case_.operation.speed_rpm)), 50.0);
  const double end =
      std::max(case_.drive->duration, breakpoints_.empty() ? 0.0 : breakpoints_.back());
  point.time = random_.between(0, end);
  if (!breakpoints_.empty() &&
      !random_.once_in(4)) {  // within one of the intervals between breakpoints
    const auto which =
        static_cast<std::size_t>(random_.between(0, static_cast<double>(breakpoints_.size())));
    point.time = random_.between(which == 0 ? 0 : breakpoints_[which - 1], breakpoints_[which]);
  }
  point.inputs = plant.inputs();
  point.inputs.speed = any_speed(omega);
  point.inputs.acceleration = random_.sign() * omega * omega * random_.between(0, 1);
  point.inputs.torque = random_.between(-500, 500);
  point.inputs.suction = random_.between(-0.6e5, 10e5);
  point.inputs.delivery = random_.between(0, 400e5);
  point.inputs.load_share = random_.once_in(2) ? 1 : random_.between(0.2, 1.8);
  point.inputs.load_share_replaces_curve = random_.once_in(3);
  for (const Variable* it : knowns_)
    if (it->role == Role::state)
      point.states.push_back(
          where == Where::at_start && begins_at_zero(*it) ? 0 : any_state(*it, omega));
  if (where == Where::at_start) point.time = 0;
  return point;
}

double Sampler::any_state(const Variable& state, double omega) {
  const std::string& name = state.name;
  const auto is = [&](const char* part) { return name.find(part) != std::string::npos; };
  constexpr double kTurn = 2 * kPi, kAtmosphere = 101325;
  if (is("shaft_angle")) return random_.between(-kTurn, kTurn);
  if (is("shaft_speed")) return any_speed(omega);
  if (is("lag_rate") || is("twist_rate")) return random_.between(-0.3, 0.3) * omega;
  if (is("lag")) return random_.sign() * random_.power_of_ten(-6, -2);
  if (is("twist")) return random_.between(-0.1, 0.1);
  if (is("ln_p_"))  // from torn oil to above any valve
    return random_.once_in(2) ? random_.between(-3, 6.5)
                              : std::log(random_.between(1e5, 700e5) / kAtmosphere);
  if (is("air_out_")) return random_.between(0, 1);
  return random_.between(-1, 1);  // flows of lines over the ideal one, modes of lines
}

// @return whether the pump has values there
bool Sampler::values_at(Plant& plant, const Point& point, bool new_edges, Values& values) {
  try {
    plant.set_time(point.time);
    plant.set_states(point.states);
    plant.set_inputs(point.inputs);
    if (new_edges) plant.pass_event();
    plant.rates(rates_);
    plant.indicators(indicators_);
    const std::vector<double>& outputs = plant.outputs();
    values.clear();
    for (const Variable* it : unknowns_)
      values.push_back(it->role == Role::derivative  ? rates_.at(it->place)
                       : it->role == Role::indicator ? indicators_.at(it->place)
                                                     : outputs.at(it->place));
  } catch (const ComputationError&) {
    return false;
  }
  return true;
}

// @return what was added; the point is then another one
double Sampler::move(Point& point, const Variable& known) {
  if (known.role == Role::time) {
    const double by = random_.sign() * random_.between(1e-4, 3e-3);
    point.time += by;
    return by;
  }
  if (known.role == Role::state) {
    double& value = point.states.at(known.place);
    const double by = random_.sign() * known.nominal.value_or(1) * random_.between(0.02, 0.3);
    value += by;
    return by;
  }
  if (known.input == Input::load_share_replaces_curve) {
    bool& value = point.inputs.load_share_replaces_curve;
    value = !value;
    return 1;
  }
  double& value = input_of(point.inputs, known.input);
  const double kept = value;
  value = kept * random_.between(0.8, 0.95) + (kept == 0 ? 1 : 0);
  return value - kept;
}

// The magnitude of what is of the same kind, at one point.
double Sampler::scale_of(std::size_t unknown, const Values& values) const {
  constexpr double kAngles = 10;  // rad, that those of edges are differences of
  const Variable& it = *unknowns_[unknown];
  double scale = it.role == Role::indicator && it.unit == "rad" ? kAngles : 0;
  for (std::size_t i = 0; i < unknowns_.size(); ++i)
    if ((i == unknown || same_kind(*unknowns_[i], it)) && std::isfinite(values[i]))
      scale = std::max(scale, std::abs(values[i]));
  return scale;
}

std::vector<double> Sampler::scales_at(const Values& values) const {
  std::vector<double> scales;
  for (std::size_t u = 0; u < unknowns_.size(); ++u) scales.push_back(scale_of(u, values));
  return scales;
}

}  // namespace bentaxis::fmu
