#!/usr/bin/env python3
"""Writes pendulum.urdf and pendulum.xml (MJCF) of the problem pendulum, from its data: models.py [--check].

The other problems have closed loops, spins, flanks or one-sided contacts, which these formats cannot state exactly.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "programs"))
from problem_data import FOLDER, settings_of  # noqa: E402


def pendulum():
    d = {key: float(value) for key, value in settings_of("pendulum")["data"].items()}
    x, z = d["centre_x_mm"] / 1000, d["centre_z_mm"] / 1000
    xx, yy, zz, xz = (d[key] / 1e6 for key in ("inertia_x_kg_mm2", "inertia_y_kg_mm2", "axial_inertia_kg_mm2", "product_xz_kg_mm2"))
    urdf = f"""<?xml version="1.0"?>
<!-- Physical pendulum of the problem set (problem.md): y of the base points upwards, gravity is {d['gravity_m_per_s2']} m/s2 along -y. Written by
     generator/models.py. At joint angle 0 the pendulum's x axis points along -y of the base. -->
<robot name="pendulum">
  <link name="base"/>
  <link name="pendulum">
    <inertial>
      <origin xyz="{x!r} 0 {z!r}" rpy="0 0 0"/>
      <mass value="{d['mass_kg']!r}"/>
      <inertia ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="0" ixz="{xz!r}" iyz="0"/>
    </inertial>
  </link>
  <joint name="bearing" type="continuous">
    <origin xyz="0 0 0" rpy="0 0 -1.5707963267948966"/>
    <parent link="base"/>
    <child link="pendulum"/>
    <axis xyz="0 0 1"/>
  </joint>
</robot>
"""
    mjcf = f"""<mujoco model="pendulum">
  <!-- Physical pendulum of the problem set (problem.md). Written by generator/models.py. -->
  <option gravity="0 -{d['gravity_m_per_s2']!r} 0" timestep="1e-4" integrator="RK4">
    <flag energy="enable"/>
  </option>
  <worldbody>
    <body name="pendulum" euler="0 0 -90">
      <joint name="bearing" type="hinge" axis="0 0 1"/>
      <inertial pos="{x!r} 0 {z!r}" mass="{d['mass_kg']!r}" fullinertia="{xx!r} {yy!r} {zz!r} 0 {xz!r} 0"/>
    </body>
  </worldbody>
</mujoco>
"""
    return {"pendulum.urdf": urdf, "pendulum.xml": mjcf}


def main():
    differs = []
    for name, text in pendulum().items():
        path = FOLDER / "pendulum" / name
        if "--check" not in sys.argv:
            path.write_text(text)
        elif path.read_text() != text:
            differs.append(str(path))
    if differs:
        sys.exit("not as models.py writes them: " + ", ".join(differs))


if __name__ == "__main__":
    main()
