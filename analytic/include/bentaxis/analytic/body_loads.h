// All loads on pistons, block and shaft, for their free-body diagrams, by the closed form.
#pragma once

#include <memory>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/samples.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::analytic {

/// Loads of one body after the other: pistons, block, shaft. Reactions are those that the model
/// finds, oil, friction and film those it finds them from; inertia is masses (point masses where
/// pistons are lumped or dynamically equivalent) times accelerations and the rate of the angular
/// momentum about the centre of mass, where it acts. No load is found by subtraction, so that
/// their sums check the equilibrium.
///
/// On a piston Rs, Rc, Fp, Fpf, Pp, inertia; on the block of every piston Rc, Fpf, Ftp, then Fh and
/// Th (counted at O2), Rcn, the gear's, Tcf, Fth of each port (at its own centre of pressure), Fm,
/// Pc, inertia; on the shaft of every piston Rs, the gear's, Rb1, Rb2, Td, Tsf, Fm, Ps, inertia.
/// The gear's: Rcs at O4; of teeth in contact Rcs of every pair that may touch (of one that does
/// not touch 0 at O4); where the block's motion is imposed Tcs on the block instead. Without a port
/// plate there is no Fth.
class BodyLoads {
 public:
  /// @throws InputError as Model does
  BodyLoads(const PumpParameters& pump, const Assumptions& assumptions);
  ~BodyLoads();
  BodyLoads(BodyLoads&&) noexcept;
  BodyLoads& operator=(BodyLoads&&) noexcept;

  /// @throws InputError as Model::evaluate() does
  std::vector<BodyLoad> evaluate(const Instant& instant);

  /// With reactions of a row that was found before.
  /// @param values  a row that Model::evaluate() filled at this instant, SI
  /// @param teeth   the state of the teeth there; read where contact is resolved
  std::vector<BodyLoad> of_row(const Instant& instant, const std::vector<double>& values,
                               const TeethAction& teeth) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Loads of one turn of a case under the assumptions it gives this model, as many rows as samples.
BodyLoadTable run_body_loads(const Case& the_case, const Assumptions& assumptions,
                             const Samples& samples, const Progress& progress = {});
/// At given states of a case's pump.
BodyLoadTable run_body_loads(const Case& the_case, const Assumptions& assumptions,
                             const States& states, const Progress& progress = {});

}  // namespace bentaxis::analytic
