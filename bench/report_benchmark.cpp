// From result tables to the comparison and its page: what a report costs beyond the models.
#include <benchmark/benchmark.h>

#include "bentaxis/analytic/model.h"
#include "bentaxis/compare/comparison.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/report/page.h"

namespace bentaxis::bench {
namespace {

struct Tables {
  ResultTable first, second;
  Tables() {
    const Case the_case = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml");
    const Samples samples = sample_case(the_case, PressureTrace(the_case.pressure));
    first = analytic::run(the_case, the_case.analytic, samples);
    second = first;
    second.name = "multibody";
  }
};
const Tables& tables() {
  static const Tables both;
  return both;
}

void compare_tables(benchmark::State& state) {
  compare::Options options;
  options.orders = {5, 10};
  for (auto _ : state)
    benchmark::DoNotOptimize(compare::compare_tables(tables().first, tables().second, options));
}
BENCHMARK(compare_tables)->Unit(benchmark::kMillisecond);

void write_csv(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(to_csv(tables().first));
}
BENCHMARK(write_csv)->Unit(benchmark::kMillisecond);

void render_page(benchmark::State& state) {
  const auto comparison = compare::compare_tables(tables().first, tables().second, {});
  for (auto _ : state) {
    report::Document document;
    document.comparison = comparison;
    benchmark::DoNotOptimize(
        report::render_page(document, report::curves_of(tables().first, tables().second)));
  }
}
BENCHMARK(render_page)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace bentaxis::bench

BENCHMARK_MAIN();
