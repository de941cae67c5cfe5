#include "bentaxis/study/bearing_life.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/ball_bearing.h"

namespace bentaxis::study {
namespace {

constexpr double kMinutesPerHour = 60;

const BearingRatings& rated(const Case& the_case) {
  const BearingRatings& b = the_case.ratings;
  if (b.tapered && b.cylindrical) return b;
  // What the file has of them is no rating, but it says which key is missing.
  const auto given = [&](const char* key) {
    return std::any_of(the_case.entries.begin(), the_case.entries.end(),
                       [&](const InputEntry& entry) {
                         return entry.table == "bearings" && entry.key == key && !entry.defaulted;
                       });
  };
  std::string missing;
  std::size_t count = 0;
  const auto ask = [&](const char* key) {
    if (given(key)) return;
    missing += (missing.empty() ? "" : ", ") + std::string(key);
    ++count;
  };
  if (!b.tapered)
    for (const char* key : {"tapered_dynamic_rating_kN", "tapered_static_rating_kN", "tapered_Y"})
      ask(key);
  if (!b.cylindrical)
    for (const char* key : {"cylindrical_dynamic_rating_kN", "cylindrical_static_rating_kN"})
      ask(key);
  throw InputError(the_case.file.string() + ": [bearings] " + missing +
                   (count == 1 ? ": is missing" : ": are missing") +
                   ", and must be given: the rating life is computed from the ratings of both "
                   "bearings, as in cases/bap63_bearing_life.toml");
}

const BearingRating& rating_of(const BearingRatings& b, Bearing bearing) {
  return bearing == Bearing::tapered ? *b.tapered : *b.cylindrical;
}

// Over their sum; first over the largest, so that no sum leaves the range of numbers.
void normalise(std::vector<double>& shares) {
  const double largest = *std::max_element(shares.begin(), shares.end());
  if (largest == 0) return;
  double all = 0;
  for (double& share : shares) all += share /= largest;
  for (double& share : shares) share /= all;
}

double finite_or_none(double value) { return std::isfinite(value) ? value : not_computed(); }

double hours(double revolutions, double mean_speed_rpm) {
  return mean_speed_rpm > 0 ? finite_or_none(revolutions * 1e6 / (kMinutesPerHour * mean_speed_rpm))
                            : not_computed();
}

double mean_of(const std::vector<double>& loads, const RollingLaw& law) {
  return mean_load(loads, std::vector<double>(loads.size(), 1.0), law.life_exponent);
}

// Ball by ball at every angle of every point: lives add up as Miner's rule has it.
void add_reference_life(Bearing bearing, const BearingRating& rating,
                        const std::vector<LifePoint>& points, const std::vector<double>& shares,
                        double mean_speed_rpm, BearingLife& life) {
  if (!rating.balls) return;
  const BallGeometry& g = *rating.balls;
  const BallBearing balls{g.balls,
                          g.ball_diameter,
                          g.pitch_diameter,
                          g.inner_groove_ratio,
                          g.outer_groove_ratio,
                          g.radial_clearance,
                          rating.dynamic_rating};
  double used = 0;
  life.deflection = life.largest_ball_load = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BearingLoads& loads = points[i].loads[static_cast<std::size_t>(bearing)];
    const double each = shares[i] / static_cast<double>(loads.radial.size());
    for (std::size_t k = 0; k < loads.radial.size(); ++k) {
      if (loads.radial[k] == 0 && loads.axial[k] == 0) continue;
      const BallBearingState at = equilibrium(balls, {loads.radial[k], std::abs(loads.axial[k])});
      used += each / at.reference_life;
      life.deflection = std::max(life.deflection, std::abs(at.radial));
      life.largest_ball_load = std::max(
          life.largest_ball_load, *std::max_element(at.ball_loads.begin(), at.ball_loads.end()));
    }
  }
  if (!(used > 0)) return;
  life.reference_revolutions = 1 / used;
  life.reference_hours = hours(life.reference_revolutions, mean_speed_rpm);
}

BearingLife life_of(Bearing bearing, const BearingRating& rating,
                    const std::vector<LifePoint>& points, const std::vector<double>& shares,
                    double mean_speed_rpm) {
  BearingLife life;
  const RollingLaw law = law_of(rating.element);
  std::vector<double> of_point;
  double largest0 = 0;
  for (const LifePoint& p : points) {
    const BearingLoads& loads = p.loads[static_cast<std::size_t>(bearing)];
    of_point.push_back(mean_of(loads.equivalent, law));
    largest0 =
        std::max(largest0, *std::max_element(loads.equivalent0.begin(), loads.equivalent0.end()));
  }
  life.static_safety = largest0 > 0 ? rating.static_rating / largest0 : not_computed();
  add_reference_life(bearing, rating, points, shares, mean_speed_rpm, life);
  if (mean_speed_rpm == 0) {
    life.mean_load = life.revolutions = life.hours = not_computed();
    life.life_share.assign(points.size(), not_computed());
    return life;
  }
  life.mean_load = mean_load(of_point, shares, law.life_exponent);
  life.revolutions = rating_life(rating.dynamic_rating, life.mean_load, law.life_exponent);
  life.hours = hours(life.revolutions, mean_speed_rpm);
  double all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    life.life_share.push_back(shares[i] * std::pow(of_point[i], law.life_exponent));
    all += life.life_share.back();
  }
  for (double& share : life.life_share) share = all > 0 ? share / all : not_computed();
  return life;
}

// Finds in which share of the revolutions limits are violated, each and any of them.
class LimitFinder {
 public:
  using OfAngle = std::function<double(const BearingLoads&, std::size_t)>;

  LimitFinder(const std::vector<LifePoint>& points, const std::vector<double>& revolutions,
              PumpLife& life)
      : points_(points), life_(life) {
    // At standstill every angle counts alike: there are no revolutions to weigh them by.
    const bool turns =
        std::any_of(revolutions.begin(), revolutions.end(), [](double count) { return count > 0; });
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t angles = points[i].theta_deg.size();
      const double each = (turns ? revolutions[i] : 1) / static_cast<double>(angles);
      weights_.insert(weights_.end(), angles, each);
    }
    for (const double weight : weights_) all_ += weight;
    beyond_.assign(weights_.size(), false);
  }

  // Scans what must not be negative at any angle; `shown` is what is said of it.
  void scan(LifeLimit limit, const OfAngle& not_negative, const OfAngle& shown) {
    double violated = 0, smallest = HUGE_VAL;
    std::size_t at = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const LifePoint& p = points_[i];
      const BearingLoads& loads = p.loads[static_cast<std::size_t>(limit.bearing)];
      for (std::size_t k = 0; k < p.theta_deg.size(); ++k, ++at) {
        const double value = not_negative(loads, k);
        if (value < 0) violated += violate(at);
        if (value >= smallest) continue;
        smallest = value;
        limit.worst = shown(loads, k);
        limit.point = i;
        limit.theta_deg = p.theta_deg[k];
      }
    }
    add(std::move(limit), violated);
  }

  // The limits of validity of the turns. Of the thrust the tapered bearing has limits of its own.
  void add_validity() {
    std::vector<std::string> keys;
    for (const LifePoint& p : points_)
      for (const analytic::ValidityLimit& limit : p.validity)
        if (limit.applicable && limit.key != "thrust" && !contains(keys, limit.key))
          keys.push_back(limit.key);
    for (const std::string& key : keys) add_validity(key);
  }

  double share_beyond() const {
    double violated = 0;
    for (std::size_t at = 0; at < weights_.size(); ++at)
      if (beyond_[at]) violated += weights_[at];
    return share(violated);
  }

 private:
  double share(double violated) const { return all_ > 0 ? violated / all_ : 0; }
  double violate(std::size_t at) {
    beyond_[at] = true;
    return weights_[at];
  }
  void add(LifeLimit limit, double violated) {
    limit.violated_share = share(violated);
    life_.limits.push_back(std::move(limit));
  }

  void add_validity(const std::string& key) {
    LifeLimit found;
    found.of_bearing = false;
    double violated = 0, smallest = HUGE_VAL;
    std::size_t first = 0;  // row of a point
    for (std::size_t i = 0; i < points_.size(); first += points_[i++].theta_deg.size())
      for (const analytic::ValidityLimit& limit : points_[i].validity) {
        if (limit.key != key || !limit.applicable) continue;
        for (std::size_t k = 0; k < limit.rows.size(); ++k)
          if (limit.rows[k] == analytic::ValidityLimit::Row::violated)
            violated += violate(first + k);
        if (limit.margin >= smallest) continue;
        smallest = limit.margin;
        found.key = limit.key;
        found.limit = limit.limit;
        found.consequence = limit.consequence;
        found.unit = limit.unit;
        found.worst = limit.worst;
        found.point = i;
        found.theta_deg = limit.theta_deg;
      }
    add(std::move(found), violated);
  }

  const std::vector<LifePoint>& points_;
  PumpLife& life_;
  std::vector<double> weights_;  // of every angle of every point
  double all_ = 0;
  std::vector<bool> beyond_;  // any limit
};

void find_limits(const BearingRatings& b, const std::vector<LifePoint>& points,
                 const std::vector<double>& revolutions, PumpLife& life) {
  using OfAngle = LimitFinder::OfAngle;
  LimitFinder finder(points, revolutions, life);
  const OfAngle axial = [](const BearingLoads& l, std::size_t k) { return l.axial[k]; };
  const OfAngle load = [](const BearingLoads& l, std::size_t k) { return l.equivalent[k]; };
  const OfAngle load0 = [](const BearingLoads& l, std::size_t k) { return l.equivalent0[k]; };
  // A ball bearing takes thrust both ways unless its contact is angular, which the case does not
  // say.
  if (b.tapered->element == RollingElement::roller)
    finder.scan(
        {Bearing::tapered, "pulled", "thrust seats the tapered bearing: Rb1_z1 >= 0",
         "it takes thrust in one direction only; its life is computed from the magnitude and is "
         "not "
         "meaningful there"},
        axial, axial);
  const double per_radial = 1 / (2 * b.tapered->axial_factor);
  const bool tapered = b.tapered->element == RollingElement::roller;
  if (tapered)
    finder.scan(
        {Bearing::tapered, "seated",
         "thrust exceeds the induced thrust of the taper: Fa >= Fr/(2Y)",
         "without an opposed bearing fewer than half of the rollers carry load; P is too small "
         "there"},
        [&](const BearingLoads& l, std::size_t k) { return l.axial[k] - per_radial * l.radial[k]; },
        axial);
  for (const Bearing bearing : kBearings) {
    const BearingRating& rating = rating_of(b, bearing);
    const bool balls = rating.element == RollingElement::ball;
    const double smallest = law_of(rating.element).smallest_load;
    finder.scan(
        {bearing, "smallest",
         balls ? "load enough for the balls to roll: P >= 0.01 C"
               : "load enough for the rollers to roll: P >= 0.02 C",
         std::string(balls ? "balls" : "rollers") +
             " may slide: wear that the rating life does not include"},
        [&](const BearingLoads& l, std::size_t k) {
          return l.equivalent[k] - smallest * rating.dynamic_rating;
        },
        load);
    finder.scan(
        {bearing, "largest", "load within the range of ISO 281: P <= 0.5 C",
         "the computed rating life is too long there"},
        [&](const BearingLoads& l, std::size_t k) {
          return kLargestLoad * rating.dynamic_rating - l.equivalent[k];
        },
        load);
    finder.scan(
        {bearing, "static", "no lasting dents: P0 <= C0", "permanent indentations at standstill"},
        [&](const BearingLoads& l, std::size_t k) {
          return rating.static_rating - l.equivalent0[k];
        },
        load0);
  }
  finder.add_validity();
  life.violated_share = finder.share_beyond();
}

}  // namespace

double equivalent_load(const TaperedRating& rating, double radial, double axial) {
  const double thrust = std::abs(axial);
  return thrust <= rating.ratio_limit * radial
             ? radial
             : rating.radial_factor * radial + rating.axial_factor * thrust;
}

double equivalent_static_load(const TaperedRating& rating, double radial, double axial) {
  return std::max(radial, radial / 2 + rating.static_axial_factor * std::abs(axial));
}

RollingLaw law_of(RollingElement element) {
  return element == RollingElement::roller
             ? RollingLaw{}
             : RollingLaw{kBallLifeExponent, kBallWeibullSlope, kSmallestBallLoad};
}

double mean_load(std::span<const double> loads, std::span<const double> shares, double exponent) {
  // Over the largest, so that no power and no sum leaves the range of numbers.
  double largest = 0, most = 0, sum = 0, all = 0;
  for (const double load : loads) largest = std::max(largest, load);
  for (const double share : shares) most = std::max(most, share);
  if (largest == 0 || most == 0) return 0;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    sum += shares[i] / most * std::pow(loads[i] / largest, exponent);
    all += shares[i] / most;
  }
  return largest * std::pow(sum / all, 1 / exponent);
}

double rating_life(double dynamic_rating, double load, double exponent) {
  return load > 0 ? finite_or_none(std::pow(dynamic_rating / load, exponent)) : not_computed();
}

double combined_life(std::span<const double> lives) {
  double sum = 0;
  for (const double life : lives) {
    if (!is_computed(life)) return not_computed();
    sum += std::pow(life, -kWeibullSlope);
  }
  return std::pow(sum, -1 / kWeibullSlope);
}

double combined_life(std::span<const double> lives, std::span<const double> slopes) {
  double shortest = HUGE_VAL;
  bool rollers = true;
  for (std::size_t i = 0; i < lives.size(); ++i) {
    if (!is_computed(lives[i])) return not_computed();
    shortest = std::min(shortest, lives[i]);
    rollers = rollers && slopes[i] == kWeibullSlope;
  }
  if (rollers) return combined_life(lives);
  // Over the shortest life: the sum is 1 or more at 1 and grows with the life.
  constexpr int kHalvings = 60;
  const auto too_long = [&](double life) {
    double sum = 0;
    for (std::size_t i = 0; i < lives.size(); ++i)
      sum += std::pow(life * (shortest / lives[i]), slopes[i]);
    return sum >= 1;
  };
  return shortest * numerics::bisect({0, 1}, kHalvings, too_long).middle();
}

std::string to_string(Bearing bearing) {
  return bearing == Bearing::tapered ? "tapered" : "cylindrical";
}

void require_ratings(const Case& the_case) { rated(the_case); }

LifePoint life_point(const Case& the_case, const ResultTable& table, double share) {
  const BearingRatings& b = rated(the_case);
  LifePoint point;
  point.share = share;
  point.speed_rpm = the_case.operation.speed_rpm;
  point.theta_deg = table.theta_deg;
  const ChannelLayout at(the_case.pump);
  BearingLoads &tapered = point.loads[0], &cylindrical = point.loads[1];
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double fr = std::hypot(table.at(row, at.Rb1(0)), table.at(row, at.Rb1(1)));
    const double fa = table.at(row, at.Rb1(2));
    tapered.radial.push_back(fr);
    tapered.axial.push_back(fa);
    tapered.equivalent.push_back(equivalent_load(*b.tapered, fr, fa));
    tapered.equivalent0.push_back(equivalent_static_load(*b.tapered, fr, fa));
    cylindrical.radial.push_back(std::hypot(table.at(row, at.Rb2(0)), table.at(row, at.Rb2(1))));
  }
  cylindrical.axial.assign(table.rows(), 0.0);
  cylindrical.equivalent = cylindrical.equivalent0 = cylindrical.radial;
  return point;
}

DutyShares duty_shares(const std::vector<LifePoint>& points) {
  DutyShares shares;
  for (const LifePoint& p : points) shares.time.push_back(p.share);
  normalise(shares.time);
  for (std::size_t i = 0; i < points.size(); ++i)
    shares.revolutions.push_back(shares.time[i] * std::abs(points[i].speed_rpm));
  normalise(shares.revolutions);
  return shares;
}

PumpLife pump_life(const Case& the_case, const std::vector<LifePoint>& points) {
  const BearingRatings& b = rated(the_case);
  const DutyShares shares = duty_shares(points);
  const std::vector<double>& revolutions = shares.revolutions;
  PumpLife life;
  for (std::size_t i = 0; i < points.size(); ++i)
    life.mean_speed_rpm += shares.time[i] * std::abs(points[i].speed_rpm);
  std::array<double, 2> lives{}, slopes{};
  for (const Bearing bearing : kBearings) {
    const auto i = static_cast<std::size_t>(bearing);
    life.bearings[i] =
        life_of(bearing, rating_of(b, bearing), points, revolutions, life.mean_speed_rpm);
    lives[i] = life.bearings[i].revolutions;
    slopes[i] = law_of(rating_of(b, bearing).element).weibull_slope;
  }
  life.revolutions = combined_life(lives, slopes);
  life.hours = hours(life.revolutions, life.mean_speed_rpm);
  find_limits(b, points, revolutions, life);
  return life;
}

}  // namespace bentaxis::study
