#include "bentaxis/multibody/piston_solver.h"

#include <algorithm>
#include <cmath>

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::Mat33;
using SimTK::Stage;
using SimTK::State;
using SimTK::Vec3;
using SimTK::Vector;

namespace {

// Errors below this share of the piston's length are round-off of coordinates.
constexpr double kRoundOff = 1e-15;
// Turn of a piston, rad, that changes the matrix of its equations by round-off alone.
constexpr double kSameMatrix = 2e-14;
// Turn of a piston, rad, after which the matrix of its equations is found afresh: a matrix that is
// off by this much still gains five digits a step.
constexpr double kStale = 1e-5;
constexpr int kMostSteps = 30;

}  // namespace

PistonSolver::PistonSolver(const SimTK::MultibodySystem& system,
                           const SimTK::SimbodyMatterSubsystem& matter,
                           const SimTK::MobilizedBody& shaft,
                           const std::vector<SimTK::MobilizedBody>& pistons,
                           const std::vector<InlineJoint>& bores, double piston_length, double spin,
                           const State& state)
    : system_(system),
      matter_(matter),
      shaft_(shaft),
      round_off_(kRoundOff * piston_length),
      spin_(spin) {
  for (std::size_t k = 0; k < pistons.size(); ++k) {
    Piston piston;
    piston.body = pistons[k];
    piston.row = bores[k].first_row(state);
    piston.u = piston.body.getFirstUIndex(state);
    piston.nu = piston.body.getNumU(state);
    piston.q = piston.body.getFirstQIndex(state);
    pistons_.push_back(piston);
  }
  u_like_.resize(state.getNU());
  q_like_.resize(state.getNQ());
}

Vec3 PistonSolver::axis_in_shaft(const State& state, const Piston& piston) const {
  return Vec3(piston.body.getMobilizerTransform(state).z());
}

// Row i, column j: rate of equation i per unit of speed of mobility j. The third row is the speed
// about the piston's own axis where that is free, and an empty equation where it is not.
void PistonSolver::find_matrices(const State& state) {
  if (no_bias_.size() == 0) matter_.calcBiasForMultiplyByPq(state, no_bias_);
  const int most = std::max_element(pistons_.begin(), pistons_.end(), [](auto& a, auto& b) {
                     return a.nu < b.nu;
                   })->nu;
  for (Piston& piston : pistons_) piston.matrix = Mat33(0);
  for (int j = 0; j < most; ++j) {
    u_like_ = 0;
    for (const Piston& piston : pistons_) u_like_[piston.u + j] = 1;
    matter_.multiplyByN(state, false, u_like_, q_like_);
    matter_.multiplyByPq(state, q_like_, no_bias_, rates_);
    for (Piston& piston : pistons_) {
      piston.matrix(0, j) = rates_[piston.row];
      piston.matrix(1, j) = rates_[piston.row + 1];
    }
  }
  turned_ = 0;
  for (Piston& piston : pistons_) {
    if (piston.nu == 3)
      piston.matrix[2] = ~axis_in_shaft(state, piston);
    else
      piston.matrix(2, 2) = 1;
    piston.inverse = piston.matrix.invert();
  }
}

double PistonSolver::solve_positions(State& state) {
  double before = SimTK::Infinity;
  double worst = 0;
  turned_ = SimTK::Infinity;
  for (int step = 0; step < kMostSteps; ++step) {
    system_.realize(state, Stage::Position);
    const Vector& error = state.getQErr();
    worst = 0;
    for (const Piston& piston : pistons_)
      worst = std::max({worst, std::abs(error[piston.row]), std::abs(error[piston.row + 1])});
    const bool stalled = worst < 1e3 * round_off_ && !(worst < before / 2);
    if (worst <= round_off_ || stalled || !std::isfinite(worst)) break;
    before = worst;
    if (turned_ > kStale) find_matrices(state);
    u_like_ = 0;
    double largest = 0;
    for (const Piston& piston : pistons_) {
      const Vec3 change = piston.inverse * Vec3(-error[piston.row], -error[piston.row + 1], 0);
      for (int j = 0; j < piston.nu; ++j) u_like_[piston.u + j] = change[j];
      largest = std::max(largest, change.norm());
    }
    turned_ += largest;
    matter_.multiplyByN(state, false, u_like_, q_like_);
    Vector& q = state.updQ();
    for (const Piston& piston : pistons_) {
      SimTK::Vec4 quaternion;
      for (int i = 0; i < 4; ++i) quaternion[i] = q[piston.q + i] + q_like_[piston.q + i];
      quaternion /= quaternion.norm();
      for (int i = 0; i < 4; ++i) q[piston.q + i] = quaternion[i];
    }
  }
  return worst;
}

void PistonSolver::solve_speeds(State& state) {
  if (turned_ > kSameMatrix) find_matrices(state);
  u_like_ = state.getU();
  for (const Piston& piston : pistons_)
    for (int j = 0; j < piston.nu; ++j) u_like_[piston.u + j] = 0;
  const int first = shaft_.getFirstUIndex(state);
  const Vec3 shaft_rate(u_like_[first], u_like_[first + 1], u_like_[first + 2]);
  matter_.multiplyByN(state, false, u_like_, q_like_);
  matter_.multiplyByPq(state, q_like_, no_bias_, rates_);
  Vector& u = state.updU();
  for (const Piston& piston : pistons_) {
    // Absolute speed about the axis: the shaft's share and the joint's make up the spin.
    const double own =
        piston.nu == 3 ? spin_ - dot(Vec3(piston.body.getBodyRotation(state).z()), shaft_rate) : 0;
    const Vec3 speed = piston.inverse * Vec3(-rates_[piston.row], -rates_[piston.row + 1], own);
    for (int j = 0; j < piston.nu; ++j) u[piston.u + j] = speed[j];
  }
  system_.realize(state, Stage::Velocity);
}

void PistonSolver::solve_accelerations(const State& state, Vector& udot) {
  for (const Piston& piston : pistons_)
    for (int j = 0; j < piston.nu; ++j) udot[piston.u + j] = 0;
  matter_.calcConstraintAccelerationErrors(state, udot, rates_);
  const int first = shaft_.getFirstUIndex(state);
  const Vec3 shaft_acceleration(udot[first], udot[first + 1], udot[first + 2]);
  const Vec3 shaft_rate = shaft_.getBodyAngularVelocity(state);
  for (const Piston& piston : pistons_) {
    // The spin stays: no part of the absolute angular acceleration lies along the axis.
    const Vec3 axis(piston.body.getBodyRotation(state).z());
    const Vec3 rate = piston.body.getBodyAngularVelocity(state);
    const double own =
        piston.nu == 3 ? -dot(axis, shaft_acceleration + shaft_rate % (rate - shaft_rate)) : 0;
    const Vec3 value = piston.inverse * Vec3(-rates_[piston.row], -rates_[piston.row + 1], own);
    for (int j = 0; j < piston.nu; ++j) udot[piston.u + j] = value[j];
  }
}

void PistonSolver::solve_forces(const Vector& forces, std::vector<Vec3>& bore) const {
  bore.resize(pistons_.size());
  for (std::size_t k = 0; k < pistons_.size(); ++k) {
    const Piston& piston = pistons_[k];
    Vec3 right(0);
    for (int j = 0; j < piston.nu; ++j) right[j] = forces[piston.u + j];
    bore[k] = ~piston.inverse * right;
  }
}

}  // namespace bentaxis::multibody
