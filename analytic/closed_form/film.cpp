#include "closed_form/film.h"

#include <cmath>

#include "bentaxis/pump/units.h"
#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
LandForce<T> land_force(const RawPlate<T>& p, const RawArc<T>& arc) {
  using std::cos, std::sin;
  // Integrals over r of w(r) r and w(r) r^2, with w the trapezoid 0, 1, 1, 0 at r1 .. r4.
  const T first = (p.r2 - p.r1) * (p.r1 + 2 * p.r2) / 6 + (p.r3 - p.r2) * (p.r3 + p.r2) / 2 +
                  (p.r4 - p.r3) * (p.r4 + 2 * p.r3) / 6;
  const T second = (p.r2 - p.r1) * (p.r1 * p.r1 + 2 * p.r1 * p.r2 + 3 * p.r2 * p.r2) / 12 +
                   (p.r3 - p.r2) * (p.r3 * p.r3 + p.r3 * p.r2 + p.r2 * p.r2) / 3 +
                   (p.r4 - p.r3) * (p.r4 * p.r4 + 2 * p.r4 * p.r3 + 3 * p.r3 * p.r3) / 12;
  // A point at angle psi is (-r sin psi, r cos psi); each element pushes along -z2.
  const T from = arc.from_deg * kRadPerDegree;
  const T to = arc.to_deg * kRadPerDegree;
  return {-first * (to - from), -second * (sin(to) - sin(from)), second * (cos(to) - cos(from))};
}

template LandForce<double> land_force(const RawPlate<double>& p, const RawArc<double>& arc);

template <class T>
void prepare(const RawPump<T>& pump, bool plate, FilmNumbers<T>& film) {
  const T zero = 0;
  film = {{zero, zero, zero}, {zero, zero, zero}};
  if (!plate) return;
  film.delivery = land_force(pump.plate, pump.plate.delivery);
  film.suction = land_force(pump.plate, pump.plate.suction);
}
template void prepare(const RawPump<double>& pump, bool plate, FilmNumbers<double>& film);
template void prepare(const RawPump<Dual>& pump, bool plate, FilmNumbers<Dual>& film);
template void prepare(const RawPump<long double>& pump, bool plate, FilmNumbers<long double>& film);

}  // namespace bentaxis::analytic::closed_form
