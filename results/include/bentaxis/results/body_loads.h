// What acts on each body of the pump at an instant, for its free-body diagram: reactions, applied
// loads and inertia (d'Alembert), so that forces and moments on a body sum to zero.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace bentaxis {

enum class ForceKind {
  reaction,  ///< an unknown of the equilibrium equations
  applied,   ///< oil, friction, spring, weight, film
  inertia,   ///< minus mass times acceleration, minus the rate of angular momentum
};

/// A force, with what it acts on; components in S1.
struct BodyLoad {
  std::string on;      ///< "piston 1", "block", "shaft"
  std::string by;      ///< "shaft", "oil", "gravity"; of inertia: the body itself
  std::string symbol;  ///< "Rs", "Fp", "inertia"
  std::string point;   ///< where it acts: "A1", "centre of mass"
  ForceKind kind = ForceKind::applied;
  std::array<double, 3> at = {};      ///< m, from O1
  std::array<double, 3> force = {};   ///< N
  std::array<double, 3> moment = {};  ///< Nm, beside that of the force at its point
};

/// What is left of all loads on a body.
struct BodySum {
  std::string body;
  std::array<double, 3> force = {};   ///< N
  std::array<double, 3> moment = {};  ///< Nm, about the first load's point
  double force_over_sum = 0;          ///< magnitude over the sum of the magnitudes
  double moment_over_sum = 0;         ///< likewise, of moments and of levers times forces
};

/// One for each body, in the order in which bodies first appear.
std::vector<BodySum> sums_of(const std::vector<BodyLoad>& loads);

}  // namespace bentaxis
