#include "bentaxis/study/simulation_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "answers_text.h"
#include "bentaxis/analytic/teeth.h"
#include "bentaxis/hydraulics/power.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/force_figures.h"
#include "bentaxis/study/motion_answers.h"
#include "bentaxis/study/plausibility_section.h"
#include "bentaxis/study/pump_scene.h"
#include "bentaxis/study/teeth_section.h"
#include "bentaxis/study/timing.h"
#include "document_parts.h"
#include "fmu_section.h"
#include "key_figures.h"

namespace bentaxis::study {
namespace {

using report::Cell;
using report::Figure;
using report::Values;

constexpr std::size_t kMaxTouches = 200;  // in the table
constexpr std::size_t kMaxMarks = 2000;   // in a figure
constexpr double kMilliseconds = 1e3;

// The runs there are, with their names.
std::vector<std::pair<std::string, const Trajectory*>> runs_of(const SimulationResult& r) {
  std::vector<std::pair<std::string, const Trajectory*>> runs;
  if (r.analytic) runs.emplace_back("analytic", &*r.analytic);
  if (r.multibody) runs.emplace_back("multibody", &*r.multibody);
  return runs;
}

bool compliant(const SimulationResult& r) { return r.ready.the_case.pump.gear.is_compliant(); }

Values times_of(const Trajectory& run) {
  Values times;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    times.push_back(kMilliseconds * run.state(row, StateColumn::time));
  return times;
}

Values state_of(const Trajectory& run, std::size_t column) {
  Values values;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    values.push_back(run.table.state(row, column));
  return values;
}

// Columns of the oil in a unit, those of chambers apart.
std::vector<std::string> columns_of(const SimulationResult& r, const std::string& unit) {
  std::vector<std::string> names;
  for (const OilColumn& column : runs_of(r).front().second->oil->columns)
    if (column.unit == unit && column.piston == 0) names.push_back(column.name);
  return names;
}

// ---- Figures

std::vector<Figure> figures_of(const SimulationResult& r) {
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

// What both models need for the wanted error; "" where one of them is not there.
std::string race(const SimulationResult& r) {
  const double seconds[] = {r.seconds_for(Model::analytic, r.choice.error),
                            r.seconds_for(Model::multibody, r.choice.error)};
  if (!is_computed(seconds[0]) || !is_computed(seconds[1])) return "";
  return fmt::format("analytic {:.3g} s, multibody {:.3g} s: {:.3g} times as long", seconds[0],
                     seconds[1], seconds[1] / seconds[0]);
}

// ---- Tables

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

// A course that a pump does not survive, or that the oil's law was not made for.
std::vector<report::Warning> doubts_of(const SimulationResult& r) {
  constexpr double kNearVacuum = 0.1;  // of the atmosphere
  constexpr double kOverspeed = 3;     // of the speed of [operation]
  const auto [name, run] = runs_of(r).front();
  const Case& the_case = r.ready.the_case;
  double lowest = 0, lowest_at = 0, fastest = 0, fastest_at = 0;
  for (std::size_t row = 0; row < run->lag.size(); ++row) {
    const double time = run->state(row, StateColumn::time),
                 speed = run->state(row, StateColumn::shaft_speed);
    for (int k = 0; k < the_case.pump.geometry.pistons; ++k)
      if (const double p = run->oil->value(row, k); p < lowest) {
        lowest = p;
        lowest_at = time;
      }
    if (std::abs(speed) > std::abs(fastest)) {
      fastest = speed;
      fastest_at = time;
    }
  }
  std::vector<report::Warning> warnings;
  const double atmosphere = the_case.hydraulics->atmosphere / kPascalPerBar;
  if (lowest < (kNearVacuum - 1) * atmosphere)
    warnings.push_back(
        {"course-vacuum",
         fmt::format("a chamber falls to {:.4g} bar gauge at {:.4g} s: it is not filled "
                     "completely, and its pressure follows from the law of the air",
                     lowest, lowest_at)});
  const double usual = std::abs(the_case.operation.speed_rpm);
  if (usual > 0 && std::abs(fastest) > kOverspeed * usual)
    warnings.push_back(
        {"course-overspeed",
         fmt::format("the shaft reaches {:.5g} rpm at {:.4g} s, more than {:g} times the speed of "
                     "[operation]: is an inertia or a load missing?",
                     fastest, fastest_at, kOverspeed)});
  return warnings;
}

// More pairs of teeth might touch than are looked at.
void warn_of_further_pairs(const SimulationResult& r, std::vector<report::Warning>& warnings) {
  const Trajectory& run = *runs_of(r).front().second;
  if (run.teeth.empty()) return;
  const double reach = analytic::BevelTeeth(r.ready.the_case.pump).geometry().reach;
  double worst = 0;
  std::size_t rows = 0;
  for (const TeethAction& action : run.teeth) {
    double largest = 0;
    for (const PairContact& pair : action.pairs) largest = std::max(largest, pair.approach);
    worst = std::max(worst, largest);
    if (largest > reach) ++rows;
  }
  if (rows == 0) return;
  warnings.push_back(
      {"further pairs of teeth touch",
       fmt::format(
           "in {:.3g} % of the rows the approach of the teeth exceeds {:.3g} um, maximum {:.3g} "
           "um: three pairs of each flank are modelled; a fourth would carry part of the force.",
           100.0 * static_cast<double>(rows) / static_cast<double>(run.teeth.size()), 1e6 * reach,
           1e6 * worst)});
}

std::vector<report::Warning> warnings_of(const SimulationResult& r) {
  std::vector<report::Warning> warnings;
  if (r.oil_follows)
    warnings = doubts_of(r);
  else if (r.ready.hydraulics)
    warnings.push_back(
        {"pressure of constant speed",
         fmt::format("the chamber pressure is the periodic one of {:g} rpm at every speed of the "
                     "motion; the oil does not follow it.",
                     r.ready.the_case.operation.speed_rpm)});
  warn_of_further_pairs(r, warnings);
  if (r.ready.hydraulics)
    if (auto warning = accuracy_warning(r.ready.the_case, *r.ready.hydraulics))
      warnings.push_back(std::move(*warning));
  if (r.choice.unit)
    for (report::Warning& warning : coupling_warnings(r)) warnings.push_back(std::move(warning));
  return warnings;
}

std::optional<report::Scene> scene_of(const SimulationResult& r) {
  std::vector<SceneRun> shown;
  SceneMotion motion;
  for (const auto& [name, run] : runs_of(r)) {
    if (run->loads.run_rows() != run->lag.size()) return std::nullopt;
    shown.push_back({run->table.results, run->loads});
  }
  const Trajectory& first = *runs_of(r).front().second;
  motion.time_ms = times_of(first);
  for (std::size_t row = 0; row < first.lag.size(); ++row) {
    motion.shaft.push_back(radians(first.state(row, StateColumn::theta)));
    motion.block.push_back(motion.shaft.back() - first.lag[row]);
  }
  return pump_scene(r.ready.the_case, shown, &motion);
}

report::KeyFigures key_figures_of(const SimulationResult& r) {
  report::KeyFigures key;
  key.at_unit = "ms";
  std::vector<const ResultTable*> tables;
  for (const auto& [name, run] : runs_of(r)) {
    key.models.push_back(name);
    tables.push_back(&run->table.results);
  }
  key.rows = motion_figures(tables, times_of(*runs_of(r).front().second));
  return key;
}

std::vector<report::Figure> diagrams_of(const SimulationResult& r) {
  const Trajectory& run = *runs_of(r).front().second;
  DiagramRun shown{r.ready.the_case, run.table.results, &run.loads};
  shown.time_ms = times_of(run);
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    shown.block_deg.push_back(run.state(row, StateColumn::theta) - run.lag[row] / kRadPerDegree);
  shown.constant_ports = !r.oil_follows;
  return force_figures(shown);
}

std::string milliseconds(double seconds) {
  return fmt::format("{:.4g} ms", seconds * kMilliseconds);
}

// Of the first model: where both agree, those of the other are the same.
MotionAnswers answers_to(const SimulationResult& r) {
  return motion_answers(*runs_of(r).front().second, r.ready.the_case);
}

std::vector<std::string> answers_of(const MotionAnswers& a) {
  std::vector<std::string> answers;
  if (a.reached_s)
    answers.push_back(fmt::format(
        "Speed: {:g} % of {:.5g} rpm{} after {}{}.", 100 * MotionAnswers::kReached,
        a.first_rpm == 0 ? a.end_rpm : a.end_rpm - a.first_rpm,
        a.first_rpm == 0
            ? ""
            : fmt::format(", the change from {:.5g} to {:.5g} rpm,", a.first_rpm, a.end_rpm),
        milliseconds(*a.reached_s),
        a.settled
            ? ""
            : "; the speed still changes at the end: a longer simulation gives other numbers"));
  if (a.backwards)
    answers.push_back(fmt::format("The shaft also turns backwards: up to {:.4g} rpm at {}.",
                                  a.backwards->rpm, milliseconds(a.backwards->at_s)));
  answers.push_back(fmt::format(
      "Drive torque: at most {:.4g} Nm at {}; work of the drive{} {:.4g} kJ.", a.largest_torque,
      milliseconds(a.largest_torque_s),
      a.drive_has_inertia ? ", which turns its own inertia too," : "", a.drive_work / 1e3));
  if (a.delivery)
    answers.push_back(
        fmt::format("Delivery pressure: at most {:.4g} bar at {}, {:.3g} bar above its mean over "
                    "the last {}, {:.4g} bar.",
                    a.delivery->highest_bar, milliseconds(a.delivery->highest_s),
                    a.delivery->highest_bar - a.delivery->end_bar,
                    a.delivery->end_is_turn ? "turn" : "tenth of the time", a.delivery->end_bar));
  if (a.walls) {
    answers.push_back(fmt::format(
        "Walls: largest force {:.4g} N at {} (piston {}); {}.", a.walls->largest_N,
        milliseconds(a.walls->largest_s), a.walls->piston,
        a.walls->loose == 0
            ? "some wall pushes in every row"
            : fmt::format("no wall pushes in {:.3g} % of the rows", 100 * a.walls->loose)));
    answers.push_back(fmt::format("Block: {:.4g} to {:.4g} deg behind the shaft.",
                                  a.walls->lag_deg[0], a.walls->lag_deg[1]));
  }
  if (a.beyond_plate)
    answers.push_back(
        fmt::format("Not a possible motion of a pump in {:.3g} % of the rows: the film force acts "
                    "up to {:.3g} mm from the block's axis (at {}), outside the plate radius of "
                    "{:.3g} mm. The block would tilt there: Fh, Th and Rcn are not valid.",
                    100 * a.beyond_plate->share, a.beyond_plate->largest_mm,
                    milliseconds(a.beyond_plate->largest_s), a.beyond_plate->plate_mm));
  return answers;
}

report::Verdict verdict_of(const SimulationResult& r) {
  report::Verdict verdict{r.agrees(), r.headline()};
  if (r.choice.only) verdict.word = r.agrees() ? "Balanced" : "Not balanced";
  if (!r.choice.only) verdict.tolerance = r.choice.error;
  const MotionAnswers answers = answers_to(r);
  verdict.answers = answers_of(answers);
  if (answers.beyond_plate)
    verdict.not_valid = fmt::format("in {:.3g} % of the rows", 100 * answers.beyond_plate->share);
  return verdict;
}

}  // namespace

report::Document simulation_document(const SimulationResult& r, const report::Lines& program,
                                     const CaseDescription& description) {
  const Case& the_case = r.ready.the_case;
  report::Document document;
  document.title = the_case.name;
  document.program = program;
  put_description(document, description, scene_of(r));
  document.derived = derived_section(the_case);
  document.verdict = verdict_of(r);
  document.meaning =
      r.choice.only
          ? "One model's motion, integrated once. Its balances of work, energy and mass say how "
            "well it was integrated; nothing else was computed that could contradict it. Without "
            "--model both models are run and compared. Whether a pump does so is another question "
            "(docs/limits.md)."
      : r.oil_follows || r.choice.steady
          ? "Two derivations of the mechanics, coupled to the same oil and integrated by the same "
            "method. Agreement verifies that both solve the same equations. The integration error "
            "is estimated by another tolerance, that of the oil by its balances. Whether a pump "
            "behaves like this is validation (docs/limits.md)."
      : r.has_teeth() || r.choice.unit
          ? "Two derivations of the mechanics, integrated by the same method. Agreement verifies "
            "that both solve the same equations. The integration error is estimated by another "
            "tolerance. Whether a pump behaves like this is validation (docs/limits.md)."
          : "Two derivations of the motion, each integrated by its own method, against each other "
            "in time. Agreement verifies that both solve the same equations. Whether a pump "
            "behaves like this is validation (docs/limits.md).";
  document.key_figures = key_figures_of(r);
  report::append(document.warnings, warnings_of(r));
  if (!r.choice.only) document.common = common_inputs(the_case, true, r.oil_follows);
  document.checks = r.checks;
  document.models.emplace();
  document.runs.emplace();
  if (r.choice.steady) document.runs->push_back(periodic_section(r));
  if (!r.groups.empty()) document.runs->push_back(difference_section(r));
  if (r.choice.unit) document.runs->push_back(coupling_section(r));
  if (r.oil_follows) document.runs->push_back(energy_section(r));
  if (r.oil_follows && r.choice.steady) document.runs->push_back(steady_power_section(r));
  document.runs->push_back(work_section(r));
  if (compliant(r)) document.runs->push_back(teeth_section(r));
  if (!r.effort.empty()) document.runs->push_back(effort_section(r));
  for (const auto& [name, run] : runs_of(r)) {
    report::ModelSection model;
    model.name = name;
    model.assumptions =
        in_words(r.ready.assumptions(name == "analytic" ? Model::analytic : Model::multibody));
    model.facts = {{"integrated by", run->record.choice},
                   {"steps", std::to_string(run->record.steps)},
                   {"evaluations", std::to_string(run->record.evaluations)}};
    model.seconds = run->record.seconds;
    model.angles = run->lag.size();
    document.models->push_back(std::move(model));
  }
  document.figures = figures_of(r);
  for (auto& figure : diagrams_of(r)) document.figures->push_back(std::move(figure));
  if (r.has_teeth() && r.analytic)
    document.figures->push_back(teeth_picture(
        r.ready.the_case.pump, teeth_table_of(*r.analytic, r.ready.the_case.pump.gear).results));
  if (!r.difference.empty() && !r.choice.steady) document.figures->push_back(difference_figure(r));
  if (auto figure = effort_figure(r)) document.figures->push_back(std::move(*figure));
  return document;
}

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

std::string simulation_text(const SimulationResult& r) {
  std::string text =
      report::answers_text(r.ready.the_case.name, r.headline(), answers_of(answers_to(r)));
  if (!r.groups.empty()) {
    text += fmt::format("{:<13} {:<17} {:>13} {:>16} {:>12}\n", "group", "       peak",
                        r.choice.steady ? "of peak" : "of peak, time",
                        r.choice.steady ? "" : "of peak, angle", "of allowed");
    for (const GroupDifference& g : r.groups)
      text += fmt::format("{:<13} {:>11.5g} {:<5} {:>13.1e} {:>16} {:>12}\n", g.group, g.peak,
                          g.unit, g.in_time,
                          is_computed(g.over_angle) ? fmt::format("{:.1e}", g.over_angle) : "",
                          g.judged ? fmt::format("{:.2g}", g.of_allowed) : "not compared");
    text += "\n";
  }
  for (const auto& [name, run] : runs_of(r)) {
    const TrajectoryRecord& t = run->record;
    text +=
        fmt::format("{}: {:.3g} s, {} steps, {} evaluations; residual of the work balance {:.1e} J",
                    name, t.seconds, t.steps, t.evaluations, t.worst_work_residual);
    if (compliant(r)) {
      const auto touches = std::count_if(t.events.begin(), t.events.end(),
                                         [](const ToothEvent& event) { return event.touch; });
      text += fmt::format("; {} touches, out of contact {:.3g} % of the time", touches,
                          100 * t.share_out_of_contact);
    }
    text += "\n";
  }
  if (const std::string times = race(r); !times.empty())
    text += fmt::format("for an error of {:g} of peak: {}\n", r.choice.error, times);
  if (r.oil_follows)
    for (const auto& [name, run] : runs_of(r)) {
      const OilHistory& oil = *run->oil;
      text += fmt::format("{}: residual of the oil's energy {:.1e} J, of its mass {:.1e} kg\n",
                          name, oil.worst_energy_residual, oil.worst_mass_residual);
    }
  if (is_computed(r.integration_change))
    text += fmt::format("at a tolerance ten times looser results change by {:.1e} of peak\n",
                        r.integration_change);
  if (!r.multibody_choice.empty()) text += "chosen " + r.multibody_choice + "\n";
  if (r.choice.unit) text += coupling_text(r);
  for (const report::Warning& warning : warnings_of(r))
    text += fmt::format("warning: {}: {}\n", warning.name, warning.text);
  return text;
}

}  // namespace bentaxis::study
