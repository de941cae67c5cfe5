// Words and numbers of a call, and what is asked of what an object keeps.
#pragma once

#include <functional>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/run.h"

namespace bentaxis::python {

/// @throws InputError
inline study::Model model_called(const std::string& name) {
  for (const study::Model model : study::kModels)
    if (study::to_string(model) == name) return model;
  throw InputError("model " + name + ": must be analytic or multibody");
}

/// A number of a call, by the name of its argument. @throws InputError where it is out of its range
inline void require_in(const char* name, double value, double low, double high) {
  const NumberRange range{low, high};
  if (!range.contains(value))
    throw InputError(std::string(name) + " = " + number_text(value) + ": must be " + range.text());
}

/// A property of an object of Python's: a member of what the object keeps.
template <class Self, class Kept, class Member>
auto of(Kept Self::*kept, Member member) {
  return [kept, member](const Self& self) { return std::invoke(member, *(self.*kept)); };
}

}  // namespace bentaxis::python
