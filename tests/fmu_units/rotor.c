/* A rotor on the shaft under a torque that stands: input the drive torque of the pump, outputs
 * speed and acceleration. */
#include "model.h"

const char* const kModelToken = "rotor-1";

enum { kLoad, kSpeed, kAcceleration, kTorque, kInertia };

void model_start(double v[]) {
  v[kLoad] = 0;      /* Nm */
  v[kSpeed] = 1500;  /* 1/min */
  v[kTorque] = 320;  /* Nm */
  v[kInertia] = 0.2; /* kg m2 */
}

void model_outputs(double v[], double time) {
  (void)time;
  v[kAcceleration] = (v[kTorque] - v[kLoad]) / v[kInertia];
}

int model_step(double v[], double time, double step, char* message, size_t length) {
  const double rpm = 9.549296585513721; /* per rad/s */
  (void)time;
  (void)message;
  (void)length;
  v[kSpeed] += rpm * step * (v[kTorque] - v[kLoad]) / v[kInertia];
  return 0;
}
