#include "bentaxis/study/budget_section.h"

#include <functional>

#include "bentaxis/results/budget.h"
#include "bentaxis/study/efficiency.h"
#include "document_parts.h"

namespace bentaxis::study {
namespace {

struct CauseText {
  Cause cause;
  const char* name;
  const char* kind;  // of its power
};
constexpr CauseText kTexts[] = {
    {Cause::pressure, "pressure", "on the oil"},
    {Cause::piston_friction, "piston friction", "loss"},
    {Cause::block_friction, "block friction, Cc", "loss"},
    {Cause::shaft_friction, "shaft friction, Cs", "loss"},
    {Cause::torque_factor, "shaft friction, (1 - Ct) Td", "loss"},
    {Cause::weight, "weight of the pistons", "stored"},
    {Cause::inertia, "inertia", "stored"},
    {Cause::ring, "bore forces that do not act at B, on the play", "no body's"},
    {Cause::teeth, "deformation of the teeth", "stored"},
};

// Causes that the budgets of a comparison have.
std::vector<CauseText> causes_in(const ResultTable& budget) {
  std::vector<CauseText> causes;
  for (const CauseText& text : kTexts)
    if (budget.find(drive_column(text.cause)) < budget.columns()) causes.push_back(text);
  return causes;
}

struct Statistics {
  double mean = 0, least = 0, greatest = 0;
};

Statistics statistics(std::size_t rows, const std::function<double(std::size_t)>& value) {
  Statistics s{0, not_computed(), not_computed()};
  for (std::size_t row = 0; row < rows; ++row) {
    const double v = value(row);
    s.mean += v / static_cast<double>(rows);
    if (!is_computed(s.least) || v < s.least) s.least = v;
    if (!is_computed(s.greatest) || v > s.greatest) s.greatest = v;
  }
  return s;
}

Statistics statistics(const ResultTable& table, const std::string& column) {
  const std::size_t c = table.find(column);
  if (c == table.columns()) return {not_computed(), not_computed(), not_computed()};
  return statistics(table.rows(), [&](std::size_t row) { return table.at(row, c); });
}

// A run with what follows from it.
struct Turn : BudgetTurn {
  double omega() const { return rad_per_second(ready.the_case.operation.speed_rpm); }
  double power(const std::string& column) const {
    return statistics(budget, column).mean * omega();
  }
  Efficiencies efficiencies() const {
    return study::efficiencies(ready, oil, statistics(budget, "Td_z1_Nm").mean);
  }
  bool pumps() const { return is_computed(efficiencies().mechanical); }
};

// A quantity of both models.
report::Budget::Quantity quantity(const std::vector<Turn>& turns, const std::string& name,
                                  const std::string& kind, const std::string& unit,
                                  const std::function<double(const Turn&)>& value,
                                  const std::string& note = {}) {
  report::Budget::Quantity q{name, kind, unit, {}, note};
  for (const Turn& turn : turns) q.values.push_back(value(turn));
  return q;
}

// @param comparison  of the budgets; nullptr: they are not compared
std::vector<report::Budget::Torque> torque_lines(const std::vector<Turn>& turns,
                                                 const compare::Comparison* comparison) {
  std::vector<report::Budget::Torque> lines;
  const auto add = [&](const std::string& name, const std::string& column,
                       const std::string& carrying) {
    report::Budget::Torque line{name, column, {}, {}, {}, {}, 0, {}};
    for (const Turn& turn : turns) {
      const Statistics s = statistics(turn.budget, column);
      line.mean.push_back(s.mean);
      line.least.push_back(s.least);
      line.greatest.push_back(s.greatest);
      line.carrying.push_back(statistics(turn.budget, carrying).mean);
    }
    if (const auto* compared = comparison != nullptr ? comparison->find(column) : nullptr) {
      line.largest_difference = compared->largest;
      line.verdict = compare::to_string(compared->verdict);
    }
    lines.push_back(std::move(line));
  };
  for (const CauseText& text : causes_in(turns.front().budget))
    add(text.name, drive_column(text.cause), carrying_column(text.cause));
  add("drive torque Td", "Td_z1_Nm", "Tcs_z2_Nm");
  return lines;
}

std::vector<report::Budget::Quantity> power_lines(const std::vector<Turn>& turns) {
  std::vector<report::Budget::Quantity> lines;
  const auto add = [&](const std::string& name, const std::string& kind,
                       const std::function<double(const Turn&)>& value,
                       const std::string& note = {}) {
    lines.push_back(quantity(turns, name, kind, "W", value, note));
  };
  const auto of = [](Cause cause) {
    return [cause](const Turn& turn) { return turn.power(drive_column(cause)); };
  };
  add(
      "drive", "in", [](const Turn& turn) { return turn.power("Td_z1_Nm"); }, "mean Td x speed");
  for (const CauseText& text : causes_in(turns.front().budget))
    add(text.name, text.kind, of(text.cause));
  add(
      "not accounted for", "open",
      [](const Turn& turn) {
        double rest = turn.power("Td_z1_Nm");
        for (const CauseText& text : causes_in(turn.budget))
          rest -= turn.power(drive_column(text.cause));
        return rest;
      },
      "drive less all lines above");
  if (!turns.front().oil) return lines;
  using hydraulics::PumpPower;
  const auto oil = [](const auto& value) {
    return [value](const Turn& turn) { return turn.oil ? value(*turn.oil) : not_computed(); };
  };
  add("pistons on the oil, by the hydraulic model", "check",
      oil([](const PumpPower& power) { return power.pistons; }),
      "work of -p dV per turn from the mass balance: a check of the power of the pressure");
  add("flow to the load", "out", oil([](const PumpPower& power) { return power.useful; }),
      "of the power on the oil: mass flow x pressure potential, out through the delivery port less "
      "in through the suction port; the work of compression is part of it");
  add("in the oil", "loss", oil([](const PumpPower& power) { return power.lost(); }),
      "pistons on the oil less the flow to the load: ports and leakage");
  return lines;
}

std::vector<report::Budget::Quantity> efficiency_quantities(const std::vector<Turn>& turns) {
  const bool pumps =
      std::all_of(turns.begin(), turns.end(), [](const Turn& turn) { return turn.pumps(); });
  const bool hydraulic = turns.front().oil.has_value();
  std::vector<report::Budget::Quantity> quantities;
  for (const EfficiencyLine& line : efficiency_lines()) {
    const bool given = line.value == &Efficiencies::mechanical;  // also where the pressure is given
    const bool at_rest = line.value == &Efficiencies::volumetric;  // also where it does not pump
    const bool known = (hydraulic || given) && (pumps || at_rest);
    quantities.push_back(quantity(
        turns, line.name, "", "%",
        [&](const Turn& turn) { return known ? turn.efficiencies().*line.value : not_computed(); },
        known ? line.meaning
        : !hydraulic && !given
            ? "not modelled: the pressure is given, and nothing leaks or is compressed"
            : "not pumping: no power goes in, or no pressure is raised"));
  }
  return quantities;
}

std::vector<report::Budget::Quantity> block_lines(const std::vector<Turn>& turns) {
  std::vector<report::Budget::Quantity> lines;
  const auto add = [&](const std::string& name, const std::string& unit, bool greatest,
                       const std::function<Statistics(const Turn&)>& of,
                       const std::string& note = {}) {
    lines.push_back(quantity(
        turns, name + (greatest ? ", maximum" : ", minimum"), "", unit,
        [&](const Turn& turn) { return greatest ? of(turn).greatest : of(turn).least; }, note));
  };
  const std::optional<PortPlate>& plate = turns.front().ready.the_case.pump.port_plate;
  const auto column = [](const char* name) {
    return [name](const Turn& turn) { return statistics(turn.budget, name); };
  };
  for (const bool greatest : {false, true})
    add("pressing force", "N", greatest, column("Fpress_z2_N"),
        greatest ? "" : "chambers, friction, spring, weight and tooth force along z2");
  const std::string none = "not modelled: the case has no port plate";
  const auto lands = [&](const Turn& turn) {
    return plate ? -statistics(turn.budget, "Fland_z2_N").mean : not_computed();
  };
  lines.push_back(quantity(turns, "separating force of the lands", "", "N", lands,
                           plate ? "constant: port pressures on the fixed plate" : none));
  const auto ratio = [&](const Turn& turn) {
    if (!plate) return Statistics{not_computed(), not_computed(), not_computed()};
    const std::size_t press = turn.budget.find("Fpress_z2_N");
    const std::size_t land = turn.budget.find("Fland_z2_N");
    return statistics(turn.budget.rows(), [&](std::size_t row) {
      const double pressing = turn.budget.at(row, press);
      return pressing > 0 ? -turn.budget.at(row, land) / pressing : not_computed();
    });
  };
  for (const bool greatest : {false, true})
    add("balance, separating over pressing force", "", greatest, ratio,
        !plate     ? none
        : greatest ? "above 1 the block lifts off"
                   : "the film carries the difference from 1");
  const auto radius = [&](const Turn& turn) {
    const std::size_t x = turn.table.find("xh_x2_mm");
    const std::size_t y = turn.table.find("yh_y2_mm");
    if (x == turn.table.columns() || y == turn.table.columns())
      return Statistics{not_computed(), not_computed(), not_computed()};
    return statistics(turn.table.rows(), [&](std::size_t row) {
      return std::hypot(turn.table.at(row, x), turn.table.at(row, y));
    });
  };
  for (const bool greatest : {false, true})
    add("distance of the film force from z2", "mm", greatest, radius,
        plate ? fmt::format("the plate's lands lie from {:.4g} to {:.4g} mm", plate->r1 * 1e3,
                            plate->r4 * 1e3)
              : "");
  return lines;
}

report::Budget section_of(const std::vector<Turn>& turns, const compare::Comparison* comparison) {
  report::Budget section;
  for (const Turn& turn : turns) section.models.push_back(turn.table.name);
  section.torque = torque_lines(turns, comparison);
  section.power = power_lines(turns);
  section.efficiency = efficiency_quantities(turns);
  section.block = block_lines(turns);
  return section;
}

}  // namespace

report::Budget budget_section(const BudgetComparison& budgets, const PreparedCase& first,
                              const PreparedCase& second, const ResultTable& analytic,
                              const ResultTable& multibody) {
  report::Budget section =
      section_of({{{first, budgets.analytic, analytic, budgets.analytic_oil}},
                  {{second, budgets.multibody, multibody, budgets.multibody_oil}}},
                 &budgets.comparison);
  section.text =
      "Each line from its own load alone: analytic by the closed form under that load, multibody "
      "by the load's virtual power along Simbody's velocities. Spring, film and the weights of "
      "shaft and block have no torque. The torque that drives the block is transmitted by the "
      "gear; where the speed of the block is imposed, it is not part of Td.";
  return section;
}

report::Budget budget_section(const std::vector<BudgetTurn>& turns) {
  std::vector<Turn> each;
  for (const BudgetTurn& turn : turns) each.push_back({turn});
  return section_of(each, nullptr);
}

std::string budget_text(const BudgetComparison& budgets) {
  const auto mean = [&](const std::string& column) {
    return statistics(budgets.analytic, column).mean;
  };
  const double whole = mean("Td_z1_Nm");
  std::string text = fmt::format("mean drive torque {:.5g} Nm:", whole);
  const char* separator = " ";
  for (const CauseText& cause : causes_in(budgets.analytic)) {
    const double part = mean(drive_column(cause.cause));
    if (std::abs(part) < 1e-9 * std::abs(whole)) continue;
    text += fmt::format("{}{} {:.4g}", separator, cause.name, part);
    separator = "; ";
  }
  return text;
}

}  // namespace bentaxis::study
