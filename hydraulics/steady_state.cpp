#include "bentaxis/hydraulics/steady_state.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/stopwatch.h"
#include "integrator.h"
#include "network.h"

namespace bentaxis::hydraulics {
namespace {

constexpr double kLitrePerMinute = 1e-3 / 60;  // m3/s
// Of the first, coarse search, whose sensitivities the fine one goes on using.
constexpr double kCoarse = 1e-5;
// Largest change of ln P and of ln(load area) in one Newton step.
constexpr double kLongestStep = 2;
constexpr int kSettlingPeriods = 3;
constexpr int kMostIterations = 40;
// Noise of an integration over the error allowed per step, from many steps and restarts.
constexpr double kNoise = 20;

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

// The map of one period: residual of (pressures at the start, ln of the load area).
class PeriodMap {
 public:
  explicit PeriodMap(const Network& network) : network_(network), integrator_(network) {}

  int unknowns() const { return network_.pressures() + (network_.open_line() ? 0 : 1); }
  double load_area(const Vector& z) const {
    return network_.open_line() ? 0 : std::exp(z[network_.pressures()]);
  }
  std::vector<double> pressures(const Vector& z) const {
    return {z.data(), z.data() + network_.pressures()};
  }

  // Pressures at the end of the period in the order of the chambers that stand there next.
  template <class State>
  std::vector<double> relabelled(const State& end) const {
    const int n = network_.pistons();
    std::vector<double> next(network_.pressures());
    for (int k = 0; k < n; ++k) next[(k + n - 1) % n] = end[k];
    // Chamber k stands at -360 k/N at the start and at 360/N - 360 k/N at the end: where chamber
    // k-1 began.
    if (!network_.open_line()) next[n] = end[n];
    return next;
  }

  Vector residual(const Vector& z, double tolerance, Matrix* jacobian = nullptr) {
    std::vector<double> sensitivity;
    const auto end = integrator_.over_period(pressures(z), load_area(z), tolerance,
                                             jacobian != nullptr ? &sensitivity : nullptr);
    const int n = network_.pistons();
    const int size = network_.size();
    Vector result(unknowns());
    const auto next = relabelled(end);
    for (int i = 0; i < network_.pressures(); ++i) result[i] = next[i] - z[i];
    if (!network_.open_line()) result[unknowns() - 1] = end[size - 1] - 1;
    if (jacobian != nullptr) {
      const Eigen::Map<const Matrix> end_by_start(sensitivity.data(), size, unknowns());
      jacobian->resize(unknowns(), unknowns());
      for (int k = 0; k < n; ++k) jacobian->row((k + n - 1) % n) = end_by_start.row(k);
      for (int i = n; i < size; ++i) jacobian->row(i) = end_by_start.row(i);
      for (int i = 0; i < network_.pressures(); ++i) (*jacobian)(i, i) -= 1;
    }
    return result;
  }

  Integrator& integrator() { return integrator_; }

 private:
  const Network& network_;
  Integrator integrator_;
};

double size_of(const Vector& v) { return v.lpNorm<Eigen::Infinity>(); }

Vector first_guess(const Network& network, const std::optional<Start>& start) {
  const int n = network.pistons();
  const bool open = network.open_line();
  Vector z(network.pressures() + (open ? 0 : 1));
  const double ideal_mass_flow = network.fluid().state(network.suction_log_pressure()).density *
                                 network.displacement() / (360 * network.seconds_per_degree());
  for (int k = 0; k < n; ++k) {
    const bool fills = k == 0 || 360.0 * k / n > 180;  // the chamber stands at -360 k/N
    z[k] = start   ? network.fluid().log_pressure(start->chambers)
           : fills ? network.suction_log_pressure()
                   : network.delivery_log_pressure();
  }
  if (!open) {
    z[n] = start ? network.fluid().log_pressure(start->line) : network.delivery_log_pressure();
    z[n + 1] = std::log(start ? start->load_area : network.load_area_for(ideal_mass_flow));
  }
  return z;
}

// Newton with the sensitivities of every iterate, damped; each integration to `tolerance`.
void search(PeriodMap& map, Vector& z, double tolerance, Matrix& jacobian, int& iterations,
            const Progress& progress) {
  Vector f = map.residual(z, tolerance, &jacobian);
  double best = size_of(f);
  for (; best > kNoise * tolerance; ++iterations) {
    if (progress) progress(0.9 * iterations / kMostIterations);
    if (iterations >= kMostIterations)
      throw ComputationError("hydraulics: no periodic state found after " +
                             std::to_string(iterations) +
                             " Newton steps; pressures still change by a factor of up to exp(" +
                             number_text(best) + ") per period");
    Vector step = -jacobian.partialPivLu().solve(f);
    if (!step.allFinite())
      throw ComputationError(
          "hydraulics: no periodic state found: the pressures do not determine the load orifice");
    step *= std::min(1.0, kLongestStep / size_of(step));
    bool accepted = false;
    for (int halving = 0; halving < 12 && !accepted; ++halving, step /= 2) {
      try {
        const Vector trial = z + step;
        Matrix trial_jacobian;
        const Vector trial_f = map.residual(trial, tolerance, &trial_jacobian);
        // A longer residual is allowed at first: the orifice roots make the map far from linear.
        if (size_of(trial_f) < (1 - 1e-4) * best) {
          z = trial;
          f = trial_f;
          jacobian = trial_jacobian;
          best = size_of(f);
          accepted = true;
        }
      } catch (const ComputationError&) {
        // Too far: the integration does not get through the period from there.
      }
    }
    if (!accepted) return;  // at the noise of the integration, or stuck: the caller looks at it
  }
}

Channel channel(const std::string& name, const std::string& meaning, const std::string& unit,
                double unit_in_si, int piston) {
  Channel c;
  c.name = name;
  c.quantity = name.substr(0, name.find('_'));
  c.meaning = meaning;
  c.piston = piston;
  c.unit = unit;
  c.unit_in_si = unit_in_si;
  c.group = name;
  c.kind = ChannelKind::input;
  return c;
}

std::vector<Channel> turn_channels() {
  const double bar = kPascalPerBar;
  return {
      channel("p_1_bar", "pressure in chamber 1, gauge", "bar", bar, 1),
      channel("p_delivery_bar", "pressure in the delivery volume, gauge", "bar", bar, 0),
      channel("Qs_1_l_per_min", "flow from the suction port into chamber 1", "l/min",
              kLitrePerMinute, 1),
      channel("Qd_1_l_per_min", "flow from chamber 1 into the delivery port", "l/min",
              kLitrePerMinute, 1),
      channel("Ql_1_l_per_min", "leakage from chamber 1 to the case", "l/min", kLitrePerMinute, 1),
      channel("Qs_l_per_min", "flow through the suction port", "l/min", kLitrePerMinute, 0),
      channel("Qd_l_per_min", "flow through the delivery port", "l/min", kLitrePerMinute, 0),
      channel("Ql_l_per_min", "leakage of all chambers", "l/min", kLitrePerMinute, 0),
      channel("Qload_l_per_min", "flow through the load orifice", "l/min", kLitrePerMinute, 0),
      channel("V_1_cm3", "volume of chamber 1", "cm3", 1e-6, 1),
      channel("as_1_mm2", "opening of chamber 1 to the suction port", "mm2", 1e-6, 1),
      channel("ad_1_mm2", "opening of chamber 1 to the delivery port", "mm2", 1e-6, 1)};
}

// Largest and least of what was seen.
struct Extremes {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  double least_at = 0, greatest_at = 0;
  void see(double value, double at) {
    if (value < least) least = value, least_at = at;
    if (value > greatest) greatest = value, greatest_at = at;
  }
};

double turn(double degrees) {
  const double wrapped = std::fmod(degrees, 360.0);
  return wrapped < 0 ? wrapped + 360 : wrapped;
}

// One more integration over the period, to the end with everything that is reported. The N chambers
// over 360/N degrees are one chamber over the turn.
void record(const Case& the_case, const Network& network, PeriodMap& map, const Vector& z,
            SteadyState& result) {
  const int n = network.pistons();
  const int points = the_case.pressure.points;
  const double period = network.period_deg();
  const double load_area = map.load_area(z);
  const Fluid& fluid = network.fluid();
  const double delivery_density = fluid.density(the_case.pressure.ports.delivery);
  const double suction_density = fluid.density(the_case.pressure.ports.suction);
  const double case_density = fluid.density(the_case.hydraulics->case_pressure);

  // Grid point i falls into segment i n / points, seen by the chamber that starts there.
  struct Place {
    double x;
    int point, chamber;
  };
  std::vector<Place> places;
  for (int i = 0; i < points; ++i) {
    const int segment = static_cast<int>(static_cast<long long>(i) * n / points);
    const double x = 360.0 * i / points - period * segment;
    places.push_back({std::clamp(x, 0.0, period * (1 - 1e-15)), i, (n - segment) % n});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.x < b.x; });

  ResultTable& table = result.table;
  table.name = "hydraulics";
  table.channels = turn_channels();
  table.values.resize(table.columns() * points);
  for (int i = 0; i < points; ++i) table.theta_deg.push_back(360.0 * i / points);
  result.chamber = {table.theta_deg, std::vector<double>(points)};
  result.delivery = result.chamber;

  Integrator::Watch watch;
  for (const Place& place : places) watch.at.push_back(place.x);
  Network::Flows flows;
  const auto total = [](const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x;
    return sum;
  };
  std::size_t next = 0;
  const auto line = [&](const double* y) { return network.open_line() ? 0 : fluid.gauge(y[n]); };
  watch.sample = [&](double x, const double* y) {
    const Place& place = places[next++];
    const int k = place.chamber;
    network.flows(x, y, load_area, flows);
    const double angle = table.theta_deg[place.point];
    const double pressure = fluid.gauge(y[k]);
    result.chamber.pressure[place.point] = pressure;
    result.delivery.pressure[place.point] = line(y);
    const double row[] = {pressure,
                          line(y),
                          flows.suction[k] / suction_density,
                          flows.delivery[k] / delivery_density,
                          flows.leakage[k] / case_density,
                          total(flows.suction) / suction_density,
                          total(flows.delivery) / delivery_density,
                          total(flows.leakage) / case_density,
                          flows.load / delivery_density,
                          network.chamber().volume(radians(angle)).value,
                          network.suction().area(angle),
                          network.delivery().area(angle)};
    for (std::size_t c = 0; c < table.columns(); ++c)
      table.values[place.point * table.columns() + c] = row[c] / table.channels[c].unit_in_si;
  };
  Extremes chamber, delivery, flow;
  watch.step = [&](double x, const double* y) {
    network.flows(x, y, load_area, flows);
    for (int k = 0; k < n; ++k) chamber.see(fluid.gauge(y[k]), turn(network.angle_deg(x, k)));
    delivery.see(line(y), x);
    flow.see(total(flows.delivery), x);
  };
  Integrals integrals;
  const auto pressures = map.pressures(z);
  const auto end = map.integrator().over_period(
      pressures, load_area, the_case.hydraulics->tolerance, nullptr, &integrals, &watch);
  const auto next_start = map.relabelled(end);
  double change = 0;
  for (std::size_t i = 0; i < next_start.size(); ++i)
    change = std::max(change, std::abs(next_start[i] - pressures[i]));
  if (!network.open_line()) change = std::max(change, std::abs(end[network.size() - 1] - 1));
  result.convergence.residual = change;
  result.log_pressures = pressures;

  Summary& s = result.summary;
  const double time = period * network.seconds_per_degree();
  s.displacement = network.displacement();
  s.ideal_flow = s.displacement / (n * time);
  s.flow = integrals.load / time / delivery_density;
  s.flow_at_inlet = integrals.load / time / suction_density;
  s.volumetric_efficiency = s.flow_at_inlet / s.ideal_flow;
  s.leakage = integrals.leakage / time / suction_density;
  s.delivery_mean = network.open_line() ? 0 : end[network.size() - 1] * network.delivery_pressure();
  s.delivery_least = delivery.least;
  s.delivery_greatest = delivery.greatest;
  s.flow_ripple = (flow.greatest - flow.least) / (integrals.delivery / time);
  s.chamber_least = chamber.least;
  s.chamber_least_deg = chamber.least_at;
  s.chamber_greatest = chamber.greatest;
  s.chamber_greatest_deg = chamber.greatest_at;
  s.overshoot = chamber.greatest - s.delivery_mean;
  s.undershoot = the_case.pressure.ports.suction - chamber.least;
  s.work = integrals.work * n;
  s.mass_in = integrals.suction * n;
  s.mass_out = (integrals.delivery + integrals.leakage) * n;
  s.load_area = load_area;
  if (!network.open_line() && !(integrals.load > 0))
    throw ComputationError("hydraulics: nothing is left for the load at this delivery pressure");
}

}  // namespace

SteadyState steady_state(const Case& the_case, const std::optional<Start>& start,
                         const Progress& progress) {
  const Stopwatch stopwatch;
  const Network network(the_case);
  const double tolerance = the_case.hydraulics->tolerance;
  PeriodMap map(network);
  Vector z = first_guess(network, start);
  SteadyState result;

  // A few periods as they come: then every chamber has met a port and forgotten its start.
  for (int i = 0; i < kSettlingPeriods; ++i) {
    const auto next =
        map.relabelled(map.integrator().over_period(map.pressures(z), map.load_area(z), kCoarse));
    std::copy(next.begin(), next.end(), z.data());
    if (!network.open_line() && !start) z[network.pistons()] = network.delivery_log_pressure();
  }
  Matrix jacobian;
  int& iterations = result.convergence.iterations;
  search(map, z, std::max(kCoarse, tolerance), jacobian, iterations, progress);

  // Finer integrations change the answer little: the coarse derivatives serve on.
  const Eigen::PartialPivLU<Matrix> chord(jacobian);
  double before = std::numeric_limits<double>::infinity();
  for (;; ++iterations) {
    const Vector f = map.residual(z, tolerance);
    const double size = size_of(f);
    if (size <= kNoise * tolerance) break;
    if (!(size < 0.5 * before)) {
      // Slow: take the fine map's own derivatives.
      search(map, z, tolerance, jacobian, iterations, progress);
      const double left = size_of(map.residual(z, tolerance));
      if (left > 100 * kNoise * tolerance)
        throw ComputationError(
            "hydraulics: no periodic state found: pressures still change by " + number_text(left) +
            " of themselves per period" +
            (network.open_line() ? "" : " (can the pump reach this delivery pressure at all?)"));
      break;
    }
    before = size;
    z -= chord.solve(f);
  }
  if (progress) progress(0.95);
  record(the_case, network, map, z, result);
  const Work& work = map.integrator().work();
  result.convergence.steps = work.steps;
  result.convergence.evaluations = work.evaluations;
  result.convergence.seconds = stopwatch.seconds();
  result.table.provenance.seconds = result.convergence.seconds;
  if (progress) progress(1);
  return result;
}

ResultTable transient_from_rest(const Case& the_case, double load_area, int revolutions,
                                int samples, const Progress& progress) {
  const Network network(the_case);
  PeriodMap map(network);
  const int n = network.pistons();
  std::vector<double> y(network.pressures(), network.suction_log_pressure());
  if (!network.open_line()) y[n] = 0;
  ResultTable table;
  table.name = "transient";
  const auto all = turn_channels();
  table.channels = {all[0], all[1]};
  const Fluid& fluid = network.fluid();
  Integrator::Watch watch;
  for (int i = 0; i < samples; ++i) watch.at.push_back(network.period_deg() * i / samples);
  int chamber = 0;  // which of the relabelled chambers is chamber 1
  long long period = 0;
  watch.sample = [&](double x, const double* state) {
    table.theta_deg.push_back(static_cast<double>(period) * network.period_deg() + x);
    table.values.push_back(fluid.gauge(state[chamber]) / kPascalPerBar);
    table.values.push_back(network.open_line() ? 0 : fluid.gauge(state[n]) / kPascalPerBar);
  };
  const long long periods = static_cast<long long>(revolutions) * n;
  for (; period < periods; ++period) {
    y = map.relabelled(map.integrator().over_period(y, load_area, the_case.hydraulics->tolerance,
                                                    nullptr, nullptr, &watch));
    chamber = (chamber + n - 1) % n;
    if (progress) progress(static_cast<double>(period + 1) / static_cast<double>(periods));
  }
  return table;
}

void give_to(Case& the_case, const SteadyState& state) { the_case.pressure.curve = state.chamber; }

std::vector<Line> lines(const SteadyState& state) {
  const Summary& s = state.summary;
  const double bar = kPascalPerBar;
  return {
      {"displacement", s.displacement * 1e6, "cm3/rev"},
      {"ideal flow", s.ideal_flow / kLitrePerMinute, "l/min"},
      {"mean flow, at delivery pressure", s.flow / kLitrePerMinute, "l/min"},
      {"mean flow, at suction pressure", s.flow_at_inlet / kLitrePerMinute, "l/min"},
      {"volumetric efficiency", 100 * s.volumetric_efficiency, "%"},
      {"leakage, at suction pressure", s.leakage / kLitrePerMinute, "l/min"},
      {"mean delivery pressure", s.delivery_mean / bar, "bar"},
      {"delivery pressure, least", s.delivery_least / bar, "bar"},
      {"delivery pressure, greatest", s.delivery_greatest / bar, "bar"},
      {"delivery pressure ripple, peak to peak", (s.delivery_greatest - s.delivery_least) / bar,
       "bar"},
      {"flow ripple, peak to peak", 100 * s.flow_ripple, "% of mean"},
      {"chamber pressure, greatest", s.chamber_greatest / bar, "bar"},
      {"angle of the greatest", s.chamber_greatest_deg, "deg"},
      {"overshoot over mean delivery pressure", s.overshoot / bar, "bar"},
      {"chamber pressure, least", s.chamber_least / bar, "bar"},
      {"angle of the least", s.chamber_least_deg, "deg"},
      {"undershoot under suction pressure", s.undershoot / bar, "bar"},
      {"work of the pistons per turn", s.work, "J"},
      {"mean torque of that work", s.work / (2 * kPi), "Nm"},
      {"mass in minus mass out, over mass in", (s.mass_in - s.mass_out) / s.mass_in, ""},
      {"load orifice", s.load_area * 1e6, "mm2"},
  };
}

}  // namespace bentaxis::hydraulics
