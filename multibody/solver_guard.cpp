#include "solver_guard.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {

using SimTK::Matrix;
using SimTK::Vector;

namespace {

// Directions below this share of the largest pivot cannot be told from round-off.
constexpr double kPivot = 1e-15;

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

double largest_magnitude(const Vector& v, double last_factor) {
  double largest = 0;
  for (int i = 0; i < v.size(); ++i)
    largest = std::max(largest, std::abs(v[i]) * (i + 1 == v.size() ? last_factor : 1));
  return largest;
}

}  // namespace

double estimated_force_error(const PumpSystem& pump, const SimTK::State& state) {
  const Vector& error = state.getUDotErr();
  if (error.size() == 0) return 0;
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
  // The last equation drives the shaft: its multiplier is a torque, the others are forces.
  const double arm = 1 / pump.pump().geometry.joint_circle_radius;
  const double off = largest_magnitude(multipliers, arm);
  const double scale = largest_magnitude(state.getMultipliers(), arm);
  return off > 0 ? off / scale : 0;
}

double force_difference(const PumpSystem& pump, const Reactions& reactions,
                        const Reactions& others) {
  double off = 0;
  double largest = 0;
  bool finite = true;
  const auto look = [&](const SimTK::Vec3& a, const SimTK::Vec3& b) {
    finite = finite && a.isFinite() && b.isFinite();
    off = std::max(off, (a - b).norm());
    largest = std::max(largest, b.norm());
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
    look({arm * reactions.drive, reactions.tooth, 0}, {arm * others.drive, others.tooth, 0});
  }
  if (!finite) return SimTK::Infinity;
  return off > 0 ? off / largest : 0;
}

void require_accurate_forces(double error, double theta) {
  if (error <= kLargestForceError) return;
  throw ComputationError(
      "multibody model: Simbody's constraint solver loses the reactions at theta = " +
      number_text(theta / kRadPerDegree) + " deg: about " + short_text(error) +
      " of the largest would be wrong, allowed " + short_text(kLargestForceError) +
      "; bodies of very different mass, or constraints that are almost dependent (bearings close "
      "together or far away, small gear, pistons near the assembly limit, rods without inertia "
      "about their axis); use --reactions residual, or the analytic model");
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
