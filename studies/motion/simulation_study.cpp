#include "simulation_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/simulation.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/study/reporting.h"
#include "coupled_pump.h"
#include "differences.h"
#include "event_match.h"
#include "pressure_steps.h"

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
constexpr double kAnalyticShare = 0.01;  // of the wanted error
// A run longer than this is not repeated for the table of efforts.
constexpr double kCheap = 1.0;  // s

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
    add_checks(r_, pump_.has_value());
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
    scales_ = scales(run);
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
    for (const GroupDifference& g :
         group_differences(run, half, nullptr, scales_,
                           std::vector<double>(judged_rows(), kNothingToJudge), steps_))
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
    scales_ = scales(*r_.analytic);
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

  Scales scales(const Trajectory& run) const {
    return scales_of(r_.ready.the_case, run, r_.choice.error);
  }

  // In a row of two runs of nearly the same motion; nothing between steps of the pressure.
  double difference(const Trajectory& a, const Trajectory& b, const Scales& scales,
                    std::size_t row) const {
    return steps_.between(a, b, row, kNothingToJudge) ? 0 : largest_difference(a, b, scales, row);
  }

  void note_growth(const Trajectory& run, const Trajectory& disturbed) {
    double growth = 1;
    for (std::size_t row = 0; row < run.lag.size(); ++row) {
      update_max_abs(growth, difference(run, disturbed, scales_, row) / r_.disturbance);
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
      update_max_abs(largest, difference(a, b, scales_, row));
    return largest;
  }

  void run_analytic() {
    analytic::SimulationOptions options;
    options.error = std::min(kAnalyticError, kAnalyticShare * r_.choice.error);
    options.body_loads = true;
    r_.analytic = analytic(options, "analytic");
    options.body_loads = false;
    scales_ = scales(*r_.analytic);
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
    const Scales own = scales(b);
    const std::size_t judged = judged_rows();
    double change = 0;
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      if (!r_.growth.empty() && row >= judged) break;
      const double allowed = row < r_.growth.size() ? r_.allowed(row) : r_.choice.error;
      update_max_abs(change, difference(a, b, own, row) / allowed);
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
    r_.groups = group_differences(a, m, turned ? &*turned : nullptr, scales_, allowed, steps_);
    sort_groups(r_.groups);
    double fastest = 0;
    for (std::size_t row = 0; row < a.lag.size(); ++row) {
      const bool between = steps_.between(a, m, row, std::min(r_.allowed(row), kNothingToJudge));
      r_.difference.push_back(between ? not_computed() : largest_difference(a, m, scales_, row));
      fastest = std::max(fastest, std::abs(a.state(row, StateColumn::shaft_speed)));
      if (row >= allowed.size()) continue;
      r_.rows_at_steps += between ? 1 : 0;
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

  SimulationResult& r_;
  const PartProgress& progress_of_;
  const PressureSteps steps_{r_.ready.the_case.pressure, r_.ready.the_case.pump};
  Scales scales_;                    // of the run that is the measure
  std::optional<CoupledPump> pump_;  // with oil, or for a periodic motion
  double tolerance_ = 0;             // of its run
};

}  // namespace

void run_simulation(SimulationResult& result, const PartProgress& progress_of) {
  Study(result, progress_of).run();
}

}  // namespace bentaxis::study
