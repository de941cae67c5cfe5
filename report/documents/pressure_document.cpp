#include "bentaxis/study/pressure_document.h"

#include "bentaxis/compare/comparison.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/efficiency.h"
#include "bentaxis/study/failed_points.h"
#include "bentaxis/study/turn_summary.h"
#include "document_parts.h"
#include "hydraulic_results.h"
#include "hydraulic_sections.h"
#include "key_figures.h"

namespace bentaxis::study {
namespace {

constexpr int kOverlayTurns = 3;  // as in Fig. 19-24

double bar(const OperatingPoint& point) {
  return point.the_case().pressure.ports.delivery / kPascalPerBar;
}

}  // namespace

// What the pump delivers, and what is wrong with its timing.
std::vector<std::string> pressure_answers(const OperatingPoint& point,
                                          const std::vector<report::TimingRow>& timing) {
  const hydraulics::Summary& s = point.state().summary;
  return {fmt::format("{} {:.4g} l/min (at suction density) at a mean of {:.4g} bar and {:.5g} "
                      "rpm: volumetric efficiency{} {:.4g} %, ripple {:.3g} bar peak to peak.",
                      s.flow < 0 ? "Takes" : "Delivers", std::abs(s.flow) / kLitrePerMinute,
                      s.delivery_mean / kPascalPerBar, point.the_case().operation.speed_rpm,
                      s.motors() ? " as a motor" : "", 100 * s.volumetric_efficiency,
                      (s.delivery_greatest - s.delivery_least) / kPascalPerBar),
          timing_answer(timing)};
}

report::Document pressure_document(const OperatingPoint& point,
                                   const hydraulics::PowerBudget& power,
                                   const report::Lines& program,
                                   const CaseDescription& description) {
  const Case& the_case = point.the_case();
  const hydraulics::SteadyState& state = point.state();
  report::Document document = case_document(description, the_case.name, program);
  document.key_figures = {{"hydraulic model"}, "deg", oil_figures(state.summary, 1)};
  document.models = {report::model_of(point.analytic, {}), report::model_of(point.multibody, {})};
  document.runs = {hydraulic_section(the_case, state), power_section(the_case, state, power),
                   efficiency_section(point, power), orders_section(the_case, state)};
  document.timing = timing_rows(the_case, state);
  report::append(document.warnings, timing_warnings(*document.timing));
  const double torques[] = {mean(point.analytic, "Td_z1_Nm"), mean(point.multibody, "Td_z1_Nm")};
  document.verdict = {
      .agrees = std::nullopt,
      .headline = fmt::format("Mean drive torque {:.5g} Nm by the analytic model, {:.5g} Nm by the "
                              "multibody model, at {:.4g} bar.",
                              torques[0], torques[1], bar(point)),
      .word = "Pressure",
      .answers = pressure_answers(point, *document.timing)};
  document.figures = hydraulic_figures(the_case, state);
  append(document.figures, result_figures(the_case, state, power));
  document.figures->push_back({"td", "Drive torque Td", "Fig. 17",
                               report::ChannelFigure{"Nm", {"Td_z1_Nm"}},
                               fmt::format("Mean torque: analytic {:.5g} Nm, multibody {:.5g} Nm.",
                                           torques[0], torques[1])});
  return document;
}

void add_curve(report::Document& document, const TorqueCurve& curve) {
  const char* axis = "mean delivery pressure (bar)";
  document.figures->push_back(
      {"torque_curve", "Mean drive torque against delivery pressure", "Fig. 18",
       report::OwnFigure{"Nm",
                         axis,
                         false,
                         curve.bar,
                         {{"analytic", curve.analytic},
                          {"multibody", curve.multibody},
                          {"ideal: displacement x pressure / 2 pi", curve.ideal}}}});
  document.figures->push_back(
      {"flow_curve", "Mean flow against delivery pressure", "",
       report::OwnFigure{
           "l/min",
           axis,
           false,
           curve.bar,
           {{"volume flow to the load, at the density in the suction port", curve.flow},
            {"volume flow to the load, at the density of the mean delivery pressure",
             curve.flow_at_delivery}}}});
  report::NewSection section(
      "Torque and flow against delivery pressure",
      "Each point: periodic hydraulic state, then both models over a turn. 0 bar is an open line. "
      "The flow and the volumetric efficiency are at the density in the suction port, the last "
      "column at that of the mean delivery pressure.");
  section.columns("delivery, bar", "mean torque, analytic, Nm", "mean torque, multibody, Nm",
                  "ideal torque, Nm", "flow, l/min", "volumetric efficiency, %",
                  "flow at delivery pressure, l/min");
  for (std::size_t i = 0; i < curve.bar.size(); ++i)
    section.row(curve.bar[i], curve.analytic[i], curve.multibody[i], curve.ideal[i], curve.flow[i],
                curve.efficiency[i], curve.flow_at_delivery[i]);
  for (const FailedPoint& failed : curve.failed) {
    section.row(failed.value);
    section.fact(failed.point + ": not computed", failed.reason);
  }
  add_warnings(document, curve.failed);
  document.runs->push_back(std::move(section));
}

void add_overlay(report::Document& document, const OperatingPoint& first,
                 const OperatingPoint& second) {
  if (second.analytic.rows() != first.analytic.rows())
    throw InputError(second.the_case().file.string() +
                     ": must have the same samples_per_revolution as " +
                     first.the_case().file.string());
  std::vector<double> theta;
  for (int turn = 0; turn < kOverlayTurns; ++turn)
    for (const double angle : first.analytic.theta_deg) theta.push_back(angle + 360 * turn);
  const auto add = [&](const std::string& id, const std::string& title, const std::string& paper,
                       const std::vector<std::string>& channels) {
    report::Figure figure = angle_figure(id, title, paper, "N", theta);
    compare::Difference worst;
    for (const OperatingPoint* point : {&first, &second}) {
      const auto comparison = compare::compare_tables(point->analytic, point->multibody, {});
      for (const std::string& channel : channels) {
        const std::vector<double> turn = report::values_of(point->analytic, channel);
        std::vector<double> values;
        for (int i = 0; i < kOverlayTurns; ++i) append(values, turn);
        add_series(figure, fmt::format("{} at {:.4g} bar", channel, bar(*point)), values);
        worst.keep_larger(comparison.find(channel)->difference());
      }
    }
    figure.note = fmt::format(
        "Analytic model, three times the same turn; the multibody model differs by up to {} of "
        "peak.",
        worst.share_text());
    document.figures->push_back(std::move(figure));
  };
  add("overlay_rc_x2", "Bore force Rc on piston 1, x2: both loads", "Fig. 19", {"Rc_1_x2_N"});
  add("overlay_rc_y2", "Bore force Rc on piston 1, y2: both loads", "Fig. 20", {"Rc_1_y2_N"});
  add("overlay_rs_xy", "Joint force Rs on piston 1 across the block axis: both loads", "Fig. 21",
      {"Rs_1_x2_N", "Rs_1_y2_N"});
  add("overlay_rs_z2", "Joint force Rs on piston 1, z2: both loads", "Fig. 22", {"Rs_1_z2_N"});
  add("overlay_rb1", "Tapered bearing force Rb1: both loads", "Fig. 23",
      {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N"});
  add("overlay_rb2", "Cylindrical bearing force Rb2: both loads", "Fig. 24",
      {"Rb2_x1_N", "Rb2_y1_N"});
  document.runs->push_back(hydraulic_section(second.the_case(), second.state()));
  document.runs->back().title = "Hydraulic model: " + second.the_case().name;
}

namespace {

// Whether the case meets the printed numbers that a parameter was set to.
std::string calibration_answer(const compare::PublishedSection& section) {
  std::size_t held = 0;
  std::vector<std::string> outside;
  for (const compare::PublishedRow& row : section.rows) {
    if (!row.number.calibrated() || row.verdict == compare::PublishedVerdict::not_comparable)
      continue;
    ++held;
    if (row.verdict == compare::PublishedVerdict::outside)
      outside.push_back(row.number.quantity + (row.at.empty() ? "" : ", " + row.at));
  }
  if (held == 0) return "No printed number that a parameter was set to applies to this case.";
  if (outside.empty())
    return fmt::format("Calibrated: {} that a parameter was set to {} inside.",
                       counted(held, "printed number"), word_for(held, "is", "are"));
  return fmt::format("Not calibrated: {} of {} that a parameter was set to {} outside: {}.",
                     outside.size(), counted(held, "printed number"),
                     word_for(outside.size(), "is", "are"), joined(outside, "; "));
}

}  // namespace

void add_published(report::Document& document, compare::PublishedSection section) {
  const std::string text =
      section.summary.text() +
      " Used to infer: the number went into the geometry of this case, which is not published. "
      "Calibrated: a parameter was set to reproduce the number. Only predicted rows test the "
      "models; a window is the range of a printed axis, which contains the printed curve.";
  document.verdict->agrees = section.calibrated();
  document.verdict->word = section.calibrated() ? "Calibrated" : "Not calibrated";
  const std::string answer = calibration_answer(section);
  document.verdict->headline += " " + answer;
  document.verdict->answers.insert(document.verdict->answers.begin(), answer);
  document.published = report::PublishedTable{text, std::move(section)};
}

std::string text_of(const compare::PublishedSection& section) {
  std::string text;
  for (const auto& row : section.rows) {
    if (row.verdict == compare::PublishedVerdict::not_comparable) continue;
    text += fmt::format("{:<60} {:>20} {:<8} {:<27} paper {} ({})\n",
                        row.number.quantity + (row.at.empty() ? "" : ", " + row.at),
                        row.values[0] ? compare::text_of(*row.values[0]) : "",
                        row.verdict == compare::PublishedVerdict::inside ? "inside" : "OUTSIDE",
                        row.number.status, row.printed, row.where);
  }
  return text;
}

void add_transient(report::Document& document, const ResultTable& transient) {
  const auto values = [&](std::size_t column) {
    return report::values_of(transient, transient.channels[column].name);
  };
  report::Figure figure =
      angle_figure("transient", "From rest: pressures with the shaft at full speed at once", "",
                   "bar", transient.theta_deg);
  add_series(figure, "chamber 1", values(0));
  add_series(figure, "delivery volume", values(1));
  figure.note = "The load is that of the periodic state.";
  document.figures->push_back(std::move(figure));
}

std::vector<std::pair<std::string, std::string>> pressure_csv(
    const OperatingPoint& point, const hydraulics::PowerBudget& power) {
  return {{"pressure.csv", bentaxis::to_csv(point.state().table)},
          {"power.csv", power_csv(point.state(), power)},
          {"orders.csv", orders_csv(point.the_case(), point.state())}};
}

void add_suction_speed(report::Document& document, const OperatingPoint& point,
                       const SuctionSpeed& found) {
  document.timing->push_back(suction_speed_row(point.the_case(), found));
  const report::TimingRow& row = document.timing->back();
  report::append(document.warnings, timing_warnings({row}));
  std::vector<std::string>& answers = document.verdict->answers;
  answers.insert(answers.begin(),
                 fmt::format("{} {} rpm: {}. The case turns at {:.5g} rpm.",
                             found.filling ? "Filling speed" : "Suction speed",
                             row.bound.empty() ? fmt::format("{:.4g}", row.value) : row.bound,
                             row.text, point.the_case().operation.speed_rpm));
  // One sentence on all quantities that have a limit, this one too.
  std::erase_if(answers, [](const std::string& text) { return text.starts_with(kPortTiming); });
  answers.push_back(timing_answer(*document.timing));
}

std::string pressure_text(const OperatingPoint& point, const hydraulics::PowerBudget& power,
                          const report::Document& document) {
  std::string text = point.the_case().name + "\n";
  for (const std::string& answer : document.verdict->answers) text += answer + "\n";
  text += "\n";
  const auto add = [&](const std::string& name, double value, const std::string& unit) {
    text += fmt::format("{:<42} {:>12.6g} {}\n", name, value, unit);
  };
  for (const auto& line : hydraulics::lines(point.state()))
    if (is_computed(line.value)) add(line.name, line.value, line.unit);
  for (const hydraulics::Place place : point.state().places)
    add(fmt::format("power, {}", hydraulics::name_of(place)), power[place], "W");
  add("residual power, of the power of the pistons",
      hydraulics::left_over(power) / power[hydraulics::Place::pistons], "");
  const hydraulics::PumpPower oil = hydraulics::pump_power(power);
  add("power of the flow to the load", oil.useful, "W");
  add("power lost in the oil", oil.lost(), "W");
  const double torque = mean(point.analytic, "Td_z1_Nm");
  add("mean drive torque, analytic", torque, "Nm");
  add("mean drive torque, multibody", mean(point.multibody, "Td_z1_Nm"), "Nm");
  const Efficiencies all = efficiencies(point.ready, oil, torque);
  for (const EfficiencyLine& line : efficiency_lines())
    if (is_computed(all.*line.value) && line.value != &Efficiencies::volumetric)
      add(std::string(line.name) + " efficiency", all.*line.value, "%");
  return text + "\n" + timing_text(*document.timing) + "\n" +
         report::warnings_text(*document.warnings);
}

}  // namespace bentaxis::study
