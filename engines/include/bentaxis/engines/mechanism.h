// A pump as any engine of rigid bodies is given it: bodies, joints, loads and motion as numbers.
// SI units, components in S1 unless said otherwise.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/samples.h"

namespace bentaxis::engines {

using Vector = Eigen::Vector3d;
/// A force and its moment about O1, the origin of S1.
using Wrench = Eigen::Matrix<double, 6, 1>;
Wrench force_at(const Vector& point, const Vector& force);
Wrench couple(const Vector& moment);

/// What a joint lets a body do: turn about or slide along an axis, which stands in its own frame.
struct Freedom {
  bool turns = true;
  Vector axis = Vector::UnitZ();
  bool driven = false;  ///< where it is integrated: keeps its velocity
};

/// A body with the joint to its parent. Its origin is the joint's point.
struct Body {
  std::string name;
  int parent = -1;                                     ///< -1: the world
  Vector place = Vector::Zero();                       ///< of its origin in the parent's frame
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< there, all coordinates 0
  std::vector<Freedom> freedoms = {};                  ///< one after the other
  double mass = 0;
  Vector centre = Vector::Zero();   ///< of mass, in its own frame
  Vector inertia = Vector::Zero();  ///< about it, along its own axes
};

/// A force of unknown size and its opposite: what one body does to another. Its wrenches at a
/// sample, for size 1, are those of Instant.
struct Action {
  std::string name;
  int on = 0, by = -1;     ///< bodies; -1: the world
  bool two_sided = false;  ///< where its size is negative it is that of State::other_sides
};

/// A point of one body stays on a point of another.
struct Loop {
  int on = 0, by = 0;                                           ///< bodies
  Vector point_on = Vector::Zero(), point_by = Vector::Zero();  ///< in their frames
  int action = 0;  ///< the first of three actions, which are its force
};

/// What the joint of a body carries.
struct Support {
  std::string name;
  int body = 0;
};

/// A column of results: a sum of sizes of unknown forces.
struct Reading {
  std::string channel;                        ///< "Rs_1_x2_N"
  std::vector<std::pair<int, double>> terms;  ///< place among actions, then supports; factor
  /// Instead of the size of an action: this component of its wrench.
  std::optional<Wrench> component = {};
};

/// All that changes from sample to sample.
struct State {
  std::vector<double> position, velocity, acceleration;  ///< per freedom of all bodies in order
  std::vector<Wrench> loads;                             ///< known, per body; without weight
  std::vector<Wrench> actions;                           ///< of size 1, on the body `on`
  std::vector<Wrench> supports;                          ///< of size 1
  std::vector<Wrench> other_sides;  ///< of actions with two sides, in their order
};

struct Mechanism {
  std::vector<Body> bodies;
  std::vector<Action> actions;
  std::vector<Support> supports;
  std::vector<Loop> loops;
  std::vector<Reading> readings;
  Vector gravity = Vector::Zero();
  double length = 1;  ///< a typical one, m
  std::vector<State> states;
};

/// Why a channel has no reading: one text for every quantity that no engine gives.
std::string why_not_given(const Channel& channel);

/// Writes a pump down at the samples of a run. Only raw data are used: the motion of pistons is
/// found by Newton's method from the closed loops, the load of the port plate by quadrature.
/// @param assumptions  of the analytic model: friction, inertia, what turns the block
/// @throws InputError where a case has what this description lacks; ComputationError where a loop
///         does not close
Mechanism assemble(const Case& the_case, const Assumptions& assumptions, const Samples& samples);

}  // namespace bentaxis::engines
