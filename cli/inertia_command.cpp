#include <cmath>
#include <cstdio>
#include <memory>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/inertia_document.h"
#include "bentaxis/study/published_section.h"
#include "commands.h"
#include "console.h"
#include "data_folder.h"
#include "options.h"
#include "report_files.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

struct Options {
  CaseOption the_case;
  std::string out = "out";
  std::vector<double> map_speeds, map_factors = {0.25, 8};  // from, to
  study::InertiaOptions study;
};

std::pair<double, double> range_of(const std::vector<double>& range, const std::string& option) {
  if (range.size() != 2 || !(range[0] > 0) || !(range[1] > range[0]) || !std::isfinite(range[1]))
    throw InputError(option + ": must be FROM,TO with 0 < FROM < TO");
  return {range[0], range[1]};
}

int run(const Options& options) {
  const Case as_read = options.the_case.read();
  OutputFolder folder(options.out);
  const study::InertiaStudy result = study::run_inertia_study(as_read, options.study, progress_of);
  const auto data = shipped_reference_data();
  const auto published =
      study::printed_numbers_of(data ? *data / "published" : "",
                                {study::facts_of(result.the_case, result.the_case.analytic)});
  const study::InertiaReport report =
      study::inertia_report(result, published ? &published->numbers : nullptr, versions());
  const auto paths = write_report(folder, "inertia", report.document, report.curves,
                                  {{"inertia.csv", study::inertia_curves_csv(result)},
                                   {"inertia_errors.csv", study::inertia_errors_csv(result)},
                                   {"inertia_map.csv", study::inertia_map_csv(result.map)}});
  std::printf("%s\n", study::inertia_text(result).c_str());
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return result.agrees() ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_inertia_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "inertia", "What treating the pistons as two point masses does to the reactions");
  add_case(*command, options->the_case);
  add_out(*command, options->out, "inertia.html, inertia.json and the curves");
  command->add_option("--speeds", options->study.speeds, "speeds to study, rpm")
      ->delimiter(',')
      ->option_text("NUMBER[,NUMBER..] [1500,2350]");
  command
      ->add_option("--map", options->study.map_axis,
                   "what grows along the map beside the speed: the piston's mass or its length")
      ->transform(CLI::CheckedTransformer(std::map<std::string, study::MapAxis>{
          {"mass", study::MapAxis::mass}, {"length", study::MapAxis::length}}))
      ->option_text("mass|length [mass]");
  command->add_option("--map-speeds", options->map_speeds, "range of speed of the map, rpm")
      ->delimiter(',')
      ->option_text("FROM,TO [slowest / 3, 3 x fastest]");
  command
      ->add_option("--map-factors", options->map_factors, "range of the factor on mass or length")
      ->delimiter(',')
      ->option_text("FROM,TO [0.25,8]");
  command->add_option("--map-size", options->study.map_size, "values along each side of the map")
      ->check(CLI::Range(2, 100))
      ->option_text("NUMBER [30]");
  return {command, [options] {
            study::InertiaOptions& study = options->study;
            study.map_factors = range_of(options->map_factors, "--map-factors");
            if (!options->map_speeds.empty())
              study.map_speeds = range_of(options->map_speeds, "--map-speeds");
            return run(*options);
          }};
}

}  // namespace bentaxis::cli
