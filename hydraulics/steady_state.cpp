#include "bentaxis/hydraulics/steady_state.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "bentaxis/hydraulics/accuracy_log.h"
#include "bentaxis/numerics/dense.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/stopwatch.h"
#include "integrator.h"
#include "network.h"
#include "period_map.h"
#include "timing_record.h"
#include "turn.h"

namespace bentaxis::hydraulics {
namespace {

using Vector = PeriodMap::Vector;
using Matrix = PeriodMap::Matrix;

// Of the first, coarse search, whose sensitivities the fine one goes on using.
constexpr double kCoarse = 1e-5;
constexpr int kSettlingPeriods = 3;
constexpr double kSharesInLoop[] = {0.7, 0.9, 0.5, 0.3};
// Change of ln P in a period up to which a pressure says what is about reachable.
constexpr double kNearlyPeriodic = 0.1;
// Of all effort that an integrator may spend, what tighter tolerances may take.
constexpr double kShareForRefinement = 0.05;
// The same of one search in another way, where the usual one finds nothing.
constexpr double kShareForOtherSearch = 0.05, kShareForNeighbour = 0.02;
// Of all of these together.
constexpr double kShareForOtherSearches = 0.25;
// What such searches change: the tolerance, and how far a neighbour is whose state they start from.
constexpr double kCoarsestOther = 1000;
constexpr double kOtherTolerances[] = {2, 0.5, 10, 0.1, 100, kCoarsestOther};
constexpr double kBeside[] = {0.99, 1.01};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Tolerances below this are round-off.
constexpr double kFinest = 3e-13;
// Of the allowed error of the curve, what its interpolation may take.
constexpr double kInterpolation = 0.1;
// What no longer falls is noise of the integration up to as many times the usual.
constexpr double kStalled = 3;
// Rows of a table: as many as the samples, or a multiple of them, within these.
constexpr int kFewestRows = 720, kMaxRows = 7200;

// Chambers as they come to stand at theta = 0 when half of them fill and half deliver.
// `share` is what of the ideal flow a load may take at first.
Vector first_guess(const Network& network, const std::optional<Start>& start, double share = 1) {
  const int n = network.pistons();
  const Fluid& fluid = network.fluid();
  const double flow = network.ideal_mass_flow();
  const double high = network.expected_log_pressure(share);
  auto states = network.uniform(high, start ? fluid.log_pressure(start->line) : high, flow);
  for (int k = 0; k < n; ++k) {
    const bool fills = k == 0 || 360.0 * k / n > 180;  // the chamber stands at -360 k/N
    if (start)
      states[k] = fluid.log_pressure(start->chambers);
    else if (fills)
      states[k] = network.suction_log_pressure();
  }
  if (network.backwards() && network.has_loop() && !start) network.exchange_sides(states.data());
  if (network.load_sought())
    states.push_back(std::log(start ? start->load_size : network.load_size_for(share * flow)));
  return Eigen::Map<const Vector>(states.data(), static_cast<Eigen::Index>(states.size()));
}

// The state that a period repeats, and the derivatives that keep it there.
struct Found {
  Vector z;
  Vector next;  // the last one corrected once more: stored energy returns more closely
  numerics::LinearSolver chord;
  int iterations = 0;
};

// A few periods as they come: then every chamber has met a port and forgotten its start.
void settle(const Network& network, PeriodMap& map, Vector& z, bool line_given) {
  for (int i = 0; i < kSettlingPeriods; ++i) {
    z.head(network.states()) += map.residual(z, kCoarse).head(network.states());
    const bool asked_for = !network.has_loop() || network.load_sought();
    if (!network.fixed_line() && !line_given && !network.backwards() && asked_for)
      z[network.pistons()] = network.delivery_log_pressure();
  }
}

Found find(const Network& network, PeriodMap& map, const Vector& guess, bool line_given,
           double tolerance, const std::function<void()>& alive) {
  Found found{guess, guess, {}, 0};
  settle(network, map, found.z, line_given);
  Matrix jacobian;
  search(map, found.z, std::max(kCoarse, tolerance), jacobian, found.iterations, alive);
  found.chord = numerics::LinearSolver(jacobian);
  return found;
}

// A closed loop has kinks where check valves shut: what is not found from one start is from
// another.
Found search_from(const Network& network, PeriodMap& map, const std::optional<Start>& start,
                  double tolerance, const std::function<void()>& alive) {
  if (network.has_loop() && !start)
    for (const double share : kSharesInLoop) {
      try {
        Found found =
            find(network, map, first_guess(network, start, share), false, tolerance, alive);
        const double coarse = std::max(kCoarse, tolerance);
        if (size_of(map.residual(found.z, coarse)) <= kStalled * map.noise() * coarse) return found;
      } catch (const ComputationError&) {
        // The next one.
      }
    }
  return find(network, map, first_guess(network, start), start.has_value(), tolerance, alive);
}

// Finer integrations change the answer little: the coarse derivatives serve on. Afterwards `states`
// holds the steps of a period from the found state, and `f` what is left at its end.
using States = std::vector<std::pair<double, std::vector<double>>>;
void refine(const Network& network, PeriodMap& map, double tolerance, Found& found, States& states,
            Vector& f, const std::function<void()>& alive) {
  double before = kInfinity;
  for (;; ++found.iterations) {
    if (alive) alive();
    states.clear();
    f = map.residual(found.z, tolerance, nullptr, nullptr, [&](const Integrator::Step& step) {
      const double* y = step.state(step.to);
      states.emplace_back(step.to, std::vector<double>(y, y + network.pressures()));
    });
    const double size = size_of(f);
    if (size <= map.noise() * tolerance) return;
    if (!(size < 0.5 * before)) {
      if (size > 0.9 * before && size <= kStalled * map.noise() * tolerance) return;
      // Slow: take the fine map's own derivatives.
      Matrix jacobian;
      search(map, found.z, tolerance, jacobian, found.iterations, alive);
      found.chord = numerics::LinearSolver(jacobian);
      f = map.residual(found.z, tolerance);
      if (size_of(f) > 100 * map.noise() * tolerance)
        throw ComputationError("hydraulics: no periodic state found: pressures still change by " +
                               number_text(size_of(f)) + " of themselves per period");
      return;
    }
    before = size;
    found.z -= found.chord.solve(f);
  }
}

// Where no state is found: whether the pump could reach the delivery pressure at all. Without flow
// through the ports the search gets slow at the end, so it is taken as it stands.
void refuse_what_is_out_of_reach(const Network& network, const Case& the_case,
                                 const std::function<void()>& alive) {
  Integrator integrator(network, alive);
  PeriodMap map(network, Sizing::closed, integrator);
  Vector z = first_guess(network, Start{0, 0, 1}).head(network.states());
  double largest = kInfinity, left = kInfinity;
  try {
    settle(network, map, z, true);
    Matrix jacobian;
    int iterations = 0;
    try {
      search(map, z, kCoarse, jacobian, iterations, alive);
    } catch (const ComputationError&) {
      // As far as it came.
    }
    left = size_of(map.residual(z, kCoarse));
    largest = map.mean_delivery();
  } catch (const ComputationError&) {
    return;  // then the first failure has to say it
  }
  if (left < kNearlyPeriodic && largest < network.delivery_pressure() * (1 - left))
    throw ComputationError(
        the_case.file.string() +
        ": [pressure] delivery_bar = " + number_text(network.delivery_pressure() / kPascalPerBar) +
        ": cannot be reached: with the load closed the mean delivery pressure is " +
        (left > map.noise() * kCoarse ? "about " : "") +
        number_text(std::round(10 * largest / kPascalPerBar) / 10) +
        " bar, and leakage, backflow and compression take all of the flow");
}

// Carries out one kind of search at a tolerance, with all that follows it.
using Attempt = std::function<Found(const std::function<Found(double)>& search_at, double)>;

// The state that a case a little beside this one repeats, coarsely.
std::optional<Vector> state_beside(const Case& beside, const std::function<void()>& alive) {
  try {
    const Network network(beside);
    Integrator integrator(network, alive);
    integrator.spend_at_most(kShareForNeighbour);
    PeriodMap map(network, Sizing::mean_pressure, integrator);
    return search_from(network, map, {}, kCoarse, alive).z;
  } catch (const ComputationError&) {
    return std::nullopt;
  } catch (const InputError&) {  // a load that takes more than the pump displaces there
    return std::nullopt;
  }
}

// Where the usual search fails. At a finer tolerance the integration may see what it stepped over;
// at a coarser one Newton's method passes over jumps of the map that are below it, and the error
// that the curve then has is stated as ever. A neighbour's state is a start close by.
// Of all that is found the first that is accurate enough is taken, else the most accurate.
std::optional<Found> search_otherwise(const Case& the_case, const Network& network, PeriodMap& map,
                                      Integrator& integrator, const std::function<void()>& alive,
                                      const Attempt& attempt, SteadyState& result) {
  struct Best {
    Found found;
    SteadyState state;
  };
  std::optional<Best> best;
  const double most = integrator.share_of_effort() + kShareForOtherSearches;
  // Whether what there is now is accurate enough.
  const auto tried = [&](const std::function<Found(double)>& search_at, double tolerance) {
    integrator.spend_at_most(std::min(integrator.share_of_effort() + kShareForOtherSearch, most));
    try {
      Found found = attempt(search_at, tolerance);
      if (!best || pressure_error(result) < pressure_error(best->state))
        best = Best{std::move(found), std::move(result)};
    } catch (const ComputationError&) {
      // The next one.
    }
    return best && is_accurate(the_case, best->state);
  };
  const auto taken = [&]() -> std::optional<Found> {
    if (!best) return std::nullopt;
    result = std::move(best->state);
    return std::move(best->found);
  };
  const double own = the_case.hydraulics->tolerance;
  if (most >= 1 + kShareForOtherSearches) return std::nullopt;  // the usual search spent it all
  for (const double factor : kOtherTolerances) {
    const double tolerance = own * factor;
    if (tolerance < kFinest || tolerance > kCoarse) continue;
    if (tried([&](double at) { return search_from(network, map, {}, at, alive); }, tolerance))
      return taken();
  }
  if (best) return taken();
  for (const double factor : kBeside)
    for (const bool speed : {false, true}) {
      if (integrator.share_of_effort() >= most) return taken();
      Case beside = the_case;
      double& moved = speed ? beside.operation.speed_rpm : beside.pressure.ports.delivery;
      if (moved == 0) continue;
      moved *= factor;
      const std::optional<Vector> guess = state_beside(beside, alive);
      if (!guess) continue;
      for (const double tolerance : {own, own * kCoarsestOther})
        if (tried([&](double at) { return find(network, map, *guess, true, at, alive); },
                  tolerance))
          return taken();
    }
  return taken();
}

// Which operating point it is, and what failed there.
std::string failure_text(const Case& the_case, const Network& network, const std::string& what) {
  if (network.load().kind() == LoadKind::flow && !network.fixed_line())
    return the_case.file.string() + ": [load] flow_l_per_min = " +
           number_text(the_case.hydraulics->load->flow / kLitrePerMinute) +
           ": no delivery pressure found at which the pump delivers it: " + what;
  return the_case.file.string() +
         ": [pressure] delivery_bar = " + number_text(network.delivery_pressure() / kPascalPerBar) +
         ", [operation] speed_rpm = " + number_text(the_case.operation.speed_rpm) + ": " + what;
}

int rows_of(const Case& the_case) {
  const int samples = the_case.operation.samples_per_revolution;
  if (the_case.pressure.points > 0) return the_case.pressure.points;
  if (samples > kMaxRows) return kMaxRows;
  return samples * ((kFewestRows + samples - 1) / samples);
}

void note_ends(const Case& the_case, const Network& network, Summary& s) {
  s.overshoot = s.chamber_greatest - s.delivery_mean;
  s.undershoot = the_case.pressure.ports.suction - s.chamber_least;
  for (const Bridge& bridge : bridges(network.suction(), network.delivery()))
    (bridge.both_open ? s.both_open_deg : s.both_closed_deg) += bridge.to_deg - bridge.from_deg;
}

// The state and the turn at one tolerance.
void solve(const Case& the_case, const Network& network, PeriodMap& map, double tolerance,
           Found& found, const std::function<void()>& alive, SteadyState& result) {
  States states;
  Vector f;
  refine(network, map, tolerance, found, states, f, alive);
  // Once more, finer: this is the result, and its difference from the last one its error.
  found.z -= found.chord.solve(f);
  const double finer = std::max(tolerance / 10, kFinest);
  TurnRecord turn(network, map.load_size(found.z), rows_of(the_case));
  TimingRecord timing(network, map.load_size(found.z));
  Integrals integrals;
  f = map.residual(found.z, finer, nullptr, &integrals, [&](const Integrator::Step& step) {
    turn.see(step);
    timing.see(step);
  });
  turn.finish();
  ComputedPressure curve = turn.curve(kInterpolation * the_case.hydraulics->curve_error);
  // What the state still moves by, and everything that an integration ten times coarser misses.
  const Vector left = found.chord.solve(f);
  found.next = found.z - left;
  double change = 0;
  for (int k = 0; k < network.pistons(); ++k)
    change = std::max(change, std::abs(left[k]) * network.fluid().state(found.z[k]).pressure);
  curve.error += change + turn.difference(states, curve);

  result.convergence.pieces = curve.log_pressure.pieces().size();
  result.convergence.residual = size_of(f);
  result.convergence.tolerance = finer;
  result.states = map.states(found.z);
  Summary& s = result.summary;
  s.load = network.load().kind();
  s.atmosphere = network.fluid().atmosphere();
  const bool has_size = !network.fixed_line() && network.load().kind() != LoadKind::flow;
  s.load_size = has_size ? map.load_size(found.z) : 0;
  s.delivery_mean = map.mean_delivery();
  turn.summarize(integrals, s);
  result.orders = turn.orders(kOrders);
  summarize(network, integrals, s);
  note_ends(the_case, network, s);
  result.timing = timing.timing(s.delivery_mean);
  result.computed = std::make_shared<ComputedPressure>(std::move(curve));
  PressureSpec as_computed;
  as_computed.kind = PressureKind::hydraulic;
  as_computed.computed = result.computed;
  result.table = turn.table(PressureTrace(as_computed));
  result.delivery = turn.delivery();
}

// The same, finer; false and nothing changed where that takes too long or is below round-off.
bool improve(const Case& the_case, const Network& network, PeriodMap& map, double tolerance,
             Found& found, const std::function<void()>& alive, SteadyState& result) {
  SteadyState finer;
  try {
    solve(the_case, network, map, tolerance, found, alive, finer);
  } catch (const ComputationError&) {
    return false;
  }
  if (finer.computed->error < result.computed->error) result = std::move(finer);
  return true;
}

// Sums f(angle, weight) over a turn, weights in degrees: Gauss points of each piece of the curve,
// cut to a degree at most.
template <typename F>
void over_pieces(const ComputedPressure& curve, const F& f) {
  using Rule = boost::math::quadrature::gauss<double, 5>;
  const auto& pieces = curve.log_pressure.pieces();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double from = pieces[i].from_deg;
    const double way = (i + 1 < pieces.size() ? pieces[i + 1].from_deg : 360) - from;
    const int cuts = static_cast<int>(std::ceil(way));
    const double half = way / cuts / 2;
    for (int cut = 0; cut < cuts; ++cut) {
      const double middle = from + (2 * cut + 1) * half;
      for (std::size_t j = 0; j < Rule::abscissa().size(); ++j) {
        const double off = Rule::abscissa()[j] * half, weight = Rule::weights()[j] * half;
        f(middle + off, weight);
        if (off != 0) f(middle - off, weight);
      }
    }
  }
}

double indicated_work(const Chamber& chamber, const ComputedPressure& curve) {
  double work = 0;
  over_pieces(curve, [&](double angle, double weight) {
    work -= weight * kRadPerDegree * curve.gauge(angle) * chamber.volume(radians(angle)).slope;
  });
  return work;
}

double largest_of_spline(const PressureCurve& points, const ComputedPressure& curve) {
  const PeriodicSpline spline(points.theta_deg, points.pressure);
  const auto& pieces = curve.log_pressure.pieces();
  double worst = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double to = i + 1 < pieces.size() ? pieces[i + 1].from_deg : 360;
    for (const double angle : {pieces[i].from_deg, (pieces[i].from_deg + to) / 2})
      worst = std::max(worst, std::abs(spline(angle) - curve.gauge(angle)));
  }
  return worst;
}

}  // namespace

SteadyState steady_state(const Case& the_case, const std::optional<Start>& start,
                         const Progress& progress) {
  const Stopwatch stopwatch;
  const auto equations = std::make_shared<const Network>(the_case);
  const Network& network = *equations;
  double fraction = 0;
  const auto alive = [&] {
    if (progress) progress(fraction = std::min(0.95, fraction + 0.001));
  };
  Integrator integrator(network, alive);
  PeriodMap map(network, Sizing::mean_pressure, integrator);
  SteadyState result;
  // The state by one kind of search, at the tolerance and, where the curve's error asks for it, at
  // finer ones.
  const Attempt attempt = [&](const std::function<Found(double)>& search_at, double tolerance) {
    Found found = search_at(tolerance);
    result = SteadyState();
    solve(the_case, network, map, tolerance, found, alive, result);
    integrator.spend_at_most(integrator.share_of_effort() + kShareForRefinement);
    const auto error = [&] { return result.computed->error / result.computed->peak; };
    for (double before = kInfinity; error() > the_case.hydraulics->curve_error &&
                                    error() < before / 2 && tolerance > kFinest;) {
      before = error();
      tolerance = std::max(tolerance / 10, kFinest);
      if (!improve(the_case, network, map, tolerance, found, alive, result)) break;
    }
    return found;
  };
  Found found;
  try {
    found = attempt([&](double at) { return search_from(network, map, start, at, alive); },
                    the_case.hydraulics->tolerance);
  } catch (const ComputationError& error) {
    if (network.load_sought()) refuse_what_is_out_of_reach(network, the_case, alive);
    std::optional<Found> again;
    if (!start)
      again = search_otherwise(the_case, network, map, integrator, alive, attempt, result);
    if (!again) throw ComputationError(failure_text(the_case, network, error.what()));
    found = std::move(*again);
  }
  if (network.load_sought() && !(result.summary.mass_flow > 0)) {
    refuse_what_is_out_of_reach(network, the_case, alive);
    throw ComputationError(
        failure_text(the_case, network, "hydraulics: no flow is left for the load"));
  }
  result.equations = equations;
  result.corrected_states = map.states(found.next);
  result.corrected_load_size = map.load_size(found.next);
  result.places = network.places();
  result.indicated_work = indicated_work(network.chamber(), *result.computed);
  result.chamber.theta_deg = result.table.theta_deg;
  for (const double angle : result.chamber.theta_deg)
    result.chamber.pressure.push_back(result.computed->gauge(angle));
  if (the_case.pressure.points > 0)
    result.spline_error = largest_of_spline(result.chamber, *result.computed);
  result.convergence.iterations = found.iterations;
  result.convergence.steps = integrator.work().steps;
  result.convergence.evaluations = integrator.work().evaluations;
  result.convergence.seconds = stopwatch.seconds();
  result.table.provenance.seconds = result.convergence.seconds;
  if (!is_accurate(the_case, result)) AccuracyLog::note(the_case, result);
  if (progress) progress(1);
  return result;
}

double pressure_error(const SteadyState& state) {
  return state.computed ? state.computed->error / state.computed->peak : not_computed();
}

bool is_accurate(const Case& the_case, const SteadyState& state) {
  return !(pressure_error(state) > the_case.hydraulics->curve_error);
}

ResultTable transient_from_rest(const Case& the_case, double load_size, int revolutions,
                                int samples, const Progress& progress) {
  const Network network(the_case);
  Integrator integrator(network);
  const PeriodMap map(network, Sizing::mean_pressure, integrator);
  const int n = network.pistons();
  std::vector<double> y = network.uniform(network.suction_log_pressure(), 0, 0);
  ResultTable table;
  table.name = "transient";
  table.channels = pressure_channels();
  const Fluid& fluid = network.fluid();
  int chamber = 0;  // which of the relabelled chambers is chamber 1
  const long long periods = static_cast<long long>(revolutions) * n;
  for (long long period = 0; period < periods; ++period) {
    int next = 0;
    y = map.relabelled(integrator.over_period(
        y, load_size, the_case.hydraulics->tolerance, nullptr, nullptr,
        [&](const Integrator::Step& step) {
          for (; next < samples; ++next) {
            const double x = network.period_deg() * next / samples;
            if (x > step.to) break;
            const double* state = step.state(x);
            table.theta_deg.push_back((network.backwards() ? -1 : 1) *
                                      (static_cast<double>(period) * network.period_deg() + x));
            table.values.push_back(fluid.gauge(state[chamber]) / kPascalPerBar);
            table.values.push_back(network.delivery_gauge(state) / kPascalPerBar);
          }
        }));
    chamber = network.next_of(chamber);
    if (progress) progress(static_cast<double>(period + 1) / static_cast<double>(periods));
  }
  return table;
}

std::vector<double> orders_of_rate(const ComputedPressure& chamber, int count) {
  std::vector<std::complex<double>> sums(count);
  over_pieces(chamber, [&](double angle, double weight) {
    const double value = weight * chamber.gauge(angle) / 180;
    for (int i = 0; i < count; ++i) sums[i] += std::polar(value, -radians((i + 1) * angle));
  });
  std::vector<double> amplitudes(count);
  for (int i = 0; i < count; ++i) amplitudes[i] = (i + 1) * std::abs(sums[i]);
  return amplitudes;
}

PowerBudget power_by_place(const SteadyState& state, const Progress& progress) {
  const Network& network = *state.equations;
  Integrator integrator(network, [&] {
    if (progress) progress(0.5);
  });
  PowerBudget energy;
  integrator.over_period(state.corrected_states, state.corrected_load_size,
                         state.convergence.tolerance, nullptr, nullptr, {}, &energy);
  for (int i = 0; i < kPlaces; ++i)
    energy[static_cast<Place>(i)] /= network.period_deg() * network.seconds_per_degree();
  if (progress) progress(1);
  return energy;
}

double density(const SteadyState& state, double gauge) {
  return state.equations->fluid().density(gauge);
}

double effective_bulk_modulus(const SteadyState& state, double gauge) {
  return state.equations->fluid().effective_bulk_modulus(gauge);
}

void give_to(Case& the_case, const SteadyState& state) {
  the_case.pressure.computed = state.computed;
  if (the_case.pressure.points > 0) the_case.pressure.curve = state.chamber;
  const auto& load = the_case.hydraulics->load;
  if (load && load->sets_pressure() && the_case.pressure.ports.delivery > 0)
    the_case.pressure.ports.delivery = state.summary.delivery_mean;
}

namespace {

Line load_line(const Summary& s) {
  switch (s.load) {
    case LoadKind::laminar:
      return {"load, laminar conductance", s.load_size * kPascalPerBar / kLitrePerMinute,
              "l/min/bar", "load_l_per_min_per_bar"};
    case LoadKind::relief_valve:
      return {"load, relief valve's cracking pressure",
              (s.load_size - s.atmosphere) / kPascalPerBar, "bar", "load_cracking_bar"};
    case LoadKind::constant_pressure:
      return {"load, constant pressure", s.delivery_mean / kPascalPerBar, "bar", "load_bar"};
    case LoadKind::flow:
      return {"load, given flow", s.flow / kLitrePerMinute, "l/min", "load_l_per_min"};
    case LoadKind::orifice:
      break;
  }
  return {"load orifice", s.load_size * 1e6, "mm2", "load_mm2"};
}

}  // namespace

std::vector<Line> lines(const SteadyState& state) {
  const Summary& s = state.summary;
  const double bar = kPascalPerBar;
  return {
      {"displacement", s.displacement * 1e6, "cm3/rev", "displacement_cm3", true},
      {"density of all volume flows, that in the suction port", s.density, "kg/m3",
       "density_kg_per_m3", true},
      {"ideal flow, displacement x speed", s.ideal_flow / kLitrePerMinute, "l/min",
       "ideal_flow_l_per_min", true},
      {"mean flow to the load", s.flow / kLitrePerMinute, "l/min", "flow_l_per_min", true},
      {"mean mass flow to the load", s.mass_flow, "kg/s", "mass_flow_kg_per_s", true},
      {s.motors() ? "volumetric efficiency as a motor, ideal flow over the flow taken"
                  : "volumetric efficiency, mean flow to the load over ideal flow",
       100 * s.volumetric_efficiency, "%", "volumetric_efficiency_percent", true},
      {"leakage", s.leakage / kLitrePerMinute, "l/min", "leakage_l_per_min", true},
      {"mean delivery pressure", s.delivery_mean / bar, "bar", "delivery_mean_bar", true},
      {"delivery pressure, minimum", s.delivery_least / bar, "bar", "delivery_least_bar"},
      {"delivery pressure, maximum", s.delivery_greatest / bar, "bar", "delivery_greatest_bar"},
      {"delivery pressure ripple, peak to peak", (s.delivery_greatest - s.delivery_least) / bar,
       "bar", "delivery_ripple_bar"},
      {"ripple of the flow to the load, peak to peak", 100 * s.flow_ripple, "% of mean",
       "flow_ripple_percent"},
      {"ripple of the flow through the delivery port, peak to peak", 100 * s.port_flow_ripple,
       "% of mean", "port_flow_ripple_percent"},
      {"chamber pressure, maximum", s.chamber_greatest / bar, "bar", "chamber_greatest_bar"},
      {"angle of the maximum", s.chamber_greatest_deg, "deg", "chamber_greatest_deg"},
      {"overshoot over mean delivery pressure", s.overshoot / bar, "bar", "overshoot_bar"},
      {"chamber pressure, minimum", s.chamber_least / bar, "bar", "chamber_least_bar"},
      {"angle of the minimum", s.chamber_least_deg, "deg", "chamber_least_deg"},
      {"undershoot under suction pressure", s.undershoot / bar, "bar", "undershoot_bar"},
      {"work of the pistons per turn", s.work, "J", "work_J", true},
      {"mean torque of that work", s.work / (2 * kPi), "Nm", "work_torque_Nm", true},
      {"mass in minus mass out, over mass in", (s.mass_in - s.mass_out) / s.mass_in, "",
       "mass_balance"},
      load_line(s),
      {"both ports open to a chamber (negative overlap)", s.both_open_deg, "deg per turn",
       "both_open_deg"},
      {"both ports closed (positive overlap)", s.both_closed_deg, "deg per turn",
       "both_closed_deg"},
      {"filling at the end of suction, mass in the chamber over that of oil at suction pressure",
       state.timing.filled ? 100 * state.timing.filled->ratio : not_computed(), "%",
       "filling_percent"},
      {"loss of volumetric efficiency by incomplete filling",
       state.timing.filled ? 100 * state.timing.filled->loss : not_computed(), "%",
       "filling_loss_percent"},
      {"chamber below saturation pressure: air comes out", s.below_saturation_deg, "deg per turn",
       "below_saturation_deg"},
      {"chamber below vapour pressure: oil boils", s.below_vapour_deg, "deg per turn",
       "below_vapour_deg"},
      {"estimated error of the chamber pressure, of its peak", pressure_error(state), "",
       "pressure_error"},
  };
}

}  // namespace bentaxis::hydraulics
