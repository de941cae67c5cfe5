// What can explain the paper's 16.49 Nm of torque from shaft to block at theta = 0 against 14.22 Nm
// of ADAMS (Roccatello & Nervegna 2009, footnote 9)? docs/shaft_to_block_torque.md.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/study/run.h"

namespace bentaxis::study {

inline constexpr double kPaperBlockTorque = 16.49;  ///< Nm, by the paper's model
inline constexpr double kAdamsBlockTorque = 14.22;  ///< Nm, by its ADAMS model

/// A pump with one thing changed: Tcs at theta = 0 by both models, Nm.
struct BlockTorque {
  int group = 0;     ///< what was changed: friction, pressure, geometry
  std::string what;  ///< in words
  double analytic = 0, multibody = 0;
  double change = 0;    ///< of the analytic model against the first row
  bool has_gap = true;  ///< the pump, pressure and speed are those that the two torques are of
  double share() const { return change / (kPaperBlockTorque - kAdamsBlockTorque); }
};

/// One thing changed at a time in a pump, against that pump without piston friction.
/// @param ideal      the rated pump with an ideal pressure trace
/// @param hydraulic  the same with the hydraulic model
/// @throws InputError where the changes mean nothing for the cases; ComputationError
std::vector<BlockTorque> block_torques(const Case& ideal, const Case& hydraulic,
                                       const PartProgress& progress_of = silent());

/// The rows as a table.
std::string block_torque_text(const std::vector<BlockTorque>& rows);

}  // namespace bentaxis::study
