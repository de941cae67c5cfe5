// Boost.Math in double precision alone.
#pragma once

#include <boost/math/policies/policy.hpp>

namespace bentaxis::designs {

/// Without it Boost.Math evaluates functions of a double in long double, and tries them before
/// main() begins with numbers that a double has no room for. Where long double is no wider than
/// double (valgrind emulates it so), the program would end there.
using PlainDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace bentaxis::designs
