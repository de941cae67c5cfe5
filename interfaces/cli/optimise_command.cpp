#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bentaxis/designs/optimise_document.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "commands.h"
#include "console.h"
#include "options.h"
#include "ranks.h"
#include "report_files.h"
#include "sweep_options.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

struct OptimiseOptions {
  CaseOption the_case;
  ReportPlace place;
  std::vector<std::string> vary;
  std::string study, conditions;
  int population = 64, generations = 50, restarts = 2, seed = 1, threads = 0, samples = 100;
  bool no_refinement = false, resume = false;
  designs::OptimiseRequest request;
};

designs::OptimiseRequest request_of(const OptimiseOptions& options, const CommandParser& command) {
  designs::OptimiseRequest request;
  if (!options.study.empty()) request = designs::read_optimise_request(options.study);
  const auto varied = varied_of(options.vary);
  for (const auto& one : varied)
    std::erase_if(request.vary, [&](const auto& old) { return old.first == one.first; });
  const auto append = [](auto& to, const auto& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  append(request.vary, varied);
  append(request.minimise, options.request.minimise);
  append(request.maximise, options.request.maximise);
  append(request.outputs, options.request.outputs);
  append(request.subject_to, options.request.subject_to);
  if (!options.conditions.empty()) request.conditions = options.conditions;
  if (command.given("--model")) request.model = options.request.model;
  designs::SearchOptions& search = request.search;
  for (const auto& [name, value, to] :
       {std::tuple{"--population", options.population, &search.population},
        {"--generations", options.generations, &search.generations},
        {"--restarts", options.restarts, &search.restarts}})
    if (command.given(name)) *to = static_cast<std::size_t>(value);
  if (command.given("--samples")) request.samples = static_cast<std::size_t>(options.samples);
  if (command.given("--comparison")) request.comparison = options.request.comparison;
  if (command.given("--seed")) search.seed = static_cast<std::uint64_t>(options.seed);
  if (options.no_refinement) search.refine = false;
  return request;
}

int optimise(const OptimiseOptions& options, const CommandParser& command, const Ranks& ranks) {
  if (designs::search_libraries().empty())
    throw InputError(
        "optimise: this program was built without pagmo and NLopt; install libpagmo-dev and "
        "libnlopt-cxx-dev (scripts/setup full) and build again");
  const bool first = ranks.rank() == 0;
  const Case base =
      first ? options.the_case.read() : read_case(options.the_case.file, options.the_case.changes);
  const designs::Optimiser optimiser(base,
                                     designs::optimise_plan(request_of(options, command), base));
  const designs::SweepParts parts(parts_in(options.place.out),
                                  optimiser.record("bentaxis " BENTAXIS_VERSION));
  ranks.must_be_same(parts.record().identity, "case, plan or version");
  std::optional<ReportFolders> folders;
  std::optional<RunLock> lock;
  if (first) {
    folders.emplace(options.place);
    lock.emplace(parts.begin(RunLock::Kind::alone));
  }
  ranks.wait();
  designs::OptimiseWork work;
  work.threads = ranks.size() > 1 && options.threads == 0 ? 1 : options.threads;
  work.parts = &parts;
  work.resume = options.resume;
  work.rank = static_cast<std::size_t>(ranks.rank());
  work.ranks = static_cast<std::size_t>(ranks.size());
  work.sum = [&ranks](std::span<double> numbers) { ranks.add_up(numbers); };
  const auto say_kept = [&] {
    if (!first) return;
    if (const std::size_t kept = parts.count(); kept > 0) {
      const std::size_t singles = parts.count_singles();
      std::fprintf(
          stderr, "bentaxis: %zu of %zu batches%s are in %s: --resume goes on from them\n", kept,
          optimiser.batches(),
          singles > 0 ? (" and " + std::to_string(singles) + " single designs").c_str() : "",
          parts.folder().c_str());
    } else
      parts.remove(0);
  };
  try {
    const designs::Optimisation found = optimiser.run(work, progress_of("optimise"));
    if (!first) return kDone;
    if (options.resume)
      std::fprintf(stderr, "bentaxis: %zu batches%s were there already\n", found.kept,
                   found.kept_singles > 0
                       ? (" and " + std::to_string(found.kept_singles) + " single designs").c_str()
                       : "");
    std::vector<TextFile> files = text_files(designs::chosen_cases(found));
    files.emplace_back("front.csv", designs::front_csv(found));
    files.emplace_back("evaluations.csv", designs::evaluations_csv(found));
    const auto paths = folders->write(
        "report", designs::optimise_document(found, versions(), study::describe(base, progress_of)),
        {}, files);
    parts.remove(optimiser.batches());
    std::string text = designs::headline(found);
    for (const std::string& answer : designs::optimise_answers(found)) text += "\n" + answer;
    print_result(text, paths);
    return found.chosen.empty() ? kOutOfTolerance : kDone;
  } catch (const Interrupted&) {
    say_kept();
    if (ranks.size() > 1) throw;  // other ranks would wait for it
    return kInterrupted;
  } catch (...) {
    say_kept();
    throw;
  }
}

}  // namespace

Command add_optimise_command(CommandParser program) {
  auto options = std::make_shared<OptimiseOptions>();
  CommandParser command = program.subcommand(
      "optimise", "Find the best designs: objectives, constraints, any parameters");
  if (designs::search_libraries().empty()) command.lacks("pagmo and NLopt");
  add_case(command, options->the_case);
  add_report(command, options->place,
             "report.html, report.json, front.csv, evaluations.csv and chosen_N.toml");
  command
      .option("--vary", options->vary, "parameter that varies; with its range, or a list of values")
      .repeatable()
      .text("NAME=FROM:TO");
  const std::string names = "NAME[,NAME..]";
  designs::OptimiseRequest& request = options->request;
  command.option("--minimise", request.minimise, "outputs to minimise; see bentaxis outputs")
      .list()
      .text(names);
  command.option("--maximise", request.maximise, "outputs to maximise").list().text(names);
  command
      .option("--subject-to", request.subject_to,
              "what every design must keep, as \"timing.backflow.excess <= 0\"")
      .repeatable()
      .text("\"NAME <= NUMBER\"");
  command
      .option("--output", request.outputs, "outputs to compute; besides objectives and constraints")
      .list()
      .text(names);
  command
      .option("--conditions", options->conditions,
              "CSV: operating points with their share of the time, as a duty cycle of life")
      .text("FILE");
  command
      .option("--study", options->study,
              "study file; it holds the same as the options, which add to it")
      .text("FILE");
  command.option("--population", options->population, "designs evaluated at once, a multiple of 4")
      .integer_in(8, designs::kMaxPopulation)
      .text("NUMBER [64]");
  command.option("--generations", options->generations, "of each search, after the first")
      .integer_in(0, designs::kMaxGenerations)
      .text("NUMBER [50]");
  command.option("--restarts", options->restarts, "searches, each from points of its own")
      .integer_in(1, designs::kMaxRestarts)
      .text("NUMBER [2]");
  command
      .option("--seed", options->seed,
              "seed of the random number generator; of the first search, the next ones count on")
      .integer_in(0, 2147483647)
      .text("NUMBER [1]");
  command
      .option(
          "--samples", options->samples,
          "number of samples that are drawn; of [uncertainty], for each quantile of each design")
      .integer_in(1, designs::kMaxSamples)
      .text("NUMBER [100]");
  command.choice("--comparison", request.comparison, {"fast", "yes", "no"},
                 "random and grid search with as many designs beside it: fast: where designs are "
                 "evaluated by the closed form");
  command.choice("--model", request.model, {"analytic", "multibody"}, "model that computes");
  command.flag("--no-refinement", options->no_refinement,
               "leave out the improvement of the best designs by gradients");
  command.flag("--resume", options->resume,
               "continue an interrupted run; with the batches that it has left");
  add_threads(command, options->threads, "0: one per processor, one where started by mpirun");
  return {command, [options, command] {
            return in_ranks([&](const Ranks& ranks) { return optimise(*options, command, ranks); });
          }};
}

}  // namespace bentaxis::cli
