// MuJoCo (Todorov, Erez, Tassa 2012) as an engine: docs/engines.md has its traps.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
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
  // The compiler refuses a body without mass or inertia: Model puts the true values in.
  std::string text = fmt::format(
      R"(<body name="b{}" pos="{}" quat="{}"><inertial pos="{}" mass="1" diaginertia="1 1 1"/>)",
      body, words(task.place + 3 * body, 3), words(quaternion, 4),
      words(task.centre + 3 * body, 3));
  for (int i = 0; i < task.freedoms; ++i)
    if (task.freedom_body[i] == body)
      text += fmt::format(R"(<joint type="{}" axis="{}"/>)",
                          task.freedom_turns[i] != 0 ? "hinge" : "slide",
                          words(task.freedom_axis + 3 * i, 3));
  for (int child = body + 1; child < task.bodies; ++child)
    if (task.parent[child] == body) text += body_text(task, child);
  return text + "</body>";
}

// Everything that MuJoCo has of a task. `more`: elements beside the bodies.
struct Model {
  mjModel* model;
  mjData* data;

  explicit Model(const bentaxis_engine_task& task, const std::string& more = "") {
    std::string bodies;
    for (int body = 0; body < task.bodies; ++body)
      if (task.parent[body] < 0) bodies += body_text(task, body);
    const std::string text =
        R"(<mujoco><compiler angle="radian" inertiafromgeom="false"/><worldbody>)" + bodies +
        "</worldbody>" + more + "</mujoco>";
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    if (mj_makeEmptyFileVFS(files.get(), "pump.xml", static_cast<int>(text.size())) != 0)
      throw std::runtime_error("MuJoCo takes no file from memory");
    std::memcpy(files->filedata[0], text.data(), text.size());
    char why[160] = "";
    model = mj_loadXML("pump.xml", files.get(), why, sizeof why);
    mj_deleteVFS(files.get());
    if (model == nullptr) throw std::runtime_error(why);
    data = mj_makeData(model);
    // Depth first, which is our order as long as grandchildren follow their parents at once.
    for (int body = 0; body < task.bodies; ++body)
      if (model->body_parentid[body + 1] != task.parent[body] + 1)
        throw std::runtime_error("bodies must stand in the order of a depth-first walk");
    for (int body = 0; body < task.bodies; ++body) {
      model->body_mass[body + 1] = task.mass[body];
      std::copy_n(task.inertia + 3 * body, 3, model->body_inertia + 3 * (body + 1));
    }
  }
  ~Model() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
};

// Loads at the centre of mass, force first.
void apply(const Eigen::Ref<const Wrenches>& loads, mjData* data) {
  for (Eigen::Index body = 0; body < loads.cols(); ++body) {
    const Vector force = loads.col(body).head<3>(), moment = loads.col(body).tail<3>();
    const Vector centre = Eigen::Map<const Vector>(data->xipos + 3 * (body + 1));
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(data->xfrc_applied + 6 * (body + 1)) << force,
        moment - centre.cross(force);
  }
}

class MujocoTree : public Tree {
 public:
  explicit MujocoTree(const bentaxis_engine_task& task)
      : task_(task), all_(task), model_(all_.model), data_(all_.data) {}

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
    // The answer has the moment first and is about the centre of mass of the whole tree that the
    // body is in.
    apply(loads, data_);
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
  Model all_;
  mjModel* model_;
  mjData* data_;
};

// A `connect` for each loop; an armature that no load can slow down holds the speed of what is
// driven.
class MujocoIntegration;
const MujocoIntegration* integrated = nullptr;  // a callback has no argument of its own

class MujocoIntegration : public Integration {
 public:
  MujocoIntegration(const bentaxis_engine_task& task, const Settings& settings)
      : task_(task),
        settings_(settings.text()),
        all_(task, elements(task, settings)),
        model_(all_.model),
        data_(all_.data) {
    for (int i = 0; i < task.freedoms; ++i)
      if (task.freedom_driven[i] != 0) model_->dof_armature[i] = kArmature;
    mj_setConst(model_, data_);  // what the solver takes from masses and inertias
    for (int loop = 0; loop < task.loops; ++loop) {
      double* points = model_->eq_data + static_cast<long>(mjNEQDATA) * loop;
      std::copy_n(task.loop_point_on + 3 * loop, 3, points);
      std::copy_n(task.loop_point_by + 3 * loop, 3, points + 3);
    }
    std::copy_n(task.position, model_->nq, data_->qpos);
    std::copy_n(task.velocity, model_->nv, data_->qvel);
    integrated = this;
    mjcb_passive = [](const mjModel*, mjData* data) { integrated->load(data); };
  }
  ~MujocoIntegration() override { mjcb_passive = nullptr; }

  std::string text() const override {
    return fmt::format("MuJoCo {}, connect, {}", mj_versionString(), settings_);
  }

  void step(int, Moment* begin) override {
    if (begin != nullptr) {
      mj_forward(model_, data_);
      const auto values = [&](const double* from) {
        return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(from, task_.freedoms));
      };
      begin->position = values(data_->qpos);
      begin->velocity = values(data_->qvel);
      begin->acceleration = values(data_->qacc);
      begin->loop_force = Eigen::Map<const Eigen::Matrix3Xd>(data_->efc_force, 3, task_.loops);
    }
    mj_step(model_, data_);
  }

 private:
  static constexpr double kArmature = 1e9;  // kg m2

  static std::string elements(const bentaxis_engine_task& task, const Settings& settings) {
    const double step = 2 * task.interval;
    const double impedance = settings.number("impedance");
    const std::string connect =
        fmt::format(R"(solref="{:.17g} 1" solimp="{:.17g} {:.17g} 0.001 0.5 2")",
                    settings.number("time_constant") * step, impedance, impedance);
    std::string text = fmt::format(
        R"(<option timestep="{:.17g}" integrator="{}" solver="{}" iterations="{:g}" )"
        R"(tolerance="1e-14" gravity="{}"><flag contact="disable" refsafe="disable"/></option>)",
        step, settings.word("integrator"), settings.word("solver"), settings.number("iterations"),
        words(task.gravity, 3));
    text += "<equality>";
    for (int loop = 0; loop < task.loops; ++loop)
      text += fmt::format(R"(<connect body1="b{}" body2="b{}" anchor="0 0 0" {}/>)",
                          task.loop_on[loop], task.loop_by[loop], connect);
    return text + "</equality>";
  }

  // Loads at the instant of a stage.
  void load(mjData* data) const {
    const auto sample =
        std::min<Eigen::Index>(std::lround(data->time / task_.interval), task_.samples - 1);
    apply(Eigen::Map<const Wrenches>(task_.loads + 6 * sample * task_.bodies, 6, task_.bodies),
          data);
  }

  const bentaxis_engine_task& task_;
  std::string settings_;
  Model all_;
  mjModel* model_;
  mjData* data_;
};

// By itself MuJoCo writes both to a file in the working folder. Nothing can be thrown through it.
void redirect_messages() {
  mju_user_warning = [](const char*) {};
  mju_user_error = [](const char* text) {
    std::fputs(text, stderr);
    std::exit(1);
  };
}

}  // namespace

std::unique_ptr<Tree> make_tree(const bentaxis_engine_task& task) {
  redirect_messages();
  return std::make_unique<MujocoTree>(task);
}

// Time constant of `solref` in steps, impedance of `solimp`.
std::string known_settings() {
  return "integrator=RK4,Euler,implicit time_constant=2,1,3,5;0.01..1000 "
         "impedance=0.9999,0.999,0.99,0.9;0.0001..0.9999 "  // others MuJoCo replaces by these
         "solver=Newton,CG,PGS iterations=2,1,20;1..100000;integer";
}

std::unique_ptr<Integration> make_integration(const bentaxis_engine_task& task,
                                              const Settings& settings) {
  redirect_messages();
  return std::make_unique<MujocoIntegration>(task, settings);
}

}  // namespace bentaxis::engines
