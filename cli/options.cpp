#include "options.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::cli {

Case CaseOption::read() const { return read_case(file, changes); }

void add_case(CLI::App& command, CaseOption& the_case) {
  command.add_option("case", the_case.file, "case file (TOML)")->required()->option_text("CASE");
  command
      .add_option("--set", the_case.changes,
                  "change a key of the case, as if its file said so; can be given again")
      ->expected(1)
      ->take_all()
      ->option_text("TABLE.KEY=VALUE");
}

void add_out(CLI::App& command, std::string& folder, const std::string& what) {
  command.add_option("--out", folder, "folder for " + what + ", made where missing")
      ->option_text("DIR [" + folder + "]");
}

namespace {

// An option whose values are an enumeration's names in its order.
template <class Enumeration>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Enumeration& value,
                        const std::vector<std::string>& words, const std::string& what) {
  std::map<std::string, Enumeration> names;
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    names[words[i]] = static_cast<Enumeration>(i);
    list += (i == 0 ? "" : "|") + words[i];
  }
  return command.add_option(name, value, what)
      ->transform(CLI::CheckedTransformer(names))
      ->option_text(list + " [" + words[static_cast<std::size_t>(value)] + "]");
}

}  // namespace

void add_integrators(CLI::App& command, std::vector<multibody::Integrator>& integrators) {
  std::map<std::string, multibody::Integrator> names;
  std::string list;
  for (const auto integrator : study::all_integrators()) {
    const std::string& name = multibody::integrator_names()[static_cast<std::size_t>(integrator)];
    names[name] = integrator;
    list += (list.empty() ? "" : ",") + name;
  }
  command.add_option("--integrators", integrators, "time integrators to try")
      ->delimiter(',')
      ->transform(CLI::CheckedTransformer(names))
      ->option_text("NAME[,NAME..] [" + list + "]");
}

void RunChoice::add_to(CLI::App& command, bool several) {
  command_ = &command;
  command
      .add_option("--way", way,
                  "multibody: driven (reactions at given angles, no time integration) or "
                  "integrated (in time, over the case's revolutions)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, study::Way>{
          {"driven", study::Way::driven}, {"integrated", study::Way::integrated}}))
      ->option_text("driven|integrated [driven]");
  add_choice(command, "--scene", scene.scene, multibody::scene_names(),
             "multibody, driven: what is built; what a scene does not compute stays empty");
  add_choice(command, "--reactions", scene.method, multibody::method_names(),
             "multibody, driven: by forward dynamics and its multipliers, or by inverse dynamics "
             "(faster; serves massless pistons too)");
  command
      .add_option("--channels", channels_,
                  "only these: quantities (Rs) or columns (Rs_1_z2_N); without --scene the "
                  "smallest scene that computes them is built")
      ->delimiter(',')
      ->option_text("NAME[,NAME..] [all]");
  add_choice(command, "--integrator", integration.integrator, multibody::integrator_names(),
             "time integrator of an integrated run");
  CLI::Option* accuracy =
      command
          .add_option("--accuracy", accuracies,
                      several ? "accuracies of an integrated run; all are tabled, the last is "
                                "compared"
                              : "relative accuracy per step of an integrated run")
          ->check(accuracy_range());
  if (several)
    accuracy->delimiter(',')->option_text("NUMBER[,NUMBER..] [1e-4,1e-6]");
  else
    accuracy->expected(1)->option_text("NUMBER [1e-6]");
  command
      .add_option("--error", error_,
                  "integrated: choose integrator and accuracy for this error of every reaction, of "
                  "peak, by a short calibration, and verify it")
      ->check(number_in(1e-11, 0.1))
      ->excludes(accuracy)
      ->option_text("NUMBER");
}

void RunChoice::refuse_without_effect(bool multibody) const {
  const bool integrated = multibody && way == study::Way::integrated;
  if (given("--error") && !integrated)
    throw InputError(
        "--error: only an integrated run of the multibody model has an error to choose; give "
        "--way integrated (driven and analytic runs are exact to round-off)");
  if (!multibody && way == study::Way::integrated)
    throw InputError(
        "--way integrated: only the multibody model is integrated in time; the analytic model "
        "gives "
        "the reactions at any angle");
  for (const char* option : {"--scene", "--reactions"}) {
    if (!given(option)) continue;
    if (!multibody)
      throw InputError(std::string(option) +
                       ": changes nothing: only the multibody model builds scenes");
    if (integrated)
      throw InputError(
          "--scene and --reactions are for --way driven: an integrated run is of the full pump, by "
          "its equations of motion");
  }
  for (const char* option : {"--integrator", "--accuracy"})
    if (given(option) && !integrated)
      throw InputError(std::string(option) +
                       ": changes nothing: only an integrated run of the multibody model takes "
                       "steps; give --way integrated");
}

multibody::SceneChoice RunChoice::scene_for(const Case& the_case) const {
  const ChannelLayout layout(the_case.pump.geometry.pistons);
  const study::ChannelChoice wanted = channels();
  multibody::SceneChoice choice = scene;
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

std::optional<study::ErrorTarget> RunChoice::target() const {
  if (!given("--error")) return std::nullopt;
  study::ErrorTarget target;
  target.error = error_;
  if (given("--integrator")) target.integrators = {integration.integrator};
  return target;
}

namespace {

CLI::Validator number_that(const std::string& range, const std::function<bool(double)>& allowed) {
  return {[=](const std::string& text) {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && allowed(value))
              return std::string();
            return text + ": must be " + range;
          },
          ""};
}

}  // namespace

CLI::Validator number_in(double low, double high) {
  return number_that("in [" + number_text(low) + ", " + number_text(high) + "]",
                     [=](double value) { return value >= low && value <= high; });
}

CLI::Validator accuracy_range() { return number_in(1e-12, 0.1); }

CLI::Validator positive_number() {
  return number_that("a finite number > 0", [](double value) { return value > 0; });
}

}  // namespace bentaxis::cli
