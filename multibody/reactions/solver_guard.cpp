#include "reactions/solver_guard.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"

namespace bentaxis::multibody {

using SimTK::Matrix;
using SimTK::Vector;

namespace {

// Directions below this share of the largest pivot cannot be told from round-off.
constexpr double kPivot = 1e-15;

// The last equation may drive the shaft: its multiplier is a torque, the others are forces.
double largest_force(const Vector& multipliers, double last_factor) {
  double largest = 0;
  for (int i = 0; i < multipliers.size(); ++i)
    update_max_abs(largest, multipliers[i] * (i + 1 == multipliers.size() ? last_factor : 1));
  return largest;
}

bool is_finite(const Vector& v) {
  for (int i = 0; i < v.size(); ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

// Singular values of the scaled constraint matrix below this share of the largest count as zero.
constexpr double kRankTolerance = 1e-11;

// An error estimate is right within this factor.
constexpr double kSameSize = 10;

ComputationError not_finite(const char* whose, double theta) {
  return ComputationError(
      std::string("multibody model: ") + whose +
      " reactions that are not finite at theta = " + number_text(theta / kRadPerDegree) + " deg");
}

// What the multipliers lose and why, without what they were held to.
std::string lost_forces(double error, double theta) {
  return "multibody model: Simbody's constraint solver is inaccurate at theta = " +
         number_text(theta / kRadPerDegree) + " deg: about " + short_text(error) +
         " of the largest would be wrong, allowed " + short_text(kLargestForceError);
}

constexpr const char* kCauses =
    "; bodies of very different mass, or constraints that are almost dependent (bearings close "
    "together or far away, small gear, pistons near the assembly limit, rods without inertia "
    "about their axis); use --reactions residual, or the analytic model";

}  // namespace

std::string short_text(double error) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), error,
                                    std::chars_format::scientific, 1);
  return {text.data(), result.ptr};
}

double estimated_force_error(const PumpSystem& pump, const SimTK::State& state) {
  const Vector& error = state.getUDotErr();
  if (error.size() == 0) return 0;
  if (!is_finite(error) || !is_finite(state.getMultipliers())) return SimTK::NaN;
  const auto& matter = pump.matter();
  Matrix g;
  matter.calcG(state, g);
  Matrix transposed(g.ncol(), g.nrow());
  for (int i = 0; i < g.nrow(); ++i)
    for (int j = 0; j < g.ncol(); ++j) transposed(j, i) = g(i, j);
  Vector acceleration(g.ncol());
  Vector inertia_force;
  Vector multipliers(g.nrow());
  SimTK::FactorQTZ(g, kPivot).solve(error, acceleration);
  matter.multiplyByM(state, acceleration, inertia_force);
  SimTK::FactorQTZ(transposed, kPivot).solve(inertia_force, multipliers);
  const double arm = pump.drive().has_torque_as_last_multiplier()
                         ? 1 / pump.pump().geometry.joint_circle_radius
                         : 1;
  const double off = largest_force(multipliers, arm);
  const double scale = largest_force(state.getMultipliers(), arm);
  return off == 0 ? 0 : off / scale;
}

double force_difference(const PumpSystem& pump, const Reactions& reactions,
                        const Reactions& others) {
  double off = 0;
  double largest = 0;
  const auto look = [&](const SimTK::Vec3& a, const SimTK::Vec3& b) {
    update_max_abs(off, (a - b).norm());
    update_max_abs(largest, b.norm());
  };
  for (std::size_t k = 0; k < others.pistons.size(); ++k) {
    look(reactions.pistons[k].joint, others.pistons[k].joint);
    look(reactions.pistons[k].bore, others.pistons[k].bore);
  }
  if (!pump.is_prescribed()) {
    look(reactions.block_hold[1], others.block_hold[1]);
    look(reactions.tapered, others.tapered);
    look(reactions.cylindrical, others.cylindrical);
    const double arm = 1 / pump.pump().geometry.joint_circle_radius;
    look({arm * reactions.drive, reactions.tooth, arm * reactions.imposed},
         {arm * others.drive, others.tooth, arm * others.imposed});
    look(arm * reactions.couple, arm * others.couple);
    look(reactions.side_force, others.side_force);
  }
  return off == 0 ? 0 : off / largest;
}

void require_accurate_forces(double error, double theta) {
  if (error <= kLargestForceError) return;
  if (!std::isfinite(error)) throw not_finite("Simbody's constraint solver returns", theta);
  throw ComputationError(lost_forces(error, theta) + kCauses);
}

Fault fault_of(double difference, double estimated) {
  if (!(estimated < difference / kSameSize)) return Fault::multipliers;
  return estimated <= kLargestForceError ? Fault::inverse_dynamics : Fault::undecided;
}

void require_agreement(double difference, const std::function<double()>& estimated, double theta) {
  if (difference <= kLargestForceError) return;
  const double own = estimated();
  if (!std::isfinite(own)) throw not_finite("Simbody's constraint solver returns", theta);
  if (!std::isfinite(difference)) throw not_finite("inverse dynamics returns", theta);
  const std::string figures = " (difference from inverse dynamics " + short_text(difference) +
                              ", estimated error of the multipliers " + short_text(own) + ")";
  switch (fault_of(difference, own)) {
    case Fault::multipliers:
      throw ComputationError(lost_forces(difference, theta) + figures + kCauses);
    case Fault::inverse_dynamics:
      throw ComputationError(
          "multibody model: inverse dynamics contradicts Simbody's constraint solver at theta = " +
          number_text(theta / kRadPerDegree) +
          " deg; the error is in inverse dynamics, because the estimated error of the multipliers "
          "does not explain it" +
          figures + "; use the analytic model");
    case Fault::undecided:
      break;
  }
  throw ComputationError(
      "multibody model: inverse dynamics contradicts Simbody's constraint solver at theta = " +
      number_text(theta / kRadPerDegree) + " deg and neither is known to be right" + figures +
      "; use the analytic model");
}

Rank constraint_rank(const PumpSystem& pump, const SimTK::State& state) {
  Matrix g;
  pump.matter().calcG(state, g);
  Rank result;
  result.equations = g.nrow();
  result.mobilities = g.ncol();
  // Rows are in units of the constraints (speeds of points, angular speed): scaled to length 1.
  for (int i = 0; i < g.nrow(); ++i) g[i] /= std::max(g[i].norm(), 1e-300);
  SimTK::FactorSVD svd(g);
  Vector singular_values;
  svd.getSingularValues(singular_values);
  for (int i = 0; i < singular_values.size(); ++i)
    if (singular_values[i] > kRankTolerance * singular_values[0]) ++result.rank;
  return result;
}

void translate_simbody_errors(const std::function<void()>& job) {
  try {
    job();
  } catch (const SimTK::Exception::Base& error) {
    std::string why = error.getMessageText();
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw ComputationError("multibody model: Simbody refused: " + why);
  }
}

}  // namespace bentaxis::multibody
