#include "closed_form/block.h"

#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
void prepare(const RawPump<T>& pump, const PistonNumbers<T>& piston, BlockNumbers<T>& p) {
  const auto& block = pump.block;
  p.bottom_area = block.bottom_area;
  p.force_y = block.mass * piston.gravity_y;
  p.force_z = block.spring_force + block.mass * piston.gravity_z;
  p.moment_x = -block.centre_of_mass_z * block.mass * piston.gravity_y;
  p.inertia = block.axial_inertia;
  p.viscous = pump.friction.block_viscous;
  p.pin_z = block.pin_z;
  p.contact = pump.piston.contact / pump.geometry.piston_length;
}
template void prepare(const RawPump<double>& pump, const PistonNumbers<double>& piston,
                      BlockNumbers<double>& p);
template void prepare(const RawPump<Dual>& pump, const PistonNumbers<Dual>& piston,
                      BlockNumbers<Dual>& p);
template void prepare(const RawPump<long double>& pump, const PistonNumbers<long double>& piston,
                      BlockNumbers<long double>& p);

}  // namespace bentaxis::analytic::closed_form
