#include "bentaxis/study/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <memory>

#include "bentaxis/analytic/model.h"
#include "bentaxis/files/stored_values.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/column_values.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/efficiency.h"
#include "bentaxis/study/engine_comparison.h"
#include "bentaxis/study/published_section.h"
#include "bentaxis/study/rounding_spread.h"
#include "bentaxis/study/timing.h"
#include "bentaxis/study/turn_summary.h"

namespace bentaxis::study {
namespace {

double largest_of(const compare::Comparison& comparison,
                  std::initializer_list<std::string> groups) {
  const auto* const found =
      comparison.furthest([&](const Channel& channel) { return contains(groups, channel.group); });
  return found == nullptr ? 0 : found->largest_over_peak();
}

// Components whose vector, or the loads, are so much larger that a difference of much of themselves
// would pass: the smallest of each quantity and axis.
std::string small_components(const compare::Comparison& comparison) {
  std::map<std::string, const compare::ChannelComparison*> smallest;
  for (const auto& c : comparison.channels) {
    if (!c.is_small_component()) continue;
    auto& least = smallest[c.channel.quantity + "_" + c.channel.axis];
    if (least == nullptr || c.own_peak / c.peak < least->own_peak / least->peak) least = &c;
  }
  std::string text = joined(smallest, ", ", [](const auto& one) {
    return fmt::format("{} ({:.1e} of itself)", one.first,
                       one.second->allowed / one.second->own_peak);
  });
  if (text.empty()) return text;
  return fmt::format(
      "below {:g} of the peak of their vector, to which differences are relative, so that errors "
      "up to these shares are not noticed: {}",
      compare::kSmallComponent, text);
}

// Why a channel is not compared.
std::string why_not_compared(const compare::ChannelComparison& c, const ComparisonResult& r) {
  using compare::Comparable;
  if (!c.judged) return "is an input, given to both models";
  if (c.missing == Comparable::first_missing) return "is not computed by the analytic model";
  if (c.missing == Comparable::second_missing) return "is not computed by the multibody model";
  const auto imposed = [](const Assumptions& a) { return a.gear == BlockDrive::imposed; };
  if (c.channel.quantity == "Rcs" && imposed(r.first.the_case.analytic) &&
      imposed(r.second.the_case.multibody))
    return "is computed by neither model: the speed of the block is imposed";
  if (c.channel.group == "xh_yh") return "does not exist: the film force is 0 at every angle";
  return "is computed by neither model for this pump and motion";
}

// Where both models lack all that was asked for, that is no agreement and no difference.
void require_something_compared(const ComparisonResult& r) {
  if (r.comparison.compared() > 0 || r.comparison.incomplete() != nullptr) return;
  std::vector<std::string> reasons;
  for (const auto& c : r.comparison.channels)
    add_once(reasons, c.channel.quantity + " " + why_not_compared(c, r));
  throw InputError("--channels " + r.options.channels.text() +
                   ": nothing was compared: " + joined(reasons, "; "));
}

// A table's values in the columns of another: not computed where it has none of that name.
ResultTable in_columns_of(const ResultTable& columns, const ResultTable& table) {
  ResultTable same{columns.name, columns.channels, columns.theta_deg, {}, columns.provenance};
  same.values.resize(same.rows() * same.columns());
  for (std::size_t c = 0; c < same.columns(); ++c) {
    const std::size_t from = table.find(same.channels[c].name);
    for (std::size_t row = 0; row < same.rows(); ++row)
      same.values[row * same.columns() + c] =
          from < table.columns() ? table.at(row, from) : not_computed();
  }
  return same;
}

// Rows from which on time and memory are worth saving.
constexpr std::size_t kManyRows = 10'000;

// The comparison while it is made.
class Maker {
 public:
  Maker(PreparedCase first, PreparedCase second, bool other_pump, const ComparisonOptions& options,
        const PartProgress& progress_of)
      : progress_of_(progress_of),
        samples_(first.samples(options.way)),
        multibody_samples_(second.samples(options.way)),
        zero_scales_(zero_scales(first.the_case, samples_)) {
    result_.first = std::move(first);
    result_.second = std::move(second);
    result_.options = options;
    if (other_pump) result_.other.emplace();
  }

  ComparisonResult make() {
    ComparisonResult& r = result_;
    run_all();
    compare_tables();
    split_assumptions();
    r.published = published_section(
        r.options.published, {&r.first.the_case, r.first.the_case.analytic, &r.analytic},
        {&r.second.the_case, r.second.the_case.multibody, &r.multibody}, progress_of_);
    r.limits =
        analytic::check_validity(r.first.the_case, r.first.the_case.analytic, samples_, r.analytic);
    if (r.other)
      r.other = {analytic::check_validity(r.second.the_case, r.second.the_case.multibody,
                                          multibody_samples_, r.multibody),
                 plausibility(r.second.the_case)};
    warn();
    if (!r.options.with.empty()) hold_to_reference();
    if (r.options.engines)
      r.engines = std::make_shared<EngineComparison>(r.options.engines->calls->compare(
          r.first, *r.options.engines, r.analytic, &r.multibody, r.tolerance, progress_of_));
    return std::move(result_);
  }

 private:
  bool integrated() const { return result_.options.way == Way::integrated; }
  bool has_teeth() const {
    return result_.first.the_case.pump.gear.contact == ToothContact::teeth && !integrated() &&
           result_.options.scene.scene == multibody::Scene::full &&
           result_.first.the_case.analytic.gear == BlockDrive::mesh &&
           result_.second.the_case.multibody.gear == BlockDrive::mesh;
  }
  // Of another run they would be those beside its reactions, which no report shows.
  bool has_loads() const {
    return result_.options.loads && !integrated() &&
           result_.options.scene.scene == multibody::Scene::full;
  }
  bool has_budget() const {
    const ChannelLayout layout(result_.first.the_case.pump);
    return !integrated() && result_.options.scene.scene == multibody::Scene::full &&
           result_.options.channels.wants(layout.channels()[layout.Td()]);
  }

  RunOptions multibody_run(double accuracy) const {
    return {.model = Model::multibody,
            .way = result_.options.way,
            .scene = result_.options.scene,
            .integration = {result_.options.integration.integrator, accuracy}};
  }

  void store(ModelRun& run) const;
  void run_models();
  void integrate_all();
  double torque_driven_speed_error(const multibody::IntegrationOptions& integration) const;
  compare::Options comparison_options() const;
  void note_film_point_errors();
  bool may_be_missing(const Channel& channel, std::size_t row) const;
  void compare_tables();
  void split_assumptions();
  void run_without_viscous(const PartProgress& progress_of);
  void run_all();
  void hold_to_reference();
  void note_multiplier_errors();
  void warn_of(Model model, const std::vector<analytic::ValidityLimit>& limits);
  void warn();

  ComparisonResult result_;
  const PartProgress& progress_of_;
  Samples samples_, multibody_samples_;
  compare::ZeroScales zero_scales_;
  ResultTable film_point_errors_;
  std::optional<ResultTable> analytic_budget_, multibody_budget_;
};

// Of many rows not both models' values are held in the memory.
void Maker::store(ModelRun& run) const {
  const std::filesystem::path& folder = result_.options.scratch;
  if (folder.empty() || run.table.rows() < kManyRows) return;
  store_values(run.table, folder);
  if (run.budget) store_values(*run.budget, folder);
}

void Maker::run_models() {
  ComparisonResult& r = result_;
  ComparisonOptions& o = r.options;
  if (o.target && !integrated())
    throw InputError("only an integrated run of the multibody model has an error to choose");
  if (o.target) {
    RunOptions to_error = multibody_run(0);
    to_error.target = o.target;
    const ModelRun run = study::run(r.second, multibody_samples_, to_error, progress_of_);
    r.choice = run.choice;
    o.integration = run.integration;
    o.accuracies = {run.integration.accuracy};
  }
  r.tolerance = o.tolerance    ? *o.tolerance
                : o.target     ? o.target->error
                : integrated() ? kIntegratedFactor * o.accuracies.back()
                               : kDrivenTolerance;
  const auto with_all = [&](RunOptions options) {
    options.budget = has_budget();
    options.teeth = has_teeth();
    options.loads = has_loads();
    return options;
  };
  ModelRun analytic = study::run(r.first, samples_, with_all({}), progress_of_);
  store(analytic);
  r.analytic = std::move(analytic.table);
  r.analytic_loads = std::move(analytic.loads);
  analytic_budget_ = std::move(analytic.budget);
  note_film_point_errors();
  if (integrated()) {
    integrate_all();
    return;
  }
  ModelRun multibody =
      study::run(r.second, multibody_samples_, with_all(multibody_run(0)), progress_of_);
  store(multibody);
  r.multibody = std::move(multibody.table);
  r.multibody_loads = std::move(multibody.loads);
  multibody_budget_ = std::move(multibody.budget);
  if (analytic.teeth)
    r.teeth = compare_teeth(std::move(*analytic.teeth), std::move(*multibody.teeth), r.tolerance,
                            zero_scales_, r.first.the_case.pump);
}

// Integrated runs at every accuracy asked for. The last one's table is the one compared.
void Maker::integrate_all() {
  ComparisonResult& r = result_;
  for (const double accuracy : r.options.accuracies) {
    const RunOptions options = multibody_run(accuracy);
    ModelRun run = study::run(r.second, multibody_samples_, options, progress_of_);
    r.multibody = std::move(run.table);
    const auto comparison = compare::compare_tables(r.analytic, r.multibody, comparison_options());
    const auto worst = [&](std::initializer_list<std::string> groups) {
      return largest_of(comparison, groups);
    };
    r.integrations.push_back({accuracy, worst({"Rs"}), worst({"Rc"}), worst({"Rb1", "Rb2"}),
                              worst({"Rcs"}), worst({"Td"}), std::move(*run.record),
                              torque_driven_speed_error(options.integration)});
  }
}

// The shaft free under the analytic torque: how far its speed strays from omega.
double Maker::torque_driven_speed_error(const multibody::IntegrationOptions& integration) const {
  const ComparisonResult& r = result_;
  const analytic::Model model(r.first.the_case.pump, r.second.the_case.multibody);
  std::vector<double> values(model.layout().size());
  Instant instant;
  instant.ports = samples_.ports;
  instant.chamber_pressure.resize(samples_.pistons);
  const auto torque = [&](double theta_deg) {
    instant.turn(radians(std::fmod(theta_deg, 360.0)), samples_.omega);
    for (int k = 1; k <= samples_.pistons; ++k)
      instant.chamber_pressure[k - 1] =
          r.first.pressure(piston_angle_deg(theta_deg, k, samples_.pistons));
    model.place_at_constant_speed(instant, r.first.pressure);
    model.reactions(instant, values);
    return values[model.layout().Td()];
  };
  return multibody::run_torque_driven(r.second.the_case, r.second.the_case.multibody,
                                      multibody_samples_, r.second.pressure, torque, integration,
                                      progress_of_("torque-driven"))
      .whole.speed_error;
}

// The point of the film force is Th over Fh (53): where Fh passes 0 it is known as well as what is
// allowed of these two leaves it.
void Maker::note_film_point_errors() {
  const ComparisonResult& r = result_;
  const ChannelLayout layout(r.first.the_case.pump);
  const std::vector<Channel>& channels = layout.channels();
  const auto allowed = [&](std::size_t column) {
    return r.tolerance * compare::scale_of(r.analytic, channels[column], zero_scales_);
  };
  const double of_force = allowed(layout.Fh()), of_moment = allowed(layout.Th(0));
  constexpr double kMillimetre = 1e-3;
  constexpr double kAnyPoint = 1e300;  // mm
  film_point_errors_ = select_channels(r.analytic, [](const Channel& channel) {
    return channel.quantity == "xh" || channel.quantity == "yh";
  });
  for (std::size_t row = 0; row < r.analytic.rows(); ++row) {
    const double force = std::abs(r.analytic.at(row, layout.Fh()));
    const bool has_point = is_computed(force) && force != 0;
    // A force within its own error has no point of application that could be compared.
    const double least = force - of_force;
    for (std::size_t column = 0; column < film_point_errors_.columns(); ++column) {
      double& value = film_point_errors_.values[row * film_point_errors_.columns() + column];
      const double at = std::abs(value);
      if (!has_point || !is_computed(at))
        value = 0;
      else
        value = least > 0 ? (of_moment / kMillimetre + at * of_force) / least : kAnyPoint;
    }
  }
}

compare::Options Maker::comparison_options() const {
  const int n = result_.first.the_case.pump.geometry.pistons;
  compare::Options options;
  options.tolerance = result_.tolerance;
  options.orders = {n, 2 * n};
  options.zero_scales = zero_scales_;
  if (film_point_errors_.rows() > 0) options.uncertainty = &film_point_errors_;
  options.may_be_missing = [this](const Channel& channel, std::size_t row) {
    return may_be_missing(channel, row);
  };
  return options;
}

// What a run is known not to compute: what its scene or an imposed gear leaves out, and the point
// of the film force where there is none (53).
bool Maker::may_be_missing(const Channel& channel, std::size_t row) const {
  const ComparisonResult& r = result_;
  const auto has = [&](const PreparedCase& ready) {
    const auto& all = ChannelLayout(ready.the_case.pump).channels();
    return std::any_of(all.begin(), all.end(),
                       [&](const Channel& c) { return c.of_pump && c.name == channel.name; });
  };
  if (!has(r.first) || !has(r.second) || !computes({}, r.first.the_case.analytic, channel) ||
      !computes(multibody_run(0), r.second.the_case.multibody, channel))
    return true;
  if (channel.quantity != "xh" && channel.quantity != "yh") return false;
  const std::size_t fh = ChannelLayout(r.first.the_case.pump).Fh();
  return r.analytic.at(row, fh) == 0 || r.multibody.at(row, fh) == 0;
}

void Maker::compare_tables() {
  ComparisonResult& r = result_;
  r.comparison = compare::compare_tables(r.analytic, r.multibody, comparison_options());
  std::erase_if(r.comparison.channels,
                [&](const auto& c) { return !r.options.channels.wants(c.channel); });
  require_something_compared(r);
  for (const ResultTable* table : {&r.analytic, &r.multibody})
    for (auto& check : compare::judge_checks(*table, zero_scales_, r.tolerance))
      r.checks.push_back(std::move(check));
  if (!analytic_budget_) return;
  r.budget = compare_budgets(std::move(*analytic_budget_), std::move(*multibody_budget_),
                             r.tolerance, zero_scales_);
  append(r.checks, r.budget->checks);
  r.budget->analytic_oil = pump_power(r.first, progress_of_("power of the oil"));
  // Both models get the same oil, unless they are given different cases.
  const bool same = r.first.hydraulics && r.second.hydraulics &&
                    r.first.hydraulics->equations == r.second.hydraulics->equations;
  r.budget->multibody_oil =
      same ? r.budget->analytic_oil : pump_power(r.second, progress_of_("power of the other oil"));
}

// Takes the difference apart where the models' assumptions differ.
void Maker::split_assumptions() {
  ComparisonResult& r = result_;
  const Assumptions& from = r.first.the_case.analytic;
  const Assumptions& to = r.second.the_case.multibody;
  // Of assumptions and transfer of a variant towards those of the second case.
  using Change = void (*)(Assumptions&, Case&, const Case& to);
  const Change all_changes[] = {
      [](Assumptions& a, Case&, const Case& b) { a.piston_friction = b.multibody.piston_friction; },
      [](Assumptions& a, Case&, const Case& b) { a.inertia = b.multibody.inertia; },
      [](Assumptions& a, Case&, const Case& b) { a.gear = b.multibody.gear; }};
  const auto from_words = in_words(from);
  const auto to_words = in_words(to);
  std::vector<Change> changes;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < from_words.size(); ++i) {
    if (from_words[i].second == to_words[i].second) continue;
    r.changes.push_back({from_words[i].first, from_words[i].second, to_words[i].second});
    names.push_back(from_words[i].first);
    changes.push_back(all_changes[i]);
  }
  const TransferKind kinds[] = {r.first.the_case.pump.transfer.kind,
                                r.second.the_case.pump.transfer.kind};
  const bool other_transfer = r.options.split_transfer && kinds[0] != kinds[1];
  if (other_transfer) {
    r.changes.push_back({"transfer", to_string(kinds[0]), to_string(kinds[1])});
    names.emplace_back("transfer");
    changes.push_back([](Assumptions&, Case& variant, const Case& b) {
      variant.pump.transfer = b.pump.transfer;
      variant.pump.gear = b.pump.gear;
    });
  }
  // The closed form knows involutes alone: what another shape does is seen in the other model.
  std::optional<ModelRun> involutes;
  const unsigned shape = 1U << names.size();
  const bool other_shape = has_teeth() && to.flanks != from.flanks;
  if (other_shape) {
    r.changes.push_back({"flanks of the teeth", to_string(from.flanks), to_string(to.flanks)});
    names.emplace_back("flanks of the teeth");
    changes.push_back([](Assumptions&, Case&, const Case&) {});
    RunOptions options = multibody_run(0);
    options.assumptions = to;
    options.assumptions->flanks = from.flanks;
    options.budget = r.budget.has_value();
    involutes = study::run(r.second, multibody_samples_, options, progress_of_);
  }
  if (names.empty()) return;
  const auto run_of = [&](unsigned mask, bool budget) {
    RunOptions options{.assumptions = from, .budget = budget};
    PreparedCase ready{r.first.the_case, r.first.hydraulics,
                       PressureTrace(r.first.the_case.pressure)};
    for (std::size_t i = 0; i < changes.size(); ++i)
      if ((mask & (1U << i)) != 0)
        changes[i](*options.assumptions, ready.the_case, r.second.the_case);
    ModelRun run = study::run(ready, samples_, options);
    // Another transfer has other columns.
    if (other_transfer) run.table = in_columns_of(r.analytic, run.table);
    return run;
  };
  const auto shaped = [&](unsigned mask, ResultTable table, const ResultTable& other,
                          const ResultTable& involute) {
    if (other_shape && (mask & shape) != 0)
      for (std::size_t i = 0; i < table.values.size(); ++i) {
        const std::size_t row = i / table.columns(), column = i % table.columns();
        table.values[i] += other.at(row, column) - involute.at(row, column);
      }
    return table;
  };
  const auto variant = [&](unsigned mask) {
    return shaped(mask, run_of(mask, false).table, r.multibody,
                  involutes ? involutes->table : r.multibody);
  };
  // A tolerance that the user names counts as it is.
  const double tolerance = r.options.tolerance || integrated() ? r.tolerance : kDrivenRestTolerance;
  r.split =
      compare::split_difference(r.analytic, r.multibody, names, variant, zero_scales_, tolerance);
  compare::mark_explained(r.comparison, *r.split);
  if (!r.budget) return;
  explain(*r.budget,
          compare::split_difference(
              r.budget->analytic, r.budget->multibody, names,
              [&](unsigned mask) {
                return shaped(mask, *run_of(mask, true).budget, r.budget->multibody,
                              involutes ? *involutes->budget : r.budget->multibody);
              },
              zero_scales_, tolerance),
          zero_scales_);
}

// Rcs and Tcs alone of a run: of many rows part by part, so that no more than a part is ever held
// in all its columns.
ResultTable torque_of_gear(const PreparedCase& ready, const Samples& samples,
                           const RunOptions& options, const PartProgress& progress_of) {
  const auto wanted = [](const Channel& channel) {
    return channel.quantity == "Rcs" || channel.quantity == "Tcs";
  };
  const std::size_t rows = samples.theta_deg.size();
  std::optional<Progress> told;
  ResultTable whole;
  for (std::size_t first = 0; first < rows; first += kManyRows) {
    const Samples part = samples.part(first, kManyRows);
    const auto of_part = [&](const std::string& name) {
      if (!told) told = progress_of(name);
      return !*told ? Progress() : Progress([&](double done) {
        (*told)((static_cast<double>(first) + done * static_cast<double>(part.theta_deg.size())) /
                static_cast<double>(rows));
      });
    };
    ResultTable torque = select_channels(study::run(ready, part, options, of_part).table, wanted);
    if (first == 0) {
      whole = std::move(torque);
      continue;
    }
    append(whole.theta_deg, torque.theta_deg);
    append(whole.values, torque.values);
    whole.provenance.seconds += torque.provenance.seconds;
  }
  return whole;
}

// Both models, and both without the viscous torque, which takes as long: side by side where that is
// seconds. Of short runs the time is reported, so nothing runs beside them.
void Maker::run_all() {
  if (integrated() || samples_.theta_deg.size() < kManyRows) {
    run_models();
    run_without_viscous(progress_of_);
    return;
  }
  struct Stopped {};
  std::atomic<bool> first_done = false, stopped = false;
  std::exception_ptr failure;  // of the second job: told where the first has none
  numerics::parallel_for(2, 2, [&](std::size_t job) {
    try {
      if (job == 0) {
        run_models();
        first_done = true;
        return;
      }
      // One of them tells how far it is: the first, then this one.
      run_without_viscous([&](const std::string& part) {
        return Progress([&, told = progress_of_(part)](double fraction) {
          if (stopped) throw Stopped();
          if (first_done) told(fraction);
        });
      });
    } catch (const Stopped&) {
    } catch (...) {
      if (job == 0) {
        stopped = true;
        throw;
      }
      failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
}

// Fig. 32 with and without the block's viscous torque: what it shows.
void Maker::run_without_viscous(const PartProgress& progress_of) {
  ComparisonResult& r = result_;
  if (r.first.the_case.pump.friction.block_viscous <= 0 || integrated() ||
      r.options.scene.scene != multibody::Scene::full)
    return;
  const auto still = [](const PreparedCase& ready) {
    Case the_case = ready.the_case;
    the_case.pump.friction.block_viscous = 0;
    PressureTrace pressure(the_case.pressure);
    return PreparedCase{std::move(the_case), {}, std::move(pressure)};
  };
  const auto named = [&](const std::string& part) { return progress_of(part + ", Cc = 0"); };
  r.without_viscous.push_back(torque_of_gear(still(r.first), samples_, {}, named));
  r.without_viscous.push_back(
      torque_of_gear(still(r.second), multibody_samples_, multibody_run(0), named));
}

// Both models held to a reference: what was asked for and computed.
void Maker::hold_to_reference() {
  ComparisonResult& r = result_;
  const auto computed = [&](Model model) -> const ResultTable& {
    return model == Model::analytic ? r.analytic : r.multibody;
  };
  const auto wanted = [&](Model model, const ResultTable& table) {
    return select_channels(table, [&](const Channel& channel) {
      return r.options.channels.wants(channel) &&
             any_computed(computed(model), computed(model).find(channel.name));
    });
  };
  ResultAt at_angles;
  if (!integrated())
    at_angles = [&](Model model, const std::vector<double>& theta_deg) {
      return wanted(model,
                    model == Model::analytic
                        ? run_at_angles(r.first, theta_deg, {}, progress_of_)
                        : run_at_angles(r.second, theta_deg, multibody_run(0), progress_of_));
    };
  r.with = hold_results(
      r.options.with, [&](Model model) -> const Case& { return r.of(model).the_case; },
      [&](Model model) {
        return ReferenceRun{wanted(model, computed(model)), zero_scales_};
      },
      at_angles);
  if (!r.with->other_case.empty())
    r.warnings.push_back(
        {"the curves belong to another case", r.with->name + ": " + r.with->other_case});
}

// Of one of the pumps: what its ports and its limits of validity say.
void Maker::warn_of(Model model, const std::vector<analytic::ValidityLimit>& limits) {
  const PreparedCase& ready = result_.of(model);
  const auto warn = [&](Warning warning) {
    if (result_.other) warning.text = result_.pump_of(model) + ": " + warning.text;
    result_.warnings.push_back(std::move(warning));
  };
  if (ready.hydraulics) {
    for (auto& warning : timing_warnings(timing_rows(ready.the_case, *ready.hydraulics)))
      warn(std::move(warning));
    if (auto warning = accuracy_warning(ready.the_case, *ready.hydraulics))
      warn(std::move(*warning));
  }
  for (Warning& warning : limit_warnings(limits)) warn(std::move(warning));
}

void Maker::warn() {
  ComparisonResult& r = result_;
  warn_of(Model::analytic, r.limits);
  if (r.other) warn_of(Model::multibody, r.other->limits);
  r.rounding = rounding_lines(r.first.the_case, r.first.the_case.analytic);
  for (const auto& text : rounding_warnings(r.rounding))
    r.warnings.push_back({"digits lost to rounding", text});
  if (!integrated()) {
    r.losses = multibody_losses(r.second.the_case, r.second.the_case.multibody, r.options.scene);
    for (const auto& text :
         multibody_warnings(r.second.the_case, r.options.scene, r.rounding, r.losses))
      r.warnings.push_back({"digits lost in Simbody", text});
    note_multiplier_errors();
  }
  if (const std::string text = small_components(r.comparison); !text.empty())
    r.warnings.push_back({"small channels", text});
}

// Where the models differ: what the multibody model's other method, which solves for no
// multipliers, gives at the same angles. Both are the same equations, so that their difference is
// round-off.
void Maker::note_multiplier_errors() {
  ComparisonResult& r = result_;
  if (r.agrees() || r.split || r.options.scene.scene != multibody::Scene::full ||
      multibody::method_for(r.second.the_case.pump, r.options.scene.method) !=
          multibody::Method::multipliers)
    return;
  RunOptions without = multibody_run(0);
  without.scene.method = multibody::Method::residual;
  without.budget = r.budget.has_value();
  const auto keep = [&](const compare::Comparison& changes) {
    for (const auto& c : changes.channels)
      if (c.compared() && c.largest_over_peak() > r.tolerance)
        r.losses.multipliers[c.channel.name] = c.largest_over_peak();
  };
  try {
    const ModelRun other = study::run(r.second, multibody_samples_, without, progress_of_);
    compare::Options options = comparison_options();
    options.uncertainty = nullptr;
    // Scales are those of the verdict: of the analytic model's peaks.
    compare::Comparison changes = compare::compare_tables(r.multibody, other.table, options);
    for (auto& c : changes.channels)
      for (const auto& of_verdict : r.comparison.channels)
        if (of_verdict.channel.name == c.channel.name) c.peak = of_verdict.peak;
    keep(changes);
    std::vector<compare::Check> checks =
        compare::judge_checks(other.table, zero_scales_, r.tolerance);
    if (other.budget) {
      const BudgetComparison budgets =
          compare_budgets(r.budget->multibody, *other.budget, r.tolerance, zero_scales_);
      keep(budgets.comparison);
      append(checks, budgets.checks);
    }
    // Of a check that holds there: all that it is off by here.
    for (const auto& check : r.checks)
      for (const auto& there : checks)
        if (!check.holds() && there.holds() && check.table == r.multibody.name &&
            there.table == check.table && there.name == check.name)
          r.losses.multipliers[full_name(check)] = check.relative();
  } catch (const ComputationError&) {
    // That method refuses the case: it says nothing.
  }
}

}  // namespace

Lines in_words(const Assumptions& a) {
  return {{"piston friction", a.piston_friction ? "on" : "off"},
          {"piston inertia", to_string(a.inertia)},
          {"gear", to_string(a.gear)}};
}

void check_same_run(const Case& first, const Case& second) {
  const auto differs = [&](const char* what) {
    throw InputError(second.file.string() + ": must have the same " + what + " as " +
                     first.file.string());
  };
  if (first.pump.geometry.pistons != second.pump.geometry.pistons) differs("number of pistons");
  if (first.operation.samples_per_revolution != second.operation.samples_per_revolution)
    differs("samples_per_revolution");
  if (first.operation.revolutions != second.operation.revolutions) differs("revolutions");
}

ComparisonResult compare_models(Case analytic_case, std::optional<Case> multibody_case,
                                const ComparisonOptions& options, const PartProgress& progress_of) {
  if (!options.with.empty()) reference_in(options.with);  // refused before anything is computed
  if (multibody_case) check_same_run(analytic_case, *multibody_case);
  if (options.engines) options.engines->calls->check(*options.engines);
  if (options.engines && options.way != Way::driven)
    throw InputError(
        "--engine: must be left out beside --way integrated: engines are compared with driven "
        "models; --engine-way integrated integrates them");
  require_memory(analytic_case, Kept::compared, options.way);
  const bool other_pump = multibody_case.has_value();
  PreparedCase first = prepare(std::move(analytic_case), progress_of);
  // The same case is solved once: both models get the very same curve.
  PreparedCase second = multibody_case ? prepare(std::move(*multibody_case), progress_of)
                                       : PreparedCase{first.the_case, first.hydraulics,
                                                      PressureTrace(first.the_case.pressure)};
  return Maker(std::move(first), std::move(second), other_pump, options, progress_of).make();
}

CaseDescription describe(const ComparisonResult& result, const PartProgress& progress_of) {
  const bool all_loads = result.multibody_loads.rows() > 0;
  return describe(result.first.the_case, progress_of,
                  all_loads ? Described::without_turn : Described::all);
}

}  // namespace bentaxis::study
