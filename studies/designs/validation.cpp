#include "bentaxis/designs/validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/column_values.h"
#include "bentaxis/results/periodic_lines.h"
#include "bentaxis/study/published_section.h"

namespace bentaxis::designs {
namespace {

constexpr double kCoverage = 2;  // u_val's, for about 95 %

// Standard uncertainty of what lies within -+ half, anywhere alike (JCGM 100, 4.3.7).
double of_half_width(double half) { return half / std::sqrt(3.0); }

// A row that gives E: one number of the model against a printed one, or a window's middle.
bool gives_error(const compare::PublishedRow& row) {
  const compare::Measure measure = row.number.measure;
  if (measure == compare::Measure::sign_changes || measure == compare::Measure::main_order)
    return false;  // whole numbers
  if (row.values.empty() || !row.values.front()) return false;
  const auto& value = *row.values.front();
  return value.low == value.high && std::isfinite(row.number.low) && std::isfinite(row.number.high);
}

bool comparable(const compare::PublishedRow& row) {
  return row.verdict != compare::PublishedVerdict::not_comparable;
}

// The model's numbers of rows, for a sample.
Further numbers_of(const std::vector<ValidationRow>& rows, const compare::Published& published) {
  return {rows.size(), [&rows, &published](const study::PreparedCase& ready,
                                           const ResultTable& table, std::span<double> values) {
            const study::PublishedInput input{&ready.the_case, ready.the_case.analytic, &table};
            study::VariantRuns runs(study::Model::analytic, input);
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const compare::PublishedNumber& number = rows[i].row.number;
              const auto value = compare::value_of(number, [&](const std::string& variant) {
                return runs(published.variant(variant));
              });
              if (!value) throw InputError(number.quantity + ": is not computed");
              values[i] = value->low;
            }
          }};
}

// Where both models assume the same, they differ by their numerical errors.
bool same_assumptions(const study::ComparisonResult& result) { return result.changes.empty(); }

// Of the models, at the samples of the case.
std::vector<double> differences(const study::ComparisonResult& result, const std::string& channel) {
  std::vector<double> list = column_of(result.analytic, result.analytic.find(channel));
  const std::size_t other = result.multibody.find(channel);
  for (std::size_t row = 0; row < list.size(); ++row)
    list[row] = std::abs(list[row] - result.multibody.at(row, other));
  return list;
}

std::vector<ValidationCurve> curves_of(const study::ComparisonResult& result,
                                       const UncertaintyResult& uncertainty) {
  std::vector<ValidationCurve> curves;
  const auto held = result.with ? result.with->held.find("analytic")
                                : std::map<std::string, study::Outcome::Held>::const_iterator();
  if (!result.with || held == result.with->held.end() || uncertainty.theta_deg.empty())
    return curves;
  const study::Outcome::Held& reference = held->second;
  const ResultTable& data = reference.reference;
  const auto absolute = study::reference_in(result.options.with).absolute;
  for (const CurveBand& band : uncertainty.bands) {
    const compare::ReferenceChannel* found = result.with->find("analytic", band.channel.name);
    const std::size_t column = data.find(band.channel.name);
    if (found == nullptr || !found->comparison.compared() || column == data.columns()) continue;
    ValidationCurve curve;
    curve.channel = band.channel;
    const std::vector<double>& angles = data.theta_deg;
    const std::size_t simulated = reference.result.find(band.channel.name);
    const std::vector<double> deviations = on_lines(uncertainty.theta_deg, band.deviation, angles);
    const std::vector<double> numerical =
        same_assumptions(result)
            ? on_lines(result.analytic.theta_deg, differences(result, band.channel.name), angles)
            : std::vector<double>(angles.size(), 0);
    const auto of_unit = absolute.find(band.channel.unit);
    const double tolerance = found->comparison.tolerance * found->comparison.peak +
                             (of_unit == absolute.end() ? 0 : of_unit->second);
    // Half the width within which the reference may lie.
    const auto half_width = [&](std::size_t row) {
      double half = tolerance + reference.resampling.at(row, column);
      if (reference.low.rows() > 0)
        half += (reference.high.at(row, column) - reference.low.at(row, column)) / 2;
      return half;
    };
    double worst = -1;
    std::size_t within = 0;
    for (std::size_t row = 0; row < data.rows(); ++row) {
      if (!is_computed(data.at(row, column))) continue;
      const ComparisonError error{reference.result.at(row, simulated), data.at(row, column),
                                  is_computed(numerical[row]) ? numerical[row] : 0, deviations[row],
                                  of_half_width(half_width(row))};
      curve.theta_deg.push_back(angles[row]);
      curve.data.push_back(error.data);
      within += error.within() ? 1 : 0;
      const double ratio = error.error() == 0 ? 0 : std::abs(error.error()) / error.validation();
      if (ratio > worst) {
        worst = ratio;
        curve.worst = error;
        curve.worst_deg = angles[row];
      }
    }
    if (curve.data.empty()) continue;
    curve.within_share = static_cast<double>(within) / static_cast<double>(curve.data.size());
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace

double ComparisonError::validation() const {
  return std::hypot(numerical, input, data_uncertainty);
}
bool ComparisonError::within() const { return std::abs(error()) <= kCoverage * validation(); }

Validation validation(const Case& the_case, const study::ComparisonResult& result,
                      std::size_t samples, const study::PartProgress& progress_of) {
  Validation v;
  const auto printed = study::printed_numbers_of(result.options.published,
                                                 {study::facts_of(the_case, the_case.analytic)});
  if (printed && result.published)
    for (const compare::PublishedRow& row : result.published->section.rows) {
      if (!comparable(row)) continue;
      if (!gives_error(row)) {
        ++v.without_error;
        continue;
      }
      ValidationRow one{row, {}};
      one.error.simulation = row.values.front()->low;
      one.error.data = row.number.value.value_or((row.number.low + row.number.high) / 2);
      one.error.data_uncertainty = of_half_width((row.number.high - row.number.low) / 2);
      if (const auto& other = row.values.back(); same_assumptions(result) && other)
        one.error.numerical = std::abs(other->low - one.error.simulation);
      v.rows.push_back(std::move(one));
    }
  UncertaintyOptions options;
  options.samples = samples;
  options.first_order = false;
  if (printed) options.further = numbers_of(v.rows, printed->numbers);
  v.uncertainty = uncertainty(the_case, options, progress_of);
  for (std::size_t i = 0; i < v.rows.size(); ++i)
    v.rows[i].error.input = v.uncertainty.further[i].deviation;
  if (result.with) v.reference = result.with->name;
  v.curves = curves_of(result, v.uncertainty);
  return v;
}

std::string validation_text(const Validation& v) {
  const auto of = [](const auto& all, const auto& error_of) {
    const auto count = std::count_if(all.begin(), all.end(),
                                     [&](const auto& one) { return error_of(one).within(); });
    return fmt::format("{} of {}", count, all.size());
  };
  std::string text = fmt::format(
      "uncertainty: {} samples; the error of the model could be 0 (|E| <= 2 u_val) for "
      "{} printed numbers",
      v.uncertainty.options.samples,
      of(v.rows, [](const ValidationRow& row) { return row.error; }));
  if (!v.curves.empty())
    text += fmt::format(", and all through the turn for {} curves",
                        of(v.curves, [](const ValidationCurve& curve) { return curve.worst; }));
  if (const std::size_t without = v.uncertainty.sampled.infeasible.size(); without > 0)
    text += fmt::format(
        "; {} of {} samples are infeasible pumps and are left out: u_input is that of the other "
        "samples alone",
        without, v.uncertainty.options.samples);
  return text;
}

}  // namespace bentaxis::designs
