#include "embedded.h"

#include <algorithm>
#include <charconv>
#include <string_view>

// The assembler reads the files: as a text in this source they would take the compiler minutes.
#define BENTAXIS_EMBED(name, file)                                                 \
  asm(".pushsection .rodata\n.balign 16\n" #name ":\n.incbin \"" file "\"\n" #name \
      "_end:\n.byte 0\n.popsection\n")

BENTAXIS_EMBED(bentaxis_fmu_library, BENTAXIS_FMU_LIBRARY);
BENTAXIS_EMBED(bentaxis_fmu_licence, BENTAXIS_FMU_LICENCE);
BENTAXIS_EMBED(bentaxis_fmu_notices, BENTAXIS_FMU_NOTICES);

// NOLINTBEGIN(readability-identifier-naming): names of symbols
extern "C" {
extern const char bentaxis_fmu_library[], bentaxis_fmu_library_end[];
extern const char bentaxis_fmu_licence[], bentaxis_fmu_licence_end[];
extern const char bentaxis_fmu_notices[], bentaxis_fmu_notices_end[];
}
// NOLINTEND(readability-identifier-naming)

namespace bentaxis::fmu {

std::string embedded_library() { return {bentaxis_fmu_library, bentaxis_fmu_library_end}; }
std::string needed_glibc() {
  // Versions of symbols stand in the library as "GLIBC_2.35".
  constexpr std::string_view kPrefix = "GLIBC_2.";
  const std::string_view library(
      bentaxis_fmu_library,
      static_cast<std::size_t>(bentaxis_fmu_library_end - bentaxis_fmu_library));
  int newest = 0;
  for (auto at = library.find(kPrefix); at != std::string_view::npos;
       at = library.find(kPrefix, at + 1)) {
    int minor = 0;
    const char* const first = library.data() + at + kPrefix.size();
    std::from_chars(first, library.data() + library.size(), minor);
    newest = std::max(newest, minor);
  }
  return "2." + std::to_string(newest);
}
std::string embedded_licence() { return {bentaxis_fmu_licence, bentaxis_fmu_licence_end}; }
std::string embedded_notices() { return {bentaxis_fmu_notices, bentaxis_fmu_notices_end}; }

}  // namespace bentaxis::fmu
