#include "bentaxis/hydraulics/oil_in_time.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"
#include "network.h"

namespace bentaxis::hydraulics {
namespace {

double sum_over_chambers(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

class OilInTime : public Oil {
 public:
  OilInTime(const Case& the_case, const OilStart& start)
      : network_(the_case, Network::Use::time),
        density_(network_.fluid().state(network_.suction_log_pressure()).density),
        load_size_(size_of(network_, start)),
        share_(share_of(the_case)),
        start_(start.states.empty() ? at_rest() : start.states) {
    if (start_.size() != static_cast<std::size_t>(network_.size()))
      throw InputError(the_case.file.string() + ": the oil has " + std::to_string(network_.size()) +
                       " states, and its start " + std::to_string(start_.size()));
  }

  int pistons() const override { return network_.pistons(); }
  int states() const override { return network_.size(); }
  TakesFromOutside takes() const override {
    TakesFromOutside takes;
    takes.suction = true;
    takes.delivery = network_.fixed_end();
    takes.load_share = !network_.fixed_end();
    return takes;
  }
  void surround(const Surroundings& outside) override {
    network_.set_suction(outside.suction);
    if (network_.fixed_end()) network_.set_delivery(outside.delivery);
    outside_share_ = outside.load_share;
  }
  std::vector<double> start() const override { return start_; }
  std::vector<OilColumn> state_columns() const override { return network_.state_columns(); }
  // ln of pressures; what the lines have is over pressures and flows of the same kind.
  std::vector<double> scales() const override { return std::vector<double>(start_.size(), 1.0); }
  std::vector<double> knots() const override {
    return share_ ? share_->knots() : std::vector<double>();
  }

  std::vector<double> edges_deg() const override {
    constexpr double kOne = 1e-9;  // degrees
    std::vector<double> edges;
    for (const auto* port : {&network_.delivery(), &network_.suction()})
      for (const double edge : port->edges_deg())
        for (int k = 0; k < pistons(); ++k) {
          const double at = std::fmod(edge + network_.period_deg() * k, 360);
          edges.push_back(at > 360 - kOne ? 0 : at);
        }
    std::sort(edges.begin(), edges.end());
    edges.erase(
        std::unique(edges.begin(), edges.end(), [](double a, double b) { return b - a < kOne; }),
        edges.end());
    return edges;
  }

  std::vector<int> order_after_period() const override {
    std::vector<int> order(start_.size());
    std::iota(order.begin(), order.end(), 0);
    for (const int first : network_.by_chamber())
      for (int k = 0; k < pistons(); ++k) order[first + k] = first + (k + 1) % pistons();
    return order;
  }

  bool rates(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
             double* dy) const override {
    return network_.rates(Network::at(shaft, block), y, load_size(time), dy);
  }

  void jacobian(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
                double* by_state) const override {
    network_.jacobian(Network::at(shaft, block), y, load_size(time), by_state, nullptr);
  }

  void loads(double, const AxisMotion&, const double* y, OilLoads& loads) const override {
    loads.chamber_pressure.resize(pistons());
    for (int k = 0; k < pistons(); ++k) loads.chamber_pressure[k] = network_.fluid().gauge(y[k]);
    loads.ports = {network_.suction_gauge(y), network_.delivery_gauge(y)};
  }

  std::vector<OilPlace> places() const override {
    std::vector<OilPlace> all;
    for (const Place place : network_.places())
      all.push_back({key_of(place), name_of(place), use_of(place)});
    return all;
  }

  void powers(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
              double* power, double& mass_in, double& mass_out) const override {
    const Network::Moment now = Network::at(shaft, block);
    Network::Flows flows;
    network_.flows(now, y, load_size(time), flows);
    const PowerBudget budget = network_.power(now, y, flows);
    for (const Place place : network_.places()) *power++ = budget[place];
    mass_in = flows.taken;
    mass_out = (network_.has_loop() ? 0 : flows.load) + sum_over_chambers(flows.leakage);
  }

  void stored(double, const AxisMotion& shaft, const AxisMotion& block, const double* y,
              double& energy, double& mass) const override {
    const Network::Stored all = network_.stored(Network::at(shaft, block), y);
    energy = all.energy;
    mass = all.mass;
  }

  std::optional<OilLimits> limits() const override {
    return OilLimits{network_.fluid().saturation(), network_.fluid().vapour()};
  }

  std::vector<OilColumn> columns() const override {
    std::vector<OilColumn> all;
    const auto pressure = [&](const std::string& group, const std::string& meaning) {
      all.push_back({group + "_bar", meaning + ", gauge", "bar", group});
    };
    const auto flow = [&](const std::string& group, const std::string& meaning) {
      all.push_back({group + "_l_per_min", meaning + ", at suction density", "l/min", group});
    };
    for (int k = 1; k <= pistons(); ++k) {
      const std::string number = std::to_string(k);
      all.push_back(
          {"p_" + number + "_bar", "pressure in chamber " + number + ", gauge", "bar", "p", k});
    }
    pressure("p_suction", "pressure in the suction port");
    pressure("p_delivery", "pressure in the delivery volume");
    if (network_.has_delivery_line())
      pressure("p_load", "pressure at the end of the delivery line");
    if (network_.has_accumulator()) pressure("p_accumulator", "pressure in the accumulator");
    flow("flow_suction", network_.has_loop() ? "from the charge supply" : "taken in");
    flow("flow_delivery", "into the load");
    flow("leakage", "leakage of all chambers");
    if (network_.load().has_relief() && !network_.fixed_end())
      flow("flow_relief", "over the relief valve beside the load");
    all.push_back({"power_useful_W",
                   "what the oil carries out of the delivery volume less what it carries in to the "
                   "suction port, mass flow times pressure potential",
                   "W"});
    return all;
  }

  void row(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
           double* values) const override {
    Network::Flows flows;
    network_.flows(Network::at(shaft, block), y, load_size(time), flows);
    for (int k = 0; k < pistons(); ++k) *values++ = network_.fluid().gauge(y[k]) / kPascalPerBar;
    *values++ = network_.suction_gauge(y) / kPascalPerBar;
    *values++ = network_.delivery_gauge(y) / kPascalPerBar;
    if (network_.has_delivery_line()) *values++ = network_.load_gauge(y) / kPascalPerBar;
    if (network_.has_accumulator()) *values++ = network_.accumulator_gauge(y) / kPascalPerBar;
    const auto add_flow = [&](double mass) { *values++ = mass / density_ / kLitrePerMinute; };
    add_flow(flows.taken);
    add_flow(flows.load - flows.relief);
    add_flow(sum_over_chambers(flows.leakage));
    if (network_.load().has_relief() && !network_.fixed_end()) add_flow(flows.relief);
    *values++ = network_.port_power(y, flows);
  }

 private:
  static double size_of(const Network& network, const OilStart& start) {
    if (!network.load_sought()) return network.load().size();
    return start.load_size > 0 ? start.load_size : network.load().closed();
  }

  static std::optional<TimeSignal> share_of(const Case& the_case) {
    const auto& load = the_case.hydraulics->load;
    if (!load || load->share.time.empty()) return std::nullopt;
    return TimeSignal(load->share);
  }

  double load_size(double time) const {
    if (outside_share_) return network_.load().shared(load_size_, *outside_share_);
    return share_ ? network_.load().shared(load_size_, share_->value(time)) : load_size_;
  }

  std::vector<double> at_rest() const {
    const double suction = network_.suction_log_pressure();
    const double open = network_.has_loop() ? suction : 0;
    const double delivery = network_.fixed_end() ? network_.delivery_log_pressure() : open;
    std::vector<double> chambers(pistons(), suction);
    for (int k = 0; k < pistons(); ++k) {
      const double angle = network_.angle_deg(0, k);
      if (network_.delivery().area(angle) > network_.suction().area(angle)) chambers[k] = delivery;
    }
    return network_.at_rest(chambers, delivery);
  }

  Network network_;
  double density_;  // of all volume flows
  double load_size_;
  std::optional<TimeSignal> share_;  // of that
  std::optional<double> outside_share_;
  std::vector<double> start_;
};

}  // namespace

bool starts_periodic(const Case& the_case) {
  const DriveSpec& drive = drive_of(the_case);
  const double speed = rad_per_second(the_case.operation.speed_rpm);
  const bool by_curve = drive.kind == DriveKind::speed && !drive.curve.time.empty();
  const double start =
      by_curve ? TimeSignal(drive.curve).value(0) : drive.start_speed.value_or(speed);
  return speed != 0 && start == speed;
}

bool needs_periodic_state(const Case& the_case) {
  const LoadData load = the_case.hydraulics->load.value_or(LoadData());
  const bool held =
      the_case.pressure.ports.delivery == 0 || load.kind == LoadKind::constant_pressure;
  return starts_periodic(the_case) || (!held && !load.sets_pressure());
}

OilStart running(const SteadyState& state) {
  return {state.corrected_load_size, state.corrected_states};
}

OilStart at_rest(const SteadyState& state) { return {state.corrected_load_size, {}}; }

std::unique_ptr<Oil> oil_in_time(const Case& the_case, const OilStart& start) {
  return std::make_unique<OilInTime>(the_case, start);
}

}  // namespace bentaxis::hydraulics
