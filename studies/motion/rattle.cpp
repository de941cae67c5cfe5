#include "bentaxis/study/rattle.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/reporting.h"
#include "rattle_pieces.h"

namespace bentaxis::study {
namespace {

constexpr double kBoundaryRpm = 1e-3;

PreparedCase ready_at(const Case& the_case, double speed_rpm, double delivery_bar) {
  return prepare(rattle_case(the_case, speed_rpm, delivery_bar));
}

// Where the smallest rigid force passes 0, between speeds at which it is known.
std::vector<double> boundary(const Case& the_case, const std::vector<double>& speeds,
                             const RattleRow& row) {
  std::vector<double> found;
  const auto least = [&](double rpm) {
    return rigid_extremes(ready_at(the_case, rpm, row.delivery_bar)).first;
  };
  const auto near = [](double a, double b) { return b - a <= kBoundaryRpm; };
  for (std::size_t j = 0; j + 1 < speeds.size(); ++j) {
    if (!is_computed(row.least[j]) || !is_computed(row.least[j + 1]) ||
        (row.least[j] < 0) == (row.least[j + 1] < 0))
      continue;
    std::uintmax_t evaluations = 50;
    try {
      const auto [low, high] = boost::math::tools::toms748_solve(
          least, speeds[j], speeds[j + 1], row.least[j], row.least[j + 1], near, evaluations);
      found.push_back((low + high) / 2);
    } catch (const ComputationError&) {
      // Between two speeds at which there is a pressure there need not be one.
    }
  }
  return found;
}

RattlePoint failed_point(const std::string& reason) {
  RattlePoint point;
  point.reason = reason;
  return point;
}

RattleRow compute_row(const Case& the_case, const RattleOptions& options, double delivery_bar,
                      const std::function<void()>& turn, const std::function<void()>& point) {
  RattleRow row;
  row.delivery_bar = delivery_bar;
  const std::vector<double>& speeds = options.speed_rpm;
  std::vector<std::optional<PreparedCase>> ready(speeds.size());
  std::vector<std::string> reasons(speeds.size());
  for (std::size_t j = 0; j < speeds.size(); ++j) {
    std::pair<double, double> extremes{not_computed(), not_computed()};
    try {
      ready[j] = ready_at(the_case, speeds[j], delivery_bar);
      extremes = rigid_extremes(*ready[j]);
    } catch (const ComputationError& error) {
      ready[j].reset();
      reasons[j] = error.what();
    }
    row.least.push_back(extremes.first);
    row.greatest.push_back(extremes.second);
    turn();
  }
  row.boundary_rpm = boundary(the_case, speeds, row);
  double lag = 0, lag_rate = 0;
  const auto at = [&](std::size_t j) {
    // A point that fails on the way leaves the teeth where its neighbour had them.
    double lag_here = lag, rate_here = lag_rate;
    RattlePoint found = failed_point(reasons[j]);
    if (ready[j]) try {
        found = settle(*ready[j], options, lag_here, rate_here, turn);
        lag = lag_here;
        lag_rate = rate_here;
      } catch (const ComputationError& error) {
        found = failed_point(error.what());
      }
    point();
    return found;
  };
  for (std::size_t j = 0; j < speeds.size(); ++j) row.up.push_back(at(j));
  row.down.resize(speeds.size());
  for (std::size_t j = speeds.size(); j-- > 0;) row.down[j] = at(j);
  const auto failed = [](const RattlePoint& p) { return !p.done(); };
  if (std::all_of(row.up.begin(), row.up.end(), failed) &&
      std::all_of(row.down.begin(), row.down.end(), failed))
    throw ComputationError(row.up.front().reason);
  return row;
}

}  // namespace

const std::vector<std::string>& rattle_class_names() {
  static const std::vector<std::string> names = {"carries", "reverses", "loses contact",
                                                 "hits both flanks"};
  return names;
}

std::string to_string(RattleClass kind) {
  return rattle_class_names()[static_cast<std::size_t>(kind)];
}

bool two_states(const RattlePoint& up, const RattlePoint& down) {
  if (!up.done() || !down.done()) return false;
  if (up.kind != down.kind) return true;
  const RattlePoint& weaker = up.largest < down.largest ? up : down;
  const RattlePoint& stronger = up.largest < down.largest ? down : up;
  return stronger.least_turn > weaker.largest &&
         stronger.largest - weaker.largest > kOtherForce * stronger.largest;
}

bool carries_rigidly(double least, double greatest) { return least >= 0 || greatest <= 0; }

bool RattleRow::done() const {
  const auto done = [](const RattlePoint& p) { return p.done(); };
  return std::all_of(up.begin(), up.end(), done) && std::all_of(down.begin(), down.end(), done);
}

std::vector<FailedPoint> RattleMap::all_failed() const {
  std::vector<FailedPoint> all = failed;
  for (const RattleRow& row : rows)
    for (std::size_t j = 0; j < row.up.size(); ++j)
      for (const auto& [name, point] : {std::pair{"up", &row.up[j]}, {"down", &row.down[j]}})
        if (!point->done())
          all.push_back({row.delivery_bar,
                         "delivery_bar = " + number_text(row.delivery_bar) + ", speed_rpm = " +
                             number_text(options.speed_rpm[j]) + ", swept " + name,
                         point->reason});
  return all;
}

bool RattleMap::agrees() const {
  return std::all_of(checks.begin(), checks.end(),
                     [](const RattleCheck& check) { return check.agrees(); });
}

Case rattle_case(Case the_case, double speed_rpm, double delivery_bar) {
  require_pressure_asked_for(the_case);
  if (the_case.pump.transfer.is_joint())
    throw InputError((the_case.file.empty() ? "" : the_case.file.string() + ": ") +
                     "[transfer] kind = \"" + to_string(the_case.pump.transfer.kind) +
                     "\": must be \"gear\" or \"pistons\": a joint has no play");
  if (the_case.pump.transfer.has_own_clearances())
    throw InputError((the_case.file.empty() ? "" : the_case.file.string() + ": ") +
                     "[transfer] clearance_deviation_file = \"" +
                     the_case.pump.transfer.wall->deviation_file.filename().string() +
                     "\": must be left out in a map of rattle, which takes all pistons as equal");
  the_case.operation.speed_rpm = speed_rpm;
  the_case.pressure.ports.delivery = pascals(delivery_bar);
  DriveSpec drive;
  drive.duration = 60 / speed_rpm;
  the_case.drive = drive;
  return the_case;
}

RattleMap rattle_map(const Case& the_case, const RattleOptions& options,
                     const RattleKeeping& keeping, const PartProgress& progress_of) {
  RattleMap map{the_case, options, std::vector<RattleRow>(options.delivery_bar.size()), {}, {}};
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < map.rows.size(); ++i) {
    const auto there = std::find_if(
        keeping.finished.begin(), keeping.finished.end(),
        [&](const RattleRow& row) { return row.delivery_bar == options.delivery_bar[i]; });
    if (there != keeping.finished.end())
      map.rows[i] = *there;
    else
      missing.push_back(i);
  }
  Reporting points(2 * missing.size() * options.speed_rpm.size(), progress_of("rattle"));
  std::vector<std::string> reasons(map.rows.size());
  numerics::parallel_for(options.threads, missing.size(), [&](std::size_t i) {
    RattleRow& row = map.rows[missing[i]];
    try {
      row = compute_row(
          the_case, options, options.delivery_bar[missing[i]], [&] { points.tick(); },
          [&] { points.done(); });
    } catch (const ComputationError& error) {
      reasons[missing[i]] = error.what();
      return;
    }
    points.tick([&] {
      if (keeping.keep && row.done()) keeping.keep(row);
    });
  });
  for (std::size_t i = map.rows.size(); i-- > 0;) {
    if (reasons[i].empty()) continue;
    const double bar = options.delivery_bar[i];
    map.failed.insert(map.failed.begin(), {bar, "delivery_bar = " + number_text(bar), reasons[i]});
    map.rows.erase(map.rows.begin() + static_cast<std::ptrdiff_t>(i));
    map.options.delivery_bar.erase(map.options.delivery_bar.begin() +
                                   static_cast<std::ptrdiff_t>(i));
  }
  if (map.rows.empty())
    throw ComputationError("no row of the map could be computed; the first: " +
                           map.failed[0].reason);
  const auto chosen = points_to_check(map);
  map.checks.resize(chosen.size());
  Reporting checks(chosen.size(), progress_of("Simbody"));
  numerics::parallel_for(options.threads, chosen.size(), [&](std::size_t i) {
    map.checks[i] = check_point(map, chosen[i].first, chosen[i].second, [&] { checks.tick(); });
    checks.done();
  });
  return map;
}

}  // namespace bentaxis::study
