// Text: the comparison in words, for a terminal; any text, for markup.
#pragma once

#include <string>

#include "bentaxis/compare/comparison.h"

namespace bentaxis::report {

/// The comparison as a plain-text table, one line per scale group, worst first.
std::string text_table(const compare::Comparison& comparison);

/// As HTML, XML and SVG take it, between quotes too. Control characters become blanks.
std::string escaped_markup(const std::string& text);

}  // namespace bentaxis::report
