#include "turn.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>

#include "bentaxis/pump/units.h"
#include "boole.h"

namespace bentaxis::hydraulics {
namespace {

// A ripple is that of the flow averaged over this angle, degrees: what passes in the instant at
// which a port opens is none.
constexpr double kRippleWindow = 0.25;
constexpr int kPerWindow = 10;

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

std::vector<Channel> turn_channels(const Network& network) {
  std::vector<Channel> all = pressure_channels();
  const struct {
    const char *name, *meaning;
    int piston;
  } flows[] = {{"s_1", "from the suction port into chamber 1", 1},
               {"d_1", "from chamber 1 into the delivery port", 1},
               {"l_1", "leakage from chamber 1 to the case", 1},
               {"s", "through the suction port", 0},
               {"d", "through the delivery port", 0},
               {"l", "leakage of all chambers", 0},
               {"load", "into the load", 0}};
  for (const auto& f : flows)
    all.push_back(channel(std::string("Q") + f.name + "_l_per_min",
                          std::string("volume flow ") + f.meaning + ", at suction density", "l/min",
                          kLitrePerMinute, f.piston));
  all.push_back(channel("V_1_cm3", "volume of chamber 1", "cm3", 1e-6, 1));
  all.push_back(channel("as_1_mm2", "opening of chamber 1 to the suction port", "mm2", 1e-6, 1));
  all.push_back(channel("ad_1_mm2", "opening of chamber 1 to the delivery port", "mm2", 1e-6, 1));
  for (const auto& f : flows)
    all.push_back(channel(std::string("m") + f.name + "_g_per_s",
                          std::string("mass flow ") + f.meaning, "g/s", 1e-3, f.piston));
  if (network.has_suction_volume())
    all.push_back(
        channel("p_suction_bar", "pressure in the suction port, gauge", "bar", kPascalPerBar, 0));
  if (network.has_delivery_line())
    all.push_back(channel("p_load_bar", "pressure at the end of the delivery line, gauge", "bar",
                          kPascalPerBar, 0));
  if (network.air_at() > 0)
    all.push_back(channel("air_1_percent", "share of the dissolved air that is out in chamber 1",
                          "%", 0.01, 1));
  all.push_back(channel("dp_1_bar_per_deg", "rate of the pressure in chamber 1", "bar/deg",
                        kPascalPerBar, 1));
  all.push_back(channel("K_1_MPa", "effective bulk modulus in chamber 1", "MPa", 1e6, 1));
  for (const bool own : {true, false})
    for (const bool suction : {true, false})
      all.push_back(
          channel(std::string(suction ? "Qsb" : "Qdb") + (own ? "_1" : "") + "_l_per_min",
                  std::string("backflow ") +
                      (suction ? "into the suction port from " : "of the delivery port into ") +
                      (own ? "chamber 1" : "all chambers") + ", at suction density",
                  "l/min", kLitrePerMinute, own ? 1 : 0));
  for (const auto& [port, key] : {std::pair{&network.suction(), "as"}, {&network.delivery(), "ad"}})
    for (std::size_t i = 0; i < port->parts(); ++i)
      all.push_back(channel(std::string(key) + "_1_" + port->part(i).key + "_mm2",
                            std::string("opening of chamber 1 to the ") +
                                (key[1] == 's' ? "suction" : "delivery") +
                                " port: " + port->part(i).name,
                            "mm2", 1e-6, 1));
  for (const Place place : network.places())
    all.push_back(channel(std::string("power_") + key_of(place) + "_W",
                          std::string("power: ") + name_of(place), "W", 1, 0));
  return all;
}

// What flows against the direction in which a flow counts.
double against(double flow) { return std::max(0.0, -flow); }
double all_against(const std::vector<double>& flows) {
  double sum = 0;
  for (const double flow : flows) sum += against(flow);
  return sum;
}

double total(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum;
}

// Peak to peak over the mean of a periodic flow, from the mass passed at equal steps.
double ripple(const std::vector<double>& passed) {
  const std::size_t steps = passed.size() - 1;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (std::size_t i = 0; i < steps; ++i) {
    const std::size_t to = i + kPerWindow;
    const double mass = (to <= steps ? passed[to] : passed[to - steps] + passed.back()) - passed[i];
    least = std::min(least, mass);
    greatest = std::max(greatest, mass);
  }
  return (greatest - least) / std::abs(passed.back() * kPerWindow / static_cast<double>(steps));
}

// Share of a straight way from a to b that lies below a limit.
double share_below(double a, double b, double limit) {
  if (a < limit && b < limit) return 1;
  if (a >= limit && b >= limit) return 0;
  return (limit - std::min(a, b)) / std::abs(b - a);
}

// A piece that stays between its ends where both slopes point from one to the other (Fritsch and
// Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246).
bool stays_between(const PeriodicCubic::Piece& p, double to) {
  const double rise = (p.end_value - p.value) / (to - p.from_deg);
  if (p.slope * rise <= 0 || p.end_slope * rise <= 0) return true;  // it turns round on the way
  return std::hypot(p.slope, p.end_slope) <= 3 * std::abs(rise);
}

}  // namespace

std::vector<Channel> pressure_channels() {
  return {
      channel("p_1_bar", "pressure in chamber 1, gauge", "bar", kPascalPerBar, 1),
      channel("p_delivery_bar", "pressure in the delivery volume, gauge", "bar", kPascalPerBar, 0)};
}

TurnRecord::TurnRecord(const Network& network, double load_size, int rows)
    : network_(network),
      load_size_(load_size),
      state_(network.size()),
      power_places_(network.places()) {
  // Row i falls into segment i n / rows, seen by the chamber that starts there.
  const int n = network.pistons();
  const double period = network.period_deg();
  for (int i = 0; i < rows; ++i) {
    const int segment = static_cast<int>(static_cast<long long>(i) * n / rows);
    const double past = 360.0 * i / rows - period * segment;
    const double x = network.backwards() ? period - past : past;
    const int chamber = (n - segment - (network.backwards() ? 1 : 0)) % n;
    places_.push_back({std::clamp(x, 0.0, period * (1 - 1e-15)), i, chamber});
    angles_.push_back(360.0 * i / rows);
  }
  std::stable_sort(places_.begin(), places_.end(),
                   [](const RowPlace& a, const RowPlace& b) { return a.x < b.x; });
  delivery_.resize(rows);
  values_.resize(rows * turn_channels(network).size());
  const auto windows = static_cast<std::size_t>(std::ceil(period / kRippleWindow));
  delivered_.assign(windows * kPerWindow + 1, 0.0);
  loaded_ = delivered_;
}

void TurnRecord::add_node(const Integrator::Step& step, double x) {
  const double* y = step.state(x);
  x_.push_back(x);
  s_.insert(s_.end(), y, y + network_.pressures());
  network_.rates(x, y, load_size_, state_.data());
  slope_.insert(slope_.end(), state_.begin(), state_.begin() + network_.pressures());
  load_flow_.push_back(network_.load_flow(x, y, load_size_));
  load_pressure_.push_back(network_.load_gauge(y));
}

void TurnRecord::add_row(const Integrator::Step& step) {
  const RowPlace& place = places_[next_place_++];
  const double* y = step.state(place.x);
  const int k = place.chamber;
  network_.flows(place.x, y, load_size_, flows_);
  const double angle = angles_[place.row];
  delivery_[place.row] = network_.delivery_gauge(y);
  const double mass[] = {
      flows_.suction[k],      flows_.delivery[k],    flows_.leakage[k], total(flows_.suction),
      total(flows_.delivery), total(flows_.leakage), flows_.load};
  const double density = network_.fluid().state(network_.suction_log_pressure()).density;
  double* to = values_.data() + place.row * (values_.size() / angles_.size());
  *to++ = 0;  // the chamber's, once its curve is there
  *to++ = delivery_[place.row];
  for (const double m : mass) *to++ = m / density;
  *to++ = network_.chamber().volume(radians(angle)).value;
  *to++ = network_.suction().area(angle);
  *to++ = network_.delivery().area(angle);
  for (const double m : mass) *to++ = m;
  if (network_.has_suction_volume()) *to++ = network_.suction_gauge(y);
  if (network_.has_delivery_line()) *to++ = network_.load_gauge(y);
  if (network_.air_at() > 0) *to++ = network_.air_out(y, k);
  const Fluid::State at = network_.mixture(y, k);
  network_.rates(place.x, y, load_size_, state_.data());
  *to++ = (network_.backwards() ? -1 : 1) * at.pressure * state_[k];
  *to++ = at.stiffness * at.pressure;
  *to++ = against(flows_.suction[k]) / density;
  *to++ = against(flows_.delivery[k]) / density;
  *to++ = all_against(flows_.suction) / density;
  *to++ = all_against(flows_.delivery) / density;
  for (const auto* port : {&network_.suction(), &network_.delivery()})
    for (std::size_t i = 0; i < port->parts(); ++i) *to++ = port->part_area(i, angle);
  const PowerBudget power = network_.power(place.x, y, flows_);
  for (const Place by : power_places_) *to++ = power[by];
}

void TurnRecord::see(const Integrator::Step& step) {
  if (x_.empty() || edges_.back() == x_.size()) add_node(step, step.from);
  if (edges_.empty()) edges_.push_back(0);
  for (const double share : {0.25, 0.5, 0.75})
    add_node(step, step.from + share * (step.to - step.from));
  add_node(step, step.to);
  for (; next_place_ < places_.size() && places_[next_place_].x <= step.to;) add_row(step);
  const double grid = network_.period_deg() / static_cast<double>(delivered_.size() - 1);
  for (auto i = static_cast<std::size_t>(std::ceil(step.from / grid));
       i < delivered_.size() && static_cast<double>(i) * grid <= step.to; ++i) {
    const Integrals passed = step.integrals(static_cast<double>(i) * grid);
    delivered_[i] = passed.delivery;
    loaded_[i] = passed.load;
  }
  if (step.at_edge) edges_.push_back(x_.size());
}

void TurnRecord::finish() {
  if (!network_.backwards()) return;
  const int n = network_.pistons();
  const auto turn_round = [&](std::vector<double>& values, double sign) {
    const std::size_t width = values.size() / x_.size();
    std::vector<double> turned(values.size());
    for (std::size_t i = 0; i < x_.size(); ++i)
      for (std::size_t j = 0; j < width; ++j) {
        const auto chamber = static_cast<int>(j);
        const std::size_t to =
            width > 1 && chamber < n ? static_cast<std::size_t>((chamber + 1) % n) : j;
        turned[(x_.size() - 1 - i) * width + to] = sign * values[i * width + j];
      }
    values = std::move(turned);
  };
  for (double& x : x_) x = network_.period_deg() - x;
  turn_round(x_, 1);
  turn_round(s_, 1);
  turn_round(slope_, -1);
  turn_round(load_flow_, 1);
  turn_round(load_pressure_, 1);
  for (std::size_t& edge : edges_) edge = x_.size() - edge;
  std::reverse(edges_.begin(), edges_.end());
}

void TurnRecord::add_pieces(std::size_t first, std::size_t last, int k, double error,
                            std::vector<PeriodicCubic::Piece>& pieces, double& worst) const {
  PeriodicCubic::Piece piece{x_[first], s(first, k), slope(first, k), s(last, k), slope(last, k)};
  double off = 0, pascals_off = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double difference = std::abs(value_at(piece, x_[last], x_[i]) - s(i, k));
    off = std::max(off, difference);
    pascals_off = std::max(pascals_off, difference * network_.fluid().state(s(i, k)).pressure);
  }
  if (last > first + 1 && (off > error || !stays_between(piece, x_[last]))) {
    const std::size_t middle = (first + last) / 2;
    add_pieces(first, middle, k, error, pieces, worst);
    add_pieces(middle, last, k, error, pieces, worst);
    return;
  }
  worst = std::max(worst, pascals_off);
  pieces.push_back(piece);
}

ComputedPressure TurnRecord::curve(double error) const {
  const int n = network_.pistons();
  ComputedPressure result;
  result.atmosphere = network_.fluid().atmosphere();
  std::vector<PeriodicCubic::Piece> pieces;
  for (int segment = 0; segment < n; ++segment) {
    const int chamber = (n - segment) % n;
    const double start = network_.period_deg() * segment;
    for (std::size_t e = 0; e + 1 < edges_.size(); ++e) {
      const std::size_t before = pieces.size();
      add_pieces(edges_[e], edges_[e + 1] - 1, chamber, error, pieces, result.error);
      for (std::size_t i = before; i < pieces.size(); ++i) pieces[i].from_deg += start;
      result.edges_deg.push_back(pieces[before].from_deg);
    }
  }
  for (std::size_t i = 0; i < x_.size(); ++i)
    for (int k = 0; k < n; ++k)
      result.peak = std::max(result.peak, std::abs(network_.fluid().gauge(s(i, k))));
  result.log_pressure = PeriodicCubic(std::move(pieces));
  return result;
}

ResultTable TurnRecord::table(const PressureTrace& chamber) const {
  ResultTable table;
  table.name = "hydraulics";
  table.channels = turn_channels(network_);
  table.theta_deg = angles_;
  table.values = values_;
  const std::size_t columns = table.columns();
  for (std::size_t row = 0; row < angles_.size(); ++row) {
    table.values[row * columns] = chamber(angles_[row]);
    for (std::size_t c = 0; c < columns; ++c)
      table.values[row * columns + c] /= table.channels[c].unit_in_si;
  }
  return table;
}

double TurnRecord::difference(const std::vector<std::pair<double, std::vector<double>>>& states,
                              const ComputedPressure& curve) const {
  double worst = 0;
  for (const auto& [x, y] : states)
    for (int k = 0; k < network_.pistons(); ++k)
      worst = std::max(
          worst, std::abs(curve.gauge(network_.angle_deg(x, k)) - network_.fluid().gauge(y[k])));
  return worst;
}

std::vector<Order> TurnRecord::orders(int count) const {
  const int n = network_.pistons();
  const std::size_t nodes = x_.size();
  std::vector<double> weight(nodes);
  // Every step has its ends and three nodes between: Boole's rule.
  for (std::size_t e = 0; e + 1 < edges_.size(); ++e)
    for (std::size_t i = edges_[e]; i + 1 < edges_[e + 1]; i += 4)
      for (int j = 0; j < 5; ++j)
        weight[i + j] += (x_[i + 4] - x_[i]) * kBoole[j] / network_.period_deg();
  struct Sums {
    std::complex<double> flow, delivery, load_pressure;
  };
  std::vector<Sums> sums(count);
  for (std::size_t i = 0; i < nodes; ++i) {
    const double flow = load_flow_[i] - load_flow_[0];
    const double delivery = delivery_gauge(i) - delivery_gauge(0);
    const double load_pressure = load_pressure_[i] - load_pressure_[0];
    const std::complex<double> turned = std::polar(1.0, -radians(n * x_[i]));
    std::complex<double> wave = 2 * weight[i];
    for (Sums& sum : sums) {
      // Written out: the product of complex<double> looks for infinities.
      wave = {wave.real() * turned.real() - wave.imag() * turned.imag(),
              wave.real() * turned.imag() + wave.imag() * turned.real()};
      sum.flow += wave * flow;
      sum.delivery += wave * delivery;
      sum.load_pressure += wave * load_pressure;
    }
  }
  std::vector<Order> all;
  for (int m = 1; m <= count; ++m) {
    const Sums& sum = sums[m - 1];
    all.push_back({m * n, std::abs(sum.flow), std::abs(sum.delivery), std::abs(sum.load_pressure)});
  }
  return all;
}

void TurnRecord::summarize(const Integrals& over_period, Summary& summary) const {
  const int n = network_.pistons();
  const Fluid& fluid = network_.fluid();
  summary.chamber_least = summary.delivery_least = std::numeric_limits<double>::infinity();
  summary.chamber_greatest = summary.delivery_greatest = -summary.chamber_least;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    for (int k = 0; k < n; ++k) {
      const double p = fluid.gauge(s(i, k));
      const double angle = wrap_degrees(network_.chamber_deg(x_[i], k));
      if (p < summary.chamber_least) summary.chamber_least = p, summary.chamber_least_deg = angle;
      if (p > summary.chamber_greatest)
        summary.chamber_greatest = p, summary.chamber_greatest_deg = angle;
    }
    for (int k = 0; i > 0 && k < n; ++k) {
      const double way = x_[i] - x_[i - 1];
      summary.below_saturation_deg +=
          way * share_below(s(i - 1, k), s(i, k), fluid.log_pressure(fluid.saturation()));
      summary.below_vapour_deg +=
          way * share_below(s(i - 1, k), s(i, k), fluid.log_pressure(fluid.vapour()));
    }
    const double line = delivery_gauge(i);
    summary.delivery_least = std::min(summary.delivery_least, line);
    summary.delivery_greatest = std::max(summary.delivery_greatest, line);
  }
  summary.saturation = fluid.saturation();
  summary.vapour = fluid.vapour();
  // The end is what the grid reaches but for round-off.
  auto delivered = delivered_, loaded = loaded_;
  delivered.back() = over_period.delivery;
  loaded.back() = over_period.load;
  summary.port_flow_ripple = ripple(delivered);
  summary.flow_ripple = network_.fixed_line() ? summary.port_flow_ripple : ripple(loaded);
}

}  // namespace bentaxis::hydraulics
