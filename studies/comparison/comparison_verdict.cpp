// The verdict of a comparison, in a word and in a sentence, and the cause of a difference.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bentaxis/compare/stated_difference.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/engine_comparison.h"

namespace bentaxis::study {

std::string pump_name(const Case& the_case, Model model) {
  return fmt::format("{} ({} model)", the_case.name, to_string(model));
}

bool ComparisonResult::checks_hold() const {
  return std::all_of(checks.begin(), checks.end(), [](const auto& check) { return check.holds(); });
}

bool ComparisonResult::agrees() const {
  if (!checks_hold() || comparison.incomplete() != nullptr) return false;
  if (budget && !budget->comparison.agrees()) return false;
  if (teeth && !split && !teeth->comparison.agrees()) return false;
  return split ? split->explained() : comparison.agrees();
}

bool ComparisonResult::agrees_but_for_reference() const {
  return agrees() && with && with->state != Outcome::State::agrees;
}

bool ComparisonResult::passes() const {
  return agrees() && !agrees_but_for_reference() && (!engines || engines->agrees());
}

namespace {

// A result in which the models differ, or that a check says must vanish and does not.
struct Failure {
  std::string name;   ///< of the column or the check
  std::string group;  ///< of the reactions whose round-off it carries
  double off = 0;     ///< in its unit
  double scale = 0;
};

// The reactions whose round-off a quantity carries: the film force's point is Th over Fh, torques
// about z2 are those of forces.
std::vector<std::string> carried_by(const std::string& group) {
  if (group == "xh_yh") return {"Th", "Fh"};
  if (group == "Tcs") return {"Rcs"};
  if (group == "Tc") return {"Rc"};
  // Parts of torques, by the forces of the pistons that make them.
  if (group == "parts of Tcs") return {"Rcs", "Rc"};
  if (group == "parts of Td") return {"Td", "Rs"};
  if (group == "teeth") return {"Rcs", "Rcn", "Th"};  // by forces of pairs and where these act
  return {group};
}

// Of a column of the budgets: the whole that it is a part of.
std::string whole_of(const std::string& column) {
  return column.starts_with("Tcs_")  ? "parts of Tcs"
         : column.starts_with("Td_") ? "parts of Td"
                                     : "Fh";
}

std::vector<Failure> failures_of(const ComparisonResult& r) {
  std::vector<Failure> failures;
  const auto add = [&](const compare::Comparison& comparison, const auto& group_of) {
    for (const auto& c : comparison.channels)
      if (c.judged && c.verdict == compare::Verdict::differs)
        failures.push_back({c.channel.name, group_of(c.channel), c.largest, c.peak});
  };
  add(r.comparison, [](const Channel& channel) { return channel.group; });
  if (r.budget)
    add(r.budget->comparison, [](const Channel& channel) { return whole_of(channel.name); });
  if (r.teeth && !r.split) add(r.teeth->comparison, [](const Channel&) { return "teeth"; });
  for (const auto& check : r.checks)
    if (!check.holds())
      failures.push_back({full_name(check), check.group, check.worst, check.scale});
  return failures;
}

std::vector<std::string> compared_groups(const compare::Comparison& comparison) {
  std::vector<std::string> groups;
  for (const auto& c : comparison.channels)
    if (c.compared()) add_once(groups, c.channel.group);
  return groups;
}

// Whether no difference over its peak is larger: what is allowed of xh and yh changes over the
// turn, and so what exceeds it most need not be the largest.
bool is_largest(const compare::Comparison& comparison, const compare::ChannelComparison& worst) {
  return !compare::is_nearest_to_limit(worst) &&
         std::none_of(comparison.channels.begin(), comparison.channels.end(), [&](const auto& c) {
           return c.judged && c.compared() && c.largest_over_peak() > worst.largest_over_peak();
         });
}

std::string where_in_words(const compare::ChannelComparison& c) {
  return fmt::format("{} at {:g} deg: {:.1e} {}, {:.1e} of {}", c.channel.name,
                     c.theta_of_largest_deg, c.largest, c.channel.unit, c.largest_over_peak(),
                     compare::scale_in_words(c));
}

}  // namespace

bool only_one_computed(const compare::Comparison& comparison) {
  return std::any_of(comparison.channels.begin(), comparison.channels.end(), [](const auto& c) {
    return c.verdict == compare::Verdict::not_computed &&
           (c.missing == compare::Comparable::first_missing ||
            c.missing == compare::Comparable::second_missing);
  });
}

std::optional<DifferenceCause> ComparisonResult::cause() const {
  if (agrees() || split) return std::nullopt;
  std::map<std::string, double> known = losses.groups;
  for (const RoundingLine& line : rounding)
    known[line.group] = std::max(known[line.group], line.total());
  constexpr double kEstimateFactor = 10;
  DifferenceCause least;
  std::string group, measured;
  double worst = 0, largest_change = 0;
  for (const Failure& failure : failures_of(*this)) {
    if (!(failure.scale > 0)) return std::nullopt;
    double estimate = 0;
    for (const std::string& carrier : carried_by(failure.group)) estimate += known[carrier];
    const auto change = losses.multipliers.find(failure.name);
    const bool by_multipliers = change != losses.multipliers.end() && change->second > estimate;
    if (by_multipliers) estimate = change->second;
    if (by_multipliers && change->second > largest_change) {
      largest_change = change->second;
      measured = failure.name;
    }
    const double over = failure.off / failure.scale;
    if (!(over <= kEstimateFactor * estimate)) return std::nullopt;
    if (over / estimate <= worst) continue;
    worst = over / estimate;
    least.round_off = estimate;
    least.over_scale = over;
    group = failure.group;
  }
  if (group.empty()) return std::nullopt;
  if (!measured.empty())
    least.text = fmt::format(
        "The cause is round-off in Simbody's constraint multipliers: without them (--reactions "
        "residual) {} changes by {:.1e} of its scale.",
        measured, largest_change);
  else
    least.text = fmt::format(
        "The cause is round-off: rounding of inputs and intermediate results changes {} of this "
        "case by about {:.1e} of its scale.",
        group, least.round_off);
  return least;
}

std::string ComparisonResult::headline() const {
  if (const auto* gap = comparison.incomplete())
    return fmt::format("Agreement of the two models cannot be shown: {} of {}.", gap->gap,
                       gap->channel.name);
  const auto found = cause();
  const std::string because = found ? " " + found->text : "";
  const bool channels_agree = split ? split->explained() : comparison.agrees();
  if (budget && channels_agree && !budget->comparison.agrees())
    if (const auto* apart = budget->comparison.failed())
      return fmt::format("The torque budgets of the two models differ: {} (tolerance {:g}).{}",
                         where_in_words(*apart),
                         split ? split->tolerance : budget->comparison.tolerance, because);
  if (teeth && channels_agree && !split && !teeth->comparison.agrees()) {
    if (const auto* gap = teeth->comparison.incomplete())
      return fmt::format("Agreement of the teeth of the two models cannot be shown: {} of {}.",
                         gap->gap, gap->channel.name);
    if (const auto* apart = teeth->comparison.failed())
      return fmt::format("The teeth of the two models differ: {} (tolerance {:g}).{}",
                         where_in_words(*apart), teeth->comparison.tolerance, because);
  }
  if (channels_agree)
    if (const auto* check = compare::failed_check(checks))
      return fmt::format(
          "A check of the {} model fails: {} is {:.1e} {} at {:g} deg, {:.1e} of its scale "
          "(tolerance {:g}).{}",
          check->table, check->name, check->worst, check->unit, check->theta_deg, check->relative(),
          check->tolerance, because);
  const auto* const worst = comparison.worst();
  if (worst == nullptr) return "Nothing was compared.";
  const std::string where =
      fmt::format("{} at {:g} deg: {:.1e} of {}", worst->channel.name, worst->theta_of_largest_deg,
                  worst->largest_over_peak(), compare::scale_in_words(*worst));
  const bool largest = is_largest(comparison, *worst);
  if (split)
    return fmt::format(
        "{} The models make different assumptions and differ{} {}. {}, {:.1e} of peak "
        "remains (tolerance {:g}).",
        agrees() ? "Explained." : "Not explained.",
        largest ? " by up to" : ", furthest beyond what is allowed in", where,
        agrees() ? "After accounting for each assumption" : "Each assumption accounted for",
        split->largest_rest(), split->tolerance);
  // What one model alone computed has agreed with nothing.
  const std::string on = only_one_computed(comparison)
                             ? " on what both computed: " + joined(compared_groups(comparison))
                             : "";
  const char* const lead = largest    ? "Largest difference"
                           : agrees() ? "Difference nearest to its limit:"
                                      : "Furthest beyond what is allowed:";
  return fmt::format("The two models {}{}. {} {} (tolerance {:g}).{}",
                     agrees() ? "agree" : "differ", on, lead, where, comparison.tolerance, because);
}

}  // namespace bentaxis::study
