// Instances by version of FMI. Internal.
#pragma once

#include <memory>
#include <string>

#include "bentaxis/fmu/slave.h"
#include "shared_library.h"

namespace bentaxis::fmu {

/// What an instance is made of.
struct SlaveOrigin {
  const UnitDescription& description;
  const SharedLibrary& library;
  std::filesystem::path resources;
  std::string unit;  ///< file, for messages
  std::string name;  ///< of the instance
};

/// @throws InputError naming functions that the library lacks, another version of it, and in the
///         unit's words where it does not start
std::unique_ptr<Slave> fmi2_slave(const SlaveOrigin& origin);
std::unique_ptr<Slave> fmi3_slave(const SlaveOrigin& origin);

}  // namespace bentaxis::fmu
