#include "bentaxis/study/tradeoff_study.h"

#include "bentaxis/pump/error.h"

namespace bentaxis::study {
namespace {

constexpr double kCounterpartTransition = 20;  // deg, as in the default pump

struct Variant {
  std::string name;
  Case the_case;
};

std::vector<Variant> variants(const Case& the_case) {
  const bool step =
      the_case.pressure.kind == PressureKind::ideal && the_case.pressure.transition_deg == 0;
  Case other = the_case;
  other.pressure.kind = PressureKind::ideal;
  other.pressure.transition_deg = step ? kCounterpartTransition : 0;
  if (step) return {{"smooth", other}, {"step", the_case}};
  return {{"smooth", the_case}, {"step", other}};
}

}  // namespace

TradeoffStudy run_tradeoff_study(const Case& the_case, TradeoffOptions options,
                                 const Progress& progress) {
  if (the_case.operation.speed_rpm == 0)
    throw InputError(
        the_case.file.string() +
        ": [operation] speed_rpm = 0: tradeoff integrates in time, which needs a speed "
        "other than 0");
  // A few angles per pitch, so that one piston can stand for all where it may.
  if (options.samples_per_revolution == 0)
    options.samples_per_revolution = 8 * the_case.pump.geometry.pistons;
  TradeoffStudy study{the_case, std::move(options), {}};
  const auto both = variants(the_case);
  for (std::size_t v = 0; v < both.size(); ++v)
    study.pressures.push_back(
        {both[v].name,
         measure_tradeoff(both[v].the_case, both[v].name, study.options, [&](double fraction) {
           progress((static_cast<double>(v) + fraction) / static_cast<double>(both.size()));
         })});
  return study;
}

}  // namespace bentaxis::study
