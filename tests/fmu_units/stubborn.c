/* A unit that says things and then refuses; variables of many types. */
#include <stdio.h>

#include "model.h"

const char* const kModelToken = "stubborn-1";

enum { kFailAt, kStatus, kWhole, kSmall, kYes, kSingle, kSum, kSpeed };

void model_start(double v[]) {
  v[kFailAt] = 0.01;
  v[kStatus] = 3; /* FMI's: error */
  v[kSpeed] = 150;
}

void model_outputs(double v[], double time) {
  (void)time;
  v[kSum] = v[kWhole] + v[kSmall] + v[kYes] + v[kSingle];
}

int model_step(double v[], double time, double step, char* message, size_t length) {
  v[kSpeed] = 150 + time + step;
  if (time + step < v[kFailAt]) {
    if (time == 0) {
      snprintf(message, length, "the tank is\nhalf empty");
      return 1;
    }
    return 0;
  }
  snprintf(message, length, "no level of oil at %g s", time);
  return (int)v[kStatus];
}
