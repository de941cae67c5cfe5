// A case with the closed form and its oil, built and kept together. Internal.
#pragma once

#include <memory>
#include <optional>

#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"

namespace bentaxis::fmu {

struct Machine {
  /// @param given  with a [drive]
  /// @param start  of the oil, of a hydraulic case
  /// @throws InputError
  Machine(const Case& given, const hydraulics::OilStart& start);
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  const Case the_case;  // the models keep references to it
  std::optional<PressureTrace> pressure;
  std::unique_ptr<Mechanics> mechanics;
  std::unique_ptr<Oil> oil;
};

/// Where the oil of a case starts: in its periodic state, at rest, or nowhere. Where that has to be
/// computed, what it is of the ports' pressures is given to the case, as simulate does.
/// @throws InputError, ComputationError
hydraulics::OilStart oil_start(Case& the_case, bool from_rest);

}  // namespace bentaxis::fmu
