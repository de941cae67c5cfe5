#include "bentaxis/study/operating_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <initializer_list>

#include "bentaxis/files/csv_rows.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/efficiency.h"
#include "bentaxis/study/reporting.h"

namespace bentaxis::study {
namespace {

constexpr int kMaxThreads = 8;  // every one holds models of its own
// A delivery pressure is printed to 0.1 bar of some hundred.
constexpr double kPressureTolerance = 1e-6;
// The first guess is in proportion and off by a few per cent: the first step to either side of it.
constexpr double kBracketFactor = 1.05;

}  // namespace

void require_pressure_asked_for(const Case& the_case) {
  if (the_case.hydraulics && the_case.hydraulics->load &&
      the_case.hydraulics->load->sets_pressure())
    throw InputError(the_case.file.string() +
                     ": [load] sets the delivery pressure: it cannot be varied");
}

void require_hydraulic(const Case& the_case) {
  if (the_case.pressure.kind != PressureKind::hydraulic)
    throw InputError(the_case.file.string() +
                     ": [pressure] kind must be \"hydraulic\" for this command, "
                     "as in cases/bap63_rated_hydraulic.toml");
}

OperatingPoint run_point(Case the_case, const PartProgress& progress_of) {
  require_hydraulic(the_case);
  OperatingPoint point;
  point.ready = prepare(std::move(the_case), progress_of);
  point.analytic = run_turn(point.ready, Model::analytic, progress_of);
  point.multibody = run_turn(point.ready, Model::multibody, progress_of);
  return point;
}

double mean(const ResultTable& table, const std::string& channel) {
  const std::size_t column = table.find(channel);
  double sum = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) sum += table.at(row, column);
  return sum / static_cast<double>(table.rows());
}

TorqueCurve torque_curve(const Case& the_case, const std::vector<double>& delivery_bar,
                         const Progress& progress) {
  require_pressure_asked_for(the_case);
  const std::size_t count = delivery_bar.size();
  TorqueCurve curve;
  curve.bar = delivery_bar;
  const auto columns = {&curve.bar,  &curve.analytic,   &curve.multibody,       &curve.ideal,
                        &curve.flow, &curve.efficiency, &curve.flow_at_delivery};
  for (auto* values : columns) values->resize(count);
  std::vector<std::string> reasons(count);
  Reporting reporting(count, progress);
  const PartProgress within = [&](const std::string&) { return [&](double) { reporting.tick(); }; };
  numerics::parallel_for(kMaxThreads, count, [&](std::size_t i) {
    reporting.tick();
    Case at = the_case;
    at.pressure.ports.delivery = pascals(delivery_bar[i]);
    try {
      const OperatingPoint point = run_point(std::move(at), within);
      const auto& s = point.state().summary;
      curve.analytic[i] = mean(point.analytic, "Td_z1_Nm");
      curve.multibody[i] = mean(point.multibody, "Td_z1_Nm");
      curve.ideal[i] =
          s.displacement * (pascals(delivery_bar[i]) - the_case.pressure.ports.suction) / (2 * kPi);
      curve.flow[i] = s.flow / kLitrePerMinute;
      curve.flow_at_delivery[i] = flow_at_delivery(point.state()) / kLitrePerMinute;
      curve.efficiency[i] = 100 * s.volumetric_efficiency;
    } catch (const ComputationError& error) {
      reasons[i] = error.what();
    }
    reporting.done();
  });
  curve.failed = without_failed(
      reasons,
      [&](std::size_t i) {
        return FailedPoint{delivery_bar[i], "delivery_bar = " + number_text(delivery_bar[i]), ""};
      },
      [&](std::size_t from, std::size_t to) {
        for (auto* values : columns) (*values)[to] = (*values)[from];
      },
      "no point of the series");
  for (auto* values : columns) values->resize(count - curve.failed.size());
  return curve;
}

std::string to_csv(const TorqueCurve& curve) {
  CsvRows csv(
      "delivery_bar,mean_Td_analytic_Nm,mean_Td_multibody_Nm,ideal_Td_Nm,flow_l_per_min,"
      "volumetric_efficiency_percent,flow_at_delivery_l_per_min,reason");
  const double none = not_computed();
  auto failed = curve.failed.begin();
  for (std::size_t i = 0; i <= curve.bar.size(); ++i) {
    for (; failed != curve.failed.end() && (i == curve.bar.size() || failed->value < curve.bar[i]);
         ++failed)
      csv.row(failed->value, none, none, none, none, none, none, failed->reason);
    if (i < curve.bar.size())
      csv.row(curve.bar[i], curve.analytic[i], curve.multibody[i], curve.ideal[i], curve.flow[i],
              curve.efficiency[i], curve.flow_at_delivery[i], "");
  }
  return std::move(csv).text();
}

std::string torque_curve_text(const TorqueCurve& curve) {
  std::string text = fmt::format("{:>12} {:>20} {:>20} {:>12} {:>12} {:>20} {:>22}\n", "delivery",
                                 "mean Td, analytic", "mean Td, multibody", "ideal Td", "flow",
                                 "flow at delivery", "volumetric efficiency");
  text += fmt::format("{:>12} {:>20} {:>20} {:>12} {:>12} {:>20} {:>22}\n", "bar", "Nm", "Nm", "Nm",
                      "l/min", "pressure, l/min", "%");
  for (std::size_t i = 0; i < curve.bar.size(); ++i)
    text += fmt::format("{:>12.6g} {:>20.6g} {:>20.6g} {:>12.6g} {:>12.6g} {:>20.6g} {:>22.6g}\n",
                        curve.bar[i], curve.analytic[i], curve.multibody[i], curve.ideal[i],
                        curve.flow[i], curve.flow_at_delivery[i], curve.efficiency[i]);
  for (const FailedPoint& failed : curve.failed)
    text += fmt::format("{:>12.6g} not computed: {}\n", failed.value, failed.reason);
  return text;
}

double delivery_pressure_for(const OperatingPoint& start, const std::string& name, double wanted,
                             const std::function<double(const ResultTable&)>& statistic,
                             const PartProgress& progress_of) {
  require_pressure_asked_for(start.the_case());
  const auto excess = [&](double pressure) {
    Case at = start.the_case();
    at.pressure.ports.delivery = pressure;
    return statistic(run_turn(prepare(std::move(at), progress_of), Model::analytic, progress_of)) -
           wanted;
  };
  const double guess =
      start.the_case().pressure.ports.delivery * wanted / statistic(start.analytic);
  const auto close_enough = [](double low, double high) {
    return high - low <= kPressureTolerance * high;
  };
  std::uintmax_t evaluations = 30;
  try {
    if (guess > 0 && std::isfinite(guess)) {
      const auto [low, high] = boost::math::tools::bracket_and_solve_root(
          excess, guess, kBracketFactor, true, close_enough, evaluations);
      if (close_enough(low, high)) return (low + high) / 2;
    }
  } catch (const boost::math::evaluation_error&) {
    // No bracket: said below.
  }
  throw ComputationError("published numbers: no delivery pressure found at which " + name +
                         " reaches " + number_text(wanted));
}

}  // namespace bentaxis::study
