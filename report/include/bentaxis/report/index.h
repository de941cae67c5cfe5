// A page over many reports: what each says in one row.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bentaxis::report {

/// One report, by its JSON.
struct IndexEntry {
  std::string json, page;  ///< paths from the folder that is indexed; page: "" where there is none
  std::string title, case_file, command, date, version;
  /// The worst of all verdicts of the report: of the models, of a reference, of calibrated numbers.
  /// Nothing where nothing was compared.
  std::optional<bool> agrees;
  std::vector<std::string> warnings;  ///< names: limits, timing, lost digits, implausible inputs
  std::string word, headline;
  std::string worst_channel;
  std::optional<double> worst_over_peak;
  std::string picture;  ///< SVG, or ""
};

/// What a report's JSON says, without its paths and picture; nothing where the text is no report.
std::optional<IndexEntry> index_entry(const std::string& json_text);

/// The pump's drawing in a report's page; "" where it has none.
std::string picture_of_page(const std::string& html);

/// Differing ones first, then those with warnings, each by the worst channel; those that have
/// neither a verdict nor a warning last.
void sort_by_worst(std::vector<IndexEntry>& entries);

/// How many reports say what, and which is the worst, in two sentences.
/// @param entries  sorted by sort_by_worst()
std::string index_headline(const std::vector<IndexEntry>& entries);

/// The page: a table that needs no script, and a filter for those who have one.
/// @param title    of the page
/// @param skipped  files that are no report, to be named
std::string index_page(const std::string& title, const std::vector<IndexEntry>& entries,
                       const std::vector<std::string>& skipped);

/// {"schema": 1, "headline": "..", "reports": [..]} with the same content but for the pictures.
std::string index_json(const std::vector<IndexEntry>& entries);

}  // namespace bentaxis::report
