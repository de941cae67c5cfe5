#include "result_files.h"

#include <string>
#include <utility>

#include "bentaxis/files/csv.h"
#include "bentaxis/pump/lists.h"

namespace bentaxis::cli {
std::vector<TextFile> comparison_files(const study::ComparisonResult& result) {
  const auto chosen = [&](const char* name, const ResultTable& table) {
    return TextFile(name, [&](const TextSink& write) {
      write_csv(table, write,
                [&](const Channel& channel) { return result.options.channels.wants(channel); });
    });
  };
  std::vector<TextFile> curves = {chosen("analytic.csv", result.analytic),
                                  chosen("multibody.csv", result.multibody)};
  if (result.first.hydraulics)
    curves.push_back(csv_file("pressure.csv", result.first.hydraulics->table));
  if (result.budget) {
    curves.push_back(csv_file("budget_analytic.csv", result.budget->analytic));
    curves.push_back(csv_file("budget_multibody.csv", result.budget->multibody));
  }
  if (result.teeth) {
    curves.push_back(csv_file("teeth_analytic.csv", result.teeth->analytic));
    curves.push_back(csv_file("teeth_multibody.csv", result.teeth->multibody));
  }
  if (result.engines) append(curves, engine_files(*result.engines));
  return curves;
}

std::vector<TextFile> engine_files(const study::EngineComparison& engines) {
  std::vector<TextFile> curves;
  for (const study::EngineRun& run : engines.runs)
    if (run.failure.empty()) curves.push_back(csv_file(run.name + ".csv", run.table));
  return curves;
}

}  // namespace bentaxis::cli
