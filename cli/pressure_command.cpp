#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <tuple>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/report/page.h"
#include "bentaxis/report/report.h"
#include "commands.h"
#include "console.h"
#include "hydraulic_case.h"
#include "hydraulic_report.h"
#include "models.h"
#include "published.h"
#include "pump_report.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

constexpr int kMostPoints = 1000;  // of a torque curve
constexpr int kOverlayTurns = 3;   // as in Fig. 19-24

struct Options {
  std::string case_file, out = "out", overlay, published, delivery;
  int transient = 0;
};

// One operating point with both models under the case's assumptions.
struct Point {
  ReadyCase ready;
  ResultTable analytic, multibody;

  const Case& the_case() const { return ready.the_case; }
  const hydraulics::SteadyState& state() const { return *ready.hydraulics; }
  double bar() const { return the_case().pressure.ports.delivery / kPascalPerBar; }
};

void require_hydraulic(const Case& the_case) {
  if (the_case.pressure.kind != PressureKind::hydraulic)
    throw InputError(the_case.file.string() +
                     ": [pressure] kind must be \"hydraulic\" for this command");
}

ResultTable run_driven(const std::string& model, const Case& the_case) {
  const PressureTrace pressure(the_case.pressure);
  return run_model(model, the_case, model == "analytic" ? the_case.analytic : the_case.multibody,
                   samples_of(the_case, pressure, Way::driven), pressure, Way::driven, {});
}

Point run_point(Case the_case) {
  Point point{with_pressure(std::move(the_case)), {}, {}};
  point.analytic = run_driven("analytic", point.the_case());
  point.multibody = run_driven("multibody", point.the_case());
  return point;
}

double mean(const ResultTable& table, const std::string& channel) {
  const std::size_t column = table.find(channel);
  double sum = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) sum += table.at(row, column);
  return sum / static_cast<double>(table.rows());
}

// ---- Torque and flow against delivery pressure
// ---------------------------------------------------

// FROM:TO:STEP or one number, bar.
std::vector<double> delivery_pressures(const std::string& text) {
  const auto fail = [&](const std::string& why) {
    throw InputError("--delivery-bar " + text + ": " + why);
  };
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(':', at), text.size());
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data() + at, text.data() + end, value);
    if (error != std::errc() || stop != text.data() + end || !std::isfinite(value) || value < 0)
      fail("must be FROM:TO:STEP or one number, in bar, >= 0");
    numbers.push_back(value);
    at = end + 1;
  }
  if (numbers.size() == 1) return numbers;
  if (numbers.size() != 3) fail("must be FROM:TO:STEP or one number, in bar");
  const double from = numbers[0], to = numbers[1], step = numbers[2];
  if (!(step > 0) || to < from) fail("must have STEP > 0 and FROM <= TO");
  const double count = std::floor((to - from) / step + 1e-9) + 1;
  if (count > kMostPoints) fail("must not be more than " + std::to_string(kMostPoints) + " points");
  std::vector<double> pressures;
  for (int i = 0; i < static_cast<int>(count); ++i) pressures.push_back(from + i * step);
  return pressures;
}

struct TorqueCurve {
  std::vector<double> bar, analytic, multibody, ideal, flow, efficiency;
};

// Points are independent: each thread takes the next one. Every thread has models of its own.
TorqueCurve torque_curve(const Case& the_case, const std::vector<double>& pressures) {
  const std::size_t count = pressures.size();
  TorqueCurve curve;
  curve.bar = pressures;
  for (auto* values :
       {&curve.analytic, &curve.multibody, &curve.ideal, &curve.flow, &curve.efficiency})
    values->resize(count);
  std::atomic<std::size_t> next = 0;
  const auto work = [&](bool reports) {
    const Progress progress = progress_of("torque curve");
    for (std::size_t i = next++; i < count; i = next++) {
      Case at = the_case;
      at.pressure.ports.delivery = pascals(pressures[i]);
      const Point point = run_point(std::move(at));
      const auto& s = point.state().summary;
      curve.analytic[i] = mean(point.analytic, "Td_z1_Nm");
      curve.multibody[i] = mean(point.multibody, "Td_z1_Nm");
      curve.ideal[i] =
          s.displacement * (pascals(pressures[i]) - the_case.pressure.ports.suction) / (2 * kPi);
      curve.flow[i] = s.flow * 6e4;
      curve.efficiency[i] = 100 * s.volumetric_efficiency;
      if (reports) progress(static_cast<double>(i + 1) / static_cast<double>(count));
    }
  };
  const std::size_t threads =
      std::min<std::size_t>({std::max(1U, std::thread::hardware_concurrency()), count, 8});
  std::vector<std::future<void>> others;
  for (std::size_t t = 1; t < threads; ++t)
    others.push_back(std::async(std::launch::async, work, false));
  try {
    work(true);
  } catch (...) {
    next = count;  // the others finish their point and stop
    throw;
  }
  for (auto& other : others) other.get();
  return curve;
}

std::string to_csv(const TorqueCurve& curve) {
  std::string text =
      "delivery_bar,mean_Td_analytic_Nm,mean_Td_multibody_Nm,ideal_Td_Nm,flow_l_per_min,"
      "volumetric_efficiency_percent\n";
  for (std::size_t i = 0; i < curve.bar.size(); ++i) {
    const double row[] = {curve.bar[i],   curve.analytic[i], curve.multibody[i],
                          curve.ideal[i], curve.flow[i],     curve.efficiency[i]};
    for (std::size_t c = 0; c < std::size(row); ++c) {
      if (c > 0) text += ',';
      append_number(text, row[c]);
    }
    text += '\n';
  }
  return text;
}

void add_curve(Json& report, const TorqueCurve& curve) {
  const char* axis = "mean delivery pressure (bar)";
  Json torque = own_figure("torque_curve", "Mean drive torque against delivery pressure", "Fig. 18",
                           "Nm", axis, curve.bar);
  add_series(torque, "analytic", plot_values(curve.analytic));
  add_series(torque, "multibody", plot_values(curve.multibody));
  add_series(torque, "ideal: displacement x pressure / 2 pi", plot_values(curve.ideal));
  Json flow =
      own_figure("flow_curve", "Mean flow against delivery pressure", "", "l/min", axis, curve.bar);
  add_series(flow, "to the load, at delivery pressure", plot_values(curve.flow));
  report["figures"].push_back(std::move(torque));
  report["figures"].push_back(std::move(flow));
  Json rows = Json::array();
  for (std::size_t i = 0; i < curve.bar.size(); ++i)
    rows.push_back({curve.bar[i], curve.analytic[i], curve.multibody[i], curve.ideal[i],
                    curve.flow[i], curve.efficiency[i]});
  report["runs"].push_back(
      {{"title", "Torque and flow against delivery pressure"},
       {"text",
        "Each point: periodic hydraulic state, then both models over a turn. 0 bar is an open "
        "line."},
       {"table",
        {{"columns",
          {"delivery, bar", "mean torque, analytic, Nm", "mean torque, multibody, Nm",
           "ideal torque, Nm", "flow, l/min", "volumetric efficiency, %"}},
         {"rows", rows}}}});
}

// ---- Against published numbers
// -------------------------------------------------------------------

// Delivery pressure at which a magnitude reaches a row's lower limit, by the analytic model.
double pressure_needed(const PublishedRow& row, const Point& start) {
  const auto reached = [&](double pressure) {
    Case at = start.the_case();
    at.pressure.ports.delivery = pressure;
    const ReadyCase ready = with_pressure(std::move(at));
    return measure(row, run_driven("analytic", ready.the_case)).low - row.low;
  };
  double p0 = start.the_case().pressure.ports.delivery;
  double f0 = measure(row, start.analytic).low - row.low;
  double p1 = p0 * row.low / (f0 + row.low);
  for (int i = 0; i < 10; ++i) {
    const double f1 = reached(p1);
    if (std::abs(f1) <= 1e-5 * row.low) return p1;
    const double next = p1 - f1 * (p1 - p0) / (f1 - f0);
    p0 = p1;
    f0 = f1;
    p1 = next;
    if (!(p1 > 0)) break;
  }
  throw ComputationError("published numbers: no delivery pressure found at which " + row.quantity +
                         " reaches " + number_text(row.low));
}

struct Verdicts {
  Json rows = Json::array();
  std::vector<std::string> lines;
  bool inside = true;
};

Verdicts set_against(const std::vector<PublishedRow>& rows, const Point& point) {
  std::map<std::tuple<bool, bool>, std::pair<ResultTable, ResultTable>> variants;
  Verdicts verdicts;
  for (const PublishedRow& row : rows) {
    const std::tuple key{row.piston_friction, row.block_viscous};
    if (variants.count(key) == 0) {
      if (row.piston_friction && row.block_viscous) {
        variants[key] = {point.analytic, point.multibody};
      } else {
        Case changed = point.the_case();
        if (!row.piston_friction)
          changed.analytic.piston_friction = changed.multibody.piston_friction = false;
        if (!row.block_viscous) changed.pump.friction.block_viscous = 0;
        variants[key] = {run_driven("analytic", changed), run_driven("multibody", changed)};
      }
    }
    const auto& [analytic, multibody] = variants[key];
    const Measured first = measure(row, analytic), second = measure(row, multibody);
    const bool inside = first.inside(row) && second.inside(row);
    std::string where = row.where;
    if (row.find_pressure)
      where += fmt::format("; needs a mean delivery pressure of {:.1f} bar",
                           pressure_needed(row, point) / kPascalPerBar);
    const std::size_t column = analytic.find(row.channel);
    verdicts.rows.push_back({{"quantity", row.quantity},
                             {"paper", row.paper},
                             {"analytic", shown(first)},
                             {"multibody", shown(second)},
                             {"unit", analytic.channels[column].unit},
                             {"verdict", inside ? "inside" : "outside"},
                             {"status", row.status},
                             {"where", where}});
    const Json value = shown(first);
    verdicts.lines.push_back(
        fmt::format("{:<44} {:>22} {:<3} {:<8} {:<14} paper {} ({})", row.quantity,
                    value.is_string() ? value.get<std::string>() : fmt::format("{:.6g}", first.low),
                    analytic.channels[column].unit, inside ? "inside" : "OUTSIDE", row.status,
                    row.paper, where));
    verdicts.inside = verdicts.inside && inside;
  }
  return verdicts;
}

// ---- Two cases over three turns (Fig. 19-24)
// -----------------------------------------------------

void add_overlay(Json& report, const Point& first, const Point& second) {
  const std::size_t rows = first.analytic.rows();
  if (second.analytic.rows() != rows)
    throw InputError(second.the_case().file.string() +
                     ": must have the same samples_per_revolution as " +
                     first.the_case().file.string());
  std::vector<double> theta;
  for (int turn = 0; turn < kOverlayTurns; ++turn)
    for (const double angle : first.analytic.theta_deg) theta.push_back(angle + 360 * turn);
  const auto add = [&](const std::string& id, const std::string& title, const std::string& paper,
                       const std::vector<std::string>& channels) {
    Json figure = own_figure(id, title, paper, "N", "shaft angle (deg)", theta);
    for (const Point* point : {&first, &second})
      for (const std::string& channel : channels) {
        const std::size_t column = point->analytic.find(channel);
        std::vector<double> values;
        for (int turn = 0; turn < kOverlayTurns; ++turn)
          for (std::size_t row = 0; row < rows; ++row)
            values.push_back(point->analytic.at(row, column));
        add_series(figure, fmt::format("{} at {:.4g} bar", channel, point->bar()),
                   plot_values(values));
      }
    double worst = 0;
    for (const Point* point : {&first, &second}) {
      const auto comparison = compare::compare_tables(point->analytic, point->multibody, {});
      for (const std::string& channel : channels)
        worst = std::max(worst, comparison.find(channel)->largest_over_peak());
    }
    figure["note"] = fmt::format(
        "Analytic model, three times the same turn; the multibody model differs by up to {:.1e} of "
        "peak.",
        worst);
    report["figures"].push_back(std::move(figure));
  };
  add("overlay_rc_x2", "Bore force Rc on piston 1, x2: both loads", "Fig. 19", {"Rc_1_x2_N"});
  add("overlay_rc_y2", "Bore force Rc on piston 1, y2: both loads", "Fig. 20", {"Rc_1_y2_N"});
  add("overlay_rs_xy", "Joint force Rs on piston 1 across the block axis: both loads", "Fig. 21",
      {"Rs_1_x2_N", "Rs_1_y2_N"});
  add("overlay_rs_z2", "Joint force Rs on piston 1, z2: both loads", "Fig. 22", {"Rs_1_z2_N"});
  add("overlay_rb1", "Tapered bearing force Rb1: both loads", "Fig. 23",
      {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N"});
  add("overlay_rb2", "Cylindrical bearing force Rb2: both loads", "Fig. 24",
      {"Rb2_x1_N", "Rb2_y1_N"});
  Json block = hydraulic_block(second.the_case(), second.state());
  block["title"] = "Hydraulic model: " + second.the_case().name;
  report["runs"].push_back(std::move(block));
}

// ---- The command
// ---------------------------------------------------------------------------------

void add_transient(Json& report, const ResultTable& transient) {
  Json figure = own_figure("transient", "From rest: pressures with the shaft at full speed at once",
                           "", "bar", "shaft angle (deg)", transient.theta_deg);
  std::vector<double> chamber, delivery;
  for (std::size_t row = 0; row < transient.rows(); ++row) {
    chamber.push_back(transient.at(row, 0));
    delivery.push_back(transient.at(row, 1));
  }
  add_series(figure, "chamber 1", plot_values(chamber));
  add_series(figure, "delivery volume", plot_values(delivery));
  figure["note"] = "The load orifice is that of the periodic state.";
  report["figures"].push_back(std::move(figure));
}

int pressure(const Options& options) {
  Case read = read_case(options.case_file);
  require_hydraulic(read);
  std::optional<Case> second;
  if (!options.overlay.empty()) {
    second = read_case(options.overlay);
    require_hydraulic(*second);
  }
  std::vector<PublishedRow> published;
  if (!options.published.empty()) published = read_published(options.published);
  std::vector<double> pressures;
  if (!options.delivery.empty()) pressures = delivery_pressures(options.delivery);
  OutputFolder folder(options.out);

  const Point point = run_point(std::move(read));
  const Case& the_case = point.the_case();
  Json report = {{"schema", 1},
                 {"title", the_case.name},
                 {"program", versions()},
                 {"case", case_section(the_case)},
                 {"derived", derived_section(the_case)},
                 {"runs", Json::array({hydraulic_block(the_case, point.state())})},
                 {"figures", Json::array()},
                 {"models", Json::array({report::model_section(point.analytic, {}),
                                         report::model_section(point.multibody, {})})}};
  Verdicts verdicts;
  if (!published.empty()) {
    verdicts = set_against(published, point);
    report["published"] = {
        {"text",
         "Used to infer: the number went into the geometry of this case, which is not published. "
         "Calibrated: a "
         "parameter was set so that the number comes out. Only predicted rows say something about "
         "the models; a "
         "window is the range of a printed axis, in which the lost curve must have been."},
        {"rows", verdicts.rows}};
  }
  report["figures"] = hydraulic_figures(the_case, point.state());
  report["figures"].push_back(
      {{"id", "td"},
       {"title", "Drive torque Td"},
       {"paper", "Fig. 17"},
       {"unit", "Nm"},
       {"channels", {"Td_z1_Nm"}},
       {"note", fmt::format("Mean torque: analytic {:.5g} Nm, multibody {:.5g} Nm.",
                            mean(point.analytic, "Td_z1_Nm"), mean(point.multibody, "Td_z1_Nm"))}});
  if (second) add_overlay(report, point, run_point(std::move(*second)));
  std::optional<TorqueCurve> curve;
  if (!pressures.empty()) {
    curve = torque_curve(the_case, pressures);
    add_curve(report, *curve);
    folder.add("torque_curve.csv", to_csv(*curve));
  }
  if (options.transient > 0) {
    const ResultTable transient = hydraulics::transient_from_rest(
        the_case, point.state().summary.load_area, options.transient, 72, progress_of("transient"));
    add_transient(report, transient);
    folder.add("transient.csv", bentaxis::to_csv(transient));
  }

  const Json curves = report::curve_section(point.analytic, point.multibody);
  folder.add("pressure.html", report::render_page(the_case.name, report, curves));
  folder.add("pressure.json", report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  folder.add("pressure.csv", bentaxis::to_csv(point.state().table));
  const auto paths = folder.commit();

  std::printf("%s\n\n", the_case.name.c_str());
  for (const auto& line : hydraulics::lines(point.state()))
    std::printf("%-42s %12.6g %s\n", line.name.c_str(), line.value, line.unit.c_str());
  std::printf("%-42s %12.6g Nm\n%-42s %12.6g Nm\n", "mean drive torque, analytic",
              mean(point.analytic, "Td_z1_Nm"), "mean drive torque, multibody",
              mean(point.multibody, "Td_z1_Nm"));
  if (!verdicts.lines.empty()) std::printf("\n");
  for (const auto& line : verdicts.lines) std::printf("%s\n", line.c_str());
  if (curve) {
    std::printf("\n%s", to_csv(*curve).c_str());
  }
  std::printf("\n");
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return verdicts.inside ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_pressure_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "pressure", "Compute chamber and delivery pressures, flows and the torque they need");
  add_case(*command, options->case_file);
  add_out(*command, options->out, "pressure.html, pressure.json and the curves");
  command
      ->add_option("--delivery-bar", options->delivery,
                   "also mean torque and flow at these delivery pressures; 0 is an open line")
      ->option_text("FROM:TO:STEP");
  command
      ->add_option("--overlay", options->overlay,
                   "another hydraulic case, drawn into one figure with the first over three turns")
      ->option_text("CASE");
  command
      ->add_option(
          "--published", options->published,
          "published numbers to set the results against; outside any window: exit status 1")
      ->option_text("FILE");
  command
      ->add_option("--transient", options->transient,
                   "also the transient from rest over so many turns")
      ->check(CLI::Range(1, 1000))
      ->option_text("TURNS");
  return {command, [options] { return pressure(*options); }};
}

}  // namespace bentaxis::cli
