#include "picture/panels.h"

#include <fmt/format.h>

#include <sstream>

namespace bentaxis::report::picture {
namespace {

double draw_legend(pugi::xml_node root, const std::vector<Keys>& rows, double y) {
  for (const Keys& keys : rows) {
    if (keys.empty()) continue;
    double x = 14;
    for (const Key& key : keys) {
      const double width = 38 + kLetter * static_cast<double>(key.label.size()) + 18;
      if (x > 14 && x + width > kWidth) {
        x = 14;
        y += 18;
      }
      key.draw(root, x, y - 4);
      add_text(root, x + 36, y, key.label);
      x += width;
    }
    y += 20;
  }
  return y;
}

// Name of an axis of values, along it.
void name_upwards(pugi::xml_node root, double x, double y, const std::string& name) {
  add_text(
      root, x, y, name,
      {{"text-anchor", "middle"}, {"transform", fmt::format("rotate(-90 {} {})", px(x), px(y))}});
}

void draw_panel(pugi::xml_node root, const Panel& panel, double top) {
  constexpr double kRightAxis = 64;  // px, room for numbers and name
  const double bottom = top + panel.height, right = kRight - (panel.right ? kRightAxis : 0);
  Scale x = scale_of(panel.x, panel.xs, panel.left, right, panel.x_margin, panel.angle);
  if (!panel.x_ticks.empty()) x.ticks = panel.x_ticks;
  Scale y = scale_of(panel.y, panel.ys, bottom, top, panel.y_margin);
  if (!panel.y_ticks.empty()) y.ticks = panel.y_ticks;
  if (panel.bare) {
    panel.draw(root, x, y);
    return;
  }
  const Attributes grid = {{"stroke", "#e1e6ec"}, {"class", "grid"}};
  if (panel.x_ticks.empty())
    for (const Tick& tick : x.ticks)
      add_line(root, x.place(tick.value), top, x.place(tick.value), bottom, grid);
  if (panel.y_ticks.empty())
    for (const Tick& tick : y.ticks)
      add_line(root, panel.left, y.place(tick.value), right, y.place(tick.value),
               tick.value == 0 ? Attributes{{"stroke", "#67727e"}, {"class", "zero"}} : grid);
  panel.draw(root, x, y);
  const double middle = (top + bottom) / 2;
  if (panel.right) {
    const Scale other =
        scale_of(panel.right->axis, panel.right->range, bottom, top, panel.y_margin);
    panel.right->draw(root, x, other);
    add_line(root, right, top, right, bottom, {{"stroke", "#67727e"}, {"class", "zero"}});
    for (const Tick& tick : other.ticks)
      add_text(root, right + 7, other.place(tick.value) + 4, tick.label);
    name_upwards(root, kWidth - 8, middle, other.name);
  }
  for (const Tick& tick : x.ticks)
    add_text(root, x.place(tick.value), bottom + 16, tick.label, kMiddle);
  for (const Tick& tick : y.ticks)
    add_text(root, panel.left - 7, y.place(tick.value) + 4, tick.label, {{"text-anchor", "end"}});
  add_text(root, (panel.left + right) / 2, bottom + 33, x.name, kMiddle);
  name_upwards(root, 13, middle, y.name);
}

}  // namespace

Key line_key(const std::string& label, const std::string& colour, double width,
             const std::string& dash, double opacity) {
  return {label, [=](pugi::xml_node root, double x, double y) {
            add_line(root, x, y, x + 30, y,
                     {{"stroke", colour},
                      {"stroke-width", px(width)},
                      {"stroke-dasharray", dash},
                      {"opacity", fmt::format("{:g}", opacity)}});
          }};
}

Key shade_key(const std::string& label, const std::string& colour) {
  return {label, [=](pugi::xml_node root, double x, double y) {
            add(root, "rect",
                {{"x", px(x)},
                 {"y", px(y - 6)},
                 {"width", "30"},
                 {"height", "12"},
                 {"stroke", "#67727e"},
                 {"stroke-width", "0.6"},
                 {"fill", colour}});
          }};
}

Keys scale_keys(const std::string& name, const std::function<Key(double)>& key) {
  Keys keys;
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) keys.push_back(key(t));
  keys[0].label = name + ": " + keys[0].label;
  return keys;
}

std::string drawn(const Figure& figure, const Picture& picture) {
  pugi::xml_document document;
  pugi::xml_node root = add(document, "svg",
                            {{"xmlns", "http://www.w3.org/2000/svg"},
                             {"font-family", "DejaVu Sans, Arial, sans-serif"},
                             {"font-size", "12"},
                             {"fill", "#1c2733"},
                             {"role", "img"}});
  root.append_child("title").text() = figure.title.c_str();
  if (!figure.note.empty()) root.append_child("desc").text() = figure.note.c_str();
  add(root, "rect", {{"class", "ground"}, {"width", "100%"}, {"height", "100%"}, {"fill", "#fff"}});
  // A title too long for one line is broken once.
  const std::size_t most = 84;
  double y = 20;
  std::string title = figure.title;
  if (title.size() > most) {
    const std::size_t at = title.rfind(' ', most);
    const std::size_t cut = at == std::string::npos ? title.size() : at;
    add_text(root, 14, y, title.substr(0, cut),
             {{"class", "title"}, {"font-weight", "bold"}, {"font-size", "13"}});
    title = cut < title.size() ? title.substr(cut + 1) : "";
    y += 17;
  }
  add_text(root, 14, y, title, {{"class", "title"}, {"font-weight", "bold"}, {"font-size", "13"}});
  if (!figure.paper.empty()) {
    y += 17;
    add_text(root, 14, y, "paper: " + figure.paper, {{"class", "soft title"}, {"fill", "#4d5a67"}});
  }
  y = draw_legend(root, picture.legend, y + 20);
  y -= 8;
  for (const Panel& panel : picture.panels) {
    if (!panel.title.empty()) {
      y += 14;
      add_text(root, kLeft, y, panel.title, {{"class", "soft"}, {"fill", "#4d5a67"}});
      y += 6;
    }
    draw_panel(root, panel, y);
    y += panel.height + (panel.x.label.empty() ? 24 : 44);
  }
  if (picture.panels.empty()) add_text(root, 14, y + 14, "There is nothing to draw.");
  const double height = picture.panels.empty() ? y + 30 : y - 4;
  root.prepend_attribute("viewBox") = fmt::format("0 0 {} {}", px(kWidth), px(height)).c_str();
  root.append_attribute("width") = px(kWidth).c_str();
  root.append_attribute("height") = px(height).c_str();
  std::ostringstream text;
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  return text.str() + "\n";
}

}  // namespace bentaxis::report::picture
