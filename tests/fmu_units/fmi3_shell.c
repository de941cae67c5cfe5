/* A model as a unit of FMI 3.0. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hostile.h"
#include "interface/fmi3.h"
#include "model.h"

typedef struct {
  double values[kModelValues];
  double time;
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;
} Instance;

static void log_text(void* environment, const char* text) {
  Instance* instance = environment;
  if (instance != NULL) instance->log(instance->environment, fmi3Warning, "logStatusWarning", text);
}

#ifdef OTHER_VERSION
const char* fmi3GetVersion(void) { return "2.9"; }
#else
const char* fmi3GetVersion(void) { return fmi3Version; }
#endif

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean logging_on,
                                         fmi3Boolean event_mode_used,
                                         fmi3Boolean early_return_allowed,
                                         const fmi3ValueReference intermediate[],
                                         size_t intermediates, fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update) {
  (void)name;
  (void)visible;
  (void)logging_on;
  (void)early_return_allowed;
  (void)intermediate;
  (void)intermediates;
  (void)update;
  const size_t length = strlen(resources);
  if (strcmp(token, kModelToken) != 0 || event_mode_used || resources[0] != '/' ||
      resources[length - 1] != '/') {
    char text[200];
    snprintf(text, sizeof text, "token \"%s\" is not \"%s\"", token, kModelToken);
    log(environment, fmi3Error, "logStatusError", text);
    return NULL;
  }
  Instance* instance = calloc(1, sizeof(Instance));
  if (instance == NULL) return NULL;
  instance->environment = environment;
  instance->log = log;
  model_start(instance->values);
  misbehave("instantiate", log_text, instance);
  return instance;
}

void fmi3FreeInstance(fmi3Instance instance) {
  misbehave("free", log_text, instance);
  free(instance);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_defined,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean stop_defined, fmi3Float64 stop) {
  (void)tolerance_defined;
  (void)tolerance;
  (void)stop_defined;
  (void)stop;
  misbehave("enter", log_text, c);
  ((Instance*)c)->time = start;
  return fmi3OK;
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
  misbehave("exit", log_text, c);
  return fmi3OK;
}
#ifndef WITHOUT_TERMINATE
fmi3Status fmi3Terminate(fmi3Instance c) {
  misbehave("terminate", log_text, c);
  return fmi3OK;
}
#endif

#define GET(TYPE)                                                                       \
  fmi3Status fmi3Get##TYPE(fmi3Instance c, const fmi3ValueReference vr[], size_t count, \
                           fmi3##TYPE value[], size_t value_count) {                    \
    Instance* instance = c;                                                             \
    misbehave("get", log_text, c);                                                      \
    if (count != value_count) return fmi3Error;                                         \
    model_outputs(instance->values, instance->time);                                    \
    for (size_t i = 0; i < count; ++i) value[i] = (fmi3##TYPE)instance->values[vr[i]];  \
    return fmi3OK;                                                                      \
  }                                                                                     \
  fmi3Status fmi3Set##TYPE(fmi3Instance c, const fmi3ValueReference vr[], size_t count, \
                           const fmi3##TYPE value[], size_t value_count) {              \
    Instance* instance = c;                                                             \
    misbehave("set", log_text, c);                                                      \
    if (count != value_count) return fmi3Error;                                         \
    for (size_t i = 0; i < count; ++i) instance->values[vr[i]] = (double)value[i];      \
    return fmi3OK;                                                                      \
  }
GET(Float64)
GET(Float32)
GET(Int8)
GET(UInt8)
GET(Int16)
GET(UInt16)
GET(Int32)
GET(UInt32)
GET(Int64)
GET(UInt64)
GET(Boolean)

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean keep,
                      fmi3Boolean* event, fmi3Boolean* terminate, fmi3Boolean* early,
                      fmi3Float64* reached) {
  Instance* instance = c;
  char message[200] = "";
  (void)keep;
  misbehave("step", log_text, c);
  *event = *terminate = *early = false;
  *reached = time;
  const int status = model_step(instance->values, time, step, message, sizeof message);
  if (message[0] != '\0')
    instance->log(instance->environment, (fmi3Status)status, "logStatusError", message);
  if (status <= fmi3Warning) *reached = instance->time = time + step;
  /* After that an importer makes no call: not to free it either. */
  if (status == fmi3Fatal) free(instance);
  return (fmi3Status)status;
}
