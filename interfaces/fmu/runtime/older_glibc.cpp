// The library of an FMU runs with glibc 2.28 and newer. It is linked on a system with a newer one,
// whose functions have newer versions. The linker sends calls of these functions to the functions
// here (--wrap). They call the oldest version, which computes numbers by the same algorithm, or do
// themselves what glibc 2.28 cannot.
#include <dlfcn.h>
#include <link.h>
#include <pthread.h>
#include <sched.h>
#include <sys/stat.h>

#include <cerrno>

#ifdef __x86_64__
#define BENTAXIS_OLDEST "GLIBC_2.2.5"
constexpr int kStatVersion = 1;
#else
#define BENTAXIS_OLDEST "GLIBC_2.17"  // of 64-bit ARM
constexpr int kStatVersion = 0;
#endif

// Names are the linker's, parameters those of the functions; addresses are the loader's integers.

// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming)
// NOLINTBEGIN(readability-non-const-parameter, performance-no-int-to-ptr)
extern "C" {

#define BENTAXIS_OLDEST_OF(name) asm(".symver oldest_" #name "," #name "@" BENTAXIS_OLDEST)
BENTAXIS_OLDEST_OF(exp);
BENTAXIS_OLDEST_OF(exp2);
BENTAXIS_OLDEST_OF(log);
BENTAXIS_OLDEST_OF(log2);
BENTAXIS_OLDEST_OF(pow);
BENTAXIS_OLDEST_OF(hypot);
BENTAXIS_OLDEST_OF(__xstat);
BENTAXIS_OLDEST_OF(__fxstat);
double oldest_exp(double x);
double oldest_exp2(double x);
double oldest_log(double x);
double oldest_log2(double x);
double oldest_pow(double x, double y);
double oldest_hypot(double x, double y);
int oldest___xstat(int version, const char* file, struct stat* facts);
int oldest___fxstat(int version, int handle, struct stat* facts);

double __wrap_exp(double x) { return oldest_exp(x); }
double __wrap_exp2(double x) { return oldest_exp2(x); }
double __wrap_log(double x) { return oldest_log(x); }
double __wrap_log2(double x) { return oldest_log2(x); }
double __wrap_pow(double x, double y) { return oldest_pow(x, y); }
double __wrap_hypot(double x, double y) { return oldest_hypot(x, y); }
int __wrap_stat(const char* file, struct stat* facts) {
  return oldest___xstat(kStatVersion, file, facts);
}
int __wrap_fstat(int handle, struct stat* facts) {
  return oldest___fxstat(kStatVersion, handle, facts);
}

// Of glibc 2.32: counters of references are then changed without locks. 0 is always right.
char __wrap___libc_single_threaded = 0;

// Its address alone counts: whether there may be threads.
int __wrap___pthread_key_create(pthread_key_t* /*key*/, void (* /*destroy*/)(void*)) {
  return ENOSYS;
}

// In glibc 2.28 a function of libpthread, which a simulator need not have.
int __wrap_pthread_once(pthread_once_t* once, void (*routine)()) {
  enum { kNever = PTHREAD_ONCE_INIT, kRunning, kDone };
  for (int state = kNever; !__atomic_compare_exchange_n(once, &state, kRunning, false,
                                                        __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE);
       state = kNever) {
    if (state == kDone) return 0;
    sched_yield();
  }
  try {
    routine();
  } catch (...) {  // the next call tries again
    __atomic_store_n(once, kNever, __ATOMIC_RELEASE);
    throw;
  }
  __atomic_store_n(once, kDone, __ATOMIC_RELEASE);
  return 0;
}

// Of glibc 2.35: where exceptions find the tables of the code that they pass.
int __wrap__dl_find_object(void* address, dl_find_object* result) {
  struct Search {
    ElfW(Addr) address;
    dl_find_object* result;
  } search{reinterpret_cast<ElfW(Addr)>(address), result};
  const auto look = [](dl_phdr_info* object, std::size_t /*size*/, void* data) {
    const Search& wanted = *static_cast<Search*>(data);
    bool inside = false;
    ElfW(Addr) tables = 0;
    for (int i = 0; i < object->dlpi_phnum; ++i) {
      const ElfW(Phdr)& part = object->dlpi_phdr[i];
      const ElfW(Addr) begin = object->dlpi_addr + part.p_vaddr;
      if (part.p_type == PT_GNU_EH_FRAME) tables = begin;
      if (part.p_type != PT_LOAD || wanted.address < begin ||
          wanted.address >= begin + part.p_memsz)
        continue;
      inside = true;
      wanted.result->dlfo_map_start = reinterpret_cast<void*>(begin);
      wanted.result->dlfo_map_end = reinterpret_cast<void*>(begin + part.p_memsz);
    }
    if (inside) wanted.result->dlfo_eh_frame = reinterpret_cast<void*>(tables);
    return static_cast<int>(inside && tables != 0);
  };
  return dl_iterate_phdr(look, &search) == 1 ? 0 : -1;
}

}  // extern "C"
// NOLINTEND(readability-non-const-parameter, performance-no-int-to-ptr)
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)
