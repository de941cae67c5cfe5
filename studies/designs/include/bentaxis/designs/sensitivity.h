// How outputs of one design change with its parameters: derivatives, each with how it was found.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/designs/output.h"
#include "bentaxis/designs/variable.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::designs {

/// Where a derivative comes from.
enum class Way {
  exact,        ///< numbers that carry derivatives through the closed form: right to round-off
  forward,      ///< exact, through the pressures' own derivatives: CVODES' forward sensitivities
  differences,  ///< central differences, extrapolated to no step (Ridders 1982)
};
std::string to_string(Way way);

struct Derivative {
  double value;  ///< in the files' units; not_computed() where there is none
  /// Of differences: estimate; of forward sensitivities: what ten times their tolerance changes. Of
  /// an exact one 0, but at a kink, where several samples attain an
  /// extreme: derivatives to either side are value - error and value + error.
  double error = 0;
  Way way = Way::exact;
  std::string reason = {};  ///< why there is none
};

/// Derivatives of outputs with respect to parameters, at a case.
struct Sensitivities {
  Case base;
  study::Model model = study::Model::analytic;
  std::vector<Variable> variables;
  std::vector<Output> outputs;
  std::vector<double> at;      ///< of the variables
  std::vector<double> values;  ///< of the outputs
  /// The scale of differences of outputs: the peak over the turn of what a statistic is of;
  /// of others the magnitude.
  std::vector<double> scales;
  std::vector<std::vector<Derivative>> derivatives;  ///< by output, then variable
  /// Variables whose differences an interruption has left out, where finished ones are kept.
  std::vector<std::string> left_out = {};

  /// Percent of the output per percent of the variable; not_computed() where one of them is 0.
  double elasticity(std::size_t output, std::size_t variable) const;
};

/// Every number of a case that has something to do in it, but how finely a turn is cut.
std::vector<Variable> continuous_variables(const Case& base);

/// Takes the reactions at one sample of a turn, and their derivatives by each variable in turn, in
/// SI over the variable's unit in files.
using ReactionVisitor = std::function<void(std::size_t row, const std::vector<double>& values,
                                           const std::vector<double>& derivatives)>;
/// Exact derivatives of all reactions over a driven turn, by the analytic model, with respect to
/// every continuous variable that has them.
/// @param theta_deg  angles; without them those of the case's samples
/// @return these variables, in the order of the derivatives
/// @throws InputError, ComputationError
std::vector<Variable> differentiate_reactions(
    const Case& base, const ReactionVisitor& visit,
    const study::PartProgress& progress_of = study::silent(),
    const std::optional<std::vector<double>>& theta_deg = std::nullopt);

/// Derivatives at the case itself. Exact are those by the analytic model of statistics of
/// reactions, without teeth, with respect to what pump, speed and pressure are made of; under
/// hydraulic pressure, but for a spline in its place, they are forward sensitivities; a largest or
/// least value changes as at the sample that attains it.
/// @param keep_finished  where progress interrupts the differences, what is finished is the result
///                       (`left_out` names the rest), if anything is
/// @throws InputError where a variable is no continuous number, or as the case; ComputationError
Sensitivities sensitivities(const Case& base, const std::vector<Variable>& variables,
                            const std::vector<Output>& outputs,
                            study::Model model = study::Model::analytic,
                            const study::PartProgress& progress_of = study::silent(),
                            bool keep_finished = false);

/// Two ways to find derivatives, set against each other.
struct SensitivityCheck {
  /// Largest difference that is allowed: of an output over its scale, per relative change of the
  /// parameter. What differences of a model lose to its round-off.
  static constexpr double kTolerance = 1e-7;

  Sensitivities other;
  /// Over that scale; by output, then variable. Of an output that is not computed independently
  /// (`why_not_independent`) not computed.
  std::vector<std::vector<double>> differences;
  double worst = 0;
  std::size_t output = 0, variable = 0;  ///< of the worst
  /// Not compared: neither model has one, one of them refuses the neighbours, or differences are
  /// not as sharp.
  std::size_t missing = 0;
  std::size_t shared = 0;    ///< not compared: of outputs that are not computed independently
  std::size_t lacking = 0;   ///< one model alone gives no value, or none that is finite
  std::size_t compared = 0;  ///< the others
  bool agrees() const { return compared > 0 && lacking == 0 && worst <= kTolerance; }
};
/// Sets derivatives against those of the other model at the same place.
SensitivityCheck compare_derivatives(const Sensitivities& found, Sensitivities other);
/// The same derivatives by differences of the other model, of the outputs that it computes
/// independently.
SensitivityCheck check(const Sensitivities& found,
                       const study::PartProgress& progress_of = study::silent());

}  // namespace bentaxis::designs
