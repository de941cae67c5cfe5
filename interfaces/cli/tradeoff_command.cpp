#include <algorithm>

#include "bentaxis/study/run.h"
#include "bentaxis/study/tradeoff_document.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct TradeoffCommandOptions {
  CaseOption the_case;
  ReportPlace place;
  study::TradeoffOptions tradeoff;
};

int tradeoff(const TradeoffCommandOptions& options) {
  const Case the_case = study::prepare(options.the_case.read(), progress_of).the_case;
  ReportFolders folders(options.place);
  const study::TradeoffStudy result =
      study::run_tradeoff_study(the_case, options.tradeoff, progress_of("tradeoff"));
  folders.publish("tradeoff", study::tradeoff_text(result),
                  study::tradeoff_document(result, versions(), described(result.the_case)),
                  {{"tradeoff.csv", study::tradeoff_csv(result)}});
  return kDone;
}

}  // namespace

Command add_tradeoff_command(CommandParser program) {
  auto options = std::make_shared<TradeoffCommandOptions>();
  study::TradeoffOptions& tradeoff_options = options->tradeoff;
  auto command = program.subcommand(
      "tradeoff", "Time every model, scene, integrator and accuracy on a case against its error");
  add_case(command, options->the_case);
  add_report(command, options->place, "tradeoff.html, tradeoff.json and tradeoff.csv");
  add_integrators(command, tradeoff_options.integrators);
  command.option("--accuracies", tradeoff_options.accuracies,
                 Values::accuracies("NUMBER[,NUMBER..] [1e-2,1e-3,..,1e-10]").list(),
                 "accuracies of integrated runs");
  command.option("--angles", tradeoff_options.samples_per_revolution,
                 Values::integers(1, 100000, "NUMBER [8 per piston]"),
                 "angles per turn at which results are taken; each ends a step");
  command.option("--max-seconds-per-run", tradeoff_options.max_seconds_per_run, Values::positive(),
                 "stop an integrated run that takes longer, and try no tighter accuracy");
  return {command, [options] {
            study::TradeoffOptions& o = options->tradeoff;
            if (o.integrators.empty()) o.integrators = study::all_integrators();
            if (o.accuracies.empty())
              o.accuracies = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
            std::sort(o.accuracies.rbegin(), o.accuracies.rend());
            return tradeoff(*options);
          }};
}

}  // namespace bentaxis::cli
