// How far a model is from data, and how well that is known: ASME V&V 20-2009, Standard for
// Verification and Validation in Computational Fluid Dynamics and Heat Transfer, sections 1 and 5.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/designs/uncertainty.h"
#include "bentaxis/study/comparison.h"

namespace bentaxis::designs {

/// Comparison error E = S - D of a simulation S with data D, and its standard uncertainty.
struct ComparisonError {
  double simulation = 0, data = 0;
  double numerical = 0;         ///< of S: what both models, which solve the same, differ by
  double input = 0;             ///< of S: standard deviation by the uncertain parameters
  double data_uncertainty = 0;  ///< standard uncertainty of D

  double error() const { return simulation - data; }
  double validation() const;  ///< u_val, root of the sum of squares
  /// Whether E could be due to what is not known of S and D: |E| <= 2 u_val.
  bool within() const;
};

/// A printed number.
struct ValidationRow {
  compare::PublishedRow row;
  ComparisonError error;
};

/// A curve of the reference of --with.
struct ValidationCurve {
  Channel channel;
  std::vector<double> theta_deg, data;
  ComparisonError worst;  ///< where |E| / u_val is largest
  double worst_deg = 0;
  double within_share = 0;  ///< of the turn: |E| <= 2 u_val
};

struct Validation {
  UncertaintyResult uncertainty;
  std::vector<ValidationRow> rows;
  std::size_t without_error =
      0;                  ///< comparable rows that give no number: ranges, one-sided ones, counts
  std::string reference;  ///< name of --with's, or ""
  std::vector<ValidationCurve> curves;
};

/// @param the_case  of the analytic model, as it was before its hydraulics were solved
/// @throws InputError, ComputationError
Validation validation(const Case& the_case, const study::ComparisonResult& result,
                      std::size_t samples,
                      const study::PartProgress& progress_of = study::silent());

/// The same in words, a line.
std::string validation_text(const Validation& validation);

}  // namespace bentaxis::designs

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/designs/validation_section.h")
#include "bentaxis/designs/validation_section.h"
#endif
