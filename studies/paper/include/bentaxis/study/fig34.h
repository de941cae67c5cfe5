// What the paper's Fig. 34 can mean: the tooth force along x2 that Roccatello & Nervegna (2009)
// show of bevel teeth in three-dimensional contact, without a contact parameter. For which
// stiffness, exponent, backlash, damping and block inertia does a compliant contact stay inside the
// printed axes and change its sign as printed, and for which not?
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

/// The printed axes of Rcs_x2, N, on either side of 0.
inline constexpr double kFig34Axes = 250;
/// A force of either sign that can be seen in them, N: a hundredth of their span.
inline constexpr double kFig34Visible = 5;

/// A contact law and what it moves.
struct Fig34Point {
  double exponent = 1;       ///< e
  double approach = 0;       ///< m, at kFig34Force: softness, whatever the exponent
  double backlash = 0;       ///< j, m
  double dissipation = 0;    ///< c, s/m
  double block_inertia = 0;  ///< kg m2, axial
  bool drag = false;         ///< the case's block_viscous; else none
};
/// Force at which softness is stated, N.
inline constexpr double kFig34Force = 100;
/// The contact defaults of ADAMS: 1e5 N at 1 mm with the exponent 2.2.
double adams_approach();
/// They, without backlash and drag on the block; c = 5 s/m, which no default corresponds to.
Fig34Point adams_by_default();

/// Motions whose largest force differs by more than this share between windows do not repeat:
/// their statistics have two significant digits at most.
inline constexpr double kFig34Repeats = 0.01;

/// A quantity over the windows of one simulation.
struct Fig34Range {
  double minimum = 0, maximum = 0;
  /// (maximum - minimum) / maximum; 0 where all are 0.
  double spread() const;
};

/// The force along x2, N, in windows of as many turns each, and what it shows.
struct Fig34Curve {
  std::vector<double> theta_deg, force;  ///< of the first turn that counts; empty where not kept
  double least = 0, greatest = 0;        ///< N, in the first window
  double apart = 0;                      ///< share of the time without contact, first window
  double sign_changes = 0;               ///< per turn, between visible forces, first window
  double both_signs = 0;    ///< share of pitches (360/N) that see both, least of all windows
  Fig34Range largest_over;  ///< N, largest magnitude of each window
  Fig34Range apart_over;    ///< share of the time without contact in each window
  std::string failure;      ///< why it could not be simulated, or ""

  double largest() const;  ///< N, in the first window
  bool done() const { return failure.empty(); }
  /// In every window.
  bool inside() const { return done() && largest_over.maximum <= kFig34Axes; }
  /// As the text describes it: it changes its sign periodically. In every window.
  bool reverses() const { return done() && both_signs == 1; }
  bool repeats() const { return done() && largest_over.spread() <= kFig34Repeats; }
};

struct Fig34Options {
  std::vector<double> exponents = {1, 1.5, 2.2};
  std::vector<double> approaches;  ///< m; empty: 0.5 um, 5 um and that of ADAMS
  std::vector<double> backlashes = {0, 20e-6, 50e-6};
  std::vector<double> dissipations = {0.05, 0.5, 5, 50};
  std::vector<double> block_inertias = {1e-3, 1.5e-3, 2e-3};
  int turns_left_out = 2, turns = 2;  ///< turns of a window
  int windows = 3;                    ///< one behind the other
  int samples_per_turn = 1440;
};

/// What was expected before the study was written, and what came out.
struct Fig34Expectation {
  struct Found {
    double dissipation = 0;          ///< c, s/m; of rigid teeth 0
    double least = 0, greatest = 0;  ///< over block inertias, backlashes and windows
    double spread = 0;               ///< largest spread between the windows of one law
  };
  std::string what, unit;
  double low = 0, high = 0;  ///< window
  std::vector<Found> found;  ///< those expected say nothing of damping that could be repeated

  bool inside(const Found& f) const { return f.least >= low && f.greatest <= high; }
  /// For one dissipation at least.
  bool holds() const;
};

struct Fig34Study {
  Case the_case;
  /// What the case differs in from the pump, pressure and speed that the figure is of; "" where it
  /// is that: else the figure does not apply, and nothing is expected.
  std::string mismatch;
  Fig34Options options;
  Fig34Curve rigid, rigid_with_drag;       ///< the block turns as the shaft does
  double rigid_at_0 = 0, rigid_at_38 = 0;  ///< N, without drag
  double reversing_torque = 0;             ///< Nm, drag on the block from which on nothing reverses
  std::vector<Fig34Point> points;
  std::vector<Fig34Curve> curves;  ///< of the points, without their forces
  std::vector<std::pair<std::string, Fig34Curve>> pictured;
  std::vector<Fig34Expectation> expectations;
  bool applies() const { return mismatch.empty(); }
  bool as_expected() const;
};

/// The analytic model in time, at the case's pressure and speed, flanks = "two".
/// @param as_read  its contact and drive do not matter
/// @throws InputError at standstill; what cannot be simulated becomes a failure of its curve
Fig34Study run_fig34_study(const Case& as_read, const Fig34Options& options,
                           const PartProgress& progress_of);

/// The force along x2 by one contact law, in the first of the turns that count.
/// @throws InputError at standstill
Fig34Curve fig34_curve(const Case& as_read, const Fig34Point& point, const Fig34Options& options,
                       const PartProgress& progress_of);

/// A row per point.
std::string fig34_csv(const Fig34Study& study);
/// The curves of the picture.
std::string fig34_curves_csv(const Fig34Study& study);
/// The result in words, for a terminal.
std::string fig34_text(const Fig34Study& study);

}  // namespace bentaxis::study

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/study/fig34_document.h")
#include "bentaxis/study/fig34_document.h"
#endif
