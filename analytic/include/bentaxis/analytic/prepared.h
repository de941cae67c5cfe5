// A pump prepared for the closed form.
#pragma once

#include <vector>

#include "bentaxis/analytic/closed_form.h"
#include "bentaxis/pump/parameters.h"

namespace bentaxis::analytic {

/// Numbers of a pump under its assumptions, and what the algebra needs beside them.
struct PreparedPump {
  closed_form::Pump<double> numbers;
  bool imposed = false, smooth_friction = false, dry_friction = false;
  std::vector<double> phase_sin, phase_cos;  // of 2 pi k / N

  closed_form::Common common() const {
    return {static_cast<int>(phase_sin.size()),
            phase_sin.data(),
            phase_cos.data(),
            imposed,
            smooth_friction,
            dry_friction};
  }
};

/// Fills in what depends on the geometry alone.
void prepare_geometry(const Geometry& g, closed_form::Pump<double>& p);

/// @throws InputError if real pistons are asked for and the pump has no data of them.
PreparedPump prepare(const PumpParameters& pump, const Assumptions& assumptions);

}  // namespace bentaxis::analytic
