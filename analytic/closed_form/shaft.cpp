#include "closed_form/shaft.h"

#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
void prepare(const RawPump<T>& pump, const FrameNumbers<T>& frame, ShaftNumbers<T>& p) {
  const T weight = -pump.shaft.mass * pump.gravity;
  const T spring_y = -pump.block.spring_force * frame.sin_tilt;  // along -z2, at O2
  p.joint_radius = pump.geometry.joint_circle_radius;
  p.force_y = weight + spring_y;
  p.force_z = -pump.block.spring_force * frame.cos_tilt;
  p.moment_x = -pump.geometry.axis_offset * spring_y - pump.shaft.centre_of_mass_z * weight;
  p.inertia = pump.shaft.axial_inertia;
  p.viscous = pump.friction.shaft_viscous;
  p.inverse_torque_factor = 1 / pump.friction.shaft_torque_factor;
  p.tapered_z = pump.bearings.tapered_z;
  p.inverse_bearing_distance = 1 / (pump.bearings.cylindrical_z - pump.bearings.tapered_z);
  p.axis_offset = pump.geometry.axis_offset;
}
template void prepare(const RawPump<double>& pump, const FrameNumbers<double>& frame,
                      ShaftNumbers<double>& p);
template void prepare(const RawPump<Dual>& pump, const FrameNumbers<Dual>& frame,
                      ShaftNumbers<Dual>& p);
template void prepare(const RawPump<long double>& pump, const FrameNumbers<long double>& frame,
                      ShaftNumbers<long double>& p);

}  // namespace bentaxis::analytic::closed_form
