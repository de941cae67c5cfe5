// modelDescription.xml: what a unit says of itself. Internal.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/fmu/unit.h"
#include "dependencies.h"
#include "runtime/variables.h"

namespace bentaxis::fmu {

/// Name of the library in the archive, without its ending.
inline constexpr const char* kModelIdentifier = "bentaxis_pump";

struct Description {
  std::vector<Variable> variables;  ///< of variables_of()
  std::string model_name, text;     ///< name, and one sentence
  std::string token;                ///< guid of FMI 2, instantiationToken of FMI 3
  std::string generated;            ///< date and time; empty: left out
  double stop_time = 1;             ///< s
  double step = 0;                  ///< s, of communication, where there is a usual one; 0: none
  double tolerance = 1e-9;
  Dependencies dependencies;  ///< of unknowns that are not there nothing is said
};

std::string description_fmi2(const Description& description);
std::string description_fmi3(const Description& description);
inline std::string description_xml(Version version, const Description& description) {
  return version == Version::fmi2 ? description_fmi2(description) : description_fmi3(description);
}

/// How a variable gets its value at the start.
enum class Initial {
  none,        ///< of inputs and of time, where the word must not stand
  exact,       ///< its start value
  calculated,  ///< in initialization mode; without a start value
};
Initial initial_of(const Variable& variable);

/// Unknowns of initialization mode, as both versions ask for them: outputs, states and their
/// derivatives that are calculated. In the order of the list.
std::vector<const Variable*> initial_unknowns(const std::vector<Variable>& variables);

}  // namespace bentaxis::fmu
