#include <cmath>
#include <limits>

#include "bentaxis/study/failed_points.h"
#include "bentaxis/study/inertia_document.h"
#include "bentaxis/study/published_section.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct InertiaCommandOptions {
  CaseOption the_case;
  ReportPlace place;
  std::string speeds;
  std::vector<double> map_speeds, map_factors = {0.25, 8};  // from, to
  study::InertiaOptions study;
};

std::pair<double, double> range_of(const std::vector<double>& range, const std::string& option) {
  if (range.size() != 2 || !(range[0] > 0) || !(range[1] > range[0]) || !std::isfinite(range[1]))
    throw InputError(option + ": must be FROM,TO with 0 < FROM < TO");
  return {range[0], range[1]};
}

int run(const InertiaCommandOptions& options) {
  const Case as_read = options.the_case.read();
  ReportFolders folders(options.place);
  const study::InertiaStudy result = study::run_inertia_study(as_read, options.study, progress_of);
  const auto data = shipped_reference_data();
  const auto published =
      study::printed_numbers_of(data ? *data / "published" : "",
                                {study::facts_of(result.the_case, result.the_case.analytic)});
  std::optional<compare::PublishedSection> judged;
  if (published) judged = study::judge_inertia(result, published->numbers);
  study::InertiaReport report =
      study::inertia_report(result, std::move(judged), versions(), described(result.the_case));
  study::add_warnings(report.document, result.failed);
  folders.publish("inertia", study::inertia_text(result), report.document,
                  {{"inertia.csv", study::inertia_curves_csv(result)},
                   {"inertia_errors.csv", study::inertia_errors_csv(result)},
                   {"inertia_map.csv", study::inertia_map_csv(result.map)}},
                  report.curves);
  return status_of_series(result.agrees() ? kDone : kOutOfTolerance, result.failed,
                          options.study.speeds.size());
}

}  // namespace

Command add_inertia_command(CommandParser program) {
  auto options = std::make_shared<InertiaCommandOptions>();
  auto command = program.subcommand(
      "inertia", "Error of the reactions from treating the pistons as two point masses");
  add_case(command, options->the_case);
  add_report(command, options->place, "inertia.html, inertia.json and the curves");
  add_values(command, "--speeds", options->speeds, "shaft speeds, rpm", "1500,2350");
  command.choice("--map", options->study.map_axis, {"mass", "length"},
                 "what increases along the map besides the speed: the piston's mass or its length");
  command.option("--map-speeds", options->map_speeds,
                 Values("FROM,TO [slowest / 3, 3 x fastest]").list(),
                 "range of speed of the map, rpm");
  command.option("--map-factors", options->map_factors, Values("FROM,TO [0.25,8]").list(),
                 "range of the factor on mass or length");
  command.option("--map-size", options->study.map_size, Values::integers(2, 100),
                 "values along each side of the map");
  return {command, [options] {
            study::InertiaOptions& study = options->study;
            if (!options->speeds.empty())
              study.speeds = values_in("--speeds", options->speeds, "rpm",
                                       -std::numeric_limits<double>::infinity());
            study.map_factors = range_of(options->map_factors, "--map-factors");
            if (!options->map_speeds.empty())
              study.map_speeds = range_of(options->map_speeds, "--map-speeds");
            return run(*options);
          }};
}

}  // namespace bentaxis::cli
