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

using bentaxis::engines::Arrays;
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
  Arrays at{};
  bentaxis::engines::lay_out(&shared, shared, at);
  bentaxis_engine_task task{};
  task.request = shared.request;
  task.bodies = shared.bodies;
  task.freedoms = shared.freedoms;
  task.samples = shared.samples;
  task.actions = shared.actions;
  task.supports = shared.supports;
  task.loops = shared.loops;
  std::copy_n(shared.gravity, 3, task.gravity);
  task.length = shared.length;
  task.parent = at.parent;
  task.place = at.place;
  task.axes = at.axes;
  task.mass = at.mass;
  task.centre = at.centre;
  task.inertia = at.inertia;
  task.freedom_body = at.freedom_body;
  task.freedom_turns = at.freedom_turns;
  task.freedom_axis = at.freedom_axis;
  task.position = at.position;
  task.velocity = at.velocity;
  task.acceleration = at.acceleration;
  task.loads = at.loads;
  task.action_on = at.action_on;
  task.action_by = at.action_by;
  task.action = at.action;
  task.support_body = at.support_body;
  task.support = at.support;
  task.interval = shared.interval;
  task.first = shared.first;
  task.every = shared.every;
  task.freedom_driven = at.freedom_driven;
  task.loop_on = at.loop_on;
  task.loop_by = at.loop_by;
  task.loop_action = at.loop_action;
  task.loop_point_on = at.loop_point_on;
  task.loop_point_by = at.loop_point_by;
  task.settings = shared.settings;
  bentaxis_engine_answer answer{at.values, at.residual, 0, ""};
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
