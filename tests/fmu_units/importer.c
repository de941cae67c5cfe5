/* An importer of FMI 2 and 3 for any platform that a C compiler builds it for: runs one instance after a plan, prints its
 * outputs. Used by scripts/try_fmu_platforms.
 *
 * usage: importer PLAN
 * The plan is a text of UTF-8, one line each: library; folder of resources as the version has it; token; version (2 or 3);
 * kind (cs or me); number of continuous states; number of event indicators; step in s; number of steps; value references of
 * the inputs speed and acceleration; speed at the start in rad/s; acceleration in rad/s2; states at the start of model
 * exchange (an empty line: the instance's own); then the value reference of every output. A line is printed for the start and
 * for each step: time and every output with 17 digits; in model exchange then states, their rates and event indicators. Model
 * exchange integrates by the classic method of Runge and Kutta, without events.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interface/fmi2.h"
#include "interface/fmi3.h"

#ifdef _WIN32
#include <windows.h>
static void* load(const char* file) {
  wchar_t wide[4096];
  if (MultiByteToWideChar(CP_UTF8, 0, file, -1, wide, 4096) == 0) return NULL;
  void* const library = (void*)LoadLibraryW(wide);
  if (library == NULL) fprintf(stderr, "LoadLibrary: error %lu\n", GetLastError());
  return library;
}
static void* find(void* library, const char* name) {
  return (void*)GetProcAddress((HMODULE)library, name);
}
#else
#include <dlfcn.h>
static void* load(const char* file) {
  void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) fprintf(stderr, "%s\n", dlerror());
  return library;
}
static void* find(void* library, const char* name) { return dlsym(library, name); }
#endif

static void fail(const char* what) {
  fprintf(stderr, "importer: %s\n", what);
  exit(1);
}

static void* library;
static void* function(const char* name) {
  void* const found = find(library, name);
  if (found == NULL) fail(name);
  return found;
}
#define CALL(name, ...)                                               \
  do {                                                                \
    if (((name##TYPE*)function(#name))(__VA_ARGS__) != 0) fail(#name); \
  } while (0)

static void say2(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                 fmi2String category, fmi2String message, ...) {
  va_list arguments;
  (void)environment, (void)name;
  fprintf(stderr, "status %d, %s: ", (int)status, category);
  va_start(arguments, message);
  vfprintf(stderr, message, arguments);
  va_end(arguments);
  fputc('\n', stderr);
}
static void say3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                 fmi3String message) {
  (void)environment;
  fprintf(stderr, "status %d, %s: %s\n", (int)status, category, message);
}

enum { kMost = 4096 };
static char lines[16][kMost];
static unsigned inputs[2], outputs[kMost];
static size_t count, states, indicators;
static int version, exchange;
static double start_speed, acceleration, step;
static void* it;

static void instantiate(void) {
  static fmi2CallbackFunctions callbacks;
  if (version == 2) {
    callbacks.logger = say2;
    callbacks.allocateMemory = calloc;
    callbacks.freeMemory = free;
    it = ((fmi2InstantiateTYPE*)function("fmi2Instantiate"))(
        "pump", exchange ? fmi2ModelExchange : fmi2CoSimulation, lines[2], lines[1], &callbacks, 0, 0);
  } else if (exchange) {
    it = ((fmi3InstantiateModelExchangeTYPE*)function("fmi3InstantiateModelExchange"))(
        "pump", lines[2], lines[1], false, false, NULL, say3);
  } else {
    it = ((fmi3InstantiateCoSimulationTYPE*)function("fmi3InstantiateCoSimulation"))(
        "pump", lines[2], lines[1], false, false, false, false, NULL, 0, NULL, say3, NULL);
  }
  if (it == NULL) fail("no instance");
}

static void set_drive(double time) {
  const double values[2] = {start_speed + acceleration * time, acceleration};
  if (version == 2)
    CALL(fmi2SetReal, it, inputs, 2, values);
  else
    CALL(fmi3SetFloat64, it, inputs, 2, values, 2);
}

static void initialize(double end) {
  if (version == 2) {
    CALL(fmi2SetupExperiment, it, 0, 0, 0, 1, end);
    CALL(fmi2EnterInitializationMode, it);
    set_drive(0);
    CALL(fmi2ExitInitializationMode, it);
  } else {
    CALL(fmi3EnterInitializationMode, it, false, 0, 0, true, end);
    set_drive(0);
    CALL(fmi3ExitInitializationMode, it);
  }
}

static void leave_event_mode(void) {
  if (version == 2) {
    fmi2EventInfo info;
    do CALL(fmi2NewDiscreteStates, it, &info);
    while (info.newDiscreteStatesNeeded);
    CALL(fmi2EnterContinuousTimeMode, it);
  } else {
    bool again, terminate, nominals, values, defined;
    double next;
    do CALL(fmi3UpdateDiscreteStates, it, &again, &terminate, &nominals, &values, &defined, &next);
    while (again);
    CALL(fmi3EnterContinuousTimeMode, it);
  }
}

static void get_states(double* x) {
  if (version == 2)
    CALL(fmi2GetContinuousStates, it, x, states);
  else
    CALL(fmi3GetContinuousStates, it, x, states);
}

static void go_to(double time, const double* x) {
  if (version == 2) {
    CALL(fmi2SetTime, it, time);
    CALL(fmi2SetContinuousStates, it, x, states);
  } else {
    CALL(fmi3SetTime, it, time);
    CALL(fmi3SetContinuousStates, it, x, states);
  }
  set_drive(time);
}

static void rates(double time, const double* x, double* k) {
  go_to(time, x);
  if (version == 2)
    CALL(fmi2GetDerivatives, it, k, states);
  else
    CALL(fmi3GetContinuousStateDerivatives, it, k, states);
}

static void advance(double time, double* x) {
  static double k[4][kMost], at[kMost];
  static const double nodes[4] = {0, 0.5, 0.5, 1}, weights[4] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  int stage;
  size_t i;
  for (stage = 0; stage < 4; ++stage) {
    for (i = 0; i < states; ++i) at[i] = x[i] + (stage == 0 ? 0 : nodes[stage] * step * k[stage - 1][i]);
    rates(time + nodes[stage] * step, at, k[stage]);
  }
  for (stage = 0; stage < 4; ++stage)
    for (i = 0; i < states; ++i) x[i] += step * weights[stage] * k[stage][i];
  go_to(time + step, x);
}

static void print_all(const double* values, size_t number) {
  size_t i;
  for (i = 0; i < number; ++i) printf(" %.17g", values[i]);
}

static void print_row(double time, const double* x) {
  static double values[kMost];
  if (version == 2)
    CALL(fmi2GetReal, it, outputs, count, values);
  else
    CALL(fmi3GetFloat64, it, outputs, count, values, count);
  printf("%.17g", time);
  print_all(values, count);
  if (exchange) print_all(x, states);
  if (exchange && version == 2) {
    CALL(fmi2GetDerivatives, it, values, states);
    print_all(values, states);
    CALL(fmi2GetEventIndicators, it, values, indicators);
    print_all(values, indicators);
  } else if (exchange) {
    CALL(fmi3GetContinuousStateDerivatives, it, values, states);
    print_all(values, states);
    CALL(fmi3GetEventIndicators, it, values, indicators);
    print_all(values, indicators);
  }
  putchar('\n');
}

static void do_step(double time) {
  set_drive(time);
  if (version == 2) {
    CALL(fmi2DoStep, it, time, step, 1);
  } else {
    bool event, terminate, early;
    double last;
    CALL(fmi3DoStep, it, time, step, true, &event, &terminate, &early, &last);
  }
}

int main(int argc, char** argv) {
  static double x[kMost];
  long steps, i;
  int line;
  char* start;
  FILE* const plan = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (plan == NULL) fail("usage: importer PLAN");
  for (line = 0; line < 14; ++line) {
    if (fgets(lines[line], kMost, plan) == NULL) fail("the plan is too short");
    lines[line][strcspn(lines[line], "\n")] = '\0';
  }
  while (count < kMost && fscanf(plan, "%u", &outputs[count]) == 1) ++count;
  fclose(plan);
  version = atoi(lines[3]);
  exchange = strcmp(lines[4], "me") == 0;
  states = strtoul(lines[5], NULL, 10);
  indicators = strtoul(lines[6], NULL, 10);
  step = strtod(lines[7], NULL);
  steps = strtol(lines[8], NULL, 10);
  inputs[0] = (unsigned)strtoul(lines[9], NULL, 10);
  inputs[1] = (unsigned)strtoul(lines[10], NULL, 10);
  start_speed = strtod(lines[11], NULL);
  acceleration = strtod(lines[12], NULL);

  library = load(lines[0]);
  if (library == NULL) fail("the library cannot be loaded");
  instantiate();
  initialize((double)steps * step);
  if (exchange) {
    leave_event_mode();
    get_states(x);
    start = lines[13];
    for (i = 0; *start != '\0'; ++i) x[i] = strtod(start, &start);
    go_to(0, x);
  }
  print_row(0, x);
  for (i = 0; i < steps; ++i) {
    const double time = (double)i * step;
    if (exchange)
      advance(time, x);
    else
      do_step(time);
    print_row((double)(i + 1) * step, x);
  }
  if (version == 2) {
    CALL(fmi2Terminate, it);
    ((fmi2FreeInstanceTYPE*)function("fmi2FreeInstance"))(it);
  } else {
    CALL(fmi3Terminate, it);
    ((fmi3FreeInstanceTYPE*)function("fmi3FreeInstance"))(it);
  }
  return 0;
}
