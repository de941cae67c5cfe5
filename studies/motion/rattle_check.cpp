// Points of the rattle map by Simbody's model: from the same state, through the same turns.
#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"
#include "rattle_pieces.h"

namespace bentaxis::study {
namespace {

// All three are integrated to this; the disturbance is far above their errors and far below what
// the forces are judged by.
constexpr double kCheckTolerance = 1e-9;
constexpr double kCheckDisturbance = 1e-6;  // of the lag's scale
// Allowed difference of the largest force: what tops between steps are found to, and the errors of
// the steps grown as disturbances grow.
constexpr double kOfTops = 1e-5;
constexpr double kOfSteps = 1e-5;
constexpr int kMaxCheckedTurns = 3;  // an irregular motion is judged for less than one
constexpr double kTooMuchToJudge = 0.05;

// A model under way.
struct Runner : WatchedModel {
  coupled::ContactInterval judged, whole;

  Runner(const PreparedCase& ready, Model model, const RattlePoint& from, double disturbance)
      : WatchedModel(ready, model, kCheckTolerance, from.lag, from.lag_rate, disturbance) {}
};

// Of two motions, of what their states are measured by.
double states_apart(const Runner& a, const Runner& b) {
  const MotionVector scales = a.mechanics->scales();
  compare::Difference most;
  for (const std::size_t i : {kLag, kLagRate})
    most.keep_larger(compare::difference(a.watch.motion()[i], b.watch.motion()[i], scales[i]));
  return most.share();
}

}  // namespace

// Of the larger: a model without force differs from one that has some.
compare::Difference force_difference(double analytic, double multibody) {
  return compare::difference(analytic, multibody, std::max(analytic, multibody));
}

std::vector<std::pair<std::size_t, std::size_t>> points_to_check(const RattleMap& map) {
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> of_class(
      rattle_class_names().size());
  for (std::size_t i = 0; i < map.rows.size(); ++i)
    for (std::size_t j = 0; j < map.rows[i].up.size(); ++j)
      if (map.rows[i].up[j].observed > 0)
        of_class[static_cast<std::size_t>(map.rows[i].up[j].kind)].emplace_back(i, j);
  // How many of each class: in turn, as long as there are any.
  std::vector<std::size_t> wanted(of_class.size(), 0);
  auto left = static_cast<std::size_t>(map.options.check);
  for (bool any = true; any && left > 0;) {
    any = false;
    for (std::size_t k = 0; k < of_class.size() && left > 0; ++k) {
      if (wanted[k] == of_class[k].size()) continue;
      ++wanted[k];
      --left;
      any = true;
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> chosen;
  for (std::size_t k = 0; k < of_class.size(); ++k)
    for (std::size_t n = 0; n < wanted[k]; ++n)  // evenly, in the middles of as many parts
      chosen.push_back(of_class[k][(2 * n + 1) * of_class[k].size() / (2 * wanted[k])]);
  return chosen;
}

RattleCheck check_point(const RattleMap& map, std::size_t row, std::size_t speed,
                        const std::function<void()>& turn) {
  const RattlePoint& point = map.rows[row].up[speed];
  const PreparedCase ready = prepare(
      rattle_case(map.the_case, map.options.speed_rpm[speed], map.options.delivery_bar[row]));
  Runner analytic(ready, Model::analytic, point, 0);
  Runner disturbed(ready, Model::analytic, point, kCheckDisturbance);
  Runner multibody(ready, Model::multibody, point, 0);
  RattleCheck check;
  check.row = row;
  check.speed = speed;
  check.parts = std::min(point.observed, kMaxCheckedTurns) * kPartsOfTurn;
  const double part = 60 / map.options.speed_rpm[speed] / kPartsOfTurn;
  double growth = 1;
  bool judging = true;
  for (int n = 1; n <= check.parts; ++n) {
    coupled::ContactInterval of[2];
    int model = 0;
    for (Runner* runner : {&analytic, &multibody}) {
      of[model] = runner->watch.run_to(n * part);
      runner->whole = runner->whole + of[model++];
    }
    turn();
    if (!judging) continue;
    disturbed.watch.run_to(n * part);
    update_max_abs(growth, states_apart(analytic, disturbed) / kCheckDisturbance);
    const double allowed = kOfTops + kOfSteps * growth;
    judging = allowed <= kTooMuchToJudge;
    if (!judging) continue;
    check.judged = n;
    check.growth = growth;
    check.allowed = allowed;
    analytic.judged = analytic.judged + of[0];
    multibody.judged = multibody.judged + of[1];
  }
  const auto class_of_judged = [&](const Runner& r) {
    return class_of(check.judged > 0 ? r.judged : r.whole);
  };
  check.analytic = class_of_judged(analytic);
  check.multibody = class_of_judged(multibody);
  check.analytic_whole = class_of(analytic.whole);
  check.multibody_whole = class_of(multibody.whole);
  check.largest_analytic = analytic.whole.largest;
  check.largest_multibody = multibody.whole.largest;
  check.difference = force_difference(analytic.judged.largest, multibody.judged.largest).share();
  return check;
}

}  // namespace bentaxis::study
