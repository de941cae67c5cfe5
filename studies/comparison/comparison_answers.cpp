#include "bentaxis/study/comparison_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bentaxis/pump/lists.h"
#include "bentaxis/study/engine_comparison.h"
#include "bentaxis/study/lost_digits.h"
#include "bentaxis/study/shown_pump.h"

namespace bentaxis::study {
namespace {

const char* found_text(const Outcome& outcome) {
  switch (outcome.state) {
    case Outcome::State::agrees:
      return " agrees: ";
    case Outcome::State::differs:
      return outcome.differs() ? " differs: " : " is incomplete: ";
    case Outcome::State::unusable:
      return " cannot be used: ";
    case Outcome::State::failed:
      break;
  }
  return " could not be computed: ";
}

void add_outcome(std::vector<std::string>& sentences, const Outcome& outcome,
                 bool in_headline = false) {
  if (!in_headline) sentences.push_back(outcome.name + found_text(outcome) + held_text(outcome));
  if (outcome.explanation) sentences.push_back(outcome.name + ": " + outcome.explanation->text());
}

// Where an assumption matters most, over the peak of the reaction; "" where it does nothing.
std::string contribution_text(const compare::Split& split, std::size_t assumption) {
  const auto share = [&](const compare::ChannelSplit& channel) {
    return channel.computed && channel.peak > 0
               ? channel.contributions[assumption].largest / channel.peak
               : 0.0;
  };
  const compare::ChannelSplit* most = nullptr;
  for (const compare::ChannelSplit& channel : split.channels)
    if (share(channel) > (most == nullptr ? 0.0 : share(*most))) most = &channel;
  if (most == nullptr) return {};
  return fmt::format("The assumption on {} changes {} most: by up to {:.4g} {} ({:.3g} % of peak).",
                     split.assumptions[assumption], most->channel.name,
                     most->contributions[assumption].largest, most->channel.unit,
                     100 * share(*most));
}

// How many reactions lose digits, and the worst.
std::string lost_digits_text(const std::vector<RoundingLine>& lines) {
  std::size_t lost = 0;
  const RoundingLine* worst = nullptr;
  for (const RoundingLine& line : lines) {
    if (rounding_warnings({line}).empty()) continue;
    ++lost;
    // A loss that could not be estimated is the worst.
    if (worst == nullptr || std::isnan(line.total()) || line.total() > worst->total())
      worst = &line;
  }
  if (worst == nullptr) return {};
  return fmt::format("Digits are lost to round-off in {} of {} reactions; worst: {}.", lost,
                     lines.size(), rounding_warnings({*worst}).front());
}

}  // namespace

std::vector<std::string> comparison_answers(const ComparisonResult& r) {
  std::vector<std::string> sentences;
  if (r.with) add_outcome(sentences, *r.with, r.agrees_but_for_reference());
  // Where an engine differs the headline says so.
  if (r.engines && r.engines->agrees()) sentences.push_back(r.engines->headline());
  if (r.split)
    for (std::size_t a = 0; a < r.split->assumptions.size(); ++a)
      if (std::string text = contribution_text(*r.split, a); !text.empty())
        sentences.push_back(std::move(text));
  if (r.other) {
    // Whose they are is said of every sentence.
    const auto add = [&](Model model, const ResultTable& table, const auto& limits) {
      for (const std::string& sentence : pump_answers(r.of(model), table, limits))
        sentences.push_back(r.pump_of(model) + ": " + sentence);
    };
    add(Model::analytic, r.analytic, r.limits);
    add(Model::multibody, r.multibody, r.other->limits);
  } else {
    // Under unequal assumptions the other model's are others; in a smaller scene it has none.
    append(sentences,
           pump_answers(r.first, r.analytic, r.limits,
                        r.split                           ? "By the analytic model: "
                        : only_one_computed(r.comparison) ? "By the analytic model alone: "
                                                          : ""));
  }
  if (std::string text = lost_digits_text(r.rounding); !text.empty())
    sentences.push_back(std::move(text));
  return sentences;
}

std::vector<std::string> regression_answers(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> sentences;
  const std::vector<const GroupLine*> lines = sorted_lines(outcomes);
  std::vector<const Outcome*> wrong;
  for (const Outcome& outcome : outcomes)
    if (outcome.state != Outcome::State::agrees) wrong.push_back(&outcome);
  if (wrong.empty() && !lines.empty())
    sentences.push_back("Nearest to its limit: " + lines.front()->reference + ": " +
                        line_text(*lines.front()) + ".");
  const auto place = [&](const Outcome& outcome) {
    return std::find_if(lines.begin(), lines.end(),
                        [&](const GroupLine* line) { return line->reference == outcome.name; }) -
           lines.begin();
  };
  // One that could not be held to its curves is worse than any difference.
  std::stable_sort(wrong.begin(), wrong.end(), [&](const Outcome* a, const Outcome* b) {
    if (a->error.empty() != b->error.empty()) return b->error.empty();
    return place(*a) < place(*b);
  });
  for (const Outcome* outcome : wrong) add_outcome(sentences, *outcome);
  return sentences;
}

std::string regression_report(const std::vector<Outcome>& outcomes) {
  std::string text = summary(outcomes) + "\n";
  for (const std::string& answer : regression_answers(outcomes)) text += answer + "\n";
  return text + "\n" + regression_text(outcomes);
}

}  // namespace bentaxis::study
