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

// Of all kinds.
typedef const char* fmi3GetVersionTYPE(void);
typedef fmi3Status fmi3SetDebugLoggingTYPE(fmi3Instance instance, fmi3Boolean on, size_t count,
                                           const fmi3String categories[]);
typedef fmi3Instance fmi3InstantiateModelExchangeTYPE(fmi3String name, fmi3String token,
                                                      fmi3String resource_path, fmi3Boolean visible,
                                                      fmi3Boolean logging_on,
                                                      fmi3InstanceEnvironment environment,
                                                      fmi3LogMessageCallback log);
typedef fmi3Instance fmi3InstantiateCoSimulationTYPE(
    fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible,
    fmi3Boolean logging_on, fmi3Boolean event_mode_used, fmi3Boolean early_return_allowed,
    const fmi3ValueReference intermediate[], size_t intermediates,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3IntermediateUpdateCallback update);
typedef fmi3Instance fmi3InstantiateScheduledExecutionTYPE(
    fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible,
    fmi3Boolean logging_on, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback clock_update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock);
typedef void fmi3FreeInstanceTYPE(fmi3Instance instance);
typedef fmi3Status fmi3EnterInitializationModeTYPE(fmi3Instance instance,
                                                   fmi3Boolean tolerance_defined,
                                                   fmi3Float64 tolerance, fmi3Float64 start_time,
                                                   fmi3Boolean stop_time_defined,
                                                   fmi3Float64 stop_time);
typedef fmi3Status fmi3ExitInitializationModeTYPE(fmi3Instance instance);
typedef fmi3Status fmi3EnterEventModeTYPE(fmi3Instance instance);
typedef fmi3Status fmi3TerminateTYPE(fmi3Instance instance);
typedef fmi3Status fmi3ResetTYPE(fmi3Instance instance);
typedef fmi3Status fmi3GetFloat32TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                      size_t count, fmi3Float32 values[], size_t value_count);
typedef fmi3Status fmi3GetFloat64TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                      size_t count, fmi3Float64 values[], size_t value_count);
typedef fmi3Status fmi3GetInt8TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                   size_t count, fmi3Int8 values[], size_t value_count);
typedef fmi3Status fmi3GetUInt8TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, fmi3UInt8 values[], size_t value_count);
typedef fmi3Status fmi3GetInt16TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, fmi3Int16 values[], size_t value_count);
typedef fmi3Status fmi3GetUInt16TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, fmi3UInt16 values[], size_t value_count);
typedef fmi3Status fmi3GetInt32TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, fmi3Int32 values[], size_t value_count);
typedef fmi3Status fmi3GetUInt32TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, fmi3UInt32 values[], size_t value_count);
typedef fmi3Status fmi3GetInt64TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, fmi3Int64 values[], size_t value_count);
typedef fmi3Status fmi3GetUInt64TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, fmi3UInt64 values[], size_t value_count);
typedef fmi3Status fmi3GetBooleanTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                      size_t count, fmi3Boolean values[], size_t value_count);
typedef fmi3Status fmi3GetStringTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, fmi3String values[], size_t value_count);
typedef fmi3Status fmi3GetBinaryTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, size_t sizes[], fmi3Binary values[],
                                     size_t value_count);
typedef fmi3Status fmi3GetClockTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, fmi3Clock values[]);
typedef fmi3Status fmi3SetFloat32TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                      size_t count, const fmi3Float32 values[], size_t value_count);
typedef fmi3Status fmi3SetFloat64TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                      size_t count, const fmi3Float64 values[], size_t value_count);
typedef fmi3Status fmi3SetInt8TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                   size_t count, const fmi3Int8 values[], size_t value_count);
typedef fmi3Status fmi3SetUInt8TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, const fmi3UInt8 values[], size_t value_count);
typedef fmi3Status fmi3SetInt16TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, const fmi3Int16 values[], size_t value_count);
typedef fmi3Status fmi3SetUInt16TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, const fmi3UInt16 values[], size_t value_count);
typedef fmi3Status fmi3SetInt32TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, const fmi3Int32 values[], size_t value_count);
typedef fmi3Status fmi3SetUInt32TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, const fmi3UInt32 values[], size_t value_count);
typedef fmi3Status fmi3SetInt64TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, const fmi3Int64 values[], size_t value_count);
typedef fmi3Status fmi3SetUInt64TYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, const fmi3UInt64 values[], size_t value_count);
typedef fmi3Status fmi3SetBooleanTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                      size_t count, const fmi3Boolean values[], size_t value_count);
typedef fmi3Status fmi3SetStringTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, const fmi3String values[], size_t value_count);
typedef fmi3Status fmi3SetBinaryTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                     size_t count, const size_t sizes[], const fmi3Binary values[],
                                     size_t value_count);
typedef fmi3Status fmi3SetClockTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                    size_t count, const fmi3Clock values[]);
typedef fmi3Status fmi3GetNumberOfVariableDependenciesTYPE(fmi3Instance instance,
                                                           fmi3ValueReference vr, size_t* count);
typedef fmi3Status fmi3GetVariableDependenciesTYPE(fmi3Instance instance,
                                                   fmi3ValueReference dependent,
                                                   size_t dependent_elements[],
                                                   fmi3ValueReference independents[],
                                                   size_t independent_elements[],
                                                   fmi3DependencyKind kinds[], size_t count);
typedef fmi3Status fmi3GetFMUStateTYPE(fmi3Instance instance, fmi3FMUState* state);
typedef fmi3Status fmi3SetFMUStateTYPE(fmi3Instance instance, fmi3FMUState state);
typedef fmi3Status fmi3FreeFMUStateTYPE(fmi3Instance instance, fmi3FMUState* state);
typedef fmi3Status fmi3SerializedFMUStateSizeTYPE(fmi3Instance instance, fmi3FMUState state,
                                                  size_t* size);
typedef fmi3Status fmi3SerializeFMUStateTYPE(fmi3Instance instance, fmi3FMUState state,
                                             fmi3Byte bytes[], size_t size);
typedef fmi3Status fmi3DeserializeFMUStateTYPE(fmi3Instance instance, const fmi3Byte bytes[],
                                               size_t size, fmi3FMUState* state);
typedef fmi3Status fmi3GetDirectionalDerivativeTYPE(
    fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknown_count,
    const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],
    size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count);
typedef fmi3Status fmi3GetAdjointDerivativeTYPE(
    fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknown_count,
    const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],
    size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count);
typedef fmi3Status fmi3EnterConfigurationModeTYPE(fmi3Instance instance);
typedef fmi3Status fmi3ExitConfigurationModeTYPE(fmi3Instance instance);
typedef fmi3Status fmi3GetIntervalDecimalTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                              size_t count, fmi3Float64 intervals[],
                                              fmi3IntervalQualifier qualifiers[]);
typedef fmi3Status fmi3GetIntervalFractionTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                               size_t count, fmi3UInt64 counters[],
                                               fmi3UInt64 resolutions[],
                                               fmi3IntervalQualifier qualifiers[]);
typedef fmi3Status fmi3GetShiftDecimalTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                           size_t count, fmi3Float64 shifts[]);
typedef fmi3Status fmi3GetShiftFractionTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                            size_t count, fmi3UInt64 counters[],
                                            fmi3UInt64 resolutions[]);
typedef fmi3Status fmi3SetIntervalDecimalTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                              size_t count, const fmi3Float64 intervals[]);
typedef fmi3Status fmi3SetIntervalFractionTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                               size_t count, const fmi3UInt64 counters[],
                                               const fmi3UInt64 resolutions[]);
typedef fmi3Status fmi3SetShiftDecimalTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                           size_t count, const fmi3Float64 shifts[]);
typedef fmi3Status fmi3SetShiftFractionTYPE(fmi3Instance instance, const fmi3ValueReference vr[],
                                            size_t count, const fmi3UInt64 counters[],
                                            const fmi3UInt64 resolutions[]);
typedef fmi3Status fmi3EvaluateDiscreteStatesTYPE(fmi3Instance instance);
typedef fmi3Status fmi3UpdateDiscreteStatesTYPE(fmi3Instance instance, fmi3Boolean* again,
                                                fmi3Boolean* terminate,
                                                fmi3Boolean* nominals_changed,
                                                fmi3Boolean* states_changed,
                                                fmi3Boolean* next_event_time_defined,
                                                fmi3Float64* next_event_time);

// Model exchange.
typedef fmi3Status fmi3EnterContinuousTimeModeTYPE(fmi3Instance instance);
typedef fmi3Status fmi3CompletedIntegratorStepTYPE(fmi3Instance instance,
                                                   fmi3Boolean no_set_state_before,
                                                   fmi3Boolean* enter_event_mode,
                                                   fmi3Boolean* terminate);
typedef fmi3Status fmi3SetTimeTYPE(fmi3Instance instance, fmi3Float64 time);
typedef fmi3Status fmi3SetContinuousStatesTYPE(fmi3Instance instance, const fmi3Float64 x[],
                                               size_t count);
typedef fmi3Status fmi3GetContinuousStateDerivativesTYPE(fmi3Instance instance,
                                                         fmi3Float64 derivatives[], size_t count);
typedef fmi3Status fmi3GetEventIndicatorsTYPE(fmi3Instance instance, fmi3Float64 indicators[],
                                              size_t count);
typedef fmi3Status fmi3GetContinuousStatesTYPE(fmi3Instance instance, fmi3Float64 x[],
                                               size_t count);
typedef fmi3Status fmi3GetNominalsOfContinuousStatesTYPE(fmi3Instance instance,
                                                         fmi3Float64 nominals[], size_t count);
typedef fmi3Status fmi3GetNumberOfEventIndicatorsTYPE(fmi3Instance instance, size_t* count);
typedef fmi3Status fmi3GetNumberOfContinuousStatesTYPE(fmi3Instance instance, size_t* count);

// Co-simulation.
typedef fmi3Status fmi3EnterStepModeTYPE(fmi3Instance instance);
typedef fmi3Status fmi3GetOutputDerivativesTYPE(fmi3Instance instance,
                                                const fmi3ValueReference vr[], size_t count,
                                                const fmi3Int32 orders[], fmi3Float64 values[],
                                                size_t value_count);
typedef fmi3Status fmi3DoStepTYPE(fmi3Instance instance, fmi3Float64 time, fmi3Float64 step,
                                  fmi3Boolean no_set_state_before,
                                  fmi3Boolean* event_handling_needed, fmi3Boolean* terminate,
                                  fmi3Boolean* early_return, fmi3Float64* last_successful_time);

// Scheduled execution.
typedef fmi3Status fmi3ActivateModelPartitionTYPE(fmi3Instance instance, fmi3ValueReference clock,
                                                  fmi3Float64 time);

// Every function by name: use(name).
#define BENTAXIS_FMI3_FUNCTIONS(X)       \
  X(fmi3GetVersion)                      \
  X(fmi3SetDebugLogging)                 \
  X(fmi3InstantiateModelExchange)        \
  X(fmi3InstantiateCoSimulation)         \
  X(fmi3InstantiateScheduledExecution)   \
  X(fmi3FreeInstance)                    \
  X(fmi3EnterInitializationMode)         \
  X(fmi3ExitInitializationMode)          \
  X(fmi3EnterEventMode)                  \
  X(fmi3Terminate)                       \
  X(fmi3Reset)                           \
  X(fmi3GetFloat32)                      \
  X(fmi3GetFloat64)                      \
  X(fmi3GetInt8)                         \
  X(fmi3GetUInt8)                        \
  X(fmi3GetInt16)                        \
  X(fmi3GetUInt16)                       \
  X(fmi3GetInt32)                        \
  X(fmi3GetUInt32)                       \
  X(fmi3GetInt64)                        \
  X(fmi3GetUInt64)                       \
  X(fmi3GetBoolean)                      \
  X(fmi3GetString)                       \
  X(fmi3GetBinary)                       \
  X(fmi3GetClock)                        \
  X(fmi3SetFloat32)                      \
  X(fmi3SetFloat64)                      \
  X(fmi3SetInt8)                         \
  X(fmi3SetUInt8)                        \
  X(fmi3SetInt16)                        \
  X(fmi3SetUInt16)                       \
  X(fmi3SetInt32)                        \
  X(fmi3SetUInt32)                       \
  X(fmi3SetInt64)                        \
  X(fmi3SetUInt64)                       \
  X(fmi3SetBoolean)                      \
  X(fmi3SetString)                       \
  X(fmi3SetBinary)                       \
  X(fmi3SetClock)                        \
  X(fmi3GetNumberOfVariableDependencies) \
  X(fmi3GetVariableDependencies)         \
  X(fmi3GetFMUState)                     \
  X(fmi3SetFMUState)                     \
  X(fmi3FreeFMUState)                    \
  X(fmi3SerializedFMUStateSize)          \
  X(fmi3SerializeFMUState)               \
  X(fmi3DeserializeFMUState)             \
  X(fmi3GetDirectionalDerivative)        \
  X(fmi3GetAdjointDerivative)            \
  X(fmi3EnterConfigurationMode)          \
  X(fmi3ExitConfigurationMode)           \
  X(fmi3GetIntervalDecimal)              \
  X(fmi3GetIntervalFraction)             \
  X(fmi3GetShiftDecimal)                 \
  X(fmi3GetShiftFraction)                \
  X(fmi3SetIntervalDecimal)              \
  X(fmi3SetIntervalFraction)             \
  X(fmi3SetShiftDecimal)                 \
  X(fmi3SetShiftFraction)                \
  X(fmi3EvaluateDiscreteStates)          \
  X(fmi3UpdateDiscreteStates)            \
  X(fmi3EnterContinuousTimeMode)         \
  X(fmi3CompletedIntegratorStep)         \
  X(fmi3SetTime)                         \
  X(fmi3SetContinuousStates)             \
  X(fmi3GetContinuousStateDerivatives)   \
  X(fmi3GetEventIndicators)              \
  X(fmi3GetContinuousStates)             \
  X(fmi3GetNominalsOfContinuousStates)   \
  X(fmi3GetNumberOfEventIndicators)      \
  X(fmi3GetNumberOfContinuousStates)     \
  X(fmi3EnterStepMode)                   \
  X(fmi3GetOutputDerivatives)            \
  X(fmi3DoStep)                          \
  X(fmi3ActivateModelPartition)

#ifdef __cplusplus
}
#endif
