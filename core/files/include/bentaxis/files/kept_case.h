// A case to be kept elsewhere: its text and the curves it names.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/case.h"

namespace bentaxis {

struct KeptCase {
  struct Curve {
    std::string name;  ///< as the text has it, relative to the case file: "curves/motor.csv"
    std::string bytes;
  };
  std::string text;  ///< of a case file
  std::vector<Curve> curves;
};

/// The case as case_text() has it, its curves under names of their own beside it.
/// @throws InputError where a curve cannot be read, or is another than the case was read from
KeptCase kept_case(const Case& the_case);

/// All of a file. @throws InputError where it cannot be read
std::string bytes_of(const std::filesystem::path& file);

}  // namespace bentaxis
