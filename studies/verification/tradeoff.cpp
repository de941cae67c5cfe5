#include "bentaxis/study/tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/stopwatch.h"
#include "bentaxis/study/calibration.h"

namespace bentaxis::study {
namespace {

// A run is repeated as long as that takes no longer than this, s.
constexpr double kRepeatFor = 0.3;

// Time of a job too short to be timed once: the best of three stretches of at least 20 ms.
double time_of(const std::function<void()>& job) {
  double best = std::numeric_limits<double>::infinity();
  for (int stretch = 0; stretch < 3; ++stretch) {
    long repeats = 0;
    const Stopwatch stopwatch;
    do {
      job();
      ++repeats;
    } while (stopwatch.seconds() < 0.02);
    best = std::min(best, stopwatch.seconds() / static_cast<double>(repeats));
  }
  return best;
}

// The right curves: the closed form in extended precision.
ResultTable right_curves(const analytic::Model& model, const Samples& samples) {
  std::vector<long double> wide(model.layout().size());
  return tabulate(
      "analytic", model.layout(), samples, [&](const Instant& instant, std::vector<double>& row) {
        model.reactions(instant, wide);
        for (std::size_t c = 0; c < model.layout().reactions(); ++c)
          row[c] = is_computed(static_cast<double>(wide[c])) ? static_cast<double>(wide[c])
                                                             : not_computed();
      });
}

// Everything that is done on one turn of one case.
class Measurement {
 public:
  Measurement(const Case& the_case, const std::string& pressure_name,
              const TradeoffOptions& options, const Progress& progress)
      : case_(the_case),
        pressure_name_(pressure_name),
        options_(options),
        progress_(progress),
        assumptions_(the_case.multibody),
        pressure_(the_case.pressure),
        samples_(sample_case(the_case, pressure_, 1, the_case.operation.speed_rpm < 0)),
        model_(the_case.pump, assumptions_),
        reference_(right_curves(model_, samples_)),
        jobs_(2 + multibody::scene_names().size() * multibody::method_names().size() +
              options.integrators.size() * options.accuracies.size()) {}

  std::vector<TradeoffRun> all() {
    scalar();
    for (const auto set : analytic::available_instruction_sets()) batch(set);
    done_ = 2;
    for (std::size_t m = 0; m < multibody::method_names().size(); ++m)
      for (std::size_t s = 0; s < multibody::scene_names().size(); ++s)
        driven(static_cast<multibody::Scene>(s), static_cast<multibody::Method>(m));
    for (const auto integrator : options_.integrators) integrate(integrator);
    if (progress_) progress_(1);
    return std::move(runs_);
  }

 private:
  TradeoffRun& add(const char* model, const char* method, const std::string& variant) {
    runs_.push_back({pressure_name_, model, method, variant, {}, {}, 0, {}, {}});
    return runs_.back();
  }

  // Reports progress within the job at hand.
  void report(double fraction) const {
    if (progress_) progress_((done_ + fraction) / static_cast<double>(jobs_) * 0.999);
  }

  void judge(TradeoffRun& run, const ResultTable& table,
             multibody::Scene scene = multibody::Scene::full) const {
    run.error = achieved_error(case_, samples_, reference_, table, scene);
  }

  void scalar() {
    TradeoffRun& run = add("analytic", "scalar", "");
    std::vector<Instant> instants(samples_.theta_deg.size());
    for (std::size_t i = 0; i < instants.size(); ++i) samples_.instant(i, instants[i]);
    std::vector<double> values(model_.layout().size());
    run.seconds_per_turn = time_of([&] {
      for (const Instant& instant : instants) model_.reactions(instant, values);
    });
    judge(run, tabulate("analytic", model_.layout(), samples_,
                        [&](const Instant& instant, std::vector<double>& row) {
                          model_.reactions(instant, row);
                        }));
  }

  void batch(analytic::InstructionSet set) {
    TradeoffRun& run = add("analytic", "batch", analytic::to_string(set));
    const std::size_t rows = samples_.theta_deg.size();
    std::vector<double> theta(rows);
    std::vector<std::vector<double>> pressure(samples_.pistons, std::vector<double>(rows));
    Instant instant;
    for (std::size_t i = 0; i < rows; ++i) {
      samples_.instant(i, instant);
      theta[i] = instant.shaft.angle;
      for (int k = 0; k < samples_.pistons; ++k) pressure[k][i] = instant.chamber_pressure[k];
    }
    std::vector<analytic::Varying> chambers;
    for (const auto& column : pressure) chambers.push_back({column.data(), 0});
    analytic::BatchInstants instants;
    instants.count = rows;
    instants.theta.each = theta.data();
    instants.omega.all = samples_.omega;
    instants.chamber_pressure = chambers;
    instants.suction.all = samples_.ports.suction;
    instants.delivery.all = samples_.ports.delivery;
    const analytic::BatchModel model(case_.pump, assumptions_);
    analytic::BatchColumns columns(model.layout().reactions(), rows);
    const auto outputs = outputs_of(model.layout(), analytic::ChannelGroup::all, columns);
    run.seconds_per_turn = time_of([&] { model.reactions(instants, outputs, {set, 1}); });
    std::size_t next = 0;
    judge(run, tabulate("analytic", model.layout(), samples_,
                        [&](const Instant&, std::vector<double>& row) {
                          for (std::size_t c = 0; c < model.layout().reactions(); ++c)
                            row[c] = columns.column(c)[next];
                          ++next;
                        }));
  }

  void driven(multibody::Scene scene, multibody::Method method) {
    TradeoffRun& run = add("multibody", "driven",
                           multibody::scene_names()[static_cast<std::size_t>(scene)] + ", " +
                               multibody::method_names()[static_cast<std::size_t>(method)]);
    try {
      run.seconds_per_turn = std::numeric_limits<double>::infinity();
      for (int repeat = 0; repeat < 3; ++repeat) {
        const auto watch = [&](double fraction) { report(fraction / 3 + repeat / 3.0); };
        const ResultTable table =
            multibody::run_driven(case_, assumptions_, samples_, watch, scene, method);
        run.seconds_per_turn = std::min(run.seconds_per_turn, table.provenance.seconds);
        if (repeat == 0) judge(run, table, scene);
      }
    } catch (const ComputationError& error) {
      run.failure = error.what();
    }
    ++done_;
  }

  void integrate(multibody::Integrator integrator) {
    std::string given_up;
    for (const double accuracy : options_.accuracies) {
      TradeoffRun& run = add("multibody", "integrated", name_of(integrator));
      run.accuracy = accuracy;
      run.failure = given_up;
      if (given_up.empty() && !attempt(integrator, accuracy, run))
        given_up = fmt::format("not tried: accuracy {} took longer than {:g} s",
                               number_text(accuracy), options_.max_seconds_per_run);
      ++done_;
    }
  }

  // False where the run took too long.
  bool attempt(multibody::Integrator integrator, double accuracy, TradeoffRun& run) const {
    struct TooLong {
      double turn;
    };
    const Stopwatch stopwatch;
    const auto watch = [&](double fraction) {
      report(fraction);
      if (stopwatch.seconds() > options_.max_seconds_per_run && fraction < 1)
        throw TooLong{fraction};
    };
    try {
      // Short runs are timed more than once: the best counts.
      run.seconds_per_turn = std::numeric_limits<double>::infinity();
      for (int repeat = 0; repeat < 3 && stopwatch.seconds() < kRepeatFor; ++repeat) {
        const auto result = multibody::run_integrated(case_, assumptions_, samples_, pressure_,
                                                      {integrator, accuracy}, watch);
        run.seconds_per_turn = std::min(run.seconds_per_turn, result.record.seconds);
        run.record = result.record;
        if (repeat == 0) judge(run, result.table);
      }
    } catch (const ComputationError& error) {
      run.failure = error.what();
    } catch (const TooLong& stopped) {
      run.failure = fmt::format("stopped after {:.3g} s at {:.0f} % of the turn",
                                stopwatch.seconds(), 100 * stopped.turn);
      return false;
    }
    return stopwatch.seconds() <= options_.max_seconds_per_run;
  }

  const Case& case_;
  const std::string& pressure_name_;
  const TradeoffOptions& options_;
  const Progress& progress_;
  Assumptions assumptions_;
  PressureTrace pressure_;
  Samples samples_;
  analytic::Model model_;
  ResultTable reference_;
  std::size_t jobs_;
  double done_ = 0;
  std::vector<TradeoffRun> runs_;
};

}  // namespace

std::vector<TradeoffRun> measure_tradeoff(const Case& the_case, const std::string& pressure_name,
                                          const TradeoffOptions& options,
                                          const Progress& progress) {
  Case sampled = the_case;
  sampled.operation.samples_per_revolution = options.samples_per_revolution;
  return Measurement(sampled, pressure_name, options, progress).all();
}

std::vector<std::size_t> pareto_front(const std::vector<TradeoffRun>& runs,
                                      const std::function<bool(const TradeoffRun&)>& among) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].done() && among(runs[i])) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return runs[a].seconds_per_turn < runs[b].seconds_per_turn;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || runs[i].error.worst < runs[front.back()].error.worst) front.push_back(i);
  return front;
}

Order order_of(const std::vector<TradeoffRun>& runs, const std::string& integrator,
               double degrees_per_turn) {
  // Below this the evaluation at the samples decides, not the integration.
  constexpr double kFloor = 1e-12;
  constexpr double kCoarse = 1e-2;
  std::vector<std::pair<double, double>> points;  // log of step and error, steps falling
  for (const TradeoffRun& run : runs) {
    if (!run.done() || run.method != "integrated" || run.variant != integrator) continue;
    if (!(run.error.worst > kFloor && run.error.worst < kCoarse) || run.record->steps <= 0)
      continue;
    const double step = std::log(degrees_per_turn / static_cast<double>(run.record->steps));
    // Runs whose step is set by the samples and edges, not by the accuracy, say nothing.
    if (!points.empty() && step > points.back().first - 0.1) {
      points.back() = {step, std::log(run.error.worst)};
      continue;
    }
    points.emplace_back(step, std::log(run.error.worst));
  }
  Order order;
  order.integrator = integrator;
  order.runs = static_cast<int>(points.size());
  if (points.size() < 2) return order;
  const auto& last = points[points.size() - 1];
  const auto& before = points[points.size() - 2];
  order.last_pair = (before.second - last.second) / (before.first - last.first);
  double mean_x = 0;
  double mean_y = 0;
  for (const auto& [x, y] : points) {
    mean_x += x / static_cast<double>(points.size());
    mean_y += y / static_cast<double>(points.size());
  }
  double xx = 0;
  double xy = 0;
  for (const auto& [x, y] : points) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  }
  order.least_squares = xy / xx;
  return order;
}

std::string outside_theory(const Order& order, const std::pair<int, int>& theory) {
  constexpr double kRoom = 0.5;  // nearer to that order than to the next
  std::string text;
  for (const auto& [name, value] :
       {std::pair("last pair", order.last_pair), std::pair("least squares", order.least_squares)})
    if (value && !(*value >= theory.first - kRoom && *value <= theory.second + kRoom))
      text += (text.empty() ? "" : " and ") + std::string(name) +
              (*value < theory.first ? " below" : " above");
  return text;
}

const TradeoffRun* fastest_within(const std::vector<TradeoffRun>& runs, double error) {
  const TradeoffRun* fastest = nullptr;
  for (const TradeoffRun& run : runs)
    if (run.done() && run.method == "integrated" && run.error.worst <= error &&
        (fastest == nullptr || run.seconds_per_turn < fastest->seconds_per_turn))
      fastest = &run;
  return fastest;
}

}  // namespace bentaxis::study
