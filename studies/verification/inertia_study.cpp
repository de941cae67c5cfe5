#include "bentaxis/study/inertia_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/piece_progress.h"
#include "bentaxis/study/published_section.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {
namespace {

constexpr double kSpinForRun = 600;  // rpm, where the case's pistons do not spin

bool slower(double a, double b) { return std::abs(a) < std::abs(b); }

// Values from low to high in equal ratios.
std::vector<double> ratios(const std::pair<double, double>& range, int count) {
  const auto& [low, high] = range;
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / (count - 1)));
  return values;
}

void compare_models_and_scenes(InertiaStudy& s) {
  const double radius = s.the_case.pump.geometry.joint_circle_radius;
  const double of_teeth = tooth_round_off(s.the_case.pump) / kInertiaModelsAgree;
  compare::Difference models, scenes;
  for (std::size_t i = 0; i < s.full.size(); ++i) {
    // Runs come in pairs: without load, loaded. The inertia forces alone are the smallest scale.
    // Under load what is left of loads that cancel carries their round-off, 1e-12 of them.
    const double round_off = compare::kNoSignal / kInertiaModelsAgree;
    double least = std::max(s.one_piston[i - i % 2].analytic_real.peak("Rs"),
                            round_off * s.one_piston[i].analytic_real.peak("Rs"));
    // Pistons without mass: nothing is left but the round-off of what loads would be.
    if (least == 0) least = round_off * s.one_piston[i - i % 2 + 1].analytic_real.peak("Rs");
    const auto differ = [&](const ResultTable& first, const ResultTable& second,
                            multibody::Scene scene) {
      const RunOptions options{.model = Model::multibody, .scene = {scene, {}}};
      const auto computed = [&](const Channel& channel) {
        return channel.of_pump && computes(options, s.the_case.analytic, channel);
      };
      const double scale = scene == multibody::Scene::full ? std::max(least, of_teeth) : least;
      return largest_difference(first, second, computed, scale, radius);
    };
    for (const auto& [run, scene] : {std::pair{&s.full[i], multibody::Scene::full},
                                     std::pair{&s.one_piston[i], multibody::Scene::piston}}) {
      models.keep_larger(differ(run->analytic_lumped, run->multibody_lumped, scene));
      models.keep_larger(differ(run->analytic_real, run->multibody_real, scene));
    }
    for (const auto table : {&InertiaRun::multibody_real, &InertiaRun::multibody_lumped})
      scenes.keep_larger(
          differ(s.full[i].*table, s.one_piston[i].*table, multibody::Scene::piston));
  }
  s.models_apart = models.share();
  s.scenes_apart = scenes.share();
}

}  // namespace

void require_even_transfer(const Case& the_case, const std::string& study) {
  if (the_case.pump.transfer.is_even()) return;
  std::vector<std::string> even;
  for (const TransferTraits& transfer : kTransfers)
    if (transfer.even) even.push_back('"' + std::string(transfer.name) + '"');
  throw InputError((the_case.file.empty() ? "" : the_case.file.string() + ": ") +
                   "[transfer] kind = \"" + to_string(the_case.pump.transfer.kind) +
                   "\": must be one of " + joined(even) + " in " + study +
                   ": the block has to turn exactly as the shaft does");
}

const InertiaRun& InertiaStudy::loaded(const std::vector<InertiaRun>& runs, double speed_rpm) {
  return *std::find_if(runs.begin(), runs.end(), [&](const InertiaRun& run) {
    return run.loaded && run.speed_rpm == speed_rpm;
  });
}

double tooth_round_off(const PumpParameters& pump) {
  const Gear& gear = pump.gear;
  if (gear.contact != ToothContact::teeth || !gear.teeth) return 0;
  return gear.teeth->youngs_modulus * gear.teeth->face_width * gear.pitch_diameter / 2 *
         std::numeric_limits<double>::epsilon() / 2;
}

bool InertiaStudy::agrees() const {
  return models_apart <= kInertiaModelsAgree && scenes_apart <= kInertiaScenesAgree;
}

InertiaStudy run_inertia_study(const Case& as_read, const InertiaOptions& options,
                               const PartProgress& progress_of) {
  // One piston stands for all, and its spin is integrated by Simbody.
  require_even_transfer(as_read, "an inertia study");
  // Of each speed both pistons by both models in two scenes, and what is made of the fastest.
  require_memory(as_read, Kept::lumped, Way::driven, options.speeds.size() + 1);
  InertiaStudy s;
  s.the_case = prepare(as_read, progress_of).the_case;
  const Case& the_case = s.the_case;
  for (const double speed : options.speeds) at_speed(the_case, speed);  // refuses early
  std::vector<double> speeds;                                           // that could be computed
  // Of each speed the oil, then two scenes without load and loaded.
  constexpr std::size_t kPieces = 5;
  const Progress whole = progress_of("speeds");
  std::size_t begun = 0;
  for (const double speed : options.speeds) {
    std::size_t piece = kPieces * begun++;
    const auto next = [&] { return within(whole, piece++, kPieces * options.speeds.size()); };
    Case at;
    try {
      at = prepare(at_speed(as_read, speed), [&](const auto&) { return next(); }).the_case;
    } catch (const ComputationError& error) {
      s.failed.push_back({speed, fmt::format("speed_rpm = {:g}", speed), error.what()});
      continue;
    }
    speeds.push_back(speed);
    piece = kPieces * begun - 4;
    for (const bool loaded : {false, true}) {
      s.one_piston.push_back(run_both_pistons(at, speed, loaded, multibody::Scene::piston, next()));
      s.full.push_back(run_both_pistons(at, speed, loaded, multibody::Scene::full, next()));
    }
  }
  if (speeds.empty())
    throw ComputationError("no speed of the series could be computed; the first: " +
                           s.failed[0].reason);
  s.fastest = *std::max_element(speeds.begin(), speeds.end(), slower);
  compare_models_and_scenes(s);
  s.causes = causes_of_error(the_case, s.fastest, By::analytic);
  s.multibody_causes = causes_of_error(the_case, s.fastest, By::multibody);
  s.lumpings = lumpings(the_case, s.fastest);
  s.over_fraction = lumping_over_fraction(the_case, s.fastest, 51);
  s.masses = three_masses(the_case.pump);
  const double slowest = std::abs(*std::min_element(speeds.begin(), speeds.end(), slower));
  const auto map_speeds =
      options.map_speeds.value_or(std::pair(slowest / 3, 3 * std::abs(s.fastest)));
  s.map = error_map(the_case, options.map_axis, ratios(map_speeds, options.map_size),
                    ratios(options.map_factors, options.map_size), progress_of("map"));
  s.approach = approach_to_lumped(the_case, s.fastest);
  const double own_spin = the_case.pump.piston.real->spin / kRadPerSecondPerRpm;
  // Without axial inertia a piston has no freedom to spin.
  if (the_case.pump.piston.real->axial_inertia > 0)
    s.spin = spin_run(the_case, s.fastest, own_spin != 0 ? own_spin : kSpinForRun,
                      progress_of("integrated, spinning pistons"));
  s.costs = scene_costs(the_case);
  return s;
}

compare::PublishedSection judge_inertia(const InertiaStudy& s,
                                        const compare::Published& published) {
  compare::PublishedSection all;
  for (const InertiaRun& run : s.one_piston) {
    if (run.loaded) continue;
    const Case bare = without_loads(at_speed(s.the_case, run.speed_rpm));
    for (const bool real_pistons : {false, true}) {
      auto section = compare::judge_published(
          published, {"analytic", "multibody"},
          [&](const std::string& model, const compare::PublishedVariant& variant) {
            const auto set = variant.set.find("real_pistons");
            const bool real = set == variant.set.end() ? real_pistons : set->second != 0;
            Assumptions assumptions = bare.analytic;
            assumptions.inertia = real ? PistonInertia::real : PistonInertia::lumped;
            return compare::PublishedRun{model == "analytic"
                                             ? (real ? &run.analytic_real : &run.analytic_lumped)
                                             : (real ? &run.multibody_real : &run.multibody_lumped),
                                         facts_of(bare, assumptions)};
          },
          "inertia");
      for (auto& row : section.rows) {
        // What holds at any condition says nothing of this study; rows that take one kind of piston
        // from the other are the same for both.
        if (row.verdict == compare::PublishedVerdict::not_comparable ||
            row.number.condition.empty() || (real_pistons && !row.number.minus.empty()))
          continue;
        if (row.number.minus.empty()) row.at += real_pistons ? "; real pistons" : "; two masses";
        all.rows.push_back(std::move(row));
      }
      all.models = section.models;
    }
  }
  for (const auto& row : all.rows) all.summary.count(row);
  return all;
}

}  // namespace bentaxis::study
