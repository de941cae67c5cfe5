// What is asked first of the reactions of a run: the drive torque, the largest forces, and whether
// the model holds for them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/remarks.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// Takes a run row by row, so that a run that is not kept can be summarised too.
class TurnSummary {
 public:
  /// Of a vector, all pistons together.
  struct Peak {
    Channel channel;  ///< a component of the vector: its group, meaning and unit
    double value = not_computed();
    std::size_t row = 0;
    double theta_deg = 0;
    int piston = 0;  ///< 0: not of a piston
  };
  struct Torque {
    double mean = not_computed(), least = not_computed(), greatest = not_computed();
    double peak() const;    ///< largest magnitude
    double ripple() const;  ///< greatest less least over the mean, %; not computed where it is 0
  };

  explicit TurnSummary(const std::vector<Channel>& channels);
  explicit TurnSummary(const ResultTable& table);
  void add(double theta_deg, const double* values);

  /// Forces that are unknowns of the equilibrium, and the place of the film force, in the order of
  /// the columns; some may not be computed.
  std::vector<Peak> peaks() const;
  Torque torque() const;

  /// Both in sentences: the torque, then the largest forces.
  std::vector<std::string> answers() const;

 private:
  struct Vector {
    std::size_t group = 0;  ///< of groups_
    int piston = 0;
    std::vector<std::size_t> columns;
    double value = not_computed();
    std::size_t row = 0;
    double theta_deg = 0;
  };
  std::vector<Channel> groups_;
  std::vector<Vector> vectors_;
  std::size_t torque_column_;  ///< past the end: there is none
  std::size_t columns_;
  std::size_t rows_ = 0, torques_ = 0;
  double torque_sum_ = 0, least_torque_ = 0, greatest_torque_ = 0;
};

/// What must hold and does not, each in a sentence.
/// @param time_s  of the rows, of a motion; empty: the limits are of a turn
std::vector<std::string> limit_answers(const std::vector<analytic::ValidityLimit>& limits,
                                       const std::vector<double>& time_s = {});
/// The same with what it means.
std::vector<Warning> limit_warnings(const std::vector<analytic::ValidityLimit>& limits,
                                    const std::vector<double>& time_s = {});
/// "over 7.5 % of the turn", "in 7.5 % of the rows": the share in which any of the limits does not
/// hold; "" where all do.
std::string not_valid_text(const std::vector<analytic::ValidityLimit>& limits,
                           const std::vector<double>& time_s = {});

/// How every such sentence begins.
inline constexpr const char* kPortTiming = "Port timing: ";
/// Which verdicts on the timing of the ports exceed their limits, in a sentence.
std::string timing_answer(const std::vector<TimingRow>& rows);

/// Limits of one turn by the analytic model, of a run that is not kept or not yet made: at the
/// angles of the case, so that it says what a comparison of the case says, or at the most of them.
inline constexpr int kMaxAnglesOfLimits = 3600;
std::vector<analytic::ValidityLimit> limits_of_turn(Case the_case, const Assumptions& assumptions,
                                                    const PressureTrace& pressure);

}  // namespace bentaxis::study
