// The map of one N-th of a turn, and the search for the state that it repeats.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "integrator.h"
#include "network.h"

namespace bentaxis::hydraulics {

/// What the size of a load that is sought is determined by.
enum class Sizing {
  mean_pressure,  ///< the mean delivery pressure asked for: its ln is one more unknown
  closed,         ///< it lets nothing pass: the delivery pressure becomes the largest reachable
};

/// Residual of the periodic state as a function of z: the network's states at theta = 0, and ln of
/// the load's size where it is sought and `Sizing::mean_pressure`.
class PeriodMap {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  PeriodMap(const Network& network, Sizing sizing, Integrator& integrator)
      : network_(network),
        integrator_(integrator),
        sizing_(sizing),
        sized_(sizing == Sizing::mean_pressure && network.load_sought()) {}

  int unknowns() const { return network_.states() + (sized_ ? 1 : 0); }
  double load_size(const Vector& z) const;
  std::vector<double> states(const Vector& z) const;

  /// States at the end of a period in the order of the chambers that stand there next: chamber k
  /// has come to where chamber k-1 began, backwards where chamber k+1 did.
  std::vector<double> relabelled(const std::vector<double>& end) const;

  /// What is left: per state its change over the period, and where the load is sought the mean over
  /// the one asked for, less 1.
  Vector residual(const Vector& z, double tolerance, Matrix* jacobian = nullptr,
                  Integrals* integrals = nullptr, const Integrator::Watch& watch = {});
  /// Noise of the residual over the error allowed per step, from many steps and restarts; waves in
  /// a delivery line carry it on.
  double noise() const { return network_.has_delivery_line() ? 200 : 20; }
  /// Mean delivery pressure of the last residual, Pa gauge.
  double mean_delivery() const { return mean_; }

 private:
  const Network& network_;
  Integrator& integrator_;
  Sizing sizing_;
  bool sized_;
  double mean_ = 0;
};

/// Largest component.
double size_of(const PeriodMap::Vector& v);

/// Damped Newton method with the sensitivities of every iterate, down to the noise of integrations
/// at `tolerance`, or until nothing improves.
/// @param jacobian    of the last z
/// @param iterations  counted on
/// @throws ComputationError where the steps do not settle
void search(PeriodMap& map, PeriodMap::Vector& z, double tolerance, PeriodMap::Matrix& jacobian,
            int& iterations, const std::function<void()>& alive);

}  // namespace bentaxis::hydraulics
