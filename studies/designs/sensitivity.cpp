#include "bentaxis/designs/sensitivity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bentaxis/analytic/derivatives.h"
#include "bentaxis/compare/difference.h"
#include "bentaxis/designs/evaluator.h"
#include "bentaxis/hydraulics/sensitivity.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/full_key.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/efficiency.h"
#include "bentaxis/study/piece_progress.h"

namespace bentaxis::designs {
namespace {

// ---- Exact derivatives

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

// Samples this near to the largest, of the output's scale, attain it as well.
constexpr double kTie = 1e-12;

// The largest of some values, with its derivative: on either side that of whichever of those that
// attain it then grows most.
class LargestRate {
 public:
  explicit LargestRate(std::size_t directions) : least_(directions), most_(directions) {}

  template <class Rate>
  void add(double value, double tie, const Rate& rate) {
    if (value < largest_ - tie) return;
    const bool alone = value > largest_ + tie;
    for (std::size_t d = 0; d < least_.size(); ++d) {
      least_[d] = alone ? rate(d) : std::min(least_[d], rate(d));
      most_[d] = alone ? rate(d) : std::max(most_[d], rate(d));
    }
    largest_ = std::max(largest_, value);
  }
  // The mean of both sides, and by how much each differs from it.
  Derivative rate(std::size_t d) const {
    return {(least_[d] + most_[d]) / 2, (most_[d] - least_[d]) / 2};
  }

 private:
  double largest_ = -std::numeric_limits<double>::infinity();
  std::vector<double> least_, most_;  // one per direction
};

// Statistics of one output with their derivatives, sample by sample.
class StatisticRates {
 public:
  StatisticRates(const Output& output, double scale, std::size_t directions)
      : output_(output),
        tie_(kTie * scale),
        sum_(directions),
        squares_(directions),
        kinks_(directions),
        slopes_(directions),
        low_(directions),
        high_(directions),
        peak_(directions) {}

  // `derivatives` as of DerivativeModel, of `reactions` each.
  void add(const std::vector<double>& values, const std::vector<double>& derivatives,
           std::size_t reactions) {
    double squares = 0;
    for (const std::size_t c : output_.columns) squares += values[c] * values[c];
    const bool vector = output_.columns.size() > 1;
    const double value = vector ? std::sqrt(squares) : values[output_.columns.front()];
    const auto rate = [&](std::size_t d) {
      const double* const row = &derivatives[d * reactions];
      if (!vector) return row[output_.columns.front()];
      double product = 0;
      for (const std::size_t c : output_.columns) product += values[c] * row[c];
      return value > 0 ? product / value : 0;
    };
    // A magnitude that is 0 grows by this on both sides.
    const bool zero = std::abs(value) <= tie_;
    const auto slope = [&](std::size_t d) {
      double square = 0;
      for (const std::size_t c : output_.columns)
        square += derivatives[d * reactions + c] * derivatives[d * reactions + c];
      return std::sqrt(square);
    };
    for (const double side : {-1.0, 1.0}) {
      const auto magnitude = [&](std::size_t d) {
        return zero ? side * slope(d) : (value < 0 ? -1 : 1) * rate(d);
      };
      peak_.add(std::abs(value), tie_, magnitude);
      const auto own = [&](std::size_t d) { return vector ? magnitude(d) : rate(d); };
      high_.add(value, tie_, own);
      low_.add(-value, tie_, [&](std::size_t d) { return -own(d); });
    }
    mean_square_ += value * value;
    ++count_;
    for (std::size_t d = 0; d < sum_.size(); ++d) {
      const double r = vector && zero ? 0 : rate(d);
      sum_[d] += r;
      squares_[d] += value * r;
      if (!zero) continue;
      if (vector) kinks_[d] += slope(d);
      slopes_[d] += slope(d) * slope(d);
    }
    all_zero_ &= zero;
  }

  Derivative derivative(std::size_t d) const {
    const Derivative low = low_.rate(d);
    Derivative high = high_.rate(d);
    switch (output_.statistic) {
      case Statistic::mean:
        return {sum_[d] / count_, kinks_[d] / count_};
      case Statistic::min:
        return {-low.value, low.error};
      case Statistic::max:
        return high;
      case Statistic::peak:
        return peak_.rate(d);
      case Statistic::rms:
        if (all_zero_) return {0, std::sqrt(slopes_[d] / count_)};
        return {squares_[d] / std::sqrt(mean_square_ * count_)};
      case Statistic::range:
        break;
    }
    return {high.value + low.value, high.error + low.error};
  }

 private:
  const Output& output_;
  double tie_, count_ = 0, mean_square_ = 0;
  bool all_zero_ = true;
  std::vector<double> sum_, squares_;   // one per direction
  std::vector<double> kinks_, slopes_;  // of samples where it is 0: sum of slopes, of their squares
  LargestRate low_, high_, peak_;       // of what is lowest the negative
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

// ---- Differences

// Of the parameter: short, so that another sample seldom becomes the largest and friction at a dead
// centre is followed through its change of sign; longer where the
// pressure is found by a search that ends at 1e-9 or so.
constexpr double kFirstStep = 1e-4, kFirstStepOfSearch = 0.02;
constexpr double kStepOfZero = 0.01;  // in the file's unit
constexpr int kMaxShorter = 8;        // times a first step that leads nowhere is halved
// Halvings: where an evaluation is quick, and where it is a search or takes Simbody.
constexpr int kLevels = 8, kSlowLevels = 5;

// Where an evaluation gives no value of an output, or not twice.
constexpr const char* kNoDifferences = "no differences could be formed";

// The first step from which all of both sides is inside of the range; 0 where there is none.
double first_step(const Variable& variable, const Case& base, double at) {
  const NumberRange range = variable.range(base);
  const bool search = base.pressure.kind == PressureKind::hydraulic;
  double step = at == 0 ? kStepOfZero : (search ? kFirstStepOfSearch : kFirstStep) * std::abs(at);
  const double room = std::min(at - range.low, range.high - at);
  if (step >= room) step = room / 2;
  return step > 1e-9 * std::abs(at) && step > 0 ? step : 0;
}

// C. J. F. Ridders, Advances in Engineering Software 4 (1982) 75: central differences of falling
// steps in Neville's scheme; the entry that its neighbours confirm best. Of a function that is not
// smooth (the largest of some samples) an entry may be confirmed by chance: shorter steps must come
// to it too.
class Ridders {
 public:
  // The difference of one step more, half as long as the last. @return false: no use to go on
  bool add(double difference) {
    differences_.push_back(difference);
    std::vector<double> row = {difference};
    double factor = 1;
    for (std::size_t j = 0; j < last_.size(); ++j) {
      factor *= 4;
      row.push_back((row[j] * factor - last_[j]) / (factor - 1));
      const double error = std::max(std::abs(row[j + 1] - row[j]), std::abs(row[j + 1] - last_[j]));
      if (error <= error_) {
        error_ = error;
        value_ = row[j + 1];
        level_ = differences_.size() - 1;
      }
    }
    const bool worse = last_.size() > 1 && std::abs(row.back() - last_.back()) > 2 * error_;
    last_ = std::move(row);
    return !worse;
  }
  double value() const { return value_; }
  double error() const {
    const std::size_t count = differences_.size();
    double error = error_;
    // By two steps alone, of those shorter than what the value rests on the nearest.
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = std::min(level_ + 1, count - 1); k < count && k > 0; ++k) {
      const double by_two = differences_[k] + (differences_[k] - differences_[k - 1]) / 3;
      nearest = std::min(nearest, std::abs(by_two - value_));
    }
    error = std::max(error, nearest);
    // Halving a step takes away three quarters of what is left, where a function is smooth.
    if (count < 3) return error;
    const double* const last = &differences_[count - 3];
    const double ratio = (last[0] - last[1]) / (last[1] - last[2]);
    if (ratio > 3 && ratio < 5) return error;
    const auto [low, high] = std::minmax_element(last, last + 3);
    return std::max(error, *high - *low);
  }

 private:
  std::vector<double> differences_, last_;
  double value_ = 0, error_ = std::numeric_limits<double>::infinity();
  std::size_t level_ = 0;  // of the shortest step in value_
};

// Of one variable alone: others stay as the case has them, or follow it where they do by default.
void find_by_differences(Sensitivities& s, std::size_t v, const std::vector<std::size_t>& outputs,
                         const Progress& progress) {
  const Evaluator evaluator(Family(s.base, {s.variables[v]}), s.outputs, s.model);
  std::string reason;
  const int levels = evaluator.fast() ? kLevels : kSlowLevels;
  int evaluations = 0;
  const auto values = [&](double x) {
    // Some more than the levels need, as a first step may be halved.
    if (progress) progress(std::min(1.0, evaluations++ / (2.0 * levels + 2)));
    Evaluation found = evaluator.evaluate({&x, 1});
    if (!found.feasible()) reason = found.reason;
    return found.values;
  };
  double step = first_step(s.variables[v], s.base, s.at[v]);
  if (step == 0) reason = "is at a bound of its range";
  for (int i = 0; step > 0; ++i, step /= 2) {
    reason.clear();
    values(s.at[v] + step);
    if (reason.empty()) values(s.at[v] - step);
    if (reason.empty() || i == kMaxShorter) break;
  }
  if (!reason.empty()) {
    for (const std::size_t o : outputs)
      s.derivatives[o][v] = {not_computed(), 0, Way::differences, reason};
    return;
  }
  const double first = step;
  std::vector<Ridders> tables(outputs.size());
  std::vector<bool> going(outputs.size(), true);
  for (int level = 0; level < levels; ++level, step /= 2) {
    const double above = s.at[v] + step, below = s.at[v] - step;
    const auto high = values(above), low = values(below);
    if (!reason.empty()) break;
    for (std::size_t i = 0; i < outputs.size(); ++i)
      if (going[i])
        going[i] = tables[i].add((high[outputs[i]] - low[outputs[i]]) / (above - below));
  }
  // Round-off of the output, over the longest step.
  constexpr double kRoundOff = 4 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const double noise = kRoundOff * s.scales[outputs[i]] / first;
    Derivative found = {tables[i].value(), tables[i].error() + noise, Way::differences};
    if (!std::isfinite(found.error)) found = {not_computed(), 0, Way::differences, kNoDifferences};
    s.derivatives[outputs[i]][v] = found;
  }
}

Sensitivities begin(const Case& base, const std::vector<Variable>& variables,
                    const std::vector<Output>& outputs, study::Model model) {
  Sensitivities s;
  s.base = base;
  s.model = model;
  s.variables = variables;
  s.outputs = outputs;
  for (const Variable& variable : variables) {
    if (variable.discrete())
      throw InputError(variable.name() + ": is not a continuous number: it has no derivative");
    s.at.push_back(variable.value(base));
  }
  std::vector<Output> all = outputs;
  for (Output output : outputs) {
    if (output.source == Source::curve || output.source == Source::budget)
      output.statistic = Statistic::peak;
    all.push_back(output);
  }
  const std::vector<double> found = Evaluator(Family(base, {}), all, model).outputs_at({});
  const auto half = found.begin() + static_cast<std::ptrdiff_t>(outputs.size());
  s.values.assign(found.begin(), half);
  s.scales.assign(half, found.end());
  for (double& scale : s.scales) scale = std::abs(scale);
  for (std::size_t o = 0; o < outputs.size(); ++o)
    s.derivatives.emplace_back(variables.size(), Derivative{not_computed()});
  return s;
}

// Of one variable or of several, those for which `wanted`.
template <class Wanted>
std::vector<std::size_t> numbers(std::size_t count, const Wanted& wanted) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < count; ++i)
    if (wanted(i)) list.push_back(i);
  return list;
}

}  // namespace

std::string to_string(Way way) {
  switch (way) {
    case Way::exact:
      return "exact";
    case Way::forward:
      return "forward sensitivities (CVODES)";
    case Way::differences:
      break;
  }
  return "differences";
}

double Sensitivities::elasticity(std::size_t output, std::size_t variable) const {
  if (at[variable] == 0 || values[output] == 0) return not_computed();
  return derivatives[output][variable].value * at[variable] / values[output];
}

std::vector<Variable> continuous_variables(const Case& base) {
  std::vector<Variable> variables;
  for (const Table& table : standard_registry().tables) {
    // What an integration in time starts and is driven by changes no driven turn.
    if (table.name == "drive" || table.name.starts_with("assumptions")) continue;
    for (const Parameter& p : table.parameters)
      for (const std::string& name : number_names(table, p)) try {
          variables.emplace_back(name, base);
        } catch (const InputError&) {
          continue;  // it does nothing in this case
        }
  }
  return variables;
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

Sensitivities sensitivities(const Case& base, const std::vector<Variable>& variables,
                            const std::vector<Output>& outputs, study::Model model,
                            const study::PartProgress& progress_of, bool keep_finished) {
  study::require_memory(base, study::Kept::table, study::Way::driven);
  Sensitivities s = begin(base, variables, outputs, model);
  const ChannelLayout layout(base.pump);
  std::vector<std::size_t> outputs_found, variables_found;
  if (model == study::Model::analytic)
    variables_found =
        numbers(variables.size(), [&](std::size_t v) { return is_exact(s.variables[v], base); });
  if (!variables_found.empty()) {
    const study::PreparedCase ready = study::prepare(base, progress_of);
    outputs_found = numbers(outputs.size(), [&](std::size_t o) {
      return is_computed(s.values[o]) &&
             (is_statistic(outputs[o], layout) || is_of_means(outputs[o], ready));
    });
    if (!outputs_found.empty())
      variables_found =
          find_exact(s, ready, outputs_found, std::move(variables_found), progress_of);
  }

  // Of the outputs that differences are needed of alone, so that these can be quick.
  std::vector<std::vector<std::size_t>> wanted;
  std::vector<std::size_t> by_differences;
  for (std::size_t v = 0; v < variables.size(); ++v) {
    wanted.push_back(numbers(outputs.size(), [&](std::size_t o) {
      return is_computed(s.values[o]) &&
             !(contains(outputs_found, o) && contains(variables_found, v));
    }));
    if (!wanted.back().empty()) by_differences.push_back(v);
  }
  if (by_differences.empty()) return s;
  const Progress progress = progress_of("derivatives");
  std::size_t done = 0;
  try {
    for (; done < by_differences.size(); ++done)
      find_by_differences(s, by_differences[done], wanted[by_differences[done]],
                          study::within(progress, done, by_differences.size()));
    if (progress) progress(1);
  } catch (const Interrupted&) {
    const bool exact = !outputs_found.empty() && !variables_found.empty();
    if (!keep_finished || done == by_differences.size() || (done == 0 && !exact)) throw;
    for (; done < by_differences.size(); ++done) {
      const std::size_t v = by_differences[done];
      s.left_out.push_back(variables[v].name());
      for (const std::size_t o : wanted[v])
        s.derivatives[o][v] = {not_computed(), 0, Way::differences, "not computed: interrupted"};
    }
  }
  return s;
}

SensitivityCheck compare_derivatives(const Sensitivities& found, Sensitivities other) {
  SensitivityCheck result{std::move(other), {}};
  result.differences.assign(found.outputs.size(), std::vector<double>(found.variables.size()));
  for (std::size_t v = 0; v < found.variables.size(); ++v)
    for (std::size_t o = 0; o < found.outputs.size(); ++o) {
      const double size = found.at[v] == 0 ? 1 : std::abs(found.at[v]);
      const double over_scale = size / (found.scales[o] > 0 ? found.scales[o] : 1);
      const Derivative &one = found.derivatives[o][v], &two = result.other.derivatives[o][v];
      const compare::Difference apart = compare::difference(one.value, two.value, 1);
      const double difference = result.differences[o][v] = apart.share() * over_scale;
      const Derivative& missing = is_computed(one.value) ? two : one;
      const bool refused = !missing.reason.empty() && missing.reason != kNoDifferences;
      if (apart.known() ? (one.error + two.error) * over_scale > SensitivityCheck::kTolerance
                        : apart.comparable == compare::Comparable::both_missing || refused) {
        ++result.missing;
      } else if (!apart.known()) {
        ++result.lacking;
      } else {
        ++result.compared;
        if (difference > result.worst) {
          result.worst = difference;
          result.output = o;
          result.variable = v;
        }
      }
    }
  return result;
}

SensitivityCheck check(const Sensitivities& found, const study::PartProgress& progress_of) {
  const study::Model model =
      found.model == study::Model::analytic ? study::Model::multibody : study::Model::analytic;
  Sensitivities other = begin(found.base, found.variables, found.outputs, model);
  const Progress progress = progress_of("derivatives of " + study::to_string(model));
  const auto all = numbers(found.outputs.size(), [](std::size_t) { return true; });
  for (std::size_t v = 0; v < found.variables.size(); ++v)
    find_by_differences(other, v, all, study::within(progress, v, found.variables.size()));
  if (progress) progress(1);
  return compare_derivatives(found, std::move(other));
}

}  // namespace bentaxis::designs
