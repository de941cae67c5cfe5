// Chooses integrator and accuracy for an error that the user asks for.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

/// What was chosen and what it was seen to do.
struct Calibration {
  multibody::IntegrationOptions chosen;
  double asked = 0;             ///< largest error of any reaction over its peak
  double error_in_trial = 0;    ///< over the trial's part of a turn
  double seconds_per_turn = 0;  ///< of the trial, scaled to a turn
  int trials = 0;
  std::string seconds_spent;  ///< as text

  /// One line for the user.
  std::string text() const;
};

/// Names an integrator as on the command line.
const std::string& name_of(multibody::Integrator integrator);

/// Finds the cheapest integrator and accuracy whose error, against the analytic model under the
/// same assumptions, is at most half of `asked` over the first 1/N of a turn (all that happens to a
/// pump happens to some piston within it). The rest of a run is not covered: verify it.
/// @param among  integrators to try
/// @throws ComputationError if none of them reaches it
Calibration calibrate(const Case& the_case, const Assumptions& assumptions,
                      const PressureTrace& pressure, double asked,
                      const std::vector<multibody::Integrator>& among,
                      const PartProgress& progress_of);

/// Calibrates, runs the case, and tightens the accuracy until the error of the whole run is at most
/// `asked`.
struct VerifiedRun {
  Calibration calibration;
  AchievedError error;  ///< of the whole run
  multibody::IntegratedRun run;

  /// One line for the user: what was chosen, and what the whole run then did.
  std::string text() const;
};
VerifiedRun run_to_error(const Case& the_case, const Assumptions& assumptions,
                         const Samples& samples, const PressureTrace& pressure, double asked,
                         const std::vector<multibody::Integrator>& among,
                         const PartProgress& progress_of);

}  // namespace bentaxis::study
