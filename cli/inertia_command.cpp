#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/report/page.h"
#include "bentaxis/report/report.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/inertia.h"
#include "bentaxis/study/run.h"
#include "commands.h"
#include "console.h"
#include "options.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

using report::Json;

using study::InertiaRun;

// Both models solve the same equations; what they may differ by, of peak.
constexpr double kModelsAgree = 1e-10;
// The one-piston scene against the full pump, of peak.
constexpr double kScenesAgree = 1e-11;
constexpr double kSpinForRun = 600;  // rpm, where the case's pistons do not spin

struct Options {
  CaseOption the_case;
  std::string out = "out";
  std::vector<double> speeds;
  std::vector<double> map_speeds;  // from, to; empty: a third of the slowest to 3 times the fastest
  std::vector<double> map_factors = {0.25, 8};
  study::MapAxis map_axis = study::MapAxis::mass;
  int map_size = 30;
};

// Everything the study computed.
struct Study {
  std::vector<InertiaRun> one_piston;  // by speed: without load, loaded
  std::vector<InertiaRun> full;
  study::ErrorCauses causes, multibody_causes;
  std::vector<study::Lumping> lumpings, over_fraction;
  study::ThreeMasses masses;
  study::ErrorMap map;
  std::vector<study::Approach> approach;
  std::optional<study::SpinRun> spin;
  std::vector<study::SceneCost> costs;
  double fastest = 0;
};

std::string rpm(double speed) { return fmt::format("{:g} rpm", speed); }
std::string load_name(bool loaded) { return loaded ? "loaded" : "no load"; }

// Magnitude of a vector of piston 1 over the turn.
std::vector<double> magnitude(const ResultTable& table, const std::vector<std::string>& names) {
  std::vector<double> result(table.rows(), 0.0);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const auto& name : names) {
      const double value = table.at(row, table.find(name));
      result[row] += value * value;
    }
    result[row] = std::sqrt(result[row]);
  }
  return result;
}

const std::vector<std::string> kRs = {"Rs_1_x2_N", "Rs_1_y2_N", "Rs_1_z2_N"};
const std::vector<std::string> kRc = {"Rc_1_x2_N", "Rc_1_y2_N"};

std::vector<double> column(const ResultTable& table, const std::string& name) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows(); ++row)
    values.push_back(table.at(row, table.find(name)));
  return values;
}

Json rounded(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values)
    list.push_back(is_computed(v) ? Json(std::strtod(fmt::format("{:.9g}", v).c_str(), nullptr))
                                  : Json());
  return list;
}

// Curves of the page: one name, one curve by each model, and their difference.
class Curves {
 public:
  explicit Curves(const std::vector<double>& theta_deg)
      : json_({{"theta_deg", theta_deg},
               {"tables", Json::array({{{"name", "analytic"}, {"columns", Json::object()}},
                                       {{"name", "multibody"}, {"columns", Json::object()}}})},
               {"difference", Json::object()}}) {}

  void add(const std::string& name, const std::vector<double>& analytic,
           const std::vector<double>& multibody = {}) {
    json_["tables"][0]["columns"][name] = rounded(analytic);
    if (multibody.empty()) return;
    json_["tables"][1]["columns"][name] = rounded(multibody);
    std::vector<double> difference;
    for (std::size_t i = 0; i < analytic.size(); ++i)
      difference.push_back(multibody[i] - analytic[i]);
    json_["difference"][name] = rounded(difference);
  }
  const Json& json() const { return json_; }

 private:
  Json json_;
};

Json figure(const std::string& id, const std::string& title, const std::string& paper,
            const std::string& unit, const std::vector<std::string>& channels,
            const std::string& note = "") {
  Json result = {
      {"id", id}, {"title", title}, {"paper", paper}, {"unit", unit}, {"channels", channels}};
  if (!note.empty()) result["note"] = note;
  return result;
}

// |R| of both kinds of piston at all speeds, without load or loaded.
Json magnitude_figure(const Study& s, Curves& curves, const std::string& id,
                      const std::string& symbol, const std::vector<std::string>& parts, bool loaded,
                      const std::string& paper) {
  std::vector<std::string> names;
  for (const InertiaRun& run : s.one_piston) {
    if (run.loaded != loaded) continue;
    for (const bool real : {false, true}) {
      names.push_back(fmt::format("|{}| {}, {}, {}", symbol, rpm(run.speed_rpm),
                                  real ? "real piston" : "2 masses", load_name(loaded)));
      curves.add(names.back(), magnitude(real ? run.analytic_real : run.analytic_lumped, parts),
                 magnitude(real ? run.multibody_real : run.multibody_lumped, parts));
    }
  }
  return figure(id, fmt::format("|{}| of a piston, {}", symbol, load_name(loaded)), paper, "N",
                names);
}

// Components at the fastest speed, without load.
Json component_figure(const InertiaRun& run, Curves& curves, const std::string& id,
                      const std::string& symbol, const std::vector<std::string>& parts) {
  std::vector<std::string> names;
  for (const auto& part : parts) {
    for (const bool real : {false, true}) {
      names.push_back(part + (real ? ", real piston" : ", 2 masses"));
      curves.add(names.back(), column(real ? run.analytic_real : run.analytic_lumped, part),
                 column(real ? run.multibody_real : run.multibody_lumped, part));
    }
  }
  return figure(id, fmt::format("{} by component, no load, {}", symbol, rpm(run.speed_rpm)), "",
                "N", names);
}

// lumped - real of channels of the full pump.
Json effect_figure(const InertiaRun& run, Curves& curves, const std::string& id,
                   const std::string& title, const std::string& unit,
                   const std::vector<std::string>& channels) {
  std::vector<std::string> names;
  const ResultTable analytic = study::difference(run.analytic_lumped, run.analytic_real, "");
  const ResultTable multibody = study::difference(run.multibody_lumped, run.multibody_real, "");
  for (const auto& channel : channels) {
    names.push_back(channel + ", 2 masses - real");
    curves.add(names.back(), column(analytic, channel), column(multibody, channel));
  }
  return figure(id, fmt::format("{}, {}, {}", title, rpm(run.speed_rpm), load_name(run.loaded)), "",
                unit, names);
}

Json cause_figures(const Study& s, Curves& curves) {
  Json figures = Json::array();
  for (const auto& [id, symbol, parts] :
       {std::tuple{"causes_rs", "Rs", kRs}, std::tuple{"causes_rc", "Rc", kRc}}) {
    std::vector<std::string> names;
    for (const auto part : {&study::ErrorCauses::all, &study::ErrorCauses::centre,
                            &study::ErrorCauses::transverse, &study::ErrorCauses::spin}) {
      names.push_back(fmt::format("|error of {}| by {}", symbol, (s.causes.*part).name));
      curves.add(names.back(), magnitude(s.causes.*part, parts),
                 magnitude(s.multibody_causes.*part, parts));
    }
    figures.push_back(figure(
        id,
        fmt::format("Error of {} that lumping causes, each cause alone, {}", symbol,
                    rpm(s.fastest)),
        "", "N", names, "Magnitudes of vectors; the vectors add up, their magnitudes need not."));
  }
  return figures;
}

Json series(const std::string& label, const Json& x, const Json& y) {
  return {{"label", label}, {"x", x}, {"y", y}};
}

Json fraction_figure(const Study& s) {
  Json chi = Json::array();
  Json rs = Json::array();
  Json rc = Json::array();
  for (const auto& lumping : s.over_fraction) {
    chi.push_back(lumping.joint_mass_fraction);
    rs.push_back(lumping.error_rs);
    rc.push_back(lumping.error_rc);
  }
  return {{"id", "fraction"},
          {"kind", "xy"},
          {"title", "Error of two masses over chi, no load, " + rpm(s.fastest)},
          {"x", {{"label", "chi, share of the mass at A"}}},
          {"y", {{"label", "largest error over the turn"}, {"unit", "N"}, {"from", 0}}},
          {"series", Json::array({series("Rs", chi, rs), series("Rc", chi, rc)})}};
}

Json approach_figure(const Study& s) {
  Json t = Json::array();
  Json rs = Json::array();
  Json rc = Json::array();
  for (const auto& step : s.approach) {
    t.push_back(step.t);
    rs.push_back(step.error_rs);
    rc.push_back(step.error_rc);
  }
  return {{"id", "approach"},
          {"kind", "xy"},
          {"title", "Simbody: the real piston tends to the lumped one as its inertia does, " +
                        rpm(s.fastest)},
          {"x", {{"label", "t: 1 = real piston, 0 = moments of the lumped one"}, {"log", true}}},
          {"y", {{"label", "difference from the lumped scene"}, {"unit", "N"}, {"log", true}}},
          {"series", Json::array({series("Rs", t, rs), series("Rc", t, rc)})},
          {"note",
           "A rigid body with free spin against a massless rod with two point masses: two "
           "different Simbody bodies and joints."}};
}

Json map_figure(const Study& s, const std::string& symbol,
                const std::vector<std::vector<double>>& values) {
  const bool mass = s.map.axis == study::MapAxis::mass;
  Json rows = Json::array();
  for (const auto& row : values) {
    Json list = Json::array();
    for (const double v : row) list.push_back(is_computed(v) ? Json(100 * v) : Json());
    rows.push_back(list);
  }
  return {
      {"id", "map_" + symbol},
      {"kind", "map"},
      {"title", fmt::format("Lumping error of {} over the loaded reaction", symbol)},
      {"x", {{"label", "speed"}, {"unit", "rpm"}, {"values", s.map.speed_rpm}, {"log", true}}},
      {"y",
       {{"label", mass ? "mass of the piston over the case's" : "length over the case's"},
        {"values", s.map.factor},
        {"log", true}}},
      {"z", {{"label", "error"}, {"unit", "%"}}},
      {"values", rows},
      {"contours", {0.1, 1, 5}},
      {"points",
       Json::array({{{"label", "case"}, {"x", std::abs(s.one_piston.front().speed_rpm)}, {"y", 1}},
                    {{"label", "case"}, {"x", std::abs(s.fastest)}, {"y", 1}}})},
      {"note",
       "Largest |two masses - real| over the turn, divided by the real piston's largest "
       "loaded reaction of the same pump."}};
}

Json error_table(const std::vector<InertiaRun>& runs, const std::vector<std::string>& groups) {
  Json rows = Json::array();
  for (const InertiaRun& run : runs) {
    const auto loaded = std::find_if(runs.begin(), runs.end(), [&](const InertiaRun& other) {
      return other.loaded && other.speed_rpm == run.speed_rpm;
    });
    for (const auto& error : study::lumping_errors(run, *loaded)) {
      if (std::find(groups.begin(), groups.end(), error.group) == groups.end()) continue;
      rows.push_back({fmt::format("{} ({})", error.group, error.unit), error.speed_rpm,
                      load_name(error.loaded), error.analytic,
                      is_computed(error.multibody) ? Json(error.multibody) : Json(), error.peak,
                      error.loaded_peak, 100 * error.fraction()});
    }
  }
  return {{"columns",
           {"reaction", "speed, rpm", "load", "error of lumping, analytic", "the same, multibody",
            "peak of this run", "peak loaded", "error, % of peak loaded"}},
          {"rows", rows}};
}

double cost_of(const Study& s, const std::string& scene, const std::string& method) {
  for (const auto& cost : s.costs)
    if (cost.scene == scene && cost.method == method) return cost.microseconds_per_angle;
  return not_computed();
}

Json sections(const Case& the_case, const Study& s, double models, double scenes) {
  Json list = Json::array();
  const auto add = [&](const std::string& title, const std::string& text, const Json& table,
                       const report::Lines& facts = {}) {
    list.push_back({{"title", title}, {"text", text}, {"facts", facts}, {"table", table}});
  };
  add("Error of lumping on a piston's reactions",
      "Largest magnitude of two masses - real over the turn. Reactions are linear in the inertia "
      "forces, so load does not change the error (but for the weight); it changes what the error "
      "is "
      "measured by.",
      error_table(s.one_piston, {"Rs", "Rc"}));
  add("Error of lumping on bearings, gear and torque", "Full pump, both models.",
      error_table(s.full, {"Rb1", "Rb2", "Rcs", "Rcn", "Td"}));

  Json rows = Json::array();
  for (const ResultTable* table :
       {&s.causes.centre, &s.causes.transverse, &s.causes.spin, &s.causes.all})
    rows.push_back({table->name, table->peak("Rs"), table->peak("Rc")});
  add("Where the error comes from",
      "From two masses to the real piston three things change; each is switched alone, without "
      "load "
      "at " +
          rpm(s.fastest) + ". As vectors the three add up to the whole exactly.",
      {{"columns", {"cause", "error of Rs, N", "error of Rc, N"}}, {"rows", rows}},
      {{"largest part the three do not explain", fmt::format("{:.1e} N", s.causes.rest)}});

  rows = Json::array();
  for (const auto& lumping : s.lumpings)
    rows.push_back(
        {lumping.name,
         is_computed(lumping.joint_mass_fraction) ? Json(lumping.joint_mass_fraction) : Json(),
         lumping.error_rs, lumping.error_rc});
  report::Lines facts;
  if (s.masses.exists)
    facts = {{"mass at A", fmt::format("{:.5g} kg", s.masses.at_joint)},
             {"mass at the centre", fmt::format("{:.5g} kg", s.masses.at_centre)},
             {"mass at B", fmt::format("{:.5g} kg", s.masses.at_ring)},
             {"three real masses would do", s.masses.positive
                                                ? "yes, all are positive"
                                                : "no, one is negative; the equations still hold"}};
  else
    facts = {{"three point masses", "do not exist: the centre of mass is not between A and B"}};
  add("Which lumping is best",
      "Error left, largest over the turn, without load at " + rpm(s.fastest) +
          ". Three point masses ([piston] inertia = \"dynamically_equivalent\") leave the "
          "gyroscopic "
          "moment of spin only.",
      {{"columns", {"lumping", "chi", "error of Rs, N", "error of Rc, N"}}, {"rows", rows}}, facts);

  rows = Json::array();
  for (const auto& step : s.approach) rows.push_back({step.t, step.error_rs, step.error_rc});
  add("Simbody: from the real piston to the lumped one",
      "Centre of mass, transverse and axial inertia go to those of the two masses with t.",
      {{"columns", {"t", "difference of Rs, N", "difference of Rc, N"}}, {"rows", rows}},
      s.spin ? report::Lines{{"spin at the start", fmt::format("{:g} rpm", s.spin->spin_rpm)},
                             {"largest change over a turn integrated",
                              fmt::format("{:.1e} rad/s (accuracy {:g} per step)",
                                          s.spin->worst_change, s.spin->accuracy)}}
             : report::Lines{{"spin", "none: the piston has no axial inertia"}});

  rows = Json::array();
  const double full = cost_of(s, "full", "multipliers");
  for (const auto& cost : s.costs)
    rows.push_back({cost.scene, cost.method, cost.bodies, cost.mobilities, cost.equations,
                    cost.microseconds_per_angle,
                    is_computed(full) ? Json(full / cost.microseconds_per_angle) : Json()});
  add("What each scene costs",
      "Real pistons, processor time measured in this run (fastest of three turns). Curves of this "
      "report "
      "are of the one-piston scene, tables of bearings of the full one.",
      {{"columns",
        {"scene", "reactions by", "bodies", "mobilities", "constraint equations",
         "microseconds per angle", "times cheaper than the full pump"}},
       {"rows", rows}},
      {{"largest difference of the models, of peak", fmt::format("{:.1e}", models)},
       {"one-piston scene against full pump, of peak", fmt::format("{:.1e}", scenes)},
       {"pistons in the pump", std::to_string(the_case.pump.geometry.pistons)}});
  return list;
}

// The paper's windows hold for its own pump only; they are shown for the pump inferred from it.
Json published(const Study& s) {
  Json rows = Json::array();
  const auto range = [&](const std::vector<std::string>& parts, bool multibody) {
    double low = 1e300;
    double high = 0;
    for (const InertiaRun& run : s.one_piston) {
      if (run.loaded) continue;
      for (const bool real : {false, true}) {
        const ResultTable& table = multibody ? (real ? run.multibody_real : run.multibody_lumped)
                                             : (real ? run.analytic_real : run.analytic_lumped);
        for (const double v : magnitude(table, parts)) {
          low = std::min(low, v);
          high = std::max(high, v);
        }
      }
    }
    return std::pair{low, high};
  };
  const auto add = [&](const std::string& symbol, const std::vector<std::string>& parts, double low,
                       double high, const std::string& where) {
    const auto [a_low, a_high] = range(parts, false);
    const auto [m_low, m_high] = range(parts, true);
    const bool inside = a_low >= low && a_high <= high && m_low >= low && m_high <= high;
    rows.push_back({{"quantity", "|" + symbol + "| without load, two masses and real"},
                    {"paper", fmt::format("{:g} to {:g} N", low, high)},
                    {"analytic", fmt::format("{:.4g} to {:.4g} N", a_low, a_high)},
                    {"multibody", fmt::format("{:.4g} to {:.4g} N", m_low, m_high)},
                    {"unit", ""},
                    {"verdict", inside ? "inside" : "outside"},
                    {"where", where}});
  };
  add("Rc", kRc, 10, 70, "Fig. 36, range of the axis");
  add("Rs", kRs, 20, 110, "Fig. 37, range of the axis");
  const auto mean = [&](const ResultTable& table, const std::vector<std::string>& parts) {
    double sum = 0;
    for (const double v : magnitude(table, parts)) sum += v;
    return sum / static_cast<double>(table.rows());
  };
  for (const auto& [symbol, parts, above] :
       {std::tuple{"Rc", kRc, true}, std::tuple{"Rs", kRs, false}}) {
    bool as_expected = true;
    std::string analytic, multibody;
    for (const InertiaRun& run : s.one_piston) {
      if (run.loaded) continue;
      for (const bool mb : {false, true}) {
        const double lumped = mean(mb ? run.multibody_lumped : run.analytic_lumped, parts);
        const double real = mean(mb ? run.multibody_real : run.analytic_real, parts);
        as_expected = as_expected && (lumped > real) == above;
        std::string& text = mb ? multibody : analytic;
        text += fmt::format("{}{:.4g} / {:.4g} N", text.empty() ? "" : ", ", lumped, real);
      }
    }
    rows.push_back(
        {{"quantity", fmt::format("mean |{}|, two masses / real, by speed", symbol)},
         {"paper", above ? "two masses above real" : "two masses below real"},
         {"analytic", analytic},
         {"multibody", multibody},
         {"unit", ""},
         {"verdict", as_expected ? "inside" : "outside"},
         {"where", above ? "Fig. 36, order of the labels" : "Fig. 37, order of the labels"}});
  }
  return {
      {"text",
       "The paper's figures are of the Casappa BAP 63 at 1500 and 2350 rpm without load. They say "
       "something about this case as far as it is that pump at those speeds; its geometry and "
       "masses are not printed and were inferred."},
      {"rows", rows}};
}

std::string curves_csv(const Study& s) {
  std::string text = "theta_deg";
  const auto variants = [](const InertiaRun& run) {
    return std::vector<std::pair<std::string, const ResultTable*>>{
        {"analytic_lumped", &run.analytic_lumped},
        {"analytic_real", &run.analytic_real},
        {"multibody_lumped", &run.multibody_lumped},
        {"multibody_real", &run.multibody_real}};
  };
  std::vector<std::vector<double>> columns;
  for (const InertiaRun& run : s.one_piston) {
    for (const auto& [name, table] : variants(run)) {
      const std::string prefix =
          fmt::format(",{}_{}_{:g}rpm_", name, run.loaded ? "loaded" : "noload", run.speed_rpm);
      for (const auto* parts : {&kRs, &kRc}) {
        for (const auto& part : *parts) {
          text += prefix + part;
          columns.push_back(column(*table, part));
        }
        text += prefix + (parts == &kRs ? "Rs_1_magnitude_N" : "Rc_1_magnitude_N");
        columns.push_back(magnitude(*table, *parts));
      }
    }
  }
  text += "\n";
  const ResultTable& first = s.one_piston.front().analytic_real;
  for (std::size_t row = 0; row < first.rows(); ++row) {
    append_number(text, first.theta_deg[row]);
    for (const auto& values : columns) {
      text += ',';
      append_number(text, values[row]);
    }
    text += '\n';
  }
  return text;
}

std::string errors_csv(const Study& s) {
  std::string text =
      "reaction,unit,speed_rpm,load,error_analytic,error_multibody,peak,peak_loaded,"
      "error_over_peak_loaded\n";
  for (const InertiaRun& run : s.full) {
    const auto loaded = std::find_if(s.full.begin(), s.full.end(), [&](const InertiaRun& other) {
      return other.loaded && other.speed_rpm == run.speed_rpm;
    });
    for (const auto& error : study::lumping_errors(run, *loaded)) {
      text += error.group + "," + error.unit + ",";
      append_number(text, error.speed_rpm);
      text += error.loaded ? ",loaded" : ",no_load";
      for (const double v :
           {error.analytic, error.multibody, error.peak, error.loaded_peak, error.fraction()}) {
        text += ',';
        append_number(text, v);
      }
      text += '\n';
    }
  }
  return text;
}

std::string map_csv(const study::ErrorMap& map) {
  std::string text = map.axis == study::MapAxis::mass ? "mass_factor" : "length_factor";
  text += ",speed_rpm,Rs_error_over_loaded,Rc_error_over_loaded\n";
  for (std::size_t i = 0; i < map.factor.size(); ++i) {
    for (std::size_t j = 0; j < map.speed_rpm.size(); ++j) {
      append_number(text, map.factor[i]);
      for (const double v : {map.speed_rpm[j], map.rs[i][j], map.rc[i][j]}) {
        text += ',';
        append_number(text, v);
      }
      text += '\n';
    }
  }
  return text;
}

// Values from low to high in equal ratios.
std::vector<double> ratios(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / (count - 1)));
  return values;
}

void check_range(const std::vector<double>& range, const std::string& option) {
  if (range.size() != 2 || !(range[0] > 0) || !(range[1] > range[0]) || !std::isfinite(range[1]))
    throw InputError(option + ": must be FROM,TO with 0 < FROM < TO");
}

// `the_case` has its chamber pressure; `as_read` may need it computed for each speed.
Study compute(const Case& as_read, const Case& the_case, const Options& options) {
  Study s;
  for (const double speed : options.speeds) study::at_speed(the_case, speed);  // refuses early
  s.fastest = *std::max_element(options.speeds.begin(), options.speeds.end(),
                                [](double a, double b) { return std::abs(a) < std::abs(b); });
  for (const double speed : options.speeds) {
    const Case at = study::prepare(study::at_speed(as_read, speed), progress_of).the_case;
    for (const bool loaded : {false, true}) {
      const std::string what = rpm(speed) + ", " + load_name(loaded);
      s.one_piston.push_back(study::run_both_pistons(at, speed, loaded, multibody::Scene::piston,
                                                     progress_of("one piston, " + what)));
      s.full.push_back(study::run_both_pistons(at, speed, loaded, multibody::Scene::full,
                                               progress_of("full pump, " + what)));
    }
  }
  s.causes = study::causes_of_error(the_case, s.fastest, study::By::analytic);
  s.multibody_causes = study::causes_of_error(the_case, s.fastest, study::By::multibody);
  s.lumpings = study::lumpings(the_case, s.fastest);
  s.over_fraction = study::lumping_over_fraction(the_case, s.fastest, 51);
  s.masses = study::three_masses(the_case.pump);
  std::vector<double> map_speeds = options.map_speeds;
  if (map_speeds.empty()) {
    const double slowest =
        std::abs(*std::min_element(options.speeds.begin(), options.speeds.end(),
                                   [](double a, double b) { return std::abs(a) < std::abs(b); }));
    map_speeds = {slowest / 3, 3 * std::abs(s.fastest)};
  }
  check_range(map_speeds, "--map-speeds");
  s.map = study::error_map(
      the_case, options.map_axis, ratios(map_speeds[0], map_speeds[1], options.map_size),
      ratios(options.map_factors[0], options.map_factors[1], options.map_size), progress_of("map"));
  s.approach = study::approach_to_lumped(the_case, s.fastest);
  const double own_spin = the_case.pump.piston.real->spin / kRadPerSecondPerRpm;
  // Without axial inertia a piston has no freedom to spin.
  if (the_case.pump.piston.real->axial_inertia > 0)
    s.spin = study::spin_run(the_case, s.fastest, own_spin != 0 ? own_spin : kSpinForRun,
                             progress_of("integrated, spinning pistons"));
  s.costs = study::scene_costs(the_case);
  return s;
}

int run(const Options& options) {
  check_range(options.map_factors, "--map-factors");
  const Case as_read = options.the_case.read();
  OutputFolder folder(options.out);
  const Case the_case = study::prepare(as_read, progress_of).the_case;
  const Study s = compute(as_read, the_case, options);

  double models = 0;
  double scenes = 0;
  const double radius = the_case.pump.geometry.joint_circle_radius;
  for (std::size_t i = 0; i < s.full.size(); ++i) {
    // Runs come in pairs: without load, loaded. The inertia forces alone are the smallest scale.
    const double least = s.one_piston[i - i % 2].analytic_real.peak("Rs");
    const auto differ = [&](const ResultTable& first, const ResultTable& second) {
      return study::largest_over_peak(first, second, least, radius);
    };
    for (const InertiaRun* run : {&s.full[i], &s.one_piston[i]})
      models = std::max({models, differ(run->analytic_lumped, run->multibody_lumped),
                         differ(run->analytic_real, run->multibody_real)});
    scenes = std::max({scenes, differ(s.full[i].multibody_real, s.one_piston[i].multibody_real),
                       differ(s.full[i].multibody_lumped, s.one_piston[i].multibody_lumped)});
  }
  const bool agrees = models <= kModelsAgree && scenes <= kScenesAgree;

  const InertiaRun* fast_bare = nullptr;
  const InertiaRun* fast_loaded = nullptr;
  const InertiaRun* full_loaded = nullptr;
  for (std::size_t i = 0; i < s.full.size(); ++i) {
    if (s.full[i].speed_rpm != s.fastest) continue;
    (s.full[i].loaded ? fast_loaded : fast_bare) = &s.one_piston[i];
    if (s.full[i].loaded) full_loaded = &s.full[i];
  }
  std::string headline = fmt::format("At {} two masses are off by", rpm(s.fastest));
  for (const auto& error : study::lumping_errors(*fast_loaded, *fast_loaded))
    if (error.group == "Rs" || error.group == "Rc")
      headline += fmt::format("{} {:.3g} N of {} ({:.2g} % of its loaded peak)",
                              error.group == "Rc" ? " and" : "", error.analytic, error.group,
                              100 * error.fraction());
  headline += fmt::format(". The models agree to {:.1e} of peak.", models);

  Curves curves(s.one_piston.front().analytic_real.theta_deg);
  Json figures = Json::array();
  figures.push_back(magnitude_figure(s, curves, "rc", "Rc", kRc, false, "Fig. 36"));
  figures.push_back(magnitude_figure(s, curves, "rs", "Rs", kRs, false, "Fig. 37"));
  figures.push_back(component_figure(*fast_bare, curves, "rc_parts", "Rc", kRc));
  figures.push_back(component_figure(*fast_bare, curves, "rs_parts", "Rs", kRs));
  figures.push_back(magnitude_figure(s, curves, "rc_loaded", "Rc", kRc, true, "Fig. 14"));
  figures.push_back(magnitude_figure(s, curves, "rs_loaded", "Rs", kRs, true, "Fig. 12"));
  for (const auto& f : cause_figures(s, curves)) figures.push_back(f);
  figures.push_back(fraction_figure(s));
  figures.push_back(effect_figure(*full_loaded, curves, "bearings",
                                  "Effect of lumping on the bearings", "N",
                                  {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N", "Rb2_x1_N", "Rb2_y1_N"}));
  if (full_loaded->analytic_real.find("Rcs_z4_N") < full_loaded->analytic_real.columns())
    figures.push_back(effect_figure(*full_loaded, curves, "gear",
                                    "Effect of lumping on the tooth force", "N", {"Rcs_z4_N"}));
  figures.push_back(effect_figure(*full_loaded, curves, "torque",
                                  "Effect of lumping on the drive torque", "Nm", {"Td_z1_Nm"}));
  figures.push_back(map_figure(s, "Rc", s.map.rc));
  figures.push_back(map_figure(s, "Rs", s.map.rs));
  figures.push_back(approach_figure(s));

  report::Document head;
  head.the_case = study::case_section(the_case);
  head.derived = study::derived_section(the_case);
  const Json report = {
      {"schema", 1},
      {"title", "Lumped or real pistons: " + the_case.name},
      {"program", versions()},
      {"case", report::to_json(head)["case"]},
      {"derived", report::to_json(head)["derived"]},
      {"verdict", {{"agrees", agrees}, {"headline", headline}, {"tolerance", kModelsAgree}}},
      {"runs", sections(the_case, s, models, scenes)},
      {"published", published(s)},
      {"figures", figures}};
  folder.add("inertia.html", report::render_page(report["title"], report, curves.json()));
  folder.add("inertia.json", report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  folder.add("inertia.csv", curves_csv(s));
  folder.add("inertia_errors.csv", errors_csv(s));
  folder.add("inertia_map.csv", map_csv(s.map));
  const auto paths = folder.commit();

  std::printf("%s\n%s\n\n", the_case.name.c_str(), headline.c_str());
  std::printf("error of lumping    speed rpm  load      N or Nm   %% of loaded peak\n");
  for (const InertiaRun& run : s.full) {
    const auto& loaded = *std::find_if(s.full.begin(), s.full.end(), [&](const InertiaRun& other) {
      return other.loaded && other.speed_rpm == run.speed_rpm;
    });
    for (const auto& error : study::lumping_errors(run, loaded))
      std::printf("%-20s%9g  %-8s %9.4g   %.3g\n", error.group.c_str(), error.speed_rpm,
                  load_name(error.loaded).c_str(), error.analytic, 100 * error.fraction());
  }
  std::printf("\nbest lumping at %s, no load (error of Rs, Rc in N)\n", rpm(s.fastest).c_str());
  for (const auto& lumping : s.lumpings)
    std::printf("%-50s chi %-8s %9.4g %9.4g\n", lumping.name.c_str(),
                is_computed(lumping.joint_mass_fraction)
                    ? fmt::format("{:.5f}", lumping.joint_mass_fraction).c_str()
                    : "-",
                lumping.error_rs, lumping.error_rc);
  for (const PistonInertia inertia : s.full.front().by_inverse_dynamics)
    std::printf(
        "%s pistons have no inertia about A: their multibody reactions are by inverse dynamics\n",
        to_string(inertia).c_str());
  std::printf("\nscene     reactions by  bodies  equations  us per angle\n");
  for (const auto& cost : s.costs)
    std::printf("%-9s %-13s %6d  %9d  %12.1f\n", cost.scene.c_str(), cost.method.c_str(),
                cost.bodies, cost.equations, cost.microseconds_per_angle);
  std::printf("\n");
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return agrees ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_inertia_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "inertia", "What treating the pistons as two point masses does to the reactions");
  add_case(*command, options->the_case);
  add_out(*command, options->out, "inertia.html, inertia.json and the curves");
  command->add_option("--speeds", options->speeds, "speeds to study, rpm")
      ->delimiter(',')
      ->option_text("NUMBER[,NUMBER..] [1500,2350]");
  command
      ->add_option("--map", options->map_axis,
                   "what grows along the map beside the speed: the piston's mass or its length")
      ->transform(CLI::CheckedTransformer(std::map<std::string, study::MapAxis>{
          {"mass", study::MapAxis::mass}, {"length", study::MapAxis::length}}))
      ->option_text("mass|length [mass]");
  command->add_option("--map-speeds", options->map_speeds, "range of speed of the map, rpm")
      ->delimiter(',')
      ->option_text("FROM,TO [slowest / 3, 3 x fastest]");
  command
      ->add_option("--map-factors", options->map_factors, "range of the factor on mass or length")
      ->delimiter(',')
      ->option_text("FROM,TO [0.25,8]");
  command->add_option("--map-size", options->map_size, "values along each side of the map")
      ->check(CLI::Range(2, 100))
      ->option_text("NUMBER [30]");
  return {command, [options] {
            if (options->speeds.empty()) options->speeds = {1500, 2350};
            return run(*options);
          }};
}

}  // namespace bentaxis::cli
