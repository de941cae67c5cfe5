#include "bentaxis/report/scene.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <utility>

#include "base64.h"
#include "bentaxis/report/document.h"
#include "json_fields.h"

namespace bentaxis {

inline void to_json(nlohmann::json& json, ForceKind kind) {
  constexpr const char* kNames[] = {"reaction", "applied", "inertia"};
  json = kNames[static_cast<std::size_t>(kind)];
}

}  // namespace bentaxis

namespace bentaxis::report {

using Json = nlohmann::json;

inline void to_json(Json& json, Look look) {
  constexpr const char* kNames[] = {"shaft",   "piston", "block",   "plate", "delivery",
                                    "suction", "gear",   "bearing", "pin",   "axis"};
  json = kNames[static_cast<std::size_t>(look)];
}

inline void to_json(Json& json, const Scalar& scalar) {
  json = scalar.constant;
  if (scalar.factor == 0) return;
  Json source = scalar.channel;
  if (scalar.series) source = *scalar.series;
  json = Json::array({scalar.constant, scalar.factor, source});
}

inline void to_json(Json& json, const Vector& vector) {
  json = Json::array();
  for (const auto& [axis, by] : vector.terms)
    json.push_back(Json::array({axis[0], axis[1], axis[2], by}));
}

inline void to_json(Json& json, const Place& place) {
  json = {{"at", place.at}};
  put(json, "body", place.body);
}

BENTAXIS_JSON(SceneSum, body, force_over_sum, moment_over_sum)

namespace {

std::string base64_floats(const Values& values) {
  std::string bytes;
  for (const double value : values) {  // what was not computed stays NaN
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>((bits >> (8 * byte)) & 0xFF);
  }
  return base64_of(std::move(bytes));
}

// One alone stands for all models.
template <class Item>
Json per_model(const std::vector<Item>& items) {
  const Json list = items;
  bool alike = !list.empty();
  for (const Json& one : list) alike = alike && one == list.front();
  return alike ? Json::array({list.front()}) : list;
}

// Shapes are drawn in floats.
Json drawn(double x) { return rounded(x, 7); }
template <class List>
Json drawn(const List& items) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(drawn(item));
  return list;
}
Json flat(const std::vector<report::Point>& points) {
  Json list = Json::array();
  for (const report::Point& point : points)
    for (const double x : point) list.push_back(drawn(x));
  return list;
}

void put_form(Json& json, const Lathe& lathe) { json["lathe"] = drawn(lathe.profile); }
void put_form(Json& json, const Prism& prism) {
  json["prism"] = {{"outline", drawn(prism.outline)},
                   {"z", {drawn(prism.z_low), drawn(prism.z_high)}}};
  if (!prism.holes.empty()) json["prism"]["holes"] = drawn(prism.holes);
}
void put_form(Json& json, const Ball& ball) {
  json["ball"] = {{"centre", drawn(ball.centre)}, {"radius", drawn(ball.radius)}};
}
void put_form(Json& json, const Mesh& mesh) {
  Json corners = Json::array();
  for (const auto& triangle : mesh.triangles)
    for (const std::size_t corner : triangle) corners.push_back(corner);
  json["mesh"] = {{"points", flat(mesh.points)}, {"triangles", std::move(corners)}};
}
void put_form(Json& json, const Wire& wire) {
  json["wire"] = {{"points", flat(wire.points)}};
  put(json["wire"], "closed", wire.closed);
}

void put_motion(Json&, const Standing&) {}
void put_motion(Json& json, const Turning& turning) { json["turns"] = turning.angle; }
void put_motion(Json& json, const Between& between) {
  json["from"] = between.from;
  json["to"] = between.to;
}

}  // namespace

inline void to_json(Json& json, const Shape& shape) {
  json = {{"look", shape.look}};
  put(json, "see_through", shape.see_through);
  put(json, "tint", shape.tint);
  std::visit([&](const auto& form) { put_form(json, form); }, shape.form);
}

inline void to_json(Json& json, const SceneBody& body) {
  json = {
      {"name", body.name}, {"origin", body.origin}, {"axes", body.axes}, {"shapes", body.shapes}};
  std::visit([&](const auto& motion) { put_motion(json, motion); }, body.motion);
}

inline void to_json(Json& json, const SceneLoad& load) {
  json = {{"id", load.id},       {"label", load.label},     {"group", load.group},
          {"kind", load.kind},   {"on", load.on},           {"by", load.by},
          {"point", load.point}, {"at", per_model(load.at)}};
  put(json, "frame", load.frame);
  put(json, "axes", load.axes);
  if (!load.force.empty()) json["force"] = per_model(load.force);
  if (!load.moment.empty()) json["moment"] = per_model(load.moment);
  put(json, "counterpart", load.counterpart);
}

BENTAXIS_COMPILED_HERE(Scene)

std::string compact_json(const Scene& scene) {
  Json json = {{"models", scene.models},  {"rows", scene.rows},     {"series", Json::array()},
               {"bodies", scene.bodies},  {"loads", scene.loads},   {"sums", scene.sums},
               {"frames", Json::array()}, {"centre", scene.centre}, {"radius", scene.radius},
               {"note", scene.note}};
  for (const Values& series : scene.series) json["series"].push_back(base64_floats(series));
  for (const auto& [name, axes] : scene.frames)
    json["frames"].push_back({{"name", name}, {"axes", axes}});
  put(json, "film_point", scene.film_point);
  put(json, "film_path", scene.film_path);
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  // The curves in the format of their own block, behind the rest.
  if (scene.curves)
    text.replace(text.size() - 1, 1, ",\"curves\":" + packed_json(*scene.curves) + "}");
  return text;
}

}  // namespace bentaxis::report
