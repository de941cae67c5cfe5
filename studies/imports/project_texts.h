// The texts of study/project/, made by scripts/cmake/embed.cmake. Internal.
#pragma once

#include <map>
#include <string>

namespace bentaxis::study {

/// Files by their names.
const std::map<std::string, std::string>& project_texts();

inline const std::string& project_text(const std::string& name) { return project_texts().at(name); }

}  // namespace bentaxis::study
