// The one call into the part of the program that is linked with OpenTURNS.
#pragma once

extern "C" {

/// Indices of one output, by Martinez' estimator with asymptotic intervals.
/// @param base       number of base points
/// @param numbers    d
/// @param inputs     (d + 2) base x d, row by row: A, B, then A with one column of B each
/// @param outputs    of these points
/// @param level      of the intervals
/// @param indices    d x 6: first, its low and high, total, its low and high
/// @param message    of `room` characters: why it failed
/// @return 0 where it did not
int bentaxis_sobol_indices(unsigned long base, unsigned long numbers, const double* inputs,
                           const double* outputs, double level, double* indices, char* message,
                           unsigned long room);
}
