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
#include <mpi.h>
#endif

namespace bentaxis::cli {
namespace {

LaunchedRanks launched() {
  return launched_ranks([](const char* name) { return std::getenv(name); });
}

}  // namespace

#ifdef BENTAXIS_HAS_MPI

namespace {

[[noreturn]] void end_all(int rank, const char* why, int status) {
  // What is wrong with all ranks is said once: by the first, which ends the others before they do.
  std::signal(SIGTERM, SIG_DFL);
  if (rank > 0) std::this_thread::sleep_for(std::chrono::seconds(1));
  std::fprintf(stderr, "bentaxis: rank %d: %s\n", rank, why);
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, status);
  std::abort();
}

}  // namespace

void Ranks::wait() const {
  if (size_ > 1) MPI_Barrier(MPI_COMM_WORLD);
}

void Ranks::add_up(std::span<double> numbers) const {
  if (size_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE,
                  MPI_SUM, MPI_COMM_WORLD);
}

void Ranks::must_be_same(const std::string& text, const std::string& what) const {
  if (size_ == 1) return;
  std::string first = text;
  auto length = static_cast<int>(first.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD);
  first.resize(static_cast<std::size_t>(length));
  MPI_Bcast(first.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
  if (first != text) throw InputError(what + " of this rank are not those of rank 0");
}

int in_ranks(const std::function<int(const Ranks&)>& job) {
  Ranks ranks;
  if (!launched().by_mpi) return job(ranks);  // starting MPI takes a while
  int provided = 0;  // the thread that starts MPI is the only one to call it
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.size_);
  try {
    const int status = job(ranks);
    MPI_Finalize();
    return status;
  } catch (const Interrupted& error) {
    end_all(ranks.rank_, error.what(), kInterrupted);
  } catch (const InputError& error) {
    end_all(ranks.rank_, error.what(), kBadInput);
  } catch (const std::exception& error) {
    end_all(ranks.rank_, error.what(), kComputationFailed);
  }
}

std::string mpi_library() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING] = "";
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string name = text;
  return name.substr(0, name.find_first_of(",\n"));
}

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
