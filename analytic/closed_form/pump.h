// A pump as the closed form sees it: the numbers of its pieces.
#pragma once

#include "closed_form/block.h"
#include "closed_form/film.h"
#include "closed_form/frame.h"
#include "closed_form/friction.h"
#include "closed_form/gear.h"
#include "closed_form/joint.h"
#include "closed_form/piston.h"
#include "closed_form/shaft.h"
#include "closed_form/state.h"
#include "closed_form/wall.h"

namespace bentaxis::analytic::closed_form {

/// Numbers of a pump, prepared once, SI. Plain numbers only, so that many pumps can be laid out
/// with one array per number.
template <class T>
struct Pump {
  FrameNumbers<T> frame;
  PistonNumbers<T> piston;
  FrictionNumbers<T> friction;
  BlockNumbers<T> block;
  FilmNumbers<T> film;
  GearNumbers<T> gear;
  ShaftNumbers<T> shaft;
  JointNumbers<T> joint;
  WallNumbers<T> wall;
};

/// What all pumps of a batch have in common.
struct Common {
  int pistons = 0;
  const double* phase_sin = nullptr;  ///< of 2 pi k / N
  const double* phase_cos = nullptr;
  bool imposed = false;  ///< block speed imposed: no tooth force
  FrictionLaw friction;
  TransferKind transfer = TransferKind::gear;
  /// First columns of what the transfer carries, beyond the reactions that every pump has; -1: not
  /// asked for.
  int couple_column = -1, force_column = -1, wall_column = -1, block_torque_column = -1;
  /// Clearance of each piston, m, where they differ; null: that of the pump.
  const double* clearances = nullptr;

  template <class Par>
  BENTAXIS_INLINE Par clearance(const WallNumbers<Par>& wall, int k) const {
    return clearances == nullptr ? wall.clearance : Par(clearances[k]);
  }
};

}  // namespace bentaxis::analytic::closed_form
