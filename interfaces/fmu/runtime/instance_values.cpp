// Values of an instance by reference, and how they depend on each other.
#include <algorithm>
#include <cmath>

#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/units.h"
#include "instance.h"

namespace bentaxis::fmu {

const Variable& Instance::variable(Reference reference) const {
  if (reference >= variables_.size())
    throw Refused("there is no variable with the reference " + std::to_string(reference));
  return variables_[reference];
}

std::size_t Instance::count_of(Role role) const {
  return static_cast<std::size_t>(std::count_if(
      variables_.begin(), variables_.end(), [&](const Variable& it) { return it.role == role; }));
}

// States, rates and indicators at the present time. Of co-simulation the plant has none by itself.
Plant& Instance::open_plant() {
  if (!plant_) throw Refused("the pump has not been started");
  if (kind_ == Kind::model_exchange) return *plant_;
  if (!open_) {
    auto open =
        std::make_unique<Plant>(case_as_set(parameters_), resources_.choice, Kind::model_exchange);
    open->set_state(plant_->state());
    open_ = std::move(open);
  }
  return *open_;
}

double Instance::number(Reference reference) {
  const Variable& it = variable(reference);
  if (it.boolean) throw Refused(it.name + " is a Boolean");
  if (it.role == Role::time) return run_.now;
  if (run_.mode == kIntermediate) require_intermediate(it, false);
  if (it.role == Role::parameter) return wanted_[reference];
  if (it.role == Role::input) return input_of(inputs_, it.input);
  if (run_.mode == kInstantiated) throw Refused(it.name + " is not known before initialization");
  settle();
  if (!plant_) throw Refused(it.name + " is not known: the pump has not been started");
  if (it.role == Role::output) return plant_->outputs().at(it.place);
  if (it.role == Role::state) return open_plant().states().at(it.place);
  if (it.role == Role::derivative)
    find_rates();
  else {
    scratch_.resize(indicator_count());
    open_plant().indicators(scratch_);
  }
  return scratch_.at(it.place);
}

void Instance::numbers(const Reference* references, std::size_t count, double* values) {
  for (std::size_t i = 0; i < count; ++i) values[i] = number(references[i]);
}

bool Instance::flag(Reference reference) {
  const Variable& it = variable(reference);
  if (!it.boolean) throw Refused(it.name + " is a real number");
  if (it.role == Role::input) return inputs_.load_share_replaces_curve;
  if (run_.mode == kInstantiated) throw Refused(it.name + " is not known before initialization");
  settle();
  if (!plant_) throw Refused(it.name + " is not known: the pump has not been started");
  return plant_->flags().at(it.place);
}

void Instance::require_intermediate(const Variable& it, bool set) const {
  if (!contains(stepping_.intermediate, it.reference))
    throw Refused(it.name + " is not one of the intermediate variables of this instance");
  if (set && !may_set_)
    throw Refused(it.name + " cannot be set now: intermediateVariableSetRequested is false");
}

void Instance::require_settable(const Variable& it, double value) const {
  if (it.role != Role::parameter && it.role != Role::input)
    throw Refused(it.name + " is calculated: it cannot be set");
  const bool early = (run_.mode & (kInstantiated | kInitialization)) != 0;
  if (it.role == Role::parameter && !early) {
    if (it.variability != Variability::tunable)
      throw Refused(it.name + " is fixed: it can be set before the end of initialization");
    if (run_.mode == kContinuous)
      throw Refused(it.name + " can be set in event mode, not in continuous-time mode");
  }
  if (!std::isfinite(value)) throw Refused(it.name + " must be a finite number");
  const auto say = [&](const std::string& allowed) {
    throw Refused(it.name + " = " + number_text(value) + ": must be " + allowed);
  };
  if (it.role == Role::input) {
    const std::optional<double> least = least_of(it);
    const bool pressure = it.input == Input::suction || it.input == Input::delivery;
    if (least && value < *least)
      say(">= " + number_text(*least) +
          (pressure ? " Pa (gauge): an absolute pressure cannot be negative" : ""));
    return;
  }
  const Parameter& parameter = parameter_of(standard_registry(), it.table, it.key);
  // One that depends on other parameters is looked at with them.
  if (parameter.range_here != nullptr || value == first_parameters_[it.reference]) return;
  if (!parameter.range.contains(value)) say(parameter.range.text());
}

std::optional<double> Instance::least_of(const Variable& input) const {
  if (input.input != Input::suction && input.input != Input::delivery) return input.least;
  // That of the atmosphere, which is a parameter of hydraulic cases.
  for (const Variable& it : variables_)
    if (it.role == Role::parameter && it.name == "hydraulics.atmosphere_bar")
      return least_pressure(resources_.the_case) +
             (it.start.value() - wanted_[it.reference]) * kPascalPerBar;
  return least_pressure(resources_.the_case);
}

void Instance::require_settable_flag(Reference reference) const {
  const Variable& it = variable(reference);
  if (!it.boolean) throw Refused(it.name + " is a real number");
  if (it.role != Role::input) throw Refused(it.name + " is calculated: it cannot be set");
}

void Instance::set_flag(Reference /*reference*/, bool value) {
  if (inputs_.load_share_replaces_curve == value) return;
  inputs_.load_share_replaces_curve = value;
  inputs_changed_ = true;
}

void Instance::set_rates(const Reference* references, std::size_t count, const int* orders,
                         const double* values) {
  for (std::size_t i = 0; i < count; ++i) {
    const Variable& it = variable(references[i]);
    if (it.boolean || it.role != Role::input) throw Refused(it.name + " is not a continuous input");
    if (orders[i] != 1)
      throw Refused(it.name + ": order " + std::to_string(orders[i]) +
                    " of a derivative: inputs are interpolated linearly, order 1");
    if (!std::isfinite(values[i])) throw Refused("der(" + it.name + ") must be a finite number");
    if (it.input == Input::acceleration && values[i] != 0)
      throw Refused(
          "der(drive_acceleration): the acceleration is held between communication points");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Input which = variables_[references[i]].input;
    if (which == Input::acceleration) continue;
    if (which == Input::speed) {
      inputs_.acceleration = values[i];
      inputs_.acceleration_given = true;
    } else {
      *rate_of(inputs_, which) = values[i];
    }
    inputs_changed_ = true;
  }
}

// What changes linearly must not leave its range within a step.
void Instance::require_inputs_until(double end) const {
  Inputs then = inputs_;
  advance(then, end - run_.now);
  for (const Variable& it : variables_) {
    if (it.role != Role::input || it.boolean || rate_of(then, it.input) == nullptr) continue;
    const std::optional<double> least = least_of(it);
    const double value = input_of(then, it.input);
    if (least && value < *least)
      throw Refused(it.name + " would be " + number_text(value) +
                    " at the end of the step: must be >= " + number_text(*least));
  }
}

void Instance::set_numbers(const Reference* references, std::size_t count, const double* values) {
  for (std::size_t i = 0; i < count; ++i) {
    const Variable& it = variable(references[i]);
    if (it.boolean) throw Refused(it.name + " is a Boolean");
    if (run_.mode == kIntermediate) require_intermediate(it, true);
    require_settable(it, values[i]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Variable& it = variables_[references[i]];
    if (it.role == Role::parameter) {
      wanted_[it.reference] = values[i];
      continue;
    }
    double& place = input_of(inputs_, it.input);
    const bool first = it.input == Input::acceleration && !inputs_.acceleration_given;
    if (place == values[i] && !first) continue;
    place = values[i];
    if (first) inputs_.acceleration_given = true;
    inputs_changed_ = true;
  }
}

void Instance::refuse_values(const Reference* references, std::size_t count,
                             const char* type) const {
  if (count == 0) return;
  throw Refused(variable(references[0]).name + " is no " + type + " that can be got or set so");
}

void Instance::derivative(const Reference* unknowns, std::size_t unknown_count,
                          const Reference* knowns, std::size_t known_count, const double* seed,
                          double* sensitivity) {
  bool open = kind_ == Kind::model_exchange;
  std::vector<const Variable*> of, by;
  for (std::size_t i = 0; i < unknown_count; ++i) {
    const Variable& it = variable(unknowns[i]);
    if (it.role != Role::output && it.role != Role::derivative && it.role != Role::state)
      throw Refused(it.name +
                    " is not an unknown: derivatives are of outputs and of state derivatives");
    open = open || it.role != Role::output;
    of.push_back(&it);
  }
  for (std::size_t i = 0; i < known_count; ++i) {
    const Variable& it = variable(knowns[i]);
    if (it.boolean || (it.role != Role::input && it.role != Role::state))
      throw Refused(it.name + " is not a known: derivatives are with respect to inputs and states");
    if (!std::isfinite(seed[i])) throw Refused("the seed of " + it.name + " is not finite");
    open = open || it.role != Role::input;
    by.push_back(&it);
  }
  settle();
  if (!plant_) throw Refused("the pump has not been started");
  Plant& plant = open ? open_plant() : *plant_;
  const std::vector<double> slopes =
      plant.directional_derivative(of, by, std::vector<double>(seed, seed + known_count));
  std::copy(slopes.begin(), slopes.end(), sensitivity);
}

}  // namespace bentaxis::fmu
