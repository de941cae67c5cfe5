/* A small unit for co-simulation: what it computes, behind fmi2_shell.c or fmi3_shell.c. Values are
   doubles by their value reference, whatever type the description gives them. */
#pragma once

#include <stddef.h>

enum { kModelValues = 32 };

extern const char* const kModelToken;
/* Start values of all. */
void model_start(double values[]);
/* Outputs at a time, s, from inputs and states. */
void model_outputs(double values[], double time);
/* States from a time over a step, s, inputs as they are. Returns FMI's status; a message that is
 * not empty is logged. */
int model_step(double values[], double time, double step, char* message, size_t length);
