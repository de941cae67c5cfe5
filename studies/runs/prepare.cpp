// From a case to one that the models can be run on.
#include <utility>

#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

namespace {

// Refuses teeth that do not mesh, with the case that has them.
void require_mesh(const Case& the_case) {
  if (the_case.pump.gear.contact != ToothContact::teeth) return;
  try {
    const analytic::BevelTeeth teeth(the_case.pump);
  } catch (const InputError& error) {
    if (the_case.file.empty()) throw;
    throw InputError(the_case.file.string() + ": " + error.what());
  }
}

}  // namespace

PreparedCase prepare(Case the_case, const PartProgress& progress_of) {
  require_mesh(the_case);
  if (the_case.pressure.kind == PressureKind::hydraulic) require_constant_speed(the_case);
  return prepare_start(std::move(the_case), progress_of);
}

PreparedCase prepare_start(Case the_case, const PartProgress& progress_of) {
  require_mesh(the_case);
  std::optional<hydraulics::SteadyState> state;
  if (the_case.pressure.kind == PressureKind::hydraulic) {
    state = hydraulics::steady_state(the_case, {}, progress_of("hydraulics"));
    hydraulics::give_to(the_case, *state);
  }
  PressureTrace pressure(the_case.pressure);
  return {std::move(the_case), std::move(state), std::move(pressure)};
}

}  // namespace bentaxis::study
