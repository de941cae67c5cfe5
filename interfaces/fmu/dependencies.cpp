#include "dependencies.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "bentaxis/coupled/open_system.h"
#include "bentaxis/results/trajectory.h"
#include "runtime/machine.h"
#include "sampler.h"

namespace bentaxis::fmu {
namespace {

constexpr int kSets = 3;  // of parameters, beside the case's own

using Where = Sampler::Where;
using References = std::set<std::uint32_t>;
using ReferencesOf = std::map<std::uint32_t, References>;

void add_to(References& to, const References& from) { to.insert(from.begin(), from.end()); }

bool starts_with_one_of(std::string_view name, std::initializer_list<std::string_view> starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](std::string_view start) { return name.starts_with(start); });
}

bool is_input(const Variable& it, std::initializer_list<Input> which) {
  return it.role == Role::input && std::find(which.begin(), which.end(), it.input) != which.end();
}

bool is_chamber(const Variable& state) {
  const char last = state.name.back();
  return last >= '0' && last <= '9';
}

// Where a chamber meets a port at angle 0 parameters decide, of which only those near the case's
// are looked at.
bool is_of_ports(const Variable& it) {
  return starts_with_one_of(it.name, {"der(state.oil.", "state.oil.", "flow_", "leakage_", "p_",
                                      "pressure.", "port_plate.", "hydraulics."}) ||
         is_input(it, {Input::suction, Input::delivery});
}

// Whether a flag is about this variable: it then depends on what that depends on.
bool is_about(const Variable& flag, const Variable& it) {
  const std::string& name = flag.name;
  return (name == "tooth_contact" && it.name.starts_with("indicator.flank_")) ||
         (name == "valid_flank" && it.name.starts_with("Rcs_")) ||
         (name == "valid_film" && it.name.starts_with("Fh_")) ||
         (name == "valid_point" && starts_with_one_of(it.name, {"xh_", "yh_"})) ||
         (name == "valid_thrust" && it.name.starts_with("Rb1_z1_")) ||
         ((name == "cavitation" || name == "vapour") && it.name.starts_with("state.oil.ln_p_") &&
          is_chamber(it));
}

void add_all(std::vector<Dependence>& to, const std::vector<Dependence>& from) {
  for (const Dependence& one : from) {
    const auto same = [&](const Dependence& other) { return other.known == one.known; };
    if (std::none_of(to.begin(), to.end(), same)) to.push_back({one.known, false});
  }
  std::sort(to.begin(), to.end(),
            [](const Dependence& a, const Dependence& b) { return a.known < b.known; });
}

class Finder {
 public:
  Finder(const Case& the_case, const UnitChoice& choice, const std::vector<Variable>& variables)
      : sampler_(the_case, choice, variables),
        case_(sampler_.the_case()),
        choice_(choice),
        variables_(variables),
        unknowns_(sampler_.unknowns()),
        knowns_(sampler_.knowns()),
        parameters_(sampler_.parameters()),
        values_(sampler_.start_values()) {}

  Dependencies find() {
    Dependencies found;
    sets_ = {values_};
    for (int i = 0; i < kSets; ++i) sets_.push_back(sampler_.other_parameters());
    const auto running = sampler_.changes_by_knowns(sets_, Where::anywhere);
    if (!running) return {};
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      std::vector<Dependence>& of = found.running[unknowns_[u]->reference];
      for (std::size_t k = 0; k < knowns_.size(); ++k)
        if (const Change& change = (*running)[u][k]; change.seen())
          of.push_back({knowns_[k]->reference, change.one_factor && !knowns_[k]->boolean});
    }
    add_residuals(found.running);
    add_flags(found.running);
    sample_parameters();
    if (const auto at_start = sampler_.changes_by_knowns(sets_, Where::at_start))
      find_initial(*running, *at_start, found.initial);
    return found;
  }

 private:
  std::optional<std::uint32_t> reference_of(const std::string& name) const {
    for (const Variable& it : variables_)
      if (it.name == name) return it.reference;
    return std::nullopt;
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
        if (!is_about(flag, it)) continue;
        if (it.role == Role::state)
          add_all(of, {{it.reference, false}});
        else
          add_all(of, found[it.reference]);
      }
      if (flag.name == "inertia_reactions_valid")
        for (const Variable* it : knowns_)
          if (is_input(*it, {Input::speed, Input::acceleration}))
            add_all(of, {{it->reference, false}});
    }
  }

  // Parameters that an unknown depends on where the states are given.
  void sample_parameters() {
    by_load_.assign(unknowns_.size(), {});
    for (auto* changes : {&by_parameter_, &by_parameter_at_start_})
      changes->assign(unknowns_.size(), std::vector<Change>(parameters_.size()));
    for (const std::size_t set : {std::size_t{0}, std::size_t{1}}) {
      const auto plant = sampler_.plant_of(sets_[set]);
      if (!plant) continue;
      const std::vector<Sampler::Seen> anywhere = sampler_.look_around(*plant, Where::anywhere);
      const std::vector<Sampler::Seen> at_start = sampler_.look_around(*plant, Where::at_start);
      for (std::size_t q = 0; q < parameters_.size(); ++q)
        compare_parameter(set, q, anywhere, at_start);
      if (set == 0) compare_load(anywhere);
    }
  }

  void compare_parameter(std::size_t set, std::size_t parameter,
                         const std::vector<Sampler::Seen>& anywhere,
                         const std::vector<Sampler::Seen>& at_start) {
    const auto values = sampler_.with_other(sets_[set], *parameters_[parameter]);
    const auto plant = values ? sampler_.plant_of(*values) : nullptr;
    if (!plant) {  // nothing is known of it: all may depend on it
      if (set == 0) unmoved_.insert(parameters_[parameter]->reference);
      return;
    }
    sampler_.compare(*plant, anywhere,
                     [&](std::size_t u) -> Change& { return by_parameter_[u][parameter]; });
    sampler_.compare(*plant, at_start, [&](std::size_t u) -> Change& {
      return by_parameter_at_start_[u][parameter];
    });
  }

  // Unknowns that depend on a size of the load that is found at the start.
  void compare_load(const std::vector<Sampler::Seen>& seen) {
    if (!case_.hydraulics || !hydraulics::needs_periodic_state(case_)) return;
    if (const auto plant = sampler_.plant_of_other_load())
      sampler_.compare(*plant, seen, [&](std::size_t u) -> Change& { return by_load_[u]; });
  }

  void find_initial(const Changes& running, const Changes& at_start, DependencesOf& initial) const {
    ReferencesOf direct;  // by inputs and parameters
    ReferencesOf by_states;
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      const Variable& unknown = *unknowns_[u];
      const auto depends_on = [&](const Variable& known, const Change& anywhere,
                                  const Change& at_zero) {
        return (is_of_ports(unknown) || is_of_ports(known) ? anywhere : at_zero).seen();
      };
      for (std::size_t k = 0; k < knowns_.size(); ++k) {
        const Variable& known = *knowns_[k];
        if (!depends_on(known, running[u][k], at_start[u][k])) continue;
        if (known.role == Role::input) direct[unknown.reference].insert(known.reference);
        if (known.role == Role::state) by_states[unknown.reference].insert(known.reference);
      }
      for (std::size_t q = 0; q < parameters_.size(); ++q)
        if (depends_on(*parameters_[q], by_parameter_[u][q], by_parameter_at_start_[u][q]))
          direct[unknown.reference].insert(parameters_[q]->reference);
      add_to(direct[unknown.reference], unmoved_);
    }
    share_with_flags(direct, false);
    share_with_flags(by_states, true);
    limits_of_oil(direct);
    const References of_oil = case_.hydraulics ? starts_of_oil(direct) : References();
    const ReferencesOf starts = starts_of_states(of_oil);
    References by_load;
    for (std::size_t u = 0; u < unknowns_.size(); ++u)
      if (by_load_[u].seen()) by_load.insert(unknowns_[u]->reference);
    for (const Variable& it : variables_) {
      if (it.role != Role::output && it.role != Role::derivative && it.role != Role::flag &&
          it.role != Role::state)
        continue;
      References all = it.role == Role::state ? starts.at(it.reference) : direct[it.reference];
      for (const std::uint32_t state : by_states[it.reference]) add_to(all, starts.at(state));
      if (by_load.count(it.reference) != 0) add_to(all, of_oil);
      std::vector<Dependence>& list = initial[it.reference];
      for (const std::uint32_t known : all) list.push_back({known, false});
    }
  }

  // What residuals and flags are about, as in add_residuals() and add_flags().
  void share_with_flags(ReferencesOf& by, bool states) const {
    DependencesOf all;
    for (const auto& [unknown, knowns] : by)
      for (const std::uint32_t known : knowns) all[unknown].push_back({known, false});
    add_residuals(all);
    add_flags(all);
    for (const auto& [unknown, knowns] : all)
      for (const Dependence& one : knowns)
        if ((variables_[one.known].role == Role::state) == states) by[unknown].insert(one.known);
  }

  // What else flags are about: limits that are parameters.
  void limits_of_oil(ReferencesOf& direct) const {
    const auto limits = [this](const std::vector<double>& values) {
      return Machine(case_with(case_, variables_, values), {sampler_.load_size(), {}})
          .oil->limits();
    };
    const std::optional<OilLimits> here = limits(values_);
    for (const Variable& flag : variables_) {
      if (flag.role != Role::flag) continue;
      for (const Variable* parameter : parameters_) {
        if (flag.name == "valid_point" && parameter->name == "port_plate.outer_land_mm[2]")
          direct[flag.reference].insert(parameter->reference);
        const bool saturation = flag.name == "cavitation", vapour = flag.name == "vapour";
        if (!here || !(saturation || vapour)) continue;
        const auto values = sampler_.with_other(values_, *parameter);
        if (!values) continue;
        const OilLimits there = limits(*values).value();
        if (saturation ? there.saturation != here->saturation : there.vapour != here->vapour)
          direct[flag.reference].insert(parameter->reference);
      }
    }
  }

  // The periodic state of the oil: all that its rates depend on, and what its speed and pressures
  // are.
  References starts_of_oil(const ReferencesOf& direct) const {
    References of_oil;
    for (const Variable& it : variables_) {
      const auto found = direct.find(it.reference);
      if (it.role == Role::derivative && it.name.starts_with("der(state.oil.") &&
          found != direct.end())
        add_to(of_oil, found->second);
      if (is_input(it, {Input::speed, Input::suction, Input::delivery}) ||
          it.name == "operation.speed_rpm" || it.name == "drive.start_rpm" ||
          it.name == "pressure.suction_bar" || it.name == "pressure.delivery_bar" ||
          it.name == "hydraulics.tolerance")
        of_oil.insert(it.reference);
    }
    for (const Variable* it : knowns_)  // the load's size at the start is its whole size
      if (is_input(*it, {Input::load_share, Input::load_share_replaces_curve}))
        of_oil.erase(it->reference);
    return of_oil;
  }

  // States that the motion begins with, and the oil at rest.
  std::vector<double> start_of(const Case& the_case) const {
    const Machine machine(the_case, {sampler_.load_size(), {}});
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

  // By which inputs and parameters the states begin.
  ReferencesOf starts_of_states(const References& of_oil) const {
    ReferencesOf starts;
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
      if (const auto values = sampler_.with_other(values_, *it))
        compare_start(case_with(case_, variables_, *values), it->reference);
    for (const Variable* it : knowns_)
      if (it->role == Role::input) compare_start(with_input(*it), it->reference);
    if (!case_.hydraulics || !hydraulics::starts_periodic(case_)) return starts;
    for (const Variable& it : variables_)
      if (it.role == Role::state && it.name.starts_with("state.oil."))
        add_to(starts[it.reference], of_oil);
    return starts;
  }

  Sampler sampler_;
  const Case& case_;
  UnitChoice choice_;
  const std::vector<Variable>& variables_;
  const std::vector<const Variable*>&unknowns_, &knowns_, &parameters_;
  const std::vector<double>& values_;  // of parameters, by reference
  std::vector<std::vector<double>> sets_;
  Changes by_parameter_, by_parameter_at_start_;
  std::vector<Change> by_load_;
  References unmoved_;  // parameters that cannot be changed alone
};

}  // namespace

Dependencies dependencies_of(const Case& the_case, const UnitChoice& choice,
                             const std::vector<Variable>& variables) {
  return Finder(the_case, choice, variables).find();
}

}  // namespace bentaxis::fmu
