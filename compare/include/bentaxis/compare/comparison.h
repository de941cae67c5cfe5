// Compares two result tables channel by channel. Uses columns, units and scale groups; no physics.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/difference.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::compare {

enum class Verdict {
  agrees,  ///< largest difference within tolerance x peak
  differs,
  explained,     ///< differs, and differing assumptions account for it
  not_computed,  ///< a table has no value of this channel, as expected
  incomplete,    ///< a table lacks a value that it should have: never agreement
};

/// One harmonic of the shaft angle: x = amplitude cos(order theta - phase).
struct Harmonic {
  int order = 0;
  double amplitude[2] = {0, 0};        ///< of first and second table, channel's unit
  std::optional<double> phase_deg[2];  ///< empty where the amplitude is round-off
};

/// How far apart two tables are in one channel. Differences are second minus first, in the
/// channel's unit.
struct ChannelComparison {
  Channel channel;
  Verdict verdict = Verdict::not_computed;
  bool judged = false;    ///< counts for the overall verdict (reactions and what follows from them)
  double peak = 0;        ///< scale of the verdict: scale_of() the channel in the first table
  double own_peak = 0;    ///< largest magnitude of this channel alone in the first table
  bool at_floor = false;  ///< `peak` is the floor from the loads: the group's own is smaller
  double largest = 0;     ///< largest magnitude of the difference; where the first table is
                          ///< uncertain: at the row that is furthest beyond or nearest to its limit
  double theta_of_largest_deg = 0;
  double rms = 0;
  double mean[2] = {0, 0};
  double mean_difference = 0;
  std::vector<Harmonic> harmonics;
  double digits = 0;     ///< of agreement: -log10(largest / peak), at most Options::most_digits
  double tolerance = 0;  ///< over peak
  double allowed = 0;    ///< absolute + tolerance x peak + uncertainty there, channel's unit
  std::string gap;       ///< of an incomplete channel: which table lacks it, and where
  /// Of a channel that is not compared: what keeps it from that.
  Comparable missing = Comparable::nothing;

  /// Both tables have it, and the numbers above say how far apart they are.
  bool compared() const {
    return verdict != Verdict::not_computed && verdict != Verdict::incomplete;
  }
  /// It is so small beside its scale that a difference of much of itself passes: below
  /// kSmallComponent of it, and no round-off of 0.
  bool is_small_component() const;
  /// The largest difference, held to `peak`; not known where the channel is not compared.
  Difference difference() const { return held_to_peak(largest); }
  double largest_over_peak() const { return difference().share(); }
  double rms_over_peak() const { return held_to_peak(rms).share(); }

 private:
  Difference held_to_peak(double value) const {
    return compared() ? Difference{value, peak, Comparable::yes}
                      : Difference{not_computed(), peak, missing};
  }
};

/// Largest load of the case per unit ("N", "Nm", ...), from which the scales of groups have a
/// floor.
using ZeroScales = std::map<std::string, double>;

/// Limits of a curve that is known only to lie between them: tables of the same shape as the first.
struct Band {
  const ResultTable* low = nullptr;
  const ResultTable* high = nullptr;
};

struct Options {
  double tolerance = 1e-9;                 ///< of peak
  std::map<std::string, double> absolute;  ///< allowed on top, per unit
  std::vector<int> orders;                 ///< harmonics to report
  ZeroScales zero_scales;
  double most_digits = 16;   ///< of agreement that can be claimed: those of the poorer table
  std::optional<Band> band;  ///< a difference is then the distance from the band
  /// How far values of the first table may be off, in their unit: a table of its rows. A channel
  /// that it has no column of is not off.
  const ResultTable* uncertainty = nullptr;
  /// Whether a value of a channel may be missing at a row: then the channel is not computed,
  /// without it incomplete. Where this is not given, a value may be missing in both tables, not in
  /// one.
  std::function<bool(const Channel& channel, std::size_t row)> may_be_missing;
};

/// Minimum scale of a group, as a share of the largest load of the case. A group whose peak is
/// smaller is what is left of loads that cancel, and carries their error: scaled by its own peak
/// the round-off of the loads would differ. With the tolerance of two exact models, 1e-9, this
/// allows 1e-12 of the loads: five times the largest error of either model against curves of 50
/// digits (2e-13, docs/trust.md). A tolerance that a user names scales it alike.
inline constexpr double kMinScale = 1e-3;
inline constexpr double kLeastScale [[deprecated("use kMinScale")]] = kMinScale;
/// A channel below this share of its scale is warned of: a thousandth of itself may be wrong for
/// each millionth that the tolerance allows.
inline constexpr double kSmallComponent = 1e-3;
/// Share of a load scale up to which a value is round-off of it.
inline constexpr double kNoSignal = 1e-12;

/// Options with this tolerance, and with these loads as the floor of every scale.
Options above_round_off(double tolerance, const ZeroScales& scales);

struct Comparison {
  std::string first, second;  ///< names of the tables
  std::vector<ChannelComparison> channels;
  double tolerance = 0;

  /// Something was compared, nothing differs and nothing is incomplete.
  bool agrees() const;
  /// The first channel of the verdict that lacks a value it should have; nullptr if there is none.
  const ChannelComparison* incomplete() const;
  /// The channel of the verdict that exceeds its tolerance most; nullptr if none does.
  const ChannelComparison* failed() const;
  /// failed(), or where none differs the channel with the largest difference over its peak;
  /// nullptr if none was compared.
  const ChannelComparison* worst() const;
  /// The channel with the largest difference, of those that `of` picks and that are compared or
  /// should be: one that lacks a value comes first. nullptr where there is none.
  const ChannelComparison* furthest(const std::function<bool(const Channel&)>& of) const;
  int compared() const;
  const ChannelComparison* find(const std::string& channel_name) const;
};

/// Compares channels of the same name, at every row that both tables have a value of. A channel
/// that one table lacks altogether is missing at every row. Both tables must have the same angles.
/// @throws InputError if the angles differ.
Comparison compare_tables(const ResultTable& first, const ResultTable& second,
                          const Options& options);

/// What differences of a group are held to: its peak, at least kMinScale of the largest load; the
/// load itself where the peak is round-off of it, so that the group is zero.
double scale_of(double peak, double load);
/// That of a channel: by the peak of its group in the table and the largest load of its unit.
double scale_of(const ResultTable& table, const Channel& channel, const ZeroScales& zero_scales);

/// A channel that must vanish, over a whole table.
struct Check {
  std::string table;
  std::string name;
  std::string unit;
  double worst = 0;
  double theta_deg = 0;
  double scale = 0;
  double tolerance = 0;
  std::string group = {};  ///< of the reactions whose round-off it carries, or ""
  double relative() const { return scale > 0 ? worst / scale : worst; }
  bool holds() const { return relative() <= tolerance; }
};

/// The check that exceeds its tolerance most; nullptr where all are passed.
const Check* failed_check(const std::vector<Check>& checks);

/// Compares every check channel of a table with its scale, the pistons' together.
/// @param scales  per unit
std::vector<Check> judge_checks(const ResultTable& table, const ZeroScales& scales,
                                double tolerance);

const char* to_string(Verdict verdict);

/// What `peak` of a channel is, in words: "its peak", or the floor from the loads.
std::string scale_in_words(const ChannelComparison& channel);

}  // namespace bentaxis::compare
