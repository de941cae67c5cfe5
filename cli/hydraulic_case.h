// Cases whose chamber pressure has to be computed first.
#pragma once

#include <optional>
#include <string>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::cli {

/// A case that the models can be run on, with what the hydraulic model found if it was asked.
struct ReadyCase {
  Case the_case;
  std::optional<hydraulics::SteadyState> hydraulics;  ///< of kind "hydraulic"
};

/// Computes the chamber pressure of a case where its pressure is of kind "hydraulic" and puts it
/// into the case: one curve, which both models then get. Other cases pass through unchanged.
/// @throws InputError, ComputationError
ReadyCase with_pressure(Case the_case);

/// Reads a case and computes its chamber pressure where needed.
ReadyCase read_ready_case(const std::string& file);

}  // namespace bentaxis::cli
