#include "options.h"

#include <map>

#include "bentaxis/pump/error.h"

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

std::map<std::string, multibody::Integrator> integrators_by_name() {
  std::map<std::string, multibody::Integrator> names;
  for (const auto integrator : all_integrators())
    names[multibody::integrator_names()[static_cast<std::size_t>(integrator)]] = integrator;
  return names;
}

std::string integrator_list(const std::string& separator) {
  std::string list;
  for (const std::string& name : multibody::integrator_names())
    list += (list.empty() ? "" : separator) + name;
  return list;
}

}  // namespace

std::vector<multibody::Integrator> all_integrators() {
  std::vector<multibody::Integrator> all;
  for (std::size_t i = 0; i < multibody::integrator_names().size(); ++i)
    all.push_back(static_cast<multibody::Integrator>(i));
  return all;
}

CLI::Option* add_integrator(CLI::App& command, multibody::IntegrationOptions& options) {
  return command
      .add_option("--integrator", options.integrator, "time integrator of an integrated run")
      ->transform(CLI::CheckedTransformer(integrators_by_name()))
      ->option_text(integrator_list("|") + " [rk-merson]");
}

void add_integrators(CLI::App& command, std::vector<multibody::Integrator>& integrators) {
  command.add_option("--integrators", integrators, "time integrators to try")
      ->delimiter(',')
      ->transform(CLI::CheckedTransformer(integrators_by_name()))
      ->option_text("NAME[,NAME..] [" + integrator_list(",") + "]");
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
      ->check(CLI::Range(1e-11, 0.1, "in [1e-11, 0.1]"))
      ->excludes(accuracy)
      ->option_text("NUMBER");
}

CLI::Range accuracy_range() { return {1e-12, 0.1, "in [1e-12, 0.1]"}; }

}  // namespace bentaxis::cli
