// What is read off a periodic state, and what starts from it.
#include "steady_state_results.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <complex>

#include "bentaxis/pump/units.h"
#include "integrator.h"
#include "network.h"
#include "period_map.h"
#include "turn.h"

namespace bentaxis::hydraulics {
namespace {

// Sums f(angle, weight) over a turn, weights in degrees: Gauss points of each piece of the curve,
// cut to a degree at most.
template <typename F>
void over_pieces(const ComputedPressure& curve, const F& f) {
  using Rule = boost::math::quadrature::gauss<double, 5>;
  const auto& pieces = curve.log_pressure.pieces();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double from = pieces[i].from_deg;
    const double way = (i + 1 < pieces.size() ? pieces[i + 1].from_deg : 360) - from;
    const int cuts = static_cast<int>(std::ceil(way));
    const double half = way / cuts / 2;
    for (int cut = 0; cut < cuts; ++cut) {
      const double middle = from + (2 * cut + 1) * half;
      for (std::size_t j = 0; j < Rule::abscissa().size(); ++j) {
        const double off = Rule::abscissa()[j] * half, weight = Rule::weights()[j] * half;
        f(middle + off, weight);
        if (off != 0) f(middle - off, weight);
      }
    }
  }
}

}  // namespace

double indicated_work(const Chamber& chamber, const ComputedPressure& curve) {
  double work = 0;
  over_pieces(curve, [&](double angle, double weight) {
    work -= weight * kRadPerDegree * curve.gauge(angle) * chamber.volume(radians(angle)).slope;
  });
  return work;
}

double largest_of_spline(const PressureCurve& points, const ComputedPressure& curve) {
  const PeriodicSpline spline(points.theta_deg, points.pressure);
  const auto& pieces = curve.log_pressure.pieces();
  double worst = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double to = i + 1 < pieces.size() ? pieces[i + 1].from_deg : 360;
    for (const double angle : {pieces[i].from_deg, (pieces[i].from_deg + to) / 2})
      worst = std::max(worst, std::abs(spline(angle) - curve.gauge(angle)));
  }
  return worst;
}

double pressure_error(const SteadyState& state) {
  return state.computed ? state.computed->error / state.computed->peak : not_computed();
}

bool is_accurate(const Case& the_case, const SteadyState& state) {
  return !(pressure_error(state) > the_case.hydraulics->curve_error);
}

ResultTable transient_from_rest(const Case& the_case, double load_size, int revolutions,
                                int samples, const Progress& progress) {
  const Network network(the_case);
  Integrator integrator(network);
  const PeriodMap map(network, Sizing::mean_pressure, integrator);
  const int n = network.pistons();
  std::vector<double> y = network.uniform(network.suction_log_pressure(), 0, 0);
  ResultTable table;
  table.name = "transient";
  table.channels = pressure_channels();
  const Fluid& fluid = network.fluid();
  int chamber = 0;  // which of the relabelled chambers is chamber 1
  const long long periods = static_cast<long long>(revolutions) * n;
  for (long long period = 0; period < periods; ++period) {
    int next = 0;
    y = map.relabelled(integrator.over_period(
        y, load_size, the_case.hydraulics->tolerance, nullptr, nullptr,
        [&](const Integrator::Step& step) {
          for (; next < samples; ++next) {
            const double x = network.period_deg() * next / samples;
            if (x > step.to) break;
            const double* state = step.state(x);
            table.theta_deg.push_back((network.backwards() ? -1 : 1) *
                                      (static_cast<double>(period) * network.period_deg() + x));
            table.values.push_back(fluid.gauge(state[chamber]) / kPascalPerBar);
            table.values.push_back(network.delivery_gauge(state) / kPascalPerBar);
          }
        }));
    chamber = network.next_of(chamber);
    if (progress) progress(static_cast<double>(period + 1) / static_cast<double>(periods));
  }
  return table;
}

std::vector<double> orders_of_rate(const ComputedPressure& chamber, int count) {
  std::vector<std::complex<double>> sums(count);
  over_pieces(chamber, [&](double angle, double weight) {
    const double value = weight * chamber.gauge(angle) / 180;
    for (int i = 0; i < count; ++i) sums[i] += std::polar(value, -radians((i + 1) * angle));
  });
  std::vector<double> amplitudes(count);
  for (int i = 0; i < count; ++i) amplitudes[i] = (i + 1) * std::abs(sums[i]);
  return amplitudes;
}

PowerBudget power_by_place(const SteadyState& state, const Progress& progress) {
  const Network& network = *state.equations;
  Integrator integrator(network, [&] {
    if (progress) progress(0.5);
  });
  PowerBudget energy;
  integrator.over_period(state.corrected_states, state.corrected_load_size,
                         state.convergence.tolerance, nullptr, nullptr, {}, &energy);
  for (int i = 0; i < kPlaces; ++i)
    energy[static_cast<Place>(i)] /= network.period_deg() * network.seconds_per_degree();
  if (progress) progress(1);
  return energy;
}

double density(const SteadyState& state, double gauge) {
  return state.equations->fluid().density(gauge);
}

double effective_bulk_modulus(const SteadyState& state, double gauge) {
  return state.equations->fluid().effective_bulk_modulus(gauge);
}

void give_to(Case& the_case, const SteadyState& state) {
  the_case.pressure.computed = state.computed;
  if (the_case.pressure.points > 0) the_case.pressure.curve = state.chamber;
  const auto& load = the_case.hydraulics->load;
  if (load && load->sets_pressure() && the_case.pressure.ports.delivery > 0)
    the_case.pressure.ports.delivery = state.summary.delivery_mean;
}

namespace {

Line line_of_load(const Summary& s) {
  switch (s.load) {
    case LoadKind::laminar:
      return {"load, laminar conductance", s.load_size * kPascalPerBar / kLitrePerMinute,
              "l/min/bar", "load_l_per_min_per_bar"};
    case LoadKind::relief_valve:
      return {"load, relief valve's cracking pressure",
              (s.load_size - s.atmosphere) / kPascalPerBar, "bar", "load_cracking_bar"};
    case LoadKind::constant_pressure:
      return {"load, constant pressure", s.delivery_mean / kPascalPerBar, "bar", "load_bar"};
    case LoadKind::flow:
      return {"load, given flow", s.flow / kLitrePerMinute, "l/min", "load_l_per_min"};
    case LoadKind::orifice:
      break;
  }
  return {"load orifice", s.load_size * 1e6, "mm2", "load_mm2"};
}

Line load_line(const Summary& s) {
  Line line = line_of_load(s);
  const bool has_size = s.load != LoadKind::constant_pressure && s.load != LoadKind::flow;
  if (has_size && !(s.load_size > 0)) {
    line.name = "load: none, the line is open";
    line.value = not_computed();
  }
  return line;
}

}  // namespace

std::vector<Line> lines(const SteadyState& state) {
  const Summary& s = state.summary;
  const double bar = kPascalPerBar;
  return {
      {"displacement", s.displacement * 1e6, "cm3/rev", "displacement_cm3", true},
      {"density of all volume flows, that in the suction port", s.density, "kg/m3",
       "density_kg_per_m3", true},
      {"ideal flow, displacement x speed", s.ideal_flow / kLitrePerMinute, "l/min",
       "ideal_flow_l_per_min", true},
      {"mean flow to the load", s.flow / kLitrePerMinute, "l/min", "flow_l_per_min", true},
      {"mean mass flow to the load", s.mass_flow, "kg/s", "mass_flow_kg_per_s", true},
      {s.motors() ? "volumetric efficiency as a motor, ideal flow over the flow taken"
                  : "volumetric efficiency, mean flow to the load over ideal flow",
       100 * s.volumetric_efficiency, "%", "volumetric_efficiency_percent", true},
      {"leakage", s.leakage / kLitrePerMinute, "l/min", "leakage_l_per_min", true},
      {"mean delivery pressure", s.delivery_mean / bar, "bar", "delivery_mean_bar", true},
      {"delivery pressure, minimum", s.delivery_least / bar, "bar", "delivery_least_bar"},
      {"delivery pressure, maximum", s.delivery_greatest / bar, "bar", "delivery_greatest_bar"},
      {"delivery pressure ripple, peak to peak", (s.delivery_greatest - s.delivery_least) / bar,
       "bar", "delivery_ripple_bar"},
      {"ripple of the flow to the load, peak to peak", 100 * s.flow_ripple, "% of mean",
       "flow_ripple_percent"},
      {"ripple of the flow through the delivery port, peak to peak", 100 * s.port_flow_ripple,
       "% of mean", "port_flow_ripple_percent"},
      {"chamber pressure, maximum", s.chamber_greatest / bar, "bar", "chamber_greatest_bar"},
      {"angle of the maximum", s.chamber_greatest_deg, "deg", "chamber_greatest_deg"},
      {"overshoot over mean delivery pressure", s.overshoot / bar, "bar", "overshoot_bar"},
      {"chamber pressure, minimum", s.chamber_least / bar, "bar", "chamber_least_bar"},
      {"angle of the minimum", s.chamber_least_deg, "deg", "chamber_least_deg"},
      {"undershoot under suction pressure", s.undershoot / bar, "bar", "undershoot_bar"},
      {"work of the pistons per turn", s.work, "J", "work_J", true},
      {"mean torque of that work", s.work / (2 * kPi), "Nm", "work_torque_Nm", true},
      {"mass in minus mass out, over mass in", (s.mass_in - s.mass_out) / s.mass_in, "",
       "mass_balance"},
      load_line(s),
      {"both ports open to a chamber (negative overlap)", s.both_open_deg, "deg per turn",
       "both_open_deg"},
      {"both ports closed (positive overlap)", s.both_closed_deg, "deg per turn",
       "both_closed_deg"},
      {"filling at the end of suction, mass in the chamber over that of oil at suction pressure",
       state.timing.filled ? 100 * state.timing.filled->ratio : not_computed(), "%",
       "filling_percent"},
      {"loss of volumetric efficiency by incomplete filling",
       state.timing.filled ? 100 * state.timing.filled->loss : not_computed(), "%",
       "filling_loss_percent"},
      {"chamber below saturation pressure: air comes out", s.below_saturation_deg, "deg per turn",
       "below_saturation_deg"},
      {"chamber below vapour pressure: oil boils", s.below_vapour_deg, "deg per turn",
       "below_vapour_deg"},
      {"estimated error of the chamber pressure, of its peak", pressure_error(state), "",
       "pressure_error"},
  };
}

}  // namespace bentaxis::hydraulics
