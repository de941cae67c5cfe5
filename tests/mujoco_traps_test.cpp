// What MuJoCo does otherwise than one may expect, each pinned by a mechanism of one or two bodies
// (docs/engines.md). SI units, moments in Nm.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

namespace {

using Vector = Eigen::Vector3d;

struct Scene {
  explicit Scene(const std::string& text, bool must_load = true) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(text.size()));
    std::memcpy(files->filedata[0], text.data(), text.size());
    char why[200] = "";
    model = mj_loadXML("scene.xml", files.get(), why, sizeof why);
    mj_deleteVFS(files.get());
    error = why;
    if (must_load && model == nullptr) throw std::runtime_error(error);
    if (model != nullptr) data = mj_makeData(model);
  }
  ~Scene() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  mjModel* model = nullptr;
  mjData* data = nullptr;
  std::string error;
};

Vector three(const double* values) { return Eigen::Map<const Vector>(values); }

// Two rods of 1 kg on each other's hinges about y, along x, held at rest: weight 10 N each.
const char* const kTwoRods = R"(<mujoco><option gravity="0 0 -10"/><worldbody>
  <body><inertial pos="0.5 0 0" mass="1" diaginertia="1 1 1"/><joint axis="0 1 0"/>
    <body pos="1 0 0"><inertial pos="0.5 0 0" mass="1" diaginertia="1 1 1"/><joint axis="0 1 0"/></body>
  </body></worldbody></mujoco>)";

// cfrc_int has the moment first and is about the centre of mass of the whole tree, not about the
// joint and not about the body's own centre of mass.
TEST(MujocoTraps, JointForcesAreAboutTheCentreOfMassOfTheTree) {
  const Scene scene(kTwoRods);
  mj_kinematics(scene.model, scene.data);
  mj_comPos(scene.model, scene.data);
  mj_comVel(scene.model, scene.data);
  mj_rnePostConstraint(scene.model, scene.data);
  const double* outer = scene.data->cfrc_int + 6 * 2;
  EXPECT_NEAR(outer[5], 10, 1e-12);  // up, by the inner rod
  // At its hinge, x = 1, the joint carries 5 Nm about -y. About the tree's centre, which is that
  // hinge's place here, x = 1, the same; of the inner rod's joint, at x = 0, another.
  EXPECT_NEAR(three(outer).y(), -5, 1e-12);
  const double* inner = scene.data->cfrc_int + 6 * 1;
  EXPECT_NEAR(inner[5], 20, 1e-12);
  EXPECT_NEAR(three(inner).y(), 0, 1e-12);  // at its hinge it is -20 Nm
  const Vector about = three(scene.data->subtree_com + 3 * scene.model->body_rootid[1]);
  EXPECT_NEAR(about.x(), 1, 1e-12);
  EXPECT_NEAR((three(inner) + about.cross(three(inner + 3))).y(), -20, 1e-12);
}

// xfrc_applied has the force first and acts at the body's centre of mass.
TEST(MujocoTraps, AppliedForcesHaveTheForceFirst) {
  const Scene scene(kTwoRods);
  scene.data->xfrc_applied[6 * 2 + 2] = 7;
  mj_kinematics(scene.model, scene.data);
  mj_comPos(scene.model, scene.data);
  mj_comVel(scene.model, scene.data);
  mj_rnePostConstraint(scene.model, scene.data);
  EXPECT_NEAR(scene.data->cfrc_int[6 * 2 + 5], 10 - 7, 1e-12);
}

// A rod between two hinges of the world, one of them a `connect`. At rest in its place the inverse
// dynamics says that the loop carries nothing: a soft constraint's force comes of its violation.
TEST(MujocoTraps, InverseDynamicsAtExactMotionHasNoLoopForces) {
  const Scene scene(R"(<mujoco><option gravity="0 0 -10"/><worldbody>
    <body name="rod"><inertial pos="0.5 0 0" mass="1" diaginertia="1 1 1"/><joint axis="0 1 0"/></body>
    </worldbody><equality><connect body1="rod" anchor="1 0 0"/></equality></mujoco>)");
  mj_inverse(scene.model, scene.data);
  ASSERT_EQ(scene.data->nefc, 3);
  EXPECT_NEAR(scene.data->efc_force[2], 0, 1e-9);      // statics: 5 N
  EXPECT_NEAR(scene.data->qfrc_inverse[0], -5, 1e-9);  // as if there were no loop
}

// Forward dynamics of the same: the force is that of a soft constraint, wrong by the share that
// `solimp` leaves open, however small the step.
TEST(MujocoTraps, LoopForcesOfForwardDynamicsAreSoft) {
  for (const double impedance : {0.9, 0.99, 0.9999}) {
    const std::string value = std::to_string(impedance);
    const Scene scene(R"(<mujoco><option gravity="0 0 -10" tolerance="1e-14"/><worldbody>
      <body name="rod"><inertial pos="0.5 0 0" mass="1" diaginertia="1 1 1"/><joint axis="0 1 0"/></body>
      </worldbody><equality><connect body1="rod" anchor="1 0 0" solimp=")" +
                      value + " " + value + R"( 0.001 0.5 2"/></equality></mujoco>)");
    mj_forward(scene.model, scene.data);
    // Softness over what the rod's inertia gives: MuJoCo takes a twelfth of the latter here.
    const double softness = (1 - impedance) / impedance / 12;
    EXPECT_NEAR(scene.data->efc_force[2] / 5, 1 / (1 + softness), 1e-6 * softness) << impedance;
  }
}

// The impedance is cut at 0.9999, whatever is asked for.
TEST(MujocoTraps, ConstraintsCannotBeMadeHard) {
  double force[2] = {};
  int i = 0;
  for (const char* value : {"0.9999", "0.9999999"}) {
    const Scene scene(
        std::string(R"(<mujoco><option gravity="0 0 -10" tolerance="1e-14"/><worldbody>
      <body name="rod"><inertial pos="0.5 0 0" mass="1" diaginertia="1 1 1"/><joint axis="0 1 0"/></body>
      </worldbody><equality><connect body1="rod" anchor="1 0 0" solimp=")") +
        value + " " + value + R"( 0.001 0.5 2"/></equality></mujoco>)");
    mj_forward(scene.model, scene.data);
    force[i++] = scene.data->efc_force[2];
  }
  EXPECT_EQ(force[0], force[1]);
}

// A rod without inertia about its axis, as a lumped piston is, does not compile; the true value can
// be put in afterwards.
TEST(MujocoTraps, ABodyNeedsInertiaAboutEveryAxis) {
  const Scene refused(
      R"(<mujoco><worldbody><body><inertial pos="0 0 1" mass="1" diaginertia="1 1 0"/>
    <joint axis="0 1 0"/></body></worldbody></mujoco>)",
      false);
  EXPECT_EQ(refused.model, nullptr);
  EXPECT_NE(refused.error.find("inertia"), std::string::npos) << refused.error;
}

// The MJCF files of the problem set (docs/problems.md): MuJoCo takes the point of the second body
// from where the bodies are at the start, so that it says whether the loop is closed there.
TEST(ProblemsInMjcf, LoopsAreClosedAtTheStart) {
  const double output_arc = 65 * M_PI / 180;
  const struct {
    const char* name;
    Vector on_second;
  } models[] = {{"spherical_four_bar", {0, 0.1 * std::sin(output_arc), 0.1 * std::cos(output_arc)}},
                {"universal_joint", {0, 0.1, 0}},
                {"piston", {0, 0.035, 0}}};
  for (const auto& [name, on_second] : models) {
    const std::string file =
        std::string(BENTAXIS_SOURCE_DIR "/problems/") + name + "/" + name + ".xml";
    char why[200] = "";
    mjModel* model = mj_loadXML(file.c_str(), nullptr, why, sizeof why);
    ASSERT_NE(model, nullptr) << why;
    EXPECT_EQ(model->neq, 1) << name;
    EXPECT_LT((three(model->eq_data + 3) - on_second).norm(), 1e-15) << name;
    mj_deleteModel(model);
  }
}

}  // namespace
