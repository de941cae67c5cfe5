// A state of an instance that it can go on from, and its bytes. Internal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plant.h"

namespace bentaxis::fmu {

/// Where an instance stands in its run.
struct Standing {
  unsigned mode = 1;  ///< Mode
  double start_time = 0, stop_time = 0, now = 0, tolerance = 0;
  bool stops = false, set_up = false;
  bool started = false;  ///< whether the plant is
};

struct SavedState : Standing {
  std::vector<double> parameters;
  Inputs inputs;
  PlantState plant;
};

/// The bytes of a state: a tag with the version of this layout, the unit's token, lengths, and a
/// checksum at the end. Little-endian.
std::string bytes_of(const SavedState& state, const std::string& token);
/// @throws InputError where the bytes are not such a state of a unit with that token
SavedState state_of(const char* bytes, std::size_t size, const std::string& token);

}  // namespace bentaxis::fmu
