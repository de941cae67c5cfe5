#include "bentaxis/designs/life_document.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct LifeOptions {
  CaseOption the_case;
  ReportPlace place;
  std::string duty;
};

int life(const LifeOptions& options) {
  const Case the_case = options.the_case.read();
  const designs::DutyCycle duty = options.duty.empty()
                                      ? designs::DutyCycle()
                                      : designs::read_duty_cycle(options.duty, the_case);
  study::require_ratings(the_case);
  ReportFolders folders(options.place);
  const designs::LifeStudy result = designs::life_study(the_case, duty, progress_of);
  folders.publish("life", designs::life_text(result),
                  designs::life_document(result, versions(), described(result.the_case)),
                  {{"life.csv", designs::life_csv(result)},
                   {"life_loads.csv", designs::life_loads_csv(result)}});
  return status_of_series(result.agrees() ? kDone : kOutOfTolerance, result.failed,
                          duty.rows.size());
}

}  // namespace

Command add_life_command(CommandParser program) {
  auto options = std::make_shared<LifeOptions>();
  auto command =
      program.subcommand("life", "Rating life of the bearings after ISO 281, by both models");
  add_case(command, options->the_case);
  add_report(command, options->place, "life.html, life.json, life.csv and life_loads.csv");
  command.option("--duty", options->duty, "FILE",
                 "CSV: share of the time, and parameters such as speed_rpm,delivery_bar");
  return {command, [options] { return life(*options); }};
}

}  // namespace bentaxis::cli
