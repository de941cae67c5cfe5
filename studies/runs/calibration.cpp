#include "bentaxis/study/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/stopwatch.h"

namespace bentaxis::study {
namespace {

// A trial must leave room for what errors do in the rest of the run.
constexpr double kMargin = 0.5;
// An integrator that is this many times slower than the best so far is given up.
constexpr double kSlower = 2;
// Nor may a trial take longer than this, s.
constexpr double kLongestTrial = 20;
// Accuracies tried, loosest first.
constexpr double kAccuracies[] = {1e-1, 1e-2, 1e-3, 1e-4,  1e-5,  1e-6,
                                  1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
constexpr int kTightest = static_cast<int>(std::size(kAccuracies)) - 1;

// The loosest accuracy that is not looser than `accuracy`.
int index_of(double accuracy) {
  int i = 0;
  while (i < kTightest && kAccuracies[i] > accuracy * 1.001) ++i;
  return i;
}

struct Trial {
  double accuracy, error, seconds_per_turn;
};

// The samples of the first pitch; at least a few, whatever the case says.
Samples pitch_samples(const Case& the_case, const PressureTrace& pressure, Case& trial_case) {
  const int n = the_case.pump.geometry.pistons;
  trial_case = the_case;
  trial_case.operation.samples_per_revolution =
      std::max(the_case.operation.samples_per_revolution, 8 * n);
  Samples samples = sample_case(trial_case, pressure, 1, trial_case.operation.speed_rpm < 0);
  const auto rows = static_cast<std::size_t>(trial_case.operation.samples_per_revolution / n) + 1;
  samples.theta_deg.resize(std::min(rows, samples.theta_deg.size()));
  samples.chamber_pressure.resize(samples.theta_deg.size() * n);
  return samples;
}

}  // namespace

const std::string& name_of(multibody::Integrator integrator) {
  return multibody::integrator_names()[static_cast<std::size_t>(integrator)];
}

std::string Calibration::text() const {
  return fmt::format(
      "for an error of {:g} of peak: {} at accuracy {} ({} trials over one pitch in {}: error "
      "{:.1e}, {:.3g} ms a turn)",
      asked, name_of(chosen.integrator), number_text(chosen.accuracy), trials, seconds_spent,
      error_in_trial, 1e3 * seconds_per_turn);
}

std::string VerifiedRun::text() const {
  return calibration.text() + fmt::format("; verified: {:.1e} over the whole run ({})", error.worst,
                                          error.worst_channel);
}

Calibration calibrate(const Case& the_case, const Assumptions& assumptions,
                      const PressureTrace& pressure, double asked,
                      const std::vector<multibody::Integrator>& among,
                      const PartProgress& progress_of) {
  const Stopwatch stopwatch;
  Case trial_case;
  const Samples samples = pitch_samples(the_case, pressure, trial_case);
  const ResultTable reference = analytic::run(trial_case, assumptions, samples);
  const double turns = std::abs(samples.theta_deg.back()) / 360;
  const Progress progress = progress_of("calibration");

  Calibration best;
  best.asked = asked;
  best.seconds_per_turn = std::numeric_limits<double>::infinity();
  std::string failure;
  double closest = std::numeric_limits<double>::infinity();
  double limit = kLongestTrial;  // s

  for (std::size_t i = 0; i < among.size(); ++i) {
    const auto attempt = [&](double accuracy) -> std::optional<Trial> {
      ++best.trials;
      const Stopwatch since;
      struct TooSlow {};
      try {
        const auto run = multibody::run_integrated(
            trial_case, assumptions, samples, pressure, {among[i], accuracy}, [&](double done) {
              progress((static_cast<double>(i) + done) / static_cast<double>(among.size() + 1));
              if (since.seconds() > limit) throw TooSlow();
            });
        const double error = achieved_error(trial_case, samples, reference, run.table).worst;
        if (error < closest) closest = error;
        return Trial{accuracy, error, run.record.seconds / turns};
      } catch (const ComputationError& stopped) {
        failure = stopped.what();
      } catch (const TooSlow&) {
      }
      return std::nullopt;
    };
    // Tighten from ten times the error asked for until it is met; loosen while it is.
    std::optional<Trial> met;
    const int first = index_of(10 * asked);
    for (int step = 1, index = first; index >= 0 && index <= kTightest; index += step) {
      const std::optional<Trial> trial = attempt(kAccuracies[index]);
      const bool good = trial && trial->error <= kMargin * asked;
      if (good && (!met || trial->seconds_per_turn < met->seconds_per_turn)) met = trial;
      if (index == first && good) step = -1;
      if (step < 0 && !good) break;
      if (step > 0 && (good || !trial || trial->seconds_per_turn > kSlower * best.seconds_per_turn))
        break;
    }
    if (met && met->seconds_per_turn < best.seconds_per_turn) {
      best.chosen = {among[i], met->accuracy};
      best.error_in_trial = met->error;
      best.seconds_per_turn = met->seconds_per_turn;
      limit = kSlower * met->seconds_per_turn * turns + 0.02;
    }
  }
  progress(1);
  best.seconds_spent = fmt::format("{:.2g} s", stopwatch.seconds());
  if (!std::isfinite(best.seconds_per_turn))
    throw ComputationError(fmt::format(
        "no integrator reaches an error of {:g} of peak; the closest was {:.1e}{}", asked, closest,
        failure.empty() ? std::string() : " (last failure: " + failure + ")"));
  return best;
}

VerifiedRun run_to_error(const Case& the_case, const Assumptions& assumptions,
                         const Samples& samples, const PressureTrace& pressure, double asked,
                         const std::vector<multibody::Integrator>& among,
                         const PartProgress& progress_of) {
  VerifiedRun result;
  result.calibration = calibrate(the_case, assumptions, pressure, asked, among, progress_of);
  const ResultTable reference = analytic::run(the_case, assumptions, samples);
  for (;;) {
    result.run = multibody::run_integrated(the_case, assumptions, samples, pressure,
                                           result.calibration.chosen, progress_of("multibody"));
    result.error = achieved_error(the_case, samples, reference, result.run.table);
    if (result.error.worst <= asked) return result;
    double& accuracy = result.calibration.chosen.accuracy;
    const int index = index_of(accuracy);
    if (index == kTightest)
      throw ComputationError(
          fmt::format("{}: the error of the whole run is {:.1e} of peak ({}) at accuracy {}, the "
                      "wanted error was {:g}",
                      name_of(result.calibration.chosen.integrator), result.error.worst,
                      result.error.worst_channel, number_text(accuracy), asked));
    accuracy = kAccuracies[index + 1];
  }
}

}  // namespace bentaxis::study
