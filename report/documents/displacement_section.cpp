#include "bentaxis/study/displacement_section.h"

#include "bentaxis/pump/fixed_text.h"
#include "bentaxis/study/failed_points.h"
#include "document_parts.h"

namespace bentaxis::study {
namespace {

constexpr double kCubicCentimetre = 1e-6;  // m3
constexpr double kRpm = 1.0 / 60;          // rev/s

std::string bias_text(const DerivedDisplacement& derived) {
  return fixed_text(100 * derived.bias, 2, true) + " %";
}

std::string place_of(const FlowPoint& point) {
  return fmt::format("{:.6g} rpm and {:.6g} bar", speed_rpm(point), delivery_bar(point));
}

// Points above 100 %, by speed: "1500 rpm at 13.75, 55 bar; 1200 rpm at 13.75 bar".
std::string places_above(const std::vector<FlowPoint>& points, const DerivedDisplacement& derived) {
  std::string text;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(derived.efficiency[i] > 1 + kFlowRounding)) continue;
    const bool same =
        !text.empty() && i > 0 && points[i - 1].speed == points[i].speed && text.ends_with(" bar");
    if (same)
      text.replace(text.size() - 4, 4, ", ");
    else
      text += fmt::format("{}{:.6g} rpm at ", text.empty() ? "" : "; ", speed_rpm(points[i]));
    text += fmt::format("{:.6g} bar", delivery_bar(points[i]));
  }
  return text;
}

report::Section methods_section(const DisplacementStudy& study) {
  report::NewSection section(
      "Derived displacement",
      "The displacement as a test rig derives it from the flows of this pump, against the "
      "geometric displacement of the model. ISO 8426: flow over speed at zero pressure "
      "difference, by a line over the pressure at one speed (here the highest). Toet: slope of the "
      "flow over the speed at each pressure, then its value at zero pressure difference. Wilson: V "
      "of q = V n - k p, all points at once. Zero-pressure line: flow at zero pressure difference "
      "at each speed, then V of q = V n. Bias: derived less geometric, of the geometric. The flow "
      "is read at delivery pressure, as ISO 4409 defines the volumetric efficiency, or in the "
      "low-pressure line. Efficiency: q / (n V); of a motor n V / q.");
  section.fact("geometric displacement", "{:.6g} cm3", study.geometric / kCubicCentimetre);
  section.fact("points", "{} of {} computed", study.meters.at(0).points.size(), study.asked);
  section.columns("method", "flow read", "displacement, cm3", "bias, %", "points above 100 %",
                  "highest efficiency, %", "at speed, rpm", "at delivery, bar");
  for (const MeteredDisplacement& meter : study.meters)
    for (const DerivedDisplacement& derived : meter.derived) {
      const std::string method(name_of(derived.method));
      if (is_computed(derived.volume)) {
        const FlowPoint& highest = meter.points[derived.highest];
        section.row(method, meter.meter, derived.volume / kCubicCentimetre, 100 * derived.bias,
                    derived.above_one, 100 * derived.efficiency[derived.highest],
                    speed_rpm(highest), delivery_bar(highest));
      } else {
        section.row(method, meter.meter);
        section.fact(method + ", " + meter.meter, "not determined: " + derived.reason);
      }
      if (derived.above_one > 0)
        section.fact("above 100 % by " + method + ", " + meter.meter,
                     places_above(meter.points, derived));
    }
  return section;
}

report::Section points_section(const DisplacementStudy& study) {
  const MeteredDisplacement& meter = study.meters.at(0);
  report::NewSection section(
      "Volumetric efficiency by derived displacement",
      "Each point of the test, flow at delivery pressure: the efficiency by the geometric "
      "displacement and by each derived one. A value above 100 % comes from a derived "
      "displacement that is too small, not from the pump.");
  section.columns("speed, rpm", "delivery, bar", "flow, l/min", "geometric, %",
                  report::each_of(meter.derived, [](const DerivedDisplacement& derived) {
                    return std::string(name_of(derived.method)) + ", %";
                  }));
  for (std::size_t i = 0; i < meter.points.size(); ++i) {
    const FlowPoint& point = meter.points[i];
    section.row(speed_rpm(point), delivery_bar(point), point.flow / kLitrePerMinute,
                100 * volumetric_efficiency(study.geometric, point, study.motor),
                report::each_of(meter.derived, [&](const DerivedDisplacement& derived) {
                  return derived.efficiency.empty() ? not_computed() : 100 * derived.efficiency[i];
                }));
  }
  for (const FailedPoint& failed : study.failed)
    section.fact(failed.point + ": not computed", failed.reason);
  return section;
}

// Flow over speed: a line over the pressure difference for each speed.
report::Figure flow_figure(const DisplacementStudy& study) {
  const MeteredDisplacement& meter = study.meters.at(0);
  report::XyFigure figure{
      {"pressure difference", "bar", false, 0.0}, {"flow at delivery pressure / speed", "cm3"}, {}};
  double greatest = 0;
  for (const FlowPoint& point : meter.points) {
    const std::string label = fmt::format("{:.6g} rpm", speed_rpm(point));
    if (figure.series.empty() || figure.series.back().label != label)
      figure.series.push_back({label, {}, {}});
    const double bar = point.difference / kPascalPerBar;
    figure.series.back().add(bar, point.flow / point.speed / kCubicCentimetre);
    greatest = std::max(greatest, bar);
  }
  const double geometric = study.geometric / kCubicCentimetre;
  figure.series.push_back({"geometric displacement", {0, greatest}, {geometric, geometric}, true});
  return {"displacement_flow", "Flow per turn over the pressure difference", "", std::move(figure),
          "The methods extrapolate these points to zero pressure difference."};
}

// Bias of ISO 8426 over the speed of its test, and of the others.
report::Figure bias_figure(const DisplacementStudy& study) {
  report::XyFigure figure{{"speed of the test", "rpm"}, {"bias of the displacement", "%"}, {}};
  for (const MeteredDisplacement& meter : study.meters) {
    report::XySeries series{"ISO 8426 at this speed, flow " + meter.meter, {}, {}};
    for (const auto& [speed, volume] : meter.iso_by_speed)
      series.add(speed / kRpm, 100 * (volume / study.geometric - 1));
    figure.series.push_back(std::move(series));
  }
  const MeteredDisplacement& meter = study.meters.at(0);
  const double from = meter.points.front().speed / kRpm, to = meter.points.back().speed / kRpm;
  for (const DerivedDisplacement& derived : meter.derived)
    if (derived.method != DisplacementMethod::iso_8426 && is_computed(derived.bias))
      figure.series.push_back({std::string(name_of(derived.method)) + ", all speeds",
                               {from, to},
                               {100 * derived.bias, 100 * derived.bias},
                               true});
  return {"displacement_bias", "Bias of the derived displacement", "", std::move(figure),
          "Of the geometric displacement. ISO 8426 derives it at one speed, the others from all; "
          "they are drawn for the flow at delivery pressure."};
}

}  // namespace

std::vector<std::string> displacement_answers(const DisplacementStudy& study) {
  const MeteredDisplacement& first = study.meters.at(0);
  std::vector<std::string> values, above;
  for (const MeteredDisplacement& meter : study.meters)
    for (const DerivedDisplacement& derived : meter.derived) {
      if (!is_computed(derived.volume)) continue;
      if (&meter == &first)
        values.push_back(fmt::format("{} {:.5g} cm3 ({})", name_of(derived.method),
                                     derived.volume / kCubicCentimetre, bias_text(derived)));
      if (derived.above_one > 0)
        above.push_back(fmt::format(
            "by {}{} at {} of {} points (up to {:.2f} % at {})", name_of(derived.method),
            &meter == &first ? "" : ", flow " + meter.meter, derived.above_one, meter.points.size(),
            100 * derived.efficiency[derived.highest], place_of(meter.points[derived.highest])));
    }
  return {fmt::format("Derived displacement, flow {}: {}; the geometric one is {:.5g} cm3.",
                      first.meter, joined(values), study.geometric / kCubicCentimetre),
          above.empty() ? std::string("No method gives a volumetric efficiency above 100 %.")
                        : "The volumetric efficiency exceeds 100 % " + joined(above, "; ") + "."};
}

void add_displacement(report::Document& document, const DisplacementStudy& study) {
  if (document.verdict) report::append(document.verdict->answers, displacement_answers(study));
  report::append(document.runs, methods_section(study));
  report::append(document.runs, points_section(study));
  report::append(document.figures, flow_figure(study));
  report::append(document.figures, bias_figure(study));
  add_warnings(document, study.failed);
}

std::string displacement_text(const DisplacementStudy& study) {
  std::string text =
      fmt::format("{:<20} {:<22} {:>17} {:>8} {:>18} {:>21}\n", "method", "flow read",
                  "displacement, cm3", "bias, %", "points above 100 %", "highest efficiency, %");
  for (const MeteredDisplacement& meter : study.meters)
    for (const DerivedDisplacement& derived : meter.derived)
      text +=
          is_computed(derived.volume)
              ? fmt::format("{:<20} {:<22} {:>17.6g} {:>8} {:>18} {:>21.2f}\n",
                            name_of(derived.method), meter.meter, derived.volume / kCubicCentimetre,
                            fixed_text(100 * derived.bias, 3, true), derived.above_one,
                            100 * derived.efficiency[derived.highest])
              : fmt::format("{:<20} {:<22} not determined: {}\n", name_of(derived.method),
                            meter.meter, derived.reason);
  return text;
}

}  // namespace bentaxis::study
