// Tapered pistons that touch the walls of their bores: approach, force, and what it does to the
// piston's other reactions and to the block (T7), (T8), (T10). docs/transfer.md.
#pragma once

#include "bentaxis/pump/parameters.h"
#include "closed_form/block.h"
#include "closed_form/piston.h"
#include "closed_form/raw.h"
#include "closed_form/state.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

template <class T>
struct WallNumbers {
  T share;                             // w = 1 - l_c / b1
  T along;                             // l_c / b1: from A to D along AB
  T on_bore;                           // l_c / s_C: part of Rw that Rc balances; Rs the rest
  T clearance;                         // h, where it is that of all pistons
  T stiffness, exponent, dissipation;  // k x0, e, c_d; force k x0 (x/x0)^e (1 + c_d x')
};

template <class T>
void prepare(const RawPump<T>& pump, WallNumbers<T>& p);

/// What a wall is asked for: its law, the law continued beyond the end of contact, or nothing. An
/// integration holds to one of the last two until contact changes.
enum class WallMode : signed char { by_law, pressing, away };

/// Instant of a block that pistons carry round; it moves on its own.
template <class Real>
struct WallState : FreeState<Real> {
  const WallMode* modes = nullptr;  ///< one per piston; null: all by law
  bool away = false;                ///< no wall pushes at all

  WallMode mode(int k) const {
    if (away) return WallMode::away;
    return modes == nullptr ? WallMode::by_law : modes[k];
  }
};

/// Distance of a piston's axis from that of its bore at D, less the clearance, and its rate.
template <class Real>
struct WallApproach {
  Real distance, rate;
  Real x, y;  // direction of the wall's force on the piston, in S2: a unit vector
};
/// @param clearance  of this piston
template <class Par, class Real>
WallApproach<Real> wall_approach(const WallNumbers<Par>& p, const PistonMotion<Real>& m,
                                 const Par& clearance) {
  // B - A across the bore is -u.
  const Real off = Math<Real>::root(m.axis.x * m.axis.x + m.axis.y * m.axis.y);
  const bool centred = !(off > 0);
  const Real inverse = centred ? Real(0) : 1 / off;
  const Real x = m.axis.x * inverse;
  const Real y = m.axis.y * inverse;
  return {p.share * off - clearance, p.share * (x * m.axis_first.x + y * m.axis_first.y), x, y};
}

/// Spring and damping of a wall, W in a step of the law's two factors.
template <class Par, class Real>
Real wall_spring(const WallNumbers<Par>& p, const Real& distance) {
  using std::pow, std::abs, std::copysign;
  const Real part = distance / kWallApproach;
  return p.stiffness * (p.exponent == 1 ? part : copysign(pow(abs(part), Real(p.exponent)), part));
}
template <class Par, class Real>
Real wall_force(const WallNumbers<Par>& p, const WallApproach<Real>& at, WallMode mode) {
  if (mode == WallMode::away) return 0;
  const bool by_law = mode == WallMode::by_law;
  if (by_law && !(at.distance > 0)) return 0;
  const Real force = wall_spring(p, at.distance) * (1 + p.dissipation * at.rate);
  return by_law && force < 0 ? Real(0) : force;
}

/// Adds a wall's force on a piston at D to the forces that hold the piston, and to the block.
template <class Par, class Real>
void add_wall(const WallNumbers<Par>& p, const PistonMotion<Real>& m, const Real& x, const Real& y,
              PistonForces<Real>& f, BlockLoad<Real>& load) {
  f.rc_x = f.rc_x - p.on_bore * x;
  f.rc_y = f.rc_y - p.on_bore * y;
  f.rs.x = f.rs.x - (1 - p.on_bore) * x;
  f.rs.y = f.rs.y - (1 - p.on_bore) * y;
  const Vec3<Real> d = m.joint + p.along * m.axis;
  load.bore_x = load.bore_x + x;
  load.bore_y = load.bore_y + y;
  load.moment.x = load.moment.x + d.z * y;
  load.moment.y = load.moment.y - d.z * x;
  load.moment.z = load.moment.z + (d.y * x - d.x * y);
}

}  // namespace bentaxis::analytic::closed_form
