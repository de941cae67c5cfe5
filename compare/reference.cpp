#include "bentaxis/compare/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <list>
#include <map>
#include <set>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/periodic_spline.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/column_values.h"

namespace bentaxis::compare {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDescriptionName = "description.toml";
// What lists the cases of a folder that are not references of their own: the hard cases.
constexpr const char* kCatalogueName = "catalogue.toml";
// Angles this close are the same: a thousandth of the round-off of an angle written in 9 digits.
constexpr double kSameAngle = 1e-9;
// A spline across a wider gap would invent the curve there.
constexpr double kLargestGap = 30;
// A hint is given where it explains all but this share of the difference...
constexpr double kExplained = 0.01;
// ...or of a shifted curve this share: the spline between its points is not exact.
constexpr double kExplainedByShift = 0.25;
// ...or of an offset this one: it is the whole cause.
constexpr double kLeftByOffset = 0.1;
// Of shifts that leave as much but for this share the smallest is meant.
constexpr double kAsGood = 0.01;
// Hints look at no more angles than this.
constexpr std::size_t kHintRows = 90;

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
  if (!in.texts("undecided").empty())
    in.fail(
        "undecided",
        "the names or sizes suggest channels, but the curves do not resemble them: state what each "
        "column is in a [[curve.column]], or put it into ignore");
  in.finish();
  return curve;
}

bool ends_its_last_line(const fs::path& file) {
  return read_input_file(file, {"a curve", kLargestTable}).ends_with('\n');
}

// Index of an angle among rising ones, or their number.
std::size_t find_angle(const std::vector<double>& theta, double angle, double same) {
  auto it = std::lower_bound(theta.begin(), theta.end(), angle - same);
  while (it != theta.end() && it + 1 != theta.end() &&
         std::abs(*(it + 1) - angle) < std::abs(*it - angle))
    ++it;  // the nearest
  if (it != theta.end() && *it <= angle + same) return static_cast<std::size_t>(it - theta.begin());
  if (angle + 360 - theta.back() <= same) return theta.size() - 1;  // 359.9999, rounded, is 0
  return theta.size();
}

// The turn's angle of a sample.
double reduced(double theta_deg) {
  const double angle = wrap_degrees(theta_deg);
  return angle > 360 - kSameAngle ? 0 : angle;
}

// A value on the straight line between two points.
struct Between {
  std::size_t first, next;
  double share;
};

// Where a curve is looked at to find what it spans over [at - half, at + half]: its points there
// and the straight lines to the ends.
std::vector<Between> points_near(const std::vector<double>& theta, double at, double half) {
  std::vector<Between> points;
  const std::size_t n = theta.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    const double step = wrap_degrees(theta[next] - theta[i]);
    for (const double end : {at - half, at + half}) {
      const double past = wrap_degrees(end - theta[i]);
      if (past <= step) points.push_back({i, next, past / step});
    }
    const double past = wrap_degrees(theta[i] - at);
    if (std::min(past, 360 - past) <= half) points.push_back({i, i, 0});
  }
  return points;
}

// What a differing curve looks like, tried on some of its angles.
class Hints {
 public:
  Hints(const ResultTable& reference, const ResultTable& result)
      : reference_(reference), result_(result) {
    const std::size_t stride = 1 + (result.rows() - 1) / kHintRows;
    for (std::size_t row = 0; row < result.rows(); row += stride) rows_.push_back(row);
  }

  std::string of(const ChannelComparison& channel) const {
    const std::size_t a = reference_.find(channel.channel.name);
    const std::size_t b = result_.find(channel.channel.name);
    std::vector<double> theirs, ours;
    for (const auto row : rows_) {
      if (!is_computed(reference_.at(row, a)) || !is_computed(result_.at(row, b))) return "";
      theirs.push_back(reference_.at(row, a));
      ours.push_back(result_.at(row, b));
    }
    const double original = rms(theirs, ours, 1);
    const double enough = std::max(kExplained * original, channel.allowed);
    for (std::size_t other = 0; other < reference_.columns(); ++other) {
      if (other == a || reference_.channels[other].unit != channel.channel.unit) continue;
      std::vector<double> candidate;
      for (const auto row : rows_) candidate.push_back(reference_.at(row, other));
      if (rms(candidate, ours, 1) <= enough)
        return "the reference has this curve as " + reference_.channels[other].name;
    }
    double product = 0, square = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      product += theirs[i] * ours[i];
      square += theirs[i] * theirs[i];
    }
    const double factor = square > 0 ? product / square : 0;
    double offset = 0;
    for (std::size_t i = 0; i < ours.size(); ++i)
      offset += (ours[i] - theirs[i]) / static_cast<double>(ours.size());
    std::vector<double> moved = theirs;
    for (double& value : moved) value += offset;
    const double with_factor = rms(theirs, ours, factor), with_offset = rms(moved, ours, 1);
    if (with_offset <= std::min(enough, kLeftByOffset * original) && with_offset < with_factor)
      return fmt::format("the result is the reference {} {:.4g} {} at every angle",
                         offset < 0 ? "less" : "plus", std::abs(offset), channel.channel.unit);
    if (std::abs(factor - 1) > kExplained && with_factor <= enough)
      return std::abs(factor + 1) < kExplained
                 ? std::string("the reference has the opposite sign")
                 : fmt::format("the result is {:.7g} times the reference", factor);
    const double shift = best_shift(a, ours);
    if (shift != 0 && shifted_rms(a, ours, shift) <= kExplainedByShift * original)
      return fmt::format("the result is the reference shifted by about {:+.2f} deg", shift);
    return "";
  }

 private:
  static double rms(const std::vector<double>& theirs, const std::vector<double>& ours,
                    double factor) {
    double sum = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const double difference = ours[i] - factor * theirs[i];
      sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(ours.size()));
  }
  // The reference moved by `shift` degrees towards larger angles, against ours.
  double shifted_rms(std::size_t column, const std::vector<double>& ours, double shift) const {
    std::vector<double> moved;
    for (const auto row : rows_) moved.push_back(spline(column)(result_.theta_deg[row] - shift));
    return rms(moved, ours, 1);
  }
  double best_shift(std::size_t column, const std::vector<double>& ours) const {
    if (reference_.rows() < 3) return 0;
    struct Shift {
      double deg, rms;
    };
    const auto at = [&](double deg) { return Shift{deg, shifted_rms(column, ours, deg)}; };
    const auto search = [&](Shift best, double reach, double step) {
      const double around = best.deg;
      for (double deg = around - reach; deg <= around + reach; deg += step)
        if (const Shift there = at(deg); there.rms < best.rms) best = there;
      return best;
    };
    // A curve that repeats fits at several shifts: of those that are as good the smallest.
    std::vector<Shift> degrees;
    for (int deg = -181; deg <= 181; ++deg) degrees.push_back(at(deg));
    std::vector<Shift> fits;
    for (std::size_t i = 1; i + 1 < degrees.size(); ++i)
      if (degrees[i].rms <= degrees[i - 1].rms && degrees[i].rms <= degrees[i + 1].rms)
        fits.push_back(search(search(degrees[i], 1, 0.1), 0.1, 0.01));
    const Shift none = at(0);
    Shift best = none;
    for (const Shift& fit : fits)
      if (fit.rms < best.rms) best = fit;
    const double as_good = best.rms + kAsGood * none.rms;
    for (const Shift& fit : fits)
      if (fit.rms <= as_good && std::abs(fit.deg) < std::abs(best.deg)) best.deg = fit.deg;
    return best.deg;
  }
  const PeriodicSpline& spline(std::size_t column) const {
    auto it = splines_.find(column);
    if (it == splines_.end()) {
      // Falling angles of a turn run backwards are put in order.
      std::map<double, double> points;
      for (std::size_t row = 0; row < reference_.rows(); ++row)
        points[reduced(reference_.theta_deg[row])] = reference_.at(row, column);
      std::vector<double> x, y;
      for (const auto& [angle, value] : points) {
        x.push_back(angle);
        y.push_back(value);
      }
      it = splines_.emplace(column, PeriodicSpline(x, y)).first;
    }
    return it->second;
  }

  const ResultTable& reference_;
  const ResultTable& result_;
  std::vector<std::size_t> rows_;
  mutable std::map<std::size_t, PeriodicSpline> splines_;
};

// How far the spline through every other point misses those between, per point.
std::vector<double> misses(const std::vector<double>& theta, const std::vector<double>& values) {
  std::vector<double> miss(theta.size(), 0);
  for (std::size_t start = 0; start < 2; ++start) {
    std::vector<double> x, y;
    for (std::size_t i = start; i < theta.size(); i += 2) {
      x.push_back(theta[i]);
      y.push_back(values[i]);
    }
    if (x.size() < 3) continue;
    const PeriodicSpline spline(x, y);
    for (std::size_t i = 1 - start; i < theta.size(); i += 2)
      miss[i] = std::abs(spline(theta[i]) - values[i]);
  }
  return miss;
}

// The largest of some rows on either side of each interval, which begins at point i.
std::vector<double> largest_nearby(const std::vector<double>& values) {
  constexpr std::size_t kReach = 4;
  const std::size_t n = values.size();
  std::vector<double> out(n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k <= 2 * kReach + 1 && k < n; ++k)
      out[i] = std::max(out[i], values[(i + n * kReach - kReach + k) % n]);
  return out;
}

// Estimated error of the spline through all points, per interval between two of them: three times
// what the spline through every other point misses nearby. That is what a jump (the reversal of a
// friction force) may cost, where more points do not help: between two points the spline may miss
// by the whole jump, twice the miss half way; with a point on it by half the jump, 2.6 times the
// miss. A smooth curve is better than that, by up to 48 times. Which of them a curve is there
// cannot be told from its points alone: a steep flank beside the jump looks as smooth.
std::vector<double> resampling_errors(const std::vector<double>& theta,
                                      const std::vector<double>& values) {
  std::vector<double> errors = largest_nearby(misses(theta, values));
  for (double& error : errors) error *= 3;
  return errors;
}

// The interval of rising angles that an angle of the turn lies in: its first point.
std::size_t interval_of(const std::vector<double>& theta, double angle) {
  const auto above = std::upper_bound(theta.begin(), theta.end(), angle);
  return above == theta.begin() ? theta.size() - 1
                                : static_cast<std::size_t>(above - theta.begin()) - 1;
}

// The reference at the angles of the result, with the band of the tube.
struct Resampled {
  ResultTable middle, low, high;
  ResultTable uncertainty;  // of the middle
  bool exact = true;
  double error = 0;
};

// From each point to the next, the last of a turn to the first.
double step_after(const std::vector<double>& theta, std::size_t i) {
  return i + 1 < theta.size() ? theta[i + 1] - theta[i] : theta.front() + 360 - theta.back();
}

void require_no_wide_gap(const ReferenceCurve& curve) {
  const std::vector<double>& theta = curve.table.theta_deg;
  for (std::size_t i = 0; i < theta.size(); ++i)
    if (const double gap = step_after(theta, i); gap > kLargestGap)
      throw InputError(curve.file.string() + ": has no points between " + number_text(theta[i]) +
                       " and " + number_text(theta[i] + gap) +
                       " deg (shaft angle): must cover the turn with gaps of at most " +
                       number_text(kLargestGap) + " deg");
}

// Whether a curve has points at all of these angles.
bool covers(const ReferenceCurve& curve, const std::vector<double>& theta_deg) {
  return std::all_of(theta_deg.begin(), theta_deg.end(), [&](double angle) {
    return find_angle(curve.table.theta_deg, reduced(angle), kSameAngle) <
           curve.table.theta_deg.size();
  });
}

// Values of the band that a curve spans around angles: what it has at its points there and on the
// straight lines between.
struct Span {
  double low, high;
};
Span span_of(const std::vector<double>& values, const std::vector<Between>& near, double middle) {
  Span span{middle, middle};
  for (const Between& point : near) {
    const double value =
        values[point.first] + point.share * (values[point.next] - values[point.first]);
    span.low = std::min(span.low, value);
    span.high = std::max(span.high, value);
  }
  return span;
}

Resampled resample(const ReferenceDescription& description, const ReferenceCurve& curve,
                   const std::vector<double>& theta_deg) {
  Resampled out;
  ResultTable& table = out.middle;
  table.name = "reference";
  table.channels = curve.table.channels;
  table.theta_deg = theta_deg;
  table.values.assign(table.rows() * table.columns(), not_computed());
  const auto& theta = curve.table.theta_deg;
  std::vector<std::size_t> at;
  std::vector<std::vector<Between>> near;
  for (const double angle : theta_deg)
    at.push_back(find_angle(theta, reduced(angle), std::max(kSameAngle, curve.angle_rounding_deg)));
  out.exact = std::all_of(at.begin(), at.end(), [&](std::size_t i) { return i < theta.size(); });
  const bool tube = description.tube_deg > 0;
  if (!out.exact || tube) require_no_wide_gap(curve);
  if (tube)
    for (const double angle : theta_deg)
      near.push_back(points_near(theta, reduced(angle), description.tube_deg));
  out.low = out.high = out.uncertainty = table;
  for (std::size_t column = 0; column < table.columns(); ++column) {
    const std::vector<double> values = column_of(curve.table, column);
    const auto known = std::count_if(values.begin(), values.end(), is_computed);
    if (known == 0) continue;
    const bool gaps = known < static_cast<std::ptrdiff_t>(values.size());
    const double rounding = curve.angle_rounding_deg;
    if (gaps && (!out.exact || tube || rounding > 0))
      throw InputError(curve.file.string() + ": column of " + table.channels[column].name +
                       " has empty fields and cannot be resampled");
    std::optional<PeriodicSpline> spline;
    std::vector<double> errors;
    if (!out.exact || rounding > 0) {
      spline.emplace(theta, values);
      errors = resampling_errors(theta, values);
    }
    const double peak = curve.table.peak(table.channels[column].group);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const std::size_t index = row * table.columns() + column;
      const bool there = at[row] < theta.size();
      table.values[index] = there ? values[at[row]] : (*spline)(theta_deg[row]);
      double& uncertainty = out.uncertainty.values[index] = 0;
      if (!there) uncertainty = errors[interval_of(theta, reduced(theta_deg[row]))];
      if (rounding > 0)
        for (const double by : {-rounding, rounding})
          uncertainty += std::abs((*spline)(theta_deg[row] + by) - (*spline)(theta_deg[row])) / 2;
      if (peak > 0) out.error = std::max(out.error, uncertainty / peak);
      if (!tube) continue;
      const Span span = span_of(values, near[row], table.values[index]);
      out.low.values[index] = span.low;
      out.high.values[index] = span.high;
    }
  }
  return out;
}

// Puts the columns of `more` beside those of `table`; both have the same angles.
void append_columns(ResultTable& table, const ResultTable& more) {
  std::vector<double> values;
  for (std::size_t row = 0; row < more.rows(); ++row) {
    for (std::size_t c = 0; c < table.columns(); ++c) values.push_back(table.at(row, c));
    for (std::size_t c = 0; c < more.columns(); ++c) values.push_back(more.at(row, c));
  }
  table.values = std::move(values);
  append(table.channels, more.channels);
  table.theta_deg = more.theta_deg;
}

// A reference and what is held to it, at the same angles.
struct Held {
  Resampled reference;
  const ResultTable* result = nullptr;

  void add(const Resampled& more) {
    append_columns(reference.middle, more.middle);
    append_columns(reference.low, more.low);
    append_columns(reference.high, more.high);
    append_columns(reference.uncertainty, more.uncertainty);
    reference.exact = reference.exact && more.exact;
    reference.error = std::max(reference.error, more.error);
  }
};

// How far a model's values may be off because the angles of a curve are rounded.
ResultTable changes_within(double rounding_deg, const ResultTable& result,
                           const std::vector<double>& theta_deg, const ResultTable& curve,
                           const ResultAt& result_at) {
  ResultTable changes = curve;
  changes.values.assign(curve.values.size(), 0);
  if (rounding_deg <= 0) return changes;
  for (const double by : {-rounding_deg, rounding_deg}) {
    std::vector<double> moved = theta_deg;
    for (double& angle : moved) angle += by;
    const ResultTable there = result_at(moved);
    for (std::size_t c = 0; c < changes.columns(); ++c) {
      const std::size_t column = there.find(changes.channels[c].name);
      if (column == there.columns()) continue;
      for (std::size_t row = 0; row < changes.rows(); ++row) {
        double& change = changes.values[row * changes.columns() + c];
        const double found = std::abs(there.at(row, column) - result.at(row, column));
        if (is_computed(found)) change = std::max(change, found);
      }
    }
  }
  return changes;
}

// A curve as it stands.
Resampled at_own_angles(const ReferenceDescription& description, const ReferenceCurve& curve,
                        const ResultTable& result, const ResultAt& result_at) {
  Resampled out;
  const std::vector<double>& theta = curve.table.theta_deg;
  out.middle = curve.table;
  out.middle.name = "reference";
  out.middle.theta_deg = result.theta_deg;
  out.low = out.high = out.middle;
  out.uncertainty = changes_within(curve.angle_rounding_deg, result, theta, out.middle, result_at);
  if (description.tube_deg <= 0) return out;
  std::vector<std::vector<Between>> near;
  for (const double angle : theta) near.push_back(points_near(theta, angle, description.tube_deg));
  for (std::size_t column = 0; column < out.middle.columns(); ++column) {
    const std::vector<double> values = column_of(curve.table, column);
    const auto known = std::count_if(values.begin(), values.end(), is_computed);
    if (known > 0 && known < static_cast<std::ptrdiff_t>(values.size()))
      throw InputError(curve.file.string() + ": column of " + out.middle.channels[column].name +
                       " has empty fields: there is no tube_deg around them");
    if (known == 0) continue;
    for (std::size_t row = 0; row < theta.size(); ++row) {
      const Span span = span_of(values, near[row], values[row]);
      out.low.values[row * out.low.columns() + column] = span.low;
      out.high.values[row * out.high.columns() + column] = span.high;
    }
  }
  return out;
}

// Where a curve has no points over several of its steps.
void add_gaps(const ReferenceCurve& curve, std::vector<Judgement::Gap>& gaps) {
  constexpr double kManySteps = 3;
  const std::vector<double>& theta = curve.table.theta_deg;
  std::vector<double> steps;
  for (std::size_t i = 0; i < theta.size(); ++i) steps.push_back(step_after(theta, i));
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < theta.size(); ++i)
    if (steps[i] > kManySteps * usual) gaps.push_back({theta[i], theta[i] + steps[i]});
}

// Tables of different columns as one: at all their angles, not computed where one has none.
// @param of  which of those of one that is held
template <class Of>
ResultTable united(const std::vector<Held>& held, const Of& of) {
  std::set<double> angles;
  for (const Held& one : held)
    angles.insert(one.result->theta_deg.begin(), one.result->theta_deg.end());
  ResultTable table = of(held.front());
  table.channels.clear();
  table.theta_deg.assign(angles.begin(), angles.end());
  for (const Held& one : held) append(table.channels, of(one).channels);
  table.values.assign(table.rows() * table.columns(), not_computed());
  std::size_t first = 0;
  for (const Held& one : held) {
    const ResultTable& its = of(one);
    for (std::size_t row = 0; row < its.rows(); ++row) {
      const auto at =
          std::lower_bound(table.theta_deg.begin(), table.theta_deg.end(), its.theta_deg[row]) -
          table.theta_deg.begin();
      for (std::size_t c = 0; c < its.columns(); ++c)
        table.values[static_cast<std::size_t>(at) * table.columns() + first + c] = its.at(row, c);
    }
    first += its.columns();
  }
  return table;
}

// What the comparisons of all curves with a model come to.
class Judge {
 public:
  Judge(const ReferenceDescription& description, const std::vector<Held>& held,
        const ZeroScales& zero_scales)
      : description_(description) {
    Options options;
    options.tolerance = description.relative;
    options.absolute = description.absolute;
    options.zero_scales = zero_scales;
    options.most_digits = std::min(options.most_digits, static_cast<double>(description.digits));
    for (const Held& one : held) {
      if (description.tube_deg > 0) options.band = Band{&one.reference.low, &one.reference.high};
      options.uncertainty = &one.reference.uncertainty;
      parts_.push_back({&one, compare_tables(one.reference.middle, *one.result, options),
                        Hints(one.reference.middle, *one.result)});
    }
  }

  ReferenceChannel found(const Channel& channel, std::size_t column) const {
    const Part& part = part_of(channel.name);
    const ResultTable& result = *part.held->result;
    ReferenceChannel entry;
    if (const auto* found = part.comparison.find(channel.name)) entry.comparison = *found;
    entry.comparison.channel = channel;
    const bool computed = any_computed(result, column);
    if (!has(part, channel.name)) {
      const bool wanted =
          description_.must_be_complete() && channel.kind == ChannelKind::reaction && computed;
      entry.finding = !computed ? Finding::absent : wanted ? Finding::incomplete : Finding::missing;
      if (wanted) entry.hint = "the reference does not have it";
    } else if (!entry.comparison.compared()) {
      entry.finding = Finding::incomplete;
      entry.hint = computed ? "one of them has gaps where the other has values"
                            : "the model did not compute it";
    } else {
      const bool agrees = entry.comparison.verdict == Verdict::agrees;
      entry.finding = agrees ? Finding::agrees : Finding::differs;
      if (!agrees) entry.hint = part.hints.of(entry.comparison);
    }
    return entry;
  }

  bool has(const std::string& channel) const { return has(part_of(channel), channel); }

 private:
  struct Part {
    const Held* held;
    Comparison comparison;
    Hints hints;
  };
  static bool has(const Part& part, const std::string& channel) {
    const ResultTable& reference = part.held->reference.middle;
    return any_computed(reference, reference.find(channel));
  }
  // That has a curve of it, or the first.
  const Part& part_of(const std::string& channel) const {
    const auto it = std::find_if(parts_.begin(), parts_.end(),
                                 [&](const Part& part) { return has(part, channel); });
    return it == parts_.end() ? parts_.front() : *it;
  }

  const ReferenceDescription& description_;
  std::vector<Part> parts_;
};

Judgement judged(const ReferenceDescription& description, const std::vector<Held>& held,
                 const ZeroScales& zero_scales) {
  Judgement judgement;
  if (held.empty()) return judgement;
  const ResultTable& result = *held.front().result;
  const Judge judge(description, held, zero_scales);
  for (std::size_t column = 0; column < result.columns(); ++column) {
    const Channel& channel = result.channels[column];
    if (channel.kind == ChannelKind::check ||
        (channel.kind == ChannelKind::input && !judge.has(channel.name)))
      continue;
    judgement.channels.push_back(judge.found(channel, column));
  }
  for (const Held& one : held) {
    judgement.resampled = judgement.resampled || !one.reference.exact;
    judgement.resampling_error = std::max(judgement.resampling_error, one.reference.error);
  }
  const auto all = [&](const auto& of) {
    return held.size() == 1 ? of(held.front()) : united(held, of);
  };
  judgement.reference = all([](const Held& one) { return one.reference.middle; });
  judgement.resampling = all([](const Held& one) { return one.reference.uncertainty; });
  if (description.tube_deg > 0) {
    judgement.low = all([](const Held& one) { return one.reference.low; });
    judgement.high = all([](const Held& one) { return one.reference.high; });
  }
  return judgement;
}

void require_one_curve_each(const std::vector<ReferenceCurve>& curves) {
  std::set<std::string> names;
  for (const ReferenceCurve& curve : curves)
    for (const Channel& channel : curve.table.channels)
      if (!names.insert(channel.name).second)
        throw InputError(curve.file.string() + ": holds " + channel.name +
                         ", as does another curve for the same model");
}

}  // namespace

std::string to_string(ReferenceKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

const char* to_string(Finding finding) {
  switch (finding) {
    case Finding::agrees:
      return "agrees";
    case Finding::differs:
      return "differs";
    case Finding::missing:
      return "missing";
    case Finding::incomplete:
      return "incomplete";
    case Finding::absent:
      break;
  }
  return "not computed";
}

bool Judgement::agrees() const {
  bool compared = false;
  for (const auto& channel : channels) {
    if (channel.failed()) return false;
    compared = compared || channel.finding == Finding::agrees;
  }
  return compared;
}

Turn one_turn(const std::string& file, const AngleMap& map, const std::vector<double>& values,
              const std::function<std::string(std::size_t)>& place, double degrees_per_second) {
  const auto fail = [&](const std::string& why) { throw InputError(file + ": " + why); };
  std::vector<std::pair<double, std::size_t>> points;
  const double scale = map.sign * map.degrees_per_unit * (map.is_time ? degrees_per_second : 1);
  // Angles this close are the same angle, rounded.
  const double same = std::max(kSameAngle, 2 * map.rounding_deg);
  double turns = 0;  // of an angle that begins anew in every turn
  for (std::size_t row = 0; row < values.size(); ++row) {
    const double angle = scale * values[row] + map.offset_deg;
    if (row > 0 && !map.is_time) {
      const double step = angle + turns - points.back().first;
      if (std::abs(step) > 180 && std::abs(step) <= 360 + same) turns += step > 0 ? -360 : 360;
    }
    points.emplace_back(angle + turns, row);
  }
  if (scale == 0) fail("column " + map.column + " is a time, but the shaft of the case is at rest");
  if (points.size() > 1 && points.back().first < points.front().first)
    std::reverse(points.begin(), points.end());
  for (std::size_t i = 1; i < points.size(); ++i)
    if (const double step = points[i].first - points[i - 1].first;
        step > 0 && map.rounding_deg > step / 2 + kSameAngle)
      fail("[curve.angle] rounding_deg = " + number_text(map.rounding_deg) +
           ": must be at most half of the smallest step between two angles, " +
           number_text(rounded(step, 6)) + " deg");
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!(points[i].first > points[i - 1].first))
      throw InputError(place(points[i].second) + ": angles in column " + map.column +
                       " must increase or decrease strictly");
  if (map.turn_from_deg) {
    const double from = *map.turn_from_deg;
    if (points.front().first > from + same || points.back().first < from + 360 - kLargestGap)
      fail("turn_from_deg = " + number_text(from) + ": the record covers " +
           number_text(points.front().first) + ".." + number_text(points.back().first) + " deg");
    std::erase_if(points, [&](const auto& p) {
      return p.first < from - same || p.first > from + 360 + same;
    });
  }
  Turn turn;
  const double span = points.back().first - points.front().first;
  if (span > 360 + same)
    fail("covers " + number_text(span) +
         " deg: more than a turn; choose the turn by turn_from_deg in [curve.angle]");
  if (span > 360 - same) {
    turn.repeated = {points.front().second, points.back().second};
    points.pop_back();
  }
  for (auto& [angle, row] : points) angle = wrap_degrees(angle);
  for (auto& [angle, row] : points)  // a hair below a whole turn is the turn
    if (angle > 360 - kSameAngle) angle = 0;
  std::sort(points.begin(), points.end());
  for (const auto& [angle, row] : points) {
    turn.theta_deg.push_back(angle);
    turn.rows.push_back(row);
  }
  return turn;
}

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

ReferenceCurve read_reference_curve(const ReferenceDescription& description,
                                    const CurveDescription& curve,
                                    const std::vector<Channel>& channels, double degrees_per_second,
                                    const FrameAxes& frames) {
  const std::string file = curve.file.string();
  const auto fail = [&](const std::string& why) { throw InputError(file + ": " + why); };
  const bool foreign = description.kind == ReferenceKind::external;
  const ForeignTable whole = foreign ? read_table(curve.file, curve.sheet) : ForeignTable{};
  const NumericTable data =
      foreign ? NumericTable(whole)
              : numeric_csv_of(read_input_file(curve.file, {"a curve", kLargestTable}), curve.file,
                               true);
  const auto place = [&](std::size_t row) {
    return foreign ? whole.place(row) : file + ":" + std::to_string(data.lines[row]);
  };
  if (description.kind != ReferenceKind::external && !ends_its_last_line(curve.file))
    fail("the last line has no end: the file is truncated");
  if (data.rows.size() != static_cast<std::size_t>(curve.points))
    fail("has " + std::to_string(data.rows.size()) +
         " rows of numbers, its description says points = " + std::to_string(curve.points) +
         (data.rows.size() < static_cast<std::size_t>(curve.points) ? ": truncated?" : ""));
  const auto column_index = [&](const std::string& name) {
    const auto it = std::find(data.header.begin(), data.header.end(), name);
    if (it == data.header.end()) {
      std::string all = joined(data.header);
      if (all.size() > 200) all = all.substr(0, 200) + " ..";
      fail("has no column \"" + name + "\"; its columns are " + all);
    }
    if (std::find(it + 1, data.header.end(), name) != data.header.end())
      fail("has two columns \"" + name + "\"");
    return static_cast<std::size_t>(it - data.header.begin());
  };
  const std::size_t angle = column_index(curve.angle.column);
  for (std::size_t row = 0; row < data.rows.size(); ++row)
    if (!is_computed(data.rows[row][angle]))
      throw InputError(place(row) + ": has no value in " + curve.angle.column);

  // Every column is the angle, mapped, one of ours by its name, or ignored by name. A channel is a
  // sum of columns: one, or the components of a vector in other axes.
  using Source = std::vector<std::pair<std::size_t, double>>;
  ReferenceCurve out;
  out.file = curve.file;
  out.rows = data.rows.size();
  out.angle_rounding_deg = curve.angle.rounding_deg;
  ResultTable& table = out.table;
  table.name = "reference";
  std::vector<Source> sources;
  std::vector<std::pair<std::string, Source>> without_channel;
  std::set<std::size_t> taken = {angle};
  const auto is_free = [&](const std::string& name) {
    const std::size_t column = column_index(name);
    if (!taken.insert(column).second) fail("column \"" + name + "\" is used twice");
    return column;
  };
  const auto take = [&](const Channel& channel, Source source) {
    if (table.find(channel.name) < table.columns()) fail("two columns stand for " + channel.name);
    table.channels.push_back(channel);
    sources.push_back(std::move(source));
  };
  const auto require_convertible = [&](const std::string& theirs, const std::string& ours,
                                       const std::string& unit) {
    if (const ForeignUnit* known = find_unit(theirs); known != nullptr && known->family != unit)
      fail("unit " + theirs + " of " + ours + " cannot become " + unit);
  };
  const auto in_our_unit = [](double unit, const Channel& channel) {
    return unit == 0 ? 1 : unit / channel.unit_in_si;
  };
  for (const VectorMap& map : curve.vectors) {
    std::vector<Channel> ours;  // of one frame
    for (const Channel& channel : channels)
      if (!channel.axis.empty() &&
          channel.quantity + (channel.piston > 0 ? "_" + std::to_string(channel.piston) : "") ==
              map.ours &&
          (ours.empty() || ours.front().frame == channel.frame))
        ours.push_back(channel);
    if (ours.empty())
      fail("a vector is mapped to \"" + map.ours + "\", which is not a vector of a result");
    require_convertible(map.unit, map.ours, ours.front().unit);
    std::array<std::optional<std::size_t>, 3> columns;
    for (std::size_t j = 0; j < 3; ++j)
      if (!map.theirs[j].empty()) columns[j] = is_free(map.theirs[j]);
    // Their axes in those of the reaction.
    Axes axes = curve.frame.cosines;
    if (!curve.frame.axes_of.empty() && curve.frame.axes_of != ours.front().frame) {
      const auto from = frames.find(curve.frame.axes_of), to = frames.find(ours.front().frame);
      if (from == frames.end() || to == frames.end())
        fail("axes of " + curve.frame.axes_of + " and " + ours.front().frame + " of " + map.ours +
             ": must both be S1 or S2, or axes_of = \"own\"");
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
          axes[j][i] = 0;
          for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t l = 0; l < 3; ++l)
              axes[j][i] += curve.frame.cosines[j][k] * from->second[k][l] * to->second[i][l];
        }
    }
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr double kNothing = 1e-9;  // of a cosine
      const auto channel = std::find_if(
          ours.begin(), ours.end(), [&](const Channel& c) { return c.axis.front() == "xyz"[i]; });
      Source source;
      bool complete = true;
      for (std::size_t j = 0; j < 3; ++j) {
        if (std::abs(axes[j][i]) < kNothing) continue;
        complete = complete && columns[j];
        if (columns[j])
          source.emplace_back(*columns[j],
                              axes[j][i] * map.factor * in_our_unit(map.unit_in_si, ours.front()));
      }
      if (!complete) continue;
      any = any || channel != ours.end();
      if (channel != ours.end())
        take(*channel, source);
      else
        without_channel.emplace_back(map.ours + " along " + "xyz"[i] + ours.front().frame.substr(1),
                                     source);
    }
    if (!any)
      fail("the columns of vector " + map.ours + " give none of its components in our axes");
  }
  const auto known = [&](const std::string& ours) {
    return std::find_if(channels.begin(), channels.end(),
                        [&](const Channel& c) { return c.name == ours; });
  };
  for (const ColumnMap& map : curve.columns) {
    const std::size_t column = is_free(map.theirs);
    const auto channel = known(map.ours);
    if (channel == channels.end())
      fail("column \"" + map.theirs + "\" is mapped to \"" + map.ours +
           "\", which is not a column of a result");
    require_convertible(map.unit, map.ours, channel->unit);
    take(*channel, {{column, map.factor * in_our_unit(map.unit_in_si, *channel)}});
  }
  for (const auto& name : curve.ignored) taken.insert(column_index(name));
  for (std::size_t column = 0; column < data.header.size(); ++column) {
    if (taken.count(column) > 0) continue;
    const std::string& name = data.header[column];
    const auto channel = known(name);
    if (channel == channels.end())
      fail("column \"" + name + "\" is not used: map it in [[curve.column]] or name it in ignore");
    is_free(name);
    take(*channel, {{column, 1}});
  }

  std::vector<double> angles;
  for (const auto& row : data.rows) angles.push_back(row[angle]);
  const Turn turn = one_turn(file, curve.angle, angles, place, degrees_per_second);
  const auto value_of = [&](const Source& source, std::size_t row) {
    double sum = 0;
    for (const auto& [column, factor] : source) {
      const double value = data.rows[row][column];
      if (!is_computed(value)) return value;
      sum = source.size() == 1 ? factor * value : sum + factor * value;
    }
    return sum;
  };
  table.theta_deg = turn.theta_deg;
  for (const auto row : turn.rows)
    for (const auto& source : sources) table.values.push_back(value_of(source, row));
  for (const auto& [words, source] : without_channel) {
    double largest = 0;
    for (const auto row : turn.rows)
      if (const double value = value_of(source, row); is_computed(value))
        largest = std::max(largest, std::abs(value));
    const std::string quantity = words.substr(0, words.find_first_of("_ "));
    double peak = 0;
    for (const Channel& channel : table.channels)
      if (channel.quantity == quantity) peak = std::max(peak, table.peak(channel.group));
    if (largest > description.relative * peak)
      out.notes.push_back(
          fmt::format("the file has a part of {} up to {:.2e} of its peak: not compared, because "
                      "it is 0 in both models",
                      words, peak > 0 ? largest / peak : 1));
  }
  if (turn.repeated) {
    for (std::size_t c = 0; c < table.columns(); ++c) {
      const double start = value_of(sources[c], turn.repeated->first);
      const double again = value_of(sources[c], turn.repeated->second);
      const auto absolute = description.absolute.find(table.channels[c].unit);
      const double allowed = description.relative * table.peak(table.channels[c].group) +
                             (absolute == description.absolute.end() ? 0 : absolute->second);
      if (is_computed(start) && is_computed(again) && std::abs(again - start) > allowed)
        throw InputError(
            place(turn.repeated->second) + ": column \"" + data.header[sources[c].front().first] +
            "\" = " + number_text(again) + " a turn after " + number_text(start) +
            ": the record is not periodic (allowed: " + number_text(rounded(allowed, 3)) + " " +
            table.channels[c].unit + ")");
    }
  }
  return out;
}

std::optional<ResultTable> rows_at(const ResultTable& table, const std::vector<double>& theta_deg) {
  std::vector<std::size_t> rows;
  for (const double angle : theta_deg) {
    rows.push_back(table.rows() > 0 ? find_angle(table.theta_deg, angle, kSameAngle) : 0);
    if (rows.back() == table.rows()) return std::nullopt;
  }
  return select_rows(table, rows);
}

Judgement judge(const ReferenceDescription& description, const std::vector<ReferenceCurve>& curves,
                const ResultAt& result_at, const std::vector<double>& case_theta_deg,
                const ZeroScales& zero_scales) {
  require_one_curve_each(curves);
  // Round-off in a file is no other angle.
  const auto as_in_case = [&](std::vector<double> theta_deg) {
    for (double& angle : theta_deg)
      if (const std::size_t there = find_angle(case_theta_deg, angle, kSameAngle);
          there < case_theta_deg.size())
        angle = case_theta_deg[there];
    return theta_deg;
  };
  std::vector<Held> held;
  std::list<ResultTable> results;            // of each
  std::vector<const ReferenceCurve*> first;  // of each
  std::vector<Judgement::Gap> gaps;
  for (const ReferenceCurve& curve : curves) {
    if (description.tube_deg > 0 || !covers(curve, case_theta_deg)) require_no_wide_gap(curve);
    const auto same = std::find_if(first.begin(), first.end(), [&](const ReferenceCurve* other) {
      return other->table.theta_deg == curve.table.theta_deg;
    });
    if (same != first.end()) {
      Held& one = held[static_cast<std::size_t>(same - first.begin())];
      one.add(at_own_angles(description, curve, *one.result, result_at));
      continue;
    }
    first.push_back(&curve);
    add_gaps(curve, gaps);
    const ResultTable& result = results.emplace_back(result_at(as_in_case(curve.table.theta_deg)));
    held.push_back({at_own_angles(description, curve, result, result_at), &result});
  }
  std::vector<double> all;
  for (const ReferenceCurve* curve : first) append(all, curve->table.theta_deg);
  Judgement judgement = judged(description, held, zero_scales);
  judgement.result =
      results.size() == 1 ? std::move(results.front()) : result_at(judgement.reference.theta_deg);
  judgement.at_own_angles = std::any_of(all.begin(), all.end(), [&](double angle) {
    return find_angle(case_theta_deg, angle, kSameAngle) == case_theta_deg.size();
  });
  judgement.gaps = std::move(gaps);
  return judgement;
}

Judgement judge(const ReferenceDescription& description, const std::vector<ReferenceCurve>& curves,
                const ResultTable& result, const ZeroScales& zero_scales) {
  require_one_curve_each(curves);
  std::vector<Held> held(1);
  held.front().result = &result;
  for (const ReferenceCurve& curve : curves)
    held.front().add(resample(description, curve, result.theta_deg));
  held.front().reference.middle.name = "reference";
  return judged(description, held, zero_scales);
}

}  // namespace bentaxis::compare
