#include "closed_form/piston.h"

#include <cmath>

#include "bentaxis/pump/units.h"
#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
void prepare(const RawGeometry<T>& g, const FrameNumbers<T>& frame, PistonNumbers<T>& p) {
  using std::sin;
  p.joint_radius = g.joint_circle_radius;
  p.joint_y = g.joint_circle_radius * frame.cos_tilt;
  p.joint_z = g.joint_circle_radius * frame.sin_tilt;
  p.difference = g.bore_circle_radius - g.joint_circle_radius;
  // Rd - Ra cos(alpha), without the cancellation that cos(alpha) next to 1 brings.
  const T half = sin(g.tilt / 2);
  p.projected = p.difference + 2 * g.joint_circle_radius * half * half;
  p.bore_radius = g.bore_circle_radius;
  p.length_squared = g.piston_length * g.piston_length;
  p.area = kPi / 4 * g.bore_diameter * g.bore_diameter;
}

// Two point masses are a rigid body with centre at (1 - chi) b1 and chi (1 - chi) m b1^2 about it;
// both kinds of piston are treated through their moments about A.
template <class T>
void prepare(const RawPump<T>& pump, PistonInertia inertia, const FrameNumbers<T>& frame,
             PistonNumbers<T>& p) {
  p.gravity_y = -pump.gravity * frame.cos_tilt;
  p.gravity_z = -pump.gravity * frame.sin_tilt;
  p.mass = pump.piston.mass;
  p.inverse_lever = pump.geometry.piston_length / pump.piston.contact;
  p.spin_momentum = 0;
  const T length = pump.geometry.piston_length;
  if (inertia == PistonInertia::lumped) {
    p.static_moment = p.mass * (1 - pump.piston.joint_mass_fraction);
    p.inertia = p.static_moment;
    return;
  }
  const auto& real = pump.piston.real;
  const T centre = real.centre_of_mass;
  const T share = centre / length;
  if (inertia == PistonInertia::dynamically_equivalent) {
    // Point masses at A and B that have the transverse inertia about the centre of mass between
    // them, and the rest there.
    const bool spread = counts(real.transverse_inertia) && centre > 0 && length - centre > 0;
    const T at_joint = spread ? real.transverse_inertia / (length * centre) : T(0);
    const T at_ring = spread ? real.transverse_inertia / (length * (length - centre)) : T(0);
    const T at_centre = p.mass - at_joint - at_ring;
    p.static_moment = at_ring + at_centre * share;
    p.inertia = at_ring + at_centre * share * share;
    return;
  }
  p.static_moment = p.mass * share;
  p.inertia = p.mass * share * share + real.transverse_inertia / (length * length);
  p.spin_momentum = real.axial_inertia * real.spin / length;
}

template void prepare(const RawGeometry<double>& g, const FrameNumbers<double>& frame,
                      PistonNumbers<double>& p);
template void prepare(const RawGeometry<Dual>& g, const FrameNumbers<Dual>& frame,
                      PistonNumbers<Dual>& p);
template void prepare(const RawGeometry<long double>& g, const FrameNumbers<long double>& frame,
                      PistonNumbers<long double>& p);
template void prepare(const RawPump<double>& pump, PistonInertia inertia,
                      const FrameNumbers<double>& frame, PistonNumbers<double>& p);
template void prepare(const RawPump<Dual>& pump, PistonInertia inertia,
                      const FrameNumbers<Dual>& frame, PistonNumbers<Dual>& p);
template void prepare(const RawPump<long double>& pump, PistonInertia inertia,
                      const FrameNumbers<long double>& frame, PistonNumbers<long double>& p);

}  // namespace bentaxis::analytic::closed_form
