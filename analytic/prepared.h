// A pump prepared for the closed form. Internal.
#pragma once

#include <optional>
#include <vector>

#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/channels.h"
#include "closed_form/pump.h"

namespace bentaxis::analytic {

/// All numbers of a pump from the raw ones. @return the friction law it has
template <class T>
closed_form::FrictionLaw prepare_numbers(const closed_form::RawPump<T>& raw,
                                         const PumpParameters& pump, const Assumptions& assumptions,
                                         closed_form::Pump<T>& p) {
  closed_form::prepare(raw.geometry, p.frame);
  closed_form::prepare(raw.geometry, p.frame, p.piston);
  closed_form::prepare(raw, assumptions.inertia, p.frame, p.piston);
  const auto law = closed_form::prepare(raw, assumptions.piston_friction, p.friction);
  closed_form::prepare(raw, p.piston, p.block);
  closed_form::prepare(raw, pump.port_plate.has_value(), p.film);
  closed_form::prepare(raw, pump.gear.flanks, p.gear);
  closed_form::prepare(raw, p.frame, p.shaft);
  closed_form::prepare(raw, p.joint);
  closed_form::prepare(raw, p.wall);
  return law;
}

/// Numbers of a pump under its assumptions, and what the algebra needs beside them.
struct PreparedPump {
  closed_form::Pump<double> numbers;
  bool imposed = false;
  TransferKind transfer = TransferKind::gear;
  closed_form::FrictionLaw friction;
  std::optional<closed_form::ToothLaw> tooth_law;  // of flanks that give way
  std::optional<BevelTeeth> teeth;                 // where the contact is theirs
  std::vector<double> phase_sin, phase_cos;        // of 2 pi k / N
  std::vector<double> clearances;                  // of each piston where they differ; else empty

  /// Whether a gear's teeth carry the block round.
  bool has_tooth_force() const { return transfer == TransferKind::gear && !imposed; }
  /// m, of a piston, counted from 0.
  double clearance(std::size_t k) const {
    return clearances.empty() ? numbers.wall.clearance : clearances[k];
  }
  closed_form::Common common() const {
    return {.pistons = static_cast<int>(phase_sin.size()),
            .phase_sin = phase_sin.data(),
            .phase_cos = phase_cos.data(),
            .imposed = imposed,
            .friction = friction,
            .transfer = transfer,
            .clearances = clearances.empty() ? nullptr : clearances.data()};
  }
  /// The same where there is room for the transfer's own columns.
  closed_form::Common common(const ChannelLayout& at) const {
    closed_form::Common result = common();
    if (at.has(Quantity::TcsJoint)) result.couple_column = static_cast<int>(at.TcsJoint(0));
    if (at.has(Quantity::Fcs)) result.force_column = static_cast<int>(at.Fcs(0));
    if (at.has(Quantity::Rw)) result.wall_column = static_cast<int>(at.Rw(0, 0));
    if (at.has(Quantity::Tb)) result.block_torque_column = static_cast<int>(at.Tb());
    return result;
  }
};

/// @throws InputError if real pistons are asked for and the pump has no data of them.
PreparedPump prepare(const PumpParameters& pump, const Assumptions& assumptions);
/// The same in place: allocates nothing where `result` has been a pump with as many pistons.
void prepare(const PumpParameters& pump, const Assumptions& assumptions, PreparedPump& result);

}  // namespace bentaxis::analytic
