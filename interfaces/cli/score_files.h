// A score as text, as JSON and as a badge.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/study/problem.h"

namespace bentaxis::cli {

/// A line per column, the mistakes, the gaps, the verdict.
std::string score_text(const study::Problem& problem, const study::Score& score);
/// docs/problems.md says what is in it. @param file  that was scored
std::string score_json(const study::Problem& problem, const study::Score& score,
                       const std::string& file);
/// An SVG picture of a line's height: name of the problem, verdict and digits.
std::string score_badge(const study::Problem& problem, const study::Score& score);

/// A line per problem, and the same as JSON.
std::string problems_text(const std::vector<study::Problem>& problems);
std::string problems_json(const std::vector<study::Problem>& problems);

}  // namespace bentaxis::cli
