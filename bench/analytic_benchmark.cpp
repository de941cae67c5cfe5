// The analytic model: scalar, batch on every instruction set, against the printed formulation
// solved densely and against what writing the results costs. Pressures are inputs of the kernel:
// evaluating the pressure trace is timed on its own.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/designs/evaluator.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/units.h"
#include "printed_dense.h"

namespace bentaxis::bench {
namespace {

using namespace analytic;

const Case& rated() {
  static const Case the_case = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml");
  return the_case;
}

// Angles over one turn, whatever their number, with the pressures of the case.
struct Angles {
  explicit Angles(std::size_t count) : theta(count), pressure(5, std::vector<double>(count)) {
    const PressureTrace trace(rated().pressure);
    for (std::size_t i = 0; i < count; ++i) {
      const double degrees = 360.0 * static_cast<double>(i) / static_cast<double>(count);
      theta[i] = radians(degrees);
      for (int k = 0; k < 5; ++k) pressure[k][i] = trace(piston_angle_deg(degrees, k + 1, 5));
    }
    for (const auto& column : pressure) chamber.push_back({column.data(), 0});
    instants.count = count;
    instants.theta = {theta.data(), 0};
    instants.omega = {nullptr, rad_per_second(rated().operation.speed_rpm)};
    instants.chamber_pressure = chamber;
    instants.suction = {nullptr, rated().pressure.ports.suction};
    instants.delivery = {nullptr, rated().pressure.ports.delivery};
  }
  std::vector<double> theta;
  std::vector<std::vector<double>> pressure;
  std::vector<Varying> chamber;
  BatchInstants instants;
};

void count_angles(benchmark::State& state, std::size_t per_iteration) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(per_iteration));
  // Shown in ns: the counter is inverted, angles in units of 1e9.
  state.counters["ns_per_angle"] = benchmark::Counter(
      static_cast<double>(per_iteration) * 1e-9,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// One instant at a time, as Model or the dense baseline offer it.
template <class Solver>
void one_at_a_time(benchmark::State& state) {
  const Solver solver(rated().pump, rated().analytic);
  const PressureTrace trace(rated().pressure);
  const Samples samples = sample_case(rated(), trace);
  std::vector<Instant> instants(samples.theta_deg.size());
  for (std::size_t i = 0; i < instants.size(); ++i) samples.instant(i, instants[i]);
  std::vector<double> values(ChannelLayout(5).size());
  for (auto _ : state) {
    for (const Instant& instant : instants) {
      solver.reactions(instant, values);
      benchmark::DoNotOptimize(values.data());
      benchmark::ClobberMemory();
    }
  }
  count_angles(state, instants.size());
}
BENCHMARK(one_at_a_time<PrintedDense>)->Name("printed_dense");
BENCHMARK(one_at_a_time<Model>)->Name("scalar");

// The batch, all 37 reactions or a group; results of 720 angles stay in the second-level cache.
void batch(benchmark::State& state, InstructionSet set, ChannelGroup group, std::size_t count,
           int threads) {
  const BatchModel model(rated().pump, rated().analytic);
  const Angles angles(count);
  BatchColumns columns(model.layout().reactions(), count);
  const BatchOutputs outputs = outputs_of(model.layout(), group, columns);
  for (auto _ : state) {
    model.reactions(angles.instants, outputs, {set, threads});
    benchmark::ClobberMemory();
  }
  count_angles(state, count);
}

// Different pumps in the lanes: the numbers of every pump are read too.
void pumps(benchmark::State& state, InstructionSet set, std::size_t count) {
  std::vector<PumpParameters> variants(count, rated().pump);
  for (std::size_t i = 0; i < count; ++i)
    variants[i].geometry.piston_length *= 1 + 1e-6 * static_cast<double>(i);
  const PumpBatch model(variants, rated().analytic);
  const Angles angles(count);
  BatchColumns columns(model.layout().reactions(), count);
  const BatchOutputs outputs = outputs_of(model.layout(), ChannelGroup::all, columns);
  for (auto _ : state) {
    model.reactions(angles.instants, outputs, {set, 1});
    benchmark::ClobberMemory();
  }
  count_angles(state, count);
}

// The same pump at many angles, statistics of all reactions instead of the reactions.
void statistics(benchmark::State& state, InstructionSet set) {
  const BatchModel model(rated().pump, rated().analytic);
  const Angles angles(360);
  std::vector<Measured> measured;
  for (std::size_t c = 0; c < model.layout().reactions(); ++c) measured.push_back({c});
  std::vector<Statistics> results(measured.size());
  for (auto _ : state) {
    model.statistics(angles.instants, measured, results, {set, 1});
    benchmark::DoNotOptimize(results.data());
    benchmark::ClobberMemory();
  }
  count_angles(state, 360);
}

// Designs one after the other: the case of three varied parameters, checked and prepared, then
// statistics of all reactions at 360 angles, ideal pressure.
void designs(benchmark::State& state) {
  Case base = rated();
  base.operation.samples_per_revolution = 360;
  const designs::Family family(
      base, {designs::Variable("pump.tilt_deg", base), designs::Variable("piston.mass_kg", base),
             designs::Variable("pressure.delivery_bar", base)});
  std::vector<designs::Output> outputs;
  const ChannelLayout layout(5);
  for (std::size_t c = 0; c < layout.reactions(); ++c)
    for (const char* statistic : {"mean:", "max:", "min:", "rms:"})
      outputs.push_back(designs::output(statistic + layout.channels()[c].name, base));
  const designs::Evaluator evaluator(family, outputs);
  constexpr std::size_t kDesigns = 256;
  std::vector<double> values, results(kDesigns * outputs.size());
  for (std::size_t i = 0; i < kDesigns; ++i) {
    const double share = static_cast<double>(i) / kDesigns;
    values.insert(values.end(), {20 + 20 * share, 0.1 + 0.1 * share, 50 + 300 * share});
  }
  std::vector<std::string> reasons(kDesigns);
  for (auto _ : state) {
    evaluator.evaluate(kDesigns, values, results, reasons);
    benchmark::ClobberMemory();
  }
  if (!evaluator.fast() || !reasons.back().empty()) state.SkipWithError("not by the kernel");
  count_angles(state, kDesigns * 360);
}
BENCHMARK(designs);

// What writing the results costs: the same columns filled with a constant, by memset one after the
// other, or by ordinary stores in the order in which the kernel writes them.
void write_columns(benchmark::State& state, bool kernel_order) {
  const auto count = static_cast<std::size_t>(state.range(0));
  BatchColumns columns(37, count);
  for (auto _ : state) {
    if (kernel_order) {
      for (std::size_t i = 0; i + 8 <= count; i += 8)
        for (std::size_t c = 0; c < 37; ++c) std::fill_n(columns.column(c) + i, 8, 1.5);
    } else {
      for (std::size_t c = 0; c < 37; ++c)
        std::memset(columns.column(c), 1, count * sizeof(double));
    }
    benchmark::ClobberMemory();
  }
  count_angles(state, count);
}

// The pressures of all chambers at an angle, for comparison with the kernel that is given them.
void pressure_trace(benchmark::State& state) {
  const PressureTrace trace(rated().pressure);
  for (auto _ : state)
    for (int i = 0; i < 720; ++i)
      for (int k = 1; k <= 5; ++k) benchmark::DoNotOptimize(trace(piston_angle_deg(0.5 * i, k, 5)));
  count_angles(state, 720);
}
BENCHMARK(pressure_trace);

void register_batches() {
  using benchmark::RegisterBenchmark;
  for (const InstructionSet set : available_instruction_sets()) {
    const std::string name = to_string(set);
    RegisterBenchmark(("batch/" + name).c_str(), batch, set, ChannelGroup::all, 720, 1);
    RegisterBenchmark(("pumps/" + name).c_str(), pumps, set, 720);
    RegisterBenchmark(("statistics/" + name).c_str(), statistics, set);
    // Results that go to memory, past the caches: on every set, not only on the widest.
    RegisterBenchmark(("past_caches/" + name).c_str(), batch, set, ChannelGroup::all, 1 << 22, 1);
  }
  const InstructionSet widest = available_instruction_sets().back();
  RegisterBenchmark("batch/pistons", batch, widest, ChannelGroup::pistons, 720, 1);
  RegisterBenchmark("batch/bearings", batch, widest, ChannelGroup::bearings, 720, 1);
  // Results take 296 B per angle: 2048 per thread stay in a second-level cache of 1 MiB, 32768 per
  // thread in a third-level cache; millions go to memory.
  for (const std::size_t count : {4096, 1 << 16, 1 << 22}) {
    for (const int threads : {1, 2}) {
      auto* const registered = RegisterBenchmark(
          ("batch/angles:" + std::to_string(count) + "/threads:" + std::to_string(threads)).c_str(),
          batch, widest, ChannelGroup::all, count, threads);
      if (threads > 1) registered->UseRealTime();
    }
  }
  RegisterBenchmark("write/memset", write_columns, false)->Arg(720)->Arg(1 << 22);
  RegisterBenchmark("write/kernel_order", write_columns, true)->Arg(720)->Arg(1 << 22);
}

}  // namespace
}  // namespace bentaxis::bench

int main(int argc, char** argv) {
  bentaxis::bench::register_batches();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
