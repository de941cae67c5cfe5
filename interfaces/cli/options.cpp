#include "options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/spaced_values.h"

namespace bentaxis::cli {
namespace {

// "pump.tilt_deg=" of every key that a case may have.
std::vector<std::string> changeable_keys() {
  std::vector<std::string> keys;
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters)
      keys.push_back((table.name.empty() ? "" : table.name + ".") + parameter.key + "=");
  return keys;
}

}  // namespace

Case CaseOption::read(const std::string& whose) const {
  Case the_case = read_case(file, changes);
  const study::Plausibility looked = study::plausibility(the_case);
  std::fprintf(stderr, "pump: %s%s\n", whose.c_str(), looked.summary().c_str());
  const char* kind = strict ? "error" : "warning";
  for (const study::PlausibilityWarning& doubt : looked.warnings)
    std::fprintf(stderr, "bentaxis: %s: %s: %s\n", kind, doubt.code.c_str(), doubt.text.c_str());
  if (strict && !looked.warnings.empty())
    throw InputError(file +
                     ": implausible values, and --strict; an intended value needs a reason in "
                     "[plausibility] (docs/plausibility.md)");
  return the_case;
}

void CaseOption::refuse(const std::vector<report::Warning>& doubts, const std::string& what) const {
  if (!strict || doubts.empty()) return;
  for (const report::Warning& warning : doubts)
    std::fprintf(stderr, "bentaxis: error: %s: %s\n", warning.name.c_str(), warning.text.c_str());
  throw InputError(what);
}

void CaseOption::refuse_timing(const std::vector<report::Warning>& timing) const {
  refuse(timing, file +
                     ": port timing exceeds its limits, and --strict; intended timing needs a "
                     "reason in [plausibility] (docs/hydraulics.md)");
}

void add_case(CommandParser command, CaseOption& the_case, const std::string& otherwise) {
  command.option("case", the_case.file,
                 otherwise.empty() ? Values::case_file("CASE").required()
                                   : Values::case_file("CASE [" + otherwise + "]"),
                 "case file (TOML), or the name of a shipped case (bentaxis cases)");
  add_changes(command, the_case);
}

void add_changes(CommandParser command, CaseOption& the_case) {
  command.option("--set", the_case.changes,
                 Values("TABLE.KEY=VALUE").repeated().completed_with(changeable_keys()),
                 "change a key of the case, as if its file said so; can be given again");
  command.flag("--strict", the_case.strict, "plausibility warnings are errors: exit status 2");
}

void add_out(CommandParser command, std::string& folder, const std::string& what) {
  command.option("--out", folder, folder.empty() ? "DIR" : "DIR [" + folder + "]",
                 "where results are written; directory for " + what + ", made where missing");
}

Option add_values(CommandParser command, const std::string& name, std::string& text,
                  const std::string& what, const std::string& otherwise) {
  return command.option(name, text,
                        "NUMBER[,NUMBER..]|FROM:TO:STEP|FROM:TO:#N" +
                            (otherwise.empty() ? "" : " [" + otherwise + "]"),
                        what);
}

namespace {

std::vector<double> numbers_in(const std::string& name, const std::string& text,
                               const std::string& unit, double least) {
  constexpr int kMost = 1000;
  if (text.find(',') == std::string::npos)
    return study::spaced_values(name, text, unit, least, kMost,
                                "a list of numbers with commas (100,200), ");
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string one = text.substr(at, end - at);
    const auto value = number_in(one);
    if (!value || *value < least)
      throw InputError(name + " " + text + ": \"" + one + "\" must be a number in " + unit +
                       (std::isfinite(least) ? ", >= " + number_text(least) : "") +
                       (one.find(':') == std::string::npos
                            ? ""
                            : "; a range is FROM:TO:STEP or FROM:TO:#N, without a list"));
    values.push_back(*value);
    at = end + 1;
  }
  return values;
}

}  // namespace

std::vector<double> values_in(const std::string& name, const std::string& text,
                              const std::string& unit, double least) {
  std::vector<double> values = numbers_in(name, text, unit, least);
  for (auto value = values.begin(); value != values.end(); ++value)
    if (std::find(values.begin(), value, *value) != value)
      throw InputError(name + " " + text + ": " + number_text(*value) +
                       " is specified more than once");
  return values;
}

void add_threads(CommandParser command, int& threads, const std::string& what) {
  command.option("--threads", threads, Values::integers(0, 1024), "threads that compute; " + what);
}

void add_seed(CommandParser command, std::uint64_t& seed, const std::string& what, int high) {
  command.option("--seed", seed, Values::integers(0, high),
                 "seed of the random number generator; " + what);
}

Option add_model(CommandParser command, study::Model& model) {
  return command.choice("--model", model, {"analytic", "multibody"}, "model that computes");
}

void add_integrators(CommandParser command, std::vector<multibody::Integrator>& integrators) {
  command.choices("--integrators", integrators, multibody::integrator_names(),
                  "time integrators to try");
}

void RunChoice::add_to(CommandParser command, bool several) {
  command_ = command;
  command.choice("--way", way, {"driven", "integrated"},
                 "multibody: driven (reactions at given angles, no time integration) or "
                 "integrated (in time, over the case's revolutions)");
  command.choice("--scene", scene.scene, multibody::scene_names(),
                 "multibody, driven: what is built; what a scene does not compute stays empty");
  command.choice("--reactions", method_, multibody::method_names(),
                 "multibody, driven: by forward dynamics and its multipliers, or by inverse "
                 "dynamics (faster; serves massless pistons too)");
  command.option("--channels", channels_,
                 Values("NAME[,NAME..] [all]").list().completed_with(study::quantity_names()),
                 "only these: quantities (Rs) or columns (Rs_1_z2_N); without --scene the smallest "
                 "scene that computes them is built");
  command.choice("--integrator", integration.integrator, multibody::integrator_names(),
                 "time integrator of Simbody; of an integrated run");
  const Option accuracy =
      command.option("--accuracy", accuracies,
                     several ? Values::accuracies("NUMBER[,NUMBER..] [1e-4,1e-6]").list()
                             : Values::accuracies("NUMBER [1e-6]").one(),
                     std::string("relative accuracy per step of the time integrator; ") +
                         (several ? "of an integrated run; all are tabled, the last is compared"
                                  : "of an integrated run"));
  command
      .option("--error", error_, Values::numbers(1e-11, 0.1, "NUMBER"),
              "wanted error of every reaction, relative to its peak; of an integrated run: a short "
              "calibration chooses integrator and accuracy, and the error is verified")
      .excludes(accuracy);
}

void RunChoice::refuse_without_effect(bool multibody, bool states) const {
  if (states && way == study::Way::integrated)
    throw InputError("--way integrated: --states gives the motion, so nothing is integrated");
  if (states && given("--scene"))
    throw InputError("--scene: has no effect: at given --states the whole pump is built");
  const bool integrated = multibody && way == study::Way::integrated;
  if (given("--error") && !integrated)
    throw InputError(
        "--error: only an integrated run of the multibody model has a selectable error; give --way "
        "integrated (driven and analytic runs are exact to round-off)");
  if (!multibody && way == study::Way::integrated)
    throw InputError(
        "--way integrated: only the multibody model is integrated in time; the analytic model "
        "gives "
        "the reactions at any angle");
  for (const char* option : {"--scene", "--reactions"}) {
    if (!given(option)) continue;
    if (!multibody)
      throw InputError(std::string(option) +
                       ": has no effect: only the multibody model builds scenes");
    if (integrated)
      throw InputError(
          "--scene and --reactions are for --way driven: an integrated run always uses the full "
          "pump and its equations of motion");
  }
  for (const char* option : {"--integrator", "--accuracy"})
    if (given(option) && !integrated)
      throw InputError(std::string(option) +
                       ": has no effect: only an integrated run of the multibody model takes "
                       "steps; give --way integrated");
}

multibody::SceneChoice RunChoice::scene_for(const Case& the_case) const {
  const ChannelLayout layout(the_case.pump);
  const study::ChannelChoice wanted = channels();
  multibody::SceneChoice choice = scene;
  choice.method = method();
  if (way == study::Way::integrated) {
    wanted.of(layout);  // refuses unknown names
    return choice;
  }
  const bool chosen = given("--scene");
  choice.scene = wanted.scene_for(
      layout, chosen ? std::optional<multibody::Scene>(scene.scene) : std::nullopt);
  if (!chosen && choice.scene != multibody::Scene::full)
    std::fprintf(stderr,
                 "scene \"%s\": the smallest that computes %s; --scene full builds the whole "
                 "pump\n",
                 multibody::scene_names()[static_cast<std::size_t>(choice.scene)].c_str(),
                 wanted.text().c_str());
  return choice;
}

std::optional<multibody::Method> RunChoice::method() const {
  return given("--reactions") ? std::optional<multibody::Method>(method_) : std::nullopt;
}

std::optional<study::ErrorTarget> RunChoice::target() const {
  if (!given("--error")) return std::nullopt;
  study::ErrorTarget target;
  target.error = error_;
  if (given("--integrator")) target.integrators = {integration.integrator};
  return target;
}

}  // namespace bentaxis::cli
