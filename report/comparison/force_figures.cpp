#include "bentaxis/study/force_figures.h"

#include "bentaxis/results/channels.h"
#include "document_parts.h"
#include "force_figures_pieces.h"

namespace bentaxis::study {

double along(const DiagramRun& run, std::size_t row) {
  return run.time_ms.empty() ? run.table.theta_deg[row] : run.time_ms[row];
}

std::vector<std::size_t> frame_rows(std::size_t rows, std::size_t most) {
  const std::size_t frames = std::min(rows, most);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < frames; ++i) chosen.push_back(i * rows / frames);
  return chosen;
}

std::size_t nearest_frame(const DiagramRun& run, const std::vector<std::size_t>& rows,
                          double theta_deg) {
  const auto off = [&](std::size_t row) {
    return std::abs(std::remainder(run.table.theta_deg[row] - theta_deg, 360));
  };
  const auto nearest =
      std::ranges::min_element(rows, [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
  return nearest == rows.end() ? 0 : static_cast<std::size_t>(nearest - rows.begin());
}

namespace {

using report::Figure;
using report::OwnFigure;
using report::Values;

// Rows that curves are drawn of: a turn in degrees is smooth, a motion in time may not be.
std::vector<std::size_t> curve_rows(const DiagramRun& run) {
  return frame_rows(run.table.rows(), run.time_ms.empty() ? 360 : 1440);
}

Values column(const DiagramRun& run, std::size_t at) {
  return report::each_of(curve_rows(run), [&](std::size_t row) { return run.table.at(row, at); });
}

bool any_computed(const Values& values) { return std::ranges::any_of(values, is_computed); }

// A figure over the axis of the run, without curves.
OwnFigure over(const DiagramRun& run, const std::string& unit, const std::string& value) {
  const bool angle = run.time_ms.empty();
  OwnFigure figure{
      unit, angle ? "shaft angle (deg)" : kTimeAxis, angle,
      report::each_of(curve_rows(run), [&](std::size_t row) { return along(run, row); })};
  figure.value = value;
  return figure;
}

// The way of a force's end across the shaft over the run; marks at quarters of a turn.
Figure bearing_loci(const DiagramRun& run, const ChannelLayout& at) {
  constexpr double kQuarter = 90;  // deg
  constexpr double kKilo = 1e-3;
  report::XyFigure figure{{"x1", "kN"}, {"y1", "kN"}, {}};
  figure.equal = true;
  figure.points.push_back({"0", 0, 0});
  for (const auto& [name, x, y] : {std::tuple{"Rb1 (tapered, C1)", at.Rb1(0), at.Rb1(1)},
                                   {"Rb2 (cylindrical, C2)", at.Rb2(0), at.Rb2(1)}}) {
    report::XySeries series{name, column(run, x), column(run, y)};
    if (!any_computed(series.x)) continue;
    for (Values* values : {&series.x, &series.y})
      for (double& value : *values) value = std::round(value) * kKilo;  // to a newton
    if (run.time_ms.empty())
      for (int quarter = 0; quarter < 4; ++quarter)
        for (std::size_t row = 0; row < run.table.rows(); ++row)
          if (std::abs(run.table.theta_deg[row] - kQuarter * quarter) < 1e-9)
            figure.points.push_back({fmt::format("{:g} deg", kQuarter * quarter),
                                     kKilo * run.table.at(row, x), kKilo * run.table.at(row, y)});
    // A turn ends where it began.
    if (run.time_ms.empty() && series.x.size() > 2) series.close();
    figure.series.push_back(std::move(series));
  }
  return {"bearing_loci", "Polar loci of the bearing forces on the shaft, across it, in S1", "",
          std::move(figure),
          "The line from 0 to the curve is the force across the shaft; one scale on both axes. By "
          "the " +
              run.table.name + " model."};
}

Figure tooth_flanks(const DiagramRun& run, const ChannelLayout& at) {
  OwnFigure figure = over(run, "N", "force");
  const auto of_flank = [&](bool plus) {
    return report::each_of(curve_rows(run), [&](std::size_t row) {
      const double force = std::abs(run.table.at(row, at.Rcs()));
      const bool drives = run.table.at(row, at.carrying()) >= 0;
      return is_computed(force) && drives != plus ? 0 : force;
    });
  };
  figure.series = {{"flank + (drives the block towards +psi)", of_flank(true)},
                   {"flank - (holds it back)", of_flank(false)}};
  return {"tooth_flanks", "Tooth force by flank, at O4", "", std::move(figure),
          run.the_case.pump.gear.flanks == Flanks::one &&
                  run.the_case.pump.gear.contact == ToothContact::rigid
              ? "The sign of the torque that drives the block determines the loaded flank; with "
                "flanks = \"one\" the models use one line of action for both."
              : ""};
}

Figure moment_shares(const DiagramRun& run, const ChannelLayout& at) {
  OwnFigure figure = over(run, "Nm", "torque");
  Values sum(figure.x.size(), 0.0);
  for (int k = 0; k < at.pistons(); ++k) {
    figure.stack.push_back({fmt::format("piston {}", k + 1), column(run, at.Tc(k))});
    for (std::size_t row = 0; row < sum.size(); ++row) sum[row] += figure.stack.back().values[row];
  }
  figure.series = {{"sum", std::move(sum)}};
  return {"moment_shares", "Pistons' torque on the block about z2, piston upon piston", "",
          std::move(figure),
          "Driving contributions are above 0, braking contributions below; the line is the sum. By "
          "the " +
              run.table.name + " model."};
}

Figure chamber(const DiagramRun& run, const ChannelLayout& at) {
  OwnFigure figure = over(run, "cm3", "volume above its minimum");
  const double bore = run.the_case.pump.geometry.bore_diameter;
  const double cm3_per_mm = kPi / 4 * bore * bore * 1e-3 * 1e6;
  Values ring = column(run, at.zB(0));  // mm
  const double deepest = *std::ranges::max_element(ring);
  for (double& value : ring) value = cm3_per_mm * (deepest - value);
  figure.series = {{"volume of chamber 1", std::move(ring)}};
  figure.right =
      OwnFigure::Right{"pressure", "bar", {{"pressure of chamber 1", column(run, at.pressure(0))}}};
  return {"chamber", "Volume and pressure of chamber 1", "", std::move(figure),
          "The volume is that swept by the ring of the piston, from its deepest position."};
}

}  // namespace

std::vector<Figure> force_figures(const DiagramRun& run) {
  const ChannelLayout at(run.the_case.pump);
  const auto has = [&](std::size_t channel) { return any_computed(column(run, channel)); };
  std::vector<Figure> figures;
  if (run.table.rows() < 2) return figures;
  if (run.loads != nullptr && run.loads->run_rows() == run.table.rows()) {
    figures.push_back(force_polygon(run, "piston 1", {{2, 0}, {2, 1}, {0, 1}}, 280));
    figures.push_back(force_polygon(run, "block", {{2, 1}, {0, 1}}, 280));
  }
  if (has(at.Rb1(0)) || has(at.Rb2(0))) figures.push_back(bearing_loci(run, at));
  if (has(at.Rcs()) && run.the_case.pump.gear.contact != ToothContact::teeth)
    figures.push_back(tooth_flanks(run, at));
  if (has(at.pressure(0))) figures.push_back(plate_pressure(run));
  if (has(at.Tc(0))) figures.push_back(moment_shares(run, at));
  if (has(at.zB(0)) && has(at.pressure(0))) figures.push_back(chamber(run, at));
  return figures;
}

}  // namespace bentaxis::study
