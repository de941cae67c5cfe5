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
  std::string picture;    ///< SVG, or ""
  std::string not_valid;  ///< "over 7.5 % of the turn": no pump behaves so there; "": valid
};

/// A file or folder of which nothing can be said.
struct UnreadFile {
  std::string path;    ///< from the folder that is indexed
  std::string reason;  ///< why it cannot be read, as "Permission denied"
};

/// What a report's JSON says, without its paths and picture; nothing where the text is no report.
std::optional<IndexEntry> index_entry(const std::string& json_text);

/// Why a text is not read although it may be a report: it is no JSON, or a report of which parts
/// are missing. "" where it is a report, or JSON of something else.
std::string damage_of(const std::string& json_text);

/// The pump's drawing in a report's page; "" where it has none.
std::string picture_of_page(const std::string& html);

/// Differing ones first, then those that are not valid throughout, then those with warnings, each
/// by the worst channel; those that have neither a verdict nor a warning last.
void sort_by_worst(std::vector<IndexEntry>& entries);

/// How many reports say what, and which is the worst, in two sentences.
/// @param entries  sorted by sort_by_worst()
/// @param unread   of which nothing can be said; the headline says so
std::string index_headline(const std::vector<IndexEntry>& entries,
                           const std::vector<UnreadFile>& unread = {});

/// The verdict of a report in one or two words, as on its page.
std::string index_word(const IndexEntry& entry);
/// What is wrong in one that does not agree: "differs", "no design", "refuted".
std::string index_fault(const IndexEntry& entry);

/// The page: a table that needs no script, and a filter for those who have one.
/// @param title    of the page
/// @param skipped  files that are no report, to be named
std::string index_page(const std::string& title, const std::vector<IndexEntry>& entries,
                       const std::vector<std::string>& skipped,
                       const std::vector<UnreadFile>& unread = {});

/// {"schema": 1, "headline": "..", "reports": [..], "unread": [..]} with the same content but for
/// the pictures.
std::string index_json(const std::vector<IndexEntry>& entries,
                       const std::vector<UnreadFile>& unread = {});

}  // namespace bentaxis::report
