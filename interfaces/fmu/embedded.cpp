#include "embedded.h"

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
std::string embedded_licence() { return {bentaxis_fmu_licence, bentaxis_fmu_licence_end}; }
std::string embedded_notices() { return {bentaxis_fmu_notices, bentaxis_fmu_notices_end}; }

}  // namespace bentaxis::fmu
