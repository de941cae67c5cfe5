// The closed-form vector-algebra model of a bent-axis pump.
//
// A. Roccatello, N. Nervegna, "Mechanical modelling of a bent axis pump", International Journal of
// Fluid Power 10 (2009) no. 2, pp. 57-72. Equation numbers are the paper's; docs/theory.md has the
// derivation and every correction of a misprint.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/analytic/frozen_lag.h"
#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/teeth.h"

namespace bentaxis::analytic {

struct PreparedPump;

/// A pump prepared for evaluation at any instant. Immutable, so one object serves many threads;
/// cheap to copy.
class Model {
 public:
  /// @throws InputError where a case file with this pump would be refused (validate()), where its
  ///         teeth cannot mesh (teeth.h), or if
  ///         `assumptions` ask for real pistons and the pump has no data of them.
  Model(const PumpParameters& pump, const Assumptions& assumptions);

  const ChannelLayout& layout() const { return layout_; }

  /// All reactions and the drive torque at an instant, by force and moment equilibrium of pistons
  /// (31)-(33), block (56), (57) and shaft (42), (43).
  ///
  /// @param instant  motion of shaft and block, and pressures; one pressure per piston. A block
  ///                 that turns exactly as the shaft does takes the shorter algebra of (9)-(23).
  ///                 A joint prescribes the block's motion: that of the instant is not looked at.
  ///                 Where pistons carry the block, its walls push by their law, and the rest of
  ///                 the block's balance is the torque Tb from outside.
  /// @param values   at least layout().reactions() long; SI, ordered by layout(). Rcs is
  ///                 not_computed() where the block speed is imposed.
  /// @throws InputError where the sizes are others
  /// Rcs follows from the block's balance, whatever a contact law would give. Where the contact is
  /// that of teeth, pin, film, bearings and Td are those of the force and moment that the teeth
  /// have at the instant's lag, or at rest under that Rcs. Allocates nothing. Many instants, or
  /// many pumps, at a time: batch.h.
  /// @param teeth  where not null and the contact is that of teeth: what they do to each other
  void reactions(const Instant& instant, std::vector<double>& values,
                 TeethAction* teeth = nullptr) const;

  /// The same algebra with `long double` (64 bits of mantissa on x86): what reactions() loses to
  /// rounding is the difference. For judging errors, not for speed.
  void reactions(const Instant& instant, std::vector<long double>& values) const;

  /// Like reactions(), and the derived, input and check channels too: layout().size() values.
  /// power_residual is not_computed() where the block is not locked and the shaft is at rest.
  /// @param checks  where not null: checks of a general motion
  /// @param teeth   as of reactions()
  void evaluate(const Instant& instant, std::vector<double>& values, MotionChecks* checks = nullptr,
                TeethAction* teeth = nullptr) const;
  /// How the block turns where a rigid transfer prescribes it, from how the shaft does.
  AxisMotion block_motion(const AxisMotion& shaft) const;
  /// Sets the block's motion and the chambers' pressures of an instant of constant speed, where
  /// they differ from those at the shaft's angle: with a universal joint, and with pistons that
  /// carry the block, where the lag is the root of the block's balance at frozen rates
  /// (docs/transfer.md). Allocates nothing.
  /// @throws InputError where the block has no free play at this angle; ComputationError where no
  ///         lag balances the block before a piston leaves its bore
  void place_at_constant_speed(Instant& instant, const PressureTrace& pressure,
                               LagRules* rules = nullptr) const;
  /// The play of a block that pistons carry, at an angle of the shaft in rad.
  FreePlay free_play(double theta) const;
  /// The lag alone, of pistons that carry the block.
  FrozenLag frozen_lag(const Instant& instant, const PressureTrace& pressure) const;

  /// Whether the shaft moves the block by teeth that touch where they are.
  bool has_teeth() const;

  /// By how much reactions with two flanks differ from those with one line of action, as printed,
  /// where that one's separating part would pull the gears together; 0 where it pushes them apart.
  struct FlankChange {
    double pin = 0;          ///< |change of Rcn|, N
    double film = 0;         ///< |change of Fh|, N
    double tapered = 0;      ///< |change of Rb1|, N
    double cylindrical = 0;  ///< |change of Rb2|, N
  };
  /// @param tooth_force  Rcs
  /// @param speed        of the shaft: its sign turns the line of action (22)
  FlankChange flank_change(double tooth_force, double speed) const;

  /// Power of the sources of friction at an instant, W; positive feeds energy in.
  struct FrictionPower {
    double pistons = 0;             ///< largest of any piston
    double block = 0;               ///< viscous, Cc
    double shaft_viscous = 0;       ///< Cs
    double shaft_proportional = 0;  ///< -(1 - Ct) Td omega of (38)
  };
  FrictionPower friction_power(const Instant& instant, double drive_torque) const;

 private:
  // The rounding estimate moves inputs by little, over their bounds too where they stand on them.
  friend class RoundingEstimate;
  struct Unchecked {};
  Model(const PumpParameters& pump, const Assumptions& assumptions, Unchecked);

  // How teeth stand and what they then do.
  struct Settled {
    ToothLag lag;
    BevelTeeth::Wrench wrench;
  };
  template <class Real>
  Settled resolve_tooth_contact(const Instant& instant, std::vector<Real>& values) const;
  std::optional<Settled> find(const Instant& instant, std::vector<double>& values) const;
  void act(const Instant& instant, const ToothLag& lag, TeethAction& teeth) const;

  PumpParameters pump_;
  ChannelLayout layout_;
  std::shared_ptr<const PreparedPump> prepared_;
};

/// One turn of a case under the assumptions it gives this model, as a table.
/// @param teeth  where not null and the contact is that of teeth: becomes what they do, as a
///               teeth_table()
/// @throws ComputationError where a value is not finite.
ResultTable run(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                const Progress& progress = {}, ResultTable* teeth = nullptr);

/// Reactions at given states of a case's pump, as a table.
/// @param teeth  as of run()
/// @throws ComputationError where a value is not finite.
MotionTable run_states(const Case& the_case, const Assumptions& assumptions, const States& states,
                       const Progress& progress = {}, ResultTable* teeth = nullptr);

}  // namespace bentaxis::analytic
