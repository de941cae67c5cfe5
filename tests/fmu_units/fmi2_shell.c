/* A model as a unit of FMI 2.0. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hostile.h"
#include "interface/fmi2.h"
#include "model.h"

typedef struct {
  double values[kModelValues];
  double time;
  fmi2CallbackFunctions callbacks;
  char name[64];
} Instance;

static void log_text(void* environment, const char* text) {
  Instance* instance = environment;
  if (instance != NULL)
    instance->callbacks.logger(instance->callbacks.componentEnvironment, instance->name,
                               fmi2Warning, "logStatusWarning", "%s", text);
}

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
#ifdef OTHER_VERSION
const char* fmi2GetVersion(void) { return "1.9"; }
#else
const char* fmi2GetVersion(void) { return fmi2Version; }
#endif

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* functions, fmi2Boolean visible,
                              fmi2Boolean logging_on) {
  (void)visible;
  (void)logging_on;
  if (type != fmi2CoSimulation || strcmp(guid, kModelToken) != 0 ||
      strncmp(resources, "file:///", 8) != 0) {
    functions->logger(functions->componentEnvironment, name, fmi2Error, "logStatusError",
                      "token \"%s\" is not \"%s\"", guid, kModelToken);
    return NULL;
  }
  Instance* instance = calloc(1, sizeof(Instance));
  if (instance == NULL) return NULL;
  instance->callbacks = *functions;
  snprintf(instance->name, sizeof instance->name, "%s", name);
  model_start(instance->values);
  misbehave("instantiate", log_text, instance);
  return instance;
}

void fmi2FreeInstance(fmi2Component c) {
  misbehave("free", log_text, c);
  free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop) {
  (void)tolerance_defined;
  (void)tolerance;
  (void)stop_defined;
  (void)stop;
  misbehave("set_up", log_text, c);
  ((Instance*)c)->time = start;
  return fmi2OK;
}
fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  misbehave("enter", log_text, c);
  return fmi2OK;
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  misbehave("exit", log_text, c);
  return fmi2OK;
}
#ifndef WITHOUT_TERMINATE
fmi2Status fmi2Terminate(fmi2Component c) {
  misbehave("terminate", log_text, c);
  return fmi2OK;
}
#endif

#define GET(TYPE)                                                                        \
  fmi2Status fmi2Get##TYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count, \
                           fmi2##TYPE value[]) {                                         \
    Instance* instance = c;                                                              \
    misbehave("get", log_text, c);                                                       \
    model_outputs(instance->values, instance->time);                                     \
    for (size_t i = 0; i < count; ++i) value[i] = (fmi2##TYPE)instance->values[vr[i]];   \
    return fmi2OK;                                                                       \
  }                                                                                      \
  fmi2Status fmi2Set##TYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count, \
                           const fmi2##TYPE value[]) {                                   \
    Instance* instance = c;                                                              \
    misbehave("set", log_text, c);                                                       \
    for (size_t i = 0; i < count; ++i) instance->values[vr[i]] = value[i];               \
    return fmi2OK;                                                                       \
  }
GET(Real)
GET(Integer)
GET(Boolean)

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean keep) {
  Instance* instance = c;
  char message[200] = "";
  (void)keep;
  misbehave("step", log_text, c);
  const int status = model_step(instance->values, time, step, message, sizeof message);
  if (message[0] != '\0')
    instance->callbacks.logger(instance->callbacks.componentEnvironment, instance->name,
                               (fmi2Status)status, "logStatusError", "%s", message);
  if (status <= fmi2Warning) instance->time = time + step;
  /* After that an importer makes no call: not to free it either. */
  if (status == fmi2Fatal) free(instance);
  return (fmi2Status)status;
}
