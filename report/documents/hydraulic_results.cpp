#include "hydraulic_results.h"

#include "bentaxis/study/efficiency.h"
#include "document_parts.h"
#include "hydraulic_sections.h"

namespace bentaxis::study {
namespace {

using hydraulics::Place;
using hydraulics::PowerBudget;
using hydraulics::PowerUse;
using hydraulics::SteadyState;

constexpr double kMegapascal = 1e6;
// Of the law's figure, bar absolute, and how far beyond the chamber's greatest pressure it goes.
constexpr double kLowestPressure = 0.01, kBeyondGreatest = 1.5;
constexpr int kLawPoints = 300;

double turns_per_second(const Case& the_case) { return the_case.operation.speed_rpm / 60; }

// dp/dtheta of a chamber, bar/deg: orders from 1 to the last of the outlet.
report::Values rates_of(const SteadyState& state) {
  return report::each_of(
      hydraulics::orders_of_rate(*state.computed, state.orders.back().order),
      [](double per_radian) { return per_radian * kRadPerDegree / kPascalPerBar; });
}

// Of the pistons' power.
double share(const PowerBudget& power, double watts) { return watts / power[Place::pistons]; }

// A closed curve of two columns.
report::XySeries loop(const ResultTable& table, const std::string& label, const std::string& x,
                      const std::string& y) {
  report::XySeries series{label, report::values_of(table, x), report::values_of(table, y)};
  series.close();
  return series;
}

report::Figure law_figure(const Case& the_case, const SteadyState& state) {
  const auto& data = *the_case.hydraulics;
  const double lowest = std::max(kLowestPressure * kPascalPerBar, 1.1 * data.vapour_pressure);
  const double highest =
      kBeyondGreatest * std::max(state.summary.chamber_greatest, 0.0) + 10 * data.atmosphere;
  report::XySeries law{"effective bulk modulus", {}, {}};
  for (int i = 0; i < kLawPoints; ++i) {
    const double pressure = lowest * std::pow(highest / lowest, i / (kLawPoints - 1.0));
    law.add(pressure / kPascalPerBar,
            hydraulics::effective_bulk_modulus(state, pressure - data.atmosphere) / kMegapascal);
  }
  return {"bulk_modulus_law", "Effective bulk modulus of the oil over pressure", "",
          report::XyFigure{{"absolute pressure", "bar", true},
                           {"effective bulk modulus", "MPa", true},
                           {std::move(law)}},
          "Density x dP/d density of oil with its air (docs/hydraulics.md)."};
}

report::ScatterPoint point(int order, double amplitude, double hertz) {
  return {static_cast<double>(order), amplitude, fmt::format("{:.5g} Hz", order * hertz)};
}

std::vector<report::ScatterPoint> points(const std::vector<hydraulics::Order>& orders,
                                         double hydraulics::Order::*value, double unit,
                                         double hertz) {
  return report::each_of(
      orders, [&](const auto& one) { return point(one.order, one.*value / unit, hertz); });
}

report::Figure orders_figure(const std::string& id, const std::string& title,
                             const std::string& axis, std::vector<report::ScatterSeries> series,
                             double hertz) {
  return {id, title, "",
          report::ScatterFigure{
              {"order, per turn of the shaft", ""}, {axis, "", true}, std::move(series)},
          fmt::format("Amplitudes. Order 1 is {:.5g} Hz.", hertz)};
}

}  // namespace

report::Section power_section(const Case& the_case, const SteadyState& state,
                              const PowerBudget& power) {
  report::NewSection section(
      "Power and losses by place",
      "Means over a turn, all chambers. What flows from one pressure to another loses the mass "
      "flow times the difference of the oil's pressure potential, the integral of dP/density; "
      "compression returns the energy that it takes. The residual is the sources less all other "
      "rows.");
  section.columns("place", "what", "mean power, W", "of the pistons' power, %");
  const double indicated =
      state.indicated_work * the_case.pump.geometry.pistons * turns_per_second(the_case);
  section.fact("residual, of the power of the pistons", "{:.1e}",
               share(power, hydraulics::left_over(power)));
  section.fact("efficiency: load less oil taken in, over the pistons", "{:.4g} %",
               100 * share(power, power[Place::load] - power[Place::tank]));
  section.fact("indicated work of a chamber per turn, area of its p-V diagram", "{:.6g} J",
               state.indicated_work);
  section.fact("that of all chambers x speed over the pistons' power, less 1", "{:.1e}",
               share(power, indicated) - 1);
  const auto add = [&](const std::string& place, const std::string& what, double watts) {
    section.row(place, what, watts, 100 * share(power, watts));
  };
  for (const Place place : state.places)
    add(hydraulics::name_of(place), hydraulics::name_of(hydraulics::use_of(place)), power[place]);
  add("all losses", "sum", hydraulics::losses(power));
  add("left over", "sum", hydraulics::left_over(power));
  return section;
}

report::Section efficiency_section(const OperatingPoint& point, const PowerBudget& power) {
  const hydraulics::PumpPower oil = hydraulics::pump_power(power);
  const double omega = rad_per_second(point.the_case().operation.speed_rpm);
  const double torques[] = {mean(point.analytic, "Td_z1_Nm"), mean(point.multibody, "Td_z1_Nm")};
  report::NewSection section(
      "Power and efficiency of the pump",
      "Means over a turn. The power to the load is carried by the oil out through the delivery "
      "port less in through the suction port: mass flow x pressure potential, with the work of "
      "compression (docs/budgets.md).");
  section.columns("quantity", "unit", point.analytic.name, point.multibody.name, "definition");
  section.row("drive", "W", torques[0] * omega, torques[1] * omega, "mean Td x speed");
  const auto oil_watts = [&](const char* name, double watts, const char* text) {
    section.row(name, "W", watts, watts, text);
  };
  oil_watts("pistons on the oil, by the hydraulic model", oil.pistons, "mean of -p dV/dt");
  oil_watts("flow to the load", oil.useful,
            "mass flow x pressure potential, delivery port less suction port");
  oil_watts("in the oil", oil.lost(), "pistons on the oil less the flow to the load");
  const Efficiencies analytic = efficiencies(point.ready, oil, torques[0]);
  const Efficiencies multibody = efficiencies(point.ready, oil, torques[1]);
  for (const EfficiencyLine& line : efficiency_lines())
    if (is_computed(analytic.*line.value))
      section.row(std::string(line.name) + " efficiency", "%", analytic.*line.value,
                  multibody.*line.value, line.meaning);
  return section;
}

report::Section orders_section(const Case& the_case, const SteadyState& state) {
  report::NewSection section(
      "Orders",
      "Amplitudes of harmonics of the shaft's angle. The outlet has multiples of the number of "
      "pistons only; dp/dtheta of a chamber has all, which orders.csv lists.");
  section.columns("order", "frequency, Hz", "flow to the load, l/min", "of its mean, %",
                  "delivery pressure, bar", "pressure in front of the load, bar",
                  "dp/dtheta of a chamber, bar/deg");
  const report::Values rates = rates_of(state);
  const auto& s = state.summary;
  for (const auto& order : state.orders)
    section.row(order.order, order.order * turns_per_second(the_case),
                order.flow / s.density / kLitrePerMinute, 100 * order.flow / s.mass_flow,
                order.delivery / kPascalPerBar, order.load_pressure / kPascalPerBar,
                rates[order.order - 1]);
  return section;
}

std::vector<report::Figure> result_figures(const Case& the_case, const SteadyState& state,
                                           const PowerBudget& power) {
  const ResultTable& table = state.table;
  std::vector<report::Figure> figures;
  const auto angle = [&](const std::string& id, const std::string& title, const std::string& unit,
                         const std::string& note) {
    figures.push_back(angle_figure(id, title, "", unit, table.theta_deg));
    figures.back().note = note;
  };
  const auto series = [&](const std::string& label, const std::string& name) {
    add_series(figures.back(), label, report::values_of(table, name));
  };

  figures.push_back({"pv", "p-V diagram of chamber 1", "",
                     report::XyFigure{{"volume", "cm3"},
                                      {"pressure", "bar"},
                                      {loop(table, "chamber 1", "V_1_cm3", "p_1_bar")}},
                     fmt::format("Its area is the work of a piston on the oil, {:.6g} J per turn.",
                                 state.indicated_work)});
  angle("dp_dtheta", "Rate of the pressure in chamber 1", "bar/deg", "");
  series("dp/dtheta", "dp_1_bar_per_deg");
  angle("bulk_modulus", "Effective bulk modulus of the oil in chamber 1", "MPa", "");
  series("chamber 1", "K_1_MPa");
  figures.push_back(law_figure(the_case, state));

  angle("opening_parts", "Openings of chamber 1 by part", "mm2",
        "Each port's opening is the sum of its parts.");
  for (const auto& [prefix, port] :
       {std::pair<std::string, std::string>{"as_1_", "suction"}, {"ad_1_", "delivery"}})
    for (const Channel& channel : table.channels)
      if (channel.name.starts_with(prefix) && channel.name != prefix + "mm2")
        series(port + channel.meaning.substr(channel.meaning.find(": ")), channel.name);

  angle("backflow", "Backflow", "l/min",
        "Backflow from the delivery port into a chamber and from a chamber into the suction port.");
  series("delivery port, all chambers", "Qdb_l_per_min");
  series("suction port, all chambers", "Qsb_l_per_min");
  series("delivery port into chamber 1", "Qdb_1_l_per_min");
  series("chamber 1 into suction port", "Qsb_1_l_per_min");

  angle("power", "Power of the pistons and into the load", "W", "");
  for (const Place place : {Place::pistons, Place::load})
    series(hydraulics::name_of(place), fmt::format("power_{}_W", hydraulics::key_of(place)));
  angle("losses", "Losses by place, all chambers", "W",
        fmt::format("Means: {:.5g} W of {:.5g} W in all.", hydraulics::losses(power),
                    power[Place::pistons]));
  for (const Place place : state.places)
    if (hydraulics::use_of(place) == PowerUse::loss)
      series(hydraulics::name_of(place), fmt::format("power_{}_W", hydraulics::key_of(place)));

  const double hertz = turns_per_second(the_case);
  using hydraulics::Order;
  figures.push_back(orders_figure(
      "orders_flow", "Orders of the flow to the load", "amplitude (l/min)",
      {{"flow to the load", 0, false, false,
        points(state.orders, &Order::flow, state.summary.density * kLitrePerMinute, hertz)}},
      hertz));
  std::vector<report::ScatterSeries> pressure = {
      {"delivery volume", 0, false, false,
       points(state.orders, &Order::delivery, kPascalPerBar, hertz)}};
  if (the_case.hydraulics->delivery_line)
    pressure.push_back({"in front of the load", 1, false, false,
                        points(state.orders, &Order::load_pressure, kPascalPerBar, hertz)});
  figures.push_back(orders_figure("orders_pressure", "Orders of the delivery pressure",
                                  "amplitude (bar)", std::move(pressure), hertz));
  report::ScatterSeries rate{"chamber", 0, false, false, {}};
  for (const double amplitude : rates_of(state))
    rate.points.push_back(point(static_cast<int>(rate.points.size()) + 1, amplitude, hertz));
  figures.push_back(orders_figure("orders_rate", "Orders of dp/dtheta of a chamber",
                                  "amplitude (bar/deg)", {std::move(rate)}, hertz));
  return figures;
}

std::string power_csv(const SteadyState& state, const PowerBudget& power) {
  CsvRows csv("place,what,power_W");
  for (const Place place : state.places)
    csv.row(hydraulics::key_of(place), hydraulics::name_of(hydraulics::use_of(place)),
            power[place]);
  return std::move(csv).text();
}

std::string orders_csv(const Case& the_case, const SteadyState& state) {
  CsvRows csv("order,frequency_Hz,Qload_l_per_min,p_delivery_bar,p_load_bar,dp_1_bar_per_deg");
  const report::Values rates = rates_of(state);
  const int n = the_case.pump.geometry.pistons;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    const hydraulics::Order order =
        number % n == 0 ? state.orders[number / n - 1] : hydraulics::Order{};
    csv.row(number, number * turns_per_second(the_case),
            order.flow / state.summary.density / kLitrePerMinute, order.delivery / kPascalPerBar,
            order.load_pressure / kPascalPerBar, rates[i]);
  }
  return std::move(csv).text();
}

}  // namespace bentaxis::study
