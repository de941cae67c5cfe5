// Equations of motion of shaft, block and rotor. Internal.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/results/mechanics.h"
#include "closed_form/gear.h"
#include "simulation/loads.h"
#include "simulation/responses.h"
#include "simulation/walls.h"

namespace bentaxis::analytic::simulation {

using State = MotionVector;

/// How the teeth stand: which flank presses, if any.
struct Teeth {
  int pressing = 0;  ///< +1 or -1; 0: none
  /// A flank that is within the other but leaves faster than the law's damping lets it push.
  int idle = 0;
};

/// What one state of motion gives.
struct Motion {
  AxisMotion shaft, block;
  double drive_torque = 0;  ///< Td, Nm
  double tooth_force = 0;   ///< of the contact law, towards +psi, N
  double shaft_moment = 0;  ///< of bevel teeth on the shaft about z1, Nm
};

class Equations {
 public:
  /// @throws InputError
  Equations(const Case& the_case, const Assumptions& assumptions, const PressureTrace& pressure);

  const Model& model() const { return model_; }
  const DriveSpec& drive() const { return drive_; }
  /// From now on these act from outside.
  void set_inputs(const Surroundings& outside);
  /// Whether the block has a motion of its own.
  bool compliant() const { return law_ || bevel_ || walls_; }
  const std::optional<Walls>& walls() const { return walls_; }
  const closed_form::ToothLaw& law() const { return *law_; }
  long evaluations() const { return evaluations_; }

  State start(const SimulationOptions& options) const;
  /// What each state is measured by: an error of one part in this scale changes reactions by the
  /// same part of their peak, or so.
  State scales() const;
  /// Times at which what drives the shaft changes its law, s.
  std::vector<double> breakpoints() const;

  /// From now on rates() are those of the teeth alone: no work is added up. Of a gear with a
  /// contact law whose shaft has a given speed.
  void follow_teeth_alone() { teeth_alone_ = true; }

  // The piece of the motion that rates() follows.
  Teeth teeth;
  std::vector<closed_form::WallMode> wall_modes;  ///< of pistons that carry the block
  double from_angle = 0, to_angle = 0;  ///< rad, of psi: pressures are those of this interval
  /// rad: so near to an end of the interval the block stands on it, but for rounding.
  static constexpr double kAtEdge = 1e-12;

  /// Approach of a flank that is compliant, m, and its rate.
  double approach(const State& y, int flank) const {
    return flank * law_->arm * y[kLag] - law_->half_backlash;
  }
  double approach_rate(const State& y, int flank) const { return flank * law_->arm * y[kLagRate]; }
  /// The same of bevel teeth, the largest of any pair and slice.
  BevelTeeth::Approach approach_of_teeth(double time, const State& y, int flank) const;
  /// Of the flank that presses, by its law, N, > 0 towards +psi.
  double tooth_force(const State& y) const;
  /// About what that makes of the block, rad/s2, its magnitude.
  double tooth_acceleration(const State& y) const;
  const std::optional<BevelTeeth>& bevel() const { return bevel_; }
  /// Of the walls, with the accelerations of the motion that was found last.
  const std::vector<WallPath>& wall_paths(double time, const State& y) const;
  AxisMotion block(const AxisMotion& shaft, const State& y) const;
  double block_angle(double time, const State& y) const;
  double block_speed(double time, const State& y) const;
  AxisMotion shaft(double time, const State& y) const;
  double speed(double time, const State& y) const { return shaft(time, y).speed; }

  /// Pressures are those of the trace in the interval, teeth as `teeth` says.
  void rates(double time, const State& y, State& dy);
  /// Pressures are what set_loads() was given last, teeth as the approaches say.
  void rates_under_loads(double time, const State& y, State& dy);
  Motion motion_under_loads(double time, const State& y);
  void set_loads(const OilLoads& loads);
  /// Power of the pressures on the pistons there, W.
  double pressure_power(double time, const State& y);
  /// Everything at an instant; `instant()` then is the model's argument there.
  Motion motion(double time, const State& y);
  const Instant& instant() const { return instant_; }
  /// A row of results at the instant of the motion that was found last.
  /// @param state  values of trajectory_columns() in their units
  void row(double time, const State& y, const Motion& m, std::vector<double>& state,
           std::vector<double>& row, MotionChecks& checks) const;
  /// All loads on the bodies there.
  std::vector<BodyLoad> body_loads();
  /// Pressures at the block's angle itself instead of those of the interval.
  void at_own_angle(double time, const State& y);

  /// Of all bodies and of the rotor, J; of the teeth and the coupling, J.
  double kinetic_energy(double time, const State& y);
  double potential_energy(const State& y) const;
  double wall_energy(double time, const State& y) const;  ///< of the walls, J

 private:
  const closed_form::WallMode* modes() const { return walls_ ? wall_modes.data() : nullptr; }
  Response respond(const Accelerations<double>& by, PistonPowers* powers = nullptr);
  // Finds the powers of the pistons too.
  std::array<Response, 2> respond(const Accelerations<double>& first,
                                  const Accelerations<double>& second);
  Motion accelerate(double time, const State& y);
  Motion accelerate_block(const State& y);
  void add_rates(double time, const State& y, const Motion& m, State& dy);
  Teeth teeth_at(const State& y) const;
  void set_speeds(double time, const State& y);
  void set_pressures(double block_angle);
  // At an edge the pressure is that of the interval's side.
  double a_hair_within(double block_angle) const;
  void find_tooth_force(const State& y, Motion& m);
  double drive_torque_at(double time, const State& y) const;
  double pressing_force(const Motion& m) const;
  double spring_force(double approach) const;
  double flank_force(double approach, double rate) const;
  double motor_torque(double rotor_speed) const;

  const DriveSpec& drive_;
  const PressureTrace& pressure_;
  double omega_, start_speed_;
  double torque_factor_;
  Model model_;
  // With the teeth's torque on the block as a force at O4; what bevel teeth take from the shaft
  // beyond it is a torque of its own.
  Responses responses_;
  Responses ideal_;  // contact of the rings at B: what the mass matrix is found from
  std::optional<BevelTeeth> bevel_;
  Loads loads_;
  const PumpParameters& pump_;
  Assumptions assumptions_;
  std::optional<BodyLoads> body_loads_;  // made where they are asked for
  bool teeth_alone_ = false;
  bool ring_off_;  // rings act off B, and do work on the play of their pistons
  std::optional<closed_form::ToothLaw> law_;
  std::optional<Walls> walls_;
  mutable std::vector<WallPath> paths_;
  mutable Instant at_walls_;  // what paths_ are of
  double wall_force_ = 0;     // N, of all walls, of the rates found last
  double arm_;  // of a tooth force; 1 where pistons carry the block, whose torque is asked for
  std::optional<TimeSignal> curve_;
  Surroundings outside_;
  double probe_ = 1;  // rad/s2, for differences of responses
  double torque_scale_ = 0, tooth_scale_ = 0, shaft_inertia_ = 0, block_inertia_ = 0;
  Instant instant_;
  PistonPowers piston_powers_ = {};  // of the motion that was found last
  std::vector<double> values_;       // of the channels, for what the rings do
  long evaluations_ = 0;
};

}  // namespace bentaxis::analytic::simulation
