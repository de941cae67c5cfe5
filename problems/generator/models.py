#!/usr/bin/env python3
"""Writes problems in the formats of other programs, from their data: models.py [--check].

pendulum.urdf, and as MJCF: pendulum.xml, spherical_four_bar.xml, universal_joint.xml, piston.xml. Closed loops are `connect`
elements there, which MuJoCo keeps by a soft constraint. docs/problems.md says why the others cannot be written so.
"""
import math
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


def si(name):
    """[data] in SI, by keys with their units."""
    factors = {"_kg_mm2": 1e-6, "_mm": 1e-3, "_deg": math.pi / 180, "_rpm": math.pi / 30}
    data = {}
    for key, value in settings_of(name)["data"].items():
        factor = next((f for ending, f in factors.items() if key.endswith(ending)), 1)
        data[key] = [float(v) * factor for v in value] if isinstance(value, list) else float(value) * factor
    return data


def cross(u, v):
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def dot(u, v):
    return sum(a * b for a, b in zip(u, v))


def words(numbers):
    return " ".join(repr(number) for number in numbers)


def axes(x, y, z):
    """Orientation with these axes, as MJCF's xyaxes; z only says that they are a right-handed set."""
    assert abs(dot(cross(x, y), z) - 1) < 1e-12
    return words([*x, *y])


def spherical(name):
    """At joint angles 0 the input is at theta = 0."""
    d = si(name)
    joint = name == "universal_joint"
    A, B, C = (math.pi / 2 if joint else d[f"{link}_arc_deg"] for link in ("input", "coupler", "output"))
    s, c = math.sin(d["tilt_deg"]), math.cos(d["tilt_deg"])
    x2, y2, z2 = [1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]
    a = [0.0, math.sin(A), math.cos(A)]
    along = math.acos((math.cos(B) - math.cos(C) * dot(a, z2)) / (math.sin(C) * math.hypot(dot(a, x2), dot(a, y2))))
    wanted = math.pi / 2 if joint else d["assembly_psi_deg"]
    turn = math.atan2(dot(a, x2), dot(a, y2))
    psi = min((-turn + along, -turn - along), key=lambda angle: abs(math.remainder(angle - wanted, 2 * math.pi)))

    def in_plane(angle, first, second):
        return [math.cos(angle) * u + math.sin(angle) * v for u, v in zip(first, second)]

    x_out, y_out = in_plane(psi, x2, y2), in_plane(psi + math.pi / 2, x2, y2)
    b = [math.sin(C) * v + math.cos(C) * w for v, w in zip(y_out, z2)]
    normal = cross(a, b)
    size = math.sqrt(dot(normal, normal))
    normal = [n / size for n in normal]
    across = cross(normal, a)
    anchor = [0.1 * math.cos(B), 0.1 * math.sin(B), 0.0]
    return f"""<mujoco model="{name}">
  <!-- {name} of the problem set (problem.md), at theta = 0. Written by generator/models.py. Not in here: the constant speed of
       the input, whose inertia is any, and the constant load, -{d['load_torque_Nm']!r} Nm on the joint "output". -->
  <compiler angle="radian"/>
  <option gravity="0 0 0" timestep="1e-5" integrator="RK4"/>
  <worldbody>
    <body name="input">
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <joint name="input" type="hinge" axis="0 0 1"/>
      <body name="coupler" xyaxes="{axes(a, across, normal)}">
        <inertial pos="0 0 0" mass="1" diaginertia="{words(d['coupler_inertia_kg_mm2'])}"/>
        <joint name="a" type="hinge" axis="1 0 0"/>
      </body>
    </body>
    <body name="output" xyaxes="{axes(x_out, y_out, z2)}">
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 {d['output_inertia_kg_mm2']!r}"/>
      <joint name="output" type="hinge" axis="0 0 1" damping="{d['load_damping_Nm_s_per_rad']!r}"/>
    </body>
  </worldbody>
  <equality>
    <connect name="b" body1="coupler" body2="output" anchor="{words(anchor)}"/>
  </equality>
</mujoco>
"""


def piston():
    """At joint coordinates 0 the shaft is at theta = 0; x is across the plane of A, B and both axes."""
    d = si("piston")
    s, c = math.sin(d["tilt_deg"]), math.cos(d["tilt_deg"])
    radius, bore, length = d["joint_circle_radius_mm"], d["bore_circle_radius_mm"], d["piston_length_mm"]
    # A in the block's frame, B on the axis of the bore.
    y, z = c * radius + s * d["axis_offset_mm"], s * radius - c * d["axis_offset_mm"]
    rise = math.sqrt(length**2 - (bore - y) ** 2)
    sine, cosine = -(bore - y) / length, rise / length  # of the turn about x that makes z the piston's axis
    return f"""<mujoco model="piston">
  <!-- piston of the problem set (problem.md), at theta = 0. Written by generator/models.py. Not in here: the constant speeds of
       shaft and block, whose inertia is any, the spin at the start and the pressure, which depends on the angle. -->
  <compiler angle="radian"/>
  <option gravity="0 {-d['gravity_m_per_s2']!r} 0" timestep="1e-6" integrator="RK4"/>
  <worldbody>
    <body name="shaft">
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <joint name="shaft" type="hinge" axis="0 0 1"/>
    </body>
    <body name="block" pos="0 0 {d['axis_offset_mm']!r}" xyaxes="1 0 0 0 {c!r} {-s!r}">
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <joint name="block" type="hinge" axis="0 0 1"/>
      <body name="piston" pos="0 {bore!r} {z + rise!r}" xyaxes="1 0 0 0 {cosine!r} {sine!r}">
        <inertial pos="0 0 {d['centre_of_mass_mm'] - length!r}" mass="{d['mass_kg']!r}"
                  diaginertia="{words([d['transverse_inertia_kg_mm2']] * 2 + [d['axial_inertia_kg_mm2']])}"/>
        <joint name="slide" type="slide" axis="0 {sine!r} {cosine!r}" damping="{d['viscous_friction_N_s_per_m']!r}"/>
        <joint name="tilt x" type="hinge" axis="1 0 0"/>
        <joint name="tilt y" type="hinge" axis="0 1 0"/>
        <joint name="spin" type="hinge" axis="0 0 1"/>
      </body>
    </body>
  </worldbody>
  <equality>
    <connect name="A" body1="piston" body2="shaft" anchor="0 0 {-length!r}"/>
  </equality>
</mujoco>
"""


def main():
    differs = []
    models = {f"pendulum/{name}": text for name, text in pendulum().items()}
    models |= {f"{name}/{name}.xml": spherical(name) for name in ("spherical_four_bar", "universal_joint")}
    models["piston/piston.xml"] = piston()
    for name, text in models.items():
        path = FOLDER / name
        if "--check" not in sys.argv:
            path.write_text(text)
        elif path.read_text() != text:
            differs.append(str(path))
    if differs:
        sys.exit("not as models.py writes them: " + ", ".join(differs))


if __name__ == "__main__":
    main()
