// The units of measure of this program, in one table: names, dimensions, factors, and how other
// programs and people write them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bentaxis {

/// Exponents of the SI's base units. Radians count: 1/s is no speed of rotation.
struct Dimension {
  int kg = 0, m = 0, s = 0, kelvin = 0, rad = 0;
  bool operator==(const Dimension&) const = default;
};

struct UnitOfMeasure {
  std::string name;      ///< in case files, columns and tables: "Nm", "l/min"
  std::string quantity;  ///< "Torque"
  Dimension dimension = {};
  double factor = 1, offset = 0;  ///< SI value = factor * value + offset
  std::string standard = {};      ///< in descriptions of FMUs: "N.m", "L/min"
  /// What people read it in, where that is another unit: "rpm" of "rad/s".
  std::string display = {};
  double display_factor = 1;  ///< displayed value = factor * value
  /// Other spellings, as they stand, and in lower case whatever their case was.
  std::vector<std::string> spellings = {}, words = {};
};

/// All of them, in the order of their quantities.
const std::vector<UnitOfMeasure>& units_of_measure();

/// The unit of this name; null where there is none.
const UnitOfMeasure* find_unit_of_measure(std::string_view name);
/// The unit that is written so: by its name, its name in FMUs or one of its spellings; null where
/// there is none.
const UnitOfMeasure* find_written_unit(std::string_view text);
/// The unit that has this word among its words; null where there is none.
/// @param word  in lower case
const UnitOfMeasure* find_unit_by_word(std::string_view word);

/// SI value of one of the unit; 1 where it has no name.
/// @throws std::logic_error where there is no such unit
double unit_in_si(std::string_view name);

}  // namespace bentaxis
