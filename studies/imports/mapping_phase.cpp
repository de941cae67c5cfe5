#include "mapping_phase.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bentaxis/numerics/minimum.h"
#include "mapping_frames.h"

namespace bentaxis::study::mapping {
namespace {

class PhaseSearch {
 public:
  PhaseSearch(const Record& record, const ModelCurves& model) : record_(record), model_(model) {
    find_features();
    find_targets();
  }

  std::vector<Phase> find() const {
    std::vector<Phase> found;
    for (const double sign : {1.0, -1.0}) {
      const Coarse coarse = search_coarsely(sign);
      for (const std::size_t shift : starts_of(coarse.cost)) {
        const Phase phase = refined(sign, shift, coarse.chosen[shift]);
        if (phase.cost < kNoChannel) found.push_back(phase);
      }
      if (record_.is_over_time()) break;  // the sign of the speed says the direction
    }
    return found;
  }

 private:
  // What the phase is found by: columns about their means, and of whole vectors the length, which
  // no frame changes. Each with the model's curves it may be.
  struct Feature {
    std::vector<std::size_t> columns;
    std::string unit;
    bool is_length() const { return columns.size() == 3; }
  };
  struct Target {
    Series fine, coarse;
    std::string unit;
    bool length;
  };
  // By coarse phase: the cost of all features together, and the best target of each.
  struct Coarse {
    std::vector<double> cost;
    std::vector<std::vector<std::size_t>> chosen;
  };

  void find_features() {
    for (const Group& group : record_.groups()) {
      if (group.count() == 3) {
        features_.push_back(
            {{*group.columns[0], *group.columns[1], *group.columns[2]}, group.unit});
        continue;
      }
      for (const auto& column : group.columns)
        if (column && !record_.is_constant(*column)) features_.push_back({{*column}, group.unit});
    }
    for (const std::size_t column : record_.singles())
      features_.push_back({{column}, record_.unit_of(column)});
    constexpr std::size_t kEnough = 40;
    if (features_.size() > kEnough) features_.resize(kEnough);
  }

  void find_targets() {
    const auto add = [&](const Series& fine, const std::string& unit, bool length) {
      targets_.push_back({normalised(fine), normalised(coarse(fine)), unit, length});
    };
    for (const auto& channel : model_.channels()) add(channel.values, channel.channel.unit, false);
    for (const auto& vector : model_.vectors()) {
      add(length_of(vector.parts), vector.channel.unit, true);
      for (const char* frame : {"S1", "S2"})
        if (vector.channel.frame != frame)
          for (const auto& part :
               in_axes(vector.parts, model_.frame(vector.channel.frame), model_.frame(frame)))
            add(part, vector.channel.unit, false);
    }
  }

  Series series(const Feature& feature, const Turning& turning, std::size_t count) const {
    const auto at = [&](std::size_t j) {
      return record_.sampled(feature.columns[j], turning, count);
    };
    return feature.is_length() ? length_of({at(0), at(1), at(2)}) : at(0);
  }

  // By logarithms, so that the curves which fit decide and not the one that lags.
  static double score_of(double square) {
    constexpr double kAsGoodAsExact = 1e-4;
    return std::log(kAsGoodAsExact + std::max(0.0, 1 - square));
  }

  Coarse search_coarsely(double sign) const {
    Coarse found{std::vector<double>(kCoarse, 0),
                 std::vector(kCoarse, std::vector<std::size_t>(features_.size(), 0))};
    for (std::size_t f = 0; f < features_.size(); ++f) {
      const Series theirs = normalised(series(features_[f], {sign, 0}, kCoarse));
      std::vector<double> best(kCoarse, 0);
      for (std::size_t t = 0; t < targets_.size(); ++t) {
        const Target& target = targets_[t];
        if (target.length != features_[f].is_length() || !may_have(features_[f].unit, target.unit))
          continue;
        for (std::size_t shift = 0; shift < kCoarse; ++shift) {
          // theirs(theta - phase), phase = shift steps
          const double r = shifted_product(target.coarse, theirs, shift);
          const double value = target.length && r < 0 ? 0 : r * r;
          if (value <= best[shift]) continue;
          best[shift] = value;
          found.chosen[shift][f] = t;
        }
      }
      for (std::size_t shift = 0; shift < kCoarse; ++shift)
        found.cost[shift] += score_of(best[shift]);
    }
    return found;
  }

  static double degrees_of(std::size_t shift) {
    return 360.0 * static_cast<double>(shift) / static_cast<double>(kCoarse);
  }

  // The best coarse phases that are not each other's, nor those of another piston.
  std::vector<std::size_t> starts_of(const std::vector<double>& cost) const {
    constexpr std::size_t kTried = 3;
    std::vector<std::size_t> order(kCoarse), tried;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
    for (const std::size_t shift : order)
      if (tried.size() < kTried && std::none_of(tried.begin(), tried.end(), [&](std::size_t other) {
            return std::abs(std::remainder(degrees_of(shift) - degrees_of(other),
                                           model_.pitch_deg())) < 4;
          }))
        tried.push_back(shift);
    return tried;
  }

  Phase refined(double sign, std::size_t shift, const std::vector<std::size_t>& chosen) const {
    const auto at = [&](double phase, const auto& of_square) {
      double sum = 0;
      for (std::size_t f = 0; f < features_.size(); ++f) {
        const double r = dot(normalised(series(features_[f], {sign, phase}, model_.rows())),
                             targets_[chosen[f]].fine);
        sum += of_square(r * r);
      }
      return sum / static_cast<double>(features_.size());
    };
    const double start = degrees_of(shift);
    const double phase =
        start +
        numerics::smallest_at([&](double moved) { return at(start + moved, score_of); }, -3, 3);
    return {{},
            {sign, phase},
            at(phase, [](double square) { return 1 - square; }),
            at(phase, score_of)};
  }

  const Record& record_;
  const ModelCurves& model_;
  std::vector<Feature> features_;
  std::vector<Target> targets_;
};

}  // namespace

std::vector<Phase> phases_of(const Record& record, const ModelCurves& model) {
  return PhaseSearch(record, model).find();
}

}  // namespace bentaxis::study::mapping
