"""The problems in closed form: one function a problem, from data in SI and a value of its grid to its columns.

`wrong` names a known mistake, which is then made; what it means is said in problem.toml. The second derivation, by
Lagrange multipliers, shares no line with this one: programs/multiplier_models.py.
"""
import sys
from pathlib import Path

import numpy as np
from mpmath import mp, mpf

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "reference_data" / "generator"))


def vec(*components):
    return np.array([mpf(c) for c in components], dtype=object)


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dtype=object)


def rad(degrees):
    return mp.pi * degrees.numerator / (180 * mpf(degrees.denominator))


def named(stem, axes, vector, unit):
    return {f"{stem}_{axis}_{unit}": component for axis, component in zip(axes, vector)}


X, Y, Z = vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)


def tilted(tilt):
    """x2, y2, z2 in S1: z2 is z1 turned about x1 towards +y1."""
    c, s = mp.cos(tilt), mp.sin(tilt)
    return X, vec(0, c, -s), vec(0, s, c)


def bearings(z_1, z_2, force, moment):
    """A shaft along z under a force and a moment about its origin: the bearing at z_1 (x, y, z), that at z_2 (x, y),
    and the torque that balances the moment along z."""
    second_x = (z_1 * force[0] - moment[1]) / (z_2 - z_1)
    second_y = (z_1 * force[1] + moment[0]) / (z_2 - z_1)
    return vec(-force[0] - second_x, -force[1] - second_y, -force[2]), vec(second_x, second_y, 0), -moment[2]


# ---------------------------------------------------------------------------------------------------------------------
def pendulum(d, x, wrong=""):
    t, l, h = rad(x), d.centre_x, d.centre_z
    product = d.product_xz - d.mass * l * h  # about O
    if wrong == "product_about_centre":
        product = d.product_xz
    about_O = d.axial_inertia + d.mass * l * l
    weight_arm = d.mass * d.gravity * l
    square = d.speed_at_bottom**2 - 2 * weight_arm * (1 - mp.cos(t)) / about_O
    alpha = -weight_arm * mp.sin(t) / about_O
    x1, y1 = vec(mp.sin(t), -mp.cos(t), 0), vec(mp.cos(t), mp.sin(t), 0)
    weight = -d.mass * d.gravity * Y
    acceleration = l * (alpha * y1 - square * x1)
    if wrong == "no_centripetal":
        acceleration = l * alpha * y1
    force = d.mass * acceleration - (0 if wrong == "no_weight" else weight)
    change = product * alpha * x1 + (0 if wrong == "no_gyroscopic" else product * square * y1)
    if wrong == "no_gyroscopic_at_centre":
        change = change - d.product_xz * square * y1
    centre = l * x1 + h * Z
    moment = change - cross(centre, weight)
    if wrong == "about_centre":
        moment = moment - cross(centre, force)
    if wrong == "body_frame":
        force, moment = vec(force.dot(x1), force.dot(y1), 0), vec(moment.dot(x1), moment.dot(y1), 0)
    return {"omega_rad_per_s": mp.sqrt(square), **named("F", ("x0", "y0"), force, "N"), **named("M", ("x0", "y0"), moment, "Nm")}


# ---------------------------------------------------------------------------------------------------------------------
def spherical(d, x, wrong=""):
    """Three links about one point: input about z0, output about z2, between them the coupler with the axes a and b."""
    t, w = rad(x), d.speed
    x2, y2, z2 = tilted(d.tilt)
    s1, c1, s3, c3 = mp.sin(d.input_arc), mp.cos(d.input_arc), mp.sin(d.output_arc), mp.cos(d.output_arc)
    a, a_t, a_tt = (vec(-s1 * mp.sin(t), s1 * mp.cos(t), c1), vec(-s1 * mp.cos(t), -s1 * mp.sin(t), 0), vec(s1 * mp.sin(t), -s1 * mp.cos(t), 0))
    ax, ay, az = a.dot(x2), a.dot(y2), a.dot(z2)
    side = -1 if wrong == "other_assembly" else 1
    psi = -mp.atan2(ax, ay) + side * mp.acos((mp.cos(d.coupler_arc) - c3 * az) / (s3 * mp.hypot(ax, ay)))
    b, b_p, b_pp = (s3 * (-mp.sin(psi) * x2 + mp.cos(psi) * y2) + c3 * z2, s3 * (-mp.cos(psi) * x2 - mp.sin(psi) * y2),
                    s3 * (mp.sin(psi) * x2 - mp.cos(psi) * y2))
    slope = -a_t.dot(b) / a.dot(b_p)
    second = -(a_tt.dot(b) + 2 * slope * a_t.dot(b_p) + slope**2 * a.dot(b_pp)) / a.dot(b_p)
    rate, acceleration = slope * w, second * w * w
    a_v, b_v, b_a = a_t * w, b_p * rate, b_p * acceleration + b_pp * rate**2
    normal = cross(a, b)
    normal_v = cross(a_v, b) + cross(a, b_v)
    turn = (b_v - w * cross(Z, b)).dot(normal) / normal.dot(normal)  # of the coupler on the input link, about a
    turn_v = (b_a - w * cross(Z, b_v) - turn * normal_v).dot(normal) / normal.dot(normal)
    omega, alpha = w * Z + turn * a, turn_v * a + turn * a_v
    e1, e3 = a, normal / mp.sqrt(normal.dot(normal))
    e2 = cross(e3, e1)
    inertia = d.coupler_inertia
    if wrong == "axes_exchanged":
        inertia = [inertia[1], inertia[0], inertia[2]]
    H = sum(i * omega.dot(e) * e for i, e in zip(inertia, (e1, e2, e3)))
    change = sum(i * alpha.dot(e) * e for i, e in zip(inertia, (e1, e2, e3)))
    change = change + (0 if wrong == "no_gyroscopic" else cross(omega, H))
    if wrong == "massless_coupler":
        change = vec(0, 0, 0)
    load = -d.load_torque - d.load_damping * rate
    twist = load - (0 if wrong == "no_output_inertia" else d.output_inertia) * acceleration  # M_b . z2
    along_a, base = change.dot(a), b.dot(cross(z2, a))
    Mb = (twist * cross(a, b) + along_a * cross(b, z2)) / base
    Ma = change - Mb
    drive = Ma[2]
    if wrong == "constant_ratio":
        drive = -load
    if wrong == "output_frame":
        Ma, Mb = (vec(m.dot(x2), m.dot(y2), m.dot(z2)) for m in (Ma, Mb))
    middle = getattr(d, "assembly_psi", mpf(0))
    psi -= 2 * mp.pi * mp.nint((psi - middle) / (2 * mp.pi))
    return {"psi_deg": psi * 180 / mp.pi, "psi_rate_rad_per_s": rate, **named("Ma", ("x0", "y0", "z0"), Ma, "Nm"),
            **named("Mb", ("x0", "y0", "z0"), Mb, "Nm"), "Td_z0_Nm": drive}


def spherical_four_bar(d, x, wrong=""):
    return spherical(d, x, wrong)


def universal_joint(d, x, wrong=""):
    d.input_arc = d.coupler_arc = d.output_arc = mp.pi / 2
    if wrong == "shafts_exchanged":  # the formula of the angle with input and output exchanged
        c, s = mp.cos(d.tilt), mp.sin(d.tilt)
        row = universal_joint(d, x)
        row["psi_rate_rad_per_s"] = d.speed * (1 - (s * mp.cos(rad(x)))**2) / c
        return row
    row = spherical(d, x, wrong)
    del row["psi_deg"]
    return row


# ---------------------------------------------------------------------------------------------------------------------
def piston_in_S2(d, t, pressure, real, wrong=""):
    """Rs and Rc of one piston in S2, and its joint A in S1: docs/theory.md, section 5."""
    c, s, sn, cs, w = mp.cos(d.tilt), mp.sin(d.tilt), mp.sin(t), mp.cos(t), d.speed
    Ra, Rd, b, b1 = d.joint_circle_radius, d.bore_circle_radius, d.axis_offset, d.piston_length
    if wrong == "offset_reversed":
        b = -b
    u, u_t = vec(-(Rd - Ra) * sn, (Rd - Ra * c) * cs - b * s, 0), vec(-(Rd - Ra) * cs, -(Rd - Ra * c) * sn, 0)
    u_tt = vec((Rd - Ra) * sn, -(Rd - Ra * c) * cs, 0)
    height = mp.sqrt(b1**2 - u.dot(u))
    height_t = -u.dot(u_t) / height
    height_tt = -(u_t.dot(u_t) + u.dot(u_tt) + height_t**2) / height
    e, e_t, e_tt = (u + height * Z) / b1, (u_t + height_t * Z) / b1, (u_tt + height_tt * Z) / b1
    A_tt = vec(Ra * sn, -Ra * c * cs, -Ra * s * cs)
    v_B = (-Ra * s * sn + height_t) * w
    s_G = d.centre_of_mass if real else (1 - d.joint_mass_fraction) * b1
    mass = 0 if wrong == "no_inertia" else d.mass
    It = d.transverse_inertia if real else d.joint_mass_fraction * (1 - d.joint_mass_fraction) * d.mass * b1**2
    if wrong in ("point_mass", "no_inertia"):
        It = 0
    Ia_spin = 0 if not real or wrong in ("no_gyroscopic", "no_inertia") else d.axial_inertia * d.spin
    a_G = (A_tt + s_G * e_tt) * w**2
    weight = vec(0, 0, 0) if wrong == "no_weight" else -d.mass * d.gravity * vec(0, c, s)
    friction = d.viscous_friction * v_B
    axial = -mp.pi / 4 * d.bore_diameter**2 * pressure - (-friction if wrong == "friction_reversed" else friction)
    change = It * cross(e, e_tt) * w**2 + Ia_spin * e_t * w - s_G * cross(e, weight - mass * a_G)
    across = cross(e, change) / b1
    at_B = (axial + across[2]) / e[2] * e - across
    Rs = mass * a_G - weight - at_B
    Rc = vec(at_B[0], at_B[1], 0)
    if wrong == "axial_only":  # a rod that carries along its axis only
        Rc = axial / e[2] * vec(e[0], e[1], 0)
        Rs = mass * a_G - weight - (Rc + axial * Z)
    return Rs, Rc, vec(-d.joint_circle_radius * sn, d.joint_circle_radius * cs, 0)


def piston(d, x, wrong=""):
    t = rad(x)
    pressure = d.pressure_mean - d.pressure_amplitude * mp.sin(t)
    Rs, Rc, _ = piston_in_S2(d, t, pressure, True, wrong)
    if wrong == "frame_S1":
        x2, y2, z2 = tilted(d.tilt)
        Rs, Rc = (v[0] * x2 + v[1] * y2 + v[2] * z2 for v in (Rs, Rc))
    return {**named("Rs", ("x2", "y2", "z2"), Rs, "N"), **named("Rc", ("x2", "y2"), Rc, "N")}


def piston_pair(d, x, wrong=""):
    axes = tilted(d.tilt)
    force, moment = -d.shaft_mass * d.gravity * Y, -d.shaft_mass * d.gravity * d.shaft_centre_z * cross(Z, Y)
    if wrong == "no_shaft_weight":
        force, moment = vec(0, 0, 0), vec(0, 0, 0)
    for k in range(1 if wrong == "one_piston" else 2):
        t = rad(x) + k * mp.pi
        angle = rad(x) if wrong == "pressures_in_phase" else t
        Rs, _, A = piston_in_S2(d, t, d.pressure_mean - d.pressure_amplitude * mp.sin(angle), False, wrong)
        on_shaft = -sum(c * axis for c, axis in zip(Rs, axes))
        if wrong == "not_turned":
            on_shaft = -Rs
        force, moment = force + on_shaft, moment + cross(A, on_shaft)
    z_1, z_2 = d.tapered_z, d.cylindrical_z
    if wrong == "about_O1":
        z_1 = mpf(0)
    Rb1, Rb2, torque = bearings(z_1, z_2, force, moment)
    if wrong == "bearings_exchanged":
        Rb1, Rb2, torque = bearings(z_2, z_1, force, moment)
    if wrong == "frame_S2":
        Rb1, Rb2 = (vec(*(v.dot(axis) for axis in axes)) for v in (Rb1, Rb2))
    return {**named("Rb1", ("x1", "y1", "z1"), Rb1, "N"), **named("Rb2", ("x1", "y1"), Rb2, "N"), "Td_z1_Nm": torque}


# ---------------------------------------------------------------------------------------------------------------------
def gear_pair(d, x, wrong=""):
    t = rad(x)
    tilt, z1, z2, L = d.shaft_angle, d.teeth_input, d.teeth_output, d.cone_distance
    cone = mp.atan2(mp.sin(tilt), z2 / z1 + mp.cos(tilt))  # half angle of the input gear's pitch cone
    r1, r2 = L * mp.sin(cone), L * mp.sin(tilt - cone)
    w = d.speed * (1 + d.speed_ripple * mp.cos(t))
    alpha = -w * d.speed * d.speed_ripple * mp.sin(t)
    alpha_2 = -alpha * z1 / z2
    load = d.load_torque * (1 + d.load_ripple * mp.sin(2 * t))
    angle = mpf(0) if wrong == "no_pressure_angle" else d.pressure_angle
    J2 = 0 if wrong == "no_output_inertia" else d.output_inertia
    F = (load - J2 * alpha_2) / (r2 * mp.cos(angle))
    if wrong == "cosine_twice":
        F = F * mp.cos(angle)
    apart = -mp.sin(angle) if wrong == "other_flank" else mp.sin(angle)
    k = vec(-mp.cos(angle), apart * mp.cos(cone), -apart * mp.sin(cone))
    P = vec(0, L * mp.sin(cone), L * mp.cos(cone))
    axes = tilted(tilt)
    in_2 = lambda v: vec(*(v.dot(axis) for axis in axes))  # noqa: E731
    W1, W2 = -d.input_mass * d.gravity * Y, in_2(-d.output_mass * d.gravity * Y)
    if wrong == "no_weight":
        W1, W2 = vec(0, 0, 0), vec(0, 0, 0)
    lever = P if wrong != "force_at_apex" else vec(0, 0, 0)
    on_1 = -F * k
    Rb1, Rb2, torque = bearings(d.input_bearing_z[0], d.input_bearing_z[1], on_1 + W1,
                                cross(lever, on_1) + d.input_centre_z * cross(Z, W1))
    on_2 = in_2(F * k)
    Rb3, Rb4, _ = bearings(d.output_bearing_z[0], d.output_bearing_z[1], on_2 + W2,
                           cross(in_2(lever), on_2) + d.output_centre_z * cross(Z, W2))
    torque = torque + d.input_inertia * alpha
    if wrong == "force_at_apex":
        torque = F * r1 * mp.cos(angle) + d.input_inertia * alpha
    if wrong == "frame_S1":
        Rb3, Rb4 = (sum(c * axis for c, axis in zip(v, axes)) for v in (Rb3, Rb4))
    return {"Rg_k_N": F, **named("Rb1", ("x1", "y1", "z1"), Rb1, "N"), **named("Rb2", ("x1", "y1"), Rb2, "N"),
            **named("Rb3", ("x2", "y2", "z2"), Rb3, "N"), **named("Rb4", ("x2", "y2"), Rb4, "N"), "Td_z1_Nm": torque}


# ---------------------------------------------------------------------------------------------------------------------
def slider_crank(d, t, wrong=""):
    """Kinematics of a slider crank: e along the rod with its derivatives, accelerations of rod and crosshead, and
    K = (moment that the rod's motion needs about the crank pin) / length."""
    r, l, s, w = d.crank_radius, d.rod_length, d.rod_centre, d.speed
    A = r * vec(mp.cos(t), mp.sin(t), 0)
    y, y_t, y_tt = -r * mp.sin(t) / l, -r * mp.cos(t) / l, r * mp.sin(t) / l
    h = mp.sqrt(1 - y * y)
    h_t = -y * y_t / h
    h_tt = -(y_t**2 + y * y_tt + h_t**2) / h
    e, e_tt = vec(h, y, 0), vec(h_tt, y_tt, 0)
    mass = 0 if wrong == "massless_rod" else d.rod_mass
    inertia = 0 if wrong in ("massless_rod", "rod_as_point") else d.rod_inertia
    rod = mass * (-A + s * e_tt) * w**2 + mass * d.gravity * Y  # inertia less weight
    K = (inertia * cross(e, e_tt)[2] * w**2 + s * cross(e, rod)[2]) / l
    return A, e, (-A[0] + l * h_tt) * w**2, -A[1] + l * h_t, rod, K


def one_sided_wall(d, x, wrong=""):
    t = rad(x)
    A, e, acceleration, _, rod, K = slider_crank(d, t, wrong)
    gas = -(d.gas_force + d.gas_amplitude * mp.sin(t))
    pin_x = d.crosshead_mass * acceleration - gas
    pin_y = (e[1] * pin_x - K) / e[0]
    weight = 0 if wrong == "no_weight" else d.crosshead_mass * d.gravity
    total = weight - pin_y
    tipping = -d.gas_offset * gas - d.crosshead_centre_x * weight
    if wrong == "centred_gas":
        tipping = -d.crosshead_centre_x * weight
    front, rear = d.front_pads_x, -d.rear_pads_x
    one, two = (rear * total - tipping) / (front + rear), (front * total + tipping) / (front + rear)
    if wrong == "moment_reversed":
        one, two = (rear * total + tipping) / (front + rear), (front * total - tipping) / (front + rear)
    if wrong == "halves":
        one = two = total / 2
    pads = [max(one, 0), max(-one, 0), max(two, 0), max(-two, 0)]
    if wrong == "two_sided":
        pads = [one, mpf(0), two, mpf(0)]
    if wrong == "upper_for_lower":
        pads = [pads[1], pads[0], pads[3], pads[2]]
    Q = vec(pin_x, pin_y, 0) + rod
    return {"L1_N": pads[0], "U1_N": pads[1], "L2_N": pads[2], "U2_N": pads[3], "Td_z_Nm": cross(A, Q)[2]}


def step_friction(d, x, wrong=""):
    t = rad(x)
    A, e, acceleration, slope, rod, K = slider_crank(d, t, wrong)
    gas = -(d.gas_force + d.gas_amplitude * mp.sin(t))
    direction = mp.sign(slope * d.speed)
    if wrong == "friction_reversed":
        direction = -direction
    if wrong == "smoothed":
        direction = mp.tanh(slope * d.speed / mpf("0.5"))
    mu = 0 if wrong == "no_friction" else d.friction_coefficient

    def with_friction(f):
        px = d.crosshead_mass * acceleration - gas - f
        py = (e[1] * px - K) / e[0]
        return px, py, d.crosshead_mass * d.gravity - py

    frictionless, slope_N = with_friction(mpf(0))[2], e[1] / e[0]
    sign = 1 if wrong == "signed_normal" else mp.sign(frictionless)
    f = -mu * direction * sign * frictionless / (1 + mu * direction * sign * slope_N)
    if wrong == "normal_without_friction":
        f = -mu * direction * abs(frictionless)
    px, py, N = with_friction(f)
    Q = vec(px, py, 0) + rod
    return {"N_y_N": N, "Ff_x_N": f, "P_x_N": px, "P_y_N": py, "Td_z_Nm": cross(A, Q)[2]}


# ---------------------------------------------------------------------------------------------------------------------
def impacts(d, xs, wrong=""):
    """Flights are straight lines, the walls move as sines: each impact is a root, found in the fixed frame."""
    amplitude, gap, mass, e = d.amplitude, d.gap / 2, d.mass, d.restitution
    w = d.speed
    wall = lambda phase, side: amplitude * mp.sin(phase) + side * gap  # noqa: E731
    phase, place, speed, sums, marks = mpf(0), d.start_position, d.start_speed, [mpf(0), mpf(0)], []
    last = rad(xs[-1])
    step = mp.pi / 720
    while phase <= last:
        hit, found = None, None
        ahead = phase
        while hit is None and ahead <= last:
            for side in (-1, 1):
                inside = lambda p, side=side: side * (wall(p, side) - place - speed * (p - phase) / w)  # noqa: E731
                if inside(ahead + step) < 0:
                    low = ahead if ahead > phase else phase + step / 10**6
                    hit, found = mp.findroot(inside, (low, ahead + step), solver="anderson", tol=mpf(10) ** (6 - 2 * mp.dps)), side
            ahead += step
        marks.append((phase, place, speed, list(sums)))
        if hit is None:
            break
        place, phase = place + speed * (hit - phase) / w, hit
        if len(marks) > 40:
            raise ValueError("impacts: the body comes to rest on a wall")
        wall_speed = amplitude * w * mp.cos(phase)
        after = (1 + e) * wall_speed - e * speed
        if wrong == "elastic":
            after = 2 * wall_speed - speed
        if wrong == "restitution_squared":
            after = wall_speed - e * e * (speed - wall_speed)
        impulse = mass * abs((wall_speed if wrong == "impulse_without_rebound" else after) - speed)
        sums[1 if wrong == "one_sum" else (found + 1) // 2] += impulse
        speed = after
    rows = []
    for x in xs:
        p = rad(x)
        at, place, speed, sums = [m for m in marks if m[0] <= p][-1]
        y = place + speed * (p - at) / w
        if wrong == "in_the_box":
            y, speed = y - amplitude * mp.sin(p), speed - amplitude * w * mp.cos(p)
        rows.append({"y_mm": y * 1000, "v_m_per_s": speed, "J1_Ns": sums[0], "J2_Ns": sums[1]})
    return rows


# ---------------------------------------------------------------------------------------------------------------------
def pump(d, x, wrong=""):
    """The whole pump by the generator of the reference data: kinematics in closed form, one body after the other."""
    import make_reference as reference
    case = reference_case(d, wrong)
    row = dict(zip(reference.header(case.pistons)[1:], reference.solve_row(case, x)))
    turn = tilted(case.tilt)

    def rotate(stem, axes, to_S2):
        names = [f"{stem}_{axis}_N" for axis in axes]
        v = [row[n] for n in names] + [mpf(0)] * (3 - len(axes))
        new = [vec(*v).dot(axis) for axis in turn] if to_S2 else sum(c * axis for c, axis in zip(v, turn))
        row.update(zip(names, new))

    if wrong == "bearings_in_S2":
        rotate("Rb1", ("x1", "y1", "z1"), True)
        rotate("Rb2", ("x1", "y1"), True)
    if wrong == "Rb1_about_O1_in_S2":
        z_1, z_2 = case.z_C1, case.z_C2  # the force at O1 that, with the other bearing, carries the same moment
        for axis in "xy":
            other = row[f"Rb2_{axis}1_N"]
            moment = z_1 * row[f"Rb1_{axis}1_N"] + z_2 * other
            row[f"Rb1_{axis}1_N"] += other - moment / z_2
            row[f"Rb2_{axis}1_N"] = moment / z_2
        rotate("Rb1", ("x1", "y1", "z1"), True)
    if wrong == "pistons_in_S1":
        rotate("Rs_1", ("x2", "y2", "z2"), False)
        rotate("Rc_1", ("x2", "y2"), False)
    keep = ("Rs_1_", "Rc_1_", "Fh", "Th", "Rcn", "Rcs", "Rb", "Td")
    return {name: value for name, value in row.items() if name.startswith(keep)}


def reference_case(d, wrong=""):
    import make_reference as reference
    case = d.case_object() if callable(getattr(d, "case_object", None)) else reference.Case(d.case_path)
    if wrong == "no_weight":
        case.gravity = mpf(0)
    elif wrong == "no_spring":
        case.spring = mpf(0)
    elif wrong == "no_land_force":
        case.ports = []
    elif wrong == "no_pressure_angle":
        case.pressure_angle = mpf(0)
    elif wrong == "other_flank":
        case.pressure_angle = -case.pressure_angle
    elif wrong == "no_bottom_force":
        case.A_bottom = mpf(0)
    elif wrong == "no_piston_friction":
        case.F_coulomb = case.c_viscous = mpf(0)
    elif wrong == "no_block_friction":
        case.Cc = mpf(0)
    elif wrong == "no_gyroscopic":
        case.spin = mpf(0)
    elif wrong == "point_mass":
        case.I_t = mpf(0)
    elif wrong == "lumped":
        case.lumped, case.chi = True, mpf(1) / 2
        case.s_G, case.I_t, case.I_a = (1 - case.chi) * case.b1, mpf(0), mpf(0)
    elif wrong == "bearings_exchanged":
        case.z_C1, case.z_C2 = case.z_C2, case.z_C1
    elif wrong == "pin_at_O2":
        case.z_pin = mpf(0)
    return case


def pump_lumped(d, x, wrong=""):
    return pump(d, x, wrong)


def pump_real(d, x, wrong=""):
    return pump(d, x, wrong)
