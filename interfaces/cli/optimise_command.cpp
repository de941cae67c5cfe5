#include <tuple>

#include "bentaxis/designs/optimise_document.h"
#include "bentaxis/pump/lists.h"
#include "command_tools.h"
#include "ranks.h"
#include "sweep_options.h"

namespace bentaxis::cli {
namespace {

struct OptimiseOptions {
  CaseOption the_case;
  ReportPlace place;
  std::vector<std::string> vary;
  std::string study, conditions;
  int threads = 0;
  bool no_refinement = false, resume = false;
  designs::OptimiseRequest request;
};

designs::OptimiseRequest request_of(const OptimiseOptions& options, const CommandParser& command) {
  designs::OptimiseRequest request;
  if (!options.study.empty()) request = designs::read_optimise_request(options.study);
  const designs::OptimiseRequest& given = options.request;
  vary_anew(request.vary, options.vary);
  append(request.minimise, given.minimise);
  append(request.maximise, given.maximise);
  append(request.outputs, given.outputs);
  append(request.subject_to, given.subject_to);
  if (!options.conditions.empty()) request.conditions = options.conditions;
  const auto take = [&](const char* name, auto& to, const auto& value) {
    if (command.given(name)) to = value;
  };
  designs::SearchOptions& search = request.search;
  take("--model", request.model, given.model);
  take("--population", search.population, given.search.population);
  take("--generations", search.generations, given.search.generations);
  take("--restarts", search.restarts, given.search.restarts);
  take("--samples", request.samples, given.samples);
  take("--comparison", request.comparison, given.comparison);
  take("--seed", search.seed, given.search.seed);
  if (options.no_refinement) search.refine = false;
  return request;
}

// " and 3 single designs", where there are any.
std::string and_singles(std::size_t count) {
  return count > 0 ? " and " + std::to_string(count) + " single designs" : "";
}

int optimise(const OptimiseOptions& options, const CommandParser& command, const Ranks& ranks) {
  if (designs::search_libraries().empty())
    throw InputError(
        "optimise: this program was built without pagmo and NLopt; install libpagmo-dev and "
        "libnlopt-cxx-dev (scripts/setup full) and build again");
  const bool first = ranks.rank() == 0;
  const Case base = base_of(options.the_case, ranks);
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
  work.threads = threads_of(ranks, options.threads);
  work.parts = &parts;
  work.resume = options.resume;
  work.rank = static_cast<std::size_t>(ranks.rank());
  work.ranks = static_cast<std::size_t>(ranks.size());
  work.sum = [&ranks](std::span<double> numbers) { ranks.add_up(numbers); };
  const auto say_kept = [&] {
    if (!first) return;
    if (const std::size_t kept = parts.count(); kept > 0) {
      std::fprintf(stderr, "bentaxis: %zu of %zu batches%s are in %s: --resume goes on from them\n",
                   kept, optimiser.batches(), and_singles(parts.count_singles()).c_str(),
                   parts.folder().c_str());
    } else
      parts.remove(0);
  };
  try {
    const designs::Optimisation found = optimiser.run(work, progress_of("optimise"));
    if (!first) return kDone;
    if (options.resume)
      std::fprintf(stderr, "bentaxis: %zu batches%s were there already\n", found.kept,
                   and_singles(found.kept_singles).c_str());
    std::vector<TextFile> files = text_files(designs::chosen_cases(found));
    files.emplace_back("front.csv", designs::front_csv(found));
    files.emplace_back("evaluations.csv", designs::evaluations_csv(found));
    const auto paths = folders->write(
        "report", designs::optimise_document(found, versions(), described(base)), {}, files);
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
  auto command = program.subcommand(
      "optimise", "Find the best designs: objectives, constraints, any parameters");
  if (designs::search_libraries().empty()) command.lacks("pagmo and NLopt");
  add_case(command, options->the_case);
  add_report(command, options->place,
             "report.html, report.json, front.csv, evaluations.csv and chosen_N.toml");
  command.option("--vary", options->vary, Values("NAME=FROM:TO").repeated(),
                 "parameter that varies; with its range, or a list of values");
  designs::OptimiseRequest& request = options->request;
  command.option("--minimise", request.minimise, kNames,
                 "outputs to minimise; see bentaxis outputs");
  command.option("--maximise", request.maximise, kNames, "outputs to maximise");
  command.option("--subject-to", request.subject_to, Values("\"NAME <= NUMBER\"").repeated(),
                 "what every design must keep, as \"timing.backflow.excess <= 0\"");
  command.option("--output", request.outputs, kNames,
                 "outputs to compute; besides objectives and constraints");
  command.option("--conditions", options->conditions, "FILE",
                 "CSV: operating points with their share of the time, as a duty cycle of life");
  command.option("--study", options->study, "FILE",
                 "study file; it holds the same as the options, which add to it");
  designs::SearchOptions& search = request.search;
  command.option("--population", search.population, Values::integers(8, designs::kMaxPopulation),
                 "designs evaluated at once, a multiple of 4");
  command.option("--generations", search.generations, Values::integers(0, designs::kMaxGenerations),
                 "of each search, after the first");
  command.option("--restarts", search.restarts, Values::integers(1, designs::kMaxRestarts),
                 "searches, each from points of its own");
  add_seed(command, search.seed, "of the first search, the next ones count on");
  command.option(
      "--samples", request.samples, Values::integers(1, designs::kMaxSamples),
      "number of samples that are drawn; of [uncertainty], for each quantile of each design");
  command.choice("--comparison", request.comparison, {"fast", "yes", "no"},
                 "random and grid search with as many designs beside it: fast: where designs are "
                 "evaluated by the closed form");
  add_model(command, request.model);
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
