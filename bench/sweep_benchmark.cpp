// Designs a second of a whole sweep, by threads: blocks computed, kept, read and written as CSV and
// HDF5. Real time: run on a quiet machine.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/files/case_file.h"

namespace {

using namespace bentaxis;
using namespace bentaxis::designs;

void sweep(benchmark::State& state) {
  const Case base = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml",
                              {"operation.samples_per_revolution=360"});
  SweepRequest request;
  request.vary = {{"pump.tilt_deg", "20:40:#64"},
                  {"pressure.delivery_bar", "50:400:#64"},
                  {"pump.axis_offset_mm", "-1:1:#64"}};
  request.outputs = {"max:Rb1_z1", "peak:Rb1", "peak:Rb2", "mean:Td"};
  const Sweep all(base, sweep_plan(request, base));
  const auto folder =
      std::filesystem::temp_directory_path() / ("bentaxis_sweep_" + std::to_string(getpid()));
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
  state.counters["designs_per_second"] = benchmark::Counter(
      static_cast<double>(all.designs()) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate);
}
BENCHMARK(sweep)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
