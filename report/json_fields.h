// JSON of typed data: what nlohmann's library does not know by itself.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

// A type whose JSON is an object of these members, by their names. Numbers that are not finite
// become null when it is written.
#define BENTAXIS_JSON(Type, ...)                                                      \
  inline void to_json(nlohmann::json& nlohmann_json_j, const Type& nlohmann_json_t) { \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__))          \
  }

// The same, behind them those of `Given`, a list in brackets, in which there is something: put().
#define BENTAXIS_JSON_GIVEN(Type, Given, ...)                                              \
  inline void to_json(nlohmann::json& nlohmann_json_j, const Type& nlohmann_json_t) {      \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__))               \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(BENTAXIS_JSON_PUT, BENTAXIS_JSON_LIST Given)) \
  }
#define BENTAXIS_JSON_PUT(member) put(nlohmann_json_j, #member, nlohmann_json_t.member);
#define BENTAXIS_JSON_LIST(...) __VA_ARGS__

namespace nlohmann {

/// What is not there is null.
template <class Value>
struct adl_serializer<std::optional<Value>> {
  static void to_json(json& json, const std::optional<Value>& value) {
    json = nullptr;
    if (value) json = *value;
  }
};

}  // namespace nlohmann

namespace bentaxis::report {

/// A member of an object where there is something to say: a value that is there, text that is not
/// empty, items, a yes.
template <class Value>
void put(nlohmann::json& json, const char* key, const std::optional<Value>& value) {
  if (value) json[key] = *value;
}
template <class Items>
void put(nlohmann::json& json, const char* key, const Items& items) requires requires {
  items.empty();
}
{
  if (!items.empty()) json[key] = items;
}
inline void put(nlohmann::json& json, const char* key, bool flag) {
  if (flag) json[key] = true;
}

}  // namespace bentaxis::report
