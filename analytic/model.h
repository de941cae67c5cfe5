// The closed-form vector-algebra model of a bent-axis pump.
//
// A. Roccatello, N. Nervegna, "Mechanical modelling of a bent axis pump", International Journal of
// Fluid Power 10 (2009) no. 2, pp. 57-72. Equation numbers are the paper's; docs/theory.md has the
// derivation and every correction of a misprint.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bentaxis/analytic/kinematics.h"
#include "bentaxis/analytic/port_plate.h"
#include "bentaxis/pump/channels.h"
#include "bentaxis/pump/instant.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/result_table.h"

namespace bentaxis::analytic {

/// A pump prepared for evaluation at any instant. Immutable, so one object serves many threads.
class Model {
 public:
  /// @throws InputError if `assumptions` ask for real pistons and the pump has no data of them.
  Model(const PumpParameters& pump, const Assumptions& assumptions);

  const ChannelLayout& layout() const { return layout_; }

  /// All reactions and the drive torque at an instant, by force and moment equilibrium of pistons
  /// (31)-(33), block (56), (57) and shaft (42), (43).
  ///
  /// @param instant  shaft angle, speed, its rate, and pressures; one pressure per piston
  /// @param values   at least layout().reactions() long; SI, ordered by layout(). Rcs is
  ///                 not_computed() where the block speed is imposed.
  /// Allocates nothing. About 1 + 40 N multiplications and N roots.
  void reactions(const Instant& instant, std::vector<double>& values) const;

  /// Like reactions(), and the derived, input and check channels too: layout().size() values.
  void evaluate(const Instant& instant, std::vector<double>& values) const;

  /// What would change if the other tooth flank carried where the model's separating force pulls
  /// the gears together: the part of the tooth force that pushes the gears apart is turned round.
  struct FlankChange {
    double pin = 0;          ///< |change of Rcn|, N
    double tapered = 0;      ///< |change of Rb1|, N
    double cylindrical = 0;  ///< |change of Rb2|, N
  };
  FlankChange other_flank(double tooth_force) const;

  /// Power of the sources of friction at an instant, W; positive feeds energy in.
  struct FrictionPower {
    double pistons = 0;             ///< largest of any piston
    double block = 0;               ///< viscous, Cc
    double shaft_viscous = 0;       ///< Cs
    double shaft_proportional = 0;  ///< -(1 - Ct) Td omega of (38)
  };
  FrictionPower friction_power(const Instant& instant, double drive_torque) const;

 private:
  // Resultants of all pistons on block and shaft.
  struct Sums;
  struct PistonLoad;

  PistonLoad piston_load(const PistonKinematics& state, const Instant& instant, int k) const;
  void solve_piston(const PistonKinematics& state, const PistonLoad& load, const Instant& instant,
                    Eigen::Vector3d& joint_force, Eigen::Vector2d& bore_force) const;
  double solve_block(const Sums& sums, const Instant& instant, std::vector<double>& values) const;
  void solve_shaft(const Sums& sums, const Instant& instant, double tooth_force,
                   std::vector<double>& values) const;
  // Bearing forces that hold a force and moment about O1 on the shaft.
  struct BearingForces {
    Eigen::Vector3d tapered;
    Eigen::Vector2d cylindrical;
  };
  BearingForces bearings(const Eigen::Vector3d& force, const Eigen::Vector3d& moment) const;
  // sin and cos of the angle of piston k (from 0).
  void piston_angle(double sin_theta, double cos_theta, int k, double& s, double& c) const {
    s = sin_theta * phase_cos_[k] - cos_theta * phase_sin_[k];
    c = cos_theta * phase_cos_[k] + sin_theta * phase_sin_[k];
  }

  PumpParameters pump_;
  ChannelLayout layout_;
  Kinematics kinematics_;
  bool imposed_;
  std::vector<double> phase_sin_, phase_cos_;  // of 2 pi k / N

  double piston_area_, gravity_y_, gravity_z_;  // gravity in S2
  Friction friction_;
  // Mass properties of a piston about A: mass, static moment m sG / b1, inertia (It + m sG^2)/b1^2
  // and spin momentum Ia w_s / b1, each for use with the vector AB instead of the unit vector.
  double mass_, static_moment_, inertia_, spin_momentum_;
  double centre_share_;  // sG / b1

  LandForce land_delivery_, land_suction_;
  Eigen::Vector3d gear_point_s1_, gear_point_s2_;  // O4
  Eigen::Vector3d gear_line_s1_, gear_line_s2_;    // k4 for omega >= 0
  double gear_arm_;                                // d/2 cos(alpha_p)
  Eigen::Vector3d separation_s1_;                  // part of k4 that pushes the gears apart
  Eigen::Vector3d block_axis_s1_;                  // z2 in S1
};

/// One turn of a case under the assumptions it gives this model, as a table.
/// @throws ComputationError where a value is not finite.
ResultTable run(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                const Progress& progress = {});

}  // namespace bentaxis::analytic
