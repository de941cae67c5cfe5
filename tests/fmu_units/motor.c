/* A motor behind a coupling, as [drive] kind = "motor" of a case: inputs angle and speed of the
   shaft, output the torque of the coupling. Over a step the shaft is taken to turn on at its speed.
 */
#include "model.h"

const char* const kModelToken = "motor-1";

enum {
  kShaftAngle, /* rad */
  kShaftSpeed, /* rad/s */
  kTorque,     /* output, Nm */
  kInertia,    /* kg m2 */
  kSlope,      /* Nm s/rad */
  kStiffness,  /* Nm/rad */
  kDamping,    /* Nm s/rad */
  kNominalTorque,
  kNominalSpeed,
  kAngle, /* of the rotor */
  kSpeed
};

void model_start(double v[]) {
  v[kShaftSpeed] = v[kSpeed] = v[kNominalSpeed] = 157.07963267948966;
  v[kInertia] = 0.15;
  v[kSlope] = 20;
  v[kStiffness] = 30000;
  v[kDamping] = 20;
  v[kNominalTorque] = 290;
  v[kAngle] = 290.0 / 30000; /* the coupling carries the torque */
}

static double coupling(const double v[], double angle, double speed, double shaft_angle) {
  return v[kStiffness] * (angle - shaft_angle) + v[kDamping] * (speed - v[kShaftSpeed]);
}

void model_outputs(double v[], double time) {
  (void)time;
  v[kTorque] = coupling(v, v[kAngle], v[kSpeed], v[kShaftAngle]);
}

static double acceleration(const double v[], double angle, double speed, double since) {
  const double torque = v[kNominalTorque] - v[kSlope] * (speed - v[kNominalSpeed]);
  return (torque - coupling(v, angle, speed, v[kShaftAngle] + v[kShaftSpeed] * since)) /
         v[kInertia];
}

int model_step(double v[], double time, double step, char* message, size_t length) {
  enum { kParts = 4 };
  const double h = step / kParts;
  (void)time;
  (void)message;
  (void)length;
  for (int part = 0; part < kParts; ++part) { /* Runge-Kutta of order 4 */
    const double t = h * part;
    const double x = v[kAngle], u = v[kSpeed];
    const double a1 = acceleration(v, x, u, t);
    const double a2 = acceleration(v, x + h / 2 * u, u + h / 2 * a1, t + h / 2);
    const double a3 = acceleration(v, x + h / 2 * (u + h / 2 * a1), u + h / 2 * a2, t + h / 2);
    const double a4 = acceleration(v, x + h * (u + h / 2 * a2), u + h * a3, t + h);
    v[kAngle] = x + h * u + h * h / 6 * (a1 + a2 + a3);
    v[kSpeed] = u + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return 0;
}
