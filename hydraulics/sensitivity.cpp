#include "bentaxis/hydraulics/sensitivity.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "bentaxis/numerics/dense.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "integrator.h"
#include "network.h"
#include "period_map.h"

namespace bentaxis::hydraulics {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

// The equations of two neighbours.
struct Pair {
  Pair(const Neighbours& of, const Network& network)
      : kept_above(std::make_shared<const Network>(of.above)),
        kept_below(std::make_shared<const Network>(of.below)),
        above(*kept_above),
        below(*kept_below),
        apart(of.apart) {
    for (const Network* other : {&above, &below})
      if (other->size() != network.size() || other->states() != network.states() ||
          other->pistons() != network.pistons() || other->backwards() != network.backwards() ||
          other->load_sought() != network.load_sought())
        throw InputError("hydraulics: a parameter changes the circuit: it has no derivative");
  }
  Direction direction(const Network& network, double load_size) const {
    const bool sought = network.load_sought();
    return {&above, &below, sought ? load_size : above.load().size(),
            sought ? load_size : below.load().size(), apart};
  }
  // Of what a network says, with the state as it is.
  template <class F>
  double difference(const F& f) const {
    return (f(above) - f(below)) / apart;
  }
  std::shared_ptr<const Network> kept_above, kept_below;
  const Network &above, &below;
  double apart;
};

// Where in the period which chamber passes an angle.
struct Passage {
  double x;
  int chamber;
  std::size_t number;  // of the angle
};

std::vector<Passage> passages_of(const Network& network, std::span<const double> theta_k_deg) {
  const int n = network.pistons();
  std::vector<Passage> places;
  for (std::size_t i = 0; i < theta_k_deg.size(); ++i) {
    const double angle = wrap_degrees(theta_k_deg[i]);
    const int segment = std::min(static_cast<int>(angle / network.period_deg()), n - 1);
    const double past =
        std::clamp(angle - segment * network.period_deg(), 0.0, network.period_deg());
    if (network.backwards())
      places.push_back({network.period_deg() - past, (2 * n - segment - 1) % n, i});
    else
      places.push_back({past, (n - segment) % n, i});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Passage& a, const Passage& b) { return a.x < b.x; });
  return places;
}

// A point of the period where what flows is integrated over it: two of each step, Gauss's.
struct Node {
  double x = 0, width = 0;  // degrees, those that it stands for
  Vector state;
  Matrix by;  // by start, ln load size and parameters
};

void add_nodes(const Integrator::Step& step, int size, Eigen::Index columns,
               std::vector<Node>& nodes) {
  static const double kGauss = 0.5 / std::sqrt(3.0);
  const double width = step.to - step.from;
  for (const double place : {0.5 - kGauss, 0.5 + kGauss}) {
    Node node;
    node.x = step.from + place * width;
    node.width = width / 2;
    node.by = Eigen::Map<const Matrix>(step.sensitivities(node.x).data(), size, columns);
    node.state = Eigen::Map<const Vector>(step.state(node.x), size);
    nodes.push_back(std::move(node));
  }
}

// Means over the period of one neighbour, with the state and the load moved a little.
class MeansOf {
 public:
  MeansOf(std::shared_ptr<const Network> network, double load_size)
      : network_(std::move(network)), load_size_(load_size) {}
  void add(const Node& node, const Vector& state) {
    network_->flows(node.x, state.data(), load_size_, flows_);
    integrals_.add(flows_, node.width * network_->seconds_per_degree());
    const PowerBudget power = network_->power(node.x, state.data(), flows_);
    for (int i = 0; i < network_->place_count(); ++i)
      power_[static_cast<Place>(i)] +=
          power[static_cast<Place>(i)] * node.width / network_->period_deg();
  }
  SteadyState state(double delivery_mean) const {
    SteadyState result;
    summarize(*network_, integrals_, result.summary);
    result.summary.delivery_mean = delivery_mean;
    result.equations = network_;
    return result;
  }
  const PowerBudget& power() const { return power_; }

 private:
  std::shared_ptr<const Network> network_;
  double load_size_;
  Network::Flows flows_;
  Integrals integrals_;
  PowerBudget power_;
};

// ln P of a chamber at an angle, and its derivatives by start, ln load size and parameters.
struct Sample {
  double s = 0;
  Vector row;
};

}  // namespace

bool has_rates(const SteadyState& state, const Neighbours& parameter) {
  try {
    const Pair pair(parameter, *state.equations);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<PressureRates> pressure_rates(const SteadyState& state,
                                          std::span<const Neighbours> parameters,
                                          std::span<const double> theta_k_deg, double tolerance,
                                          const Progress& progress,
                                          std::vector<NeighbourMeans>* means) {
  const Network& network = *state.equations;
  Integrator integrator(network, [&] {
    if (progress) progress(0.5);
  });
  const PeriodMap map(network, Sizing::mean_pressure, integrator);
  const double load_size = state.corrected_load_size;
  std::vector<std::unique_ptr<const Pair>> pairs;
  std::vector<Direction> directions;
  for (const Neighbours& each : parameters) {
    pairs.push_back(std::make_unique<const Pair>(each, network));
    directions.push_back(pairs.back()->direction(network, load_size));
  }
  integrator.follow(directions, tolerance);

  const auto places = passages_of(network, theta_k_deg);
  std::vector<Sample> samples(places.size());
  std::size_t next = 0;
  const int size = network.size(), states = network.states();
  const int unknowns = map.unknowns();
  const auto columns = unknowns + static_cast<int>(pairs.size());
  std::vector<Node> nodes;
  std::vector<double> at_end;
  const std::vector<double> end = integrator.over_period(
      state.corrected_states, load_size, state.convergence.tolerance, &at_end, nullptr,
      [&](const Integrator::Step& step) {
        if (means != nullptr) add_nodes(step, size, columns, nodes);
        while (next < places.size() && places[next].x <= step.to) {
          const double x = places[next].x;
          const Eigen::Map<const Matrix> by(step.sensitivities(x).data(), size, columns);
          const double* const y = step.state(x);
          for (; next < places.size() && places[next].x == x; ++next)
            samples[next] = {y[places[next].chamber], by.row(places[next].chamber)};
        }
      });

  // How start and load follow: what the end becomes, in its new order, is what the start becomes.
  const Eigen::Map<const Matrix> by(at_end.data(), size, columns);
  Matrix residual(unknowns, columns);
  for (int j = 0; j < columns; ++j) {
    const auto moved = map.relabelled({by.col(j).data(), by.col(j).data() + size});
    residual.col(j).head(states) = Eigen::Map<const Vector>(moved.data(), states);
  }
  residual.leftCols(states).topRows(states).diagonal().array() -= 1;
  if (network.load_sought()) residual.row(states) = by.row(size - 1);
  const Matrix follow = -numerics::LinearSolver(residual.leftCols(unknowns))
                             .solve(Matrix(residual.rightCols(columns - unknowns)));
  if (!follow.allFinite())
    throw ComputationError("hydraulics: the periodic state has no derivatives here");

  std::vector<PressureRates> rates(pairs.size());
  if (means != nullptr) means->assign(pairs.size(), {});
  numerics::parallel_for(0, pairs.size(), [&](std::size_t p) {
    const auto direction = static_cast<Eigen::Index>(p);
    const auto of = [&](const auto& row) {
      return row.head(unknowns).dot(follow.col(direction)) + row[unknowns + direction];
    };
    rates[p].chamber.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double s = samples[i].s;
      rates[p].chamber[places[i].number] =
          network.fluid().state(s).pressure * of(samples[i].row) +
          pairs[p]->difference([s](const Network& each) { return each.fluid().gauge(s); });
    }
    if (network.fixed_line()) {
      rates[p].delivery_mean =
          pairs[p]->difference([](const Network& each) { return each.delivery_pressure(); });
    } else {
      const Vector last = by.row(size - 1);
      rates[p].delivery_mean = network.mean_scale() * of(last) +
                               end[size - 1] * pairs[p]->difference([](const Network& each) {
                                 return each.mean_scale();
                               });
    }
    if (means == nullptr) return;
    const Direction& way = directions[p];
    const double half = way.apart / 2;
    const double load = network.load_sought() ? std::exp(half * follow(states, direction)) : 1;
    MeansOf above(pairs[p]->kept_above, way.above_load * load);
    MeansOf below(pairs[p]->kept_below, way.below_load / load);
    for (const Node& node : nodes) {
      const Vector moved = half * (node.by.leftCols(unknowns) * follow.col(direction) +
                                   node.by.col(unknowns + direction));
      above.add(node, node.state + moved);
      below.add(node, node.state - moved);
    }
    const double mean = state.summary.delivery_mean, change = half * rates[p].delivery_mean;
    (*means)[p] = {above.state(mean + change), below.state(mean - change), above.power(),
                   below.power()};
  });
  return rates;
}

}  // namespace bentaxis::hydraulics
