// Tables of very many rows whose values lie in a file.
#pragma once

#include <filesystem>

#include "bentaxis/results/result_table.h"

namespace bentaxis {

/// Moves the values of a table into a file of a folder that has no name, so that nobody else finds
/// it and it is gone with the last copy of the table. They are read from there as they were. Where
/// the folder takes no file, or the disk has no room, they stay in the memory.
/// @return whether they were moved
bool store_values(ResultTable& table, const std::filesystem::path& folder);

}  // namespace bentaxis
