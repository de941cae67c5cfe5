// Text of an FMU, made fit for messages and reports. Internal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bentaxis::fmu {

/// One line of UTF-8: control characters become spaces, bytes that are no UTF-8 question marks.
/// @param most  bytes; longer text is cut between characters and ends in ".."
std::string plain_text(std::string_view text, std::size_t most);

}  // namespace bentaxis::fmu
