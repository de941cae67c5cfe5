// Both models held to stored curves: every reference of a folder, and what each came to.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/study/explanation.h"
#include "bentaxis/study/reference_set.h"

namespace bentaxis::study {

/// One group of channels of one model, held against one reference.
struct GroupLine {
  std::string reference, kind, model, group;
  std::vector<compare::ReferenceChannel> channels;
  int compared = 0, missing = 0, failed = 0;  ///< numbers of channels
  double seconds = 0;

  /// The channel with the largest difference over its tolerance; nullptr where nothing was
  /// compared.
  const compare::ReferenceChannel* worst() const;
  bool differs() const;  ///< a channel that was compared does
  bool is_missing() const { return compared == 0 && failed == 0; }
  std::string verdict() const;
  /// Where it is worst and what that looks like; "" where nothing was compared.
  std::string text() const;
};

/// What one reference came to. The states are in the order of their gravity. One that lacks a curve
/// which it must have, or has gaps, does not agree: its state is `differs`, and differs() is false
/// where all that was compared agrees.
struct Outcome {
  enum class State { agrees, differs, unusable, failed };
  std::string name, kind;
  std::string error;  ///< why it differs as a whole, is unusable or failed
  State state = State::agrees;
  double seconds = 0;
  std::vector<GroupLine> lines;
  std::vector<std::string> notes;
  std::string other_case;  ///< in what its case differs from the one whose results were held, or ""
  std::vector<std::pair<std::string, std::string>> properties;
  struct Held {
    ResultTable result;                ///< at the angles of the reference where a model can follow
    ResultTable reference, low, high;  ///< at its angles; with a tube what the reference spans
    ResultTable resampling;            ///< how far the reference may be off (compare::Judgement)
    std::vector<compare::Judgement::Gap> gaps = {};  ///< where it has no points for long
  };
  std::map<std::string, Held> held;  ///< by model
  /// Of one that differs, where it was looked for (designs/explain.h).
  std::optional<Explanation> explanation = {};

  bool differs() const;  ///< a curve does
  /// What was found of a channel of a model; nullptr where it was not compared.
  const compare::ReferenceChannel* find(const std::string& model, const std::string& channel) const;
  /// The line of a group with the largest difference over its tolerance; nullptr where nothing was
  /// compared.
  const GroupLine* worst_line(const std::string& group) const;
};

/// Difference of a channel over what is allowed; -1 where nothing was compared.
double severity(const compare::ReferenceChannel& channel);

/// Holds both models to one reference. Interrupted alone gets out; other errors are the outcome.
Outcome hold(const ReferencePlace& place, const PartProgress& progress_of = silent());

/// Results that are there already.
using ResultOf = std::function<ReferenceRun(Model)>;
/// The same model at other angles, deg; no function where it cannot be run there.
using ResultAt = std::function<ResultTable(Model, const std::vector<double>& theta_deg)>;
using CaseOf = std::function<const Case&(Model)>;

/// Holds results to the one reference of a folder: a third curve beside those of both models. Its
/// own case is not run; what differs in it is said (`other_case`).
/// @throws InputError where the folder cannot be used
Outcome hold_results(const std::filesystem::path& folder, const CaseOf& case_of,
                     const ResultOf& result_of, const ResultAt& result_at = {});
/// The one reference that `hold_results` would take. @throws InputError
compare::ReferenceDescription reference_in(const std::filesystem::path& folder);

/// A line as words: what was found, of how much allowed, where.
std::string line_text(const GroupLine& line);
/// What a single reference came to, in a sentence.
std::string held_text(const Outcome& outcome);

/// Lines that compare something, worst first.
std::vector<const GroupLine*> sorted_lines(const std::vector<Outcome>& outcomes);
/// Groups without any curve in the reference, by reference, in words.
std::vector<std::string> missing_lines(const std::vector<Outcome>& outcomes);

/// All outcomes as plain text: a table, worst first, then what is missing and notes.
std::string regression_text(const std::vector<Outcome>& outcomes);
/// All outcomes in a sentence.
std::string summary(const std::vector<Outcome>& outcomes);

}  // namespace bentaxis::study

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/study/reference_curves.h")
#include "bentaxis/study/reference_curves.h"
#endif
