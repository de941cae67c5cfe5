#include "bentaxis/designs/timing_advice_section.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/derived_displacement.h"
#include "bentaxis/study/displacement_section.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/pressure_document.h"
#include "bentaxis/study/spaced_values.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

constexpr int kMaxTestPoints = 100;  // speeds, pressures of a test of the displacement

struct PressureOptions {
  CaseOption the_case;
  ReportPlace place;
  std::string overlay, published, delivery, suction_speed, test_speeds, test_pressures;
  int transient = 0;
  bool advise = false, derived_displacement = false;
};

constexpr const char* kFilling = "filling";  // of --suction-speed

// saturation, vapour or a pressure in bar.
double suction_limit(const std::string& text, const HydraulicData& data) {
  if (text == "saturation") return data.saturation_pressure;
  if (text == "vapour") return data.vapour_pressure - data.atmosphere;
  const auto value = number_in(text);
  if (!value || !(pascals(*value) > -data.atmosphere))
    throw InputError(
        "--suction-speed " + text +
        ": must be filling, saturation, vapour or a gauge pressure in bar, above absolute zero");
  return pascals(*value);
}

// Speeds (rpm) and pressures (bar) of a test of the displacement.
struct DisplacementTest {
  std::vector<double> speeds, pressures;
};

std::optional<DisplacementTest> displacement_test(const PressureOptions& options,
                                                  const Case& the_case) {
  if (!options.derived_displacement) {
    if (!options.test_speeds.empty() || !options.test_pressures.empty())
      throw InputError("--test-speeds and --test-pressures need --derived-displacement");
    return std::nullopt;
  }
  study::require_pressure_asked_for(the_case);
  constexpr double kMinSpeed = 1;  // rpm
  DisplacementTest test = {study::usual_test_speeds(the_case),
                           study::usual_test_pressures(the_case)};
  if (!options.test_speeds.empty())
    test.speeds = study::spaced_values("--test-speeds", options.test_speeds, "rpm", kMinSpeed,
                                       kMaxTestPoints);
  if (!options.test_pressures.empty())
    test.pressures =
        study::spaced_values("--test-pressures", options.test_pressures, "bar", 0, kMaxTestPoints);
  if (test.pressures.size() < 2)
    throw InputError("--test-pressures " + options.test_pressures +
                     ": must be two pressures at least");
  return test;
}

int pressure(const PressureOptions& options) {
  Case read = options.the_case.read();
  study::require_hydraulic(read);
  std::optional<Case> second;
  if (!options.overlay.empty()) {
    second = read_case(options.overlay);
    study::require_hydraulic(*second);
  }
  std::optional<compare::Published> published;
  if (!options.published.empty()) published = compare::read_published(options.published);
  std::vector<double> pressures;
  if (!options.delivery.empty())
    pressures = values_in("--delivery-bar", options.delivery, "bar", 0);
  std::optional<double> limit;
  if (!options.suction_speed.empty() && options.suction_speed != kFilling)
    limit = suction_limit(options.suction_speed, *read.hydraulics);
  const auto test = displacement_test(options, read);
  ReportFolders folders(options.place);

  const study::OperatingPoint point = study::run_point(std::move(read), progress_of);
  const auto power = hydraulics::power_by_place(point.state(), progress_of("power by place"));
  report::Document document =
      study::pressure_document(point, power, versions(), described(point.the_case()));
  // A limit on the pressure alone does not say whether the chambers fill.
  if (options.suction_speed == kFilling || (limit && point.state().timing.filled))
    study::add_suction_speed(document, point,
                             study::filling_speed(point.the_case(), progress_of("filling speed")));
  if (limit)
    study::add_suction_speed(
        document, point,
        study::suction_speed(point.the_case(), *limit, progress_of("suction speed")));
  if (options.advise)
    designs::add_advice(
        document, designs::timing_advice(point.the_case(), point.state(), progress_of("advice")));
  options.the_case.refuse_timing(study::timing_warnings(*document.timing));
  if (published) study::add_published(document, study::judge_point(*published, point, progress_of));
  if (second)
    study::add_overlay(document, point, study::run_point(std::move(*second), progress_of));
  std::vector<TextFile> curves = text_files(study::pressure_csv(point, power));
  std::optional<study::DisplacementStudy> displacement;
  if (test) {
    displacement = study::displacement_study(point.the_case(), test->speeds, test->pressures,
                                             progress_of("derived displacement"));
    study::add_displacement(document, *displacement);
    curves.emplace_back("derived_displacement.csv", to_csv(*displacement));
  }
  std::optional<study::TorqueCurve> curve;
  if (!pressures.empty()) {
    curve = study::torque_curve(point.the_case(), pressures, progress_of("torque curve"));
    study::add_curve(document, *curve);
    curves.emplace_back("torque_curve.csv", to_csv(*curve));
  }
  if (options.transient > 0) {
    const ResultTable transient =
        hydraulics::transient_from_rest(point.the_case(), point.state().summary.load_size,
                                        options.transient, 72, progress_of("transient"));
    study::add_transient(document, transient);
    curves.emplace_back("transient.csv", to_csv(transient));
  }
  std::string text = study::pressure_text(point, power, document);
  if (published) text += "\n" + study::text_of(document.published->section);
  if (displacement) text += "\n" + study::displacement_text(*displacement);
  if (curve) text += "\n" + torque_curve_text(*curve);
  folders.publish("pressure", text, document, curves,
                  report::curves_of(point.analytic, point.multibody));
  const bool held = !published || document.published->section.calibrated();
  int status = held ? kDone : kOutOfTolerance;
  if (displacement) status = status_of_series(status, displacement->failed, displacement->asked);
  return curve ? status_of_series(status, curve->failed, pressures.size()) : status;
}

}  // namespace

Command add_pressure_command(CommandParser program) {
  auto options = std::make_shared<PressureOptions>();
  auto command = program.subcommand(
      "pressure", "Compute chamber and delivery pressures, flows and the torque they need");
  add_case(command, options->the_case);
  add_report(command, options->place, "pressure.html, pressure.json and the curves");
  add_values(command, "--delivery-bar", options->delivery,
             "delivery pressures, bar; also mean torque and flow at these. 0 is an open line");
  command.option("--overlay", options->overlay, Values::case_file("CASE"),
                 "another hydraulic case, drawn into one figure with the first over three turns");
  command.option(
      "--published", options->published, "FILE",
      "printed numbers to set the results against; a calibrated one outside: exit status 1");
  command.option(
      "--suction-speed", options->suction_speed, "filling|saturation|vapour|BAR",
      "also the largest speed at which the chambers fill (at most 1 % of a stroke lost). With "
      "another word also the largest speed at which no chamber falls below that pressure: "
      "dissolved "
      "air is released (saturation), oil boils (vapour), or the given gauge pressure in bar. 10 to "
      "30 operating points each");
  command.flag("--advise", options->advise,
               "also which key to change, and by how much, for each port timing quantity that "
               "exceeds its limit: some 70 operating points");
  command.flag("--derived-displacement", options->derived_displacement,
               "also the displacement as test rigs derive it from flows (ISO 8426, Toet, Wilson, "
               "zero-pressure line) against the geometric one: a test of 30 operating points");
  const Values range = "FROM:TO:STEP|FROM:TO:#N";
  command.option("--test-speeds", options->test_speeds, range,
                 "its speeds, in rpm; without it five from a fifth to the whole of the case's");
  command.option("--test-pressures", options->test_pressures, range,
                 "its delivery pressures, in bar; without it six from 5 to 100 % of the case's");
  command.option("--transient", options->transient, Values::integers(1, 1000, "TURNS"),
                 "also the transient from rest over so many turns");
  return {command, [options] { return pressure(*options); }};
}

}  // namespace bentaxis::cli
