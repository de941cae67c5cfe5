#include "dependencies.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "bentaxis/coupled/open_system.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"
#include "runtime/machine.h"
#include "runtime/plant.h"

namespace bentaxis::fmu {
namespace {

constexpr int kPoints = 64;  // of every set of parameters
constexpr int kPointsOfParameter = 24;
constexpr int kSets = 3;   // of parameters, beside the case's own
constexpr int kTries = 8;  // for parameters that are refused together
// A change below this share of what is of the same kind there is round-off.
constexpr double kRoundOff = 1e-11;
// Factors that differ by less are one: differences of linear relations are exact but for round-off.
constexpr double kOneFactor = 1e-7;
constexpr double kPascalOfLoad = 200e5;       // of a load whose size is sought
constexpr double kAreaOfLoad = 1e-5;          // m2
constexpr double kConductanceOfLoad = 5e-11;  // m3/(s Pa)

// Numbers that are the same on every computer.
class Random {
 public:
  double between(double low, double high) {
    constexpr double kRange = 9007199254740992.0;  // 2^53
    return low + (high - low) * static_cast<double>(bits_() >> 11) / kRange;
  }
  bool once_in(int count) { return between(0, count) < 1; }
  double sign() { return once_in(2) ? 1 : -1; }
  double power_of_ten(double low, double high) { return std::pow(10.0, between(low, high)); }

 private:
  std::mt19937_64 bits_{20};
};

struct Point {
  double time = 0;
  std::vector<double> states;
  Inputs inputs;
};

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

// What an unknown changes by when a known does, over all points.
struct Change {
  double largest = 0;  // over what is of the same kind
  std::optional<double> factor;
  bool one_factor = true;
};

class Finder {
 public:
  Finder(const Case& the_case, const UnitChoice& choice, const std::vector<Variable>& variables)
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

  Dependencies find() {
    Dependencies found;
    sets_ = {values_};
    for (int i = 0; i < kSets; ++i) sets_.push_back(other_parameters());
    if (!sample(Where::anywhere, running_)) return {};
    for (std::size_t u = 0; u < unknowns_.size(); ++u)
      for (std::size_t k = 0; k < knowns_.size(); ++k) {
        const Change& change = running_[u][k];
        if (change.largest > kRoundOff)
          found.running[unknowns_[u]->reference].push_back(
              {knowns_[k]->reference, change.one_factor && !knowns_[k]->boolean});
        else
          found.running[unknowns_[u]->reference];
      }
    add_residuals(found.running);
    add_flags(found.running);
    find_initial(found);
    return found;
  }

 private:
  using Values = std::vector<double>;  // of unknowns_

  // @return null where the case with these parameters has no start
  std::unique_ptr<Plant> plant_of(const std::vector<double>& parameters) const {
    try {
      auto plant = std::make_unique<Plant>(case_with(case_, variables_, parameters), choice_,
                                           Plant::Kind::model_exchange);
      PlantState state = base_;
      state.inputs = plant->first_inputs();
      plant->set_state(state);
      return plant;
    } catch (const InputError&) {
    } catch (const ComputationError&) {
    }
    return nullptr;
  }

  // Other values of all parameters; those that are 0 are not, as far as the case allows it.
  std::vector<double> other_parameters() {
    std::vector<double> values = values_;
    for (const Variable* it : parameters_) {
      double& value = values[it->reference];
      const double kept = value;
      for (int i = 0; i < kTries && value == kept; ++i) {
        value = kept == 0 ? random_.between(0.2, 1) * std::pow(0.1, i / 2)
                          : kept * random_.between(0.98, 1.02);
        try {
          case_with(case_, variables_, values);
        } catch (const InputError&) {
          value = kept;
        }
      }
    }
    return values;
  }

  // Where the motion is: in its start shaft and block are at angle 0.
  enum class Where { anywhere, at_start };

  Point any_point(const Plant& plant, Where where) {
    Point point;
    const double omega = std::max(std::abs(rad_per_second(case_.operation.speed_rpm)), 50.0);
    const auto speed = [&] { return random_.sign() * omega * random_.power_of_ten(-3, 0.2); };
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
    point.inputs.speed = speed();
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

  static bool begins_at_zero(const Variable& state) {
    return state.name == "state.shaft_angle" || state.name == "state.lag" ||
           state.name == "state.lag_rate";
  }

  double any_state(const Variable& state, double omega) {
    const std::string& name = state.name;
    const auto is = [&](const char* part) { return name.find(part) != std::string::npos; };
    constexpr double kTurn = 2 * kPi, kAtmosphere = 101325;
    if (is("shaft_angle")) return random_.between(-kTurn, kTurn);
    if (is("shaft_speed")) return random_.sign() * omega * random_.power_of_ten(-3, 0.2);
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
  bool values_at(Plant& plant, const Point& point, bool new_edges, Values& values) {
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
  double move(Point& point, const Variable& known) {
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
  double scale_of(std::size_t unknown, const Values& a, const Values& b) const {
    constexpr double kAngles = 10;  // rad, that those of edges are differences of
    const Variable& it = *unknowns_[unknown];
    double scale = it.role == Role::indicator && it.unit == "rad" ? kAngles : 0;
    for (std::size_t i = 0; i < unknowns_.size(); ++i)
      if (i == unknown || same_kind(*unknowns_[i], *unknowns_[unknown]))
        for (const double value : {a[i], b[i]})
          if (std::isfinite(value)) scale = std::max(scale, std::abs(value));
    return scale;
  }

  static void note(Change& change, double scale, double before, double after, double by) {
    const double difference = after - before;
    if (!std::isfinite(difference) || scale == 0) return;
    const double share = std::abs(difference) / scale;
    change.largest = std::max(change.largest, share);
    const double factor = difference / by;
    if (!change.factor) change.factor = factor;
    const double larger = std::max(std::abs(factor), std::abs(*change.factor));
    const double rounding = kRoundOff * scale / std::abs(by);
    if (std::abs(factor - *change.factor) > kOneFactor * larger + rounding)
      change.one_factor = false;
  }

  std::vector<double> scales_at(const Values& a, const Values& b) const {
    std::vector<double> scales;
    for (std::size_t u = 0; u < unknowns_.size(); ++u) scales.push_back(scale_of(u, a, b));
    return scales;
  }

  // @return whether there were enough points
  bool sample(Where where, std::vector<std::vector<Change>>& changes) {
    changes.assign(unknowns_.size(), std::vector<Change>(knowns_.size()));
    int points = 0;
    for (const std::vector<double>& parameters : sets_) {
      const auto plant = plant_of(parameters);
      for (int p = 0; plant && p < kPoints; ++p) {
        const Point here = any_point(*plant, where);
        Values before, after;
        if (!values_at(*plant, here, true, before)) continue;
        ++points;
        const std::vector<double> scales = scales_at(before, before);
        for (std::size_t k = 0; k < knowns_.size(); ++k) {
          Point there = here;
          const double by = move(there, *knowns_[k]);
          if (!values_at(*plant, there, false, after)) continue;
          for (std::size_t u = 0; u < unknowns_.size(); ++u)
            note(changes[u][k], std::max(scales[u], std::abs(after[u])), before[u], after[u], by);
        }
      }
    }
    return points >= kPoints;
  }

  std::optional<std::uint32_t> reference_of(const std::string& name) const {
    for (const Variable& it : variables_)
      if (it.name == name) return it.reference;
    return std::nullopt;
  }

  static void add_all(std::vector<Dependence>& to, const std::vector<Dependence>& from) {
    for (const Dependence& one : from) {
      const auto same = [&](const Dependence& other) { return other.known == one.known; };
      if (std::none_of(to.begin(), to.end(), same)) to.push_back({one.known, false});
    }
    std::sort(to.begin(), to.end(),
              [](const Dependence& a, const Dependence& b) { return a.known < b.known; });
  }

  // Identities that vanish but for round-off: by all that the forces depend on.
  void add_residuals(DependencesOf& found) const {
    std::vector<Dependence> all;
    for (const Variable* it : unknowns_)
      if (it->role == Role::output && (it->unit == "N" || it->unit == "Nm"))
        add_all(all, found[it->reference]);
    std::vector<Channel> channels = motion_channels();
    const std::vector<Channel> of_run = ChannelLayout(case_.pump).channels();
    channels.insert(channels.end(), of_run.begin(), of_run.end());
    for (const Channel& channel : channels)
      if (const auto reference = reference_of(channel.name);
          reference && channel.kind == ChannelKind::check)
        found[*reference] = all;
  }

  // A flag depends on what the numbers depend on that it is about.
  void add_flags(DependencesOf& found) const {
    for (const Variable& flag : variables_) {
      if (flag.role != Role::flag) continue;
      std::vector<Dependence>& of = found[flag.reference];
      for (const Variable& it : variables_) {
        const bool about =
            (flag.name == "tooth_contact" && it.name.starts_with("indicator.flank_")) ||
            (flag.name == "valid_flank" && it.name.starts_with("Rcs_")) ||
            (flag.name == "valid_film" && it.name.starts_with("Fh_")) ||
            (flag.name == "valid_point" &&
             (it.name.starts_with("xh_") || it.name.starts_with("yh_"))) ||
            (flag.name == "valid_thrust" && it.name.starts_with("Rb1_z1_")) ||
            ((flag.name == "cavitation" || flag.name == "vapour") &&
             it.name.starts_with("state.oil.ln_p_") && is_chamber(it));
        if (!about) continue;
        if (it.role == Role::state)
          add_all(of, {{it.reference, false}});
        else
          add_all(of, found[it.reference]);
      }
      if (flag.name == "inertia_reactions_valid")
        for (const Variable* it : knowns_)
          if (it->role == Role::input &&
              (it->input == Input::speed || it->input == Input::acceleration))
            add_all(of, {{it->reference, false}});
    }
  }

  static bool is_chamber(const Variable& state) {
    const char last = state.name.back();
    return last >= '0' && last <= '9';
  }

  // Parameters that an unknown depends on where the states are given.
  void sample_parameters() {
    by_load_.assign(unknowns_.size(), {});
    for (auto* changes : {&by_parameter_, &by_parameter_at_start_})
      changes->assign(unknowns_.size(), std::vector<Change>(parameters_.size()));
    for (const std::size_t set : {std::size_t{0}, std::size_t{1}}) {
      const auto plant = plant_of(sets_[set]);
      if (!plant) continue;
      const std::vector<Seen> anywhere = look_around(*plant, Where::anywhere);
      const std::vector<Seen> at_start = look_around(*plant, Where::at_start);
      for (std::size_t q = 0; q < parameters_.size(); ++q)
        compare_parameter(set, q, anywhere, at_start);
      if (set == 0) compare_load(anywhere);
    }
  }

  struct Seen {
    Point point;
    Values values, scales;
  };

  std::vector<Seen> look_around(Plant& plant, Where where) {
    std::vector<Seen> seen;
    for (int p = 0; p < kPointsOfParameter; ++p) {
      Point point = any_point(plant, where);
      Values values;
      if (!values_at(plant, point, true, values)) continue;
      Values scales = scales_at(values, values);
      seen.push_back({std::move(point), std::move(values), std::move(scales)});
    }
    return seen;
  }

  void compare_parameter(std::size_t set, std::size_t parameter, const std::vector<Seen>& anywhere,
                         const std::vector<Seen>& at_start) {
    const auto values = with_other(sets_[set], *parameters_[parameter]);
    const auto plant = values ? plant_of(*values) : nullptr;
    if (!plant) {  // nothing is known of it: all may depend on it
      if (set == 0) unmoved_.push_back(parameters_[parameter]->reference);
      return;
    }
    compare(*plant, anywhere,
            [&](std::size_t u) -> Change& { return by_parameter_[u][parameter]; });
    compare(*plant, at_start,
            [&](std::size_t u) -> Change& { return by_parameter_at_start_[u][parameter]; });
  }

  // Unknowns that depend on a size of the load that is found at the start.
  void compare_load(const std::vector<Seen>& seen) {
    if (!case_.hydraulics || !hydraulics::needs_periodic_state(case_)) return;
    const double kept = base_.load_size;
    base_.load_size *= 1.1;
    const auto plant = plant_of(values_);
    base_.load_size = kept;
    if (!plant) return;
    compare(*plant, seen, [&](std::size_t u) -> Change& { return by_load_[u]; });
  }

  template <class Place>
  void compare(Plant& plant, const std::vector<Seen>& seen, Place place) {
    Values after;
    for (const Seen& one : seen) {
      if (!values_at(plant, one.point, true, after)) continue;
      for (std::size_t u = 0; u < unknowns_.size(); ++u)
        note(place(u), std::max(one.scales[u], std::abs(after[u])), one.values[u], after[u], 1);
    }
  }

  // The same set with another value of one parameter, where one is allowed.
  std::optional<std::vector<double>> with_other(std::vector<double> values,
                                                const Variable& parameter) const {
    double& value = values[parameter.reference];
    const double kept = value;
    for (const double factor : {0.99, 1.01, 0.999, 1.001}) {
      value = kept == 0 ? 1 - factor : kept * factor;
      try {
        case_with(case_, variables_, values);
        return values;
      } catch (const InputError&) {  // another one
      }
    }
    return std::nullopt;
  }

  // States that the motion begins with, and the oil at rest.
  std::vector<double> start_of(const Case& the_case) const {
    const Machine machine(the_case, {base_.load_size, {}});
    coupled::OpenSystem open(*machine.mechanics, *machine.oil, choice_.drive == Drive::speed);
    coupled::SystemState state;
    state.motion = machine.mechanics->start();
    state.oil = machine.oil->start();
    open.start(0, state);
    return open.values();
  }

  Case with_input(const Variable& input) const {
    Case other = case_;
    constexpr double kOther = 1.01, kOtherPressure = 1e5;
    if (input.input == Input::speed)
      other.operation.speed_rpm = other.operation.speed_rpm * kOther + 1;
    if (input.input == Input::suction) other.pressure.ports.suction += kOtherPressure;
    if (input.input == Input::delivery) other.pressure.ports.delivery += kOtherPressure;
    return other;
  }

  void find_initial(Dependencies& found) {
    sample_parameters();
    std::vector<std::vector<Change>> at_start;
    if (!sample(Where::at_start, at_start)) return;
    // By inputs and parameters, and by states.
    std::map<std::uint32_t, std::set<std::uint32_t>> direct, by_states;
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      const Variable& unknown = *unknowns_[u];
      for (std::size_t k = 0; k < knowns_.size(); ++k) {
        const Variable& known = *knowns_[k];
        const bool anywhere = is_of_ports(unknown) || is_of_ports(known);
        const Change& change = anywhere ? running_[u][k] : at_start[u][k];
        if (change.largest <= kRoundOff) continue;
        if (known.role == Role::input) direct[unknown.reference].insert(known.reference);
        if (known.role == Role::state) by_states[unknown.reference].insert(known.reference);
      }
      for (std::size_t q = 0; q < parameters_.size(); ++q) {
        const Variable& known = *parameters_[q];
        const bool anywhere = is_of_ports(unknown) || is_of_ports(known);
        const Change& change = anywhere ? by_parameter_[u][q] : by_parameter_at_start_[u][q];
        if (change.largest > kRoundOff) direct[unknown.reference].insert(known.reference);
      }
      direct[unknown.reference].insert(unmoved_.begin(), unmoved_.end());
    }
    share_with_flags(direct, false);
    share_with_flags(by_states, true);
    limits_of_oil(direct);
    std::set<std::uint32_t> of_oil;
    const auto starts = starts_of_states(direct, of_oil);
    std::set<std::uint32_t> by_load;
    for (std::size_t u = 0; u < unknowns_.size(); ++u)
      if (by_load_[u].largest > kRoundOff) by_load.insert(unknowns_[u]->reference);
    for (const Variable& it : variables_) {
      if (it.role != Role::output && it.role != Role::derivative && it.role != Role::flag &&
          it.role != Role::state)
        continue;
      std::set<std::uint32_t> all = direct[it.reference];
      if (it.role == Role::state) all = starts.at(it.reference);
      for (const std::uint32_t state : by_states[it.reference])
        all.insert(starts.at(state).begin(), starts.at(state).end());
      if (by_load.count(it.reference) != 0) all.insert(of_oil.begin(), of_oil.end());
      std::vector<Dependence>& list = found.initial[it.reference];
      for (const std::uint32_t known : all) list.push_back({known, false});
    }
  }

  // What residuals and flags are about, as in add_residuals() and add_flags().
  void share_with_flags(std::map<std::uint32_t, std::set<std::uint32_t>>& by, bool states) const {
    DependencesOf all;
    for (const auto& [unknown, knowns] : by)
      for (const std::uint32_t known : knowns) all[unknown].push_back({known, false});
    add_residuals(all);
    add_flags(all);
    for (const auto& [unknown, knowns] : all)
      for (const Dependence& one : knowns)
        if ((variables_[one.known].role == Role::state) == states) by[unknown].insert(one.known);
  }

  // Where a chamber meets a port at angle 0 parameters decide, of which only those near the case's
  // are looked at.
  static bool is_of_ports(const Variable& it) {
    return it.name.starts_with("der(state.oil.") || it.name.starts_with("state.oil.") ||
           it.name.starts_with("flow_") || it.name.starts_with("leakage_") ||
           it.name.starts_with("p_") || it.name.starts_with("pressure.") ||
           it.name.starts_with("port_plate.") || it.name.starts_with("hydraulics.") ||
           (it.role == Role::input && (it.input == Input::suction || it.input == Input::delivery));
  }

  // What else flags are about: limits that are parameters.
  void limits_of_oil(std::map<std::uint32_t, std::set<std::uint32_t>>& direct) const {
    const auto limits = [this](const std::vector<double>& values) {
      return Machine(case_with(case_, variables_, values), {base_.load_size, {}}).oil->limits();
    };
    const std::optional<OilLimits> here = limits(values_);
    for (const Variable& flag : variables_) {
      if (flag.role != Role::flag) continue;
      for (const Variable* parameter : parameters_) {
        if (flag.name == "valid_point" && parameter->name == "port_plate.outer_land_mm[2]")
          direct[flag.reference].insert(parameter->reference);
        const bool saturation = flag.name == "cavitation", vapour = flag.name == "vapour";
        if (!here || !(saturation || vapour)) continue;
        const auto values = with_other(values_, *parameter);
        if (!values) continue;
        const OilLimits there = limits(*values).value();
        if (saturation ? there.saturation != here->saturation : there.vapour != here->vapour)
          direct[flag.reference].insert(parameter->reference);
      }
    }
  }

  // By which inputs and parameters the states begin. In the periodic state of the oil that is all
  // that its rates depend on, and what its speed and pressures are.
  std::map<std::uint32_t, std::set<std::uint32_t>> starts_of_states(
      const std::map<std::uint32_t, std::set<std::uint32_t>>& direct,
      std::set<std::uint32_t>& of_oil) const {
    std::map<std::uint32_t, std::set<std::uint32_t>> starts;
    std::vector<std::uint32_t> states;
    for (const Variable& it : variables_)
      if (it.role == Role::state) states.push_back(it.reference);
    for (const std::uint32_t state : states) starts[state];
    const std::vector<double> here = start_of(case_);
    const auto compare_start = [&](const Case& other, std::uint32_t known) {
      const std::vector<double> there = start_of(other);
      for (std::size_t i = 0; i < states.size(); ++i)
        if (std::abs(there[i] - here[i]) > kRoundOff * std::max(1.0, std::abs(here[i])))
          starts[states[i]].insert(known);
    };
    for (const Variable* it : parameters_)
      if (const auto values = with_other(values_, *it))
        compare_start(case_with(case_, variables_, *values), it->reference);
    for (const Variable* it : knowns_)
      if (it->role == Role::input) compare_start(with_input(*it), it->reference);
    if (!case_.hydraulics) return starts;
    for (const Variable& it : variables_) {
      const bool oil = it.role == Role::derivative && it.name.starts_with("der(state.oil.");
      const auto found = direct.find(it.reference);
      if (oil && found != direct.end()) of_oil.insert(found->second.begin(), found->second.end());
      const bool given =
          it.role == Role::input &&
          (it.input == Input::speed || it.input == Input::suction || it.input == Input::delivery);
      if (given || it.name == "operation.speed_rpm" || it.name == "drive.start_rpm" ||
          it.name == "pressure.suction_bar" || it.name == "pressure.delivery_bar" ||
          it.name == "hydraulics.tolerance")
        of_oil.insert(it.reference);
    }
    for (const Variable* it : knowns_)  // the load's size at the start is its whole size
      if (it->role == Role::input &&
          (it->input == Input::load_share || it->input == Input::load_share_replaces_curve))
        of_oil.erase(it->reference);
    if (!hydraulics::starts_periodic(case_)) return starts;
    for (const Variable& it : variables_)
      if (it.role == Role::state && it.name.starts_with("state.oil."))
        starts[it.reference].insert(of_oil.begin(), of_oil.end());
    return starts;
  }

  Case case_;
  UnitChoice choice_;
  const std::vector<Variable>& variables_;
  std::vector<const Variable*> unknowns_, knowns_, parameters_;
  std::vector<double> values_;  // of parameters, by reference
  std::vector<std::vector<double>> sets_;
  PlantState base_;
  std::vector<double> breakpoints_;
  Random random_;
  std::vector<double> rates_, indicators_;
  std::vector<std::vector<Change>> running_, by_parameter_, by_parameter_at_start_;
  std::vector<Change> by_load_;
  std::vector<std::uint32_t> unmoved_;  // parameters that cannot be changed alone
};

}  // namespace

Dependencies dependencies_of(const Case& the_case, const UnitChoice& choice,
                             const std::vector<Variable>& variables) {
  return Finder(the_case, choice, variables).find();
}

}  // namespace bentaxis::fmu
