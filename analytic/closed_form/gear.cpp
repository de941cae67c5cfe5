#include "closed_form/gear.h"

#include <algorithm>
#include <cmath>

namespace bentaxis::analytic::closed_form {

// Axes bent by alpha and equal tooth counts make delta = 90 deg - alpha/2.
void prepare(const PumpParameters& pump, GearNumbers<double>& p) {
  const double half = pump.geometry.tilt / 2;
  const double radius = pump.gear.pitch_diameter / 2;
  const double sin_p = std::sin(pump.gear.pressure_angle);
  const double cos_p = std::cos(pump.gear.pressure_angle);
  p.y = radius;
  p.z1 = pump.geometry.axis_offset - radius * std::tan(half);
  p.z2 = radius * std::tan(half);
  p.line_x = -cos_p;
  p.line_y1 = sin_p * std::sin(half);
  p.line_z1 = sin_p * std::cos(half);
  p.line_y2 = -p.line_y1;
  p.line_z2 = p.line_z1;
  p.inverse_arm = 1 / (radius * cos_p);
  p.two_flanks = pump.gear.flanks == Flanks::two ? 1 : 0;
}

double ToothLaw::flank(double approach, double speed) const {
  if (!(approach > 0)) return 0;
  const double spring = stiffness * kToothApproach * std::pow(approach / kToothApproach, exponent);
  return std::max(0.0, spring * (1 + dissipation * speed));
}

std::optional<ToothLaw> tooth_law(const Gear& gear) {
  if (gear.contact != ToothContact::compliant || !gear.compliance) return {};
  const ToothCompliance& c = *gear.compliance;
  return ToothLaw{gear.pitch_diameter / 2 * std::cos(gear.pressure_angle), c.backlash / 2,
                  c.stiffness, c.exponent, c.dissipation};
}

}  // namespace bentaxis::analytic::closed_form
