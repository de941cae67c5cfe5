// Pieces of the rattle map. Internal.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "bentaxis/compare/difference.h"
#include "bentaxis/coupled/tooth_watch.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"
#include "bentaxis/study/rattle.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// What the interval's teeth do.
RattleClass class_of(const coupled::ContactInterval& s);
/// Error per step, of each state's scale, for a wanted error of the reactions.
double step_tolerance(double error);

/// The smallest and the largest force of rigid teeth over the turn, N, positive where the shaft
/// pushes the block on.
std::pair<double, double> rigid_extremes(const PreparedCase& ready);

/// A model whose teeth are watched from theta = 0 on.
struct WatchedModel {
  std::unique_ptr<Oil> oil;
  std::unique_ptr<Mechanics> mechanics;
  coupled::ToothWatch watch;

  /// @param disturbance  of the lag, of its scale
  WatchedModel(const PreparedCase& ready, Model model, double tolerance, double lag,
               double lag_rate, double disturbance = 0);
};

/// Moves the teeth at a point until it is settled and observes them.
/// @param lag, lag_rate  where they begin, at theta = 0; then where they end
/// @param turn           called after every turn
RattlePoint settle(const PreparedCase& ready, const RattleOptions& options, double& lag,
                   double& lag_rate, const std::function<void()>& turn);

/// What the models differ by in the largest force, of the larger.
compare::Difference force_difference(double analytic, double multibody);
/// Points of the upward sweep to check, spread over the classes.
std::vector<std::pair<std::size_t, std::size_t>> points_to_check(const RattleMap& map);
RattleCheck check_point(const RattleMap& map, std::size_t row, std::size_t speed,
                        const std::function<void()>& turn);

}  // namespace bentaxis::study
