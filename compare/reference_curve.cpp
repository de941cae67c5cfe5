// A stored curve, read and mapped onto the columns of a result.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bentaxis/compare/reference.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "reference_angles.h"

namespace bentaxis::compare {

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

namespace {

// A channel as a sum of columns of the file: one, or the components of a vector in other axes.
using Source = std::vector<std::pair<std::size_t, double>>;

// Reads and maps one file, step by step. Every column is the angle, mapped, one of ours by its
// name, or ignored by name.
class CurveReader {
 public:
  CurveReader(const ReferenceDescription& description, const CurveDescription& curve,
              const std::vector<Channel>& channels, const FrameAxes& frames)
      : description_(description), curve_(curve), channels_(channels), frames_(frames) {
    read_rows();
    angle_ = column_of(curve.angle.column);
    taken_ = {angle_};
    for (std::size_t row = 0; row < data_.rows.size(); ++row)
      if (!is_computed(data_.rows[row][angle_]))
        throw InputError(data_.place(row) + ": has no value in " + curve.angle.column);
    out_.file = curve.file;
    out_.rows = data_.rows.size();
    out_.angle_rounding_deg = curve.angle.rounding_deg;
    out_.table.name = "reference";
  }

  ReferenceCurve read(double degrees_per_second) {
    for (const VectorMap& map : curve_.vectors) map_vector(map);
    for (const ColumnMap& map : curve_.columns) map_column(map);
    for (const auto& name : curve_.ignored) taken_.insert(column_of(name));
    for (std::size_t column = 0; column < data_.header.size(); ++column)
      if (taken_.count(column) == 0) take_by_name(column);
    const Turn turn = take_turn(degrees_per_second);
    note_parts_without_channel(turn);
    if (turn.repeated) require_same_again(turn);
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(curve_.file.string() + ": " + why);
  }

  void read_rows() {
    const bool foreign = description_.kind == ReferenceKind::external;
    if (foreign) {
      data_ = read_table(curve_.file, curve_.sheet);
    } else {
      const std::string content = read_input_file(curve_.file, {"a curve", kLargestTable});
      static_cast<NumericTable&>(data_) = numeric_csv_of(content, curve_.file, true);
      data_.file = curve_.file;
      if (!content.ends_with('\n')) fail("the last line has no end: the file is truncated");
    }
    const auto points = static_cast<std::size_t>(curve_.points);
    if (data_.rows.size() != points)
      fail("has " + std::to_string(data_.rows.size()) +
           " rows of numbers, its description says points = " + std::to_string(points) +
           (data_.rows.size() < points ? ": truncated?" : ""));
  }

  std::size_t column_of(const std::string& name) const {
    const auto it = std::find(data_.header.begin(), data_.header.end(), name);
    if (it == data_.header.end()) {
      std::string all = joined(data_.header);
      if (all.size() > 200) all = all.substr(0, 200) + " ..";
      fail("has no column \"" + name + "\"; its columns are " + all);
    }
    if (std::find(it + 1, data_.header.end(), name) != data_.header.end())
      fail("has two columns \"" + name + "\"");
    return static_cast<std::size_t>(it - data_.header.begin());
  }

  // A column that nothing else stands for.
  std::size_t free_column(const std::string& name) {
    const std::size_t column = column_of(name);
    if (!taken_.insert(column).second) fail("column \"" + name + "\" is used twice");
    return column;
  }

  void take(const Channel& channel, Source source) {
    ResultTable& table = out_.table;
    if (table.find(channel.name) < table.columns()) fail("two columns stand for " + channel.name);
    table.channels.push_back(channel);
    sources_.push_back(std::move(source));
  }

  // What a column or vector of theirs is multiplied by to be in the channel's unit.
  template <class Map>
  double factor_to(const Channel& channel, const Map& map) const {
    if (const ForeignUnit* known = find_unit(map.unit);
        known != nullptr && known->family != channel.unit)
      fail("unit " + map.unit + " of " + map.ours + " cannot become " + channel.unit);
    return map.factor * (map.unit_in_si == 0 ? 1 : map.unit_in_si / channel.unit_in_si);
  }

  const Channel* channel_named(const std::string& name) const {
    const auto it = std::find_if(channels_.begin(), channels_.end(),
                                 [&](const Channel& c) { return c.name == name; });
    return it == channels_.end() ? nullptr : &*it;
  }

  void map_column(const ColumnMap& map) {
    const std::size_t column = free_column(map.theirs);
    const Channel* const channel = channel_named(map.ours);
    if (channel == nullptr)
      fail("column \"" + map.theirs + "\" is mapped to \"" + map.ours +
           "\", which is not a column of a result");
    take(*channel, {{column, factor_to(*channel, map)}});
  }

  void take_by_name(std::size_t column) {
    const std::string& name = data_.header[column];
    const Channel* const channel = channel_named(name);
    if (channel == nullptr)
      fail("column \"" + name + "\" is not used: map it in [[curve.column]] or name it in ignore");
    free_column(name);
    take(*channel, {{column, 1}});
  }

  // The components of a vector of ours, of one frame.
  std::vector<Channel> components_of(const std::string& vector) const {
    std::vector<Channel> ours;
    for (const Channel& channel : channels_)
      if (!channel.axis.empty() && vector_name(channel) == vector &&
          (ours.empty() || ours.front().frame == channel.frame))
        ours.push_back(channel);
    if (ours.empty())
      fail("a vector is mapped to \"" + vector + "\", which is not a vector of a result");
    return ours;
  }

  // The file's axes in those of a reaction.
  Axes axes_in(const std::string& frame, const std::string& vector) const {
    const FrameMap& theirs = curve_.frame;
    if (theirs.axes_of.empty() || theirs.axes_of == frame) return theirs.cosines;
    const auto from = frames_.find(theirs.axes_of), to = frames_.find(frame);
    if (from == frames_.end() || to == frames_.end())
      fail("axes of " + theirs.axes_of + " and " + frame + " of " + vector +
           ": must both be S1 or S2, or axes_of = \"own\"");
    return carried(theirs.cosines, from->second, to->second);
  }

  void map_vector(const VectorMap& map) {
    const std::vector<Channel> ours = components_of(map.ours);
    const double factor = factor_to(ours.front(), map);
    std::array<std::optional<std::size_t>, 3> columns;
    for (std::size_t j = 0; j < 3; ++j)
      if (!map.theirs[j].empty()) columns[j] = free_column(map.theirs[j]);
    const Axes axes = axes_in(ours.front().frame, map.ours);
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<Source> source = component(columns, axes, i, factor);
      if (!source) continue;
      const auto channel = std::find_if(
          ours.begin(), ours.end(), [&](const Channel& c) { return c.axis.front() == "xyz"[i]; });
      any = any || channel != ours.end();
      if (channel != ours.end())
        take(*channel, *source);
      else
        without_channel_.emplace_back(
            map.ours + " along " + "xyz"[i] + ours.front().frame.substr(1), *source);
    }
    if (!any)
      fail("the columns of vector " + map.ours + " give none of its components in our axes");
  }

  // Component i of a vector in our axes; nothing where the file lacks a column that it needs.
  static std::optional<Source> component(const std::array<std::optional<std::size_t>, 3>& columns,
                                         const Axes& axes, std::size_t i, double factor) {
    constexpr double kNothing = 1e-9;  // of a cosine
    Source source;
    for (std::size_t j = 0; j < 3; ++j) {
      if (std::abs(axes[j][i]) < kNothing) continue;
      if (!columns[j]) return std::nullopt;
      source.emplace_back(*columns[j], axes[j][i] * factor);
    }
    return source;
  }

  double value_of(const Source& source, std::size_t row) const {
    double sum = 0;
    for (const auto& [column, factor] : source) {
      const double value = data_.rows[row][column];
      if (!is_computed(value)) return value;
      sum = source.size() == 1 ? factor * value : sum + factor * value;
    }
    return sum;
  }

  std::vector<double> values_of(std::size_t column) const {
    std::vector<double> values;
    for (const auto& row : data_.rows) values.push_back(row[column]);
    return values;
  }

  // Fills the table over the turn.
  Turn take_turn(double degrees_per_second) {
    Turn turn = one_turn(
        curve_.file.string(), curve_.angle, values_of(angle_),
        [&](std::size_t row) { return data_.place(row); }, degrees_per_second);
    out_.table.theta_deg = turn.theta_deg;
    for (const auto row : turn.rows)
      for (const auto& source : sources_) out_.table.values.push_back(value_of(source, row));
    return turn;
  }

  void note_parts_without_channel(const Turn& turn) {
    const ResultTable& table = out_.table;
    for (const auto& [words, source] : without_channel_) {
      double largest = 0;
      for (const auto row : turn.rows)
        if (const double value = value_of(source, row); is_computed(value))
          largest = std::max(largest, std::abs(value));
      const std::string quantity = words.substr(0, words.find_first_of("_ "));
      double peak = 0;
      for (const Channel& channel : table.channels)
        if (channel.quantity == quantity) peak = std::max(peak, table.peak(channel.group));
      if (largest > description_.relative * peak)
        out_.notes.push_back(
            fmt::format("the file has a part of {} up to {:.2e} of its peak: not compared, because "
                        "it is 0 in both models",
                        words, peak > 0 ? largest / peak : 1));
    }
  }

  // A turn later every column is the same again.
  void require_same_again(const Turn& turn) const {
    const ResultTable& table = out_.table;
    for (std::size_t c = 0; c < table.columns(); ++c) {
      const Channel& channel = table.channels[c];
      const double start = value_of(sources_[c], turn.repeated->first);
      const double again = value_of(sources_[c], turn.repeated->second);
      const auto absolute = description_.absolute.find(channel.unit);
      const double allowed = description_.relative * table.peak(channel.group) +
                             (absolute == description_.absolute.end() ? 0 : absolute->second);
      if (is_computed(start) && is_computed(again) && std::abs(again - start) > allowed)
        throw InputError(data_.place(turn.repeated->second) + ": column \"" +
                         data_.header[sources_[c].front().first] + "\" = " + number_text(again) +
                         " a turn after " + number_text(start) + ": the record is not periodic" +
                         (curve_.angle.is_time ? ", or of another speed than the case's" : "") +
                         " (allowed: " + number_text(rounded(allowed, 3)) + " " + channel.unit +
                         ")");
    }
  }

  const ReferenceDescription& description_;
  const CurveDescription& curve_;
  const std::vector<Channel>& channels_;
  const FrameAxes& frames_;
  ForeignTable data_;
  std::size_t angle_ = 0;
  std::set<std::size_t> taken_;  // columns
  std::vector<Source> sources_;  // of the table's channels
  std::vector<std::pair<std::string, Source>> without_channel_;
  ReferenceCurve out_;
};

}  // namespace

ReferenceCurve read_reference_curve(const ReferenceDescription& description,
                                    const CurveDescription& curve,
                                    const std::vector<Channel>& channels, double degrees_per_second,
                                    const FrameAxes& frames) {
  return CurveReader(description, curve, channels, frames).read(degrees_per_second);
}

}  // namespace bentaxis::compare
