// Whether what is to be computed fits into the memory that there is.
#pragma once

#include <filesystem>
#include <string>

namespace bentaxis::study {

/// Memory that this process can still get, bytes: the minimum of what the machine has available,
/// what its control group (a container, a batch job) leaves it, and what the limit of its address
/// space (ulimit -v) leaves. Infinite where nothing of this is known.
/// @param root  where the system's folders proc and sys are
double available_memory(const std::filesystem::path& root = "/");

/// @param needed     bytes, estimated
/// @param what       what takes them, and by which key or option: begins the message
/// @param advice     what to change; ends the message
/// @param available  bytes
/// @throws InputError where more is needed than is available
void require_memory(double needed, const std::string& what, const std::string& advice,
                    double available = available_memory());

}  // namespace bentaxis::study
