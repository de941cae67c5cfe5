// Designs a second of a whole sweep, by threads: blocks computed, kept, read and written as CSV and
// HDF5; and of the evaluations alone, of a sweep and of a search for the best design, by the size
// of its batches. Real time: run on a quiet machine.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "bentaxis/designs/optimise.h"
#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/files/case_file.h"

namespace {

using namespace bentaxis;
using namespace bentaxis::designs;

Case rated() {
  return read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml",
                   {"operation.samples_per_revolution=360"});
}
std::filesystem::path scratch() {
  return std::filesystem::temp_directory_path() / ("bentaxis_sweep_" + std::to_string(getpid()));
}
void count(benchmark::State& state, std::size_t designs) {
  state.counters["designs_per_second"] =
      benchmark::Counter(static_cast<double>(designs) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

void sweep(benchmark::State& state) {
  SweepRequest request;
  request.vary = {{"pump.tilt_deg", "20:40:#64"},
                  {"pressure.delivery_bar", "50:400:#64"},
                  {"pump.axis_offset_mm", "-1:1:#64"}};
  request.outputs = {"max:Rb1_z1", "peak:Rb1", "peak:Rb2", "mean:Td"};
  const Case base = rated();
  const Sweep all(base, sweep_plan(request, base));
  const auto folder = scratch();
  SweepShare share;
  share.threads = static_cast<int>(state.range(0));
  for ([[maybe_unused]] auto _ : state) {
    const SweepParts parts(folder / "parts", record_of(all, "benchmark"));
    parts.begin();
    compute_blocks(all, parts, share, [](double) {});
    OutputFolder out(folder);
    write_sweep(all, parts, {.csv = true, .hdf5 = has_hdf5()}, out, share.threads, [](double) {});
    out.commit();
    parts.remove(all.blocks());
  }
  std::filesystem::remove_all(folder);
  count(state, all.designs());
}
BENCHMARK(sweep)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

// The same parameters and outputs for both.
const std::vector<std::pair<std::string, std::string>> kVary = {{"pump.tilt_deg", "20:40"},
                                                                {"pump.bore_diameter_mm", "18:26"}};
constexpr std::size_t kDesigns = 65536;

void sweep_evaluations(benchmark::State& state) {
  SweepRequest request;
  request.vary = kVary;
  request.sampling = Sampling::sobol;
  request.samples = kDesigns;
  request.outputs = {"peak:Rb1", "displacement_cm3"};
  const Case base = rated();
  const Sweep all(base, sweep_plan(request, base));
  const auto folder = scratch();
  for ([[maybe_unused]] auto _ : state) {
    const SweepParts parts(folder / "parts", record_of(all, "benchmark"));
    parts.begin();
    const auto start = std::chrono::steady_clock::now();
    compute_blocks(all, parts, {}, [](double) {});
    state.SetIterationTime(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    parts.remove(all.blocks());
  }
  std::filesystem::remove_all(folder);
  count(state, all.designs());
}
BENCHMARK(sweep_evaluations)->UseManualTime()->Unit(benchmark::kMillisecond);

void optimise_evaluations(benchmark::State& state) {
  OptimiseRequest request;
  request.vary = kVary;
  request.minimise = {"peak:Rb1"};
  request.maximise = {"displacement_cm3"};
  request.comparison = SearchComparisonChoice::no;
  request.search.population = static_cast<std::size_t>(state.range(0));
  request.search.generations = kDesigns / request.search.population - 1;
  request.search.restarts = 1;
  request.search.refine = false;
  const Case base = rated();
  const Optimiser optimiser(base, optimise_plan(request, base));
  const auto folder = scratch();
  std::size_t designs = 0;
  for ([[maybe_unused]] auto _ : state) {
    const SweepParts parts(folder / "parts", optimiser.record("benchmark"));
    parts.begin();
    OptimiseWork work;
    work.parts = &parts;
    const Optimisation found = optimiser.run(work, [](double) {});
    state.SetIterationTime(found.evaluation_seconds);
    designs = found.evaluated();
    parts.remove(optimiser.batches());
  }
  std::filesystem::remove_all(folder);
  count(state, designs);
}
BENCHMARK(optimise_evaluations)
    ->Arg(100)
    ->Arg(1024)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
