// The paper's model written a second time, for tests, shaft and block each at its own angle:
// positions only, everything else from second-order jets of them, and every body a dense system of
// force and moment equations as printed
// ((33), (44), (57)). Slow and plain on purpose; shares no code with analytic/.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/instant.h"

namespace bentaxis::test {

/// Value with first and second derivative with respect to time.
struct Jet {
  double v = 0, d = 0, dd = 0;
  Jet(double value = 0, double first = 0, double second = 0) : v(value), d(first), dd(second) {}
};
inline Jet operator+(Jet a, Jet b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
inline Jet operator-(Jet a, Jet b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
inline Jet operator*(Jet a, Jet b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2 * a.d * b.d + a.v * b.dd};
}
inline Jet sqrt(Jet a) {
  const double r = std::sqrt(a.v);
  const double d = a.d / (2 * r);
  return {r, d, (a.dd - 2 * d * d) / (2 * r)};
}

/// Sine and cosine of an angle that turns.
inline Jet sine(double angle, const AxisMotion& m) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  return {s, c * m.speed, c * m.acceleration - s * m.speed * m.speed};
}
inline Jet cosine(double angle, const AxisMotion& m) { return sine(angle + kPi / 2, m); }

/// Unknowns of all bodies at an instant, ordered by ChannelLayout (reactions only).
class PrintedModel {
 public:
  PrintedModel(const PumpParameters& pump, const Assumptions& assumptions)
      : p_(pump), a_(assumptions) {}

  std::vector<double> reactions(const Instant& t) const;

  /// Film on the lands, in S2 about O2: added to force and moment.
  void add_film(const PortPressures& ports, Eigen::Vector3d& force, Eigen::Vector3d& moment) const;

 private:
  PumpParameters p_;
  Assumptions a_;
};

}  // namespace bentaxis::test
