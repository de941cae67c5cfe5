// What drives shaft and block under given accelerations. Internal.
#pragma once

#include <array>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/instant.h"
#include "prepared.h"
#include "turning.h"

namespace bentaxis::analytic::simulation {

/// Both as the equations of motion need them; affine in the accelerations.
struct Response {
  double drive_torque;  ///< Td, Nm
  /// Of a gear the tooth force on the block towards +psi, N; of pistons that carry the block the
  /// torque that its balance wants from outside, Nm; of a joint 0.
  double tooth_force;
};

/// Of pressure, ring friction and weight on each piston, W; whatever the accelerations.
using PistonPowers = std::array<double, kMaxPistons>;

class Responses {
 public:
  Responses(const PumpParameters& pump, const Assumptions& assumptions);

  /// At an instant, whose own accelerations are not looked at.
  /// @param modes   of the walls; null: all by their law
  /// @param powers  where not null: become those of the pistons
  Response at(const Instant& instant, const Accelerations<double>& by,
              const closed_form::WallMode* modes, PistonPowers* powers = nullptr) const;
  /// The same under two accelerations, in the time of one but for pistons that carry the block.
  std::array<Response, 2> at(const Instant& instant, const Accelerations<double>& first,
                             const Accelerations<double>& second,
                             const closed_form::WallMode* modes,
                             PistonPowers* powers = nullptr) const;
  /// The tooth force alone under two accelerations, of a gear: what the block's motion needs.
  std::array<double, 2> tooth_forces(const Instant& instant, const Accelerations<double>& first,
                                     const Accelerations<double>& second) const;

 private:
  // What a response consists of; the rest of the closed form is not computed.
  enum class Wanted { all, tooth_force };
  template <Wanted wanted, class Real>
  void find(const Instant& instant, const Accelerations<Real>& by, bool locked,
            const closed_form::WallMode* modes, Real& drive_torque, Real& tooth_force,
            PistonPowers* powers) const;

  PreparedPump pump_;
};

}  // namespace bentaxis::analytic::simulation
