// The C interface of the Functional Mock-up Interface 2.0, as chapters 2 to 4 of the standard have
// it: names, types, values and order of arguments are the standard's, the words are ours.
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

// fmi2TypesPlatform: "default".
#define fmi2TypesPlatform "default"
#define fmi2Version "2.0"
#define fmi2True 1
#define fmi2False 0

typedef void* fmi2Component;             // an instance
typedef void* fmi2ComponentEnvironment;  // what the importer wants to be told with callbacks
typedef void* fmi2FMUstate;              // a saved state
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char* fmi2String;
typedef char fmi2Byte;

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
  fmi2DoStepStatus,
  fmi2PendingStatus,
  fmi2LastSuccessfulTime,
  fmi2Terminated
} fmi2StatusKind;

typedef void (*fmi2CallbackLogger)(fmi2ComponentEnvironment environment, fmi2String instance_name,
                                   fmi2Status status, fmi2String category, fmi2String message, ...);
typedef void* (*fmi2CallbackAllocateMemory)(size_t count, size_t size);
typedef void (*fmi2CallbackFreeMemory)(void* memory);
typedef void (*fmi2StepFinished)(fmi2ComponentEnvironment environment, fmi2Status status);

typedef struct {
  fmi2CallbackLogger logger;
  fmi2CallbackAllocateMemory allocateMemory;
  fmi2CallbackFreeMemory freeMemory;
  fmi2StepFinished stepFinished;
  fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
  fmi2Boolean newDiscreteStatesNeeded;
  fmi2Boolean terminateSimulation;
  fmi2Boolean nominalsOfContinuousStatesChanged;
  fmi2Boolean valuesOfContinuousStatesChanged;
  fmi2Boolean nextEventTimeDefined;
  fmi2Real nextEventTime;
} fmi2EventInfo;

// Every function: X(its result, its name, (its arguments)).
#define BENTAXIS_FMI2_FUNCTIONS(X)                                                                 \
  /* Of both kinds */                                                                              \
  X(const char*, fmi2GetTypesPlatform, (void))                                                     \
  X(const char*, fmi2GetVersion, (void))                                                           \
  X(fmi2Status, fmi2SetDebugLogging,                                                               \
    (fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]))                \
  X(fmi2Component, fmi2Instantiate,                                                                \
    (fmi2String instance_name, fmi2Type type, fmi2String guid, fmi2String resource_location,       \
     const fmi2CallbackFunctions* functions, fmi2Boolean visible, fmi2Boolean logging_on))         \
  X(void, fmi2FreeInstance, (fmi2Component c))                                                     \
  X(fmi2Status, fmi2SetupExperiment,                                                               \
    (fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start_time,      \
     fmi2Boolean stop_time_defined, fmi2Real stop_time))                                           \
  X(fmi2Status, fmi2EnterInitializationMode, (fmi2Component c))                                    \
  X(fmi2Status, fmi2ExitInitializationMode, (fmi2Component c))                                     \
  X(fmi2Status, fmi2Terminate, (fmi2Component c))                                                  \
  X(fmi2Status, fmi2Reset, (fmi2Component c))                                                      \
  X(fmi2Status, fmi2GetReal,                                                                       \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Real value[]))              \
  X(fmi2Status, fmi2GetInteger,                                                                    \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Integer value[]))           \
  X(fmi2Status, fmi2GetBoolean,                                                                    \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Boolean value[]))           \
  X(fmi2Status, fmi2GetString,                                                                     \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2String value[]))            \
  X(fmi2Status, fmi2SetReal,                                                                       \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Real value[]))        \
  X(fmi2Status, fmi2SetInteger,                                                                    \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Integer value[]))     \
  X(fmi2Status, fmi2SetBoolean,                                                                    \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Boolean value[]))     \
  X(fmi2Status, fmi2SetString,                                                                     \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2String value[]))      \
  X(fmi2Status, fmi2GetFMUstate, (fmi2Component c, fmi2FMUstate * state))                          \
  X(fmi2Status, fmi2SetFMUstate, (fmi2Component c, fmi2FMUstate state))                            \
  X(fmi2Status, fmi2FreeFMUstate, (fmi2Component c, fmi2FMUstate * state))                         \
  X(fmi2Status, fmi2SerializedFMUstateSize, (fmi2Component c, fmi2FMUstate state, size_t * size))  \
  X(fmi2Status, fmi2SerializeFMUstate,                                                             \
    (fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size))                          \
  X(fmi2Status, fmi2DeSerializeFMUstate,                                                           \
    (fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state))                   \
  X(fmi2Status, fmi2GetDirectionalDerivative,                                                      \
    (fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,                         \
     const fmi2ValueReference known[], size_t knowns, const fmi2Real known_seed[],                 \
     fmi2Real unknown_sensitivity[]))                                                              \
  /* Model exchange */                                                                             \
  X(fmi2Status, fmi2EnterEventMode, (fmi2Component c))                                             \
  X(fmi2Status, fmi2NewDiscreteStates, (fmi2Component c, fmi2EventInfo * info))                    \
  X(fmi2Status, fmi2EnterContinuousTimeMode, (fmi2Component c))                                    \
  X(fmi2Status, fmi2CompletedIntegratorStep,                                                       \
    (fmi2Component c, fmi2Boolean no_set_state_before, fmi2Boolean * enter_event_mode,             \
     fmi2Boolean * terminate))                                                                     \
  X(fmi2Status, fmi2SetTime, (fmi2Component c, fmi2Real time))                                     \
  X(fmi2Status, fmi2SetContinuousStates, (fmi2Component c, const fmi2Real x[], size_t count))      \
  X(fmi2Status, fmi2GetDerivatives, (fmi2Component c, fmi2Real derivatives[], size_t count))       \
  X(fmi2Status, fmi2GetEventIndicators, (fmi2Component c, fmi2Real indicators[], size_t count))    \
  X(fmi2Status, fmi2GetContinuousStates, (fmi2Component c, fmi2Real x[], size_t count))            \
  X(fmi2Status, fmi2GetNominalsOfContinuousStates,                                                 \
    (fmi2Component c, fmi2Real nominals[], size_t count))                                          \
  /* Co-simulation */                                                                              \
  X(fmi2Status, fmi2SetRealInputDerivatives,                                                       \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Integer order[],      \
     const fmi2Real value[]))                                                                      \
  X(fmi2Status, fmi2GetRealOutputDerivatives,                                                      \
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Integer order[],      \
     fmi2Real value[]))                                                                            \
  X(fmi2Status, fmi2DoStep,                                                                        \
    (fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_set_state_before))              \
  X(fmi2Status, fmi2CancelStep, (fmi2Component c))                                                 \
  X(fmi2Status, fmi2GetStatus, (fmi2Component c, fmi2StatusKind kind, fmi2Status * value))         \
  X(fmi2Status, fmi2GetRealStatus, (fmi2Component c, fmi2StatusKind kind, fmi2Real * value))       \
  X(fmi2Status, fmi2GetIntegerStatus, (fmi2Component c, fmi2StatusKind kind, fmi2Integer * value)) \
  X(fmi2Status, fmi2GetBooleanStatus, (fmi2Component c, fmi2StatusKind kind, fmi2Boolean * value)) \
  X(fmi2Status, fmi2GetStringStatus, (fmi2Component c, fmi2StatusKind kind, fmi2String * value))

// Their types, as importers name them: fmi2GetVersionTYPE.
// NOLINTNEXTLINE(bugprone-macro-parentheses): a type and its name
#define BENTAXIS_FMI2_TYPE(result, name, arguments) typedef result name##TYPE arguments;
BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_FMI2_TYPE)
#undef BENTAXIS_FMI2_TYPE

#ifdef __cplusplus
}
#endif
