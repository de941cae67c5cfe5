#include "bentaxis/study/pump_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/report/picture.h"
#include "pump_outline.h"

namespace bentaxis::study {
namespace {

// ---- Look

constexpr double kWidth = 1100;     // px
constexpr double kMaxHeight = 430;  // px, of the views
constexpr double kNarrowest = 262;  // px, of a view with its words
constexpr double kGap = 16;         // px, between views
constexpr double kHead = 44;        // px, above the views
constexpr double kFoot = 88;        // px, below them
constexpr double kFar = PumpOutline::kFar;

constexpr const char* kStyle = R"(
.bentaxis-pump { color: inherit; font-family: system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
:root.bentaxis-pump { color: #1c2733; background: #ffffff; }
@media (prefers-color-scheme: dark) { :root.bentaxis-pump { color: #e4e9ef; background: #14181d; } }
.bentaxis-pump .mm * { vector-effect: non-scaling-stroke; }
.bentaxis-pump text { fill: currentColor; font-size: 12.5px; stroke: none; }
.bentaxis-pump .title { font-size: 14px; font-weight: 600; }
.bentaxis-pump .small { font-size: 12px; opacity: 0.78; }
.bentaxis-pump .middle { text-anchor: middle; }
.bentaxis-pump .end { text-anchor: end; }
.bentaxis-pump .pale { fill: currentColor; fill-opacity: 0.07; stroke: currentColor; stroke-opacity: 0.28; stroke-width: 1px; }
.bentaxis-pump .axis { fill: none; stroke: currentColor; stroke-opacity: 0.55; stroke-width: 1px; stroke-dasharray: 12 3 2 3; }
.bentaxis-pump .edge { fill: none; stroke: currentColor; stroke-width: 1.6px; }
.bentaxis-pump .thin { fill: none; stroke: currentColor; stroke-opacity: 0.7; stroke-width: 1px; }
.bentaxis-pump .bore { fill: none; stroke: currentColor; stroke-width: 1.8px; }
.bentaxis-pump .piston { fill: #3b82c4; fill-opacity: 0.55; stroke: #3b82c4; stroke-width: 1.4px; stroke-linejoin: round; }
.bentaxis-pump .joint { fill: #3b82c4; stroke: #3b82c4; stroke-width: 1px; }
.bentaxis-pump .joints { fill: none; stroke: #3b82c4; stroke-width: 1.5px; stroke-dasharray: 6 3; }
.bentaxis-pump .lean { fill: none; stroke: #3b82c4; stroke-width: 2.4px; }
.bentaxis-pump .gear { fill: none; stroke: #1f9d6b; stroke-width: 1.5px; }
.bentaxis-pump .gear-point { fill: #1f9d6b; stroke: none; }
.bentaxis-pump .bearing { fill: #b06fb8; fill-opacity: 0.28; stroke: #b06fb8; stroke-width: 1.4px; }
.bentaxis-pump .pin { fill: none; stroke: #d08a00; stroke-width: 3px; }
.bentaxis-pump .pin-point { fill: #d08a00; stroke: none; }
.bentaxis-pump .delivery { fill: #d9541e; fill-opacity: 0.42; stroke: #d9541e; stroke-width: 1.2px; }
.bentaxis-pump .suction { fill: #3b9ec4; fill-opacity: 0.38; stroke: #3b9ec4; stroke-width: 1.2px; }
.bentaxis-pump .land { stroke: none; fill-opacity: 0.16; }
.bentaxis-pump .dimension { fill: none; stroke: currentColor; stroke-opacity: 0.75; stroke-width: 0.9px; }
.bentaxis-pump .mass { fill: currentColor; stroke: none; }
)";

struct Point {
  double x = 0, y = 0;
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
Point operator*(double f, Point a) { return {f * a.x, f * a.y}; }
Point unit(Point a) {
  const double length = std::hypot(a.x, a.y);
  return length > 0 ? Point{a.x / length, a.y / length} : Point{1, 0};
}

// To six digits: 22.5 and not 22.500000000000004.
std::string mm_text(double metres) { return fmt::format("{:.6g}", metres * 1e3); }
std::string px(double x) { return fmt::format("{:.1f}", x); }
std::string at(double x) { return fmt::format("{:.6g}", std::abs(x) < 1e-9 ? 0 : x); }

// Elements of one view; those of drawing() are in mm with y upwards, those of words() in px.
class View {
 public:
  // Its lower left and upper right corner, m.
  void room(Point p) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  }
  double width() const { return high_.x - low_.x; }
  double height() const { return high_.y - low_.y; }
  Point low() const { return low_; }

  // @param column  left edge of its words, px
  void place(double left, double middle, double px_per_m, double column) {
    column_ = column;
    left_ = left - low_.x * px_per_m;
    down_ = middle + (low_.y + high_.y) / 2 * px_per_m;
    scale_ = px_per_m;
  }
  double column() const { return column_; }
  Point on_paper(Point p) const { return {left_ + p.x * scale_, down_ - p.y * scale_}; }

  void line(const char* style, Point a, Point b) { path(style, {a, b}, false); }
  // A cross about the origin.
  void axes() {
    line("axis", {-high_.y, 0}, {high_.y, 0});
    line("axis", {0, -high_.y}, {0, high_.y});
  }
  void path(const char* style, const std::vector<Point>& points, bool closed = true) {
    std::string d;
    for (const Point& p : points)
      d += (d.empty() ? "M" : "L") + at(p.x * 1e3) + " " + at(p.y * 1e3);
    drawing_ += fmt::format("<path class=\"{}\" d=\"{}{}\"/>\n", style, d, closed ? "Z" : "");
  }
  void raw(const std::string& element) { drawing_ += element; }
  void circle(const char* style, Point c, double radius) {
    drawing_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", style,
                            at(c.x * 1e3), at(c.y * 1e3), at(radius * 1e3));
  }
  // A dot whose size is no dimension.
  void dot(const char* style, Point c, double radius_px) { circle(style, c, radius_px / scale_); }
  void words(const std::string& text, Point where, double dx, double dy, const char* style = "") {
    const Point p = on_paper(where);
    paper(text, {p.x + dx, p.y + dy}, style);
  }
  void paper(const std::string& text, Point p, const char* style = "") {
    // Kept on the sheet by its middle: a label is never lost with the point that it belongs to.
    words_ += fmt::format("<text{} x=\"{}\" y=\"{}\">{}</text>\n",
                          *style != '\0' ? fmt::format(" class=\"{}\"", style) : std::string(),
                          px(std::clamp(p.x, 4.0, kWidth - 4)), px(p.y), report::markup_of(text));
  }
  // A dimension line with arrow heads from a to b, moved aside by `aside` px, with its text.
  void dimension(Point a, Point b, double aside, const std::string& text, const char* style,
                 double dx, double dy) {
    const Point along = unit(b - a);
    const Point off = (aside / scale_) * Point{-along.y, along.x};
    const Point from = a + off, to = b + off;
    if (aside != 0) {
      line("dimension", a, from + 0.3 * off);
      line("dimension", b, to + 0.3 * off);
    }
    line("dimension", from, to);
    const double head = 6 / scale_, half = 2 / scale_;
    if (std::hypot(b.x - a.x, b.y - a.y) * scale_ > 16)
      for (const auto& [tip, way] : {std::pair{from, along}, std::pair{to, -1 * along}})
        path("mass", {tip, tip + head * way + half * Point{-way.y, way.x},
                      tip + head * way - half * Point{-way.y, way.x}});
    words(text, 0.5 * (from + to), dx, dy, style);
  }

  std::string text(const std::string& name) const {
    return fmt::format(
        "<g class=\"view-{}\">\n<g class=\"mm\" transform=\"translate({} {}) scale({:.6g} "
        "{:.6g})\">\n{}</g>\n{}</g>\n",
        name, px(left_), px(down_), scale_ / 1e3, -scale_ / 1e3, drawing_, words_);
  }

 private:
  Point low_{1e300, 1e300}, high_{-1e300, -1e300};
  double left_ = 0, down_ = 0, scale_ = 1, column_ = 0;
  std::string drawing_, words_;
};

// ---- The pump

class Picture {
 public:
  explicit Picture(const Case& the_case)
      : case_(the_case),
        p_(the_case.pump),
        g_(the_case.pump.geometry),
        derived_(analytic::derived_quantities(p_)),
        o_(p_) {}

  std::string svg() {
    make_room();
    const double high = std::max({side_.height(), joints_.height(), block_.height()});
    View* const views[] = {&side_, &joints_, &block_};
    const auto column = [](const View& view, double scale) {
      return std::max(kNarrowest, view.width() * scale);
    };
    const auto wide = [&](double scale) {
      return column(side_, scale) + column(joints_, scale) + column(block_, scale);
    };
    double scale = kMaxHeight / high;
    while (wide(scale) > kWidth - 4 * kGap) scale *= 0.98;
    const double gap = (kWidth - wide(scale)) / 4;
    double left = gap;
    for (View* view : views) {
      const double space = column(*view, scale);
      view->place(left + (space - view->width() * scale) / 2, kHead + high * scale / 2, scale,
                  left);
      left += space + gap;
    }
    bottom_ = kHead + high * scale;
    draw_side();
    draw_joints();
    draw_block();
    draw_rule(scale);
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"bentaxis-pump\" viewBox=\"0 0 {} {}\" "
        "role=\"img\" aria-label=\"The pump to scale\">\n<title>{}, to scale</title>\n"
        "<style>{}</style>\n{}{}{}{}</svg>\n",
        at(kWidth), px(bottom_ + kFoot), report::markup_of(case_.name), kStyle, side_.text("side"),
        joints_.text("joints"), block_.text("block"), rule_);
  }

 private:
  // Joint of a piston at chamber angle theta, seen along the block axis: x2, y2.
  Point joint(double theta) const {
    const auto [x, y] = o_.joint(theta);
    return {x, y};
  }
  // A point of the plane of the tilt given in S2 (z2, y2), in S1 (z1, y1).
  Point from_block(double z, double y) const {
    return {g_.axis_offset + o_.cosine * z - o_.sine * y, o_.sine * z + o_.cosine * y};
  }
  bool gear_is_drawn() const { return o_.has_gear && !o_.is_far(o_.gear_radius); }

  void make_room() {
    for (const double y : {-1.0, 1.0}) {
      side_.room({-0.1 * o_.size, y * o_.flange_radius});
      side_.room(from_block(o_.block_from, y * o_.block_radius));
      side_.room(from_block(o_.block_to + 0.5 * o_.bore, y * o_.block_radius));
    }
    // Bearings with their names.
    const double below = -0.42 * g_.joint_circle_radius - 0.7 * o_.size;
    for (const double z : {p_.bearings.tapered_z, p_.bearings.cylindrical_z})
      side_.room(
          {(o_.is_far(z) ? std::copysign(kFar * o_.size, z) : z) + std::copysign(0.36 * o_.size, z),
           o_.is_far(z) ? 0 : below});
    if (!o_.is_far(p_.block.pin_z)) side_.room(from_block(p_.block.pin_z, 0));
    if (gear_is_drawn())
      for (const double y : {-1.0, 1.0}) {
        side_.room({o_.gear_z, y * o_.gear_radius});
        side_.room(from_block(o_.gear_radius * std::tan(g_.tilt / 2), y * o_.gear_radius));
      }
    const double joints_radius = std::max(
        {o_.flange_radius, gear_is_drawn() ? o_.gear_radius : 0, g_.joint_circle_radius + o_.ball});
    square(joints_, joints_radius);
    double block_radius =
        std::max({o_.block_radius, g_.bore_circle_radius + o_.bore / 2, g_.joint_circle_radius});
    if (p_.port_plate && p_.port_plate->r4 < kFar * o_.size)
      block_radius = std::max(block_radius, p_.port_plate->r4);
    square(block_, block_radius);
  }
  // Above a view its title and its axes, below it lines of text.
  void describe(View& v, const char* title, const char* axes,
                const std::vector<std::string>& below) const {
    v.paper(title, {v.column(), 20}, "title");
    v.paper(axes, {v.column(), 36}, "small");
    for (std::size_t i = 0; i < below.size(); ++i)
      v.paper(below[i], {v.column(), bottom_ + (24 + 18 * static_cast<double>(i))});
  }
  static void square(View& view, double radius) {
    view.room({-radius, -radius});
    view.room({radius, radius});
  }

  void draw_side();
  void draw_piston(double theta, double sign);
  void draw_bearing(double z, bool tapered);
  void draw_gear_cones();
  void draw_joint_at_centre();
  void draw_wall_contact(double theta, double sign);
  std::string transfer_words() const;
  void draw_joints();
  void draw_block();
  void draw_port(const PortArc& arc, const char* style);
  void draw_rule(double scale);

  const Case& case_;
  const PumpParameters& p_;
  const Geometry& g_;
  analytic::DerivedQuantities derived_;
  PumpOutline o_;
  double bottom_ = 0;
  View side_, joints_, block_;
  std::string rule_;
};

// In section: z1 to the right, y1 upwards.
void Picture::draw_side() {
  View& v = side_;
  const double shaft = o_.shaft_radius, shaft_end = o_.shaft_end, flange = o_.flange;
  v.path("pale", {{0, o_.flange_radius},
                  {0, -o_.flange_radius},
                  {-flange, -o_.flange_radius},
                  {-flange - 0.1 * o_.size, -shaft},
                  {shaft_end, -shaft},
                  {shaft_end, shaft},
                  {-flange - 0.1 * o_.size, shaft},
                  {-flange, o_.flange_radius}});
  v.path("pale",
         {from_block(o_.block_from, -o_.block_radius), from_block(o_.block_to, -o_.block_radius),
          from_block(o_.block_to, o_.block_radius), from_block(o_.block_from, o_.block_radius)});
  draw_gear_cones();
  draw_joint_at_centre();
  // Axes, crossing at O2.
  v.line("axis", {shaft_end - 0.08 * o_.size, 0}, {0.35 * o_.size, 0});
  v.line("axis", from_block(-0.2 * o_.size, 0), from_block(o_.block_to + 0.32 * o_.bore, 0));
  v.line("edge", {0, -g_.joint_circle_radius}, {0, g_.joint_circle_radius});
  draw_piston(0, 1);
  draw_piston(kPi, -1);
  draw_wall_contact(0, 1);
  draw_wall_contact(kPi, -1);
  // Lands and groove of the plate, in section.
  if (p_.port_plate && p_.port_plate->r4 < kFar * o_.size) {
    const PortPlate& plate = *p_.port_plate;
    for (const double sign : {-1.0, 1.0}) {
      const auto stripe = [&](double inner, double outer, const char* style, double depth) {
        v.path(style, {from_block(o_.block_to, sign * inner), from_block(o_.block_to, sign * outer),
                       from_block(o_.block_to + depth, sign * outer),
                       from_block(o_.block_to + depth, sign * inner)});
      };
      stripe(plate.r1, plate.r4, "pale", o_.plate);
      stripe(plate.r2, plate.r3, "thin", o_.plate);
    }
  }
  draw_bearing(p_.bearings.tapered_z, true);
  draw_bearing(p_.bearings.cylindrical_z, false);
  if (o_.is_far(p_.block.pin_z)) {
    v.words(fmt::format("pin at {} mm", mm_text(p_.block.pin_z)),
            from_block(std::copysign(0.6 * o_.size, p_.block.pin_z), 0), 0, -8, "middle");
  } else {
    v.line("pin", from_block(0, 0), from_block(p_.block.pin_z, 0));
    v.dot("pin-point", from_block(p_.block.pin_z, 0), 5);
    v.words("pin", from_block(p_.block.pin_z, 0), 8, 14);
  }
  if (!o_.is_far(p_.shaft.centre_of_mass_z)) v.dot("mass", {p_.shaft.centre_of_mass_z, 0}, 3.5);
  if (!o_.is_far(p_.block.centre_of_mass_z))
    v.dot("mass", from_block(p_.block.centre_of_mass_z, 0), 3.5);
  // Dimensions.
  v.dimension({0, 0}, {0, -g_.joint_circle_radius}, -14, "", "", 0, 0);
  v.words("Ra " + mm_text(g_.joint_circle_radius), {0, -o_.flange_radius}, -16, 16);
  const double behind = o_.block_to + 0.42 * o_.bore;
  v.dimension(from_block(behind, 0), from_block(behind, -g_.bore_circle_radius), 0,
              "Rd " + mm_text(g_.bore_circle_radius), "", 8, 6);
  const Point a{0, g_.joint_circle_radius};
  const Point b = from_block(o_.near, g_.bore_circle_radius);
  v.dimension(a, b, 24, "b1 " + mm_text(g_.piston_length), "end", -8, -8);
  // Tilt, as an arc about O2.
  if (g_.tilt > 0.02) {
    const double r = 0.62 * o_.size;
    const double o = g_.axis_offset * 1e3;
    v.raw(fmt::format("<path class=\"dimension\" d=\"M{} 0A{} {} 0 0 1 {} {}\"/>\n",
                      at(o + r * 1e3), at(r * 1e3), at(r * 1e3), at(o + r * o_.cosine * 1e3),
                      at(r * o_.sine * 1e3)));
    v.line("dimension", {g_.axis_offset, 0}, {g_.axis_offset + 1.15 * r, 0});
    v.words(fmt::format("{:.6g}\u00b0", g_.tilt / kRadPerDegree),
            {g_.axis_offset + r * std::cos(g_.tilt / 2), r * std::sin(g_.tilt / 2)}, 6, 6);
  } else {
    v.words(fmt::format("tilt {:.6g}\u00b0", g_.tilt / kRadPerDegree), {g_.axis_offset, 0}, 10, 16);
  }
  describe(
      v, "Plane of the tilt", "z1 to the right, y1 up; pistons at 0\u00b0 and 180\u00b0",
      {fmt::format("stroke {:.4g} mm, {:.4g} cm3/rev; pistons tilt {:.2g}..{:.2g}\u00b0 in "
                   "their bores",
                   derived_.stroke * 1e3, derived_.displacement * 1e6,
                   derived_.smallest_tilt / kRadPerDegree, derived_.largest_tilt / kRadPerDegree)});
}

void Picture::draw_piston(double theta, double sign) {
  View& v = side_;
  const double rd = sign * g_.bore_circle_radius, half = g_.bore_diameter / 2;
  const double end = o_.piston_end(theta);
  const Point a{0, sign * g_.joint_circle_radius}, b = from_block(end, rd);
  // Bore: from the block's face to behind the deepest piston.
  const double bottom = o_.bore_bottom;
  v.path("bore",
         {from_block(o_.block_from, rd + half), from_block(bottom, rd + half),
          from_block(bottom, rd - half), from_block(o_.block_from, rd - half)},
         false);
  // A cone from the ball to a head behind the ring at B.
  const Point along = unit(b - a);
  const Point across{-along.y, along.x};
  const double ring = 0.97 * half, neck = 0.62 * o_.ball;
  const Point head = b + 0.1 * o_.bore * along;
  v.path("piston", {a + neck * across, b + ring * across, head + 0.8 * ring * across,
                    head - 0.8 * ring * across, b - ring * across, a - neck * across});
  v.circle("piston", a, o_.ball);
  v.line("thin", a, b);
  v.dot("mass", a, 2.2);
  v.dot("mass", b, 2.2);
  v.words("A", a, -14, sign > 0 ? -6 : 14);
  v.words("B", b, 6, -5);
}

void Picture::draw_bearing(double z, bool tapered) {
  View& v = side_;
  const std::string name = tapered ? "C1 tapered" : "C2 cylindrical";
  const double shaft = o_.shaft_radius, height = o_.bearing_height;
  if (o_.is_far(z)) {
    const Point edge{std::copysign(kFar * o_.size, z), 0};
    v.words(fmt::format("{} at {} mm {}", name, mm_text(z), z < 0 ? "\u2190" : "\u2192"), edge, 0,
            tapered ? -34 : 44, z < 0 ? "" : "end");
    return;
  }
  const double half = o_.bearing_half;
  for (const double sign : {-1.0, 1.0}) {
    const double low = sign * shaft, high = sign * (shaft + height);
    v.path("bearing", {{z - half, low}, {z + half, low}, {z + half, high}, {z - half, high}});
    // The roller, or its lean.
    const double lean = tapered ? 0.5 * half : 0;
    v.line("thin", {z - 0.7 * half, (low + high) / 2 - sign * lean},
           {z + 0.7 * half, (low + high) / 2 + sign * lean});
  }
  v.line("axis", {z, -shaft - height}, {z, shaft + height});
  v.words(tapered ? "C1 tapered" : "C2 cylindrical", {z, -shaft - height}, 0, 16, "middle");
  v.words(mm_text(z), {z, -shaft - height}, 0, 31, "middle small");
}

void Picture::draw_gear_cones() {
  View& v = side_;
  if (!gear_is_drawn()) return;
  const double r = o_.gear_radius, behind = r * std::tan(g_.tilt / 2);
  const Point apex = from_block(0, 0);
  const double back = PumpOutline::kGearFace;  // the teeth are at the outer end of the cone
  for (const double sign : {-1.0, 1.0}) {
    const Point of_shaft{o_.gear_z, sign * r}, of_block = from_block(behind, sign * r);
    v.line("gear", apex + back * (of_shaft - apex), of_shaft);
    v.line("gear", apex + back * (of_block - apex), of_block);
  }
  const Point contact{o_.gear_z, r};
  v.dot("gear", contact, 4);
  v.words("O4", contact, -8, -8, "end");
}

// At O2: of a universal joint both arms, of a constant-velocity joint the plane in which its balls
// stand.
void Picture::draw_joint_at_centre() {
  if (!p_.transfer.is_joint()) return;
  View& v = side_;
  const Point o2 = from_block(0, 0);
  const double r = o_.transfer_radius();
  if (p_.transfer.kind == TransferKind::constant_velocity) {
    const Point across{-r * std::sin(g_.tilt / 2), r * std::cos(g_.tilt / 2)};
    v.circle("gear", o2, r);
    v.line("gear", o2 - across, o2 + across);
    for (const double sign : {-1.0, 1.0}) v.dot("gear-point", o2 + sign * 0.8 * across, 4);
    v.words("constant-velocity joint", o2 - across, 0, 16, "middle small");
    return;
  }
  const double phase = p_.transfer.phase();
  if (p_.transfer.kind == TransferKind::double_cardan) {
    // The crosses on either axis, and the shaft between them.
    const double distance = p_.transfer.double_cardan->cross_distance;
    const double up = -r * std::sin(phase);
    const auto from_shaft = [&](double y) { return Point{g_.axis_offset - distance, y}; };
    v.line("gear", from_shaft(0), from_block(distance, 0));
    for (const double sign : {-1.0, 1.0}) {
      v.dot("gear-point", from_shaft(sign * up), 4);
      v.dot("gear-point", from_block(distance, sign * up), 4);
    }
    v.line("gear", from_shaft(-up), from_shaft(up));
    v.line("gear", from_block(distance, -up), from_block(distance, up));
    v.words("double universal joint", o2, 0, 16, "middle small");
    return;
  }
  const double psi = block_lead(p_, 0);
  const Point of_shaft{0, -r * std::sin(phase)};
  const Point of_block = from_block(0, r * std::cos(psi - phase)) - o2;
  for (const Point& arm : {of_shaft, of_block}) {
    v.line("gear", o2 - arm, o2 + arm);
    v.dot("gear-point", o2 - arm, 4);
    v.dot("gear-point", o2 + arm, 4);
  }
  v.words("universal joint", o2 - of_block, 0, 16, "middle small");
}

// Where a piston's axis has its contact with the wall of the bore.
void Picture::draw_wall_contact(double theta, double sign) {
  if (p_.transfer.kind != TransferKind::pistons) return;
  const Point a{0, sign * g_.joint_circle_radius};
  const Point b = from_block(o_.piston_end(theta), sign * g_.bore_circle_radius);
  const Point d = a + (p_.transfer.wall->from_joint / g_.piston_length) * (b - a);
  side_.dot("gear-point", d, 4);
  side_.words("D", d, 6, sign > 0 ? 14 : -5);
}

std::string Picture::transfer_words() const {
  switch (p_.transfer.kind) {
    case TransferKind::gear:
      return fmt::format("pitch circle d {} mm{}", mm_text(p_.gear.pitch_diameter),
                         gear_is_drawn() ? "" : " (outside the picture)");
    case TransferKind::constant_velocity:
      return "constant-velocity joint at O2";
    case TransferKind::cardan:
      return fmt::format("universal joint at O2, phase {:.4g}\u00b0",
                         p_.transfer.phase() / kRadPerDegree);
    case TransferKind::double_cardan:
      return fmt::format("double joint at O2 \u00b1 {} mm, phase {:.4g}\u00b0",
                         mm_text(p_.transfer.double_cardan->cross_distance),
                         p_.transfer.phase() / kRadPerDegree);
    case TransferKind::pistons:
      break;
  }
  const WallContact& wall = *p_.transfer.wall;
  const std::string place = fmt::format("D {} mm from A, ", mm_text(wall.from_joint));
  return place + (wall.deviation.empty() ? fmt::format("clearance {} mm", mm_text(wall.clearance))
                                         : "own clearances");
}

// S1 against z1: x1 to the right, y1 upwards, positive angles to the left.
void Picture::draw_joints() {
  View& v = joints_;
  v.circle("pale", {0, 0}, o_.flange_radius);
  v.circle("joints", {0, 0}, g_.joint_circle_radius);
  if (gear_is_drawn()) v.circle("gear", {0, 0}, o_.gear_radius);
  if (p_.transfer.has_crosses()) {
    const double phase = p_.transfer.phase();
    const Point arm = o_.transfer_radius() * Point{std::cos(phase), -std::sin(phase)};
    v.line("gear", -1 * arm, arm);
    for (const double sign : {-1.0, 1.0}) v.dot("gear-point", sign * arm, 4);
  }
  v.axes();
  for (int k = 0; k < g_.pistons; ++k) {
    const double theta = -2 * kPi * k / g_.pistons;
    const Point a{-g_.joint_circle_radius * std::sin(theta),
                  g_.joint_circle_radius * std::cos(theta)};
    v.circle("piston", a, o_.ball);
    if (g_.pistons <= 12) v.words(std::to_string(k + 1), a, 0, 4, "middle");
  }
  describe(v, o_.has_gear ? "Joints and gear" : "Joints", "against the shaft axis: x1 right, y1 up",
           {"joint circle Ra " + mm_text(g_.joint_circle_radius) + " mm", transfer_words()});
}

void Picture::draw_port(const PortArc& arc, const char* style) {
  const PortPlate& plate = *p_.port_plate;
  const auto ring = [&](double inner, double outer, const std::string& look) {
    const double from = arc.from_deg * kRadPerDegree;
    const double span = std::min(arc.to_deg - arc.from_deg, 359.99) * kRadPerDegree;
    const auto point = [&](double r, double psi) {
      return at(-r * std::sin(psi) * 1e3) + " " + at(r * std::cos(psi) * 1e3);
    };
    const int large = span > kPi ? 1 : 0;
    block_.raw(fmt::format("<path class=\"{}\" d=\"M{}A{} {} 0 {} 1 {}L{}A{} {} 0 {} 0 {}Z\"/>\n",
                           look, point(outer, from), mm_text(outer), mm_text(outer), large,
                           point(outer, from + span), point(inner, from + span), mm_text(inner),
                           mm_text(inner), large, point(inner, from)));
  };
  ring(plate.r1, plate.r4, std::string(style) + " land");
  ring(plate.r2, plate.r3, style);
}

// S2 against z2, as seen from the port plate.
void Picture::draw_block() {
  View& v = block_;
  const PortPlate* plate = p_.port_plate ? &*p_.port_plate : nullptr;
  const bool plate_fits = plate != nullptr && plate->r4 < kFar * o_.size;
  v.circle("pale", {0, 0}, o_.block_radius);
  if (plate_fits) {
    draw_port(plate->delivery, "delivery");
    draw_port(plate->suction, "suction");
  }
  v.axes();
  v.circle("thin", {0, 0}, g_.bore_circle_radius);
  v.raw(fmt::format("<ellipse class=\"joints\" cx=\"0\" cy=\"{}\" rx=\"{}\" ry=\"{}\"/>\n",
                    at(g_.axis_offset * o_.sine * 1e3), mm_text(g_.joint_circle_radius),
                    mm_text(g_.joint_circle_radius * o_.cosine)));
  for (int k = 0; k < g_.pistons; ++k) {
    const double theta = -2 * kPi * k / g_.pistons;
    const Point c{-g_.bore_circle_radius * std::sin(theta),
                  g_.bore_circle_radius * std::cos(theta)};
    v.circle("bore", c, g_.bore_diameter / 2);
    v.line("lean", joint(theta), c);
    v.dot("joint", joint(theta), 2.6);
    if (g_.pistons <= 12) v.words(std::to_string(k + 1), c, 0, 16, "middle small");
  }
  describe(
      v, "Bores and port plate", "against the block axis: x2 right, y2 up",
      {fmt::format("bores Dpi {} mm on Rd {} mm", mm_text(g_.bore_diameter),
                   mm_text(g_.bore_circle_radius)),
       plate == nullptr ? std::string("no port plate")
                        : fmt::format("lands {}..{} and {}..{} mm{}", mm_text(plate->r1),
                                      mm_text(plate->r2), mm_text(plate->r3), mm_text(plate->r4),
                                      plate_fits ? "" : " (not drawn: too large)")});
}

// A rule, and what the colours are.
void Picture::draw_rule(double scale) {
  const double wanted = 110 / scale;
  double step = std::pow(10, std::floor(std::log10(wanted)));
  for (const double f : {5.0, 2.0})
    if (f * step <= wanted) {
      step *= f;
      break;
    }
  const double y = bottom_ + 66, left = side_.column();
  rule_ = fmt::format(
      "<path class=\"edge\" d=\"M{0} {1}v6h{2}v-6\"/>\n<text class=\"small\" x=\"{3}\" "
      "y=\"{4}\">{5} mm. Blue: pistons, dashed the circle of their joints; green: {6}; "
      "pale: outlines that the case does not give; dots: centres of mass</text>\n",
      px(left), px(y), px(step * scale), px(left + step * scale + 8), px(y + 8), mm_text(step),
      o_.has_gear ? "pitch circle" : "what turns the block");
}

}  // namespace

std::string pump_picture(const Case& the_case) { return Picture(the_case).svg(); }

}  // namespace bentaxis::study
