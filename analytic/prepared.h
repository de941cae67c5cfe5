// A pump prepared for the closed form. Internal.
#pragma once

#include <optional>
#include <vector>

#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/parameters.h"
#include "closed_form/pump.h"

namespace bentaxis::analytic {

/// Numbers of a pump under its assumptions, and what the algebra needs beside them.
struct PreparedPump {
  closed_form::Pump<double> numbers;
  bool imposed = false;
  closed_form::FrictionLaw friction;
  std::optional<closed_form::ToothLaw> tooth_law;  // of flanks that give way
  std::optional<BevelTeeth> teeth;                 // where the contact is theirs
  std::vector<double> phase_sin, phase_cos;        // of 2 pi k / N

  closed_form::Common common() const {
    return {static_cast<int>(phase_sin.size()), phase_sin.data(), phase_cos.data(), imposed,
            friction};
  }
};

/// @throws InputError if real pistons are asked for and the pump has no data of them.
PreparedPump prepare(const PumpParameters& pump, const Assumptions& assumptions);
/// The same in place: allocates nothing where `result` has been a pump with as many pistons.
void prepare(const PumpParameters& pump, const Assumptions& assumptions, PreparedPump& result);

}  // namespace bentaxis::analytic
