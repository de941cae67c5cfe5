#include "hydraulic_sections.h"

#include "document_parts.h"

namespace bentaxis::study {

report::Figure angle_figure(const std::string& id, const std::string& title,
                            const std::string& paper, const std::string& unit,
                            const std::vector<double>& theta_deg) {
  return {id, title, paper, report::OwnFigure{unit, "shaft angle (deg)", true, theta_deg}};
}

void add_series(report::Figure& figure, const std::string& label, std::vector<double> values) {
  std::get<report::OwnFigure>(figure.content).series.push_back({label, std::move(values)});
}

namespace {

std::string error_text(const hydraulics::SteadyState& state, double error) {
  return fmt::format("{:.1e} bar, {:.1e} of peak", error / kPascalPerBar,
                     error / state.computed->peak);
}

std::string curve_text(const Case& the_case, const hydraulics::SteadyState& state) {
  if (the_case.pressure.points == 0)
    return fmt::format("the computed one, in {} cubic pieces", state.convergence.pieces);
  return fmt::format("periodic cubic spline through {} points, off the computed curve by up to {}",
                     the_case.pressure.points, error_text(state, state.spline_error));
}

}  // namespace

report::Section hydraulic_section(const Case& the_case, const hydraulics::SteadyState& state) {
  report::Section section{
      "Hydraulic model",
      "Chamber pressures from mass balances (docs/hydraulics.md), as the periodic steady state. "
      "Both mechanical models use the same curve.",
      {},
      {{"quantity", "value", "unit"}, {}}};
  const auto& convergence = state.convergence;
  section.facts = {
      {"curve that both models use", curve_text(the_case, state)},
      {"its largest error, estimated", error_text(state, state.computed->error)},
      {"Newton steps", std::to_string(convergence.iterations)},
      {"change of ln P from period to period", fmt::format("{:.1e}", convergence.residual)},
      {"error of ln P allowed per step", fmt::format("{:g}", convergence.tolerance)},
      {"steps of CVODES in all", std::to_string(convergence.steps)}};
  for (const auto& line : hydraulics::lines(state))
    section.table.rows.push_back({line.name, line.value, line.unit});
  return section;
}

std::vector<report::Figure> hydraulic_figures(const Case& the_case,
                                              const hydraulics::SteadyState& state) {
  std::vector<report::Figure> figures;
  const auto add = [&](const std::string& id, const std::string& title, const std::string& paper,
                       const std::string& unit,
                       const std::vector<std::pair<std::string, std::string>>& curves) {
    figures.push_back(angle_figure(id, title, paper, unit, state.table.theta_deg));
    for (const auto& [label, name] : curves)
      add_series(figures.back(), label, report::values_of(state.table, name));
  };
  add("hydraulic_pressure", "Pressure in chamber 1 and in the delivery volume", "Fig. 10, 17",
      "bar", {{"chamber 1", "p_1_bar"}, {"delivery volume", "p_delivery_bar"}});
  // Of the lines, where there are any.
  for (const auto& [label, name] : {std::pair{"suction port", "p_suction_bar"},
                                    std::pair{"end of the delivery line", "p_load_bar"}})
    for (const Channel& channel : state.table.channels)
      if (channel.name == name)
        add_series(figures.back(), label, report::values_of(state.table, name));
  const auto& s = state.summary;
  figures.back().note = fmt::format(
      "Chamber: maximum {:.5g} bar at {:.4g} deg, minimum {:.3g} bar at {:.4g} deg. Delivery: "
      "{:.5g} to {:.5g} bar, mean {:.5g} bar. The chamber pressure exceeds that of the delivery "
      "volume by the pressure drop of the port.",
      s.chamber_greatest / kPascalPerBar, s.chamber_greatest_deg, s.chamber_least / kPascalPerBar,
      s.chamber_least_deg, s.delivery_least / kPascalPerBar, s.delivery_greatest / kPascalPerBar,
      s.delivery_mean / kPascalPerBar);
  add("openings", "Openings of chamber 1, and its pressure", "Fig. 10", "mm2",
      {{"to the suction port", "as_1_mm2"}, {"to the delivery port", "ad_1_mm2"}});
  auto& openings = std::get<report::OwnFigure>(figures.back().content);
  openings.value = "area";
  openings.right = report::OwnFigure::Right{
      "pressure", "bar", {{"pressure of chamber 1", report::values_of(state.table, "p_1_bar")}}};

  // The curve itself, over two turns.
  const PressureTrace curve(the_case.pressure);
  std::vector<double> theta, pressure;
  constexpr int kPerTurn = 1440;
  for (int i = 0; i < 2 * kPerTurn; ++i) {
    theta.push_back(360.0 * i / kPerTurn);
    pressure.push_back(curve(theta.back()) / kPascalPerBar);
  }
  figures.push_back(angle_figure("spline", "Pressure of piston 1 as used by both models", "Fig. 25",
                                 "bar", theta));
  figures.back().note = curve_text(the_case, state) + ".";
  add_series(figures.back(), "chamber 1", pressure);

  add("port_flow", "Flow through both ports, leakage and load, all chambers", "", "l/min",
      {{"suction port", "Qs_l_per_min"},
       {"delivery port", "Qd_l_per_min"},
       {"load", "Qload_l_per_min"},
       {"leakage", "Ql_l_per_min"}});
  add("chamber_flow", "Flow of chamber 1", "", "l/min",
      {{"from the suction port", "Qs_1_l_per_min"},
       {"into the delivery port", "Qd_1_l_per_min"},
       {"leakage", "Ql_1_l_per_min"}});
  return figures;
}

}  // namespace bentaxis::study
