#include "simulation_files.h"

#include <string>
#include <utility>

#include "bentaxis/files/csv.h"
#include "result_files.h"

namespace bentaxis::cli {

std::vector<TextFile> simulation_files(const study::SimulationResult& result) {
  std::vector<TextFile> curves;
  for (const auto& [name, run] :
       {std::pair{"analytic", &result.analytic}, std::pair{"multibody", &result.multibody}}) {
    if (!*run) continue;
    const Trajectory& of = **run;
    curves.push_back(csv_file(std::string("simulation_") + name + ".csv", of.table));
    if (!of.teeth.empty())
      curves.emplace_back(std::string("teeth_") + name + ".csv",
                          to_csv(teeth_table_of(of, result.ready.the_case.pump.gear)));
    if (of.oil)
      curves.emplace_back(std::string("oil_") + name + ".csv",
                          [&of](const TextSink& write) { write_oil_csv(of, write); });
    if (const auto& told = result.exchanged[run == &result.multibody]; told)
      curves.emplace_back(std::string("unit_") + name + ".csv", told->csv());
  }
  return curves;
}

}  // namespace bentaxis::cli
