// libFuzzer entry: see readers.h and docs/trust.md.
#include "readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bentaxis::fuzz::read_as_study(data, size);
  return 0;
}
