#include "sweep_options.h"

#include <cstdio>

#include "bentaxis/designs/sweep_document.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "commands.h"
#include "console.h"
#include "versions.h"

namespace bentaxis::cli {

namespace {

double check_share(const std::string& text) {
  const bool percent = text.ends_with('%');
  const auto number = number_in(percent ? text.substr(0, text.size() - 1) : text);
  const double share = number.value_or(-1) / (percent ? 100 : 1);
  if (!(share >= 0 && share <= 1))
    throw InputError("--check " + text + ": must be a share of the designs, 0% to 100%");
  return share;
}

}  // namespace

void add_plan(CommandParser command, PlanOptions& options) {
  command.option("--vary", options.vary, "parameter that varies; with its values (docs/sweeps.md)")
      .repeatable()
      .text("NAME=VALUES");
  const std::string names = "NAME[,NAME..]";
  command
      .option("--output", options.request.outputs,
              "outputs to compute; as max:Rb1_z1 (docs/sweeps.md)")
      .list()
      .text(names);
  command.option("--minimise", options.request.minimise, "outputs to minimise").list().text(names);
  command.option("--maximise", options.request.maximise, "outputs to maximise").list().text(names);
  command
      .option("--study", options.study,
              "study file; it holds the same as the options, which add to it")
      .text("FILE");
  command.choice("--sampling", options.request.sampling, designs::sampling_words(),
                 "every combination, or points in distributions");
  command.option("--samples", options.samples, "number of samples that are drawn; not of a grid")
      .integer_in(1, 1000000000)
      .text("NUMBER");
  command
      .option("--seed", options.seed,
              "seed of the random number generator; 0: Sobol's sequence as it is")
      .integer_in(0, 2147483647)
      .text("NUMBER [1]");
  command.choice("--model", options.request.model, {"analytic", "multibody"},
                 "model that computes");
  command.option("--check", options.check, "share of the designs that the other model computes too")
      .text("SHARE [0%]");
}

std::vector<std::pair<std::string, std::string>> varied_of(const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, std::string>> varied;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw InputError("--vary " + text + ": must be NAME=VALUES, as in pump.tilt_deg=20:40:5");
    varied.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return varied;
}

designs::SweepRequest request_of(const PlanOptions& options, const CommandParser& command) {
  designs::SweepRequest request;
  if (!options.study.empty()) request = designs::read_sweep_request(options.study);
  const designs::SweepRequest& given = options.request;
  const auto varied = varied_of(options.vary);
  for (const auto& one : varied)
    std::erase_if(request.vary, [&](const auto& old) { return old.first == one.first; });
  // After those of the file are gone, so that an option given twice is refused as it is there.
  append(request.vary, varied);
  append(request.outputs, given.outputs);
  append(request.minimise, given.minimise);
  append(request.maximise, given.maximise);
  if (command.given("--sampling")) request.sampling = given.sampling;
  if (command.given("--samples")) request.samples = static_cast<std::size_t>(options.samples);
  if (command.given("--seed")) request.seed = static_cast<std::uint64_t>(options.seed);
  if (command.given("--model")) request.model = given.model;
  if (!options.check.empty()) request.check_share = check_share(options.check);
  return request;
}

void add_formats(CommandParser command, std::vector<std::string>& formats) {
  command.option("--format", formats, "files of results")
      .list()
      .one_of({"csv", "hdf5"})
      .text("csv,hdf5");
}

designs::SweepFormats formats_of(const std::vector<std::string>& formats) {
  designs::SweepFormats result{.csv = formats.empty(),
                               .hdf5 = formats.empty() && designs::has_hdf5()};
  for (const std::string& format : formats) (format == "csv" ? result.csv : result.hdf5) = true;
  if (result.hdf5 && !designs::has_hdf5())
    throw InputError("--format hdf5: " + designs::why_no_hdf5());
  return result;
}

std::filesystem::path parts_in(const std::filesystem::path& out) { return out / "sweep.parts"; }

std::size_t say_kept(const designs::Sweep& sweep, const designs::SweepParts& parts,
                     const std::string& why) {
  const std::size_t kept = parts.count();
  if (kept > 0)
    std::fprintf(stderr, "bentaxis: %s%zu of %zu blocks are in %s: --resume goes on from them\n",
                 why.c_str(), kept, sweep.blocks(), parts.folder().c_str());
  return kept;
}

std::optional<designs::ResumedBlocks> compute_or_say(const designs::Sweep& sweep,
                                                     const designs::SweepParts& parts,
                                                     const designs::SweepShare& share) {
  const auto kept = [&](const char* why) {
    if (parts.count() == 0 && share.ranks == 1 && share.parts == 1) parts.remove(0);
    return share.rank == 0 ? say_kept(sweep, parts, why) : parts.count();
  };
  try {
    return designs::compute_blocks(sweep, parts, share, progress_of("sweep"));
  } catch (const Interrupted&) {
    if (kept("interrupted; ") == 0 || share.ranks > 1) throw;  // other ranks would wait for it
    return std::nullopt;
  } catch (...) {
    kept("");
    throw;
  }
}

int write_results(const designs::Sweep& sweep, const designs::SweepParts& parts,
                  const designs::SweepFormats& formats, int threads, ReportFolders& folders) {
  const designs::SweepResult result = designs::write_sweep(sweep, parts, formats, folders.tables(),
                                                           threads, progress_of("writing"));
  const auto paths = folders.write(
      "report",
      designs::sweep_document(result, versions(), study::describe(result.base, progress_of)), {},
      {});
  std::printf("%s\n", designs::headline(result).c_str());
  for (const std::string& answer : designs::sweep_answers(result))
    std::printf("%s\n", answer.c_str());
  std::printf("%s", designs::disagreements_text(result).c_str());
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return result.agrees() ? kDone : kOutOfTolerance;
}

}  // namespace bentaxis::cli
