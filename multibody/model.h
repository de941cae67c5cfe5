// The multibody model, evaluated at given instants without time integration ("driven").
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/channels.h"
#include "bentaxis/pump/instant.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/result_table.h"

namespace bentaxis::multibody {

/// A pump in Simbody. At each instant shaft and block are set to their angle, Simbody's projection
/// finds the pistons, and its constraint solver accelerations and reactions. Not thread-safe: use
/// one object per thread.
class Model {
 public:
  /// @param omega_sign  sign of the speed the model will be evaluated at: the gear's line of action
  ///                    depends on it (22); 0 counts as positive
  /// @throws InputError if real pistons are asked for and the pump has no data of them
  /// @throws ComputationError if a piston has no inertia about its joint
  Model(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign);
  ~Model();
  Model(Model&&) noexcept;
  Model& operator=(Model&&) noexcept;

  const ChannelLayout& layout() const;

  /// All channels at an instant, SI, ordered by layout().
  /// @throws ComputationError where the pump cannot be assembled or constraints are redundant.
  void evaluate(const Instant& instant, std::vector<double>& values);

  /// Bodies, mobilities, constraint equations and their rank, for a report. After an evaluation.
  Provenance provenance() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// What the multibody scene consists of, as lines for a report.
std::vector<std::pair<std::string, std::string>> scene_facts(const PumpParameters& pump,
                                                             const Assumptions& assumptions);

/// One turn of a case under the given assumptions, as a table.
ResultTable run_driven(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                       const Progress& progress = {});

}  // namespace bentaxis::multibody
