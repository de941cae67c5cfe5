// The C interface of the Functional Mock-up Interface 3.0, as chapters 2 to 5 of the standard have
// it: names, types, values and order of arguments are the standard's, the words are ours.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define fmi3Version "3.0"
#define fmi3True true
#define fmi3False false

typedef void* fmi3Instance;             // an instance
typedef void* fmi3InstanceEnvironment;  // what the importer wants to be told with callbacks
typedef void* fmi3FMUState;             // a saved state
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char* fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte* fmi3Binary;
typedef bool fmi3Clock;
#define fmi3ClockActive true
#define fmi3ClockInactive false

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum {
  fmi3Independent,
  fmi3Constant,
  fmi3Fixed,
  fmi3Tunable,
  fmi3Discrete,
  fmi3Dependent
} fmi3DependencyKind;
typedef enum {
  fmi3IntervalNotYetKnown,
  fmi3IntervalUnchanged,
  fmi3IntervalChanged
} fmi3IntervalQualifier;

typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment environment, fmi3Status status,
                                       fmi3String category, fmi3String message);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment environment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment environment,
                                               fmi3Float64 time, fmi3Boolean set_requested,
                                               fmi3Boolean get_allowed, fmi3Boolean step_finished,
                                               fmi3Boolean can_return_early,
                                               fmi3Boolean* early_return_requested,
                                               fmi3Float64* early_return_time);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);

// Every function: X(its result, its name, (its arguments)).
#define BENTAXIS_FMI3_VALUES(X, type)                                                         \
  X(fmi3Status, fmi3Get##type,                                                                \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, fmi3##type values[], \
     size_t value_count))                                                                     \
  X(fmi3Status, fmi3Set##type,                                                                \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count,                      \
     const fmi3##type values[], size_t value_count))
#define BENTAXIS_FMI3_FUNCTIONS(X)                                                                 \
  /* Of all kinds */                                                                               \
  X(const char*, fmi3GetVersion, (void))                                                           \
  X(fmi3Status, fmi3SetDebugLogging,                                                               \
    (fmi3Instance instance, fmi3Boolean on, size_t count, const fmi3String categories[]))          \
  X(fmi3Instance, fmi3InstantiateModelExchange,                                                    \
    (fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible,             \
     fmi3Boolean logging_on, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log))     \
  X(fmi3Instance, fmi3InstantiateCoSimulation,                                                     \
    (fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible,             \
     fmi3Boolean logging_on, fmi3Boolean event_mode_used, fmi3Boolean early_return_allowed,        \
     const fmi3ValueReference intermediate[], size_t intermediates,                                \
     fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,                              \
     fmi3IntermediateUpdateCallback update))                                                       \
  X(fmi3Instance, fmi3InstantiateScheduledExecution,                                               \
    (fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible,             \
     fmi3Boolean logging_on, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,      \
     fmi3ClockUpdateCallback clock_update, fmi3LockPreemptionCallback lock,                        \
     fmi3UnlockPreemptionCallback unlock))                                                         \
  X(void, fmi3FreeInstance, (fmi3Instance instance))                                               \
  X(fmi3Status, fmi3EnterInitializationMode,                                                       \
    (fmi3Instance instance, fmi3Boolean tolerance_defined, fmi3Float64 tolerance,                  \
     fmi3Float64 start_time, fmi3Boolean stop_time_defined, fmi3Float64 stop_time))                \
  X(fmi3Status, fmi3ExitInitializationMode, (fmi3Instance instance))                               \
  X(fmi3Status, fmi3EnterEventMode, (fmi3Instance instance))                                       \
  X(fmi3Status, fmi3Terminate, (fmi3Instance instance))                                            \
  X(fmi3Status, fmi3Reset, (fmi3Instance instance))                                                \
  BENTAXIS_FMI3_VALUES(X, Float32)                                                                 \
  BENTAXIS_FMI3_VALUES(X, Float64)                                                                 \
  BENTAXIS_FMI3_VALUES(X, Int8)                                                                    \
  BENTAXIS_FMI3_VALUES(X, UInt8)                                                                   \
  BENTAXIS_FMI3_VALUES(X, Int16)                                                                   \
  BENTAXIS_FMI3_VALUES(X, UInt16)                                                                  \
  BENTAXIS_FMI3_VALUES(X, Int32)                                                                   \
  BENTAXIS_FMI3_VALUES(X, UInt32)                                                                  \
  BENTAXIS_FMI3_VALUES(X, Int64)                                                                   \
  BENTAXIS_FMI3_VALUES(X, UInt64)                                                                  \
  BENTAXIS_FMI3_VALUES(X, Boolean)                                                                 \
  BENTAXIS_FMI3_VALUES(X, String)                                                                  \
  X(fmi3Status, fmi3GetBinary,                                                                     \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, size_t sizes[],           \
     fmi3Binary values[], size_t value_count))                                                     \
  X(fmi3Status, fmi3GetClock,                                                                      \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, fmi3Clock values[]))      \
  X(fmi3Status, fmi3SetBinary,                                                                     \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, const size_t sizes[],     \
     const fmi3Binary values[], size_t value_count))                                               \
  X(fmi3Status, fmi3SetClock,                                                                      \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count,                           \
     const fmi3Clock values[]))                                                                    \
  X(fmi3Status, fmi3GetNumberOfVariableDependencies,                                               \
    (fmi3Instance instance, fmi3ValueReference vr, size_t * count))                                \
  X(fmi3Status, fmi3GetVariableDependencies,                                                       \
    (fmi3Instance instance, fmi3ValueReference dependent, size_t dependent_elements[],             \
     fmi3ValueReference independents[], size_t independent_elements[], fmi3DependencyKind kinds[], \
     size_t count))                                                                                \
  X(fmi3Status, fmi3GetFMUState, (fmi3Instance instance, fmi3FMUState * state))                    \
  X(fmi3Status, fmi3SetFMUState, (fmi3Instance instance, fmi3FMUState state))                      \
  X(fmi3Status, fmi3FreeFMUState, (fmi3Instance instance, fmi3FMUState * state))                   \
  X(fmi3Status, fmi3SerializedFMUStateSize,                                                        \
    (fmi3Instance instance, fmi3FMUState state, size_t * size))                                    \
  X(fmi3Status, fmi3SerializeFMUState,                                                             \
    (fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size))                    \
  X(fmi3Status, fmi3DeserializeFMUState,                                                           \
    (fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState* state))             \
  X(fmi3Status, fmi3GetDirectionalDerivative,                                                      \
    (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknown_count,             \
     const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],              \
     size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count))                      \
  X(fmi3Status, fmi3GetAdjointDerivative,                                                          \
    (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknown_count,             \
     const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],              \
     size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count))                      \
  X(fmi3Status, fmi3EnterConfigurationMode, (fmi3Instance instance))                               \
  X(fmi3Status, fmi3ExitConfigurationMode, (fmi3Instance instance))                                \
  X(fmi3Status, fmi3GetIntervalDecimal,                                                            \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, fmi3Float64 intervals[],  \
     fmi3IntervalQualifier qualifiers[]))                                                          \
  X(fmi3Status, fmi3GetIntervalFraction,                                                           \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, fmi3UInt64 counters[],    \
     fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[]))                                \
  X(fmi3Status, fmi3GetShiftDecimal,                                                               \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, fmi3Float64 shifts[]))    \
  X(fmi3Status, fmi3GetShiftFraction,                                                              \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, fmi3UInt64 counters[],    \
     fmi3UInt64 resolutions[]))                                                                    \
  X(fmi3Status, fmi3SetIntervalDecimal,                                                            \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count,                           \
     const fmi3Float64 intervals[]))                                                               \
  X(fmi3Status, fmi3SetIntervalFraction,                                                           \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count,                           \
     const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]))                                 \
  X(fmi3Status, fmi3SetShiftDecimal,                                                               \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count,                           \
     const fmi3Float64 shifts[]))                                                                  \
  X(fmi3Status, fmi3SetShiftFraction,                                                              \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count,                           \
     const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]))                                 \
  X(fmi3Status, fmi3EvaluateDiscreteStates, (fmi3Instance instance))                               \
  X(fmi3Status, fmi3UpdateDiscreteStates,                                                          \
    (fmi3Instance instance, fmi3Boolean * again, fmi3Boolean * terminate,                          \
     fmi3Boolean * nominals_changed, fmi3Boolean * states_changed,                                 \
     fmi3Boolean * next_event_time_defined, fmi3Float64 * next_event_time))                        \
  /* Model exchange */                                                                             \
  X(fmi3Status, fmi3EnterContinuousTimeMode, (fmi3Instance instance))                              \
  X(fmi3Status, fmi3CompletedIntegratorStep,                                                       \
    (fmi3Instance instance, fmi3Boolean no_set_state_before, fmi3Boolean * enter_event_mode,       \
     fmi3Boolean * terminate))                                                                     \
  X(fmi3Status, fmi3SetTime, (fmi3Instance instance, fmi3Float64 time))                            \
  X(fmi3Status, fmi3SetContinuousStates,                                                           \
    (fmi3Instance instance, const fmi3Float64 x[], size_t count))                                  \
  X(fmi3Status, fmi3GetContinuousStateDerivatives,                                                 \
    (fmi3Instance instance, fmi3Float64 derivatives[], size_t count))                              \
  X(fmi3Status, fmi3GetEventIndicators,                                                            \
    (fmi3Instance instance, fmi3Float64 indicators[], size_t count))                               \
  X(fmi3Status, fmi3GetContinuousStates, (fmi3Instance instance, fmi3Float64 x[], size_t count))   \
  X(fmi3Status, fmi3GetNominalsOfContinuousStates,                                                 \
    (fmi3Instance instance, fmi3Float64 nominals[], size_t count))                                 \
  X(fmi3Status, fmi3GetNumberOfEventIndicators, (fmi3Instance instance, size_t * count))           \
  X(fmi3Status, fmi3GetNumberOfContinuousStates, (fmi3Instance instance, size_t * count))          \
  /* Co-simulation */                                                                              \
  X(fmi3Status, fmi3EnterStepMode, (fmi3Instance instance))                                        \
  X(fmi3Status, fmi3GetOutputDerivatives,                                                          \
    (fmi3Instance instance, const fmi3ValueReference vr[], size_t count, const fmi3Int32 orders[], \
     fmi3Float64 values[], size_t value_count))                                                    \
  X(fmi3Status, fmi3DoStep,                                                                        \
    (fmi3Instance instance, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_set_state_before,   \
     fmi3Boolean * event_handling_needed, fmi3Boolean * terminate, fmi3Boolean * early_return,     \
     fmi3Float64 * last_successful_time))                                                          \
  /* Scheduled execution */                                                                        \
  X(fmi3Status, fmi3ActivateModelPartition,                                                        \
    (fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 time))

// Their types, as importers name them: fmi3GetVersionTYPE.
// NOLINTNEXTLINE(bugprone-macro-parentheses): a type and its name
#define BENTAXIS_FMI3_TYPE(result, name, arguments) typedef result name##TYPE arguments;
BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_FMI3_TYPE)
#undef BENTAXIS_FMI3_TYPE

#ifdef __cplusplus
}
#endif
