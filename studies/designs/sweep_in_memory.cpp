#include <fmt/format.h>

#include <algorithm>

#include "bentaxis/designs/sweep.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/results/stopwatch.h"
#include "bentaxis/study/memory.h"
#include "bentaxis/study/reporting.h"

namespace bentaxis::designs {

SweepResult compute_in_memory(const Sweep& sweep, int threads, const Progress& progress) {
  const Stopwatch watch;
  SweepResult result;
  result.plan = sweep.plan();
  result.base = sweep.family().base();
  result.designs = sweep.designs();
  const std::size_t n = result.plan.varied.size(), m = result.plan.outputs.size();
  // Numbers, a reason each, and what both models say of those that are checked.
  const double of_check = static_cast<double>(sizeof(SweepCheck) + 3 * m * sizeof(double));
  study::require_memory(
      static_cast<double>(result.designs) *
          (static_cast<double>((n + m) * sizeof(double) + sizeof(std::string)) +
           result.plan.check_share * of_check),
      fmt::format("sweep: {} designs of {} variables and {} outputs", result.designs, n, m),
      "take fewer designs, or the command bentaxis sweep, which keeps them on the disk");
  result.values.resize(result.designs * n);
  result.results.resize(result.designs * m);
  std::vector<SweepBlock> blocks(sweep.blocks());  // reasons and checks of each, in its place
  study::Reporting reporting(std::max<std::size_t>(blocks.size(), 1), progress);
  numerics::parallel_for(threads, blocks.size(), [&](std::size_t i) {
    SweepBlock block = sweep.compute(i, [&] { reporting.tick(); });
    const auto place = [&](std::size_t width) {
      return static_cast<std::ptrdiff_t>(block.first * width);
    };
    std::copy(block.values.begin(), block.values.end(), result.values.begin() + place(n));
    std::copy(block.results.begin(), block.results.end(), result.results.begin() + place(m));
    block.values = {};
    block.results = {};
    blocks[i] = std::move(block);
    reporting.done();
  });
  for (SweepBlock& block : blocks) {
    for (std::size_t i = 0; i < block.reasons.size(); ++i)
      if (!block.reasons[i].empty())
        result.infeasible.emplace_back(block.first + i, std::move(block.reasons[i]));
    std::move(block.checks.begin(), block.checks.end(), std::back_inserter(result.checks));
  }
  result.all_infeasible = result.infeasible.size();
  result.seconds = watch.seconds();
  return result;
}

}  // namespace bentaxis::designs
