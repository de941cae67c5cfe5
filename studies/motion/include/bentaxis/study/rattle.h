// Where the block rattles: contact of its gear's teeth, or of the pistons that carry it, over speed
// and delivery pressure. With pistons, flanks are sides of the free play and a tooth force is the
// sum of all wall forces.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

// What decides on a point; docs/rattle.md says why.
inline constexpr double kImpactSpeed = 1e-3;  ///< m/s of approach: a touch as fast is an impact
/// Share of the time: flanks that part for less have passed the force on without parting.
inline constexpr double kNoGap = 1e-6;
/// A motion repeats itself where lag and its rate are this near, of what they are measured by, to
/// where they were some turns before, twice running.
inline constexpr double kRepeats = 1e-3;
inline constexpr int kLongestPeriod = 4;  ///< turns, of a motion that is seen to repeat itself
/// Turns without separation after which nothing more is waited for.
inline constexpr int kTurnsInTouch = 5;
inline constexpr int kPartsOfTurn = 40;  ///< of a turn by Simbody: it is compared part by part
/// Two steady states differ in class, or in the largest force of a turn by this share of it.
inline constexpr double kOtherForce = 0.1;

enum class RattleClass { carries, reverses, loses_contact, hits_both };
/// "carries", "reverses", "loses contact", "hits both flanks".
const std::vector<std::string>& rattle_class_names();
std::string to_string(RattleClass kind);

struct RattleOptions {
  std::vector<double> speed_rpm;     ///< rising, > 0
  std::vector<double> delivery_bar;  ///< rising
  int discard = 10;                  ///< turns before those that are observed
  int turns = 10;                    ///< observed, where the motion does not repeat itself
  double error = 1e-3;               ///< of a reaction, of its peak: steps err by 1e-3 of it
  int threads = 0;                   ///< 0: as many as there are processors
  int check = 0;                     ///< points to be computed by Simbody too
};

/// Motion of the teeth at a speed and a pressure.
struct RattlePoint {
  RattleClass kind = RattleClass::carries;
  double apart = 0, plus = 0, minus = 0;  ///< shares of the time: on no flank, on either one
  double largest = 0, mean = 0;           ///< N, of the magnitude of the tooth force
  double least_turn = 0;                  ///< N, the smallest of all turns' largest forces
  double impacts = 0;                     ///< per turn
  double largest_impulse = 0;             ///< Ns, of an impact
  int observed = 0;                       ///< turns; 0 where teeth are rigid
  int passed = 0;                         ///< turns before them
  int period = 0;  ///< turns after which the motion repeats itself; 0: irregular, or longer
  double lag = 0, lag_rate = 0;  ///< where the observed turns begin, at theta = 0, rad, rad/s
  std::string reason = {};       ///< why it could not be computed, or "": then nothing else holds

  bool done() const { return reason.empty(); }

  /// The largest force over the mean; not_computed() where there is none.
  double over_mean() const { return mean > 0 ? largest / mean : not_computed(); }
};

/// All speeds at a delivery pressure: swept up, then down from where that ended.
struct RattleRow {
  double delivery_bar = 0;
  std::vector<RattlePoint> up, down;    ///< by speed
  std::vector<double> least, greatest;  ///< by speed, N, rigid tooth force over the turn;
                                        ///< not_computed() where the pressure could not be found
  std::vector<double> boundary_rpm;     ///< where `least` passes 0, rising

  bool done() const;  ///< all points
};

/// Whether two sweeps have come to different steady states.
bool two_states(const RattlePoint& up, const RattlePoint& down);
/// Whether the force of rigid teeth keeps its sign.
bool carries_rigidly(double least, double greatest);

/// A point by both models from the same state.
struct RattleCheck {
  std::size_t row = 0, speed = 0;
  int parts = 0;          ///< of turns, kPartsOfTurn each, that were computed
  int judged = 0;         ///< of them, until a disturbance has grown too much
  double growth = 1;      ///< of a disturbance, within the compared time
  double difference = 0;  ///< of the largest force, of the larger, within the compared time
  double allowed = 0;     ///< likewise
  RattleClass analytic{}, multibody{};                 ///< within the compared time
  RattleClass analytic_whole{}, multibody_whole{};     ///< over all
  double largest_analytic = 0, largest_multibody = 0;  ///< N, over all
  bool chaotic() const { return judged < parts; }
  bool agrees() const { return judged > 0 && analytic == multibody && difference <= allowed; }
};

struct RattleMap {
  Case the_case;
  RattleOptions options;
  std::vector<RattleRow> rows;  ///< by pressure
  std::vector<RattleCheck> checks;
  /// Pressures whose row could not be computed: they are neither in `rows` nor in `options`.
  std::vector<FailedPoint> failed;
  bool agrees() const;  ///< all checks
  /// Those, and single points of the other rows.
  std::vector<FailedPoint> all_failed() const;
};

/// Rows that are there already, and who hears of each that is finished: one thread at a time.
struct RattleKeeping {
  std::vector<RattleRow> finished;
  std::function<void(const RattleRow&)> keep;
};

/// The case at a speed and a delivery pressure, its shaft turning at constant speed.
/// @throws InputError where its load sets the pressure
Case rattle_case(Case the_case, double speed_rpm, double delivery_bar);

/// Computes a map. A row is computed by one thread: results do not depend on how many there are. A
/// point whose computation fails says why, and the sweep goes on from its neighbour; a row none of
/// whose points can be computed is left out and named. `keeping` hears of rows that are whole.
/// @throws InputError; ComputationError where every row fails, or the check of a point; what
/// `progress` throws, when rows under way are given up
RattleMap rattle_map(const Case& the_case, const RattleOptions& options,
                     const RattleKeeping& keeping = {}, const PartProgress& progress_of = silent());

/// How the simulated boundary stands to the criterion of rigid teeth, of the upward sweep.
struct BoundaryAgreement {
  std::size_t points = 0, same = 0;  ///< of those, the criterion says the same whether teeth carry
  /// Per row and boundary of the criterion: where the simulated class changes, half way between two
  /// speeds; not_computed() where it does not.
  struct Place {
    double delivery_bar, criterion_rpm, simulated_rpm, spacing_rpm;
  };
  std::vector<Place> places;
};
BoundaryAgreement boundary_agreement(const RattleMap& map);

}  // namespace bentaxis::study
