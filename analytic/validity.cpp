#include "bentaxis/analytic/validity.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::analytic {
namespace {

std::string newtons(double value) { return rounded_text(value, 4) + " N"; }

// Values apart by less are one: of the angles of those that a turn repeats the first counts.
constexpr double kSameValue = 1e-9;

// Scans a quantity that must not be negative: its smallest value is the worst.
void scan(ValidityLimit& limit, const ResultTable& table,
          const std::function<double(std::size_t row)>& must_not_be_negative,
          const std::function<double(std::size_t row)>& shown) {
  std::size_t violated = 0;
  std::size_t counted = 0;
  std::vector<double> values(table.rows());
  limit.rows.assign(table.rows(), ValidityLimit::Row::unknown);
  double smallest = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double value = values[row] = must_not_be_negative(row);
    if (!is_computed(value)) continue;
    limit.rows[row] = value < 0 ? ValidityLimit::Row::violated : ValidityLimit::Row::holds;
    if (value < 0) ++violated;
    if (counted++ == 0 || value < smallest) {
      smallest = value;
      limit.worst = shown(row);
    }
  }
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (is_computed(values[row]) && values[row] <= smallest + kSameValue * std::abs(smallest)) {
      limit.theta_deg = table.theta_deg[row];
      break;
    }
  limit.applicable = counted > 0;
  if (counted > 0)
    limit.violated_share = static_cast<double>(violated) / static_cast<double>(counted);
}

std::string flank_text(const Model::FlankChange& change) {
  return "Rcn changes by up to " + newtons(change.pin) + ", Rb1 by " + newtons(change.tapered) +
         ", Rb2 by " + newtons(change.cylindrical) + ", Fh by " + newtons(change.film);
}

// Where the model covers what the limit asks: nothing is beyond it, whatever the values are.
void hold_everywhere(ValidityLimit& limit) {
  limit.violated_share = 0;
  for (ValidityLimit::Row& row : limit.rows)
    if (row == ValidityLimit::Row::violated) row = ValidityLimit::Row::holds;
}

// Where the other flank carries, and what that means.
void describe_flanks(ValidityLimit& flank, const Model& model, bool two, double omega,
                     double furthest) {
  // Of the rows where the two differ, that with the largest force.
  const Model::FlankChange change = model.flank_change(furthest, omega);
  const bool differs = change.tapered > 0;
  if (two) {
    flank.consequence =
        (flank.violated_share > 0
             ? "Rcs is negative over " + rounded_text(100 * flank.violated_share, 3) +
                   " % of the turn: there the other flank is loaded"
             : std::string("Rcs is nowhere negative: one flank is loaded throughout")) +
        "; each flank pushes the gears apart" +
        (differs
             ? ". With one line of action for both, as printed in the paper, " + flank_text(change)
             : std::string());
    return;
  }
  flank.consequence =
      "the model uses one line of action; in reality the other flank is loaded, which also pushes "
      "the gears apart";
  if (flank.violated_share == 0) return;
  flank.consequence += omega < 0 ? ", as the line turned by sign(omega) does here"
                                 : ": with the other flank loaded, " + flank_text(change);
}

// Bore forces off B act on a point that the bore does not guide.
ValidityLimit ring_limit(const Model& model, const Case& the_case, const Samples& samples,
                         const ResultTable& table) {
  ValidityLimit ring;
  ring.limit = "bore forces act where the bore guides the piston: they do no work on the play";
  ring.name = "Rc works on the play";
  ring.key = "ring";
  ring.unit = "W";
  Instant instant;
  PlacedSamples placed(model, the_case);
  std::vector<double> values(model.layout().size());
  const auto power = [&](std::size_t row) {
    MotionChecks checks;
    samples.instant(row, instant);
    model.evaluate(placed.at(instant), values, &checks);
    return checks.ring_power;
  };
  scan(
      ring, table, [&](std::size_t row) { return -std::abs(power(row)); }, power);
  double mean = 0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    mean += power(row) / static_cast<double>(table.rows());
  ring.consequence = "Rc acts at C, " + rounded_text(*the_case.pump.piston.contact * 1e3, 6) +
                     " mm from A, and the ring keeps B, at " +
                     rounded_text(the_case.pump.geometry.piston_length * 1e3, 6) +
                     " mm, on the axis of the bore: mean power of Rc on the play " +
                     rounded_text(mean, 4) + " W, its torque is a line of the budget";
  return ring;
}

// More pairs of teeth might touch than are looked at.
ValidityLimit reach_limit(const Model& model, const Case& the_case, const Samples& samples,
                          const ResultTable& table) {
  const double reach = BevelTeeth(the_case.pump).geometry().reach;
  ValidityLimit limit;
  limit.limit =
      "tooth load so low that no further pair touches: below " + rounded_text(reach * 1e6) + " um";
  limit.name = "further pairs of teeth touch";
  limit.key = "reach";
  limit.unit = "um";
  Instant instant;
  TeethAction action;
  std::vector<double> values(model.layout().reactions());
  std::vector<double> pressed;  // m, by row
  for (std::size_t row = 0; row < table.rows(); ++row) {
    samples.instant(row, instant);
    model.reactions(instant, values, &action);
    pressed.push_back(0);
    for (const PairContact& pair : action.pairs)
      pressed.back() = std::max(pressed.back(), pair.approach);
  }
  scan(
      limit, table, [&](std::size_t row) { return reach - pressed[row]; },
      [&](std::size_t row) { return pressed[row] * 1e6; });
  limit.consequence =
      "three pairs of each flank are modelled; a fourth would carry part of the force";
  return limit;
}

}  // namespace

double share_beyond(const std::vector<ValidityLimit>& limits) {
  using Row = ValidityLimit::Row;
  std::vector<Row> any;
  for (const ValidityLimit& limit : limits) {
    if (!limit.applicable) continue;
    any.resize(std::max(any.size(), limit.rows.size()), Row::unknown);
    for (std::size_t row = 0; row < limit.rows.size(); ++row)
      any[row] = std::max(any[row], limit.rows[row]);
  }
  const auto known = std::count_if(any.begin(), any.end(), [](Row r) { return r != Row::unknown; });
  const auto beyond = std::count(any.begin(), any.end(), Row::violated);
  return known > 0 ? static_cast<double>(beyond) / static_cast<double>(known) : 0;
}

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

  const bool two = the_case.pump.gear.flanks == Flanks::two;
  ValidityLimit flank;
  flank.limit = two ? "tooth force on a modelled flank: both flanks are modelled"
                    : "tooth force on the modelled flank: Rcs >= 0";
  flank.name = "Rcs < 0";
  flank.key = "flank";
  flank.unit = "N";
  scan(flank, table, value(at.Rcs()), value(at.Rcs()));
  const TransferKind kind = the_case.pump.transfer.kind;
  flank.consequence = kind == TransferKind::gear
                          ? "no tooth force: the block's speed is imposed"
                          : "no tooth force: [transfer] kind = \"" + to_string(kind) + "\"";
  if (flank.applicable) {
    // (22) turns with the speed: so does the sign at which one line and two flanks differ.
    ValidityLimit pulled;
    if (samples.omega < 0)
      scan(pulled, table, negated(at.Rcs()), value(at.Rcs()));
    else
      pulled = flank;
    describe_flanks(flank, model, two, samples.omega, pulled.worst);
    if (two) hold_everywhere(flank);
  }
  limits.push_back(flank);

  if (samples.omega < 0 && !two && kind == TransferKind::gear) {
    ValidityLimit turned;
    turned.limit = "separating part of the tooth force pushes the gears apart";
    turned.name = "separating force reversed by sign(omega)";
    turned.key = "turned";
    turned.unit = "N";
    scan(turned, table, negated(at.Rcs()), value(at.Rcs()));
    turned.consequence =
        "(22) as printed turns the whole line of action with the speed; a real gear keeps the "
        "separating direction" +
        (turned.violated_share > 0 ? ": with the other flank loaded, " +
                                         flank_text(model.flank_change(turned.worst, samples.omega))
                                   : std::string());
    limits.push_back(turned);
  }

  ValidityLimit film;
  film.limit = "film force pushes the block off the port plate: Fh <= 0";
  film.name = "Fh reversed";
  film.key = "film";
  film.unit = "N";
  scan(film, table, negated(at.Fh()), value(at.Fh()));
  film.consequence =
      "the film would have to pull the block onto the plate; in reality the block lifts off";
  limits.push_back(film);

  ValidityLimit point;
  point.limit = "film force acts within the plate: radius of (xh, yh) <= r4";
  point.name = "(xh, yh) outside r4";
  point.key = "point";
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
        "the film pressure cannot act outside the plate: the block tilts until its edge makes "
        "contact";
  } else {
    point.consequence = "the case has no port plate";
  }
  limits.push_back(point);

  ValidityLimit thrust;
  thrust.limit = "tapered bearing loaded in its direction: Rb1_z1 >= 0";
  thrust.name = "Rb1_z1 reversed";
  thrust.key = "thrust";
  thrust.unit = "N";
  scan(thrust, table, value(at.Rb1(2)), value(at.Rb1(2)));
  thrust.consequence =
      "a tapered roller bearing takes thrust in one direction only; the shaft would move";
  limits.push_back(thrust);

  ValidityLimit friction;
  friction.limit = "friction dissipates energy: its power is not positive";
  friction.name = "friction adds energy";
  friction.key = "friction";
  friction.unit = "W";
  Instant instant;
  PlacedSamples placed(model, the_case);
  const auto power = [&](std::size_t row) {
    samples.instant(row, instant);
    const Model::FrictionPower p = model.friction_power(placed.at(instant), table.at(row, at.Td()));
    return std::max({p.pistons, p.block, p.shaft_viscous, p.shaft_proportional});
  };
  scan(
      friction, table, [&](std::size_t row) { return -power(row); }, power);
  friction.consequence =
      "(38) is used as printed: where Td omega < 0 (motoring) its proportional part drives the "
      "shaft instead of braking it";
  limits.push_back(friction);

  if (the_case.pump.piston.contact &&
      *the_case.pump.piston.contact != the_case.pump.geometry.piston_length)
    limits.push_back(ring_limit(model, the_case, samples, table));
  if (the_case.pump.gear.contact == ToothContact::teeth && assumptions.gear == BlockDrive::mesh)
    limits.push_back(reach_limit(model, the_case, samples, table));
  return limits;
}

}  // namespace bentaxis::analytic
