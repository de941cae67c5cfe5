// Which variables the unknowns of a unit depend on: ModelStructure of its description. Internal.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "bentaxis/pump/case.h"
#include "runtime/variables.h"

namespace bentaxis::fmu {

struct Dependence {
  std::uint32_t known = 0;  ///< reference
  bool constant = false;    ///< the unknown is linear in it, by one factor everywhere
};
/// By the reference of the unknown; knowns rise.
using DependencesOf = std::map<std::uint32_t, std::vector<Dependence>>;

struct Dependencies {
  /// Outputs, derivatives of states and event indicators: by inputs, states and time.
  DependencesOf running;
  /// Outputs, states and their derivatives at the end of initialization: by inputs and parameters.
  DependencesOf initial;
};

/// Found by differences of the pump's own equations at many states, inputs and parameters, all over
/// the ranges in which its laws differ: what none of them changes does not stand in the equations.
/// The periodic state of oil at the start depends on all that the oil's rates depend on.
/// Where the pump has values at too few of them nothing is said: importers then take all to depend
/// on all.
/// @param variables  of variables_of() for the same case and choice
/// @throws InputError where the case cannot be simulated so
Dependencies dependencies_of(const Case& the_case, const UnitChoice& choice,
                             const std::vector<Variable>& variables);

}  // namespace bentaxis::fmu
