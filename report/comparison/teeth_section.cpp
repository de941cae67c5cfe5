#include "bentaxis/study/teeth_section.h"

#include <array>

#include "bentaxis/analytic/teeth.h"
#include "bentaxis/results/teeth.h"
#include "document_parts.h"

namespace bentaxis::study {
namespace {

struct Extent {
  double low = 0, high = 0, theta_of_high_deg = 0;
};

Extent extent(const ResultTable& table, const std::string& name) {
  const std::size_t column = table.find(name);
  Extent found{table.at(0, column), table.at(0, column), table.theta_deg[0]};
  for (std::size_t row = 1; row < table.rows(); ++row) {
    const double value = table.at(row, column);
    found.low = std::min(found.low, value);
    if (value > found.high) {
      found.high = value;
      found.theta_of_high_deg = table.theta_deg[row];
    }
  }
  return found;
}

// Share of the turn with so many pairs under load.
double share_with(const ResultTable& table, int pairs) {
  std::size_t rows = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    int carrying = 0;
    for (std::size_t c = 0; c < table.columns(); ++c)
      carrying += table.channels[c].group == "share" && table.at(row, c) > 0 ? 1 : 0;
    rows += carrying == pairs ? 1 : 0;
  }
  return static_cast<double>(rows) / static_cast<double>(table.rows());
}

// Where the forces of a flank's pairs act: how far along the path of contact from O4, and how far
// beside the plane in which involutes touch.
report::ScatterSeries path_of(const ResultTable& table, const PumpParameters& pump, int style) {
  report::ScatterSeries series{table.name, style, false, false, {}};
  const double pitch_cone = kPi / 2 - pump.geometry.tilt / 2;
  const double distance = 1e3 * pump.gear.pitch_diameter / 2 / std::sin(pitch_cone);  // mm
  const double sin_p = std::sin(pump.gear.pressure_angle);
  const double cos_p = std::cos(pump.gear.pressure_angle);
  const std::array<double, 3> to_o4 = {0, std::sin(pitch_cone), -std::cos(pitch_cone)};
  for (const auto& [flank, side] : {std::pair{"plus", 1.0}, {"minus", -1.0}}) {
    const std::array<double, 3> line = {-side * cos_p, sin_p * std::cos(pitch_cone),
                                        sin_p * std::sin(pitch_cone)};
    const std::array<double, 3> beside = {to_o4[1] * line[2] - to_o4[2] * line[1],
                                          to_o4[2] * line[0] - to_o4[0] * line[2],
                                          to_o4[0] * line[1] - to_o4[1] * line[0]};
    for (const char* which : {"at", "before", "after"}) {
      const std::size_t x = table.find(fmt::format("{}_{}_x1_mm", flank, which));
      for (std::size_t row = 0; row < table.rows(); ++row) {
        if (!is_computed(table.at(row, x))) continue;
        double along = 0, away = 0, out = 0, length = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          const double p = table.at(row, x + i);
          along += p * line[i];
          away += p * side * beside[i];
          out += p * to_o4[i];
          length += p * p;
        }
        series.points.push_back(
            {distance * std::atan2(along, out),
             1e3 * distance * std::asin(away / std::sqrt(length)),
             fmt::format("flank {} at {:g} deg", side > 0 ? "+" : "-", table.theta_deg[row])});
      }
    }
  }
  return series;
}

// The worst channel of each group: what differs before what does not.
std::vector<const compare::ChannelComparison*> worst_lines(const compare::Comparison& comparison) {
  const auto beyond = [](const compare::ChannelComparison& line) {
    return std::pair{line.verdict == compare::Verdict::differs, line.largest_over_peak()};
  };
  std::vector<const compare::ChannelComparison*> worst;
  for (const auto& line : comparison.channels) {
    const auto same = std::ranges::find(worst, line.channel.group,
                                        [](const auto* other) { return other->channel.group; });
    if (same == worst.end())
      worst.push_back(&line);
    else if (beyond(line) > beyond(**same))
      *same = &line;
  }
  return worst;
}

}  // namespace

report::Section teeth_section(const TeethComparison& teeth, const PumpParameters& pump) {
  const ToothData& data = *pump.gear.teeth;
  report::NewSection section(
      "Teeth in contact",
      "Forces of the tooth pairs in static equilibrium under the torque that drives the block: "
      "flank + pushes the block towards +psi, flank - towards -psi. Each model computes contact "
      "and load shares independently.");
  section.columns("furthest apart", "peak of its kind", "unit", "difference", "of peak", "verdict",
                  "its own peak");
  const Extent error = extent(teeth.analytic, "transmission_error_um");
  const analytic::BevelTeeth shape(pump);
  const analytic::BevelGeometry& at = shape.geometry();
  const auto degrees = [](double radians) { return radians / kRadPerDegree; };
  section.fact("teeth", "{} on either gear, module {:.4g} mm, face width {:.4g} mm", data.count,
               1e3 * pump.gear.pitch_diameter / data.count, 1e3 * data.face_width);
  section.fact("cones", "pitch {:.4g}, base {:.4g}, tip {:.4g}, root {:.4g} deg",
               degrees(at.pitch_cone), degrees(at.base_cone), degrees(at.tip_cone),
               degrees(at.root_cone));
  section.fact("path of contact",
               "{:.4g} to {:.4g} deg from O4 as seen from O2, base pitch {:.4g} deg, contact ratio "
               "{:.4g}",
               degrees(at.path_begin), degrees(at.path_end), degrees(at.base_pitch),
               at.contact_ratio);
  section.fact("stiffness of a pair at O4", "{:.4g} N/um, {:.4g} N/(mm um)",
               shape.stiffness() / 1e6, shape.stiffness() / 1e9 / data.face_width);
  section.fact("transmission error",
               "{:.4g} to {:.4g} um along the line of action, backlash {:.4g} um", error.low,
               error.high, 1e6 * data.backlash);
  for (const auto& [name, flank] : {std::pair{"plus_force_N", "+"}, {"minus_force_N", "-"}}) {
    const Extent force = extent(teeth.analytic, name);
    section.fact(fmt::format("force of flank {}", flank),
                 force.high > 0 ? fmt::format("{:.4g} to {:.4g} N, largest at {:g} deg", force.low,
                                              force.high, force.theta_of_high_deg)
                                : "none");
  }
  for (int pairs = 0; pairs <= 2 * kPairsPerFlank; ++pairs)
    if (const double share = share_with(teeth.analytic, pairs); share > 0)
      section.fact(fmt::format("{} {} under load", pairs, pairs == 1 ? "pair" : "pairs"),
                   "{:.3g} % of the turn", 100 * share);
  for (const auto* line : worst_lines(teeth.comparison))
    section.row(line->channel.name, line->peak, line->channel.unit, line->largest,
                line->largest_over_peak(), compare::to_string(line->verdict), line->own_peak);
  return section;
}

std::vector<report::Figure> teeth_figures(const TeethComparison& teeth,
                                          const PumpParameters& pump) {
  const report::Curves curves = report::curves_of(teeth.analytic, teeth.multibody);
  const auto figure = [&](const char* id, const char* title, const char* unit,
                          std::vector<std::string> names) {
    report::ChannelFigure content{unit, std::move(names)};
    content.curves = curves;
    // Only what the figure shows.
    const auto keep = [&](auto& columns) {
      std::erase_if(columns,
                    [&](const auto& column) { return !contains(content.channels, column.first); });
    };
    for (auto& table : content.curves->tables) keep(table.columns);
    keep(content.curves->difference);
    return report::Figure{id, title, "", std::move(content)};
  };
  return {
      figure("tooth_forces", "Forces of the flanks, and of the pairs of flank +", "N",
             {"plus_force_N", "minus_force_N", "plus_at_force_N", "plus_before_force_N",
              "plus_after_force_N"}),
      figure("transmission_error",
             "Transmission error: the shaft ahead of the block, along the line of action", "um",
             {"transmission_error_um"}),
      {"contact_path",
       "Path of contact at the distance of O4: offset from the plane of action of involutes", "",
       report::ScatterFigure{{"along the line of action, from O4", "mm"},
                             {"offset from the plane of action", "um"},
                             {path_of(teeth.analytic, pump, 0), path_of(teeth.multibody, pump, 1)}},
       "Involutes touch in one plane through O2; octoids touch outside it. Of loaded pairs: in "
       "corner contact they leave the path."}};
}

}  // namespace bentaxis::study
