// What rounding leaves of the digits of a case.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bentaxis/multibody/scene.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::study {

/// Estimated rounding error of one group of reactions over its peak.
struct RoundingLine {
  std::string group;
  double inputs = 0;      ///< share of the peak
  double arithmetic = 0;  ///< share of the peak
  double theta_deg = 0;
  std::string input;  ///< the input that matters most
  double total() const { return inputs + arithmetic; }
};

/// At up to 24 angles of a turn (docs/trust.md). Milliseconds.
std::vector<RoundingLine> rounding_lines(const Case& the_case, const Assumptions& assumptions);

/// One sentence per group that rounding may change by more than 1e-9 of its peak.
std::vector<std::string> rounding_warnings(const std::vector<RoundingLine>& lines);

/// One sentence that names every group of which the driven multibody model has lost more than 1e-9
/// of its peak, and more than `lines` say: what moving every input by one unit in the last
/// place changes, at up to 24 angles. None where nothing is lost or the model refuses the case.
std::vector<std::string> multibody_warnings(const Case& the_case, const Assumptions& assumptions,
                                            const multibody::SceneChoice& scene,
                                            const std::vector<RoundingLine>& lines);

/// What moving every input by one unit in the last place changes in the driven multibody model.
struct MultibodyLosses {
  std::map<std::string, double> groups;  ///< by group of reactions, share of its scale; empty where
                                         ///< the model refuses the case
  std::string no_estimate;               ///< why there is none, or ""
  /// Of a comparison that differs: by how much columns change where they are found without
  /// constraint multipliers, share of their scale, where that is more than the tolerance.
  std::map<std::string, double> multipliers;
};
/// At up to 24 angles.
MultibodyLosses multibody_losses(const Case& the_case, const Assumptions& assumptions,
                                 const multibody::SceneChoice& scene);
/// multibody_warnings() of losses that are known already.
std::vector<std::string> multibody_warnings(const Case& the_case,
                                            const multibody::SceneChoice& scene,
                                            const std::vector<RoundingLine>& lines,
                                            const MultibodyLosses& losses);

}  // namespace bentaxis::study
