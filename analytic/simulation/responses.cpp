#include "simulation/responses.h"

#include <type_traits>

#include "closed_form/pair.h"
#include "closed_form/reactions.h"

namespace bentaxis::analytic::simulation {

Responses::Responses(const PumpParameters& pump, const Assumptions& assumptions)
    : pump_(prepare(pump, assumptions)) {}

template <class Real>
void Responses::find(const Instant& instant, const Accelerations<Real>& by, bool locked,
                     const closed_form::WallMode* modes, Real& drive_torque,
                     Real& tooth_force) const {
  closed_form::Common common = pump_.common();
  constexpr int kBlockTorque = 1 << 20;  // no other column
  common.block_torque_column = kBlockTorque;
  const int td = closed_form::column<Quantity::Td>(common.pistons, 0, 0);
  const int carrying = pump_.transfer == TransferKind::gear
                           ? closed_form::column<Quantity::Rcs>(common.pistons, 0, 0)
                           : kBlockTorque;
  tooth_force = 0;
  const auto use = [&](const auto& state) {
    using Turning = std::decay_t<decltype(state)>;
    if constexpr (!std::is_same_v<Turning, closed_form::WallState<closed_form::Pair>>) {
      closed_form::reactions<Real>(
          common, pump_.numbers, state, true,
          [pressure = instant.chamber_pressure.data()](int k) { return Real(pressure[k]); },
          [&](int column, const Real& value) {
            if (column == td) drive_torque = value;
            if (column == carrying) tooth_force = value;
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
                       const closed_form::WallMode* modes) const {
  Response r;
  find<double>(instant, by, locked(instant, by), modes, r.drive_torque, r.tooth_force);
  return r;
}

std::array<Response, 2> Responses::at(const Instant& instant, const Accelerations<double>& first,
                                      const Accelerations<double>& second,
                                      const closed_form::WallMode* modes) const {
  if (pump_.transfer == TransferKind::pistons)
    return {at(instant, first, modes), at(instant, second, modes)};
  using closed_form::Pair;
  Pair drive_torque, tooth_force;
  find<Pair>(instant, {{first.shaft, second.shaft}, {first.block, second.block}},
             locked(instant, first) && locked(instant, second), nullptr, drive_torque, tooth_force);
  return {Response{drive_torque.first(), tooth_force.first()},
          Response{drive_torque.second(), tooth_force.second()}};
}

}  // namespace bentaxis::analytic::simulation
