// Words for the choices of a call.
#pragma once

#include <optional>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/run.h"

namespace bentaxis::python {

/// @throws InputError
inline study::Model model_called(const std::string& name) {
  for (const study::Model model : study::kModels)
    if (study::to_string(model) == name) return model;
  throw InputError("model " + name + ": must be analytic or multibody");
}

}  // namespace bentaxis::python
