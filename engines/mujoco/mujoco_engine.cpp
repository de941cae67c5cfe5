// MuJoCo (Todorov, Erez, Tassa 2012) as an engine: docs/engines.md has its traps.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "closed_tree.h"

namespace bentaxis::engines {
namespace {

using Vector = Eigen::Vector3d;

std::string words(const double* values, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{}{:.17g}", i == 0 ? "" : " ", values[i]);
  return text;
}

// A body with its freedoms, and those whose parent it is.
std::string body_text(const bentaxis_engine_task& task, int body) {
  const Eigen::Quaterniond turn(Eigen::Map<const Eigen::Matrix3d>(task.axes + 9 * body));
  const double quaternion[] = {turn.w(), turn.x(), turn.y(), turn.z()};
  // The compiler refuses a body without mass or inertia: make_tree() puts the true values in.
  std::string text = fmt::format(
      R"(<body pos="{}" quat="{}"><inertial pos="{}" mass="1" diaginertia="1 1 1"/>)",
      words(task.place + 3 * body, 3), words(quaternion, 4), words(task.centre + 3 * body, 3));
  for (int i = 0; i < task.freedoms; ++i)
    if (task.freedom_body[i] == body)
      text += fmt::format(R"(<joint type="{}" axis="{}"/>)",
                          task.freedom_turns[i] != 0 ? "hinge" : "slide",
                          words(task.freedom_axis + 3 * i, 3));
  for (int child = body + 1; child < task.bodies; ++child)
    if (task.parent[child] == body) text += body_text(task, child);
  return text + "</body>";
}

mjModel* load(const bentaxis_engine_task& task) {
  std::string bodies;
  for (int body = 0; body < task.bodies; ++body)
    if (task.parent[body] < 0) bodies += body_text(task, body);
  const std::string text =
      R"(<mujoco><compiler angle="radian" inertiafromgeom="false"/><worldbody>)" + bodies +
      "</worldbody></mujoco>";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), "pump.xml", static_cast<int>(text.size())) != 0)
    throw std::runtime_error("MuJoCo takes no file from memory");
  std::memcpy(files->filedata[0], text.data(), text.size());
  char why[160] = "";
  mjModel* model = mj_loadXML("pump.xml", files.get(), why, sizeof why);
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(why);
  return model;
}

class MujocoTree : public Tree {
 public:
  explicit MujocoTree(const bentaxis_engine_task& task)
      : task_(task), model_(load(task)), data_(mj_makeData(model_)) {
    // Depth first, which is our order as long as grandchildren follow their parents at once.
    for (int body = 0; body < task.bodies; ++body)
      if (model_->body_parentid[body + 1] != task.parent[body] + 1)
        throw std::runtime_error("bodies must stand in the order of a depth-first walk");
    for (int body = 0; body < task.bodies; ++body) {
      model_->body_mass[body + 1] = task.mass[body];
      std::copy_n(task.inertia + 3 * body, 3, model_->body_inertia + 3 * (body + 1));
    }
  }
  ~MujocoTree() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  MujocoTree(const MujocoTree&) = delete;
  MujocoTree& operator=(const MujocoTree&) = delete;

  std::string text() const override {
    return fmt::format("MuJoCo {}, mj_rnePostConstraint", mj_versionString());
  }

  void set(const double* position, const double* velocity, const double* acceleration,
           bool moves) override {
    std::copy_n(position, model_->nq, data_->qpos);
    for (int i = 0; i < model_->nv; ++i) {
      data_->qvel[i] = moves ? velocity[i] : 0;
      data_->qacc[i] = moves ? acceleration[i] : 0;
    }
    for (int i = 0; i < 3; ++i) model_->opt.gravity[i] = moves ? task_.gravity[i] : 0;
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_comVel(model_, data_);
  }

  void joint_wrenches(const Wrenches& loads, Wrenches& joints) override {
    for (int body = 0; body < task_.bodies; ++body) {
      // Applied at the centre of mass, force first; the answer has the moment first and is about
      // the centre of mass of the whole tree that the body is in.
      const Vector centre = vector(data_->xipos, body + 1);
      Eigen::Map<Eigen::Matrix<double, 6, 1>> applied(data_->xfrc_applied + 6 * (body + 1));
      applied << loads.col(body).head<3>(),
          loads.col(body).tail<3>() - centre.cross(Vector(loads.col(body).head<3>()));
    }
    mj_rnePostConstraint(model_, data_);
    for (int body = 0; body < task_.bodies; ++body) {
      const double* found = data_->cfrc_int + 6 * (body + 1);
      const Vector moment = Eigen::Map<const Vector>(found);
      const Vector force = Eigen::Map<const Vector>(found + 3);
      const Vector about = vector(data_->subtree_com, model_->body_rootid[body + 1]);
      joints.col(body) << force, moment + about.cross(force);
    }
  }

 private:
  static Vector vector(const double* values, int index) {
    return Eigen::Map<const Vector>(values + 3 * index);
  }

  const bentaxis_engine_task& task_;
  mjModel* model_;
  mjData* data_;
};

}  // namespace

std::unique_ptr<Tree> make_tree(const bentaxis_engine_task& task) {
  // By itself it writes both to a file in the working folder. Nothing can be thrown through it.
  mju_user_warning = [](const char*) {};
  mju_user_error = [](const char* text) {
    std::fputs(text, stderr);
    std::exit(1);
  };
  return std::make_unique<MujocoTree>(task);
}

}  // namespace bentaxis::engines
