// How a case stands against printed numbers of its pump, for the report of compare.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/published.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/progress.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// Facts of a case under a model's assumptions, by the names that files of printed numbers use.
compare::Facts facts_of(const Case& the_case, const Assumptions& assumptions);

/// Makes of a case and its assumptions what a publication compares it with.
/// @throws InputError for a fact that cannot be set
void apply_variant(const compare::PublishedVariant& variant, Case& the_case,
                   Assumptions& assumptions);

/// A publication about a pump: its numbers, and where they are from.
struct PrintedNumbers {
  compare::Published numbers;
  std::string source;
};
/// The first publication of a folder of published data whose pump all these facts describe; nothing
/// where there is none or no folder.
std::optional<PrintedNumbers> printed_numbers_of(const std::filesystem::path& folder,
                                                 const std::vector<compare::Facts>& all_facts);

/// A model's case and the result already computed from it.
struct PublishedInput {
  const Case* the_case;
  Assumptions assumptions;
  const ResultTable* table;
};

/// Angles of a turn at which a variant is run, at most: printed numbers have three digits.
inline constexpr int kMaxVariantSamples = 1440;

/// One model under the variants of a publication, driven, each run once.
class VariantRuns {
 public:
  /// `input` must live as long as this does.
  VariantRuns(Model model, const PublishedInput& input, PartProgress progress_of = silent())
      : model_(model), input_(input), progress_of_(std::move(progress_of)) {}
  compare::PublishedRun operator()(const compare::PublishedVariant& variant);

 private:
  Model model_;
  const PublishedInput& input_;
  PartProgress progress_of_;
  std::map<std::string, ResultTable> tables_;
};

/// Holds both models to printed numbers. Recomputes the variants that the publication compares,
/// driven.
compare::PublishedSection judge_case(const compare::Published& published,
                                     const PublishedInput& analytic,
                                     const PublishedInput& multibody,
                                     const PartProgress& progress_of = silent());

/// Holds both models at an operating point to printed numbers, with the delivery pressure that a
/// number needs where the file asks for it.
/// @throws InputError where the numbers are of another pump
compare::PublishedSection judge_point(const compare::Published& published,
                                      const OperatingPoint& point,
                                      const PartProgress& progress_of = silent());

/// The section for the first pump of a folder of published data that both cases are one of, by
/// their facts; nothing where there is none or no folder.
std::optional<compare::PublishedTable> published_section(
    const std::filesystem::path& folder, const PublishedInput& analytic,
    const PublishedInput& multibody, const PartProgress& progress_of = silent());

}  // namespace bentaxis::study
