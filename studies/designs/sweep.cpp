#include "bentaxis/designs/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/designs/independence.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/stopwatch.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/memory.h"
#include "bentaxis/study/reporting.h"
#include "random_bits.h"

namespace bentaxis::designs {
namespace {

// Of the numbers that choose the designs to be checked.
constexpr std::uint64_t kCheckStream = 0x636865636b;
constexpr std::size_t kWantedBlocks = 256;  // as many at least, where there are designs for them

std::unique_ptr<Points> points_of(const SweepPlan& plan) {
  if (plan.sampling == Sampling::grid) {
    std::vector<std::vector<double>> axes;
    for (const Varied& v : plan.varied) axes.push_back(v.levels);
    return grid(std::move(axes));
  }
  const std::size_t dimension = plan.varied.size();
  if (plan.sampling == Sampling::sobol) return sobol(dimension, plan.samples, plan.seed);
  if (plan.sampling == Sampling::random) return random(dimension, plan.samples, plan.seed);
  return latin_hypercube(dimension, plan.samples, plan.seed);
}

std::vector<Variable> variables_of(const SweepPlan& plan) {
  std::vector<Variable> variables;
  for (const Varied& v : plan.varied) variables.push_back(v.variable);
  return variables;
}

// A value from a share in (0, 1).
double value_at(const Varied& v, double share) {
  if (!v.levels.empty()) {
    const auto place = static_cast<std::size_t>(share * static_cast<double>(v.levels.size()));
    return v.levels[std::min(place, v.levels.size() - 1)];
  }
  const double value = v.distribution.quantile(share);
  return v.variable.discrete() ? std::round(value) : value;
}

std::size_t block_size_of(std::size_t designs, const SweepPlan& plan, const Case& base, bool fast) {
  const bool slow =
      base.pressure.kind == PressureKind::hydraulic || plan.model == study::Model::multibody;
  const std::size_t most = fast ? 4096 : slow ? 16 : 1024;
  return std::clamp(std::bit_floor(std::max<std::size_t>(designs / kWantedBlocks, 1)),
                    std::size_t{1}, most);
}

// What the differences of an output are over.
enum class ScaleKind {
  none,       // not computed independently by both models: not compared
  vector,     // peak over the turn of the vector that the output is of
  own,        // its own magnitude
  percentage  // 100 %
};
struct Scale {
  ScaleKind kind = ScaleKind::none;
  std::optional<Output> peak = {};  // of a vector
};

Output peak_of_group(const Output& of, const Case& base) {
  const ChannelLayout layout(base.pump);
  const Channel& channel = layout.channels()[of.columns.front()];
  Output peak = of;
  peak.statistic = Statistic::peak;
  peak.columns.clear();
  for (std::size_t i = 0; i < layout.size(); ++i)
    if (layout.channels()[i].group == channel.group &&
        layout.channels()[i].piston == channel.piston)
      peak.columns.push_back(i);
  return peak;
}

Scale scale_of(const Output& o, const Case& base) {
  if (!why_not_independent(o, base).empty()) return {};
  if (o.source == Source::curve) return {ScaleKind::vector, peak_of_group(o, base)};
  if (o.source == Source::budget) return {ScaleKind::vector, output("peak:Td", base)};
  if (o.source == Source::efficiency) return {ScaleKind::percentage};
  if (o.source == Source::validity)
    for (const auto& [item, force] :
         {std::pair{"film", "Fh"}, {"flank", "Rcs"}, {"turned", "Rcs"}, {"thrust", "Rb1"}})
      if (o.item == item) return {ScaleKind::vector, output(std::string("peak:") + force, base)};
  return {ScaleKind::own};
}

}  // namespace

compare::Difference SweepCheck::difference(std::size_t output) const {
  if (scales[output] == 0) return {};
  return compare::difference(own[output], values[output], scales[output]);
}

double SweepCheck::error(std::size_t output) const {
  const compare::Difference found = difference(output);
  return found.comparable == compare::Comparable::nothing ? 0 : found.share();
}

bool SweepCheck::compared() const {
  const bool values_compared =
      std::any_of(scales.begin(), scales.end(), [](double scale) { return scale != 0; });
  return own_reason.empty() && reason.empty() ? values_compared
                                              : own_reason.empty() != reason.empty();
}

bool SweepCheck::agrees(double tolerance) const {
  if (!compared() || !own_reason.empty() || !reason.empty()) return false;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(error(i) <= tolerance)) return false;
  return true;
}

std::size_t SweepResult::compared() const {
  return static_cast<std::size_t>(std::count_if(
      checks.begin(), checks.end(), [](const SweepCheck& check) { return check.compared(); }));
}

std::size_t SweepResult::agreeing() const {
  return static_cast<std::size_t>(
      std::count_if(checks.begin(), checks.end(),
                    [&](const SweepCheck& check) { return check.agrees(tolerance); }));
}

bool SweepResult::agrees() const {
  return checks.empty() || (compared() > 0 && agreeing() == compared());
}

struct Sweep::Implementation {
  Case base;
  SweepPlan plan;
  std::unique_ptr<Points> points;
  Evaluator evaluator;
  std::size_t block_size;
  std::vector<Scale> scales;  // of each output

  Implementation(Case the_case, SweepPlan the_plan)
      : base(std::move(the_case)),
        plan(std::move(the_plan)),
        points(points_of(plan)),
        evaluator(Family(base, variables_of(plan)), plan.outputs, plan.model),
        block_size(block_size_of(points->size(), plan, base, evaluator.fast())) {
    for (const Output& o : plan.outputs) scales.push_back(scale_of(o, base));
    if (plan.check_share > 0) require_independent(plan.outputs, base, "--check");
  }

  // At least one of all designs is: the share may be less than one of them.
  bool checked(std::size_t design) const {
    return plan.check_share > 0 && (random_share(kCheckStream, design) < plan.check_share ||
                                    design == random_bits(kCheckStream + 1, 0) % points->size());
  }

  SweepCheck check(std::size_t design, std::span<const double> values,
                   std::span<const double> results, const std::string& reason) const {
    SweepCheck c;
    c.design = design;
    c.own.assign(results.begin(), results.end());
    c.own_reason = reason;
    c.values.assign(results.size(), not_computed());
    c.scales.assign(results.size(), 0);
    c.reason = study::reason_of([&] {
      Case made = base;
      evaluator.family().make(values, made);
      std::optional<study::PreparedCase> ready = study::prepare(made);
      const bool analytic = plan.model == study::Model::analytic;
      c.values = outputs_of(plan.outputs, made, ready,
                            analytic ? study::Model::multibody : study::Model::analytic);
      c.scales = scales_in(*ready, c);
    });
    return c;
  }

  std::vector<double> scales_in(const study::PreparedCase& ready, const SweepCheck& c) const {
    std::vector<Output> peaks;
    for (const Scale& scale : scales)
      if (scale.peak) peaks.push_back(*scale.peak);
    const std::vector<double> found = outputs_of(peaks, ready, study::Model::analytic);
    const compare::ZeroScales floors =
        study::zero_scales(ready.the_case, ready.samples(study::Way::driven));
    std::vector<double> result;
    auto next = found.begin();
    for (std::size_t i = 0; i < scales.size(); ++i) {
      const compare::Comparable both = compare::comparable(c.own[i], c.values[i]);
      double scale = not_computed();
      if (scales[i].kind == ScaleKind::own && both == compare::Comparable::yes)
        scale = std::max(std::abs(c.own[i]), std::abs(c.values[i]));
      if (scales[i].kind == ScaleKind::percentage) scale = 100;
      if (scales[i].kind == ScaleKind::vector) {
        scale = *next;
        ++next;
      }
      // A small value is what is left of loads that cancel, and carries their round-off.
      const auto load = floors.find(plan.outputs[i].unit);
      if (is_computed(scale) && load != floors.end())
        scale = compare::scale_of(scale, load->second);
      const bool compared =
          scales[i].kind != ScaleKind::none && both != compare::Comparable::both_missing;
      result.push_back(compared ? scale : 0);
    }
    return result;
  }
};

Sweep::Sweep(Case base, SweepPlan plan)
    : implementation_(std::make_unique<Implementation>(std::move(base), std::move(plan))) {}
Sweep::~Sweep() = default;
Sweep::Sweep(Sweep&&) noexcept = default;

const Family& Sweep::family() const { return implementation_->evaluator.family(); }
const SweepPlan& Sweep::plan() const { return implementation_->plan; }
std::size_t Sweep::designs() const { return implementation_->points->size(); }
std::size_t Sweep::block_size() const { return implementation_->block_size; }
std::size_t Sweep::blocks() const { return (designs() + block_size() - 1) / block_size(); }

SweepBlock Sweep::compute(std::size_t block, const std::function<void()>& tick) const {
  const Implementation& it = *implementation_;
  const std::size_t n = it.plan.varied.size(), m = it.plan.outputs.size();
  SweepBlock result;
  result.first = block * block_size();
  result.designs = std::min(block_size(), designs() - result.first);
  result.values.resize(result.designs * n);
  result.results.resize(result.designs * m);
  result.reasons.resize(result.designs);
  const auto values = [&](std::size_t i) { return std::span(result.values).subspan(i * n, n); };
  const auto results = [&](std::size_t i) { return std::span(result.results).subspan(i * m, m); };
  for (std::size_t i = 0; i < result.designs; ++i) {
    it.points->point(result.first + i, values(i));
    if (it.plan.sampling != Sampling::grid)
      for (std::size_t k = 0; k < n; ++k) values(i)[k] = value_at(it.plan.varied[k], values(i)[k]);
  }
  // A slow design is one to be interrupted after.
  const std::size_t step = it.evaluator.fast() ? result.designs : 1;
  for (std::size_t i = 0; i < result.designs; i += step) {
    tick();
    it.evaluator.evaluate(step, std::span(result.values).subspan(i * n, step * n),
                          std::span(result.results).subspan(i * m, step * m),
                          std::span(result.reasons).subspan(i, step));
  }
  for (std::size_t i = 0; i < result.designs; ++i)
    if (it.checked(result.first + i)) {
      tick();
      result.checks.push_back(it.check(result.first + i, values(i), results(i), result.reasons[i]));
    }
  return result;
}

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
  result.best = validity_of_best(result);
  result.seconds = watch.seconds();
  return result;
}

}  // namespace bentaxis::designs
