// Options that several commands share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/scene.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/channel_choice.h"
#include "bentaxis/study/run.h"
#include "command_parser.h"

namespace bentaxis::cli {

/// Names of outputs, of parameters.
inline const Values kNames = Values("NAME[,NAME..]").list();

/// The case of a command, and what is changed in it.
struct CaseOption {
  std::string file;
  std::vector<std::string> changes;  ///< TABLE.KEY=VALUE
  bool strict = false;               ///< implausible values are errors

  /// The case as if its file said so. Says on standard error what pump it is (after `whose`, where
  /// there are two), and what of it is doubtful. @throws InputError, with `strict` for implausible
  /// values too
  Case read(const std::string& whose = {}) const;
  /// With `strict`, prints warnings on standard error. @param what  the end of the refusal
  /// @throws InputError then
  void refuse(const std::vector<report::Warning>& doubts, const std::string& what) const;
  void refuse_timing(const std::vector<report::Warning>& timing) const;
};
/// CASE, --set and --strict.
/// @param otherwise  what the command takes where no CASE is given; empty: it must be
void add_case(CommandParser command, CaseOption& the_case, const std::string& otherwise = {});
/// --set and --strict alone.
void add_changes(CommandParser command, CaseOption& the_case);
void add_out(CommandParser command, std::string& folder, const std::string& what);
/// An option whose value is a list of numbers or a range: --speeds, --delivery-bar.
/// @param otherwise  what is taken where it is not given
Option add_values(CommandParser command, const std::string& name, std::string& text,
                  const std::string& what, const std::string& otherwise = {});
/// The numbers of such a text, each at least `least` and no two alike. @throws InputError naming
/// the option
std::vector<double> values_in(const std::string& name, const std::string& text,
                              const std::string& unit, double least);
/// --threads. @param what  goes on behind its meaning
void add_threads(CommandParser command, int& threads, const std::string& what);
/// --seed, at most `high`. @param what  likewise
void add_seed(CommandParser command, std::uint64_t& seed, const std::string& what,
              int high = 2147483647);
/// --model, one of both.
Option add_model(CommandParser command, study::Model& model);
/// A list of integrators; empty where not given.
void add_integrators(CommandParser command, std::vector<multibody::Integrator>& integrators);

/// How the multibody model is run, and which channels are asked for.
class RunChoice {
 public:
  study::Way way = study::Way::driven;
  multibody::SceneChoice scene;
  multibody::IntegrationOptions integration;
  std::vector<double> accuracies;  ///< of --accuracy; empty where not given

  /// Adds --way, --scene, --reactions, --channels, --integrator, --accuracy, --error.
  /// @param several  --accuracy takes a list
  void add_to(CommandParser command, bool several);

  /// Refuses options that were given and would change nothing.
  /// @param multibody  whether the multibody model is run at all
  /// @param states     whether the motion is given by a file
  /// @throws InputError
  void refuse_without_effect(bool multibody, bool states = false) const;

  study::ChannelChoice channels() const { return study::ChannelChoice(channels_); }
  /// The scene to build, which standard error names where it was not chosen by the user.
  /// @throws InputError
  multibody::SceneChoice scene_for(const Case& the_case) const;
  /// The way to find reactions that was asked for.
  std::optional<multibody::Method> method() const;
  /// The error asked for instead of an accuracy.
  std::optional<study::ErrorTarget> target() const;

 private:
  bool given(const std::string& option) const { return command_->given(option); }

  std::optional<CommandParser> command_;
  std::vector<std::string> channels_;
  multibody::Method method_ = multibody::Method::multipliers;  // of --reactions
  double error_ = 0;
};

}  // namespace bentaxis::cli
