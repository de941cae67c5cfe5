#include "closed_form/gear.h"

#include <algorithm>
#include <cmath>

#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

// Axes bent by alpha and equal tooth counts make delta = 90 deg - alpha/2.
template <class T>
void prepare(const RawPump<T>& pump, Flanks flanks, GearNumbers<T>& p) {
  using std::cos, std::sin, std::tan;
  const T half = pump.geometry.tilt / 2;
  const T radius = pump.gear.pitch_diameter / 2;
  const T sin_p = sin(pump.gear.pressure_angle);
  const T cos_p = cos(pump.gear.pressure_angle);
  p.y = radius;
  p.z1 = pump.geometry.axis_offset - radius * tan(half);
  p.z2 = radius * tan(half);
  p.line_x = -cos_p;
  p.line_y1 = sin_p * sin(half);
  p.line_z1 = sin_p * cos(half);
  p.line_y2 = -p.line_y1;
  p.line_z2 = p.line_z1;
  p.inverse_arm = 1 / (radius * cos_p);
  p.two_flanks = flanks == Flanks::two ? 1 : 0;
}
template void prepare(const RawPump<double>& pump, Flanks flanks, GearNumbers<double>& p);
template void prepare(const RawPump<Dual>& pump, Flanks flanks, GearNumbers<Dual>& p);
template void prepare(const RawPump<long double>& pump, Flanks flanks, GearNumbers<long double>& p);

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
