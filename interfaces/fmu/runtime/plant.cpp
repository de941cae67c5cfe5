#include "plant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bentaxis/coupled/open_system.h"
#include "bentaxis/coupled/stepper.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"
#include "columns.h"
#include "machine.h"

namespace bentaxis::fmu {
namespace {

// Of a difference quotient, in nominal values: error and round-off are alike there.
constexpr double kDifference = 5e-6;
constexpr double kPressure = 1e7;  // Pa, what pressures given from outside are measured by
constexpr double kMinSpeed = 1, kMinTorque = 1;  // rad/s, Nm

double nominal_of(Input input, const Case& the_case) {
  const double omega = std::max(std::abs(rad_per_second(the_case.operation.speed_rpm)), kMinSpeed);
  switch (input) {
    case Input::speed:
      return omega;
    case Input::acceleration:
      return omega * omega;
    case Input::torque:
      return std::max(std::abs(the_case.drive ? the_case.drive->torque : 0.0), kMinTorque);
    case Input::suction:
    case Input::delivery:
      return kPressure;
    case Input::load_share:
    case Input::load_share_replaces_curve:
      break;
  }
  return 1;
}

}  // namespace

double& input_of(Inputs& inputs, Input which) {
  switch (which) {
    case Input::speed:
      return inputs.speed;
    case Input::acceleration:
      return inputs.acceleration;
    case Input::torque:
      return inputs.torque;
    case Input::suction:
      return inputs.suction;
    case Input::delivery:
      return inputs.delivery;
    case Input::load_share:
    case Input::load_share_replaces_curve:
      break;
  }
  return inputs.load_share;
}

double* rate_of(Inputs& inputs, Input which) {
  switch (which) {
    case Input::torque:
      return &inputs.torque_rate;
    case Input::suction:
      return &inputs.suction_rate;
    case Input::delivery:
      return &inputs.delivery_rate;
    case Input::load_share:
      return &inputs.load_share_rate;
    case Input::speed:
    case Input::acceleration:
    case Input::load_share_replaces_curve:
      break;
  }
  return nullptr;
}

void advance(Inputs& inputs, double seconds) {
  for (const Input which : {Input::torque, Input::suction, Input::delivery, Input::load_share})
    if (const double rate = *rate_of(inputs, which); rate != 0)
      input_of(inputs, which) += rate * seconds;
}

class Plant::Implementation {
 public:
  Implementation(const Case& the_case, const UnitChoice& choice, Kind kind)
      : choice_(choice), kind_(kind), case_(with_drive(the_case, choice.drive)) {
    build(case_, {});
    first_ = inputs_of_case();
    // A case whose speed changes over time begins with that of its curve.
    if (choice.drive == Drive::speed && the_case.drive &&
        the_case.drive->kind == DriveKind::speed && !the_case.drive->curve.time.empty())
      first_.speed = TimeSignal(the_case.drive->curve).value(0);
    inputs_ = first_;
    state_ = {machine_->mechanics->start(), machine_->oil->start()};
  }

  const Inputs& first_inputs() const { return first_; }
  const Inputs& inputs() const { return inputs_; }

  TakesFromOutside takes() const {
    TakesFromOutside takes = machine_->oil->takes();
    takes.shaft = choice_.drive == Drive::speed;
    takes.torque = choice_.drive == Drive::torque;
    return takes;
  }

  void start(const Inputs& inputs, double end) {
    Case c = case_;
    // Whatever the case says of them, the start is that of the inputs.
    const bool from_rest = choice_.drive == Drive::speed && inputs.speed == 0;
    const bool as_in_case = inputs.speed == rad_per_second(c.operation.speed_rpm);
    if (choice_.drive == Drive::speed && !as_in_case && !from_rest)
      c.operation.speed_rpm = inputs.speed / kRadPerSecondPerRpm;
    const TakesFromOutside given = takes();
    if (given.suction) c.pressure.ports.suction = inputs.suction;
    if (given.delivery) c.pressure.ports.delivery = inputs.delivery;
    const hydraulics::OilStart oil = oil_start(c, from_rest);
    load_size_ = oil.load_size;
    started_ = scales_of(c);
    build(c, oil);
    time_ = 0;
    end_ = end > 0 ? end : c.drive->duration;
    inputs_ = inputs;
    speed_changed_ = false;
    state_ = {machine_->mechanics->start(), machine_->oil->start()};
    outside_ = surroundings({0, inputs.speed, inputs.acceleration});
    go_on();
  }

  void change(const Case& the_case) {
    PlantState now = state();
    const std::vector<double> started = started_;
    const Case before = std::exchange(case_, with_drive(the_case, choice_.drive));
    const std::vector<double> old_scales = scales_of(before), new_scales = scales_of(case_);
    for (std::size_t i = 0; i < now.started.size(); ++i)
      if (new_scales[i] != old_scales[i]) now.started[i] = new_scales[i];
    try {
      go_on_from(now, true);
    } catch (...) {
      case_ = before;
      started_ = started;
      throw;
    }
  }

  void set_inputs(const Inputs& inputs) {
    if (inputs == inputs_) return;
    if (inputs.speed != inputs_.speed) speed_changed_ = true;
    const AxisMotion shaft = steered(shaft_now(), inputs_, inputs);
    inputs_ = inputs;
    outside_ = surroundings(shaft);
    fresh_ = false;
    if (stepper_) stepper_->set_inputs(outside_);
    if (open_) open_->set_inputs(outside_);
  }

  double time() const { return time_; }

  void step(double time) {
    stepper_->step_to(time);
    stand_where_stepped();
  }
  void step_towards(double time) {
    stepper_->step_towards(time);
    stand_where_stepped();
  }

  std::vector<Passed> passed() const {
    using Kind = coupled::PassedEvent::Kind;
    std::vector<Passed> all;
    for (const coupled::PassedEvent& event : stepper_->passed()) {
      const std::string flank = event.flank > 0 ? "forward flank" : "backward flank";
      std::string what = "breakpoint of a curve over time";
      if (event.kind == Kind::edge)
        what =
            "the block passes a port edge at " + rounded_text(event.angle / kRadPerDegree) + " deg";
      if (event.kind == Kind::touch) what = "teeth touch, " + flank;
      if (event.kind == Kind::release) what = "teeth leave contact, " + flank;
      all.push_back({event.time, what});
    }
    return all;
  }

  coupled::OpenSystem& open() { return *open_; }
  void rates(std::vector<double>& rates) {
    if (!open_->rates(rates))
      throw ComputationError("the rates of the states are not finite at " + rounded_text(time_) +
                             " s");
  }
  const std::vector<double>& nominals() const { return nominals_; }
  void set_time(double time) {
    time_ = time;
    open_->set_time(time);
    fresh_ = false;
  }
  void set_states(const std::vector<double>& states) {
    open_->set(states);
    fresh_ = false;
  }

  const std::vector<double>& outputs() {
    refresh();
    return outputs_;
  }
  const std::vector<bool>& flags() {
    refresh();
    return flags_;
  }

  PlantState state() const {
    const coupled::SystemState& now = open_ ? open_->state() : state_;
    PlantState state;
    state.time = time_;
    state.motion.assign(now.motion.begin(), now.motion.end());
    state.oil = now.oil;
    state.shaft = shaft_now();
    state.load_size = load_size_;
    state.started = started_;
    state.speed_changed = speed_changed_;
    state.inputs = inputs_;
    return state;
  }

  void set_state(const PlantState& state) {
    if (state.motion.size() != kMotionStates ||
        static_cast<int>(state.oil.size()) != machine_->oil->states() ||
        !(state.started.empty() || state.started.size() == scales_of(case_).size()))
      throw InputError("the state is of another pump");
    go_on_from(state, state.load_size != load_size_ || state.started != started_);
  }

  std::vector<double> directional_derivative(const std::vector<const Variable*>& unknowns,
                                             const std::vector<const Variable*>& knowns,
                                             const std::vector<double>& seed) {
    double largest = 0;  // in nominal values
    for (std::size_t i = 0; i < knowns.size(); ++i)
      largest = std::max(largest, std::abs(seed[i]) / nominal(*knowns[i]));
    std::vector<double> slope(unknowns.size(), 0.0);
    if (largest == 0) return slope;
    const double step = kDifference / largest;
    const AxisMotion shaft = shaft_now();
    const std::vector<double> values = open_ ? open_->values() : std::vector<double>();
    const auto beside = [&](double steps) {
      Inputs inputs = inputs_;
      std::vector<double> moved = values;
      for (std::size_t i = 0; i < knowns.size(); ++i) {
        double& place = knowns[i]->role == Role::input ? input_of(inputs, knowns[i]->input)
                                                       : moved.at(knowns[i]->place);
        place += steps * step * seed[i];
      }
      return look(shaft, inputs, moved, unknowns);
    };
    std::vector<double> above, below, far_above, far_below;
    const auto stand_as_before = [&] { stand(outside_, values); };
    try {
      above = beside(1), below = beside(-1);
      far_above = beside(2), far_below = beside(-2);
    } catch (...) {
      stand_as_before();
      throw;
    }
    stand_as_before();
    // Of fourth order: flows through orifices bend sharply where pressures are nearly equal.
    for (std::size_t i = 0; i < slope.size(); ++i)
      slope[i] = (8 * (above[i] - below[i]) - (far_above[i] - far_below[i])) / (12 * step);
    return slope;
  }

 private:
  void stand_where_stepped() {
    advance(inputs_, stepper_->time() - time_);
    time_ = stepper_->time();
    state_ = stepper_->state();
    fresh_ = false;
  }

  // @param anew  models are built anew: of another case, or by another start
  void go_on_from(const PlantState& state, bool anew) {
    load_size_ = state.load_size;
    started_ = state.started;
    if (anew) build(as_started(), {load_size_, state.oil});
    time_ = state.time;
    inputs_ = state.inputs;
    speed_changed_ = state.speed_changed;
    std::copy(state.motion.begin(), state.motion.end(), state_.motion.begin());
    state_.oil = state.oil;
    outside_ = surroundings(state.shaft);
    go_on();
  }

  double nominal(const Variable& known) const {
    if (known.role == Role::input) return nominal_of(known.input, machine_->the_case);
    return nominals_.at(known.place);
  }

  // What acts and, of model exchange, the states.
  void stand(const Surroundings& outside, const std::vector<double>& values) {
    fresh_ = false;
    if (open_) {
      open_->set_inputs(outside);
      open_->set(values);
      return;
    }
    machine_->mechanics->set_inputs(outside);
    machine_->oil->set_inputs(outside);
  }

  // Values of unknowns under other inputs and states, at the present time.
  // @param shaft  as it moves under the present ones
  std::vector<double> look(const AxisMotion& shaft, const Inputs& inputs,
                           const std::vector<double>& values,
                           const std::vector<const Variable*>& unknowns) {
    const Inputs kept = std::exchange(inputs_, inputs);
    const Surroundings there = surroundings(steered(shaft, kept, inputs));
    inputs_ = kept;
    stand(there, values);
    std::vector<double> found, rates;
    if (open_) this->rates(rates);
    for (const Variable* unknown : unknowns)
      found.push_back(unknown->role == Role::derivative ? rates.at(unknown->place)
                      : unknown->role == Role::state    ? values.at(unknown->place)
                                                        : outputs().at(unknown->place));
    return found;
  }

  // What the start makes of a case and its states are measured by.
  static std::vector<double> scales_of(const Case& c) {
    return {c.operation.speed_rpm, c.pressure.ports.suction, c.pressure.ports.delivery};
  }
  Case as_started() const {
    Case c = case_;
    if (started_.empty()) return c;
    c.operation.speed_rpm = started_[0];
    c.pressure.ports = {started_[1], started_[2]};
    return c;
  }

  Inputs inputs_of_case() const {
    const Case& c = machine_->the_case;
    Inputs inputs;
    inputs.speed = rad_per_second(c.operation.speed_rpm);
    inputs.torque = choice_.start_torque.value_or(c.drive->torque);
    inputs.suction = c.pressure.ports.suction;
    inputs.delivery = c.pressure.ports.delivery;
    return inputs;
  }

  AxisMotion shaft_now() const {
    const coupled::SystemState& now = open_ ? open_->state() : state_;
    AxisMotion shaft = machine_->mechanics->shaft(time_, now.motion);
    if (outside_.shaft) shaft.acceleration = outside_.shaft->acceleration;
    return shaft;
  }

  // From the present time on.
  Surroundings surroundings(const AxisMotion& shaft) const {
    Surroundings now;
    const TakesFromOutside given = takes();
    now.time = time_;
    if (given.shaft) now.shaft = shaft;
    if (given.torque) now.torque = inputs_.torque;
    if (given.suction) now.suction = inputs_.suction;
    if (given.delivery) now.delivery = inputs_.delivery;
    if (given.load_share && (inputs_.load_share_replaces_curve || inputs_.load_share != 1 ||
                             inputs_.load_share_rate != 0))
      now.load_share = inputs_.load_share;
    now.torque_rate = inputs_.torque_rate;
    now.suction_rate = inputs_.suction_rate;
    now.delivery_rate = inputs_.delivery_rate;
    now.load_share_rate = inputs_.load_share_rate;
    return now;
  }

  // The shaft's motion where inputs follow others: it goes on where they say nothing new of it.
  static AxisMotion steered(AxisMotion shaft, const Inputs& before, const Inputs& now) {
    if (now.speed != before.speed || now.acceleration != before.acceleration) {
      shaft.speed = now.speed;
      shaft.acceleration = now.acceleration;
    }
    return shaft;
  }

  void build(const Case& the_case, const hydraulics::OilStart& start) {
    auto machine = std::make_unique<Machine>(the_case, start);  // refused: all stays
    stepper_.reset();
    open_.reset();
    machine_ = std::move(machine);
    places_ = output_places(*machine_, choice_.si_outputs);
    rules_ = flag_rules(*machine_);
    oil_columns_ = machine_->oil->columns().size();
    loads_.chamber_pressure.assign(static_cast<std::size_t>(machine_->oil->pistons()), 0.0);
    fresh_ = false;
  }

  // From time_ and state_ on, under outside_.
  void go_on() {
    fresh_ = false;
    if (kind_ == Kind::co_simulation) {
      stepper_ = std::make_unique<coupled::Stepper>("analytic", *machine_->mechanics,
                                                    *machine_->oil, choice_.tolerance);
      const double beyond = time_ + machine_->the_case.drive->duration;
      stepper_->start(time_, state_, end_ > time_ ? end_ : beyond);
      stepper_->set_inputs(outside_);
      return;
    }
    open_ = std::make_unique<coupled::OpenSystem>(*machine_->mechanics, *machine_->oil,
                                                  choice_.drive == Drive::speed);
    nominals_.clear();
    for (const coupled::OpenState& state : open_->states()) nominals_.push_back(state.nominal);
    machine_->mechanics->set_inputs(outside_);
    open_->start(time_, state_);
    open_->set_inputs(outside_);
  }

  void refresh() {
    if (fresh_) return;
    Mechanics& mechanics = *machine_->mechanics;
    const Oil& oil = *machine_->oil;
    const coupled::SystemState& now = open_ ? open_->state() : state_;
    const AxisMotion shaft = mechanics.shaft(time_, now.motion);
    const AxisMotion block = mechanics.block(time_, now.motion);
    oil.loads(time_, block, now.oil.data(), loads_);
    row_state_.clear();
    row_.assign(mechanics.layout().size(), not_computed());
    MotionChecks checks{not_computed(), not_computed(), not_computed()};
    mechanics.row(time_, now.motion, loads_, row_state_, row_, checks);
    row_oil_.resize(oil_columns_);
    if (!row_oil_.empty()) oil.row(time_, shaft, block, now.oil.data(), row_oil_.data());
    const double of_checks[] = {checks.tooth_law, checks.ring_power, checks.power_balance};
    outputs_.clear();
    for (const OutputPlace& place : places_) {
      using From = OutputPlace::From;
      const double value = place.from == From::state ? row_state_[place.index]
                           : place.from == From::row ? row_[place.index]
                           : place.from == From::oil ? row_oil_[place.index]
                                                     : of_checks[place.index];
      outputs_.push_back(value / place.unit_in_si * place.factor);
    }
    flags_.clear();
    for (const FlagRule& rule : rules_) flags_.push_back(holds(rule.flag, now));
    fresh_ = true;
  }

  bool holds(Flag flag, const coupled::SystemState& now) const {
    const ChannelLayout& at = machine_->mechanics->layout();
    const auto any_below = [&](double limit) {
      return std::any_of(loads_.chamber_pressure.begin(), loads_.chamber_pressure.end(),
                         [&](double pressure) { return pressure < limit; });
    };
    switch (flag) {
      case Flag::inertia:
        return !speed_changed_ || inputs_.acceleration_given;
      case Flag::contact:
        return machine_->mechanics->approach(time_, now.motion, 1) > 0 ||
               machine_->mechanics->approach(time_, now.motion, -1) > 0;
      case Flag::flank:
        return row_[at.Rcs()] >= 0;
      case Flag::film:
        return row_[at.Fh()] <= 0;
      case Flag::point:
        return std::hypot(row_[at.xh()], row_[at.yh()]) <= machine_->the_case.pump.port_plate->r4;
      case Flag::thrust:
        return row_[at.Rb1(2)] >= 0;
      case Flag::saturation:
        return any_below(machine_->oil->limits()->saturation);
      case Flag::vapour:
        break;
    }
    return any_below(machine_->oil->limits()->vapour);
  }

  UnitChoice choice_;
  Kind kind_;
  Case case_;  // with its parameters as they are set
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<coupled::Stepper> stepper_;
  std::unique_ptr<coupled::OpenSystem> open_;
  std::vector<OutputPlace> places_;
  std::vector<FlagRule> rules_;
  Inputs first_, inputs_;
  Surroundings outside_;
  double time_ = 0, end_ = 1, load_size_ = 0;
  bool speed_changed_ = false;
  std::vector<double> started_;
  std::size_t oil_columns_ = 0;
  coupled::SystemState state_;
  std::vector<double> nominals_;

  // What is shown, where it is fresh.
  bool fresh_ = false;
  OilLoads loads_;
  std::vector<double> row_state_, row_, row_oil_, outputs_;
  std::vector<bool> flags_;
};

Plant::Plant(const Case& the_case, const UnitChoice& choice, Kind kind)
    : it_(std::make_unique<Implementation>(the_case, choice, kind)) {}
Plant::~Plant() = default;
Inputs Plant::first_inputs() const { return it_->first_inputs(); }
TakesFromOutside Plant::takes() const { return it_->takes(); }
void Plant::start(const Inputs& inputs, double end) { it_->start(inputs, end); }
void Plant::change(const Case& the_case) { it_->change(the_case); }
void Plant::set_inputs(const Inputs& inputs) { it_->set_inputs(inputs); }
const Inputs& Plant::inputs() const { return it_->inputs(); }
double Plant::time() const { return it_->time(); }
void Plant::step(double time) { it_->step(time); }
void Plant::step_towards(double time) { it_->step_towards(time); }
std::vector<Plant::Passed> Plant::passed() const { return it_->passed(); }
std::size_t Plant::state_count() const { return it_->open().states().size(); }
std::vector<double> Plant::states() const { return it_->open().values(); }
const std::vector<double>& Plant::nominals() const { return it_->nominals(); }
void Plant::set_time(double time) { it_->set_time(time); }
void Plant::set_states(const std::vector<double>& states) { it_->set_states(states); }
void Plant::rates(std::vector<double>& rates) { it_->rates(rates); }
std::size_t Plant::indicator_count() const { return it_->open().indicators().size(); }
void Plant::indicators(std::vector<double>& values) { it_->open().indicator_values(values); }
Plant::Event Plant::pass_event() {
  it_->open().pass_event();
  return {false, it_->open().next_breakpoint()};
}
bool Plant::wants_event() { return it_->open().beyond(); }
std::vector<double> Plant::directional_derivative(const std::vector<const Variable*>& unknowns,
                                                  const std::vector<const Variable*>& knowns,
                                                  const std::vector<double>& known_seed) {
  return it_->directional_derivative(unknowns, knowns, known_seed);
}
const std::vector<double>& Plant::outputs() { return it_->outputs(); }
const std::vector<bool>& Plant::flags() { return it_->flags(); }
PlantState Plant::state() const { return it_->state(); }
void Plant::set_state(const PlantState& state) { it_->set_state(state); }

}  // namespace bentaxis::fmu
