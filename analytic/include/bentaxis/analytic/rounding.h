// What the rounding of numbers to double does to the reactions.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/instant.h"

namespace bentaxis::analytic {

/// First-order estimate of the error that rounding leaves in each reaction at an instant.
///
/// Two parts, added. *Inputs*: no number of a case file is a double, nor is its SI value; each is
/// off by up to one unit in its last place (2^-52 of itself). The effects of all inputs on a
/// reaction, taken one by one, are added with their magnitudes. Near the assembly limit this is the
/// amplification b1/(z_B - z_A), with bearings close together their distance from the load over
/// their distance from each other. No arithmetic can do better. *Arithmetic*: the same evaluation
/// with every operation rounded up, down and towards zero (W. Kahan, "How futile are mindless
/// assessments of roundoff in floating-point computation?", 2006); the largest change.
class RoundingEstimate {
 public:
  /// @throws InputError as Model
  RoundingEstimate(const PumpParameters& pump, const Assumptions& assumptions);

  /// Error of every reaction at an instant, SI, ordered by the model's layout. 0 where a reaction
  /// is not computed, and of other channels.
  struct Parts {
    std::vector<double> inputs;
    std::vector<double> arithmetic;
    std::vector<std::string> worst_input;  ///< the input with the largest effect; "" where none
  };

  /// @param pressure_rounding  Pa, by how much each chamber pressure may be off
  /// @param trace              where pistons drive the block: their pressures. Each evaluation then
  ///                           finds the block's lag itself, and the instant is one of constant
  ///                           speed
  void estimate(const Instant& instant, const std::vector<double>& pressure_rounding, Parts& parts,
                const PressureTrace* trace = nullptr) const;

  const ChannelLayout& layout() const { return model_.layout(); }

 private:
  struct Perturbed {
    std::string input;
    Model model;
    double per_change;  // rounding error of the input over the change made
  };

  PumpParameters pump_;
  Model model_;
  std::vector<Perturbed> perturbed_;
  std::vector<Model> directed_;  // made under each of the other rounding modes
};

/// By how much a chamber pressure of a trace may be off at a chamber angle: its own rounding and
/// that of the angle, Pa.
double pressure_rounding(const PressureTrace& trace, double theta_k_deg);

/// Estimated rounding error of one scale group of reactions over a turn.
struct GroupRounding {
  std::string group;      ///< "Rs"
  double inputs = 0;      ///< largest over the turn, in the group's unit
  double arithmetic = 0;  ///< likewise
  double theta_deg = 0;   ///< where the sum of both is largest
  std::string input;      ///< that matters most there
  double total() const { return inputs + arithmetic; }
};

/// The estimate over the samples of a case, thinned out to at most `most_angles`.
std::vector<GroupRounding> estimate_rounding(const Case& the_case, const Assumptions& assumptions,
                                             const Samples& samples, const PressureTrace& trace,
                                             std::size_t most_angles = 24);

}  // namespace bentaxis::analytic
