// The driven multibody model per angle, beside the scalar closed form for the ratio.
#include <benchmark/benchmark.h>

#include "bentaxis/analytic/model.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::bench {
namespace {

const Case& rated() {
  static const Case the_case = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml");
  return the_case;
}

std::vector<Instant> turn() {
  const Samples samples = sample_case(rated(), PressureTrace(rated().pressure));
  std::vector<Instant> instants(samples.theta_deg.size());
  for (std::size_t i = 0; i < instants.size(); ++i) samples.instant(i, instants[i]);
  return instants;
}

void count_angles(benchmark::State& state, std::size_t per_iteration) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(per_iteration));
}

void scalar(benchmark::State& state) {
  const analytic::Model model(rated().pump, rated().analytic);
  const auto instants = turn();
  std::vector<double> values(model.layout().size());
  for (auto _ : state)
    for (const Instant& instant : instants) {
      model.reactions(instant, values);
      benchmark::ClobberMemory();
    }
  count_angles(state, instants.size());
}
BENCHMARK(scalar);

// All channels of the full pump, the angles of a turn in order.
void driven_full(benchmark::State& state) {
  const auto instants = turn();
  multibody::Model model(rated().pump, rated().multibody, 1);
  std::vector<double> values(model.layout().size());
  for (auto _ : state)
    for (const Instant& instant : instants) {
      model.evaluate(instant, values);
      benchmark::ClobberMemory();
    }
  count_angles(state, instants.size());
}
BENCHMARK(driven_full)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace bentaxis::bench

BENCHMARK_MAIN();
