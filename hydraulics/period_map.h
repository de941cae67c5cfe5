// The map of one N-th of a turn, and the search for the state that it repeats.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "integrator.h"
#include "network.h"

namespace bentaxis::hydraulics {

/// What the size of the load orifice is determined by.
enum class Load {
  mean_pressure,  ///< the mean delivery pressure asked for: its ln is one more unknown
  closed,         ///< it lets nothing pass: the delivery pressure becomes the largest reachable
};

/// Residual of the periodic state as a function of z: the pressures s = ln(P/P0) at theta = 0 and,
/// with `Load::mean_pressure` and no open line, ln of the load area in m2.
class PeriodMap {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  PeriodMap(const Network& network, Load load, Integrator& integrator)
      : network_(network),
        integrator_(integrator),
        sized_(load == Load::mean_pressure && !network.open_line()) {}

  int unknowns() const { return network_.pressures() + (sized_ ? 1 : 0); }
  double load_area(const Vector& z) const;
  std::vector<double> pressures(const Vector& z) const;

  /// Pressures at the end of a period in the order of the chambers that stand there next: chamber k
  /// has come to where chamber k-1 began.
  std::vector<double> relabelled(const std::vector<double>& end) const;

  /// What is left: per unknown the change of s over the period, and the mean over the one asked
  /// for, less 1.
  Vector residual(const Vector& z, double tolerance, Matrix* jacobian = nullptr,
                  Integrals* integrals = nullptr, const Integrator::Watch& watch = {});

 private:
  const Network& network_;
  Integrator& integrator_;
  bool sized_;
};

/// Largest component.
double size_of(const PeriodMap::Vector& v);

/// Noise of the residual over the error allowed per step, from many steps and restarts.
inline constexpr double kNoise = 20;

/// Damped Newton method with the sensitivities of every iterate, down to the noise of integrations
/// at `tolerance`, or until nothing improves.
/// @param jacobian    of the last z
/// @param iterations  counted on
/// @throws ComputationError where the steps do not settle
void search(PeriodMap& map, PeriodMap::Vector& z, double tolerance, PeriodMap::Matrix& jacobian,
            int& iterations, const std::function<void()>& alive);

}  // namespace bentaxis::hydraulics
