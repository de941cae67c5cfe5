#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/number.h"
#include "picture/curves.h"
#include "picture/figures.h"

namespace bentaxis::report::picture {

Picture picture_of(const PistonBars& figure, const Curves& page) {
  Picture picture;
  Range all;
  all.include(0);
  std::vector<const Curves::Table*> tables;
  for (const auto& table : page.tables) {
    bool computed = false;
    for (const std::string& channel : figure.channels)
      if (const Values* values = find(table.columns, channel); any(values)) {
        all.include(*values);
        computed = true;
      }
    if (computed) tables.push_back(&table);
  }
  if (tables.empty() || page.theta_deg.empty()) return picture;
  const auto look = [](std::size_t table) {
    return Attributes{{"fill", table == 0 ? "#0072b2" : "#fff"},
                      {"stroke", "#0072b2"},
                      {"stroke-width", "1.4"},
                      {"stroke-dasharray", table == 0 ? "none" : "5 3"}};
  };
  picture.legend.emplace_back();
  for (std::size_t t = 0; t < tables.size(); ++t)
    picture.legend[0].push_back(
        {tables[t]->name, [=](pugi::xml_node root, double x, double y) {
           Attributes box = look(t);
           box.insert(box.end(),
                      {{"x", px(x)}, {"y", px(y - 5)}, {"width", "28"}, {"height", "10"}});
           add(root, "rect", box);
         }});
  const double n = static_cast<double>(figure.channels.size());
  for (const double angle : figure.angles) {
    std::size_t row = 0;
    for (std::size_t i = 0; i < page.theta_deg.size(); ++i)
      if (std::abs(page.theta_deg[i] - angle) < std::abs(page.theta_deg[row] - angle)) row = i;
    Panel panel{{"piston"}, {"share", figure.unit}, 125, {0, n}, all};
    panel.title = fmt::format("At {:g} deg", page.theta_deg[row]);
    const std::size_t every = 1 + figure.channels.size() / 25;
    for (std::size_t i = 0; i < figure.channels.size(); i += every)
      panel.x_ticks.push_back({static_cast<double>(i) + 0.5, fmt::format("{}", i + 1)});
    panel.draw = [=, channels = figure.channels](pugi::xml_node root, const Scale& x,
                                                 const Scale& y) {
      const double slot = (x.place(1) - x.place(0)),
                   bar = 0.72 * slot / static_cast<double>(tables.size());
      for (std::size_t i = 0; i < channels.size(); ++i)
        for (std::size_t t = 0; t < tables.size(); ++t) {
          const Values* values = find(tables[t]->columns, channels[i]);
          if (values == nullptr || !is_computed((*values)[row])) continue;
          Attributes box = look(t);
          const double v = (*values)[row];
          box.insert(box.end(), {{"x", px(x.place(static_cast<double>(i)) + 0.14 * slot +
                                          static_cast<double>(t) * bar + 1)},
                                 {"y", px(y.place(std::max(v, 0.0)))},
                                 {"width", px(std::max(1.0, bar - 2))},
                                 {"height", px(std::abs(y.place(v) - y.place(0)))}});
          add(root, "rect", box);
        }
    };
    picture.panels.push_back(std::move(panel));
  }
  return picture;
}

Picture picture_of(const BarsFigure& figure, const Curves&) {
  constexpr std::size_t kMaxLetters = 42;
  constexpr double kRow = 24, kBar = 15;  // px
  Picture picture;
  const double n = static_cast<double>(figure.bars.size());
  if (figure.bars.empty()) return picture;
  Axis axis = figure.x;
  axis.log = false;
  Panel panel{axis, {}, kRow * n, {0, 0}, {0, n}};
  panel.y_margin = Margin::none;
  std::size_t letters = 4;
  for (std::size_t i = 0; i < figure.bars.size(); ++i) {
    const BarsFigure::Bar& bar = figure.bars[i];
    const std::string label = cut(bar.label, kMaxLetters);
    letters = std::max(letters, label.size());
    panel.y_ticks.push_back({n - 0.5 - static_cast<double>(i), label});
    for (const double end : {bar.low, bar.high}) panel.xs.include(end);
    if (bar.interval)
      for (const double end : {bar.interval->first, bar.interval->second}) panel.xs.include(end);
  }
  panel.left = 20 + kLetter * static_cast<double>(letters);
  // Room for the number beside the longest bar.
  const double more = 0.12 * (panel.xs.high - panel.xs.low);
  if (panel.xs.low < 0) panel.xs.low -= more;
  if (panel.xs.high > 0) panel.xs.high += more;
  panel.draw = [bars = figure.bars, unit = figure.x.unit, ticks = panel.y_ticks](
                   pugi::xml_node root, const Scale& x, const Scale& y) {
    for (std::size_t i = 0; i < bars.size(); ++i) {
      const BarsFigure::Bar& bar = bars[i];
      const double middle = y.place(ticks[i].value);
      const auto number = [&](double at, double value, const char* anchor) {
        add_text(root, at, middle + 4, short_number(value),
                 {{"text-anchor", anchor}, {"font-size", "11"}});
      };
      Range drawn{0, 0};
      for (const double end : {bar.low, bar.high}) {
        if (!std::isfinite(end) || end == 0) continue;
        drawn.include(end);
        const double from = x.place(std::min(end, 0.0)), to = x.place(std::max(end, 0.0));
        pugi::xml_node box = add(root, "rect",
                                 {{"class", "bar"},
                                  {"x", fmt::format("{:.2f}", from)},
                                  {"y", px(middle - kBar / 2)},
                                  {"width", fmt::format("{:.2f}", to - from)},
                                  {"height", px(kBar)},
                                  {"fill", end < 0 ? kColours[1] : kColours[0]}});
        box.append_child("title").text() =
            fmt::format("{}: {}{}{}", bar.label, with_unit(short_number(end), unit),
                        bar.note.empty() ? "" : "; ", bar.note)
                .c_str();
      }
      const Range ends = drawn;
      if (bar.interval && std::isfinite(bar.interval->first) &&
          std::isfinite(bar.interval->second)) {
        const double from = x.place(bar.interval->first), to = x.place(bar.interval->second);
        const Attributes looks = {{"class", "interval"}, {"stroke", "#000000"}};
        add_line(root, from, middle, to, middle, looks);
        for (const double end : {from, to}) add_line(root, end, middle - 4, end, middle + 4, looks);
        drawn.include(bar.interval->first);
        drawn.include(bar.interval->second);
      }
      const double right = x.place(drawn.high) + 5;
      if (ends.low < 0) number(x.place(drawn.low) - 5, ends.low, "end");
      if (!std::isfinite(bar.low) || !std::isfinite(bar.high))
        add_text(root, right, middle + 4, "not computed", {{"font-size", "11"}});
      else if (ends.high > 0 || ends.low == 0)
        number(right, ends.high, "start");
    }
    add_line(root, x.place(0), y.first, x.place(0), y.last,
             {{"stroke", "#67727e"}, {"class", "zero"}});
  };
  picture.panels.push_back(std::move(panel));
  return picture;
}

}  // namespace bentaxis::report::picture
