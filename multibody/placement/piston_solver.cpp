#include "placement/piston_solver.h"

#include <cmath>

#include "bentaxis/results/max_abs.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::Mat33;
using SimTK::Rotation;
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
constexpr int kMaxSteps = 30;

}  // namespace

PistonSolver::PistonSolver(const SimTK::MultibodySystem& system,
                           const SimTK::SimbodyMatterSubsystem& matter,
                           const SimTK::MobilizedBody& shaft, const SimTK::MobilizedBody& block,
                           const Pistons& pistons, double piston_length, double spin,
                           const State& state)
    : system_(system),
      matter_(matter),
      shaft_(shaft),
      block_(block),
      length_(piston_length),
      round_off_(kRoundOff * piston_length),
      spin_(spin),
      bores_(*pistons.all_bores) {
  for (std::size_t k = 0; k < pistons.bodies.size(); ++k) {
    Piston piston;
    piston.body = pistons.bodies[k];
    piston.bore = pistons.bores[k];
    piston.row = pistons.bores[k].first_row(state);
    piston.u = piston.body.getFirstUIndex(state);
    piston.nu = piston.body.getNumU(state);
    piston.q = piston.body.getFirstQIndex(state);
    pistons_.push_back(piston);
  }
}

Vec3 PistonSolver::axis_in_shaft(const State& state, const Piston& piston) const {
  return Vec3(piston.body.getMobilizerTransform(state).z());
}

// Row i, column j: rate of equation i per unit of speed of mobility j. The third row is the speed
// about the piston's own axis where that is free, and an empty equation where it is not.
void PistonSolver::find_matrices(const State& state) {
  const Rotation& block = block_.getBodyRotation(state);
  turned_ = 0;
  for (Piston& piston : pistons_) {
    const Vec3 ring = length_ * Vec3(piston.body.getBodyRotation(state).z());
    const Vec3 x = block * piston.bore.axis_x();
    const Vec3 y = block * piston.bore.axis_y();
    piston.matrix = Mat33(0);
    for (int j = 0; j < piston.nu; ++j) {
      const SimTK::SpatialVec partial = piston.body.getHCol(state, SimTK::MobilizerUIndex(j));
      piston.turn[j] = partial[0];
      const Vec3 at_ring = partial[1] + partial[0] % ring;
      piston.matrix(0, j) = dot(x, at_ring);
      piston.matrix(1, j) = dot(y, at_ring);
    }
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
  for (int step = 0; step < kMaxSteps; ++step) {
    system_.realize(state, Stage::Position);
    const Vector& error = state.getQErr();
    worst = 0;
    for (const Piston& piston : pistons_)
      for (int i = 0; i < 2; ++i) update_max_abs(worst, error[piston.row + i]);
    const bool stalled = worst < 1e3 * round_off_ && !(worst < before / 2);
    if (worst <= round_off_ || stalled || !std::isfinite(worst)) break;
    before = worst;
    if (turned_ > kStale) find_matrices(state);
    double largest = 0;
    const Rotation& shaft = shaft_.getBodyRotation(state);
    changes_.clear();
    for (const Piston& piston : pistons_) {
      const Vec3 change = piston.inverse * Vec3(-error[piston.row], -error[piston.row + 1], 0);
      update_max_abs(largest, change.norm());
      // The turn of the piston in its joint that these changes of its speeds stand for.
      Vec3 turn(0);
      for (int j = 0; j < piston.nu; ++j) turn += change[j] * piston.turn[j];
      changes_.push_back(~shaft * turn);
    }
    turned_ += largest;
    Vector& q = state.updQ();
    for (std::size_t k = 0; k < pistons_.size(); ++k) {
      // q' = (0, w) q / 2 with w in the joint's fixed frame.
      double* at = &q[pistons_[k].q];
      const Vec3 w = changes_[k] / 2;
      const Vec3 v(at[1], at[2], at[3]);
      const Vec3 vector = v + at[0] * w + w % v;
      SimTK::Vec4 quaternion(at[0] - dot(w, v), vector[0], vector[1], vector[2]);
      quaternion /= quaternion.norm();
      for (int i = 0; i < 4; ++i) at[i] = quaternion[i];
    }
  }
  return worst;
}

void PistonSolver::allowed_speeds(const State& state, const Vec3& shaft_rate,
                                  const Vec3& block_rate, double spin, Vector& u) const {
  const Rotation& block = block_.getBodyRotation(state);
  const Vec3& block_origin = block_.getBodyOriginLocation(state);
  for (const Piston& piston : pistons_) {
    // B as if it stood still in the shaft, against the material of the block that it passes.
    const SimTK::Transform& place = piston.body.getBodyTransform(state);
    const Vec3 ring = place.p() + length_ * Vec3(place.z());
    const Vec3 passing = shaft_rate % ring - block_rate % (ring - block_origin);
    // Absolute speed about the axis: the shaft's share and the joint's make up the spin.
    const double own = piston.nu == 3 ? spin - dot(Vec3(place.z()), shaft_rate) : 0;
    const Vec3 speed = piston.inverse * Vec3(-dot(block * piston.bore.axis_x(), passing),
                                             -dot(block * piston.bore.axis_y(), passing), own);
    for (int j = 0; j < piston.nu; ++j) u[piston.u + j] = speed[j];
  }
}

double PistonSolver::solve_speeds(State& state) {
  if (turned_ > kSameMatrix) find_matrices(state);
  Vector& u = state.updU();
  const int first = shaft_.getFirstUIndex(state);
  const Vec3 shaft_rate(u[first], u[first + 1], u[first + 2]);
  const Vec3 block_rate = u[block_.getFirstUIndex(state)] * Vec3(block_.getBodyRotation(state).z());
  allowed_speeds(state, shaft_rate, block_rate, spin_, u);
  system_.realize(state, Stage::Velocity);
  const Vector& error = state.getUErr();
  double worst = 0;
  for (const Piston& piston : pistons_)
    for (int i = 0; i < 2; ++i) update_max_abs(worst, error[piston.row + i]);
  return worst;
}

void PistonSolver::solve_accelerations(const State& state, Vector& udot) {
  for (const Piston& piston : pistons_)
    for (int j = 0; j < piston.nu; ++j) udot[piston.u + j] = 0;
  matter_.calcBodyAccelerationFromUDot(state, udot, accelerations_);
  bores_.acceleration_errors(state, accelerations_, errors_);
  const int first = shaft_.getFirstUIndex(state);
  const Vec3 shaft_acceleration(udot[first], udot[first + 1], udot[first + 2]);
  const Vec3 shaft_rate = shaft_.getBodyAngularVelocity(state);
  for (std::size_t k = 0; k < pistons_.size(); ++k) {
    const Piston& piston = pistons_[k];
    double own = 0;
    if (piston.nu == 3) {
      // The spin stays: no part of the absolute angular acceleration lies along the axis.
      const Vec3 axis(piston.body.getBodyRotation(state).z());
      const Vec3 rate = piston.body.getBodyAngularVelocity(state);
      own = -dot(axis, shaft_acceleration + shaft_rate % (rate - shaft_rate));
    }
    const Vec3 value = piston.inverse * Vec3(-errors_[2 * k], -errors_[2 * k + 1], own);
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
