// The paper's figures as a report, as CSV and as text.
#include "bentaxis/study/paper_figures.h"
#include "document_parts.h"
#include "paper_drawings.h"

namespace bentaxis::study {
namespace {

using report::Cell;

// Adds a part that a text does not have yet.
void add_part(std::string& text, const std::string& part, const char* separator = "; ") {
  if (text.find(part) == std::string::npos) text += (text.empty() ? "" : separator) + part;
}

std::string range_text(const DrawnPanel& p) {
  return fmt::format("{:.5g} to {:.5g}{}", p.least.y, p.greatest.y, unit_after(p.panel.y.unit));
}

// By how much the curves leave the axis, where; "" where they do not.
std::string leaving(const DrawnPanel& p) {
  if (!p.known()) return {};
  std::vector<std::string> texts;
  const double span = p.panel.y.range->second - p.panel.y.range->first;
  const auto add = [&](double by, const DrawnPanel::End& end, const char* where) {
    if (by == 0) return;
    texts.push_back(fmt::format("{} {} the axis by {:.3g}{}, {:.2g} % of its length, at {:.4g}{}",
                                end.curve, where, by, unit_after(p.panel.y.unit), 100 * by / span,
                                end.x, unit_after(p.panel.x.unit)));
  };
  add(p.below(), p.least, "is below");
  add(p.above(), p.greatest, "is above");
  return joined(texts, "; ");
}

std::string verdict(const DrawnPanel& p) {
  return !p.known() ? "axis unknown" : p.inside() ? "inside" : "outside";
}

// Condition of each curve of a panel, once.
std::string conditions_of(const PaperFigures& list, const DrawnPanel& p) {
  std::string text;
  for (const PaperCurve& curve : p.panel.curves)
    for (const auto& condition : list.numbers.conditions)
      if (condition.name == curve.condition) add_part(text, condition.text);
  for (const PaperCurve& curve : p.panel.curves)
    add_part(text, list.numbers.variant(curve.variant).text);
  return text;
}

std::string names_of_conditions(const DrawnPanel& p) {
  std::string text;
  for (const PaperCurve& curve : p.panel.curves) add_part(text, curve.condition);
  return text;
}

std::string cases_of(const PaperFigures& list, const DrawnPanel& p) {
  std::string text;
  for (const PaperCurve& curve : p.panel.curves)
    add_part(text, list.case_of(curve.condition).file, ", ");
  return text;
}

compare::Difference other_model(const DrawnPanel& p) {
  compare::Difference worst;
  for (const DrawnCurve& curve : p.curves) worst.keep_larger(curve.other_model);
  return worst;
}

std::string headline(const PaperStudy& s) {
  const std::size_t known =
      report::count_of(s.panels, [](const DrawnPanel& p) { return p.known(); });
  const std::size_t inside =
      report::count_of(s.panels, [](const DrawnPanel& p) { return p.inside(); });
  std::vector<std::string> outside;
  compare::Difference worst;
  for (const DrawnPanel& p : s.panels) {
    if (p.known() && !p.inside()) outside.push_back(p.figure.name(p.panel));
    worst.keep_larger(other_model(p));
  }
  return fmt::format(
      "{} of {} panels with a known axis contain our curves{}; {} axes are unknown; "
      "drawings have none. At the same assumptions the models differ by up to {} of peak.",
      inside, known, outside.empty() ? "" : " (outside: " + joined(outside, "; ") + ")",
      s.panels.size() - known, worst.share_text());
}

// Each curve that leaves its axis, and where the numbers printed with them stand.
std::vector<std::string> answers_of(const PaperStudy& s) {
  std::vector<std::string> answers;
  for (const DrawnPanel& p : s.panels)
    if (p.known() && !p.inside())
      answers.push_back(p.figure.name(p.panel) + " does not contain our curves: " + leaving(p) +
                        (p.panel.outside.empty() ? "" : ": " + p.panel.outside) + ".");
  compare::PublishedSummary numbers;
  for (const PaperNumber& number : s.numbers) numbers.count(number.row);
  answers.push_back(
      "Numbers printed with these figures (compare counts all those of one case, axes of "
      "figures among them): " +
      numbers.text("at their conditions"));
  return answers;
}

// ---- Tables

report::Section figures_section(const PaperStudy& s) {
  report::NewSection section(
      "The figures",
      "The curves are not available: an axis is a window for the curve; a curve inside it need not "
      "be the printed one. Most axes of reactions at rated pressure were used to infer the "
      "geometry of this pump, which is not published: being inside them is no evidence "
      "(docs/limits.md).");
  section.columns("figure", "shows", "condition", "printed axis", "ours", "verdict",
                  "other model, of peak", "remarks");
  for (const PaperFigure& figure : s.list.figures) {
    for (const DrawnPanel& p : s.panels) {
      if (p.figure.id() != figure.id()) continue;
      std::string remarks = leaving(p);
      if (!remarks.empty() && !p.panel.outside.empty()) remarks += ": " + p.panel.outside;
      if (!p.panel.y.why.empty()) remarks += (remarks.empty() ? "" : "; ") + p.panel.y.why;
      const compare::Difference differs = other_model(p);
      section.row(figure.name(p.panel), figure.shows, names_of_conditions(p),
                  p.panel.y.short_text(), range_text(p), verdict(p),
                  differs.known() ? differs.share() : not_computed(), remarks);
    }
    for (const PaperTurn& turn : s.turns)
      if (turn.figure.id() == figure.id())
        section.row(figure.name(), figure.shows, figure.condition, "none: a drawing", Cell(),
                    "drawn", Cell(), figure.note);
  }
  for (const auto& of : s.list.cases)
    section.fact(of.condition, of.inertia_alone_at_rpm ? of.file + ", inertia alone" : of.file);
  for (const auto& [figures, reason] : s.list.left_out)
    section.fact("left out: Fig. " + figures, reason);
  return section;
}

report::Section numbers_section(const PaperStudy& s) {
  report::NewSection section(
      "Numbers printed with them",
      "Numbers that the paper states about these figures, computed from the same cases. Only "
      "predicted rows test the models.");
  section.columns("figure", "quantity", "printed", "condition", "analytic", "multibody", "verdict",
                  "status");
  for (const PaperNumber& number : s.numbers) {
    const compare::PublishedRow& row = number.row;
    const auto value = [&](std::size_t model) {
      return row.values[model] ? Cell(compare::text_of(*row.values[model])) : Cell();
    };
    section.row(number.figures, row.number.quantity, row.printed, row.at, value(0), value(1),
                compare::to_string(row.verdict), row.number.status);
  }
  return section;
}

// ---- Figures

report::Figure figure_of(const PaperStudy& s, const DrawnPanel& p) {
  report::XyFigure content{
      {p.panel.x.quantity, p.panel.x.unit}, {p.panel.y.quantity, p.panel.y.unit}, {}};
  const auto fix = [](report::Axis& axis, const std::optional<std::pair<double, double>>& range) {
    if (!range) return;
    axis.from = range->first;
    axis.to = range->second;
  };
  fix(content.x, p.panel.x.range);
  fix(content.y, p.panel.y.range);
  for (const DrawnCurve& curve : p.curves)
    content.series.push_back({curve.label, curve.x, curve.y, curve.dashed});
  // A curve that leaves the axis stays in sight; where the axis ends is drawn.
  const auto end = [&](double by, double at, std::optional<double>& edge, double to) {
    if (by == 0) return;
    edge = to;
    const double right = p.panel.x.range ? p.panel.x.range->second : 360.0 * p.panel.turns;
    content.series.push_back({fmt::format("printed axis ends at {:g}", at), {0, right}, {at, at}});
  };
  if (p.known()) {
    const double room = 0.03 * (p.panel.y.range->second - p.panel.y.range->first);
    end(p.below(), p.panel.y.range->first, content.y.from, p.least.y - room);
    end(p.above(), p.panel.y.range->second, content.y.to, p.greatest.y + room);
  }
  std::string note =
      fmt::format("{}, by {}. Axis of the values: {}; {} axis: {}.", conditions_of(s.list, p),
                  cases_of(s.list, p), p.panel.y.text(), p.panel.x.quantity, p.panel.x.text());
  if (p.known()) note += p.inside() ? " Our curves are inside." : " Outside: " + leaving(p) + ".";
  if (!p.panel.outside.empty() && p.known() && !p.inside()) note += " " + p.panel.outside + ".";
  if (!p.panel.differs.empty()) note += " numbers.toml: " + p.panel.differs + ".";
  if (!p.figure.note.empty()) note += " " + p.figure.note;
  return {p.figure.id(p.panel), p.figure.name(p.panel) + ": " + p.panel.title, p.figure.name(),
          std::move(content), std::move(note)};
}

}  // namespace

report::Document paper_document(const PaperStudy& s, const report::Lines& program,
                                const CaseDescription& description) {
  report::Document document =
      case_document(description, "The paper's figures: " + s.list.numbers.name, program);
  document.verdict = {.agrees = std::nullopt, .headline = headline(s), .answers = answers_of(s)};
  document.runs = {figures_section(s), numbers_section(s)};
  document.figures.emplace();
  for (const PaperFigure& figure : s.list.figures) {
    for (const DrawnPanel& p : s.panels)
      if (p.figure.id() == figure.id()) document.figures->push_back(figure_of(s, p));
    for (const PaperTurn& turn : s.turns)
      if (turn.figure.id() == figure.id()) append(document.figures, paper_drawings(turn));
  }
  return document;
}

std::string paper_csv(const PaperStudy& s) {
  CsvRows csv("figure,title,axis_from,axis_to,axis_known,least,greatest,unit,verdict");
  for (const DrawnPanel& p : s.panels) {
    const auto [from, to] = p.panel.y.range.value_or(std::pair{not_computed(), not_computed()});
    csv.row(p.figure.id(p.panel), Quoted{p.panel.title}, from, to, Quoted{p.panel.y.text()},
            p.least.y, p.greatest.y, p.panel.y.unit, verdict(p));
  }
  return std::move(csv).text();
}

std::string paper_text(const PaperStudy& s) {
  std::string text = report::answers_text("", headline(s), answers_of(s));
  for (const DrawnPanel& p : s.panels) {
    text += fmt::format("{:<18} {:<13} ours {:<26} axis {}\n", p.figure.name(p.panel), verdict(p),
                        range_text(p), p.panel.y.text());
    if (p.known() && !p.inside()) text += fmt::format("{:<18} {}\n", "", leaving(p));
  }
  for (const PaperTurn& turn : s.turns)
    text += fmt::format("{:<18} {}\n", turn.figure.name(), "drawn");
  return text;
}

}  // namespace bentaxis::study
