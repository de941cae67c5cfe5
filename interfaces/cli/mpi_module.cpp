#include "mpi_module.h"

#include <mpi.h>

namespace {

void start(int* rank, int* size) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, rank);
  MPI_Comm_size(MPI_COMM_WORLD, size);
}
void finish() { MPI_Finalize(); }
void end_all(int status) { MPI_Abort(MPI_COMM_WORLD, status); }
void wait() { MPI_Barrier(MPI_COMM_WORLD); }
void add_up(double* numbers, int count) {
  MPI_Allreduce(MPI_IN_PLACE, numbers, count, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
}
void tell_length(int* length) { MPI_Bcast(length, 1, MPI_INT, 0, MPI_COMM_WORLD); }
void tell_text(char* text, int length) { MPI_Bcast(text, length, MPI_CHAR, 0, MPI_COMM_WORLD); }

}  // namespace

extern "C" {
const bentaxis::cli::MpiFunctions kBentaxisMpi = {start,  finish,      end_all,  wait,
                                                  add_up, tell_length, tell_text};
}
