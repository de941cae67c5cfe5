#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "bentaxis/hydraulics/power.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "fmu_section.h"
#include "simulation_parts.h"

namespace bentaxis::study {

std::string race(const SimulationResult& r) {
  const double seconds[] = {r.seconds_for(Model::analytic, r.choice.error),
                            r.seconds_for(Model::multibody, r.choice.error)};
  if (!is_computed(seconds[0]) || !is_computed(seconds[1])) return "";
  return fmt::format("analytic {:.3g} s, multibody {:.3g} s: {:.3g} times as long", seconds[0],
                     seconds[1], seconds[1] / seconds[0]);
}

namespace {

using report::Cell;

constexpr std::size_t kMaxTouches = 200;  // in the table

report::Section difference_section(const SimulationResult& r) {
  report::Section section;
  section.title = "Difference of the two trajectories";
  section.text = r.choice.steady
                     ? "Over one turn, at equal shares of either model's own period."
                     : "At equal times, and at equal shaft angles: the analytic model is evaluated "
                       "when its shaft has the angle of Simbody's shaft. The tolerance is the "
                       "wanted error times the amplification of a disturbance until then.";
  section.facts = {
      {"speed of the shaft, of its largest", fmt::format("{:.1e}", r.speed_difference)}};
  if (compliant(r))
    section.facts.emplace_back("lag theta - psi", fmt::format("{:.1e} rad", r.lag_difference));
  if (!r.choice.steady) {
    section.facts.emplace_back("compared until", fmt::format("{:.6g} s", r.judged_until_s));
    section.facts.emplace_back("amplification of a disturbance until the end",
                               fmt::format("{:.3g}", r.growth.back()));
  }
  if (r.rows_at_steps > 0)
    section.facts.emplace_back(
        "rows that are not compared",
        fmt::format("{} of {}: their integration errors leave the models on different sides of a "
                    "step of the pressure",
                    r.rows_at_steps, r.analytic->lag.size()));
  section.table.columns = {
      "group",           "unit", "peak", "in time, of peak", "at, s", "over the angle, of peak",
      "of the tolerance"};
  if (is_computed(r.integration_change))
    section.facts.emplace_back(
        "change at a tolerance ten times looser, of peak",
        fmt::format("{:.1e} (the error of the integration is below that)", r.integration_change));
  for (const GroupDifference& g : r.groups)
    section.table.rows.push_back(
        {g.group, g.unit, g.peak, g.in_time, g.time_s, g.over_angle, g.of_allowed});
  return section;
}

report::Section work_section(const SimulationResult& r) {
  report::Section section;
  section.title = "Work and drift";
  section.text =
      "Work of all loads and of the drive, integrated with the motion, against the change of "
      "energy. The residual is an error of integration or constraints.";
  section.table.columns = {"quantity"};
  std::vector<std::vector<Cell>> rows = {{std::string("work of loads, J")},
                                         {std::string("work of the drive, J")},
                                         {std::string("kinetic energy gained, J")},
                                         {std::string("energy in teeth and coupling gained, J")},
                                         {std::string("residual at the end, J")},
                                         {std::string("largest residual of any row, J")},
                                         {std::string("worst error of a constraint, m")}};
  for (const auto& [name, run] : runs_of(r)) {
    section.table.columns.push_back(name);
    const TrajectoryRecord& t = run->record;
    const double values[] = {t.work_of_loads,
                             t.work_of_drives,
                             t.kinetic_energy_gained,
                             t.potential_energy_gained,
                             t.work_residual,
                             t.worst_work_residual,
                             t.drift};
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].emplace_back(values[i]);
  }
  section.table.rows = std::move(rows);
  return section;
}

// From the motor to the load, of both models.
report::Section energy_section(const SimulationResult& r) {
  report::Section section;
  section.title = "Energy from the drive to the load";
  section.text =
      "Energy supplied, stored and dissipated. Friction of pistons, block and shaft is what the "
      "loads did less the work of the pressures, weight (nothing over a turn) and the torque's own "
      "share (38), which feeds in where the torque drives backwards, among them; the oil's own are "
      "integrated place by place. Pistons do on the oil what the pressures do on them, which the "
      "models find from their own velocities and the oil from the volumes of its chambers. The "
      "work of the drive is that of the torque on the shaft, or of the motor where there is one: "
      "damping in its coupling is then among the losses.";
  section.table.columns = {"energy, J", "use"};
  std::vector<std::vector<Cell>> rows;
  const auto put = [&](std::size_t row, const std::string& name, const char* use, double value) {
    if (row == rows.size()) rows.push_back({name, std::string(use)});
    rows[row].emplace_back(value);
  };
  for (const auto& [name, run] : runs_of(r)) {
    section.table.columns.push_back(name);
    const TrajectoryRecord& t = run->record;
    const OilHistory& oil = *run->oil;
    std::size_t row = 0;
    put(row++, "work of the drive", "source", t.work_of_drives);
    for (const OilEnergy& e : oil.energies)
      if (e.place.use == PowerUse::source && e.place.key != "pistons")
        put(row++, e.place.name, "source", e.energy);
    put(row++, "motion of shaft, block, pistons, rotor", "stored", t.kinetic_energy_gained);
    put(row++, "teeth and coupling", "stored", t.potential_energy_gained);
    put(row++, "oil", "stored", oil.energy_gained);
    put(row++, "friction, viscous torques, damping", "loss", oil.pressure_work - t.work_of_loads);
    for (const OilEnergy& e : oil.energies)
      if (e.place.use != PowerUse::source)
        put(row++, e.place.name, hydraulics::name_of(e.place.use), e.energy);
    put(row++, "residual: mechanics", "must vanish", t.work_residual);
    put(row++, "residual: oil", "must vanish", oil.energy_residual);
    put(row++, "residual between pistons and oil", "must vanish", oil.exchange_residual);
    put(row++, "residual of the mass of the oil, kg", "must vanish", oil.mass_residual);
  }
  section.table.rows = std::move(rows);
  return section;
}

// Mean power of a motion that repeats itself: its table is one turn at equal times, with both ends.
report::Section steady_power_section(const SimulationResult& r) {
  report::Section section;
  section.title = "Mean power of the periodic motion";
  section.text =
      "Means over a turn, of what `bentaxis compare` states of constant speed under the same "
      "names. "
      "The drive is the torque Td on the pump's shaft; a motor in front of a coupling does what "
      "the "
      "coupling's damping takes in addition. The flow to the load is mass flow x pressure "
      "potential, delivery port less suction port (docs/budgets.md).";
  section.table.columns = {"quantity", "unit"};
  std::vector<std::vector<Cell>> rows;
  for (const auto& [name, run] : runs_of(r)) {
    section.table.columns.push_back(name);
    const ResultTable& table = run->table.results;
    const std::size_t torque = table.find("Td_z1_Nm");
    const std::size_t last = table.rows() - 1;
    const double duration = run->state(last, StateColumn::time) - run->state(0, StateColumn::time);
    double drive = 0;
    for (std::size_t row = 0; row < last; ++row)
      drive += table.at(row, torque) * rad_per_second(run->state(row, StateColumn::shaft_speed)) /
               static_cast<double>(last);
    hydraulics::PowerBudget budget;
    for (const OilEnergy& e : run->oil->energies)
      if (const auto place = hydraulics::place_of(e.place.key))
        budget[*place] = e.energy / duration;
    const hydraulics::PumpPower power = hydraulics::pump_power(budget);
    const std::tuple<const char*, const char*, double> quantities[] = {
        {"drive", "W", drive},
        {"pistons on the oil, by the hydraulic model", "W", power.pistons},
        {"flow to the load", "W", power.useful},
        {"in the oil", "W", power.lost()},
        {"total efficiency", "%", drive > 0 ? 100 * power.useful / drive : not_computed()}};
    std::size_t at = 0;
    for (const auto& [quantity, unit, value] : quantities) {
      if (at == rows.size()) rows.push_back({quantity, unit});
      rows[at++].emplace_back(value);
    }
  }
  section.table.rows = std::move(rows);
  return section;
}

// Multipliers that say something; the others are of states that forget a disturbance at once.
constexpr double kForgotten = 1e-6;

report::Section periodic_section(const SimulationResult& r) {
  report::Section section;
  section.title = "Periodic motion and its stability";
  section.text =
      "The motion is periodic with an N-th of a turn, with the pistons renumbered. A Floquet "
      "multiplier is the factor of a small disturbance over this period; below 1 it decays. The "
      "decay time is that in which it falls to 1/e.";
  for (const Model model : kModels) {
    const auto& motion = r.periodic[static_cast<int>(model)];
    if (!motion) continue;
    section.facts.emplace_back(
        to_string(model),
        fmt::format("period {:.9g} s, {:.9g} rpm, {}; {} Newton steps, states off by {:.1e} of "
                    "their scales",
                    motion->period_s, motion->speed / kRadPerSecondPerRpm,
                    motion->stable() ? "stable" : "unstable", motion->iterations, motion->error));
  }
  section.table.columns = {"model", "multiplier, magnitude", "its angle, deg", "decay time, s"};
  for (const Model model : kModels) {
    const auto& motion = r.periodic[static_cast<int>(model)];
    if (!motion) continue;
    for (const std::complex<double>& m : motion->multipliers) {
      const double size = std::abs(m);
      if (size < kForgotten) continue;
      section.table.rows.push_back(
          {to_string(model), size, std::arg(m) / kRadPerDegree,
           size < 1 ? -motion->period_s / std::log(size) : not_computed()});
    }
  }
  return section;
}

report::Section teeth_section(const SimulationResult& r) {
  report::Section section;
  section.title = "Teeth: touches and impulses";
  for (const auto& [name, run] : runs_of(r))
    section.facts.emplace_back(name + ": share of the time out of contact",
                               fmt::format("{:.4g} %", 100 * run->record.share_out_of_contact));
  if (r.analytic && r.multibody) {
    const EventMatch& e = r.events;
    section.facts.emplace_back("touches", fmt::format("analytic {}, multibody {}; {} are matched",
                                                      e.touches[0], e.touches[1], e.matched));
    section.facts.emplace_back("their largest difference in time",
                               fmt::format("{:.1e} s", e.time_s));
    section.facts.emplace_back("their largest difference of impulse, of the largest impulse",
                               fmt::format("{:.1e}", e.impulse));
    section.facts.emplace_back(
        "impulse of a touch, mean and largest",
        fmt::format("analytic {:.4g}, {:.4g} Ns; multibody {:.4g}, {:.4g} Ns", e.mean_impulse[0],
                    e.largest_impulse[0], e.mean_impulse[1], e.largest_impulse[1]));
  }
  const auto [name, run] = runs_of(r).front();
  section.text = fmt::format(
      "Contacts of the {} model with the speeds before them and the impulse until separation{}.",
      name,
      run->record.events.size() > 2 * kMaxTouches
          ? fmt::format("; the first {} of them", kMaxTouches)
          : "");
  section.table.columns = {"time, s",      "flank",         "shaft, rad/s",
                           "block, rad/s", "approach, m/s", "impulse, Ns"};
  for (const ToothEvent& event : run->record.events) {
    if (!event.touch) continue;
    if (section.table.rows.size() == kMaxTouches) break;
    section.table.rows.push_back({event.time_s, std::string(event.flank > 0 ? "driving" : "other"),
                                  event.shaft_speed, event.block_speed, event.approach_speed,
                                  event.impulse});
  }
  return section;
}

report::Section effort_section(const SimulationResult& r) {
  report::Section section;
  section.title = "Speed against error";
  section.text =
      "Largest error of any reaction, of its peak, in the compared time: of the analytic model "
      "against its tightest run, of the multibody model against the analytic one. Runs that tell "
      "the error of another one are made beside it: either takes somewhat longer than alone.";
  for (const auto& [name, run] : runs_of(r))
    section.facts.emplace_back(name + ": chosen", run->record.choice);
  if (!r.multibody_choice.empty())
    section.facts.emplace_back("accuracy of the multibody model", r.multibody_choice);
  if (const std::string text = race(r); !text.empty())
    section.facts.emplace_back(fmt::format("for an error of {:g} of peak", r.choice.error), text);
  section.table.columns = {"model", "method",     "error or accuracy asked", "error", "s",
                           "steps", "evaluations"};
  for (const Effort& e : r.effort)
    section.table.rows.push_back(
        {to_string(e.model), e.method, e.asked, e.error, e.seconds, e.steps, e.evaluations});
  return section;
}

}  // namespace

std::vector<report::Section> simulation_sections(const SimulationResult& r) {
  std::vector<report::Section> sections;
  if (r.choice.steady) sections.push_back(periodic_section(r));
  if (!r.groups.empty()) sections.push_back(difference_section(r));
  if (r.choice.unit) sections.push_back(coupling_section(r));
  if (r.oil_follows) sections.push_back(energy_section(r));
  if (r.oil_follows && r.choice.steady) sections.push_back(steady_power_section(r));
  sections.push_back(work_section(r));
  if (compliant(r)) sections.push_back(teeth_section(r));
  if (!r.effort.empty()) sections.push_back(effort_section(r));
  return sections;
}

}  // namespace bentaxis::study
