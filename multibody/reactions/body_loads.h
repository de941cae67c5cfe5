// All loads on the bodies of a placed pump.
#pragma once

#include <SimTKsimbody.h>

#include <optional>
#include <vector>

#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/teeth.h"
#include "loads/film.h"
#include "reactions/reactions.h"

namespace bentaxis::multibody {

/// Reads what Simbody has: reactions that were found, the laws that its force elements apply, and
/// inertia from the mass properties and accelerations of its bodies. Nothing is what other loads
/// leave over.
class BodyLoadReader {
 public:
  /// @param pump  of the full scene; outlives the reader
  explicit BodyLoadReader(const PumpSystem& pump) : pump_(pump) {}

  /// Names and order are those of analytic/body_loads.h.
  /// @param state          realized to Dynamics
  /// @param accelerations  of its mobilities
  /// @param pressure       chamber pressures in force, Pa
  /// @param teeth          what bevel teeth do; null where there are none
  std::vector<BodyLoad> read(const SimTK::State& state, const SimTK::Vector& accelerations,
                             const Reactions& reactions, const std::vector<double>& pressure,
                             const TeethAction* teeth);

 private:
  struct Looked;
  void read_pistons(Looked& at, const std::vector<double>& pressure) const;
  void read_transfer(Looked& at, const TeethAction* teeth) const;
  void read_block(Looked& at);
  void read_shaft(Looked& at) const;

  const PumpSystem& pump_;
  /// Of the lands of either port at a pressure of kUnitPressure.
  struct LandLoads {
    FilmLoad delivery, suction;
  };
  std::optional<LandLoads> lands_;
};

}  // namespace bentaxis::multibody
