#include "instance.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::fmu {
namespace {

// Times of an importer that differ by less than this share are one: sums of steps are rounded.
constexpr double kSameTime = 1e-9;

bool same_time(double a, double b) {
  return std::abs(a - b) <= kSameTime * std::max({1.0, std::abs(a), std::abs(b)});
}

const char* word_of(unsigned mode) {
  switch (mode) {
    case kInstantiated:
      return "before initialization";
    case kInitialization:
      return "in initialization mode";
    case kEvent:
      return "in event mode";
    case kContinuous:
      return "in continuous-time mode";
    case kStep:
      return "between steps";
    case kTerminated:
      return "after termination";
    case kIntermediate:
      return "in an intermediate update";
    default:
      break;
  }
  return "after an error: restore a state, reset or free the instance";
}

// What a solver tries may be too far away: it comes back with other states.
struct NotComputable : ComputationError {
  using ComputationError::ComputationError;
};

void require_finite(double value, const char* what) {
  if (!std::isfinite(value)) throw Refused(std::string(what) + " is not a finite number");
}

}  // namespace

Instance::Instance(const std::filesystem::path& resources, const std::string& token, Kind kind,
                   Log log, Stepping stepping)
    : kind_(kind),
      log_(std::move(log)),
      stepping_(std::move(stepping)),
      resources_(read_resources(resources)) {
  if (token != resources_.token)
    throw Refused("the token " + shown(token, 100) +
                  " is that of another FMU than its resources: " + resources_.token);
  variables_ = variables_of(resources_.the_case, resources_.choice);
  for (const Variable& it : variables_)
    first_parameters_.push_back(it.role == Role::parameter ? it.start.value() : 0);
  for (const Reference reference : stepping_.intermediate)
    if (!has_intermediate_values(variable(reference)))
      throw Refused(variable(reference).name +
                    " has no intermediate values: those are of continuous inputs and of outputs");
  first_inputs_ = Plant(resources_.the_case, resources_.choice, kind).first_inputs();
  reset();
}

void Instance::require(Kind kind) const {
  if (kind != kind_)
    throw Refused(kind == Kind::co_simulation ? "this instance is of model exchange"
                                              : "this instance is of co-simulation");
}

void Instance::require_mode(unsigned modes) const {
  if ((modes & run_.mode) == 0)
    throw Refused(std::string("must not be called ") + word_of(run_.mode));
}

Status Instance::failed(const char* function) noexcept {
  Status status = Status::error;
  try {
    const auto say = [&](const char* what) {
      log_.say(status, std::string(function) + ": " + what);
    };
    try {
      throw;
    } catch (const Refused& error) {
      say(error.what());
    } catch (const InputError& error) {
      say(error.what());
    } catch (const NotComputable& error) {
      status = Status::discard;
      say(error.what());
    } catch (const ComputationError& error) {
      run_.mode = kFailed;
      say(error.what());
    } catch (const std::bad_alloc&) {
      run_.mode = kFailed;
      say("no memory is left");
    } catch (const std::exception& error) {
      run_.mode = kFailed;
      say(error.what());
    } catch (...) {
      run_.mode = kFailed;
      say("failed");
    }
  } catch (...) {  // no memory for words
    run_.mode = kFailed;
  }
  return status;
}

void Instance::set_up(std::optional<double> tolerance, double start_time,
                      std::optional<double> stop_time) {
  require_finite(start_time, "the start time");
  if (stop_time) {
    require_finite(*stop_time, "the stop time");
    if (!(*stop_time > start_time))
      throw Refused("the stop time " + number_text(*stop_time) +
                    " s must be after the start time " + number_text(start_time) + " s");
  }
  if (tolerance && !(*tolerance > 0 && std::isfinite(*tolerance)))
    throw Refused("the tolerance must be a number > 0");
  // Never looser than what the unit was made with: importers pass on defaults of their own solvers.
  constexpr double kTightest = 1e-12;
  run_.tolerance = resources_.choice.tolerance;
  if (tolerance) run_.tolerance = std::min(run_.tolerance, std::max(*tolerance, kTightest));
  run_.start_time = run_.now = start_time;
  run_.stops = stop_time.has_value();
  run_.stop_time = stop_time.value_or(0);
  run_.set_up = true;
}

void Instance::enter_initialization() {
  if (!run_.set_up) set_up({}, 0, {});
  run_.mode = kInitialization;
}

void Instance::exit_initialization() {
  try {
    settle();
  } catch (const InputError&) {
    run_.mode = kFailed;
    throw;
  }
  run_.mode = kind_ == Kind::co_simulation && !stepping_.event_mode ? kStep : kEvent;
}

void Instance::terminate() {
  settle();
  run_.mode = kTerminated;
}

void Instance::reset() {
  run_ = {};
  run_.tolerance = resources_.choice.tolerance;
  parameters_ = wanted_ = first_parameters_;
  inputs_ = first_inputs_;
  inputs_changed_ = false;
  plant_.reset();
  open_.reset();
  at_event_ = stopped_early_ = false;
}

Case Instance::case_as_set(const std::vector<double>& parameters) const {
  return case_with(resources_.the_case, variables_, parameters);
}

UnitChoice Instance::present_choice() const {
  UnitChoice choice = resources_.choice;
  choice.tolerance = run_.tolerance;
  return choice;
}

void Instance::start() {
  const Case the_case = case_as_set(wanted_);
  auto plant = std::make_unique<Plant>(the_case, present_choice(), kind_);
  plant->start(inputs_, run_.stops ? run_.stop_time - run_.start_time : 0);
  plant_ = std::move(plant);
  parameters_ = wanted_;
  run_.started = true;
}

void Instance::settle() {
  if ((run_.mode & (kInitialization | kRunning | kIntermediate)) == 0) return;
  const bool changed = wanted_ != parameters_;
  if (run_.mode == kInitialization) {
    if (!run_.started || changed || inputs_changed_) start();
    inputs_changed_ = false;
    open_.reset();
    return;
  }
  if (changed) {
    try {
      plant_->change(case_as_set(wanted_));  // what is refused leaves it as it was
      parameters_ = wanted_;
    } catch (...) {
      wanted_ = parameters_;
      throw;
    }
    log_.event("parameters have changed at " + number_text(run_.now) + " s");
    open_.reset();
  }
  if (inputs_changed_) {
    plant_->set_inputs(inputs_);
    inputs_changed_ = false;
    open_.reset();
  }
}

Status Instance::step(double time, double size) {
  require_finite(time, "the time of the step");
  require_finite(size, "the size of the step");
  if (!(size > 0)) throw Refused("the size of the step " + number_text(size) + " s must be > 0");
  if (!same_time(time, run_.now))
    throw Refused("the step begins at " + number_text(time) + " s, the pump is at " +
                  number_text(run_.now) + " s");
  const double end = time + size;
  if (run_.stops && end > run_.stop_time && !same_time(end, run_.stop_time))
    throw Refused("the step ends at " + number_text(end) + " s, after the stop time " +
                  number_text(run_.stop_time) + " s");
  settle();
  require_inputs_until(end);
  open_.reset();
  at_event_ = stopped_early_ = false;
  // A step below the resolution of time is none.
  if (!(end - run_.start_time > plant_->time())) {
    run_.now = end;
    return Status::ok;
  }
  try {
    if (stepping_.update || (stepping_.event_mode && stepping_.early_return))
      step_by_step(run_.now, end);
    else
      step_whole(end);
    stopped_early_ = run_.now < end;
  } catch (const ComputationError& error) {
    return log_.say(Status::discard, error.what());
  }
  return Status::ok;
}

void Instance::step_whole(double end) {
  plant_->step(end - run_.start_time);
  inputs_ = plant_->inputs();
  note_events();
  run_.now = end;
}

// Ends at the first event where the importer allows it, and calls its intermediate update after
// each step of the integrator.
void Instance::step_by_step(double start, double end) {
  // What is set starts the integrator anew: each update may not.
  constexpr double kLeastShareBetweenSettings = 0.05;
  const PlantState before = plant_->state();
  double stop = end - run_.start_time, set_at = plant_->time();
  try {
    while (plant_->time() < stop && !(at_event_ && stepping_.early_return)) {
      plant_->step_towards(stop);
      inputs_ = plant_->inputs();
      note_events();
      run_.now = plant_->time() == end - run_.start_time ? end : run_.start_time + plant_->time();
      if (!stepping_.update) continue;
      const bool may_set = plant_->time() - set_at >= kLeastShareBetweenSettings * (end - start);
      if (may_set) set_at = plant_->time();
      stop = intermediate_update(stop, may_set && plant_->time() < stop);
    }
  } catch (const ComputationError&) {
    plant_->set_state(before);
    inputs_ = plant_->inputs();
    inputs_changed_ = at_event_ = false;
    run_.now = start;
    throw;
  }
}

double Instance::intermediate_update(double end, bool may_set) {
  run_.mode = kIntermediate;
  may_set_ = may_set;
  const std::optional<double> early = stepping_.update(run_.now, may_set);
  if (run_.mode != kIntermediate)
    throw std::runtime_error("a call within the intermediate update has failed");
  run_.mode = kStep;
  settle();
  open_.reset();
  if (!early) return end;
  if (!stepping_.early_return) {
    log_.say(Status::warning,
             "the step goes on: it cannot return early where earlyReturnAllowed was false");
    return end;
  }
  return std::isfinite(*early) ? std::clamp(*early - run_.start_time, plant_->time(), end) : end;
}

void Instance::note_events() {
  at_event_ = false;
  for (const Plant::Passed& event : plant_->passed()) {
    if (log_.tells_events())
      log_.event("event at " + number_text(run_.start_time + event.time) + " s: " + event.what);
    at_event_ = stepping_.event_mode && event.time == plant_->time();
  }
}

void Instance::enter_step_mode() {
  settle();
  run_.mode = kStep;
}

void Instance::enter_event_mode() {
  if (kind_ == Kind::co_simulation && !stepping_.event_mode)
    throw Refused("this instance has no event mode: eventModeUsed was false");
  settle();
  run_.mode = kEvent;
  if (log_.tells_events()) log_.event("event at " + number_text(run_.now) + " s");
}

Instance::Event Instance::update_discrete_states() {
  settle();
  const Plant::Event event = open_plant().pass_event();
  Event told{event.states_changed, {}};
  if (event.next_time) told.next_time = run_.start_time + *event.next_time;
  return told;
}

void Instance::enter_continuous_mode() {
  settle();
  run_.mode = kContinuous;
}

bool Instance::step_completed() {
  settle();
  return plant_->wants_event();
}

void Instance::set_time(double time) {
  require_finite(time, "the time");
  if (time < run_.start_time && !same_time(time, run_.start_time))
    throw Refused("the time " + number_text(time) + " s is before the start time " +
                  number_text(run_.start_time) + " s");
  settle();
  plant_->set_time(time - run_.start_time);
  run_.now = time;
}

namespace {

void require_count(std::size_t count, std::size_t wanted, const char* what) {
  if (count != wanted)
    throw Refused("there are " + std::to_string(wanted) + " " + what + ", not " +
                  std::to_string(count));
}

}  // namespace

void Instance::set_states(const double* values, std::size_t count) {
  require_count(count, state_count(), "continuous states");
  for (std::size_t i = 0; i < count; ++i) require_finite(values[i], "a continuous state");
  settle();
  scratch_.assign(values, values + count);
  plant_->set_states(scratch_);
}

void Instance::states(double* values, std::size_t count) {
  require_count(count, state_count(), "continuous states");
  settle();
  const std::vector<double> states = open_plant().states();
  std::copy(states.begin(), states.end(), values);
}

void Instance::rates(double* values, std::size_t count) {
  require_count(count, state_count(), "derivatives");
  settle();
  find_rates();
  std::copy(scratch_.begin(), scratch_.end(), values);
}

void Instance::find_rates() {
  Plant& plant = open_plant();
  try {
    plant.rates(scratch_);
  } catch (const ComputationError& error) {
    if (run_.mode != kContinuous) throw;
    throw NotComputable(error.what());
  }
}

void Instance::indicators(double* values, std::size_t count) {
  require_count(count, indicator_count(), "event indicators");
  settle();
  scratch_.resize(count);
  open_plant().indicators(scratch_);
  std::copy(scratch_.begin(), scratch_.end(), values);
}

void Instance::nominals(double* values, std::size_t count) const {
  require_count(count, state_count(), "continuous states");
  for (const Variable& it : variables_)
    if (it.role == Role::state) values[it.place] = it.nominal.value_or(1);
}

}  // namespace bentaxis::fmu
