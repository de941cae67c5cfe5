// An exception that leaves an FMU.
#include <stdexcept>

extern "C" void throw_exception() { throw std::runtime_error("no level of oil"); }
