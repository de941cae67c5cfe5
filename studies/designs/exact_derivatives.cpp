#include <algorithm>
#include <cmath>
#include <utility>

#include "bentaxis/analytic/derivatives.h"
#include "bentaxis/hydraulics/sensitivity.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/efficiency.h"
#include "derivatives.h"
#include "statistic_rates.h"

namespace bentaxis::designs {
namespace {

// Rates of what the closed form takes from a case, along one of its parameters.
struct Rates {
  PumpParameters pump;
  double speed = 0;  // rad/s
  PortPressures ports;
  double transition_deg = 0, delivery_start_deg = 0;
};

// Every number of a case as 0: conversions of units are linear, so what a variable that is put to 1
// makes of it are rates.
Case no_rates(const Case& base) {
  Case rates = base;
  rates.pump = analytic::no_rates(base.pump);
  rates.operation.speed_rpm = 0;
  rates.pressure.ports = {};
  rates.pressure.transition_deg = rates.pressure.delivery_start_deg = 0;
  return rates;
}

bool is_of_closed_form(const Variable& variable, const Case& base) {
  const auto differentiable = variable.parameter().differentiable;
  return differentiable != nullptr && differentiable(base);
}

bool is_exact(const Variable& variable, const Case& base) {
  if (base.pump.gear.contact == ToothContact::teeth) return false;
  // Where psi differs from theta the chambers' pressures follow the block.
  if (!base.pump.transfer.is_even()) return false;
  // A spline through points of a computed curve is another curve.
  if (base.pressure.kind == PressureKind::hydraulic) return base.pressure.points == 0;
  return is_of_closed_form(variable, base);
}

bool is_statistic(const Output& output, const ChannelLayout& layout) {
  return output.source == Source::curve && output.columns.back() < layout.reactions();
}

// Made of means over a turn of the oil, and of the drive torque.
bool is_of_means(const Output& output, const study::PreparedCase& ready) {
  if (!ready.hydraulics) return false;
  if (output.source == Source::efficiency) return true;
  if (output.source != Source::hydraulics) return false;
  const auto lines = hydraulics::lines(*ready.hydraulics);
  return std::any_of(lines.begin(), lines.end(),
                     [&](const auto& line) { return line.mean && line.key == output.item; });
}

Rates rates_of(const Variable& variable, const Case& base) {
  Case rates = no_rates(base);
  variable.put(rates, 1);
  return {rates.pump, rad_per_second(rates.operation.speed_rpm), rates.pressure.ports,
          rates.pressure.transition_deg, rates.pressure.delivery_start_deg};
}

// Ideal pressure of a chamber and its rates: the share of the way from suction to delivery is
// t^2 (3 - 2 t) of the share t of a transition.
class IdealPressure {
 public:
  explicit IdealPressure(const PressureSpec& spec) : spec_(spec), share_(shares(spec)) {}

  double rate(double theta_k_deg, const Rates& along) const {
    const double share = share_(theta_k_deg);
    const double width = spec_.transition_deg;
    double slope = 0;
    if (width > 0) {
      for (const double edge : {0.0, 180.0}) {
        const double past = wrap_degrees(theta_k_deg - spec_.delivery_start_deg - edge + 180) - 180;
        if (std::abs(past) > width / 2) continue;
        const double t = past / width + 0.5;
        const double t_rate =
            (-along.delivery_start_deg - past / width * along.transition_deg) / width;
        slope += (edge == 0 ? 6 : -6) * t * (1 - t) * t_rate;
      }
    }
    return along.ports.suction + (along.ports.delivery - along.ports.suction) * share +
           (spec_.ports.delivery - spec_.ports.suction) * slope;
  }

 private:
  static PressureTrace shares(PressureSpec spec) {
    spec.kind = PressureKind::ideal;
    spec.ports = {0, 1};
    return PressureTrace(spec);
  }
  const PressureSpec& spec_;
  PressureTrace share_;
};

// ---- Hydraulic pressure

// Of a parameter, between the cases by which the equations are differentiated: truncation of its
// square and round-off of 1e-16 / kApart.
constexpr double kApart = 1e-6;
// Errors per step of the sensitivities, of d(ln P) per relative change: of the result, and of what
// it is compared with.
constexpr double kFine = 1e-9, kCoarse = 1e-8;

double size_of(double value) { return value == 0 ? 1 : std::abs(value); }

// None where one of them is refused; but of what the closed form takes, and the oil hardly does,
// the other side alone will do.
std::optional<hydraulics::Neighbours> neighbours(const Variable& variable, const Case& base) {
  const Family family(base, {variable});
  const double at = variable.value(base), size = size_of(at);
  hydraulics::Neighbours two{base, base, 0};
  const auto go = [&](Case& to, double way) {
    const double there = at + way * kApart * size;
    try {
      family.make({&there, 1}, to);
      two.apart += std::abs(there - at) / size;
      return true;
    } catch (const InputError&) {
      to = base;
      return false;
    }
  };
  const int sides = static_cast<int>(go(two.above, 1)) + static_cast<int>(go(two.below, -1));
  if (sides == 2 || (sides == 1 && is_of_closed_form(variable, base))) return two;
  return {};
}

// Samples of a case with its pressure, and how that changes with some variables.
struct TurnWithRates {
  Case the_case;
  Samples samples;
  std::vector<hydraulics::PressureRates> fine, coarse;  // of hydraulic pressure
  // Of each variable, where they are wanted: the cases beside it, and the means of `fine` and
  // `coarse` there.
  std::vector<hydraulics::Neighbours> beside;
  std::vector<hydraulics::NeighbourMeans> fine_means, coarse_means;
};

struct Wanted {
  bool errors = false;  // under hydraulic pressure every direction once more, with coarse rates
  bool means = false;   // of the oil
  std::optional<std::vector<double>> theta_deg = {};  // instead of the case's samples
};

// Takes from `variables` those that the hydraulic pressure has no derivatives by.
TurnWithRates turn_of(const study::PreparedCase& ready, const Case& base,
                      const std::vector<Variable>& all, const Wanted& wanted,
                      std::vector<std::size_t>& variables, const study::PartProgress& progress_of) {
  const auto samples = [&] {
    return wanted.theta_deg ? sample_angles(ready.the_case, ready.pressure, *wanted.theta_deg)
                            : ready.samples(study::Way::driven);
  };
  TurnWithRates turn{ready.the_case, samples(), {}, {}, {}, {}, {}};
  if (!ready.hydraulics) return turn;
  std::vector<hydraulics::Neighbours> parameters;
  std::vector<std::size_t> kept;
  for (const std::size_t v : variables) {
    auto two = neighbours(all[v], base);
    if (!two || !hydraulics::has_rates(*ready.hydraulics, *two)) continue;
    parameters.push_back(std::move(*two));
    kept.push_back(v);
  }
  variables = kept;
  const int n = base.pump.geometry.pistons;
  std::vector<double> angles;
  for (const double theta : turn.samples.theta_deg)
    for (int k = 1; k <= n; ++k) angles.push_back(piston_angle_deg(theta, k, n));
  const auto rates = [&](double tolerance, std::vector<hydraulics::NeighbourMeans>& means) {
    auto found = hydraulics::pressure_rates(*ready.hydraulics, parameters, angles, tolerance,
                                            progress_of("derivatives of the pressure"),
                                            wanted.means ? &means : nullptr);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double size = size_of(all[variables[i]].value(base));
      for (double& rate : found[i].chamber) rate /= size;
      found[i].delivery_mean /= size;
    }
    return found;
  };
  try {
    if (wanted.errors) turn.fine = rates(kFine, turn.fine_means);
    turn.coarse = rates(kCoarse, turn.coarse_means);
  } catch (const ComputationError&) {
    variables.clear();  // differences may get through
  }
  if (!wanted.errors) turn.fine = turn.coarse;
  turn.beside = std::move(parameters);
  return turn;
}

// Whether the mean delivery pressure is a result.
bool load_sets_pressure(const Case& base) {
  return base.pressure.kind == PressureKind::hydraulic && base.hydraulics->load &&
         base.hydraulics->load->sets_pressure() && base.pressure.ports.delivery > 0;
}

// Reactions over a driven turn with their exact derivatives by those of some variables that have
// them.
class TurnDerivatives {
 public:
  TurnDerivatives(const study::PreparedCase& ready, const Case& base,
                  const std::vector<Variable>& all, std::vector<std::size_t> variables,
                  const Wanted& wanted, const study::PartProgress& progress_of)
      : base_(base),
        variables_(std::move(variables)),
        turn_(turn_of(ready, base, all, wanted, variables_, progress_of)),
        hydraulic_(turn_.the_case.pressure.kind == PressureKind::hydraulic) {
    const std::size_t directions = (hydraulic_ && wanted.errors ? 2 : 1) * variables_.size();
    for (std::size_t d = 0; d < directions; ++d)
      rates_.push_back(rates_of(all[variables_[d % variables_.size()]], base));
  }

  const std::vector<std::size_t>& variables() const { return variables_; }
  bool hydraulic() const { return hydraulic_; }
  std::size_t directions() const { return rates_.size(); }

  // Values of something that is made of means, a little above and below a direction's variable,
  // over what these are apart in it.
  // @param of           what it is: of a case with the means of its oil, and of the mean torque
  // @param torque_rate  of the mean torque along the direction
  template <class Of>
  double of_means(std::size_t d, const Variable& variable, double torque, double torque_rate,
                  const Of& of) const {
    const std::size_t v = d % variables_.size();
    const hydraulics::Neighbours& beside = turn_.beside[v];
    const hydraulics::NeighbourMeans& means =
        (d < variables_.size() ? turn_.fine_means : turn_.coarse_means)[v];
    const double apart = beside.apart * size_of(variable.value(base_));
    const auto at = [&](const Case& there, const hydraulics::SteadyState& state,
                        const hydraulics::PowerBudget& power, double way) {
      study::PreparedCase ready;
      ready.the_case = there;
      ready.hydraulics = state;
      return of(ready, hydraulics::pump_power(power), torque + way * apart / 2 * torque_rate);
    };
    return (at(beside.above, means.above, means.power_above, 1) -
            at(beside.below, means.below, means.power_below, -1)) /
           apart;
  }

  // Calls visit(row, values, derivatives), derivatives as of DerivativeModel.
  template <class Visit>
  void for_each_row(const Visit& visit) const {
    const Case& prepared = turn_.the_case;
    const std::size_t count = variables_.size(), directions = rates_.size();
    std::vector<PumpParameters> pumps;
    pumps.reserve(directions);
    for (const Rates& rates : rates_) pumps.push_back(rates.pump);
    const analytic::DerivativeModel model(prepared.pump, prepared.analytic, pumps);
    const std::size_t reactions = model.layout().reactions();
    const auto n = static_cast<std::size_t>(model.layout().pistons());
    const IdealPressure ideal(base_.pressure);
    const auto of_pressure = [&](std::size_t d) -> const hydraulics::PressureRates& {
      return d < count ? turn_.fine[d] : turn_.coarse[d - count];
    };
    Instant instant;
    std::vector<Instant> along(directions);
    for (std::size_t d = 0; d < directions; ++d) {
      along[d].turn(0, rates_[d].speed);
      along[d].ports = rates_[d].ports;
      if (load_sets_pressure(base_)) along[d].ports.delivery = of_pressure(d).delivery_mean;
      if (prepared.pressure.kind != PressureKind::curve) along[d].chamber_pressure.resize(n);
    }
    const auto chamber_rate = [&](std::size_t d, std::size_t row, std::size_t k) {
      if (hydraulic_) return of_pressure(d).chamber[row * n + k];
      return ideal.rate(piston_angle_deg(turn_.samples.theta_deg[row], static_cast<int>(k) + 1,
                                         static_cast<int>(n)),
                        rates_[d]);
    };
    std::vector<double> values(reactions), derivatives(reactions * directions);
    for (std::size_t row = 0; row < turn_.samples.theta_deg.size(); ++row) {
      turn_.samples.instant(row, instant);
      for (std::size_t d = 0; d < directions; ++d)
        for (std::size_t k = 0; k < along[d].chamber_pressure.size(); ++k)
          along[d].chamber_pressure[k] = chamber_rate(d, row, k);
      model.reactions(instant, along, values, derivatives);
      visit(row, values, derivatives);
    }
  }

 private:
  const Case& base_;
  std::vector<std::size_t> variables_;
  TurnWithRates turn_;
  bool hydraulic_;
  std::vector<Rates> rates_;
};

// What an output that is made of means is.
double value_of_means(const Output& output, const study::PreparedCase& ready,
                      const hydraulics::PumpPower& power, double torque) {
  if (output.source == Source::efficiency) {
    const study::Efficiencies all = study::efficiencies(ready, power, torque);
    for (const study::EfficiencyLine& line : study::efficiency_lines())
      if (output.item == line.key) return all.*line.value;
  }
  for (const hydraulics::Line& line : hydraulics::lines(*ready.hydraulics))
    if (output.item == line.key) return line.value;
  return not_computed();
}

// @return the variables for which it could be done
std::vector<std::size_t> find_exact(Sensitivities& s, const study::PreparedCase& ready,
                                    const std::vector<std::size_t>& outputs,
                                    std::vector<std::size_t> wanted,
                                    const study::PartProgress& progress_of) {
  const auto of_means = [&](std::size_t o) { return is_of_means(s.outputs[o], ready); };
  const bool means = std::any_of(outputs.begin(), outputs.end(), of_means);
  const TurnDerivatives turn(ready, s.base, s.variables, std::move(wanted), {true, means},
                             progress_of);
  const std::vector<std::size_t>& variables = turn.variables();
  if (variables.empty()) return variables;
  std::vector<StatisticRates> statistics;
  std::vector<std::size_t> of_statistic;
  for (const std::size_t o : outputs) {
    if (of_means(o)) continue;
    of_statistic.push_back(o);
    statistics.emplace_back(s.outputs[o], s.scales[o], turn.directions());
  }
  const ChannelLayout layout(s.base.pump);
  const std::size_t reactions = layout.reactions(), td = layout.Td();
  double torque = 0, rows = 0;
  std::vector<double> torque_rates(turn.directions());
  turn.for_each_row([&](std::size_t, const auto& values, const auto& derivatives) {
    for (StatisticRates& statistic : statistics) statistic.add(values, derivatives, reactions);
    torque += values[td];
    for (std::size_t d = 0; d < torque_rates.size(); ++d)
      torque_rates[d] += derivatives[d * reactions + td];
    ++rows;
  });
  const std::size_t count = variables.size();
  // @param of  the derivative along a direction
  const auto keep = [&](std::size_t o, const auto& of) {
    for (std::size_t d = 0; d < count; ++d) {
      Derivative& found = s.derivatives[o][variables[d]];
      found = of(d);
      if (!turn.hydraulic()) continue;
      found.way = Way::forward;
      found.error += std::abs(of(count + d).value - found.value);
    }
  };
  for (std::size_t i = 0; i < of_statistic.size(); ++i)
    keep(of_statistic[i], [&](std::size_t d) { return statistics[i].derivative(d); });
  for (const std::size_t o : outputs) {
    if (!of_means(o)) continue;
    keep(o, [&](std::size_t d) {
      const Variable& variable = s.variables[variables[d % count]];
      return Derivative{turn.of_means(
          d, variable, torque / rows, torque_rates[d] / rows,
          [&](const auto&... made) { return value_of_means(s.outputs[o], made...); })};
    });
  }
  return variables;
}

}  // namespace

Pairs find_exact(Sensitivities& s, const study::PartProgress& progress_of) {
  Pairs found;
  if (s.model != study::Model::analytic) return found;
  found.variables =
      numbers(s.variables.size(), [&](std::size_t v) { return is_exact(s.variables[v], s.base); });
  if (found.variables.empty()) return found;
  const study::PreparedCase ready = study::prepare(s.base, progress_of);
  const ChannelLayout layout(s.base.pump);
  found.outputs = numbers(s.outputs.size(), [&](std::size_t o) {
    return is_computed(s.values[o]) &&
           (is_statistic(s.outputs[o], layout) || is_of_means(s.outputs[o], ready));
  });
  if (!found.outputs.empty())
    found.variables = find_exact(s, ready, found.outputs, std::move(found.variables), progress_of);
  return found;
}

std::vector<Variable> differentiate_reactions(const Case& base, const ReactionVisitor& visit,
                                              const study::PartProgress& progress_of,
                                              const std::optional<std::vector<double>>& theta_deg) {
  const std::vector<Variable> all = continuous_variables(base);
  const TurnDerivatives turn(
      study::prepare(base, progress_of), base, all,
      numbers(all.size(), [&](std::size_t v) { return is_exact(all[v], base); }),
      {.theta_deg = theta_deg}, progress_of);
  std::vector<Variable> found;
  for (const std::size_t v : turn.variables()) found.push_back(all[v]);
  if (!found.empty()) turn.for_each_row(visit);
  return found;
}

}  // namespace bentaxis::designs
