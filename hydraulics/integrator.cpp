#include "integrator.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bentaxis/hydraulics/versions.h"
#include "bentaxis/numerics/stiff_integrator.h"
#include "bentaxis/pump/error.h"

namespace bentaxis::hydraulics {
namespace {

// Effort is counted in steps x states, with sensitivities x states again: about a microsecond each.
// A usual operating point takes 1e5, the wildest of our tests that ends 3e6. A delivery line has
// more states, of which each step costs less and more are taken.
constexpr double kMaxEffort = 1.5e7;
// Error per step of sensitivities with a delivery line.
constexpr double kForWaves = 1e-4;
constexpr int kUsualStates = 8;
double most_effort(const Network& network) {
  return kMaxEffort * std::max(1.0, static_cast<double>(network.states()) / kUsualStates);
}
constexpr double kEffortBetweenSigns = 1e4;  // of life
constexpr int kIntegrals = 5;

// The network over a period, with its integrals and sensitivities.
class Period : public numerics::Equations {
 public:
  enum class Wanted { nothing, integrals, energies };
  Period(const Network& network, double load_size, const std::vector<Direction>& directions,
         Wanted wanted)
      : network_(network),
        load_size_(load_size),
        directions_(directions),
        wanted_(wanted),
        by_state_(static_cast<std::size_t>(network.size()) * network.size()),
        by_load_(network.size()),
        above_(network.size()),
        below_(network.size()) {
    // Integrals are scaled to the mass and the work of one piston's stroke at delivery pressure.
    const double stroke = network.chamber().swept();
    mass_scale_ = network.fluid().state(0).density * stroke;
    work_scale_ = stroke * std::max(network.delivery_pressure(), network.fluid().atmosphere());
  }

  int states() const override { return network_.size(); }
  int integrals() const override {
    if (wanted_ == Wanted::nothing) return 0;
    return wanted_ == Wanted::energies ? network_.place_count() : kIntegrals;
  }
  bool rates(double x, const double* y, double* dy) override {
    return network_.rates(x, y, load_size_, dy);
  }
  void jacobian(double x, const double* y, const double*, bool, double* by_state) override {
    network_.jacobian(x, y, load_size_, by_state, by_load_.data());
  }

  bool sensitivity_rates(double x, const double* y, const std::vector<const double*>& s,
                         const std::vector<double*>& ds) override {
    network_.jacobian(x, y, load_size_, by_state_.data(), by_load_.data());
    const int size = network_.size();
    const int count = static_cast<int>(s.size());
    const int first_direction = count - static_cast<int>(directions_.size());
    for (int j = 0; j < count; ++j) {
      double* to = ds[j];
      const double* from = s[j];
      if (j >= first_direction) {
        const Direction& way = directions_[j - first_direction];
        if (!way.above->rates(x, y, way.above_load, above_.data()) ||
            !way.below->rates(x, y, way.below_load, below_.data()))
          return false;
        for (int row = 0; row < size; ++row) to[row] = (above_[row] - below_[row]) / way.apart;
      } else {
        for (int row = 0; row < size; ++row) to[row] = j < network_.states() ? 0 : by_load_[row];
      }
      for (int column = 0; column < size; ++column) {
        if (from[column] == 0) continue;
        const double* entries = by_state_.data() + column * size;
        for (int row = 0; row < size; ++row) to[row] += entries[row] * from[column];
      }
    }
    return true;
  }

  void integrands(double x, const double* y, double* dq) override {
    network_.flows(x, y, load_size_, flows_);
    if (wanted_ == Wanted::energies) {
      const PowerBudget power = network_.power(x, y, flows_);
      const double work = network_.seconds_per_degree() / work_scale_;
      for (int i = 0; i < network_.place_count(); ++i) dq[i] = power[static_cast<Place>(i)] * work;
      return;
    }
    Integrals rates;
    rates.add(flows_, network_.seconds_per_degree() / mass_scale_);
    dq[0] = rates.suction;
    dq[1] = rates.delivery;
    dq[2] = rates.leakage;
    dq[3] = rates.load;
    dq[4] = flows_.power * network_.seconds_per_degree() / work_scale_;
  }

  Integrals in_units(const double* q) const {
    return {q[0] * mass_scale_, q[1] * mass_scale_, q[2] * mass_scale_, q[3] * mass_scale_,
            q[4] * work_scale_};
  }
  double work_scale() const { return work_scale_; }

 private:
  const Network& network_;
  double load_size_;
  const std::vector<Direction>& directions_;
  Wanted wanted_;
  std::vector<double> by_state_, by_load_, above_, below_;  // of the sensitivity equations
  Network::Flows flows_;
  double mass_scale_ = 1, work_scale_ = 1;  // of the integrals, for their error control
};

const char* text_of(numerics::IntegrationFailure::Reason reason) {
  return reason == numerics::IntegrationFailure::Reason::tolerance
             ? "[hydraulics] tolerance is tighter than double precision allows there"
             : "the pressures change too fast there: the step falls below round-off";
}

}  // namespace

void Integrals::add(const Flows& flows, double seconds) {
  for (std::size_t k = 0; k < flows.suction.size(); ++k) {
    suction += flows.suction[k] * seconds;
    delivery += flows.delivery[k] * seconds;
    leakage += flows.leakage[k] * seconds;
  }
  load += flows.load * seconds;
  work += flows.power * seconds;
}

void summarize(const Network& network, const Integrals& over_period, Summary& summary) {
  const int n = network.pistons();
  const int way = network.backwards() ? -1 : 1;
  const double density = network.fluid().state(network.suction_log_pressure()).density;
  const double time = network.period_deg() * network.seconds_per_degree();
  summary.density = density;
  summary.displacement = network.displacement();
  summary.ideal_flow = way * summary.displacement / (n * time);
  summary.mass_flow = over_period.load / time;
  summary.flow = summary.mass_flow / density;
  // What is spent is the ideal flow of a pump and the flow that a motor takes.
  summary.volumetric_efficiency = summary.motors() ? summary.ideal_flow / summary.flow
                                                   : summary.flow / std::abs(summary.ideal_flow);
  summary.leakage = over_period.leakage / time / density;
  summary.work = way * over_period.work * n;
  summary.mass_in = over_period.suction * n;
  summary.mass_out = (over_period.delivery + over_period.leakage) * n;
}

std::string sundials_version() { return numerics::sundials_version(); }

Integrator::Integrator(const Network& network, std::function<void()> alive)
    : network_(network), alive_(std::move(alive)) {}

void Integrator::follow(std::vector<Direction> directions, double tolerance) {
  directions_ = std::move(directions);
  directions_tolerance_ = tolerance;
}

double Integrator::share_of_effort() const { return effort_ / most_effort(network_); }

std::vector<double> Integrator::over_period(const std::vector<double>& states, double load_size,
                                            double tolerance, std::vector<double>* sensitivity,
                                            Integrals* integrals, const Watch& watch,
                                            PowerBudget* energy) {
  const int size = network_.size();
  using Wanted = Period::Wanted;
  Period period(network_, load_size, directions_,
                energy != nullptr      ? Wanted::energies
                : integrals != nullptr ? Wanted::integrals
                                       : Wanted::nothing);
  numerics::Sensitivities columns;
  std::vector<double> unit_columns;
  if (sensitivity != nullptr) {
    // They serve as the Jacobian of a Newton iteration: the states set the steps. But a mode of a
    // delivery line that the states do not excite would be followed in steps far too long.
    const bool waves = network_.has_delivery_line();
    const bool as_result = !directions_.empty();
    columns.count =
        network_.states() + (network_.load_sought() ? 1 : 0) + static_cast<int>(directions_.size());
    columns.tolerance = as_result ? directions_tolerance_
                        : waves   ? std::max(tolerance, kForWaves)
                                  : tolerance;
    columns.sets_steps = waves || as_result;
    unit_columns.resize(static_cast<std::size_t>(columns.count) * size);
    for (int j = 0; j < network_.states(); ++j) unit_columns[j * (size + 1)] = 1;
  }
  numerics::StiffIntegrator bdf(period, tolerance, columns);
  Step taken;
  taken.state = [&](double x) { return bdf.state_at(x); };
  taken.integrals = [&](double x) { return period.in_units(bdf.integrals_at(x)); };
  taken.sensitivities = [&](double x) -> const std::vector<double>& {
    return bdf.sensitivities_at(x);
  };

  std::vector<double> start = states;
  start.resize(size);  // the mean starts at 0
  bdf.start(0, start, std::vector<double>(period.integrals()), unit_columns);
  std::vector<double> stops = network_.edges_deg();
  stops.push_back(network_.period_deg());
  const double effort = size * (sensitivity != nullptr ? size : 1);
  try {
    for (const double stop : stops) {
      // The slopes of the areas jump at an edge: start again at order 1 instead of stepping over
      // it.
      if (bdf.time() > 0) bdf.restart();
      long steps = 0;
      for (bool at_edge = false; !at_edge; ++steps) {
        taken.from = bdf.time();
        at_edge = bdf.step(stop) == numerics::StiffIntegrator::Reached::stop;
        taken.to = bdf.time();
        taken.at_edge = at_edge;
        if (watch) watch(taken);
        effort_ += effort;
        if (effort_ > most_ * most_effort(network_))
          throw ComputationError(
              "hydraulics: no periodic state within " + std::to_string(work_.steps + steps) +
              " steps: the pressures are too stiff (see transition_pressure_bar, dead_volume_cm3, "
              "delivery_volume_l" +
              (network_.has_delivery_line() ? ", bandwidth_Hz of [delivery_line])" : ")"));
        if (alive_ && (since_sign_ += effort) > kEffortBetweenSigns) {
          since_sign_ = 0;
          alive_();
        }
      }
      work_.steps += steps;
      work_.evaluations += bdf.evaluations();
    }
  } catch (const numerics::IntegrationFailure& failure) {
    throw IntegrationFailure("hydraulics: the time integration stops at a shaft angle of " +
                             number_text(bdf.time()) + " deg: " + text_of(failure.reason()));
  }
  const double end = bdf.time();
  if (energy != nullptr) {
    const double* q = bdf.integrals_at(end);
    for (int i = 0; i < network_.place_count(); ++i)
      (*energy)[static_cast<Place>(i)] = q[i] * period.work_scale();
  } else if (integrals != nullptr) {
    *integrals = period.in_units(bdf.integrals_at(end));
  }
  if (sensitivity != nullptr) *sensitivity = bdf.sensitivities_at(end);
  const double* y = bdf.state_at(end);
  return {y, y + size};
}

}  // namespace bentaxis::hydraulics
