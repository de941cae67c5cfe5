#include "embedded.h"

asm(".pushsection .rodata\n.balign 16\nbentaxis_fmu_supervisor:\n.incbin \"" BENTAXIS_FMU_SUPERVISOR
    "\"\nbentaxis_fmu_supervisor_end:\n.byte 0\n.popsection\n");

extern "C" {
extern const char bentaxis_fmu_supervisor[], bentaxis_fmu_supervisor_end[];
}

namespace bentaxis::fmu {

std::string_view embedded_supervisor() {
  return {bentaxis_fmu_supervisor,
          static_cast<std::size_t>(bentaxis_fmu_supervisor_end - bentaxis_fmu_supervisor)};
}

}  // namespace bentaxis::fmu
