#include "options.h"

#include <cmath>
#include <functional>
#include <map>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::cli {

void add_case(CLI::App& command, std::string& file) {
  command.add_option("case", file, "case file (TOML)")->required()->option_text("CASE");
}

void add_out(CLI::App& command, std::string& folder, const std::string& what) {
  command.add_option("--out", folder, "folder for " + what + ", made where missing")
      ->option_text("DIR [" + folder + "]");
}

void add_way(CLI::App& command, Way& way) {
  command
      .add_option("--way", way,
                  "multibody: driven (reactions at given angles, no time integration) or "
                  "integrated (in time, over the case's revolutions)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Way>{{"driven", Way::driven}, {"integrated", Way::integrated}}))
      ->option_text("driven|integrated [driven]");
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

CLI::Option* add_scene(CLI::App& command, multibody::SceneChoice& choice) {
  CLI::Option* scene =
      add_choice(command, "--scene", choice.scene, multibody::scene_names(),
                 "multibody, driven: what is built; what a scene does not compute stays empty");
  add_choice(command, "--reactions", choice.method, multibody::method_names(),
             "multibody, driven: by forward dynamics and its multipliers, or by inverse dynamics "
             "(faster; serves massless pistons too)");
  return scene;
}

CLI::Option* add_integrator(CLI::App& command, multibody::IntegrationOptions& options) {
  return add_choice(command, "--integrator", options.integrator, multibody::integrator_names(),
                    "time integrator of an integrated run");
}

std::vector<multibody::Integrator> all_integrators() {
  std::vector<multibody::Integrator> all;
  for (std::size_t i = 0; i < multibody::integrator_names().size(); ++i)
    all.push_back(static_cast<multibody::Integrator>(i));
  return all;
}

void add_integrators(CLI::App& command, std::vector<multibody::Integrator>& integrators) {
  std::map<std::string, multibody::Integrator> names;
  std::string list;
  for (const auto integrator : all_integrators()) {
    const std::string& name = multibody::integrator_names()[static_cast<std::size_t>(integrator)];
    names[name] = integrator;
    list += (list.empty() ? "" : ",") + name;
  }
  command.add_option("--integrators", integrators, "time integrators to try")
      ->delimiter(',')
      ->transform(CLI::CheckedTransformer(names))
      ->option_text("NAME[,NAME..] [" + list + "]");
}

std::vector<multibody::Integrator> ErrorTarget::integrators() const {
  if (integrator->count() > 0) return {integration->integrator};
  return all_integrators();
}

void ErrorTarget::refuse_unless(bool integrated) const {
  if (!integrated)
    throw InputError(
        "--error: only an integrated run of the multibody model has an error to choose; give "
        "--way integrated (driven and analytic runs are exact to round-off)");
}

void add_error(CLI::App& command, ErrorTarget& target,
               const multibody::IntegrationOptions& integration, CLI::Option* integrator,
               CLI::Option* accuracy) {
  target.integration = &integration;
  target.integrator = integrator;
  command
      .add_option("--error", target.error,
                  "integrated: choose integrator and accuracy for this error of every reaction, of "
                  "peak, by a short calibration, and verify it")
      ->check(number_in(1e-11, 0.1))
      ->excludes(accuracy)
      ->option_text("NUMBER");
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
