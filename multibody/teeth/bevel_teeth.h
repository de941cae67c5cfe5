// Straight bevel teeth of shaft and block that touch where they are.
#pragma once

#include <SimTKsimbody.h>

#include <array>
#include <memory>
#include <optional>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/tooth_flexibility.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/teeth.h"
#include "teeth/flank_curve.h"

namespace bentaxis::multibody {

inline SimTK::Vec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// Where two flanks are nearest to each other, on the unit sphere about O2 in S1.
struct Touch {
  bool found = false;     ///< else they do not face each other, or only beyond both tips
  bool at_tip = false;    ///< of either, against the other's flank
  double pressed_in = 0;  ///< rad along the great circle that both flanks are normal to; < 0: gap
  SimTK::Vec3 point;      ///< unit vector, in the middle between the points of both flanks
  SimTK::Vec3 normal;     ///< unit vector there, of the force on the block
  double shaft_roll = 0, block_roll = 0;    ///< of the points of either flank
  double shaft_angle = 0, block_angle = 0;  ///< their polar angles from the own cone axis
  int iterations = 0;
};

/// Rolls at which a search begins.
struct TouchGuess {
  double shaft_roll = 0, block_roll = 0;
};

/// Contact and forces of the teeth. Nothing depends on what was asked before.
class BevelTeeth {
 public:
  /// @throws InputError naming the key of [gear] where such teeth do not mesh
  BevelTeeth(const PumpParameters& pump, FlankShape shape);

  const FlankCurve& curve() const { return *curve_; }
  double pitch_cone() const { return pitch_cone_; }
  /// R, m, from O2 to O4.
  double distance() const { return distance_; }
  double tip_roll() const { return tip_roll_; }
  double contact_ratio() const;
  SimTK::Vec3 shaft_axis() const { return {0, 0, 1}; }
  const SimTK::Vec3& block_axis() const { return block_axis_; }

  /// The flanks of a pair that push the block towards +psi, found by Newton's method.
  /// @param shaft_ahead, block_ahead  rad, by which either flank's point on the pitch cone has
  /// passed
  ///                                  O4, in the sense of +theta, +psi
  /// @param guess  none: as perfect teeth touch there. What is found does not depend on it.
  Touch touch(double shaft_ahead, double block_ahead, std::optional<TouchGuess> guess = {}) const;

  /// Forces of all pairs at an angle of the shaft, rad. @param dissipation  false: as at rest
  TeethAction act(double theta, double shaft_speed, const ToothLag& lag,
                  bool dissipation = true) const;
  /// The lag at which teeth at rest carry this torque about z2, Nm; of no torque, that at which the
  /// flank that pushes towards +psi just touches, or where both press on each other alike.
  ToothLag rest(double theta, double torque_on_block) const;

  /// The largest approach of any pair and slice of a flank, m, and its rate there, m/s.
  struct Closing {
    double approach = 0, rate = 0;
  };
  Closing closing(double theta, double shaft_speed, const ToothLag& lag, int flank) const;

  /// Torque about z2 on the block, and about z1 on the shaft, Nm.
  double torque_on_block(const TeethAction& action) const;
  double torque_on_shaft(const TeethAction& action) const;

 private:
  struct Pair;
  struct Slices;
  struct Placed;
  void refuse_what_does_not_mesh() const;
  Pair pair(double theta, double lag, int flank, int which) const;
  Slices press(const Pair& pair, double closing_per_length, double dissipation) const;
  double closing_per_length(const Pair& pair, double shaft_speed, double lag_rate) const;
  Placed place(const SimTK::Rotation& frame, double azimuth, double roll) const;
  Placed on_shaft(double shaft_ahead, double roll) const;
  Placed on_block(double block_ahead, double roll) const;
  bool regular(double shaft_ahead, double block_ahead, Touch& touch) const;
  template <class Flank>
  bool foot(const SimTK::Vec3& tip, const Flank& flank, double& roll) const;
  template <class Flank>
  bool foot_from(double start, const SimTK::Vec3& tip, const Flank& flank, double& roll) const;
  double largest_approach(double theta, double lag, int flank) const;
  template <class Excess>
  double root(double theta, int flank, double torque_on_block, const Excess& excess) const;

  Gear gear_;
  ToothData teeth_;
  double tilt_, pitch_cone_, distance_, tip_cone_;
  double pitch_angle_;
  SimTK::Vec3 block_axis_;
  SimTK::Rotation shaft_frame_, block_frame_;  // cone axis, pitch point
  std::unique_ptr<FlankCurve> curve_;
  std::optional<ToothFlexibility> flexibility_;
  double tip_roll_ = 0;
};

}  // namespace bentaxis::multibody
