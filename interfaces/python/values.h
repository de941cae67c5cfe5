// Values between Python and the program, and the names of their types in docstrings.
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/registry.h"

namespace bentaxis::python {

// Arguments that may be of several types.
// NOLINTBEGIN(bugprone-macro-parentheses): the name of a class
#define BENTAXIS_ARGUMENT(name)                          \
  class name : public pybind11::object {                 \
    static bool any(PyObject*) { return true; }          \
                                                         \
   public:                                               \
    PYBIND11_OBJECT_DEFAULT(name, pybind11::object, any) \
  }
BENTAXIS_ARGUMENT(Texts);       ///< a text, a list of them, or None
BENTAXIS_ARGUMENT(CaseValue);   ///< of a parameter
BENTAXIS_ARGUMENT(CaseValues);  ///< by key, or None
BENTAXIS_ARGUMENT(Paths);       ///< a path or a list of them
BENTAXIS_ARGUMENT(Motion);      ///< a path, or arrays by name
BENTAXIS_ARGUMENT(Variations);  ///< values by parameter
BENTAXIS_ARGUMENT(Bounds);      ///< lowest and highest by parameter, or None
BENTAXIS_ARGUMENT(DataFrame);
#undef BENTAXIS_ARGUMENT
// NOLINTEND(bugprone-macro-parentheses)

/// A text alone is a list of one, None an empty list. @throws InputError
std::vector<std::string> texts_of(const pybind11::handle& texts, const std::string& what);
/// Likewise of paths.
std::vector<std::string> paths_of(const pybind11::handle& paths, const std::string& what);
/// A value as a case file has it: TOML. @throws InputError
std::string toml_of(const pybind11::handle& value, const std::string& what);
/// Items of a mapping; none of None. @throws InputError
std::vector<std::pair<std::string, pybind11::object>> items_of(const pybind11::handle& mapping,
                                                               const std::string& what);
/// Values of a parameter that varies, as a command line has them: "20:40:5", or those of a list
/// with commas between them.
std::string values_text(const std::string& name, const pybind11::handle& values);
pybind11::object python_of(const Value& value);

}  // namespace bentaxis::python

namespace pybind11::detail {
#define BENTAXIS_TYPE_NAME(type, words)             \
  template <>                                       \
  struct handle_type_name<bentaxis::python::type> { \
    static constexpr auto name = const_name(words); \
  }
BENTAXIS_TYPE_NAME(Texts, "Union[str, Sequence[str], None]");
BENTAXIS_TYPE_NAME(CaseValue, "CaseValue");
BENTAXIS_TYPE_NAME(CaseValues, "Optional[Mapping[str, CaseValue]]");
BENTAXIS_TYPE_NAME(Paths, "Union[PathLike, Sequence[PathLike]]");
BENTAXIS_TYPE_NAME(Motion, "Union[PathLike, Mapping[str, ArrayLike]]");
BENTAXIS_TYPE_NAME(Variations,
                   "Mapping[str, Union[str, float, bool, Sequence[CaseValue], ArrayLike]]");
BENTAXIS_TYPE_NAME(Bounds, "Optional[Mapping[str, Tuple[float, float]]]");
BENTAXIS_TYPE_NAME(DataFrame, "pandas.DataFrame");
#undef BENTAXIS_TYPE_NAME
}  // namespace pybind11::detail
