#include <cstdio>

#include "bentaxis/analytic/model.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/files.h"
#include "commands.h"
#include "console.h"

namespace bentaxis::cli {

int run_command(const RunOptions& options) {
  const Case the_case = read_case(options.case_file);
  OutputFolder folder(options.out);
  const PressureTrace pressure(the_case.pressure);
  const bool integrated = options.model == "multibody" && options.way == Way::integrated;
  const Samples samples =
      sample_case(the_case, pressure, integrated ? the_case.operation.revolutions : 1,
                  integrated && the_case.operation.speed_rpm < 0);
  Assumptions assumptions = options.model == "analytic" ? the_case.analytic : the_case.multibody;
  if (!options.gear.empty())
    assumptions.gear = options.gear == "imposed" ? GearScene::imposed : GearScene::mesh;

  ResultTable table;
  if (options.model == "analytic") {
    table = analytic::run(the_case, assumptions, samples, progress_of("analytic"));
  } else if (integrated) {
    table = multibody::run_integrated(the_case, assumptions, samples, pressure,
                                      options.integration, progress_of("multibody"))
                .table;
  } else {
    table = multibody::run_driven(the_case, assumptions, samples, progress_of("multibody"));
  }
  folder.add(options.model + ".csv", to_csv(table));
  for (const auto& path : folder.commit()) std::printf("%s\n", path.c_str());
  return kDone;
}

}  // namespace bentaxis::cli
