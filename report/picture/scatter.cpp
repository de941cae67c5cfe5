#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "picture/curves.h"
#include "picture/figures.h"

namespace bentaxis::report::picture {

Picture picture_of(const ScatterFigure& figure, const Curves&) {
  struct Shown {
    ScatterSeries series;
    std::size_t style;
    std::string colour;
  };
  const auto usable = [](const Axis& axis, double v) {
    return std::isfinite(v) && (!axis.log || v > 0);
  };
  std::vector<Shown> all;
  Panel panel{figure.x, figure.y, 330, {}, {}};
  panel.x_margin = panel.y_margin = Margin::decades;
  std::size_t next = 0;
  for (ScatterSeries series : figure.series) {
    std::erase_if(series.points, [&](const ScatterPoint& p) {
      return !usable(figure.x, p.x) || !usable(figure.y, p.y);
    });
    if (series.points.empty()) continue;
    for (const ScatterPoint& p : series.points) {
      panel.xs.include(p.x);
      panel.ys.include(p.y);
    }
    const std::size_t style = series.emphasis ? 0
                              : series.style  ? static_cast<std::size_t>(*series.style)
                                              : next++;
    all.push_back({series, style, series.emphasis ? "#67727e" : pick(kColours, style)});
  }
  Picture picture;
  if (all.empty()) return picture;
  picture.legend.emplace_back();
  for (const Shown& shown : all)
    picture.legend[0].push_back({shown.series.name, [=](pugi::xml_node root, double x, double y) {
                                   if (shown.series.line)
                                     line_key("", shown.colour, shown.series.emphasis ? 6 : 1.5,
                                              "none", shown.series.emphasis ? 0.35 : 1)
                                         .draw(root, x, y);
                                   if (!shown.series.emphasis)
                                     draw_mark(root, shown.style, x + 15, y, shown.colour, "");
                                 }});
  // What is emphasised lies broad and pale under the rest.
  std::ranges::stable_sort(
      all, [](const Shown& a, const Shown& b) { return a.series.emphasis > b.series.emphasis; });
  panel.draw = [all, x_name = figure.x.label, y_name = figure.y.label](
                   pugi::xml_node root, const Scale& x, const Scale& y) {
    for (const Shown& shown : all) {
      Curve line{{},
                 {},
                 shown.colour,
                 shown.series.emphasis ? 8.0 : 1.3,
                 shown.series.emphasis ? 0.35 : 1};
      for (const ScatterPoint& p : shown.series.points) {
        line.x.push_back(p.x);
        line.y.push_back(p.y);
      }
      if (shown.series.line && line.x.size() > 1) draw_curve(root, x, y, line);
      if (shown.series.emphasis) continue;
      for (const ScatterPoint& p : shown.series.points)
        draw_mark(root, shown.style, x.place(p.x), y.place(p.y), shown.colour,
                  fmt::format("{}{}{} {}, {} {}", p.note, p.note.empty() ? "" : ", ", x_name,
                              short_number(p.x), y_name, short_number(p.y)));
    }
  };
  picture.panels.push_back(std::move(panel));
  return picture;
}

}  // namespace bentaxis::report::picture
