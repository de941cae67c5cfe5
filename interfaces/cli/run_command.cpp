#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/study/lost_digits.h"
#include "bentaxis/study/row_stream.h"
#include "bentaxis/study/run.h"
#include "bentaxis/study/state_doubts.h"
#include "bentaxis/study/timing.h"
#include "bentaxis/study/transfer_summary.h"
#include "bentaxis/study/turn_summary.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct RunCommandOptions {
  CaseOption the_case;
  std::string out = "out";
  study::Model model = study::Model::analytic;
  RunChoice choice;
  std::string gear;    ///< "", "mesh" or "imposed"
  std::string states;  ///< file with the motion; "": constant speed
};

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "bentaxis: warning: %s\n", warning.c_str());
}

// What was found, then the files.
int finish(OutputFolder& folder, const std::string& name, const std::vector<std::string>& answers) {
  const auto paths = folder.commit();
  std::printf("%s\n", name.c_str());
  for (const std::string& answer : answers) std::printf("%s\n", answer.c_str());
  print_files(paths);
  return kDone;
}

// Reactions at given states.
int run_states(const RunCommandOptions& options, const study::PreparedCase& ready,
               const study::RunOptions& run_options, const study::ChannelChoice& channels,
               OutputFolder& folder) {
  std::vector<Channel> there = ChannelLayout(ready.the_case.pump).channels();
  for (const Channel& channel : motion_channels()) there.push_back(channel);
  channels.of(there);  // refuses unknown names
  const States states = read_states(options.states, ready.the_case, ready.pressure);
  const auto doubts = study::state_doubts(ready.the_case, states);
  options.the_case.refuse(doubts, options.states + ": implausible states, and --strict");
  for (const auto& doubt : doubts) warn({doubt.name + ": " + doubt.text});
  ResultTable teeth;
  MotionTable table = study::run_states(ready, states, run_options, progress_of,
                                        run_options.teeth ? &teeth : nullptr);
  const study::TurnSummary summary(table.results);
  table.results = select_channels(table.results,
                                  [&](const Channel& channel) { return channels.wants(channel); });
  const std::string name = to_string(options.model);
  folder.add(name + ".csv", to_csv(table));
  if (run_options.teeth) folder.add("teeth_" + name + ".csv", to_csv(teeth));
  std::vector<std::string> answers = summary.answers();
  for (std::string& answer : answers)
    answer.insert(0, "Of these " + std::to_string(table.results.rows()) + " states: ");
  answers.emplace_back(
      "Limits of validity (film force, its place, tooth flank, bearing) are checked over turns at "
      "constant speed, not at given states.");
  return finish(folder, ready.the_case.name, answers);
}

int run(const RunCommandOptions& options) {
  const bool analytic = options.model == study::Model::analytic;
  const bool driven = options.choice.way == study::Way::driven;
  const bool states = !options.states.empty();
  options.choice.refuse_without_effect(!analytic, states);
  Case read = options.the_case.read();
  OutputFolder folder(options.out);
  const study::PreparedCase ready = study::prepare(std::move(read), progress_of);
  Assumptions assumptions = ready.assumptions(options.model);
  if (!options.gear.empty())
    assumptions.gear = options.gear == "imposed" ? BlockDrive::imposed : BlockDrive::mesh;

  const study::ChannelChoice channels = options.choice.channels();
  const auto wanted = [&](const Channel& channel) { return channels.wants(channel); };
  study::RunOptions run_options;
  run_options.model = options.model;
  run_options.assumptions = assumptions;
  run_options.way = options.choice.way;
  std::vector<std::string> warnings;
  if (ready.hydraulics) {
    const auto timing =
        study::timing_warnings(study::timing_rows(ready.the_case, *ready.hydraulics));
    options.the_case.refuse_timing(timing);
    for (const auto& warning : timing) warnings.push_back(warning.name + ": " + warning.text);
  }
  const bool toothed = ready.the_case.pump.gear.contact == ToothContact::teeth &&
                       assumptions.gear == BlockDrive::mesh;
  if (states) {
    run_options.scene.method = options.choice.method();
    run_options.teeth = toothed;
    warn(warnings);
    return run_states(options, ready, run_options, channels, folder);
  }
  if (analytic)
    channels.of(ChannelLayout(ready.the_case.pump));  // refuses unknown names
  else
    run_options.scene = options.choice.scene_for(ready.the_case);
  run_options.integration = options.choice.integration;
  if (!options.choice.accuracies.empty())
    run_options.integration.accuracy = options.choice.accuracies.back();
  run_options.target = options.choice.target();

  const auto lines = study::rounding_lines(ready.the_case, assumptions);
  warn(study::rounding_warnings(lines));
  if (!analytic && driven)
    warn(study::multibody_warnings(ready.the_case, assumptions, run_options.scene, lines));
  warn(warnings);

  run_options.teeth = toothed && driven && run_options.scene.scene == multibody::Scene::full;
  std::vector<std::string> answers;
  if (analytic && !run_options.teeth) {
    const PumpParameters& pump = ready.the_case.pump;
    study::TurnSummary summary(ChannelLayout(pump).channels());
    study::TransferSummary transfer(pump, ChannelLayout(pump).channels());
    study::stream_analytic(
        ready, assumptions, wanted, folder.open("analytic.csv"),
        [&](double theta_deg, const double* values) {
          summary.add(theta_deg, values);
          transfer.add(theta_deg, values);
        },
        progress_of);
    answers = summary.answers();
    append(answers, transfer.answers());
  } else {
    const study::ModelRun result = study::run(ready, run_options, progress_of);
    answers = study::TurnSummary(result.table).answers();
    append(answers, study::TransferSummary(ready.the_case.pump, result.table).answers());
    if (!result.choice.empty()) std::fprintf(stderr, "chosen %s\n", result.choice.c_str());
    const std::string name = to_string(options.model);
    folder.add(name + ".csv", to_csv(select_channels(result.table, wanted)));
    if (result.teeth) folder.add("teeth_" + name + ".csv", to_csv(*result.teeth));
  }
  if (std::string play = study::free_play_answer(ready.the_case.pump); !play.empty())
    answers.push_back(std::move(play));
  for (std::string& answer :
       study::limit_answers(study::limits_of_turn(ready.the_case, assumptions, ready.pressure)))
    // Of a smaller scene this run has not computed what they are about.
    answers.push_back(run_options.scene.scene == multibody::Scene::full || analytic
                          ? std::move(answer)
                          : "By the analytic model: " + answer);
  if (ready.hydraulics)
    answers.push_back(study::timing_answer(study::timing_rows(ready.the_case, *ready.hydraulics)));
  return finish(folder, ready.the_case.name, answers);
}

}  // namespace

Command add_run_command(CommandParser program) {
  auto options = std::make_shared<RunCommandOptions>();
  auto command = program.subcommand("run", "Run one model and write its curves as CSV");
  add_case(command, options->the_case);
  add_model(command, options->model).required().text("analytic|multibody");
  add_out(command, options->out, "the curves");
  command.option("--states", options->states, "FILE",
                 "CSV with the motion of shaft and block, and pressures where it has them: "
                 "reactions there instead of along a turn at constant speed");
  options->choice.add_to(command, false);
  command.option(
      "--gear", options->gear, Values::words({"mesh", "imposed"}, "mesh|imposed [mesh]"),
      "tooth force between shaft and block, or block speed imposed; overrides the case file");
  return {command, [options] { return run(*options); }};
}

}  // namespace bentaxis::cli
