#include "bentaxis/study/fig34.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/reporting.h"
#include "bentaxis/study/run.h"
#include "paper_conditions.h"

namespace bentaxis::study {
namespace {

// Extremes and signs are asked for, of motions that impacts make sensitive: no more digits.
constexpr double kError = 1e-5;

/// The part along x2 of a tooth force on the block that is > 0 where it pushes towards +psi, (22).
double along_x2(const Case& the_case, double tooth_force) {
  return -std::cos(the_case.pump.gear.pressure_angle) * tooth_force;
}

/// Least and greatest of samples, a peak between them by the parabola through three.
void find_extremes(const std::vector<double>& force, Fig34Curve& curve) {
  for (std::size_t i = 0; i < force.size(); ++i) {
    double value = force[i];
    if (i > 0 && i + 1 < force.size()) {
      const double bend = force[i - 1] - 2 * value + force[i + 1];
      const double rise = force[i + 1] - force[i - 1];
      const bool peak = std::abs(rise) < std::abs(bend);  // the vertex lies between both
      if (peak) value -= rise * rise / (8 * bend);
    }
    curve.least = std::min(i == 0 ? value : curve.least, value);
    curve.greatest = std::max(i == 0 ? value : curve.greatest, value);
  }
}

/// What samples of whole turns show. Its ranges are those of one window.
Fig34Curve seen_in(const std::vector<double>& force, int turns, int pistons) {
  Fig34Curve curve;
  find_extremes(force, curve);
  const auto visible = [](double f) { return std::abs(f) < kFig34Visible ? 0 : f > 0 ? 1 : -1; };
  int last = 0, changes = 0;
  std::size_t apart = 0;
  for (const double f : force) {
    if (f == 0) ++apart;
    const int now = visible(f);
    if (now == 0) continue;
    if (last != 0 && now != last) ++changes;
    last = now;
  }
  curve.apart = static_cast<double>(apart) / static_cast<double>(force.size());
  curve.sign_changes = static_cast<double>(changes) / turns;
  const std::size_t pitches = static_cast<std::size_t>(turns) * static_cast<std::size_t>(pistons);
  std::size_t both = 0;
  for (std::size_t p = 0; p < pitches; ++p) {
    bool pushed = false, pulled = false;
    for (std::size_t i = p * force.size() / pitches; i < (p + 1) * force.size() / pitches; ++i) {
      pushed |= visible(force[i]) > 0;
      pulled |= visible(force[i]) < 0;
    }
    if (pushed && pulled) ++both;
  }
  curve.both_signs = static_cast<double>(both) / static_cast<double>(pitches);
  curve.largest_over = {curve.largest(), curve.largest()};
  curve.apart_over = {curve.apart, curve.apart};
  return curve;
}

void widen(Fig34Range& range, const Fig34Range& by) {
  range.minimum = std::min(range.minimum, by.minimum);
  range.maximum = std::max(range.maximum, by.maximum);
}

/// What the first window shows, with the ranges of all. Motions that impacts make chaotic never
/// repeat: how far their windows differ says how far one window can be trusted.
Fig34Curve seen_in_windows(const std::vector<double>& force, int windows, int turns, int pistons) {
  Fig34Curve curve;
  const std::size_t length = force.size() / static_cast<std::size_t>(windows);
  for (int w = 0; w < windows; ++w) {
    const auto from = force.begin() + static_cast<std::ptrdiff_t>(length) * w;
    const Fig34Curve window =
        seen_in({from, from + static_cast<std::ptrdiff_t>(length)}, turns, pistons);
    if (w == 0) {
      curve = window;
      continue;
    }
    widen(curve.largest_over, window.largest_over);
    widen(curve.apart_over, window.apart_over);
    curve.both_signs = std::min(curve.both_signs, window.both_signs);
  }
  return curve;
}

Case without_drag(Case the_case) {
  the_case.pump.friction.block_viscous = 0;
  return the_case;
}

class Study {
 public:
  Study(PreparedCase ready, const Fig34Options& options)
      : ready_(std::move(ready)), options_(options) {}

  Fig34Curve rigid(bool drag) const {
    const Case the_case = drag ? ready_.the_case : without_drag(ready_.the_case);
    const ResultTable table =
        analytic::run(the_case, the_case.analytic, sample_case(the_case, ready_.pressure));
    std::vector<double> force;
    const std::size_t column = table.find("Rcs_z4_N");
    const double direction = the_case.operation.speed_rpm < 0 ? -1 : 1;
    for (std::size_t row = 0; row < table.rows(); ++row)
      force.push_back(direction * along_x2(the_case, table.at(row, column)));
    Fig34Curve curve = seen_in(force, 1, the_case.pump.geometry.pistons);
    curve.apart = 0;
    curve.theta_deg = table.theta_deg;
    curve.force = std::move(force);
    return curve;
  }

  Fig34Curve simulate(const Fig34Point& point, int windows, bool keep) const {
    Case the_case = point.drag ? ready_.the_case : without_drag(ready_.the_case);
    Gear& gear = the_case.pump.gear;
    gear.contact = ToothContact::compliant;
    gear.compliance.emplace();
    gear.compliance->exponent = point.exponent;
    gear.compliance->stiffness =
        kFig34Force / kToothApproach * std::pow(kToothApproach / point.approach, point.exponent);
    gear.compliance->backlash = point.backlash;
    gear.compliance->dissipation = point.dissipation;
    the_case.pump.block.axial_inertia = point.block_inertia;
    const double turn = 2 * kPi / std::abs(rad_per_second(the_case.operation.speed_rpm));
    const int counted = windows * options_.turns;
    const int all = options_.turns_left_out + counted;
    the_case.drive.emplace();
    the_case.drive->kind = DriveKind::speed;
    the_case.drive->duration = all * turn;
    the_case.drive->samples = all;
    analytic::SimulationOptions asked;
    asked.error = kError;
    const int samples = options_.samples_per_turn;
    for (int i = 1; i <= counted * samples; ++i)
      asked.times.push_back(turn * (options_.turns_left_out + static_cast<double>(i) / samples));
    try {
      std::vector<double> force;
      force.reserve(asked.times.size());
      analytic::watch_tooth_force(
          the_case, the_case.analytic, ready_.pressure, asked,
          [&](double, double tooth_force) { force.push_back(along_x2(the_case, tooth_force)); });
      Fig34Curve curve =
          seen_in_windows(force, windows, options_.turns, the_case.pump.geometry.pistons);
      if (keep) {
        for (int i = 1; i <= samples; ++i) curve.theta_deg.push_back(360.0 * i / samples);
        curve.force.assign(force.begin(), force.begin() + samples);
      }
      return curve;
    } catch (const ComputationError& error) {
      Fig34Curve failed;
      failed.failure = error.what();
      return failed;
    }
  }

  /// All points, by as many threads as there are processors.
  std::vector<Fig34Curve> simulate(const std::vector<Fig34Point>& points, int windows,
                                   const Progress& progress) const {
    std::vector<Fig34Curve> curves(points.size());
    for_each_of(points.size(), 0, progress,
                [&](std::size_t i) { curves[i] = simulate(points[i], windows, false); });
    return curves;
  }

 private:
  PreparedCase ready_;
  Fig34Options options_;
};

std::vector<Fig34Point> grid(const Fig34Options& options, bool with_drag) {
  std::vector<Fig34Point> points;
  for (const bool drag : {false, true}) {
    if (drag && !with_drag) continue;
    for (const double exponent : options.exponents)
      for (const double approach : options.approaches)
        for (const double backlash : options.backlashes)
          for (const double dissipation : options.dissipations)
            for (const double inertia : options.block_inertias)
              points.push_back({exponent, approach, backlash, dissipation, inertia, drag});
  }
  return points;
}

// The case as every contact law starts from it, with its pressure.
PreparedCase with_rigid_teeth(Case the_case, const PartProgress& progress_of) {
  if (the_case.operation.speed_rpm == 0)
    throw InputError(the_case.file.string() +
                     ": [operation] speed_rpm = 0: teeth lose contact in motion only");
  Gear& gear = the_case.pump.gear;
  gear.flanks = Flanks::two;
  gear.contact = ToothContact::rigid;
  gear.compliance.reset();
  gear.teeth.reset();
  the_case.drive.reset();
  return prepare(std::move(the_case), progress_of);
}

double interpolated(const Fig34Curve& curve, double angle_deg) {
  const auto above = std::lower_bound(curve.theta_deg.begin(), curve.theta_deg.end(), angle_deg);
  if (above == curve.theta_deg.begin()) return curve.force.front();
  if (above == curve.theta_deg.end()) return curve.force.back();
  const auto i = static_cast<std::size_t>(above - curve.theta_deg.begin());
  const double share =
      (angle_deg - curve.theta_deg[i - 1]) / (curve.theta_deg[i] - curve.theta_deg[i - 1]);
  return curve.force[i - 1] + share * (curve.force[i] - curve.force[i - 1]);
}

// ---- What was expected (first tries with another program, and the printed torques)

constexpr double kStiff = 0.5e-6;  // 200 N/um, m at 100 N
const std::vector<double> kDissipations = {0.05, 0.5, 5, 50};
const std::vector<double> kInertias = {1e-3, 1.5e-3, 2e-3};

/// What one law shows in all its windows joins what others show.
void include(Fig34Expectation::Found& found, const Fig34Range& range, double factor) {
  found.least = std::min(found.least, factor * range.minimum);
  found.greatest = std::max(found.greatest, factor * range.maximum);
  found.spread = std::max(found.spread, range.spread());
}

void add_expectations(const Study& study, Fig34Study& result, const Progress& progress) {
  const auto add_rigid = [&](const std::string& what, const std::string& unit, double low,
                             double high, double found) {
    result.expectations.push_back({what, unit, low, high, {{0, found, found, 0}}});
  };
  add_rigid("rigid teeth without Cc, 0 deg", "N", -114.6 * 1.05, -114.6 * 0.95, result.rigid_at_0);
  add_rigid("rigid teeth without Cc, 38 deg", "N", 84.5 * 0.95, 84.5 * 1.05, result.rigid_at_38);
  add_rigid("drag Cc psi' from which on nothing reverses", "Nm", 4.5, 5.5, result.reversing_torque);
  struct Try {
    std::string name;
    double exponent, approach;
    std::vector<double> backlashes;
    double low, high, least_apart, most_apart;  // forces, N; shares of time, %
  };
  const Try tries[] = {
      {"contact as ADAMS has it by default, no backlash",
       2.2,
       adams_approach(),
       {0},
       175,
       212,
       15,
       25},
      {"the same, 50 um of backlash", 2.2, adams_approach(), {50e-6}, 345, 393, 0, 100},
      {"stiff (200 N/um, linear), 20 and 50 um", 1, kStiff, {20e-6, 50e-6}, 750, 1300, 70, 90}};
  Fig34Expectation with_drag{"all of these with Cc: without contact", "%", 0, 0, {}};
  for (const double dissipation : kDissipations) with_drag.found.push_back({dissipation, 0, 0, 0});
  int done = 0;
  for (const Try& t : tries) {
    Fig34Expectation force{t.name + ": largest force", "N", t.low, t.high, {}};
    Fig34Expectation apart{t.name + ": without contact", "%", t.least_apart, t.most_apart, {}};
    for (std::size_t d = 0; d < kDissipations.size(); ++d) {
      std::vector<Fig34Point> points;
      for (const bool drag : {false, true})
        for (const double backlash : t.backlashes)
          for (const double inertia : kInertias)
            points.push_back({t.exponent, t.approach, backlash, kDissipations[d], inertia, drag});
      const auto curves = study.simulate(points, result.options.windows, [&](double f) {
        progress((done + f) / static_cast<double>(std::size(tries) * kDissipations.size()));
      });
      ++done;
      Fig34Expectation::Found f{kDissipations[d], HUGE_VAL, 0, 0}, a{kDissipations[d], 100, 0, 0};
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (!curves[i].done()) f.greatest = HUGE_VAL;
        const Fig34Range &largest = curves[i].largest_over, &share = curves[i].apart_over;
        if (points[i].drag) {
          include(with_drag.found[d], share, 100);
          continue;
        }
        include(f, largest, 1);
        include(a, share, 100);
      }
      force.found.push_back(f);
      apart.found.push_back(a);
    }
    result.expectations.push_back(force);
    if (t.most_apart < 100) result.expectations.push_back(apart);
  }
  if (result.the_case.pump.friction.block_viscous > 0) result.expectations.push_back(with_drag);
}

void add_pictured(const Study& study, Fig34Study& result) {
  const double inertia = kInertias[1];
  const auto add = [&](const std::string& name, const Fig34Point& point) {
    result.pictured.emplace_back(name, study.simulate(point, result.options.windows, true));
  };
  result.pictured = {{"rigid, no Cc", result.rigid}, {"rigid, with Cc", result.rigid_with_drag}};
  add("as ADAMS by default, c 5 s/m", adams_by_default());
  add("the same, 50 um of backlash", {2.2, adams_approach(), 50e-6, 5, inertia, false});
  add("stiff, no backlash, c 50 s/m", {1, kStiff, 0, 50, inertia, false});
  add("stiff, 20 um of backlash, c 0.5 s/m", {1, kStiff, 20e-6, 0.5, inertia, false});
  add("the same, with Cc", {1, kStiff, 20e-6, 0.5, inertia, true});
}

}  // namespace

double adams_approach() { return 1e-3 * std::pow(kFig34Force / 1e5, 1 / 2.2); }

Fig34Point adams_by_default() { return {2.2, adams_approach(), 0, 5, kInertias[1], false}; }

double Fig34Range::spread() const { return maximum > 0 ? (maximum - minimum) / maximum : 0; }

double Fig34Curve::largest() const { return std::max(std::abs(least), std::abs(greatest)); }

bool Fig34Expectation::holds() const {
  return std::any_of(found.begin(), found.end(), [&](const Found& f) { return inside(f); });
}

bool Fig34Study::as_expected() const {
  return std::all_of(expectations.begin(), expectations.end(),
                     [](const Fig34Expectation& e) { return e.holds(); });
}

Fig34Curve fig34_curve(const Case& as_read, const Fig34Point& point, const Fig34Options& options,
                       const PartProgress& progress_of) {
  return Study(with_rigid_teeth(as_read, progress_of), options)
      .simulate(point, options.windows, true);
}

Fig34Study run_fig34_study(const Case& as_read, const Fig34Options& options,
                           const PartProgress& progress_of) {
  Fig34Study result;
  result.options = options;
  if (result.options.approaches.empty())
    result.options.approaches = {kStiff, 5e-6, adams_approach()};
  PreparedCase ready = with_rigid_teeth(as_read, progress_of);
  result.the_case = ready.the_case;
  const bool drag = result.the_case.pump.friction.block_viscous > 0;
  const Study study(std::move(ready), result.options);

  result.rigid = study.rigid(false);
  result.rigid_with_drag = study.rigid(true);
  result.rigid_at_0 = interpolated(result.rigid, 0);
  result.rigid_at_38 = interpolated(result.rigid, 38);
  const Gear& mesh = result.the_case.pump.gear;
  // The block pushes the shaft by so much at most, on the arm (d/2) cos(ap).
  result.reversing_torque = std::max(0.0, result.rigid.greatest) * mesh.pitch_diameter / 2;
  if (result.the_case.operation.speed_rpm < 0)
    result.reversing_torque = std::max(0.0, -result.rigid.least) * mesh.pitch_diameter / 2;
  result.mismatch = off_rated_condition(result.the_case);
  if (result.applies()) add_expectations(study, result, progress_of("what was expected"));
  add_pictured(study, result);
  result.points = grid(result.options, drag);
  result.curves =
      study.simulate(result.points, result.options.windows, progress_of("grid of contact laws"));
  return result;
}

}  // namespace bentaxis::study
