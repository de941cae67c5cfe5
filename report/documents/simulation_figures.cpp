#include <fmt/format.h>

#include <optional>

#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/force_figures.h"
#include "bentaxis/study/teeth_section.h"
#include "simulation_parts.h"

namespace bentaxis::study {
namespace {

using report::Figure;
using report::Values;

// Columns of the oil in a unit, those of chambers apart.
std::vector<std::string> columns_of(const SimulationResult& r, const std::string& unit) {
  std::vector<std::string> names;
  for (const OilColumn& column : runs_of(r).front().second->oil->columns)
    if (column.unit == unit && column.piston == 0) names.push_back(column.name);
  return names;
}

std::vector<Figure> curves_over_time(const SimulationResult& r) {
  std::vector<Figure> figures;
  const auto add = [&](const std::string& id, const std::string& title, const std::string& unit,
                       std::vector<std::string> names) {
    figures.push_back({id, title, "", report::ChannelFigure{unit, std::move(names)}});
  };
  std::vector<std::string> speeds = {"shaft_rpm", "block_rpm"};
  if (r.ready.the_case.drive->kind == DriveKind::motor) speeds.emplace_back("motor_rpm");
  add("speed", "Speeds of shaft and block", "rpm", speeds);
  if (compliant(r)) add("lag", "Lag of the block, theta - psi", "mrad", {"lag"});
  add("rcs", "Gear tooth force Rcs on the block, by the shaft, at O4, along z4", "N", {"Rcs_z4_N"});
  add("td", "Drive torque Td", "Nm", {"Td_z1_Nm"});
  add("pressure",
      r.oil_follows ? "Chamber pressure of piston 1"
                    : "Chamber pressure of piston 1, at the angle of the block in each model",
      "bar", {"p_1_bar"});
  if (r.oil_follows) {
    add("ports", "Pressures of the ports", "bar", columns_of(r, "bar"));
    add("flows", "Flows: into the load, from suction, leakage", "l/min", columns_of(r, "l/min"));
  }
  add("rs", "Joint force Rs on piston 1, in S2", "N", {"Rs_1_x2_N", "Rs_1_y2_N", "Rs_1_z2_N"});
  add("rc", "Bore force Rc on piston 1, in S2", "N", {"Rc_1_x2_N", "Rc_1_y2_N"});
  add("rb1", "Tapered bearing force Rb1 on the shaft, in S1", "N",
      {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N"});
  add("rb2", "Cylindrical bearing force Rb2 on the shaft, in S1", "N", {"Rb2_x1_N", "Rb2_y1_N"});
  add("pin", "Pin force Rcn on the block", "N", {"Rcn_x2_N", "Rcn_y2_N"});
  add("film", "Film force Fh of the port plate on the block", "N", {"Fh_z2_N"});
  if (compliant(r))
    for (Figure& figure : figures)
      figure.note =
          "Ticks below: touches of the teeth; upper row the driving flank, lower row the other.";
  return figures;
}

Values positive(Values values) {
  for (double& value : values)
    if (!(value > 0)) value = not_computed();
  return values;
}

Figure difference_figure(const SimulationResult& r) {
  const Values times = times_of(*r.analytic);
  Values allowed, disturbed;
  for (std::size_t row = 0; row < times.size(); ++row) {
    allowed.push_back(r.allowed(row));
    disturbed.push_back(r.growth[row] * r.disturbance);
  }
  report::XyFigure content{{"time", "ms"}, {"difference over peak", "", true}, {}};
  content.series = {
      {"of the models, largest of any reaction", times, positive(r.difference)},
      {"tolerance: wanted error times amplification", times, allowed},
      {fmt::format("after a disturbance of {:g} at the start", r.disturbance), times, disturbed}};
  return {"difference", "Difference of the models and amplification of disturbances", "",
          std::move(content),
          "Impacts amplify every error. The amplification of a disturbance of the initial state "
          "shows how much of a difference is caused by the motion itself."};
}

std::optional<Figure> effort_figure(const SimulationResult& r) {
  report::ScatterFigure content{
      {"time of the run", "s", true}, {"largest error of any reaction, of peak", "", true}, {}};
  for (const Model model : kModels) {
    report::ScatterSeries series{to_string(model), static_cast<int>(model), true, false, {}};
    for (const Effort& effort : r.effort)
      if (effort.model == model && is_computed(effort.error) && effort.error > 0)
        series.points.push_back(
            {effort.seconds, effort.error, fmt::format("{}, {:g}", effort.method, effort.asked)});
    if (!series.points.empty()) content.series.push_back(std::move(series));
  }
  if (content.series.empty()) return std::nullopt;
  return Figure{"effort", "Speed against error", "", std::move(content),
                "Analytic: against its tightest run. Multibody: against the analytic model. Errors "
                "within the compared time."};
}

std::vector<Figure> diagrams_of(const SimulationResult& r) {
  const Trajectory& run = *runs_of(r).front().second;
  DiagramRun shown{r.ready.the_case, run.table.results, &run.loads};
  shown.time_ms = times_of(run);
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    shown.block_deg.push_back(run.state(row, StateColumn::theta) - run.lag[row] / kRadPerDegree);
  shown.constant_ports = !r.oil_follows;
  return force_figures(shown);
}

}  // namespace

std::vector<Figure> simulation_figures(const SimulationResult& r) {
  std::vector<Figure> figures = curves_over_time(r);
  append(figures, diagrams_of(r));
  if (r.has_teeth() && r.analytic)
    figures.push_back(teeth_picture(
        r.ready.the_case.pump, teeth_table_of(*r.analytic, r.ready.the_case.pump.gear).results));
  if (!r.difference.empty() && !r.choice.steady) figures.push_back(difference_figure(r));
  if (auto figure = effort_figure(r)) figures.push_back(std::move(*figure));
  return figures;
}

}  // namespace bentaxis::study
