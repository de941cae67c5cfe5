// The program in which an engine runs, so that nothing else ends with it:
//   bentaxis_engine_runner MODULE     (descriptor 3: the memory of shared_task.h)
#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "shared_task.h"

namespace {

using bentaxis::engines::Outcome;
using bentaxis::engines::Shared;

void run(const char* module, Shared& shared) {
  const auto failed = [&](Outcome outcome) {
    const char* why = dlerror();
    std::snprintf(shared.text, sizeof shared.text, "%s", why != nullptr ? why : "");
    shared.outcome = outcome;
  };
  void* library = dlopen(module, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return failed(Outcome::not_loaded);
  auto* engine = reinterpret_cast<decltype(&bentaxis_engine)>(dlsym(library, "bentaxis_engine"));
  if (engine == nullptr) return failed(Outcome::no_function);
  bentaxis_engine_task task = shared.task;
  bentaxis_engine_answer answer{};
  bentaxis::engines::lay_out(&shared, task, answer);
  task.settings = shared.settings;
  shared.interface = engine(BENTAXIS_ENGINE_INTERFACE, &task, &answer);
  shared.seconds = answer.seconds;
  std::copy_n(answer.text, sizeof answer.text, shared.text);
  shared.text[sizeof shared.text - 1] = 0;
  shared.outcome =
      shared.interface == BENTAXIS_ENGINE_INTERFACE ? Outcome::returned : Outcome::other_interface;
}

}  // namespace

int main(int count, char** arguments) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  struct stat memory {};
  if (count != 2 || fstat(3, &memory) != 0) return 2;
  void* shared = mmap(nullptr, static_cast<std::size_t>(memory.st_size), PROT_READ | PROT_WRITE,
                      MAP_SHARED, 3, 0);
  if (shared == MAP_FAILED) return 2;
  run(arguments[1], *static_cast<Shared*>(shared));
  return 0;
}
