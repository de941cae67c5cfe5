// Which parameters of a case would explain that results differ from a reference: what was found.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bentaxis::study {

/// Whether a parameter is a setting of the rig and no property of the pump: its speed and
/// pressures.
bool is_operating_condition(const std::string& name);

/// What changed parameters make of a difference, computed again with them: one, two, or all that
/// are left out together. The difference is the
/// sum of its squares over all channels compared, each over the peak of its reaction.
struct ExplainingChange {
  struct Parameter {
    std::string name, unit;
    double from = 0, to = 0;             ///< in the case, and where the difference is smallest
    std::vector<std::string> look_same;  ///< that these data cannot tell from it
  };
  std::vector<Parameter> parameters;
  double share = 0;              ///< of the difference that goes
  double rest_over_peak = 0;     ///< the largest difference that stays
  std::string rest_channel;      ///< where
  double rest_over_allowed = 0;  ///< the largest of the rests over what is allowed of each
};

/// Thresholds, fixed before results were seen; docs/reference_data.md says them too.
struct Explanation {
  static constexpr double kSingle = 0.95;       ///< a share from which one parameter explains
  static constexpr double kPair = 0.99;         ///< and from which two do, where no single one does
  static constexpr double kWorthNaming = 0.01;  ///< less explains nothing
  static constexpr double kMentioned = 0.4;     ///< other parameters are named above this
  /// Change over the value beyond which it is no wrong number; an operating condition may be any.
  static constexpr double kLargest = 0.5;
  /// An operating condition is named before what explains more of the difference by less than this
  /// share.
  static constexpr double kAsWell = 0.002;
  static constexpr double kLookSame =
      0.999;  ///< correlation of derivatives that cannot be told apart

  std::vector<ExplainingChange> singles;  ///< that were computed again, best first
  std::vector<ExplainingChange> pairs;    ///< likewise; only where no single one explains
  /// What other programs leave out as a whole: friction, weight, the mass of the pistons.
  std::vector<ExplainingChange> left_out;  ///< best first
  std::size_t tried = 0;                   ///< parameters that have exact derivatives
  std::string reason;                      ///< why nothing was looked for, or ""

  /// What explains the difference; nullptr where nothing does.
  const ExplainingChange* cause() const;
  /// The finding in a sentence or two.
  std::string text() const;
};

}  // namespace bentaxis::study
