#include "bentaxis/analytic/mechanics.h"

#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"
#include "simulation/equations.h"

namespace bentaxis::analytic {
namespace {

using simulation::Equations;
using simulation::Motion;

// For the sizes of what acts: chambers at the pressures of the ports.
PressureTrace port_pressures(const Case& the_case) {
  constexpr double kTransition = 20;  // deg
  PressureSpec spec;
  spec.ports = the_case.pressure.ports;
  spec.transition_deg = kTransition;
  return PressureTrace(spec);
}

class ClosedForm : public Mechanics {
 public:
  ClosedForm(const Case& the_case, const Assumptions& assumptions)
      : pressure_(port_pressures(the_case)), equations_(the_case, assumptions, pressure_) {
    require_smooth_friction(the_case);
  }

  const ChannelLayout& layout() const override { return equations_.model().layout(); }
  MotionVector start() const override { return equations_.start({}); }
  void surround(const Surroundings& outside) override { set_inputs(outside); }
  void set_inputs(const Surroundings& outside) override { equations_.set_inputs(outside); }
  MotionVector scales() const override { return equations_.scales(); }
  bool shaft_is_free() const override { return equations_.drive().kind != DriveKind::speed; }
  bool compliant() const override { return equations_.compliant(); }
  bool has_motor() const override { return equations_.drive().kind == DriveKind::motor; }
  std::vector<double> breakpoints() const override { return equations_.breakpoints(); }

  AxisMotion shaft(double time, const MotionVector& y) const override {
    return equations_.shaft(time, y);
  }
  AxisMotion block(double time, const MotionVector& y) const override {
    return equations_.block(equations_.shaft(time, y), y);
  }
  bool carried_by_pistons() const override { return equations_.walls().has_value(); }
  double approach(double time, const MotionVector& y, int contact) const override {
    if (equations_.walls()) return wall(time, y, contact).distance;
    return equations_.bevel() ? equations_.approach_of_teeth(time, y, contact).distance
                              : equations_.approach(y, contact);
  }
  double approach_rate(double time, const MotionVector& y, int contact) const override {
    if (equations_.walls()) return wall(time, y, contact).rate;
    return equations_.bevel() ? equations_.approach_of_teeth(time, y, contact).rate
                              : equations_.approach_rate(y, contact);
  }
  bool teeth(double time, const MotionVector& y, TeethAction& action) override {
    if (!equations_.bevel()) return false;
    const AxisMotion turning = equations_.shaft(time, y);
    action = equations_.bevel()->act(turning.angle, turning.speed, {y[kLag], y[kLagRate]});
    return true;
  }

  void rates(double time, const MotionVector& y, const OilLoads& loads, MotionVector& dy) override {
    equations_.set_loads(loads);
    equations_.rates_under_loads(time, y, dy);
  }
  double pressure_power(double time, const MotionVector& y, const OilLoads& loads) override {
    equations_.set_loads(loads);
    return equations_.pressure_power(time, y);
  }
  void row(double time, const MotionVector& y, const OilLoads& loads, std::vector<double>& state,
           std::vector<double>& row, MotionChecks& checks) override {
    equations_.set_loads(loads);
    const Motion m = equations_.motion_under_loads(time, y);
    equations_.row(time, y, m, state, row, checks);
  }
  std::vector<BodyLoad> body_loads(double time, const MotionVector& y,
                                   const OilLoads& loads) override {
    equations_.set_loads(loads);
    equations_.motion_under_loads(time, y);
    return equations_.body_loads();
  }
  double kinetic_energy(double time, const MotionVector& y) override {
    return equations_.kinetic_energy(time, y);
  }
  double potential_energy(const MotionVector& y) const override {
    return equations_.potential_energy(y);
  }
  double elastic_energy(double time, const MotionVector& y) const override {
    return equations_.potential_energy(y) + equations_.wall_energy(time, y);
  }

 private:
  const simulation::WallPath& wall(double time, const MotionVector& y, int piston) const {
    return equations_.wall_paths(time, y)[static_cast<std::size_t>(piston) - 1];
  }

  PressureTrace pressure_;
  Equations equations_;
};

}  // namespace

std::unique_ptr<Mechanics> mechanics(const Case& the_case, const Assumptions& assumptions) {
  return std::make_unique<ClosedForm>(the_case, assumptions);
}

}  // namespace bentaxis::analytic
