/* A valve in the load that closes over time; its opening in percent, and whether it moves. */
#include "model.h"

const char* const kModelToken = "valve-1";

enum { kShare, kMoving, kBegin, kEnd, kLast };

void model_start(double v[]) {
  v[kBegin] = 0.005; /* s */
  v[kEnd] = 0.015;
  v[kLast] = 80; /* % */
}

void model_outputs(double v[], double time) {
  const double way = (time - v[kBegin]) / (v[kEnd] - v[kBegin]);
  const double x = way < 0 ? 0 : way > 1 ? 1 : way;
  v[kShare] = 100 + (v[kLast] - 100) * x;
  v[kMoving] = x > 0 && x < 1;
}

int model_step(double v[], double time, double step, char* message, size_t length) {
  (void)v;
  (void)time;
  (void)step;
  (void)message;
  (void)length;
  return 0;
}
