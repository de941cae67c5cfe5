#include "hydraulic_report.h"

#include <fmt/format.h>

#include "bentaxis/pump/units.h"

namespace bentaxis::cli {
namespace {

constexpr const char* kShaftAngle = "shaft angle (deg)";

std::vector<double> column(const ResultTable& table, const std::string& name) {
  std::vector<double> values;
  const std::size_t c = table.find(name);
  for (std::size_t row = 0; row < table.rows(); ++row) values.push_back(table.at(row, c));
  return values;
}

}  // namespace

Json own_figure(const std::string& id, const std::string& title, const std::string& paper,
                const std::string& unit, const std::string& axis, const std::vector<double>& x) {
  return {{"id", id},
          {"title", title},
          {"paper", paper},
          {"unit", unit},
          {"x", {{"label", axis}, {"angle", axis == kShaftAngle}, {"values", plot_values(x)}}},
          {"series", Json::array()}};
}

void add_series(Json& figure, const std::string& label, Json values) {
  figure["series"].push_back({{"label", label}, {"values", std::move(values)}});
}

Json hydraulic_block(const Case& the_case, const hydraulics::SteadyState& state) {
  Json rows = Json::array();
  for (const auto& line : hydraulics::lines(state))
    rows.push_back({line.name, line.value, line.unit});
  const auto& convergence = state.convergence;
  Json facts = Json::array();
  const auto fact = [&](const char* name, const std::string& value) {
    facts.push_back(Json::array({name, value}));
  };
  fact("points of the curve", std::to_string(the_case.pressure.points));
  fact("Newton steps", std::to_string(convergence.iterations));
  fact("change of ln P from period to period", fmt::format("{:.1e}", convergence.residual));
  fact("error of ln P allowed per step", fmt::format("{:g}", the_case.hydraulics->tolerance));
  fact("steps of CVODES in all", std::to_string(convergence.steps));
  return {
      {"title", "Hydraulic model"},
      {"text",
       "Chamber pressures by balance of mass (docs/hydraulics.md), as the periodic steady state. "
       "Both mechanical models get one and the same curve of it."},
      {"facts", facts},
      {"table", {{"columns", {"quantity", "value", "unit"}}, {"rows", rows}}}};
}

Json hydraulic_figures(const Case& the_case, const hydraulics::SteadyState& state) {
  const ResultTable& table = state.table;
  Json figures = Json::array();
  const auto add = [&](const std::string& id, const std::string& title, const std::string& paper,
                       const std::string& unit,
                       const std::vector<std::pair<std::string, std::string>>& curves) -> Json& {
    Json figure = own_figure(id, title, paper, unit, kShaftAngle, table.theta_deg);
    for (const auto& [label, name] : curves)
      add_series(figure, label, plot_values(column(table, name)));
    figures.push_back(std::move(figure));
    return figures.back();
  };
  Json& both =
      add("hydraulic_pressure", "Pressure in chamber 1 and in the delivery volume", "Fig. 10, 17",
          "bar", {{"chamber 1", "p_1_bar"}, {"delivery volume", "p_delivery_bar"}});
  const auto& s = state.summary;
  both["note"] = fmt::format(
      "Chamber: greatest {:.5g} bar at {:.4g} deg, least {:.3g} bar at {:.4g} deg. Delivery: "
      "{:.5g} to "
      "{:.5g} bar, mean {:.5g} bar. The chamber is above the delivery volume by the pressure drop "
      "of the "
      "port.",
      s.chamber_greatest / kPascalPerBar, s.chamber_greatest_deg, s.chamber_least / kPascalPerBar,
      s.chamber_least_deg, s.delivery_least / kPascalPerBar, s.delivery_greatest / kPascalPerBar,
      s.delivery_mean / kPascalPerBar);
  add("openings", "Openings of chamber 1", "Fig. 10", "mm2",
      {{"to the suction port", "as_1_mm2"}, {"to the delivery port", "ad_1_mm2"}});

  // The spline itself between its points, over two turns.
  const PressureTrace spline(the_case.pressure);
  std::vector<double> theta, pressure;
  constexpr int kPerTurn = 1440;
  for (int i = 0; i < 2 * kPerTurn; ++i) {
    theta.push_back(360.0 * i / kPerTurn);
    pressure.push_back(spline(theta.back()));
  }
  Json given = own_figure("spline",
                          fmt::format("Pressure of piston 1 as both models get it: periodic cubic "
                                      "spline of {} points",
                                      the_case.pressure.points),
                          "Fig. 25", "bar", kShaftAngle, theta);
  add_series(given, "spline", plot_values(pressure, kPascalPerBar));
  figures.push_back(std::move(given));

  add("port_flow", "Flow through both ports, leakage and load, all chambers", "", "l/min",
      {{"suction port", "Qs_l_per_min"},
       {"delivery port", "Qd_l_per_min"},
       {"load orifice", "Qload_l_per_min"},
       {"leakage", "Ql_l_per_min"}});
  add("chamber_flow", "Flow of chamber 1", "", "l/min",
      {{"from the suction port", "Qs_1_l_per_min"},
       {"into the delivery port", "Qd_1_l_per_min"},
       {"leakage", "Ql_1_l_per_min"}});
  return figures;
}

}  // namespace bentaxis::cli
