#include "closed_form/block.h"

namespace bentaxis::analytic::closed_form {

void prepare(const PumpParameters& pump, const PistonNumbers<double>& piston,
             BlockNumbers<double>& p) {
  const Block& block = pump.block;
  p.bottom_area = block.bottom_area;
  p.force_y = block.mass * piston.gravity_y;
  p.force_z = block.spring_force + block.mass * piston.gravity_z;
  p.moment_x = -block.centre_of_mass_z * block.mass * piston.gravity_y;
  p.inertia = block.axial_inertia;
  p.viscous = pump.friction.block_viscous;
  p.pin_z = block.pin_z;
  p.contact = ring_contact(pump) / pump.geometry.piston_length;
}

}  // namespace bentaxis::analytic::closed_form
