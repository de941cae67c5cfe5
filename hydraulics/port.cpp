#include "port.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::hydraulics {
namespace {

// Edges closer than this are one, degrees.
constexpr double kOneEdge = 1e-9;
// A piece of a table bends where its slope changes by more than this share of itself, unless the
// area that the change makes is below this share of the largest: that is rounding of the table.
constexpr double kBend = 0.1;
constexpr double kRoundedArea = 1e-6;

double wrap(double angle) {
  const double wrapped = angle - 360.0 * std::floor(angle / 360.0);
  return wrapped >= 360.0 ? 0.0 : wrapped;
}

}  // namespace

double segment_area(double radius, double overlap) {
  const double half_angle = 2 * std::asin(std::sqrt(std::clamp(overlap / (2 * radius), 0.0, 1.0)));
  return radius * radius * (half_angle - std::sin(half_angle) * std::cos(half_angle));
}

double common_area(double radius, double smaller, double overlap) {
  if (overlap <= 0) return 0;
  if (overlap >= 2 * smaller) return kPi * smaller * smaller;
  // The chord through both crossings cuts a segment off either circle.
  const double twice_distance = 2 * (radius + smaller - overlap);
  return segment_area(smaller, overlap * (2 * radius - overlap) / twice_distance) +
         segment_area(radius, overlap * (2 * smaller - overlap) / twice_distance);
}

double PortOpening::Frame::past(double theta_deg) const {
  return wrap(theta_deg + half_ - first_) + first_;
}

double PortOpening::Overlap::area(double past) const {
  const double overlap = std::min(past, to) - std::max(frame.trailing(past), from);
  if (!(overlap > 0)) return 0;
  if (circular) {
    const double long_by = overlap * length;
    return common_area(height / 2, height / 2, long_by) + height * std::max(0.0, long_by - height);
  }
  return area_per_degree *
         (overlap < rounding ? overlap * overlap / (2 * rounding) : overlap - rounding / 2);
}

double PortOpening::Wedge::passed(double length_deg) const {
  const double share = std::clamp(length_deg / length, 0.0, 1.0);
  return quadratic ? share * share : share;
}

double PortOpening::Wedge::area(double leading) const {
  const double behind = frame.trailing(leading);
  if (trailing)
    return root_area * (passed(from + length - behind) - passed(from + length - leading));
  return root_area * (passed(leading - from) - passed(behind - from));
}

double PortOpening::Groove::area(double past) const {
  const double overlap = std::min(past, to) - std::max(frame.trailing(past), from);
  return std::clamp(mouth_per_degree * overlap, 0.0, cross_section);
}

double PortOpening::Hole::area(double past) const {
  // Only one end of the kidney is over the hole at a time.
  const double overlap = radius + length * std::min(past - centre, centre - frame.trailing(past));
  return end_radius > 0 ? common_area(end_radius, radius, overlap) : segment_area(radius, overlap);
}

double PortOpening::Table::area(double theta_deg) const { return curve(theta_deg - start); }

PortOpening::PortOpening(const HydraulicData& data, const PlatePort& port,
                         double bore_circle_radius) {
  if (port.table.theta_deg.empty())
    add_geometry(data, port, radians(1) * bore_circle_radius);
  else
    add_table(port.table);
  std::sort(edges_deg_.begin(), edges_deg_.end());
}

void PortOpening::add_edge(double theta_deg) { edges_deg_.push_back(wrap(theta_deg)); }

void PortOpening::add_geometry(const HydraulicData& data, const PlatePort& port, double length) {
  const double half = data.kidney_width_deg / 2;
  const auto& [from, to] = port.arc;
  const bool circular = data.kidney_ends == KidneyEnds::circular;
  const double rounding = circular ? data.kidney_height / length : data.kidney_rounding_deg;
  // Kidney, port and notches are shorter than a turn, so that one branch of the angle is enough.
  const Frame frame(from - port.notch.length_deg, half);
  add({"kidney", "kidney over the port"},
      Overlap{frame, from, to, rounding, length, data.kidney_height, length * data.kidney_height,
              circular});
  for (const double at : {from - half, from - half + rounding, from + half, to - half,
                          to + half - rounding, to + half})
    add_edge(at);

  const bool quadratic = data.notch_law == NotchLaw::quadratic;
  const auto add_notch = [&](const Notch& notch, double start, double tip, bool trailing) {
    if (notch.length_deg == 0 || notch.area == 0) return;
    add(trailing ? PartName{"trailing_notch", "notch behind the port"}
                 : PartName{"notch", "notch before the port"},
        Wedge{frame, start, notch.length_deg, notch.area, quadratic, trailing});
    add_edge(tip - half);
    add_edge(tip + half);
  };
  add_notch(port.notch, from - port.notch.length_deg, from - port.notch.length_deg, false);
  add_notch(port.trailing_notch, to, to + port.trailing_notch.length_deg, true);

  if (const ReliefGroove& groove = port.groove; groove.area > 0) {
    const double mouth = groove.width * length;  // per degree
    add({"groove", "relief groove"},
        Groove{Frame(groove.from_deg, half), groove.from_deg, groove.to_deg, mouth, groove.area});
    for (const double at : {groove.from_deg, groove.to_deg}) {
      add_edge(at - half);
      add_edge(at + half);
    }
    const double full = groove.area / mouth;
    if (full < std::min(groove.to_deg - groove.from_deg, 2 * half)) {
      add_edge(groove.from_deg - half + full);
      add_edge(groove.to_deg + half - full);
    }
  }
  for (const PlateHole& hole : port.holes) {
    if (hole.diameter == 0) continue;
    const double reach = hole.diameter / 2 / length;
    add(&hole == port.holes.data() ? PartName{"hole", "hole"} : PartName{"hole_2", "second hole"},
        Hole{Frame(hole.angle_deg - reach, half), hole.angle_deg, hole.diameter / 2, length,
             circular ? data.kidney_height / 2 : 0});
    for (const double at : {hole.angle_deg - reach, hole.angle_deg + reach}) {
      add_edge(at - half);
      add_edge(at + half);
    }
  }
}

void PortOpening::add_table(const OpeningTable& table) {
  const std::size_t n = table.theta_deg.size();
  std::vector<double> span(n), rise(n), slope(n);  // of the interval that begins at each point
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    span[i] = table.theta_deg[next] - table.theta_deg[i] + (next == 0 ? 360 : 0);
    rise[i] = (table.area[next] - table.area[i]) / span[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    if (!(rise[before] * rise[i] > 0)) continue;
    const double share = (span[before] + 2 * span[i]) / (3 * (span[before] + span[i]));
    slope[i] = rise[before] * rise[i] / (share * rise[i] + (1 - share) * rise[before]);
  }
  const double largest = *std::max_element(table.area.begin(), table.area.end());
  std::vector<bool> edge(n);
  std::vector<PeriodicCubic::Piece> pieces;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    // An integration that meets a bend in the middle of a step sees it late, or not at all where
    // the step covers it.
    const auto [least, most] = std::minmax({slope[i], rise[i], slope[next]});
    if (most - least > kBend * std::max(std::abs(least), std::abs(most)) &&
        (most - least) * span[i] > kRoundedArea * largest)
      edge[i] = edge[next] = true;
    pieces.push_back({table.theta_deg[i] - table.theta_deg[0], table.area[i], slope[i],
                      table.area[next], slope[next]});
    const std::size_t before = (i + n - 1) % n;
    const bool closed_before = table.area[before] == 0, closed_after = table.area[next] == 0;
    if (table.area[i] == 0 && closed_before != closed_after) edge[i] = true;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (edge[i]) add_edge(table.theta_deg[i]);
  add({"table", "from a table"}, Table{table.theta_deg[0], PeriodicCubic(std::move(pieces))});
}

void PortOpening::add(const PartName& name, Part part) {
  names_.push_back(name);
  parts_.push_back(std::move(part));
}

double PortOpening::part_area(std::size_t i, double theta_deg) const {
  Place none;
  return area_of(parts_[i], theta_deg, none);
}

double PortOpening::area_of(const Part& part, double theta_deg, Place& place) {
  return std::visit(
      [&](const auto& of) {
        if constexpr (std::is_same_v<decltype(of), const Table&>) {
          return of.area(theta_deg);
        } else {
          if (place.frame == nullptr || !(*place.frame == of.frame))
            place = {&of.frame, of.frame.past(theta_deg)};
          return of.area(place.past);
        }
      },
      part);
}

double PortOpening::area(double theta_deg) const {
  double sum = 0;
  Place place;
  for (const Part& part : parts_) sum += area_of(part, theta_deg, place);
  return sum;
}

std::vector<Bridge> bridges(const PortOpening& suction, const PortOpening& delivery) {
  std::vector<double> edges = suction.edges_deg();
  append(edges, delivery.edges_deg());
  sort_once(edges, kOneEdge);
  if (edges.empty()) edges = {0};
  std::vector<Bridge> all;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double to = i + 1 < edges.size() ? edges[i + 1] : edges[0] + 360;
    const double middle = (edges[i] + to) / 2;
    const bool open = suction.area(middle) > 0;
    if (open != (delivery.area(middle) > 0)) continue;
    if (!all.empty() && all.back().to_deg == edges[i] && all.back().both_open == open)
      all.back().to_deg = to;
    else
      all.push_back({edges[i], to, open});
  }
  if (all.size() == 1 && all[0].to_deg - all[0].from_deg == 360)
    return {{0, 360, all[0].both_open}};
  // One that goes on over 0 degrees.
  if (all.size() > 1 && all.back().to_deg == all.front().from_deg + 360 &&
      all.back().both_open == all.front().both_open) {
    all.back().to_deg = all.front().to_deg + 360;
    all.erase(all.begin());
  }
  return all;
}

}  // namespace bentaxis::hydraulics
