// Both models held to stored curves: every reference of a folder, and what each came to.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/study/reference_set.h"

namespace bentaxis::study {

/// One group of channels of one model, held against one reference.
struct GroupLine {
  std::string reference, kind, model, group;
  std::vector<compare::ReferenceChannel> channels;
  int compared = 0, missing = 0, failed = 0;  ///< numbers of channels
  double seconds = 0;

  /// The channel nearest to failing or furthest beyond; nullptr where nothing was compared.
  const compare::ReferenceChannel* worst() const;
  bool is_missing() const { return compared == 0 && failed == 0; }
  std::string verdict() const;
  /// Where it is worst and what that looks like; "" where nothing was compared.
  std::string text() const;
};

/// What one reference came to. The states are in the order of their gravity.
struct Outcome {
  enum class State { agrees, differs, unusable, failed };
  std::string name, kind;
  std::string error;  ///< why it differs as a whole, is unusable or failed
  State state = State::agrees;
  double seconds = 0;
  std::vector<GroupLine> lines;
  std::vector<std::string> notes;
  std::vector<std::pair<std::string, std::string>> properties;
  /// By model: the reference at the result's angles, and the result.
  std::map<std::string, std::pair<ResultTable, ResultTable>> tables;
};

/// Difference of a channel over what is allowed; -1 where nothing was compared.
double severity(const compare::ReferenceChannel& channel);

/// Holds both models to one reference. Interrupted alone gets out; other errors are the outcome.
Outcome hold(const ReferencePlace& place, const PartProgress& progress_of = silent());

/// Lines that compare something, worst first.
std::vector<const GroupLine*> sorted_lines(const std::vector<Outcome>& outcomes);
/// Groups without any curve in the reference, by reference, in words.
std::vector<std::string> missing_lines(const std::vector<Outcome>& outcomes);

/// All outcomes as plain text: a table, worst first, then what is missing and notes.
std::string regression_text(const std::vector<Outcome>& outcomes);
/// All outcomes in a sentence.
std::string summary(const std::vector<Outcome>& outcomes);

}  // namespace bentaxis::study
