// An instance for co-simulation in a process of its own. Internal.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "bentaxis/fmu/slave.h"
#include "channel.h"

namespace bentaxis::fmu {

/// What an instance is made of.
struct SlaveOrigin {
  std::shared_ptr<const void> owner;  ///< kept as long as the instance
  const UnitDescription& description;
  std::filesystem::path resources;
  std::string unit;                  ///< file, for messages
  std::string name;                  ///< of the instance
  std::unique_ptr<Channel> channel;  ///< of a process that has loaded the library
};

/// @throws InputError naming functions that the library lacks, another version of it, and in the
///         FMU's words where it does not start; ComputationError where it does not come back
std::unique_ptr<Slave> process_slave(SlaveOrigin origin);

/// What a type of FMI 2 or 3 is in messages between processes. @param version  of FMI
process::Type type_of(const UnitVariable& variable, int version);

}  // namespace bentaxis::fmu
