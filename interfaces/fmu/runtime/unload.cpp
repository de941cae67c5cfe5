// What is left when a unit's library is unloaded. The C++ library that is joined to it keeps memory
// for exceptions when there is none left, and gives it back only if it is asked to.

// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming): libstdc++'s own name
namespace __gnu_cxx {
void __freeres();
}
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)

namespace {
[[gnu::destructor]] void give_back() { __gnu_cxx::__freeres(); }
}  // namespace
