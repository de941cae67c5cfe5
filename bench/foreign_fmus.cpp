// Imports FMUs of others and steps them through their default experiment
// (docs/external_benchmarks.md): a line of JSON for each.
//
//   foreign_fmus FILE.fmu..
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "bentaxis/fmu/slave.h"

namespace {

using bentaxis::fmu::UnitVariable;

nlohmann::json tried(const std::string& file) {
  nlohmann::json line = {{"file", file}};
  std::string stage = "import";
  try {
    const bentaxis::fmu::ImportedUnit unit(file, {.call_seconds = 20});
    const auto& d = unit.description();
    line["fmi"] = d.version;
    line["tool"] = d.tool;
    line["variables"] = d.variables.size();
    const double start = d.start_time.value_or(0), stop = d.stop_time.value_or(start + 1);
    constexpr int kSteps = 100;
    stage = "instantiate";
    const auto slave = unit.instantiate("foreign");
    stage = "initialise";
    slave->enter_initialisation(start, stop);
    slave->exit_initialisation();
    stage = "step";
    const double step = (stop - start) / kSteps;
    for (int i = 0; i < kSteps; ++i) slave->step(start + i * step, step);
    stage = "outputs";
    std::vector<const UnitVariable*> outputs;
    for (const UnitVariable& v : d.variables)
      if (v.causality == "output" && v.numeric()) outputs.push_back(&v);
    const std::vector<double> values = slave->get(outputs);
    for (std::size_t i = 0; i < values.size(); ++i) line["outputs"][outputs[i]->name] = values[i];
    stage = "end";
    slave->end();
    line["steps"] = kSteps;
    line["stop"] = stop;
    stage = "";
  } catch (const std::exception& error) {
    line["why"] = error.what();
  }
  line["failed_at"] = stage;
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: foreign_fmus FILE.fmu..\n");
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    std::printf("%s\n", tried(argv[i]).dump().c_str());
    std::fflush(stdout);
  }
  return 0;
}
