#include "embedded.h"

asm(".pushsection .rodata\n.balign 16\nkBentaxisFmuSupervisor:\n.incbin \"" BENTAXIS_FMU_SUPERVISOR
    "\"\nkBentaxisFmuSupervisorEnd:\n.byte 0\n.popsection\n");

extern "C" {
extern const char kBentaxisFmuSupervisor[], kBentaxisFmuSupervisorEnd[];
}

namespace bentaxis::fmu {

std::string_view embedded_supervisor() {
  return {kBentaxisFmuSupervisor,
          static_cast<std::size_t>(kBentaxisFmuSupervisorEnd - kBentaxisFmuSupervisor)};
}

}  // namespace bentaxis::fmu
