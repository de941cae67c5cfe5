// Maps, slices, parallel axes and pairs of a sweep.
#include "document_parts.h"
#include "sweep_view.h"

namespace bentaxis::designs {
namespace {

using report::Values;

// What a page can hold and a reader can look through.
constexpr std::size_t kMaxMaps = 12, kMaxSlices = 12, kMaxPairs = 6, kMaxLines = 6;
constexpr std::size_t kMaxDrawnLevels = 60;  // of either axis of a map
constexpr std::size_t kMaxPoints = 300;      // of a figure of designs
constexpr std::size_t kMaxMarked = 60;       // designs of the front drawn among them
constexpr std::size_t kMaxColumns = 10;      // parallel axes

bool is_number(const Variable& variable) { return variable.words().empty(); }

// Numbers below `count`, evenly chosen, with the first, the last and `with`.
std::vector<std::size_t> spread(std::size_t count, std::size_t most, std::size_t with) {
  if (count <= most) return thinned(count, count + 1);
  std::vector<std::size_t> chosen = {with};
  for (std::size_t i = 0; i + 1 < most; ++i) chosen.push_back(i * (count - 1) / (most - 2));
  sort_once(chosen);
  return chosen;
}

// Some five round values in between.
std::vector<double> levels_between(double low, double high, bool log) {
  std::vector<double> levels;
  if (!(high > low)) return levels;
  if (log) {
    for (double power = std::pow(10, std::floor(std::log10(low))); power < high; power *= 10)
      if (power > low) levels.push_back(power);
    return levels;
  }
  const double power = std::pow(10, std::floor(std::log10((high - low) / 5)));
  double step = power;
  for (const double m : {2, 5, 10})
    if ((high - low) / step > 7) step = m * power;
  for (double k = std::floor(low / step) + 1; k * step < high; ++k) levels.push_back(k * step);
  return levels;
}

class Figures {
 public:
  explicit Figures(const SweepView& view) : view_(view) {
    for (std::size_t k = 0; k < view.variables(); ++k)
      if (view.whole_grid() ? view.levels(k).size() > 1 : view.designs() > 1) varied_.push_back(k);
  }

  std::vector<report::Figure> all() {
    if (view_.whole_grid()) {
      maps();
      slices();
    } else {
      clouds();
    }
    pairs();
    parallel();
    return std::move(figures_);
  }

 private:
  void add(const std::string& id, const std::string& title, auto content,
           const std::string& note = "") {
    figures_.push_back({id, title, "", std::move(content), note});
  }

  // What the others are while `shown` vary.
  std::string others_text(const std::vector<std::size_t>& shown) const {
    std::vector<std::string> others;
    for (const std::size_t k : varied_)
      if (!contains(shown, k))
        others.push_back(view_.variable(k).name() + " " +
                         value_text(view_.variable(k), view_.levels(k)[view_.home()[k]]));
    return others.empty() ? "" : "At " + joined(others) + ", nearest to the value of the case. ";
  }

  static std::string limit_text(std::size_t shown, std::size_t all, const char* what) {
    return shown < all ? fmt::format("The first {} of {} {} are drawn. ", shown, all, what) : "";
  }

  void maps() {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t a = 0; a < varied_.size(); ++a)
      for (std::size_t b = a + 1; b < varied_.size(); ++b)
        if (is_number(view_.variable(varied_[a])) && is_number(view_.variable(varied_[b])))
          pairs.emplace_back(varied_[a], varied_[b]);
    std::size_t made = 0;
    const std::size_t wanted = pairs.size() * view_.outputs();
    for (const auto& [a, b] : pairs)
      for (std::size_t k = 0; k < view_.outputs() && made < kMaxMaps; ++k, ++made)
        map(a, b, k, made == 0 ? limit_text(std::min(wanted, kMaxMaps), wanted, "maps") : "");
  }

  void map(std::size_t a, std::size_t b, std::size_t k, std::string note) {
    const auto columns = spread(view_.levels(a).size(), kMaxDrawnLevels, view_.home()[a]);
    const auto rows = spread(view_.levels(b).size(), kMaxDrawnLevels, view_.home()[b]);
    const auto levels = [&](std::size_t variable, const std::vector<std::size_t>& drawn) {
      return report::each_of(drawn, [&](std::size_t i) { return view_.levels(variable)[i]; });
    };
    report::MapFigure m{
        view_.axis(a), view_.axis(b), {}, levels(a, columns), levels(b, rows), {}, {}, {}};
    auto level = view_.home();
    double low = INFINITY, high = -INFINITY;
    bool gaps = false;
    for (const std::size_t i : rows) {
      Values values;
      std::vector<std::string> reasons;
      for (const std::size_t j : columns) {
        level[a] = j;
        level[b] = i;
        const std::size_t design = view_.at(level);
        const double v = view_.result(design, k);
        values.push_back(v);
        reasons.push_back(view_.reason(design));
        gaps = gaps || !reasons.back().empty();
        if (!is_computed(v)) continue;
        low = std::min(low, v);
        high = std::max(high, v);
      }
      m.values.push_back(std::move(values));
      m.reasons.push_back(std::move(reasons));
    }
    if (!gaps) m.reasons.clear();
    m.z = view_.output_axis(k);
    m.linear = !(m.z.log && low > 0);
    m.z.log = false;
    if (m.linear && std::isfinite(low)) m.z.from = low;
    m.contours = levels_between(low, high, !m.linear);
    ascending(m);
    note += others_text({a, b});
    if (columns.size() < view_.levels(a).size() || rows.size() < view_.levels(b).size())
      note += "Only some contour levels are drawn. ";
    if (gaps) note += "Hatched: infeasible, with the reason where pointed at.";
    add(fmt::format("map_{}_{}_{}", a + 1, b + 1, k + 1),
        fmt::format("{} over {} and {}", view_.output(k).name, view_.variable(a).name(),
                    view_.variable(b).name()),
        std::move(m), note);
  }

  // Levels may be given in any order; a map has them rising.
  static void ascending(report::MapFigure& m) {
    const auto order_of = [](const Values& values) {
      return report::by_size(values.size(), [&](std::size_t i) { return -values[i]; });
    };
    const auto arranged = [](const auto& list, const std::vector<std::size_t>& order) {
      auto made = list;
      for (std::size_t i = 0; i < order.size(); ++i) made[i] = list[order[i]];
      return made;
    };
    const auto columns = order_of(m.x_values), rows = order_of(m.y_values);
    m.x_values = arranged(m.x_values, columns);
    m.y_values = arranged(m.y_values, rows);
    m.values = arranged(m.values, rows);
    for (Values& row : m.values) row = arranged(row, columns);
    if (m.reasons.empty()) return;
    m.reasons = arranged(m.reasons, rows);
    for (auto& row : m.reasons) row = arranged(row, columns);
  }

  // An output over one variable: a line for each level of the next one.
  void slices() {
    std::vector<std::pair<std::size_t, std::size_t>> wanted;  // variable, output
    for (const std::size_t v : varied_)
      if (is_number(view_.variable(v)))
        for (std::size_t k = 0; k < view_.outputs(); ++k) wanted.emplace_back(v, k);
    const std::size_t drawn = std::min(wanted.size(), kMaxSlices);
    for (std::size_t i = 0; i < drawn; ++i)
      slice(wanted[i].first, wanted[i].second,
            i == 0 ? limit_text(drawn, wanted.size(), "slices") : "");
  }

  void slice(std::size_t v, std::size_t k, const std::string& note) {
    const auto next = std::ranges::find(varied_, v) + 1;
    const std::size_t family = varied_.size() == 1 ? v : next == varied_.end() ? varied_[0] : *next;
    report::XyFigure xy{view_.axis(v), view_.output_axis(k), {}};
    auto level = view_.home();
    const auto line = [&](const std::string& label) {
      std::vector<std::pair<double, double>> points;
      for (level[v] = 0; level[v] < view_.levels(v).size(); ++level[v])
        points.emplace_back(view_.levels(v)[level[v]], view_.result(view_.at(level), k));
      std::ranges::sort(points, [](const auto& a, const auto& b) { return a.first < b.first; });
      report::XySeries series{label, {}, {}};
      for (const auto& [x, y] : points) series.add(x, y);
      xy.series.push_back(std::move(series));
    };
    if (family == v) {
      line(view_.output(k).name);
    } else {
      const std::size_t count = view_.levels(family).size();
      for (const std::size_t i : spread(count, kMaxLines, view_.home()[family])) {
        level[family] = i;
        const Variable& variable = view_.variable(family);
        line(variable.name() + " " + value_text(variable, view_.levels(family)[i]));
      }
    }
    add(fmt::format("slice_{}_{}", v + 1, k + 1),
        fmt::format("{} over {}", view_.output(k).name, view_.variable(v).name()), std::move(xy),
        note + others_text({v, family}));
  }

  // Designs drawn in figures of many of them, and those of the front among these.
  std::vector<std::size_t> chosen() const { return thinned(view_.designs(), kMaxPoints, marked()); }
  std::vector<std::size_t> marked() const {
    return report::each_of(thinned(view_.front().size(), kMaxMarked),
                           [&](std::size_t i) { return view_.front()[i]; });
  }
  std::string chosen_text() const {
    const std::size_t drawn = chosen().size();
    return drawn < view_.designs()
               ? fmt::format("{} of {} designs are drawn, evenly chosen{}. ", drawn,
                             view_.designs(), view_.front().empty() ? "" : ", and of the front")
               : "";
  }
  std::string front_name() const { return view_.sought() > 1 ? "Pareto front" : "best"; }

  // Points of designs, and apart from them those of the front.
  report::ScatterFigure cloud(report::Axis x, report::Axis y, auto x_of, auto y_of) const {
    report::ScatterFigure scatter{std::move(x), std::move(y), {}};
    scatter.series = {{"designs", 0, false, false, {}}, {front_name(), 1, false, false, {}}};
    const auto& front = view_.front();
    for (const std::size_t design : chosen()) {
      const bool best = std::ranges::binary_search(front, design);
      scatter.series[best ? 1 : 0].points.push_back(
          {x_of(design), y_of(design),
           fmt::format("design {}: {}", view_.number(design), view_.text(design))});
    }
    if (front.empty()) scatter.series.pop_back();
    return scatter;
  }

  // Of samples: an output over a variable.
  void clouds() {
    std::size_t made = 0;
    for (const std::size_t v : varied_)
      for (std::size_t k = 0; k < view_.outputs() && made < kMaxSlices; ++k) {
        if (!is_number(view_.variable(v))) continue;
        ++made;
        add(fmt::format("cloud_{}_{}", v + 1, k + 1),
            fmt::format("{} over {}", view_.output(k).name, view_.variable(v).name()),
            cloud(
                view_.axis(v), view_.output_axis(k),
                [&](std::size_t design) { return view_.value(design, v); },
                [&](std::size_t design) { return view_.result(design, k); }),
            chosen_text());
      }
  }

  // Outputs that are sought against each other; all of them where none is.
  void pairs() {
    std::vector<std::size_t> outputs;
    for (std::size_t k = 0; k < view_.outputs(); ++k)
      if (view_.direction(k) != 0 || view_.sought() == 0) outputs.push_back(k);
    std::size_t made = 0;
    for (std::size_t a = 0; a < outputs.size(); ++a)
      for (std::size_t b = a + 1; b < outputs.size() && made < kMaxPairs; ++b, ++made)
        add(fmt::format("pair_{}_{}", outputs[a] + 1, outputs[b] + 1),
            fmt::format("{} against {}", view_.output(outputs[b]).name,
                        view_.output(outputs[a]).name),
            cloud(
                view_.output_axis(outputs[a]), view_.output_axis(outputs[b]),
                [&, a](std::size_t design) { return view_.result(design, outputs[a]); },
                [&, b](std::size_t design) { return view_.result(design, outputs[b]); }),
            chosen_text());
  }

  void parallel() {
    const std::size_t all = varied_.size() + view_.outputs();
    if (all < 3 || view_.designs() < 2) return;
    report::ParallelFigure figure;
    const auto designs = chosen();
    const auto add_column = [&](const report::Axis& axis, auto of_design,
                                const std::vector<std::string>& words) {
      figure.columns.push_back(
          {axis.label, axis.unit, report::each_of(designs, of_design), axis.log, words});
    };
    for (const std::size_t k : varied_)
      add_column(
          view_.axis(k), [&](std::size_t design) { return view_.value(design, k); },
          view_.variable(k).words());
    std::size_t by = figure.columns.size();
    for (std::size_t k = view_.outputs(); k-- > 0;)
      if (view_.direction(k) != 0) by = figure.columns.size() + k;
    for (std::size_t k = 0; k < view_.outputs(); ++k)
      add_column(view_.output_axis(k), [&](std::size_t design) { return view_.result(design, k); },
                 {});
    std::string note = chosen_text();
    if (figure.columns.size() > kMaxColumns) {
      note += limit_text(kMaxColumns, all, "parameters and outputs");
      figure.columns.resize(kMaxColumns);
    }
    figure.colour_by = std::min(by, figure.columns.size() - 1);
    for (const std::size_t design : marked())
      figure.marked.push_back(
          static_cast<std::size_t>(std::ranges::lower_bound(designs, design) - designs.begin()));
    figure.marked_label = front_name();
    if (figure.marked.size() < view_.front().size())
      figure.marked_label += fmt::format(", {} of {}", figure.marked.size(), view_.front().size());
    add("parallel", "Designs over their parameters and outputs", std::move(figure),
        note + "A line per design; it ends where an output was not computed.");
  }

  const SweepView& view_;
  std::vector<std::size_t> varied_;
  std::vector<report::Figure> figures_;
};

}  // namespace

std::vector<report::Figure> sweep_figures(const SweepView& view) { return Figures(view).all(); }

}  // namespace bentaxis::designs
