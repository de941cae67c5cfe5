#include "closed_form/film.h"

#include <cmath>

#include "bentaxis/pump/units.h"

namespace bentaxis::analytic::closed_form {

LandForce<double> land_force(const PortPlate& p, const PortArc& arc) {
  // Integrals over r of w(r) r and w(r) r^2, with w the trapezoid 0, 1, 1, 0 at r1 .. r4.
  const double first = (p.r2 - p.r1) * (p.r1 + 2 * p.r2) / 6 + (p.r3 - p.r2) * (p.r3 + p.r2) / 2 +
                       (p.r4 - p.r3) * (p.r4 + 2 * p.r3) / 6;
  const double second = (p.r2 - p.r1) * (p.r1 * p.r1 + 2 * p.r1 * p.r2 + 3 * p.r2 * p.r2) / 12 +
                        (p.r3 - p.r2) * (p.r3 * p.r3 + p.r3 * p.r2 + p.r2 * p.r2) / 3 +
                        (p.r4 - p.r3) * (p.r4 * p.r4 + 2 * p.r4 * p.r3 + 3 * p.r3 * p.r3) / 12;
  // A point at angle psi is (-r sin psi, r cos psi); each element pushes along -z2.
  const double from = radians(arc.from_deg);
  const double to = radians(arc.to_deg);
  return {-first * (to - from), -second * (std::sin(to) - std::sin(from)),
          second * (std::cos(to) - std::cos(from))};
}

void prepare(const PumpParameters& pump, FilmNumbers<double>& film) {
  film = {};
  if (!pump.port_plate) return;
  film.delivery = land_force(*pump.port_plate, pump.port_plate->delivery);
  film.suction = land_force(*pump.port_plate, pump.port_plate->suction);
}

}  // namespace bentaxis::analytic::closed_form
