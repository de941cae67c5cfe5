#include "differences.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"

namespace bentaxis::study {
namespace {

constexpr const char* kFlow = "l/min";

}  // namespace

Compared compared_column(const Column& column) {
  return {column.group, column.unit, column.unit != kFlow};
}

std::size_t judged_rows(const std::vector<double>& growth, double error, double disturbance) {
  std::size_t rows = 0;
  // Nor where the disturbance itself, which is larger with oil, has come to that: growth is then no
  // longer known.
  while (rows < growth.size() && error * growth[rows] <= kNothingToJudge &&
         growth[rows] * disturbance <= kNothingToJudge)
    ++rows;
  return rows;
}

namespace {

// use(what it is, value) of everything compared in a row.
template <class Use>
void for_each_tooth_value(const Trajectory& run, std::size_t row, const Use& use) {
  const TeethAction& action = run.teeth[row];
  double force[2] = {};
  for (std::size_t i = 0; i < action.pairs.size(); ++i)
    force[i / kPairsPerFlank] += action.pairs[i].force;
  use(Compared{"lag of the teeth", "rad", true}, action.lag);
  for (const double flank : force) use(Compared{"tooth force", "N", true}, flank);
}

template <class Use>
void for_each_value(const Trajectory& run, std::size_t row, const Use& use) {
  const ResultTable& table = run.table.results;
  for (std::size_t c = 0; c < table.columns(); ++c)
    if (table.channels[c].kind == ChannelKind::reaction && table.channels[c].of_pump)
      use(Compared{table.channels[c].group, table.channels[c].unit, true}, table.at(row, c));
  if (!run.teeth.empty()) for_each_tooth_value(run, row, use);
  if (!run.oil) return;
  for (std::size_t c = 0; c < run.oil->columns.size(); ++c)
    if (const Compared what = compared_column(run.oil->columns[c]); !what.group.empty())
      use(what, run.oil->value(row, c));
}

// Of vectors the peak is that of their length, as everywhere.
Scales peaks_of(const Trajectory& run) {
  Scales peaks;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    for_each_value(run, row, [&](const Compared& what, double value) {
      double& peak = peaks[what.group];
      peak = std::max(peak, std::abs(value));
    });
  for (auto& [group, peak] : peaks) peak = std::max(peak, run.table.results.peak(group));
  return peaks;
}

// use(what it is, difference) of everything compared in a row.
template <class Use>
void for_each_difference(const Trajectory& a, const Trajectory& b, const Scales& scales,
                         std::size_t row, const Use& use) {
  std::vector<double> others;
  for_each_value(b, row, [&](const Compared&, double value) { others.push_back(value); });
  std::size_t next = 0;
  for_each_value(a, row, [&](const Compared& what, double value) {
    const double other = next < others.size() ? others[next] : not_computed();
    ++next;
    use(what, compare::difference(value, other, scales.at(what.group)));
  });
}

}  // namespace

double fastest_speed(const Trajectory& run, std::size_t row) {
  double speed = 0;
  for (const StateColumn body : {StateColumn::shaft_speed, StateColumn::block_speed})
    speed = std::max(speed, kRadPerSecondPerRpm * std::abs(run.state(row, body)));
  return speed;
}

LoadScale loads_of(const Case& the_case, const Trajectory& run) {
  Samples samples;
  samples.pistons = the_case.pump.geometry.pistons;
  samples.ports = the_case.pressure.ports;
  const ResultTable& table = run.table.results;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    samples.omega = std::max(samples.omega, fastest_speed(run, row));
    for (std::size_t c = 0; c < table.columns(); ++c)
      if (table.channels[c].quantity == "p" && is_computed(table.at(row, c)))
        samples.chamber_pressure.push_back(table.at(row, c) * table.channels[c].unit_in_si);
  }
  return load_scale(the_case, samples);
}

// An angle of the teeth has the round-off of the bodies' angles.
Scales scales_of(const Case& the_case, const Trajectory& run, double error) {
  const LoadScale loads = loads_of(the_case, run);
  Scales scales = peaks_of(run);
  if (run.lag.empty()) return scales;
  const double bar = scales.count("p") > 0 ? scales.at("p") : 0;
  double flow = 0;
  for_each_value(run, 0, [&](const Compared& what, double) {
    if (what.unit == kFlow) flow = std::max(flow, scales.at(what.group));
  });
  for_each_value(run, 0, [&](const Compared& what, double) {
    double& scale = scales.at(what.group);
    if (what.unit == "rad")
      scale = std::max(scale, compare::kNoSignal / error);
    else if (what.unit == kFlow)
      scale = scale > 0 ? scale : flow;
    else
      scale = compare::scale_of(scale, what.unit == "N"     ? loads.force
                                       : what.unit == "Nm"  ? loads.moment
                                       : what.unit == "bar" ? bar
                                                            : 0);
  });
  return scales;
}

double largest_difference(const Trajectory& a, const Trajectory& b, const Scales& scales,
                          std::size_t row) {
  compare::Difference largest;
  for_each_difference(a, b, scales, row,
                      [&](const Compared& what, const compare::Difference& difference) {
                        if (what.judged) largest.keep_larger(difference);
                      });
  return largest.share();
}

std::vector<GroupDifference> group_differences(const Trajectory& first, const Trajectory& second,
                                               const Trajectory* turned, const Scales& scales,
                                               const std::vector<double>& allowed,
                                               const PressureSteps& steps) {
  const Scales peaks = peaks_of(first);
  struct Largest {
    GroupDifference group;
    compare::Difference in_time, over_angle;
  };
  std::map<std::string, Largest> groups;
  for (std::size_t row = 0; row < allowed.size(); ++row) {
    if (steps.between(first, second, row, allowed[row])) continue;
    const double time = first.state(row, StateColumn::time);
    for_each_difference(first, second, scales, row,
                        [&](const Compared& what, const compare::Difference& difference) {
                          auto& [group, in_time, over_angle] = groups[what.group];
                          group.group = what.group;
                          group.unit = what.unit;
                          group.peak = peaks.at(what.group);
                          group.scale = scales.at(what.group);
                          group.judged = what.judged;
                          if (in_time.keep_larger(difference)) group.time_s = time;
                          if (!what.judged) return;
                          const double before = group.of_allowed;
                          update_max_abs(group.of_allowed, difference.share() / allowed[row]);
                          if (is_computed(before) && group.of_allowed != before)
                            group.allowed_s = time;
                        });
    if (turned == nullptr || steps.between(*turned, second, row, allowed[row])) continue;
    for_each_difference(*turned, second, scales, row,
                        [&](const Compared& what, const compare::Difference& difference) {
                          groups[what.group].over_angle.keep_larger(difference);
                        });
  }
  std::vector<GroupDifference> result;
  for (auto& [name, largest] : groups) {
    GroupDifference& group = result.emplace_back(std::move(largest.group));
    group.in_time = largest.in_time.share();
    group.over_angle = largest.over_angle.share();
    if (!group.judged) group.of_allowed = not_computed();
  }
  return result;
}

void sort_groups(std::vector<GroupDifference>& groups) {
  const auto key = [](const GroupDifference& g) {
    const double size = g.judged ? g.of_allowed : g.in_time;
    return std::tuple(g.judged, !is_computed(size), is_computed(size) ? size : 0);
  };
  std::sort(groups.begin(), groups.end(),
            [&](const auto& x, const auto& y) { return key(x) > key(y); });
}

}  // namespace bentaxis::study
