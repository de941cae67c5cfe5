#include "bentaxis/hydraulics/oil_in_time.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "bentaxis/pump/delivery_side.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
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
        density_(checked(the_case).fluid().state(network_.suction_log_pressure()).density),
        load_size_(size_of(network_, start)),
        share_(share_of(the_case)),
        start_(start.states.empty() ? at_rest() : start.states) {
    if (start_.size() != static_cast<std::size_t>(network_.size()))
      throw InputError(the_case.file.string() + ": the oil has " + std::to_string(network_.size()) +
                       " states, and its start " + std::to_string(start_.size()));
  }

  // In time the mechanics move the pistons: of a stroke of its own the oil would do other work.
  const Network& checked(const Case& the_case) const {
    if (network_.chamber().is_given())
      throw InputError(the_case.file.string() +
                       ": [hydraulics] stroke_file: refused in a simulation in time: there the oil "
                       "acts on pistons that move by the pump's own geometry");
    return network_;
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
  void surround(const Surroundings& outside) override { set_inputs(outside); }
  void set_inputs(const Surroundings& outside) override {
    outside_ = outside;
    hold(outside.time);
  }
  std::vector<double> start() const override { return start_; }
  std::vector<OilColumn> state_columns() const override { return network_.state_columns(); }
  // ln of pressures; what the lines have is over pressures and flows of the same kind.
  std::vector<double> scales() const override { return std::vector<double>(start_.size(), 1.0); }
  std::vector<double> breakpoints() const override {
    return share_ ? share_->breakpoints() : std::vector<double>();
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
    sort_once(edges, kOne);
    return edges;
  }

  std::vector<int> order_after_period() const override { return network_.order_after_period(); }

  bool rates(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
             double* dy) const override {
    follow(time);
    return network_.rates(Network::at(shaft, block), y, load_size(time), dy);
  }

  void jacobian(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
                double* by_state) const override {
    follow(time);
    network_.jacobian(Network::at(shaft, block), y, load_size(time), by_state, nullptr);
  }

  void loads(double time, const AxisMotion&, const double* y, OilLoads& loads) const override {
    follow(time);
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
    follow(time);
    const Network::Moment now = Network::at(shaft, block);
    Network::Flows flows;
    network_.flows(now, y, load_size(time), flows);
    const PowerBudget budget = network_.power(now, y, flows);
    for (const Place place : network_.places()) *power++ = budget[place];
    mass_in = flows.taken;
    mass_out = (network_.has_loop() ? 0 : flows.load) + sum_over_chambers(flows.leakage);
  }

  void stored(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
              double& energy, double& mass) const override {
    follow(time);
    const Network::Stored all = network_.stored(Network::at(shaft, block), y);
    energy = all.energy;
    mass = all.mass;
  }

  std::optional<OilLimits> limits() const override {
    return OilLimits{network_.fluid().saturation(), network_.fluid().vapour()};
  }

  std::vector<OilColumn> columns() const override {
    std::vector<OilColumn> all;
    for (const Column& column : columns_) all.push_back(column.column);
    return all;
  }

  void row(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
           double* values) const override {
    follow(time);
    Network::Flows flows;
    network_.flows(Network::at(shaft, block), y, load_size(time), flows);
    for (const Column& column : columns_) *values++ = column.value(y, flows);
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

  // The pressures outside, as they are at a time.
  void hold(double time) const {
    network_.set_suction(outside_.suction_at(time));
    if (network_.fixed_end()) network_.set_delivery(outside_.delivery_at(time));
  }
  // Where they change with time; where they do not they are held already.
  void follow(double time) const {
    if (!outside_.pressures_are_held()) hold(time);
  }

  double load_size(double time) const {
    if (const auto share = outside_.load_share_at(time))
      return network_.load().shared(load_size_, *share);
    return share_ ? network_.load().shared(load_size_, share_->value(time)) : load_size_;
  }

  // A column and its value at a state.
  struct Column {
    OilColumn column;
    std::function<double(const double* y, const Network::Flows& flows)> value;
  };

  std::vector<Column> all_columns() const {
    using Flows = Network::Flows;
    std::vector<Column> all;
    const auto pressure = [&](const std::string& group, const std::string& where, auto gauge,
                              int chamber = 0) {
      const std::string of = chamber > 0 ? "_" + std::to_string(chamber) : "";
      all.push_back({{group + of + "_bar", "pressure " + where + ", gauge", "bar", group, chamber},
                     [gauge](const double* y, const Flows&) { return gauge(y) / kPascalPerBar; }});
    };
    const auto flow = [&](const std::string& group, const std::string& what, auto mass) {
      all.push_back({{group + "_l_per_min", what + ", at suction density", "l/min", group},
                     [this, mass](auto, const Flows& flows) {
                       return mass(flows) / density_ / kLitrePerMinute;
                     }});
    };
    for (int k = 0; k < pistons(); ++k)
      pressure(
          "p", "in chamber " + std::to_string(k + 1),
          [this, k](const double* y) { return network_.fluid().gauge(y[k]); }, k + 1);
    pressure("p_suction", "in the suction port",
             [this](const double* y) { return network_.suction_gauge(y); });
    pressure("p_delivery", "in the delivery volume",
             [this](const double* y) { return network_.delivery_gauge(y); });
    if (network_.has_delivery_line())
      pressure("p_load", "at the end of the delivery line",
               [this](const double* y) { return network_.load_gauge(y); });
    if (network_.has_accumulator())
      pressure("p_accumulator", "in the accumulator",
               [this](const double* y) { return network_.accumulator_gauge(y); });
    flow("flow_suction", network_.has_loop() ? "from the charge supply" : "taken in",
         [](const Flows& flows) { return flows.taken; });
    flow("flow_delivery", "into the load",
         [](const Flows& flows) { return flows.load - flows.relief; });
    flow("leakage", "leakage of all chambers",
         [](const Flows& flows) { return sum_over_chambers(flows.leakage); });
    if (network_.load().has_relief() && !network_.fixed_end())
      flow("flow_relief", "through the relief valve parallel to the load",
           [](const Flows& flows) { return flows.relief; });
    all.push_back(
        {{"power_useful_W",
          "power that the oil carries out of the delivery volume less that into the suction port, "
          "mass flow times pressure potential",
          "W"},
         [this](const double* y, const Flows& flows) { return network_.port_power(y, flows); }});
    return all;
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

  mutable Network network_;  // which holds the pressures outside at the time that was asked last
  double density_;           // of all volume flows
  double load_size_;
  std::optional<TimeSignal> share_;  // of that
  Surroundings outside_;
  std::vector<double> start_;
  std::vector<Column> columns_ = all_columns();
};

}  // namespace

bool starts_periodic(const Case& the_case) {
  const double speed = rad_per_second(the_case.operation.speed_rpm);
  return speed != 0 && start_speed(drive_of(the_case), speed) == speed;
}

bool needs_periodic_state(const Case& the_case) {
  const LoadData load = the_case.hydraulics->load.value_or(LoadData());
  return starts_periodic(the_case) || (!delivery_is_held(the_case) && !load.sets_pressure());
}

OilStart running(const SteadyState& state) {
  return {state.corrected_load_size, state.corrected_states};
}

OilStart at_rest(const SteadyState& state) { return {state.corrected_load_size, {}}; }

std::unique_ptr<Oil> oil_in_time(const Case& the_case, const OilStart& start) {
  return std::make_unique<OilInTime>(the_case, start);
}

}  // namespace bentaxis::hydraulics
