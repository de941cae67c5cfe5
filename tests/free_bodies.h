// Free-body diagrams of pistons, block and shaft, written out from the columns of a result: what is
// left of forces and moments. Positions as in docs/theory.md, derivatives by jets; no code of a
// model.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/teeth.h"

namespace bentaxis::test {

/// Sum of forces and moments on one body over the sum of their magnitudes.
class FreeBody {
 public:
  using V = Eigen::Vector3d;
  void force(const V& at, const V& f) {
    force_ += f;
    moment_ += at.cross(f);
    force_scale_ += f.norm();
    moment_scale_ += at.norm() * f.norm();
  }
  void moment(const V& m) {
    moment_ += m;
    moment_scale_ += m.norm();
  }
  double residual() const {
    const auto over = [](double a, double b) { return b > 0 ? a / b : a; };
    return std::max(over(force_.norm(), force_scale_), over(moment_.norm(), moment_scale_));
  }

 private:
  V force_ = V::Zero(), moment_ = V::Zero();
  double force_scale_ = 0, moment_scale_ = 0;
};

/// Friction (25) along z2 on a piston whose ring moves with `velocity`; written out here, because
/// each model has a law of its own.
double ring_friction(const Friction& f, double velocity, double rest_speed);

/// Largest residual of all bodies, in S1. `values` are SI, ordered by ChannelLayout. Needs the gear
/// in mesh.
/// @param teeth  where not null: what acts between shaft and block, instead of Rcs at O4
double free_body_residual(const PumpParameters& p, const Assumptions& assumptions, const Instant& t,
                          const std::vector<double>& values, const TeethAction* teeth = nullptr);

}  // namespace bentaxis::test
