#include "bentaxis/study/shown_pump.h"

#include <utility>

namespace bentaxis::study {

ShownPump show_pump(Case the_case, const PartProgress& progress_of) {
  require_memory(the_case, Kept::shown, Way::driven);
  ShownPump pump{prepare(std::move(the_case), progress_of), {}, {}, {}};
  const Case& ready = pump.ready.the_case;
  RunOptions options;
  options.loads = true;
  const Samples samples = pump.ready.samples(Way::driven);
  pump.run = run(pump.ready, samples, options, progress_of);
  pump.limits = analytic::check_validity(ready, ready.analytic, samples, pump.run.table);
  pump.description = describe(ready, progress_of, Described::without_turn);
  return pump;
}

}  // namespace bentaxis::study
