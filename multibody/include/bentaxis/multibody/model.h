// The multibody model, evaluated at given instants without time integration ("driven").
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/multibody/scene.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/budget.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/teeth.h"

namespace bentaxis::multibody {

/// Which rule found the lag of a block that pistons turn, at constant speed.
enum class LagRule {
  unloaded,       ///< nothing turns the block within its free play: the middle of it
  driving_side,   ///< walls carry on the side of the direction of rotation
  trailing_side,  ///< walls carry on the other side
  within_play,    ///< balance without walls
};
inline constexpr std::size_t kLagRules = 4;

/// A pump in Simbody. At each instant shaft and block are set to their motion, Simbody's constraint
/// equations give the pistons, and reactions follow by the chosen method. The block may move on its
/// own: its acceleration is given, and the tooth force is what that takes. Not thread-safe: use one
/// object per thread.
class Model {
 public:
  /// @param omega_sign  sign of the speed that the gear's line of action is laid out for (22); the
  ///                    sign of the tooth force follows the speed of each instant
  /// @param method      none: method_for() the pump
  /// @throws InputError if real pistons are asked for and the pump has no data of them, or if the
  ///                    method cannot serve the pump
  /// @throws ComputationError if a piston has no inertia about its joint and the method is not
  ///                          Method::residual
  Model(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign,
        Scene scene = Scene::full, std::optional<Method> method = {});
  ~Model();
  Model(Model&&) noexcept;
  Model& operator=(Model&&) noexcept;

  const ChannelLayout& layout() const;

  /// All channels that the scene computes at an instant, SI, ordered by layout(); the others are
  /// left as they are. In the one-piston scene the pistons take their turns: N evaluations.
  /// @param checks  if not null, what is found beside them; of the full pump
  /// @throws ComputationError where the pump cannot be assembled or constraints are redundant.
  void evaluate(const Instant& instant, std::vector<double>& values,
                MotionChecks* checks = nullptr);

  /// Motion of the block beside one of the shaft, where a joint turns the block: that motion counts
  /// in evaluate(), whatever the instant says of the block. Without a joint the block turns as the
  /// shaft does.
  AxisMotion block_beside(const AxisMotion& shaft);

  /// All channels at constant speed, where pistons turn the block: the lag is the one at which the
  /// block is in balance (frozen lag), and the pressures are those at the block's angle.
  /// @param theta_deg  angle of the shaft, degrees
  /// @param speed      rad/s
  /// @throws InputError where the pistons have no free play there
  /// @throws ComputationError where no lag is found, or the pump cannot be assembled at it
  LagRule evaluate_at_frozen_lag(double theta_deg, double speed, const PressureTrace& pressure,
                                 const PortPressures& ports, std::vector<double>& values);

  /// Drive torque by cause, and the block's balance, at the instant of the last evaluate(); of the
  /// full pump.
  Budget budget();

  /// All loads on pistons, block and shaft at the instant of the last evaluate(), named and ordered
  /// as analytic::BodyLoads has them; of the full pump. Reactions are those that evaluate() found,
  /// oil, friction and film what the force element applies, weight Simbody's; inertia is Simbody's
  /// masses and inertias times the accelerations of its bodies.
  std::vector<BodyLoad> body_loads();

  /// Whether bevel teeth turn the block: of the full pump with [gear] contact = "teeth".
  bool has_teeth() const;
  /// What they do to each other at the instant of the last evaluate(); where there are any.
  const TeethAction& teeth() const;

  /// The channels of piston 1 alone; only in the one-piston scene.
  void evaluate_one(const Instant& instant, std::vector<double>& values);

  /// Bodies, mobilities, constraint equations and their rank, for a report. After an evaluation.
  Provenance provenance() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Whether a piston has inertia about its joint A. Without it there are equilibrium equations but
/// no equation of motion, and only Method::residual serves.
bool has_equation_of_motion(const PumpParameters& pump, PistonInertia inertia);

/// What the multibody scene consists of, as lines for a report.
std::vector<std::pair<std::string, std::string>> scene_facts(const PumpParameters& pump,
                                                             const Assumptions& assumptions,
                                                             Scene scene = Scene::full);

/// Size of a scene: what is built and solved.
struct SceneSize {
  int bodies = 0;
  int mobilities = 0;
  int equations = 0;  ///< constraint equations solved at an instant
};
SceneSize scene_size(const PumpParameters& pump, const Assumptions& assumptions, Scene scene);

/// One turn of a case under the given assumptions, as a table. In the one-piston scene piston 1
/// stands for all where the samples allow it (they divide by N, and every piston sees at its angle
/// the pressure that piston 1 sees there); elsewhere the pistons are evaluated one by one.
/// @param budget  if not null, becomes the budget_table() of the run; of the full pump
/// @param teeth   if not null, becomes the teeth_table() of the run, without rows where the full
/// pump's
///                block is not turned by bevel teeth
/// @param loads   if not null, becomes those of Model::body_loads(), a row per sample; of the full
///                pump
ResultTable run_driven(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                       const Progress& progress = {}, Scene scene = Scene::full,
                       std::optional<Method> method = {}, ResultTable* budget = nullptr,
                       ResultTable* teeth = nullptr, BodyLoadTable* loads = nullptr);

/// Reactions at given states of shaft and block, with the torque that their motion needs.
/// @param teeth, loads  as of run_driven()
/// @throws InputError, ComputationError
MotionTable run_states(const Case& the_case, const Assumptions& assumptions, const States& states,
                       const Progress& progress = {}, std::optional<Method> method = {},
                       ResultTable* teeth = nullptr, BodyLoadTable* loads = nullptr);

}  // namespace bentaxis::multibody
