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
