#include "options.h"

#include <cmath>
#include <functional>
#include <map>

#include "bentaxis/pump/csv.h"

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

void add_integrator(CLI::App& command, multibody::IntegrationOptions& options) {
  std::map<std::string, multibody::Integrator> names;
  std::string list;
  for (std::size_t i = 0; i < multibody::integrator_names().size(); ++i) {
    names[multibody::integrator_names()[i]] = static_cast<multibody::Integrator>(i);
    list += (i == 0 ? "" : "|") + multibody::integrator_names()[i];
  }
  command.add_option("--integrator", options.integrator, "time integrator of an integrated run")
      ->transform(CLI::CheckedTransformer(names))
      ->option_text(list + " [rk-merson]");
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
