// For those who write an engine's module: what an engine has to be able to do, and how the loops
// are closed with that. Internal.
#pragma once

#include <Eigen/Dense>
#include <map>
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

/// How an integrated tree is at an instant.
struct Moment {
  Eigen::VectorXd position, velocity, acceleration;  ///< per freedom
  Eigen::Matrix3Xd loop_force;                       ///< per loop, on its body `on`
};

/// An engine that integrates the tree of a task, whose loops its own constraints close.
class Integration {
 public:
  virtual ~Integration() = default;
  /// Engine, version, integrator and settings in a line.
  virtual std::string text() const = 0;
  /// Takes the step that begins at a sample and ends at the one after the next.
  /// @param begin  if given: receives how the tree is at its begin
  virtual void step(int sample, Moment* begin) = 0;
};

/// The settings of a run: those given, else the defaults.
class Settings {
 public:
  /// @param known  "NAME=DEFAULT,OTHER,.. NAME=DEFAULT,OTHER,..;LEAST..MOST", a word or a number; a
  ///               number with "..MOST;integer" is a whole one
  /// @param given  "NAME=VALUE NAME=VALUE"
  /// @throws std::runtime_error where a name is not known
  Settings(const std::string& known, const std::string& given);
  const std::string& word(const std::string& name) const { return values_.at(name); }
  /// @throws std::runtime_error where it is no number of at least 0
  double number(const std::string& name) const;
  /// All of them in a line.
  std::string text() const;

 private:
  std::map<std::string, std::string> values_;
};

// What an engine's module defines.

std::unique_ptr<Tree> make_tree(const bentaxis_engine_task& task);

/// The settings of make_integration(), as Settings takes them.
std::string known_settings();

/// At the first sample. @throws std::runtime_error where the engine cannot integrate it
std::unique_ptr<Integration> make_integration(const bentaxis_engine_task& task,
                                              const Settings& settings);

}  // namespace bentaxis::engines
