#include <algorithm>

#include "bentaxis/designs/independence.h"
#include "bentaxis/designs/sensitivity_document.h"
#include "bentaxis/pump/lists.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct SensitivityOptions {
  CaseOption the_case;
  ReportPlace place;
  std::vector<std::string> outputs, parameters;
  study::Model model = study::Model::analytic;
  bool check = false;
};

const std::vector<std::string> kOutputs = {"mean:Td", "peak:Rb1", "peak:Rb2", "peak:Rs",
                                           "peak:Rc", "peak:Rcn", "min:Fh"};

int sensitivity(const SensitivityOptions& options) {
  const Case base = options.the_case.read();
  std::vector<designs::Output> outputs;
  for (const std::string& name : options.outputs.empty() ? kOutputs : options.outputs)
    add_once(outputs, designs::output(name, base));
  std::vector<designs::Variable> variables;
  for (const std::string& name : options.parameters)
    if (std::none_of(variables.begin(), variables.end(),
                     [&](const designs::Variable& v) { return v.name() == name; }))
      variables.emplace_back(name, base);
  if (variables.empty()) variables = designs::continuous_variables(base);
  if (options.check) designs::require_independent(outputs, base, "--check-derivatives");
  ReportFolders folders(options.place);

  const designs::Sensitivities found =
      designs::sensitivities(base, variables, outputs, options.model, progress_of, true);
  bool interrupted = !found.left_out.empty();
  std::optional<designs::SensitivityCheck> check;
  try {
    if (options.check && !interrupted) check = designs::check(found, progress_of);
  } catch (const Interrupted&) {
    interrupted = true;
  }
  // An interruption that is there already would end the description at once.
  const auto description =
      study::describe(found.base, interrupted ? study::silent() : study::PartProgress(progress_of));
  folders.publish("sensitivity", designs::sensitivity_text(found, check),
                  designs::sensitivity_document(found, check, versions(), description),
                  {{"sensitivity.csv", designs::sensitivity_csv(found, check)}});
  if (interrupted) {
    std::fprintf(stderr, "bentaxis: %s What is finished is written.\n",
                 found.left_out.empty() ? "Interrupted: the check is missing."
                                        : designs::left_out_text(found).c_str());
    return kInterrupted;
  }
  return !check || check->agrees() ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_sensitivity_command(CommandParser program) {
  auto options = std::make_shared<SensitivityOptions>();
  auto command = program.subcommand(
      "sensitivity", "Derivatives of any output with respect to any parameter of a case");
  add_case(command, options->the_case);
  add_report(command, options->place, "sensitivity.html, sensitivity.json and sensitivity.csv");
  command.option("--output", options->outputs,
                 Values("NAME[,NAME..] [Td, bearings, Rs, Rc, pin, film]").list(),
                 "outputs to compute; their derivatives are found (docs/sweeps.md)");
  command.option("--vary", options->parameters, kNames,
                 "parameter that varies; the derivatives are with respect to it. Names as of "
                 "--set; without, every number of the case");
  add_model(command, options->model);
  command.flag("--check-derivatives", options->check,
               "also by differences of the other model; a difference: exit status 1");
  return {command, [options] { return sensitivity(*options); }};
}

}  // namespace bentaxis::cli
