#include "prepared.h"

#include <cmath>

#include "bentaxis/pump/units.h"

namespace bentaxis::analytic {

PreparedPump prepare(const PumpParameters& pump, const Assumptions& assumptions) {
  PreparedPump result;
  closed_form::Pump<double>& p = result.numbers;
  closed_form::prepare(pump.geometry, p.frame);
  closed_form::prepare(pump.geometry, p.frame, p.piston);
  closed_form::prepare(pump, assumptions.inertia, p.frame, p.piston);
  result.friction = closed_form::prepare(pump, assumptions.piston_friction, p.friction);
  closed_form::prepare(pump, p.piston, p.block);
  closed_form::prepare(pump, p.film);
  closed_form::prepare(pump, p.gear);
  closed_form::prepare(pump, p.frame, p.shaft);
  result.tooth_law = closed_form::tooth_law(pump.gear);
  if (pump.gear.contact == ToothContact::teeth)
    result.teeth = BevelTeeth(pump, BevelTeeth::Unchecked{});
  result.imposed = assumptions.gear == BlockDrive::imposed;
  for (int k = 0; k < pump.geometry.pistons; ++k) {
    result.phase_sin.push_back(std::sin(2 * kPi * k / pump.geometry.pistons));
    result.phase_cos.push_back(std::cos(2 * kPi * k / pump.geometry.pistons));
  }
  return result;
}

}  // namespace bentaxis::analytic
