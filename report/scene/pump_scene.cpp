#include "bentaxis/study/pump_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/report/document.h"
#include "bentaxis/results/channels.h"
#include "pump_shapes.h"

namespace bentaxis::study {
namespace {

using Eigen::Vector3d;
using report::Place;
using report::Scalar;
using Terms = report::Vector;

// Of the largest of a run: so far may rows be from what is said of all of them at once.
constexpr double kSame = 1e-13;

Vector3d vector(const report::Point& p) { return {p[0], p[1], p[2]}; }
report::Point point(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Terms constant(const Vector3d& v) { return {{{point(v), {1}}}}; }

// The number at the end of a text, or 0.
int number_of(const std::string& text) {
  const std::size_t digits = text.find_last_not_of("0123456789") + 1;
  return digits < text.size() ? std::stoi(text.substr(digits)) : 0;
}

// Of a load that is said of both bodies, the one that its name is about.
int rank(const std::string& body) {
  return body.starts_with("piston") ? 0 : body == "block" ? 1 : 2;
}

class SceneMaker {
 public:
  SceneMaker(const Case& the_case, const std::vector<SceneRun>& runs)
      : p_(the_case.pump),
        g_(p_.geometry),
        outline_(p_),
        shapes_(pump_shapes(the_case, outline_)),
        runs_(runs),
        layout_(p_) {
    axes_["S1"] = {report::Point{1, 0, 0}, report::Point{0, 1, 0}, report::Point{0, 0, 1}};
    axes_["S2"] = {report::Point{1, 0, 0}, report::Point{0, outline_.cosine, -outline_.sine},
                   report::Point{0, outline_.sine, outline_.cosine}};
    if (outline_.has_gear) axes_["S4"] = tooth_axes(the_case.operation.speed_rpm < 0 ? -1 : 1);
  }

  report::Scene scene(const SceneMotion* motion) {
    for (const SceneRun& run : runs_) scene_.models.push_back(run.table.name);
    scene_.rows = runs_[0].table.rows();
    for (const auto& [frame, axes] : axes_) scene_.frames.emplace_back(frame, axes);
    add_bodies(motion);
    add_loads();
    scene_.note = shapes_.note;
    return std::move(scene_);
  }

 private:
  Vector3d o2() const { return {0, 0, g_.axis_offset}; }
  Vector3d turned(double x, double y, double z) const {  // from S2
    const auto& s2 = axes_.at("S2");
    return x * vector(s2[0]) + y * vector(s2[1]) + z * vector(s2[2]);
  }
  // S4 (21)-(23), (22) with one line of action.
  std::array<report::Point, 3> tooth_axes(double direction) const {
    const double radius = p_.gear.pitch_diameter / 2, half = std::tan(g_.tilt / 2);
    const Vector3d i4 = Vector3d(0, -radius, radius * half).normalized();
    const double across = std::sin(p_.gear.pressure_angle);
    const Vector3d k4 =
        direction * Vector3d(-std::cos(p_.gear.pressure_angle), across * std::sin(g_.tilt / 2),
                             across * std::cos(g_.tilt / 2));
    return {point(i4), point(k4.cross(i4)), point(k4)};
  }

  Scalar add_series(report::Values values) {
    // What stays is a number.
    if (std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); }))
      return {values.front()};
    // The opposite of a load has its numbers.
    const auto negative = [&](const report::Values& one) {
      return std::equal(one.begin(), one.end(), values.begin(),
                        [](double a, double b) { return a == -b; });
    };
    const auto& all = scene_.series;
    auto same = std::find(all.begin(), all.end(), values);
    Scalar scalar{0, 1};
    if (same == all.end()) {
      same = std::find_if(all.begin(), all.end(), negative);
      scalar.factor = same == all.end() ? 1 : -1;
    }
    scalar.series = static_cast<std::size_t>(same - all.begin());
    if (scalar.series == all.size()) scene_.series.push_back(std::move(values));
    return scalar;
  }
  Scalar channel(std::size_t column, double factor = 1) const {
    return {0, factor, layout_.channels()[column].name};
  }

  void add_bodies(const SceneMotion* motion);
  void add_pistons();
  void add_loads();
  report::SceneLoad described(const BodyLoad& load);
  Place place_of(const BodyLoad& load, const SceneRun& run, std::size_t index);
  Terms force_of(const BodyLoad& load, const SceneRun& run, std::size_t index, double sign);
  Terms moment_of(const BodyLoad& load, const SceneRun& run, std::size_t index, double sign);
  std::optional<Terms> by_channels(const std::string& symbol, int piston, double sign) const;
  std::optional<Terms> by_one_channel(std::size_t column, const report::Values* parts,
                                      const SceneRun& run) const;
  Terms by_series(const std::array<report::Values, 3>& parts);
  Terms along_axes(const std::array<report::Values, 3>& parts) {
    Terms terms;
    for (int i = 0; i < 3; ++i) {
      report::Point axis = {};
      axis[i] = 1;
      terms.terms.push_back({axis, add_series(parts[i])});
    }
    return terms;
  }
  // Components of a load over the rows.
  std::array<report::Values, 3> parts_of(const SceneRun& run, std::size_t index,
                                         report::Point BodyLoadTable::Row::*of) const {
    std::array<report::Values, 3> parts;
    for (std::size_t row = 0; row < scene_.rows; ++row)
      for (int i = 0; i < 3; ++i) parts[i].push_back((run.loads.at(row, index).*of)[i]);
    return parts;
  }
  Place film_point() const {
    return {"plate",
            {{{{1, 0, 0}, channel(layout_.xh(), 1e-3)}, {{0, 1, 0}, channel(layout_.yh(), 1e-3)}}}};
  }
  bool film_point_is_near() const;

  const PumpParameters& p_;
  const Geometry& g_;
  PumpOutline outline_;
  PumpShapes shapes_;
  const std::vector<SceneRun>& runs_;
  ChannelLayout layout_;
  std::map<std::string, std::array<report::Point, 3>> axes_;
  bool at_film_point_ = false;
  report::Scene scene_;
};

// ---- Bodies

void SceneMaker::add_bodies(const SceneMotion* motion) {
  const auto turning = [&](const std::vector<double> SceneMotion::*of) {
    if (motion == nullptr) {
      if (of == &SceneMotion::block && layout_.has(Quantity::psi))
        return report::Turning{channel(layout_.psi(), kRadPerDegree)};
      return report::Turning{{0, kRadPerDegree, "theta_deg"}};
    }
    report::Values turn;
    for (const double angle : motion->*of) turn.push_back(std::remainder(angle, 2 * kPi));
    return report::Turning{add_series(std::move(turn))};
  };
  scene_.bodies.push_back({"shaft", {}, axes_["S1"], turning(&SceneMotion::shaft), shapes_.shaft});
  add_pistons();
  scene_.bodies.push_back(
      {"block", point(o2()), axes_["S2"], turning(&SceneMotion::block), shapes_.block});
  scene_.bodies.push_back({"plate", point(o2() + turned(0, 0, outline_.block_to)), axes_["S2"],
                           report::Standing{}, shapes_.plate});
  scene_.bodies.push_back({"housing", {}, axes_["S1"], report::Standing{}, shapes_.housing});

  // What there is to see: from the end of the shaft to behind the plate.
  const Vector3d from(0, 0, outline_.shaft_end);
  const Vector3d to = o2() + turned(0, 0, outline_.block_to + outline_.plate);
  scene_.centre = point((from + to) / 2);
  const double wide = std::max({outline_.flange_radius, outline_.block_radius,
                                outline_.is_far(outline_.gear_radius) ? 0 : outline_.gear_radius});
  scene_.radius = (to - from).norm() / 2 + wide / 2;
}

void SceneMaker::add_pistons() {
  const ResultTable& table = runs_[0].table;
  double least = 0, most = 0;
  for (int k = 0; k < g_.pistons; ++k)
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double p = table.at(row, layout_.pressure(k));
      least = k + row == 0 ? p : std::min(least, p);
      most = k + row == 0 ? p : std::max(most, p);
    }
  for (int k = 0; k < g_.pistons; ++k) {
    std::vector<report::Shape> shapes = shapes_.piston;
    if (most > least)
      for (report::Shape& shape : shapes) {
        shape.tint = channel(layout_.pressure(k), 1 / (most - least));
        shape.tint->constant = -least / (most - least);
      }
    const double phi = -2 * kPi * k / g_.pistons;
    const Vector3d a(-g_.joint_circle_radius * std::sin(phi),
                     g_.joint_circle_radius * std::cos(phi), 0);
    const Vector3d bore(-g_.bore_circle_radius * std::sin(phi),
                        g_.bore_circle_radius * std::cos(phi), 0);
    Terms b = constant(bore);
    b.terms.push_back({{0, 0, 1}, channel(layout_.zB(k), 1e-3)});
    scene_.bodies.push_back({"piston " + std::to_string(k + 1),
                             {},
                             axes_["S1"],
                             report::Between{{"shaft", constant(a)}, {"block", std::move(b)}},
                             std::move(shapes)});
  }
}

// ---- Loads

// Fh is shown where it acts, with no moment beside it, unless that is out of sight at some row.
bool SceneMaker::film_point_is_near() const {
  for (const SceneRun& run : runs_)
    for (std::size_t row = 0; row < run.table.rows(); ++row)
      for (const std::size_t column : {layout_.xh(), layout_.yh()}) {
        const double mm = run.table.at(row, column);
        if (!is_computed(mm) || !(std::abs(mm) * 1e-3 <= PumpOutline::kFar * outline_.size))
          return false;
      }
  return true;
}

Place SceneMaker::place_of(const BodyLoad& load, const SceneRun& run, std::size_t index) {
  const int number = number_of(load.point);
  if (number > 0 && number <= g_.pistons && !load.symbol.starts_with("Rcs")) {
    const std::string piston = "piston " + std::to_string(number);
    const auto found =
        std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                     [&](const report::SceneBody& body) { return body.name == piston; });
    const auto& between = std::get<report::Between>(found->motion);
    if (load.point == "A" + std::to_string(number)) return between.from;
    if (load.point == "B" + std::to_string(number)) return between.to;
    if (load.point == "D" + std::to_string(number))
      return {piston, constant({0, 0, p_.transfer.wall->from_joint})};
    if (load.point.starts_with("contact point"))
      return {piston, constant({0, 0, p_.piston.contact.value_or(g_.piston_length)})};
  }
  if (load.on.starts_with("piston") && load.point == "centre of mass")
    for (const BodyLoad& joint : run.loads.row(0))
      if (joint.on == load.on && joint.symbol == "Rs")
        return {load.on,
                constant({0, 0, (vector(run.loads.at(0, index).at) - vector(joint.at)).norm()})};
  if (load.symbol == "Fh" && at_film_point_) return film_point();
  Place place;
  place.at = along_axes(parts_of(run, index, &BodyLoadTable::Row::at));
  return place;
}

// Quantities of the rows that a load is, component by component.
std::optional<Terms> SceneMaker::by_channels(const std::string& symbol, int piston,
                                             double sign) const {
  Terms terms;
  for (const Channel& one : layout_.channels()) {
    if (one.quantity != symbol || one.piston != piston || one.kind == ChannelKind::check ||
        one.frame == "S3" || one.frame == "S4" || one.axis.empty())
      continue;
    const int i = one.axis[0] - 'x';
    terms.terms.push_back({axes_.at(one.frame)[i], {0, sign * one.unit_in_si, one.name}});
  }
  if (terms.terms.empty()) return std::nullopt;
  return terms;
}

// A fixed axis times a channel, where every row is that.
std::optional<Terms> SceneMaker::by_one_channel(std::size_t column, const report::Values* parts,
                                                const SceneRun& run) const {
  std::size_t largest = 0;
  const auto value = [&](std::size_t row) { return run.table.at(row, column); };
  for (std::size_t row = 0; row < scene_.rows; ++row) {
    if (!is_computed(value(row))) return std::nullopt;
    if (std::abs(value(row)) > std::abs(value(largest))) largest = row;
  }
  if (value(largest) == 0) return std::nullopt;
  const Vector3d whole(parts[0][largest], parts[1][largest], parts[2][largest]);
  const Vector3d axis = whole / value(largest);
  for (std::size_t row = 0; row < scene_.rows; ++row)
    if (!((Vector3d(parts[0][row], parts[1][row], parts[2][row]) - value(row) * axis).norm() <=
          kSame * whole.norm()))
      return std::nullopt;
  return Terms{{{point(axis), channel(column)}}};
}

// Along one fixed axis where it stays on it, or component by component.
Terms SceneMaker::by_series(const std::array<report::Values, 3>& parts) {
  const auto at = [&](std::size_t row) {
    return Vector3d(parts[0][row], parts[1][row], parts[2][row]);
  };
  std::size_t largest = 0;
  for (std::size_t row = 0; row < scene_.rows; ++row)
    if (at(row).norm() > at(largest).norm()) largest = row;
  const double most = at(largest).norm();
  if (most == 0) return constant(Vector3d::Zero());
  const Vector3d axis = at(largest) / most;
  report::Values along;
  bool straight = true;
  for (std::size_t row = 0; row < scene_.rows; ++row) {
    along.push_back(at(row).dot(axis));
    straight = straight && (at(row) - along.back() * axis).norm() <= kSame * most;
  }
  if (straight) return {{{point(axis), add_series(std::move(along))}}};
  return along_axes(parts);
}

Terms SceneMaker::force_of(const BodyLoad& load, const SceneRun& run, std::size_t index,
                           double sign) {
  const auto parts = parts_of(run, index, &BodyLoadTable::Row::force);
  const int piston = std::max(load.on.starts_with("piston") ? number_of(load.on) : 0,
                              load.by.starts_with("piston") ? number_of(load.by) : 0);
  if (load.kind == ForceKind::reaction)
    if (auto terms = by_channels(load.symbol, piston, sign)) return *terms;
  std::optional<std::size_t> column;
  if (load.symbol == "Rcs") column = layout_.Rcs();
  if (load.symbol == "Fp" || load.symbol == "Ftp")
    column = layout_.pressure(number_of(load.point) - 1);
  if (column)
    if (auto terms = by_one_channel(*column, parts.data(), run)) return *terms;
  return by_series(parts);
}

Terms SceneMaker::moment_of(const BodyLoad& load, const SceneRun& run, std::size_t index,
                            double sign) {
  if (load.kind == ForceKind::reaction)
    if (auto terms = by_channels(load.symbol, 0, sign)) return *terms;
  return by_series(parts_of(run, index, &BodyLoadTable::Row::moment));
}

std::string group_of(const BodyLoad& load) {
  if (load.kind == ForceKind::reaction) return load.symbol;
  if (load.kind == ForceKind::inertia) return "inertia";
  if (load.by == "oil") return "oil";
  if (load.by == "gravity") return "weight";
  return load.symbol == "Fm" ? "spring" : "friction";
}

report::SceneLoad SceneMaker::described(const BodyLoad& load) {
  report::SceneLoad shown;
  const std::string piston = load.on.starts_with("piston")   ? load.on
                             : load.by.starts_with("piston") ? load.by
                                                             : std::string();
  shown.counterpart = rank(load.by) < rank(load.on) && (!piston.empty() || load.by == "block");
  shown.id = load.symbol;
  const int number = !piston.empty() ? number_of(piston) : 0;
  if (number > 0)
    shown.id += "_" + std::to_string(number);
  else if (load.by == "oil" && load.symbol != "Fh")
    shown.id += "_" + (number_of(load.point) > 0 ? std::to_string(number_of(load.point))
                                                 : load.point.substr(0, load.point.find(' ')));
  else if (load.kind == ForceKind::inertia)
    shown.id += "_" + load.on;
  else if (load.point.starts_with("flank"))
    shown.id += "_" + load.point;
  if (shown.counterpart) shown.id += "." + load.on;
  shown.label = load.symbol + " on " + (load.on.starts_with("piston") ? "" : "the ") + load.on;
  shown.group = group_of(load);
  shown.kind = load.kind;
  shown.on = load.on;
  shown.by = load.by;
  shown.point = load.point;
  shown.frame = "S1";
  for (const Channel& one : layout_.channels())
    if (one.quantity == load.symbol && one.frame != "S3") shown.frame = one.frame;
  for (const char* symbol : {"Fp", "Fpf", "Ftp", "Fth", "Fm", "Tcf"})
    if (load.symbol == symbol) shown.frame = "S2";
  for (const char* letter : {"x", "y", "z"}) shown.axes.push_back(letter + shown.frame.substr(1));
  return shown;
}

void SceneMaker::add_loads() {
  at_film_point_ = film_point_is_near();
  scene_.film_point = film_point();
  // Loads of all models, each behind those before it where a model first has it.
  std::vector<BodyLoad> loads;
  for (const SceneRun& run : runs_) {
    auto next = loads.begin();
    for (const BodyLoad& load : run.loads.loads) {
      const auto same = std::find_if(loads.begin(), loads.end(),
                                     [&](const BodyLoad& one) { return same_load(one, load); });
      next = (same != loads.end() ? same : loads.insert(next, load)) + 1;
    }
  }
  for (const BodyLoad& load : loads) {
    if (load.symbol == "Th" && at_film_point_) continue;
    report::SceneLoad shown = described(load);
    bool forces = false, moments = false;
    for (const SceneRun& run : runs_) {
      const auto& list = run.loads.loads;
      const auto own = std::find_if(list.begin(), list.end(),
                                    [&](const BodyLoad& one) { return same_load(one, load); });
      if (own == list.end()) {
        shown.at.emplace_back();
        shown.force.emplace_back();
        shown.moment.emplace_back();
        continue;
      }
      const auto index = static_cast<std::size_t>(own - list.begin());
      for (std::size_t row = 0; row < scene_.rows; ++row) {
        const BodyLoadTable::Row& at = run.loads.at(row, index);
        forces = forces || at.force != report::Point{};
        moments = moments || at.moment != report::Point{};
      }
      shown.at.push_back(place_of(load, run, index));
      shown.force.push_back(force_of(load, run, index, shown.counterpart ? -1 : 1));
      shown.moment.push_back(moment_of(load, run, index, shown.counterpart ? -1 : 1));
    }
    // What is nothing at all rows of all models is no load.
    if (!forces && !moments) continue;
    if (!forces) shown.force.clear();
    if (!moments) shown.moment.clear();
    scene_.loads.push_back(std::move(shown));
  }
}

std::vector<report::SceneSum> sums_of(const std::vector<SceneRun>& runs) {
  std::vector<report::SceneSum> sums;
  for (const SceneRun& run : runs) {
    const std::vector<BodySum> worst = worst_sums(run.loads);
    for (std::size_t i = 0; i < worst.size(); ++i) {
      if (sums.size() <= i) sums.push_back({worst[i].body, {}, {}});
      sums[i].force_over_sum.push_back(worst[i].force_over_sum);
      sums[i].moment_over_sum.push_back(worst[i].moment_over_sum);
    }
  }
  return sums;
}

}  // namespace

namespace {

// Of what a scene names.
report::Curves curves_of(const std::vector<SceneRun>& runs, const SceneMotion* motion) {
  report::Curves curves;
  curves.theta_deg = motion != nullptr ? motion->time_ms : runs[0].table.theta_deg;
  if (motion != nullptr) curves.axis = "time (ms)";
  for (const SceneRun& run : runs) {
    report::Curves::Table columns{run.table.name, {}};
    for (const Channel& channel : run.table.channels)
      if (channel.kind != ChannelKind::check && channel.frame != "S3" && channel.quantity != "Tc")
        columns.columns.emplace_back(channel.name, report::values_of(run.table, channel.name));
    curves.tables.push_back(std::move(columns));
  }
  return curves;
}

std::vector<double> every(std::size_t step, const std::vector<double>& values) {
  std::vector<double> thin;
  for (std::size_t at = 0; at < values.size(); at += step) thin.push_back(values[at]);
  return thin;
}

// @param step  of the run's rows, a multiple of that of the table
BodyLoadTable every(std::size_t step, const BodyLoadTable& table) {
  BodyLoadTable thin;
  thin.loads = table.loads;
  thin.step = step;
  for (std::size_t row = 0; row < table.rows(); row += step / table.step)
    for (std::size_t load = 0; load < table.loads.size(); ++load)
      thin.values.push_back(table.at(row, load));
  return thin;
}

// Between neighbours of a path of continuous pressure lies a hundredth of it; more is a jump.
constexpr double kPathJump = 0.1;

/// Fh's point in the plate's x and y over one N-th of a turn, which all others repeat; else over
/// the whole turn.
std::vector<std::vector<std::array<double, 2>>> film_path(const PumpParameters& pump,
                                                          const ResultTable& table) {
  const std::size_t pitch =
      table.rows() /
      static_cast<std::size_t>(pump.transfer.repeats_every_pitch() ? pump.geometry.pistons : 1);
  const ChannelLayout layout(pump);
  std::vector<std::array<double, 2>> points;
  double reach = 0;
  for (std::size_t i = 0; i <= pitch; ++i) {
    const std::size_t row = i % table.rows();
    const double x = table.at(row, layout.xh()), y = table.at(row, layout.yh());
    if (!is_computed(x) || !is_computed(y)) return {};
    // To the nanometre: more cannot be seen, and the page is smaller.
    points.push_back({std::round(x * 1e6) * 1e-9, std::round(y * 1e6) * 1e-9});
    reach = std::max({reach, std::abs(x - table.at(0, layout.xh())) * 1e-3,
                      std::abs(y - table.at(0, layout.yh())) * 1e-3});
  }
  std::vector<std::vector<std::array<double, 2>>> pieces;
  for (const auto& point : points) {
    const bool joined =
        !pieces.empty() && std::hypot(point[0] - pieces.back().back()[0],
                                      point[1] - pieces.back().back()[1]) <= kPathJump * reach;
    if (!joined) pieces.emplace_back();
    pieces.back().push_back(point);
  }
  return pieces;
}

}  // namespace

report::Scene pump_scene(const Case& the_case, const std::vector<SceneRun>& runs,
                         const SceneMotion* motion, const ResultTable* path) {
  const std::size_t rows = runs.at(0).table.rows();
  for (const SceneRun& run : runs)
    if (run.table.rows() != rows || run.loads.run_rows() != rows)
      throw ComputationError("the pump in space: runs of different rows");
  std::vector<report::SceneSum> sums = sums_of(runs);
  const auto add_film_path = [&](report::Scene& scene) {
    if (path != nullptr) scene.film_path = film_path(the_case.pump, *path);
  };
  std::size_t step = (rows + kMaxSceneRows - 1) / kMaxSceneRows;
  for (const SceneRun& run : runs) step = std::lcm(step, run.loads.step);
  if (step <= 1) {
    report::Scene scene = SceneMaker(the_case, runs).scene(motion);
    scene.sums = std::move(sums);
    add_film_path(scene);
    return scene;
  }
  std::deque<std::pair<ResultTable, BodyLoadTable>> thin;
  std::vector<SceneRun> thinned;
  for (const SceneRun& run : runs) {
    thin.emplace_back(every_row(run.table, step), every(step, run.loads));
    thinned.push_back({thin.back().first, thin.back().second});
  }
  SceneMotion some;
  if (motion != nullptr)
    some = {every(step, motion->time_ms), every(step, motion->shaft), every(step, motion->block)};
  const SceneMotion* const of_some = motion != nullptr ? &some : nullptr;
  report::Scene scene = SceneMaker(the_case, thinned).scene(of_some);
  scene.curves = curves_of(thinned, of_some);
  scene.sums = std::move(sums);
  add_film_path(scene);
  scene.note += fmt::format(" Shown: one of {} rows.", step);
  return scene;
}

const ResultTable* film_path_of(const CaseDescription& description) {
  return description.film_path ? &*description.film_path : nullptr;
}

std::optional<report::Scene> scene_of(const CaseDescription& description) {
  if (!description.turn) return std::nullopt;
  const auto& [the_case, table, loads] = *description.turn;
  const std::vector<SceneRun> runs = {{table, loads}};
  report::Scene scene = pump_scene(the_case, runs, nullptr, film_path_of(description));
  if (!scene.curves) scene.curves = curves_of(runs, nullptr);
  return scene;
}

}  // namespace bentaxis::study
