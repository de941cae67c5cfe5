// The closed form for many instants, or many pumps, at a time: the same algebra as Model, several
// lanes per instruction, one contiguous array per result.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::analytic {

/// Instruction sets the kernel is compiled for; the processor decides at run time which can be
/// used. On processors other than x86-64, and with BENTAXIS_PORTABLE, there is `scalar` alone.
enum class InstructionSet {
  scalar,  ///< one lane, every processor
  sse2,    ///< 2 lanes, every x86-64 processor
  avx2,    ///< 4 lanes, with fused multiply-add
  avx512,  ///< 8 lanes (F, CD, DQ, BW)
};

std::string to_string(InstructionSet set);
/// Those this machine can run, widest last.
std::vector<InstructionSet> available_instruction_sets();
/// Lanes of double in one register.
std::size_t lanes(InstructionSet set);

/// One number per instant, or one for all.
struct Varying {
  const double* each = nullptr;  ///< an array, or null
  double all = 0;                ///< used where `each` is null
};

/// Motion of a block that is not locked to the shaft.
struct BlockMotion {
  Varying psi, omega, omega_dot;
};

/// Instants of a batch; SI, as in an Instant. Pressures are inputs: whoever calls has evaluated
/// them.
struct BatchInstants {
  std::size_t count = 0;
  Varying theta, omega, omega_dot;
  std::span<const Varying> chamber_pressure;  ///< one per piston
  Varying suction, delivery;                  ///< port pressures
  std::optional<BlockMotion> block = {};      ///< none: it is locked to the shaft
};

/// Where results go: one pointer per reaction in the order of ChannelLayout, to `count` doubles, or
/// null for a channel that is not asked for. Where only channels of pistons are asked for, block
/// and shaft are not solved. Longer, by the places of ChannelLayout: the couple Tcs of a joint as
/// well; no other derived channel is written. Nothing need be aligned; arrays must not overlap.
using BatchOutputs = std::vector<double*>;

/// How a batch is evaluated.
struct BatchOptions {
  InstructionSet instruction_set = available_instruction_sets().back();
  int threads = 1;  ///< 1: in the calling thread; more: as many threads of oneTBB at most
};

/// What statistics are of: a reaction, or the magnitude of a vector.
struct Measured {
  std::size_t reaction = 0;    ///< column of ChannelLayout; of a vector that of its first component
  std::size_t components = 1;  ///< of the vector, in columns one after the other; 1: the reaction
};

/// Over the instants of a batch.
struct Statistics {
  double mean = 0, min = 0, max = 0, mean_square = 0;
};

/// Columns of doubles that start on cache lines: results of a batch. Allocated once, used often;
/// moved, never copied: outputs point into it.
class BatchColumns {
 public:
  BatchColumns(std::size_t columns, std::size_t rows);

  std::size_t rows() const { return rows_; }
  double* column(std::size_t index) { return first_.get() + index * stride_; }
  const double* column(std::size_t index) const { return first_.get() + index * stride_; }

 private:
  struct Free {
    void operator()(double* first) const;
  };

  std::size_t rows_, stride_;
  std::unique_ptr<double[], Free> first_;
};

/// Which reactions to compute.
enum class ChannelGroup {
  pistons,   ///< Rs and Rc of every piston
  bearings,  ///< Rb1, Rb2 and Td
  all,
};

/// Pointers to the columns of a group of reactions, null for the others. `columns` has one column
/// per reaction.
BatchOutputs outputs_of(const ChannelLayout& layout, ChannelGroup group, BatchColumns& columns);

struct PreparedPump;

/// One pump, prepared for batches of instants. Immutable, so one object serves many threads.
class BatchModel {
 public:
  /// @throws InputError as Model, and where the contact is that of teeth
  BatchModel(const PumpParameters& pump, const Assumptions& assumptions);
  ~BatchModel();
  BatchModel(BatchModel&&) noexcept;
  BatchModel& operator=(BatchModel&&) noexcept;

  const ChannelLayout& layout() const { return layout_; }

  /// Reactions at every instant, equal to Model::reactions to round-off. Allocates nothing (with
  /// more than one thread oneTBB does). Rcs is not_computed() where the block speed is imposed.
  /// @throws InputError unless there is a pressure for each piston and an output for each reaction
  void reactions(const BatchInstants& instants, const BatchOutputs& outputs,
                 const BatchOptions& options = {}) const;

  /// Statistics of reactions() over the instants, without its columns: equal to round-off, and bit
  /// for bit for any number of threads. Once a thread has measured as much it allocates nothing
  /// (with more than one thread it does).
  /// @param results  one per entry of `measured`; not_computed() of Rcs where the block speed is
  ///                 imposed
  /// @throws InputError unless there are an instant, a pressure for each piston and a result for
  ///         each of `measured`, and all of these are reactions
  void statistics(const BatchInstants& instants, std::span<const Measured> measured,
                  std::span<Statistics> results, const BatchOptions& options = {}) const;

  /// Becomes another pump. Allocates nothing where that has as many pistons.
  /// @throws InputError as the constructor; the object may then only be given another pump
  void set_pump(const PumpParameters& pump, const Assumptions& assumptions);

 private:
  ChannelLayout layout_;
  std::unique_ptr<PreparedPump> pump_;
};

/// Many pumps with equal numbers of pistons, each at an instant of its own: instant i belongs to
/// pump i. For sweeps, tolerances and fits. Immutable.
class PumpBatch {
 public:
  /// @throws InputError if there is no pump, if numbers of pistons differ, or as
  ///         BatchModel
  PumpBatch(const std::vector<PumpParameters>& pumps, const Assumptions& assumptions);
  ~PumpBatch();
  PumpBatch(PumpBatch&&) noexcept;
  PumpBatch& operator=(PumpBatch&&) noexcept;

  const ChannelLayout& layout() const { return layout_; }
  std::size_t size() const { return size_; }

  /// As BatchModel::reactions; `instants.count` must be size(). @throws InputError
  void reactions(const BatchInstants& instants, const BatchOutputs& outputs,
                 const BatchOptions& options = {}) const;

 private:
  ChannelLayout layout_;
  std::size_t size_;
  std::unique_ptr<PreparedPump> common_;  // what the pumps share
  std::vector<double> numbers_;           // one array of size_ per number of a pump
};

}  // namespace bentaxis::analytic
