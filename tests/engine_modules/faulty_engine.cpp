// Engines that fail, each in its way: FAULT says which.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bentaxis/engines/interface.h"

#define FAULT_CRASHES 1
#define FAULT_OLD 2
#define FAULT_SAYS_NOTHING 3
#define FAULT_GIVES_ZERO 4
#define FAULT_LEAVES 5
#define FAULT_WAITS 6

int bentaxis_engine(int, const bentaxis_engine_task* task, bentaxis_engine_answer* answer) {
#if FAULT == FAULT_CRASHES
  std::fputs("about to fail\n", stderr);
  std::abort();
#elif FAULT == FAULT_OLD
  return BENTAXIS_ENGINE_INTERFACE + 1;
#elif FAULT == FAULT_LEAVES
  std::exit(7);
#elif FAULT == FAULT_WAITS
  for (;;) pause();
#endif
  const long count = static_cast<long>(task->samples) * (task->actions + task->supports);
  std::fill_n(answer->values, count, FAULT == FAULT_GIVES_ZERO ? 0.0 : 0.0 / 0.0 * FAULT);
  std::snprintf(answer->text, sizeof answer->text, "a faulty engine");
  return BENTAXIS_ENGINE_INTERFACE;
}
