#include "bentaxis/report/document.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base64.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/report/picture.h"

namespace bentaxis::report {
namespace {

using Json = nlohmann::json;

Json to_json(const Curves& curves);

constexpr int kPlotDigits = 9;
constexpr int kDifferenceDigits = 4;  // differences are known to their order of magnitude

const char* to_string(ChannelKind kind) {
  switch (kind) {
    case ChannelKind::reaction:
      return "reaction";
    case ChannelKind::derived:
      return "derived";
    case ChannelKind::input:
      return "input";
    case ChannelKind::check:
      break;
  }
  return "check";
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class Value>
Json value_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

// A plot needs no more digits, and a page is a third shorter.
Json rounded(double value, int digits) {
  if (!is_computed(value)) return nullptr;
  return bentaxis::rounded(value, digits);
}

Json rounded(const Values& values, int digits = kPlotDigits) {
  Json list = Json::array();
  for (const double value : values) list.push_back(rounded(value, digits));
  return list;
}

Json exact(const Values& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number_or_null(value));
  return list;
}

// Declared for list_of and add, which are templates.
Json json_of(const Section&);
Json json_of(const Record&);
Json json_of(const Figure&);
Json json_of(const Provenance&);
Json json_of(const CaseSection&);
Json json_of(const DerivedQuantity&);
Json json_of(const Verdict&);
Json json_of(const Summary&);
Json json_of(const PlausibilitySection&);
Json json_of(const Warning&);
Json json_of(const CommonInput&);
Json json_of(const ValidityRow&);
Json json_of(const TimingRow&);
Json json_of(const ModelSection&);
Json json_of(const compare::Harmonic&);
Json json_of(const compare::ChannelComparison&);
Json json_of(const compare::Check&);
Json json_of(const KeyFigures::Row&);
Json json_of(const Budget::Torque&);
Json json_of(const Budget::Quantity&);
Json json_of(const Budget&);
Json json_of(const AssumptionSplit&);
Json json_of(const PublishedTable&);
Json json_of(const HardCaseRow::Model&);
Json json_of(const HardCaseRow&);
Json json_of(const LongRunSection&);

// An array of what `one` makes of each item.
template <class Items, class One>
Json list_of(const Items& items, One one) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(one(item));
  return list;
}

// An array of the items' JSON.
template <class Items>
Json list_of(const Items& items) {
  return list_of(items, [](const auto& item) { return json_of(item); });
}

// ---- Blocks

Json json_of(const Cell& cell) {
  if (const auto* flag = std::get_if<bool>(&cell)) return *flag;
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* count = std::get_if<long>(&cell)) return *count;
  if (const auto* number = std::get_if<double>(&cell)) return number_or_null(*number);
  return nullptr;
}

Json json_of(const Section& section) {
  return {{"title", section.title},
          {"text", section.text},
          {"facts", section.facts},
          {"table",
           {{"columns", section.table.columns},
            {"rows", list_of(section.table.rows, [](const auto& row) {
               return list_of(row, [](const Cell& cell) { return json_of(cell); });
             })}}}};
}

Json json_of(const Record& record) {
  Json row = Json::object();
  for (const auto& [key, cell] : record) row[key] = json_of(cell);
  return row;
}

// ---- Figures

Json json_of(const Axis& axis) {
  Json json = {{"label", axis.label}, {"unit", axis.unit}, {"log", axis.log}};
  if (axis.from) json["from"] = *axis.from;
  if (axis.to) json["to"] = *axis.to;
  return json;
}

Json json_of(const Axis& axis, const Values& values) {
  Json json = json_of(axis);
  json["values"] = exact(values);
  return json;
}

Json json_of(const Ends& ends) { return {ends.low, ends.high}; }

Json points_of(const std::vector<NamedPoint>& points) {
  return list_of(points, [](const NamedPoint& p) {
    return Json{{"label", p.label}, {"x", number_or_null(p.x)}, {"y", number_or_null(p.y)}};
  });
}

Json series_of(const std::vector<Series>& series) {
  return list_of(series, [](const Series& s) {
    return Json{{"label", s.label}, {"values", rounded(s.values)}};
  });
}

Json json_of(const ChannelFigure& figure) {
  Json json = {{"kind", "curves"},
               {"unit", figure.unit},
               {"channels", figure.channels},
               {"extra", series_of(figure.extra)}};
  if (figure.curves) json["curves"] = to_json(*figure.curves);
  if (figure.ends) json["ends"] = json_of(*figure.ends);
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
      {"series", series_of(figure.series)}};
  if (!figure.stack.empty()) json["stack"] = series_of(figure.stack);
  if (figure.right)
    json["right"] = {{"value", figure.right->value},
                     {"unit", figure.right->unit},
                     {"series", series_of(figure.right->series)}};
  if (figure.ends) json["ends"] = json_of(*figure.ends);
  return json;
}

Json json_of(const XySeries& s) {
  Json json = {{"label", s.label}, {"x", exact(s.x)}, {"y", exact(s.y)}};
  if (s.dashed) json["dashed"] = true;
  return json;
}

Json json_of(const XyFigure& figure) {
  return {{"kind", "xy"},
          {"x", json_of(figure.x)},
          {"y", json_of(figure.y)},
          {"series", list_of(figure.series, [](const XySeries& s) { return json_of(s); })},
          {"equal", figure.equal},
          {"points", points_of(figure.points)}};
}

Json json_of(const MapFigure& figure) {
  Json json = {{"kind", "map"},
               {"x", json_of(figure.x, figure.x_values)},
               {"y", json_of(figure.y, figure.y_values)},
               {"z", {{"label", figure.z.label}, {"unit", figure.z.unit}}},
               {"values", list_of(figure.values, [](const Values& row) { return exact(row); })},
               {"contours", figure.contours},
               {"points", points_of(figure.points)}};
  if (!figure.classes.empty()) json["classes"] = figure.classes;
  if (figure.linear) json["linear"] = true;
  if (!figure.lines.empty())
    json["lines"] = list_of(figure.lines, [](const XySeries& s) { return json_of(s); });
  if (figure.marks) json["marks"] = json_of(*figure.marks);
  if (figure.z.from) json["z"]["from"] = *figure.z.from;
  if (!figure.reasons.empty()) json["reasons"] = figure.reasons;
  return json;
}

Json json_of(const ScatterFigure& figure) {
  return {{"kind", "scatter"},
          {"x", json_of(figure.x)},
          {"y", json_of(figure.y)},
          {"series", list_of(figure.series, [](const ScatterSeries& s) {
             return Json{{"name", s.name},
                         {"style", value_or_null(s.style)},
                         {"line", s.line},
                         {"emphasis", s.emphasis},
                         {"points", list_of(s.points, [](const ScatterPoint& p) {
                            return Json{{"x", number_or_null(p.x)},
                                        {"y", number_or_null(p.y)},
                                        {"note", p.note}};
                          })}};
           })}};
}

// Thousandths are more than a picture shows.
Json drawn_values(const Values& values) {
  constexpr double kShown = 1e3;
  return list_of(values, [](double v) { return number_or_null(std::round(v * kShown) / kShown); });
}

Json json_of(const DrawingFigure& figure) {
  const auto panel_of = [](const DrawingFigure::Panel& panel) {
    Json json = {{"x", json_of(panel.x)}, {"y", json_of(panel.y)}};
    json["x_range"] = {panel.x_low, panel.x_high};
    json["y_range"] = {panel.y_low, panel.y_high};
    return json;
  };
  const auto line_of = [](const DrawingFigure::Line& line) {
    Json json = {{"panel", line.panel},
                 {"look", line.look},
                 {"width", line.width},
                 {"x", drawn_values(line.x)},
                 {"y", drawn_values(line.y)}};
    if (line.value) json["value"] = number_or_null(*line.value);
    return json;
  };
  const auto frame_of = [&](const DrawingFigure::Frame& frame) {
    return Json{{"theta_deg", frame.theta_deg},
                {"text", frame.text},
                {"lines", list_of(frame.lines, line_of)},
                {"arrows", list_of(frame.arrows, [](const DrawingFigure::Arrow& arrow) {
                   return Json{{"panel", arrow.panel},           {"look", arrow.look},
                               {"x", number_or_null(arrow.x)},   {"y", number_or_null(arrow.y)},
                               {"dx", number_or_null(arrow.dx)}, {"dy", number_or_null(arrow.dy)}};
                 })}};
  };
  Json json = {
      {"kind", "drawing"},
      {"looks",
       list_of(
           figure.looks,
           [](const DrawingFigure::Look& look) {
             return Json{{"label", look.label}, {"colour", look.colour}, {"filled", look.filled}};
           })},
      {"panels", list_of(figure.panels, panel_of)},
      {"frames", list_of(figure.frames, frame_of)},
      {"shown", figure.shown}};
  if (figure.shades)
    json["shades"] = {{"label", figure.shades->label},
                      {"unit", figure.shades->unit},
                      {"range", {figure.shades->low, figure.shades->high}}};
  if (!figure.ground.empty()) json["ground"] = list_of(figure.ground, line_of);
  if (!figure.axis.empty()) json["axis"] = figure.axis;
  return json;
}

Json json_of(const BarsFigure& figure) {
  const auto bar_of = [](const BarsFigure::Bar& bar) {
    Json json = {{"label", bar.label},
                 {"low", number_or_null(bar.low)},
                 {"high", number_or_null(bar.high)},
                 {"note", bar.note}};
    if (bar.interval)
      json["interval"] = {number_or_null(bar.interval->first),
                          number_or_null(bar.interval->second)};
    return json;
  };
  return {{"kind", "bars"}, {"x", json_of(figure.x)}, {"bars", list_of(figure.bars, bar_of)}};
}

Json json_of(const BandFigure& figure) {
  Json x = json_of(figure.x, figure.x_values);
  x["angle"] = figure.angle;
  const auto band_of = [](const BandFigure::Band& band) {
    return Json{{"label", band.label},
                {"low", rounded(band.low)},
                {"middle", rounded(band.middle)},
                {"high", rounded(band.high)}};
  };
  return {{"kind", "bands"},
          {"x", x},
          {"y", json_of(figure.y)},
          {"bands", list_of(figure.bands, band_of)},
          {"lines", list_of(figure.lines, [](const XySeries& s) { return json_of(s); })}};
}

Json json_of(const ParallelFigure& figure) {
  const auto column_of = [](const ParallelFigure::Column& column) {
    Json json = {{"label", column.label},
                 {"unit", column.unit},
                 {"log", column.log},
                 {"values", rounded(column.values)}};
    if (!column.words.empty()) json["words"] = column.words;
    return json;
  };
  return {{"kind", "parallel"},
          {"columns", list_of(figure.columns, column_of)},
          {"colour_by", figure.colour_by},
          {"marked", figure.marked},
          {"marked_label", figure.marked_label}};
}

Json json_of(const Figure& figure) {
  Json json = std::visit([](const auto& content) { return json_of(content); }, figure.content);
  json["id"] = figure.id;
  json["file"] = file_name_of(figure);
  json["title"] = figure.title;
  json["paper"] = figure.paper;
  json["note"] = figure.note;
  return json;
}

// ---- Sections

Json json_of(const Provenance& from) {
  return {{"command", from.command},
          {"date", from.date},
          {"version", from.version},
          {"inputs", list_of(from.inputs,
                             [](const Provenance::Input& input) {
                               return Json{{"file", input.file}, {"sha256", input.sha256}};
                             })},
          {"machine", from.machine}};
}

Json json_of(const CaseSection& section) {
  return {{"file", section.file}, {"entries", list_of(section.entries, [](const InputEntry& entry) {
                                     return Json{{"table", entry.table},
                                                 {"key", entry.key},
                                                 {"value", entry.value},
                                                 {"defaulted", entry.defaulted},
                                                 {"changed", entry.changed}};
                                   })}};
}

Json json_of(const DerivedQuantity& q) {
  return {{"name", q.name},
          {"symbol", q.symbol},
          {"value", q.value},
          {"unit", q.unit},
          {"source", q.source}};
}

Json json_of(const Verdict& verdict) {
  Json json = {{"agrees", verdict.agrees ? Json(*verdict.agrees) : Json()},
               {"headline", verdict.headline}};
  if (!verdict.word.empty()) json["word"] = verdict.word;
  if (verdict.tolerance) json["tolerance"] = *verdict.tolerance;
  if (verdict.compared) {
    json["compared"] = *verdict.compared;
    json["digits"] = value_or_null(verdict.digits);
    json["worst"] = nullptr;
  }
  if (verdict.checks_hold) json["checks_hold"] = *verdict.checks_hold;
  if (verdict.worst)
    json["worst"] = {{"channel", verdict.worst->channel},
                     {"max_over_peak", verdict.worst->over_peak},
                     {"theta_deg", verdict.worst->theta_deg}};
  if (verdict.rest_over_peak) json["rest_over_peak"] = *verdict.rest_over_peak;
  if (verdict.rest_tolerance) json["rest_tolerance"] = *verdict.rest_tolerance;
  if (verdict.reference)
    json["reference"] = {{"name", verdict.reference->name},
                         {"agrees", verdict.reference->agrees},
                         {"headline", verdict.reference->headline}};
  if (verdict.fit)
    json["fit"] = {{"chi_square", number_or_null(verdict.fit->chi_square)},
                   {"degrees_of_freedom", verdict.fit->degrees_of_freedom},
                   {"p_value", value_or_null(verdict.fit->p_value)},
                   {"refuted_below", verdict.fit->refuted_below},
                   {"refuted", verdict.fit->refuted}};
  if (verdict.models_agree) json["models_agree"] = *verdict.models_agree;
  if (verdict.cause)
    json["cause"] = {{"text", verdict.cause->text},
                     {"round_off_over_peak", verdict.cause->round_off_over_peak},
                     {"max_over_peak", verdict.cause->over_peak}};
  return json;
}

Json json_of(const Summary& summary) {
  return {{"text", summary.text},
          {"groups", list_of(summary.groups, [](const Summary::Group& group) {
             return Json{{"title", group.title}, {"lines", group.lines}};
           })}};
}

Json json_of(const PlausibilitySection& section) {
  return {{"summary", section.summary},
          {"warnings", list_of(section.warnings,
                               [](const DoubtRow& row) {
                                 return Json{{"code", row.code}, {"text", row.text}};
                               })},
          {"meant", list_of(section.meant, [](const DoubtRow& row) {
             return Json{{"code", row.code}, {"text", row.text}, {"reason", row.reason}};
           })}};
}

Json json_of(const Warning& warning) { return {{"name", warning.name}, {"text", warning.text}}; }

Json json_of(const CommonInput& common) {
  return {{"input", common.input}, {"value", common.value}, {"caught_by", common.caught_by}};
}

Json json_of(const ValidityRow& row) {
  const auto known = [&](double value) { return row.applicable ? Json(value) : Json(nullptr); };
  return {{"limit", row.limit},
          {"share_percent", known(100 * row.violated_share)},
          {"worst", known(row.worst)},
          {"unit", row.unit},
          {"theta_deg", known(row.theta_deg)},
          {"violated", row.applicable && row.violated_share > 0},
          {"applicable", row.applicable},
          {"consequence", row.consequence}};
}

Json json_of(const TimingRow& row) {
  Json angles = Json::array();
  for (const auto& [from, to] : row.angles) angles.push_back({from, to});
  return {{"code", row.code},
          {"quantity", row.quantity},
          {"value", number_or_null(row.value)},
          {"unit", row.unit},
          {"limit", value_or_null(row.limit)},
          {"flagged", row.flagged},
          {"theta_deg", value_or_null(row.theta_deg)},
          {"angles", angles},
          {"meant", row.meant},
          {"text", row.text}};
}

Json json_of(const ModelSection& model) {
  return {{"name", model.name},
          {"assumptions", model.assumptions},
          {"facts", model.facts},
          {"seconds", number_or_null(model.seconds)},
          {"angles", model.angles}};
}

Json json_of(const compare::Harmonic& harmonic) {
  return {{"order", harmonic.order},
          {"amplitude", {harmonic.amplitude[0], harmonic.amplitude[1]}},
          {"phase_deg", list_of(harmonic.phase_deg, value_or_null<double>)}};
}

Json json_of(const compare::ChannelComparison& c) {
  const Channel& channel = c.channel;
  Json row = {{"name", channel.name},
              {"quantity", channel.quantity},
              {"meaning", channel.meaning},
              {"equation", channel.equation},
              {"piston", channel.piston},
              {"axis", channel.axis},
              {"frame", channel.frame},
              {"on_body", channel.on_body},
              {"by_body", channel.by_body},
              {"point", channel.point},
              {"unit", channel.unit},
              {"group", channel.group},
              {"kind", to_string(channel.kind)},
              {"compared", c.judged},
              {"peak", c.peak},
              {"peak_is_floor", c.at_floor},
              {"verdict", compare::to_string(c.verdict)},
              {"tolerance", c.tolerance}};
  if (!c.gap.empty()) row["gap"] = c.gap;
  if (!c.compared()) {
    for (const char* key : {"max_abs", "max_over_peak", "rms", "rms_over_peak", "theta_of_max_deg",
                            "mean_difference", "digits", "own_peak"})
      row[key] = nullptr;
    row["mean"] = {nullptr, nullptr};
    row["orders"] = Json::array();
    return row;
  }
  row["own_peak"] = c.own_peak;
  row["max_abs"] = c.largest;
  row["max_over_peak"] = number_or_null(c.largest_over_peak());
  row["rms"] = c.rms;
  row["rms_over_peak"] = number_or_null(c.rms_over_peak());
  row["theta_of_max_deg"] = c.theta_of_largest_deg;
  row["mean"] = {c.mean[0], c.mean[1]};
  row["mean_difference"] = c.mean_difference;
  row["digits"] = c.digits;
  row["orders"] = list_of(c.harmonics);
  return row;
}

Json json_of(const compare::Check& check) {
  return {{"model", check.table},
          {"name", check.name},
          {"worst", check.worst},
          {"unit", check.unit},
          {"scale", check.scale},
          {"relative", check.relative()},
          {"tolerance", check.tolerance},
          {"theta_deg", check.theta_deg},
          {"verdict", check.holds() ? "holds" : "violated"}};
}

Json json_of(const KeyFigures::Row& row) {
  return {{"quantity", row.quantity},
          {"symbol", row.symbol},
          {"unit", row.unit},
          {"values", exact(row.values)},
          {"difference", value_or_null(row.difference)},
          {"over_value", value_or_null(row.over_value)},
          {"at", value_or_null(row.at)},
          {"note", row.note}};
}

Json json_of(const KeyFigures& key) {
  return {{"models", key.models}, {"at_unit", key.at_unit}, {"rows", list_of(key.rows)}};
}

Json json_of(const Budget::Torque& line) {
  return {{"cause", line.cause},
          {"column", line.column},
          {"mean", exact(line.mean)},
          {"least", exact(line.least)},
          {"greatest", exact(line.greatest)},
          {"carrying", exact(line.carrying)},
          {"max_abs", line.largest_difference},
          {"verdict", line.verdict}};
}

Json json_of(const Budget::Quantity& quantity) {
  return {{"name", quantity.name},
          {"kind", quantity.kind},
          {"unit", quantity.unit},
          {"values", exact(quantity.values)},
          {"note", quantity.note}};
}

Json json_of(const Budget& budget) {
  return {{"text", budget.text},
          {"models", budget.models},
          {"torque", list_of(budget.torque)},
          {"power", list_of(budget.power)},
          {"efficiency", list_of(budget.efficiency)},
          {"block", list_of(budget.block)}};
}

Json json_of(const compare::Split& split, const compare::ChannelSplit& channel) {
  const auto over_peak = [&](double value) { return channel.peak > 0 ? value / channel.peak : 0; };
  Json parts = Json::array();
  for (std::size_t i = 0; i < split.assumptions.size(); ++i)
    parts.push_back({{"assumption", split.assumptions[i]},
                     {"max_abs", channel.contributions[i].largest},
                     {"over_peak", over_peak(channel.contributions[i].largest)},
                     {"mean", channel.contributions[i].mean}});
  return {{"name", channel.channel.name},
          {"group", channel.channel.group},
          {"kind", to_string(channel.channel.kind)},
          {"unit", channel.channel.unit},
          {"peak", channel.peak},
          {"max_abs", channel.largest_difference},
          {"over_peak", over_peak(channel.largest_difference)},
          {"contributions", parts},
          {"rest", channel.rest},
          {"rest_over_peak", channel.rest_over_peak()},
          {"verdict", channel.rest_over_peak() <= split.tolerance ? "explained" : "unexplained"}};
}

Json json_of(const AssumptionSplit& assumptions) {
  Json section = {
      {"text", assumptions.text},
      {"rows",
       list_of(
           assumptions.rows,
           [](const AssumptionRow& row) {
             return Json{{"name", row.name}, {"analytic", row.first}, {"multibody", row.second}};
           })},
      {"channels", Json::array()}};
  for (const compare::ChannelSplit& channel : assumptions.split.channels)
    if (channel.computed) section["channels"].push_back(json_of(assumptions.split, channel));
  return section;
}

Json json_of(const std::optional<compare::PublishedValue>& value) {
  if (!value) return nullptr;
  if (value->low == value->high) return rounded(value->low, 6);
  return compare::text_of(*value);
}

Json json_of(const PublishedTable& published) {
  const compare::PublishedSection& section = published.section;
  return {{"text", published.text},
          {"rows", list_of(section.rows,
                           [&](const compare::PublishedRow& row) {
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
                           })},
          {"predicted", section.summary.predicted},
          {"predicted_comparable", section.summary.predicted_comparable},
          {"predicted_inside", section.summary.predicted_inside}};
}

// ---- Records of single commands

Json json_of(const HardCaseRow::Model& model) {
  return {{"model", model.model},
          {"expected", model.expected},
          {"verdict", model.verdict},
          {"message", model.message},
          {"digits", value_or_null(model.digits)},
          {"groups", list_of(model.groups,
                             [](const HardCaseRow::Group& g) {
                               return Json{{"group", g.group},
                                           {"loss_over_peak", g.loss_over_peak},
                                           {"predicted", g.predicted}};
                             })},
          {"weak_point", model.weak_point},
          {"measured_over_predicted", value_or_null(model.measured_over_predicted)},
          {"microseconds_per_angle", model.microseconds_per_angle}};
}

Json json_of(const HardCaseRow& row) {
  return {{"name", row.name},
          {"group", row.group},
          {"hard", row.hard},
          {"changes", row.changes},
          {"models", list_of(row.models)}};
}

Json json_of(const LongRunSection& run) {
  Json json = json_of(run.section);
  json["bounded"] = run.bounded;
  return json;
}

// Adds a part that is there.
template <class Part>
void add(Json& json, const char* key, const std::optional<Part>& part) {
  if (part) json[key] = json_of(*part);
}
template <class Item>
void add(Json& json, const char* key, const std::optional<std::vector<Item>>& items) {
  if (items) json[key] = list_of(*items);
}

Json to_json(const Document& document) {
  Json json = {{"schema", 1}, {"title", document.title}, {"program", document.program}};
  if (!document.files.empty()) json["files"] = document.files;
  add(json, "provenance", document.provenance);
  add(json, "case", document.the_case);
  add(json, "plausibility", document.plausibility);
  add(json, "derived", document.derived);
  add(json, "verdict", document.verdict);
  if (!document.meaning.empty()) json["meaning"] = document.meaning;
  add(json, "key_figures", document.key_figures);
  add(json, "summary", document.summary);
  add(json, "warnings", document.warnings);
  add(json, "common", document.common);
  add(json, "validity", document.validity);
  add(json, "timing", document.timing);
  add(json, "models", document.models);
  if (document.comparison) {
    json["channels"] = list_of(document.comparison->channels);
    // A comparison says so where there is nothing to take apart and nothing printed to hold it to.
    json["assumptions"] = nullptr;
    json["published"] = nullptr;
  }
  add(json, "checks", document.checks);
  add(json, "budget", document.budget);
  add(json, "assumptions", document.assumptions);
  add(json, "published", document.published);
  add(json, "runs", document.runs);
  add(json, "figures", document.figures);
  add(json, "rows", document.records);
  add(json, "cases", document.hard_cases);
  add(json, "long_run", document.long_run);
  return json;
}

Json to_json(const Curves& curves) {
  const auto columns = [](const auto& named, int digits) {
    Json json = Json::object();
    for (const auto& [name, values] : named) json[name] = rounded(values, digits);
    return json;
  };
  Json json = {
      {"theta_deg", exact(curves.theta_deg)},
      {"tables",
       list_of(
           curves.tables,
           [&](const Curves::Table& table) {
             return Json{{"name", table.name}, {"columns", columns(table.columns, kPlotDigits)}};
           })},
      {"difference", columns(curves.difference, kDifferenceDigits)}};
  if (!curves.axis.empty()) json["axis"] = curves.axis;
  if (!curves.marks.empty())
    json["marks"] = list_of(curves.marks, [](const Curves::Mark& mark) {
      return Json{{"x", mark.x}, {"upper", mark.upper}};
    });
  if (!curves.reference) return json;
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
  return json;
}

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

std::string dumped(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

ModelSection model_of(const ResultTable& table, const Lines& assumptions) {
  return {table.name, assumptions, table.provenance.facts, table.provenance.seconds, table.rows()};
}

std::string json_text(const Document& document) { return dumped(to_json(document), 1) + "\n"; }
std::string compact_json(const Document& document) { return dumped(to_json(document), -1); }
std::string compact_json(const Curves& curves) { return dumped(to_json(curves), -1); }

std::string packed_json(const Curves& curves) {
  Curves rest = curves;
  rest.tables.clear();
  rest.difference.clear();
  Json json = to_json(rest);
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

Values values_of(const ResultTable& table, const std::string& channel_name) {
  const std::size_t column = table.find(channel_name);
  Values values;
  for (std::size_t row = 0; row < table.rows(); ++row) values.push_back(table.at(row, column));
  return values;
}

const Values* find(const std::vector<std::pair<std::string, Values>>& columns,
                   const std::string& name) {
  for (const auto& [key, values] : columns)
    if (key == name) return &values;
  return nullptr;
}

Curves curves_of(const ResultTable& only) {
  Curves::Table columns{only.name, {}};
  for (const Channel& channel : only.channels)
    if (channel.kind != ChannelKind::check)
      columns.columns.emplace_back(channel.name, values_of(only, channel.name));
  return {only.theta_deg, {std::move(columns)}, {}, {}};
}

Curves curves_of(const ResultTable& first, const ResultTable& second) {
  Curves curves = curves_of(first);
  curves.tables.push_back(std::move(curves_of(second).tables.front()));
  for (std::size_t a = 0; a < first.columns(); ++a) {
    const std::size_t b = second.find(first.channels[a].name);
    const ChannelKind kind = first.channels[a].kind;
    if (b == second.columns() || kind == ChannelKind::check || kind == ChannelKind::input) continue;
    Values difference;
    for (std::size_t row = 0; row < first.rows(); ++row)
      difference.push_back(second.at(row, b) - first.at(row, a));
    curves.difference.emplace_back(first.channels[a].name, std::move(difference));
  }
  return curves;
}

}  // namespace bentaxis::report
