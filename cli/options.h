// Options that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/scene.h"

namespace bentaxis::cli {

/// How the multibody model is run.
enum class Way { driven, integrated };

void add_case(CLI::App& command, std::string& file);
void add_out(CLI::App& command, std::string& folder, const std::string& what);
void add_way(CLI::App& command, Way& way);
void add_integrator(CLI::App& command, multibody::IntegrationOptions& options);
/// A finite number in [low, high].
CLI::Validator number_in(double low, double high);
/// --scene and --reactions.
void add_scene(CLI::App& command, multibody::SceneChoice& choice);
/// Accuracies that Simbody's integrators accept.
CLI::Validator accuracy_range();
/// A finite number above 0.
CLI::Validator positive_number();

}  // namespace bentaxis::cli
