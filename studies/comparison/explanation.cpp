#include "bentaxis/study/explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/text.h"

namespace bentaxis::study {
namespace {

std::string change_text(const ExplainingChange& change) {
  return joined(change.parameters, " and ", [](const auto& p) {
    return fmt::format("{} {:.6g} -> {:.6g}{}", p.name, p.from, p.to, unit_after(p.unit)) +
           (p.from != 0 ? fmt::format(" ({:+.3g} %)", 100 * (p.to / p.from - 1)) : "");
  });
}

// Rounded down, so that 99.98 % is no 100 %.
double percent(double share) { return std::floor(1000 * share) / 10; }

}  // namespace

bool is_operating_condition(const std::string& name) {
  static const std::vector<std::string> kConditions = {
      "operation.speed_rpm", "pressure.delivery_bar", "pressure.suction_bar", "load.cracking_bar"};
  return contains(kConditions, name);
}

const ExplainingChange* Explanation::cause() const {
  if (!left_out.empty() && left_out.front().share >= kPair) return &left_out.front();
  const auto first = [](const std::vector<ExplainingChange>& changes, double enough) {
    const auto found = std::find_if(changes.begin(), changes.end(),
                                    [&](const auto& change) { return change.share >= enough; });
    return found == changes.end() ? nullptr : &*found;
  };
  const ExplainingChange *const single = first(singles, kSingle), *const pair = first(pairs, kPair);
  if (single == nullptr || pair == nullptr) return single != nullptr ? single : pair;
  return pair->rest_over_allowed <= 1 && single->rest_over_allowed > 1 ? pair : single;
}

std::string Explanation::text() const {
  if (!reason.empty()) return "No explanation was searched for: " + reason;
  const ExplainingChange* const found = cause();
  if (found == nullptr) {
    std::string text =
        fmt::format("No parameter of the case explains the difference ({} tried", tried);
    const auto worth_naming = [](const std::vector<ExplainingChange>& changes) {
      return !changes.empty() && changes.front().share >= kWorthNaming;
    };
    if (worth_naming(singles))
      text += fmt::format("; the best, {}, explains {:g} % of it", change_text(singles.front()),
                          percent(singles.front().share));
    if (worth_naming(pairs))
      text += fmt::format("; the best pair, {}, {:g} %", change_text(pairs.front()),
                          percent(pairs.front().share));
    return text + ").";
  }
  std::string text = fmt::format(
      "{} {} {:g} % of the difference; the rest is at most {:.2g} of peak ({})",
      change_text(*found), found->parameters.size() == 1 ? "explains" : "together explain",
      percent(found->share), found->rest_over_peak, found->rest_channel);
  if (found->rest_over_allowed > 1)
    text += fmt::format(", {:.3g} times what is allowed: other causes remain",
                        found->rest_over_allowed);
  std::vector<std::string> same, others;
  for (const auto& p : found->parameters) append(same, p.look_same);
  for (const ExplainingChange& other : singles) {
    if (&other == found || other.share <= kMentioned) continue;
    const std::string& name = other.parameters.front().name;
    bool known = false;
    for (const std::string& one : same) known = known || one == name;
    if (!known) others.push_back(fmt::format("{} {:g} %", name, percent(other.share)));
  }
  text += others.empty() ? fmt::format("; nothing else above {:g} %", 100 * kMentioned)
                         : fmt::format("; alone {}", fmt::join(others, ", "));
  text += ".";
  if (std::all_of(found->parameters.begin(), found->parameters.end(),
                  [](const auto& p) { return is_operating_condition(p.name); }))
    text += " The reference seems to be of another operating condition than the case.";
  if (!same.empty())
    text += fmt::format(" These data do not distinguish it from: {}.", fmt::join(same, ", "));
  return text;
}

}  // namespace bentaxis::study
