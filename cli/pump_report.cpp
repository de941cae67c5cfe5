#include "pump_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/report/report.h"

namespace bentaxis::cli {

Json case_section(const Case& the_case) {
  Json entries = Json::array();
  for (const InputEntry& entry : the_case.entries)
    entries.push_back({{"table", entry.table},
                       {"key", entry.key},
                       {"value", entry.value},
                       {"defaulted", entry.defaulted}});
  return {{"file", the_case.file.filename().string()}, {"entries", entries}};
}

Json derived_section(const Case& the_case) {
  const Geometry& g = the_case.pump.geometry;
  const analytic::DerivedQuantities derived = analytic::derived_quantities(g);
  const double speed = the_case.operation.speed_rpm;
  const double pressure = the_case.pressure.ports.delivery - the_case.pressure.ports.suction;
  Json rows = Json::array();
  const auto add = [&](const char* name, const char* symbol, double value, const char* unit,
                       const char* source) {
    rows.push_back(
        {{"name", name}, {"symbol", symbol}, {"value", value}, {"unit", unit}, {"source", source}});
  };
  add("displacement", "V", derived.displacement * 1e6, "cm3/rev", "N A stroke");
  add("stroke", "", derived.stroke * 1e3, "mm", "max zB - min zB over the turn");
  add("piston area", "A", derived.piston_area * 1e6, "mm2", "pi Dpi^2 / 4");
  add("smallest piston tilt", "", derived.smallest_tilt / kRadPerDegree, "deg", "AB against z2");
  add("largest piston tilt", "", derived.largest_tilt / kRadPerDegree, "deg", "AB against z2");
  add("ideal flow", "", derived.displacement * std::abs(speed) * 1e3, "l/min", "V n");
  add("ideal torque", "", derived.displacement * pressure / (2 * kPi), "Nm",
      "V (delivery - suction) / 2 pi");
  add("gear torque arm", "(d/2) cos ap",
      the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle) * 1e3,
      "mm", "(19), (22)");
  add("pitch cone", "delta", 90 - the_case.pump.geometry.tilt / kRadPerDegree / 2, "deg",
      "90 deg - alpha/2");
  return rows;
}

Json common_section(const Case& the_case) {
  const std::string once = ", evaluated once per sample and given to both models";
  std::string trace = "ideal trace" + once;
  if (the_case.pressure.kind == PressureKind::curve)
    trace = "periodic cubic spline through " + the_case.pressure.file.filename().string() + once;
  if (the_case.pressure.kind == PressureKind::hydraulic)
    trace = fmt::format("hydraulic model, periodic cubic spline through {} points{}",
                        the_case.pressure.points, once);
  Json rows = Json::array();
  const auto add = [&](const std::string& input, const std::string& value,
                       const std::string& caught_by) {
    rows.push_back({{"input", input}, {"value", value}, {"caught_by", caught_by}});
  };
  add("chamber pressure", trace,
      "high-precision curves (computed with their own trace); mean torque of a frictionless pump = "
      "displacement x pressure / 2 pi");
  add("geometry, masses, loads of the case file", "read and converted to SI once",
      "high-precision curves, which read the case file with another parser");
  add("law of the port-plate film", "full pressure between r2 and r3, linear to 0 at r1 and r4",
      "high-precision curves; the integral itself is taken twice (closed form, quadrature)");
  add("law of piston friction",
      the_case.pump.friction.regularization > 0 ? "Fc tanh(v/v_reg) + cv v" : "Fc sign(v) + cv v",
      "high-precision curves; power balance; written once in each model");
  add("law of shaft friction (38)", "Td (1 - Ct) + Cs omega", "power balance of each model");
  add("constant speed, equal for shaft and block (1:1)",
      "omega given; no torsion, no play in the gear",
      "nothing here: a rig. Torque-driven run: the shaft, set free under the analytic torque, "
      "holds "
      "its speed");
  add("rigid bodies, points A and B on the piston's axis, no clearance", "assumed",
      "nothing here: a rig or an elastic model");
  add("frames, signs and the names of the reactions", "docs/theory.md",
      "free-body diagrams written in the tests; signs printed in the paper");
  return rows;
}

Json validity_section(const std::vector<analytic::ValidityLimit>& limits) {
  Json rows = Json::array();
  for (const auto& limit : limits) {
    const bool known = limit.applicable;
    rows.push_back({{"limit", limit.limit},
                    {"share_percent", known ? Json(100 * limit.violated_share) : Json()},
                    {"worst", known ? Json(limit.worst) : Json()},
                    {"unit", limit.unit},
                    {"theta_deg", known ? Json(limit.theta_deg) : Json()},
                    {"violated", known && limit.violated_share > 0},
                    {"applicable", known},
                    {"consequence", limit.consequence}});
  }
  return rows;
}

Json warnings_section(const std::vector<analytic::ValidityLimit>& limits) {
  Json rows = Json::array();
  for (const auto& limit : limits) {
    if (!limit.applicable || limit.violated_share <= 0) continue;
    rows.push_back(
        {{"name", limit.name},
         {"text", fmt::format("over {:.3g} % of the turn, worst {:.4g} {} at {:g} deg: {}.",
                              100 * limit.violated_share, limit.worst, limit.unit, limit.theta_deg,
                              limit.consequence)}});
  }
  return rows;
}

Json figures_section(const ResultTable& analytic, const ResultTable& multibody,
                     const std::vector<ResultTable>& without_viscous) {
  Json figures = Json::array();
  const auto add = [&](const std::string& id, const std::string& title, const std::string& paper,
                       const std::string& unit, std::vector<std::string> channels) -> Json& {
    figures.push_back({{"id", id},
                       {"title", title},
                       {"paper", paper},
                       {"unit", unit},
                       {"channels", std::move(channels)}});
    return figures.back();
  };
  add("pressure", "Chamber pressure of piston 1 (given to both models)", "Fig. 10, 25", "bar",
      {"p_1_bar"});
  add("rs", "Joint force Rs on piston 1, by the shaft, at A, in S2", "Fig. 12", "N",
      {"Rs_1_x2_N", "Rs_1_y2_N", "Rs_1_z2_N"});
  add("rs_xy", "Joint force Rs on piston 1: components across the block axis", "Fig. 26", "N",
      {"Rs_1_x2_N", "Rs_1_y2_N"});
  add("rs3", "Joint force Rs on piston 1 in S3: along the piston (z3) and across it", "4.1.2", "N",
      {"Rs_1_x3_N", "Rs_1_y3_N", "Rs_1_z3_N"});
  add("rc", "Bore force Rc on piston 1, by the block, at B, in S2", "Fig. 14, 27", "N",
      {"Rc_1_x2_N", "Rc_1_y2_N"});
  add("bearings", "Bearing forces Rb1 (tapered, C1) and Rb2 (cylindrical, C2) on the shaft, in S1",
      "Fig. 15", "N", {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N", "Rb2_x1_N", "Rb2_y1_N"});
  add("rb1", "Tapered bearing force Rb1 on the shaft at C1, in S1", "Fig. 28", "N",
      {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N"});
  add("rb2", "Cylindrical bearing force Rb2 on the shaft at C2, in S1", "Fig. 29", "N",
      {"Rb2_x1_N", "Rb2_y1_N"});
  Json& torque = add("td", "Drive torque Td", "Fig. 17, 30", "Nm", {"Td_z1_Nm"});
  std::string means;
  for (const ResultTable* table : {&analytic, &multibody}) {
    double mean = 0;
    for (std::size_t row = 0; row < table->rows(); ++row)
      mean += table->at(row, table->find("Td_z1_Nm")) / static_cast<double>(table->rows());
    if (is_computed(mean))
      means += fmt::format("{}{} {:.5g} Nm", means.empty() ? "" : ", ", table->name, mean);
  }
  torque["note"] = "Mean torque: " + means + ".";

  const auto has = [](const ResultTable& table, const char* name) {
    const std::size_t column = table.find(name);
    for (std::size_t row = 0; row < table.rows(); ++row)
      if (is_computed(table.at(row, column))) return true;
    return false;
  };
  const auto extras = [&](const char* channel) {
    Json list = Json::array();
    for (const ResultTable& table : without_viscous)
      if (has(table, channel))
        list.push_back(
            {{"label", table.name + ", Cc = 0"}, {"values", report::curve(table, channel)}});
    return list;
  };
  if (has(analytic, "Rcs_z4_N") || has(multibody, "Rcs_z4_N"))
    add("rcs", "Gear tooth force Rcs on the block, by the shaft, at O4, along z4", "Fig. 32 top",
        "N", {"Rcs_z4_N"})["extra"] = extras("Rcs_z4_N");
  add("tcs", "Torque that carries the block round, about z2", "Fig. 32 bottom", "Nm",
      {"Tcs_z2_Nm"})["extra"] = extras("Tcs_z2_Nm");
  std::vector<std::string> shares;
  for (const Channel& channel : analytic.channels)
    if (channel.quantity == "Tc") shares.push_back(channel.name);
  Json& bars = add("shares", "Each piston's share of the pistons' torque on the block, about z2",
                   "Fig. 31, 33", "Nm", shares);
  bars["kind"] = "piston_bars";
  bars["angles"] = {0, 38};
  add("film", "Film force Fh of the port plate on the block, at (xh, yh)", "(51)", "N",
      {"Fh_z2_N"});
  add("film_point", "Point where Fh acts, from z2", "(53)", "mm", {"xh_x2_mm", "yh_y2_mm"});
  add("pin", "Pin force Rcn on the block", "(54)", "N", {"Rcn_x2_N", "Rcn_y2_N"});
  return figures;
}

Json figures_of(const std::vector<Channel>& channels, const Json& figures) {
  Json shown = Json::array();
  for (const Json& figure : figures)
    if (std::any_of(channels.begin(), channels.end(), [&](const Channel& channel) {
          const Json& names = figure["channels"];
          return std::find(names.begin(), names.end(), channel.name) != names.end();
        }))
      shown.push_back(figure);
  return shown;
}

}  // namespace bentaxis::cli
