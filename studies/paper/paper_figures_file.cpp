// What is known of the paper's figures, read from its file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/study/paper_study.h"

namespace bentaxis::study {
namespace {

const std::vector<std::string> kKinds = {"curves", "operating points", "block from the front",
                                         "force triangle", "piston in two planes"};

PaperAxis read_axis(TableReader in, const std::string& quantity, const std::string& unit) {
  PaperAxis axis;
  axis.quantity = in.text("quantity", quantity);
  axis.unit = in.text("unit", unit);
  axis.labels = in.numbers("labels");
  if (!axis.labels.empty()) {
    const auto& l = axis.labels;
    const double steps = l.size() == 3 ? (l[2] - l[0]) / l[1] : 0;
    if (!(steps >= 1) || std::abs(steps - std::round(steps)) > 1e-9 || !(l[1] > 0))
      in.fail("labels", "must be [first, step, last] with whole steps from first up to last");
    axis.range = {l[0], l[2]};
  }
  axis.why = in.text("why", "");
  if (in.has("axis")) {
    const auto range = in.pair("axis", kAny);
    if (!(range.first < range.second)) in.fail("axis", "must be [from, to] with from < to");
    if (axis.range && (range.first > axis.range->first || range.second < axis.range->second))
      in.fail("axis", "must hold its labels");
    axis.range = range;
    if (axis.why.empty()) in.fail("why", "must say how the axis is known outside its labels");
  }
  if (!axis.range && axis.why.empty()) in.fail("why", "must say why the axis is not known");
  in.finish();
  return axis;
}

template <class Item>
std::string read_name(TableReader& in, const std::string& key, const std::vector<Item>& items,
                      bool needed) {
  std::string name = needed ? in.text(key) : in.text(key, "");
  if (!name.empty() &&
      std::none_of(items.begin(), items.end(), [&](const Item& item) { return item.name == name; }))
    in.fail(key, "is not in the file of printed numbers");
  return name;
}

PaperCurve read_curve(TableReader in, const PaperFigures& list) {
  PaperCurve curve;
  curve.label = in.text("label");
  curve.model =
      in.choice("model", {"analytic", "multibody"}) == 0 ? Model::analytic : Model::multibody;
  curve.condition = read_name(in, "condition", list.numbers.conditions, true);
  curve.variant = read_name(in, "variant", list.numbers.variants, false);
  curve.channels = in.texts("channels");
  if (curve.channels.empty()) in.fail("channels", "at least one column must be named");
  curve.factor = in.number("factor", kAny, 1.0);
  curve.times = in.text("times", "");
  curve.over = in.text("over", "");
  if (in.has("teeth")) {
    in.choice("teeth", {"compliant"});
    curve.compliant_teeth = true;
  }
  curve.leaves = in.flag("leaves", false);
  curve.dashed = in.flag("dashed", false);
  in.finish();
  return curve;
}

PaperPanel read_panel(TableReader in, const PaperFigures& list) {
  PaperPanel panel;
  panel.name = in.text("name", "");
  panel.title = in.text("title");
  panel.turns = in.integer("turns", 1, 10, 1);
  panel.x = read_axis(in.table("x"), "shaft angle", "deg");
  panel.y = read_axis(in.table("y"), "", "");
  panel.outside = in.text("outside", "");
  panel.differs = in.text("differs", "");
  for (TableReader& item : in.tables("curve"))
    panel.curves.push_back(read_curve(std::move(item), list));
  if (panel.curves.empty()) in.fail("curve", "at least one [[figure.panel.curve]] is needed");
  in.finish();
  return panel;
}

PaperFigure read_figure(TableReader in, const PaperFigures& list) {
  PaperFigure figure;
  figure.number = in.integer("number", 1, 99);
  figure.page = in.integer("page", 1, 9999);
  figure.part = in.text("part", "");
  figure.shows = in.text("shows");
  figure.note = in.text("note", "");
  figure.kind = static_cast<PaperKind>(in.choice("kind", kKinds));
  const bool drawing =
      figure.kind != PaperKind::curves && figure.kind != PaperKind::operating_points;
  if (figure.kind == PaperKind::operating_points || drawing) {
    figure.condition = read_name(in, "condition", list.numbers.conditions, true);
    figure.variant = read_name(in, "variant", list.numbers.variants, false);
  }
  if (drawing) {
    figure.angles = in.numbers("angles");
    if (figure.angles.empty()) in.fail("angles", "at least one angle is needed");
    for (const double angle : figure.angles)
      if (!(angle >= 0 && angle < 360)) in.fail("angles", "must lie in [0, 360)");
  }
  if (figure.kind == PaperKind::operating_points) {
    const auto spaced = in.numbers("delivery_bar");
    if (spaced.size() != 3 || !(spaced[0] >= 0 && spaced[1] > 0 && spaced[2] > spaced[0]))
      in.fail("delivery_bar", "must be [first, step, last] with 0 <= first < last and step > 0");
    for (int i = 0; spaced[0] + i * spaced[1] <= spaced[2] * (1 + 1e-12); ++i)
      figure.delivery_bar.push_back(spaced[0] + i * spaced[1]);
  }
  for (TableReader& item : in.tables("panel"))
    figure.panels.push_back(read_panel(std::move(item), list));
  if (figure.panels.empty() != drawing)
    in.fail("panel", drawing ? "a drawing has none" : "at least one [[figure.panel]] is needed");
  in.finish();
  return figure;
}

}  // namespace

std::string PaperAxis::short_text() const {
  if (!range) return "unknown";
  return fmt::format("{:g} to {:g}{}", range->first, range->second, unit_after(unit));
}

std::string PaperAxis::text() const {
  std::string text = short_text();
  if (!range) return text + ": " + why;
  if (why.empty()) return text;
  return labels.empty()
             ? fmt::format("{} ({})", text, why)
             : fmt::format("{} (labels {:g} to {:g}; {})", text, labels[0], labels[2], why);
}

std::string PaperFigure::id(const PaperPanel& panel) const {
  return fmt::format("fig{}{}{}{}", number, part, panel.name.empty() ? "" : "_", panel.name);
}

std::string PaperFigure::name(const PaperPanel& panel) const {
  return fmt::format("Fig. {}{}{}{}", number, part, panel.name.empty() ? "" : ", ", panel.name);
}

const PaperFigures::CaseOfCondition& PaperFigures::case_of(const std::string& condition) const {
  const auto it = std::find_if(cases.begin(), cases.end(), [&](const CaseOfCondition& item) {
    return item.condition == condition;
  });
  if (it == cases.end())
    throw InputError(file.string() + ": no [[case]] gives the condition \"" + condition + "\"");
  return *it;
}

PaperFigures read_paper_figures(const std::filesystem::path& file) {
  const TomlFile toml = TomlFile::read(file, "list of the paper's figures");
  TableReader in = toml.root();
  PaperFigures list;
  list.file = file;
  in.integer("schema", 1, 1);
  list.numbers = compare::read_published(file.parent_path() / in.text("numbers"));
  for (TableReader& item : in.tables("case")) {
    PaperFigures::CaseOfCondition of;
    of.condition = read_name(item, "condition", list.numbers.conditions, true);
    of.file = item.text("file");
    if (item.has("inertia_alone_at_rpm"))
      of.inertia_alone_at_rpm = item.number("inertia_alone_at_rpm", kPositive);
    item.finish();
    list.cases.push_back(std::move(of));
  }
  for (TableReader& item : in.tables("figure")) {
    const int line = item.line();
    list.figures.push_back(read_figure(std::move(item), list));
    const std::string id = list.figures.back().id();
    for (std::size_t i = 0; i + 1 < list.figures.size(); ++i)
      if (list.figures[i].id() == id)
        throw InputError(fmt::format("{}:{}: figure {} is a duplicate", file.string(), line, id));
  }
  if (list.figures.empty()) in.fail("figure", "at least one [[figure]] is needed");
  for (TableReader& item : in.tables("left_out")) {
    list.left_out.emplace_back(item.text("figures"), item.text("reason"));
    item.finish();
  }
  in.finish();
  for (const PaperFigure& figure : list.figures) {
    if (!figure.condition.empty()) list.case_of(figure.condition);
    for (const PaperPanel& panel : figure.panels)
      for (const PaperCurve& curve : panel.curves) list.case_of(curve.condition);
  }
  return list;
}

}  // namespace bentaxis::study
