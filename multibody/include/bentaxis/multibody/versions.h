// What the multibody model is built on.
#pragma once

#include <string>

namespace bentaxis::multibody {

std::string simbody_version();
/// File name of the BLAS library that Simbody's linear algebra uses in this process.
std::string blas_library();

}  // namespace bentaxis::multibody
