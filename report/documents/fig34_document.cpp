#include "bentaxis/study/fig34_document.h"

#include <functional>

#include "bentaxis/pump/counted.h"
#include "document_parts.h"

namespace bentaxis::study {
namespace {

using report::Cell;
using Lines = std::vector<std::string>;

// ---- Values of the grid and how often they can be what is printed

struct Parameter {
  std::string name;
  double Fig34Point::*member;
  double factor;  ///< to the unit of the text
  std::string unit;
};
const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> list = {
      {"exponent", &Fig34Point::exponent, 1, ""},
      {"approach at 100 N", &Fig34Point::approach, 1e6, " um"},
      {"backlash", &Fig34Point::backlash, 1e6, " um"},
      {"dissipation", &Fig34Point::dissipation, 1, " s/m"},
      {"block inertia", &Fig34Point::block_inertia, 1e6, " kg mm2"}};
  return list;
}

std::string number_of(const Parameter& of, double value) {
  return fmt::format("{:g}", std::round(1e3 * value * of.factor) / 1e3);
}
std::string value_text(const Parameter& of, double value) {
  return fmt::format("{} {}{}", of.name, number_of(of, value), of.unit);
}

std::vector<double> values_of(const Fig34Study& s, const Parameter& of) {
  std::vector<double> values;
  for (const Fig34Point& point : s.points) add_once(values, point.*of.member);
  return values;
}

struct Count {
  int all = 0, inside = 0, reverses = 0, both = 0, failed = 0, unsettled = 0;
};

Count count(const Fig34Study& s, const std::function<bool(const Fig34Point&)>& wanted) {
  Count c;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    if (!wanted(s.points[i])) continue;
    const Fig34Curve& curve = s.curves[i];
    ++c.all;
    c.failed += curve.done() ? 0 : 1;
    c.unsettled += curve.done() && !curve.repeats() ? 1 : 0;
    c.inside += curve.inside() ? 1 : 0;
    c.reverses += curve.reverses() ? 1 : 0;
    c.both += curve.inside() && curve.reverses() ? 1 : 0;
  }
  return c;
}

Count count(const Fig34Study& s, bool drag) {
  return count(s, [&](const Fig34Point& p) { return p.drag == drag; });
}
Count count(const Fig34Study& s, bool drag, const Parameter& of, double value) {
  return count(s, [&](const Fig34Point& p) { return p.drag == drag && p.*of.member == value; });
}

std::string drag_name(bool drag) { return drag ? "with Cc" : "without Cc"; }

/// Values, and pairs of values, none of whose laws stays inside and reverses; pairs only where
/// neither value is ruled out alone.
Lines ruled_out(const Fig34Study& s, bool drag) {
  Lines lines;
  struct Value {
    const Parameter* of;
    double value;
  };
  const auto has = [](const Fig34Point& point, const Value& v) {
    return point.*v.of->member == v.value;
  };
  std::vector<Value> left;
  for (const Parameter& of : parameters())
    for (const double value : values_of(s, of)) {
      const Count c = count(s, drag, of, value);
      if (c.both == 0)
        lines.push_back(fmt::format(
            "{}: of {} {} the printed axes, {} the sign in every pitch", value_text(of, value),
            counted(c.all, "law"), counted(c.all - c.inside, "leaves", "leave"),
            counted(c.all - c.reverses, "does not change", "do not change")));
      else
        left.push_back({&of, value});
    }
  for (std::size_t i = 0; i < left.size(); ++i)
    for (std::size_t j = i + 1; j < left.size(); ++j) {
      if (left[i].of == left[j].of) continue;
      const Count c = count(s, [&](const Fig34Point& p) {
        return p.drag == drag && has(p, left[i]) && has(p, left[j]);
      });
      if (c.all > 0 && c.both == 0)
        lines.push_back(fmt::format(
            "{} together with {}: of {} {} the printed axes, {} the sign in every pitch",
            value_text(*left[i].of, left[i].value), value_text(*left[j].of, left[j].value),
            counted(c.all, "law"), counted(c.all - c.inside, "leaves", "leave"),
            counted(c.all - c.reverses, "does not change", "do not change")));
    }
  return lines;
}

std::string range_text(const Fig34Curve& curve) {
  return fmt::format("{:.1f} to {:.1f} N", curve.least, curve.greatest);
}

bool has_drag(const Fig34Study& s) { return s.the_case.pump.friction.block_viscous > 0; }

// Without the drag on the block, and with it where there is any.
std::vector<bool> drags_of(const Fig34Study& s) {
  return has_drag(s) ? std::vector{false, true} : std::vector{false};
}

// The motion of the laws with or without drag.
std::vector<const Fig34Curve*> curves_of(const Fig34Study& s, bool drag) {
  std::vector<const Fig34Curve*> curves;
  for (std::size_t i = 0; i < s.points.size(); ++i)
    if (s.points[i].drag == drag) curves.push_back(&s.curves[i]);
  return curves;
}

// Of every parameter those that some law has which does both: "exponent 1, 1.5; backlash 10 um".
std::string possible_values(const Fig34Study& s, bool drag) {
  return joined(parameters(), "; ", [&](const Parameter& of) {
    Lines values;
    for (const double value : values_of(s, of))
      if (count(s, drag, of, value).both > 0) values.push_back(number_of(of, value));
    return of.name + " " + joined(values) + of.unit;
  });
}

Lines about(const Fig34Study& s, bool drag) {
  const Count c = count(s, drag);
  const std::vector<const Fig34Curve*> curves = curves_of(s, drag);
  const double pitch = 360.0 / s.the_case.pump.geometry.pistons;
  Lines lines = {fmt::format(
      "Of {} contact laws {} stay within {:g} N, {} change the sign in every {:g} deg, {} do both.",
      c.all, c.inside, kFig34Axes, c.reverses, pitch, c.both)};
  const auto rigid = drag ? s.rigid_with_drag.sign_changes : s.rigid.sign_changes;
  const std::size_t as_rigid = report::count_of(curves, [&](const Fig34Curve* curve) {
    return curve->done() && curve->sign_changes == rigid;
  });
  lines.push_back(rigid == 0 ? fmt::format("{} never change sign, as rigid teeth.", as_rigid)
                             : fmt::format("{} change it as often as rigid teeth, {:g} times a "
                                           "turn.",
                                           as_rigid, rigid));
  if (c.failed > 0) lines.push_back(fmt::format("{} could not be simulated.", c.failed));
  if (c.unsettled > 0) {
    double spread = 0;
    for (const Fig34Curve* curve : curves) spread = std::max(spread, curve->largest_over.spread());
    lines.push_back(fmt::format(
        "The motion of {} does not repeat: {} largest force differs between {} of "
        "{} by up to {:.0f} %. Longer runs can exceed the forces stated for them.",
        counted(c.unsettled, "law"), word_for(c.unsettled, "its", "their"),
        counted(s.options.windows, "window"), counted(s.options.turns, "turn"), 100 * spread));
  }
  if (!s.applies()) return lines;  // nothing printed to hold them to
  if (c.both == 0) {
    lines.emplace_back("So none of them can be the printed curve.");
    return lines;
  }
  double least_apart = 1, most_apart = 0, least = HUGE_VAL, greatest = 0;
  for (const Fig34Curve* curve : curves) {
    if (!curve->inside() || !curve->reverses()) continue;
    least_apart = std::min(least_apart, curve->apart_over.minimum);
    most_apart = std::max(most_apart, curve->apart_over.maximum);
    least = std::min(least, curve->largest_over.minimum);
    greatest = std::max(greatest, curve->largest_over.maximum);
  }
  lines.push_back(
      fmt::format("Those that do both reach {:.0f} to {:.0f} N and are without contact "
                  "{:.0f} to {:.0f} % of the time.",
                  least, greatest, 100 * least_apart, 100 * most_apart));
  const Lines out = ruled_out(s, drag);
  lines.push_back(out.empty() ? "No value and no pair of values of the grid is ruled out."
                              : "What none of them has:");
  for (const std::string& line : out) lines.push_back("- " + line);
  lines.push_back("What some of them have: " + possible_values(s, drag) + ".");
  return lines;
}

// Where the figure is not of this case.
std::string does_not_apply(const Fig34Study& s) {
  return "Fig. 34 does not apply to this case: it is printed for the paper's pump at 275 bar and "
         "1500 rpm (" +
         s.mismatch + ").";
}

std::string headline(const Fig34Study& s) {
  const Count c = count(s, false);
  if (!s.applies()) return does_not_apply(s);
  std::string text = fmt::format(
      "Without Cc {} of {} contact laws stay inside the printed axes and reverse as printed{}",
      c.both, c.all, c.both > 1 ? ": the figure does not show which" : "");
  if (has_drag(s)) {
    const Count d = count(s, true);
    text += fmt::format("; with Cc {} of {}", d.both, d.all);
  }
  return text +
         fmt::format(". {} of {} hold.",
                     report::count_of(s.expectations, [](const auto& e) { return e.holds(); }),
                     counted(s.expectations.size(), "expectation"));
}

// What the printed figure says of the teeth, without and with the drag on the block.
Lines answers_of(const Fig34Study& s) {
  Lines answers;
  if (!s.applies())
    return {
        fmt::format("Without Cc {} of {} contact laws stay within {:g} N and change the sign of "
                    "the tooth force in every pitch; none is compared with the figure.",
                    count(s, false).both, count(s, false).all, kFig34Axes)};
  for (const bool drag : drags_of(s)) {
    const std::string name = drag_name(drag);
    const Lines out = ruled_out(s, drag);
    answers.push_back(report::sentence(
        count(s, drag).both == 0 ? name + ": no contact law of the grid can be what is printed"
        : out.empty()            ? name + ": the figure rules out no value of the contact law"
                                 : name + ": the figure rules out " + joined(out, "; ")));
  }
  for (const Fig34Expectation& e : s.expectations)
    if (!e.holds())
      answers.push_back(fmt::format("Not as expected: {} ({:.4g} to {:.4g} {} expected).", e.what,
                                    e.low, e.high, e.unit));
  return answers;
}

report::Summary summary_of(const Fig34Study& s) {
  report::Summary summary{
      fmt::format("The tooth force along x2 of compliant flanks at the case's pressure and {:g} "
                  "rpm, {} of {} each after {} discarded. A law stays "
                  "inside and reverses only where it does so in every window. Nothing is fitted: "
                  "the paper prints axes and a periodic change of sign, but no contact parameter.",
                  s.the_case.operation.speed_rpm, counted(s.options.windows, "window"),
                  counted(s.options.turns, "turn"),
                  counted(s.options.turns_left_out, "turn that is", "turns that are")),
      {}};
  Lines rigid = {
      fmt::format("Without Cc {}, {:.1f} N at 0 deg and {:.1f} N at 38 deg; {:g} changes "
                  "of sign per turn.",
                  range_text(s.rigid), s.rigid_at_0, s.rigid_at_38, s.rigid.sign_changes)};
  if (has_drag(s))
    rigid.push_back(fmt::format("With Cc {}, {:g} changes of sign per turn.",
                                range_text(s.rigid_with_drag), s.rigid_with_drag.sign_changes));
  rigid.push_back(
      fmt::format("Nothing reverses where the drag on the block exceeds {:.2f} Nm; Cc "
                  "makes {:.2f} Nm.",
                  s.reversing_torque,
                  s.the_case.pump.friction.block_viscous *
                      std::abs(s.the_case.operation.speed_rpm) * kRadPerSecondPerRpm));
  summary.groups.push_back({"Rigid teeth", rigid});
  summary.groups.push_back({"Compliant teeth without Cc", about(s, false)});
  if (has_drag(s)) summary.groups.push_back({"Compliant teeth with Cc", about(s, true)});
  return summary;
}

// ---- Tables

/// To two significant digits where the motion does not repeat: more would be those of the windows
/// that happen to be looked at.
double stated(double value, const Fig34Expectation::Found& f) {
  if (f.spread <= kFig34Repeats || value == 0 || !std::isfinite(value)) return value;
  const double step = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
  return std::round(value / step) * step;
}

report::Section expectations_section(const Fig34Study& s) {
  report::NewSection section(
      "Expectations",
      "Expectations written down before the study, from first tries with another program and "
      "from the printed torques. The damping of the first tries is not known: each is shown "
      "for several values and counts as confirmed if it is inside for any of them. Found over "
      "block inertias of 1000, 1500 and 2000 kg mm2 and over consecutive windows of the same "
      "motion. Where these windows differ by more than 1 %, the motion does not repeat and the "
      "range has two significant digits.");
  section.columns("what", "unit", "expected from", "to", "c, s/m", "found from", "to",
                  "differs between windows, %", "verdict");
  for (const Fig34Expectation& e : s.expectations)
    for (const auto& f : e.found) {
      const auto of_several = [&](double value) {
        return e.found.size() > 1 ? value : not_computed();
      };
      section.row(e.what, e.unit, e.low, e.high, of_several(f.dissipation), stated(f.least, f),
                  stated(f.greatest, f), of_several(std::round(1000 * f.spread) / 10),
                  e.inside(f) ? "inside" : "outside");
    }
  return section;
}

report::Section counts_section(const Fig34Study& s) {
  report::NewSection section(
      "By value",
      "How many of the contact laws with a value stay inside the printed axes, change the sign "
      "in every pitch, and do both.");
  section.columns("Cc", "value", "laws", "inside the axes", "reverse in every pitch", "both");
  for (const bool drag : drags_of(s))
    for (const Parameter& of : parameters())
      for (const double value : values_of(s, of)) {
        const Count c = count(s, drag, of, value);
        section.row(drag_name(drag), value_text(of, value), c.all, c.inside, c.reverses, c.both);
      }
  return section;
}

std::vector<report::Record> records(const Fig34Study& s) {
  std::vector<report::Record> rows;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const Fig34Point& p = s.points[i];
    const Fig34Curve& c = s.curves[i];
    const auto of = [&](double value) { return c.done() ? Cell(value) : Cell(); };
    rows.push_back({{"drag", p.drag},
                    {"exponent", p.exponent},
                    {"approach_at_100N_um", 1e6 * p.approach},
                    {"backlash_um", 1e6 * p.backlash},
                    {"dissipation_s_per_m", p.dissipation},
                    {"block_inertia_kg_mm2", 1e6 * p.block_inertia},
                    {"least_Rcs_x2_N", of(c.least)},
                    {"greatest_Rcs_x2_N", of(c.greatest)},
                    {"share_without_contact", of(c.apart)},
                    {"sign_changes_per_turn", of(c.sign_changes)},
                    {"share_of_pitches_with_both_signs", of(c.both_signs)},
                    {"inside_axes", c.inside()},
                    {"reverses", c.reverses()},
                    {"largest_Rcs_x2_N_least_window", of(c.largest_over.minimum)},
                    {"largest_Rcs_x2_N_greatest_window", of(c.largest_over.maximum)},
                    {"share_without_contact_least_window", of(c.apart_over.minimum)},
                    {"share_without_contact_greatest_window", of(c.apart_over.maximum)},
                    {"status", c.done() ? "done" : "failed: " + c.failure}});
  }
  return rows;
}

// ---- Figures

report::Figure curves_figure(const Fig34Study& s) {
  report::XyFigure content{{"shaft angle", "deg"}, {"force along x2", "N"}, {}};
  for (const auto& [name, curve] : s.pictured)
    if (!curve.force.empty()) content.series.push_back({name, curve.theta_deg, curve.force});
  for (const double end : {-kFig34Axes, kFig34Axes})
    content.series.push_back(
        {fmt::format("printed axes end at {:g} N", end), {0, 360}, {end, end}});
  return {"fig34", "Tooth force along x2", "Fig. 34", std::move(content),
          "Block inertia 1500 kg mm2."};
}

report::Figure scatter_figure(const Fig34Study& s) {
  report::ScatterFigure content{{"time without contact", "%"}, {"largest force", "N", true}, {}};
  const auto approaches = values_of(s, parameters()[1]);
  double most_apart = 0;
  for (const Fig34Curve& c : s.curves) most_apart = std::max(most_apart, 100 * c.apart);
  content.series.push_back({fmt::format("printed axes end at {:g} N", kFig34Axes),
                            std::nullopt,
                            true,
                            true,
                            {{0, kFig34Axes, ""}, {most_apart, kFig34Axes, ""}}});
  for (const bool drag : drags_of(s))
    for (std::size_t a = 0; a < approaches.size(); ++a) {
      report::ScatterSeries series;
      series.name = fmt::format("{:.3g} um at 100 N, {}", 1e6 * approaches[a], drag_name(drag));
      series.style = static_cast<int>(a + (drag ? approaches.size() : 0));
      for (std::size_t i = 0; i < s.points.size(); ++i) {
        const Fig34Point& p = s.points[i];
        const Fig34Curve& c = s.curves[i];
        if (p.drag != drag || p.approach != approaches[a] || !c.done()) continue;
        series.points.push_back(
            {100 * c.apart, c.largest(),
             fmt::format("e {:g}, j {:g} um, c {:g} s/m, {:g} kg mm2, {}", p.exponent,
                         1e6 * p.backlash, p.dissipation, 1e6 * p.block_inertia,
                         c.reverses() ? "reverses" : "does not reverse in every pitch")});
      }
      content.series.push_back(std::move(series));
    }
  return {"fig34_laws", "Every contact law: largest force over loss of contact", "",
          std::move(content)};
}

}  // namespace

report::Document fig34_document(const Fig34Study& s, const report::Lines& program,
                                const CaseDescription& description) {
  report::Document document =
      case_document(description, "What Fig. 34 can mean: " + s.the_case.name, program);
  document.verdict = {.agrees = std::nullopt,
                      .headline = headline(s),
                      .word = !s.applies()      ? "Not applicable"
                              : s.as_expected() ? "As expected"
                                                : "Not all as expected",
                      .answers = answers_of(s)};
  document.summary = summary_of(s);
  document.runs = {counts_section(s)};
  if (s.applies()) document.runs->insert(document.runs->begin(), expectations_section(s));
  document.records = records(s);
  document.figures = {curves_figure(s), scatter_figure(s)};
  return document;
}

std::string fig34_csv(const Fig34Study& s) {
  CsvRows csv(
      "drag,exponent,approach_at_100N_um,backlash_um,dissipation_s_per_m,block_inertia_kg_mm2,"
      "least_Rcs_x2_N,greatest_Rcs_x2_N,share_without_contact,sign_changes_per_turn,"
      "share_of_pitches_with_both_signs,inside_axes,reverses,failure,"
      "largest_Rcs_x2_N_least_window,largest_Rcs_x2_N_greatest_window,"
      "share_without_contact_least_window,share_without_contact_greatest_window");
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const Fig34Point& p = s.points[i];
    const Fig34Curve& c = s.curves[i];
    const auto if_done = [&](report::Values values) {
      return c.done() ? std::move(values) : report::Values(values.size(), not_computed());
    };
    csv.row(p.drag ? 1 : 0, p.exponent, 1e6 * p.approach, 1e6 * p.backlash, p.dissipation,
            1e6 * p.block_inertia,
            if_done({c.least, c.greatest, c.apart, c.sign_changes, c.both_signs,
                     c.inside() ? 1.0 : 0.0, c.reverses() ? 1.0 : 0.0}),
            c.failure,
            if_done({c.largest_over.minimum, c.largest_over.maximum, c.apart_over.minimum,
                     c.apart_over.maximum}));
  }
  return std::move(csv).text();
}

std::string fig34_curves_csv(const Fig34Study& s) {
  CsvRows csv("curve,theta_deg,Rcs_x2_N");
  for (const auto& [name, curve] : s.pictured)
    for (std::size_t i = 0; i < curve.force.size(); ++i)
      csv.row(Quoted{name}, curve.theta_deg[i], curve.force[i]);
  return std::move(csv).text();
}

std::string fig34_text(const Fig34Study& s) {
  std::string text = report::answers_text(s.the_case.name, headline(s), answers_of(s)) +
                     report::summary_text(summary_of(s));
  if (!s.applies()) return text;
  text +=
      fmt::format("\n{:<68} {:>18}  {:>7} {:>18}\n", "expectation", "window", "c, s/m", "found");
  for (const Fig34Expectation& e : s.expectations)
    for (const auto& f : e.found)
      text += fmt::format(
          "{:<68} {:>8.4g}..{:>8.4g}  {:>7} {:>8.4g}..{:>8.4g} {:<2} {}\n", e.what, e.low, e.high,
          e.found.size() > 1 ? fmt::format("{:g}", f.dissipation) : "", stated(f.least, f),
          stated(f.greatest, f), e.unit, e.inside(f) ? "inside" : "OUTSIDE");
  return text;
}

}  // namespace bentaxis::study
