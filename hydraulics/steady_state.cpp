#include "bentaxis/hydraulics/steady_state.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
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
#include "steady_state_results.h"
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

}  // namespace bentaxis::hydraulics
