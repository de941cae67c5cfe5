// The problem pendulum with MuJoCo: mujoco_pendulum pendulum FOLDER OUT.csv, or --version
//
// FOLDER is problems/pendulum, whose pendulum.xml is the model. The speed follows from MuJoCo's
// energies, the acceleration from mj_forward, the reaction from mj_rnePostConstraint: cfrc_int is
// what the parent exerts on the body, moment before force, about the centre of mass of the whole
// tree, in the axes of the world.
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

constexpr double kStartSpeedRpm = 190;  // speed_at_bottom_rpm of problem.toml
constexpr double kPi = 3.14159265358979323846;

double energy(const mjModel* model, mjData* data, double angle, double speed) {
  data->qpos[0] = angle;
  data->qvel[0] = speed;
  mj_forward(model, data);  // with energies: the model enables them
  return data->energy[0] + data->energy[1];
}

int run(const std::string& folder, const std::string& out) {
  char error[1000] = "";
  mjModel* model = mj_loadXML((folder + "/pendulum.xml").c_str(), nullptr, error, sizeof error);
  if (model == nullptr) {
    std::fprintf(stderr, "mujoco_pendulum: %s\n", error);
    return 3;
  }
  mjData* data = mj_makeData(model);
  std::FILE* file = std::fopen(out.c_str(), "w");
  if (file == nullptr) {
    std::fprintf(stderr, "mujoco_pendulum: cannot write %s\n", out.c_str());
    return 2;
  }
  std::fputs("theta_deg,omega_rad_per_s,F_x0_N,F_y0_N,M_x0_Nm,M_y0_Nm\n", file);
  const double total = energy(model, data, 0, kStartSpeedRpm * kPi / 30);
  for (int degree = 0; degree < 360; ++degree) {
    const double theta = degree * kPi / 180;
    const double rest = energy(model, data, theta, 0), unit = energy(model, data, theta, 1);
    const double speed = std::sqrt((total - rest) / (unit - rest));
    energy(model, data, theta, speed);
    mj_rnePostConstraint(model, data);
    const double* wrench = data->cfrc_int + 6;  // of the first body behind the world
    const double* about = data->subtree_com + 3;
    const double* force = wrench + 3;
    const double x = wrench[0] + about[1] * force[2] - about[2] * force[1];
    const double y = wrench[1] + about[2] * force[0] - about[0] * force[2];
    std::fprintf(file, "%d,%.17g,%.17g,%.17g,%.17g,%.17g\n", degree, speed, force[0], force[1], x,
                 y);
  }
  const bool written = std::fclose(file) == 0;
  mj_deleteData(data);
  mj_deleteModel(model);
  return written ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--version") {
    std::printf("MuJoCo %s\n", mj_versionString());
    return 0;
  }
  if (argc != 4 || std::string(argv[1]) != "pendulum") {
    std::fputs("usage: mujoco_pendulum pendulum FOLDER OUT.csv\n", stderr);
    return 2;
  }
  return run(argv[2], argv[3]);
}
