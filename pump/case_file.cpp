#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Allowed values of a number, with the text an engineer sees when it is left.
struct Range {
  double low = -kInfinity, high = kInfinity;
  bool low_open = false, high_open = false;

  bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
  std::string text() const {
    if (low == -kInfinity && high == kInfinity) return "a finite number";
    if (high == kInfinity) return (low_open ? "> " : ">= ") + number_text(low);
    return "in " + std::string(low_open ? "(" : "[") + number_text(low) + ", " + number_text(high) +
           (high_open ? ")" : "]");
  }
};
constexpr Range kAny{};
constexpr Range kPositive{0, kInfinity, true};
constexpr Range kNotNegative{0, kInfinity};

// A computed number for a message, to six digits.
std::string short_text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string quoted(const toml::node& node) {
  std::ostringstream out;
  out << toml::default_formatter(node, toml::format_flags::none);
  std::string text = out.str();
  if (const auto newline = text.find('\n'); newline != std::string::npos) text.resize(newline);
  return text;
}

// Number of single-character edits between two words: to suggest the key that was meant.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

// One table of the file. Remembers which keys were asked for, so that the rest are errors.
class TableReader {
 public:
  TableReader(std::string file, std::string name, const toml::table* table, int line,
              std::vector<CaseEntry>& entries)
      : file_(std::move(file)),
        name_(std::move(name)),
        table_(table),
        line_(line),
        entries_(entries) {}

  bool has(const std::string& key) {
    known_.insert(key);
    return table_ != nullptr && table_->contains(key);
  }

  double number(const std::string& key, Range range, std::optional<double> fallback = {}) {
    const toml::node* node = find(key, range.text(), fallback.has_value());
    if (node == nullptr) return defaulted(key, *fallback);
    return number_of(*node, key, range);
  }

  int integer(const std::string& key, int low, int high, std::optional<int> fallback = {}) {
    const Range range{static_cast<double>(low), static_cast<double>(high)};
    const std::string wanted =
        "an integer " +
        (high == std::numeric_limits<int>::max() ? ">= " + number_text(low) : range.text());
    const toml::node* node = find(key, wanted, fallback.has_value());
    if (node == nullptr) return static_cast<int>(defaulted(key, *fallback));
    if (!node->is_integer()) fail(*node, key, "must be " + wanted);
    const auto value = node->as_integer()->get();
    if (value < low || value > high) fail(*node, key, "must be " + wanted);
    record(key, quoted(*node));
    return static_cast<int>(value);
  }

  std::string text(const std::string& key, std::optional<std::string> fallback = {}) {
    const toml::node* node = find(key, "a text", fallback.has_value());
    if (node == nullptr) {
      record(key, *fallback, true);
      return *fallback;
    }
    if (!node->is_string()) fail(*node, key, "must be a text in quotes");
    record(key, node->as_string()->get());
    return node->as_string()->get();
  }

  bool flag(const std::string& key, bool fallback) {
    const toml::node* node = find(key, "true or false", true);
    if (node == nullptr) return fallback;
    if (!node->is_boolean()) fail(*node, key, "must be true or false");
    record(key, quoted(*node));
    return node->as_boolean()->get();
  }

  // One of a few words; returns its index.
  std::size_t choice(const std::string& key, const std::vector<std::string>& words,
                     std::optional<std::size_t> fallback = {}) {
    std::string wanted;
    for (const auto& word : words) wanted += (wanted.empty() ? "\"" : " or \"") + word + "\"";
    const toml::node* node = find(key, wanted, fallback.has_value());
    if (node == nullptr) {
      record(key, words[*fallback], true);
      return *fallback;
    }
    const auto* value = node->as_string();
    const auto it = value == nullptr ? words.end() : std::find(words.begin(), words.end(), **value);
    if (it == words.end()) fail(*node, key, "must be " + wanted);
    record(key, **value);
    return static_cast<std::size_t>(it - words.begin());
  }

  std::pair<double, double> pair(const std::string& key, Range range) {
    const toml::node* node = find(key, "a pair of numbers [a, b]", false);
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != 2)
      fail(*node, key, "must be a pair of numbers [a, b]");
    const std::pair<double, double> values{number_of((*array)[0], key, range, false),
                                           number_of((*array)[1], key, range, false)};
    record(key, quoted(*node));
    return values;
  }

  // Every key that is there must have been asked for.
  void finish() const {
    if (table_ == nullptr) return;
    for (const auto& [key, node] : *table_) {
      const std::string word(key.str());
      if (known_.count(word) > 0) continue;
      const bool is_table = node.is_table();
      std::string message =
          is_table && name_.empty()
              ? "unknown table [" + word + "]"
              : "unknown key \"" + word + "\"" + (name_.empty() ? "" : " in [" + name_ + "]");
      const auto nearest =
          std::min_element(known_.begin(), known_.end(), [&](const auto& a, const auto& b) {
            return edit_distance(word, a) < edit_distance(word, b);
          });
      if (nearest != known_.end() && edit_distance(word, *nearest) <= 3)
        message += "; did you mean \"" + *nearest + "\"?";
      else if (!known_.empty())
        message += "; allowed: " + list_of_keys();
      throw InputError(
          place(node.source().begin.line > 0 ? static_cast<int>(node.source().begin.line) : line_) +
          message);
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& why) const {
    const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
    if (node != nullptr) fail(*node, key, why);
    throw InputError(place(line_) + label(key) + ": " + why);
  }

  // A key of the table that was probably meant to be `key`.
  std::string misspelt(const std::string& key) const {
    if (table_ == nullptr) return "";
    for (const auto& [found, node] : *table_) {
      const std::string word(found.str());
      if (known_.count(word) == 0 && edit_distance(word, key) <= 3)
        return "; is \"" + word + "\" in line " + std::to_string(node.source().begin.line) +
               " meant?";
    }
    return "";
  }

 private:
  std::string place(int line) const {
    return file_ + (line > 0 ? ":" + std::to_string(line) : "") + ": ";
  }
  std::string label(const std::string& key) const {
    return (name_.empty() ? "" : "[" + name_ + "] ") + key;
  }
  std::string list_of_keys() const {
    std::string keys;
    for (const auto& key : known_) keys += (keys.empty() ? "" : ", ") + key;
    return keys;
  }
  [[noreturn]] void fail(const toml::node& node, const std::string& key,
                         const std::string& why) const {
    throw InputError(place(static_cast<int>(node.source().begin.line)) + label(key) + " = " +
                     quoted(node) + ": " + why);
  }

  const toml::node* find(const std::string& key, const std::string& wanted, bool optional) {
    known_.insert(key);
    const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
    if (node == nullptr && !optional)
      throw InputError(place(line_) + label(key) + " is missing: must be " + wanted +
                       misspelt(key));
    return node;
  }

  double number_of(const toml::node& node, const std::string& key, Range range,
                   bool recorded = true) {
    double value = 0;
    if (node.is_integer()) {
      value = static_cast<double>(node.as_integer()->get());
    } else if (node.is_floating_point()) {
      value = node.as_floating_point()->get();
    } else {
      fail(node, key, "must be a number, " + range.text());
    }
    if (!std::isfinite(value)) fail(node, key, "must be a finite number, " + range.text());
    if (!range.contains(value)) fail(node, key, "must be " + range.text());
    if (recorded) record(key, quoted(node));
    return value;
  }

  double defaulted(const std::string& key, double value) {
    record(key, number_text(value), true);
    return value;
  }
  void record(const std::string& key, std::string value, bool by_default = false) {
    entries_.push_back({name_, key, std::move(value), by_default});
  }

  std::string file_, name_;
  const toml::table* table_;
  int line_;
  std::vector<CaseEntry>& entries_;
  std::set<std::string> known_;
};

class CaseReader {
 public:
  CaseReader(const toml::table& root, const std::filesystem::path& file)
      : root_(root), file_(file.string()) {
    result_.file = file;
  }

  Case read() {
    TableReader top(file_, "", &root_, 0, result_.entries);
    top.integer("schema", 1, 1);
    result_.name = top.text("name");
    // Reading in the order of the schema keeps the first error the one nearest to the top.
    read_pump(table(top, "pump"));
    read_gear(table(top, "gear"));
    read_bearings(table(top, "bearings"));
    read_piston(table(top, "piston"));
    read_shaft(table(top, "shaft"));
    read_block(table(top, "block"));
    read_friction(table(top, "friction", false));
    read_operation(table(top, "operation"));
    read_pressure(table(top, "pressure"));
    if (top.has("port_plate")) read_port_plate(table(top, "port_plate"));
    if (result_.pressure.kind == PressureKind::hydraulic || top.has("hydraulics"))
      read_hydraulics(table(top, "hydraulics"));
    read_assumptions(top);
    top.finish();
    return std::move(result_);
  }

 private:
  TableReader table(TableReader& parent, const std::string& key, bool required = true) {
    if (!parent.has(key)) {
      if (required)
        throw InputError(file_ + ": table [" + key + "] is missing" + parent.misspelt(key));
      return {file_, key, nullptr, 0, result_.entries};
    }
    return section(root_.get(key), key);
  }
  TableReader section(const toml::node* node, const std::string& name) {
    const auto line = static_cast<int>(node->source().begin.line);
    if (!node->is_table())
      throw InputError(file_ + ":" + std::to_string(line) + ": " + name + " = " + quoted(*node) +
                       ": must be a table [" + name + "]");
    return {file_, name, node->as_table(), line, result_.entries};
  }

  void read_pump(TableReader in) {
    Geometry& g = result_.pump.geometry;
    in.choice("type", {"bent_axis_bevel"}, 0);
    g.pistons = in.integer("pistons", 1, 99);
    g.tilt = radians(in.number("tilt_deg", {0, 90, false, true}));
    g.joint_circle_radius = metres(in.number("joint_circle_radius_mm", kPositive));
    g.bore_circle_radius = metres(in.number("bore_circle_radius_mm", kPositive));
    g.axis_offset = metres(in.number("axis_offset_mm", kAny));
    g.piston_length = metres(in.number("piston_length_mm", kPositive));
    g.bore_diameter = metres(in.number("bore_diameter_mm", kPositive));
    in.finish();
    const AssemblyMargin margin = assembly_margin(g);
    if (!(g.piston_length > margin.longest_distance))
      in.fail("piston_length_mm",
              "must be > " + short_text(margin.longest_distance * 1e3) +
                  ": the pump cannot be assembled at theta = " + short_text(margin.theta_deg) +
                  " deg, where " + short_text((margin.longest_distance - g.piston_length) * 1e3) +
                  " mm are missing (set by joint_circle_radius_mm, bore_circle_radius_mm, "
                  "axis_offset_mm, tilt_deg)");
  }

  void read_gear(TableReader in) {
    result_.pump.gear.pitch_diameter = metres(in.number("pitch_diameter_mm", kPositive));
    result_.pump.gear.pressure_angle = radians(in.number("pressure_angle_deg", {0, 60}));
    in.finish();
  }

  void read_bearings(TableReader in) {
    Bearings& bearings = result_.pump.bearings;
    bearings.tapered_z = metres(in.number("tapered_z_mm", kAny));
    bearings.cylindrical_z = metres(in.number("cylindrical_z_mm", kAny));
    if (bearings.tapered_z == bearings.cylindrical_z)
      in.fail("cylindrical_z_mm", "must differ from tapered_z_mm");
    in.finish();
  }

  void read_piston(TableReader in) {
    PistonMass& piston = result_.pump.piston;
    piston.inertia = static_cast<PistonInertia>(in.choice("inertia", piston_inertia_names()));
    const bool real = piston.inertia != PistonInertia::lumped;
    piston.mass = in.number("mass_kg", kNotNegative);
    piston.joint_mass_fraction = in.number("joint_mass_fraction", {0, 1}, 0.5);
    // Data of the real piston may stand in a lumped case; they are read where they are complete.
    const std::vector<std::string> needed = {"centre_of_mass_mm", "transverse_inertia_kg_mm2",
                                             "axial_inertia_kg_mm2"};
    const auto present = std::count_if(needed.begin(), needed.end(),
                                       [&](const std::string& key) { return in.has(key); });
    const bool complete = present == static_cast<std::ptrdiff_t>(needed.size());
    if (real || complete) {
      PistonMass::Real data;
      data.centre_of_mass = metres(in.number("centre_of_mass_mm", kAny));
      const double transverse = in.number("transverse_inertia_kg_mm2", kNotNegative);
      data.transverse_inertia = square_metres(transverse);
      data.axial_inertia = square_metres(in.number("axial_inertia_kg_mm2", {0, 2 * transverse}));
      data.spin = rad_per_second(in.number("spin_rpm", kAny, 0.0));
      piston.real = data;
    } else {
      for (const auto& key : needed)
        if (in.has(key)) in.number(key, key == needed[0] ? kAny : kNotNegative);
      in.number("spin_rpm", kAny, 0.0);
    }
    in.finish();
    if (const std::string why = piston_inertia_refusal(piston.inertia, result_.pump); !why.empty())
      in.fail("inertia", why);
  }

  void read_shaft(TableReader in) {
    Shaft& shaft = result_.pump.shaft;
    shaft.mass = in.number("mass_kg", kNotNegative);
    shaft.centre_of_mass_z = metres(in.number("centre_of_mass_z_mm", kAny));
    shaft.axial_inertia = square_metres(in.number("axial_inertia_kg_mm2", kNotNegative, 2000.0));
    in.finish();
  }

  void read_block(TableReader in) {
    Block& block = result_.pump.block;
    block.mass = in.number("mass_kg", kNotNegative);
    block.centre_of_mass_z = metres(in.number("centre_of_mass_z_mm", kAny));
    block.pin_z = metres(in.number("pin_z_mm", kAny));
    block.bottom_area = square_metres(in.number("bottom_area_mm2", kNotNegative, 0.0));
    block.spring_force = in.number("spring_force_N", kNotNegative, 0.0);
    block.axial_inertia = square_metres(in.number("axial_inertia_kg_mm2", kNotNegative, 1500.0));
    in.finish();
  }

  void read_friction(TableReader in) {
    Friction& friction = result_.pump.friction;
    friction.piston_coulomb = in.number("piston_coulomb_N", kNotNegative, 0.0);
    friction.piston_viscous = in.number("piston_viscous_N_s_per_m", kNotNegative, 0.0);
    friction.regularization = in.number("regularization_m_per_s", kNotNegative, 0.01);
    friction.block_viscous =
        in.number("block_viscous_Nm_per_rpm", kNotNegative, 0.0) / kRadPerSecondPerRpm;
    friction.shaft_viscous =
        in.number("shaft_viscous_Nm_per_rpm", kNotNegative, 0.0) / kRadPerSecondPerRpm;
    friction.shaft_torque_factor = in.number("shaft_torque_factor", {0, 1, true}, 1.0);
    in.finish();
  }

  void read_operation(TableReader in) {
    constexpr int kMost = std::numeric_limits<int>::max();
    result_.operation.speed_rpm = in.number("speed_rpm", kAny);
    result_.pump.gravity = in.number("gravity_m_per_s2", kAny, 9.80665);
    result_.operation.revolutions = in.integer("revolutions", 1, kMost, 1);
    result_.operation.samples_per_revolution = in.integer("samples_per_revolution", 1, kMost, 720);
    in.finish();
  }

  void read_pressure(TableReader in) {
    PressureSpec& pressure = result_.pressure;
    pressure.kind =
        std::array{PressureKind::ideal, PressureKind::curve,
                   PressureKind::hydraulic}[in.choice("kind", {"ideal", "curve", "hydraulic"})];
    const bool curve = pressure.kind == PressureKind::curve;
    const bool hydraulic = pressure.kind == PressureKind::hydraulic;
    pressure.ports.suction = pascals(in.number("suction_bar", kAny));
    pressure.ports.delivery =
        pascals(in.number("delivery_bar", hydraulic ? Range{0, 10000} : kAny));
    // Keys of the other kinds may be present and are then unused.
    if (hydraulic || in.has("points")) pressure.points = in.integer("points", 16, 100000, 800);
    const bool ideal = pressure.kind == PressureKind::ideal;
    const std::optional<double> unused = ideal ? std::nullopt : std::optional<double>(0.0);
    pressure.transition_deg = in.number("transition_deg", {0, 180}, unused);
    pressure.delivery_start_deg = in.number("delivery_start_deg", kAny, 180.0);
    if (curve) {
      pressure.file = std::filesystem::path(file_).parent_path() / in.text("file");
      if (!std::filesystem::exists(pressure.file))
        in.fail("file", "no such file: " + pressure.file.string());
      if (std::filesystem::is_directory(pressure.file))
        in.fail("file", "is a folder: " + pressure.file.string());
      pressure.curve = read_pressure_curve(pressure.file);
      PressureTrace{pressure};  // refuses a curve that cannot be a periodic spline
    } else if (in.has("file")) {
      in.text("file");
    }
    in.finish();
  }

  void read_port_plate(TableReader in) {
    PortPlate plate;
    const auto [r1, r2] = in.pair("inner_land_mm", kNotNegative);
    const auto [r3, r4] = in.pair("outer_land_mm", kNotNegative);
    if (!(r1 < r2)) in.fail("inner_land_mm", "must be [r1, r2] with 0 <= r1 < r2");
    if (!(r2 < r3 && r3 < r4)) in.fail("outer_land_mm", "must be [r3, r4] with r2 < r3 < r4");
    plate.r1 = metres(r1);
    plate.r2 = metres(r2);
    plate.r3 = metres(r3);
    plate.r4 = metres(r4);
    const auto arc = [&](const std::string& key) {
      const auto [from, to] = in.pair(key, kAny);
      if (!(from < to && to <= from + 360))
        in.fail(key, "must be [from, to] with from < to <= from + 360");
      return PortArc{from, to};
    };
    plate.delivery = arc("delivery_arc_deg");
    plate.suction = arc("suction_arc_deg");
    in.finish();
    result_.pump.port_plate = plate;
  }

  // After [port_plate], whose arcs and lands are the defaults of the ports here.
  void read_hydraulics(TableReader in) {
    HydraulicData data;
    const auto& plate = result_.pump.port_plate;
    data.density = in.number("density_kg_per_m3", {100, 5000}, 850.0);
    data.bulk_modulus = in.number("bulk_modulus_MPa", {10, 1e9}, 1400.0) * 1e6;
    data.air_share = in.number("air_percent", {0, 50, true}, 0.5) / 100;
    data.air_exponent = in.number("air_exponent", {1, 1.67}, 1.4);
    data.atmosphere = pascals(in.number("atmosphere_bar", {0.1, 10}, 1.01325));
    const auto port = [&](const std::string& name, std::optional<PortArc> arc) {
      PlatePort result;
      const std::string key = name + "_arc_deg";
      if (in.has(key) || !arc) {
        const auto [from, to] = in.pair(key, kAny);
        if (!(from < to && to <= from + 360))
          in.fail(key, "must be [from, to] with from < to <= from + 360");
        arc = PortArc{from, to};
      }
      result.arc = *arc;
      result.notch.length_deg = in.number(name + "_notch_deg", {0, 90}, 0.0);
      result.notch.area = square_metres(in.number(name + "_notch_area_mm2", kNotNegative, 0.0));
      return result;
    };
    data.delivery = port("delivery", plate ? std::optional(plate->delivery) : std::nullopt);
    data.suction = port("suction", plate ? std::optional(plate->suction) : std::nullopt);
    data.kidney_width_deg = in.number("kidney_width_deg", {0, 180, true});
    data.kidney_height =
        metres(in.number("kidney_height_mm", kPositive,
                         plate ? std::optional((plate->r3 - plate->r2) * 1e3) : std::nullopt));
    data.kidney_rounding_deg = in.number("kidney_rounding_deg", {0, data.kidney_width_deg},
                                         std::min(5.0, data.kidney_width_deg));
    data.notch_law = in.choice("notch_law", {"quadratic", "linear"}, 0) == 0 ? NotchLaw::quadratic
                                                                             : NotchLaw::linear;
    for (const auto& [name, side] :
         {std::pair{"delivery", &data.delivery}, std::pair{"suction", &data.suction}})
      if (side->arc.to_deg - side->arc.from_deg + side->notch.length_deg + data.kidney_width_deg >
          360)
        in.fail("kidney_width_deg",
                std::string("with the ") + name + " port's arc and notch must not exceed 360 deg");
    data.discharge_coefficient = in.number("discharge_coefficient", {0, 2, true}, 0.67);
    data.transition_pressure = pascals(in.number("transition_pressure_bar", kPositive, 0.1));
    // 1 l/min = 1e-3/60 m3/s
    data.leakage =
        in.number("leakage_l_per_min_per_bar", kNotNegative, 0.002) / 6e4 / kPascalPerBar;
    const Range absolute{-data.atmosphere / kPascalPerBar, kInfinity, true};
    data.case_pressure = pascals(in.number("case_bar", absolute, 0.0));
    data.dead_volume = in.number("dead_volume_cm3", kPositive, 3.0) / 1e6;
    data.delivery_volume = in.number("delivery_volume_l", kPositive, 0.5) / 1e3;
    data.tolerance = in.number("tolerance", {1e-12, 1e-4}, 1e-10);
    in.finish();
    if (result_.pressure.kind != PressureKind::hydraulic) return;  // present and unused
    if (!absolute.contains(result_.pressure.ports.suction / kPascalPerBar))
      in.fail("atmosphere_bar",
              "must exceed -suction_bar of [pressure]: no absolute pressure is "
              "below zero");
    result_.hydraulics = data;
  }

  // [assumptions.analytic] and [assumptions.multibody]: what a model leaves out or does otherwise.
  void read_assumptions(TableReader& top) {
    const auto fallback = Assumptions{true, result_.pump.piston.inertia, GearScene::mesh};
    result_.analytic = result_.multibody = fallback;
    if (!top.has("assumptions")) return;
    TableReader both = section(root_.get("assumptions"), "assumptions");
    const toml::table& models = *root_.get_as<toml::table>("assumptions");
    for (auto [name, target] :
         {std::pair{"analytic", &result_.analytic}, std::pair{"multibody", &result_.multibody}}) {
      if (!both.has(name)) continue;
      TableReader in = section(models.get(name), std::string("assumptions.") + name);
      target->piston_friction = in.flag("piston_friction", true);
      target->inertia = static_cast<PistonInertia>(
          in.choice("inertia", piston_inertia_names(), static_cast<std::size_t>(fallback.inertia)));
      target->gear =
          in.choice("gear", {"mesh", "imposed"}, 0) == 1 ? GearScene::imposed : GearScene::mesh;
      if (const std::string why = piston_inertia_refusal(target->inertia, result_.pump);
          !why.empty())
        in.fail("inertia", why);
      in.finish();
    }
    both.finish();
  }

  const toml::table& root_;
  std::string file_;
  Case result_;
};

}  // namespace

Case parse_case(const std::string& text, const std::filesystem::path& file) {
  toml::table root;
  try {
    root = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw InputError(file.string() + ":" + std::to_string(error.source().begin.line) + ": " + what);
  }
  return CaseReader(root, file).read();
}

Case read_case(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    throw InputError(file.string() + ": is a folder, not a case file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": cannot be read: no such file, or no permission");
  std::ostringstream text;
  text << in.rdbuf();
  return parse_case(text.str(), file);
}

}  // namespace bentaxis
