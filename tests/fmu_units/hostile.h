/* What an FMU may do to the program that runs it. BENTAXIS_TEST_HOSTILE="PLACE ACTION" says where
 * and what: see hostile.c. */
#pragma once

#ifdef HOSTILE
/* Called in each of FMI's functions: "step", .. */
void misbehave(const char* place, void (*log)(void* environment, const char* text),
               void* environment);
#else
#define misbehave(place, log, environment) ((void)(log), (void)(environment))
#endif
