#include "ranks.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "bentaxis/pump/error.h"
#include "commands.h"
#include "launched_ranks.h"

#ifdef BENTAXIS_HAS_MPI
#include "bentaxis/files/module.h"
#include "mpi_module.h"
#endif

namespace bentaxis::cli {
namespace {

LaunchedRanks launched() {
  return launched_ranks([](const char* name) { return std::getenv(name); });
}

}  // namespace

#ifdef BENTAXIS_HAS_MPI

namespace {

// MPI is loaded in ranks alone: it brings eight libraries.
const MpiFunctions& mpi() {
  static const Module loaded(BENTAXIS_MPI_MODULE);
  return loaded.table<MpiFunctions>("kBentaxisMpi", "ranks");
}

[[noreturn]] void end_all(int rank, const char* why, int status) {
  // What is wrong with all ranks is said once: by the first, which ends the others before they do.
  std::signal(SIGTERM, SIG_DFL);
  if (rank > 0) std::this_thread::sleep_for(std::chrono::seconds(1));
  std::fprintf(stderr, "bentaxis: rank %d: %s\n", rank, why);
  std::fflush(stderr);
  mpi().end_all(status);
  std::abort();
}

}  // namespace

void Ranks::wait() const {
  if (size_ > 1) mpi().wait();
}

void Ranks::add_up(std::span<double> numbers) const {
  if (size_ > 1) mpi().add_up(numbers.data(), static_cast<int>(numbers.size()));
}

void Ranks::must_be_same(const std::string& text, const std::string& what) const {
  if (size_ == 1) return;
  std::string first = text;
  auto length = static_cast<int>(first.size());
  mpi().tell_length(&length);
  first.resize(static_cast<std::size_t>(length));
  mpi().tell_text(first.data(), length);
  if (first != text) throw InputError(what + " of this rank are not those of rank 0");
}

int in_ranks(const std::function<int(const Ranks&)>& job) {
  Ranks ranks;
  if (!launched().by_mpi) return job(ranks);  // starting MPI takes a while
  mpi().start(&ranks.rank_, &ranks.size_);
  try {
    const int status = job(ranks);
    mpi().finish();
    return status;
  } catch (const Interrupted& error) {
    end_all(ranks.rank_, error.what(), kInterrupted);
  } catch (const InputError& error) {
    end_all(ranks.rank_, error.what(), kBadInput);
  } catch (const std::exception& error) {
    end_all(ranks.rank_, error.what(), kComputationFailed);
  }
}

std::string mpi_library() { return BENTAXIS_HAS_MPI; }

#else

void Ranks::wait() const {}
void Ranks::add_up(std::span<double>) const {}
void Ranks::must_be_same(const std::string&, const std::string&) const {}

int in_ranks(const std::function<int(const Ranks&)>& job) {
  if (launched().several)
    throw InputError(
        "started as one of several ranks, but this program was built without MPI; install "
        "libopenmpi-dev (scripts/setup full) and build again, or take --part I/N");
  return job(Ranks());
}

std::string mpi_library() { return "none"; }

#endif

}  // namespace bentaxis::cli
