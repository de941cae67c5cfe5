#include "result_files.h"

#include <string>
#include <utility>

#include "bentaxis/files/csv.h"

namespace bentaxis::cli {

std::vector<TextFile> comparison_files(const study::ComparisonResult& result) {
  const auto wanted = [&](const Channel& channel) {
    return result.options.channels.wants(channel);
  };
  std::vector<TextFile> curves = {
      {"analytic.csv", to_csv(select_channels(result.analytic, wanted))},
      {"multibody.csv", to_csv(select_channels(result.multibody, wanted))}};
  if (result.first.hydraulics)
    curves.emplace_back("pressure.csv", to_csv(result.first.hydraulics->table));
  if (result.budget) {
    curves.emplace_back("budget_analytic.csv", to_csv(result.budget->analytic));
    curves.emplace_back("budget_multibody.csv", to_csv(result.budget->multibody));
  }
  if (result.teeth) {
    curves.emplace_back("teeth_analytic.csv", to_csv(result.teeth->analytic));
    curves.emplace_back("teeth_multibody.csv", to_csv(result.teeth->multibody));
  }
  if (result.engines)
    for (TextFile& file : engine_files(*result.engines)) curves.push_back(std::move(file));
  return curves;
}

std::vector<TextFile> engine_files(const study::EngineComparison& engines) {
  std::vector<TextFile> curves;
  for (const study::EngineRun& run : engines.runs)
    if (run.failure.empty()) curves.emplace_back(run.name + ".csv", to_csv(run.table));
  return curves;
}

std::vector<TextFile> simulation_files(const study::SimulationResult& result) {
  std::vector<TextFile> curves;
  for (const auto& [name, run] :
       {std::pair{"analytic", &result.analytic}, std::pair{"multibody", &result.multibody}}) {
    if (!*run) continue;
    curves.emplace_back(std::string("simulation_") + name + ".csv", to_csv((*run)->table));
    if (!(*run)->teeth.empty())
      curves.emplace_back(std::string("teeth_") + name + ".csv",
                          to_csv(teeth_table_of(**run, result.ready.the_case.pump.gear)));
    if ((*run)->oil) curves.emplace_back(std::string("oil_") + name + ".csv", oil_csv(**run));
    if (const auto& told = result.exchanged[run == &result.multibody]; told)
      curves.emplace_back(std::string("unit_") + name + ".csv", told->csv());
  }
  return curves;
}

}  // namespace bentaxis::cli
