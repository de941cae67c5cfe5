#include "sweep_options.h"

#include "bentaxis/designs/sweep_document.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "command_tools.h"

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
  designs::SweepRequest& request = options.request;
  command.option("--vary", options.vary, Values("NAME=VALUES").repeated(),
                 "parameter that varies; with its values (docs/sweeps.md)");
  command.option("--output", request.outputs, kNames,
                 "outputs to compute; as max:Rb1_z1 (docs/sweeps.md)");
  command.option("--minimise", request.minimise, kNames, "outputs to minimise");
  command.option("--maximise", request.maximise, kNames, "outputs to maximise");
  command.option("--study", options.study, "FILE",
                 "study file; it holds the same as the options, which add to it");
  command.choice("--sampling", request.sampling, designs::sampling_words(),
                 "every combination, or points in distributions");
  command.option("--samples", request.samples, Values::integers(1, 1000000000, "NUMBER"),
                 "number of samples that are drawn; not of a grid");
  add_seed(command, request.seed, "0: Sobol's sequence as it is");
  add_model(command, request.model);
  command.option("--check", options.check, "SHARE [0%]",
                 "share of the designs that the other model computes too");
}

void vary_anew(Varied& varied, const std::vector<std::string>& texts) {
  Varied given;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw InputError("--vary " + text + ": must be NAME=VALUES, as in pump.tilt_deg=20:40:5");
    given.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  for (const auto& one : given)
    std::erase_if(varied, [&](const auto& old) { return old.first == one.first; });
  // After those of the file are gone, so that an option given twice is refused as it is there.
  append(varied, given);
}

designs::SweepRequest request_of(const PlanOptions& options, const CommandParser& command) {
  designs::SweepRequest request;
  if (!options.study.empty()) request = designs::read_sweep_request(options.study);
  const designs::SweepRequest& given = options.request;
  vary_anew(request.vary, options.vary);
  append(request.outputs, given.outputs);
  append(request.minimise, given.minimise);
  append(request.maximise, given.maximise);
  if (command.given("--sampling")) request.sampling = given.sampling;
  if (command.given("--samples")) request.samples = given.samples;
  if (command.given("--seed")) request.seed = given.seed;
  if (command.given("--model")) request.model = given.model;
  if (!options.check.empty()) request.check_share = check_share(options.check);
  return request;
}

void add_formats(CommandParser command, std::vector<std::string>& formats) {
  command.option("--format", formats, Values::words({"csv", "hdf5"}, "csv,hdf5").list(),
                 "files of results");
}

designs::SweepFormats formats_of(const std::vector<std::string>& formats) {
  designs::SweepFormats result{.csv = formats.empty(),
                               .hdf5 = formats.empty() && designs::has_hdf5()};
  for (const std::string& format : formats) (format == "csv" ? result.csv : result.hdf5) = true;
  if (result.hdf5 && !designs::has_hdf5())
    throw InputError("--format hdf5: " + designs::why_no_hdf5());
  return result;
}

Case base_of(const CaseOption& the_case, const Ranks& ranks) {
  return ranks.rank() == 0 ? the_case.read() : read_case(the_case.file, the_case.changes);
}

int threads_of(const Ranks& ranks, int threads) {
  return ranks.size() > 1 && threads == 0 ? 1 : threads;
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
      "report", designs::sweep_document(result, versions(), described(result.base)), {}, {});
  std::printf("%s\n", designs::headline(result).c_str());
  for (const std::string& answer : designs::sweep_answers(result))
    std::printf("%s\n", answer.c_str());
  std::printf("%s", designs::disagreements_text(result).c_str());
  print_files(paths);
  return result.agrees() ? kDone : kOutOfTolerance;
}

}  // namespace bentaxis::cli
