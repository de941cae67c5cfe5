// Angles of a run with the chamber pressures there.
#pragma once

#include <cstddef>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/instant.h"

namespace bentaxis {

/// Angles of a run, or of a part of it, with the chamber pressures there: evaluated once, given to
/// every model.
struct Samples {
  std::vector<double> theta_deg;
  std::vector<double> chamber_pressure;  ///< row-major, one column per piston, Pa gauge
  PortPressures ports;
  double omega = 0;  ///< rad/s
  int pistons = 0;

  /// Copies sample `row` into `instant`. theta is reduced to one turn first, exactly.
  /// @throws InputError where there is no such row, or not a pressure for each of its pistons
  void instant(std::size_t row, Instant& instant) const;
  /// `count` rows from `first` on, or as many as there are.
  Samples part(std::size_t first, std::size_t count) const;
};

/// Which part of a run is wanted: all of it, unless it is too long to hold.
struct SampleRange {
  long long first = 0;
  long long count = -1;  ///< -1: to the end
};

/// @throws InputError where a case cannot be run at constant speed: where the chambers' pressures
///         are computed and differ from chamber to chamber (universal joint) or depend on the lag
///         (pistons), and where the lag jumps with a step of the pressure
void require_constant_speed(const Case& the_case);

/// Samples of `revolutions` turns: angles 360 i/s for i = 0 .. s x revolutions - 1; against the
/// direction of rotation (speed < 0) an integrated run takes `falling` angles -360 i/s.
Samples sample_case(const Case& the_case, const PressureTrace& pressure, int revolutions = 1,
                    bool falling = false, const SampleRange& range = {});
/// Samples at any angles, deg.
Samples sample_angles(const Case& the_case, const PressureTrace& pressure,
                      std::vector<double> theta_deg);

}  // namespace bentaxis
