#include "bentaxis/study/simulation_document.h"
#include "simulation_parts.h"

namespace bentaxis::study {
namespace {

using report::Values;

constexpr std::size_t kMaxMarks = 2000;  // in a figure

Values state_of(const Trajectory& run, std::size_t column) {
  Values values;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    values.push_back(run.table.state(row, column));
  return values;
}

}  // namespace

report::Curves simulation_curves(const SimulationResult& r) {
  report::Curves curves;
  const auto runs = runs_of(r);
  curves.axis = "time (ms)";
  curves.theta_deg = times_of(*runs.front().second);
  for (const auto& [name, run] : runs) {
    report::Curves::Table table{name, {}};
    const auto& states = run->table.state_names;
    for (auto i = static_cast<std::size_t>(StateColumn::shaft_speed); i < states.size(); ++i)
      table.columns.emplace_back(states[i], state_of(*run, i));
    Values lag = run->lag;
    for (double& value : lag) value *= 1e3;
    table.columns.emplace_back("lag", std::move(lag));
    for (const Channel& channel : run->table.results.channels)
      if (channel.kind != ChannelKind::check)
        table.columns.emplace_back(channel.name,
                                   report::values_of(run->table.results, channel.name));
    if (run->oil)
      for (std::size_t c = 0; c < run->oil->columns.size(); ++c) {
        if (report::find(table.columns, run->oil->columns[c].name) != nullptr) continue;
        Values values;
        for (std::size_t row = 0; row < run->lag.size(); ++row)
          values.push_back(run->oil->value(row, c));
        table.columns.emplace_back(run->oil->columns[c].name, std::move(values));
      }
    curves.tables.push_back(std::move(table));
  }
  if (curves.tables.size() == 2)
    for (const auto& [name, values] : curves.tables[0].columns) {
      const Values* others = report::find(curves.tables[1].columns, name);
      if (others == nullptr) continue;
      Values difference;
      for (std::size_t row = 0; row < values.size(); ++row)
        difference.push_back((*others)[row] - values[row]);
      curves.difference.emplace_back(name, std::move(difference));
    }
  for (const ToothEvent& event : runs.front().second->record.events)
    if (event.touch && curves.marks.size() < kMaxMarks)
      curves.marks.push_back({event.time_s * kMilliseconds, event.flank > 0});
  return curves;
}

}  // namespace bentaxis::study
