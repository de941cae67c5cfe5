#include "bentaxis/study/rattle.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <mutex>
#include <optional>
#include <thread>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "rattle_pieces.h"

namespace bentaxis::study {
namespace {

constexpr double kBoundaryRpm = 1e-3;

ReadyCase ready_at(const Case& the_case, double speed_rpm, double delivery_bar) {
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
    if ((row.least[j] < 0) == (row.least[j + 1] < 0)) continue;
    std::uintmax_t evaluations = 50;
    const auto [low, high] = boost::math::tools::toms748_solve(
        least, speeds[j], speeds[j + 1], row.least[j], row.least[j + 1], near, evaluations);
    found.push_back((low + high) / 2);
  }
  return found;
}

RattleRow compute_row(const Case& the_case, const RattleOptions& options, double delivery_bar,
                      const std::function<void()>& turn, const std::function<void()>& point) {
  RattleRow row;
  row.delivery_bar = delivery_bar;
  std::vector<ReadyCase> ready;
  const std::vector<double>& speeds = options.speed_rpm;
  for (const double rpm : speeds) {
    ready.push_back(ready_at(the_case, rpm, delivery_bar));
    const auto [least, greatest] = rigid_extremes(ready.back());
    row.least.push_back(least);
    row.greatest.push_back(greatest);
    turn();
  }
  row.boundary_rpm = boundary(the_case, speeds, row);
  double lag = 0, lag_rate = 0;
  for (const ReadyCase& at : ready) {
    row.up.push_back(settle(at, options, lag, lag_rate, turn));
    point();
  }
  row.down.resize(speeds.size());
  for (std::size_t j = speeds.size(); j-- > 0;) {
    row.down[j] = settle(ready[j], options, lag, lag_rate, turn);
    point();
  }
  return row;
}

// Whoever listens is called by one thread at a time, and may throw. The lock also shows the thread
// sanitizer, which cannot see into oneTBB, that tasks come between what lies before and after.
class Reporting {
 public:
  Reporting(std::size_t all, Progress progress) : all_(all), progress_(std::move(progress)) {}

  void done() {
    const std::lock_guard lock(mutex_);
    ++done_;
    tell();
  }
  void tick(const std::function<void()>& first = {}) {
    const std::lock_guard lock(mutex_);
    if (first) first();
    tell();
  }

 private:
  void tell() {
    if (progress_) progress_(static_cast<double>(done_) / static_cast<double>(all_));
  }
  std::mutex mutex_;
  std::size_t all_, done_ = 0;
  Progress progress_;
};

// Orders what threads hand to each other once more than oneTBB does, whose library a thread
// sanitizer does not see.
std::atomic<long> handed_over{0};

template <class Job>
void in_threads(int threads, std::size_t count, const Job& job) {
  if (count == 0) return;
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  handed_over.fetch_add(1);
  oneapi::tbb::task_arena(threads > 0 ? std::min(threads, processors) : processors).execute([&] {
    // One by one: a row may take many times as long as another.
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const auto& range) {
          handed_over.fetch_add(1);
          for (std::size_t i = range.begin(); i < range.end(); ++i) job(i);
          handed_over.fetch_add(1);
        },
        oneapi::tbb::simple_partitioner());
  });
  handed_over.fetch_add(1);
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
  if (up.kind != down.kind) return true;
  const RattlePoint& weaker = up.largest < down.largest ? up : down;
  const RattlePoint& stronger = up.largest < down.largest ? down : up;
  return stronger.least_turn > weaker.largest &&
         stronger.largest - weaker.largest > kOtherForce * stronger.largest;
}

bool carries_rigidly(double least, double greatest) { return least >= 0 || greatest <= 0; }

bool RattleMap::agrees() const {
  return std::all_of(checks.begin(), checks.end(),
                     [](const RattleCheck& check) { return check.agrees(); });
}

Case rattle_case(Case the_case, double speed_rpm, double delivery_bar) {
  if (the_case.hydraulics && the_case.hydraulics->load &&
      the_case.hydraulics->load->sets_pressure())
    throw InputError(the_case.file.string() +
                     ": [load] sets the delivery pressure: a map over it has none to give");
  the_case.operation.speed_rpm = speed_rpm;
  the_case.pressure.ports.delivery = pascals(delivery_bar);
  DriveSpec drive;
  drive.duration = 60 / speed_rpm;
  the_case.drive = drive;
  return the_case;
}

RattleMap rattle_map(const Case& the_case, const RattleOptions& options,
                     const RattleKeeping& keeping, const PartProgress& progress_of) {
  RattleMap map{the_case, options, std::vector<RattleRow>(options.delivery_bar.size()), {}};
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
  in_threads(options.threads, missing.size(), [&](std::size_t i) {
    RattleRow& row = map.rows[missing[i]];
    row = compute_row(
        the_case, options, options.delivery_bar[missing[i]], [&] { points.tick(); },
        [&] { points.done(); });
    points.tick([&] {
      if (keeping.keep) keeping.keep(row);
    });
  });
  const auto chosen = points_to_check(map);
  map.checks.resize(chosen.size());
  Reporting checks(chosen.size(), progress_of("Simbody"));
  in_threads(options.threads, chosen.size(), [&](std::size_t i) {
    map.checks[i] = check_point(map, chosen[i].first, chosen[i].second, [&] { checks.tick(); });
    checks.done();
  });
  return map;
}

}  // namespace bentaxis::study
