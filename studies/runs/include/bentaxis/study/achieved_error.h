// How far a run is from the solution it should have found.
#pragma once

#include <string>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/multibody/scene.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// What counts as agreement where the user names no tolerance: largest difference over the peak.
inline constexpr double kDrivenTolerance = 1e-9;  ///< both models are exact to round-off

/// Largest differences over the peak of each group of reactions; not_computed() where neither table
/// has a value, where one of them lacks a value that it should have, and of what the scene leaves
/// out.
struct AchievedError {
  double rs = not_computed();
  double rc = not_computed();
  double bearings = not_computed();  ///< Rb1 and Rb2
  double rcs = not_computed();
  double td = not_computed();
  double worst = 0;           ///< of all reactions
  std::string worst_channel;  ///< where
};

/// What channels are held to whose peak is zero, per unit: the largest applied load of the case.
compare::ZeroScales zero_scales(const Case& the_case, const Samples& samples);

/// @param reference  the right curves at the same angles
/// @param scene      that computed `table`
AchievedError achieved_error(const Case& the_case, const Samples& samples,
                             const ResultTable& reference, const ResultTable& table,
                             multibody::Scene scene = multibody::Scene::full);

}  // namespace bentaxis::study
