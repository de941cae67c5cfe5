#include "bentaxis/designs/output.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "bentaxis/analytic/budget.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/compare/reference.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/budget.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/column_values.h"
#include "bentaxis/study/bearing_life.h"
#include "bentaxis/study/efficiency.h"
#include "bentaxis/study/motion_answers.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/simulation.h"
#include "bentaxis/study/timing.h"

namespace bentaxis::designs {
namespace {

using compare::vector_name;

const std::vector<std::string>& statistic_names() {
  static const std::vector<std::string> names = {"mean", "min", "max", "peak", "rms", "range"};
  return names;
}

std::string without_unit(const std::string& column, const std::string& unit) {
  return unit.empty() ? column : column.substr(0, column.size() - unit.size() - 1);
}

// Names by which a channel can be asked for.
std::vector<std::string> names_of(const Channel& c) {
  std::vector<std::string> names = {c.name, without_unit(c.name, c.unit)};
  if (c.piston == 1)
    for (std::string& name : std::vector<std::string>(names)) {
      const std::size_t at = name.find("_1");
      names.push_back(name.substr(0, at) + name.substr(at + 2));
    }
  return names;
}

std::string meaning_of(const Channel& c, bool vector) {
  std::string text = c.meaning;
  if (!c.on_body.empty()) text += " on " + c.on_body;
  if (!c.by_body.empty()) text += " by " + c.by_body;
  if (!c.point.empty())
    text +=
        (c.point.starts_with("about ") || c.point.starts_with("from ") ? ", " : ", at ") + c.point;
  if (!c.frame.empty()) text += vector ? ", magnitude" : ", along " + c.axis;
  return text;
}

bool can_be_asked_for(const Channel& c) { return c.kind != ChannelKind::check; }

// Fills in what a statistic is of; false where there is no such channel.
bool find_channels(const std::string& wanted, const std::vector<Channel>& channels, Output& o) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (!can_be_asked_for(channels[i])) continue;
    if (!contains(names_of(channels[i]), wanted)) continue;
    o.columns = {i};
    o.item = channels[i].name;
    o.unit = channels[i].unit;
    o.meaning = meaning_of(channels[i], false);
    return true;
  }
  // A vector: "Rs", of piston 1, or "Rs_3".
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Channel& c = channels[i];
    if (!can_be_asked_for(c) || c.frame == "S3") continue;
    if (wanted != vector_name(c) && !(c.piston == 1 && wanted == c.quantity)) continue;
    o.columns.push_back(i);
    o.item = vector_name(c);
    o.unit = c.unit;
    o.meaning = meaning_of(c, o.columns.size() > 1);
  }
  return !o.columns.empty();
}

struct DerivedEntry {
  const char *name, *unit, *meaning;
  double (*value)(const analytic::DerivedQuantities&);
};
const DerivedEntry kDerived[] = {
    {"displacement_cm3", "cm3", "displacement per turn",
     [](const analytic::DerivedQuantities& d) { return d.displacement * 1e6; }},
    {"stroke_mm", "mm", "stroke of a piston",
     [](const analytic::DerivedQuantities& d) { return d.stroke * 1e3; }},
    {"largest_tilt_deg", "deg",
     "largest angle between a piston and the block axis; of pistons that turn the block at the end "
     "of its free play",
     [](const analytic::DerivedQuantities& d) { return d.largest_tilt * 180 / kPi; }},
};

struct LifeEntry {
  const char *name, *unit, *meaning;
  double (*value)(const study::PumpLife&);
};
const LifeEntry kLives[] = {
    {"tapered_h", "h", "rating life L10h of the tapered bearing",
     [](const study::PumpLife& l) { return l.of(study::Bearing::tapered).hours; }},
    {"cylindrical_h", "h", "rating life L10h of the cylindrical bearing",
     [](const study::PumpLife& l) { return l.of(study::Bearing::cylindrical).hours; }},
    {"system_h", "h", "rating life L10h of both bearings together",
     [](const study::PumpLife& l) { return l.hours; }},
    {"tapered_P_N", "N", "mean equivalent load of the tapered bearing",
     [](const study::PumpLife& l) { return l.of(study::Bearing::tapered).mean_load; }},
    {"cylindrical_P_N", "N", "mean equivalent load of the cylindrical bearing",
     [](const study::PumpLife& l) { return l.of(study::Bearing::cylindrical).mean_load; }},
    {"tapered_static_safety", "", "static safety C0 / P0 of the tapered bearing",
     [](const study::PumpLife& l) { return l.of(study::Bearing::tapered).static_safety; }},
    {"cylindrical_static_safety", "", "static safety C0 / P0 of the cylindrical bearing",
     [](const study::PumpLife& l) { return l.of(study::Bearing::cylindrical).static_safety; }},
};
bool has_ratings(const Case& the_case) {
  return the_case.ratings.tapered && the_case.ratings.cylindrical;
}

// Of the entry of this name.
template <std::size_t size, class Entry, class Of>
double value_in(const Entry (&entries)[size], const std::string& name, const Of& of) {
  for (const Entry& e : entries)
    if (name == e.name) return e.value(of);
  return not_computed();
}

struct MotionEntry {
  const char *name, *unit, *meaning;
  bool of_oil;  // of the delivery pressure
  double (*value)(const study::MotionAnswers&);
};
const MotionEntry kMotion[] = {
    {"reached_s", "s", "time at which the shaft has made 95 % of the change of its speed, for good",
     false, [](const study::MotionAnswers& a) { return a.reached_s.value_or(not_computed()); }},
    {"last_rpm", "rpm", "speed of the shaft at the end", false,
     [](const study::MotionAnswers& a) { return a.last_rpm; }},
    {"peak_torque_Nm", "Nm", "drive torque Td of the largest magnitude, with its sign", false,
     [](const study::MotionAnswers& a) { return a.largest_torque; }},
    {"peak_torque_s", "s", "time of the drive torque of the largest magnitude", false,
     [](const study::MotionAnswers& a) { return a.largest_torque_s; }},
    {"drive_work_J", "J", "energy from the drive", false,
     [](const study::MotionAnswers& a) { return a.drive_work; }},
    {"peak_delivery_bar", "bar", "highest delivery pressure", true,
     [](const study::MotionAnswers& a) {
       return a.delivery ? a.delivery->highest_bar : not_computed();
     }},
    {"peak_delivery_s", "s", "time of the highest delivery pressure", true,
     [](const study::MotionAnswers& a) {
       return a.delivery ? a.delivery->highest_s : not_computed();
     }},
    {"end_delivery_bar", "bar",
     "mean delivery pressure over the last tenth of the time or the last turn, what is longer",
     true,
     [](const study::MotionAnswers& a) {
       return a.delivery ? a.delivery->end_bar : not_computed();
     }},
    {"overshoot_bar", "bar", "highest delivery pressure less end_delivery_bar", true,
     [](const study::MotionAnswers& a) {
       return a.delivery ? a.delivery->highest_bar - a.delivery->end_bar : not_computed();
     }},
    {"beyond_plate_percent", "%",
     "share of the rows in which the film force acts beyond the port plate", false,
     [](const study::MotionAnswers& a) {
       return a.beyond_plate ? 100 * a.beyond_plate->share : 0;
     }},
};

// Keys of the limits of validity, and units and meanings of what is held to them.
struct ValidityEntry {
  const char *key, *unit, *meaning;
};
constexpr ValidityEntry kValidity[] = {
    {"flank", "N", "tooth force on the driving flank (limit: Rcs >= 0; none with two flanks)"},
    {"turned", "N", "tooth force at negative speed with one line of action (limit: Rcs <= 0)"},
    {"film", "N", "film force (limit: Fh <= 0)"},
    {"point", "mm", "distance of the film force from z2 (limit: r4 of the port plate)"},
    {"thrust", "N", "axial force of the tapered bearing (limit: Rb1_z1 >= 0)"},
    {"friction", "W", "power that friction adds (limit: 0)"},
    {"ring", "W", "power of the bore forces on the play (limit: 0)"},
    {"reach", "um", "approach of the teeth (limit: where a further pair would touch)"}};

std::vector<Channel> budget_channels(const Case& the_case) {
  return budget_table("", the_case.pump.piston.contact.has_value(),
                      the_case.pump.gear.contact == ToothContact::teeth)
      .channels;
}

bool is_hydraulic(const Case& base) { return base.pressure.kind == PressureKind::hydraulic; }

// What this case has that is asked for by its name alone.
std::vector<Output> single_outputs(const Case& base) {
  std::vector<Output> all;
  const auto add = [&](Source source, const std::string& prefix, const std::string& item,
                       const std::string& unit, const std::string& meaning, bool share = false) {
    all.push_back({.name = prefix + item + (share ? ".share" : ""),
                   .unit = unit,
                   .meaning = meaning,
                   .source = source,
                   .item = item,
                   .share = share});
  };
  for (const DerivedEntry& d : kDerived) add(Source::derived, "", d.name, d.unit, d.meaning);
  for (const auto& [key, unit, meaning] : kValidity) {
    add(Source::validity, "validity.", key, unit, std::string("worst value of the ") + meaning);
    add(Source::validity, "validity.", key, "",
        std::string("share of the turn in which the limit is violated: ") + meaning, true);
  }
  for (const bool mechanical : {true, false})
    for (const study::EfficiencyLine& e : study::efficiency_lines())
      if ((e.key == std::string("mechanical")) == mechanical && (mechanical || is_hydraulic(base)))
        add(Source::efficiency, "efficiency.", e.key, "%",
            std::string(e.name) + " efficiency: " + e.meaning);
  if (is_hydraulic(base)) {
    hydraulics::SteadyState empty;
    empty.summary.load_size = 1;  // named as what it is where there is one
    if (base.hydraulics && base.hydraulics->load) empty.summary.load = base.hydraulics->load->kind;
    for (const hydraulics::Line& line : hydraulics::lines(empty))
      add(Source::hydraulics, "hydraulics.", line.key, line.unit, line.name);
  }
  add(Source::plausibility, "plausibility.", "warnings", "",
      "number of plausibility warnings without a stated reason");
  if (is_hydraulic(base)) {
    for (const study::TimingQuantity& q : study::timing_quantities()) {
      if (q.searched) continue;
      add(Source::timing, "timing.", q.code, q.unit, q.quantity);
      if (q.code == "connected-area") continue;  // has no limit
      add(Source::timing, "timing.", q.code, q.unit, q.quantity + ", above its limit");
      all.back().name += ".excess";
      all.back().excess = true;
    }
    add(Source::timing, "timing.", "warnings", "",
        "number of port timing quantities that exceed their limits without a stated reason");
  }
  if (base.drive)
    for (const MotionEntry& e : kMotion)
      if (is_hydraulic(base) || !e.of_oil)
        add(Source::motion, "motion.", e.name, e.unit,
            std::string("of the simulation in time: ") + e.meaning);
  if (has_ratings(base))
    for (const LifeEntry& e : kLives) add(Source::life, "life.", e.name, e.unit, e.meaning);
  return all;
}

// What a case lacks for an output of this name; "" where nothing.
std::string lacking(const std::string& name, const Case& base) {
  if (name.starts_with("life.") && !has_ratings(base))
    return "needs ratings of both bearings in [bearings]";
  if (name.starts_with("motion.") && !base.drive)
    return "needs [drive], as in cases/bap63_start_up.toml";
  const auto& lines = study::efficiency_lines();
  const bool of_motion_of_oil = std::any_of(
      std::begin(kMotion), std::end(kMotion),
      [&](const MotionEntry& e) { return e.of_oil && name == std::string("motion.") + e.name; });
  const bool of_oil =
      of_motion_of_oil || name.starts_with("hydraulics.") || name.starts_with("timing.") ||
      std::any_of(lines.begin(), lines.end(),
                  [&](const auto& e) { return name == std::string("efficiency.") + e.key; });
  return of_oil && !is_hydraulic(base) ? "needs [pressure] kind = \"hydraulic\"" : "";
}

[[noreturn]] void unknown(const std::string& name, const Case& base) {
  auto names = output_names(base);
  const ChannelLayout layout(base.pump);
  const std::string statistic = name.substr(0, name.find(':') + 1);  // npos + 1 is 0
  if (Output o; statistic.empty() && find_channels(name, layout.channels(), o))
    throw InputError("output " + name + ": needs a statistic; did you mean \"mean:" + name + "\"?");
  if (!statistic.empty() && name.find("budget.") == std::string::npos) {
    names.clear();  // those of the statistic that is asked for
    for (const Channel& c : layout.channels())
      if (can_be_asked_for(c))
        for (const std::string& of : {c.name, vector_name(c)}) names.push_back(statistic + of);
  }
  throw InputError("output " + name + ": unknown name" +
                   suggestion(name, {names.begin(), names.end()}, "listed by bentaxis outputs"));
}

}  // namespace

std::string to_string(Statistic statistic) {
  return statistic_names()[static_cast<std::size_t>(statistic)];
}

Output output(const std::string& name, const Case& base) {
  Output o;
  o.name = name;
  if (const std::size_t colon = name.find(':'); colon != std::string::npos) {
    const auto& statistics = statistic_names();
    const auto found = std::find(statistics.begin(), statistics.end(), name.substr(0, colon));
    if (found == statistics.end())
      throw InputError("output " + name + ": no statistic " + name.substr(0, colon) +
                       suggestion(name.substr(0, colon), {statistics.begin(), statistics.end()}));
    o.statistic = static_cast<Statistic>(found - statistics.begin());
    std::string of = name.substr(colon + 1);
    const bool budget = of.starts_with("budget.");
    if (budget) of = of.substr(7);
    o.source = budget ? Source::budget : Source::curve;
    const ChannelLayout layout(base.pump);
    const auto& channels = budget ? budget_channels(base) : layout.channels();
    if (!find_channels(of, channels, o)) unknown(name, base);
    o.name = *found + ":" + (budget ? "budget." : "") + o.item;
    o.meaning = *found + " of " + o.meaning;
    return o;
  }
  for (Output& single : single_outputs(base))
    if (single.name == name) return std::move(single);
  if (const std::string why = lacking(name, base); !why.empty())
    throw InputError("output " + name + ": " + why);
  unknown(name, base);
}

std::vector<std::string> output_names(const Case& base) {
  std::vector<std::string> names;
  const ChannelLayout layout(base.pump);
  for (const Channel& c : layout.channels())
    if (can_be_asked_for(c) && c.piston <= 1) names.push_back("max:" + c.name);
  for (const Channel& c : layout.channels()) {  // vectors
    Output o;
    const std::string name = vector_name(c);
    if (c.piston <= 1 && find_channels(name, layout.channels(), o) && o.columns.size() > 1)
      add_once(names, "peak:" + name);
  }
  for (const Channel& c : budget_channels(base))
    if (can_be_asked_for(c)) names.push_back("mean:budget." + c.name);
  for (const Output& single : single_outputs(base)) names.push_back(single.name);
  return names;
}

double statistic_of(Statistic statistic, const std::vector<double>& values) {
  if (values.empty() || !is_computed(values.front())) return not_computed();
  double sum = 0, squares = 0, low = values.front(), high = low;
  for (const double v : values) {
    if (!is_computed(v)) return not_computed();
    sum += v;
    squares += v * v;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  const auto count = static_cast<double>(values.size());
  switch (statistic) {
    case Statistic::mean:
      return sum / count;
    case Statistic::min:
      return low;
    case Statistic::max:
      return high;
    case Statistic::peak:
      return std::max(std::abs(low), std::abs(high));
    case Statistic::rms:
      return std::sqrt(squares / count);
    case Statistic::range:
      break;
  }
  return high - low;
}

namespace {

double statistic_in(Output o, const ResultTable& table) {
  // The number of pistons moves columns, and may take some away.
  const auto stands = [&](std::size_t column) {
    return column < table.columns() &&
           (table.channels[column].name == o.item || vector_name(table.channels[column]) == o.item);
  };
  if (!std::all_of(o.columns.begin(), o.columns.end(), stands)) {
    o.columns.clear();
    if (!find_channels(o.item, table.channels, o)) return not_computed();
  }
  std::vector<double> values(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (o.columns.size() == 1) {
      values[row] = table.at(row, o.columns[0]);
      continue;
    }
    double squares = 0;
    for (const std::size_t column : o.columns)
      squares += table.at(row, column) * table.at(row, column);
    values[row] = std::sqrt(squares);
  }
  return statistic_of(o.statistic, values);
}

// What several outputs of one design are read off, each found once.
class Turn {
 public:
  Turn(const study::PreparedCase& ready, study::Model model, bool budget)
      : ready_(ready), model_(model) {
    run_ = study::run(ready, {.model = model, .budget = budget});
  }

  double value(const Output& o) {
    switch (o.source) {
      case Source::curve:
        return statistic_in(o, run_.table);
      case Source::budget:
        return statistic_in(o, *run_.budget);
      case Source::validity:
        return validity(o);
      case Source::efficiency:
        return efficiency(o);
      case Source::life:
        return life(o);
      case Source::derived:
      case Source::hydraulics:
      case Source::timing:
      case Source::plausibility:
      case Source::motion:
        break;
    }
    return not_computed();
  }

 private:
  double validity(const Output& o) {
    if (limits_.empty())
      limits_ = analytic::check_validity(ready_.the_case, ready_.assumptions(model_),
                                         ready_.samples(study::Way::driven), run_.table);
    for (const analytic::ValidityLimit& limit : limits_)
      if (limit.key == o.item && limit.applicable)
        return o.share ? limit.violated_share : limit.worst;
    return not_computed();
  }
  double efficiency(const Output& o) {
    const std::size_t column = ChannelLayout(ready_.the_case.pump).Td();
    const std::vector<double> torque = column_of(run_.table, column);
    if (!oil_) oil_ = study::pump_power(ready_);
    const study::Efficiencies all =
        study::efficiencies(ready_, oil_, statistic_of(Statistic::mean, torque));
    for (const study::EfficiencyLine& e : study::efficiency_lines())
      if (o.item == e.key) return all.*e.value;
    return not_computed();
  }

  double life(const Output& o) {
    const Case& the_case = ready_.the_case;
    if (!life_) life_ = study::pump_life(the_case, {study::life_point(the_case, run_.table)});
    return value_in(kLives, o.item, *life_);
  }

  const study::PreparedCase& ready_;
  study::Model model_;
  study::ModelRun run_;
  std::vector<analytic::ValidityLimit> limits_;
  std::optional<study::PumpLife> life_;
  std::optional<hydraulics::PumpPower> oil_;  // its balance
};

}  // namespace

double derived_value(const Output& output, const analytic::DerivedQuantities& derived) {
  return value_in(kDerived, output.item, derived);
}

double derived_value(const Output& output, const PumpParameters& pump) {
  return derived_value(output, analytic::derived_quantities(pump));
}

double derived_value(const Output& output, const Geometry& geometry) {
  PumpParameters pump;
  pump.geometry = geometry;
  return derived_value(output, pump);
}

namespace {

double timing_value(const Output& o, const std::vector<TimingRow>& rows) {
  if (o.item == "warnings") return static_cast<double>(study::timing_warnings(rows).size());
  for (const TimingRow& r : rows)
    if (r.code == o.item) return o.excess ? r.value - r.limit.value_or(not_computed()) : r.value;
  return not_computed();
}

}  // namespace

namespace {

// As `simulate --model MODEL` states them.
study::MotionAnswers motion_of(const Case& the_case, study::Model model) {
  study::SimulationChoice choice;
  choice.only = model;
  return study::simulate(study::prepare_simulation(the_case, choice), choice).answers;
}

// @param prepared  the case made ready, which costs what it takes where it is asked for first
std::vector<double> values_of(const std::vector<Output>& outputs, const Case& the_case,
                              const std::function<const study::PreparedCase&()>& prepared,
                              study::Model model) {
  std::optional<Turn> turn;
  std::optional<study::MotionAnswers> motion;
  std::optional<analytic::DerivedQuantities> derived;
  std::vector<TimingRow> timing;
  std::vector<double> values;
  const auto is = [](Source source) {
    return [source](const Output& o) { return o.source == source; };
  };
  const bool budget = std::any_of(outputs.begin(), outputs.end(), is(Source::budget));
  // A design whose turn cannot be computed has no outputs at all; a simulation may do without one.
  if (std::none_of(outputs.begin(), outputs.end(), is(Source::motion))) prepared();
  for (const Output& o : outputs) {
    if (o.source == Source::derived) {
      if (!derived) derived = analytic::derived_quantities(the_case.pump);
      values.push_back(derived_value(o, *derived));
    } else if (o.source == Source::hydraulics) {
      values.push_back(not_computed());
      for (const hydraulics::Line& line : hydraulics::lines(*prepared().hydraulics))
        if (line.key == o.item) values.back() = line.value;
    } else if (o.source == Source::timing) {
      if (timing.empty()) timing = study::timing_rows(prepared().the_case, *prepared().hydraulics);
      values.push_back(timing_value(o, timing));
    } else if (o.source == Source::plausibility) {
      values.push_back(
          static_cast<double>(study::plausibility(prepared().the_case).warnings.size()));
    } else if (o.source == Source::motion) {
      if (!motion) motion = motion_of(the_case, model);
      values.push_back(value_in(kMotion, o.item, *motion));
    } else {
      if (!turn) turn.emplace(prepared(), model, budget);
      values.push_back(turn->value(o));
    }
  }
  return values;
}

}  // namespace

std::vector<double> outputs_of(const std::vector<Output>& outputs, const Case& the_case,
                               std::optional<study::PreparedCase>& ready, study::Model model) {
  return values_of(
      outputs, the_case,
      [&]() -> const study::PreparedCase& {
        if (!ready) ready.emplace(study::prepare(the_case));
        return *ready;
      },
      model);
}

std::vector<double> outputs_of(const std::vector<Output>& outputs, const study::PreparedCase& ready,
                               study::Model model) {
  return values_of(
      outputs, ready.the_case, [&]() -> const study::PreparedCase& { return ready; }, model);
}

}  // namespace bentaxis::designs
