#include "simulation/responses.h"

#include <type_traits>

#include "closed_form/pair.h"
#include "closed_form/reactions.h"

namespace bentaxis::analytic::simulation {

Responses::Responses(const PumpParameters& pump, const Assumptions& assumptions)
    : pump_(prepare(pump, assumptions)) {}

namespace {

double first_of(double value) { return value; }
double first_of(const closed_form::Pair& values) { return values.first(); }

}  // namespace

template <Responses::Wanted wanted, class Real>
void Responses::find(const Instant& instant, const Accelerations<Real>& by, bool locked,
                     const closed_form::WallMode* modes, Real& drive_torque, Real& tooth_force,
                     PistonPowers* powers) const {
  closed_form::Common common = pump_.common();
  constexpr int kBlockTorque = 1 << 20;  // no other column
  common.block_torque_column = kBlockTorque;
  const int td = closed_form::column<Quantity::Td>(common.pistons, 0, 0);
  const int carrying = pump_.transfer == TransferKind::gear
                           ? closed_form::column<Quantity::Rcs>(common.pistons, 0, 0)
                           : kBlockTorque;
  const closed_form::PistonNumbers<double>& piston = pump_.numbers.piston;
  tooth_force = 0;
  const auto use = [&](const auto& state) {
    using Turning = std::decay_t<decltype(state)>;
    if constexpr (!std::is_same_v<Turning, closed_form::WallState<closed_form::Pair>>) {
      closed_form::reactions<Real>(
          common, pump_.numbers, state, true,
          [pressure = instant.chamber_pressure.data()](int k) { return Real(pressure[k]); },
          [&](int column, const Real& value) {
            if constexpr (wanted == Wanted::all)
              if (column == td) drive_torque = value;
            if (column == carrying) tooth_force = value;
          },
          [&](int k, const auto& m, const auto& f) {
            if (wanted != Wanted::all || powers == nullptr) return;
            const Real rate = state.rate();
            const auto falling = [&](const Real& joint, const Real& axis, double gravity) {
              return gravity * rate * (piston.mass * joint + piston.static_moment * axis);
            };
            (*powers)[k] = first_of(f.axial * m.ring_velocity(rate) +
                                    falling(m.joint_first.y, m.axis_first.y, piston.gravity_y) +
                                    falling(m.joint_first.z, m.axis_first.z, piston.gravity_z));
          });
    }
  };
  with_state<Real>(pump_.transfer, pump_.numbers, instant, by, locked, use, modes);
  // Rcs is positive along the turning (22).
  if (pump_.transfer == TransferKind::gear && instant.shaft.speed < 0) tooth_force = -tooth_force;
}

namespace {

bool locked(const Instant& instant, const Accelerations<double>& by) {
  return by.shaft == by.block && instant.shaft.angle == instant.block.angle &&
         instant.shaft.speed == instant.block.speed;
}

}  // namespace

Response Responses::at(const Instant& instant, const Accelerations<double>& by,
                       const closed_form::WallMode* modes, PistonPowers* powers) const {
  Response r;
  find<Wanted::all, double>(instant, by, locked(instant, by), modes, r.drive_torque, r.tooth_force,
                            powers);
  return r;
}

std::array<Response, 2> Responses::at(const Instant& instant, const Accelerations<double>& first,
                                      const Accelerations<double>& second,
                                      const closed_form::WallMode* modes,
                                      PistonPowers* powers) const {
  if (pump_.transfer == TransferKind::pistons)
    return {at(instant, first, modes, powers), at(instant, second, modes)};
  using closed_form::Pair;
  Pair drive_torque, tooth_force;
  find<Wanted::all, Pair>(instant, {{first.shaft, second.shaft}, {first.block, second.block}},
                          locked(instant, first) && locked(instant, second), nullptr, drive_torque,
                          tooth_force, powers);
  return {Response{drive_torque.first(), tooth_force.first()},
          Response{drive_torque.second(), tooth_force.second()}};
}

std::array<double, 2> Responses::tooth_forces(const Instant& instant,
                                              const Accelerations<double>& first,
                                              const Accelerations<double>& second) const {
  using closed_form::Pair;
  Pair unused, tooth_force;
  find<Wanted::tooth_force, Pair>(
      instant, {{first.shaft, second.shaft}, {first.block, second.block}},
      locked(instant, first) && locked(instant, second), nullptr, unused, tooth_force, nullptr);
  return {tooth_force.first(), tooth_force.second()};
}

}  // namespace bentaxis::analytic::simulation
