#include "bentaxis/study/rattle_document.h"

#include <array>

#include "bentaxis/study/failed_points.h"
#include "document_parts.h"

namespace bentaxis::study {
namespace {

using report::Values;

using Sweep = std::vector<RattlePoint> RattleRow::*;

std::array<long, 4> counts_of(const RattleMap& map, Sweep sweep) {
  std::array<long, 4> counts{};
  for (const RattleRow& row : map.rows)
    for (const RattlePoint& point : row.*sweep)
      if (point.done()) ++counts.at(static_cast<std::size_t>(point.kind));
  return counts;
}

bool rigid(const RattleMap& map) { return !map.the_case.pump.block_moves_freely(); }
bool by_pistons(const RattleMap& map) {
  return map.the_case.pump.transfer.kind == TransferKind::pistons;
}
// What carries the block, in words.
struct Words {
  const char *contacts, *contact, *force, *criterion;
};
const Words& words(const RattleMap& map) {
  static const Words kTeeth{"teeth", "flank", "tooth force", "rigid teeth"};
  static const Words kPistons{"pistons", "piston", "sum of the wall forces",
                              "one piston without play"};
  return by_pistons(map) ? kPistons : kTeeth;
}

// use(row, number of the speed) of every point where the sweeps up and down end in other motions.
template <class Use>
void for_each_two_states(const RattleMap& map, const Use& use) {
  for (const RattleRow& row : map.rows)
    for (std::size_t j = 0; j < row.up.size(); ++j)
      if (two_states(row.up[j], row.down[j])) use(row, j);
}

std::size_t two_states_of(const RattleMap& map) {
  std::size_t count = 0;
  for_each_two_states(map, [&](const RattleRow&, std::size_t) { ++count; });
  return count;
}

std::size_t failed_of(const RattleRow& row) {
  return report::count_of(row.up, [](const RattlePoint& point) { return !point.done(); });
}

std::size_t agreeing(const RattleMap& map) {
  return report::count_of(map.checks, [](const RattleCheck& check) { return check.agrees(); });
}

double turns_of(int parts) { return static_cast<double>(parts) / kPartsOfTurn; }

std::string headline(const RattleMap& map) {
  const auto counts = counts_of(map, &RattleRow::up);
  std::vector<std::string> classes;
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0)
      classes.push_back(fmt::format("{} at {}", rattle_class_names()[k], counts[k]));
  // Pressures that failed as a whole are not among the rows.
  const std::size_t speeds = map.options.speed_rpm.size(), lost = map.failed.size() * speeds;
  std::size_t failed = lost;
  for (const RattleRow& row : map.rows) failed += failed_of(row);
  std::string text =
      fmt::format("{} of {} points", joined(classes), map.rows.size() * speeds + lost);
  if (failed > 0) text += fmt::format(", {} could not be computed", failed);
  if (const std::size_t both = two_states_of(map); both > 0)
    text += fmt::format("; another steady state swept down at {}", both);
  if (map.checks.empty()) return text;
  text += fmt::format("; Simbody agrees at {} of {} points", agreeing(map), map.checks.size());
  if (const std::size_t partly =
          report::count_of(map.checks, [](const RattleCheck& check) { return check.chaotic(); });
      partly > 0)
    text += fmt::format(", {} of them compared over part of their turns only", partly);
  return text;
}

// Speeds at which the contact is lost, swept up or down: "300 to 900, 1500".
std::string speeds_to_avoid(const RattleRow& row, const std::vector<double>& speeds) {
  const auto avoided = [&](std::size_t j) {
    const auto rattles = [](const RattlePoint& point) {
      return point.done() && point.kind != RattleClass::carries;
    };
    return rattles(row.up[j]) || rattles(row.down[j]);
  };
  std::vector<std::string> ranges;
  for (std::size_t j = 0; j < row.up.size(); ++j) {
    if (!avoided(j)) continue;
    const std::size_t from = j;
    while (j + 1 < row.up.size() && avoided(j + 1)) ++j;
    ranges.push_back(j > from ? fmt::format("{:.4g} to {:.4g}", speeds[from], speeds[j])
                              : fmt::format("{:.4g}", speeds[from]));
  }
  return joined(ranges);
}

// Speeds to avoid at the pressure of the map that is nearest to the case's own: "300 to 900 rpm".
std::vector<std::string> answers_of(const RattleMap& map) {
  const double rated = map.the_case.pressure.ports.delivery / kPascalPerBar;
  const RattleRow* nearest = report::largest_of(
      map.rows, [&](const RattleRow& row) { return -std::abs(row.delivery_bar - rated); });
  if (nearest == nullptr) return {};
  const std::string avoided = speeds_to_avoid(*nearest, map.options.speed_rpm);
  const bool all = map.failed.empty();
  const std::string lost = joined(map.failed, ", ", [](const FailedPoint& failed) {
    return fmt::format("{:.4g} bar", failed.value);
  });
  const std::size_t unknown = failed_of(*nearest);
  std::string text = fmt::format(
      "At {:.4g} bar, of the pressures of the map{} the nearest to the case's {:.4g} bar: ",
      nearest->delivery_bar, all ? "" : " that could be computed", rated);
  text += avoided.empty()
              ? fmt::format("the {} are loaded throughout the turn at all speeds of the map{}.",
                            words(map).contacts, unknown == 0 ? "" : " that could be computed")
              : fmt::format(
                    "avoid {} rpm: the {} are not loaded throughout the turn (speeds of "
                    "the map).",
                    avoided, words(map).contacts);
  if (unknown > 0)
    text += fmt::format(" {} of its {} speeds could not be computed.", unknown, nearest->up.size());
  if (!all) text += " Could not be computed: " + lost + ".";
  // A sweep starts where it ended at the speed before.
  if (map.options.speed_rpm.size() <= 1)
    text +=
        " With one speed each sweep has one start: another steady state is found with speeds "
        "on both sides of it.";
  return {text};
}

std::string against(RattleClass analytic, RattleClass multibody) {
  return analytic == multibody ? to_string(analytic)
                               : to_string(analytic) + " against " + to_string(multibody);
}

std::string agreement_text(const BoundaryAgreement& agreement) {
  std::string text = fmt::format("the criterion says the same as the motion at {} of {} points",
                                 agreement.same, agreement.points);
  double sum = 0, most = 0, spacing = 0;
  int count = 0;
  for (const auto& place : agreement.places) {
    if (!is_computed(place.simulated_rpm)) continue;
    const double difference = place.simulated_rpm - place.criterion_rpm;
    sum += difference;
    most = std::max(most, std::abs(difference));
    spacing = std::max(spacing, place.spacing_rpm);
    ++count;
  }
  if (count > 0)
    text += fmt::format(
        "; the simulated boundary lies {:.3g} rpm {} it on average, {:.3g} rpm from it at most, "
        "where speeds are {:.3g} rpm apart and leave {:.3g} rpm open on either side",
        std::abs(sum / count), sum < 0 ? "below" : "above", most, spacing, spacing / 2);
  return text;
}

report::Section settings_section(const RattleMap& map) {
  const RattleOptions& o = map.options;
  report::NewSection section("How it was computed");
  section.fact("shaft", "constant speed of the point; [drive] is not used");
  if (rigid(map)) {
    section.text =
        "Teeth are rigid: block and shaft have the same angle. Only loaded and reversing are "
        "distinguished, by the sign of the tooth force.";
    return section;
  }
  section.fact("first point",
               "the lowest speed, from theta = psi = 0, the middle of the {}, both at the shaft's "
               "speed",
               by_pistons(map) ? "free play" : "backlash");
  section.fact("every other point",
               "from the final state of the neighbouring point: up in speed, then down");
  section.fact("discarded", "{} turns, fewer where the motion repeats itself", o.discard);
  section.fact("observed", "{} turns, or one period where the motion repeats itself", o.turns);
  section.fact("repeats itself",
               "lag and its rate as 1 to {} turns ago, within {:g} of their scales, twice running",
               kLongestPeriod, kRepeats);
  section.fact("in touch throughout", "{} turns without separation: the last of them is observed",
               kTurnsInTouch);
  section.fact("impact", "a touch at {:g} m/s of approach or more", kImpactSpeed);
  if (by_pistons(map))
    section.fact("sides", "the sign of theta - psi when a piston touches its wall");
  else
    section.fact("largest impulse",
                 "from an impact until its flank leaves (rattle.csv: largest_impulse_Ns): of teeth "
                 "that hit once and then carry, with what they carry");
  section.fact("loses contact", "no {} touches for more than {:g} of the time", words(map).contact,
               kNoGap);
  section.fact("two steady states",
               "up and down differ in class, or the largest force of every turn of one is above "
               "all of the other and {:g} % larger",
               100 * kOtherForce);
  section.fact("integration",
               "BDF of variable order (CVODES), errors of a step for an error of {:g} of peak "
               "(--error)",
               o.error);
  return section;
}

report::Section classes_section(const RattleMap& map) {
  report::NewSection section("Classes",
                             "Of the points swept up and down. Share out of contact: of the upward "
                             "points of the class, mean.");
  section.columns("class", "points, up", "points, down", "largest force over mean, up",
                  "share out of contact, up");
  const auto up = counts_of(map, &RattleRow::up), down = counts_of(map, &RattleRow::down);
  for (std::size_t k = 0; k < up.size(); ++k) {
    double most = 0, apart = 0;
    for (const RattleRow& row : map.rows)
      for (const RattlePoint& p : row.up)
        if (p.done() && static_cast<std::size_t>(p.kind) == k) {
          if (p.mean > 0) most = std::max(most, p.over_mean());
          apart += p.apart / static_cast<double>(up[k]);
        }
    const auto if_any = [&](double value) { return up[k] > 0 ? value : not_computed(); };
    section.row(rattle_class_names()[k], up[k], down[k], if_any(most), if_any(apart));
  }
  return section;
}

report::Section boundary_section(const RattleMap& map) {
  const BoundaryAgreement agreement = boundary_agreement(map);
  report::NewSection section(
      "Boundary by the criterion",
      std::string(by_pistons(map) ? "A transfer without play keeps the sign of its torque"
                                  : "Rigid teeth keep the sign of their force") +
          " as long as the drag on the block, Cc psi', and what its pistons take exceed what they "
          "turn it on by, all through the turn. The speed at which the smallest force passes 0, "
          "beside the speed half way between those where the upward sweep ceases or begins to "
          "carry: " +
          agreement_text(agreement) + ".");
  if (by_pistons(map))
    section.say(
        "In the free play pistons under pressure push the block away from the middle, which the "
        "criterion does not have.");
  section.columns("delivery pressure, bar", "criterion, rpm", "simulated, rpm", "difference, rpm");
  for (const auto& place : agreement.places)
    section.row(place.delivery_bar, place.criterion_rpm, place.simulated_rpm,
                place.simulated_rpm - place.criterion_rpm);
  if (agreement.places.empty()) section.fact("boundary", "none within these speeds and pressures");
  return section;
}

report::Section states_section(const RattleMap& map) {
  constexpr std::size_t kMaxRows = 100;  // the rest is in the CSV file
  report::NewSection section("Two steady states",
                             "Points where the upward and the downward sweep converge to different "
                             "motions. No period: irregular, longer, or still decaying.");
  section.fact("points", std::to_string(two_states_of(map)));
  section.columns("delivery pressure, bar", "speed, rpm", "up", "down", "largest up, N",
                  "largest down, N", "period up, turns", "period down, turns");
  const auto period = [](const RattlePoint& p) {
    return p.period > 0 ? report::cell_of(p.period) : report::Cell("none");
  };
  for_each_two_states(map, [&](const RattleRow& row, std::size_t j) {
    const RattlePoint &u = row.up[j], &d = row.down[j];
    if (section.table.rows.size() < kMaxRows)
      section.row(row.delivery_bar, map.options.speed_rpm[j], to_string(u.kind), to_string(d.kind),
                  u.largest, d.largest, period(u), period(d));
  });
  return section;
}

report::Section checks_section(const RattleMap& map) {
  report::NewSection section(
      "Recomputed by Simbody",
      "Points spread over the classes, through the observed turns from the state at which they "
      "begin. A second run of the closed form from a slightly disturbed state measures the "
      "amplification of disturbances: the tolerance of the largest force is the integration error "
      "times this factor. Where the factor is too large, nothing is compared; such a motion is "
      "chaotic, and later results agree only in kind. Where the classes differ, that of the closed "
      "form is given first.");
  section.fact("agree", "{} of {}", agreeing(map), map.checks.size());
  section.columns("bar", "rpm", "class", "turns compared", "of", "growth", "largest force apart by",
                  "allowed", "agrees", "all turns: class", "largest, N", "Simbody, N");
  for (const RattleCheck& c : map.checks)
    section.row(map.options.delivery_bar[c.row], map.options.speed_rpm[c.speed],
                against(c.analytic, c.multibody), turns_of(c.judged), turns_of(c.parts), c.growth,
                c.difference, c.allowed, c.agrees(), against(c.analytic_whole, c.multibody_whole),
                c.largest_analytic, c.largest_multibody);
  return section;
}

class MapFigures {
 public:
  explicit MapFigures(const RattleMap& map) : map_(map) {
    std::size_t most = 0;
    for (const RattleRow& row : map.rows) most = std::max(most, row.boundary_rpm.size());
    for (std::size_t k = 0; k < most; ++k) {
      lines_.push_back(
          {k == 0 ? fmt::format("criterion: at lower speed {} would reverse", words(map).criterion)
                  : "criterion, again",
           {},
           {}});
      for (const RattleRow& row : map.rows)
        lines_.back().add(k < row.boundary_rpm.size() ? row.boundary_rpm[k] : not_computed(),
                          row.delivery_bar);
    }
    report::XySeries marks{"up and down differ", {}, {}};
    for_each_two_states(map, [&](const RattleRow& row, std::size_t j) {
      marks.add(map.options.speed_rpm[j], row.delivery_bar);
    });
    if (!marks.x.empty()) marks_ = std::move(marks);
  }

  template <class Value>
  report::Figure figure(const std::string& id, const std::string& title, report::Axis z,
                        Sweep sweep, const Value& value) const {
    report::MapFigure m{{"speed", "rpm"},
                        {"delivery pressure", "bar"},
                        std::move(z),
                        map_.options.speed_rpm,
                        map_.options.delivery_bar,
                        {},
                        {},
                        {}};
    bool all_done = true;
    for (const RattleRow& row : map_.rows) {
      m.values.push_back(report::each_of(row.*sweep, [&](const RattlePoint& point) {
        return point.done() ? value(point) : not_computed();
      }));
      m.reasons.push_back(
          report::each_of(row.*sweep, [](const RattlePoint& point) { return point.reason; }));
      all_done = all_done && row.done();
    }
    if (all_done) m.reasons.clear();
    m.lines = lines_;
    return {id, title, "", std::move(m)};
  }

  report::Figure classes(const std::string& id, const std::string& title, Sweep sweep) const {
    report::Figure f = figure(id, title, {"class"}, sweep,
                              [](const RattlePoint& p) { return static_cast<double>(p.kind); });
    auto& m = std::get<report::MapFigure>(f.content);
    m.classes = rattle_class_names();
    m.marks = marks_;
    return f;
  }

  template <class Value>
  report::Figure linear(const std::string& id, const std::string& title, report::Axis z,
                        const Value& value) const {
    report::Figure f = figure(id, title, std::move(z), &RattleRow::up, value);
    std::get<report::MapFigure>(f.content).linear = true;
    return f;
  }

 private:
  const RattleMap& map_;
  std::vector<report::XySeries> lines_;
  std::optional<report::XySeries> marks_;
};

std::vector<report::Figure> map_figures(const RattleMap& map) {
  const MapFigures make(map);
  const Words& of = words(map);
  const std::string contact = fmt::format("Contact of the {}, speed swept ", of.contacts);
  std::vector<report::Figure> figures = {make.classes("classes", contact + "up", &RattleRow::up)};
  figures.front().note = fmt::format(
      "One rectangle per point. The line is where the smallest force of {} over the turn passes 0.",
      of.criterion);
  if (!rigid(map)) {
    figures.push_back(make.classes("classes_down", contact + "down", &RattleRow::down));
    figures.push_back(make.linear("apart", "Share of the time without contact, swept up",
                                  {"share of the time", "%"},
                                  [](const RattlePoint& p) { return 100 * p.apart; }));
    figures.push_back(make.linear("impacts", "Impacts per turn, swept up", {"impacts per turn"},
                                  [](const RattlePoint& p) { return p.impacts; }));
  }
  const std::string largest = fmt::format("Largest {}", of.force);
  figures.push_back(make.figure("over_mean", largest + " over the mean, swept up",
                                {"largest over mean"}, &RattleRow::up,
                                [](const RattlePoint& p) { return p.over_mean(); }));
  figures.push_back(make.figure("largest", largest + ", swept up", {"force", "N"}, &RattleRow::up,
                                [](const RattlePoint& p) { return p.largest; }));
  return figures;
}

}  // namespace

report::Document rattle_document(const RattleMap& map, const report::Lines& program,
                                 const CaseDescription& description) {
  report::Document document =
      case_document(description,
                    map.the_case.name + (by_pistons(map) ? ": where the block rattles"
                                                         : ": where the gear rattles"),
                    program);
  const bool checked = !map.checks.empty();
  document.verdict = {.agrees = checked ? std::optional(map.agrees()) : std::nullopt,
                      .headline = headline(map),
                      .word = checked ? "" : "Map",
                      .answers = answers_of(map)};
  document.meaning = fmt::format(
      "Contact of the {} by the closed form; a class is that of the observed turns, with "
      "the thresholds below. {}",
      words(map).contacts,
      checked ? "Simbody's model, from the same states, verifies the equations of motion."
              : "Nothing was compared: --check-points N recomputes points by Simbody.");
  document.runs = {settings_section(map), classes_section(map), boundary_section(map)};
  if (!rigid(map)) document.runs->push_back(states_section(map));
  if (checked) document.runs->push_back(checks_section(map));
  document.figures = map_figures(map);
  add_warnings(document, map.all_failed());
  return document;
}

std::string rattle_text(const RattleMap& map) {
  std::string text = report::answers_text(map.the_case.name, headline(map), answers_of(map));
  const auto up = counts_of(map, &RattleRow::up), down = counts_of(map, &RattleRow::down);
  text += fmt::format("{:<18} {:>8} {:>8}\n", "class", "up", "down");
  for (std::size_t k = 0; k < up.size(); ++k)
    text += fmt::format("{:<18} {:>8} {:>8}\n", rattle_class_names()[k], up[k], down[k]);
  text += "\n" + agreement_text(boundary_agreement(map)) + "\n";
  for (const RattleCheck& c : map.checks)
    text += fmt::format(
        "Simbody at {:g} bar, {:g} rpm: {}: {}, largest force {:.1e} apart, {:.1e} allowed, {:g} "
        "of {:g} turns compared{}\n",
        map.options.delivery_bar[c.row], map.options.speed_rpm[c.speed],
        c.agrees() ? "agrees" : "differs", against(c.analytic, c.multibody), c.difference,
        c.allowed, turns_of(c.judged), turns_of(c.parts),
        c.chaotic() ? fmt::format(", chaotic; over all {} against {}", to_string(c.analytic_whole),
                                  to_string(c.multibody_whole))
                    : "");
  return text;
}

}  // namespace bentaxis::study
