#include "loads/film.h"

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {
namespace {

// Calls visit(x, weight) for the points of the five-point rule on [a, b], from a to b.
template <class Visit>
void quadrature(double a, double b, Visit visit) {
  // In extended precision, so that the tables are right to the last digit of a double.
  using Rule = boost::math::quadrature::gauss<long double, 5>;
  const auto& points = Rule::abscissa();  // those from 0 on: the others are their mirror images
  const auto& weights = Rule::weights();
  const int last = static_cast<int>(points.size()) - 1;
  for (int i = -last; i <= last; ++i) {
    const auto at = static_cast<double>(i < 0 ? -points[-i] : points[i]);
    visit((a + b) / 2 + (b - a) / 2 * at, (b - a) / 2 * static_cast<double>(weights[std::abs(i)]));
  }
}

void add_port(FilmLoad& load, const PortPlate& plate, const PortArc& arc, double port_pressure) {
  const std::array<std::pair<double, double>, 3> rings = {
      {{plate.r1, plate.r2}, {plate.r2, plate.r3}, {plate.r3, plate.r4}}};
  const auto pressure = [&](double r) {
    if (r < plate.r2) return port_pressure * (r - plate.r1) / (plate.r2 - plate.r1);
    if (r > plate.r3) return port_pressure * (plate.r4 - r) / (plate.r4 - plate.r3);
    return port_pressure;
  };
  constexpr int kPanels = 36;  // at most 10 degrees each
  const double from = radians(arc.from_deg);
  const double width = radians(arc.to_deg - arc.from_deg) / kPanels;
  for (int panel = 0; panel < kPanels; ++panel) {
    quadrature(from + panel * width, from + (panel + 1) * width, [&](double psi, double d_psi) {
      for (const auto& [inner, outer] : rings) {
        quadrature(inner, outer, [&](double r, double d_r) {
          const double push = pressure(r) * r * d_r * d_psi;  // along -z2
          const double x = -r * std::sin(psi);
          const double y = r * std::cos(psi);
          load.force_z -= push;
          load.moment_x -= y * push;
          load.moment_y += x * push;
        });
      }
    });
  }
}

}  // namespace

FilmLoad film_load(const PortPlate& plate, const PortPressures& ports) {
  FilmLoad load;
  add_port(load, plate, plate.delivery, ports.delivery);
  add_port(load, plate, plate.suction, ports.suction);
  return load;
}

}  // namespace bentaxis::multibody
