// Rating life of the shaft's bearings after ISO 281, and their static safety after ISO 76, from
// the reactions Rb1 and Rb2 over turns of a pump.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// Of roller bearings: L10 = (C / P)^(10/3) million revolutions (ISO 281:2007, 7.2).
inline constexpr double kLifeExponent = 10.0 / 3;
/// Of ball bearings.
inline constexpr double kBallLifeExponent = 3;
/// Of roller bearings: slope of the Weibull distribution of their lives (Lundberg & Palmgren 1952).
inline constexpr double kWeibullSlope = 9.0 / 8;
/// Of ball bearings (likewise 1947).
inline constexpr double kBallWeibullSlope = 10.0 / 9;
/// ISO 281 holds for loads up to this share of C (and up to C0).
inline constexpr double kLargestLoad = 0.5;
/// Smallest load of a roller bearing, of C, at which its rollers roll: the manufacturers' rule.
inline constexpr double kSmallestLoad = 0.02;
/// That of a ball bearing.
inline constexpr double kSmallestBallLoad = 0.01;

/// What the rolling elements decide.
struct RollingLaw {
  double life_exponent = kLifeExponent, weibull_slope = kWeibullSlope;
  double smallest_load = kSmallestLoad;  ///< of C
};
RollingLaw law_of(RollingElement element);

/// Equivalent dynamic radial load P, N, of a tapered roller bearing, or of the ball bearing in its
/// place: Fr up to |Fa| = e Fr, else
/// X Fr + Y |Fa|.
/// @param radial  Fr >= 0, N @param axial  Fa, N
double equivalent_load(const TaperedRating& rating, double radial, double axial);
/// Equivalent static radial load P0 = max(Fr, Fr / 2 + Y0 |Fa|), N (ISO 76).
double equivalent_static_load(const TaperedRating& rating, double radial, double axial);
/// The constant load that costs as much life as loads P_i over shares q_i of the revolutions:
/// (sum q P^p / sum q)^(1/p).
double mean_load(std::span<const double> loads, std::span<const double> shares,
                 double exponent = kLifeExponent);
/// L10 in millions of revolutions; not_computed() without load.
double rating_life(double dynamic_rating, double load, double exponent = kLifeExponent);
/// That of roller bearings of which none may fail: (sum L^-e)^(-1/e), e the Weibull slope;
/// not_computed() where one is.
double combined_life(std::span<const double> lives);
/// Of bearings each with its own slope: the L at which sum (L/L_i)^e_i = 1, as 10 % of the pumps
/// have then had a failure. With equal slopes it is the life above.
double combined_life(std::span<const double> lives, std::span<const double> slopes);

/// The two bearings, as reactions and keys number them.
enum class Bearing { tapered, cylindrical };
inline constexpr Bearing kBearings[] = {Bearing::tapered, Bearing::cylindrical};
std::string to_string(Bearing bearing);

/// Loads of a bearing at the angles of a turn, N.
struct BearingLoads {
  std::vector<double> radial;       ///< Fr
  std::vector<double> axial;        ///< Fa = Rb1_z1; 0 of the cylindrical bearing
  std::vector<double> equivalent;   ///< P
  std::vector<double> equivalent0;  ///< P0
};

/// What bearings go through for a share of the time.
struct LifePoint {
  double share = 1;                     ///< of the time, or in proportion to it
  double speed_rpm = 0;                 ///< either sign
  std::vector<double> theta_deg;        ///< of the loads, evenly over the turn
  std::array<BearingLoads, 2> loads{};  ///< by Bearing
  /// Limits of validity of the turn, where they were checked: analytic::check_validity().
  std::vector<analytic::ValidityLimit> validity{};
};

/// @throws InputError where the case does not give both ratings
void require_ratings(const Case& the_case);

/// @param table  of a turn at constant speed, by either model
/// @throws InputError where the case does not give both ratings
LifePoint life_point(const Case& the_case, const ResultTable& table, double share = 1);

/// Shares of the time that sum to 1, and of the revolutions: they sum to 1 too, or are all 0 where
/// nothing turns. Shares in any proportion, however large, are taken.
struct DutyShares {
  std::vector<double> time, revolutions;
};
DutyShares duty_shares(const std::vector<LifePoint>& points);

/// Of one bearing over all points.
struct BearingLife {
  double mean_load = 0;            ///< P_m, N
  double revolutions = 0;          ///< L10, millions
  double hours = 0;                ///< L10h at the mean speed
  double static_safety = 0;        ///< C0 over the largest P0
  std::vector<double> life_share;  ///< that each point uses up, sums to 1
  /// Of a ball bearing whose balls are given (ISO/TS 16281); else not_computed().
  double reference_revolutions = not_computed();  ///< L10r, millions, under the loads of all angles
  double reference_hours = not_computed();
  double deflection = not_computed();         ///< m, largest radial one of the inner ring
  double largest_ball_load = not_computed();  ///< N
};

/// A limit of what a life may be computed for: of a bearing, or of the models that find its loads.
struct LifeLimit {
  Bearing bearing = Bearing::tapered;
  std::string key;            ///< "pulled", "seated", "smallest", "largest", "static", or that of
                              ///< an analytic::ValidityLimit
  std::string limit;          ///< what must hold
  std::string consequence;    ///< where it does not
  double violated_share = 0;  ///< of the revolutions
  double worst = 0;           ///< in `unit`
  std::size_t point = 0;      ///< where that is
  double theta_deg = 0;
  std::string unit = "N";
  bool of_bearing = true;  ///< false: of the turn of the pump, whatever the bearing is
};

struct PumpLife {
  std::array<BearingLife, 2> bearings;  ///< by Bearing
  double revolutions = 0;               ///< L10 of both together, millions
  double hours = 0;
  double mean_speed_rpm = 0;  ///< of the whole time, standstill too; >= 0
  std::vector<LifeLimit> limits;
  double violated_share = 0;  ///< of the revolutions, in which any of the limits is violated

  const BearingLife& of(Bearing bearing) const {
    return bearings[static_cast<std::size_t>(bearing)];
  }
};

/// Lives under a duty cycle. Loads count by revolutions: share of the time x speed. Without any
/// revolution there is no life, only static safety.
/// @throws InputError where the case does not give both ratings
PumpLife pump_life(const Case& the_case, const std::vector<LifePoint>& points);

}  // namespace bentaxis::study
