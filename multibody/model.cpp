#include "bentaxis/multibody/model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/results/max_abs.h"
#include "loads/friction.h"
#include "placement/placement.h"
#include "reactions/body_loads.h"
#include "reactions/budget.h"
#include "reactions/channels.h"
#include "reactions/inverse_dynamics.h"
#include "reactions/motion_checks.h"
#include "reactions/reactions.h"
#include "reactions/solver_guard.h"
#include "scene/pump_system.h"
#include "scene_facts.h"
#include "transfers/frozen_lag.h"
#include "transfers/joint.h"

namespace bentaxis::multibody {

using SimTK::Stage;

namespace {

// The one-piston scene turned so that its piston stands where piston k + 1 of n does.
AxisMotion turned_back(const AxisMotion& motion, int k, int n) {
  return {motion.angle - 2 * kPi * k / n, motion.speed, motion.acceleration};
}

}  // namespace

struct Model::Implementation {
  Implementation(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign,
                 Scene the_scene, std::optional<Method> asked)
      : layout(validate(pump)),
        scene(the_scene),
        method(method_for(pump, asked)),
        method_is_given(asked.has_value()),
        parameters(pump),
        system(built_pump(pump, the_scene), assumptions, omega_sign, drive_of(the_scene)),
        placement(system),
        inverse_dynamics(system, placement),
        load_reader(system) {
    system.inputs().chamber_pressure = [this](double, double, std::vector<double>& p) {
      p = pressure;
    };
    if (pump.transfer.is_joint()) joint_motion = std::make_unique<JointMotion>(pump);
    if (pump.transfer.kind == TransferKind::pistons && the_scene != Scene::full)
      throw InputError("multibody model: --scene " +
                       scene_names()[static_cast<std::size_t>(the_scene)] +
                       ": must be full beside [transfer] kind = \"pistons\", whose walls need the "
                       "block's balance");
    if (method == Method::multipliers) system.require_piston_inertia();
  }

  void check(const Instant& instant) const;
  void require_sizes(const Instant& instant, const std::vector<double>& values) const;
  void evaluate(const Instant& given, std::vector<double>& values, MotionChecks* checks);
  void place(const AxisMotion& shaft, const AxisMotion& block, const PortPressures& ports);
  void place_and_solve(const AxisMotion& shaft, const AxisMotion& block, const Instant& instant);
  AxisMotion block_beside(const AxisMotion& shaft) const;
  LagRule evaluate_at_frozen_lag(double theta_deg, double speed, const PressureTrace& trace,
                                 const PortPressures& ports, std::vector<double>& values);
  void settle_teeth(const Instant& instant);
  void check_rank();

  ChannelLayout layout;
  Scene scene;
  Method method;
  bool method_is_given;
  PumpParameters parameters;
  PumpSystem system;
  Placement placement;
  std::unique_ptr<JointMotion> joint_motion;  // of a pump with a joint
  InverseDynamics inverse_dynamics;
  BodyLoadReader load_reader;
  Reactions reactions;
  Reactions by_inverse_dynamics;  // what the multipliers are held to
  TeethAction teeth;
  std::vector<double> pressure;
  SimTK::Vector accelerations;
  Rank rank;
  long placements = 0;
  double worst_difference = 0;  // of multipliers from inverse dynamics, of the largest force
};

Model::Model(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign,
             Scene scene, std::optional<Method> method) {
  translate_simbody_errors([&] {
    implementation_ =
        std::make_unique<Implementation>(pump, assumptions, omega_sign, scene, method);
  });
}
Model::~Model() = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;

const ChannelLayout& Model::layout() const { return implementation_->layout; }

void Model::Implementation::check(const Instant& instant) const {
  if (scene != Scene::full) return;
  const auto lacks = [](double acceleration, double inertia) {
    return acceleration != 0 && !(inertia > 0);
  };
  if (lacks(instant.shaft.acceleration, system.pump().shaft.axial_inertia) ||
      lacks(instant.block.acceleration, system.pump().block.axial_inertia))
    throw InputError("multibody model: a changing speed needs axial inertias > 0");
}

void Model::Implementation::require_sizes(const Instant& instant,
                                          const std::vector<double>& values) const {
  if (instant.chamber_pressure.size() != static_cast<std::size_t>(layout.pistons()))
    throw InputError("multibody model: " + std::to_string(instant.chamber_pressure.size()) +
                     " chamber pressures for " + std::to_string(layout.pistons()) + " pistons");
  if (values.size() < layout.size())
    throw InputError("multibody model: space for " + std::to_string(values.size()) +
                     " values, needed are " + std::to_string(layout.size()));
}

void Model::Implementation::check_rank() {
  if (rank.equations > 0) return;
  rank = constraint_rank(system, system.dynamics());
  if (rank.rank < rank.equations)
    throw ComputationError("multibody model: " + std::to_string(rank.equations) +
                           " constraint equations have rank " + std::to_string(rank.rank) +
                           ": the reactions are not determined uniquely");
}

// Lets the teeth stand as they are given, or where they give what the block's balance takes.
void Model::Implementation::settle_teeth(const Instant& instant) {
  SimTK::State& state = system.dynamics();
  TeethSetting& setting = system.teeth_setting();
  setting = {};
  if (instant.lag) {
    setting.lag = *instant.lag;
  } else {
    setting.apart = true;
    inverse_dynamics.solve(by_inverse_dynamics);
    setting.lag = system.bevel()->rest(state, by_inverse_dynamics.imposed);
    setting.apart = setting.dissipation = false;
    state.invalidateAllCacheAtOrAbove(Stage::Dynamics);
  }
  teeth = system.bevel()->action(state);
}

void Model::Implementation::place(const AxisMotion& shaft, const AxisMotion& block,
                                  const PortPressures& ports) {
  system.inputs().ports = ports;
  // At standstill the pistons' velocities are round-off of the projection, with any sign.
  system.inputs().rest_speed = shaft.speed == 0 && block.speed == 0
                                   ? std::numeric_limits<double>::infinity()
                                   : rest_speed_at(system.pump().geometry, shaft.speed);
  ++placements;
  placement.place(shaft, block);
}

// Finds the reactions at a motion of shaft and block under the pressures in `pressure`.
void Model::Implementation::place_and_solve(const AxisMotion& shaft, const AxisMotion& block,
                                            const Instant& instant) {
  place(shaft, block, instant.ports);
  reactions.block_is_given = true;
  SimTK::State& state = system.dynamics();
  if (system.bevel() != nullptr) settle_teeth(instant);
  if (method == Method::multipliers) {
    if (scene == Scene::full) {
      system.drive().set_acceleration(state, shaft.acceleration);
      if (system.has_rigid_gear())
        system.gear().setting().relative_acceleration = block.acceleration - shaft.acceleration;
    }
    realize_with_flank(system, state);
    check_rank();
    reactions_from_multipliers(system, state, reactions);
    inverse_dynamics.solve(by_inverse_dynamics);
    const double difference = force_difference(system, reactions, by_inverse_dynamics);
    require_agreement(
        difference, [&] { return estimated_force_error(system, state); }, shaft.angle);
    update_max_abs(worst_difference, difference);
  } else {
    inverse_dynamics.solve(reactions);
    check_rank();
  }
}

AxisMotion Model::Implementation::block_beside(const AxisMotion& shaft) const {
  return joint_motion ? joint_motion->block(shaft) : shaft;
}

LagRule Model::Implementation::evaluate_at_frozen_lag(double theta_deg, double speed,
                                                      const PressureTrace& trace,
                                                      const PortPressures& ports,
                                                      std::vector<double>& values) {
  const PumpParameters& p = system.pump();
  const int n = layout.pistons();
  Instant instant;
  instant.ports = ports;
  instant.shaft = {radians(theta_deg), speed, 0};
  const auto turn_to = [&](double lag) {
    instant.block = {instant.shaft.angle - lag, speed, 0};
    instant.chamber_pressure.clear();
    for (int k = 1; k <= n; ++k)
      instant.chamber_pressure.push_back(
          trace(piston_angle_deg(theta_deg - lag / kRadPerDegree, k, n)));
  };
  // What the block's motion needs beyond all that acts on it, turned round.
  const auto moment = [&](double lag, bool walls) {
    turn_to(lag);
    pressure = instant.chamber_pressure;
    system.wall_setting().apart = !walls;
    place(instant.shaft, instant.block, instant.ports);
    inverse_dynamics.solve(by_inverse_dynamics);
    return -by_inverse_dynamics.imposed;
  };
  turn_to(0);
  double most = 0;
  for (const double at : instant.chamber_pressure) update_max_abs(most, at);
  const double area = kPi * p.geometry.bore_diameter * p.geometry.bore_diameter / 4;
  const double radius = p.geometry.joint_circle_radius;
  const double scale = radius * std::max({most * area, p.piston.mass * speed * speed * radius,
                                          p.piston.mass * std::abs(p.gravity)});
  FrozenLag found;
  try {
    found = find_frozen_lag(free_play(p, instant.shaft.angle), moment, scale, speed);
  } catch (...) {
    system.wall_setting().apart = false;
    throw;
  }
  system.wall_setting().apart = false;
  turn_to(found.lag);
  evaluate(instant, values, nullptr);
  reactions.block_is_given = false;
  values[layout.lag()] = found.lag;
  values[layout.Tb()] = not_computed();  // none is left but round-off
  return found.rule;
}

void Model::Implementation::evaluate(const Instant& given, std::vector<double>& values,
                                     MotionChecks* checks) {
  Instant followed;
  if (joint_motion) {
    followed = given;
    followed.block = block_beside(given.shaft);
  }
  const Instant& instant = joint_motion ? followed : given;
  check(instant);
  const int n = layout.pistons();
  if (scene == Scene::piston) {
    for (int k = 0; k < n; ++k) {
      pressure.assign(1, instant.chamber_pressure[k]);
      place_and_solve(turned_back(instant.shaft, k, n), turned_back(instant.block, k, n), instant);
      read_piston_channels(system, reactions, 0, k, instant.chamber_pressure[k], layout, values);
    }
    return;
  }
  pressure = instant.chamber_pressure;
  place_and_solve(instant.shaft, instant.block, instant);
  const SimTK::State& state = system.dynamics();
  for (int k = 0; k < n; ++k)
    read_piston_channels(system, reactions, k, k, instant.chamber_pressure[k], layout, values);
  if (scene != Scene::full) return;
  // At standstill the power balance is taken with a virtual turn of 1 rad/s.
  const bool has_gear = layout.transfer() == TransferKind::gear;
  const bool stands = has_gear && instant.locked() && instant.shaft.speed == 0;
  if (stands) placement.assemble({instant.shaft.angle, 1, 0}, {instant.block.angle, 1, 0});
  const WorkRate rate =
      stands ? WorkRate{system.assembly(), 1} : WorkRate{state, instant.shaft.speed};
  read_pump_channels(system, state, reactions, rate, {instant.shaft, instant.block}, pressure,
                     layout, values);
  if (has_gear && instant.locked() && checks == nullptr) return;
  system.system().realize(state, Stage::Dynamics);
  placement.constrained_accelerations(accelerations);
  const MotionChecks found = motion_checks(system, state, reactions, accelerations,
                                           instant.shaft.angle - instant.block.angle);
  if (checks != nullptr) *checks = found;
  if (!has_gear || !instant.locked())
    values[layout.power_residual()] =
        instant.shaft.speed == 0 ? not_computed() : found.power_balance / instant.shaft.speed;
}

void Model::evaluate(const Instant& instant, std::vector<double>& values, MotionChecks* checks) {
  implementation_->require_sizes(instant, values);
  if (checks != nullptr) *checks = {not_computed(), not_computed(), not_computed()};
  translate_simbody_errors([&] { implementation_->evaluate(instant, values, checks); });
}

AxisMotion Model::block_beside(const AxisMotion& shaft) {
  AxisMotion block;
  translate_simbody_errors([&] { block = implementation_->block_beside(shaft); });
  return block;
}

LagRule Model::evaluate_at_frozen_lag(double theta_deg, double speed, const PressureTrace& pressure,
                                      const PortPressures& ports, std::vector<double>& values) {
  if (layout().transfer() != TransferKind::pistons)
    throw std::logic_error("evaluate_at_frozen_lag() is of pistons that turn the block");
  LagRule rule{};
  translate_simbody_errors([&] {
    rule = implementation_->evaluate_at_frozen_lag(theta_deg, speed, pressure, ports, values);
  });
  return rule;
}

void Model::evaluate_one(const Instant& instant, std::vector<double>& values) {
  Implementation& self = *implementation_;
  if (self.scene != Scene::piston)
    throw std::logic_error("evaluate_one() is of the one-piston scene");
  self.require_sizes(instant, values);
  translate_simbody_errors([&] {
    self.check(instant);
    self.pressure.assign(1, instant.chamber_pressure[0]);
    self.place_and_solve(instant.shaft,
                         self.joint_motion ? self.block_beside(instant.shaft) : instant.block,
                         instant);
    read_piston_channels(self.system, self.reactions, 0, 0, instant.chamber_pressure[0],
                         self.layout, values);
  });
}

bool Model::has_teeth() const { return implementation_->system.bevel() != nullptr; }

const TeethAction& Model::teeth() const {
  if (!has_teeth()) throw std::logic_error("teeth() is of the full pump with bevel teeth");
  return implementation_->teeth;
}

Budget Model::budget() {
  Implementation& self = *implementation_;
  if (self.scene != Scene::full) throw std::logic_error("budget() is of the full pump");
  Budget budget;
  translate_simbody_errors(
      [&] { budget = budget_of(self.system, self.placement, self.reactions); });
  return budget;
}

std::vector<BodyLoad> Model::body_loads() {
  Implementation& self = *implementation_;
  if (self.scene != Scene::full) throw std::logic_error("body_loads() is of the full pump");
  std::vector<BodyLoad> loads;
  translate_simbody_errors([&] {
    const SimTK::State& state = self.system.dynamics();
    // Inverse dynamics leaves accelerations of its own; Simbody's are where it solved for them.
    if (self.method == Method::multipliers)
      self.accelerations = state.getUDot();
    else
      self.placement.constrained_accelerations(self.accelerations);
    loads = self.load_reader.read(state, self.accelerations, self.reactions, self.pressure,
                                  has_teeth() ? &self.teeth : nullptr);
  });
  return loads;
}

Provenance Model::provenance() const {
  const Implementation& self = *implementation_;
  Provenance provenance;
  provenance.facts = scene_facts(self.parameters, self.system.assumptions(), self.scene);
  auto& facts = provenance.facts;
  facts.insert(
      facts.begin() + 1,
      {"way",
       "driven: pistons placed at each angle until the constraint equations hold to round-off, " +
           std::string(self.method == Method::multipliers
                           ? "accelerations and reactions solved together"
                           : "accelerations too, reactions by inverse dynamics") +
           ", no time integration"});
  if (!self.system.contact_at_b())
    facts.emplace_back("bore forces",
                       "do not act at B and do work on the play between pistons and bores, which "
                       "an ideal constraint cannot: found by inverse dynamics" +
                           std::string(self.method_is_given ? "" : ", chosen for that"));
  facts.emplace_back("mobilities", std::to_string(self.rank.mobilities));
  facts.emplace_back("constraint equations", std::to_string(self.rank.equations));
  facts.emplace_back("rank of the constraint matrix", std::to_string(self.rank.rank));
  const auto& simbody = self.system.system();
  const auto per_angle = [&](Stage stage) {
    return number_text(std::round(100.0 * simbody.getNumRealizationsOfThisStage(stage) /
                                  static_cast<double>(std::max(self.placements, 1L))) /
                       100);
  };
  facts.emplace_back("realizations per angle", "positions " + per_angle(Stage::Position) +
                                                   ", velocities " + per_angle(Stage::Velocity) +
                                                   ", accelerations " +
                                                   per_angle(Stage::Acceleration));
  if (self.method == Method::multipliers && self.placements > 0) {
    const double estimated = estimated_force_error(self.system, self.system.dynamics());
    facts.emplace_back(
        "difference from inverse dynamics",
        short_text(self.worst_difference) + " of the largest force, the worst of all angles");
    facts.emplace_back("estimated error of the multipliers",
                       short_text(estimated) + " of the largest force, at the last angle");
  }
  return provenance;
}

}  // namespace bentaxis::multibody
