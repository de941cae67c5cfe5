#include "bentaxis/designs/life_document.h"

#include "bentaxis/files/csv.h"
#include "bentaxis/study/failed_points.h"
#include "document_parts.h"

namespace bentaxis::designs {
namespace {

using report::Values;
using study::Bearing;
using study::BearingLife;
using study::LifePoint;
using study::PumpLife;

const BearingRating& rating_of(const Case& the_case, Bearing bearing) {
  return bearing == Bearing::tapered ? *the_case.ratings.tapered : *the_case.ratings.cylindrical;
}

std::string name_of(const Case& the_case, Bearing bearing) {
  const std::string& designation = rating_of(the_case, bearing).designation;
  return to_string(bearing) + (designation.empty() ? "" : " (" + designation + ")");
}

// Four digits, without an exponent.
std::string digits(double value) {
  if (!is_computed(value)) return "-";
  return value < 1000 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}

std::string hours_text(double hours) { return is_computed(hours) ? digits(hours) + " h" : "none"; }

// Of what part of the duty cycle the lives are, where that is not all of it.
std::string part_text(const LifeStudy& s) {
  if (s.failed.empty()) return "";
  const std::string rows = joined(
      s.failed, ", ", [](const study::FailedPoint& f) { return fmt::format("{:g}", f.value); });
  return fmt::format(
      "NOT the life under the whole duty cycle: row{} {} could not be computed. The other rows "
      "alone: ",
      s.failed.size() > 1 ? "s" : "", rows);
}

std::string headline(const LifeStudy& s) {
  const PumpLife& life = s.analytic.life;
  if (life.mean_speed_rpm == 0) return "no revolution: the bearings have no rating life";
  return part_text(s) + fmt::format(
                            "{} at {:.4g} rpm{} for both bearings together: tapered {}, "
                            "cylindrical {}",
                            hours_text(life.hours), life.mean_speed_rpm,
                            s.duty.rows.size() > 1 ? " on average" : "",
                            hours_text(life.of(Bearing::tapered).hours),
                            hours_text(life.of(Bearing::cylindrical).hours));
}

std::string agreement_text(const LifeStudy& s) {
  return fmt::format(
      "The loads by both models {}: they differ by {:.1e} of the largest at most, {:g} allowed.",
      s.agrees() ? "agree" : "differ", s.models_apart(), kLifeModelsAgree);
}

// What is known of a ball bearing ball by ball, by both models.
std::string balls_text(const LifeStudy& s, Bearing bearing) {
  const BearingLife& life = s.analytic.life.of(bearing);
  return fmt::format(
      "L10r {} million revolutions, {} (by Simbody {}) after ISO/TS 16281; largest radial "
      "deflection {:.4g} um, largest ball load {:.4g} N",
      digits(life.reference_revolutions), hours_text(life.reference_hours),
      hours_text(s.multibody.life.of(bearing).reference_hours), life.deflection * 1e6,
      life.largest_ball_load);
}

report::Section bearings_section(const LifeStudy& s) {
  report::NewSection section(
      "Bearings",
      "Rating life after ISO 281: 90 % of the bearings last longer. P_m: the constant equivalent "
      "load with the same life. No factor for lubrication, cleanliness or reliability (a_ISO = a_1 "
      "= 1).");
  section.fact("both together, million revolutions", rounded_text(s.analytic.life.revolutions));
  section.fact("both together", hours_text(s.analytic.life.hours));
  section.fact("mean speed", "{:.6g} rpm", s.analytic.life.mean_speed_rpm);
  section.fact("largest difference of the models", "{:.1e} of the largest load", s.models_apart());
  section.columns("bearing", "C, N", "C0, N", "P_m, N", "P_m by Simbody, N", "C / P_m",
                  "L10, million revolutions", "L10h, h", "static safety C0 / P0");
  for (const Bearing bearing : study::kBearings) {
    const BearingRating& rating = rating_of(s.the_case, bearing);
    const BearingLife& life = s.analytic.life.of(bearing);
    if (is_computed(life.reference_revolutions))
      section.fact(name_of(s.the_case, bearing), balls_text(s, bearing));
    section.row(name_of(s.the_case, bearing), rating.dynamic_rating, rating.static_rating,
                life.mean_load, s.multibody.life.of(bearing).mean_load,
                rating.dynamic_rating / life.mean_load, life.revolutions, life.hours,
                life.static_safety);
  }
  return section;
}

// Mean equivalent load of one row.
double load_of(const Case& the_case, const LifePoint& point, Bearing bearing) {
  const auto& loads = point.loads[static_cast<std::size_t>(bearing)].equivalent;
  return study::mean_load(loads, std::vector<double>(loads.size(), 1.0),
                          study::law_of(rating_of(the_case, bearing).element).life_exponent);
}

report::Section duty_section(const LifeStudy& s) {
  report::NewSection section(
      "Duty cycle",
      "Loads count by revolutions, time at standstill by the hours only. Life: the share of the "
      "life that each row consumes.");
  if (!s.duty.file.empty()) section.fact("file", s.duty.file.filename().string());
  section.columns("row", "time, %", "revolutions, %",
                  report::each_of(s.duty.variables, [](const Variable& v) {
                    return v.name() + (v.unit().empty() ? "" : ", " + v.unit());
                  }));
  for (const Bearing bearing : study::kBearings)
    section.columns(to_string(bearing) + " P_m, N", to_string(bearing) + " life, %");
  const study::DutyShares shares = study::duty_shares(s.analytic.points);
  for (std::size_t row = 0; row < s.duty.rows.size(); ++row) {
    report::Row values;
    for (std::size_t i = 0; i < s.duty.variables.size(); ++i)
      values.emplace_back(s.duty.variables[i].text(s.duty.rows[row].values[i]));
    for (const Bearing bearing : study::kBearings) {
      values.emplace_back(load_of(s.the_case, s.analytic.points[row], bearing));
      values.emplace_back(100 * s.analytic.life.of(bearing).life_share[row]);
    }
    section.row(s.duty.rows[row].number, 100 * shares.time[row], 100 * shares.revolutions[row],
                values);
  }
  return section;
}

std::string limit_name(const study::LifeLimit& limit) {
  return (limit.of_bearing ? to_string(limit.bearing) + " bearing: " : "") + limit.limit;
}

// "over 7.5 % of the revolutions"; a pump at rest has angles alone.
std::string share_text(double share, const PumpLife& life) {
  return fmt::format("over {:.3g} % of the {}", 100 * share,
                     life.mean_speed_rpm == 0 ? "angles" : "revolutions");
}

// Where any limit is exceeded; "" where none is.
std::string not_valid_of(const PumpLife& life) {
  return life.violated_share > 0 ? share_text(life.violated_share, life) : "";
}

// Which bearing sets the life, and which row of the duty cycle uses up most of it.
std::vector<std::string> answers_of(const LifeStudy& s) {
  const PumpLife& life = s.analytic.life;
  if (life.mean_speed_rpm == 0) return {};
  const Bearing first = life.of(Bearing::tapered).hours <= life.of(Bearing::cylindrical).hours
                            ? Bearing::tapered
                            : Bearing::cylindrical;
  if (!is_computed(life.of(first).hours)) return {};
  std::vector<std::string> answers = {
      fmt::format("The {} bearing sets the life ({}; both together {}).",
                  first == Bearing::tapered ? "tapered" : "cylindrical",
                  hours_text(life.of(first).hours), hours_text(life.hours))};
  const std::vector<double>& shares = life.of(first).life_share;
  if (s.duty.rows.size() > 1 && shares.size() == s.duty.rows.size()) {
    const auto row = static_cast<std::size_t>(std::ranges::max_element(shares) - shares.begin());
    const study::DutyShares duty = study::duty_shares(s.analytic.points);
    answers.push_back(fmt::format(
        "Most of its life is consumed by {}: {:.3g} % of its life in {:.3g} % of the time.",
        s.duty.name_of(row), 100 * shares[row], 100 * duty.time[row]));
  }
  for (const study::LifeLimit& l : life.limits)
    if (l.violated_share > 0)
      answers.push_back(fmt::format("Not valid {}, where this does not hold: {}.",
                                    share_text(l.violated_share, life), limit_name(l)));
  return answers;
}

std::vector<report::ValidityRow> validity_of(const LifeStudy& s) {
  std::vector<report::ValidityRow> rows;
  for (const study::LifeLimit& l : s.analytic.life.limits)
    rows.push_back(
        {limit_name(l), l.unit,
         l.consequence +
             (s.duty.rows.size() > 1 ? " (worst in " + s.duty.name_of(l.point) + ")" : ""),
         true, l.violated_share, l.worst, l.theta_deg});
  return rows;
}

// The row that uses up most of the life of the bearing that lasts shorter.
std::size_t hardest_row(const LifeStudy& s) {
  const PumpLife& life = s.analytic.life;
  if (life.mean_speed_rpm == 0) return 0;
  const bool tapered =
      life.of(Bearing::tapered).revolutions <= life.of(Bearing::cylindrical).revolutions;
  const auto& shares = life.of(tapered ? Bearing::tapered : Bearing::cylindrical).life_share;
  return static_cast<std::size_t>(std::ranges::max_element(shares) - shares.begin());
}

// A bearing's loads over the turn of one row, by both models.
report::Figure turn_figure(const LifeStudy& s, Bearing bearing, std::size_t row) {
  report::Curves curves;
  curves.theta_deg = s.analytic.points[row].theta_deg;
  curves.tables = {{"analytic", {}}, {"multibody", {}}};
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, std::vector<double> study::BearingLoads::*which) {
    const auto i = static_cast<std::size_t>(bearing);
    names.push_back(name);
    add_both(curves, name, s.analytic.points[row].loads[i].*which,
             s.multibody.points[row].loads[i].*which);
  };
  if (bearing == Bearing::tapered) {
    add("P, equivalent load", &study::BearingLoads::equivalent);
    add("Fr, radial load", &study::BearingLoads::radial);
    add("Fa, axial load", &study::BearingLoads::axial);
  } else {
    add("P = Fr, radial load", &study::BearingLoads::equivalent);
  }
  report::Figure figure{to_string(bearing) + "_turn",
                        fmt::format("Loads of the {} bearing over a turn", to_string(bearing)), "",
                        report::ChannelFigure{"N", names, {}, std::move(curves)}};
  if (s.duty.rows.size() > 1)
    figure.note = "The row that consumes most of the life: " + s.duty.name_of(row) + ".";
  return figure;
}

// Share of the revolutions above a load.
report::Figure spectrum_figure(const LifeStudy& s) {
  constexpr std::size_t kMaxPoints = 400;  // of a curve
  const study::DutyShares shares = study::duty_shares(s.analytic.points);
  report::XyFigure plot{
      {"share of the revolutions above it", "%"}, {"equivalent load", "N", false, 0}, {}};
  for (const Bearing bearing : study::kBearings) {
    std::vector<std::pair<double, double>> spectrum;  // load, share
    for (std::size_t row = 0; row < s.analytic.points.size(); ++row) {
      const auto& loads =
          s.analytic.points[row].loads[static_cast<std::size_t>(bearing)].equivalent;
      for (const double load : loads)
        spectrum.emplace_back(load, shares.revolutions[row] / static_cast<double>(loads.size()));
    }
    std::ranges::sort(spectrum, std::greater<>());
    report::XySeries series{to_string(bearing), {0}, {spectrum.front().first}};
    double above = 0, shown = 0;
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
      above += 100 * spectrum[k].second;
      if (above - shown < 100.0 / kMaxPoints && k + 1 < spectrum.size()) continue;
      shown = above;
      series.add(above, spectrum[k].first);
    }
    plot.series.push_back(std::move(series));
    const double mean = s.analytic.life.of(bearing).mean_load;
    plot.series.push_back({to_string(bearing) + ", P_m", {0, 100}, {mean, mean}});
  }
  return {"spectrum", "Load spectrum of both bearings", "", std::move(plot),
          "Every angle of every row of the duty cycle, largest load first; P_m is the constant "
          "load with the same life."};
}

}  // namespace

report::Document life_document(const LifeStudy& s, const report::Lines& program,
                               const study::CaseDescription& description) {
  report::Document document =
      study::case_document(description, s.the_case.name + ": life of the bearings", program);
  document.verdict = {.agrees = s.agrees(),
                      .headline = headline(s),
                      .not_valid = not_valid_of(s.analytic.life),
                      .answers = answers_of(s)};
  document.meaning = agreement_text(s) +
                     " The rating life includes only fatigue of the rolling contacts under these "
                     "loads; it is as reliable as the ratings and loads.";
  document.validity = validity_of(s);
  document.runs = {bearings_section(s), duty_section(s)};
  const std::size_t row = hardest_row(s);
  document.figures = {turn_figure(s, Bearing::tapered, row),
                      turn_figure(s, Bearing::cylindrical, row)};
  if (s.analytic.life.mean_speed_rpm > 0) document.figures->push_back(spectrum_figure(s));
  study::add_warnings(document, s.failed);
  return document;
}

std::string life_csv(const LifeStudy& s) {
  std::string header = "row,time_share,revolution_share";
  for (const Variable& v : s.duty.variables) header += "," + v.name();
  for (const Bearing bearing : study::kBearings)
    for (const char* what : {"P_N", "P_multibody_N", "life_share"})
      header += "," + to_string(bearing) + "_" + what;
  CsvRows csv(header + ",reason");
  const study::DutyShares shares = study::duty_shares(s.analytic.points);
  const std::string no_reason;
  for (std::size_t row = 0; row < s.duty.rows.size(); ++row) {
    std::vector<double> loads;
    for (const Bearing bearing : study::kBearings)
      loads.insert(loads.end(), {load_of(s.the_case, s.analytic.points[row], bearing),
                                 load_of(s.the_case, s.multibody.points[row], bearing),
                                 s.analytic.life.of(bearing).life_share[row]});
    csv.row(s.duty.rows[row].number, shares.time[row], shares.revolutions[row],
            s.duty.rows[row].values, loads, no_reason);
  }
  const std::vector<double> nothing(2 + s.duty.variables.size() + 3 * std::size(study::kBearings),
                                    not_computed());
  for (const study::FailedPoint& f : s.failed)
    csv.row(fmt::format("{:g}", f.value), nothing, f.reason);
  return std::move(csv).text();
}

std::string life_loads_csv(const LifeStudy& s) {
  CsvRows csv(
      "row,theta_deg,model,tapered_Fr_N,tapered_Fa_N,tapered_P_N,tapered_P0_N,cylindrical_P_N");
  for (std::size_t row = 0; row < s.duty.rows.size(); ++row)
    for (std::size_t k = 0; k < s.analytic.points[row].theta_deg.size(); ++k)
      for (const auto* of : {&s.analytic, &s.multibody}) {
        const LifePoint& p = of->points[row];
        csv.row(s.duty.rows[row].number, p.theta_deg[k],
                of == &s.analytic ? "analytic" : "multibody", p.loads[0].radial[k],
                p.loads[0].axial[k], p.loads[0].equivalent[k], p.loads[0].equivalent0[k],
                p.loads[1].equivalent[k]);
      }
  return std::move(csv).text();
}

std::string life_text(const LifeStudy& s) {
  std::string text = s.the_case.name + "\n" + headline(s) + "\n" + agreement_text(s) + "\n";
  for (const std::string& answer : answers_of(s)) text += answer + "\n";
  text += "\n";
  text += fmt::format("{:<28} {:>8} {:>8} {:>8} {:>10} {:>9} {:>7}\n", "bearing", "C kN", "C0 kN",
                      "P_m kN", "L10 1e6", "L10h h", "C0/P0");
  for (const Bearing bearing : study::kBearings) {
    const BearingRating& rating = rating_of(s.the_case, bearing);
    const BearingLife& life = s.analytic.life.of(bearing);
    text += fmt::format("{:<28} {:>8.4g} {:>8.4g} {:>8} {:>10} {:>9} {:>7.3g}\n",
                        name_of(s.the_case, bearing), rating.dynamic_rating / 1e3,
                        rating.static_rating / 1e3, digits(life.mean_load / 1e3),
                        digits(life.revolutions), digits(life.hours), life.static_safety);
  }
  for (const Bearing bearing : study::kBearings)
    if (is_computed(s.analytic.life.of(bearing).reference_revolutions))
      text += name_of(s.the_case, bearing) + ": " + balls_text(s, bearing) + "\n";
  if (s.duty.rows.size() > 1) {
    const study::DutyShares shares = study::duty_shares(s.analytic.points);
    text += fmt::format("\n{:>7} {:>7} {:>10} {:>12}  of time, revolutions, life used up, %\n",
                        "time", "turns", "tapered", "cylindrical");
    for (std::size_t row = 0; row < s.duty.rows.size(); ++row)
      text += fmt::format(
          "{:>7.3g} {:>7.3g} {:>10.3g} {:>12.3g}  {}\n", 100 * shares.time[row],
          100 * shares.revolutions[row], 100 * s.analytic.life.of(Bearing::tapered).life_share[row],
          100 * s.analytic.life.of(Bearing::cylindrical).life_share[row], s.duty.name_of(row));
  }
  for (const study::LifeLimit& l : s.analytic.life.limits)
    if (l.violated_share > 0)
      text += fmt::format("exceeded {}: {} (worst {:.4g} {}): {}\n",
                          share_text(l.violated_share, s.analytic.life), limit_name(l), l.worst,
                          l.unit, l.consequence);
  return text;
}

}  // namespace bentaxis::designs
