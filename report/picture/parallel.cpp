#include <fmt/format.h>

#include <algorithm>

#include "bentaxis/pump/number.h"
#include "picture/figures.h"

namespace bentaxis::report::picture {
namespace {

struct PlacedName {
  double x;         // of its middle, px
  std::size_t row;  // the first in which it has room
};

// Of names that stand evenly between the ends of the axis.
std::vector<PlacedName> placed(const std::vector<std::string>& names) {
  std::vector<PlacedName> places;
  std::vector<double> ends;  // of the rows, px
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double half = kLetter * static_cast<double>(names[k].size()) / 2;
    const double x =
        kLeft + (kRight - kLeft) * static_cast<double>(k) / static_cast<double>(names.size() - 1);
    const double at = std::clamp(x, 6 + half, std::max(6 + half, kWidth - 4 - half));
    std::size_t row = 0;
    while (row < ends.size() && ends[row] > at - half - 8) ++row;
    if (row == ends.size()) ends.push_back(0);
    ends[row] = at + half;
    places.push_back({at, row});
  }
  return places;
}

}  // namespace

Picture picture_of(const ParallelFigure& figure, const Curves&) {
  constexpr double kHeight = 300, kNameRow = 15;  // px
  Picture picture;
  const std::size_t count = figure.columns.size();
  if (count < 2) return picture;
  std::vector<Range> ranges(count);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& column = figure.columns[k];
    for (const double value : column.values)
      if (!column.log || value > 0) ranges[k].include(value);
    if (!column.words.empty())
      ranges[k] = {0, std::max(1.0, static_cast<double>(column.words.size()) - 1)};
    names.push_back(cut(name_of({column.label, column.unit}), 40));
  }
  if (std::ranges::all_of(ranges, [](const Range& r) { return r.empty(); })) return picture;
  const auto scale = [&columns = figure.columns, ranges](std::size_t k, double first, double last) {
    const auto& column = columns[k];
    Scale made =
        scale_of({column.label, column.unit, column.log}, ranges[k], first, last, Margin::none);
    if (column.words.empty()) return made;
    made.ticks.clear();
    for (std::size_t w = 0; w < column.words.size(); ++w)
      made.ticks.push_back({static_cast<double>(w), column.words[w]});
    return made;
  };
  // Colours by the place on the axis of one column, in five steps named in the legend.
  const std::size_t by = std::min(figure.colour_by, count - 1);
  const Scale colours = scale(by, 0, 1);
  picture.legend.resize(2);
  picture.legend[0] = scale_keys(figure.columns[by].label, [&](double t) {
    const double value = colours.log ? colours.low * std::pow(colours.high / colours.low, t)
                                     : colours.low + t * (colours.high - colours.low);
    return line_key(with_unit(short_number(value), figure.columns[by].unit), line_shade(t), 3);
  });
  if (!figure.marked.empty())
    picture.legend[1].push_back(line_key(figure.marked_label, "#000000", 2));
  const std::vector<PlacedName> places = placed(names);
  std::size_t rows = 0;
  for (const PlacedName& place : places) rows = std::max(rows, place.row + 1);
  Panel panel{{},
              {},
              kHeight + kNameRow * static_cast<double>(rows),
              {0, static_cast<double>(count - 1)},
              {0, 1}};
  panel.bare = true;
  panel.y_margin = Margin::none;
  panel.draw = [=, columns = figure.columns, marked = figure.marked](
                   pugi::xml_node root, const Scale& x, const Scale& y) {
    const double top = y.last + 8, bottom = top + kHeight - 8;
    std::vector<Scale> axes;
    for (std::size_t k = 0; k < count; ++k) axes.push_back(scale(k, bottom, top));
    const auto draw = [&](std::size_t design, const std::string& colour, double width,
                          const char* opacity) {
      std::string path, note;
      bool joined = false;
      for (std::size_t k = 0; k < count; ++k) {
        const double value = columns[k].values[design];
        const bool shown = axes[k].shows(value);
        if (shown)
          path += fmt::format("{}{} {}", joined ? "L" : "M", px(x.place(static_cast<double>(k))),
                              px(axes[k].place(value)));
        joined = shown;
        const bool named = shown && !columns[k].words.empty();
        note += fmt::format("{}{} {}", note.empty() ? "" : ", ", columns[k].label,
                            named ? columns[k].words.at(static_cast<std::size_t>(value))
                            : is_computed(value) ? with_unit(short_number(value), columns[k].unit)
                                                 : "not computed");
      }
      if (path.empty()) return;
      pugi::xml_node node = add(root, "path",
                                {{"class", "design"},
                                 {"d", path},
                                 {"fill", "none"},
                                 {"stroke", colour},
                                 {"stroke-width", px(width)},
                                 {"stroke-linejoin", "round"},
                                 {"opacity", opacity}});
      node.append_child("title").text() = note.c_str();
    };
    for (std::size_t design = 0; design < columns[by].values.size(); ++design) {
      const double value = columns[by].values[design];
      draw(design, colours.shows(value) ? line_shade(colours.place(value)) : "#98a4af", 1.2, "0.6");
    }
    for (const std::size_t design : marked) draw(design, "#000000", 2, "1");
    for (std::size_t k = 0; k < count; ++k) {
      const double at = x.place(static_cast<double>(k));
      add_line(root, at, top, at, bottom, {{"stroke", "#67727e"}, {"class", "zero"}});
      for (const Tick& tick : axes[k].ticks)
        add_text(root, at - 5, axes[k].place(tick.value) + 4, tick.label,
                 {{"text-anchor", "end"},
                  {"font-size", "11"},
                  {"class", "mark"},
                  {"stroke", "#fff"},
                  {"stroke-width", "3"},
                  {"paint-order", "stroke"}});
    }
    for (std::size_t k = 0; k < count; ++k)
      add_text(root, places[k].x, bottom + 20 + kNameRow * static_cast<double>(places[k].row),
               names[k], kMiddle);
  };
  picture.panels.push_back(std::move(panel));
  return picture;
}

}  // namespace bentaxis::report::picture
