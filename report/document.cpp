#include "bentaxis/report/document.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "base64.h"
#include "bentaxis/compare/stated_difference.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/report/picture.h"
#include "json_fields.h"

namespace nlohmann {

template <>
struct adl_serializer<bentaxis::report::Cell> {
  static void to_json(json& json, const bentaxis::report::Cell& cell) {
    json = nullptr;
    std::visit(
        [&](const auto& value) {
          if constexpr (!std::is_same_v<decltype(value), const std::monostate&>) json = value;
        },
        cell);
  }
};

}  // namespace nlohmann

namespace bentaxis {

inline void to_json(nlohmann::json& json, ChannelKind kind) {
  constexpr const char* kNames[] = {"reaction", "derived", "input", "check"};
  json = kNames[static_cast<std::size_t>(kind)];
}

BENTAXIS_JSON(InputEntry, table, key, value, defaulted, changed)
BENTAXIS_JSON(Warning, name, text)
BENTAXIS_JSON(TimingRow, code, quantity, value, unit, limit, flagged, theta_deg, angles, meant,
              text)
BENTAXIS_JSON(Channel, name, quantity, meaning, equation, piston, axis, frame, on_body, by_body,
              point, unit, group, kind)

inline void to_json(nlohmann::json& json, const AssumptionRow& row) {
  json = {{"name", row.name}, {"analytic", row.first}, {"multibody", row.second}};
}

}  // namespace bentaxis

namespace bentaxis::compare {

BENTAXIS_JSON(Harmonic, order, amplitude, phase_deg)

inline void to_json(nlohmann::json& json, const ChannelComparison& c) {
  const bool compared = c.compared();
  const auto known = [&](double value) {
    return compared ? nlohmann::json(value) : nlohmann::json();
  };
  json = c.channel;
  json["compared"] = c.judged;
  json["peak"] = c.peak;
  json["peak_is_floor"] = c.at_floor;
  json["verdict"] = to_string(c.verdict);
  json["tolerance"] = c.tolerance;
  if (!c.gap.empty()) json["gap"] = c.gap;
  json["own_peak"] = known(c.own_peak);
  json["max_abs"] = known(c.largest);
  json["max_over_peak"] = known(c.largest_over_peak());
  json["allowed"] = known(c.allowed);
  json["rms"] = known(c.rms);
  json["rms_over_peak"] = known(c.rms_over_peak());
  json["theta_of_max_deg"] = known(c.theta_of_largest_deg);
  if (is_nearest_to_limit(c)) json["nearest_to_limit"] = true;
  json["mean"] = {known(c.mean[0]), known(c.mean[1])};
  json["mean_difference"] = known(c.mean_difference);
  json["digits"] = known(c.digits);
  json["orders"] = nlohmann::json::array();
  if (compared) json["orders"] = c.harmonics;
}

inline void to_json(nlohmann::json& json, const Check& check) {
  json = {{"model", check.table},
          {"name", check.name},
          {"worst", check.worst},
          {"unit", check.unit},
          {"scale", check.scale},
          {"relative", check.relative()},
          {"tolerance", check.tolerance},
          {"theta_deg", check.theta_deg},
          {"verdict", check.holds() ? "holds" : "violated"}};
}

}  // namespace bentaxis::compare

namespace bentaxis::report {
namespace {

using Json = nlohmann::json;

constexpr int kPlotDigits = 9;
constexpr int kDifferenceDigits = 4;  // differences are known to their order of magnitude

// A plot needs no more digits, and a page is a third shorter.
Json rounded(double value, int digits) {
  return is_computed(value) ? Json(bentaxis::rounded(value, digits)) : Json();
}
Json rounded(const Values& values, int digits = kPlotDigits) {
  Json list = Json::array();
  for (const double value : values) list.push_back(rounded(value, digits));
  return list;
}

// An array of what `one` makes of each item.
template <class Items, class One>
Json list_of(const Items& items, One one) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(one(item));
  return list;
}

// A member of an object where there is something to say: a value that is there, text that is not
// empty, items, a yes.
template <class Value>
void put(Json& json, const char* key, const std::optional<Value>& value) {
  if (value) json[key] = *value;
}
template <class Items>
void put(Json& json, const char* key, const Items& items) requires requires {
  items.empty();
}
{
  if (!items.empty()) json[key] = items;
}
void put(Json& json, const char* key, bool flag) {
  if (flag) json[key] = true;
}

}  // namespace

// ---- Blocks

BENTAXIS_JSON(Table, columns, rows)
BENTAXIS_JSON(Section, title, text, facts, table)

// ---- Figures

BENTAXIS_JSON(NamedPoint, label, x, y)
BENTAXIS_JSON(ScatterPoint, x, y, note)
BENTAXIS_JSON(ScatterSeries, name, style, line, emphasis, points)
BENTAXIS_JSON(DrawingFigure::Look, label, colour, filled)
BENTAXIS_JSON(DrawingFigure::Arrow, panel, look, x, y, dx, dy)

inline void to_json(Json& json, const Axis& axis) {
  json = {{"label", axis.label}, {"unit", axis.unit}, {"log", axis.log}};
  put(json, "from", axis.from);
  put(json, "to", axis.to);
}

inline void to_json(Json& json, const Ends& ends) { json = {ends.low, ends.high}; }

inline void to_json(Json& json, const Series& s) {
  json = {{"label", s.label}, {"values", rounded(s.values)}};
}

inline void to_json(Json& json, const XySeries& s) {
  json = {{"label", s.label}, {"x", s.x}, {"y", s.y}};
  put(json, "dashed", s.dashed);
}

// Thousandths are more than a picture shows.
inline void to_json(Json& json, const DrawingFigure::Line& line) {
  const auto drawn = [](const Values& values) {
    constexpr double kShown = 1e3;
    return list_of(values, [](double v) { return std::round(v * kShown) / kShown; });
  };
  json = {{"panel", line.panel},
          {"look", line.look},
          {"width", line.width},
          {"x", drawn(line.x)},
          {"y", drawn(line.y)}};
  put(json, "value", line.value);
}

BENTAXIS_JSON(DrawingFigure::Frame, theta_deg, text, lines, arrows)

inline void to_json(Json& json, const DrawingFigure::Panel& panel) {
  json = {{"x", panel.x}, {"y", panel.y}};
  json["x_range"] = {panel.x_low, panel.x_high};
  json["y_range"] = {panel.y_low, panel.y_high};
}

inline void to_json(Json& json, const BarsFigure::Bar& bar) {
  json = {{"label", bar.label}, {"low", bar.low}, {"high", bar.high}, {"note", bar.note}};
  put(json, "interval", bar.interval);
}

inline void to_json(Json& json, const BandFigure::Band& band) {
  json = {{"label", band.label},
          {"low", rounded(band.low)},
          {"middle", rounded(band.middle)},
          {"high", rounded(band.high)}};
}

inline void to_json(Json& json, const ParallelFigure::Column& column) {
  json = {{"label", column.label},
          {"unit", column.unit},
          {"log", column.log},
          {"values", rounded(column.values)}};
  put(json, "words", column.words);
}

BENTAXIS_JSON(Curves::Mark, x, upper)
inline void to_json(Json& json, const Curves& curves);

namespace {

Json with_values(const Axis& axis, const Values& values) {
  Json json = axis;
  json["values"] = values;
  return json;
}

// What the kinds of figures differ in.

Json json_of(const ChannelFigure& figure) {
  Json json = {{"kind", "curves"},
               {"unit", figure.unit},
               {"channels", figure.channels},
               {"extra", figure.extra}};
  put(json, "curves", figure.curves);
  put(json, "ends", figure.ends);
  return json;
}

Json json_of(const PistonBars& figure) {
  return {{"kind", "piston_bars"},
          {"unit", figure.unit},
          {"channels", figure.channels},
          {"angles", figure.angles}};
}

Json json_of(const OwnFigure& figure) {
  Json json = {
      {"kind", "own_axis"},
      {"unit", figure.unit},
      {"value", figure.value},
      {"x", {{"label", figure.axis}, {"angle", figure.angle}, {"values", rounded(figure.x)}}},
      {"series", figure.series}};
  put(json, "stack", figure.stack);
  if (figure.right)
    json["right"] = {{"value", figure.right->value},
                     {"unit", figure.right->unit},
                     {"series", figure.right->series}};
  put(json, "ends", figure.ends);
  return json;
}

Json json_of(const XyFigure& figure) {
  return {{"kind", "xy"},          {"x", figure.x},
          {"y", figure.y},         {"series", figure.series},
          {"equal", figure.equal}, {"points", figure.points}};
}

Json json_of(const MapFigure& figure) {
  Json json = {{"kind", "map"},
               {"x", with_values(figure.x, figure.x_values)},
               {"y", with_values(figure.y, figure.y_values)},
               {"z", {{"label", figure.z.label}, {"unit", figure.z.unit}}},
               {"values", figure.values},
               {"contours", figure.contours},
               {"points", figure.points}};
  put(json, "classes", figure.classes);
  put(json, "linear", figure.linear);
  put(json, "lines", figure.lines);
  put(json, "marks", figure.marks);
  put(json["z"], "from", figure.z.from);
  put(json, "reasons", figure.reasons);
  return json;
}

Json json_of(const ScatterFigure& figure) {
  return {{"kind", "scatter"}, {"x", figure.x}, {"y", figure.y}, {"series", figure.series}};
}

Json json_of(const DrawingFigure& figure) {
  Json json = {{"kind", "drawing"},
               {"looks", figure.looks},
               {"panels", figure.panels},
               {"frames", figure.frames},
               {"shown", figure.shown}};
  if (figure.shades)
    json["shades"] = {{"label", figure.shades->label},
                      {"unit", figure.shades->unit},
                      {"range", {figure.shades->low, figure.shades->high}}};
  put(json, "ground", figure.ground);
  put(json, "axis", figure.axis);
  return json;
}

Json json_of(const BarsFigure& figure) {
  return {{"kind", "bars"}, {"x", figure.x}, {"bars", figure.bars}};
}

Json json_of(const BandFigure& figure) {
  Json json = {{"kind", "bands"},
               {"x", with_values(figure.x, figure.x_values)},
               {"y", figure.y},
               {"bands", figure.bands},
               {"lines", figure.lines}};
  json["x"]["angle"] = figure.angle;
  return json;
}

Json json_of(const ParallelFigure& figure) {
  return {{"kind", "parallel"},
          {"columns", figure.columns},
          {"colour_by", figure.colour_by},
          {"marked", figure.marked},
          {"marked_label", figure.marked_label}};
}

}  // namespace

inline void to_json(Json& json, const Figure& figure) {
  json = std::visit([](const auto& content) { return json_of(content); }, figure.content);
  json["id"] = figure.id;
  json["file"] = file_name_of(figure);
  json["title"] = figure.title;
  json["paper"] = figure.paper;
  json["note"] = figure.note;
}

// ---- Sections

BENTAXIS_JSON(Provenance::Input, file, sha256)
BENTAXIS_JSON(Provenance, command, date, version, inputs, machine)
BENTAXIS_JSON(CaseSection, file, entries)
BENTAXIS_JSON(DerivedQuantity, name, symbol, value, unit, source)
BENTAXIS_JSON(Verdict::Further, name, agrees, headline)
BENTAXIS_JSON(Verdict::Fit, chi_square, degrees_of_freedom, p_value, refuted_below, refuted)
BENTAXIS_JSON(Summary::Group, title, lines)
BENTAXIS_JSON(Summary, text, groups)
BENTAXIS_JSON(CommonInput, input, value, caught_by)
BENTAXIS_JSON(ModelSection, name, assumptions, facts, seconds, angles)
BENTAXIS_JSON(KeyFigures::Row, quantity, symbol, unit, values, difference, over_value, at, note)
BENTAXIS_JSON(KeyFigures, models, at_unit, rows)
BENTAXIS_JSON(Budget::Quantity, name, kind, unit, values, note)
BENTAXIS_JSON(HardCaseRow::Group, group, loss_over_peak, predicted)
BENTAXIS_JSON(HardCaseRow::Model, model, expected, verdict, message, digits, groups, weak_point,
              measured_over_predicted, microseconds_per_angle)
BENTAXIS_JSON(HardCaseRow, name, group, hard, changes, models)

inline void to_json(Json& json, const Verdict& verdict) {
  json = {{"agrees", verdict.agrees}, {"headline", verdict.headline}};
  put(json, "answers", verdict.answers);
  put(json, "word", verdict.word);
  put(json, "not_valid", verdict.not_valid);
  put(json, "tolerance", verdict.tolerance);
  if (verdict.compared) {
    json["compared"] = *verdict.compared;
    json["digits"] = verdict.digits;
    json["worst"] = nullptr;
  }
  put(json, "checks_hold", verdict.checks_hold);
  if (verdict.worst)
    json["worst"] = {{"channel", verdict.worst->channel},
                     {"max_over_peak", verdict.worst->over_peak},
                     {"theta_deg", verdict.worst->theta_deg}};
  put(json, "rest_over_peak", verdict.rest_over_peak);
  put(json, "rest_tolerance", verdict.rest_tolerance);
  put(json, "reference", verdict.reference);
  put(json, "fit", verdict.fit);
  put(json, "models_agree", verdict.models_agree);
  if (verdict.cause)
    json["cause"] = {{"text", verdict.cause->text},
                     {"round_off_over_peak", verdict.cause->round_off_over_peak},
                     {"max_over_peak", verdict.cause->over_peak}};
}

inline void to_json(Json& json, const PlausibilitySection& section) {
  const auto warning = [](const PlausibilityRow& row) {
    return Json{{"code", row.code}, {"text", row.text}};
  };
  const auto meant = [&](const PlausibilityRow& row) {
    Json entry = warning(row);
    entry["reason"] = row.reason;
    return entry;
  };
  json = {{"summary", section.summary},
          {"warnings", list_of(section.warnings, warning)},
          {"meant", list_of(section.meant, meant)}};
}

inline void to_json(Json& json, const ValidityRow& row) {
  const auto known = [&](double value) { return row.applicable ? Json(value) : Json(); };
  json = {{"limit", row.limit},
          {"share_percent", known(100 * row.violated_share)},
          {"worst", known(row.worst)},
          {"unit", row.unit},
          {"theta_deg", known(row.theta_deg)},
          {"violated", row.applicable && row.violated_share > 0},
          {"applicable", row.applicable},
          {"consequence", row.consequence}};
  if (row.time_s) json["time_s"] = known(*row.time_s);
}

inline void to_json(Json& json, const Budget::Torque& line) {
  json = {{"cause", line.cause},       {"column", line.column},
          {"mean", line.mean},         {"least", line.least},
          {"greatest", line.greatest}, {"carrying", line.carrying},
          {"verdict", line.verdict},   {"max_abs", line.largest_difference}};
}

BENTAXIS_JSON(Budget, text, models, torque, power, efficiency, block)

inline void to_json(Json& json, const AssumptionSplit& assumptions) {
  const compare::Split& split = assumptions.split;
  const auto channel_of = [&](const compare::ChannelSplit& channel) {
    const auto over_peak = [&](double value) {
      return channel.peak > 0 ? value / channel.peak : 0;
    };
    Json parts = Json::array();
    for (std::size_t i = 0; i < split.assumptions.size(); ++i)
      parts.push_back({{"assumption", split.assumptions[i]},
                       {"max_abs", channel.contributions[i].largest},
                       {"over_peak", over_peak(channel.contributions[i].largest)},
                       {"mean", channel.contributions[i].mean}});
    return Json{
        {"name", channel.channel.name},
        {"group", channel.channel.group},
        {"kind", channel.channel.kind},
        {"unit", channel.channel.unit},
        {"peak", channel.peak},
        {"max_abs", channel.largest_difference},
        {"over_peak", over_peak(channel.largest_difference)},
        {"contributions", parts},
        {"rest", channel.rest},
        {"rest_over_peak", channel.rest_over_peak()},
        {"verdict", channel.rest_over_peak() <= split.tolerance ? "explained" : "unexplained"}};
  };
  json = {{"text", assumptions.text}, {"rows", assumptions.rows}, {"channels", Json::array()}};
  for (const compare::ChannelSplit& channel : split.channels)
    if (channel.computed) json["channels"].push_back(channel_of(channel));
}

inline void to_json(Json& json, const LongRunSection& run) {
  json = run.section;
  json["bounded"] = run.bounded;
}

namespace {

Json json_of(const std::optional<compare::PublishedValue>& value) {
  if (!value) return nullptr;
  if (value->low == value->high) return rounded(value->low, 6);
  return compare::text_of(*value);
}

Json json_of(const PublishedTable& published) {
  const compare::PublishedSection& section = published.section;
  const auto row_of = [&](const compare::PublishedRow& row) {
    Json json = {{"quantity", row.number.quantity},
                 {"paper", row.printed},
                 {"unit", row.number.unit},
                 {"status", row.number.status},
                 {"at", row.at},
                 {"condition", row.number.condition},
                 {"variant", row.number.variant},
                 {"counted", row.counted()},
                 {"verdict", compare::to_string(row.verdict)},
                 {"where", row.where}};
    for (std::size_t m = 0; m < section.models.size(); ++m)
      json[section.models[m]] = json_of(row.values[m]);
    return json;
  };
  return {{"text", published.text},
          {"rows", list_of(section.rows, row_of)},
          {"predicted", section.summary.predicted},
          {"predicted_comparable", section.summary.predicted_comparable},
          {"predicted_inside", section.summary.predicted_inside}};
}

// One row of `tradeoff`: an object whose keys are the row's own.
Json json_of(const Record& record) {
  Json row = Json::object();
  for (const auto& [key, cell] : record) row[key] = cell;
  return row;
}

// The parts of a report that are there.
Json json_of(const Document& document) {
  Json json = {{"schema", 1}, {"title", document.title}, {"program", document.program}};
  put(json, "files", document.files);
  put(json, "provenance", document.provenance);
  put(json, "case", document.the_case);
  put(json, "plausibility", document.plausibility);
  put(json, "derived", document.derived);
  put(json, "verdict", document.verdict);
  put(json, "meaning", document.meaning);
  put(json, "key_figures", document.key_figures);
  put(json, "summary", document.summary);
  put(json, "warnings", document.warnings);
  put(json, "common", document.common);
  put(json, "validity", document.validity);
  put(json, "timing", document.timing);
  put(json, "models", document.models);
  if (document.comparison) {
    json["channels"] = document.comparison->channels;
    // A comparison says so where there is nothing to take apart and nothing printed to hold it to.
    json["assumptions"] = nullptr;
    json["published"] = nullptr;
  }
  put(json, "checks", document.checks);
  put(json, "budget", document.budget);
  put(json, "assumptions", document.assumptions);
  if (document.published) json["published"] = json_of(*document.published);
  put(json, "runs", document.runs);
  put(json, "figures", document.figures);
  if (document.records)
    json["rows"] = list_of(*document.records, [](const Record& record) { return json_of(record); });
  put(json, "cases", document.hard_cases);
  put(json, "long_run", document.long_run);
  return json;
}

}  // namespace

inline void to_json(Json& json, const Curves& curves) {
  const auto columns = [](const auto& named, int digits) {
    Json object = Json::object();
    for (const auto& [name, values] : named) object[name] = rounded(values, digits);
    return object;
  };
  const auto table_of = [&](const Curves::Table& table) {
    return Json{{"name", table.name}, {"columns", columns(table.columns, kPlotDigits)}};
  };
  json = {{"theta_deg", curves.theta_deg},
          {"tables", list_of(curves.tables, table_of)},
          {"difference", columns(curves.difference, kDifferenceDigits)}};
  put(json, "axis", curves.axis);
  put(json, "marks", curves.marks);
  if (curves.samples > 0) json["samples"] = curves.samples;
  if (!curves.reference) return;
  Json held = Json::object();
  for (const Curves::Held& one : curves.reference->held) {
    Json& entry = held[one.channel] = {{"values", rounded(one.values)},
                                       {"allowed", one.allowed},
                                       {"difference", columns(one.differences, kDifferenceDigits)}};
    if (one.low.empty()) continue;
    entry["low"] = rounded(one.low);
    entry["high"] = rounded(one.high);
  }
  json["reference"] = {{"name", curves.reference->name}, {"held", held}};
}

namespace {

// A column as the upper five bytes of each number, little-endian: 9 digits. What was not computed
// is NaN.
constexpr int kDroppedBits = 24;

std::uint64_t kept_bits(double value) {
  if (!std::isfinite(value)) return std::uint64_t{0x7FF8} << (48 - kDroppedBits);
  return (std::bit_cast<std::uint64_t>(value) + (std::uint64_t{1} << (kDroppedBits - 1))) >>
         kDroppedBits;
}
double kept(double value) { return std::bit_cast<double>(kept_bits(value) << kDroppedBits); }

std::string packed(const Values& values) {
  std::string bytes;
  for (const double value : values)
    for (int byte = 0; byte < 5; ++byte)
      bytes += static_cast<char>((kept_bits(value) >> (8 * byte)) & 0xFF);
  return base64_of(bytes);
}

// Whether the second table's column is, to the digits kept, the first one's and the difference.
bool follows(const Values& first, const Values& second, const Values* difference) {
  constexpr double kLastDigit = 5e-9;
  if (first.size() != second.size()) return false;
  for (std::size_t row = 0; row < first.size(); ++row) {
    if (std::isfinite(first[row]) != std::isfinite(second[row])) return false;
    if (!std::isfinite(first[row])) continue;
    const double found = kept(first[row]) + (difference != nullptr ? kept((*difference)[row]) : 0);
    if (!(std::abs(found - second[row]) <= kLastDigit * std::abs(second[row]))) return false;
  }
  return true;
}

Json packed_tables(const Curves& curves) {
  Json tables = Json::array();
  for (std::size_t t = 0; t < curves.tables.size(); ++t) {
    Json columns = Json::object();
    for (const auto& [name, values] : curves.tables[t].columns) {
      const Values* first = t == 1 ? find(curves.tables[0].columns, name) : nullptr;
      const Values* difference = find(curves.difference, name);
      if (first != nullptr && follows(*first, values, difference))
        columns[name] = true;
      else
        columns[name] = packed(values);
    }
    tables.push_back({{"name", curves.tables[t].name}, {"columns", std::move(columns)}});
  }
  return tables;
}

// A zero is written without its sign.
void drop_signs_of_zeros(Json& json) {
  if (json.is_structured())
    for (Json& one : json) drop_signs_of_zeros(one);
  else if (json.is_number_float() && json.get<double>() == 0)
    json = 0.0;
}

std::string dumped(Json json, int indent) {
  drop_signs_of_zeros(json);
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

FigureContent::FigureContent() = default;
FigureContent::~FigureContent() = default;
FigureContent::FigureContent(const FigureContent&) = default;
FigureContent::FigureContent(FigureContent&&) noexcept = default;
FigureContent& FigureContent::operator=(const FigureContent&) = default;
FigureContent& FigureContent::operator=(FigureContent&&) noexcept = default;

Document::Document() = default;
Document::~Document() = default;
Document::Document(const Document&) = default;
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(const Document&) = default;
Document& Document::operator=(Document&&) noexcept = default;

ModelSection model_of(const ResultTable& table, const Lines& assumptions) {
  return {table.name, assumptions, table.provenance.facts, table.provenance.seconds, table.rows()};
}

std::string json_text(const Document& document) { return dumped(json_of(document), 1) + "\n"; }
std::string compact_json(const Document& document) { return dumped(json_of(document), -1); }
std::string compact_json(const Curves& curves) { return dumped(curves, -1); }

std::string packed_json(const Curves& curves) {
  Curves rest = curves;
  rest.tables.clear();
  rest.difference.clear();
  Json json = rest;
  json["tables"] = packed_tables(curves);
  for (const auto& [name, values] : curves.difference) json["difference"][name] = packed(values);
  return dumped(json, -1);
}

std::vector<std::string> files_of(const std::string& json_text) {
  std::vector<std::string> names;
  const Json json = Json::parse(json_text, nullptr, false);
  if (!json.is_object() || !json.contains("files")) return names;
  for (const Json& name : json["files"])
    if (name.is_string()) names.push_back(name.get<std::string>());
  return names;
}

}  // namespace bentaxis::report
