// The commands of the program, one per job.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::cli {

/// Exit statuses (docs/command_line.md).
enum ExitStatus { kDone = 0, kOutOfTolerance = 1, kBadInput = 2, kComputationFailed = 3 };

enum class Way { driven, integrated };

struct RunOptions {
  std::string case_file, model, out = "out";
  Way way = Way::driven;
  std::string scene = "full";
  std::string gear;  ///< "", "mesh" or "imposed"
  multibody::IntegrationOptions integration;
};
int run_command(const RunOptions& options);

struct CompareOptions {
  std::string case_file, out = "out";
  std::string multibody_case;  ///< another case for the multibody model; empty = the same
  double tolerance = 0;        ///< 0 = default for the way
  Way way = Way::driven;
  multibody::IntegrationOptions integration;
  std::vector<double> accuracies;  ///< integrated: all are run, the last is reported in full
  std::vector<std::string> analytic, multibody;  ///< KEY=VALUE assumptions
};
int compare_command(const CompareOptions& options);

/// Applies KEY=VALUE (piston_friction=on|off, inertia=lumped|real, gear=mesh|imposed).
/// @throws InputError
void apply_assumption(const std::string& text, const PumpParameters& pump,
                      Assumptions& assumptions);

}  // namespace bentaxis::cli
