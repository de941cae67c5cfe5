#include "bentaxis/analytic/batch.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

#include "batch/job.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/validate.h"
#include "prepared.h"

namespace bentaxis::analytic {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kDoublesPerLine = kCacheLine / sizeof(double);
constexpr std::size_t kNumbers = sizeof(closed_form::Pump<double>) / sizeof(double);
static_assert(std::is_trivially_copyable_v<closed_form::Pump<double>>);

// Instants per task: long enough to hide what a task costs (about 1 us).
constexpr std::size_t kGrain = 1024;

// Results larger than this will not be found in a cache by whoever reads them: bytes.
constexpr std::size_t kCacheBytes = std::size_t{16} << 20;

// Should and can results be written past the caches?
bool streams(const BatchInstants& instants, const BatchOutputs& outputs) {
  std::size_t bytes = 0;
  bool aligned = true;
  for (const double* column : outputs) {
    if (column == nullptr) continue;
    bytes += instants.count * sizeof(double);
    aligned &= reinterpret_cast<std::uintptr_t>(column) % kCacheLine == 0;
  }
  return aligned && bytes > kCacheBytes;
}

struct Kernel {
  BatchKernel* run;
  TallyKernel* tally;
};

Kernel kernel(InstructionSet set) {
  switch (set) {
#ifdef BENTAXIS_X86_KERNELS
    case InstructionSet::avx512:
      return {run_batch_avx512, tally_batch_avx512};
    case InstructionSet::avx2:
      return {run_batch_avx2, tally_batch_avx2};
    case InstructionSet::sse2:
      return {run_batch_sse2, tally_batch_sse2};
#else
    case InstructionSet::avx512:
    case InstructionSet::avx2:
    case InstructionSet::sse2:
#endif
    case InstructionSet::scalar:
      break;
  }
  return {run_batch_scalar, tally_batch_scalar};
}

// oneTBB orders what its caller did before a loop, the pieces, and what the caller does after it;
// the thread sanitizer cannot see into the library and is told. Pieces stay unordered among
// themselves.
struct LoopOrder {
#ifdef __SANITIZE_THREAD__
  void started() { __tsan_release(&start_); }
  void piece_starts() { __tsan_acquire(&start_); }
  void piece_ends() { __tsan_release(&end_); }
  void ended() { __tsan_acquire(&end_); }

 private:
  char start_ = 0, end_ = 0;
#else
  void started() {}
  void piece_starts() {}
  void piece_ends() {}
  void ended() {}
#endif
};

BatchJob::Column column(const Varying& v) { return {v.each, v.all}; }

BatchJob::Block block_of(TransferKind transfer) {
  switch (transfer) {
    case TransferKind::constant_velocity:
      return BatchJob::Block::joint;
    case TransferKind::cardan:
      return BatchJob::Block::cardan;
    case TransferKind::double_cardan:
      return BatchJob::Block::double_cardan;
    case TransferKind::gear:
    case TransferKind::pistons:
      break;
  }
  return BatchJob::Block::locked;
}

// What the kernel is given; points to `pressures`, which is filled in, and to what it is made of.
using Pressures = std::array<BatchJob::Column, kMaxPistons>;
BatchJob job_of(const PreparedPump& pump, const double* pumps, const ChannelLayout& layout,
                const BatchInstants& instants, Pressures& pressures) {
  if (instants.chamber_pressure.size() != static_cast<std::size_t>(layout.pistons()))
    throw InputError("batch: " + std::to_string(instants.chamber_pressure.size()) +
                     " chamber pressures for " + std::to_string(layout.pistons()) + " pistons");
  for (std::size_t k = 0; k < instants.chamber_pressure.size(); ++k)
    pressures[k] = column(instants.chamber_pressure[k]);
  const BlockMotion block = instants.block.value_or(BlockMotion{});
  if (instants.block && pump.transfer != TransferKind::gear)
    throw InputError("batch: a motion of the block: must be left out where [transfer] kind = \"" +
                     to_string(pump.transfer) + "\" prescribes it");
  return {.common = pump.common(),
          .stream = false,
          .bodies = true,
          .pump = &pump.numbers,
          .pumps = pumps,
          .pumps_stride = instants.count,
          .theta = column(instants.theta),
          .omega = column(instants.omega),
          .omega_dot = column(instants.omega_dot),
          .suction = column(instants.suction),
          .delivery = column(instants.delivery),
          .block = instants.block ? BatchJob::Block::free : block_of(pump.transfer),
          .psi = column(block.psi),
          .block_omega = column(block.omega),
          .block_omega_dot = column(block.omega_dot),
          .chamber_pressure = pressures.data(),
          .outputs = nullptr};
}

// Calls piece(begin, end) for all instants, in pieces of whole grains, in as many threads as may
// be; as one piece in the calling thread where there is one.
template <class Piece>
void in_pieces(std::size_t count, int threads, const Piece& piece) {
  if (threads <= 1 || count <= kGrain) {
    piece(std::size_t{0}, count);
    return;
  }
  // Each thread keeps to one piece of every array, so that its part stays in its own cache.
  LoopOrder order;
  const auto all = [&] {
    order.started();
    const std::size_t blocks = (count + kGrain - 1) / kGrain;
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, blocks),
        [&](const auto& range) {
          order.piece_starts();
          piece(range.begin() * kGrain, std::min(count, range.end() * kGrain));
          order.piece_ends();
        },
        oneapi::tbb::static_partitioner());
    order.ended();
  };
  if (threads >= oneapi::tbb::this_task_arena::max_concurrency())
    all();
  else
    oneapi::tbb::task_arena(threads).execute(all);
}

void run_job(const PreparedPump& pump, const double* pumps, const ChannelLayout& layout,
             const BatchInstants& instants, const BatchOutputs& outputs,
             const BatchOptions& options) {
  if (outputs.size() < layout.reactions())
    throw InputError("batch: " + std::to_string(outputs.size()) + " outputs, needed are " +
                     std::to_string(layout.reactions()) + " (null where not asked for)");
  Pressures pressures;
  BatchJob job = job_of(pump, pumps, layout, instants, pressures);
  const auto bodies = outputs.begin() + static_cast<std::ptrdiff_t>(layout.Fh());
  job.stream = streams(instants, outputs);
  job.bodies = std::any_of(bodies, outputs.end(), [](const double* p) { return p != nullptr; });
  job.outputs = outputs.data();
  // What a joint exerts stands behind the reactions of every transfer.
  const auto ask = [&](std::size_t column, int& of_job) {
    if (outputs.size() < column + 3) return;
    const auto first = outputs.begin() + static_cast<std::ptrdiff_t>(column);
    if (std::all_of(first, first + 3, [](const double* p) { return p == nullptr; })) return;
    of_job = static_cast<int>(column);
    job.stream = false;  // lines have room for reactions alone
  };
  if (layout.has(Quantity::TcsJoint)) ask(layout.TcsJoint(0), job.common.couple_column);
  if (layout.has(Quantity::Fcs)) ask(layout.Fcs(0), job.common.force_column);
  if (!pump.has_tooth_force() && outputs[layout.Rcs()] != nullptr)
    std::fill_n(outputs[layout.Rcs()], instants.count, not_computed());
  BatchKernel* const run = kernel(options.instruction_set).run;
  in_pieces(instants.count, options.threads,
            [&](std::size_t begin, std::size_t end) { run(job, begin, end); });
}

// Room of a thread for what it adds up.
struct TallyRoom {
  struct Lines {
    alignas(kCacheLine) double values[kBlock];
  };
  struct Lanes {
    alignas(kCacheLine) double values[kTallied * kMaxLanes];
  };
  std::vector<Lines> block;
  std::vector<Lanes> lanes;
  std::vector<Statistics> sums;

  BatchTally tally(const ChannelLayout& layout, std::span<const Measured> measured) {
    static_assert(sizeof(Lines) == kBlock * sizeof(double));
    static_assert(sizeof(Lanes) == kTallied * kMaxLanes * sizeof(double));
    if (block.size() < layout.reactions()) block.resize(layout.reactions());
    if (lanes.size() < measured.size()) lanes.resize(measured.size());
    if (sums.size() < measured.size()) sums.resize(measured.size());
    return {measured, &block.front().values, lanes.front().values};
  }
};

// Adds the sums of a piece to those of pieces before it.
void add(Statistics& all, const Statistics& piece) {
  all.mean += piece.mean;
  all.mean_square += piece.mean_square;
  all.min = std::min(all.min, piece.min);
  all.max = std::max(all.max, piece.max);
}

}  // namespace

std::string to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return "AVX-512";
    case InstructionSet::avx2:
      return "AVX2";
    case InstructionSet::sse2:
      return "SSE2";
    case InstructionSet::scalar:
      break;
  }
  return "one lane";
}

std::vector<InstructionSet> available_instruction_sets() {
  std::vector<InstructionSet> sets = {InstructionSet::scalar};
#ifdef BENTAXIS_X86_KERNELS
  sets.push_back(InstructionSet::sse2);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    sets.push_back(InstructionSet::avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

std::size_t lanes(InstructionSet set) { return std::size_t{1} << static_cast<int>(set); }

BatchColumns::BatchColumns(std::size_t columns, std::size_t rows)
    : rows_(rows),
      // One line more than the rows need: columns a power of two apart would share cache sets.
      stride_((rows / kDoublesPerLine + 1) / 2 * 2 * kDoublesPerLine + kDoublesPerLine),
      first_(static_cast<double*>(
          ::operator new (columns* stride_ * sizeof(double), std::align_val_t{kCacheLine}))) {
  std::uninitialized_fill_n(first_.get(), columns * stride_, 0.0);
}

void BatchColumns::Free::operator()(double* first) const {
  ::operator delete (first, std::align_val_t{kCacheLine});
}

BatchOutputs outputs_of(const ChannelLayout& layout, ChannelGroup group, BatchColumns& columns) {
  BatchOutputs outputs(layout.reactions(), nullptr);
  const std::size_t first = group == ChannelGroup::bearings ? layout.Rb1(0) : 0;
  const std::size_t end = group == ChannelGroup::pistons ? layout.Fh() : outputs.size();
  for (std::size_t i = first; i < end; ++i) outputs[i] = columns.column(i);
  return outputs;
}

namespace {

// Teeth rest, and walls of pistons push, where an iteration per instant says: Model has them.
const PumpParameters& by_kernel(const PumpParameters& pump) {
  if (validate(pump).gear.contact == ToothContact::teeth)
    throw InputError(
        "batch: [gear] contact = \"teeth\": must be \"rigid\" or \"compliant\" in the evaluation "
        "of many instants at a time");
  if (pump.transfer.kind == TransferKind::pistons)
    throw InputError(
        "batch: [transfer] kind = \"pistons\": must be of another kind in the evaluation of many "
        "instants at a time: the block's lag is found instant by instant");
  return pump;
}

}  // namespace

BatchModel::BatchModel(const PumpParameters& pump, const Assumptions& assumptions)
    : layout_(by_kernel(pump)), pump_(std::make_unique<PreparedPump>(prepare(pump, assumptions))) {}
BatchModel::~BatchModel() = default;
BatchModel::BatchModel(BatchModel&&) noexcept = default;
BatchModel& BatchModel::operator=(BatchModel&&) noexcept = default;

void BatchModel::reactions(const BatchInstants& instants, const BatchOutputs& outputs,
                           const BatchOptions& options) const {
  run_job(*pump_, nullptr, layout_, instants, outputs, options);
}

void BatchModel::statistics(const BatchInstants& instants, std::span<const Measured> measured,
                            std::span<Statistics> results, const BatchOptions& options) const {
  if (results.size() != measured.size())
    throw InputError("statistics of a batch: space for " + std::to_string(results.size()) +
                     " results, needed are " + std::to_string(measured.size()));
  if (instants.count == 0) throw InputError("statistics of a batch: there is no instant");
  bool bodies = false;
  for (const Measured& m : measured) {
    const std::size_t end = m.reaction + m.components;
    if (m.components == 0 || end > layout_.reactions())
      throw InputError("statistics of a batch: " + std::to_string(m.components) +
                       " reactions from number " + std::to_string(m.reaction) + " on of " +
                       std::to_string(layout_.reactions()));
    bodies |= end > layout_.Fh();
  }
  if (measured.empty()) return;
  Pressures pressures;
  BatchJob job = job_of(*pump_, nullptr, layout_, instants, pressures);
  job.bodies = bodies;
  TallyKernel* const tally = kernel(options.instruction_set).tally;

  // One grain after the other whatever the threads, so that sums do not depend on them.
  const std::size_t grains = (instants.count + kGrain - 1) / kGrain;
  const auto add_up = [&](std::size_t grain, Statistics* sums, TallyRoom& room) {
    tally(job, room.tally(layout_, measured), grain * kGrain,
          std::min(instants.count, (grain + 1) * kGrain), sums);
  };
  if (options.threads <= 1 || grains == 1) {
    thread_local TallyRoom own;
    add_up(0, results.data(), own);
    for (std::size_t grain = 1; grain < grains; ++grain) {
      add_up(grain, own.sums.data(), own);
      for (std::size_t i = 0; i < results.size(); ++i) add(results[i], own.sums[i]);
    }
  } else {
    std::vector<Statistics> sums(grains * measured.size());
    in_pieces(instants.count, options.threads, [&](std::size_t begin, std::size_t end) {
      thread_local TallyRoom room;
      for (; begin < end; begin += kGrain)
        add_up(begin / kGrain, &sums[begin / kGrain * measured.size()], room);
    });
    std::copy_n(sums.begin(), results.size(), results.begin());
    for (std::size_t i = results.size(); i < sums.size(); ++i)
      add(results[i % results.size()], sums[i]);
  }
  const auto count = static_cast<double>(instants.count);
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].mean /= count;
    results[i].mean_square /= count;
    const std::size_t first = measured[i].reaction;
    if (!pump_->has_tooth_force() && first <= layout_.Rcs() &&
        layout_.Rcs() < first + measured[i].components)
      results[i] = {not_computed(), not_computed(), not_computed(), not_computed()};
  }
}

void BatchModel::set_pump(const PumpParameters& pump, const Assumptions& assumptions) {
  prepare(by_kernel(pump), assumptions, *pump_);
  if (pump.geometry.pistons != layout_.pistons() || pump.transfer.kind != layout_.transfer())
    layout_ = ChannelLayout(pump);
}

PumpBatch::PumpBatch(const std::vector<PumpParameters>& pumps, const Assumptions& assumptions)
    : layout_(pumps.empty() ? ChannelLayout(1) : ChannelLayout(by_kernel(pumps.front()))),
      size_(pumps.size()) {
  if (pumps.empty()) throw InputError("batch of pumps: empty");
  numbers_.resize(kNumbers * size_);
  for (std::size_t i = 0; i < size_; ++i) {
    if (pumps[i].geometry.pistons != layout_.pistons())
      throw InputError("batch of pumps: pump " + std::to_string(i + 1) + " has " +
                       std::to_string(pumps[i].geometry.pistons) + " pistons, the first has " +
                       std::to_string(layout_.pistons()));
    PreparedPump pump = prepare(by_kernel(pumps[i]), assumptions);
    double numbers[kNumbers];
    std::memcpy(numbers, &pump.numbers, sizeof numbers);
    for (std::size_t n = 0; n < kNumbers; ++n) numbers_[n * size_ + i] = numbers[n];
    if (i == 0) {
      common_ = std::make_unique<PreparedPump>(std::move(pump));
    } else {
      common_->friction.smooth |= pump.friction.smooth;
      common_->friction.dry |= pump.friction.dry;
    }
  }
}
PumpBatch::~PumpBatch() = default;
PumpBatch::PumpBatch(PumpBatch&&) noexcept = default;
PumpBatch& PumpBatch::operator=(PumpBatch&&) noexcept = default;

void PumpBatch::reactions(const BatchInstants& instants, const BatchOutputs& outputs,
                          const BatchOptions& options) const {
  if (instants.count != size_)
    throw InputError("batch of pumps: " + std::to_string(instants.count) + " instants for " +
                     std::to_string(size_) + " pumps");
  run_job(*common_, numbers_.data(), layout_, instants, outputs, options);
}

}  // namespace bentaxis::analytic
