#include "bentaxis/coupled/prescribed_oil.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"

namespace bentaxis::coupled {
namespace {

class PrescribedOil : public Oil {
 public:
  PrescribedOil(int pistons, const PressureTrace& pressure, const PortPressures& ports)
      : pistons_(pistons),
        pressure_(pressure),
        ports_(ports),
        edges_deg_(block_edges_deg(pressure, pistons)) {}

  int pistons() const override { return pistons_; }
  int states() const override { return 0; }
  // Of ports alone: a curve says by itself what the pressure is.
  TakesFromOutside takes() const override {
    TakesFromOutside takes;
    takes.suction = takes.delivery = pressure_.ideal_share(0).has_value();
    return takes;
  }
  void surround(const Surroundings& outside) override { set_inputs(outside); }
  void set_inputs(const Surroundings& outside) override { outside_ = outside; }
  std::vector<double> start() const override { return {}; }
  std::vector<double> scales() const override { return {}; }
  std::vector<double> edges_deg() const override { return edges_deg_; }
  std::vector<double> breakpoints() const override { return {}; }
  std::vector<int> order_after_period() const override { return {}; }

  bool rates(double, const AxisMotion&, const AxisMotion&, const double*, double*) const override {
    return true;
  }
  void jacobian(double, const AxisMotion&, const AxisMotion&, const double*,
                double*) const override {}
  void loads(double time, const AxisMotion& block, const double*, OilLoads& loads) const override {
    const auto suction = outside_.suction_at(time), delivery = outside_.delivery_at(time);
    const bool from_outside = suction || delivery;
    const PortPressures now{suction.value_or(ports_.suction), delivery.value_or(ports_.delivery)};
    loads.chamber_pressure.resize(static_cast<std::size_t>(pistons_));
    const double degrees = on_its_side(block);
    for (int k = 0; k < pistons_; ++k) {
      const double angle = piston_angle_deg(degrees, k + 1, pistons_);
      loads.chamber_pressure[k] =
          from_outside ? now.suction + (now.delivery - now.suction) * *pressure_.ideal_share(angle)
                       : pressure_(angle);
    }
    loads.ports = now;
  }

  std::vector<OilPlace> places() const override { return {}; }
  void powers(double, const AxisMotion&, const AxisMotion&, const double*, double*, double& mass_in,
              double& mass_out) const override {
    mass_in = mass_out = 0;
  }
  void stored(double, const AxisMotion&, const AxisMotion&, const double*, double& energy,
              double& mass) const override {
    energy = mass = 0;
  }
  std::vector<OilColumn> columns() const override { return {}; }
  void row(double, const AxisMotion&, const AxisMotion&, const double*, double*) const override {}

 private:
  // Block angle in degrees, or a hair before an edge at which it stands while it turns backwards: a
  // pressure that jumps there has the value of the side that the block turns to.
  double on_its_side(const AxisMotion& block) const {
    constexpr double kOnEdge = 2e-9, kHair = 4e-9;  // the trace takes 1e-9 to be on an edge
    const double degrees = block.angle / kRadPerDegree;
    if (block.speed >= 0) return degrees;
    const double wrapped = wrap_degrees(degrees);
    const auto is_near = [&](double edge) {
      return std::abs(std::remainder(edge - wrapped, 360.0)) <= kOnEdge;
    };
    return std::any_of(edges_deg_.begin(), edges_deg_.end(), is_near) ? degrees - kHair : degrees;
  }

  int pistons_;
  const PressureTrace& pressure_;
  PortPressures ports_;
  Surroundings outside_;
  std::vector<double> edges_deg_;
};

}  // namespace

std::unique_ptr<Oil> prescribed_oil(int pistons, const PressureTrace& pressure,
                                    const PortPressures& ports) {
  return std::make_unique<PrescribedOil>(pistons, pressure, ports);
}

}  // namespace bentaxis::coupled
