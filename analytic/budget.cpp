#include "bentaxis/analytic/budget.h"

#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "bentaxis/analytic/model.h"
#include "closed_form/reactions.h"
#include "prepared.h"

namespace bentaxis::analytic {
namespace {

// A load of the pistons alone: their numbers without what the other loads come from.
struct LoadAlone {
  Cause cause;
  closed_form::PistonNumbers<double> piston;
  double omega, omega_dot;  // that inertia knows of
  bool friction, pressure;
};

// Pistons without weight: mass is what the accelerations of `omega` make of it.
closed_form::PistonNumbers<double> weightless(closed_form::PistonNumbers<double> piston) {
  piston.gravity_y = piston.gravity_z = 0;
  return piston;
}

closed_form::PistonNumbers<double> massless(closed_form::PistonNumbers<double> piston) {
  piston.mass = piston.static_moment = piston.inertia = piston.spin_momentum = 0;
  return piston;
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
  void put(Budget& budget, Cause cause, double on_shaft, double on_block) const;

  Model model;
  PreparedPump prepared;
  double block_weight_and_spring;
  double torque_factor;
  std::vector<double> values;
};

void BudgetModel::Implementation::put(Budget& budget, Cause cause, double on_shaft,
                                      double on_block) const {
  budget.carrying_of(cause) = on_block;
  budget.drive_of(cause) = on_shaft;
  if (prepared.imposed) return;
  // The tooth force that carries the block against this load, as it acts on the shaft (43), (57).
  const closed_form::GearNumbers<double>& gear = prepared.numbers.gear;
  budget.drive_of(cause) -= closed_form::tooth_on_shaft(gear, on_block * gear.inverse_arm).moment.z;
}

Budget BudgetModel::Implementation::evaluate(const Instant& instant) {
  using closed_form::BlockLoad;
  using closed_form::ShaftLoad;
  const closed_form::Pump<double>& p = prepared.numbers;
  const double omega = instant.shaft.speed;
  const double omega_dot = instant.shaft.acceleration;
  const double sine = std::sin(instant.shaft.angle);
  const double cosine = std::cos(instant.shaft.angle);
  // Tcs is a reaction where the gear carries the block, else it follows from the bores' forces.
  if (prepared.imposed)
    model.evaluate(instant, values);
  else
    model.reactions(instant, values);

  const LoadAlone loads[] = {
      {Cause::pressure, weightless(massless(p.piston)), 0, 0, false, true},
      {Cause::piston_friction, weightless(massless(p.piston)), 0, 0, true, false},
      {Cause::weight, p.piston, 0, 0, false, false},
      {Cause::inertia, weightless(p.piston), omega, omega_dot, false, false}};
  std::array<BlockLoad<double>, std::size(loads)> on_block = {};
  std::array<ShaftLoad<double>, std::size(loads)> on_shaft = {};
  for (std::size_t k = 0; k < prepared.phase_sin.size(); ++k) {
    const double s = sine * prepared.phase_cos[k] - cosine * prepared.phase_sin[k];
    const double c = cosine * prepared.phase_cos[k] + sine * prepared.phase_sin[k];
    const auto motion = closed_form::piston_motion(p.frame, p.piston, s, c);
    const double ring_friction = closed_form::friction_force(prepared.friction, p.friction,
                                                             motion.ring_velocity(omega), omega);
    for (std::size_t i = 0; i < std::size(loads); ++i) {
      const LoadAlone& load = loads[i];
      const double friction = load.friction ? ring_friction : 0;
      const double pressure = load.pressure ? instant.chamber_pressure[k] : 0;
      const auto forces = closed_form::piston_forces(load.piston, motion, load.omega,
                                                     load.omega_dot, friction, pressure);
      closed_form::add_piston(p.block, motion, forces, friction, pressure, on_block[i]);
      closed_form::add_joint(p.frame, forces.rs, s, c, on_shaft[i]);
    }
  }

  Budget budget;
  double axial = 0;
  for (std::size_t i = 0; i < std::size(loads); ++i) {
    const bool inertia = loads[i].cause == Cause::inertia;
    put(budget, loads[i].cause,
        p.shaft.joint_radius * on_shaft[i].torque + (inertia ? p.shaft.inertia * omega_dot : 0),
        (inertia ? p.block.inertia * omega_dot : 0) - on_block[i].moment.z);
    axial += on_block[i].axial;
  }
  put(budget, Cause::block_friction, 0, p.block.viscous * omega);
  put(budget, Cause::shaft_friction, p.shaft.viscous * omega, 0);

  const ChannelLayout& at = model.layout();
  budget.drive_torque = values[at.Td()];
  budget.drive_of(Cause::torque_factor) = (1 - torque_factor) * budget.drive_torque;
  closed_form::BlockBalance<double> lands = {{0, 0, 0}, 0, 0};
  closed_form::add_lands(p.film, instant.ports.delivery, instant.ports.suction, lands);
  budget.separating = lands.force.z;
  budget.pressing = axial + block_weight_and_spring;
  budget.film = values[at.Fh()];
  if (prepared.imposed) {
    budget.carrying_torque = values[at.Tcs()];
  } else {
    const double tooth = closed_form::Math<double>::direction(omega) * values[at.Rcs()];
    const auto carried = closed_form::tooth_on_block(p.gear, tooth);
    budget.carrying_torque = carried.moment.z;
    budget.pressing += carried.force.z;
  }
  return budget;
}

BudgetModel::BudgetModel(const PumpParameters& pump, const Assumptions& assumptions)
    : implementation_(std::make_unique<Implementation>(pump, assumptions)) {}
BudgetModel::~BudgetModel() = default;
BudgetModel::BudgetModel(BudgetModel&&) noexcept = default;
BudgetModel& BudgetModel::operator=(BudgetModel&&) noexcept = default;

Budget BudgetModel::evaluate(const Instant& instant) { return implementation_->evaluate(instant); }

ResultTable run_budget(const Case& the_case, const Assumptions& assumptions,
                       const Samples& samples) {
  BudgetModel model(the_case.pump, assumptions);
  ResultTable table = budget_table("analytic");
  Instant instant;
  for (std::size_t row = 0; row < samples.theta_deg.size(); ++row) {
    samples.instant(row, instant);
    append_budget(table, samples.theta_deg[row], model.evaluate(instant));
  }
  return table;
}

}  // namespace bentaxis::analytic
