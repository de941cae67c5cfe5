#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "assumptions.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/report/page.h"
#include "bentaxis/report/report.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/calibration.h"
#include "channel_choice.h"
#include "commands.h"
#include "console.h"
#include "hydraulic_case.h"
#include "hydraulic_report.h"
#include "models.h"
#include "published_section.h"
#include "pump_report.h"
#include "rounding_report.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

constexpr double kDrivenTolerance = 1e-9;       // of peak; both models are exact to round-off
constexpr double kIntegratedFactor = 100;       // achieved error over Simbody's accuracy per step
constexpr double kDrivenRestTolerance = 1e-10;  // of what no assumption explains, of peak

struct Options {
  std::string case_file, out = "out";
  std::string multibody_case;  // another case for the multibody model; empty = the same
  double tolerance = 0;        // 0 = default for the way
  Way way = Way::driven;
  multibody::IntegrationOptions integration;
  std::vector<double> accuracies;  // integrated: all are run, the last is reported in full
  multibody::SceneChoice scene;    // driven
  ChannelChoice channels;
  ErrorTarget target;  // integrated: chooses integrator and accuracy instead
  std::string choice;  // what was chosen for the target
  std::vector<std::string> analytic, multibody;  // KEY=VALUE assumptions
};

// One comparison with everything it needs.
struct Study {
  Case analytic_case, multibody_case;
  PressureTrace pressure, multibody_pressure;
  Samples samples, multibody_samples;
  double tolerance = 0;
  ResultTable analytic, multibody;
};

ResultTable run_multibody(const Study& study, const Options& options, double accuracy,
                          multibody::IntegrationRecord* record) {
  const Case& the_case = study.multibody_case;
  multibody::IntegrationOptions integration = options.integration;
  integration.accuracy = accuracy;
  return run_model("multibody", the_case, the_case.multibody, study.multibody_samples,
                   study.multibody_pressure, options.way, integration, record, options.scene);
}

// The analytic torque as a function of the shaft angle, for the torque-driven run.
std::function<double(double)> analytic_torque(const Study& study, const Assumptions& assumptions) {
  auto model = std::make_shared<analytic::Model>(study.analytic_case.pump, assumptions);
  auto values = std::make_shared<std::vector<double>>(model->layout().size());
  auto instant = std::make_shared<Instant>();
  instant->ports = study.samples.ports;
  instant->chamber_pressure.resize(study.samples.pistons);
  return [=, &study](double theta_deg) {
    instant->turn(radians(std::fmod(theta_deg, 360.0)), study.samples.omega);
    for (int k = 1; k <= study.samples.pistons; ++k)
      instant->chamber_pressure[k - 1] =
          study.pressure(piston_angle_deg(theta_deg, k, study.samples.pistons));
    model->reactions(*instant, *values);
    return (*values)[model->layout().Td()];
  };
}

double worst_of_group(const compare::Comparison& comparison, const std::string& group) {
  double worst = 0;
  for (const auto& c : comparison.channels)
    if (c.channel.group == group && c.verdict != compare::Verdict::not_computed)
      worst = std::max(worst, c.largest_over_peak());
  return worst;
}

// Integrated runs at every accuracy asked for: achieved error, drift, work and cost. The last one's
// table is the one compared.
Json integrate_all(Study& study, const Options& options,
                   const compare::Options& comparison_options) {
  Json rows = Json::array();
  report::Lines facts;  // a list of pairs would become a JSON object
  const auto torque = analytic_torque(study, study.multibody_case.multibody);
  for (const double accuracy : options.accuracies) {
    multibody::IntegrationRecord record;
    study.multibody = run_multibody(study, options, accuracy, &record);
    const auto comparison =
        compare::compare_tables(study.analytic, study.multibody, comparison_options);
    multibody::IntegrationOptions integration = options.integration;
    integration.accuracy = accuracy;
    const auto free_shaft = multibody::run_torque_driven(
        study.multibody_case, study.multibody_case.multibody, study.multibody_samples,
        study.multibody_pressure, torque, integration, progress_of("torque-driven"));
    rows.push_back({accuracy, worst_of_group(comparison, "Rs"), worst_of_group(comparison, "Rc"),
                    std::max(worst_of_group(comparison, "Rb1"), worst_of_group(comparison, "Rb2")),
                    worst_of_group(comparison, "Rcs"), worst_of_group(comparison, "Td"),
                    record.whole.position_error, record.whole.velocity_error,
                    record.whole.gear_phase / kRadPerDegree, record.whole.work_residual,
                    free_shaft.whole.speed_error, record.steps, record.evaluations});
    facts = Json::array(
        {{"gear phase, worst (block minus shaft)",
          fmt::format("{:.2e} deg", record.whole.gear_phase / kRadPerDegree)},
         {"shaft angle against omega t, worst",
          fmt::format("{:.2e} deg", record.whole.shaft_angle / kRadPerDegree)},
         {"work of loads", fmt::format("{:.6g} J", record.work_of_loads)},
         {"work of the drive", fmt::format("{:.6g} J", record.work_of_drives)},
         {"kinetic energy gained", fmt::format("{:.3g} J", record.kinetic_energy_gained)},
         {"work unaccounted for", fmt::format("{:.3g} J", record.whole.work_residual)}});
  }
  if (!options.choice.empty()) facts.push_back(Json::array({"chosen", options.choice}));
  return {{{"title", "Integrated run and torque-driven run"},
           {"text",
            fmt::format("Integrator {}, {} revolution(s). Errors are the largest difference from "
                        "the analytic model over the peak. In the torque-driven run the shaft is "
                        "free and fed the analytic Td; its speed error is relative to omega. Facts "
                        "are of the last accuracy.",
                        study::name_of(options.integration.integrator),
                        study.multibody_case.operation.revolutions)},
           {"facts", facts},
           {"table",
            {{"columns",
              {"accuracy asked", "error Rs", "error Rc", "error Rb", "error Rcs", "error Td",
               "constraint error, m", "constraint rate error, m/s", "gear phase, deg",
               "work lost, J", "torque-driven speed error", "steps", "evaluations"}},
             {"rows", rows}}}}};
}

report::Lines assumption_lines(const Assumptions& a) {
  return {{"piston friction", a.piston_friction ? "on" : "off"},
          {"piston inertia", to_string(a.inertia)},
          {"gear", to_string(a.gear)}};
}

// Takes the difference apart where the models' assumptions differ.
struct SplitResult {
  std::vector<report::AssumptionRow> rows;
  std::optional<compare::Split> split;
};

SplitResult split_assumptions(const Study& study, const compare::ZeroScales& scales,
                              double tolerance) {
  const Assumptions from = study.analytic_case.analytic;
  const Assumptions to = study.multibody_case.multibody;
  SplitResult result;
  using Change = void (*)(Assumptions&, const Assumptions&);
  std::vector<Change> changes;
  std::vector<std::string> names;
  const auto from_lines = assumption_lines(from);
  const auto to_lines = assumption_lines(to);
  const Change all_changes[] = {
      [](Assumptions& a, const Assumptions& b) { a.piston_friction = b.piston_friction; },
      [](Assumptions& a, const Assumptions& b) { a.inertia = b.inertia; },
      [](Assumptions& a, const Assumptions& b) { a.gear = b.gear; }};
  for (std::size_t i = 0; i < from_lines.size(); ++i) {
    if (from_lines[i].second == to_lines[i].second) continue;
    result.rows.push_back({from_lines[i].first, from_lines[i].second, to_lines[i].second});
    names.push_back(from_lines[i].first);
    changes.push_back(all_changes[i]);
  }
  if (names.empty()) return result;
  const auto variant = [&](unsigned mask) {
    Assumptions assumptions = from;
    for (std::size_t i = 0; i < changes.size(); ++i)
      if ((mask & (1U << i)) != 0) changes[i](assumptions, to);
    return analytic::run(study.analytic_case, assumptions, study.samples);
  };
  result.split =
      compare::split_difference(study.analytic, study.multibody, names, variant, scales, tolerance);
  return result;
}

std::string headline(const compare::Comparison& comparison, const SplitResult& split, bool agrees) {
  const auto* worst = comparison.worst();
  const std::string where =
      worst == nullptr ? ""
                       : fmt::format("{} at {:g} deg: {:.1e} of its peak", worst->channel.name,
                                     worst->theta_of_largest_deg, worst->largest_over_peak());
  if (split.split)
    return fmt::format(
        "{} The models make different assumptions and differ by up to {}. {}, {:.1e} of peak is "
        "left (tolerance {:g}).",
        agrees ? "Explained." : "Not explained.", where,
        agrees ? "After accounting for each assumption" : "Each assumption accounted for",
        split.split->largest_rest(), split.split->tolerance);
  return fmt::format("{} Largest difference {} (tolerance {:g}).",
                     agrees ? "The two models agree." : "The two models differ.", where,
                     comparison.tolerance);
}

void check_same_run(const Case& first, const Case& second) {
  const auto differs = [&](const char* what) {
    throw InputError(second.file.string() + ": must have the same " + what + " as " +
                     first.file.string());
  };
  if (first.pump.geometry.pistons != second.pump.geometry.pistons) differs("number of pistons");
  if (first.operation.samples_per_revolution != second.operation.samples_per_revolution)
    differs("samples_per_revolution");
  if (first.operation.revolutions != second.operation.revolutions) differs("revolutions");
}

// Integrator and accuracy for the error asked for, verified over the whole run.
void choose_integration(const Study& study, Options& options) {
  const Case& the_case = study.multibody_case;
  const study::VerifiedRun verified = study::run_to_error(
      the_case, the_case.multibody, study.multibody_samples, study.multibody_pressure,
      options.target.error, options.target.integrators(), progress_of);
  options.integration = verified.calibration.chosen;
  options.accuracies = {verified.calibration.chosen.accuracy};
  options.choice = verified.text();
}

int compare(Options options) {
  Case first = read_case(options.case_file);
  Case second = options.multibody_case.empty() ? first : read_case(options.multibody_case);
  for (const auto& text : options.analytic) apply_assumption(text, first.pump, first.analytic);
  for (const auto& text : options.multibody) apply_assumption(text, second.pump, second.multibody);
  check_same_run(first, second);
  OutputFolder folder(options.out);
  // The same case is solved once: both models get the very same curve.
  const bool same_case = options.multibody_case.empty();
  ReadyCase ready = with_pressure(std::move(first));
  first = std::move(ready.the_case);
  if (same_case)
    second.pressure = first.pressure;
  else
    second = with_pressure(std::move(second)).the_case;

  const bool integrated = options.way == Way::integrated;
  const ChannelLayout layout(first.pump.geometry.pistons);
  if (!integrated) options.scene = options.channels.scene_for(layout, options.scene);
  const auto wanted_channels = options.channels.of(layout);
  const auto wanted = [&](const Channel& channel) { return options.channels.wants(channel); };
  PressureTrace pressure(first.pressure);
  PressureTrace second_pressure(second.pressure);
  Samples samples = samples_of(first, pressure, options.way);
  Samples second_samples = samples_of(second, second_pressure, options.way);
  Study study{std::move(first),
              std::move(second),
              std::move(pressure),
              std::move(second_pressure),
              std::move(samples),
              std::move(second_samples),
              0,
              {},
              {}};
  const Case& the_case = study.analytic_case;
  const int n = the_case.pump.geometry.pistons;

  if (options.target.error > 0) {
    options.target.refuse_unless(integrated);
    choose_integration(study, options);
  }
  study.tolerance = options.tolerance > 0      ? options.tolerance
                    : options.target.error > 0 ? options.target.error
                    : integrated               ? kIntegratedFactor * options.accuracies.back()
                                               : kDrivenTolerance;
  compare::Options comparison_options;
  comparison_options.tolerance = study.tolerance;
  comparison_options.orders = {n, 2 * n};
  comparison_options.zero_scales = study::zero_scales(the_case, study.samples);

  study.analytic =
      analytic::run(the_case, the_case.analytic, study.samples, progress_of("analytic"));
  Json runs = Json::array();
  if (integrated)
    runs = integrate_all(study, options, comparison_options);
  else
    study.multibody = run_multibody(study, options, 0, nullptr);

  auto comparison = compare::compare_tables(study.analytic, study.multibody, comparison_options);
  std::erase_if(comparison.channels, [&](const auto& c) { return !wanted(c.channel); });
  std::vector<compare::Check> checks =
      compare::judge_checks(study.analytic, comparison_options.zero_scales, study.tolerance);
  for (auto& check :
       compare::judge_checks(study.multibody, comparison_options.zero_scales, study.tolerance))
    checks.push_back(std::move(check));
  const SplitResult split = split_assumptions(
      study, comparison_options.zero_scales,
      integrated ? study.tolerance : std::min(study.tolerance, kDrivenRestTolerance));
  if (split.split) compare::mark_explained(comparison, *split.split);
  const bool checks_hold =
      std::all_of(checks.begin(), checks.end(), [](const auto& check) { return check.holds(); });
  const bool agrees = checks_hold && (split.split ? split.split->explained() : comparison.agrees());

  // Fig. 32 with and without the block's viscous torque.
  std::vector<ResultTable> without_viscous;
  if (the_case.pump.friction.block_viscous > 0 && !integrated &&
      options.scene.scene == multibody::Scene::full) {
    Case still = the_case;
    still.pump.friction.block_viscous = 0;
    without_viscous.push_back(analytic::run(still, the_case.analytic, study.samples));
    Case still_second = study.multibody_case;
    still_second.pump.friction.block_viscous = 0;
    without_viscous.push_back(multibody::run_driven(
        still_second, still_second.multibody, study.multibody_samples,
        progress_of("multibody, Cc = 0"), options.scene.scene, options.scene.method));
  }

  const auto published =
      published_section({&the_case, the_case.analytic, &study.analytic},
                        {&study.multibody_case, study.multibody_case.multibody, &study.multibody});
  const auto limits =
      analytic::check_validity(the_case, the_case.analytic, study.samples, study.analytic);
  const auto* worst = comparison.worst();
  Json report = {
      {"schema", 1},
      {"title", the_case.name},
      {"program", versions()},
      {"case", case_section(the_case)},
      {"derived", derived_section(the_case)},
      {"verdict",
       {{"agrees", agrees},
        {"headline", headline(comparison, split, agrees)},
        {"tolerance", study.tolerance},
        {"compared", comparison.compared()},
        {"checks_hold", checks_hold},
        {"digits", worst != nullptr ? Json(worst->digits) : Json()},
        {"worst", worst != nullptr ? Json{{"channel", worst->channel.name},
                                          {"max_over_peak", worst->largest_over_peak()},
                                          {"theta_deg", worst->theta_of_largest_deg}}
                                   : Json()}}},
      {"meaning",
       "Two models that agree have solved the same equations correctly: that is verification. It "
       "says nothing about what both leave out or share (tables below). Whether a real pump "
       "behaves "
       "so is validation, and needs measurements."},
      {"warnings", warnings_section(limits)},
      {"common", common_section(the_case)},
      {"validity", validity_section(limits)},
      {"models",
       Json::array({report::model_section(study.analytic, assumption_lines(the_case.analytic)),
                    report::model_section(study.multibody,
                                          assumption_lines(study.multibody_case.multibody))})},
      {"channels", report::channel_rows(comparison)},
      {"checks", report::check_rows(checks)},
      {"assumptions", nullptr},
      {"published", published ? report::published_section(*published) : Json()},
      {"runs", runs},
      {"figures", figures_of(wanted_channels,
                             figures_section(study.analytic, study.multibody, without_viscous))}};
  if (ready.hydraulics) {
    report["runs"].push_back(hydraulic_block(the_case, *ready.hydraulics));
    for (Json& figure : hydraulic_figures(the_case, *ready.hydraulics))
      report["figures"].push_back(std::move(figure));
    folder.add("pressure.csv", to_csv(ready.hydraulics->table));
  }
  const auto rounding = rounding_lines(the_case, the_case.analytic);
  report["runs"].push_back(rounding_block(rounding));
  for (const auto& text : rounding_warnings(rounding))
    report["warnings"].push_back({{"name", "digits lost to rounding"}, {"text", text}});
  if (!integrated)
    for (const auto& text : multibody_warnings(study.multibody_case, study.multibody_case.multibody,
                                               options.scene, rounding))
      report["warnings"].push_back({{"name", "digits lost in Simbody"}, {"text", text}});
  if (split.split) {
    report["verdict"]["word"] = agrees ? "Explained" : "Not explained";
    report["verdict"]["rest_over_peak"] = split.split->largest_rest();
    report["verdict"]["rest_tolerance"] = split.split->tolerance;
    report["assumptions"] = report::split_section(
        *split.split, split.rows,
        "The models were asked to assume different things. Each assumption's contribution is its "
        "effect in the analytic model, averaged over the orders in which the assumptions can be "
        "taken over; what is left is a difference between the models themselves.");
  }

  const Json curves = report::curve_section(study.analytic, study.multibody);
  folder.add("report.html", report::render_page(the_case.name, report, curves));
  folder.add("report.json", report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  folder.add("analytic.csv", to_csv(select_channels(study.analytic, wanted)));
  folder.add("multibody.csv", to_csv(select_channels(study.multibody, wanted)));
  const auto paths = folder.commit();

  std::printf("%s\n%s\n\n%s", the_case.name.c_str(),
              report["verdict"]["headline"].get<std::string>().c_str(),
              report::text_table(comparison).c_str());
  if (!options.choice.empty()) std::printf("chosen %s\n", options.choice.c_str());
  for (const auto& check : checks)
    std::printf("%s: %s: %.1e of scale, %s\n", check.table.c_str(), check.name.c_str(),
                check.relative(), check.holds() ? "holds" : "violated");
  for (const auto& warning : report["warnings"])
    std::printf("warning: %s: %s\n", warning["name"].get<std::string>().c_str(),
                warning["text"].get<std::string>().c_str());
  if (published) std::printf("published numbers: %s\n", published->section.summary.text().c_str());
  std::printf("\n");
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return agrees ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_compare_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("compare", "Run both models and report where and by how much they differ");
  add_case(*command, options->case_file);
  add_out(*command, options->out, "report.html, report.json and the curves");
  command
      ->add_option("--tolerance", options->tolerance,
                   "largest difference over peak that counts as agreement")
      ->check(positive_number())
      ->option_text("NUMBER [1e-9 driven, 100 x accuracy integrated]");
  add_way(*command, options->way);
  options->channels.add_to(*command, add_scene(*command, options->scene));
  CLI::Option* integrator = add_integrator(*command, options->integration);
  CLI::Option* accuracy =
      command
          ->add_option("--accuracy", options->accuracies,
                       "accuracies of an integrated run; all are tabled, the last is compared")
          ->delimiter(',')
          ->check(accuracy_range())
          ->option_text("NUMBER[,NUMBER..] [1e-4,1e-6]");
  add_error(*command, options->target, options->integration, integrator, accuracy);
  command
      ->add_option("--analytic", options->analytic,
                   "assumption of the analytic model: piston_friction=on|off, "
                   "inertia=lumped|real|dynamically_equivalent, gear=mesh|imposed; overrides the "
                   "case file")
      ->option_text("KEY=VALUE ..");
  command->add_option("--multibody", options->multibody, "the same for the multibody model")
      ->option_text("KEY=VALUE ..");
  command
      ->add_option("--multibody-case", options->multibody_case,
                   "give the multibody model another case: what would a wrong input do?")
      ->option_text("CASE");
  return {command, [options] {
            if (options->accuracies.empty()) options->accuracies = {1e-4, 1e-6};
            return compare(*options);
          }};
}

}  // namespace bentaxis::cli
