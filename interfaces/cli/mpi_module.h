// What is used of MPI, by the module that is linked with it: all ranks of the run.
#pragma once

namespace bentaxis::cli {

struct MpiFunctions {
  void (*start)(int* rank, int* size);  ///< the thread that starts MPI is the only one to call it
  void (*finish)();
  void (*end_all)(int status);
  void (*wait)();
  void (*add_up)(double* numbers, int count);
  void (*tell_length)(int* length);           ///< that of rank 0
  void (*tell_text)(char* text, int length);  ///< that of rank 0
};

}  // namespace bentaxis::cli

extern "C" {
extern const bentaxis::cli::MpiFunctions kBentaxisMpi;
}
