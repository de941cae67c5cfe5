// Printed numbers as data: what a publication says about a pump, and how results stand against it
// (reference_data/published). Uses expressions over columns and named facts of a case; no physics.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/results/result_table.h"

namespace bentaxis::compare {

/// Named numbers that describe a case and a model's assumptions ("speed_rpm", "piston_friction" as
/// 0 or 1), in the unit of the name.
using Facts = std::map<std::string, double>;
/// What facts must be: name to [low, high].
using FactRanges = std::map<std::string, std::pair<double, double>>;

/// A case at which the publication gives numbers.
struct PublishedCondition {
  std::string name, text;
  FactRanges facts;

  /// What a case differs in from this condition, in words; "" where it meets it.
  std::string mismatch(const Facts& of_case) const;
};

/// A change of the case that the publication itself makes ("without viscous torque").
struct PublishedVariant {
  std::string name, text;
  Facts set;
};

/// How a curve becomes the number that is compared.
enum class Measure {
  fact,  ///< no curve: a fact of the case
  mean,  ///< over the turn, or over [from_deg, to_deg]
  minimum,
  maximum,
  largest,       ///< largest magnitude
  range,         ///< smallest to largest value: both must lie in the window
  at,            ///< value at at_deg
  sign_changes,  ///< how often the curve changes sign in a turn
  main_order,    ///< order of the largest harmonic
};

struct PublishedNumber {
  std::string quantity;   ///< in words
  std::string where;      ///< page, section, table or figure
  std::string status;     ///< "used to infer the geometry", "calibrated" or "predicted"
  std::string condition;  ///< name, or "" where the case does not matter
  std::string variant;    ///< name, or ""
  std::string minus;      ///< a variant whose number is taken off, or ""
  std::string study;      ///< the study that computes it; "" is a comparison of two models
  std::string unit;
  std::string note;
  std::string not_comparable;  ///< why no result can be held to it, or ""
  bool repeats = false;        ///< says what another row says: not counted
  bool find_pressure = false;  ///< the delivery pressure at which `low` is reached is of interest
  Measure measure = Measure::mean;
  std::vector<std::string> channels;  ///< several: the magnitude of the vector
  std::string fact;                   ///< of Measure::fact
  double from_deg = 0, to_deg = 360, at_deg = 0;
  double factor = 1;
  std::string times;            ///< a fact that the curve is multiplied by, or ""
  std::optional<double> value;  ///< printed; inside is within tolerance
  double tolerance = 0;
  double low, high;  ///< window, or value -+ tolerance

  bool predicted() const { return status == "predicted"; }
  bool calibrated() const { return status == "calibrated"; }
};

struct Published {
  std::string name;  ///< of the pump
  FactRanges identity;
  std::vector<PublishedCondition> conditions;
  std::vector<PublishedVariant> variants;
  std::vector<PublishedNumber> numbers;

  /// Whether a case is one of this pump: by its facts, never by its name.
  bool describes(const Facts& facts) const { return mismatch(facts).empty(); }
  /// The variant of this name; one that sets nothing where there is none.
  PublishedVariant variant(const std::string& variant_name) const;
  /// What a case differs in from this pump, in words; "" where it is one.
  std::string mismatch(const Facts& facts) const;
};

/// Reads a file of printed numbers. @throws InputError naming file, line and key.
Published read_published(const std::filesystem::path& file);

/// One model's result under a variant, with the facts that then hold. No table: not run.
struct PublishedRun {
  const ResultTable* table = nullptr;
  Facts facts;
};

/// A model's number under a row's measure: [low, high], equal where it is one number.
struct PublishedValue {
  double low = 0, high = 0;
  bool inside(const PublishedNumber& number) const {
    return low >= number.low && high <= number.high;
  }
};

/// In words: "22181 to 35803", or one number.
std::string text_of(const PublishedValue& value);

/// The number that one run gives for a row; nothing where the run did not compute it.
std::optional<PublishedValue> value_of(const PublishedNumber& number, const PublishedRun& run);

/// A model's run under the variant of this name; "" is the case as it is.
using RunOfVariant = std::function<PublishedRun(const std::string& variant)>;
/// The number under the row's variant, less that of the variant which the row takes off.
std::optional<PublishedValue> value_of(const PublishedNumber& number, const RunOfVariant& run);

enum class PublishedVerdict { inside, outside, not_comparable };
const char* to_string(PublishedVerdict verdict);

/// A row and what the models make of it.
struct PublishedRow {
  PublishedNumber number;
  std::string printed;                                ///< in words, with its unit
  std::string at;                                     ///< condition and variant in words, or ""
  std::vector<std::optional<PublishedValue>> values;  ///< by model; nothing where not comparable
  PublishedVerdict verdict = PublishedVerdict::not_comparable;
  std::string where;  ///< where printed, the row's note, why it is not comparable

  /// Whether the row counts as validation.
  bool counted() const { return number.predicted() && !number.repeats; }
};

/// Where results stand against printed numbers.
struct PublishedSummary {
  int predicted = 0;             ///< rows that count as validation
  int predicted_comparable = 0;  ///< of them, rows this case can be held to
  int predicted_inside = 0;
  int other_comparable = 0;  ///< rows used to infer the geometry, or calibrated
  int other_inside = 0;
  void count(const PublishedRow& row);  ///< a row that repeats another does not count
  /// @param where  rows that are counted: "in this case"
  std::string text(const std::string& where = "in this case") const;
};

struct PublishedSection {
  std::vector<std::string> models;
  std::vector<PublishedRow> rows;
  PublishedSummary summary;

  /// Whether no number that a parameter of the case was set to is outside. Only these a case must
  /// meet: how it stands against the others is what was to be found out.
  bool calibrated() const;
};

/// Holds results to printed numbers.
/// @param run  (model, variant) -> its result; variant "" is the case as it was run
/// @param study  which numbers: those of this study and those of a comparison
PublishedSection judge_published(
    const Published& published, const std::vector<std::string>& models,
    const std::function<PublishedRun(const std::string& model, const PublishedVariant& variant)>&
        run,
    const std::string& study = "");

/// Where the results stand against printed numbers.
struct PublishedTable {
  std::string text;
  PublishedSection section;
};

}  // namespace bentaxis::compare
