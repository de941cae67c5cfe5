#include "machine.h"

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::fmu {
namespace {

bool has_oil(const Case& the_case) { return the_case.pressure.kind == PressureKind::hydraulic; }

}  // namespace

Machine::Machine(const Case& given, const hydraulics::OilStart& start) : the_case(given) {
  validate(the_case);
  drive_of(the_case);
  if (!has_oil(the_case)) pressure.emplace(the_case.pressure);
  mechanics = analytic::mechanics(the_case, the_case.analytic);
  oil = pressure ? coupled::prescribed_oil(the_case.pump.geometry.pistons, *pressure,
                                           the_case.pressure.ports)
                 : hydraulics::oil_in_time(the_case, start);
}

hydraulics::OilStart oil_start(Case& the_case, bool from_rest) {
  if (!has_oil(the_case)) return {};
  const bool periodic = !from_rest && hydraulics::starts_periodic(the_case);
  if (!periodic && !hydraulics::needs_periodic_state(the_case)) return {};
  const hydraulics::SteadyState state = hydraulics::steady_state(the_case);
  hydraulics::give_to(the_case, state);
  return periodic ? hydraulics::running(state) : hydraulics::at_rest(state);
}

}  // namespace bentaxis::fmu
