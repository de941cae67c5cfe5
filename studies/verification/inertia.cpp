#include "bentaxis/study/inertia.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "bentaxis/analytic/model.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/numerics/minimum.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/piece_progress.h"

namespace bentaxis::study {
namespace {

constexpr int kMapAngles = 120;         // per turn
constexpr double kSpinAccuracy = 1e-7;  // Simbody's, per step
constexpr int kTimingTurns = 3;         // the fastest counts

Assumptions with(const Assumptions& assumptions, PistonInertia inertia) {
  Assumptions result = assumptions;
  result.inertia = inertia;
  return result;
}

void require_real_piston(const Case& the_case) {
  if (const std::string why = piston_inertia_refusal(PistonInertia::real, the_case.pump);
      !why.empty())
    throw InputError(the_case.file.string() + ": the inertia study " + why);
  const PistonMass& piston = the_case.pump.piston;
  if (piston.mass == 0 && piston.real->transverse_inertia > 0)  // axial <= 2 transverse
    throw InputError(
        the_case.file.string() + ": [piston] transverse_inertia_kg_mm2 = " +
        to_text(*value_of(parameter_of(standard_registry(), "piston", "transverse_inertia_kg_mm2"),
                          the_case)) +
        ": must be 0 where mass_kg = 0, in an inertia study: Simbody has no body with "
        "inertia but without mass");
}

Samples turn_of(const Case& the_case) {
  return sample_case(the_case, PressureTrace(the_case.pressure));
}

ResultTable analytic_run(const Case& the_case, PistonInertia inertia) {
  return analytic::run(the_case, with(the_case.analytic, inertia), turn_of(the_case));
}

// The smallest scene that has Rs and Rc, by the method that needs no inertia.
ResultTable one_piston_run(const Case& the_case, PistonInertia inertia) {
  return multibody::run_driven(the_case, with(the_case.analytic, inertia), turn_of(the_case), {},
                               multibody::Scene::piston, multibody::Method::residual);
}

// A real piston with the moments of the lumped one.
PistonMass::Real real_data_of_lumped(const PumpParameters& pump) {
  const double chi = pump.piston.joint_mass_fraction;
  const double length = pump.geometry.piston_length;
  return {(1 - chi) * length, chi * (1 - chi) * pump.piston.mass * length * length, 0, 0};
}

Case with_real(Case the_case, const PistonMass::Real& real) {
  the_case.pump.piston.real = real;
  return the_case;
}

double peak_difference(const ResultTable& first, const ResultTable& second,
                       const std::string& group) {
  return difference(first, second, "").peak(group);
}

Lumping error_of(const std::string& name, const Case& the_case, PistonInertia inertia,
                 const ResultTable& real) {
  const ResultTable lumped = analytic_run(the_case, inertia);
  return {
      name,
      inertia == PistonInertia::lumped ? the_case.pump.piston.joint_mass_fraction : not_computed(),
      peak_difference(lumped, real, "Rs"), peak_difference(lumped, real, "Rc")};
}

// A case with few pistons and samples: every piston has the same curve, so one is enough.
Case one_piston(Case the_case, int samples) {
  the_case.pump.geometry.pistons = 1;
  the_case.operation.samples_per_revolution = samples;
  return the_case;
}

}  // namespace

Case without_loads(Case the_case) {
  the_case.pressure = PressureSpec{};
  the_case.pump.gravity = 0;
  the_case.pump.block.spring_force = 0;
  the_case.pump.port_plate.reset();
  Friction none;
  none.shaft_torque_factor = 1;
  the_case.pump.friction = none;
  return the_case;
}

Case at_speed(Case the_case, double speed_rpm) {
  if (speed_rpm == 0 || !std::isfinite(speed_rpm))
    throw InputError(
        "--speeds: each speed must be a finite number other than 0: at rest there is no inertia "
        "force");
  the_case.operation.speed_rpm = speed_rpm;
  return the_case;
}

InertiaRun run_both_pistons(const Case& the_case, double speed_rpm, bool loaded,
                            multibody::Scene scene, const Progress& progress) {
  require_real_piston(the_case);
  const Case at = at_speed(loaded ? the_case : without_loads(the_case), speed_rpm);
  const Samples samples = turn_of(at);
  InertiaRun run;
  run.speed_rpm = speed_rpm;
  run.loaded = loaded;
  run.joint_circle_radius = at.pump.geometry.joint_circle_radius;
  const auto multibody_run = [&](PistonInertia inertia, std::size_t number) {
    // Inverse dynamics needs no equation of motion; for what has one it would hide a failure.
    const bool by_multipliers = multibody::has_equation_of_motion(at.pump, inertia);
    if (!by_multipliers) run.by_inverse_dynamics.push_back(inertia);
    return multibody::run_driven(
        at, with(at.analytic, inertia), samples, within(progress, number, 2), scene,
        by_multipliers ? std::nullopt : std::optional(multibody::Method::residual));
  };
  run.analytic_lumped = analytic::run(at, with(at.analytic, PistonInertia::lumped), samples);
  run.analytic_real = analytic::run(at, with(at.analytic, PistonInertia::real), samples);
  run.multibody_lumped = multibody_run(PistonInertia::lumped, 0);
  run.multibody_real = multibody_run(PistonInertia::real, 1);
  return run;
}

ResultTable difference(const ResultTable& first, const ResultTable& second,
                       const std::string& name) {
  ResultTable result = first;
  result.name = name;
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = is_computed(first.values[i]) && is_computed(second.values[i])
                           ? first.values[i] - second.values[i]
                           : not_computed();
  return result;
}

compare::Difference largest_difference(const ResultTable& first, const ResultTable& second,
                                       const std::function<bool(const Channel&)>& computed,
                                       double force, double radius) {
  compare::Difference largest;
  for (std::size_t c = 0; c < first.columns(); ++c) {
    const Channel& channel = first.channels[c];
    if (channel.kind != ChannelKind::reaction || !computed(channel)) continue;
    const double least = channel.unit == "Nm" ? force * radius : force;
    const double peak = std::max(first.peak(channel.group), least);
    for (std::size_t row = 0; row < first.rows(); ++row)
      largest.keep_larger(compare::difference(first.at(row, c), second.at(row, c), peak));
  }
  return largest;
}

std::vector<LumpingError> lumping_errors(const InertiaRun& run, const InertiaRun& loaded) {
  const ResultTable analytic = difference(run.analytic_lumped, run.analytic_real, "");
  const ResultTable multibody = difference(run.multibody_lumped, run.multibody_real, "");
  const double force = loaded.analytic_real.peak("Rs");
  std::vector<LumpingError> errors;
  for (const Channel& channel : run.analytic_real.channels) {
    if (channel.kind != ChannelKind::reaction) continue;
    if (std::any_of(errors.begin(), errors.end(),
                    [&](const auto& error) { return error.group == channel.group; }))
      continue;
    const std::size_t column = multibody.find(channel.name);
    errors.push_back(
        {channel.group, channel.unit, run.speed_rpm, run.loaded, analytic.peak(channel.group),
         is_computed(multibody.at(0, column)) ? multibody.peak(channel.group) : not_computed(),
         run.analytic_real.peak(channel.group), loaded.analytic_real.peak(channel.group),
         channel.unit == "Nm" ? force * run.joint_circle_radius : force});
  }
  return errors;
}

ErrorCauses causes_of_error(const Case& the_case, double speed_rpm, By model) {
  require_real_piston(the_case);
  const Case bare = at_speed(without_loads(the_case), speed_rpm);
  const PistonMass::Real real = *bare.pump.piston.real;
  const PistonMass::Real lumped = real_data_of_lumped(bare.pump);
  const auto run = [&](const Case& at, PistonInertia inertia) {
    return model == By::analytic ? analytic_run(at, inertia) : one_piston_run(at, inertia);
  };
  const ResultTable from = run(bare, PistonInertia::lumped);
  const auto part = [&](const PistonMass::Real& changed, const std::string& name) {
    return difference(from, run(with_real(bare, changed), PistonInertia::real), name);
  };
  PistonMass::Real centre = lumped;
  centre.centre_of_mass = real.centre_of_mass;
  PistonMass::Real transverse = lumped;
  transverse.transverse_inertia = real.transverse_inertia;
  PistonMass::Real spin = lumped;
  spin.axial_inertia = real.axial_inertia;
  spin.spin = real.spin;
  ErrorCauses causes{part(centre, "centre of mass"), part(transverse, "transverse inertia"),
                     part(spin, "spin"), part(real, "all"), 0};
  const ResultTable rest =
      difference(difference(difference(causes.all, causes.centre, ""), causes.transverse, ""),
                 causes.spin, "");
  causes.rest = std::max(rest.peak("Rs"), rest.peak("Rc"));
  return causes;
}

std::vector<Lumping> lumpings(const Case& the_case, double speed_rpm) {
  require_real_piston(the_case);
  const Case bare = one_piston(at_speed(without_loads(the_case), speed_rpm),
                               the_case.operation.samples_per_revolution);
  const ResultTable real = analytic_run(bare, PistonInertia::real);
  const auto with_fraction = [&](const std::string& name, double chi) {
    Case changed = bare;
    changed.pump.piston.joint_mass_fraction = chi;
    return error_of(name, changed, PistonInertia::lumped, real);
  };
  std::vector<Lumping> result;
  result.push_back(with_fraction("as in the case", bare.pump.piston.joint_mass_fraction));
  const double keeps_centre =
      1 - bare.pump.piston.real->centre_of_mass / bare.pump.geometry.piston_length;
  if (keeps_centre >= 0 && keeps_centre <= 1)
    result.push_back(with_fraction("keeps the centre of mass, chi = 1 - s_G/b1", keeps_centre));
  result.push_back(with_fraction(
      "minimum error of Rs",
      numerics::smallest_at([&](double chi) { return with_fraction("", chi).error_rs; }, 0, 1)));
  result.push_back(with_fraction(
      "minimum error of Rc",
      numerics::smallest_at([&](double chi) { return with_fraction("", chi).error_rc; }, 0, 1)));
  if (three_masses(bare.pump).exists)
    result.push_back(error_of("three point masses (dynamically_equivalent)", bare,
                              PistonInertia::dynamically_equivalent, real));
  return result;
}

std::vector<Lumping> lumping_over_fraction(const Case& the_case, double speed_rpm, int points) {
  const Case bare = one_piston(at_speed(without_loads(the_case), speed_rpm),
                               the_case.operation.samples_per_revolution);
  const ResultTable real = analytic_run(bare, PistonInertia::real);
  std::vector<Lumping> result;
  for (int i = 0; i < points; ++i) {
    Case changed = bare;
    changed.pump.piston.joint_mass_fraction = static_cast<double>(i) / (points - 1);
    result.push_back(error_of("", changed, PistonInertia::lumped, real));
  }
  return result;
}

ThreeMasses three_masses(const PumpParameters& pump) {
  ThreeMasses masses;
  if (!pump.piston.real) return masses;
  const PistonMass::Real& real = *pump.piston.real;
  const double length = pump.geometry.piston_length;
  const double centre = real.centre_of_mass;
  masses.exists = piston_inertia_refusal(PistonInertia::dynamically_equivalent, pump).empty();
  if (!masses.exists) return masses;
  if (real.transverse_inertia > 0) {
    masses.at_joint = real.transverse_inertia / (length * centre);
    masses.at_ring = real.transverse_inertia / (length * (length - centre));
  }
  masses.at_centre = pump.piston.mass - masses.at_joint - masses.at_ring;
  masses.positive = masses.at_centre >= 0;
  return masses;
}

ErrorMap error_map(const Case& the_case, MapAxis axis, std::vector<double> speeds,
                   std::vector<double> factors, const Progress& progress) {
  require_real_piston(the_case);
  ErrorMap map{axis, std::move(speeds), std::move(factors), {}, {}};
  for (std::size_t i = 0; i < map.factor.size(); ++i) {
    const double f = map.factor[i];
    Case grown = one_piston(the_case, kMapAngles);
    PistonMass& piston = grown.pump.piston;
    piston.mass *= f;
    piston.real->axial_inertia *= f;
    piston.real->transverse_inertia *= axis == MapAxis::mass ? f : f * f * f;
    if (axis == MapAxis::length) {
      grown.pump.geometry.piston_length *= f;
      piston.real->centre_of_mass *= f;
      piston.real->axial_inertia =
          std::min(piston.real->axial_inertia, 2 * piston.real->transverse_inertia);
    }
    map.rs.emplace_back();
    map.rc.emplace_back();
    const bool fits =
        grown.pump.geometry.piston_length > assembly_margin(grown.pump.geometry).longest_distance;
    for (const double speed : map.speed_rpm) {
      double rs = not_computed();
      double rc = not_computed();
      if (fits) {
        const Case at = at_speed(grown, speed);
        const ResultTable real = analytic_run(at, PistonInertia::real);
        const ResultTable error = difference(analytic_run(at, PistonInertia::lumped), real, "");
        const double peak_rs = real.peak("Rs");
        const double peak_rc = real.peak("Rc");
        if (peak_rs > 0) rs = error.peak("Rs") / peak_rs;
        if (peak_rc > 0) rc = error.peak("Rc") / peak_rc;
      }
      map.rs.back().push_back(rs);
      map.rc.back().push_back(rc);
    }
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(map.factor.size()));
  }
  return map;
}

std::vector<Approach> approach_to_lumped(const Case& the_case, double speed_rpm) {
  require_real_piston(the_case);
  const Case bare = at_speed(without_loads(the_case), speed_rpm);
  const ResultTable lumped = one_piston_run(bare, PistonInertia::lumped);
  const PistonMass::Real real = *bare.pump.piston.real;
  const PistonMass::Real limit = real_data_of_lumped(bare.pump);
  std::vector<Approach> result;
  for (const double t : {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const auto between = [&](double from, double to) { return to + t * (from - to); };
    const PistonMass::Real mixed{between(real.centre_of_mass, limit.centre_of_mass),
                                 between(real.transverse_inertia, limit.transverse_inertia),
                                 t * real.axial_inertia, real.spin};
    const ResultTable table = one_piston_run(with_real(bare, mixed), PistonInertia::real);
    result.push_back(
        {t, peak_difference(table, lumped, "Rs"), peak_difference(table, lumped, "Rc")});
  }
  return result;
}

SpinRun spin_run(const Case& the_case, double speed_rpm, double spin_rpm,
                 const Progress& progress) {
  require_real_piston(the_case);
  Case spinning = at_speed(the_case, speed_rpm);
  spinning.pump.piston.real->spin = rad_per_second(spin_rpm);
  // No force on a piston's own axis turns it about that: where on it the bore acts makes no
  // difference, and beside B it cannot be integrated.
  spinning.pump.piston.contact.reset();
  // Nor do the teeth: bevel teeth are not integrated by Simbody.
  if (spinning.pump.gear.contact == ToothContact::teeth) {
    spinning.pump.gear.contact = ToothContact::rigid;
    spinning.pump.gear.teeth.reset();
  }
  spinning.operation.samples_per_revolution = 72;
  spinning.operation.revolutions = 1;
  const PressureTrace pressure(spinning.pressure);
  const Samples samples = sample_case(spinning, pressure, 1, speed_rpm < 0);
  const multibody::IntegrationOptions options{.accuracy = kSpinAccuracy};
  const auto run = multibody::run_integrated(spinning, with(spinning.analytic, PistonInertia::real),
                                             samples, pressure, options, progress);
  return {spin_rpm, run.record.whole.spin_error, options.accuracy};
}

std::vector<SceneCost> scene_costs(const Case& the_case) {
  require_real_piston(the_case);
  const Assumptions assumptions = with(the_case.analytic, PistonInertia::real);
  const Samples samples = turn_of(the_case);
  std::vector<SceneCost> costs;
  for (std::size_t m = 0; m < multibody::method_names().size(); ++m) {
    for (std::size_t s = 0; s < multibody::scene_names().size(); ++s) {
      const auto scene = static_cast<multibody::Scene>(s);
      const auto method = static_cast<multibody::Method>(m);
      if (method == multibody::Method::multipliers &&
          (multibody::has_ring_off_b(the_case.pump) ||
           !multibody::has_equation_of_motion(the_case.pump, PistonInertia::real)))
        continue;
      multibody::Model model(the_case.pump, assumptions, samples.omega, scene, method);
      std::vector<double> values(model.layout().size());
      Instant instant;
      double best = 1e300;
      for (int turn = 0; turn < kTimingTurns; ++turn) {
        const std::clock_t start = std::clock();
        for (std::size_t row = 0; row < samples.theta_deg.size(); ++row) {
          samples.instant(row, instant);
          if (scene == multibody::Scene::piston)
            model.evaluate_one(instant, values);
          else
            model.evaluate(instant, values);
        }
        best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
      }
      const multibody::SceneSize size = multibody::scene_size(the_case.pump, assumptions, scene);
      costs.push_back({multibody::scene_names()[s], multibody::method_names()[m], size.bodies,
                       size.mobilities, size.equations,
                       1e6 * best / static_cast<double>(samples.theta_deg.size())});
    }
  }
  return costs;
}

}  // namespace bentaxis::study
