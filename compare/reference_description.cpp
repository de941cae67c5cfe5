// The description of a reference: what it says, and the folder it stands in.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "bentaxis/compare/reference.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::compare {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDescriptionName = "description.toml";
// What lists the cases of a folder that are not references of their own: the hard cases.
constexpr const char* kCatalogueName = "catalogue.toml";

const std::vector<std::string> kKinds = {"high-precision", "published", "golden", "external"};
const std::vector<std::string> kFolders = {"high_precision", "published", "golden", ""};
const std::vector<std::string> kModels = {"analytic", "multibody"};

// Quantities of foreign columns, by the channels' unit of each.
const std::map<std::string, std::string>& families() {
  static const std::map<std::string, std::string> all = {
      {"Force", "N"}, {"Torque", "Nm"}, {"Length", "mm"}, {"Pressure", "bar"}};
  return all;
}

// Units a foreign column may have: the channel unit it is a multiple of, and its SI value.
const std::map<std::string, ForeignUnit>& units() {
  static const std::map<std::string, ForeignUnit> all = [] {
    std::map<std::string, ForeignUnit> made;
    for (const UnitOfMeasure& unit : units_of_measure())
      if (const auto family = families().find(unit.quantity); family != families().end())
        made[unit.name] = {family->second, unit.factor};
    return made;
  }();
  return all;
}

// SI value of a unit of this quantity; 0 where it is none of it.
double size_of(const std::string& unit, const char* quantity) {
  const UnitOfMeasure* const found = find_unit_of_measure(unit);
  return found != nullptr && found->quantity == quantity ? found->factor : 0;
}

// Sign and any further factor.
double read_factor(TableReader& in) {
  const int sign = in.integer("sign", -1, 1, 1);
  if (sign == 0) in.fail("sign", "must be 1 or -1");
  return sign * in.number("factor", kPositive, 1.0);
}

// The SI value of the unit of a column; 0 where it has that of ours.
double read_unit(TableReader& in, const std::string& unit) {
  if (unit.empty()) return 0;
  const auto it = units().find(unit);
  if (it == units().end()) {
    const auto name_of = [](const auto& one) { return one.first; };
    in.fail("unit", "must be one of " + joined(units(), ", ", name_of));
  }
  return it->second.si;
}

// What a column or a vector of theirs is of ours.
template <class Map>
void read_ours(TableReader& in, Map& map) {
  map.ours = in.text("ours");
  map.unit = in.text("unit", "");
  map.file_says = in.text("file_says", "");
  map.unit_in_si = read_unit(in, map.unit);
  map.factor = read_factor(in);
  in.finish();
}

ColumnMap read_column(TableReader in) {
  ColumnMap map;
  map.theirs = in.text("theirs");
  read_ours(in, map);
  return map;
}

VectorMap read_vector(TableReader in) {
  VectorMap map;
  const auto theirs = in.texts("theirs");
  if (theirs.size() != 3)
    in.fail("theirs",
            "must be three columns, x, y and z of the file; \"\" for one that it does not have");
  std::copy(theirs.begin(), theirs.end(), map.theirs.begin());
  read_ours(in, map);
  return map;
}

FrameMap read_frame(TableReader in) {
  FrameMap map;
  map.axes_of = in.text("axes_of", "own");
  map.words = map.axes_of == "own" ? "the axes of each reaction" : "the axes of " + map.axes_of;
  if (map.axes_of == "own") map.axes_of.clear();
  if (in.has("euler_deg") && in.has("x"))
    in.fail("x", "either euler_deg or direction cosines x, y, z");
  if (in.has("euler_deg")) {
    const std::string sequence = in.text("euler", "ZXZ");
    const auto angles = in.numbers("euler_deg");
    if (angles.size() != 3) in.fail("euler_deg", "must be three angles");
    try {
      map.cosines = turned_axes(sequence, {angles[0], angles[1], angles[2]});
    } catch (const InputError& error) {
      in.fail("euler", error.what());
    }
    map.words += fmt::format(", turned by {:g}, {:g}, {:g} deg about {}", angles[0], angles[1],
                             angles[2], sequence);
  } else if (in.has("x") || in.has("y") || in.has("z")) {
    const char* names[] = {"x", "y", "z"};
    map.words += " with";
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = in.numbers(names[i]);
      if (row.size() != 3) in.fail(names[i], "must be three direction cosines");
      std::copy(row.begin(), row.end(), map.cosines[i].begin());
      map.words += fmt::format(" {} = [{:g}, {:g}, {:g}]", names[i], row[0], row[1], row[2]);
    }
    constexpr double kRounded = 1e-5;  // of cosines written in 6 digits
    const Axes& c = map.cosines;
    const auto dot = [](const auto& a, const auto& b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    const std::array<double, 3> cross = {c[0][1] * c[1][2] - c[0][2] * c[1][1],
                                         c[0][2] * c[1][0] - c[0][0] * c[1][2],
                                         c[0][0] * c[1][1] - c[0][1] * c[1][0]};
    for (std::size_t i = 0; i < 3; ++i)
      if (std::abs(dot(c[i], c[i]) - 1) > kRounded ||
          std::abs(dot(c[i], c[(i + 1) % 3])) > kRounded)
        in.fail(names[i], "axes must have length 1 and be orthogonal");
    if (dot(cross, c[2]) < 0) in.fail("z", "axes must be right-handed: x cross y = z");
  }
  in.finish();
  return map;
}

AngleMap read_angle(TableReader in) {
  AngleMap map;
  map.column = in.text("column", "theta_deg");
  map.unit = in.text("unit", "deg");
  map.is_time = seconds_per(map.unit) > 0;
  map.degrees_per_unit = map.is_time ? seconds_per(map.unit) : degrees_per(map.unit);
  if (map.degrees_per_unit == 0)
    in.fail("unit",
            "must be one of deg, rad, mrad, turn, gon, or of s, ms, us, min with the speed of the "
            "case");
  map.sign = read_factor(in);
  map.offset_deg = in.number("offset_deg", kAny, 0.0);
  map.rounding_deg = in.number("rounding_deg", kNotNegative, 0.0);
  if (in.has("turn_from_deg")) map.turn_from_deg = in.number("turn_from_deg", kAny);
  in.finish();
  return map;
}

fs::path existing(TableReader& in, const std::string& key, const fs::path& folder,
                  const std::string& name) {
  fs::path path = (folder / name).lexically_normal();
  if (!fs::is_regular_file(path)) in.fail(key, "no such file: " + path.string());
  return path;
}

CurveDescription read_curve(TableReader in, const fs::path& folder) {
  CurveDescription curve;
  curve.file = existing(in, "file", folder, in.text("file"));
  curve.points = in.integer("points", 3, std::numeric_limits<int>::max());
  curve.models = in.texts("models");
  for (const auto& model : curve.models)
    if (!contains(kModels, model)) in.fail("models", "must be \"analytic\", \"multibody\" or both");
  if (curve.models.empty()) curve.models = kModels;
  curve.sheet = in.text("sheet", "");
  curve.guessed = in.flag("guessed", false);
  curve.angle = read_angle(in.optional_table("angle"));
  curve.frame = read_frame(in.optional_table("frame"));
  for (TableReader& vector : in.tables("vector")) curve.vectors.push_back(read_vector(vector));
  for (TableReader& column : in.tables("column")) curve.columns.push_back(read_column(column));
  curve.ignored = in.texts("ignore");
  curve.one_is_wrong = in.texts("one_is_wrong");
  if (!in.texts("undecided").empty())
    in.fail(
        "undecided",
        "the names or sizes suggest channels, but the curves do not resemble them: state what each "
        "column is in a [[curve.column]], or put it into ignore");
  in.finish();
  return curve;
}

}  // namespace

std::string to_string(ReferenceKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

const ForeignUnit* find_unit(const std::string& name) {
  const auto it = units().find(name);
  return it == units().end() ? nullptr : &it->second;
}
double degrees_per(const std::string& angle_unit) {
  return size_of(angle_unit, "Angle") / kRadPerDegree;
}
double seconds_per(const std::string& time_unit) { return size_of(time_unit, "Time"); }

Axes turned_axes(const std::string& sequence, const std::array<double, 3>& angles_deg) {
  Axes axes = kNoTurn;
  if (sequence.size() != 3) throw InputError("must be three axes, as in ZXZ or 313");
  for (std::size_t turn = 0; turn < 3; ++turn) {
    const std::size_t axis = std::string("xyzXYZ123").find(sequence[turn]) % 3;
    if (std::string("xyzXYZ123").find(sequence[turn]) == std::string::npos)
      throw InputError("must be three axes, as in ZXZ or 313");
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double c = std::cos(radians(angles_deg[turn])), s = std::sin(radians(angles_deg[turn]));
    const auto first = axes[a], second = axes[b];
    for (std::size_t i = 0; i < 3; ++i) {
      axes[a][i] = c * first[i] + s * second[i];
      axes[b][i] = c * second[i] - s * first[i];
    }
  }
  return axes;
}

Axes carried(const Axes& axes, const Axes& from, const Axes& to) {
  Axes out{};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = 0; l < 3; ++l) out[j][i] += axes[j][k] * from[k][l] * to[i][l];
  return out;
}

std::string vector_name(const Channel& channel) {
  return channel.quantity + (channel.piston > 0 ? "_" + std::to_string(channel.piston) : "");
}

std::vector<std::string> assumptions_of(const CurveDescription& curve) {
  std::vector<std::string> lines;
  if (!curve.guessed) return lines;
  const AngleMap& angle = curve.angle;
  lines.push_back(fmt::format(
      "assumed, guessed from the curves of {}: theta = {}{}{} in {}{}{}, the phase shift of the "
      "whole file",
      curve.file.filename().string(), angle.sign < 0 ? "-" : "",
      std::abs(angle.sign) == 1 ? "" : fmt::format("{:g} x ", std::abs(angle.sign)), angle.column,
      angle.unit, angle.is_time ? " x speed" : "",
      fmt::format(" {} {:g} deg", angle.offset_deg < 0 ? "-" : "+", std::abs(angle.offset_deg))));
  if (!curve.vectors.empty())
    lines.push_back("assumed: the vectors of the file are given in " +
                    (curve.frame.words.empty() ? "the axes of each reaction" : curve.frame.words));
  if (curve.vectors.size() > 1 &&
      std::all_of(curve.vectors.begin(), curve.vectors.end(),
                  [](const VectorMap& vector) { return vector.factor < 0; }))
    lines.emplace_back(
        "assumed: every vector has the sign -1, the force on the other body; vectors in "
        "left-handed "
        "axes look the same");
  if (!curve.one_is_wrong.empty())
    lines.push_back(
        "not decided: a component of " + joined(curve.one_is_wrong, " or ") +
        " has the wrong sign; in turned axes these vectors do not show which of them: a further "
        "vector with three components would");
  std::map<std::string, std::string> meanings;  // "x -1, kN" -> columns
  const auto add = [&](const std::string& theirs, const std::string& ours, double factor,
                       const std::string& unit) {
    auto& list = meanings[fmt::format("{:+g}{}", factor, unit.empty() ? "" : " x " + unit)];
    list += (list.empty() ? "" : ", ") + ours + " = " + theirs;
  };
  for (const auto& vector : curve.vectors)
    add("(" + vector.theirs[0] + ", " + vector.theirs[1] + ", " + vector.theirs[2] + ")",
        vector.ours, vector.factor, vector.unit);
  for (const auto& column : curve.columns)
    add(column.theirs, column.ours, column.factor, column.unit);
  for (const auto& [meaning, list] : meanings)
    lines.push_back("assumed, times " + meaning + ": " + list);
  std::map<std::pair<std::string, std::string>, std::string> against;  // units -> columns
  const auto contradict = [&](const std::string& theirs, const auto& map) {
    if (map.file_says.empty()) return;
    auto& list = against[{map.file_says, map.unit}];
    list += (list.empty() ? "" : ", ") + theirs;
  };
  for (const auto& vector : curve.vectors)
    for (const std::string& theirs : vector.theirs)
      if (!theirs.empty()) contradict(theirs, vector);
  for (const auto& column : curve.columns) contradict(column.theirs, column);
  for (const auto& [units, list] : against)
    lines.push_back("assumed against the file: its heading says " + units.first +
                    ", its values fit the model in " + units.second + ": " + list +
                    "; the heading is wrong, or the values are");
  if (!curve.ignored.empty()) lines.push_back("assumed to be no result: " + joined(curve.ignored));
  return lines;
}

std::vector<fs::path> find_references(const fs::path& root) {
  if (!fs::is_directory(root))
    throw InputError(root.string() +
                     ": is not a directory with reference data; `bentaxis reference new` makes one "
                     "from a file of curves");
  std::vector<fs::path> found;
  const std::function<void(const fs::path&)> visit = [&](const fs::path& folder) {
    if (fs::is_regular_file(folder / kDescriptionName)) {
      found.push_back(folder);
      return;
    }
    if (fs::is_regular_file(folder / kCatalogueName)) return;
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
    std::sort(entries.begin(), entries.end());
    for (const auto& entry : entries) {
      if (entry.filename() == "README.md" || entry.filename() == "generator") continue;
      // A proposal of `bentaxis reference new`, which stands beside the reference that it is for.
      if (entry.filename().string().ends_with("_mapping.toml")) continue;
      if (!fs::is_directory(entry))
        throw InputError(folder.string() + ": has no " + kDescriptionName + ", and its file " +
                         entry.filename().string() + " is not used");
      visit(entry);
    }
  };
  visit(root);
  if (found.empty())
    throw InputError(root.string() + ": holds no reference data (no " + kDescriptionName + ")");
  return found;
}

ReferenceDescription read_description(const fs::path& folder, const std::string& name) {
  const TomlFile file = TomlFile::read(folder / kDescriptionName, "description");
  TableReader in = file.root();
  ReferenceDescription d;
  d.folder = folder;
  d.name = name;
  in.integer("schema", 1, 1);
  d.kind = static_cast<ReferenceKind>(in.choice("kind", kKinds));
  const std::string above = fs::canonical(folder).parent_path().filename();
  const auto place = std::find(kFolders.begin(), kFolders.end(), above);
  if (place != kFolders.end() && !above.empty() &&
      place - kFolders.begin() != static_cast<std::ptrdiff_t>(d.kind))
    in.fail("kind", "must be \"" + kKinds[static_cast<std::size_t>(place - kFolders.begin())] +
                        "\" in a folder below " + above);
  d.source = in.text("source");
  d.how_made = in.text("how_made");
  d.who_may_change = in.text("who_may_change");
  in.text("exercises", "");
  in.text("frames_and_units", "");
  for (const auto& document : in.texts("documents"))
    d.documents.push_back(existing(in, "documents", folder, document));
  if (d.kind == ReferenceKind::published) {
    d.numbers = existing(in, "numbers", folder, in.text("numbers"));
    in.finish();
    return d;
  }
  d.digits = in.integer("digits", 1, 1000);
  d.case_file = existing(in, "case", folder, in.text("case"));
  d.multibody_case_file = d.case_file;
  if (in.has("multibody_case"))
    d.multibody_case_file = existing(in, "multibody_case", folder, in.text("multibody_case"));
  if (in.has("samples_per_revolution"))
    d.samples_per_revolution =
        in.integer("samples_per_revolution", 3, std::numeric_limits<int>::max());
  TableReader tolerance = in.table("tolerance");
  d.relative = tolerance.number("relative", {0, 1});
  d.absolute["N"] = tolerance.number("absolute_N", kNotNegative, 0.0);
  d.absolute["Nm"] = tolerance.number("absolute_Nm", kNotNegative, 0.0);
  d.absolute["mm"] = tolerance.number("absolute_mm", kNotNegative, 0.0);
  d.absolute["bar"] = tolerance.number("absolute_bar", kNotNegative, 0.0);
  d.tube_deg = tolerance.number("tube_deg", {0, 45}, 0.0);
  tolerance.finish();
  for (TableReader& curve : in.tables("curve")) d.curves.push_back(read_curve(curve, folder));
  if (d.curves.empty()) in.fail("curve", "at least one [[curve]] is needed");
  in.finish();
  return d;
}

void check_files(const ReferenceDescription& description, const std::vector<fs::path>& used) {
  std::set<fs::path> known = {description.folder / kDescriptionName, description.case_file,
                              description.multibody_case_file, description.numbers};
  known.insert(description.documents.begin(), description.documents.end());
  known.insert(used.begin(), used.end());
  for (const auto& curve : description.curves) known.insert(curve.file);
  std::set<fs::path> normal;
  for (const auto& path : known)
    if (!path.empty()) normal.insert(fs::absolute(path).lexically_normal());
  std::set<fs::path> there;
  for (const auto& entry : fs::recursive_directory_iterator(description.folder))
    if (!entry.is_directory()) there.insert(entry.path());
  for (const auto& path : there)
    if (normal.count(fs::absolute(path).lexically_normal()) == 0)
      throw InputError(path.string() + ": is not used: name it in " +
                       (description.folder / kDescriptionName).string() + " or remove it");
}

}  // namespace bentaxis::compare
