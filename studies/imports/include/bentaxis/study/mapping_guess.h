// What the columns of a foreign record stand for, guessed from the curves themselves by holding
// them to a model's curves.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// What is proposed for a column, or for the columns of a vector together.
struct MappingProposal {
  std::string theirs, ours;
  int sign = 1;
  std::string unit;
  double correlation = 0;  ///< of both curves about their means, in the end mapped
  double difference = 0;   ///< root mean square at the record's angles, over that of the curve
  std::string remark;      ///< "its name says so, its curve does not", ..
};

/// A proposed mapping of a whole file.
struct MappingGuess {
  compare::CurveDescription curve;                           ///< guessed = true
  std::vector<MappingProposal> proposals;                    ///< worst first
  std::vector<std::pair<std::string, std::string>> ignored;  ///< columns, and why
  /// Of those ignored: columns whose names or sizes say a channel, but whose correlation with its
  /// curve is too small. They stand for nothing until someone says what they are.
  std::vector<std::string> unrecognised;
  double rounding = 0;  ///< of the values, over the peak of their group: the largest of all
  int digits = 0;       ///< significant ones of the columns that are mapped
  int samples = 0;      ///< per turn of a run that has the record's angles; 0 = none has
  std::string euler;    ///< of a frame at Euler angles: their sequence
  std::array<double, 3> euler_deg{};
  /// A small phase shift that fits better but not well, as a wrong port timing would too: not
  /// taken.
  double shift_not_taken_deg = 0;

  std::size_t recognised() const;  ///< columns that stand for a result
};

/// Proposes a mapping. It can choose, and nothing else:
/// - per file: column, unit and direction of the angle; one phase shift; one frame: the axes of
///   each reaction, of S1 or of S2, these exchanged and turned by right angles, or those of S1
///   turned by any angles, but not by less than 5 deg from axes at right angles; one numbering of
///   the pistons;
/// - per quantity: one sign (the force on the other body); a turned frame and a sign together only
///   where two vectors show it;
/// - per column or vector: channel and unit, of a list of units.
/// The phase shift is the roundest angle that fits as well as the best one; one below 10 deg is
/// taken only where without it curves differ ten times as much. No factor, scale or
/// offset is fitted, and no sign of a single component: what is wrong in a model stays wrong.
/// @param model  one turn at equal steps
/// @param frames  of the case
/// @param degrees_per_second  of the shaft, for a record over time
/// @param model_at  the same at other angles: what is shown of a proposal is compared at the
///                  record's own, and nothing is interpolated; no function: at those of `model`
/// @throws InputError where no column can be the angle or no column fits any channel
MappingGuess guess_mapping(const ForeignTable& table, const ResultTable& model,
                           const compare::FrameAxes& frames, double degrees_per_second,
                           const compare::ResultAt& model_at = {});

}  // namespace bentaxis::study
