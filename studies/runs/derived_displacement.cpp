#include "bentaxis/study/derived_displacement.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/files/csv_rows.h"
#include "bentaxis/numerics/dense.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/efficiency.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/reporting.h"

namespace bentaxis::study {
namespace {

constexpr int kMaxCircuits = 8;  // every one holds a circuit of its own
constexpr double kSecondsPerMinute = 60;

// Coefficients of the least-squares fit of y by the columns of a matrix.
Eigen::VectorXd fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y,
                    const std::string& needs) {
  const auto refuse = [&] { throw ComputationError("derived displacement: " + needs); };
  if (columns.rows() < columns.cols()) refuse();
  // Columns are scaled to one size, so that the rank does not depend on units.
  const Eigen::VectorXd size = columns.colwise().norm();
  const numerics::LeastSquaresSolver solver(columns *
                                            size.cwiseMax(1e-300).cwiseInverse().asDiagonal());
  if (solver.rank() < columns.cols()) refuse();
  return (solver.solve(y).array() / size.array()).matrix();
}

struct Line {
  double at_zero, slope;
};
Line line_through(const std::vector<double>& x, const std::vector<double>& y,
                  const std::string& needs) {
  const auto count = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd columns(count, 2);
  columns.col(0).setOnes();
  columns.col(1) = Eigen::Map<const Eigen::VectorXd>(x.data(), count);
  const Eigen::VectorXd found =
      fit(columns, Eigen::Map<const Eigen::VectorXd>(y.data(), count), needs);
  return {found[0], found[1]};
}

// Points of one test condition: what is fitted over what.
struct Series {
  std::vector<double> x, y;
  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

const std::string kTwoPressures = "it takes one speed with points at two pressures";
const std::string kTwoSpeeds = "it takes two pressures with points at two speeds each";

// q at p = 0 for every speed at which two pressures are there.
std::map<double, double> flow_without_pressure(const std::vector<FlowPoint>& points) {
  std::map<double, Series> by_speed;
  for (const FlowPoint& point : points) by_speed[point.speed].add(point.difference, point.flow);
  std::map<double, double> flows;
  for (const auto& [speed, series] : by_speed)
    if (series.x.size() > 1) flows[speed] = line_through(series.x, series.y, kTwoPressures).at_zero;
  if (flows.empty()) throw ComputationError("derived displacement: " + kTwoPressures);
  return flows;
}

double toet(const std::vector<FlowPoint>& points) {
  std::map<double, std::vector<const FlowPoint*>> by_pressure;
  for (const FlowPoint& point : points) by_pressure[point.delivery].push_back(&point);
  Series slopes;
  for (const auto& [delivery, at] : by_pressure) {
    if (at.size() < 2) continue;
    Series series;
    double difference = 0;
    for (const FlowPoint* point : at) {
      series.add(point->speed, point->flow);
      difference += point->difference / static_cast<double>(at.size());
    }
    slopes.add(difference, line_through(series.x, series.y, kTwoSpeeds).slope);
  }
  return line_through(slopes.x, slopes.y, kTwoSpeeds).at_zero;
}

double wilson(const std::vector<FlowPoint>& points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd columns(count, 2);
  Eigen::VectorXd flow(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FlowPoint& point = points[static_cast<std::size_t>(i)];
    columns.row(i) << point.speed, -point.difference;
    flow[i] = point.flow;
  }
  return fit(columns, flow, kTwoPressures)[0];
}

double zero_pressure_line(const std::vector<FlowPoint>& points) {
  double across = 0, along = 0;
  for (const auto& [speed, flow] : flow_without_pressure(points)) {
    across += speed * flow;
    along += speed * speed;
  }
  return across / along;
}

DerivedDisplacement derived_by(DisplacementMethod method, const std::vector<FlowPoint>& points,
                               double geometric, bool motor) {
  DerivedDisplacement derived{method, not_computed(), "", not_computed(), {}};
  derived.reason = reason_of([&] { derived.volume = derived_displacement(method, points); });
  if (!is_computed(derived.volume)) return derived;
  derived.bias = derived.volume / geometric - 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    derived.efficiency.push_back(volumetric_efficiency(derived.volume, points[i], motor));
    if (derived.efficiency[i] > 1 + kFlowRounding) ++derived.above_one;
    if (derived.efficiency[i] > derived.efficiency[derived.highest]) derived.highest = i;
  }
  return derived;
}

MeteredDisplacement metered(const std::string& meter, std::vector<FlowPoint> points,
                            double geometric, bool motor) {
  MeteredDisplacement found{meter, std::move(points), {}, {}};
  for (const DisplacementMethod method : kDisplacementMethods)
    found.derived.push_back(derived_by(method, found.points, geometric, motor));
  for (const auto& [speed, flow] : flow_without_pressure(found.points))
    found.iso_by_speed.emplace_back(speed, flow / speed);
  return found;
}

// 12 digits of a number.
double without_round_off(double value) {
  return number_in(fmt::format("{:.12g}", value)).value_or(value);
}

std::vector<double> steps(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  return values;
}

}  // namespace

double speed_rpm(const FlowPoint& point) {
  return without_round_off(point.speed * kSecondsPerMinute);
}
double delivery_bar(const FlowPoint& point) {
  return without_round_off(point.delivery / kPascalPerBar);
}

const char* name_of(DisplacementMethod method) {
  switch (method) {
    case DisplacementMethod::iso_8426:
      return "ISO 8426";
    case DisplacementMethod::toet:
      return "Toet";
    case DisplacementMethod::wilson:
      return "Wilson";
    case DisplacementMethod::zero_pressure_line:
      return "zero-pressure line";
  }
  return "";
}

double volumetric_efficiency(double volume, const FlowPoint& point, bool motor) {
  const double share = point.flow / (point.speed * volume);
  if (!motor) return share;
  return share > 0 ? 1 / share : not_computed();
}

double derived_displacement(DisplacementMethod method, const std::vector<FlowPoint>& points) {
  if (points.empty()) throw ComputationError("derived displacement: " + kTwoPressures);
  switch (method) {
    case DisplacementMethod::iso_8426: {
      const auto flows = flow_without_pressure(points);
      return flows.rbegin()->second / flows.rbegin()->first;
    }
    case DisplacementMethod::toet:
      return toet(points);
    case DisplacementMethod::wilson:
      return wilson(points);
    case DisplacementMethod::zero_pressure_line:
      break;
  }
  return zero_pressure_line(points);
}

std::vector<double> usual_test_speeds(const Case& the_case) {
  const double speed = std::abs(the_case.operation.speed_rpm);
  return steps(0.2 * speed, speed, 5);
}

std::vector<double> usual_test_pressures(const Case& the_case) {
  const PortPressures& ports = the_case.pressure.ports;
  const double difference = ports.delivery - ports.suction;
  std::vector<double> pressures;
  for (const double share : {0.05, 0.2, 0.4, 0.6, 0.8, 1.0})
    pressures.push_back((ports.suction + share * difference) / kPascalPerBar);
  return pressures;
}

DisplacementStudy displacement_study(const Case& the_case, const std::vector<double>& speeds_rpm,
                                     const std::vector<double>& delivery_bar,
                                     const Progress& progress) {
  require_hydraulic(the_case);
  require_pressure_asked_for(the_case);
  if (delivery_bar.size() < 2)
    throw InputError("derived displacement: there must be two delivery pressures at least");
  DisplacementStudy study;
  study.motor = the_case.operation.speed_rpm < 0;
  const double sign = study.motor ? -1 : 1;
  study.geometric = analytic::derived_quantities(the_case.pump).displacement;
  study.asked = speeds_rpm.size() * delivery_bar.size();
  std::vector<std::string> reasons(study.asked);
  std::vector<FlowPoint> at_suction(study.asked), at_delivery(study.asked);
  const auto speed_of = [&](std::size_t i) { return sign * speeds_rpm[i / delivery_bar.size()]; };
  const auto bar_of = [&](std::size_t i) { return delivery_bar[i % delivery_bar.size()]; };

  Reporting reporting(study.asked, progress);
  const PartProgress within = [&](const std::string&) { return [&](double) { reporting.tick(); }; };
  numerics::parallel_for(kMaxCircuits, study.asked, [&](std::size_t i) {
    reporting.tick();
    Case at = the_case;
    at.operation.speed_rpm = speed_of(i);
    at.pressure.ports.delivery = pascals(bar_of(i));
    reasons[i] = reason_of([&] {
      const PreparedCase ready = prepare(std::move(at), within);
      const hydraulics::SteadyState& state = *ready.hydraulics;
      at_suction[i] = {sign * speed_of(i) / kSecondsPerMinute, pascals(bar_of(i)),
                       pressure_difference(ready), sign * state.summary.flow};
      at_delivery[i] = at_suction[i];
      at_delivery[i].flow = sign * flow_at_delivery(state);
    });
    reporting.done();
  });
  study.failed = without_failed(
      reasons,
      [&](std::size_t i) {
        return FailedPoint{bar_of(i),
                           "speed_rpm = " + number_text(speed_of(i)) +
                               ", delivery_bar = " + number_text(bar_of(i)),
                           ""};
      },
      [&](std::size_t from, std::size_t to) {
        at_suction[to] = at_suction[from];
        at_delivery[to] = at_delivery[from];
      },
      "no point of the test");
  at_suction.resize(study.asked - study.failed.size());
  at_delivery.resize(at_suction.size());
  study.meters = {metered("at delivery pressure", at_delivery, study.geometric, study.motor),
                  metered("at suction pressure", at_suction, study.geometric, study.motor)};
  return study;
}

std::string to_csv(const DisplacementStudy& study) {
  const MeteredDisplacement& at_delivery = study.meters.at(0);
  CsvRows csv(
      "speed_rpm,delivery_bar,pressure_difference_bar,flow_at_delivery_l_per_min,flow_l_per_min,"
      "efficiency_geometric_percent,efficiency_iso_8426_percent,efficiency_toet_percent,"
      "efficiency_wilson_percent,efficiency_zero_pressure_line_percent,reason");
  for (std::size_t i = 0; i < at_delivery.points.size(); ++i) {
    const FlowPoint& point = at_delivery.points[i];
    std::vector<double> efficiency;
    for (const DerivedDisplacement& derived : at_delivery.derived)
      efficiency.push_back(derived.efficiency.empty() ? not_computed()
                                                      : 100 * derived.efficiency[i]);
    csv.row(speed_rpm(point), delivery_bar(point), point.difference / kPascalPerBar,
            point.flow / kLitrePerMinute, study.meters.at(1).points[i].flow / kLitrePerMinute,
            100 * volumetric_efficiency(study.geometric, point, study.motor), efficiency, "");
  }
  for (const FailedPoint& failed : study.failed)
    csv.row(std::vector<double>(10, not_computed()), failed.point + ": " + failed.reason);
  return std::move(csv).text();
}

}  // namespace bentaxis::study
