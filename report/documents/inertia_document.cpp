#include "bentaxis/study/inertia_document.h"

#include <map>

#include "document_parts.h"

namespace bentaxis::study {
namespace {

using report::Curves;
using report::Figure;
using report::NewSection;
using report::Values;
using report::values_of;
using Names = std::vector<std::string>;

const Names kRs = {"Rs_1_x2_N", "Rs_1_y2_N", "Rs_1_z2_N"};
const Names kRc = {"Rc_1_x2_N", "Rc_1_y2_N"};

constexpr const char* kCancels = "none: loads that cancel";

std::string rpm(double speed) { return fmt::format("{:g} rpm", speed); }
std::string load_name(bool loaded) { return loaded ? "loaded" : "no load"; }

// Magnitude of a vector of piston 1 over the turn.
Values magnitude(const ResultTable& table, const Names& names) {
  return report::values_at(table.rows(), [&](std::size_t row) {
    double squares = 0;
    for (const auto& name : names) {
      const double value = table.at(row, table.find(name));
      squares += value * value;
    }
    return std::sqrt(squares);
  });
}

const ResultTable& analytic_of(const InertiaRun& run, bool real) {
  return real ? run.analytic_real : run.analytic_lumped;
}
const ResultTable& multibody_of(const InertiaRun& run, bool real) {
  return real ? run.multibody_real : run.multibody_lumped;
}

// ---- Figures

// |R| of both kinds of piston at all speeds, without load or loaded.
Figure magnitude_figure(const InertiaStudy& s, Curves& curves, const std::string& id,
                        const std::string& symbol, const Names& parts, bool loaded,
                        const std::string& paper) {
  Names names;
  for (const InertiaRun& run : s.one_piston) {
    if (run.loaded != loaded) continue;
    for (const bool real : {false, true}) {
      names.push_back(fmt::format("|{}| {}, {}, {}", symbol, rpm(run.speed_rpm),
                                  real ? "real piston" : "2 masses", load_name(loaded)));
      add_both(curves, names.back(), magnitude(analytic_of(run, real), parts),
               magnitude(multibody_of(run, real), parts));
    }
  }
  return {id, fmt::format("|{}| of a piston, {}", symbol, load_name(loaded)), paper,
          report::ChannelFigure{"N", names}};
}

// Components at the fastest speed, without load.
Figure component_figure(const InertiaRun& run, Curves& curves, const std::string& id,
                        const std::string& symbol, const Names& parts) {
  Names names;
  for (const auto& part : parts) {
    for (const bool real : {false, true}) {
      names.push_back(part + (real ? ", real piston" : ", 2 masses"));
      add_both(curves, names.back(), values_of(analytic_of(run, real), part),
               values_of(multibody_of(run, real), part));
    }
  }
  return {id, fmt::format("{} by component, no load, {}", symbol, rpm(run.speed_rpm)), "",
          report::ChannelFigure{"N", names}};
}

// lumped - real of channels of the full pump.
Figure effect_figure(const InertiaRun& run, Curves& curves, const std::string& id,
                     const std::string& title, const std::string& unit, const Names& channels) {
  Names names;
  const ResultTable analytic = difference(run.analytic_lumped, run.analytic_real, "");
  const ResultTable multibody = difference(run.multibody_lumped, run.multibody_real, "");
  for (const auto& channel : channels) {
    names.push_back(channel + ", 2 masses - real");
    add_both(curves, names.back(), values_of(analytic, channel), values_of(multibody, channel));
  }
  return {id, fmt::format("{}, {}, {}", title, rpm(run.speed_rpm), load_name(run.loaded)), "",
          report::ChannelFigure{unit, names}};
}

Figure cause_figure(const InertiaStudy& s, Curves& curves, const std::string& id,
                    const std::string& symbol, const Names& parts) {
  Names names;
  for (const auto part :
       {&ErrorCauses::all, &ErrorCauses::centre, &ErrorCauses::transverse, &ErrorCauses::spin}) {
    names.push_back(fmt::format("|error of {}| by {}", symbol, (s.causes.*part).name));
    add_both(curves, names.back(), magnitude(s.causes.*part, parts),
             magnitude(s.multibody_causes.*part, parts));
  }
  return {
      id,
      fmt::format("Error of {} that lumping causes, each cause alone, {}", symbol, rpm(s.fastest)),
      "", report::ChannelFigure{"N", names},
      "Magnitudes of vectors; the vectors add up, their magnitudes need not."};
}

// Rs and Rc over something, of a list of results.
template <class Result>
std::vector<report::XySeries> both_errors(const std::vector<Result>& results,
                                          double Result::*argument) {
  std::vector<report::XySeries> series = {{"Rs", {}, {}}, {"Rc", {}, {}}};
  for (const Result& result : results) {
    for (auto& s : series) s.x.push_back(result.*argument);
    series[0].y.push_back(result.error_rs);
    series[1].y.push_back(result.error_rc);
  }
  return series;
}

Figure fraction_figure(const InertiaStudy& s) {
  return {"fraction", "Error of two masses over chi, no load, " + rpm(s.fastest), "",
          report::XyFigure{{"chi, share of the mass at A"},
                           {"largest error over the turn", "N", false, 0},
                           both_errors(s.over_fraction, &Lumping::joint_mass_fraction)}};
}

Figure approach_figure(const InertiaStudy& s) {
  return {
      "approach",
      "Simbody: the real piston converges to the lumped one as its inertia does, " + rpm(s.fastest),
      "",
      report::XyFigure{{"t: 1 = real piston, 0 = moments of the lumped one", "", true},
                       {"difference from the lumped scene", "N", true},
                       both_errors(s.approach, &Approach::t)},
      "A rigid body with free spin against a massless rod with two point masses: two "
      "different Simbody bodies and joints."};
}

Figure map_figure(const InertiaStudy& s, const std::string& symbol, std::vector<Values> percent) {
  for (auto& row : percent)
    for (double& share : row) share *= 100;
  const bool mass = s.map.axis == MapAxis::mass;
  return {"map_" + symbol, fmt::format("Lumping error of {} over the loaded reaction", symbol), "",
          report::MapFigure{
              {"speed", "rpm", true},
              {mass ? "mass of the piston over the case's" : "length over the case's", "", true},
              {"error", "%"},
              s.map.speed_rpm,
              s.map.factor,
              std::move(percent),
              {0.1, 1, 5},
              {{"case", std::abs(s.one_piston.front().speed_rpm), 1},
               {"case", std::abs(s.fastest), 1}}},
          "Largest |two masses - real| over the turn, divided by the real piston's largest "
          "loaded reaction of the same pump."};
}

std::vector<Figure> all_figures(const InertiaStudy& s, Curves& curves) {
  const auto fast = [&](const std::vector<InertiaRun>& runs, bool loaded) -> const InertiaRun& {
    return *std::ranges::find_if(runs, [&](const InertiaRun& run) {
      return run.speed_rpm == s.fastest && run.loaded == loaded;
    });
  };
  const InertiaRun& bare = fast(s.one_piston, false);
  const InertiaRun& full = fast(s.full, true);
  std::vector<Figure> figures = {
      magnitude_figure(s, curves, "rc", "Rc", kRc, false, "Fig. 36"),
      magnitude_figure(s, curves, "rs", "Rs", kRs, false, "Fig. 37"),
      component_figure(bare, curves, "rc_parts", "Rc", kRc),
      component_figure(bare, curves, "rs_parts", "Rs", kRs),
      magnitude_figure(s, curves, "rc_loaded", "Rc", kRc, true, "Fig. 14"),
      magnitude_figure(s, curves, "rs_loaded", "Rs", kRs, true, "Fig. 12"),
      cause_figure(s, curves, "causes_rs", "Rs", kRs),
      cause_figure(s, curves, "causes_rc", "Rc", kRc),
      fraction_figure(s),
      effect_figure(full, curves, "bearings", "Effect of lumping on the bearings", "N",
                    {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N", "Rb2_x1_N", "Rb2_y1_N"})};
  if (full.analytic_real.find("Rcs_z4_N") < full.analytic_real.columns())
    figures.push_back(effect_figure(full, curves, "gear", "Effect of lumping on the tooth force",
                                    "N", {"Rcs_z4_N"}));
  figures.push_back(effect_figure(full, curves, "torque", "Effect of lumping on the drive torque",
                                  "Nm", {"Td_z1_Nm"}));
  figures.push_back(map_figure(s, "Rc", s.map.rc));
  figures.push_back(map_figure(s, "Rs", s.map.rs));
  figures.push_back(approach_figure(s));
  return figures;
}

// ---- Tables

// Of every run, over the peak of the loaded run of its speed.
std::vector<LumpingError> errors_of(const std::vector<InertiaRun>& runs) {
  std::vector<LumpingError> errors;
  for (const InertiaRun& run : runs)
    append(errors, lumping_errors(run, InertiaStudy::loaded(runs, run.speed_rpm)));
  return errors;
}

report::Section error_section(const char* title, const char* text,
                              const std::vector<InertiaRun>& runs, const Names& groups) {
  NewSection section(title, text);
  section.columns("reaction", "speed, rpm", "load", "error of lumping, analytic",
                  "the same, multibody", "peak of this run", "peak loaded",
                  "error, % of peak loaded");
  for (const auto& error : errors_of(runs))
    if (contains(groups, error.group))
      section.row(fmt::format("{} ({})", error.group, error.unit), error.speed_rpm,
                  load_name(error.loaded), error.analytic, error.multibody, error.peak,
                  error.loaded_peak,
                  error.cancels() ? report::Cell(kCancels) : report::Cell(100 * error.fraction()));
  return section;
}

report::Section causes_section(const InertiaStudy& s) {
  NewSection section(
      "Where the error comes from",
      "From two masses to the real piston three things change; each is switched alone, without "
      "load at " +
          rpm(s.fastest) + ". As vectors the three add up exactly to the total.");
  section.fact("largest part the three do not explain", "{:.1e} N", s.causes.rest);
  section.columns("cause", "error of Rs, N", "error of Rc, N");
  for (const ResultTable* cause :
       {&s.causes.centre, &s.causes.transverse, &s.causes.spin, &s.causes.all})
    section.row(cause->name, cause->peak("Rs"), cause->peak("Rc"));
  return section;
}

report::Section lumping_section(const InertiaStudy& s) {
  NewSection section("Which lumping is best",
                     "Remaining error, maximum over the turn, without load at " + rpm(s.fastest) +
                         ". Three point masses ([piston] inertia = \"dynamically_equivalent\") "
                         "leave the gyroscopic moment of spin only.");
  section.columns("lumping", "chi", "error of Rs, N", "error of Rc, N");
  for (const auto& lumping : s.lumpings)
    section.row(lumping.name, lumping.joint_mass_fraction, lumping.error_rs, lumping.error_rc);
  if (!s.masses.exists) {
    section.fact("three point masses", "do not exist: the centre of mass is not between A and B");
    return section;
  }
  for (const auto& [name, mass] : {std::pair{"mass at A", s.masses.at_joint},
                                   {"mass at the centre", s.masses.at_centre},
                                   {"mass at B", s.masses.at_ring}})
    section.fact(name, "{:.5g} kg", mass);
  section.fact("three real masses would do", s.masses.positive
                                                 ? "yes, all are positive"
                                                 : "no, one is negative; the equations still hold");
  return section;
}

report::Section approach_section(const InertiaStudy& s) {
  NewSection section(
      "Simbody: from the real piston to the lumped one",
      "Centre of mass, transverse and axial inertia go to those of the two masses with t.");
  section.columns("t", "difference of Rs, N", "difference of Rc, N");
  for (const auto& step : s.approach) section.row(step.t, step.error_rs, step.error_rc);
  if (!s.spin) {
    section.fact("spin", "none: the piston has no axial inertia");
    return section;
  }
  section.fact("spin at the start", rpm(s.spin->spin_rpm));
  section.fact("largest change over a turn integrated", "{:.1e} rad/s (accuracy {:g} per step)",
               s.spin->worst_change, s.spin->accuracy);
  return section;
}

report::Section cost_section(const InertiaStudy& s) {
  NewSection section(
      "What each scene costs",
      "Real pistons, processor time measured in this run (fastest of three turns). Curves of "
      "this report are of the one-piston scene, tables of bearings of the full one.");
  section.fact("largest difference of the models, of peak", "{:.1e}", s.models_apart);
  section.fact("one-piston scene against full pump, of peak", "{:.1e}", s.scenes_apart);
  section.fact("pistons in the pump", "{}", s.the_case.pump.geometry.pistons);
  section.columns("scene", "reactions by", "bodies", "mobilities", "constraint equations",
                  "microseconds per angle", "times cheaper than the full pump");
  double full = not_computed();
  for (const auto& cost : s.costs)
    if (cost.scene == "full" && cost.method == "multipliers") full = cost.microseconds_per_angle;
  for (const auto& cost : s.costs)
    section.row(cost.scene, cost.method, cost.bodies, cost.mobilities, cost.equations,
                cost.microseconds_per_angle, full / cost.microseconds_per_angle);
  return section;
}

// ---- Printed numbers

report::PublishedTable published_table(compare::PublishedSection section) {
  return {
      "The paper's figures are of the Casappa BAP 63 at 1500 and 2350 rpm without load. They apply "
      "to this case only as far as it is that pump at those speeds; its geometry and masses are "
      "not printed and were inferred.",
      std::move(section)};
}

// By group, of all speeds, loaded.
std::map<std::string, LumpingError> worst_errors(const InertiaStudy& s) {
  std::map<std::string, LumpingError> worst;
  for (const InertiaRun& run : s.full)
    if (run.loaded)
      for (const auto& error : lumping_errors(run, run))
        if (auto& known = worst[error.group];
            known.group.empty() || error.fraction() > known.fraction())
          known = error;
  return worst;
}

// The answer to what the study was asked; "" where the models do not agree.
std::string word(const InertiaStudy& s) {
  if (!s.agrees()) return {};
  const auto worst = worst_errors(s);
  return std::ranges::all_of(worst,
                             [](const auto& one) { return one.second.fraction() <= kTwoMassesDo; })
             ? "Two masses are enough"
             : "Two masses are not enough";
}

// Will two masses do? Which reactions they miss by more than the limit, and where; the rest.
std::string headline(const InertiaStudy& s) {
  const auto of_peak = [](const LumpingError& error) {
    return fmt::format("{:.2g} % of its loaded peak ({:.3g} {} at {})", 100 * error.fraction(),
                       error.analytic, error.unit, rpm(error.speed_rpm));
  };
  std::vector<std::string> missed;
  const LumpingError* largest = nullptr;  // of those within the limit
  const auto worst = worst_errors(s);
  for (const auto& [group, error] : worst) {
    if (error.fraction() > kTwoMassesDo)
      missed.push_back(fmt::format("{}: off by {}", group, of_peak(error)));
    else if (largest == nullptr || error.fraction() > largest->fraction())
      largest = &error;
  }
  std::string text = missed.empty() ? "Two point masses are accurate enough"
                                    : fmt::format("Two point masses are not accurate enough for {}",
                                                  joined(missed, "; "));
  if (largest != nullptr)
    text += fmt::format("{}: {} is off by {}, the rest by less",
                        missed.empty() ? "" : ". They are for the others", largest->group,
                        of_peak(*largest));
  text += fmt::format(". The limit is {:g} %.", 100 * kTwoMassesDo);
  if (s.agrees()) return text + fmt::format(" The models agree to {:.1e} of peak.", s.models_apart);
  const bool models = !(s.models_apart <= kInertiaModelsAgree);
  return fmt::format("{} by {:.1e} of peak (tolerance {:g}). ",
                     models ? "The models differ"
                            : "The multibody model of one piston differs from that of the full "
                              "pump",
                     models ? s.models_apart : s.scenes_apart,
                     models ? kInertiaModelsAgree : kInertiaScenesAgree) +
         text;
}

// What makes the error, and which lumping leaves least.
std::vector<std::string> answers_of(const InertiaStudy& s) {
  std::vector<std::string> answers;
  const auto& c = s.causes;
  for (const auto& [group, piston_force] :
       {std::pair{"Rs", "the joint force Rs"}, std::pair{"Rc", "the bore force Rc"}}) {
    const ResultTable* largest = &c.centre;
    for (const ResultTable* cause : {&c.transverse, &c.spin})
      if (cause->peak(group) > largest->peak(group)) largest = cause;
    answers.push_back(fmt::format(
        "Two masses change {} of a piston by up to {:.3g} N without load at {}; the largest part, "
        "{:.3g} N{}, comes from: {}.",
        piston_force, c.all.peak(group), rpm(s.fastest), largest->peak(group),
        largest->peak(group) > c.all.peak(group) ? " before others take some of it away" : "",
        largest->name));
  }
  const Lumping* best = report::largest_of(
      s.lumpings, [](const Lumping& l) { return -std::max(l.error_rs, l.error_rc); });
  if (best == nullptr) return answers;
  answers.push_back(fmt::format("Smallest error at {}: {}{}, {:.3g} N in Rs and {:.3g} N in Rc.",
                                rpm(s.fastest), best->name,
                                is_computed(best->joint_mass_fraction)
                                    ? fmt::format(" (chi = {:.5g})", best->joint_mass_fraction)
                                    : "",
                                best->error_rs, best->error_rc));
  return answers;
}

}  // namespace

InertiaReport inertia_report(const InertiaStudy& s,
                             std::optional<compare::PublishedSection> published,
                             const report::Lines& program, const CaseDescription& description) {
  InertiaReport result;
  Curves& curves = result.curves;
  curves.theta_deg = s.one_piston.front().analytic_real.theta_deg;
  curves.tables = {{"analytic", {}}, {"multibody", {}}};
  report::Document& document = result.document;
  document = case_document(description, "Lumped or real pistons: " + s.the_case.name, program);
  document.verdict = {.agrees = s.agrees(),
                      .headline = headline(s),
                      .word = word(s),
                      .tolerance = kInertiaModelsAgree,
                      .answers = answers_of(s)};
  document.runs = {
      error_section("Error of lumping on a piston's reactions",
                    "Largest magnitude of two masses - real over the turn. Reactions are linear in "
                    "the inertia forces, so load does not change the error (but for the weight); "
                    "it changes the peak that the error is relative to.",
                    s.one_piston, {"Rs", "Rc"}),
      error_section("Error of lumping on bearings, gear and torque", "Full pump, both models.",
                    s.full, {"Rb1", "Rb2", "Rcs", "Rcn", "Td"}),
      causes_section(s),
      lumping_section(s),
      approach_section(s),
      cost_section(s)};
  if (published) document.published = published_table(std::move(*published));
  document.figures = all_figures(s, curves);
  return result;
}

std::string inertia_curves_csv(const InertiaStudy& s) {
  const ResultTable& first = s.one_piston.front().analytic_real;
  std::string header = "theta_deg";
  std::vector<Values> columns = {first.theta_deg};
  const auto add = [&](const std::string& name, Values values) {
    header += "," + name;
    columns.push_back(std::move(values));
  };
  for (const InertiaRun& run : s.one_piston)
    for (const auto& [name, table] : {std::pair{"analytic_lumped", &run.analytic_lumped},
                                      std::pair{"analytic_real", &run.analytic_real},
                                      std::pair{"multibody_lumped", &run.multibody_lumped},
                                      std::pair{"multibody_real", &run.multibody_real}}) {
      const std::string prefix =
          fmt::format("{}_{}_{:g}rpm_", name, run.loaded ? "loaded" : "noload", run.speed_rpm);
      for (const auto* parts : {&kRs, &kRc}) {
        for (const auto& part : *parts) add(prefix + part, values_of(*table, part));
        add(prefix + (parts == &kRs ? "Rs_1_magnitude_N" : "Rc_1_magnitude_N"),
            magnitude(*table, *parts));
      }
    }
  CsvRows csv(header);
  for (std::size_t row = 0; row < first.rows(); ++row)
    csv.row(report::each_of(columns, [&](const Values& values) { return values[row]; }));
  return std::move(csv).text();
}

std::string inertia_errors_csv(const InertiaStudy& s) {
  CsvRows csv(
      "reaction,unit,speed_rpm,load,error_analytic,error_multibody,peak,peak_loaded,"
      "error_over_peak_loaded");
  for (const auto& error : errors_of(s.full))
    csv.row(error.group, error.unit, error.speed_rpm, error.loaded ? "loaded" : "no_load",
            error.analytic, error.multibody, error.peak, error.loaded_peak, error.fraction());
  return std::move(csv).text();
}

std::string inertia_map_csv(const ErrorMap& map) {
  CsvRows csv((map.axis == MapAxis::mass ? "mass_factor" : "length_factor") +
              std::string(",speed_rpm,Rs_error_over_loaded,Rc_error_over_loaded"));
  for (std::size_t i = 0; i < map.factor.size(); ++i)
    for (std::size_t j = 0; j < map.speed_rpm.size(); ++j)
      csv.row(map.factor[i], map.speed_rpm[j], map.rs[i][j], map.rc[i][j]);
  return std::move(csv).text();
}

std::string inertia_text(const InertiaStudy& s) {
  std::string text = report::answers_text(s.the_case.name, headline(s), answers_of(s));
  text += "error of lumping    speed rpm  load      N or Nm   % of loaded peak\n";
  for (const auto& error : errors_of(s.full))
    text += fmt::format("{:<20}{:>9g}  {:<8} {:>9.4g}   {}\n", error.group, error.speed_rpm,
                        load_name(error.loaded), error.analytic,
                        error.cancels() ? kCancels : fmt::format("{:.3g}", 100 * error.fraction()));
  for (const PistonInertia inertia : s.full.front().by_inverse_dynamics)
    text += to_string(inertia) +
            " pistons have no inertia about A: their multibody reactions are by inverse dynamics\n";
  text += fmt::format("\nbest lumping at {}, no load (error of Rs, Rc in N)\n", rpm(s.fastest));
  for (const auto& lumping : s.lumpings)
    text += fmt::format("{:<50} chi {:<8} {:>9.4g} {:>9.4g}\n", lumping.name,
                        is_computed(lumping.joint_mass_fraction)
                            ? fmt::format("{:.5f}", lumping.joint_mass_fraction)
                            : "-",
                        lumping.error_rs, lumping.error_rc);
  text += "\nscene     reactions by  bodies  equations  us per angle\n";
  for (const auto& cost : s.costs)
    text += fmt::format("{:<9} {:<13} {:>6}  {:>9}  {:>12.1f}\n", cost.scene, cost.method,
                        cost.bodies, cost.equations, cost.microseconds_per_angle);
  return text;
}

}  // namespace bentaxis::study
