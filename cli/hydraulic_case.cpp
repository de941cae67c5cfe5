#include "hydraulic_case.h"

#include <utility>

#include "console.h"

namespace bentaxis::cli {

ReadyCase with_pressure(Case the_case) {
  ReadyCase ready{std::move(the_case), {}};
  if (ready.the_case.pressure.kind != PressureKind::hydraulic) return ready;
  ready.hydraulics = hydraulics::steady_state(ready.the_case, {}, progress_of("hydraulics"));
  hydraulics::give_to(ready.the_case, *ready.hydraulics);
  return ready;
}

ReadyCase read_ready_case(const std::string& file) { return with_pressure(read_case(file)); }

}  // namespace bentaxis::cli
