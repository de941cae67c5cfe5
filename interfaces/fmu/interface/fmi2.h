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

// Of both kinds.
typedef const char* fmi2GetTypesPlatformTYPE(void);
typedef const char* fmi2GetVersionTYPE(void);
typedef fmi2Status fmi2SetDebugLoggingTYPE(fmi2Component c, fmi2Boolean on, size_t count,
                                           const fmi2String categories[]);
typedef fmi2Component fmi2InstantiateTYPE(fmi2String instance_name, fmi2Type type, fmi2String guid,
                                          fmi2String resource_location,
                                          const fmi2CallbackFunctions* functions,
                                          fmi2Boolean visible, fmi2Boolean logging_on);
typedef void fmi2FreeInstanceTYPE(fmi2Component c);
typedef fmi2Status fmi2SetupExperimentTYPE(fmi2Component c, fmi2Boolean tolerance_defined,
                                           fmi2Real tolerance, fmi2Real start_time,
                                           fmi2Boolean stop_time_defined, fmi2Real stop_time);
typedef fmi2Status fmi2EnterInitializationModeTYPE(fmi2Component c);
typedef fmi2Status fmi2ExitInitializationModeTYPE(fmi2Component c);
typedef fmi2Status fmi2TerminateTYPE(fmi2Component c);
typedef fmi2Status fmi2ResetTYPE(fmi2Component c);
typedef fmi2Status fmi2GetRealTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                   fmi2Real value[]);
typedef fmi2Status fmi2GetIntegerTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                      fmi2Integer value[]);
typedef fmi2Status fmi2GetBooleanTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                      fmi2Boolean value[]);
typedef fmi2Status fmi2GetStringTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                     fmi2String value[]);
typedef fmi2Status fmi2SetRealTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                   const fmi2Real value[]);
typedef fmi2Status fmi2SetIntegerTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                      const fmi2Integer value[]);
typedef fmi2Status fmi2SetBooleanTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                      const fmi2Boolean value[]);
typedef fmi2Status fmi2SetStringTYPE(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                     const fmi2String value[]);
typedef fmi2Status fmi2GetFMUstateTYPE(fmi2Component c, fmi2FMUstate* state);
typedef fmi2Status fmi2SetFMUstateTYPE(fmi2Component c, fmi2FMUstate state);
typedef fmi2Status fmi2FreeFMUstateTYPE(fmi2Component c, fmi2FMUstate* state);
typedef fmi2Status fmi2SerializedFMUstateSizeTYPE(fmi2Component c, fmi2FMUstate state,
                                                  size_t* size);
typedef fmi2Status fmi2SerializeFMUstateTYPE(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[],
                                             size_t size);
typedef fmi2Status fmi2DeSerializeFMUstateTYPE(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                               fmi2FMUstate* state);
typedef fmi2Status fmi2GetDirectionalDerivativeTYPE(fmi2Component c,
                                                    const fmi2ValueReference unknown[],
                                                    size_t unknowns,
                                                    const fmi2ValueReference known[], size_t knowns,
                                                    const fmi2Real known_seed[],
                                                    fmi2Real unknown_sensitivity[]);

// Model exchange.
typedef fmi2Status fmi2EnterEventModeTYPE(fmi2Component c);
typedef fmi2Status fmi2NewDiscreteStatesTYPE(fmi2Component c, fmi2EventInfo* info);
typedef fmi2Status fmi2EnterContinuousTimeModeTYPE(fmi2Component c);
typedef fmi2Status fmi2CompletedIntegratorStepTYPE(fmi2Component c, fmi2Boolean no_set_state_before,
                                                   fmi2Boolean* enter_event_mode,
                                                   fmi2Boolean* terminate);
typedef fmi2Status fmi2SetTimeTYPE(fmi2Component c, fmi2Real time);
typedef fmi2Status fmi2SetContinuousStatesTYPE(fmi2Component c, const fmi2Real x[], size_t count);
typedef fmi2Status fmi2GetDerivativesTYPE(fmi2Component c, fmi2Real derivatives[], size_t count);
typedef fmi2Status fmi2GetEventIndicatorsTYPE(fmi2Component c, fmi2Real indicators[], size_t count);
typedef fmi2Status fmi2GetContinuousStatesTYPE(fmi2Component c, fmi2Real x[], size_t count);
typedef fmi2Status fmi2GetNominalsOfContinuousStatesTYPE(fmi2Component c, fmi2Real nominals[],
                                                         size_t count);

// Co-simulation.
typedef fmi2Status fmi2SetRealInputDerivativesTYPE(fmi2Component c, const fmi2ValueReference vr[],
                                                   size_t count, const fmi2Integer order[],
                                                   const fmi2Real value[]);
typedef fmi2Status fmi2GetRealOutputDerivativesTYPE(fmi2Component c, const fmi2ValueReference vr[],
                                                    size_t count, const fmi2Integer order[],
                                                    fmi2Real value[]);
typedef fmi2Status fmi2DoStepTYPE(fmi2Component c, fmi2Real time, fmi2Real step,
                                  fmi2Boolean no_set_state_before);
typedef fmi2Status fmi2CancelStepTYPE(fmi2Component c);
typedef fmi2Status fmi2GetStatusTYPE(fmi2Component c, fmi2StatusKind kind, fmi2Status* value);
typedef fmi2Status fmi2GetRealStatusTYPE(fmi2Component c, fmi2StatusKind kind, fmi2Real* value);
typedef fmi2Status fmi2GetIntegerStatusTYPE(fmi2Component c, fmi2StatusKind kind,
                                            fmi2Integer* value);
typedef fmi2Status fmi2GetBooleanStatusTYPE(fmi2Component c, fmi2StatusKind kind,
                                            fmi2Boolean* value);
typedef fmi2Status fmi2GetStringStatusTYPE(fmi2Component c, fmi2StatusKind kind, fmi2String* value);

// Every function by name: BENTAXIS_FMI2_FUNCTIONS(use) with use(name).
#define BENTAXIS_FMI2_FUNCTIONS(X)     \
  X(fmi2GetTypesPlatform)              \
  X(fmi2GetVersion)                    \
  X(fmi2SetDebugLogging)               \
  X(fmi2Instantiate)                   \
  X(fmi2FreeInstance)                  \
  X(fmi2SetupExperiment)               \
  X(fmi2EnterInitializationMode)       \
  X(fmi2ExitInitializationMode)        \
  X(fmi2Terminate)                     \
  X(fmi2Reset)                         \
  X(fmi2GetReal)                       \
  X(fmi2GetInteger)                    \
  X(fmi2GetBoolean)                    \
  X(fmi2GetString)                     \
  X(fmi2SetReal)                       \
  X(fmi2SetInteger)                    \
  X(fmi2SetBoolean)                    \
  X(fmi2SetString)                     \
  X(fmi2GetFMUstate)                   \
  X(fmi2SetFMUstate)                   \
  X(fmi2FreeFMUstate)                  \
  X(fmi2SerializedFMUstateSize)        \
  X(fmi2SerializeFMUstate)             \
  X(fmi2DeSerializeFMUstate)           \
  X(fmi2GetDirectionalDerivative)      \
  X(fmi2EnterEventMode)                \
  X(fmi2NewDiscreteStates)             \
  X(fmi2EnterContinuousTimeMode)       \
  X(fmi2CompletedIntegratorStep)       \
  X(fmi2SetTime)                       \
  X(fmi2SetContinuousStates)           \
  X(fmi2GetDerivatives)                \
  X(fmi2GetEventIndicators)            \
  X(fmi2GetContinuousStates)           \
  X(fmi2GetNominalsOfContinuousStates) \
  X(fmi2SetRealInputDerivatives)       \
  X(fmi2GetRealOutputDerivatives)      \
  X(fmi2DoStep)                        \
  X(fmi2CancelStep)                    \
  X(fmi2GetStatus)                     \
  X(fmi2GetRealStatus)                 \
  X(fmi2GetIntegerStatus)              \
  X(fmi2GetBooleanStatus)              \
  X(fmi2GetStringStatus)

#ifdef __cplusplus
}
#endif
