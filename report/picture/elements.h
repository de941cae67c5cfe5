// What a picture is made of: looks and SVG elements, in pixels.
#pragma once

#include <array>
#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

namespace bentaxis::report::picture {

// ---- Looks; the curves' colours and dashes are those of page/elements.js.

inline constexpr double kWidth = 720, kLeft = 82, kRight = 704;  // px
inline constexpr double kLetter = 6.6;                           // px, of the legend, on average
inline constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9",
                                        "#e69f00", "#000000", "#7f3b08", "#542788", "#5f6b75"};
inline constexpr std::array kExtraColours = {"#444c55", "#8a5a00", "#7a3b8f"};
inline constexpr std::array kDashes = {"none", "8 5", "2 4"};  // by table

template <class Choices>
const char* pick(const Choices& choices, std::size_t i) {
  return choices[i % choices.size()];
}

/// Light to dark by t in [0, 1]: the order of the values survives a print without colour.
std::string shade(double t);
/// Dark to light, for lines: seen on white and on a dark ground.
std::string line_shade(double t);

// ---- Elements

/// A length as SVG has it, to a tenth of a pixel.
std::string px(double value);

using Attributes = std::vector<std::pair<const char*, std::string>>;

pugi::xml_node add(pugi::xml_node parent, const char* name, const Attributes& attributes);
pugi::xml_node add_text(pugi::xml_node parent, double x, double y, const std::string& text,
                        Attributes attributes = {});
void add_line(pugi::xml_node parent, double x1, double y1, double x2, double y2,
              const Attributes& attributes);

inline const Attributes kMiddle = {{"text-anchor", "middle"}};

/// A symbol, one of five, with a text that is shown when pointed at.
void draw_mark(pugi::xml_node root, std::size_t which, double x, double y,
               const std::string& colour, const std::string& note);

}  // namespace bentaxis::report::picture
