// Reactions at given states of shaft and block.
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/results/stopwatch.h"

namespace bentaxis::multibody {

MotionTable run_states(const Case& the_case, const Assumptions& assumptions, const States& states,
                       const Progress& progress, std::optional<Method> method, ResultTable* teeth,
                       BodyLoadTable* loads) {
  validate(the_case);
  if (states.pistons != the_case.pump.geometry.pistons)
    throw InputError("states of " + std::to_string(states.pistons) + " pistons for a pump with " +
                     std::to_string(the_case.pump.geometry.pistons));
  const Stopwatch stopwatch;
  Model model(the_case.pump, assumptions, 1, Scene::full, method);
  if (teeth != nullptr) {
    *teeth = teeth_table("multibody");
    if (!model.has_teeth()) teeth = nullptr;
  }
  if (loads != nullptr) *loads = BodyLoadTable::of(states.rows());
  std::size_t next = 0;
  MotionTable table = tabulate_states(
      "multibody", model.layout(), states,
      [&](const Instant& instant, std::vector<double>& row, MotionChecks& checks) {
        model.evaluate(instant, row, &checks);
        const double angle = states.motion[next++].theta_deg;
        if (teeth != nullptr) append_teeth(*teeth, angle, the_case.pump.gear, model.teeth());
        if (loads != nullptr) loads->append(model.body_loads());
      },
      progress);
  table.results.provenance = model.provenance();
  table.results.provenance.seconds = stopwatch.seconds();
  return table;
}

}  // namespace bentaxis::multibody
