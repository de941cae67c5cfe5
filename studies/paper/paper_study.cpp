#include "bentaxis/study/paper_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/column_values.h"
#include "bentaxis/study/fig34.h"
#include "bentaxis/study/inertia.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/published_section.h"

namespace bentaxis::study {
namespace {

std::vector<double> values_of(const ResultTable& table, const std::string& name) {
  return column_of(table, table.find(name));
}

Model the_other(Model model) {
  return model == Model::analytic ? Model::multibody : Model::analytic;
}

// A condition of the paper: the case that gives it, a turn of it by either model, and the paper's
// changes of it, each run once.
class AtCondition {
 public:
  AtCondition(const PaperFigures& list, const PaperFigures::CaseOfCondition& of,
              const std::filesystem::path& cases, const PartProgress& progress_of)
      : list_(list), as_read_(read_case(cases / of.file)) {
    if (of.inertia_alone_at_rpm) {
      as_read_ = without_loads(at_speed(as_read_, *of.inertia_alone_at_rpm));
      as_read_.analytic.piston_friction = as_read_.multibody.piston_friction = false;
    }
    ready_ = prepare(as_read_, progress_of);
    for (const Model model : kModels) {
      const Assumptions& assumptions = ready_.assumptions(model);
      const compare::Facts facts = facts_of(ready_.the_case, assumptions);
      std::string mismatch = list.numbers.mismatch(facts);
      for (const auto& condition : list.numbers.conditions)
        if (condition.name == of.condition && mismatch.empty())
          mismatch = condition.mismatch(facts);
      if (!mismatch.empty())
        throw InputError(as_read_.file.string() + ": does not meet the condition \"" +
                         of.condition + "\" of " + list.file.string() + ": " + mismatch);
      RunOptions options;
      options.model = model;
      Side& side = sides_[static_cast<std::size_t>(model)];
      side.table = study::run(ready_, options, progress_of).table;
      side.input = {&ready_.the_case, assumptions, &side.table};
      side.runs = std::make_unique<VariantRuns>(model, side.input, progress_of);
    }
  }
  // Runs refer to what lies here.
  AtCondition(const AtCondition&) = delete;
  AtCondition& operator=(const AtCondition&) = delete;

  const Case& as_read() const { return as_read_; }
  const Case& the_case() const { return ready_.the_case; }

  compare::PublishedRun run(Model model, const std::string& variant) {
    return (*sides_[static_cast<std::size_t>(model)].runs)(list_.numbers.variant(variant));
  }

  /// A column of the model's turn, else of the hydraulic one's. @throws InputError
  std::vector<double> column(const compare::PublishedRun& run, const std::string& name) const {
    if (run.table->find(name) < run.table->columns()) return values_of(*run.table, name);
    if (ready_.hydraulics) {
      const ResultTable& oil = ready_.hydraulics->table;
      if (oil.find(name) < oil.columns() && oil.rows() == run.table->rows())
        return values_of(oil, name);
    }
    throw InputError(list_.file.string() + ": no channel \"" + name + "\" in " +
                     as_read_.file.string());
  }

 private:
  struct Side {
    ResultTable table;
    PublishedInput input{};
    std::unique_ptr<VariantRuns> runs;
  };
  const PaperFigures& list_;
  Case as_read_;
  PreparedCase ready_;
  Side sides_[2];
};

double fact_of(const compare::PublishedRun& run, const std::string& name,
               const PaperFigures& list) {
  const auto it = run.facts.find(name);
  if (it == run.facts.end())
    throw InputError(list.file.string() + ": \"" + name + "\" is no fact of a case");
  return it->second;
}

// Largest difference of two curves, held to the largest magnitude of the first.
compare::Difference curves_apart(const std::vector<double>& values,
                                 const std::vector<double>& from) {
  double peak = 0;
  for (const double value : values) peak = std::max(peak, std::abs(value));
  compare::Difference apart;
  for (std::size_t i = 0; i < values.size(); ++i)
    apart.keep_larger(
        compare::difference(values[i], i < from.size() ? from[i] : not_computed(), peak));
  return apart;
}

class PaperRun {
 public:
  PaperRun(PaperStudy& study, const std::filesystem::path& cases, const PartProgress& progress_of)
      : s_(study), progress_of_(progress_of) {
    for (const auto& of : s_.list.cases) {
      conditions_.emplace(of.condition,
                          std::make_unique<AtCondition>(s_.list, of, cases, progress_of));
      s_.cases.push_back(at(of.condition).the_case());
    }
  }

  void draw(const PaperFigure& figure) {
    switch (figure.kind) {
      case PaperKind::curves:
        for (const PaperPanel& panel : figure.panels)
          add_panel(figure, panel, [&](const PaperCurve& curve) { return turns(panel, curve); });
        break;
      case PaperKind::operating_points: {
        const TorqueCurve torque = torque_curve(at(figure.condition).as_read(), figure.delivery_bar,
                                                progress_of_("torque over pressure"));
        if (!torque.failed.empty())
          throw ComputationError(torque.failed[0].point + ": " + torque.failed[0].reason);
        for (const PaperPanel& panel : figure.panels)
          add_panel(figure, panel, [&](const PaperCurve& curve) {
            const bool analytic = curve.model == Model::analytic;
            const auto& own = analytic ? torque.analytic : torque.multibody;
            return DrawnCurve{
                curve.label,  torque.bar,
                own,          true,
                curve.dashed, curves_apart(own, analytic ? torque.multibody : torque.analytic)};
          });
        break;
      }
      case PaperKind::block_from_the_front:
      case PaperKind::piston_in_two_planes:
        s_.turns.push_back({figure, pump(figure), *turn(figure).table});
        break;
      case PaperKind::force_triangle:
        s_.turns.push_back({figure, pump(figure), massless(figure)});
        break;
    }
  }

  /// Printed numbers of the figures of the list, by its conditions.
  void judge_numbers() {
    for (const auto& of : s_.list.cases) {
      const auto section = compare::judge_published(
          s_.list.numbers, {to_string(Model::analytic), to_string(Model::multibody)},
          [&](const std::string& model, const compare::PublishedVariant& variant) {
            return at(of.condition)
                .run(model == to_string(Model::analytic) ? Model::analytic : Model::multibody,
                     variant.name);
          },
          "inertia");
      for (const compare::PublishedRow& row : section.rows) {
        if (row.number.condition != of.condition || row.number.measure == compare::Measure::range ||
            row.verdict == compare::PublishedVerdict::not_comparable)
          continue;
        const std::string figures = figures_in(row.number.where);
        if (!figures.empty()) s_.numbers.push_back({figures, row});
      }
    }
  }

 private:
  AtCondition& at(const std::string& condition) { return *conditions_.at(condition); }

  compare::PublishedRun turn(const PaperFigure& figure) {
    return at(figure.condition).run(Model::analytic, figure.variant);
  }
  const PumpParameters& pump(const PaperFigure& figure) {
    return at(figure.condition).the_case().pump;
  }

  // The pistons without inertia and friction, and so without weight: what is left are three forces.
  ResultTable massless(const PaperFigure& figure) {
    Case the_case = at(figure.condition).the_case();
    the_case.pump.piston.mass = 0;
    PressureTrace pressure(the_case.pressure);
    const PreparedCase ready{std::move(the_case), {}, std::move(pressure)};
    RunOptions options;
    options.assumptions = ready.the_case.analytic;
    options.assumptions->piston_friction = false;
    return study::run(ready, options, progress_of_).table;
  }

  std::vector<double> values(const PaperCurve& curve, Model model) {
    AtCondition& condition = at(curve.condition);
    const compare::PublishedRun run = condition.run(model, curve.variant);
    double factor = curve.factor;
    if (!curve.times.empty()) factor *= fact_of(run, curve.times, s_.list);
    if (!curve.over.empty()) factor /= fact_of(run, curve.over, s_.list);
    std::vector<double> values;
    for (const std::string& channel : curve.channels) {
      const std::vector<double> part = condition.column(run, channel);
      values.resize(part.size());
      for (std::size_t i = 0; i < part.size(); ++i)
        values[i] = curve.channels.size() == 1 ? part[i] : std::hypot(values[i], part[i]);
    }
    for (double& value : values) value *= factor;
    return values;
  }

  // A curve over the turns that the panel shows, up to where the last one ends.
  DrawnCurve turns(const PaperPanel& panel, const PaperCurve& curve) {
    DrawnCurve drawn;
    drawn.label = curve.label;
    drawn.judged = !curve.leaves;
    drawn.dashed = curve.dashed;
    std::vector<double> theta, one;
    if (curve.compliant_teeth) {
      Fig34Point law = adams_by_default();
      law.drag = curve.variant.empty();
      Fig34Options options;
      options.windows = 1;  // one turn is drawn
      const Fig34Curve force =
          fig34_curve(at(curve.condition).as_read(), law, options, progress_of_);
      if (!force.done()) throw ComputationError("compliant teeth: " + force.failure);
      // Its samples are at the ends of intervals.
      theta = force.theta_deg;
      one = force.force;
      theta.insert(theta.begin(), theta.back() - 360);
      one.insert(one.begin(), one.back());
      theta.pop_back();
      one.pop_back();
    } else {
      theta = at(curve.condition).run(curve.model, curve.variant).table->theta_deg;
      one = values(curve, curve.model);
      drawn.other_model = curves_apart(one, values(curve, the_other(curve.model)));
    }
    for (int i = 0; i < panel.turns; ++i) {
      for (const double angle : theta) drawn.x.push_back(angle + 360 * i);
      drawn.y.insert(drawn.y.end(), one.begin(), one.end());
    }
    drawn.x.push_back(360.0 * panel.turns);
    drawn.y.push_back(one.front());
    return drawn;
  }

  template <class CurveOf>
  void add_panel(const PaperFigure& figure, const PaperPanel& panel, const CurveOf& curve_of) {
    DrawnPanel drawn;
    drawn.figure = figure;
    drawn.panel = panel;
    drawn.least.y = HUGE_VAL;
    drawn.greatest.y = -HUGE_VAL;
    for (const PaperCurve& curve : panel.curves) {
      drawn.curves.push_back(curve_of(curve));
      const DrawnCurve& c = drawn.curves.back();
      if (!c.judged) continue;
      for (std::size_t i = 0; i < c.y.size(); ++i) {
        if (!is_computed(c.y[i]))
          throw ComputationError(figure.name(panel) + ", " + c.label + ": not computed");
        if (c.y[i] < drawn.least.y) drawn.least = {c.label, c.x[i], c.y[i]};
        if (c.y[i] > drawn.greatest.y) drawn.greatest = {c.label, c.x[i], c.y[i]};
      }
    }
    s_.panels.push_back(std::move(drawn));
  }

  // Those figures of the list that a place in the paper names: "Fig. 14, 27".
  std::string figures_in(const std::string& where) const {
    std::string found;
    std::size_t from = where.find("Fig. ");
    if (from == std::string::npos) return found;
    for (from += 5; from < where.size() && std::isdigit(static_cast<unsigned char>(where[from]));) {
      std::size_t used = 0;
      const int number = std::stoi(where.substr(from), &used);
      if (std::any_of(s_.list.figures.begin(), s_.list.figures.end(),
                      [&](const PaperFigure& figure) { return figure.number == number; }))
        found += (found.empty() ? "" : ", ") + std::to_string(number);
      from += used;
      if (where.compare(from, 2, ", ") == 0) from += 2;
    }
    return found;
  }

  PaperStudy& s_;
  const PartProgress& progress_of_;
  std::map<std::string, std::unique_ptr<AtCondition>> conditions_;
};

}  // namespace

double DrawnPanel::below() const {
  return known() ? std::max(0.0, panel.y.range->first - least.y) : 0;
}
double DrawnPanel::above() const {
  return known() ? std::max(0.0, greatest.y - panel.y.range->second) : 0;
}

PaperStudy run_paper_study(const PaperFigures& list, const std::filesystem::path& cases,
                           const PartProgress& progress_of) {
  PaperStudy result;
  result.list = list;
  PaperRun study(result, cases, progress_of);
  for (const PaperFigure& figure : result.list.figures) study.draw(figure);
  study.judge_numbers();
  return result;
}

}  // namespace bentaxis::study
