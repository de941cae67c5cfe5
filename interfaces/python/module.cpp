#include "binding.h"
#include "report.h"

PYBIND11_MODULE(_bentaxis, module) {
  using namespace bentaxis::python;
  // Classes and functions are those of the package: its name stands in messages and in pickles.
  module.attr("__name__") = "bentaxis";
  module.doc() = "Reaction forces of bent-axis piston pumps by two independent models.";
  module.attr("__version__") = BENTAXIS_VERSION;
  // A signature names the types that are known by then: what others show comes first.
  add_errors(module);
  add_tables(module);
  add_case(module);
  add_runs(module);
  add_comparison(module);
  add_simulation(module);
  add_regression(module);
  add_sweep(module);
  add_optimisation(module);
  add_identification(module);
  add_report(module);
  module.attr("__name__") = "bentaxis._bentaxis";
}
