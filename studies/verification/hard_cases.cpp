#include "bentaxis/study/hard_cases.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/rounding.h"
#include "bentaxis/compare/comparison.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/results/stopwatch.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/rounding_spread.h"

namespace bentaxis::study {
namespace {

ResultTable read_reference(const HardCase& hard, const ChannelLayout& layout,
                           const Samples& samples) {
  const auto file = hard.folder / "reference.csv";
  const NumericTable table = read_numeric_csv(file, true);
  ResultTable result;
  result.name = "reference";
  for (std::size_t c = 0; c < layout.reactions(); ++c) {
    result.channels.push_back(layout.channels()[c]);
    if (c + 1 >= table.header.size() || table.header[c + 1] != result.channels[c].name)
      throw InputError(file.string() + ":1: column " + std::to_string(c + 2) + " must be " +
                       result.channels[c].name);
  }
  if (table.rows.size() != samples.theta_deg.size())
    throw InputError(file.string() + ": must have " + std::to_string(samples.theta_deg.size()) +
                     " angles");
  result.theta_deg = samples.theta_deg;
  for (const auto& row : table.rows)
    result.values.insert(result.values.end(), row.begin() + 1, row.end());
  return result;
}

std::vector<GroupLoss> losses(const compare::Comparison& comparison) {
  std::vector<GroupLoss> groups;
  for (const auto& [group, largest] : largest_of_groups(comparison))
    groups.push_back({group, largest, 0});
  return groups;
}

using Run = std::function<ResultTable(const Case&)>;

void judge(HardOutcome& outcome) {
  outcome.verdict = HardVerdict::as_predicted;
  for (const GroupLoss& g : outcome.groups) {
    if (g.measured <= std::max(kRoundOffLoss, kPredictionFactor * g.predicted)) continue;
    outcome.verdict = HardVerdict::wrong;
    if (!outcome.message.empty()) outcome.message += "; ";
    outcome.message += is_computed(g.measured)
                           ? g.group + " is off by " + number_text(g.measured) +
                                 " of its peak, predicted were " + number_text(g.predicted)
                           : g.group + " has no value at some angle";
  }
}

// Runs a model and fills all but the prediction. False where it refused.
bool attempt(HardOutcome& outcome, const Case& the_case, const ResultTable& reference,
             const compare::Options& options, const Run& run, ResultTable& table) {
  const Stopwatch stopwatch;
  try {
    table = run(the_case);
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const Interrupted*>(&error) != nullptr) throw;
    const bool clear = dynamic_cast<const InputError*>(&error) != nullptr ||
                       dynamic_cast<const ComputationError*>(&error) != nullptr;
    outcome.message = error.what();
    outcome.verdict = clear && outcome.refusal_expected ? HardVerdict::refused : HardVerdict::wrong;
    return false;
  }
  outcome.seconds_per_angle = stopwatch.seconds() / static_cast<double>(table.rows());
  outcome.groups = losses(compare::compare_tables(reference, table, options));
  return true;
}

}  // namespace

const std::vector<std::string>& hard_models() {
  static const std::vector<std::string> models = {"analytic", "multibody", "residual"};
  return models;
}

const char* to_string(HardVerdict verdict) {
  switch (verdict) {
    case HardVerdict::as_predicted:
      return "accurate";
    case HardVerdict::refused:
      return "refused";
    case HardVerdict::wrong:
      break;
  }
  return "WRONG";
}

const GroupLoss* HardOutcome::worst() const {
  const auto it =
      std::max_element(groups.begin(), groups.end(), [](const GroupLoss& a, const GroupLoss& b) {
        return std::isnan(b.measured) ? !std::isnan(a.measured) : a.measured < b.measured;
      });
  return it == groups.end() ? nullptr : &*it;
}

std::optional<double> HardOutcome::worst_ratio() const {
  std::optional<double> worst;
  for (const GroupLoss& g : groups) {
    if (g.measured <= kNoticeableLoss) continue;
    const double ratio = g.measured / std::max(g.predicted, 1e-300);
    if (!worst || std::abs(std::log(ratio)) > std::abs(std::log(*worst))) worst = ratio;
  }
  return worst;
}

std::vector<HardCase> read_catalogue(const std::filesystem::path& folder,
                                     const std::string& filter) {
  const auto file = folder / "catalogue.toml";
  const TomlFile toml = TomlFile::read(file, "catalogue of hard cases");
  TableReader root = toml.root();
  root.text("base");                                  // of the generator
  root.integer("samples_per_revolution", 1, 100000);  // likewise
  std::vector<HardCase> cases;
  for (TableReader& entry : root.tables("case")) {
    HardCase hard;
    hard.name = entry.text("name");
    hard.group = entry.text("group");
    hard.hard = entry.text("hard");
    for (const std::string& model : hard_models())
      if (entry.choice(model, {"accurate", "refused"}, 0) == 1) hard.refused.push_back(model);
    TableReader change = entry.optional_table("change");
    for (const std::string& key : change.keys())
      hard.changes.push_back(key + " = " + change.any(key));
    entry.finish();
    hard.folder = folder / hard.name;
    if (hard.name.find(filter) != std::string::npos) cases.push_back(std::move(hard));
  }
  root.finish();
  if (cases.empty()) throw InputError(file.string() + ": no case named like \"" + filter + "\"");
  return cases;
}

namespace {

HardOutcome outcome_of(const HardCase& hard, const std::string& model) {
  HardOutcome outcome;
  outcome.model = model;
  outcome.refusal_expected = contains(hard.refused, model);
  return outcome;
}

}  // namespace

std::vector<HardOutcome> run_hard_case(const HardCase& hard, const PartProgress& progress_of) {
  const Case the_case = read_case(hard.folder / "case.toml");
  const PressureTrace pressure(the_case.pressure);
  const Samples samples = sample_case(the_case, pressure);
  const ResultTable reference = read_reference(hard, ChannelLayout(the_case.pump), samples);
  compare::Options options;
  options.zero_scales = zero_scales(the_case, samples);
  const Progress progress = progress_of(hard.name);

  HardOutcome analytic = outcome_of(hard, "analytic");
  ResultTable table;
  const Run run_analytic = [&](const Case& c) { return analytic::run(c, c.analytic, samples); };
  std::map<std::string, double> of_inputs;  // over peak
  if (attempt(analytic, the_case, reference, options, run_analytic, table)) {
    const auto estimated = analytic::estimate_rounding(the_case, the_case.analytic, samples,
                                                       pressure, samples.theta_deg.size());
    const GroupLoss* worst = analytic.worst();
    for (GroupLoss& g : analytic.groups) {
      for (const auto& e : estimated) {
        if (e.group != g.group) continue;
        const auto channel = std::find_if(reference.channels.begin(), reference.channels.end(),
                                          [&](const Channel& c) { return c.group == e.group; });
        const double peak = compare::scale_of(reference, *channel, options.zero_scales);
        if (!(peak > 0)) continue;
        g.predicted = e.total() / peak;
        of_inputs[g.group] = e.inputs / peak;
        if (&g == worst) analytic.weak_point = e.input;
      }
    }
    judge(analytic);
  }
  std::vector<HardOutcome> outcomes = {analytic};

  for (const auto& [name, method] : {std::pair{"multibody", multibody::Method::multipliers},
                                     std::pair{"residual", multibody::Method::residual}}) {
    HardOutcome outcome = outcome_of(hard, name);
    const Run run = [&, way = method](const Case& c) {
      return multibody::run_driven(c, c.multibody, samples, progress, multibody::Scene::full, way);
    };
    if (attempt(outcome, the_case, reference, options, run, table)) {
      outcome.weak_point = analytic.weak_point;
      std::map<std::string, double> spread;
      try {
        spread = rounding_spread(the_case, table, options, run);
      } catch (const NoEstimate& none) {
        outcome.message = none.what();
      }
      for (GroupLoss& g : outcome.groups) g.predicted = of_inputs[g.group] + spread[g.group];
      judge(outcome);
    }
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

bool LongRun::bounded() const {
  constexpr double kGrowth = 2;
  return position_error[1] <= kGrowth * position_error[0] &&
         reaction_error[1] <= kGrowth * reaction_error[0];
}

std::vector<double> errors_of_turns(const ResultTable& reference, const ResultTable& table,
                                    const compare::ZeroScales& zero_scales, int samples_per_turn) {
  std::vector<compare::Difference> turns((reference.rows() + samples_per_turn - 1) /
                                         samples_per_turn);
  for (std::size_t c = 0; c < reference.columns(); ++c) {
    const Channel& channel = reference.channels[c];
    if (channel.kind != ChannelKind::reaction) continue;
    const double scale = compare::scale_of(reference, channel, zero_scales);
    for (std::size_t row = 0; row < reference.rows(); ++row)
      turns[row / samples_per_turn].keep_larger(
          compare::difference(reference.at(row, c), table.at(row, c), scale));
  }
  std::vector<double> errors;
  for (const compare::Difference& turn : turns) errors.push_back(turn.share());
  return errors;
}

LongRun run_long(const std::filesystem::path& catalogue, int turns, double accuracy,
                 const PartProgress& progress_of) {
  Case the_case = read_case(catalogue / "long_run" / "case.toml");
  the_case.operation.revolutions = turns;
  const PressureTrace pressure(the_case.pressure);
  const Samples samples = sample_case(the_case, pressure, turns);
  const ResultTable analytic = analytic::run(the_case, the_case.analytic, samples);
  const compare::ZeroScales scales = zero_scales(the_case, samples);
  const auto run = multibody::run_integrated(the_case, the_case.multibody, samples, pressure,
                                             {.accuracy = accuracy},
                                             progress_of(std::to_string(turns) + " turns"));
  const std::vector<double> errors =
      errors_of_turns(analytic, run.table, scales, the_case.operation.samples_per_revolution);
  LongRun result;
  result.turns = turns;
  result.accuracy = accuracy;
  result.seconds = run.record.seconds;
  result.work_of_loads = run.record.work_of_loads;
  int next = 1;
  for (int turn = 0; turn < turns; ++turn) {
    const int half = 2 * turn < turns ? 0 : 1;
    const auto& record = run.record.turns[turn];
    update_max_abs(result.position_error[half], record.position_error);
    update_max_abs(result.reaction_error[half], errors[turn]);
    if (turn + 1 != next && turn + 1 != turns) continue;
    result.shown.push_back({turn + 1, record, errors[turn]});
    const int leading = std::stoi(std::to_string(next).substr(0, 1));  // 1, 2, 5, 10, ..
    next = leading == 2 ? next / 2 * 5 : next * 2;
  }
  return result;
}

}  // namespace bentaxis::study
