// Results held to the curves of a reference.
#include <algorithm>
#include <cmath>
#include <list>
#include <set>

#include "bentaxis/compare/reference.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/column_values.h"
#include "reference_angles.h"
#include "reference_hints.h"
#include "reference_resampling.h"

namespace bentaxis::compare {
namespace {

// Puts the columns of `more` beside those of `table`; both have the same angles.
void append_columns(ResultTable& table, const ResultTable& more) {
  std::vector<double> values;
  for (std::size_t row = 0; row < more.rows(); ++row) {
    for (std::size_t c = 0; c < table.columns(); ++c) values.push_back(table.at(row, c));
    for (std::size_t c = 0; c < more.columns(); ++c) values.push_back(more.at(row, c));
  }
  table.values = std::move(values);
  append(table.channels, more.channels);
  table.theta_deg = more.theta_deg;
}

// A reference and what is held to it, at the same angles.
struct Held {
  Resampled reference;
  const ResultTable* result = nullptr;

  void add(const Resampled& more) {
    append_columns(reference.middle, more.middle);
    append_columns(reference.low, more.low);
    append_columns(reference.high, more.high);
    append_columns(reference.uncertainty, more.uncertainty);
    reference.exact = reference.exact && more.exact;
    reference.error = std::max(reference.error, more.error);
  }
};

// Where a curve has no points over several of its steps.
void add_gaps(const ReferenceCurve& curve, std::vector<Judgement::Gap>& gaps) {
  constexpr double kManySteps = 3;
  const std::vector<double>& theta = curve.table.theta_deg;
  std::vector<double> steps;
  for (std::size_t i = 0; i < theta.size(); ++i) steps.push_back(step_after(theta, i));
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < theta.size(); ++i)
    if (steps[i] > kManySteps * usual) gaps.push_back({theta[i], theta[i] + steps[i]});
}

// Tables of different columns as one: at all their angles, not computed where one has none.
// @param of  which of those of one that is held
template <class Of>
ResultTable united(const std::vector<Held>& held, const Of& of) {
  std::set<double> angles;
  for (const Held& one : held)
    angles.insert(one.result->theta_deg.begin(), one.result->theta_deg.end());
  ResultTable table = of(held.front());
  table.channels.clear();
  table.theta_deg.assign(angles.begin(), angles.end());
  for (const Held& one : held) append(table.channels, of(one).channels);
  table.values.assign(table.rows() * table.columns(), not_computed());
  std::size_t first = 0;
  for (const Held& one : held) {
    const ResultTable& its = of(one);
    for (std::size_t row = 0; row < its.rows(); ++row) {
      const auto at =
          std::lower_bound(table.theta_deg.begin(), table.theta_deg.end(), its.theta_deg[row]) -
          table.theta_deg.begin();
      for (std::size_t c = 0; c < its.columns(); ++c)
        table.values[static_cast<std::size_t>(at) * table.columns() + first + c] = its.at(row, c);
    }
    first += its.columns();
  }
  return table;
}

// What the comparisons of all curves with a model come to.
class Judge {
 public:
  Judge(const ReferenceDescription& description, const std::vector<Held>& held,
        const ZeroScales& zero_scales)
      : description_(description) {
    Options options;
    options.tolerance = description.relative;
    options.absolute = description.absolute;
    options.zero_scales = zero_scales;
    options.most_digits = std::min(options.most_digits, static_cast<double>(description.digits));
    for (const Held& one : held) {
      if (description.tube_deg > 0) options.band = Band{&one.reference.low, &one.reference.high};
      options.uncertainty = &one.reference.uncertainty;
      parts_.push_back({&one, compare_tables(one.reference.middle, *one.result, options),
                        Hints(one.reference.middle, *one.result)});
    }
  }

  ReferenceChannel found(const Channel& channel, std::size_t column) const {
    const Part& part = part_of(channel.name);
    const ResultTable& result = *part.held->result;
    ReferenceChannel entry;
    if (const auto* found = part.comparison.find(channel.name)) entry.comparison = *found;
    entry.comparison.channel = channel;
    const bool computed = any_computed(result, column);
    if (!has(part, channel.name)) {
      const bool wanted =
          description_.must_be_complete() && channel.kind == ChannelKind::reaction && computed;
      entry.finding = !computed ? Finding::absent : wanted ? Finding::incomplete : Finding::missing;
      if (wanted) entry.hint = "the reference does not have it";
    } else if (!entry.comparison.compared()) {
      entry.finding = Finding::incomplete;
      entry.hint = computed ? "one of them has gaps where the other has values"
                            : "the model did not compute it";
    } else {
      const bool agrees = entry.comparison.verdict == Verdict::agrees;
      entry.finding = agrees ? Finding::agrees : Finding::differs;
      if (!agrees) entry.hint = part.hints.of(entry.comparison);
    }
    return entry;
  }

  bool has(const std::string& channel) const { return has(part_of(channel), channel); }

 private:
  struct Part {
    const Held* held;
    Comparison comparison;
    Hints hints;
  };
  static bool has(const Part& part, const std::string& channel) {
    const ResultTable& reference = part.held->reference.middle;
    return any_computed(reference, reference.find(channel));
  }
  // That has a curve of it, or the first.
  const Part& part_of(const std::string& channel) const {
    const auto it = std::find_if(parts_.begin(), parts_.end(),
                                 [&](const Part& part) { return has(part, channel); });
    return it == parts_.end() ? parts_.front() : *it;
  }

  const ReferenceDescription& description_;
  std::vector<Part> parts_;
};

Judgement judged(const ReferenceDescription& description, const std::vector<Held>& held,
                 const ZeroScales& zero_scales) {
  Judgement judgement;
  if (held.empty()) return judgement;
  const ResultTable& result = *held.front().result;
  const Judge judge(description, held, zero_scales);
  for (std::size_t column = 0; column < result.columns(); ++column) {
    const Channel& channel = result.channels[column];
    if (channel.kind == ChannelKind::check ||
        (channel.kind == ChannelKind::input && !judge.has(channel.name)))
      continue;
    judgement.channels.push_back(judge.found(channel, column));
  }
  for (const Held& one : held) {
    judgement.resampled = judgement.resampled || !one.reference.exact;
    judgement.resampling_error = std::max(judgement.resampling_error, one.reference.error);
  }
  const auto all = [&](const auto& of) {
    return held.size() == 1 ? of(held.front()) : united(held, of);
  };
  judgement.reference = all([](const Held& one) { return one.reference.middle; });
  judgement.resampling = all([](const Held& one) { return one.reference.uncertainty; });
  if (description.tube_deg > 0) {
    judgement.low = all([](const Held& one) { return one.reference.low; });
    judgement.high = all([](const Held& one) { return one.reference.high; });
  }
  return judgement;
}

void require_one_curve_each(const std::vector<ReferenceCurve>& curves) {
  std::set<std::string> names;
  for (const ReferenceCurve& curve : curves)
    for (const Channel& channel : curve.table.channels)
      if (!names.insert(channel.name).second)
        throw InputError(curve.file.string() + ": holds " + channel.name +
                         ", as does another curve for the same model");
}

}  // namespace

const char* to_string(Finding finding) {
  switch (finding) {
    case Finding::agrees:
      return "agrees";
    case Finding::differs:
      return "differs";
    case Finding::missing:
      return "missing";
    case Finding::incomplete:
      return "incomplete";
    case Finding::absent:
      break;
  }
  return "not computed";
}

bool Judgement::agrees() const {
  bool compared = false;
  for (const auto& channel : channels) {
    if (channel.failed()) return false;
    compared = compared || channel.finding == Finding::agrees;
  }
  return compared;
}

std::optional<ResultTable> rows_at(const ResultTable& table, const std::vector<double>& theta_deg) {
  std::vector<std::size_t> rows;
  for (const double angle : theta_deg) {
    rows.push_back(table.rows() > 0 ? find_angle(table.theta_deg, angle, kSameAngle) : 0);
    if (rows.back() == table.rows()) return std::nullopt;
  }
  return select_rows(table, rows);
}

Judgement judge(const ReferenceDescription& description, const std::vector<ReferenceCurve>& curves,
                const ResultAt& result_at, const std::vector<double>& case_theta_deg,
                const ZeroScales& zero_scales) {
  require_one_curve_each(curves);
  // Round-off in a file is no other angle.
  const auto as_in_case = [&](std::vector<double> theta_deg) {
    for (double& angle : theta_deg)
      if (const std::size_t there = find_angle(case_theta_deg, angle, kSameAngle);
          there < case_theta_deg.size())
        angle = case_theta_deg[there];
    return theta_deg;
  };
  std::vector<Held> held;
  std::list<ResultTable> results;            // of each
  std::vector<const ReferenceCurve*> first;  // of each
  std::vector<Judgement::Gap> gaps;
  for (const ReferenceCurve& curve : curves) {
    if (description.tube_deg > 0 || !covers(curve, case_theta_deg)) require_no_wide_gap(curve);
    const auto same = std::find_if(first.begin(), first.end(), [&](const ReferenceCurve* other) {
      return other->table.theta_deg == curve.table.theta_deg;
    });
    if (same != first.end()) {
      Held& one = held[static_cast<std::size_t>(same - first.begin())];
      one.add(at_own_angles(description, curve, *one.result, result_at));
      continue;
    }
    first.push_back(&curve);
    add_gaps(curve, gaps);
    const ResultTable& result = results.emplace_back(result_at(as_in_case(curve.table.theta_deg)));
    held.push_back({at_own_angles(description, curve, result, result_at), &result});
  }
  std::vector<double> all;
  for (const ReferenceCurve* curve : first) append(all, curve->table.theta_deg);
  Judgement judgement = judged(description, held, zero_scales);
  judgement.result =
      results.size() == 1 ? std::move(results.front()) : result_at(judgement.reference.theta_deg);
  judgement.at_own_angles = std::any_of(all.begin(), all.end(), [&](double angle) {
    return find_angle(case_theta_deg, angle, kSameAngle) == case_theta_deg.size();
  });
  judgement.gaps = std::move(gaps);
  return judgement;
}

Judgement judge(const ReferenceDescription& description, const std::vector<ReferenceCurve>& curves,
                const ResultTable& result, const ZeroScales& zero_scales) {
  require_one_curve_each(curves);
  std::vector<Held> held(1);
  held.front().result = &result;
  for (const ReferenceCurve& curve : curves)
    held.front().add(resample(description, curve, result.theta_deg));
  held.front().reference.middle.name = "reference";
  return judged(description, held, zero_scales);
}

}  // namespace bentaxis::compare
