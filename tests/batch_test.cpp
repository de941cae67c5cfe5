// The batch kernel: the scalar model's results to round-off on every instruction set this machine
// has, only what was asked for, no allocation.
#include "bentaxis/analytic/batch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <type_traits>
#include <utility>

#include "allocations.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using namespace analytic;

// Instants as arrays, from one instant per lane.
struct Arrays {
  explicit Arrays(const std::vector<Instant>& list)
      : pressure(list.front().chamber_pressure.size()) {
    for (const Instant& i : list) {
      theta.push_back(i.shaft.angle);
      omega.push_back(i.shaft.speed);
      omega_dot.push_back(i.shaft.acceleration);
      suction.push_back(i.ports.suction);
      delivery.push_back(i.ports.delivery);
      for (std::size_t k = 0; k < pressure.size(); ++k)
        pressure[k].push_back(i.chamber_pressure[k]);
    }
    for (const auto& column : pressure) chamber.push_back({column.data(), 0});
    instants = {list.size(), {theta.data(), 0},   {omega.data(), 0},   {omega_dot.data(), 0},
                chamber,     {suction.data(), 0}, {delivery.data(), 0}};
  }
  std::vector<double> theta, omega, omega_dot, suction, delivery;
  std::vector<std::vector<double>> pressure;
  std::vector<Varying> chamber;
  BatchInstants instants;
};

std::vector<Instant> turn(const Case& the_case) {
  const Samples samples = one_turn(the_case);
  std::vector<Instant> list(samples.theta_deg.size());
  for (std::size_t i = 0; i < list.size(); ++i) samples.instant(i, list[i]);
  return list;
}

// ---- high-precision curves ---------------------------------------------------------------------

class BatchReference : public testing::TestWithParam<std::string> {};

// As for the scalar model: rounding of the inputs and some 300 operations.
constexpr double kReferenceTolerance = 1e-13;

TEST_P(BatchReference, EveryReactionIsRightToRoundOffOnEveryInstructionSet) {
  const Case the_case = reference_case(GetParam());
  const NumericTable reference =
      read_numeric_csv(reference_folder() / GetParam() / "reference.csv", true);
  const ResultTable table = analytic::run(the_case, the_case.analytic, one_turn(the_case));
  const Arrays arrays(turn(the_case));
  const BatchModel model(the_case.pump, the_case.analytic);
  BatchColumns columns(model.layout().reactions(), arrays.instants.count);
  for (const InstructionSet set : available_instruction_sets()) {
    model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, columns),
                    {set, 1});
    for (std::size_t c = 0; c < model.layout().reactions(); ++c) {
      const Channel& channel = table.channels[c];
      const double peak = table.peak(channel.group);
      for (std::size_t row = 0; row < table.rows(); ++row) {
        const double expected = reference.rows[row][c + 1];
        const double value = columns.column(c)[row] / channel.unit_in_si;
        ASSERT_EQ(is_computed(expected), is_computed(value)) << channel.name;
        if (!is_computed(expected)) continue;
        ASSERT_NEAR(expected, value, scaled(kReferenceTolerance) * (peak > 0 ? peak : 1))
            << channel.name << " at " << table.theta_deg[row] << " deg, " << to_string(set);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, BatchReference, testing::ValuesIn(reference_cases()),
                         [](const auto& test) { return test.param; });

// ---- against the scalar model on random pumps
// ----------------------------------------------------

// The same operations, fused or not; sine, cosine and tanh of another library: of the row's largest
// force, the worst found is below 5e-15.
constexpr double kScalarTolerance = 1e-13;

double worst_difference(const Model& model, const Instant& instant, const BatchColumns& columns,
                        std::size_t row) {
  std::vector<double> values(model.layout().size());
  model.reactions(instant, values);
  double largest = 0;
  double worst = 0;
  for (std::size_t c = 0; c < model.layout().reactions(); ++c) {
    const double batch = columns.column(c)[row];
    if (is_computed(values[c]) != is_computed(batch)) return 1e300;
    if (!is_computed(values[c])) continue;
    largest = std::max(largest, std::abs(values[c]));
    worst = std::max(worst, std::abs(values[c] - batch));
  }
  return worst / largest;
}

TEST(Batch, OnePumpAtAnyInstantEqualsTheScalarModel) {
  RandomPump random(31);
  for (int n = 0; n < 60; ++n) {
    const PumpParameters pump = random.pump();
    const Assumptions assumptions = random.assumptions(pump);
    const Model scalar(pump, assumptions);
    const BatchModel model(pump, assumptions);
    std::vector<Instant> instants;
    for (int i = 0; i < 1 + n % 19; ++i) instants.push_back(random.instant(pump, true));
    const Arrays arrays(instants);
    for (const InstructionSet set : available_instruction_sets()) {
      BatchColumns columns(model.layout().reactions(), instants.size());
      model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, columns),
                      {set, 1});
      for (std::size_t i = 0; i < instants.size(); ++i)
        ASSERT_LT(worst_difference(scalar, instants[i], columns, i), scaled(kScalarTolerance))
            << "pump " << n << ", lane " << i << ", " << to_string(set);
    }
  }
}

// Pumps of one batch may have friction with and without a regularization, a port plate or none.
std::vector<PumpParameters> pumps_of(RandomPump& random, int pistons, int count) {
  std::vector<PumpParameters> pumps;
  for (int i = 0; i < count; ++i) {
    PumpParameters pump = random.pump();
    while (assembly_margin(pump.geometry).longest_distance > 0.8 * pump.geometry.piston_length)
      pump = random.pump();
    pump.geometry.pistons = pistons;
    if (i % 3 == 1) pump.friction.regularization = 0;
    pumps.push_back(pump);
  }
  return pumps;
}

TEST(Batch, ManyPumpsEqualTheScalarModel) {
  RandomPump random(32);
  for (const int count : {1, 2, 3, 7, 8, 9, 31}) {
    for (const PistonInertia inertia : {PistonInertia::lumped, PistonInertia::real}) {
      for (const BlockDrive gear : {BlockDrive::mesh, BlockDrive::imposed}) {
        const Assumptions assumptions = {true, inertia, gear};
        const auto pumps = pumps_of(random, 5, count);
        const PumpBatch model(pumps, assumptions);
        std::vector<Instant> instants;
        for (const PumpParameters& pump : pumps) instants.push_back(random.instant(pump, true));
        const Arrays arrays(instants);
        for (const InstructionSet set : available_instruction_sets()) {
          BatchColumns columns(model.layout().reactions(), pumps.size());
          model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, columns),
                          {set, 1});
          for (std::size_t i = 0; i < pumps.size(); ++i)
            ASSERT_LT(worst_difference(Model(pumps[i], assumptions), instants[i], columns, i),
                      scaled(kScalarTolerance))
                << "pump " << i << " of " << count << ", " << to_string(set);
        }
      }
    }
  }
}

// Angles far beyond a turn, dead centres, standstill: where the vector functions take other paths.
TEST(Batch, SpecialInstantsEqualTheScalarModel) {
  const Case the_case = reference_case("bap63_rated");
  for (const double regularization : {0.0, 0.01}) {
    PumpParameters pump = the_case.pump;
    pump.friction.regularization = regularization;
    const Model scalar(pump, {});
    const BatchModel model(pump, {});
    std::vector<Instant> instants;
    for (const double theta : {0.0, -0.0, kPi, -kPi, 1e-300, 1e5, -3e7, 1e12, 2 * kPi}) {
      for (const double omega : {0.0, 157.0, -157.0, 1e-9}) {
        Instant instant;
        instant.turn(theta, omega);
        instant.chamber_pressure = {0, 1e7, 2e7, 0, 3e7};
        instants.push_back(instant);
      }
    }
    const Arrays arrays(instants);
    for (const InstructionSet set : available_instruction_sets()) {
      BatchColumns columns(model.layout().reactions(), instants.size());
      model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, columns),
                      {set, 1});
      for (std::size_t i = 0; i < instants.size(); ++i)
        ASSERT_LT(worst_difference(scalar, instants[i], columns, i), scaled(kScalarTolerance))
            << instants[i].shaft.angle << " " << instants[i].shaft.speed << " " << to_string(set);
    }
  }
}

// Negative control: a parameter off by 1e-6 in the pump given to the batch must be noticed.
TEST(Batch, TheComparisonNoticesAnotherPump) {
  RandomPump random(33);
  const PumpParameters pump = random.pump();
  PumpParameters other = pump;
  other.geometry.piston_length *= 1 + 1e-6;
  const std::vector<Instant> instants = {random.instant(pump, true)};
  const BatchModel model(other, {});
  BatchColumns columns(model.layout().reactions(), 1);
  const Arrays arrays(instants);
  model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, columns));
  EXPECT_GT(worst_difference(Model(pump, {}), instants[0], columns, 0), kScalarTolerance);
}

// ---- only what was asked for
// ---------------------------------------------------------------------

TEST(Batch, WritesWhatWasAskedForAndNothingElse) {
  const Case the_case = reference_case("bap63_rated");
  std::vector<Instant> instants = turn(the_case);
  instants.resize(13);
  const Arrays arrays(instants);
  const BatchModel model(the_case.pump, the_case.analytic);
  const std::size_t reactions = model.layout().reactions();
  constexpr double kUntouched = 4321;
  for (const InstructionSet set : available_instruction_sets()) {
    BatchColumns all(reactions, instants.size());
    model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, all), {set, 1});
    for (const ChannelGroup group : {ChannelGroup::pistons, ChannelGroup::bearings}) {
      BatchColumns part(reactions, instants.size());
      for (std::size_t c = 0; c < reactions; ++c)
        std::fill_n(part.column(c), instants.size() + 1, kUntouched);  // and one beyond the end
      const BatchOutputs outputs = outputs_of(model.layout(), group, part);
      model.reactions(arrays.instants, outputs, {set, 1});
      for (std::size_t c = 0; c < reactions; ++c) {
        for (std::size_t i = 0; i < instants.size(); ++i)
          ASSERT_EQ(part.column(c)[i], outputs[c] != nullptr ? all.column(c)[i] : kUntouched)
              << model.layout().channels()[c].name << " " << to_string(set);
        ASSERT_EQ(part.column(c)[instants.size()], kUntouched);
      }
    }
  }
}

TEST(Batch, OneNumberForAllEqualsAnArrayOfIt) {
  const Case the_case = reference_case("step_single");
  const std::vector<Instant> instants = turn(the_case);
  const Arrays arrays(instants);
  const BatchModel model(the_case.pump, the_case.analytic);
  BatchInstants constant = arrays.instants;
  constant.omega = {nullptr, instants[0].shaft.speed};
  constant.omega_dot = {};
  constant.suction = {nullptr, instants[0].ports.suction};
  constant.delivery = {nullptr, instants[0].ports.delivery};
  BatchColumns first(model.layout().reactions(), instants.size());
  BatchColumns second(model.layout().reactions(), instants.size());
  model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, first));
  model.reactions(constant, outputs_of(model.layout(), ChannelGroup::all, second));
  for (std::size_t c = 0; c < model.layout().reactions(); ++c)
    for (std::size_t i = 0; i < instants.size(); ++i)
      ASSERT_EQ(first.column(c)[i], second.column(c)[i]);
}

// Code for writing past the caches is compiled anew: additions may be fused elsewhere. 4e-16 found.
constexpr double kRecompiledTolerance = 1e-14;

// A copy would point into the original.
static_assert(!std::is_copy_constructible_v<BatchColumns>);
static_assert(!std::is_copy_assignable_v<BatchColumns>);

// An odd number of cache lines apart, and no more of them than that takes.
TEST(Batch, ColumnsDoNotShareCacheSets) {
  for (const std::size_t rows : {0, 1, 7, 8, 9, 24, 512, 1000, 1024, 65536}) {
    analytic::BatchColumns columns(2, rows);
    const auto doubles = static_cast<std::size_t>(columns.column(1) - columns.column(0));
    EXPECT_EQ(doubles % 8, 0U) << rows;
    EXPECT_EQ(doubles / 8 % 2, 1U) << rows;
    EXPECT_GE(doubles, rows);
    EXPECT_LE(doubles, rows + 16);
  }
}

TEST(Batch, ColumnsCanBeMoved) {
  BatchColumns columns(3, 5);
  columns.column(2)[4] = 7;
  const double* const before = columns.column(2);
  const BatchColumns moved = std::move(columns);
  EXPECT_EQ(moved.column(2), before);
  EXPECT_EQ(moved.column(2)[4], 7);
}

// Whole lines are written past the caches, what is left over by ordinary stores, and what is not
// asked for or not computed is left alone: on every instruction set, one pump or many.
TEST(Batch, WritingPastTheCachesChangesNothingOnAnyInstructionSet) {
  const Case the_case = reference_case("bap63_rated");
  const std::vector<Instant> some = turn(the_case);
  std::vector<Instant> instants;
  for (std::size_t i = 0; i < 60'003; ++i) instants.push_back(some[i % some.size()]);
  const Arrays arrays(instants);
  const Arrays few(some);
  for (const BlockDrive gear : {BlockDrive::mesh, BlockDrive::imposed}) {
    Assumptions assumptions = the_case.analytic;
    assumptions.gear = gear;
    const BatchModel model(the_case.pump, assumptions);
    const PumpBatch pumps(std::vector<PumpParameters>(instants.size(), the_case.pump), assumptions);
    const std::size_t reactions = model.layout().reactions();
    for (const InstructionSet set : available_instruction_sets()) {
      BatchColumns small(reactions, some.size());
      model.reactions(few.instants, outputs_of(model.layout(), ChannelGroup::all, small), {set, 1});
      BatchColumns large(reactions, instants.size());
      BatchOutputs outputs = outputs_of(model.layout(), ChannelGroup::all, large);
      outputs[model.layout().Fh()] = nullptr;
      for (const bool many : {false, true}) {
        for (std::size_t c = 0; c < reactions; ++c)
          std::fill_n(large.column(c), instants.size(), 0);
        if (many)
          pumps.reactions(arrays.instants, outputs, {set, 1});
        else
          model.reactions(arrays.instants, outputs, {set, 1});
        for (std::size_t c = 0; c < reactions; ++c) {
          double peak = 0;
          for (std::size_t i = 0; i < some.size(); ++i)
            if (is_computed(small.column(c)[i]))
              peak = std::max(peak, std::abs(small.column(c)[i]));
          for (std::size_t i = 0; i < instants.size(); ++i) {
            const double expected = small.column(c)[i % some.size()];
            const double value = large.column(c)[i];
            if (outputs[c] == nullptr) {
              ASSERT_EQ(value, 0);
            } else if (!is_computed(expected)) {
              ASSERT_FALSE(is_computed(value));
            } else {
              ASSERT_NEAR(value, expected, scaled(kRecompiledTolerance) * peak)
                  << to_string(set) << ", column " << c << ", row " << i;
            }
          }
        }
      }
    }
  }
}

// Large enough to be shared by threads and to be written past the caches.
TEST(Batch, ThreadsAndWritingPastTheCachesChangeNothing) {
  const Case the_case = reference_case("bap63_rated");
  const std::vector<Instant> some = turn(the_case);
  std::vector<Instant> instants;
  for (std::size_t i = 0; i < 60'003; ++i) instants.push_back(some[i % some.size()]);
  const Arrays arrays(instants);
  const BatchModel model(the_case.pump, the_case.analytic);
  BatchColumns small(model.layout().reactions(), some.size());
  const Arrays some_arrays(some);
  model.reactions(some_arrays.instants, outputs_of(model.layout(), ChannelGroup::all, small));
  const auto large = [&](int threads) {
    BatchColumns columns(model.layout().reactions(), instants.size());
    model.reactions(arrays.instants, outputs_of(model.layout(), ChannelGroup::all, columns),
                    {available_instruction_sets().back(), threads});
    return columns;
  };
  const BatchColumns one = large(1);
  for (std::size_t c = 0; c < model.layout().reactions(); ++c) {
    double peak = 0;
    for (std::size_t i = 0; i < some.size(); ++i)
      peak = std::max(peak, std::abs(small.column(c)[i]));
    for (std::size_t i = 0; i < instants.size(); ++i)
      ASSERT_NEAR(one.column(c)[i], small.column(c)[i % some.size()],
                  scaled(kRecompiledTolerance) * peak);
  }
  for (const int threads : {2, 3}) {
    const BatchColumns shared = large(threads);
    for (std::size_t c = 0; c < model.layout().reactions(); ++c)
      for (std::size_t i = 0; i < instants.size(); ++i)
        ASSERT_EQ(shared.column(c)[i], one.column(c)[i]) << threads;
  }
}

// ---- statistics
// -------------------------------------------------------------------------------------

// Every reaction, and every vector of one quantity.
std::vector<Measured> all_measured(const ChannelLayout& layout) {
  std::vector<Measured> measured;
  for (std::size_t c = 0; c < layout.reactions(); ++c) measured.push_back({c});
  for (int k = 0; k < layout.pistons(); ++k) {
    measured.push_back({layout.Rs(k, 0), 3});
    measured.push_back({layout.Rc(k, 0), 2});
  }
  measured.insert(measured.end(), {{layout.Th(0), 2}, {layout.Rb1(0), 3}, {layout.Rb2(0), 2}});
  return measured;
}

// Sums of up to thousands of numbers that are reactions to kRecompiledTolerance.
constexpr double kSumTolerance = 1e-13;

// By columns, as whoever has no statistics of the kernel would.
void expect_statistics_of_columns(const BatchModel& model, const BatchInstants& instants,
                                  InstructionSet set, const std::string& what) {
  BatchColumns columns(model.layout().reactions(), instants.count);
  model.reactions(instants, outputs_of(model.layout(), ChannelGroup::all, columns), {set, 1});
  const std::vector<Measured> measured = all_measured(model.layout());
  std::vector<Statistics> found(measured.size());
  model.statistics(instants, measured, found, {set, 1});
  double scale = 0;  // largest reaction
  for (std::size_t c = 0; c < model.layout().reactions(); ++c)
    for (std::size_t i = 0; i < instants.count; ++i)
      if (is_computed(columns.column(c)[i]))
        scale = std::max(scale, std::abs(columns.column(c)[i]));
  const double tolerance = scaled(kSumTolerance) * scale;
  for (std::size_t m = 0; m < measured.size(); ++m) {
    Statistics expected{0, HUGE_VAL, -HUGE_VAL, 0};
    for (std::size_t i = 0; i < instants.count; ++i) {
      double value = columns.column(measured[m].reaction)[i];
      if (measured[m].components > 1) {
        double squares = 0;
        for (std::size_t c = 0; c < measured[m].components; ++c)
          squares += std::pow(columns.column(measured[m].reaction + c)[i], 2);
        value = std::sqrt(squares);
      }
      expected.mean += value / static_cast<double>(instants.count);
      expected.mean_square += value * value / static_cast<double>(instants.count);
      expected.min = std::min(expected.min, value);
      expected.max = std::max(expected.max, value);
    }
    const std::string at = what + ", " + to_string(set) + ", measured " + std::to_string(m);
    ASSERT_EQ(is_computed(expected.mean), is_computed(found[m].max)) << at;
    if (!is_computed(expected.mean)) continue;
    ASSERT_NEAR(expected.mean, found[m].mean, tolerance) << at;
    ASSERT_NEAR(expected.min, found[m].min, tolerance) << at;
    ASSERT_NEAR(expected.max, found[m].max, tolerance) << at;
    ASSERT_NEAR(expected.mean_square, found[m].mean_square, tolerance * scale) << at;
  }
}

TEST(Statistics, AreThoseOfTheColumns) {
  RandomPump random(2024);
  for (const std::size_t count : {1, 3, 8, 63, 64, 65, 360, 1023, 2500}) {
    const PumpParameters pump = random.pump();
    std::vector<Instant> instants;
    for (std::size_t i = 0; i < count; ++i) instants.push_back(random.instant(pump, true));
    const Arrays arrays(instants);
    for (const BlockDrive gear : {BlockDrive::mesh, BlockDrive::imposed}) {
      const BatchModel model(pump, {.inertia = pump.piston.inertia, .gear = gear});
      for (const InstructionSet set : available_instruction_sets())
        expect_statistics_of_columns(model, arrays.instants, set,
                                     std::to_string(count) + " instants");
    }
  }
}

TEST(Statistics, DoNotDependOnThreads) {
  const Case the_case = reference_case("bap63_rated");
  const std::vector<Instant> once = turn(the_case);
  std::vector<Instant> instants;
  for (std::size_t i = 0; i < 9001; ++i) instants.push_back(once[i % once.size()]);
  const Arrays arrays(instants);
  const BatchModel model(the_case.pump, the_case.analytic);
  const std::vector<Measured> measured = all_measured(model.layout());
  std::vector<Statistics> one(measured.size()), more(measured.size());
  for (const InstructionSet set : available_instruction_sets()) {
    model.statistics(arrays.instants, measured, one, {set, 1});
    for (const int threads : {2, 3, 64}) {
      model.statistics(arrays.instants, measured, more, {set, threads});
      EXPECT_EQ(0, std::memcmp(one.data(), more.data(), one.size() * sizeof(Statistics)))
          << to_string(set) << ", " << threads << " threads";
    }
  }
}

TEST(Statistics, OfPistonsAloneAreThoseOfAll) {
  const Case the_case = reference_case("bap63_rated");
  const Arrays arrays(turn(the_case));
  const BatchModel model(the_case.pump, the_case.analytic);
  const std::vector<Measured> all = all_measured(model.layout());
  std::vector<Statistics> of_all(all.size()), of_one(1);
  model.statistics(arrays.instants, all, of_all);
  const Measured rs = {model.layout().Rs(2, 1)};
  model.statistics(arrays.instants, {&rs, 1}, of_one);
  EXPECT_NEAR(of_one[0].max, of_all[rs.reaction].max, kRecompiledTolerance * of_all[2].max);
}

TEST(Statistics, RefuseWhatDoesNotFit) {
  const Case the_case = reference_case("bap63_rated");
  Arrays arrays(turn(the_case));
  const BatchModel model(the_case.pump, the_case.analytic);
  const auto measure = [&](Measured m, std::size_t room) {
    std::vector<Statistics> results(room);
    model.statistics(arrays.instants, {&m, 1}, results);
  };
  measure({34, 3}, 1);
  EXPECT_THROW(measure({35, 3}, 1), InputError);
  EXPECT_THROW(measure({0, 0}, 1), InputError);
  EXPECT_THROW(measure({0, 1}, 2), InputError);
  arrays.instants.count = 0;
  EXPECT_THROW(measure({0, 1}, 1), InputError);
}

// A model that has become another pump is that pump's.
TEST(Batch, BecomesAnotherPump) {
  RandomPump random(7);
  BatchModel model(random.pump(), {});
  for (int i = 0; i < 20; ++i) {
    const PumpParameters pump = random.pump();
    const Assumptions assumptions = {.inertia = pump.piston.inertia};
    const Arrays arrays({random.instant(pump, true)});
    model.set_pump(pump, assumptions);
    const BatchModel fresh(pump, assumptions);
    ASSERT_EQ(model.layout().pistons(), pump.geometry.pistons);
    BatchColumns found(fresh.layout().reactions(), 1), expected(fresh.layout().reactions(), 1);
    model.reactions(arrays.instants, outputs_of(fresh.layout(), ChannelGroup::all, found));
    fresh.reactions(arrays.instants, outputs_of(fresh.layout(), ChannelGroup::all, expected));
    for (std::size_t c = 0; c < fresh.layout().reactions(); ++c)
      ASSERT_EQ(found.column(c)[0], expected.column(c)[0]);
    PumpParameters refused = pump;
    refused.geometry.piston_length = 0;
    EXPECT_THROW(model.set_pump(refused, assumptions), InputError);
  }
}

// ---- counts
// ----------------------------------------------------------------------------------------

TEST(Allocations, AreCounted) {
  const AllocationCounter counter;
  ::operator delete(::operator new(100));
  EXPECT_EQ(counter.count(), 1);
}

TEST(Allocations, NoEvaluationAllocates) {
  const Case the_case = reference_case("bap63_rated");
  const std::vector<Instant> instants = turn(the_case);
  const Model scalar(the_case.pump, the_case.analytic);
  std::vector<double> values(scalar.layout().size());
  const BatchModel model(the_case.pump, the_case.analytic);
  const Arrays arrays(instants);
  BatchColumns columns(model.layout().reactions(), instants.size());
  const BatchOutputs outputs = outputs_of(model.layout(), ChannelGroup::all, columns);
  const PumpBatch pumps(std::vector<PumpParameters>(instants.size(), the_case.pump),
                        the_case.analytic);
  const auto sets = available_instruction_sets();
  const std::vector<Measured> measured = all_measured(model.layout());
  std::vector<Statistics> statistics(measured.size());
  model.statistics(arrays.instants, measured, statistics);
  BatchModel changing(the_case.pump, the_case.analytic);

  const AllocationCounter counter;
  for (const Instant& instant : instants) scalar.reactions(instant, values);
  for (const Instant& instant : instants) scalar.evaluate(instant, values);
  for (const InstructionSet set : sets) {
    model.reactions(arrays.instants, outputs, {set, 1});
    pumps.reactions(arrays.instants, outputs, {set, 1});
    changing.set_pump(the_case.pump, the_case.analytic);
    changing.statistics(arrays.instants, measured, statistics, {set, 1});
  }
  EXPECT_EQ(counter.count(), 0);
}

// ---- input
// -----------------------------------------------------------------------------------------

TEST(Batch, RefusesWhatDoesNotFit) {
  const Case the_case = reference_case("bap63_rated");
  EXPECT_THROW(PumpBatch({}, {}), InputError);
  PumpParameters seven = the_case.pump;
  seven.geometry.pistons = 7;
  EXPECT_THROW(PumpBatch({the_case.pump, seven}, {}), InputError);
  const PumpBatch two({the_case.pump, the_case.pump}, {});
  const Arrays one({turn(the_case)[0]});
  EXPECT_THROW(two.reactions(one.instants, BatchOutputs(37)), InputError);
  EXPECT_THROW(BatchModel(the_case.pump, {}).reactions(one.instants, BatchOutputs(36)), InputError);
}

TEST(Batch, InstructionSetsAreNamedAndOrdered) {
  const auto sets = available_instruction_sets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), InstructionSet::scalar);
  EXPECT_EQ(lanes(sets.front()), 1U);
  for (std::size_t i = 1; i < sets.size(); ++i) EXPECT_EQ(lanes(sets[i]), 2 * lanes(sets[i - 1]));
}

}  // namespace
}  // namespace bentaxis::test
