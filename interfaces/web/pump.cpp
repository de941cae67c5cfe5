// The pump of the page: what its worker calls. A narrow C interface: texts in, JSON out, and the
// table of a turn as numbers in memory. Parses, calls, prints; the models are those of the program.
#include <emscripten.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/analytic/budget.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/report/document.h"
#include "bentaxis/results/samples.h"
#include "bentaxis/study/budget_section.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/efficiency.h"
#include "bentaxis/study/plausibility_section.h"
#include "bentaxis/study/pump_scene.h"
#include "bentaxis/study/transfer_summary.h"
#include "bentaxis/study/turn_summary.h"
#include "comparison_figures.h"
#include "document_parts.h"
#include "hydraulic_sections.h"
#include "key_figures.h"

namespace {

using namespace bentaxis;
using Json = nlohmann::ordered_json;

// More do not fit into the memory that the page takes, with loads and curves.
constexpr int kMaxSamples = 7200;

struct Design {
  study::PreparedCase ready;
  Samples samples;
  ResultTable table;
};

// What the page shows: this design, and one that is kept beside it.
std::array<std::optional<Design>, 2> designs;
constexpr const char* kNames[] = {"this design", "kept design"};

std::string answer;

// The answer of a call, or why there is none: kind "input", "computation", "memory" or "program".
template <class Call>
const char* answered(Call call) {
  const auto failed = [](const char* kind, const std::string& why) {
    answer =
        Json{{"error", why}, {"kind", kind}}.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  try {
    answer = call();
  } catch (const InputError& error) {
    failed("input", error.what());
  } catch (const ComputationError& error) {
    failed("computation", error.what());
  } catch (const std::bad_alloc&) {
    failed("memory", "there is not enough memory for this case");
  } catch (const std::exception& error) {
    failed("program", error.what());
  }
  return answer.c_str();
}

Design& design(int which) { return designs.at(static_cast<std::size_t>(which)).value(); }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

Design computed(Case the_case, const char* name) {
  const Operation& operation = the_case.operation;
  if (operation.samples_per_revolution > kMaxSamples)
    throw InputError(
        "[operation] samples_per_revolution = " + std::to_string(operation.samples_per_revolution) +
        ": this page computes at most " + std::to_string(kMaxSamples) +
        "; lower it, or use the program: bentaxis run");
  Design made{study::prepare(std::move(the_case)), {}, {}};
  const Case& ready = made.ready.the_case;
  made.samples = sample_case(ready, made.ready.pressure);
  made.table = analytic::run(ready, ready.analytic, made.samples);
  made.table.name = name;
  return made;
}

// ---- Parameters

Json json_of(const Value& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

Json bound(double value) { return std::isfinite(value) ? Json(value) : Json(); }

const char* type_of(const Parameter& p) {
  constexpr const char* kTypes[] = {"number", "integer", "flag", "text", "choice", "pair", "curve"};
  return kTypes[p.field.index()];
}

Json parameter_json(const Table& table, const Parameter& p, const Case& the_case) {
  Json json = {{"table", table.name},    {"key", p.key},       {"type", type_of(p)},
               {"unit", p.unit.name},    {"symbol", p.symbol}, {"meaning", p.meaning},
               {"range", p.range_words}, {"words", p.words}};
  const NumberRange range = range_of(p, the_case);
  json["low"] = bound(range.low);
  json["high"] = bound(range.high);
  json["low_open"] = range.low_open;
  json["high_open"] = range.high_open;
  if (!p.plausible.why.empty())
    json["plausible"] = {bound(p.plausible.low), bound(p.plausible.high)};
  if (const auto value = value_of(p, the_case)) json["value"] = json_of(*value);
  return json;
}

// Those that have something to do in a case and that one number, word or flag sets.
std::string parameters_of(const Case& the_case) {
  const Registry& registry = standard_registry();
  Json tables = Json::array();
  for (const Table& table : registry.tables) {
    Json parameters = Json::array();
    for (const Parameter& p : table.parameters)
      if (is_active(table, p, registry, the_case) && value_of(p, the_case))
        parameters.push_back(parameter_json(table, p, the_case));
    if (!parameters.empty())
      tables.push_back(
          {{"name", table.name}, {"meaning", table.meaning}, {"parameters", parameters}});
  }
  return tables.dump();
}

// ---- What a report says

// Where both designs are shown: that of the first, then that of the second or nothing, then how far
// they are apart.
void put_beside(std::vector<report::KeyFigures::Row>& rows,
                const std::vector<report::KeyFigures::Row>& kept) {
  for (report::KeyFigures::Row& row : rows) {
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const auto& other) {
      return other.quantity == row.quantity && other.unit == row.unit;
    });
    const double value = row.values.at(0);
    const double other = same == kept.end() ? not_computed() : same->values.at(0);
    row.values.push_back(other);
    if (!is_computed(value) || !is_computed(other)) continue;
    row.difference = other - value;
    if (value != 0) row.over_value = std::abs((other - value) / value);
  }
}

std::vector<report::KeyFigures::Row> key_rows(const Design& one) {
  auto rows = study::turn_figures({&one.table});
  report::append(rows, study::transfer_figures({&one.table}, one.ready.the_case.pump));
  if (one.ready.hydraulics)
    report::append(rows, study::oil_figures(one.ready.hydraulics->summary, 1));
  return rows;
}

// The oil: its operating point, and the figures of a report but for the curve given to both models.
void add_oil(report::Document& document, const Case& the_case,
             const hydraulics::SteadyState& state) {
  document.runs = std::vector{study::hydraulic_section(the_case, state)};
  std::vector<report::Figure> figures = study::hydraulic_figures(the_case, state);
  std::erase_if(figures, [](const report::Figure& figure) { return figure.id == "spline"; });
  report::append(document.figures, std::move(figures));
}

report::Document document_of(const Design& one, const Design* kept) {
  const Case& the_case = one.ready.the_case;
  const BodyLoadTable loads = analytic::run_body_loads(the_case, the_case.analytic, one.samples);
  const study::CaseDescription description{the_case, study::plausibility(the_case), {}, {}, {}};
  report::Document document = study::case_document(
      description, the_case.name, {}, study::pump_scene(the_case, {{one.table, loads}}));
  const auto limits = analytic::check_validity(the_case, the_case.analytic, one.samples, one.table);
  document.verdict = {std::nullopt, "The analytic model alone: nothing is compared.", "One model"};
  document.verdict->answers = study::TurnSummary(one.table).answers();
  report::append(document.verdict->answers,
                 study::TransferSummary(the_case.pump, one.table).answers());
  report::append(document.verdict->answers, study::limit_answers(limits));
  document.verdict->not_valid = study::not_valid_text(limits);
  document.validity = study::validity_section(limits);

  std::vector<const ResultTable*> tables = {&one.table};
  if (kept != nullptr) tables.push_back(&kept->table);
  document.key_figures = {{}, "deg", key_rows(one)};
  for (const ResultTable* table : tables) document.key_figures->models.push_back(table->name);
  if (kept != nullptr) put_beside(document.key_figures->rows, key_rows(*kept));
  document.figures = study::channel_figures(tables);
  if (one.ready.hydraulics) add_oil(document, the_case, *one.ready.hydraulics);

  std::vector<ResultTable> budgets;
  for (const Design* each : {&one, kept})
    if (each != nullptr)
      budgets.push_back(
          analytic::run_budget(each->ready.the_case, each->ready.the_case.analytic, each->samples));
  std::vector<study::BudgetTurn> turns = {
      {one.ready, budgets[0], one.table, study::pump_power(one.ready)}};
  if (kept != nullptr)
    turns.push_back({kept->ready, budgets[1], kept->table, study::pump_power(kept->ready)});
  document.budget = study::budget_section(turns);
  return document;
}

std::string channels_of(const ResultTable& table) {
  Json channels = Json::array();
  for (const Channel& c : table.channels)
    channels.push_back({{"name", c.name},
                        {"meaning", c.meaning},
                        {"on_body", c.on_body},
                        {"unit", c.unit},
                        {"group", c.group},
                        {"piston", c.piston}});
  return channels.dump();
}

}  // namespace

// Every text is UTF-8 and valid until the next call.
extern "C" {

/// Reads a case and computes one turn. `which`: 0 this design, 1 the kept one, -1 drops the kept
/// one. `changes`: lines TABLE.KEY=VALUE, as --set has them. -> {rows, columns, name}
EMSCRIPTEN_KEEPALIVE const char* bentaxis_compute(int which, const char* file, const char* text,
                                                  const char* changes) {
  return answered([&]() -> std::string {
    if (which < 0) {
      designs[1].reset();
      return "{}";
    }
    auto& place = designs.at(static_cast<std::size_t>(which));
    Design made = computed(parse_case(text, file, lines_of(changes)), kNames[which]);
    place = std::move(made);
    return Json{{"rows", place->table.rows()},
                {"columns", place->table.columns()},
                {"name", place->ready.the_case.name}}
        .dump();
  });
}

/// The angles of the last turn, deg, and its values, row by row, in the units of the channels.
EMSCRIPTEN_KEEPALIVE const double* bentaxis_angles(int which) {
  return design(which).table.theta_deg.data();
}
EMSCRIPTEN_KEEPALIVE const double* bentaxis_values(int which) {
  return design(which).table.values.data();
}

/// The columns of these values. -> [{name, meaning, unit, group, piston}]
EMSCRIPTEN_KEEPALIVE const char* bentaxis_channels(int which) {
  return answered([&] { return channels_of(design(which).table); });
}

/// The parameters that a case uses, from the registry. -> [{name, meaning, parameters}]
EMSCRIPTEN_KEEPALIVE const char* bentaxis_parameters(const char* file, const char* text,
                                                     const char* changes) {
  return answered([&] { return parameters_of(parse_case(text, file, lines_of(changes))); });
}

/// The case as the text of a file.
EMSCRIPTEN_KEEPALIVE const char* bentaxis_case_text(const char* file, const char* text,
                                                    const char* changes) {
  return answered([&] {
    return Json{{"text", case_text(parse_case(text, file, lines_of(changes)))}}.dump();
  });
}

/// What a report says of the last turn, the kept design beside it where there is one: the report's
/// JSON, the pump in space, its picture. -> {report, scene, picture}
EMSCRIPTEN_KEEPALIVE const char* bentaxis_document() {
  return answered([&]() -> std::string {
    const report::Document document = document_of(design(0), designs[1] ? &*designs[1] : nullptr);
    return "{\"report\":" + report::compact_json(document) +
           ",\"scene\":" + report::compact_json(*document.scene) +
           ",\"picture\":" + Json(document.picture).dump() + "}";
  });
}

}  // extern "C"
