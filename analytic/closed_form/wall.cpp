#include "closed_form/wall.h"

#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
void prepare(const RawPump<T>& pump, WallNumbers<T>& p) {
  const auto& wall = pump.transfer.wall;
  p.along = wall.from_joint / pump.geometry.piston_length;
  p.share = 1 - p.along;
  p.on_bore = wall.from_joint / pump.piston.contact;
  p.clearance = wall.clearance;
  p.stiffness = wall.stiffness * kWallApproach;
  p.exponent = wall.exponent;
  p.dissipation = wall.dissipation;
}
template void prepare(const RawPump<double>& pump, WallNumbers<double>& p);
template void prepare(const RawPump<Dual>& pump, WallNumbers<Dual>& p);
template void prepare(const RawPump<long double>& pump, WallNumbers<long double>& p);

}  // namespace bentaxis::analytic::closed_form
