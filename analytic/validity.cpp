#include "bentaxis/analytic/validity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "bentaxis/pump/number.h"

namespace bentaxis::analytic {
namespace {

std::string newtons(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g N", value);
  return text;
}

// Scans a quantity that must not be negative: its smallest value is the worst.
void scan(ValidityLimit& limit, const ResultTable& table,
          const std::function<double(std::size_t row)>& must_not_be_negative,
          const std::function<double(std::size_t row)>& shown) {
  std::size_t violated = 0;
  std::size_t counted = 0;
  double smallest = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double value = must_not_be_negative(row);
    if (!is_computed(value)) continue;
    if (value < 0) ++violated;
    if (counted++ == 0 || value < smallest) {
      smallest = value;
      limit.worst = shown(row);
      limit.theta_deg = table.theta_deg[row];
    }
  }
  limit.applicable = counted > 0;
  if (counted > 0)
    limit.violated_share = static_cast<double>(violated) / static_cast<double>(counted);
}

std::string flank_text(const Model::FlankChange& change) {
  return "with the other flank carrying, Rcn changes by up to " + newtons(change.pin) +
         ", Rb1 by " + newtons(change.tapered) + ", Rb2 by " + newtons(change.cylindrical);
}

}  // namespace

std::vector<ValidityLimit> check_validity(const Case& the_case, const Assumptions& assumptions,
                                          const Samples& samples, const ResultTable& table) {
  const Model model(the_case.pump, assumptions);
  const ChannelLayout& at = model.layout();
  const auto value = [&](std::size_t column) {
    return [&table, column](std::size_t row) { return table.at(row, column); };
  };
  const auto negated = [&](std::size_t column) {
    return [&table, column](std::size_t row) { return -table.at(row, column); };
  };
  std::vector<ValidityLimit> limits;

  ValidityLimit flank;
  flank.limit = "tooth force on the modelled flank: Rcs >= 0";
  flank.name = "Rcs < 0";
  flank.unit = "N";
  scan(flank, table, value(at.Rcs()), value(at.Rcs()));
  flank.consequence =
      flank.applicable
          ? "the model keeps one line of action; a real tooth pair loads its other flank, which "
            "still pushes the gears apart" +
                (flank.violated_share > 0
                     ? ": " + flank_text(model.other_flank(std::min(0.0, flank.worst)))
                     : std::string())
          : "no tooth force: the block's speed is imposed";
  limits.push_back(flank);

  if (samples.omega < 0) {
    ValidityLimit turned;
    turned.limit = "separating part of the tooth force pushes the gears apart";
    turned.name = "separating force reversed by sign(omega)";
    turned.unit = "N";
    scan(turned, table, negated(at.Rcs()), value(at.Rcs()));
    turned.consequence =
        "(22) as printed turns the whole line of action with the speed; a real gear keeps the "
        "separating direction" +
        (turned.violated_share > 0 ? ": " + flank_text(model.other_flank(turned.worst))
                                   : std::string());
    limits.push_back(turned);
  }

  ValidityLimit film;
  film.limit = "film force pushes the block off the port plate: Fh <= 0";
  film.name = "Fh reversed";
  film.unit = "N";
  scan(film, table, negated(at.Fh()), value(at.Fh()));
  film.consequence =
      "the film would have to pull the block onto the plate; in reality the block lifts off";
  limits.push_back(film);

  ValidityLimit point;
  point.limit = "film force acts within the plate: radius of (xh, yh) <= r4";
  point.name = "(xh, yh) beyond r4";
  point.unit = "mm";
  point.applicable = the_case.pump.port_plate.has_value();
  if (point.applicable) {
    const double r4 = the_case.pump.port_plate->r4 * 1e3;
    const auto radius = [&](std::size_t row) {
      return std::hypot(table.at(row, at.xh()), table.at(row, at.yh()));
    };
    scan(
        point, table, [&](std::size_t row) { return r4 - radius(row); }, radius);
    point.consequence =
        "no pressure in the film can act outside the plate: the block tilts until "
        "its edge carries";
  } else {
    point.consequence = "the case has no port plate";
  }
  limits.push_back(point);

  ValidityLimit thrust;
  thrust.limit = "tapered bearing loaded in its direction: Rb1_z1 >= 0";
  thrust.name = "Rb1_z1 reversed";
  thrust.unit = "N";
  scan(thrust, table, value(at.Rb1(2)), value(at.Rb1(2)));
  thrust.consequence = "a tapered roller bearing takes thrust one way only; the shaft would move";
  limits.push_back(thrust);

  ValidityLimit friction;
  friction.limit = "friction takes energy: no friction with positive power";
  friction.name = "friction feeds energy in";
  friction.unit = "W";
  Instant instant;
  const auto power = [&](std::size_t row) {
    samples.instant(row, instant);
    const Model::FrictionPower p = model.friction_power(instant, table.at(row, at.Td()));
    return std::max({p.pistons, p.block, p.shaft_viscous, p.shaft_proportional});
  };
  scan(
      friction, table, [&](std::size_t row) { return -power(row); }, power);
  friction.consequence =
      "(38) is kept as printed: where Td omega < 0 (motoring) its proportional part drives the "
      "shaft instead of braking it";
  limits.push_back(friction);
  return limits;
}

}  // namespace bentaxis::analytic
