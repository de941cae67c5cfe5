// A value of a table of numbers that cannot be used. Internal.
#pragma once

#include <string>

#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {

/// @param range  what it must be
[[noreturn]] inline void refuse_value(const std::filesystem::path& file, const NumericTable& table,
                                      std::size_t row, std::size_t column,
                                      const std::string& range) {
  throw InputError(file.string() + ":" + std::to_string(table.lines[row]) + ": " +
                   table.header[column] + " = " + number_text(table.rows[row][column]) +
                   ": must be " + range);
}

}  // namespace bentaxis
