// What data say about a pump: unknown parameters from printed numbers, windows, outputs and curves,
// and how well the data determine them and every reaction.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/published.h"
#include "bentaxis/designs/distribution.h"
#include "bentaxis/designs/least_squares.h"
#include "bentaxis/designs/output.h"
#include "bentaxis/designs/posterior.h"
#include "bentaxis/designs/variable.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::designs {

/// A parameter that the data are to determine, between bounds. Without a prior every value between
/// them is as likely as any other before there are data.
struct Unknown {
  Variable variable;
  double low, high;            ///< file's unit
  std::string condition = {};  ///< where it acts; "": a parameter of the pump, in all
  std::optional<Distribution> prior = std::nullopt;  ///< normal or lognormal, beside the bounds

  /// "pump.tilt_deg", of a condition "peak load: pressure.delivery_bar".
  std::string name() const;
};
/// "NAME=LOW:HIGH". @throws InputError naming the option, also where the parameter itself may not
/// have these values
Unknown unknown_of(const std::string& option, const std::string& text, const Case& base);

/// Settings of the rig or the publication under which data were taken.
struct Condition {
  std::string name;  ///< "": as the case says
  std::vector<std::pair<Variable, double>> settings = {};
};

enum class Use {
  fitted,     ///< unknowns are determined from it
  predicted,  ///< only held against what the others give
  left_out,   ///< neither, with a reason
};

/// What is known from outside: a value with its standard uncertainty, a window that a number or a
/// curve must not leave, or a curve.
struct Datum {
  struct Curve {
    std::size_t column;  ///< of a ChannelLayout
    std::vector<double> theta_deg, values, uncertainties;
  };
  std::string what, where, unit;
  Use use = Use::fitted;
  std::string reason = {};  ///< of one left out
  std::size_t condition = 0;
  std::string variant = {};  ///< of a publication
  // One of the three is there:
  std::optional<compare::PublishedNumber> printed = std::nullopt;
  std::optional<Output> output = std::nullopt;
  std::optional<Curve> curve = std::nullopt;

  std::optional<double> value = std::nullopt;  ///< none of windows and curves
  double low = 0, high = 0;                    ///< of a window; infinite where one-sided
  double uncertainty = 0;  ///< standard, of the value; of a window how soft its edges are

  /// How many numbers a model gives for it: 1; 2 for the range of a curve; those of a curve.
  std::size_t size() const;
};

/// Everything that files of data say.
struct IdentificationData {
  std::vector<Unknown> unknowns;
  std::vector<Condition> conditions = {{""}};  ///< the first: the case itself
  std::vector<compare::PublishedVariant> variants;
  std::vector<Datum> data;
  std::vector<std::filesystem::path> files;  ///< that were read, for messages
};

/// Reads one file of data (docs/identification.md) to what is there already.
/// @throws InputError naming file, line and key
void read_identification(const std::filesystem::path& file, const Case& base,
                         IdentificationData& data);

/// What the analytic model gives for the data as a function of the unknowns, in the files' units.
/// Immutable: serves many threads.
class DataModel {
 public:
  /// @param kernel  whether the batch kernel may compute what it can: the same to round-off, faster
  /// @throws InputError where there is no unknown, nothing to fit, or one unknown twice
  DataModel(Case base, IdentificationData data, bool kernel = true);
  ~DataModel();
  DataModel(DataModel&&) noexcept;

  const Case& base() const;
  const IdentificationData& data() const;
  std::size_t size() const { return data().unknowns.size(); }
  /// Where the numbers of a datum start in what predict() fills.
  std::size_t place_of(std::size_t datum) const;
  std::size_t numbers() const;  ///< of all data

  /// The case's own values, moved into the bounds.
  std::vector<double> start() const;
  /// What the model gives for all data but those left out (not_computed()).
  /// @return false where the values make no pump
  bool predict(std::span<const double> x, std::span<double> numbers) const;
  /// A residual of a datum: over its standard uncertainty; 0 inside a window.
  double residual(const Datum& datum, std::size_t number, double model) const;
  /// Residuals of the fitted data, and of the priors at the end.
  /// @param without         this one of the data is not fitted
  /// @param bounds_as_prior an unknown without a prior is pulled to the middle of its bounds as if
  ///                        they were a normal one of their standard deviation
  LeastSquaresProblem problem(std::optional<std::size_t> without = {},
                              bool bounds_as_prior = false) const;

  /// The pump with these values: the base case with them.
  Case pump(std::span<const double> x) const;
  /// Its reactions over the turn, as the base case assumes.
  ResultTable turn(std::span<const double> x) const;

 private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

/// A direction of the unknowns in which they can be moved together without the data noticing, or
/// the reverse, from the singular values of the derivatives.
struct Direction {
  double strength = 0;          ///< how much narrower the data make it than the bounds do
  std::vector<double> weights;  ///< of the unknowns over the standard deviation of their bounds
};

/// What the data determine at a solution, as if the model were linear there.
struct Information {
  std::vector<double> spread;         ///< standard deviation of each unknown before data
  std::vector<double> deviation;      ///< and after, bounds taken as normal with the same deviation
  std::vector<Direction> directions;  ///< the best determined first
  std::vector<std::string> words;     ///< what is determined only together with what, or not at all
};
/// @param jacobian  of problem() at x
/// @param at_bound  unknowns that a bound holds: no words say that the data leave them open
Information information_of(const DataModel& model, std::span<const double> x,
                           std::span<const double> jacobian,
                           const std::vector<std::size_t>& at_bound = {});

/// An unknown that ends at a bound, and that the data would take outside of it.
struct HeldUnknown {
  std::size_t unknown = 0;
  bool high = false;  ///< the upper bound
  double gain = 0;    ///< by which chi-square would fall there if the model were linear
};
/// Those that chi-square tells from a value inside: by more than 0.01.
std::vector<HeldUnknown> held_unknowns(const DataModel& model, const LeastSquaresFit& fit);

/// The p-value below which a fit is refuted: of a right model with right uncertainties one fit in
/// a thousand is refuted by chance.
inline constexpr double kFitRefutedBelow = 1e-3;
/// The p-value above which the residuals are too small for the stated uncertainties.
inline constexpr double kUncertaintiesTooLargeAbove = 1 - kFitRefutedBelow;

/// Probability that chi-square is larger than a value, with so many degrees of freedom (> 0).
double chi_square_p_value(double chi_square, std::size_t degrees_of_freedom);

/// Chi-square test of a fit.
struct GoodnessOfFit {
  double chi_square = 0;  ///< sum of the squared residuals, each over its standard uncertainty
  /// What counts as a datum: values, points of curves, priors, and windows that the fit leaves. A
  /// window that is kept tests nothing.
  std::size_t residuals = 0;
  /// Directions of the unknowns that were fitted to them: none along a bound that holds an unknown,
  /// and none that changes no residual.
  std::size_t fitted_directions = 0;
  std::optional<double> p_value = std::nullopt;  ///< nothing without degrees of freedom: no test

  std::size_t degrees_of_freedom() const { return residuals - fitted_directions; }
  /// Whether the data refute the model with these unknowns. Without degrees of freedom a fit passes
  /// through all data; it counts as refuted where it does not even do that.
  bool refuted() const;
  /// Whether residuals are smaller than the stated uncertainties let expect.
  bool uncertainties_too_large() const;
  /// Birge ratio, the root of chi-square over the degrees of freedom (at least one): by how much
  /// all stated uncertainties would have to be larger for the residuals to be as expected.
  double birge_ratio() const;
};
GoodnessOfFit goodness_of(const DataModel& model, const LeastSquaresFit& fit);

/// A parameter that was not unknown, fitted together with the unknowns.
struct FurtherUnknown {
  Variable variable;
  double before = 0, value = 0;  ///< in the case and fitted, in the file's unit
  GoodnessOfFit fit;             ///< with it
  /// Plausibility warnings that the fitted value causes, by their names (study/plausibility.h).
  std::vector<std::string> implausible = {};
};
/// The single parameters of the case that would improve a fit most if they were unknown too, the
/// best first; those whose fitted values are implausible after all others. All continuous
/// parameters that are active in the case are compared by their derivatives; those that promise
/// most are fitted with all unknowns.
std::vector<FurtherUnknown> further_unknowns(const DataModel& of_fit, const LeastSquaresFit& fit,
                                             int threads, const Progress& progress = {});

/// A datum or a prior, and how far the fit is from it.
struct WorstResidual {
  std::optional<std::size_t> datum;    ///< in IdentificationData::data
  std::optional<std::size_t> unknown;  ///< or of whose prior
  std::size_t number = 0;              ///< of the datum: the worst point of a curve
  double residual = 0;                 ///< over its standard uncertainty, with its sign
  double share = 0;                    ///< of chi-square that all numbers of the datum make up
};
/// Of all fitted data and priors, the largest first.
std::vector<WorstResidual> worst_residuals(const DataModel& model, const LeastSquaresFit& fit);

/// Limits of an unknown by its profile: the others are fitted anew at each of its values.
struct Profile {
  std::vector<double> values, rises;  ///< of the sum of squares above its smallest
  /// 95 %: where it rises by 3.841. Right only where the stated uncertainties are.
  double low = 0, high = 0;
  bool open_low = false, open_high = false;  ///< a bound is met before
};

/// Draws from the posterior: bounds, priors and data together.
struct Posterior : Draws {
  std::vector<double> numbers;  ///< count x DataModel::numbers()
};

/// A reaction over the turn.
struct ReactionBand {
  std::size_t column = 0;
  std::vector<double> low, middle, high;  ///< 2.5 %, 50 %, 97.5 %
  double half_width = 0;                  ///< largest over the turn, of the peak
  double peak = 0;                        ///< largest magnitude of the middle curve
};

/// What it takes to measure a reaction.
enum class Measured {
  on_a_rig,     ///< the drive torque: every test rig has a torque meter
  at_bearings,  ///< the loads of the shaft's bearings: force sensors in their seats
  nowhere,      ///< forces between parts that turn: no rig measures them
};
Measured measured_as(const std::string& quantity);

/// A measurement that could be made.
struct Candidate {
  Output output;
  Measured measured = Measured::nowhere;
  double deviation = 0;  ///< standard uncertainty it is taken to have
  double shrinks = 0;    ///< mean share by which the reactions' bands would become narrower
  std::string most;      ///< the reaction that gains most
  double most_shrinks = 0;
};

/// A datum predicted by all others.
struct LeftOut {
  std::size_t datum = 0;
  double value = 0, high = 0;  ///< predicted; of a range its two ends
  double deviation = 0;        ///< standard, of prediction and datum together
  double distance = 0;         ///< prediction to datum over it; 0 inside a window
};

struct IdentifyOptions {
  int starts = 8;  ///< the case's own values and points of the bounds
  std::uint64_t seed = 1;
  int draws = 400;         ///< of the posterior that are kept
  int steps = 2000;        ///< of every walker of the ensemble
  double measured = 0.01;  ///< standard uncertainty of candidates, of the reaction's peak
  bool profiles = true, posterior = true, leave_one_out = true;
  int threads = 0;
};

struct Minimum {
  std::vector<double> x;
  double sum_of_squares = 0;
  int starts = 0;  ///< how many led there
};

struct Identification {
  LeastSquaresFit fit;
  GoodnessOfFit goodness;
  std::vector<WorstResidual> worst;     ///< the largest first
  std::vector<FurtherUnknown> further;  ///< of a refuted fit: what would improve it most
  std::vector<Minimum> minima;          ///< best first
  std::vector<double> numbers;          ///< of the fit
  /// Of a refuted fit with all stated uncertainties times the Birge ratio.
  Information information;
  /// By unknown; empty where not asked for. Neither they nor posterior, bands and candidates are
  /// there of a refuted fit: they would rest on a model that the data refute.
  std::vector<Profile> profiles;
  Posterior posterior;
  std::vector<double> theta_deg;
  std::vector<ReactionBand> bands;  ///< of the reactions of piston 1, block, shaft and gear
  /// Those that every rig measures first, then the others in the order of `Measured`; of each kind
  /// the most useful first.
  std::vector<Candidate> candidates;
  std::vector<LeftOut> left_out;
  /// Where there are any, profiles, posterior and bands hold only if these bounds are right.
  std::vector<HeldUnknown> held;
};

/// A fit that the data refute (GoodnessOfFit::refuted()) is a result, no error.
/// @throws InputError, ComputationError
Identification identify(const DataModel& model, const IdentifyOptions& options,
                        const study::PartProgress& progress_of = study::silent());

// Its parts.
std::vector<Profile> profiles_of(const DataModel& model, const LeastSquaresFit& fit, int threads,
                                 const Progress& progress);
Posterior posterior_of(const DataModel& model, const LeastSquaresFit& fit,
                       const IdentifyOptions& options, const Progress& progress);
std::vector<LeftOut> leave_one_out(const DataModel& model, const LeastSquaresFit& fit, int threads,
                                   const Progress& progress);
/// Bands of the reactions and what further measurements would do to them.
void bands_of(const DataModel& model, const IdentifyOptions& options, Identification& result,
              const Progress& progress);

}  // namespace bentaxis::designs
