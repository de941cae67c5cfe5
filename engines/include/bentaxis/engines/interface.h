/* The C interface between the program and an engine: one function of a shared library
   bentaxis_engine_NAME.so. SI units; every vector has world components (S1 of docs/notation.md);
   a wrench is a force and its moment about the world's origin, six numbers.
   docs/engines.md says how to add an engine. */
#pragma once

/* Changes whenever a structure below does. */
#define BENTAXIS_ENGINE_INTERFACE 2

/* What is asked for. */
enum {
  BENTAXIS_ENGINE_GIVEN_MOTION, /* inverse dynamics at every sample */
  BENTAXIS_ENGINE_INTEGRATED,   /* the engine integrates from the first sample on, at given loads */
  BENTAXIS_ENGINE_SETTINGS      /* no values: `text` has the settings that the engine has, as
                                   "NAME=DEFAULT,OTHER,.. NAME=.."; the others are those of a sweep */
};

#ifdef __cplusplus
extern "C" {
#endif

/* A tree of bodies, its motion and its loads at every sample. */
struct bentaxis_engine_task {
  int request; /* one of the above */
  int bodies, freedoms, samples, actions, supports, loops;
  double gravity[3]; /* acceleration */
  double length;     /* a typical length of the mechanism, m */

  /* Bodies: a parent stands before its children, -1 is the world. */
  const int* parent;
  const double* place;   /* 3 per body: its origin in the frame of its parent, all coordinates 0 */
  const double* axes;    /* 9: its axes there, column by column */
  const double* mass;    /* may be 0 */
  const double* centre;  /* 3: centre of mass in the frame of the body */
  const double* inertia; /* 3: about it, along the axes of the body; may be 0 */

  /* Freedoms, in the order of the bodies: what the joint of a body to its parent lets it do, one
     after the other, about its origin. */
  const int* freedom_body;
  const int* freedom_turns;   /* 1: turns about the axis; 0: slides along it */
  const double* freedom_axis; /* 3: in the frame of the body */
  const double *position, *velocity, *acceleration; /* samples x freedoms */

  const double* loads; /* known, but for weight: samples x bodies x 6 */

  /* Unknown forces, each of size 1: on a body; the opposite acts on another, -1 is the world. */
  const int *action_on, *action_by;
  const double* action; /* samples x actions x 6 */

  /* What the joint of a body can carry, each of size 1: on the body, by its parent. */
  const int* support_body;
  const double* support; /* samples x supports x 6 */

  /* Integrated only. A step of the engine leads from a sample to the one after the next, so that
     the loads in its middle are there. */
  double interval;           /* time between two samples, s */
  int first, every;          /* samples of which values are wanted: first, first + every, .. */
  const int* freedom_driven; /* 1: keeps the velocity of the first sample, whatever that takes */
  /* Loops: a point of one body stays on a point of another. What this takes are three actions. */
  const int *loop_on, *loop_by, *loop_action;  /* bodies; first of its actions */
  const double *loop_point_on, *loop_point_by; /* 3: in the frames of the bodies */
  const char* settings; /* "NAME=VALUE NAME=VALUE": settings of the engine; "": its defaults */
};

struct bentaxis_engine_answer {
  double* values;   /* samples x (actions + supports): sizes of the unknown forces */
  double* residual; /* samples: what joints carry beyond their supports, over all that they carry */
  double seconds;   /* integrated: of the steps from sample `first` on */
  char text[512];   /* engine, version, method; or why there are no values */
};

/* @return BENTAXIS_ENGINE_INTERFACE of the library. Where that is not `interface`, nothing else has
   been done. Where the engine fails, `values` of the first sample begin with NaN. */
int bentaxis_engine(int interface, const struct bentaxis_engine_task* task,
                    struct bentaxis_engine_answer* answer);

#ifdef __cplusplus
}
#endif
