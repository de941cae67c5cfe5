// What bevel teeth in contact do to each other at an instant, and as a table.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis {

/// A pair of teeth that may touch. Vectors are in S1; O2 is where the axes meet.
struct PairContact {
  int flank = 1;        ///< +1: the shaft pushes the block towards +psi; -1: towards -psi
  int shaft_tooth = 0;  ///< 1..Z, numbered as ToothErrors says
  int block_tooth = 0;  ///< flank +1: the one before it, i - 1; flank -1: the one of its number
  double approach = 0;  ///< at O4's distance from O2, less errors, relief and half the backlash, m;
                        ///< < 0: the gap
  double force = 0;     ///< of the whole face width, N, >= 0
  /// Where the force acts, from O2, m: in the middle between the points of both flanks that are
  /// nearest to each other, at the distance of the resultant. Of a pair without force: undefined.
  std::array<double, 3> point = {};
  std::array<double, 3> normal = {};  ///< unit vector, of the force on the block
};

/// Most pairs of a flank that are looked at: those of the shaft's tooth nearest to O4, of the one
/// before and of the one after it.
inline constexpr int kPairsPerFlank = 3;
/// The pairs of TeethAction, in words.
inline constexpr std::array<const char*, 2 * kPairsPerFlank> kPairNames = {
    "flank +1, pair at O4", "flank +1, pair before", "flank +1, pair after",
    "flank -1, pair at O4", "flank -1, pair before", "flank -1, pair after"};
/// Contact ratios above it are refused: more pairs than kPairsPerFlank might carry.
inline constexpr double kLargestContactRatio = 2.5;

/// State of all teeth.
struct TeethAction {
  double lag = 0;  ///< theta - psi of the teeth, rad
  /// By flank (+1, then -1) and, within it, by the shaft's tooth: nearest to O4 (the tooth i for
  /// which theta Z / 2 pi + 1/2 lies in [i - 1, i)), the one before it (i - 1, which has passed O4
  /// where theta grows), the one after it.
  std::array<PairContact, 2 * kPairsPerFlank> pairs = {};
  std::array<double, 3> force = {};   ///< on the block, S1, N; the opposite on the shaft
  std::array<double, 3> moment = {};  ///< on the block about O2, S1, Nm; likewise
};

/// Table of the teeth over a turn: lag_urad; transmission_error_um, the lag along the line of
/// action at O4; plus_force_N, minus_force_N by flank; and per pair and flank shaft tooth, force,
/// share of the flank's force, point and normal.
ResultTable teeth_table(const std::string& model);
/// Adds the row of an instant.
/// @param gear  of the pump: its arm turns the lag into a length
/// @throws ComputationError where a value is not finite
void append_teeth(ResultTable& table, double theta_deg, const Gear& gear,
                  const TeethAction& action);

}  // namespace bentaxis
