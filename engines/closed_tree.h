// For those who write an engine's module: what an engine has to be able to do, and how the loops
// are closed with that. Internal.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <string>

#include "bentaxis/engines/interface.h"

namespace bentaxis::engines {

/// Per body a force and its moment about the world's origin, column by column.
using Wrenches = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// An engine with the tree of a task in it.
class Tree {
 public:
  virtual ~Tree() = default;
  /// Engine, version and method in a line.
  virtual std::string text() const = 0;
  /// Puts the tree into a state.
  /// @param moves  false: at rest there and without weight
  virtual void set(const double* position, const double* velocity, const double* acceleration,
                   bool moves) = 0;
  /// Inverse dynamics there: what the joint of each body to its parent does to the body.
  virtual void joint_wrenches(const Wrenches& loads, Wrenches& joints) = 0;
};

/// What an engine's module defines.
std::unique_ptr<Tree> make_tree(const bentaxis_engine_task& task);

}  // namespace bentaxis::engines
