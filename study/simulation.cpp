#include "bentaxis/study/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/analytic/simulation.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/worst.h"

namespace bentaxis::study {
namespace {

constexpr double kDisturbance = 1e-9;
// A disturbance of the wanted error that has grown to this of peak leaves nothing to be judged.
constexpr double kNothingToJudge = 0.1;
// The analytic model is cheap: it is integrated so much better that it is the truth beside Simbody.
constexpr double kAnalyticShare = 0.01;
constexpr double kAnalyticError = 1e-8;
// A run longer than this is not repeated for the table of efforts.
constexpr double kCheap = 1.0;  // s

std::map<std::string, double> peaks_of(const ResultTable& table) {
  std::map<std::string, double> peaks;
  for (const Channel& channel : table.channels)
    if (channel.kind == ChannelKind::reaction && peaks.count(channel.group) == 0)
      peaks[channel.group] = table.peak(channel.group);
  return peaks;
}

// Difference of a reaction over its peak.
template <class Use>
void for_each_difference(const Trajectory& a, const Trajectory& b,
                         const std::map<std::string, double>& peaks, std::size_t row,
                         const Use& use) {
  const ResultTable& table = a.table.results;
  for (std::size_t c = 0; c < table.columns(); ++c) {
    const Channel& channel = table.channels[c];
    if (channel.kind != ChannelKind::reaction) continue;
    const double peak = peaks.at(channel.group);
    if (peak > 0) use(channel, std::abs(table.at(row, c) - b.table.results.at(row, c)) / peak);
  }
}

double largest_difference(const Trajectory& a, const Trajectory& b,
                          const std::map<std::string, double>& peaks, std::size_t row) {
  double largest = 0;
  for_each_difference(a, b, peaks, row,
                      [&](const Channel&, double share) { keep_worst(largest, share); });
  return largest;
}

class Study {
 public:
  Study(SimulationResult& result, const PartProgress& progress_of)
      : r_(result), progress_of_(progress_of) {}

  void run() {
    if (r_.choice.only != Model::multibody) run_analytic();
    if (r_.choice.only != Model::analytic) run_multibody();
    if (r_.analytic && r_.multibody) compare();
    check();
  }

 private:
  Trajectory analytic(const analytic::SimulationOptions& options, const std::string& part) const {
    return analytic::simulate(r_.ready.the_case, r_.ready.assumptions(Model::analytic),
                              r_.ready.pressure, options, progress_of_(part));
  }

  std::size_t judged_rows() const {
    std::size_t rows = 0;
    while (rows < r_.growth.size() && r_.allowed(rows) <= kNothingToJudge) ++rows;
    return rows;
  }

  // Largest difference of any reaction in what is judged.
  double apart(const Trajectory& a, const Trajectory& b) const {
    double largest = 0;
    for (std::size_t row = 0; row < judged_rows(); ++row)
      keep_worst(largest, largest_difference(a, b, peaks_, row));
    return largest;
  }

  void run_analytic() {
    analytic::SimulationOptions options;
    options.error = std::min(kAnalyticError, kAnalyticShare * r_.choice.error);
    r_.analytic = analytic(options, "analytic");
    peaks_ = peaks_of(r_.analytic->table.results);
    analytic::SimulationOptions disturbed = options;
    r_.disturbance = disturbed.disturbance = kDisturbance;
    const Trajectory beside = analytic(disturbed, "sensitivity");
    double growth = 1;
    for (std::size_t row = 0; row < r_.analytic->lag.size(); ++row) {
      growth =
          std::max(growth, largest_difference(*r_.analytic, beside, peaks_, row) / kDisturbance);
      r_.growth.push_back(growth);
    }
    const std::size_t judged = judged_rows();
    r_.judged_until_s = judged == 0 ? 0 : r_.analytic->table.state(judged - 1, 0);
    if (r_.analytic->record.seconds > kCheap) {
      add_effort(Model::analytic, options.error, *r_.analytic, not_computed());
      return;
    }
    analytic::SimulationOptions best = options;
    best.error = options.error * 1e-3;
    const Trajectory truth = analytic(best, "analytic, tightest");
    for (const double error : {1e-2, 1e-4, 1e-6}) {
      analytic::SimulationOptions looser = options;
      looser.error = error;
      const Trajectory run = analytic(looser, "analytic, looser");
      add_effort(Model::analytic, error, run, apart(truth, run));
    }
    add_effort(Model::analytic, options.error, *r_.analytic, apart(truth, *r_.analytic));
  }

  Trajectory multibody(double accuracy) const {
    SimulationOptions options;
    options.error = r_.choice.error;
    options.accuracy = accuracy;
    multibody::SimulationMethod method;
    method.integrator = r_.choice.integrator;
    return multibody::simulate(
        r_.ready.the_case, r_.ready.assumptions(Model::multibody), r_.ready.pressure, options,
        progress_of_(fmt::format("multibody, accuracy {:g}", accuracy)), method);
  }

  void run_multibody() {
    const std::string name =
        multibody::integrator_names()[static_cast<std::size_t>(r_.choice.integrator)];
    if (r_.choice.accuracy) {
      r_.multibody = multibody(*r_.choice.accuracy);
      r_.multibody_choice = fmt::format("{}, accuracy {:g} as asked", name, *r_.choice.accuracy);
      add_multibody(*r_.choice.accuracy, *r_.multibody);
      return;
    }
    // Two runs, ten times apart in accuracy, tell how the error falls; where it is not small enough
    // yet a third goes to the accuracy at which it should be, and tells again.
    constexpr int kMostRuns = 5;
    constexpr double kStep = 10, kMargin = 0.3, kUsualPower = 0.75, kTightest = 1e-12;
    double loose = kStep * multibody::accuracy_for(r_.choice.error);
    double tight = loose / kStep;
    Trajectory before = multibody(loose);
    add_multibody(loose, before);
    double left = 0;  // error of the tighter run, of what is allowed
    for (int runs = 2;; ++runs) {
      r_.multibody = multibody(tight);
      add_multibody(tight, *r_.multibody);
      const double change = change_of(before, *r_.multibody);
      left = change / (std::pow(loose / tight, kUsualPower) - 1);
      if (left <= kMargin || runs == kMostRuns || tight <= kTightest) break;
      const double next = tight * std::pow(kMargin / left, 1 / kUsualPower);
      loose = tight;
      tight = std::clamp(next, std::max(kTightest, tight * 1e-4), tight / kStep);
      before = std::move(*r_.multibody);
    }
    r_.multibody_choice = fmt::format(
        "{}, accuracy {:.2g}: by what a looser run changes its error is {:.1e} of what is allowed",
        name, tight, left);
  }

  // Of what is allowed; without the analytic model of the wanted error.
  double change_of(const Trajectory& a, const Trajectory& b) const {
    const auto peaks = peaks_of(b.table.results);
    double change = 0;
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      if (row < r_.growth.size() && r_.allowed(row) > kNothingToJudge) break;
      const double allowed = row < r_.growth.size() ? r_.allowed(row) : r_.choice.error;
      keep_worst(change, largest_difference(a, b, peaks, row) / allowed);
    }
    return change;
  }

  void add_multibody(double accuracy, const Trajectory& run) {
    add_effort(Model::multibody, accuracy, run,
               r_.analytic ? apart(*r_.analytic, run) : not_computed());
  }

  void add_effort(Model model, double asked, const Trajectory& run, double error) {
    r_.effort.push_back(
        {model,
         model == Model::analytic
             ? "extrapolation"
             : multibody::integrator_names()[static_cast<std::size_t>(r_.choice.integrator)],
         asked, error, run.record.seconds, run.record.steps, run.record.evaluations});
  }

  void compare() {
    const Trajectory& a = *r_.analytic;
    const Trajectory& m = *r_.multibody;
    const Trajectory turned = at_angles_of(m);
    std::map<std::string, GroupDifference> groups;
    const std::size_t judged = judged_rows();
    double fastest = 0;
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      r_.difference.push_back(largest_difference(a, m, peaks_, row));
      fastest = std::max(fastest, std::abs(a.table.state(row, 3)));
      if (row >= judged) continue;
      for_each_difference(a, m, peaks_, row, [&](const Channel& channel, double share) {
        GroupDifference& group = groups[channel.group];
        group.group = channel.group;
        group.unit = channel.unit;
        group.peak = peaks_.at(channel.group);
        if (std::isnan(share) || share > group.in_time) {
          group.in_time = share;
          group.time_s = a.table.state(row, 0);
        }
        keep_worst(group.of_allowed, share / r_.allowed(row));
      });
      for_each_difference(turned, m, peaks_, row, [&](const Channel& channel, double share) {
        keep_worst(groups[channel.group].over_angle, share);
      });
      keep_worst(r_.speed_difference, a.table.state(row, 3) - m.table.state(row, 3));
      keep_worst(r_.lag_difference, a.lag[row] - m.lag[row]);
    }
    if (fastest > 0) r_.speed_difference /= fastest;
    for (const auto& [name, group] : groups) r_.groups.push_back(group);
    std::sort(r_.groups.begin(), r_.groups.end(),
              [](const auto& x, const auto& y) { return x.of_allowed > y.of_allowed; });
    match_events();
  }

  // The analytic trajectory at the moments when its shaft is where Simbody's is at the rows.
  Trajectory at_angles_of(const Trajectory& m) const {
    const Trajectory& a = *r_.analytic;
    analytic::SimulationOptions options;
    options.error = std::min(kAnalyticError, kAnalyticShare * r_.choice.error);
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      const double speed = 6 * a.table.state(row, 3);  // deg/s
      const double late =
          speed != 0 ? (m.table.state(row, 1) - a.table.state(row, 1)) / speed : 0.0;
      const double time = a.table.state(row, 0);
      const double spacing = r_.ready.the_case.drive->duration / r_.ready.the_case.drive->samples;
      const double earliest = options.times.empty() ? 0.0 : options.times.back();
      options.times.push_back(
          std::max(earliest, std::abs(late) < spacing / 4 ? time + late : time));
    }
    return analytic(options, "analytic, over the angle");
  }

  void match_events() {
    const std::vector<ToothEvent>* lists[] = {&r_.analytic->record.events,
                                              &r_.multibody->record.events};
    std::vector<const ToothEvent*> touches[2];
    EventMatch& match = r_.events;
    for (int model = 0; model < 2; ++model) {
      for (const ToothEvent& event : *lists[model])
        if (event.touch && event.time_s <= r_.judged_until_s) {
          touches[model].push_back(&event);
          match.mean_impulse[model] += event.impulse;
          match.largest_impulse[model] = std::max(match.largest_impulse[model], event.impulse);
        }
      match.touches[model] = touches[model].size();
      if (match.touches[model] > 0)
        match.mean_impulse[model] /= static_cast<double>(match.touches[model]);
    }
    // In order of time; a touch belongs to the one of the same flank that is next in time.
    for (std::size_t i = 0, j = 0; i < touches[0].size() && j < touches[1].size();) {
      const ToothEvent& a = *touches[0][i];
      const ToothEvent& m = *touches[1][j];
      const double apart = m.time_s - a.time_s;
      const auto nearer = [&](const std::vector<const ToothEvent*>& list, std::size_t at,
                              const ToothEvent& to) {
        return at + 1 < list.size() && list[at + 1]->flank == to.flank &&
               std::abs(list[at + 1]->time_s - to.time_s) < std::abs(apart);
      };
      if (a.flank != m.flank || nearer(touches[0], i, m) || nearer(touches[1], j, a)) {
        ++(a.time_s < m.time_s ? i : j);
        continue;
      }
      ++match.matched;
      keep_worst(match.time_s, apart);
      if (match.largest_impulse[0] > 0)
        keep_worst(match.impulse, (m.impulse - a.impulse) / match.largest_impulse[0]);
      ++i;
      ++j;
    }
  }

  void check() {
    for (const auto& [model, run] :
         {std::pair{Model::analytic, &r_.analytic}, std::pair{Model::multibody, &r_.multibody}}) {
      if (!*run) continue;
      const Trajectory& t = **run;
      const TrajectoryRecord& record = t.record;
      // Where nothing moves there is no work: then that of the largest torque over 1e-6 rad.
      const ResultTable& table = t.table.results;
      constexpr double kLeastTurn = 1e-6;
      const double work =
          std::max({std::abs(record.work_of_loads), std::abs(record.work_of_drives),
                    std::abs(record.kinetic_energy_gained), kLeastTurn * table.peak("Td")});
      // Simbody's work is integrated with its motion, to the same error.
      const double tolerance = model == Model::analytic
                                   ? kAnalyticError
                                   : std::max(r_.choice.error, r_.choice.accuracy.value_or(0));
      r_.checks.push_back({to_string(model), "work less energy gained", "J",
                           record.worst_work_residual, 0, work, tolerance});
      const std::size_t balance = table.find("power_balance_W");
      double worst = 0, angle = 0, scale = 0;
      for (std::size_t row = 0; row < table.rows(); ++row) {
        const double value = std::abs(table.at(row, balance));
        if (std::isnan(value) || value > worst) {
          worst = value;
          angle = table.theta_deg[row];
        }
        // Of the torque at the faster body's speed; at rest at 1 rad/s, as in virtual work.
        const double speed = std::max({1.0, kRadPerSecondPerRpm * std::abs(t.table.state(row, 3)),
                                       kRadPerSecondPerRpm * std::abs(t.table.state(row, 4))});
        scale = std::max(scale, std::abs(table.at(row, table.find("Td_z1_Nm"))) * speed);
      }
      constexpr double kPowerTolerance = 1e-8;
      r_.checks.push_back({to_string(model), "power of all loads less the change of kinetic energy",
                           "W", worst, angle, std::max(scale, 1e-3), kPowerTolerance});
    }
  }

  SimulationResult& r_;
  const PartProgress& progress_of_;
  std::map<std::string, double> peaks_;
};

}  // namespace

const GroupDifference* SimulationResult::worst() const {
  return groups.empty() ? nullptr : &groups.front();
}

double SimulationResult::seconds_for(Model model, double error) const {
  // The slowest that is not good enough, the fastest that is.
  const Effort* poor = nullptr;
  const Effort* good = nullptr;
  for (const Effort& e : effort) {
    if (e.model != model || !(e.error > 0)) continue;
    if (e.error <= error && (good == nullptr || e.seconds < good->seconds)) good = &e;
    if (e.error > error && (poor == nullptr || e.error < poor->error)) poor = &e;
  }
  if (good == nullptr) return not_computed();
  if (poor == nullptr || poor->seconds >= good->seconds) return good->seconds;
  const double share = std::log(poor->error / error) / std::log(poor->error / good->error);
  return poor->seconds * std::pow(good->seconds / poor->seconds, share);
}

bool SimulationResult::agrees() const {
  const bool hold = std::all_of(checks.begin(), checks.end(),
                                [](const compare::Check& check) { return check.holds(); });
  if (choice.only) return hold;
  return hold && worst() != nullptr && worst()->of_allowed <= 1;
}

std::string SimulationResult::headline() const {
  if (choice.only)
    return fmt::format("{} s simulated by the {} model; work and power {}",
                       number_text(ready.the_case.drive->duration), to_string(*choice.only),
                       agrees() ? "balance" : "do not balance");
  if (worst() == nullptr)
    return "Nothing can be judged: from the start a disturbance of the wanted error changes the "
           "motion altogether";
  const GroupDifference& w = *worst();
  const std::string sensitive =
      judged_until_s < ready.the_case.drive->duration
          ? fmt::format(
                ". Later than {:.4g} s nothing is judged: disturbances grow {:.0e} times by the "
                "end",
                judged_until_s, growth.back())
          : fmt::format("; disturbances of the start grow {:.3g} times", growth.back());
  std::string text = fmt::format(
      "{}: largest difference {:.1e} of peak ({}, at {:.4g} s), {:.2g} of what is "
      "allowed ({:g} of peak, grown as disturbances grow){}",
      agrees() ? "Both models move alike" : "The models differ", w.in_time, w.group, w.time_s,
      w.of_allowed, choice.error, sensitive);
  for (const compare::Check& check : checks)
    if (!check.holds())
      text +=
          fmt::format("; {}: {} is {:.1e} of its scale", check.table, check.name, check.relative());
  return text;
}

SimulationResult simulate(ReadyCase ready, const SimulationChoice& choice,
                          const PartProgress& progress_of) {
  check_fits_memory(ready.the_case, drive_of(ready.the_case));
  SimulationResult result;
  result.ready = std::move(ready);
  result.choice = choice;
  Study(result, progress_of).run();
  return result;
}

}  // namespace bentaxis::study
