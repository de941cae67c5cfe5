#include "picture/elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bentaxis::report::picture {
namespace {

using Shades = std::array<std::array<double, 3>, 5>;

// Between the shades by t in [0, 1].
std::string between(const Shades& shades, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(shades.size() - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(at), shades.size() - 2);
  std::array<int, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<int>(std::lround(shades[k][i] + (at - static_cast<double>(k)) *
                                                             (shades[k + 1][i] - shades[k][i])));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

}  // namespace

std::string shade(double t) {
  return between({{{247, 250, 252}, {190, 214, 235}, {107, 164, 207}, {33, 103, 166}, {8, 40, 88}}},
                 t);
}

std::string line_shade(double t) {
  return between({{{122, 40, 176}, {170, 35, 149}, {204, 71, 120}, {230, 108, 92}, {248, 149, 64}}},
                 t);
}

std::string px(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

pugi::xml_node add(pugi::xml_node parent, const char* name, const Attributes& attributes) {
  pugi::xml_node node = parent.append_child(name);
  for (const auto& [key, value] : attributes) node.append_attribute(key) = value.c_str();
  return node;
}

pugi::xml_node add_text(pugi::xml_node parent, double x, double y, const std::string& text,
                        Attributes attributes) {
  attributes.insert(attributes.begin(), {{"x", px(x)}, {"y", px(y)}});
  pugi::xml_node node = add(parent, "text", attributes);
  node.text() = text.c_str();
  return node;
}

void add_line(pugi::xml_node parent, double x1, double y1, double x2, double y2,
              const Attributes& attributes) {
  Attributes all = {{"x1", px(x1)}, {"y1", px(y1)}, {"x2", px(x2)}, {"y2", px(y2)}};
  all.insert(all.end(), attributes.begin(), attributes.end());
  add(parent, "line", all);
}

void draw_mark(pugi::xml_node root, std::size_t which, double x, double y,
               const std::string& colour, const std::string& note) {
  const Attributes looks = {{"fill", colour}, {"stroke", "#fff"}, {"class", "mark"}};
  pugi::xml_node node;
  if (which % 5 == 0) {
    node = add(root, "circle", {{"cx", px(x)}, {"cy", px(y)}, {"r", "4"}});
  } else {
    const std::string at = fmt::format("M{} {}", px(x), px(y));
    const std::array<std::string, 4> paths = {at + "m-4 -4h8v8h-8z", at + "m0 -5l4.8 8.2h-9.6z",
                                              at + "m0 -5.5l5.5 5.5l-5.5 5.5l-5.5 -5.5z",
                                              at + "m0 5l4.8 -8.2h-9.6z"};
    node = add(root, "path", {{"d", paths[which % 5 - 1]}});
  }
  for (const auto& [key, value] : looks) node.append_attribute(key) = value.c_str();
  if (!note.empty()) node.append_child("title").text() = note.c_str();
}

}  // namespace bentaxis::report::picture
