#include "bentaxis/study/turn_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/results/samples.h"
#include "same_peak.h"

namespace bentaxis::study {
namespace {

constexpr std::size_t kNamed = 4;  // forces in a sentence

bool exceeds(double value, double peak) {
  return is_computed(value) && (!is_computed(peak) || value > peak * (1 + kSamePeak));
}

std::string newtons(double value) {
  return value < 1e4 ? fmt::format("{:.4g} N", value) : fmt::format("{:.4g} kN", value / 1e3);
}

}  // namespace

double TurnSummary::Torque::peak() const { return std::max(std::abs(least), std::abs(greatest)); }

double TurnSummary::Torque::ripple() const {
  if (!(std::abs(mean) > kSamePeak * peak())) return not_computed();
  return 100 * (greatest - least) / std::abs(mean);
}

TurnSummary::TurnSummary(const std::vector<Channel>& channels)
    : torque_column_(channels.size()), columns_(channels.size()) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Channel& channel = channels[c];
    if (channel.name == "Td_z1_Nm") torque_column_ = c;
    const bool force = channel.kind == ChannelKind::reaction && channel.unit == "N";
    if (!force && channel.group != "xh_yh") continue;
    if (std::any_of(groups_.begin(), groups_.end(),
                    [&](const Channel& g) { return g.group == channel.group; }))
      continue;
    std::map<int, std::vector<std::size_t>> by_piston;
    for (std::size_t other = 0; other < channels.size(); ++other)
      if (channels[other].group == channel.group && channels[other].kind == channel.kind &&
          channels[other].frame == channel.frame)
        by_piston[channels[other].piston].push_back(other);
    for (auto& [piston, columns] : by_piston)
      vectors_.push_back({groups_.size(), piston, std::move(columns)});
    groups_.push_back(channel);
  }
}

TurnSummary::TurnSummary(const ResultTable& table) : TurnSummary(table.channels) {
  table.for_each_row([this](double theta_deg, const double* values) { add(theta_deg, values); });
}

void TurnSummary::add(double theta_deg, const double* values) {
  for (Vector& vector : vectors_) {
    double square = 0;
    for (const std::size_t c : vector.columns) square += values[c] * values[c];
    if (const double value = std::sqrt(square); exceeds(value, vector.value)) {
      vector.value = value;
      vector.row = rows_;
      vector.theta_deg = theta_deg;
    }
  }
  ++rows_;
  if (torque_column_ == columns_ || !is_computed(values[torque_column_])) return;
  const double torque = values[torque_column_];
  least_torque_ = torques_ == 0 ? torque : std::min(least_torque_, torque);
  greatest_torque_ = torques_ == 0 ? torque : std::max(greatest_torque_, torque);
  torque_sum_ += torque;
  ++torques_;
}

std::vector<TurnSummary::Peak> TurnSummary::peaks() const {
  std::vector<Peak> peaks;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Peak peak{groups_[g]};
    for (const Vector& vector : vectors_)
      if (vector.group == g && exceeds(vector.value, peak.value))
        peak = {groups_[g], vector.value, vector.row, vector.theta_deg, vector.piston};
    peaks.push_back(std::move(peak));
  }
  return peaks;
}

TurnSummary::Torque TurnSummary::torque() const {
  if (torques_ == 0) return {};
  return {torque_sum_ / static_cast<double>(torques_), least_torque_, greatest_torque_};
}

std::vector<std::string> TurnSummary::answers() const {
  std::vector<std::string> sentences;
  if (const Torque t = torque(); is_computed(t.mean))
    sentences.push_back(fmt::format("Drive torque: mean {:.4g} Nm, from {:.4g} to {:.4g} Nm.",
                                    t.mean, t.least, t.greatest));
  std::vector<Peak> forces = peaks();
  std::erase_if(forces, [](const Peak& peak) {
    return peak.channel.unit != "N" || !is_computed(peak.value);
  });
  std::stable_sort(forces.begin(), forces.end(),
                   [](const Peak& a, const Peak& b) { return a.value > b.value; });
  if (forces.empty()) return sentences;
  std::vector<std::string> named;
  for (std::size_t i = 0; i < std::min(kNamed, forces.size()); ++i) {
    const Peak& peak = forces[i];
    named.push_back(fmt::format("{} {} at {:.4g} deg ({}{})", peak.channel.group,
                                newtons(peak.value), peak.theta_deg, peak.channel.meaning,
                                peak.piston > 0 ? fmt::format(", piston {}", peak.piston) : ""));
  }
  sentences.push_back(
      fmt::format("Largest forces: {}{}.", fmt::join(named, "; "),
                  forces.size() > kNamed
                      ? fmt::format("; the others are at most {}", newtons(forces[kNamed].value))
                      : ""));
  return sentences;
}

namespace {

// "over 7.5 % of the turn"; of a motion "in 7.5 % of the rows".
std::string share_text(double share, const std::vector<double>& time_s) {
  return time_s.empty() ? fmt::format("over {:.3g} % of the turn", 100 * share)
                        : fmt::format("in {:.3g} % of the rows", 100 * share);
}

// use(limit, its share in words, where its worst value is) of those that are violated.
template <class Use>
void for_each_violated(const std::vector<analytic::ValidityLimit>& limits,
                       const std::vector<double>& time_s, int digits, const Use& use) {
  for (const analytic::ValidityLimit& limit : limits)
    if (limit.applicable && limit.violated_share > 0)
      use(limit, share_text(limit.violated_share, time_s),
          time_s.empty() ? fmt::format("{:.{}g} deg", limit.theta_deg, digits)
                         : fmt::format("{:.{}g} ms", 1e3 * time_s[limit.row], digits));
}

}  // namespace

std::vector<std::string> limit_answers(const std::vector<analytic::ValidityLimit>& limits,
                                       const std::vector<double>& time_s) {
  std::vector<std::string> sentences;
  for_each_violated(
      limits, time_s, 4, [&](const auto& limit, const auto& share, const auto& place) {
        sentences.push_back(
            fmt::format("Not valid {}, where this does not hold: {} (worst {:.4g} {} at {}).",
                        share, limit.limit, limit.worst, limit.unit, place));
      });
  return sentences;
}

std::vector<Warning> limit_warnings(const std::vector<analytic::ValidityLimit>& limits,
                                    const std::vector<double>& time_s) {
  std::vector<Warning> warnings;
  for_each_violated(
      limits, time_s, 6, [&](const auto& limit, const auto& share, const auto& place) {
        warnings.push_back(
            {limit.name, fmt::format("{}, worst {:.4g} {} at {}: {}.", share, limit.worst,
                                     limit.unit, place, limit.consequence)});
      });
  return warnings;
}

std::string not_valid_text(const std::vector<analytic::ValidityLimit>& limits,
                           const std::vector<double>& time_s) {
  const double share = analytic::share_beyond(limits);
  return share > 0 ? share_text(share, time_s) : "";
}

std::string timing_answer(const std::vector<TimingRow>& rows) {
  std::vector<std::string> names;
  std::size_t limited = 0, meant = 0;
  for (const TimingRow& row : rows) {
    if (row.flagged && !row.meant.empty())
      ++meant;
    else if (row.flagged)
      names.push_back(row.quantity);
    limited += row.limit.has_value();
  }
  if (names.empty() && meant > 0)
    return fmt::format("{}{} of {} with a limit {} not keep it, as intended.", kPortTiming, meant,
                       counted(limited, "quantity", "quantities"), word_for(meant, "does", "do"));
  if (names.empty()) return std::string(kPortTiming) + "within all limits.";
  return fmt::format(
      "{}{} of {} with a limit {} not keep it: {}{} (pressure --advise: what to change).",
      kPortTiming, names.size(), counted(limited, "quantity", "quantities"),
      word_for(names.size(), "does", "do"), fmt::join(names, ", "),
      meant > 0 ? fmt::format("; {} more as intended", meant) : "");
}

std::vector<analytic::ValidityLimit> limits_of_turn(Case the_case, const Assumptions& assumptions,
                                                    const PressureTrace& pressure) {
  int& angles = the_case.operation.samples_per_revolution;
  angles = std::min(kMaxAnglesOfLimits, angles);
  const Samples samples = sample_case(the_case, pressure);
  return analytic::check_validity(the_case, assumptions, samples,
                                  analytic::run(the_case, assumptions, samples));
}

}  // namespace bentaxis::study
