// What one turn of the analytic model shows of the film and of the loaded flank.
#include <fmt/format.h>

#include <cmath>

#include "bentaxis/analytic/validity.h"
#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

constexpr double kShareOfTurn = 0.05;   // a limit violated for less is an edge of the pressure
constexpr double kOutsideShare = 0.25;  // likewise of the film force's point, when ports open

// What numbers of the turn rest on, where it is not what a run will find.
const char* by_ideal_pressure(const Facts& f) {
  return f.turn->ideal_pressure ? "with an ideal pressure trace " : "";
}

// A limit of validity that is violated for more than a share of the turn.
const analytic::ValidityLimit* violated(const Facts& f, const char* name, double share) {
  const analytic::ValidityLimit* const limit = f.limit(name);
  return limit == nullptr || limit->violated_share <= share ? nullptr : limit;
}

// Push of the lands over bottom areas and spring; not computed where these do not press.
double block_balance(const Turn& turn) {
  return turn.press_force > 0 ? turn.land_force / turn.press_force : not_computed();
}

std::string block_balance_text(const Turn& turn) {
  const double balance = block_balance(turn);
  return is_computed(balance)
             ? fmt::format("{:.3g}", balance)
             : fmt::format("not defined, as bottom areas and spring do not press ({:.4g} N)",
                           turn.press_force);
}

}  // namespace

std::vector<Check> film_and_flank() {
  return {
      {"block-lifts-off",
       "the film would have to pull the block onto the plate (Fh > 0) in more than 5 % of the turn",
       [](const Facts& f) -> std::string {
         const auto* limit = violated(f, "Fh reversed", kShareOfTurn);
         if (limit == nullptr) return "";
         return fmt::format(
             "{}the block lifts off its plate in {:.3g} % of the turn, worst {:.4g} N at {:.4g} "
             "deg: "
             "block balance (push of the lands over bottom areas and spring) is {} (lands {:.4g} "
             "N, bottom_area_mm2 = {:.6g} and spring_force_N = {:.6g} make {:.4g} N)",
             by_ideal_pressure(f), 100 * limit->violated_share, limit->worst, limit->theta_deg,
             block_balance_text(*f.turn), f.turn->land_force, mm2(f.pump.block.bottom_area),
             f.pump.block.spring_force, f.turn->press_force);
       }},
      {"block-overpressed",
       "block balance below 0.3 at more than 100 bar: the film would have to carry the rest",
       [](const Facts& f) {
         return f.pump.port_plate && f.turn && f.ports.delivery >= kLightLoad &&
                block_balance(*f.turn) < 0.3;
       },
       [](const Facts& f) {
         return fmt::format(
             "block balance is {:.3g}, below 0.3: the lands push {:.4g} N, bottom_area_mm2 = "
             "{:.6g} "
             "and spring_force_N = {:.6g} {:.4g} N; the film would have to carry the rest",
             block_balance(*f.turn), f.turn->land_force, mm2(f.pump.block.bottom_area),
             f.pump.block.spring_force, f.turn->press_force);
       }},
      {"film-force-outside",
       "the film force would act outside r4 in more than 25 % of the turn: the block tips",
       [](const Facts& f) -> std::string {
         const auto* limit = violated(f, "(xh, yh) outside r4", kOutsideShare);
         if (limit == nullptr) return "";
         return fmt::format(
             "{}the film force acts outside of the plate (r4 = {:.4g} mm) in {:.3g} % of the turn, "
             "up "
             "to {:.4g} mm from its axis at {:.4g} deg: the block tips; block balance is {}",
             by_ideal_pressure(f), mm(f.pump.port_plate->r4), 100 * limit->violated_share,
             limit->worst, limit->theta_deg, block_balance_text(*f.turn));
       }},
      {"tooth-force-flank",
       "one flank, and Rcs < 0 in more than 5 % of the turn, but at standstill: the other flank "
       "would be loaded",
       [](const Facts& f) { return f.speed != 0 && f.pump.gear.flanks != Flanks::two; },
       [](const Facts& f) -> std::string {
         const auto* limit = violated(f, "Rcs < 0", kShareOfTurn);
         if (limit == nullptr) return "";
         return fmt::format(
             "{}the tooth force is on the other flank in {:.3g} % of the turn, worst {:.4g} N at "
             "{:.4g} deg: the block leads the shaft (block_viscous_Nm_per_rpm = {:.4g} holds it "
             "back)",
             by_ideal_pressure(f), 100 * limit->violated_share, limit->worst, limit->theta_deg,
             f.pump.friction.block_viscous * kRadPerSecondPerRpm);
       }},
  };
}

}  // namespace bentaxis::study::checks
