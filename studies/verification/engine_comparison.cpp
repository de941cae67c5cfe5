#include "bentaxis/study/engine_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bentaxis/compare/reference.h"
#include "bentaxis/engines/mechanism.h"
#include "bentaxis/engines/run.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/reference_set.h"

namespace bentaxis::study {
namespace {

// Above this share of all that joints carry, the description does not fit the pump.
constexpr double kMaxResidual = 1e-9;

// Whether two cases are the same run, however often they are sampled.
bool same_run(const Case& a, const Case& b) {
  return differing_keys(a, b).empty() && a.analytic == b.analytic &&
         a.pump.port_plate.has_value() == b.pump.port_plate.has_value() &&
         a.pump.piston.contact == b.pump.piston.contact &&
         a.pressure.curve.theta_deg == b.pressure.curve.theta_deg &&
         a.pressure.curve.pressure == b.pressure.curve.pressure;
}

// The stored curve of a case, if there is one: its folder's name and values.
std::optional<std::pair<std::string, ResultTable>> stored_curve(
    const std::vector<std::filesystem::path>& folders, const Case& the_case) {
  for (const std::filesystem::path& folder : folders)
    for (const ReferencePlace& place : references_below(folder)) {
      const auto description = compare::read_description(place.folder, place.name);
      if (description.kind == compare::ReferenceKind::high_precision &&
          description.curves.size() == 1 && same_run(read_case(description.case_file), the_case))
        return std::pair(
            place.name,
            compare::read_reference_curve(
                description, description.curves.front(), ChannelLayout(the_case.pump).channels(),
                rad_per_second(the_case.operation.speed_rpm) / kRadPerDegree)
                .table);
    }
  return std::nullopt;
}

// Rows of a table at the angles of another, if it has them all; else none.
ResultTable at_angles(const ResultTable& table, const std::vector<double>& angles) {
  constexpr double kSameAngle = 1e-9;  // deg
  std::vector<double> found;
  std::vector<std::size_t> rows;
  for (const double angle : angles)
    for (std::size_t row = 0; row < table.rows(); ++row)
      if (std::abs(table.theta_deg[row] - angle) <= kSameAngle) {
        found.push_back(angle);
        rows.push_back(row);
        break;
      }
  ResultTable some = select_rows(table, rows);
  some.theta_deg = std::move(found);
  return some;
}

// What an engine is given, and where its results belong.
struct Turn {
  engines::Mechanism mechanism;
  engines::Integrated how = {0, 0, 1, ""};
  std::vector<double> angles;      // of the rows, rising
  std::vector<std::size_t> order;  // per row its place among the results
  std::size_t state(std::size_t row) const {
    return static_cast<std::size_t>(how.first) + order[row] * static_cast<std::size_t>(how.every);
  }
};

ResultTable table_of(const std::string& name, const Turn& turn, const engines::Answer& answer,
                     const ResultTable& like) {
  const engines::Mechanism& mechanism = turn.mechanism;
  ResultTable table{
      name, like.channels, like.theta_deg, {}, {{{"method", answer.text}}, answer.seconds}};
  table.values.assign(table.rows() * table.columns(), not_computed());
  const std::size_t width = mechanism.actions.size() + mechanism.supports.size();
  for (const engines::Reading& reading : mechanism.readings) {
    const std::size_t column = table.find(reading.channel);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      double value = 0;
      for (const auto& [place, factor] : reading.terms) {
        const auto index = static_cast<std::size_t>(place);
        const double share =
            reading.component
                ? mechanism.states[turn.state(row)].actions[index].dot(*reading.component)
                : 1;
        value += factor * share * answer.values[turn.order[row] * width + index];
      }
      table.values[row * table.columns() + column] = value / table.channels[column].unit_in_si;
    }
  }
  return table;
}

// The furthest channel of each group.
std::map<std::string, EngineCell> furthest(const ResultTable& first, const ResultTable& second,
                                           double tolerance, const compare::ZeroScales& scales) {
  compare::Options options;
  options.tolerance = tolerance;
  options.zero_scales = scales;
  options.may_be_missing = [](const Channel&, std::size_t) { return true; };
  std::map<std::string, EngineCell> cells;
  for (const auto& channel : compare::compare_tables(first, second, options).channels) {
    EngineCell& cell = cells[channel.channel.group];
    cell.tolerance = tolerance;
    if (channel.compared() && cell.difference.keep_larger(channel.difference())) {
      cell.channel = channel.channel.name;
      cell.theta_deg = channel.theta_of_largest_deg;
    }
  }
  return cells;
}

// The results that stand alone in a row.
std::string odd_ones(const EngineRow& row, const std::vector<std::string>& names) {
  std::string odd;
  const auto add = [&](std::size_t i) { odd += (odd.empty() ? "" : ", ") + names[i]; };
  if (!row.curve.empty()) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (row.curve[i].differs()) add(i);
    return odd;
  }
  const auto agree = [](const EngineCell& cell) { return cell.difference.within(cell.tolerance); };
  for (std::size_t i = 0; i < names.size(); ++i) {
    bool differs = false, agrees = false, others_agree = false;
    for (std::size_t j = 0; j < names.size(); ++j) {
      if (j == i) continue;
      const EngineCell& cell = row.pairs[i][j];
      (cell.differs() ? differs : agrees) |= cell.difference.known();
      for (std::size_t k = 0; k < j; ++k) others_agree |= k != i && agree(row.pairs[j][k]);
    }
    if (differs && !agrees && others_agree) add(i);
  }
  return odd;
}

}  // namespace

// Written down before the engines were run: at given motion all solve the same linear equations in
// double precision. Integrated, bench/peers has errors of Rs near 1e-5 (MuJoCo) and 1e-4 (DART) at
// these steps; small reactions such as Rcs are differences of joint forces forty times as large.
double engine_tolerance(const std::string& engine, EngineWay way) {
  struct Tolerances {
    double given, integrated;
  };
  static const std::map<std::string, Tolerances> tolerances = {
      {"mujoco", {1e-9, 1e-3}}, {"dart", {1e-9, 1e-2}}, {"bullet", {1e-9, 1e-2}}};
  const auto found = tolerances.find(engine);
  const Tolerances own =
      found == tolerances.end() ? Tolerances{kDrivenTolerance, 1e-2} : found->second;
  return way == EngineWay::given ? own.given : own.integrated;
}

const std::vector<int>& engine_sweep_steps() {
  static const std::vector<int> steps = {180, 360, 720, 1440, 2880, 5760};
  return steps;
}

namespace {

// The settings of one engine, of those that are asked for.
std::string settings_for(const std::string& engine, const std::vector<std::string>& settings) {
  std::vector<std::string> own;
  for (const std::string& setting : settings)
    if (setting.starts_with(engine + ".")) own.push_back(setting.substr(engine.size() + 1));
  return joined(own, " ");
}

}  // namespace

void check_engines(const EngineOptions& options) {
  for (auto it = options.names.begin(); it != options.names.end(); ++it)
    if (std::find(options.names.begin(), it, *it) != it)
      throw InputError("--engine " + *it + ": is specified more than once");
  for (const std::string& name : options.names)
    if (!engines::is_engine(name))
      throw InputError("--engine " + name + ": must be one of " + joined(engines::known_engines()) +
                       ", or have a module in BENTAXIS_ENGINE_PATH");
  for (const std::string& setting : options.settings) {
    const std::size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || equals <= dot + 1 ||
        equals + 1 == setting.size() || setting.find(' ') != std::string::npos)
      throw InputError("--engine-setting " + setting + ": must be ENGINE.NAME=VALUE");
    const std::string engine = setting.substr(0, dot);
    if (!contains(options.names, engine))
      throw InputError("--engine-setting " + setting + ": " + engine + " must be one of --engine");
    const std::string name = setting.substr(dot + 1, equals - dot - 1);
    std::string names;
    bool there = false;
    for (const engines::Setting& one : engines::settings_of(engine)) {
      names += (names.empty() ? "" : ", ") + one.name;
      if (one.name != name) continue;
      there = true;
      if (const std::string allowed = one.refusal(setting.substr(equals + 1)); !allowed.empty())
        throw InputError("--engine-setting " + setting + ": must be " + allowed);
    }
    // Of an engine that cannot be asked the run says why.
    if (!names.empty() && !there)
      throw InputError("--engine-setting " + setting + ": " + engine + " has " + names);
  }
}

namespace {

// An integrated run: a fifth of a turn before lets joints settle.
Turn turn_of(const PreparedCase& ready, int steps, int results) {
  Case finer = ready.the_case;
  finer.operation.samples_per_revolution = 2 * steps;
  const int settling = steps / 5;
  // A speed below 0 runs through the angles backwards.
  const bool falling = finer.operation.speed_rpm < 0;
  const Samples samples = sample_case(finer, ready.pressure, 3, falling,
                                      {2 * (steps - settling), 2 * (steps + settling) + 1});
  Turn turn;
  turn.mechanism = engines::assemble(finer, finer.analytic, samples);
  turn.how.interval = 2 * kPi / std::abs(samples.omega) / (2 * steps);
  turn.how.first = 2 * settling;
  turn.how.every = 2 * steps / results;
  for (int i = 0; i < results; ++i) {
    turn.angles.push_back(360.0 * i / results);
    turn.order.push_back(static_cast<std::size_t>(falling ? (results - i) % results : i));
  }
  return turn;
}

// Time against error of every engine, one setting changed at a time.
void sweep_engines(const PreparedCase& ready, const EngineOptions& options,
                   const ResultTable& analytic, const compare::ZeroScales& scales,
                   const PartProgress& progress_of, EngineComparison& result) {
  int results = ready.the_case.operation.samples_per_revolution;
  for (const int steps : engine_sweep_steps()) results = std::gcd(results, steps);
  result.sweep_angles = results;
  struct Variant {
    std::string engine, setting;
  };
  std::vector<Variant> variants;
  for (const std::string& engine : options.names) {
    variants.push_back({engine, ""});
    for (const engines::Setting& setting : engines::settings_of(engine))
      for (std::size_t i = 1; i < setting.values.size(); ++i)
        variants.push_back({engine, setting.name + "=" + setting.values[i]});
  }
  const Progress progress = progress_of("engines: time against error");
  const double all = static_cast<double>(variants.size() * engine_sweep_steps().size());
  double done = 0;
  for (const int steps : engine_sweep_steps()) {
    Turn turn = turn_of(ready, steps, results);
    const ResultTable right = at_angles(
        select_channels(analytic,
                        [&](const Channel& channel) {
                          return std::any_of(
                              turn.mechanism.readings.begin(), turn.mechanism.readings.end(),
                              [&](const auto& one) { return one.channel == channel.name; });
                        }),
        turn.angles);
    for (const Variant& variant : variants) {
      turn.how.settings = settings_for(variant.engine, options.settings);
      if (!variant.setting.empty()) turn.how.settings += " " + variant.setting;
      const engines::Answer answer = engines::run_engine(
          variant.engine, turn.mechanism, [&](double) { progress(done / all); }, turn.how);
      EngineEffort effort;
      effort.engine = variant.engine;
      effort.setting = variant.setting;
      effort.steps = steps;
      effort.failure = answer.failure;
      effort.seconds = answer.turn_seconds;
      if (answer.failure.empty()) {
        const ResultTable table = table_of(variant.engine, turn, answer, right);
        for (const auto& [group, cell] : furthest(right, table, 1, scales)) {
          if (!cell.difference.known()) continue;
          const double error = cell.difference.share();
          if (group == "Rs") effort.joints = error;
          if (!(error <= effort.worst)) {
            effort.worst = error;
            effort.channel = cell.channel;
          }
        }
      }
      result.sweep.push_back(std::move(effort));
      ++done;
    }
  }
  progress(1);
}

}  // namespace

EngineComparison compare_engines(const PreparedCase& ready, const EngineOptions& options,
                                 const ResultTable& analytic, const ResultTable* multibody,
                                 double model_tolerance, const PartProgress& progress_of) {
  check_engines(options);
  const Samples samples = ready.samples(Way::driven);
  const compare::ZeroScales scales = zero_scales(ready.the_case, samples);
  const int per_turn = ready.the_case.operation.samples_per_revolution;
  EngineComparison result;
  result.way = options.way;
  const bool integrated = options.way == EngineWay::integrated;
  if ((integrated || options.sweep) && samples.omega == 0)
    throw InputError(ready.the_case.file.string() +
                     ": --engine: speed_rpm = 0: must not be 0 where engines integrate");
  if ((integrated || options.sweep) && ready.the_case.pump.transfer.is_uneven_joint())
    throw InputError(ready.the_case.file.string() + ": --engine: transfer of kind " +
                     to_string(ready.the_case.pump.transfer.kind) +
                     ": has no integration, which holds the "
                     "block at constant speed; use --engine-way given");
  Turn turn;
  if (integrated) {
    result.steps = options.steps;
    turn = turn_of(ready, options.steps, std::gcd(options.steps, per_turn));
  } else {
    turn.mechanism = engines::assemble(ready.the_case, ready.the_case.analytic, samples);
    for (std::size_t row = 0; row < samples.theta_deg.size(); ++row) turn.order.push_back(row);
  }
  engines::Mechanism& mechanism = turn.mechanism;
  if (options.change) options.change(mechanism);
  const auto is_given = [&](const Channel& channel) {
    return std::any_of(mechanism.readings.begin(), mechanism.readings.end(),
                       [&](const auto& reading) { return reading.channel == channel.name; });
  };
  const auto at_results = [&](const ResultTable& table) {
    const ResultTable some = select_channels(table, is_given);
    return integrated ? at_angles(some, turn.angles) : some;
  };
  const ResultTable given = at_results(analytic);
  result.angles = static_cast<int>(given.rows());
  std::vector<const ResultTable*> held = {&given};
  result.results = {analytic.name};
  ResultTable other;
  if (multibody != nullptr) {
    other = at_results(*multibody);
    held.push_back(&other);
    result.results.push_back(other.name);
  }
  result.models = held.size();
  std::vector<double> tolerances(result.models, model_tolerance);
  result.runs.reserve(options.names.size());
  for (const std::string& name : options.names) {
    EngineRun run;
    run.name = name;
    run.tolerance = engine_tolerance(name, options.way);
    turn.how.settings = settings_for(name, options.settings);
    const engines::Answer answer =
        engines::run_engine(name, mechanism, progress_of("engine " + name),
                            integrated ? std::optional(turn.how) : std::nullopt);
    run.failure = answer.failure;
    run.text = answer.text;
    run.residual = answer.residual;
    run.seconds = answer.seconds;
    run.turn_seconds = answer.turn_seconds;
    if (run.failure.empty() && !integrated && !(run.residual <= kMaxResidual))
      run.failure = fmt::format("{}: joints carry {:.1e} of their loads outside of their supports",
                                name, run.residual);
    if (run.failure.empty()) run.table = table_of(name, turn, answer, given);
    result.runs.push_back(std::move(run));
    if (!result.runs.back().failure.empty()) continue;
    held.push_back(&result.runs.back().table);
    tolerances.push_back(result.runs.back().tolerance);
    result.results.push_back(name);
  }
  std::map<std::string, std::string> reasons;
  for (const Channel& channel : analytic.channels)
    if (!is_given(channel)) {
      std::string name = channel.name;
      if (channel.piston > 0)
        name.replace(name.find("_" + std::to_string(channel.piston)) + 1,
                     std::to_string(channel.piston).size(), "k");
      if (reasons.emplace(name, "").second)
        result.not_given.emplace_back(name, engines::why_not_given(channel));
    }
  std::optional<ResultTable> curve;
  if (auto stored = stored_curve(options.curves, ready.the_case)) {
    curve = at_angles(stored->second, given.theta_deg);
    result.curve_angles = curve->rows();
    if (curve->rows() > 0) result.curve = stored->first;
  }
  for (const Channel& channel : given.channels) {
    if (std::any_of(result.rows.begin(), result.rows.end(),
                    [&](const EngineRow& row) { return row.group == channel.group; }))
      continue;
    EngineRow row;
    row.group = channel.group;
    row.unit = channel.unit;
    row.peak = compare::scale_of(analytic, channel, scales);
    row.pairs.assign(held.size(), std::vector<EngineCell>(held.size()));
    result.rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < held.size(); ++i) {
    for (std::size_t j = i + 1; j < held.size(); ++j) {
      auto cells = furthest(*held[i], *held[j], std::max(tolerances[i], tolerances[j]), scales);
      for (EngineRow& row : result.rows) row.pairs[i][j] = row.pairs[j][i] = cells[row.group];
    }
    if (result.curve.empty()) continue;
    const ResultTable here = at_angles(*held[i], curve->theta_deg);
    auto cells = furthest(*curve, here, tolerances[i], scales);
    for (EngineRow& row : result.rows)
      if (const auto cell = cells.find(row.group);
          cell != cells.end() && (cell->second.difference.known() || !row.curve.empty()))
        row.curve.push_back(cell->second);
  }
  for (EngineRow& row : result.rows) row.odd = odd_ones(row, result.results);
  if (options.sweep) sweep_engines(ready, options, analytic, scales, progress_of, result);
  return result;
}

const EngineCalls kEngineCalls = {check_engines, compare_engines};

}  // namespace bentaxis::study
