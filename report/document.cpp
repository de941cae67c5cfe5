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

BENTAXIS_JSON_GIVEN(Axis, (from, to), label, unit, log)
BENTAXIS_JSON_GIVEN(XySeries, (dashed), label, x, y)
BENTAXIS_JSON_GIVEN(BarsFigure::Bar, (interval), label, low, high, note)

inline void to_json(Json& json, const Ends& ends) { json = {ends.low, ends.high}; }

inline void to_json(Json& json, const Series& s) {
  json = {{"label", s.label}, {"values", rounded(s.values)}};
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

inline void to_json(Json& json, const DrawingFigure::Shades& shades) {
  json = {{"label", shades.label}, {"unit", shades.unit}, {"range", {shades.low, shades.high}}};
}

inline void to_json(Json& json, const DrawingFigure::Panel& panel) {
  json = {{"x", panel.x},
          {"y", panel.y},
          {"x_range", {panel.x_low, panel.x_high}},
          {"y_range", {panel.y_low, panel.y_high}}};
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

// ---- What the kinds of figures differ in

inline Json with_values(const Axis& axis, const Values& values) {
  Json json = axis;
  json["values"] = values;
  return json;
}

BENTAXIS_JSON_GIVEN(ChannelFigure, (curves, ends), unit, channels, extra)
BENTAXIS_JSON(PistonBars, unit, channels, angles)
BENTAXIS_JSON(OwnFigure::Right, value, unit, series)
BENTAXIS_JSON(XyFigure, x, y, series, equal, points)
BENTAXIS_JSON(ScatterFigure, x, y, series)
BENTAXIS_JSON_GIVEN(DrawingFigure, (shades, ground, axis), looks, panels, frames, shown)
BENTAXIS_JSON(BarsFigure, x, bars)
BENTAXIS_JSON(ParallelFigure, columns, colour_by, marked, marked_label)

inline void to_json(Json& json, const OwnFigure& figure) {
  json = {{"unit", figure.unit},
          {"value", figure.value},
          {"x", {{"label", figure.axis}, {"angle", figure.angle}, {"values", rounded(figure.x)}}},
          {"series", figure.series}};
  put(json, "stack", figure.stack);
  put(json, "right", figure.right);
  put(json, "ends", figure.ends);
}

inline void to_json(Json& json, const MapFigure& figure) {
  json = {{"x", with_values(figure.x, figure.x_values)},
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
}

inline void to_json(Json& json, const BandFigure& figure) {
  json = {{"x", with_values(figure.x, figure.x_values)},
          {"y", figure.y},
          {"bands", figure.bands},
          {"lines", figure.lines}};
  json["x"]["angle"] = figure.angle;
}

inline void to_json(Json& json, const Figure& figure) {
  constexpr const char* kKinds[] = {"curves",  "piston_bars", "own_axis", "xy",    "map",
                                    "scatter", "drawing",     "bars",     "bands", "parallel"};
  json = std::visit([](const auto& content) { return Json(content); }, figure.content);
  json["kind"] = kKinds[figure.content.index()];
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

inline void to_json(Json& json, const WorstChannel& worst) {
  json = {{"channel", worst.channel},
          {"max_over_peak", worst.over_peak},
          {"theta_deg", worst.theta_deg}};
}

inline void to_json(Json& json, const Verdict::Cause& cause) {
  json = {{"text", cause.text},
          {"round_off_over_peak", cause.round_off_over_peak},
          {"max_over_peak", cause.over_peak}};
}

// Of what was compared the digits and the worst channel are there in any case.
inline void to_json(Json& json, const Verdict& v) {
  json = {{"agrees", v.agrees}, {"headline", v.headline}};
  if (v.compared)
    json.update({{"compared", *v.compared}, {"digits", v.digits}, {"worst", nullptr}});
  put(json, "worst", v.worst);
  put(json, "answers", v.answers);
  put(json, "word", v.word);
  put(json, "not_valid", v.not_valid);
  put(json, "tolerance", v.tolerance);
  put(json, "checks_hold", v.checks_hold);
  put(json, "rest_over_peak", v.rest_over_peak);
  put(json, "rest_tolerance", v.rest_tolerance);
  put(json, "reference", v.reference);
  put(json, "fit", v.fit);
  put(json, "models_agree", v.models_agree);
  put(json, "cause", v.cause);
}

inline void to_json(Json& json, const PlausibilitySection& section) {
  json = {{"summary", section.summary}, {"warnings", Json::array()}, {"meant", Json::array()}};
  for (const PlausibilityRow& row : section.warnings)
    json["warnings"].push_back({{"code", row.code}, {"text", row.text}});
  for (const PlausibilityRow& row : section.meant)
    json["meant"].push_back({{"code", row.code}, {"text", row.text}, {"reason", row.reason}});
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

}  // namespace bentaxis::report

namespace bentaxis::compare {

inline nlohmann::json json_of(const std::optional<PublishedValue>& value) {
  if (!value) return nullptr;
  if (value->low == value->high) return rounded(value->low, 6);
  return text_of(*value);
}

inline void to_json(nlohmann::json& json, const PublishedTable& published) {
  const PublishedSection& section = published.section;
  json = {{"text", published.text},
          {"rows", nlohmann::json::array()},
          {"predicted", section.summary.predicted},
          {"predicted_comparable", section.summary.predicted_comparable},
          {"predicted_inside", section.summary.predicted_inside}};
  for (const PublishedRow& row : section.rows) {
    nlohmann::json& entry = json["rows"].emplace_back();
    entry = {{"quantity", row.number.quantity},
             {"paper", row.printed},
             {"unit", row.number.unit},
             {"status", row.number.status},
             {"at", row.at},
             {"condition", row.number.condition},
             {"variant", row.number.variant},
             {"counted", row.counted()},
             {"verdict", to_string(row.verdict)},
             {"where", row.where}};
    for (std::size_t m = 0; m < section.models.size(); ++m)
      entry[section.models[m]] = json_of(row.values[m]);
  }
}

}  // namespace bentaxis::compare

namespace bentaxis::report {
namespace {

// ---- The parts of a report

// Puts a part into the report's JSON where it is there.
template <auto part>
void put_part(Json& json, const char* key, const Document& document) {
  put(json, key, document.*part);
}

// A comparison says so where there is nothing to take apart and nothing printed to hold it to.
void put_comparison(Json& json, const char* key, const Document& document) {
  if (!document.comparison) return;
  json[key] = document.comparison->channels;
  for (const char* other : {"assumptions", "published"})
    if (!json.contains(other)) json[other] = nullptr;
}

// Objects whose keys are the row's own.
void put_records(Json& json, const char* key, const Document& document) {
  if (!document.records) return;
  json[key] = list_of(*document.records, [](const Record& record) {
    Json row = Json::object();
    for (const auto& [name, cell] : record) row[name] = cell;
    return row;
  });
}

// Every part with its key; docs/report.schema.json has each, and docs/report_json.md its meaning.
constexpr struct {
  const char* key;
  void (*put)(Json& json, const char* key, const Document& document);
} kParts[] = {{"files", put_part<&Document::files>},
              {"provenance", put_part<&Document::provenance>},
              {"case", put_part<&Document::the_case>},
              {"plausibility", put_part<&Document::plausibility>},
              {"derived", put_part<&Document::derived>},
              {"verdict", put_part<&Document::verdict>},
              {"meaning", put_part<&Document::meaning>},
              {"key_figures", put_part<&Document::key_figures>},
              {"summary", put_part<&Document::summary>},
              {"warnings", put_part<&Document::warnings>},
              {"common", put_part<&Document::common>},
              {"validity", put_part<&Document::validity>},
              {"timing", put_part<&Document::timing>},
              {"models", put_part<&Document::models>},
              {"checks", put_part<&Document::checks>},
              {"budget", put_part<&Document::budget>},
              {"assumptions", put_part<&Document::assumptions>},
              {"published", put_part<&Document::published>},
              {"channels", put_comparison},
              {"runs", put_part<&Document::runs>},
              {"figures", put_part<&Document::figures>},
              {"rows", put_records},
              {"cases", put_part<&Document::hard_cases>},
              {"long_run", put_part<&Document::long_run>}};

Json json_of(const Document& document) {
  Json json = {{"schema", 1}, {"title", document.title}, {"program", document.program}};
  for (const auto& part : kParts) part.put(json, part.key, document);
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

BENTAXIS_COMPILED_HERE(FigureContent)
BENTAXIS_COMPILED_HERE(Document)

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
