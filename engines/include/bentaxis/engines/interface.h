/* The C interface between the program and an engine: one function of a shared library
   bentaxis_engine_NAME.so. SI units; every vector has world components (S1 of docs/notation.md);
   a wrench is a force and its moment about the world's origin, six numbers.
   docs/engines.md says how to add an engine. */
#pragma once

/* Changes whenever a structure below does. */
#define BENTAXIS_ENGINE_INTERFACE 1

#ifdef __cplusplus
extern "C" {
#endif

/* A tree of bodies, its motion and its loads at every sample. */
struct bentaxis_engine_task {
  int bodies, freedoms, samples, actions, supports;
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

  const double* loads;  /* known, but for weight: samples x bodies x 6 */
  const double* action; /* unknown forces, each of size 1: samples x actions x bodies x 6 */

  /* What the joint of a body can carry, each of size 1: on the body, by its parent. */
  const int* support_body;
  const double* support; /* samples x supports x 6 */
};

struct bentaxis_engine_answer {
  double* values;   /* samples x (actions + supports): sizes of the unknown forces */
  double* residual; /* samples: what joints carry beyond their supports, over all that they carry */
  char text[256];   /* engine, version, method; or why there are no values */
};

/* @return BENTAXIS_ENGINE_INTERFACE of the library. Where that is not `interface`, nothing else has
   been done. Where the engine fails, `values` of the first sample begin with NaN. */
int bentaxis_engine(int interface, const struct bentaxis_engine_task* task,
                    struct bentaxis_engine_answer* answer);

#ifdef __cplusplus
}
#endif
