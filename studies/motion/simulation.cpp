#include "bentaxis/study/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "bentaxis/analytic/simulation.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/load_scale.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/reporting.h"
#include "coupled_pump.h"
#include "simulation_pieces.h"

namespace bentaxis::study {
namespace {

constexpr double kDisturbance = 1e-9;
// With oil: its integration is not that fine.
constexpr double kDisturbanceWithOil = 1e-5;
// Of the wanted error, what a step of an integration with oil may err by.
constexpr double kStepShare = 1e-3;
// Tolerances of two runs that tell the error, and what a change from one to the other is at least
// of the error of the tighter: of a method of order 2, whose error falls as the tolerance's power
// 2/3.
constexpr double kLooser = 10;
constexpr double kChangeOverError = 3.6;
constexpr double kIndependentShare = 1e-4;  // likewise, of the multibody model alone
constexpr double kSteadyShare = 1e-4;       // likewise, of a periodic motion: it is short
constexpr double kFinestStep = 1e-12;
// A disturbance of the wanted error that has grown to this of peak leaves nothing to be judged.
constexpr double kNothingToJudge = 0.1;
// The analytic model is cheap: it is integrated so much better that it is the truth beside Simbody.
constexpr double kAnalyticShare = 0.01;
constexpr double kAnalyticError = 1e-8;
constexpr double kOneTime = 1e-12;  // of the duration: times nearer than that are one
// A run longer than this is not repeated for the table of efforts.
constexpr double kCheap = 1.0;  // s
constexpr const char* kFlow = "l/min";

}  // namespace

Compared compared_column(const Column& column) {
  return {column.group, column.unit, column.unit != kFlow};
}

std::size_t judged_rows(const std::vector<double>& growth, double error, double disturbance) {
  std::size_t rows = 0;
  // Nor where the disturbance itself, which is larger with oil, has come to that: growth is then no
  // longer known.
  while (rows < growth.size() && error * growth[rows] <= kNothingToJudge &&
         growth[rows] * disturbance <= kNothingToJudge)
    ++rows;
  return rows;
}

EventMatch match_events(const std::vector<ToothEvent>& analytic,
                        const std::vector<ToothEvent>& multibody, double until_s) {
  const std::vector<ToothEvent>* lists[] = {&analytic, &multibody};
  std::vector<const ToothEvent*> touches[2];
  EventMatch match;
  for (int model = 0; model < 2; ++model) {
    for (const ToothEvent& event : *lists[model])
      if (event.touch && event.time_s <= until_s) {
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
    update_max_abs(match.time_s, apart);
    if (match.largest_impulse[0] > 0)
      update_max_abs(match.impulse, (m.impulse - a.impulse) / match.largest_impulse[0]);
    ++i;
    ++j;
  }
  return match;
}

namespace {

// use(what it is, value) of everything compared in a row.
template <class Use>
void for_each_tooth_value(const Trajectory& run, std::size_t row, const Use& use) {
  const TeethAction& action = run.teeth[row];
  double force[2] = {};
  for (std::size_t i = 0; i < action.pairs.size(); ++i)
    force[i / kPairsPerFlank] += action.pairs[i].force;
  use(Compared{"lag of the teeth", "rad", true}, action.lag);
  for (const double flank : force) use(Compared{"tooth force", "N", true}, flank);
}

template <class Use>
void for_each_value(const Trajectory& run, std::size_t row, const Use& use) {
  const ResultTable& table = run.table.results;
  for (std::size_t c = 0; c < table.columns(); ++c)
    if (table.channels[c].kind == ChannelKind::reaction && table.channels[c].of_pump)
      use(Compared{table.channels[c].group, table.channels[c].unit, true}, table.at(row, c));
  if (!run.teeth.empty()) for_each_tooth_value(run, row, use);
  if (!run.oil) return;
  for (std::size_t c = 0; c < run.oil->columns.size(); ++c)
    if (const Compared what = compared_column(run.oil->columns[c]); !what.group.empty())
      use(what, run.oil->value(row, c));
}

// Of vectors the peak is that of their length, as everywhere.
std::map<std::string, double> peaks_of(const Trajectory& run) {
  std::map<std::string, double> peaks;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    for_each_value(run, row, [&](const Compared& what, double value) {
      double& peak = peaks[what.group];
      peak = std::max(peak, std::abs(value));
    });
  for (auto& [group, peak] : peaks) peak = std::max(peak, run.table.results.peak(group));
  return peaks;
}

// Of the faster body at a row, rad/s.
double fastest_speed(const Trajectory& run, std::size_t row) {
  double speed = 0;
  for (const StateColumn body : {StateColumn::shaft_speed, StateColumn::block_speed})
    speed = std::max(speed, kRadPerSecondPerRpm * std::abs(run.state(row, body)));
  return speed;
}

// Largest loads of a run: those of the case under the pressures and at the speeds that it came to.
LoadScale loads_of(const Case& the_case, const Trajectory& run) {
  Samples samples;
  samples.pistons = the_case.pump.geometry.pistons;
  samples.ports = the_case.pressure.ports;
  const ResultTable& table = run.table.results;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    samples.omega = std::max(samples.omega, fastest_speed(run, row));
    for (std::size_t c = 0; c < table.columns(); ++c)
      if (table.channels[c].quantity == "p" && is_computed(table.at(row, c)))
        samples.chamber_pressure.push_back(table.at(row, c) * table.channels[c].unit_in_si);
  }
  return load_scale(the_case, samples);
}

// Of shaft, block and pistons at the largest speed of a run, J.
double kinetic_energy(const Case& the_case, const Trajectory& run) {
  const PumpParameters& pump = the_case.pump;
  double speed = 0;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    speed = std::max(speed, fastest_speed(run, row));
  const double pistons = pump.geometry.pistons * pump.piston.mass *
                         pump.geometry.joint_circle_radius * pump.geometry.joint_circle_radius;
  return 0.5 * (pump.shaft.axial_inertia + pump.block.axial_inertia + pistons) * speed * speed;
}

// What differences are held to: as compare::scale_of(). An angle of the teeth has the round-off of
// the bodies' angles.
std::map<std::string, double> scales_of(const Trajectory& run, const LoadScale& loads,
                                        double error) {
  std::map<std::string, double> scales = peaks_of(run);
  if (run.lag.empty()) return scales;
  const double bar = scales.count("p") > 0 ? scales.at("p") : 0;
  double flow = 0;
  for_each_value(run, 0, [&](const Compared& what, double) {
    if (what.unit == kFlow) flow = std::max(flow, scales.at(what.group));
  });
  for_each_value(run, 0, [&](const Compared& what, double) {
    double& scale = scales.at(what.group);
    if (what.unit == "rad")
      scale = std::max(scale, compare::kNoSignal / error);
    else if (what.unit == kFlow)
      scale = scale > 0 ? scale : flow;
    else
      scale = compare::scale_of(scale, what.unit == "N"     ? loads.force
                                       : what.unit == "Nm"  ? loads.moment
                                       : what.unit == "bar" ? bar
                                                            : 0);
  });
  return scales;
}

// use(what it is, difference) of everything compared in a row.
template <class Use>
void for_each_difference(const Trajectory& a, const Trajectory& b,
                         const std::map<std::string, double>& scales, std::size_t row,
                         const Use& use) {
  std::vector<double> others;
  for_each_value(b, row, [&](const Compared&, double value) { others.push_back(value); });
  std::size_t next = 0;
  for_each_value(a, row, [&](const Compared& what, double value) {
    const double other = next < others.size() ? others[next] : not_computed();
    ++next;
    use(what, compare::difference(value, other, scales.at(what.group)));
  });
}

// Over its scale; NaN where a value is missing.
double largest_difference(const Trajectory& a, const Trajectory& b,
                          const std::map<std::string, double>& scales, std::size_t row) {
  compare::Difference largest;
  for_each_difference(a, b, scales, row,
                      [&](const Compared& what, const compare::Difference& difference) {
                        if (what.judged) largest.keep_larger(difference);
                      });
  return largest.share();
}

}  // namespace

std::vector<GroupDifference> group_differences(const Trajectory& first, const Trajectory& second,
                                               const Trajectory* turned,
                                               const std::map<std::string, double>& scales,
                                               const std::vector<double>& allowed) {
  const std::map<std::string, double> peaks = peaks_of(first);
  struct Largest {
    GroupDifference group;
    compare::Difference in_time, over_angle;
  };
  std::map<std::string, Largest> groups;
  for (std::size_t row = 0; row < allowed.size(); ++row) {
    for_each_difference(first, second, scales, row,
                        [&](const Compared& what, const compare::Difference& difference) {
                          auto& [group, in_time, over_angle] = groups[what.group];
                          group.group = what.group;
                          group.unit = what.unit;
                          group.peak = peaks.at(what.group);
                          group.scale = scales.at(what.group);
                          group.judged = what.judged;
                          if (in_time.keep_larger(difference))
                            group.time_s = first.state(row, StateColumn::time);
                          if (what.judged)
                            update_max_abs(group.of_allowed, difference.share() / allowed[row]);
                        });
    if (turned == nullptr) continue;
    for_each_difference(*turned, second, scales, row,
                        [&](const Compared& what, const compare::Difference& difference) {
                          groups[what.group].over_angle.keep_larger(difference);
                        });
  }
  std::vector<GroupDifference> result;
  for (auto& [name, largest] : groups) {
    GroupDifference& group = result.emplace_back(std::move(largest.group));
    group.in_time = largest.in_time.share();
    group.over_angle = largest.over_angle.share();
    if (!group.judged) group.of_allowed = not_computed();
  }
  return result;
}

void sort_groups(std::vector<GroupDifference>& groups) {
  const auto key = [](const GroupDifference& g) {
    const double size = g.judged ? g.of_allowed : g.in_time;
    return std::tuple(g.judged, !is_computed(size), is_computed(size) ? size : 0);
  };
  std::sort(groups.begin(), groups.end(),
            [&](const auto& x, const auto& y) { return key(x) > key(y); });
}

namespace {

class Study {
 public:
  Study(SimulationResult& result, const PartProgress& progress_of)
      : r_(result), progress_of_(progress_of) {}

  void run() {
    if (r_.oil_follows || r_.choice.steady || r_.has_teeth() || r_.choice.unit) {
      pump_.emplace(r_.ready, r_.oil_follows);
      r_.choice.steady ? run_steady() : run_coupled();
    } else {
      if (r_.choice.only != Model::multibody) run_analytic();
      if (r_.choice.only != Model::analytic) run_multibody();
    }
    if (r_.analytic && r_.multibody) compare();
    check();
  }

 private:
  Trajectory analytic(const analytic::SimulationOptions& options, const std::string& part) const {
    return analytic::simulate(r_.ready.the_case, r_.ready.assumptions(Model::analytic),
                              r_.ready.pressure, options, progress_of_(part));
  }

  double tolerance() const { return std::max(kFinestStep, kStepShare * r_.choice.error); }

  // Both models to one tolerance: at which a looser run says that the error of the integration,
  // which they share, is below what is allowed. The analytic model costs little and finds it.
  void run_coupled() {
    const bool analytic = r_.choice.only != Model::multibody;
    const Model first = analytic ? Model::analytic : Model::multibody;
    const std::string wanted = r_.oil_follows ? "with oil" : "motion";
    double tolerance = this->tolerance();
    Trajectory run, loose, disturbed;
    r_.disturbance = kDisturbanceWithOil;
    // What is held against the run needs no balances, and the growth no finer steps where the
    // disturbance is far above their error.
    constexpr double kFarAbove = 1e3;
    const bool coarse = kFarAbove * kLooser * tolerance <= (1 + kOneTime) * r_.disturbance;
    const auto run_beside = [&](const CoupledPump& pump, const Progress& before,
                                const Progress& after) {
      coupled::Options options = options_for(kLooser * tolerance);
      options.balances = false;
      options.of_pump_alone = true;
      loose = follow(pump, first, options, before);
      options = options_for(coarse ? kLooser * tolerance : tolerance);
      options.balances = false;
      options.of_pump_alone = true;
      options.disturbance = r_.disturbance;
      disturbed = follow(pump, first, options, after);
    };
    if (r_.choice.unit) {
      run_beside(*pump_, part(first, "looser"), part(first, "sensitivity"));
      run = integrate(first, tolerance, part(first, wanted));
    } else {
      const CoupledPump other(r_.ready, r_.oil_follows);
      constexpr double kLooserRun = 0.6;  // of the time of both
      SlowestOf progress(2, part(first, wanted));
      numerics::parallel_for(2, 2, [&](std::size_t job) {
        if (job == 0)
          run = integrate(first, tolerance, progress.of(0));
        else
          run_beside(other, progress.of(1, 0, kLooserRun), progress.of(1, kLooserRun, 1));
      });
    }
    keep_scales(run);
    note_growth(coarse ? loose : run, disturbed);
    const auto error = [&] { return change_of(loose, run) / kChangeOverError; };
    while (error() > 1 && tolerance > kFinestStep) {
      tolerance = std::max(kFinestStep, tolerance / kLooser);
      loose = std::move(run);
      run = integrate(first, tolerance, part(first, "tighter"));
    }
    r_.integration_change = apart(run, loose);
    r_.checks.push_back(
        {to_string(first),
         "integration error over the tolerance: from a run with another integrator tolerance", "",
         error(), 0, 1, 1});
    add_effort(first, kLooser * tolerance, loose, r_.integration_change);
    add_effort(first, tolerance, run, r_.integration_change / kChangeOverError);
    tolerance_ = tolerance;
    if (r_.choice.unit) note_coupling(first, run);
    if (!analytic) {
      r_.multibody = std::move(run);
      return;
    }
    r_.analytic = std::move(run);
    if (r_.choice.only == Model::analytic) return;
    r_.multibody = integrate(Model::multibody, tolerance, part(Model::multibody, wanted));
    add_effort(Model::multibody, tolerance, *r_.multibody, apart(*r_.analytic, *r_.multibody));
    r_.multibody_choice = fmt::format(
        "Simbody's accelerations at every state, integrated as the analytic model's, "
        "{:g} per step",
        tolerance);
  }

  Progress part(Model model, const std::string& name) const {
    return progress_of_(to_string(model) + ", " + name);
  }

  Trajectory integrate(Model model, double tolerance, const Progress& progress) const {
    std::shared_ptr<UnitRecord>& record = r_.exchanged[static_cast<int>(model)];
    if (r_.choice.unit) record = std::make_shared<UnitRecord>();
    coupled::Options options = options_for(tolerance, 1, record);
    options.body_loads = true;
    return follow(*pump_, model, options, progress);
  }

  // The instances of a unit go with the run that they were for.
  Trajectory follow(const CoupledPump& pump, Model model, const coupled::Options& options,
                    const Progress& progress) const {
    Trajectory run = pump.simulate(model, options, progress);
    if (r_.choice.unit) r_.choice.unit->end_instances();
    return run;
  }

  // Each run with a unit has an instance of its own.
  coupled::Options options_for(double tolerance, int parts = 1,
                               std::shared_ptr<UnitRecord> record = nullptr) const {
    coupled::Options options;
    options.tolerance = tolerance;
    if (r_.choice.unit) options.exchange = r_.choice.unit->exchange(parts, std::move(record));
    return options;
  }

  // What exchanging values at points alone has changed: from a run with points between them.
  void note_coupling(Model model, const Trajectory& run) {
    const coupled::Options options = options_for(tolerance_, 2);
    const Trajectory half =
        follow(*pump_, model, options, part(model, "half the communication step"));
    for (const GroupDifference& g : group_differences(
             run, half, nullptr, scales_, std::vector<double>(judged_rows(), r_.choice.error)))
      r_.coupling.push_back({g.group, g.unit, g.peak, g.in_time, g.time_s});
    std::sort(r_.coupling.begin(), r_.coupling.end(), [](const auto& x, const auto& y) {
      return !is_computed(x.change) ? is_computed(y.change) : x.change > y.change;
    });
  }

  void run_steady() {
    coupled::Options options;
    options.tolerance = std::max(kFinestStep, kSteadyShare * r_.choice.error);
    options.body_loads = true;
    const auto find = [&](Model model) {
      if (r_.choice.only && *r_.choice.only != model) return std::optional<Trajectory>();
      coupled::SteadyMotion found =
          pump_->steady(model, options, progress_of_(to_string(model) + ", periodic motion"));
      r_.periodic[static_cast<int>(model)] = PeriodicMotion{
          found.period_s, found.speed, found.iterations, found.error, std::move(found.multipliers)};
      return std::optional(std::move(found.turn));
    };
    r_.analytic = find(Model::analytic);
    r_.multibody = find(Model::multibody);
    if (!r_.analytic) return;
    keep_scales(*r_.analytic);
    if (r_.multibody) compare_periods();
    // Nothing grows: both are where the motion returns to.
    r_.growth.assign(r_.analytic->lag.size(), 1.0);
    r_.judged_until_s = r_.analytic->state(r_.growth.size() - 1, StateColumn::time);
  }

  // Rows are at equal shares of either period: the periods themselves must agree too.
  void compare_periods() {
    const PeriodicMotion& a = *r_.periodic[0];
    const PeriodicMotion& m = *r_.periodic[1];
    const auto add = [&](const char* name, const char* unit, double difference, double scale,
                         double tolerance) {
      r_.checks.push_back({"both", name, unit, std::abs(difference), 0, scale, tolerance});
    };
    add("period of an N-th of a turn, difference of the models", "s", m.period_s - a.period_s,
        a.period_s, r_.choice.error);
    // Multipliers are differences of motions: of some digits less.
    constexpr double kOfMultiplier = 1e-3;
    if (!a.multipliers.empty() && a.multipliers.size() == m.multipliers.size())
      add("largest Floquet multiplier, difference of its magnitude", "",
          std::abs(m.multipliers[0]) - std::abs(a.multipliers[0]), 1, kOfMultiplier);
  }

  void keep_scales(const Trajectory& run) {
    scales_ = scales_of(run, loads_of(r_.ready.the_case, run), r_.choice.error);
  }

  void note_growth(const Trajectory& run, const Trajectory& disturbed) {
    double growth = 1;
    for (std::size_t row = 0; row < run.lag.size(); ++row) {
      update_max_abs(growth, largest_difference(run, disturbed, scales_, row) / r_.disturbance);
      r_.growth.push_back(growth);
    }
    const std::size_t judged = judged_rows();
    r_.judged_until_s = judged == 0 ? 0 : run.state(judged - 1, StateColumn::time);
  }

  std::size_t judged_rows() const {
    return study::judged_rows(r_.growth, r_.choice.error, r_.disturbance);
  }

  // Largest difference of any reaction in what is judged.
  double apart(const Trajectory& a, const Trajectory& b) const {
    double largest = 0;
    for (std::size_t row = 0; row < judged_rows(); ++row)
      update_max_abs(largest, largest_difference(a, b, scales_, row));
    return largest;
  }

  void run_analytic() {
    analytic::SimulationOptions options;
    options.error = std::min(kAnalyticError, kAnalyticShare * r_.choice.error);
    options.body_loads = true;
    r_.analytic = analytic(options, "analytic");
    options.body_loads = false;
    keep_scales(*r_.analytic);
    analytic::SimulationOptions disturbed = options;
    r_.disturbance = disturbed.disturbance = kDisturbance;
    note_growth(*r_.analytic, analytic(disturbed, "sensitivity"));
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

  static std::string multibody_part(double accuracy) {
    return fmt::format("multibody, accuracy {:g}", accuracy);
  }

  Trajectory multibody(double accuracy, const Progress& progress) const {
    if (independent()) {
      coupled::Options options;
      options.tolerance = accuracy;
      options.body_loads = true;
      return CoupledPump(r_.ready, false).simulate(Model::multibody, options, progress);
    }
    SimulationOptions options;
    options.error = r_.choice.error;
    options.accuracy = accuracy;
    options.body_loads = true;
    multibody::SimulationMethod method;
    method.integrator = r_.choice.integrator;
    return multibody::simulate(r_.ready.the_case, r_.ready.assumptions(Model::multibody),
                               r_.ready.pressure, options, progress, method);
  }

  bool independent() const {
    return coordinates_of(r_.choice, r_.ready.the_case) == Coordinates::independent;
  }

  void run_multibody() {
    const std::string name = method_of(Model::multibody);
    if (r_.choice.accuracy) {
      const double accuracy = *r_.choice.accuracy;
      r_.multibody = multibody(accuracy, progress_of_(multibody_part(accuracy)));
      r_.multibody_choice = fmt::format("{}, accuracy {:g} as asked", name, *r_.choice.accuracy);
      add_multibody(*r_.choice.accuracy, *r_.multibody);
      return;
    }
    // Two runs, ten times apart in accuracy, tell how the error falls; where it is not small enough
    // yet a third goes to the accuracy at which it should be, and tells again.
    constexpr int kMaxRuns = 5;
    constexpr double kStep = 10, kMargin = 0.3, kUsualPower = 0.75, kTightest = 1e-12;
    double tight = independent() ? std::max(kTightest, kIndependentShare * r_.choice.error)
                                 : multibody::accuracy_for(r_.choice.error);
    double loose = kStep * tight;
    Trajectory before;
    SlowestOf progress(2, progress_of_(multibody_part(tight)));
    numerics::parallel_for(2, 2, [&](std::size_t job) {
      if (job == 0)
        r_.multibody = multibody(tight, progress.of(0));
      else
        before = multibody(loose, progress.of(1));
    });
    add_multibody(loose, before);
    double left = 0;  // error of the tighter run, of what is allowed
    for (int runs = 2;; ++runs) {
      if (runs > 2) r_.multibody = multibody(tight, progress_of_(multibody_part(tight)));
      add_multibody(tight, *r_.multibody);
      const double change = change_of(before, *r_.multibody);
      left = change / (std::pow(loose / tight, kUsualPower) - 1);
      if (left <= kMargin || runs == kMaxRuns || tight <= kTightest) break;
      const double next = tight * std::pow(kMargin / left, 1 / kUsualPower);
      loose = tight;
      tight = std::clamp(next, std::max(kTightest, tight * 1e-4), tight / kStep);
      before = std::move(*r_.multibody);
    }
    r_.multibody_choice = fmt::format(
        "{}, accuracy {:.2g}: integration error, estimated from a run with looser accuracy, {:.1e} "
        "of the tolerance",
        name, tight, left);
  }

  // Of what is allowed; without the analytic model of the wanted error.
  double change_of(const Trajectory& a, const Trajectory& b) const {
    const auto scales = scales_of(b, loads_of(r_.ready.the_case, b), r_.choice.error);
    const std::size_t judged = judged_rows();
    double change = 0;
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      if (!r_.growth.empty() && row >= judged) break;
      const double allowed = row < r_.growth.size() ? r_.allowed(row) : r_.choice.error;
      update_max_abs(change, largest_difference(a, b, scales, row) / allowed);
    }
    return change;
  }

  void add_multibody(double accuracy, const Trajectory& run) {
    add_effort(Model::multibody, accuracy, run,
               r_.analytic ? apart(*r_.analytic, run) : not_computed());
  }

  std::string method_of(Model model) const {
    if (pump_) return "BDF";
    if (model == Model::analytic) return "extrapolation";
    if (independent()) return "BDF, independent coordinates";
    return multibody::integrator_names()[static_cast<std::size_t>(r_.choice.integrator)];
  }

  void add_effort(Model model, double asked, const Trajectory& run, double error) {
    r_.effort.push_back({model, method_of(model), asked, error, run.record.seconds,
                         run.record.steps, run.record.evaluations});
  }

  void compare() {
    const Trajectory& a = *r_.analytic;
    const Trajectory& m = *r_.multibody;
    // Rows of a periodic motion are at equal shares of its period.
    const std::optional<Trajectory> turned =
        r_.choice.steady ? std::nullopt : std::optional(at_angles_of(m));
    std::vector<double> allowed;
    for (std::size_t row = 0; row < judged_rows(); ++row) allowed.push_back(r_.allowed(row));
    r_.groups = group_differences(a, m, turned ? &*turned : nullptr, scales_, allowed);
    sort_groups(r_.groups);
    double fastest = 0;
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      r_.difference.push_back(largest_difference(a, m, scales_, row));
      fastest = std::max(fastest, std::abs(a.state(row, StateColumn::shaft_speed)));
      if (row >= allowed.size()) continue;
      update_max_abs(r_.speed_difference, a.state(row, StateColumn::shaft_speed) -
                                              m.state(row, StateColumn::shaft_speed));
      update_max_abs(r_.lag_difference, a.lag[row] - m.lag[row]);
    }
    if (fastest > 0) r_.speed_difference /= fastest;
    r_.events = match_events(a.record.events, m.record.events, r_.judged_until_s);
  }

  // The analytic trajectory at the moments when its shaft is where Simbody's is at the rows.
  Trajectory at_angles_of(const Trajectory& m) const {
    const Trajectory& a = *r_.analytic;
    analytic::SimulationOptions options;
    options.error = std::min(kAnalyticError, kAnalyticShare * r_.choice.error);
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      const double speed = 6 * a.state(row, StateColumn::shaft_speed);  // deg/s
      const double late =
          speed != 0 ? (m.state(row, StateColumn::theta) - a.state(row, StateColumn::theta)) / speed
                     : 0.0;
      const double time = a.state(row, StateColumn::time);
      const double spacing = r_.ready.the_case.drive->duration / r_.ready.the_case.drive->samples;
      const double earliest = options.times.empty() ? 0.0 : options.times.back();
      options.times.push_back(
          std::max(earliest, std::abs(late) < spacing / 4 ? time + late : time));
    }
    if (!pump_) return analytic(options, "analytic, over the angle");
    coupled::Options with_oil = options_for(tolerance_);
    with_oil.times = options.times;
    with_oil.balances = false;
    with_oil.of_pump_alone = true;
    return follow(*pump_, Model::analytic, with_oil, part(Model::analytic, "over the angle"));
  }

  void check() {
    for (const auto& [model, run] :
         {std::pair{Model::analytic, &r_.analytic}, std::pair{Model::multibody, &r_.multibody}}) {
      if (!*run) continue;
      const Trajectory& t = **run;
      const TrajectoryRecord& record = t.record;
      // Where nothing moves there is no work: then that of the largest torque over 1e-6 rad. Loads
      // that cancel leave the round-off of theirs.
      const LoadScale loads = loads_of(r_.ready.the_case, t);
      const ResultTable& table = t.table.results;
      constexpr double kMinTurn = 1e-6;
      constexpr double kMinWork = 1e-12;  // J: nor is there a torque
      // A speed that is off by some share of itself leaves twice that share of the kinetic energy.
      const double kinetic = kinetic_energy(r_.ready.the_case, t);
      const double work =
          std::max({kinetic, std::abs(record.work_of_loads), std::abs(record.work_of_drives),
                    std::abs(record.kinetic_energy_gained),
                    kMinTurn * std::max(table.peak("Td"), loads.moment), kMinWork});
      // Simbody's work is integrated with its motion, to the same error.
      const double tolerance = model == Model::analytic && !pump_
                                   ? kAnalyticError
                                   : std::max(r_.choice.error, r_.choice.accuracy.value_or(0));
      r_.checks.push_back({to_string(model), "work less change of energy", "J",
                           record.worst_work_residual, 0, work, tolerance});
      constexpr double kPowerTolerance = 1e-8;
      const std::size_t balance = table.find("power_balance_W");
      double worst = 0, angle = 0, scale = 0;
      for (std::size_t row = 0; row < table.rows(); ++row) {
        const double value = std::abs(table.at(row, balance));
        if (std::isnan(value) || value > worst) {
          worst = value;
          angle = table.theta_deg[row];
        }
        // Of the torque, at the faster body's speed; at rest at 1 rad/s, as in virtual work. At
        // least what a comparison holds the same power to: its tolerance of the loads.
        const double speed = std::max(1.0, fastest_speed(t, row));
        const double torque = std::max(std::abs(table.at(row, table.find("Td_z1_Nm"))),
                                       kDrivenTolerance / kPowerTolerance * loads.moment);
        scale = std::max(scale, torque * speed);
      }
      r_.checks.push_back({to_string(model), "power of all loads less the change of kinetic energy",
                           "W", worst, angle, std::max(scale, 1e-3), kPowerTolerance});
      if (t.oil) check_oil(to_string(model), t, work);
    }
  }

  // Held to the error that the integration was asked for.
  void check_oil(const std::string& model, const Trajectory& t, double work) {
    const OilHistory& oil = *t.oil;
    constexpr double kMinEnergy = 1e-6;  // J: where nothing moves
    double passed = std::max(work, kMinEnergy);
    for (const OilEnergy& energy : oil.energies) passed = std::max(passed, std::abs(energy.energy));
    const double mass = std::max(mass_passed(t), 1e-9);
    const double tolerance = r_.choice.error;
    const auto add = [&](const char* name, const char* unit, double worst, double scale) {
      r_.checks.push_back({model, name, unit, worst, 0, scale, tolerance});
    };
    add("energy of the oil: sources less what is delivered, lost and stored", "J",
        oil.worst_energy_residual, passed);
    add("mass of the oil: in less out and stored", "kg", oil.worst_mass_residual, mass);
    add("work of the pressures on the pistons and of the pistons on the oil", "J",
        oil.worst_exchange_residual, passed);
  }

  SimulationResult& r_;
  const PartProgress& progress_of_;
  std::map<std::string, double> scales_;  // by group, of the run that is the measure
  std::optional<CoupledPump> pump_;       // with oil, or for a periodic motion
  double tolerance_ = 0;                  // of its run
};

// What changes in time leaves no motion that repeats itself.
void refuse_course(const Case& the_case) {
  const auto refuse = [&](const char* key, const std::filesystem::path& file) {
    throw InputError(fmt::format(
        "{}{} = \"{}\": must be left out for a periodic motion (--steady): it changes in time",
        the_case.file.empty() ? "" : the_case.file.string() + ": ", key, file.generic_string()));
  };
  const DriveSpec& drive = *the_case.drive;
  if (drive.kind != DriveKind::motor && !drive.curve.time.empty())
    refuse("[drive] file", drive.curve.file);
  if (the_case.hydraulics && the_case.hydraulics->load &&
      !the_case.hydraulics->load->share.time.empty())
    refuse("[load] file", the_case.hydraulics->load->share.file);
}

// The check that is furthest beyond its tolerance; "" where all hold.
std::string failed_check_text(const SimulationResult& r) {
  const compare::Check* const check = compare::failed_check(r.checks);
  if (check == nullptr) return "";
  return fmt::format("A check fails: {}: {} is {:.1e} of its scale, {:g} allowed", check->table,
                     check->name, check->relative(), check->tolerance);
}

std::string periodic_headline(const SimulationResult& r) {
  const auto of = [&](Model model) -> const std::optional<PeriodicMotion>& {
    return r.periodic[static_cast<int>(model)];
  };
  const PeriodicMotion& motion = of(Model::analytic) ? *of(Model::analytic) : *of(Model::multibody);
  const std::string about =
      fmt::format("{:.6g} rpm, {}", motion.speed / kRadPerSecondPerRpm,
                  motion.multipliers.empty()
                      ? "without states that could be disturbed"
                      : fmt::format("{}: a disturbance is multiplied by {:.3g} per N-th of a turn",
                                    motion.stable() ? "stable" : "unstable",
                                    std::abs(motion.multipliers.front())));
  if (r.choice.only)
    return fmt::format("periodic motion of the {} model found: {}", to_string(*r.choice.only),
                       about);
  const GroupDifference& w = *r.worst();
  if (w.of_allowed <= 1 && !r.agrees()) return failed_check_text(r) + "; " + about;
  return fmt::format(
      "{}: largest difference {:.1e} of peak ({}), {:g} allowed; {}",
      r.agrees() ? "Both models find the same periodic motion" : "The periodic motions differ",
      w.in_time, w.group, r.choice.error, about);
}

}  // namespace

bool PeriodicMotion::stable() const {
  return multipliers.empty() || std::abs(multipliers.front()) < 1;
}

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
  if (!choice.only && worst() != nullptr && !is_computed(worst()->in_time))
    return fmt::format(
        "The models cannot be compared: at {:.4g} s a value of {} is missing or not "
        "finite",
        worst()->time_s, worst()->group);
  if (choice.steady && (choice.only || worst() != nullptr)) return periodic_headline(*this);
  if (choice.only)
    return fmt::format("{} s simulated by the {} model; work and power {}",
                       number_text(ready.the_case.drive->duration), to_string(*choice.only),
                       agrees() ? "balance" : "do not balance. " + failed_check_text(*this));
  if (worst() == nullptr)
    return "The models cannot be compared: a disturbance of the size of the wanted error changes "
           "the motion completely from the start";
  const GroupDifference& w = *worst();
  const std::string sensitive =
      judged_until_s < (1 - kOneTime) * ready.the_case.drive->duration
          ? fmt::format(
                ". Results after {:.4g} s are not compared: disturbances are amplified {:.0e} "
                "times by the end",
                judged_until_s, growth.back())
          : fmt::format("; disturbances of the initial state are amplified {:.3g} times",
                        growth.back());
  const bool check_fails = w.of_allowed <= 1 && !agrees();
  std::string text = fmt::format(
      "{}: largest difference {:.1e} of peak ({}, at {:.4g} s), {:.2g} of the tolerance ({:g} of "
      "peak times the measured amplification of disturbances){}",
      check_fails ? failed_check_text(*this) + ". The motions agree"
      : agrees()  ? "The trajectories agree"
                  : "The models differ",
      w.in_time, w.group, w.time_s, w.of_allowed, choice.error, sensitive);
  if (!agrees() && !check_fails && compare::failed_check(checks) != nullptr)
    text += ". " + failed_check_text(*this);
  return text;
}

const std::vector<std::string>& coordinates_names() {
  static const std::vector<std::string> names = {"constraints", "independent"};
  return names;
}

Coordinates coordinates_of(const SimulationChoice& choice, const Case& the_case) {
  if (choice.coordinates) return *choice.coordinates;
  const bool of_simbody = choice.accuracy || choice.integrator != SimulationChoice{}.integrator;
  return of_simbody || friction_jumps(the_case) ? Coordinates::constraints
                                                : Coordinates::independent;
}

PreparedCase prepare_simulation(Case the_case, const SimulationChoice& choice,
                                const PartProgress& progress_of) {
  if (choice.unit) the_case = choice.unit->driven();
  drive_of(the_case);
  const bool hydraulic = the_case.pressure.kind == PressureKind::hydraulic;
  if (!hydraulic && choice.oil == OilInTime::periodic)
    throw InputError("--oil periodic has no effect: the pressure of the case is not \"hydraulic\"");
  if (choice.steady) {
    if (choice.unit)
      throw InputError(
          "--steady: not possible with --fmu, because an FMU need not be periodic; simulate from "
          "the start");
    refuse_course(the_case);
    if (the_case.pump.gear.contact == ToothContact::teeth)
      throw InputError(
          "--steady: with [gear] contact = \"teeth\" the period is at least one turn, but --steady "
          "searches for a period of an N-th of a turn: simulate from the start");
    const Transfer& transfer = the_case.pump.transfer;
    if (transfer.is_uneven_joint() || transfer.has_own_clearances())
      throw InputError("--steady: with [transfer] " +
                       (transfer.has_own_clearances()
                            ? std::string("clearance_deviation_file")
                            : "kind = \"" + to_string(transfer.kind) + "\"") +
                       " the motion does not repeat after an N-th of a turn, a period for which "
                       "--steady searches: simulate from the start");
    // From rest the search would have no period to begin with: it begins at the speed of
    // [operation].
    if (the_case.drive->start_speed == 0.0) the_case.drive->start_speed.reset();
  }
  if (!hydraulic || choice.oil == OilInTime::periodic)
    return prepare(std::move(the_case), progress_of);
  if (hydraulics::needs_periodic_state(the_case))
    return prepare_start(std::move(the_case), progress_of);
  PreparedCase ready;
  ready.the_case = std::move(the_case);
  return ready;
}

SimulationResult simulate(PreparedCase ready, const SimulationChoice& choice,
                          const PartProgress& progress_of) {
  require_memory(ready.the_case, drive_of(ready.the_case), choice.only ? 1 : 2);
  SimulationResult result;
  result.ready = std::move(ready);
  result.choice = choice;
  result.oil_follows = result.ready.the_case.pressure.kind == PressureKind::hydraulic &&
                       choice.oil == OilInTime::follows;
  Study(result, progress_of).run();
  return result;
}

}  // namespace bentaxis::study
