// Time per row of the analytic model by what drives the block: the gear, the joints, and at one
// instant pistons, whose lag is sought (docs/transfer.md).
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/samples.h"

namespace bentaxis::bench {
namespace {

using namespace analytic;

Case with(const char* kind) {
  return read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml",
                   {std::string("transfer.kind=") + kind, "operation.samples_per_revolution=720"});
}

void count_rows(benchmark::State& state, std::size_t rows) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rows));
  state.counters["ns_per_row"] = benchmark::Counter(
      static_cast<double>(rows) * 1e-9,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void scalar(benchmark::State& state, const Case& the_case) {
  const Model model(the_case.pump, the_case.analytic);
  const PressureTrace trace(the_case.pressure);
  const Samples samples = sample_case(the_case, trace);
  std::vector<Instant> instants(samples.theta_deg.size());
  for (std::size_t i = 0; i < instants.size(); ++i) samples.instant(i, instants[i]);
  const bool sought = the_case.pump.transfer.kind == TransferKind::pistons;
  std::vector<double> values(model.layout().size());
  for (auto _ : state) {
    for (Instant& instant : instants) {
      if (sought) model.place_at_constant_speed(instant, trace);
      model.reactions(instant, values);
      benchmark::DoNotOptimize(values.data());
      benchmark::ClobberMemory();
    }
  }
  count_rows(state, instants.size());
}

void batch(benchmark::State& state, const Case& the_case) {
  const BatchModel model(the_case.pump, the_case.analytic);
  const PressureTrace trace(the_case.pressure);
  const Samples samples = sample_case(the_case, trace);
  const std::size_t count = samples.theta_deg.size();
  const auto n = static_cast<std::size_t>(samples.pistons);
  std::vector<double> theta(count);
  std::vector<std::vector<double>> pressure(n, std::vector<double>(count));
  Instant instant;
  for (std::size_t i = 0; i < count; ++i) {
    samples.instant(i, instant);
    theta[i] = instant.shaft.angle;
    for (std::size_t k = 0; k < n; ++k) pressure[k][i] = instant.chamber_pressure[k];
  }
  std::vector<Varying> chambers;
  for (const auto& column : pressure) chambers.push_back({column.data(), 0});
  BatchInstants instants;
  instants.count = count;
  instants.theta = {theta.data(), 0};
  instants.omega = {nullptr, rad_per_second(the_case.operation.speed_rpm)};
  instants.chamber_pressure = chambers;
  instants.suction = {nullptr, the_case.pressure.ports.suction};
  instants.delivery = {nullptr, the_case.pressure.ports.delivery};
  BatchColumns columns(model.layout().reactions(), count);
  const BatchOutputs outputs = outputs_of(model.layout(), ChannelGroup::all, columns);
  for (auto _ : state) {
    model.reactions(instants, outputs);
    benchmark::ClobberMemory();
  }
  count_rows(state, count);
}

void add_all() {
  for (const char* kind : {"gear", "constant_velocity", "cardan"}) {
    benchmark::RegisterBenchmark((std::string("scalar/") + kind).c_str(), scalar, with(kind));
    benchmark::RegisterBenchmark((std::string("batch/") + kind).c_str(), batch, with(kind));
  }
  benchmark::RegisterBenchmark("scalar/pistons", scalar,
                               read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_tapered_pistons.toml"));
}

}  // namespace
}  // namespace bentaxis::bench

int main(int count, char** arguments) {
  bentaxis::bench::add_all();
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
