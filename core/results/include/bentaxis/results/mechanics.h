// The mechanics of a pump as equations of motion, for an integration that carries oil with it.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/oil.h"
#include "bentaxis/results/surroundings.h"
#include "bentaxis/results/teeth.h"

namespace bentaxis {

/// States of motion. Those that a case does not have stay 0.
enum MotionIndex : std::size_t {
  kTurn,         ///< theta less the start's speed times time, rad; 0 where the speed is given
  kTurnRate,     ///< rad/s, likewise
  kLag,          ///< theta - psi, rad, with compliant contact or pistons that carry the block
  kLagRate,      ///< rad/s
  kTwist,        ///< of the coupling, phi - theta, rad
  kTwistRate,    ///< rad/s
  kWorkOfLoads,  ///< J, as in TrajectoryRecord
  kWorkOfDrive,  ///< J
  kImpulse,      ///< Ns, integral of the magnitude of the tooth force, or of all wall forces
  kMotionStates
};
using MotionVector = std::array<double, kMotionStates>;

/// Shaft and block, and the rotor of a motor, under the loads of the oil. A model derives its own;
/// nothing of it depends on what was asked before.
class Mechanics {
 public:
  virtual ~Mechanics() = default;

  virtual const ChannelLayout& layout() const = 0;
  /// At time 0, theta = psi = 0, as DriveSpec says.
  virtual MotionVector start() const = 0;
  /// From now on these act from outside; what is not given is as the case says. Nothing is, before.
  /// @throws std::logic_error of mechanics that take nothing
  virtual void set_inputs(const Surroundings& outside);
  /// The name of 1.0.0.
  [[deprecated("use set_inputs")]] virtual void surround(const Surroundings& outside);
  /// What each state is measured by: an error of one part in this scale changes reactions by about
  /// the same part of their peak. > 0.
  virtual MotionVector scales() const = 0;
  /// Which states move in this case: [kTurn, kTurnRate], [kLag, kLagRate], [kTwist, kTwistRate].
  virtual bool shaft_is_free() const = 0;
  virtual bool compliant() const = 0;
  virtual bool has_motor() const = 0;
  /// Times at which what drives the shaft changes its law, s.
  virtual std::vector<double> breakpoints() const;
  /// The name of 1.0.0.
  [[deprecated("use breakpoints")]] virtual std::vector<double> knots() const;

  /// Angles and speeds; accelerations are not filled in.
  virtual AxisMotion shaft(double time, const MotionVector& y) const = 0;
  virtual AxisMotion block(double time, const MotionVector& y) const = 0;
  /// Whether pistons carry the block: contacts are then walls of their bores.
  virtual bool carried_by_pistons() const { return false; }
  /// What can touch, as approach() numbers it: compliant flanks (+1: the shaft pushes the block
  /// towards +psi, -1), or pistons 1 to N.
  std::vector<int> contacts() const {
    if (!compliant()) return {};
    if (!carried_by_pistons()) return {1, -1};
    std::vector<int> pistons(static_cast<std::size_t>(layout().pistons()));
    std::iota(pistons.begin(), pistons.end(), 1);
    return pistons;
  }
  /// Of a contact, m; below 0: the gap; and its rate, m/s. Of teeth the largest of any pair and
  /// slice.
  virtual double approach(double time, const MotionVector& y, int contact) const = 0;
  virtual double approach_rate(double time, const MotionVector& y, int contact) const = 0;
  /// State of the teeth there; false where contact is not resolved.
  virtual bool teeth(double /*time*/, const MotionVector& /*y*/, TeethAction& /*action*/) {
    return false;
  }

  /// dy/dt. Forces follow their laws as they are: between flanks that do not touch nothing acts.
  /// @throws ComputationError where the model has no accelerations
  virtual void rates(double time, const MotionVector& y, const OilLoads& loads,
                     MotionVector& dy) = 0;
  /// Power of the chamber pressures on the pistons, W.
  virtual double pressure_power(double time, const MotionVector& y, const OilLoads& loads) = 0;
  /// All channels of the layout, SI, and the checks.
  /// @param state  values of trajectory_columns() in their units
  virtual void row(double time, const MotionVector& y, const OilLoads& loads,
                   std::vector<double>& state, std::vector<double>& row, MotionChecks& checks) = 0;
  /// All loads on pistons, block and shaft there, with the accelerations of the motion; none where
  /// the model does not tell them.
  virtual std::vector<BodyLoad> body_loads(double /*time*/, const MotionVector& /*y*/,
                                           const OilLoads& /*loads*/) {
    return {};
  }
  /// Of all bodies and of the rotor, J; of flanks and the coupling, J; with what walls hold, J.
  virtual double kinetic_energy(double time, const MotionVector& y) = 0;
  virtual double potential_energy(const MotionVector& y) const = 0;
  virtual double elastic_energy(double /*time*/, const MotionVector& y) const {
    return potential_energy(y);
  }
};

}  // namespace bentaxis
