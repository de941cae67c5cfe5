#include "bentaxis/analytic/validity.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic {
namespace {

using Value = std::function<double(std::size_t row)>;

std::string newtons(double value) { return rounded_text(value, 4) + " N"; }

// What limits are checked by: the rows of a turn or of a motion.
struct Rows {
  const Case& the_case;
  const Model& model;
  const ResultTable& table;
  bool in_time;                       // rows of a motion; else angles of a turn
  std::vector<double> speed = {};     // of the shaft, rad/s
  std::vector<double> friction = {};  // W, of the source of friction with the largest power
  std::vector<double> ring = {};      // W, of Rc on the play, where it acts off B
  std::vector<double> pressed = {};   // m, largest approach of teeth, where they are resolved

  const ChannelLayout& at() const { return model.layout(); }
  Value value(std::size_t column) const {
    return [this, column](std::size_t row) { return table.at(row, column); };
  }
  Value negated(std::size_t column) const {
    return [this, column](std::size_t row) { return -table.at(row, column); };
  }
  // "over 7.5 % of the turn"
  std::string share(double part) const {
    const std::string percent = rounded_text(100 * part, 3);
    return in_time ? "in " + percent + " % of the rows" : "over " + percent + " % of the turn";
  }
  // Bore forces that act at B do no work on the play.
  bool ring_off() const {
    const std::optional<double>& contact = the_case.pump.piston.contact;
    return contact && *contact != the_case.pump.geometry.piston_length;
  }
  bool two_flanks() const { return the_case.pump.gear.flanks == Flanks::two; }
};

// Values apart by less are one: of the angles of those that a turn repeats the first counts.
constexpr double kSameValue = 1e-9;

// Scans a quantity that must not be negative: its smallest value is the worst.
void scan(ValidityLimit& limit, const Rows& rows, const Value& must_not_be_negative,
          const Value& shown) {
  std::size_t violated = 0;
  std::size_t counted = 0;
  const std::size_t count = rows.table.rows();
  std::vector<double> values(count);
  limit.rows.assign(count, ValidityLimit::Row::unknown);
  for (std::size_t row = 0; row < count; ++row) {
    const double value = values[row] = must_not_be_negative(row);
    if (!is_computed(value)) continue;
    limit.rows[row] = value < 0 ? ValidityLimit::Row::violated : ValidityLimit::Row::holds;
    if (value < 0) ++violated;
    if (counted++ == 0 || value < limit.margin) {
      limit.margin = value;
      limit.worst = shown(row);
    }
  }
  for (std::size_t row = 0; row < count; ++row)
    if (is_computed(values[row]) &&
        values[row] <= limit.margin + kSameValue * std::abs(limit.margin)) {
      limit.row = row;
      limit.theta_deg = rows.table.theta_deg[row];
      break;
    }
  limit.applicable = counted > 0;
  if (counted > 0)
    limit.violated_share = static_cast<double>(violated) / static_cast<double>(counted);
}

ValidityLimit limit_of(std::string key, std::string name, std::string unit, std::string limit) {
  ValidityLimit made;
  made.key = std::move(key);
  made.name = std::move(name);
  made.unit = std::move(unit);
  made.limit = std::move(limit);
  return made;
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

// What two flanks change, at most, where one line of action pulls the gears together: its direction
// turns with the speed (22).
Model::FlankChange flank_change(const Rows& rows) {
  ValidityLimit pulled;
  const std::size_t Rcs = rows.at().Rcs();
  scan(
      pulled, rows,
      [&](std::size_t row) { return (rows.speed[row] < 0 ? -1 : 1) * rows.table.at(row, Rcs); },
      rows.value(Rcs));
  return rows.model.flank_change(pulled.worst, rows.speed[pulled.row]);
}

// Where the other flank carries, and what that means.
std::string flank_consequence(const ValidityLimit& flank, const Rows& rows) {
  if (!flank.applicable) {
    const TransferKind kind = rows.the_case.pump.transfer.kind;
    return kind == TransferKind::gear
               ? "no tooth force: the block's speed is imposed"
               : "no tooth force: [transfer] kind = \"" + to_string(kind) + "\"";
  }
  const Model::FlankChange change = flank_change(rows);
  if (rows.two_flanks())
    return (flank.violated_share > 0
                ? "Rcs is negative " + rows.share(flank.violated_share) +
                      ": there the other flank is loaded"
                : std::string("Rcs is nowhere negative: one flank is loaded throughout")) +
           "; each flank pushes the gears apart" +
           (change.tapered > 0 ? ". With one line of action for both, as printed in the paper, " +
                                     flank_text(change)
                               : std::string());
  std::string text =
      "the model uses one line of action; in reality the other flank is loaded, which also pushes "
      "the gears apart";
  if (flank.violated_share == 0) return text;
  return text + (rows.speed[flank.row] < 0
                     ? ", as the line turned by sign(omega) does here"
                     : ": with the other flank loaded, " + flank_text(change));
}

ValidityLimit flank_limit(const Rows& rows) {
  ValidityLimit flank =
      limit_of("flank", "Rcs < 0", "N",
               rows.two_flanks() ? "tooth force on a modelled flank: both flanks are modelled"
                                 : "tooth force on the modelled flank: Rcs >= 0");
  scan(flank, rows, rows.value(rows.at().Rcs()), rows.value(rows.at().Rcs()));
  flank.consequence = flank_consequence(flank, rows);
  if (rows.two_flanks()) hold_everywhere(flank);
  return flank;
}

// Of a line of action that turns with the speed, where that is negative.
ValidityLimit turned_limit(const Rows& rows) {
  ValidityLimit turned = limit_of("turned", "separating force reversed by sign(omega)", "N",
                                  "separating part of the tooth force pushes the gears apart");
  const std::size_t Rcs = rows.at().Rcs();
  scan(
      turned, rows,
      [&](std::size_t row) {
        return rows.speed[row] < 0 ? -rows.table.at(row, Rcs) : not_computed();
      },
      rows.value(Rcs));
  turned.consequence =
      "(22) as printed turns the whole line of action with the speed; a real gear keeps the "
      "separating direction";
  if (turned.violated_share > 0)
    turned.consequence += ": with the other flank loaded, " +
                          flank_text(rows.model.flank_change(turned.worst, rows.speed[turned.row]));
  return turned;
}

ValidityLimit film_limit(const Rows& rows) {
  ValidityLimit film = limit_of("film", "Fh reversed", "N",
                                "film force pushes the block off the port plate: Fh <= 0");
  scan(film, rows, rows.negated(rows.at().Fh()), rows.value(rows.at().Fh()));
  film.consequence =
      "the film would have to pull the block onto the plate; in reality the block lifts off";
  return film;
}

ValidityLimit point_limit(const Rows& rows) {
  ValidityLimit point = limit_of("point", "(xh, yh) outside r4", "mm",
                                 "film force acts within the plate: radius of (xh, yh) <= r4");
  if (!rows.the_case.pump.port_plate) {
    point.applicable = false;
    point.consequence = "the case has no port plate";
    return point;
  }
  const double r4 = rows.the_case.pump.port_plate->r4 * 1e3;
  const Value radius = [&](std::size_t row) {
    return std::hypot(rows.table.at(row, rows.at().xh()), rows.table.at(row, rows.at().yh()));
  };
  scan(
      point, rows, [&](std::size_t row) { return r4 - radius(row); }, radius);
  point.consequence =
      "the film pressure cannot act outside the plate: the block tilts until its edge makes "
      "contact";
  return point;
}

ValidityLimit thrust_limit(const Rows& rows) {
  ValidityLimit thrust = limit_of("thrust", "Rb1_z1 reversed", "N",
                                  "tapered bearing loaded in its direction: Rb1_z1 >= 0");
  scan(thrust, rows, rows.value(rows.at().Rb1(2)), rows.value(rows.at().Rb1(2)));
  thrust.consequence =
      "a tapered roller bearing takes thrust in one direction only; the shaft would move";
  return thrust;
}

ValidityLimit friction_limit(const Rows& rows) {
  ValidityLimit friction = limit_of("friction", "friction adds energy", "W",
                                    "friction dissipates energy: its power is not positive");
  const Value power = [&](std::size_t row) { return rows.friction[row]; };
  scan(
      friction, rows, [&](std::size_t row) { return -power(row); }, power);
  friction.consequence =
      "(38) is used as printed: where Td omega < 0 (motoring) its proportional part drives the "
      "shaft instead of braking it";
  return friction;
}

// Bore forces off B act on a point that the bore does not guide.
ValidityLimit ring_limit(const Rows& rows) {
  ValidityLimit ring =
      limit_of("ring", "Rc works on the play", "W",
               "bore forces act where the bore guides the piston: they do no work on the play");
  const Value power = [&](std::size_t row) { return rows.ring[row]; };
  scan(
      ring, rows, [&](std::size_t row) { return -std::abs(power(row)); }, power);
  double mean = 0;
  for (const double one : rows.ring) mean += one / static_cast<double>(rows.ring.size());
  ring.consequence = "Rc acts at C, " + rounded_text(*rows.the_case.pump.piston.contact * 1e3, 6) +
                     " mm from A, and the ring keeps B, at " +
                     rounded_text(rows.the_case.pump.geometry.piston_length * 1e3, 6) +
                     " mm, on the axis of the bore: mean power of Rc on the play " +
                     rounded_text(mean, 4) + " W" +
                     (rows.in_time ? "" : ", its torque is a line of the budget");
  return ring;
}

// More pairs of teeth might touch than are looked at.
ValidityLimit reach_limit(const Rows& rows) {
  const double reach = BevelTeeth(rows.the_case.pump).geometry().reach;
  ValidityLimit limit = limit_of(
      "reach", "further pairs of teeth touch", "um",
      "tooth load so low that no further pair touches: below " + rounded_text(reach * 1e6) + " um");
  scan(
      limit, rows, [&](std::size_t row) { return reach - rows.pressed[row]; },
      [&](std::size_t row) { return rows.pressed[row] * 1e6; });
  limit.consequence =
      "three pairs of each flank are modelled; a fourth would carry part of the force";
  return limit;
}

double largest_approach(const TeethAction& action) {
  double approach = 0;
  for (const PairContact& pair : action.pairs) approach = std::max(approach, pair.approach);
  return approach;
}

double largest_power(const Model& model, const Instant& instant, double drive_torque) {
  const Model::FrictionPower p = model.friction_power(instant, drive_torque);
  return std::max({p.pistons, p.block, p.shaft_viscous, p.shaft_proportional});
}

std::vector<ValidityLimit> limits_of(const Rows& rows) {
  std::vector<ValidityLimit> limits = {flank_limit(rows)};
  const auto backwards = [](double speed) { return speed < 0; };
  if (!rows.two_flanks() && rows.the_case.pump.transfer.kind == TransferKind::gear &&
      std::any_of(rows.speed.begin(), rows.speed.end(), backwards))
    limits.push_back(turned_limit(rows));
  limits.push_back(film_limit(rows));
  limits.push_back(point_limit(rows));
  limits.push_back(thrust_limit(rows));
  limits.push_back(friction_limit(rows));
  if (rows.ring_off()) limits.push_back(ring_limit(rows));
  if (!rows.pressed.empty()) limits.push_back(reach_limit(rows));
  return limits;
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
  Rows rows{the_case, model, table, false, std::vector<double>(table.rows(), samples.omega)};
  const bool teeth =
      the_case.pump.gear.contact == ToothContact::teeth && assumptions.gear == BlockDrive::mesh;
  Instant instant;
  PlacedSamples placed(model, the_case);
  std::vector<double> values(model.layout().size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    samples.instant(row, instant);
    const Instant& there = placed.at(instant);
    rows.friction.push_back(largest_power(model, there, table.at(row, model.layout().Td())));
    if (rows.ring_off()) {
      MotionChecks checks;
      model.evaluate(there, values, &checks);
      rows.ring.push_back(checks.ring_power);
    }
    if (teeth) {
      TeethAction action;
      model.reactions(instant, values, &action);
      rows.pressed.push_back(largest_approach(action));
    }
  }
  return limits_of(rows);
}

std::vector<ValidityLimit> limits_in_time(const Case& the_case, const Assumptions& assumptions,
                                          const Trajectory& run) {
  const Model model(the_case.pump, assumptions);
  const ResultTable& table = run.table.results;
  const ChannelLayout& at = model.layout();
  const std::size_t ring = table.find("ring_power_W");
  Rows rows{the_case, model, table, true};
  Instant instant;
  instant.ports = the_case.pressure.ports;
  instant.chamber_pressure.resize(static_cast<std::size_t>(at.pistons()));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto turning = [&](StateColumn angle, StateColumn speed) {
      return AxisMotion{radians(run.state(row, angle)), rad_per_second(run.state(row, speed)), 0};
    };
    instant.shaft = turning(StateColumn::theta, StateColumn::shaft_speed);
    instant.block = turning(StateColumn::psi, StateColumn::block_speed);
    for (int k = 0; k < at.pistons(); ++k)
      instant.chamber_pressure[static_cast<std::size_t>(k)] =
          pascals(table.at(row, at.pressure(k)));
    rows.speed.push_back(instant.shaft.speed);
    rows.friction.push_back(largest_power(model, instant, table.at(row, at.Td())));
    if (rows.ring_off()) rows.ring.push_back(table.at(row, ring));
    if (!run.teeth.empty()) rows.pressed.push_back(largest_approach(run.teeth[row]));
  }
  return limits_of(rows);
}

}  // namespace bentaxis::analytic
