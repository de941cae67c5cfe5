#include "prepared.h"

#include <cmath>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic {

PreparedPump prepare(const PumpParameters& pump, const Assumptions& assumptions) {
  PreparedPump result;
  prepare(pump, assumptions, result);
  return result;
}

void prepare(const PumpParameters& pump, const Assumptions& assumptions, PreparedPump& result) {
  const PistonInertia inertia = assumptions.inertia;
  if (const std::string why = piston_inertia_refusal(inertia, pump); !why.empty())
    throw InputError(to_string(inertia) + " pistons: " + why);
  result.friction = prepare_numbers(closed_form::raw(pump), pump, assumptions, result.numbers);
  result.tooth_law = closed_form::tooth_law(pump.gear);
  result.teeth.reset();
  if (pump.gear.contact == ToothContact::teeth)
    result.teeth = BevelTeeth(pump, BevelTeeth::Unchecked{});
  if (const std::string why = imposed_refusal(assumptions.gear, pump); !why.empty())
    throw InputError("gear = \"imposed\": " + why);
  result.transfer = pump.transfer.kind;
  result.imposed = assumptions.gear == BlockDrive::imposed;
  const auto pistons = static_cast<std::size_t>(pump.geometry.pistons);
  result.clearances.clear();
  if (pump.transfer.wall && !pump.transfer.wall->deviation.empty())
    for (std::size_t k = 0; k < pistons; ++k)
      result.clearances.push_back(pump.transfer.wall->clearance_of(k));
  if (result.phase_sin.size() == pistons) return;
  result.phase_sin.clear();
  result.phase_cos.clear();
  for (int k = 0; k < pump.geometry.pistons; ++k) {
    result.phase_sin.push_back(std::sin(2 * kPi * k / pump.geometry.pistons));
    result.phase_cos.push_back(std::cos(2 * kPi * k / pump.geometry.pistons));
  }
}

}  // namespace bentaxis::analytic
