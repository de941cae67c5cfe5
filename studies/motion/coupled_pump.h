// A case's mechanics by either model, coupled to its oil. Internal.
#pragma once

#include <memory>

#include "bentaxis/coupled/simulation.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

class CoupledPump {
 public:
  /// @param ready    outlives it
  /// @param follows  whether the oil follows the motion; else its pressure is that of the case,
  ///                 over the block's angle
  CoupledPump(const PreparedCase& ready, bool follows);

  Trajectory simulate(Model model, const coupled::Options& options,
                      const Progress& progress = {}) const;
  coupled::SteadyMotion steady(Model model, const coupled::Options& options,
                               const Progress& progress = {}) const;

 private:
  std::unique_ptr<Mechanics> mechanics(Model model) const;
  const PreparedCase& ready_;
  std::unique_ptr<Oil> oil_;
};

/// kg that passed, of a simulation with oil: in, out or, in a closed loop, through the load.
double mass_passed(const Trajectory& run);

}  // namespace bentaxis::study
