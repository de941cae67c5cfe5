#include "bentaxis/hydraulics/timing.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/units.h"
#include "boole.h"
#include "timing_record.h"

namespace bentaxis::hydraulics {
namespace {

// On every step of the integration.
constexpr std::size_t kNodes = kBooleNodes;
// Gaps of a interval shorter than this are none, degrees.
constexpr double kNoGap = 1e-6;
// The largest area of a interval is looked for at as many angles.
constexpr int kAreaAngles = 1000;

bool inside(const AngleInterval& where, double theta_deg) {
  return theta_deg >= where.from_deg - kNoGap && theta_deg <= where.to_deg + kNoGap;
}
// An angle of the turn, or the same a turn later, where that is in the interval.
bool met(const AngleInterval& where, double theta_deg) {
  return inside(where, theta_deg) || inside(where, theta_deg + 360);
}

Timing::Connection connection(const Network& network, const Bridge& bridge) {
  Timing::Connection c{{bridge.from_deg, bridge.to_deg}};
  for (int i = 0; i <= kAreaAngles; ++i) {
    const double theta =
        bridge.from_deg + (bridge.to_deg - bridge.from_deg) * i / double(kAreaAngles);
    const double s = network.suction().area(theta), d = network.delivery().area(theta);
    const double area = s > 0 && d > 0 ? s * d / std::hypot(s, d) : 0;
    if (area > c.largest_area) c.largest_area = area, c.largest_area_deg = wrap_degrees(theta);
  }
  return c;
}

Timing::Trapped trapped(const Network& network, const Bridge& bridge) {
  Timing::Trapped t{{bridge.from_deg, bridge.to_deg}};
  double least = 0, greatest = 0;
  for (int i = 0; i <= kAreaAngles; ++i) {
    const double theta =
        bridge.from_deg + (bridge.to_deg - bridge.from_deg) * i / double(kAreaAngles);
    const double volume = network.chamber().volume(radians(theta)).value;
    least = i == 0 ? volume : std::min(least, volume);
    greatest = std::max(greatest, volume);
  }
  t.swept = greatest - least;
  return t;
}

// Where the longest interval ends that is open to the suction port alone.
std::optional<double> end_of_suction(const Network& network) {
  std::vector<double> edges = network.suction().edges_deg();
  append(edges, network.delivery().edges_deg());
  std::sort(edges.begin(), edges.end());
  if (edges.empty()) return std::nullopt;
  double length = 0, longest = 0;
  std::optional<double> end;
  // Two turns: a interval may go on over 0 degrees.
  const std::size_t count = edges.size();
  for (std::size_t i = 0; i < 2 * count; ++i) {
    const double from = edges[i % count];
    const double to = i % count + 1 < count ? edges[i % count + 1] : edges[0] + 360;
    const double middle = (from + to) / 2;
    if (!(network.suction().area(middle) > 0) || network.delivery().area(middle) > 0) {
      length = 0;
      continue;
    }
    length += to - from;
    if (length > longest) longest = length, end = wrap_degrees(to);
  }
  if (longest >= 360) return std::nullopt;  // it never ends
  return end;
}

}  // namespace

std::vector<AngleInterval> intervals_below(const std::vector<double>& theta_deg,
                                           const std::vector<double>& values, double limit) {
  std::vector<AngleInterval> all;
  for (std::size_t i = 1; i < theta_deg.size(); ++i) {
    double from = theta_deg[i - 1], to = theta_deg[i];
    const double a = values[i - 1] - limit, b = values[i] - limit;
    if (a >= 0 && b >= 0) continue;
    const double crossing = from + (to - from) * a / (a - b);  // used where signs differ only
    if (a >= 0) from = crossing;
    if (b >= 0) to = crossing;
    if (!(to > from)) continue;
    if (!all.empty() && from - all.back().to_deg < kNoGap)
      all.back().to_deg = to;
    else
      all.push_back({from, to});
  }
  if (all.empty()) return all;
  const double start = theta_deg.front(), end = theta_deg.back();
  const bool over_zero = all.front().from_deg - start < kNoGap && end - all.back().to_deg < kNoGap;
  if (over_zero && all.size() > 1) {
    all.back().to_deg = all.front().to_deg + 360;
    all.erase(all.begin());
  }
  return all;
}

void TimingRecord::see(const Integrator::Step& step) {
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double x = step.from + (step.to - step.from) * static_cast<double>(i) / (kNodes - 1);
    const double* y = step.state(x);
    network_.flows(x, y, load_size_, flows_);
    x_.push_back(x);
    for (int k = 0; k < network_.pistons(); ++k)
      nodes_.push_back({0, y[k], flows_.delivery[k], flows_.suction[k],
                        network_.air_at() > 0 ? network_.air_out(y, k) : 0});
  }
}

std::vector<TimingRecord::Node> TimingRecord::turn() const {
  const int n = network_.pistons();
  std::vector<Node> turn;
  turn.reserve(nodes_.size());
  const bool backwards = network_.backwards();
  for (int segment = 0; segment < n; ++segment)
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const std::size_t node = backwards ? x_.size() - 1 - i : i;
      const double x = backwards ? network_.period_deg() - x_[node] : x_[node];
      turn.push_back(nodes_[node * n + (n - segment - (backwards ? 1 : 0)) % n]);
      turn.back().theta_deg = network_.period_deg() * segment + x;
    }
  return turn;
}

Timing TimingRecord::timing(double delivery_mean) const {
  Timing result;
  const Fluid& fluid = network_.fluid();
  const double density = fluid.state(network_.suction_log_pressure()).density;
  const std::vector<Node> turn = this->turn();
  std::vector<double> theta, s, delivered;
  for (const Node& node : turn) {
    theta.push_back(node.theta_deg);
    s.push_back(node.s);
    delivered.push_back(node.to_delivery);
  }
  result.below_saturation = intervals_below(theta, s, fluid.log_pressure(fluid.saturation()));
  result.below_vapour = intervals_below(theta, s, fluid.log_pressure(fluid.vapour()));
  result.backflow_where = intervals_below(theta, delivered, 0);

  for (const Bridge& bridge : bridges(network_.suction(), network_.delivery()))
    if (bridge.both_open)
      result.connected.push_back(connection(network_, bridge));
    else
      result.trapped.push_back(trapped(network_, bridge));

  for (std::size_t i = 0; i + kNodes <= turn.size(); i += kNodes) {
    const double seconds =
        (turn[i + kNodes - 1].theta_deg - turn[i].theta_deg) * network_.seconds_per_degree();
    double back = 0, through = 0;
    for (std::size_t j = 0; j < kNodes; ++j) {
      const Node& node = turn[i + j];
      const double into = std::max(0.0, -node.to_delivery);
      back += kBoole[j] * into;
      through += kBoole[j] * std::min(into, std::max(0.0, -node.from_suction));
      if (into / density > result.largest_backflow) {
        result.largest_backflow = into / density;
        result.largest_backflow_deg = wrap_degrees(node.theta_deg);
      }
    }
    result.backflow += back * seconds / density;
    const double middle = (turn[i].theta_deg + turn[i + kNodes - 1].theta_deg) / 2;
    for (Timing::Connection& c : result.connected)
      if (met(c.where, middle)) c.through += through * seconds / density;
  }
  for (Timing::Trapped& t : result.trapped) {
    bool first = true;
    for (const Node& node : turn) {
      if (!met(t.where, node.theta_deg)) continue;
      const double p = fluid.gauge(node.s);
      if (first || p > t.greatest) t.greatest = p, t.greatest_deg = wrap_degrees(node.theta_deg);
      if (first || p < t.least) t.least = p, t.least_deg = wrap_degrees(node.theta_deg);
      first = false;
    }
  }
  double largest = 0;
  for (int i = 0; i < kAreaAngles; ++i)
    largest = std::max(largest, network_.chamber().volume(radians(360.0 * i / kAreaAngles)).value);
  result.filling = largest * (fluid.density(delivery_mean) / density - 1);
  if (const auto end = network_.backwards() ? std::nullopt : end_of_suction(network_)) {
    const auto nearest =
        std::min_element(turn.begin(), turn.end(), [&](const Node& a, const Node& b) {
          return std::abs(wrap_degrees(a.theta_deg - *end + 180) - 180) <
                 std::abs(wrap_degrees(b.theta_deg - *end + 180) - 180);
        });
    const double ratio =
        (network_.air_at() > 0 ? fluid.mixture(nearest->s, nearest->air_out).density
                               : fluid.state(nearest->s).density) /
        density;
    const double volume = network_.chamber().volume(radians(*end)).value;
    result.filled = Timing::Filled{*end, ratio, (1 - ratio) * volume / network_.chamber().swept()};
  }
  return result;
}

}  // namespace bentaxis::hydraulics
