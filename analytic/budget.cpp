#include "bentaxis/analytic/budget.h"

#include <array>
#include <cmath>
#include <iterator>
#include <type_traits>
#include <vector>

#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/analytic/model.h"
#include "closed_form/reactions.h"
#include "prepared.h"
#include "turning.h"

namespace bentaxis::analytic {
namespace {

// A load of the pistons alone: their numbers without what the other loads come from.
struct LoadAlone {
  Cause cause;
  closed_form::PistonNumbers<double> piston;
  double rate, rate_dot;  // of the motion's parameter, that inertia knows of
  bool friction, pressure;
};

// Pistons without weight: mass is what accelerations make of it.
closed_form::PistonNumbers<double> weightless(closed_form::PistonNumbers<double> piston) {
  piston.gravity_y = piston.gravity_z = 0;
  return piston;
}

closed_form::PistonNumbers<double> massless(closed_form::PistonNumbers<double> piston) {
  piston.mass = piston.static_moment = piston.inertia = piston.spin_momentum = 0;
  return piston;
}

// Velocity of the point C of a piston against the block's there, where shaft and block turn alone
// at these speeds.
template <class State>
closed_form::Vec3<double> play(const closed_form::Pump<double>& p, const State& state, double s,
                               double c, double shaft, double block) {
  closed_form::FreeState<double> turning = {};
  if constexpr (std::is_base_of_v<closed_form::FreeState<double>, State>) turning = state;
  turning.omega = shaft;
  turning.block_omega = block;
  turning.omega_dot = turning.block_omega_dot = 0;
  const auto m = closed_form::piston_motion(p.frame, p.piston, turning, s, c);
  const closed_form::Vec3<double> at = closed_form::contact_point(p.block, m);
  return m.joint_first + p.block.contact * m.axis_first -
         block * closed_form::Vec3<double>{-at.y, at.x, 0};
}

}  // namespace

struct BudgetModel::Implementation {
  Implementation(const PumpParameters& pump, const Assumptions& assumptions)
      : model(pump, assumptions),
        prepared(prepare(pump, assumptions)),
        block_weight_and_spring(prepared.numbers.block.force_z),
        torque_factor(pump.friction.shaft_torque_factor),
        values(model.layout().size()) {}

  Budget evaluate(const Instant& instant);
  template <class State>
  Budget causes(const Instant& instant, const State& state) const;
  template <class State>
  double ratio_of_transfer(const Instant& instant, const State& state, double& wall_moment) const;
  // Whether the bores' forces act beside B, where they do work.
  bool off_the_ring() const { return prepared.numbers.block.contact != 1; }
  void put(Budget& budget, Cause cause, double on_shaft, double on_block) const;
  /// Torque about z1 on the shaft of gear or joint that turn the block with `torque` about z2.
  double on_shaft_of(double torque) const;

  Model model;
  PreparedPump prepared;
  double block_weight_and_spring;
  double torque_factor;
  // Of a transfer without a gear at the instant: torque about z1 on the shaft per torque about z2
  // on the block.
  double shaft_per_block = 0;
  std::vector<double> values;
};

double BudgetModel::Implementation::on_shaft_of(double torque) const {
  const closed_form::GearNumbers<double>& gear = prepared.numbers.gear;
  if (prepared.transfer == TransferKind::gear)
    return closed_form::tooth_on_shaft(gear, torque * gear.inverse_arm).moment.z;
  return shaft_per_block * torque;
}

void BudgetModel::Implementation::put(Budget& budget, Cause cause, double on_shaft,
                                      double on_block) const {
  budget.carrying_of(cause) = on_block;
  budget.drive_of(cause) = on_shaft;
  if (prepared.imposed) return;
  // What carries the block against this load, as it acts on the shaft (43), (57).
  budget.drive_of(cause) -= on_shaft_of(on_block);
}

template <class State>
Budget BudgetModel::Implementation::causes(const Instant& instant, const State& state) const {
  using closed_form::BlockLoad;
  using closed_form::ShaftLoad;
  const closed_form::Pump<double>& p = prepared.numbers;
  const LoadAlone loads[] = {
      {Cause::pressure, weightless(massless(p.piston)), 0, 0, false, true},
      {Cause::piston_friction, weightless(massless(p.piston)), 0, 0, true, false},
      {Cause::weight, p.piston, 0, 0, false, false},
      {Cause::inertia, weightless(p.piston), state.rate(), state.rate_dot(), false, false}};
  std::array<BlockLoad<double>, std::size(loads)> on_block = {};
  std::array<ShaftLoad<double>, std::size(loads)> on_shaft = {};
  // Of the torques, what the bores' forces of a load alone take for their work on the play.
  std::array<double, std::size(loads)> ring_on_shaft = {};
  std::array<double, std::size(loads)> ring_on_block = {};
  for (std::size_t k = 0; k < prepared.phase_sin.size(); ++k) {
    const double s = state.sine * prepared.phase_cos[k] - state.cosine * prepared.phase_sin[k];
    const double c = state.cosine * prepared.phase_cos[k] + state.sine * prepared.phase_sin[k];
    const auto motion = closed_form::piston_motion(p.frame, p.piston, state, s, c);
    const double ring_friction = closed_form::friction_force(
        prepared.friction, p.friction, motion.ring_velocity(state.rate()), state.omega);
    closed_form::Vec3<double> shaft_play = {};
    closed_form::Vec3<double> block_play = {};
    if (off_the_ring()) {
      shaft_play = play(p, state, s, c, 1, 0);
      block_play = play(p, state, s, c, 0, 1);
    }
    for (std::size_t i = 0; i < std::size(loads); ++i) {
      const LoadAlone& load = loads[i];
      const double friction = load.friction ? ring_friction : 0;
      const double pressure = load.pressure ? instant.chamber_pressure[k] : 0;
      const auto forces = closed_form::piston_forces(load.piston, motion, load.rate, load.rate_dot,
                                                     friction, pressure);
      closed_form::add_piston(p.block, motion, forces, friction, pressure, on_block[i]);
      closed_form::add_joint(p.frame, forces.rs, s, c, on_shaft[i]);
      ring_on_shaft[i] -= forces.rc_x * shaft_play.x + forces.rc_y * shaft_play.y;
      ring_on_block[i] -= forces.rc_x * block_play.x + forces.rc_y * block_play.y;
    }
  }

  Budget budget;
  double axial = 0;
  double ring_shaft = 0;
  double ring_block = 0;
  for (std::size_t i = 0; i < std::size(loads); ++i) {
    const bool inertia = loads[i].cause == Cause::inertia;
    put(budget, loads[i].cause,
        p.shaft.joint_radius * on_shaft[i].torque +
            (inertia ? p.shaft.inertia * instant.shaft.acceleration : 0) - ring_on_shaft[i],
        (inertia ? p.block.inertia * instant.block.acceleration : 0) - on_block[i].moment.z -
            ring_on_block[i]);
    axial += on_block[i].axial;
    ring_shaft += ring_on_shaft[i];
    ring_block += ring_on_block[i];
  }
  put(budget, Cause::ring, ring_shaft, ring_block);
  put(budget, Cause::block_friction, 0, p.block.viscous * instant.block.speed);
  put(budget, Cause::shaft_friction, p.shaft.viscous * instant.shaft.speed, 0);
  budget.pressing = axial + block_weight_and_spring;
  return budget;
}

// Of a joint: its couple on both bodies. Of pistons: what their walls do to both; `wall_moment` is
// that on the block.
template <class State>
double BudgetModel::Implementation::ratio_of_transfer(const Instant& instant, const State& state,
                                                      double& wall_moment) const {
  const closed_form::Pump<double>& p = prepared.numbers;
  if (prepared.transfer == TransferKind::gear) return 0;
  if constexpr (std::is_same_v<State, closed_form::WallState<double>>) {
    closed_form::BlockLoad<double> block = {};
    closed_form::ShaftLoad<double> shaft = {};
    for (std::size_t k = 0; k < prepared.phase_sin.size(); ++k) {
      const double s = state.sine * prepared.phase_cos[k] - state.cosine * prepared.phase_sin[k];
      const double c = state.cosine * prepared.phase_cos[k] + state.sine * prepared.phase_sin[k];
      const auto m = closed_form::piston_motion(p.frame, p.piston, state, s, c);
      const auto at = closed_form::wall_approach(p.wall, m, prepared.clearance(k));
      const double wall = closed_form::wall_force(p.wall, at, state.mode(static_cast<int>(k)));
      closed_form::PistonForces<double> f = {};
      closed_form::add_wall(p.wall, m, wall * at.x, wall * at.y, f, block);
      closed_form::add_piston(p.block, m, f, 0.0, 0.0, block);
      closed_form::add_joint(p.frame, f.rs, s, c, shaft);
    }
    wall_moment = block.moment.z;
    return wall_moment == 0 ? 0 : -p.shaft.joint_radius * shaft.torque / wall_moment;
  } else {
    static_cast<void>(instant);
    return closed_form::couple(p.joint, state, 1.0).on_shaft.z;
  }
}

Budget BudgetModel::Implementation::evaluate(const Instant& instant) {
  // Tcs is a reaction where the gear carries the block, else it follows from the bores' forces.
  TeethAction teeth;
  if (prepared.imposed)
    model.evaluate(instant, values);
  else
    model.reactions(instant, values, &teeth);
  const closed_form::Pump<double>& p = prepared.numbers;
  const bool toothed = model.has_teeth();
  Budget budget;
  double wall_moment = 0;
  with_state<double>(prepared.transfer, p, instant, [&](const auto& state) {
    shaft_per_block = ratio_of_transfer(instant, state, wall_moment);
    budget = causes(instant, state);
  });

  const ChannelLayout& at = model.layout();
  budget.drive_torque = values[at.Td()];
  budget.drive_of(Cause::torque_factor) = (1 - torque_factor) * budget.drive_torque;
  closed_form::BlockBalance<double> lands = {{0, 0, 0}, 0, 0};
  closed_form::add_lands(p.film, instant.ports.delivery, instant.ports.suction, lands);
  budget.separating = lands.force.z;
  budget.film = values[at.Fh()];
  if (prepared.imposed) {
    budget.carrying_torque = values[at.Tcs()];
  } else if (prepared.transfer == TransferKind::pistons) {
    budget.carrying_torque = wall_moment;
  } else if (prepared.transfer != TransferKind::gear) {
    budget.carrying_torque = values[at.carrying()];
    if (at.has(Quantity::Fcs)) budget.pressing += values[at.Fcs(2)];
  } else {
    const double tooth =
        closed_form::Math<double>::direction(instant.shaft.speed) * values[at.Rcs()];
    const auto carried = closed_form::tooth_on_block(p.gear, tooth);
    budget.carrying_torque = carried.moment.z;
    // Both gears turn at one speed: of what the shaft gives the teeth the block does not get all.
    if (toothed)
      budget.drive_of(Cause::teeth) =
          BevelTeeth::about_shaft_axis(teeth.moment) - budget.carrying_torque;
    budget.pressing += toothed ? prepared.teeth->about_block_axis(teeth.force) : carried.force.z;
  }
  return budget;
}

BudgetModel::BudgetModel(const PumpParameters& pump, const Assumptions& assumptions)
    : implementation_(std::make_unique<Implementation>(pump, assumptions)) {}
BudgetModel::~BudgetModel() = default;
BudgetModel::BudgetModel(BudgetModel&&) noexcept = default;
BudgetModel& BudgetModel::operator=(BudgetModel&&) noexcept = default;

bool BudgetModel::has_ring() const { return implementation_->off_the_ring(); }
bool BudgetModel::has_teeth() const { return implementation_->model.has_teeth(); }

Budget BudgetModel::evaluate(const Instant& instant) { return implementation_->evaluate(instant); }

ResultTable run_budget(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                       const Progress& progress) {
  BudgetModel model(the_case.pump, assumptions);
  ResultTable table = budget_table("analytic", model.has_ring(), model.has_teeth());
  const Model placing(the_case.pump, assumptions);
  PlacedSamples placed(placing, the_case);
  Instant instant;
  const std::size_t count = samples.theta_deg.size();
  table.reserve_rows(count);
  for (std::size_t row = 0; row < count; ++row) {
    samples.instant(row, instant);
    append_budget(table, samples.theta_deg[row], model.evaluate(placed.at(instant)));
    if (progress) progress(static_cast<double>(row + 1) / static_cast<double>(count));
  }
  return table;
}

}  // namespace bentaxis::analytic
