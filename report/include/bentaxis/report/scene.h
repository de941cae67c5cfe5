// The pump in space as the page's 3-D view draws it: bodies with their shapes and how they move,
// and the forces on them. The view knows no physics: every place and every vector is a sum of fixed
// axes times numbers, and numbers are constants, channels of the curves, or series of the scene.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bentaxis/report/curves.h"
#include "bentaxis/results/body_loads.h"

namespace bentaxis::report {

using Point = std::array<double, 3>;  ///< m or N, in S1 unless a body's frame is named

/// constant + factor * (a channel of the curves | a series of the scene), at a row. The channel
/// is that of the model whose load is shown; of how bodies stand, the first model's.
struct Scalar {
  double constant = 0;
  double factor = 0;
  std::string channel =
      {};  ///< column of the model's table, in its own unit; "theta_deg": the axis
  std::optional<std::size_t> series = std::nullopt;  ///< index into Scene::series, instead
};

/// A sum of terms, each a fixed axis times a number. Without terms: the model has no such load.
struct Vector {
  struct Term {
    Point axis;
    Scalar by;
  };
  std::vector<Term> terms;
};

/// A point in a body's coordinates.
struct Place {
  std::string body;  ///< name of a body of the scene, or "": S1
  Vector at;         ///< m
};

// ---- Shapes, in the coordinates of their body, m

/// A profile of (r, z), turned about the body's z axis.
struct Lathe {
  std::vector<std::array<double, 2>> profile;
};
/// A polygon of (x, y) with holes, from z_low to z_high.
struct Prism {
  std::vector<std::array<double, 2>> outline;
  std::vector<std::vector<std::array<double, 2>>> holes;
  double z_low = 0, z_high = 0;
};
struct Ball {
  Point centre;
  double radius = 0;
};
/// Triangles, seen from where their corners go round counter-clockwise.
struct Mesh {
  std::vector<Point> points;
  std::vector<std::array<std::size_t, 3>> triangles;
};
/// A line.
struct Wire {
  std::vector<Point> points;
  bool closed = false;
};

enum class Look { shaft, piston, block, plate, delivery, suction, gear, bearing, pin, axis };

struct Shape {
  std::variant<Lathe, Prism, Ball, Mesh, Wire> form;
  Look look = Look::shaft;
  bool see_through = false;
  /// Colours it from that of rest to that of full pressure as the number goes from 0 to 1.
  std::optional<Scalar> tint = std::nullopt;
};

// ---- Bodies

/// Stands where its frame stands.
struct Standing {};
/// Turns about the z axis of its frame.
struct Turning {
  Scalar angle;  ///< rad
};
/// Its origin at `from`, its z axis towards `to`; the frame given is not used.
struct Between {
  Place from, to;
};

struct SceneBody {
  std::string name;  ///< as BodyLoad::on; "plate", "housing" for what stands
  Point origin = {};
  std::array<Point, 3> axes = {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};  ///< x, y, z in S1
  std::variant<Standing, Turning, Between> motion;
  std::vector<Shape> shapes;
};

// ---- Forces

struct SceneLoad {
  std::string id;     ///< "Rs_1"; of what acts on the other body: "Rs_1.shaft"
  std::string label;  ///< "Rs on piston 1"
  std::string group;  ///< shown, hidden and scaled together: "Rs", "oil", "inertia"
  ForceKind kind = ForceKind::reaction;
  std::string on, by, point;
  std::string frame;              ///< in which its components are read out: "S2", or "": S1
  std::vector<std::string> axes;  ///< names of the components in that frame, "x2", ..
  std::vector<Place> at;          ///< one per model
  std::vector<Vector> force;      ///< N, in S1, likewise; empty: a moment alone
  std::vector<Vector> moment;     ///< Nm, likewise; empty: none
  /// The opposite of a load of another body: shown in the free-body diagram of its own alone.
  bool counterpart = false;
};

/// What the program found for the sum of all loads on a body, over all rows, in full precision.
struct SceneSum {
  std::string body;
  std::vector<double> force_over_sum, moment_over_sum;  ///< largest, one per model
};

struct Scene {
  BENTAXIS_COMPILED_ONCE(Scene);

  std::vector<std::string> models;              ///< names of the curves' tables
  std::size_t rows = 0;                         ///< of the curves and of every series
  std::optional<Curves> curves = std::nullopt;  ///< instead of the page's
  std::vector<Values> series;                   ///< one value per row; the page has them as floats
  std::vector<SceneBody> bodies;
  std::vector<SceneLoad> loads;
  std::vector<SceneSum> sums;
  /// Frames in which components are read out: name, axes in S1.
  std::vector<std::pair<std::string, std::array<Point, 3>>> frames;
  Point centre = {};  ///< of what there is to see
  double radius = 0;  ///< m
  /// Fh's point on the plate: in this body's coordinates, with the plate's outlines as wires.
  std::optional<Place> film_point = std::nullopt;
  /// Its path by the first model in the plate's x and y, m, closer than the rows are: pieces
  /// between jumps. Empty: the path is that of the rows.
  std::vector<std::vector<std::array<double, 2>>> film_path = {};
  std::string note = {};  ///< what is not to scale, or left out
};

/// For the page's block "scene" (docs/report_json.md): series as base64 of little-endian 32-bit
/// floats, what was not computed as NaN.
std::string compact_json(const Scene& scene);

}  // namespace bentaxis::report
