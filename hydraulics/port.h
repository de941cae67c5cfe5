// How far a block kidney is open to a port of the plate.
#pragma once

#include <variant>
#include <vector>

#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/periodic_cubic.h"

namespace bentaxis::hydraulics {

/// Opening between the kidney of a chamber and one port, over the chamber's own angle: the sum of
/// its parts. The kidney is centred on the bore axis, so that its edges stand at theta -+ width/2;
/// degrees are lengths on the bore circle. Parts:
///
/// - the overlap of kidney and port arc. KidneyEnds::rounded: a length x the kidney's height, which
///   grows as the square over the first `kidney_rounding_deg`. KidneyEnds::circular: the exact
///   common area of two slots with semicircular ends;
/// - notches before and behind the port: root area x (share of the length)^m, m = 1 or 2, from
///   where an edge of the kidney meets the notch to where the other one has passed it;
/// - a relief groove in the bridge: the smaller of cross-section and mouth under the kidney;
/// - holes in the bridge: the exact area of them under the kidney, whose ends are straight or
///   circular;
///
/// or instead of all that a table: the monotone cubic through its points (Fritsch and Butland, SIAM
/// J. Sci. Stat. Comput. 5 (1984) 300-304), so that it is nowhere negative and its slope does not
/// jump.
class PortOpening {
 public:
  /// Of a part: for columns and for readers.
  struct PartName {
    const char *key, *name;
  };

  PortOpening(const HydraulicData& data, const PlatePort& port, double bore_circle_radius);

  /// Area, m2, at the chamber's angle, degrees (any real number). Continuous.
  double area(double theta_deg) const;

  /// The parts that it has, and the area of one of them, which it adds.
  std::size_t parts() const { return parts_.size(); }
  const PartName& part(std::size_t i) const { return names_[i]; }
  double part_area(std::size_t i, double theta_deg) const;

  /// Chamber angles in [0, 360) where the slope of the area jumps, where the port opens or closes,
  /// and both ends of every piece of a table over which the slope changes appreciably, in rising
  /// order.
  const std::vector<double>& edges_deg() const { return edges_deg_; }

 private:
  // A interval of the plate that the kidney passes. `past` is the angle of the kidney's leading
  // edge in the turn that begins at `first`, which is before the interval.
  class Frame {
   public:
    Frame(double first_deg, double half_width_deg) : first_(first_deg), half_(half_width_deg) {}
    double past(double theta_deg) const;
    double trailing(double past) const { return past - 2 * half_; }
    double half() const { return half_; }
    bool operator==(const Frame& other) const = default;

   private:
    double first_, half_;
  };

  struct Overlap {
    Frame frame;
    double from, to, rounding;  // degrees
    double length, height;      // m per degree, m
    double area_per_degree;
    bool circular;
    double area(double past) const;
  };
  struct Wedge {  // notch; root at `from` or, behind the port, at `to`
    Frame frame;
    double from, length, root_area;
    bool quadratic, trailing;
    double passed(double length_deg) const;
    double area(double leading) const;
  };
  struct Groove {
    Frame frame;
    double from, to, mouth_per_degree, cross_section;
    double area(double past) const;
  };
  struct Hole {
    Frame frame;
    double centre, radius, length;  // degrees, m, m per degree
    double end_radius;              // of the kidney, m; 0: straight
    double area(double past) const;
  };
  struct Table {
    double start;
    PeriodicCubic curve;  // over the angle past the first point
    double area(double theta_deg) const;
  };
  // Areas of all but a table are functions of where the leading edge is in the part's frame.
  using Part = std::variant<Overlap, Wedge, Groove, Hole, Table>;

  // Where the kidney is in a frame: most parts of a port have the same.
  struct Place {
    const Frame* frame = nullptr;
    double past = 0;
  };
  static double area_of(const Part& part, double theta_deg, Place& place);

  // length: m per degree on the bore circle
  void add_geometry(const HydraulicData& data, const PlatePort& port, double length);
  void add_table(const OpeningTable& table);
  void add_edge(double theta_deg);
  void add(const PartName& name, Part part);

  std::vector<Part> parts_;
  std::vector<PartName> names_;
  std::vector<double> edges_deg_;
};

/// A interval of chamber angles in which both ports are closed, or both are open.
struct Bridge {
  double from_deg = 0, to_deg = 0;  ///< from in [0, 360), from < to
  bool both_open = false;           ///< negative overlap
};

/// All of them over the turn, in rising order of `from_deg`. One over the whole turn: [0, 360].
std::vector<Bridge> bridges(const PortOpening& suction, const PortOpening& delivery);

/// Common area of two circles of radii R and r <= R that overlap by the length u on the line of
/// their centres, u in [0, 2r].
double common_area(double radius, double smaller, double overlap);
/// Part of a circle cut off by a chord at the distance u, in [0, 2r], from its edge.
double segment_area(double radius, double overlap);

}  // namespace bentaxis::hydraulics
