// Options that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/scene.h"

namespace bentaxis::cli {

/// How the multibody model is run.
enum class Way { driven, integrated };

void add_case(CLI::App& command, std::string& file);
void add_out(CLI::App& command, std::string& folder, const std::string& what);
void add_way(CLI::App& command, Way& way);
CLI::Option* add_integrator(CLI::App& command, multibody::IntegrationOptions& options);
std::vector<multibody::Integrator> all_integrators();
/// A list of integrators; empty where not given.
void add_integrators(CLI::App& command, std::vector<multibody::Integrator>& integrators);
/// The error a user asks for instead of an accuracy.
struct ErrorTarget {
  double error = 0;  ///< of peak; 0: none asked for
  const multibody::IntegrationOptions* integration = nullptr;
  const CLI::Option* integrator = nullptr;  ///< where given, only that integrator is tried

  std::vector<multibody::Integrator> integrators() const;
  /// @throws InputError
  void refuse_unless(bool integrated) const;
};
/// @param integrator, accuracy  options of the same command
void add_error(CLI::App& command, ErrorTarget& target,
               const multibody::IntegrationOptions& integration, CLI::Option* integrator,
               CLI::Option* accuracy);
/// A finite number in [low, high].
CLI::Validator number_in(double low, double high);
/// --scene (returned) and --reactions.
CLI::Option* add_scene(CLI::App& command, multibody::SceneChoice& choice);
/// Accuracies that Simbody's integrators accept.
CLI::Validator accuracy_range();
/// A finite number above 0.
CLI::Validator positive_number();

}  // namespace bentaxis::cli
