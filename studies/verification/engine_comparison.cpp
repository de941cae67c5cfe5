#include "bentaxis/study/engine_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/compare/reference.h"
#include "bentaxis/engines/mechanism.h"
#include "bentaxis/engines/run.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/reference_set.h"

namespace bentaxis::study {
namespace {

// Above this share of all that joints carry, the description does not fit the pump.
constexpr double kMaxResidual = 1e-9;
constexpr std::size_t kModelCount = 2;

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
  ResultTable some = table;
  some.theta_deg.clear();
  some.values.clear();
  for (const double angle : angles)
    for (std::size_t row = 0; row < table.rows(); ++row)
      if (std::abs(table.theta_deg[row] - angle) <= kSameAngle) {
        some.theta_deg.push_back(angle);
        for (std::size_t c = 0; c < table.columns(); ++c) some.values.push_back(table.at(row, c));
        break;
      }
  return some;
}

ResultTable table_of(const std::string& name, const engines::Mechanism& mechanism,
                     const engines::Answer& answer, const ResultTable& like) {
  ResultTable table = like;
  table.name = name;
  table.provenance = {{{"method", answer.text}}, answer.seconds};
  std::fill(table.values.begin(), table.values.end(), not_computed());
  const std::size_t width = mechanism.actions.size() + mechanism.supports.size();
  for (const engines::Reading& reading : mechanism.readings) {
    const std::size_t column = table.find(reading.channel);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      double value = 0;
      for (const auto& [place, factor] : reading.terms)
        value += factor * answer.values[row * width + static_cast<std::size_t>(place)];
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
// double precision.
double engine_tolerance(const std::string& engine) {
  static const std::map<std::string, double> tolerances = {{"mujoco", 1e-9}, {"dart", 1e-9}};
  const auto found = tolerances.find(engine);
  return found == tolerances.end() ? kDrivenTolerance : found->second;
}

void check_engines(const std::vector<std::string>& names) {
  std::string known;
  for (const std::string& name : engines::known_engines())
    known += (known.empty() ? "" : ", ") + name;
  for (const std::string& name : names)
    if (!engines::is_engine(name))
      throw InputError("--engine " + name + ": must be one of " + known +
                       ", or have a module in BENTAXIS_ENGINE_PATH");
}

EngineComparison compare_engines(const PreparedCase& ready, const EngineOptions& options,
                                 const ResultTable& analytic, const ResultTable& multibody,
                                 double model_tolerance, const PartProgress& progress_of) {
  check_engines(options.names);
  const Samples samples = ready.samples(Way::driven);
  engines::Mechanism mechanism =
      engines::assemble(ready.the_case, ready.the_case.analytic, samples);
  if (options.change) options.change(mechanism);
  EngineComparison result;
  std::vector<const ResultTable*> tables = {&analytic, &multibody};
  std::vector<double> tolerances(kModelCount, model_tolerance);
  result.results = {analytic.name, multibody.name};
  const auto is_given = [&](const Channel& channel) {
    return std::any_of(mechanism.readings.begin(), mechanism.readings.end(),
                       [&](const auto& reading) { return reading.channel == channel.name; });
  };
  const ResultTable given = select_channels(analytic, is_given);
  result.runs.reserve(options.names.size());
  for (const std::string& name : options.names) {
    EngineRun run;
    run.name = name;
    run.tolerance = engine_tolerance(name);
    engines::Answer answer = engines::run_engine(name, mechanism, progress_of("engine " + name));
    run.failure = answer.failure;
    run.text = answer.text;
    run.residual = answer.residual;
    run.seconds = answer.seconds;
    if (run.failure.empty() && !(run.residual <= kMaxResidual))
      run.failure = fmt::format("{}: joints carry {:.1e} of their loads outside of their supports",
                                name, run.residual);
    if (run.failure.empty()) run.table = table_of(name, mechanism, answer, given);
    result.runs.push_back(std::move(run));
    if (!result.runs.back().failure.empty()) continue;
    tables.push_back(&result.runs.back().table);
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
  const compare::ZeroScales scales = zero_scales(ready.the_case, samples);
  std::vector<ResultTable> held;
  for (const ResultTable* table : tables) held.push_back(select_channels(*table, is_given));
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
      auto cells = furthest(held[i], held[j], std::max(tolerances[i], tolerances[j]), scales);
      for (EngineRow& row : result.rows) row.pairs[i][j] = row.pairs[j][i] = cells[row.group];
    }
    if (result.curve.empty()) continue;
    const ResultTable here = at_angles(held[i], curve->theta_deg);
    auto cells = furthest(*curve, here, tolerances[i], scales);
    for (EngineRow& row : result.rows)
      if (const auto cell = cells.find(row.group);
          cell != cells.end() && (cell->second.difference.known() || !row.curve.empty()))
        row.curve.push_back(cell->second);
  }
  for (EngineRow& row : result.rows) row.odd = odd_ones(row, result.results);
  return result;
}

bool EngineComparison::agrees() const {
  return std::none_of(rows.begin(), rows.end(), [&](const EngineRow& row) {
    for (std::size_t i = kModelCount; i < results.size(); ++i)
      if (row.pairs[0][i].differs() || (!row.curve.empty() && row.curve[i].differs())) return true;
    return false;
  });
}

std::vector<std::string> EngineComparison::failures() const {
  std::vector<std::string> lines;
  for (const EngineRun& run : runs)
    if (!run.failure.empty()) lines.push_back(run.failure);
  return lines;
}

std::string EngineComparison::headline() const {
  const EngineCell* worst = nullptr;
  const EngineRow* where = nullptr;
  std::string engine;
  for (const EngineRow& row : rows)
    for (std::size_t i = kModelCount; i < results.size(); ++i)
      if (const EngineCell& cell = row.pairs[0][i];
          worst == nullptr ||
          cell.difference.share() / cell.tolerance > worst->difference.share() / worst->tolerance) {
        worst = &cell;
        where = &row;
        engine = results[i];
      }
  if (worst == nullptr) return "No engine has given results.";
  const std::string largest = fmt::format(
      "{} of {} at {:g} deg: {} of peak from the analytic model (tolerance {:g})", worst->channel,
      engine, worst->theta_deg, worst->difference.share_text(), worst->tolerance);
  if (agrees()) return "All engines agree. Largest difference: " + largest + ".";
  return fmt::format("Engines differ: {}.{}", largest,
                     where->odd.empty()
                         ? ""
                         : fmt::format(" {} {}.",
                                       where->curve.empty() ? "Alone against the others:"
                                                            : "Wrong by the stored curve:",
                                       where->odd));
}

}  // namespace bentaxis::study
