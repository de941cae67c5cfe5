// A ball bearing's loads ball by ball, and the life that follows: ISO/TS 16281:2008.
#pragma once

#include <vector>

namespace bentaxis::study {

/// Internal geometry of a single-row deep-groove ball bearing, SI units.
struct BallBearing {
  int balls = 0;
  double ball_diameter = 0;          ///< Dw, m
  double pitch_diameter = 0;         ///< Dpw, m, of the balls' centres; > Dw
  double inner_groove_ratio = 0.52;  ///< ri / Dw, > 0.5
  double outer_groove_ratio = 0.53;  ///< re / Dw, > 0.5
  double radial_clearance = 0;       ///< s, m, between the rings in operation; >= 0
  double dynamic_rating = 0;         ///< C, N (ISO 281)
  double youngs_modulus = 210e9;     ///< E, Pa
  double poisson_ratio = 0.3;
};

struct BallBearingLoad {
  double radial = 0;      ///< Fr, N, towards phi = 0
  double axial = 0;       ///< Fa, N
  double moment = 0;      ///< M, Nm: moves the inner ring at phi = 0 along Fa
  double first_ball = 0;  ///< phi of the first ball, rad
};

/// Of the inner ring against the outer one.
struct BallBearingState {
  double radial = 0;               ///< m
  double axial = 0;                ///< m, from the middle of the axial clearance
  double tilt = 0;                 ///< rad
  std::vector<double> ball_loads;  ///< Q, N, from the first ball on
  double reference_life = 0;       ///< L10r, million revolutions; the inner ring rotates
};

/// Equilibrium of the inner ring with Hertz' contacts of two grooves, and the basic reference
/// rating life of the ball loads (ISO/TS 16281:2008, clauses 4 and 5).
/// @throws InputError where a dimension or a load is not one that a bearing can have
/// @throws ComputationError where no equilibrium is found
BallBearingState equilibrium(const BallBearing& bearing, const BallBearingLoad& load);

}  // namespace bentaxis::study
