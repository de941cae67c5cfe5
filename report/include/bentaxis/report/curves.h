// Curves of a report's page.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Copies of types with very many members take the compiler seconds in every source that handles
// them: the first declares them in a type, the second compiles them, in one source.
// NOLINTBEGIN(bugprone-macro-parentheses): a type has none
#define BENTAXIS_COMPILED_ONCE(Type)  \
  Type();                             \
  ~Type();                            \
  Type(const Type& other);            \
  Type(Type&& other) noexcept;        \
  Type& operator=(const Type& other); \
  Type& operator=(Type&& other) noexcept
#define BENTAXIS_COMPILED_HERE(Type)            \
  Type::Type() = default;                       \
  Type::~Type() = default;                      \
  Type::Type(const Type&) = default;            \
  Type::Type(Type&&) noexcept = default;        \
  Type& Type::operator=(const Type&) = default; \
  Type& Type::operator=(Type&&) noexcept = default;
// NOLINTEND(bugprone-macro-parentheses)

namespace bentaxis::report {

/// Values of a curve; what was not computed (pump/number.h) becomes null.
using Values = std::vector<double>;

/// Curves of both models under the names of the page's curves, with their difference.
struct Curves {
  struct Table {
    std::string name;  ///< of the model
    std::vector<std::pair<std::string, Values>> columns;
  };
  Values theta_deg;  ///< or what `axis` names
  std::vector<Table> tables;
  std::vector<std::pair<std::string, Values>> difference;  ///< second minus first table

  /// A curve from elsewhere, at the same angles, and what is allowed beside it.
  struct Held {
    std::string channel;
    Values values;
    double allowed = 0;  ///< on either side of the curve, or of the span of its values nearby:
    Values low, high;    ///< that span; empty where it is the curve itself
    std::vector<std::pair<std::string, Values>> differences = {};  ///< by table: table minus curve
  };
  /// The curves that the tables are held to.
  struct Reference {
    std::string name;
    std::vector<Held> held;
  };
  std::optional<Reference> reference = std::nullopt;

  std::string axis = {};  ///< where it is no shaft angle: "time (ms)"
  /// Something that happens at a place of the axis: a tick below the curves, those of `upper` in a
  /// row above the others.
  struct Mark {
    double x;
    bool upper;
  };
  std::vector<Mark> marks = {};
  std::size_t samples = 0;  ///< that there are, where only some of them are in the curves
  std::vector<std::size_t> rows = {};  ///< and which; empty: all
};

}  // namespace bentaxis::report
