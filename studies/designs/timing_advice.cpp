#include "bentaxis/designs/timing_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/output.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/reporting.h"
#include "bentaxis/study/timing.h"

namespace bentaxis::designs {
namespace {

constexpr double kHelps = 0.1;  // of what a verdict is beyond its limit

enum class Step { degrees, factor, bar };
// Keys that set the timing, and how they are changed.
constexpr std::pair<const char*, Step> kKeys[] = {
    {"port_plate.delivery_arc_deg.1", Step::degrees},
    {"port_plate.delivery_arc_deg.2", Step::degrees},
    {"port_plate.suction_arc_deg.1", Step::degrees},
    {"port_plate.suction_arc_deg.2", Step::degrees},
    {"hydraulics.delivery_notch_deg", Step::degrees},
    {"hydraulics.delivery_notch_area_mm2", Step::factor},
    {"hydraulics.suction_notch_deg", Step::degrees},
    {"hydraulics.suction_notch_area_mm2", Step::factor},
    {"hydraulics.kidney_width_deg", Step::degrees},
    {"pressure.suction_bar", Step::bar}};

// Values to try, the smallest changes first.
std::vector<double> values_about(double value, Step step) {
  if (step == Step::degrees)
    return {value - 1, value + 1, value - 2, value + 2, value - 4, value + 4, value - 8, value + 8};
  if (step == Step::factor)
    return {value / 1.5, value * 1.5, value / 2, value * 2, value / 4, value * 4};
  return {value + 0.1, value + 0.25, value + 0.5, value + 1};
}

struct Trial {
  std::size_t key;
  int rank;  // of the change among those of its key: 0 is the smallest
  double to;
  Evaluation found;
};

struct Key {
  Variable variable;
  double from;
  Evaluator evaluator;
};

// Lists what each trial is asked for: of every verdict value and excess, then the efficiency.
std::vector<Output> outputs_for(const std::vector<TimingRow>& rows, const Case& the_case) {
  std::vector<Output> outputs;
  for (const TimingRow& row : rows) {
    outputs.push_back(output("timing." + row.code, the_case));
    outputs.push_back(output("timing." + row.code + ".excess", the_case));
  }
  outputs.push_back(output("hydraulics.volumetric_efficiency_percent", the_case));
  return outputs;
}

}  // namespace

std::string TimingChange::text(const TimingRow& row) const {
  std::string text =
      fmt::format("{} {} -> {}: {:.3g} -> {:.3g} {}{}; volumetric efficiency {:+.2g} %",
                  variable.name(), number_text(std::round(from * 1e4) / 1e4),
                  number_text(std::round(to * 1e4) / 1e4), value_before, value_after, row.unit,
                  within ? ", within its limit" : ", still exceeded", efficiency_change);
  if (!worse.empty()) text += fmt::format("; then exceeded: {}", fmt::join(worse, ", "));
  return text;
}

TimingStudy timing_advice(const Case& the_case, const hydraulics::SteadyState& state,
                          const Progress& progress) {
  TimingStudy result;
  std::vector<TimingRow> rows = study::timing_rows(the_case, state);
  std::erase_if(rows, [](const TimingRow& row) { return !row.limit; });
  for (const TimingRow& row : rows)
    if (row.flagged && row.meant.empty()) result.advice.push_back({row, std::nullopt});
  if (result.advice.empty()) return result;

  const std::vector<Output> outputs = outputs_for(rows, the_case);
  std::vector<Key> keys;
  std::vector<Trial> trials;
  for (const auto& [name, step] : kKeys) {
    std::optional<Variable> variable;
    try {
      variable.emplace(name, the_case);
    } catch (const InputError&) {
      continue;  // does nothing in this case
    }
    const double from = variable->value(the_case);
    const NumberRange range = variable->range(the_case);
    int rank = 0;
    for (const double to : values_about(from, step)) {
      if (range.contains(to) && to != from)
        trials.push_back({keys.size(), step == Step::bar ? rank : rank / 2, to, {}});
      ++rank;
    }
    keys.push_back({*variable, from, Evaluator(Family(the_case, {*variable}), outputs)});
  }
  study::for_each_of(trials.size(), 0, progress, [&](std::size_t i) {
    Trial& trial = trials[i];
    trial.found = keys[trial.key].evaluator.evaluate({&trial.to, 1});
  });
  result.trials = trials.size();
  result.failed = static_cast<std::size_t>(std::count_if(
      trials.begin(), trials.end(), [](const Trial& t) { return !t.found.feasible(); }));
  std::erase_if(trials, [](const Trial& t) { return !t.found.feasible(); });
  if (trials.empty()) throw ComputationError("--advise: none of the trials could be computed");

  const double efficiency = 100 * state.summary.volumetric_efficiency;
  for (TimingAdvice& advice : result.advice) {
    const auto place = static_cast<std::size_t>(
        std::find_if(rows.begin(), rows.end(),
                     [&](const TimingRow& row) { return row.code == advice.row.code; }) -
        rows.begin());
    const double before = advice.row.value - *advice.row.limit;
    std::optional<std::pair<std::vector<double>, TimingChange>> best;  // the order, the change
    for (const Trial& trial : trials) {
      const double after = trial.found.values[2 * place + 1];
      if (!(after <= before - kHelps * before)) continue;
      const Key& key = keys[trial.key];
      TimingChange change{key.variable,
                          key.from,
                          trial.to,
                          advice.row.value,
                          trial.found.values[2 * place],
                          after <= 0,
                          trial.found.values.back() - efficiency,
                          {}};
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (!rows[k].flagged && !(trial.found.values[2 * k + 1] <= 0))
          change.worse.push_back(rows[k].quantity);
      const double others = static_cast<double>(change.worse.size());
      const std::vector<double> order =
          change.within ? std::vector<double>{0, others, static_cast<double>(trial.rank),
                                              -change.efficiency_change}
                        : std::vector<double>{1, others, after, 0};
      if (!best || order < best->first) best.emplace(order, std::move(change));
    }
    if (best) advice.change = std::move(best->second);
  }
  return result;
}

}  // namespace bentaxis::designs
