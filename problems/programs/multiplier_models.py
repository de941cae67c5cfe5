"""The problems as rigid bodies with constraints: MODELS[name](number, data, x) gives the columns at a value of the grid.

With doubles this is a program that takes part (numpy_multipliers.py); with mpmath it is the second derivation that the
closed forms are compared with (generator/make_curves.py). Geometry is written down only as rough as Newton's method
needs to find the assembly that is meant.
"""
import tomllib
from fractions import Fraction
from types import SimpleNamespace

import numpy as np

from multipliers import Angle, Ball, Body, Drive, Ground, Mesh, Spin, System, cross
from problem_data import FOLDER, data_of

X, Y, Z = np.eye(3)


def angle_of(number, degrees):
    return number.pi * degrees.numerator / degrees.denominator / 180


def tilted(number, tilt):
    """Columns: x2, y2, z2 in S1."""
    c, s = number.cos(tilt), number.sin(tilt)
    return number.array([[1, 0, 0], [0, c, s], [0, -s, c]])


def frame_along(number, e):
    """Axes with the third along e."""
    e = e / number.sqrt(e.dot(e))
    i = cross(number.array(Y), e)
    i = i / number.sqrt(i.dot(i))
    return np.array([i, cross(e, i), e]).T


def named(stem, axes, vector, unit):
    return {f"{stem}_{axis}_{unit}": component for axis, component in zip(axes, vector)}


def weight_of(number, body, gravity):
    return (body, body.r, number.array([0, -1, 0]) * (body.mass * gravity))


def pendulum(number, d, x):
    t = angle_of(number, x)
    c, s = number.cos(t), number.sin(t)
    R = number.array([[s, c, 0], [-c, s, 0], [0, 0, 1]])
    arm = number.array([d.centre_x, 0, d.centre_z])
    body = Body(number, d.mass, [[d.inertia_x, 0, d.product_xz], [0, d.inertia_y, 0], [d.product_xz, 0, d.axial_inertia]], R.dot(arm), R)
    ground = Ground(number)
    joint = [Ball(body, -arm, ground, [0, 0, 0]), Angle(body, Z, ground, X), Angle(body, Z, ground, Y)]
    system = System(number, [body], joint)
    load = [weight_of(number, body, d.gravity)]

    def at_rest(angle):
        """Angular acceleration at an angle: no force of this joint depends on the speed along its axis."""
        c, s = number.cos(angle), number.sin(angle)
        body.R = number.array([[s, c, 0], [-c, s, 0], [0, 0, 1]])
        body.r, body.v, body.w = body.R.dot(arm), number.array([0, 0, 0]), number.array([0, 0, 0])
        return system.solve([weight_of(number, body, d.gravity)])[5]

    # The equation of motion integrated: d(w^2)/dt = 2 w w'. Gauss-Legendre; the integrand is entire.
    square = d.speed_at_bottom**2
    for at, share in legendre(number, t):
        square += 2 * share * at_rest(at)
    body.R, body.r = R, R.dot(arm)
    speed = number.sqrt(square)
    body.w = number.array([0, 0, 1]) * speed
    body.v = cross(body.w, body.r)
    system.solve(load)
    force, moment = 0, 0
    for constraint in joint:
        f, m = constraint.wrench(number.array([0, 0, 0]))
        force, moment = force + f, moment + m
    return {"omega_rad_per_s": speed, **named("F", ("x0", "y0"), force, "N"), **named("M", ("x0", "y0"), moment, "Nm")}


def legendre(number, end):
    """Places and shares of Gauss's formula on [0, end], with as many points as the digits need."""
    if number.mp is None:
        nodes, weights = np.polynomial.legendre.leggauss(20)
    else:
        if not hasattr(number, "nodes"):
            mp, n = number.mp, 44
            number.nodes, number.weights = [], []
            for i in range(n):
                z = mp.mpf(np.polynomial.legendre.leggauss(n)[0][i])
                for _ in range(8):
                    p, q = mp.legendre(n, z), mp.legendre(n - 1, z)
                    slope = n * (z * p - q) / (z * z - 1)
                    z -= p / slope
                slope = n * (z * mp.legendre(n, z) - mp.legendre(n - 1, z)) / (z * z - 1)
                number.nodes.append(z)
                number.weights.append(2 / ((1 - z * z) * slope**2))
        nodes, weights = number.nodes, number.weights
    return [(end * (1 + z) / 2, end * w / 2) for z, w in zip(nodes, weights)]


def spherical(number, d, x, psi):
    """Every link is held at O by a joint of its own: the couples are then determinate."""
    t, array = angle_of(number, x), number.array
    ground, S2, origin = Ground(number), tilted(number, d.tilt), [0, 0, 0]

    def axis(arc, angle):
        return array([-number.sin(arc) * number.sin(angle), number.sin(arc) * number.cos(angle), number.cos(arc)])

    def about_z(angle):
        return array([[number.cos(angle), -number.sin(angle), 0], [number.sin(angle), number.cos(angle), 0], [0, 0, 1]])

    shaft = Body(number, 1, [1, 1, 1], R=about_z(t))  # any: its speed is constant
    output = Body(number, 1, [1, 1, d.output_inertia], R=S2.dot(about_z(psi)))
    a_in, b_out = axis(d.input_arc, 0), axis(d.output_arc, 0)
    a, b = shaft.direction(a_in), output.direction(b_out)
    normal = cross(a, b)
    normal = normal / number.sqrt(normal.dot(normal))
    coupler = Body(number, 1, d.coupler_inertia, R=np.array([a, cross(normal, a), normal]).T)
    b_coupler = array([number.cos(d.coupler_arc), number.sin(d.coupler_arc), 0])
    across = cross(array(Z), b_coupler)
    joint_a = [Angle(coupler, Y, shaft, a_in), Angle(coupler, Z, shaft, a_in)]
    joint_b = [Angle(coupler, across, output, b_out), Angle(coupler, Z, output, b_out)]
    drive = Drive(shaft, Y, Z, array([-number.sin(t), number.cos(t), 0]), d.speed)
    system = System(number, [shaft, output, coupler],
                    [Ball(body, origin, ground, origin) for body in (shaft, output, coupler)]
                    + [drive, Angle(shaft, Z, ground, X), Angle(shaft, Z, ground, Y), Angle(output, Z, ground, S2[:, 0]),
                       Angle(output, Z, ground, S2[:, 1])] + joint_a + joint_b)
    system.assemble()
    system.move()
    rate = output.w.dot(S2[:, 2])
    system.solve(couples=[(output, -(d.load_torque + d.load_damping * rate) * S2[:, 2])])
    Ma, Mb = (sum(c.wrench(coupler.r)[1] for c in joint) for joint in (joint_a, joint_b))
    y = S2.T.dot(output.direction(array(Y)))
    atan2 = number.math.atan2 if number.mp else np.arctan2
    return {"psi_deg": atan2(-y[0], y[1]) * 180 / number.pi, "psi_rate_rad_per_s": rate, **named("Ma", ("x0", "y0", "z0"), Ma, "Nm"),
            **named("Mb", ("x0", "y0", "z0"), Mb, "Nm"), "Td_z0_Nm": drive.multipliers[0]}


def spherical_four_bar(number, d, x):
    return spherical(number, d, x, d.assembly_psi)


def universal_joint(number, d, x):
    d.input_arc = d.coupler_arc = d.output_arc = number.pi / 2
    row = spherical(number, d, x, angle_of(number, x) + number.pi / 2)
    del row["psi_deg"]
    return row


def rod_from(number, S2, d, t, radius):
    """A piston's joint A in S1 and, roughly, its axis."""
    A = number.array([-radius * number.sin(t), radius * number.cos(t), 0])
    return A, S2[:, 2] + 0


def add_piston(number, d, S2, shaft, A_shaft, block, bore, t, real, spin):
    """One piston: its body, ball at A, ring at B in its bore, spin. `bore` is a point of its axis, in S2."""
    A, e = rod_from(number, S2, d, t, d.joint_circle_radius)
    b1 = d.piston_length
    if real:
        s_G, inertia = d.centre_of_mass, [d.transverse_inertia, d.transverse_inertia, d.axial_inertia]
    else:
        chi = d.joint_mass_fraction
        s_G, It = (1 - chi) * b1, chi * (1 - chi) * d.mass * b1**2
        inertia = [It, It, 0]
    aim = number.array([0, 0, d.axis_offset]) + S2.dot(bore) + S2[:, 2] * (S2[:, 2].dot(A) + b1) - A
    body = Body(number, d.mass, inertia, R=frame_along(number, aim))
    body.r = A + body.direction(number.array(Z)) * s_G
    joint = Ball(body, [0, 0, -s_G], shaft, A_shaft)
    ring = Ball(body, [0, 0, b1 - s_G], block[0], block[1], axes=S2.T[:2], sliding=True)
    return body, joint, ring, Spin(body, Z, spin)


def about(number, x, y, z):
    return number.array([x, y, z])


def bore_of(number, d, t):
    return number.array([-d.bore_circle_radius * number.sin(t), d.bore_circle_radius * number.cos(t), 0])


def piston(number, d, x):
    t, S2, ground, array = angle_of(number, x), tilted(number, d.tilt), Ground(number), number.array
    crank = Body(number, 1, [1, 1, 1], R=array([[number.cos(t), -number.sin(t), 0], [number.sin(t), number.cos(t), 0], [0, 0, 1]]))
    # The bore turns with the block, whose speed is that of the shaft.
    block = Body(number, 1, [1, 1, 1], r=[0, 0, d.axis_offset],
                 R=S2.dot(array([[number.cos(t), -number.sin(t), 0], [number.sin(t), number.cos(t), 0], [0, 0, 1]])))
    bore = [0, d.bore_circle_radius, 0]
    body, joint, ring, spin = add_piston(number, d, S2, crank, [0, d.joint_circle_radius, 0], (block, bore),
                                         bore_of(number, d, t), t, True, d.spin)
    fixed = []
    for turning, S in ((crank, array(np.eye(3))), (block, S2)):
        target = S.dot(array([-number.sin(t), number.cos(t), 0]))
        fixed += [Ball(turning, [0, 0, 0], ground, turning.r), Angle(turning, Z, ground, S[:, 0]), Angle(turning, Z, ground, S[:, 1]),
                  Drive(turning, Y, S[:, 2], target, d.speed)]
    system = System(number, [crank, block, body], fixed + [joint, ring, spin])
    system.assemble()
    system.move()
    loads = piston_loads(number, d, S2, body, d.pressure_mean - d.pressure_amplitude * number.sin(t), d.centre_of_mass)
    system.solve(loads)
    Rs, Rc = S2.T.dot(joint.wrench(body.r)[0]), ring.multipliers
    return {**named("Rs", ("x2", "y2", "z2"), Rs, "N"), **named("Rc", ("x2", "y2"), Rc, "N")}


def piston_loads(number, d, S2, body, pressure, s_G):
    B = body.r + body.direction(number.array(Z)) * (d.piston_length - s_G)
    v_B = (body.v + cross(body.w, B - body.r)).dot(S2[:, 2])
    force = -(number.pi / 4 * d.bore_diameter**2 * pressure + d.viscous_friction * v_B)
    return [(body, B, force * S2[:, 2]), weight_of(number, body, d.gravity)]


def piston_pair(number, d, x):
    t, S2, ground, array = angle_of(number, x), tilted(number, d.tilt), Ground(number), number.array
    turn = array([[number.cos(t), -number.sin(t), 0], [number.sin(t), number.cos(t), 0], [0, 0, 1]])
    shaft = Body(number, d.shaft_mass, [1, 1, 1], r=[0, 0, d.shaft_centre_z], R=turn)
    block = Body(number, 1, [1, 1, 1], r=[0, 0, d.axis_offset], R=S2.dot(turn))
    C1, C2 = array([0, 0, d.tapered_z]), array([0, 0, d.cylindrical_z])
    first, second = (Ball(shaft, C1 - shaft.r, ground, C1), Ball(shaft, C2 - shaft.r, ground, C2, axes=np.eye(3)[:2]))
    target = array([-number.sin(t), number.cos(t), 0])
    drive = Drive(shaft, Y, Z, target, d.speed)
    constraints = [first, second, drive, Ball(block, [0, 0, 0], ground, block.r), Angle(block, Z, ground, S2[:, 0]),
                   Angle(block, Z, ground, S2[:, 1]), Drive(block, Y, S2[:, 2], S2.dot(target), d.speed)]
    bodies, pistons = [shaft, block], []
    s_G = (1 - d.joint_mass_fraction) * d.piston_length
    for k in range(2):
        own, side = t + k * number.pi, 1 - 2 * k
        body, joint, ring, spin = add_piston(number, d, S2, shaft, [0, side * d.joint_circle_radius, -d.shaft_centre_z],
                                             (block, [0, side * d.bore_circle_radius, 0]), bore_of(number, d, own), own, False, 0)
        bodies.append(body)
        constraints += [joint, ring, spin]
        pistons.append((body, d.pressure_mean - d.pressure_amplitude * number.sin(own)))
    system = System(number, bodies, constraints)
    system.assemble()
    system.move()
    loads = [weight_of(number, shaft, d.gravity)]
    for body, pressure in pistons:
        loads += piston_loads(number, d, S2, body, pressure, s_G)
    system.solve(loads)
    return {**named("Rb1", ("x1", "y1", "z1"), first.multipliers, "N"), **named("Rb2", ("x1", "y1"), second.multipliers, "N"),
            "Td_z1_Nm": drive.multipliers[0]}


def gear_pair(number, d, x):
    t, S2, ground, array = angle_of(number, x), tilted(number, d.shaft_angle), Ground(number), number.array
    ratio = d.teeth_input / d.teeth_output
    # Half angle of the pitch cone: the line of both cones on which the rolling gears have no relative speed.
    c, s = number.cos(d.shaft_angle), number.sin(d.shaft_angle)
    p = array([0, ratio * s, 1 + ratio * c])
    p = p / number.sqrt(p.dot(p))
    P = d.cone_distance * p
    k = number.cos(d.pressure_angle) * array([-1, 0, 0]) + number.sin(d.pressure_angle) * array([0, p[2], -p[1]])
    speed = d.speed * (1 + d.speed_ripple * number.cos(t))
    acceleration = -d.speed_ripple * d.speed * number.sin(t) * speed
    turn = array([[number.cos(t), -number.sin(t), 0], [number.sin(t), number.cos(t), 0], [0, 0, 1]])
    one = Body(number, d.input_mass, [1, 1, d.input_inertia], r=[0, 0, d.input_centre_z], R=turn)
    two = Body(number, d.output_mass, [1, 1, d.output_inertia], r=S2[:, 2] * d.output_centre_z, R=S2)
    A1, A2 = (array([0, 0, z]) for z in d.input_bearing_z)
    A3, A4 = (S2[:, 2] * z for z in d.output_bearing_z)
    Rb1, Rb2 = Ball(one, A1 - one.r, ground, A1), Ball(one, A2 - one.r, ground, A2, axes=np.eye(3)[:2])
    own = lambda z: [0, 0, z - d.output_centre_z]  # noqa: E731
    Rb3 = Ball(two, own(d.output_bearing_z[0]), ground, A3, axes=S2.T)
    Rb4 = Ball(two, own(d.output_bearing_z[1]), ground, A4, axes=S2.T[:2])
    mesh, drive = Mesh(two, one, P, k), Drive(one, Y, Z, array([-number.sin(t), number.cos(t), 0]), speed, acceleration)
    system = System(number, [one, two], [Rb1, Rb2, Rb3, Rb4, drive, mesh])
    system.assemble()
    system.move()
    load = d.load_torque * (1 + d.load_ripple * number.sin(2 * t))
    system.solve([weight_of(number, one, d.gravity), weight_of(number, two, d.gravity)], [(two, load * S2[:, 2])])
    return {"Rg_k_N": mesh.multipliers[0], **named("Rb1", ("x1", "y1", "z1"), Rb1.multipliers, "N"),
            **named("Rb2", ("x1", "y1"), Rb2.multipliers, "N"), **named("Rb3", ("x2", "y2", "z2"), Rb3.multipliers, "N"),
            **named("Rb4", ("x2", "y2"), Rb4.multipliers, "N"), "Td_z1_Nm": drive.multipliers[0]}


class SliderCrank:
    """Crank, rod and crosshead in the plane x-y; the guide holds the crosshead at points along x."""

    def __init__(self, number, d, t, stations):
        array, ground = number.array, Ground(number)
        self.number, self.d = number, d
        c, s = number.cos(t), number.sin(t)
        A = d.crank_radius * array([c, s, 0])
        e = array([number.sqrt(d.rod_length**2 - A[1]**2), -A[1], 0]) / d.rod_length
        self.crank = Body(number, 1, [1, 1, 1], R=array([[c, -s, 0], [s, c, 0], [0, 0, 1]]))
        self.rod = Body(number, d.rod_mass, [1, 1, d.rod_inertia], A + d.rod_centre * e, array([[e[0], -e[1], 0], [e[1], e[0], 0], [0, 0, 1]]))
        centre = getattr(d, "crosshead_centre_x", 0)
        self.pin_at = array([-centre, 0, 0])
        self.crosshead = Body(number, d.crosshead_mass, [1, 1, 1], A + d.rod_length * e - self.pin_at)
        plane = lambda body: [Angle(body, Z, ground, X), Angle(body, Z, ground, Y)]  # noqa: E731
        self.drive = Drive(self.crank, X, Z, array([c, s, 0]), d.speed)
        self.crank_pin = Ball(self.rod, [-d.rod_centre, 0, 0], self.crank, [d.crank_radius, 0, 0])
        self.pin = Ball(self.crosshead, self.pin_at, self.rod, [d.rod_length - d.rod_centre, 0, 0], axes=np.eye(3)[:2])
        self.guides = [Ball(self.crosshead, self.pin_at + array([x, 0, 0]), ground, [0, 0, 0], axes=[Y]) for x in stations]
        upright = [] if len(stations) > 1 else [Angle(self.crosshead, X, ground, Y)]
        self.system = System(number, [self.crank, self.rod, self.crosshead],
                             [Ball(self.crank, [0, 0, 0], ground, [0, 0, 0]), *plane(self.crank), self.drive, self.crank_pin,
                              *plane(self.rod), self.pin, *plane(self.crosshead),
                              Ball(self.crosshead, [0, 0, 0], ground, [0, 0, 0], axes=[Z]), *upright, *self.guides])
        self.system.assemble()
        self.system.move()
        self.gas = -(d.gas_force + d.gas_amplitude * s)

    def solve(self, further=0):
        """Reactions under gas force and weights, and a further force along x at the pin."""
        d, number = self.d, self.number
        at = self.crosshead.r + self.pin_at
        offset = number.array([0, getattr(d, "gas_offset", 0), 0])
        x = number.array(X)
        self.system.solve([(self.crosshead, at + offset, self.gas * x), (self.crosshead, at, further * x),
                           weight_of(number, self.rod, d.gravity), weight_of(number, self.crosshead, d.gravity)])


def one_sided_wall(number, d, x):
    """Every choice of one pad a station is tried; the one that pushes with both is the answer."""
    model = SliderCrank(number, d, angle_of(number, x), [d.front_pads_x, d.rear_pads_x])
    answers = []
    for front in (1, -1):
        for rear in (1, -1):
            for guide, side in zip(model.guides, (front, rear)):
                guide.axes = number.array([side * Y])
            model.solve()
            pushes = [guide.multipliers[0] for guide in model.guides]
            if min(pushes) >= 0:
                zero = pushes[0] * 0
                (one, two), torque = pushes, model.drive.multipliers[0]
                answers.append({"L1_N": one if front > 0 else zero, "U1_N": zero if front > 0 else one,
                                "L2_N": two if rear > 0 else zero, "U2_N": zero if rear > 0 else two, "Td_z_Nm": torque})
    if len(answers) != 1:
        raise ValueError(f"{len(answers)} choices of pads are possible")
    return answers[0]


def step_friction(number, d, x):
    """f + mu |N(f)| sign(v) = 0 has corners in f: the secant method, which ends where both points are on one side."""
    model = SliderCrank(number, d, angle_of(number, x), [0])
    direction = 1 if model.crosshead.v[0] > 0 else -1

    def rest(f):
        model.solve(f)
        return f + d.friction_coefficient * direction * abs(model.guides[0].multipliers[0])

    zero = model.gas * 0
    a, b = zero, -direction * abs(model.gas) / 10
    rest_a, rest_b = rest(a), rest(b)
    for _ in range(8):
        if rest_b == rest_a:
            break
        a, b, rest_a = b, b - rest_b * (b - a) / (rest_b - rest_a), rest_b
        rest_b = rest(b)
        if abs(rest_b) <= number.tiny() * abs(model.gas):
            break
    P = model.pin.multipliers
    return {"N_y_N": model.guides[0].multipliers[0], "Ff_x_N": b, "P_x_N": P[0], "P_y_N": P[1], "Td_z_Nm": model.drive.multipliers[0]}


def impacts(number, d, xs):
    """In the frame of the box: the body falls under the box's acceleration, y'' = A w^2 sin, between walls at rest. Steps
    of a Taylor series, of as many terms as the digits need; in each the wall is met where the series says so."""
    ends = [angle_of(number, x) for x in xs]
    n = 24 if number.mp is None else 16 + number.mp.dps // 2
    phase, step = number.array(0)[()], number.pi / 90
    y, speed = d.start_position + phase, d.start_speed / d.speed - d.amplitude  # by the phase
    half, sums, rows, at = d.gap / 2, [phase, phase], [], 0

    def series(phase, y, speed):
        """y(phase + h) = sum c_i h^i: y'' = A sin(phase)."""
        terms, factorial = [y, speed], number.array(1)[()]
        s, c = number.sin(phase), number.cos(phase)
        for i in range(n):
            factorial = factorial * max(i, 1)
            derivative = (s, c, -s, -c)[i % 4]
            terms.append(d.amplitude * derivative / (factorial * (i + 1) * (i + 2)))
        return terms

    def value(terms, h):
        result = slope = phase * 0
        for term in reversed(terms):
            slope, result = slope * h + result, result * h + term
        return result, slope

    while at < len(ends):
        terms = series(phase, y, speed)
        h, side = step, 0
        for wall in (-1, 1):
            if wall * value(terms, step)[0] > half:
                side, h = wall, step
                low, high = step * 0, step
                if wall * value(terms, low)[0] > half:
                    raise ValueError("outside the box")
                for _ in range(60):
                    middle = (low + high) / 2
                    low, high = (low, middle) if wall * value(terms, middle)[0] > half else (middle, high)
                h = high
                for _ in range(6):
                    place, slope = value(terms, h)
                    h = h - (place - wall * half) / slope
        while at < len(ends) and ends[at] <= phase + h:
            place, slope = value(terms, ends[at] - phase)
            s, c = number.sin(ends[at]), number.cos(ends[at])
            rows.append({"y_mm": (place + d.amplitude * s) * 1000, "v_m_per_s": (slope + d.amplitude * c) * d.speed,
                         "J1_Ns": sums[0], "J2_Ns": sums[1]})
            at += 1
        y, slope = value(terms, h)
        phase = phase + h
        speed = slope
        if side:
            y, speed = side * half, -d.restitution * slope
            sums = list(sums)
            sums[(side + 1) // 2] = sums[(side + 1) // 2] + d.mass * d.speed * abs(speed - slope)
    return rows


def pump(number, d, x):
    """The whole pump: shaft, block and pistons at once. Loads as in docs/theory.md; the land force by quadrature."""
    case = pump_case(number, d)
    t, S2, ground, array = angle_of(number, x), tilted(number, case.tilt), Ground(number), number.array
    turn = array([[number.cos(t), -number.sin(t), 0], [number.sin(t), number.cos(t), 0], [0, 0, 1]])
    O2 = array([0, 0, case.axis_offset])
    shaft = Body(number, case.shaft_mass, [1, 1, 1], r=[0, 0, case.shaft_centre], R=turn)
    block = Body(number, case.block_mass, [1, 1, 1], r=O2 + S2[:, 2] * case.block_centre, R=S2.dot(turn))
    C1, C2 = array([0, 0, case.tapered_z]), array([0, 0, case.cylindrical_z])
    Rb1, Rb2 = Ball(shaft, C1 - shaft.r, ground, C1), Ball(shaft, C2 - shaft.r, ground, C2, axes=np.eye(3)[:2])
    drive = Drive(shaft, Y, Z, [-number.sin(t), number.cos(t), 0], case.speed)
    on_axis = lambda z: [0, 0, z - case.block_centre]  # noqa: E731
    Fh = Ball(block, on_axis(0), ground, O2, axes=[S2[:, 2]])
    Rcn = Ball(block, on_axis(case.pin_z), ground, O2 + S2[:, 2] * case.pin_z, axes=S2.T[:2])
    Th = [Angle(block, Z, ground, S2[:, 0]), Angle(block, Z, ground, S2[:, 1])]
    half, delta = case.pitch_diameter / 2, number.pi / 2 - case.tilt / 2
    O4 = array([0, half, case.axis_offset - half * number.sin(case.tilt / 2) / number.cos(case.tilt / 2)])
    ap, sign = case.pressure_angle, -1 if case.speed < 0 else 1
    k4 = sign * array([-number.cos(ap), number.sin(ap) * number.cos(delta), number.sin(ap) * number.sin(delta)])
    gear = Mesh(block, shaft, O4, k4)
    bodies, constraints = [shaft, block], [Rb1, Rb2, drive, Fh, Rcn, *Th, gear]
    pistons = []
    for k in range(case.pistons):
        degrees = x - Fraction(360 * k, case.pistons)
        own = angle_of(number, degrees)
        back = angle_of(number, Fraction(-360 * k, case.pistons))
        at_A = array([-case.joint_circle_radius * number.sin(back), case.joint_circle_radius * number.cos(back), -case.shaft_centre])
        at_bore = bore_of(number, case, back) - array([0, 0, case.block_centre])
        body, joint, ring, spin = add_piston(number, case, S2, shaft, at_A, (block, at_bore), bore_of(number, case, own), own,
                                             case.real, case.spin)
        bodies.append(body)
        constraints += [joint, ring, spin]
        pistons.append((body, joint, ring, degrees))
    system = System(number, bodies, constraints)
    system.assemble()
    system.move()
    z2, s_G = S2[:, 2], case.centre_of_mass
    loads, couples = [weight_of(number, shaft, case.gravity), weight_of(number, block, case.gravity)], []
    area = number.pi / 4 * case.bore_diameter**2
    for body, _, _, degrees in pistons:
        p = case.pressure(degrees)
        B = body.r + body.direction(array(Z)) * (case.piston_length - s_G)
        v = (body.v + cross(body.w, B - body.r)).dot(z2)
        friction = case.friction(v)
        loads += [(body, B, -(area * p + friction) * z2), (block, B, friction * z2), weight_of(number, body, case.gravity),
                  (block, O2 + S2.dot(bore_of(number, case, angle_of(number, degrees))), case.bottom_area * p * z2)]
    loads += [(block, O2, case.spring * z2), (shaft, O2, -case.spring * z2)]
    land, land_moment = land_force(number, case)
    loads.append((block, O2, -land * z2))
    couples += [(block, S2.dot(land_moment)), (block, -case.block_friction * case.speed * z2),
                (shaft, -case.shaft_friction * case.speed * array(Z))]
    system.solve(loads, couples)
    Rs, Rc = S2.T.dot(pistons[0][1].wrench(O2)[0]), pistons[0][2].multipliers
    moment = S2.T.dot(Th[0].wrench(O2)[1] + Th[1].wrench(O2)[1])
    return {**named("Rs_1", ("x2", "y2", "z2"), Rs, "N"), **named("Rc_1", ("x2", "y2"), Rc, "N"), "Fh_z2_N": Fh.multipliers[0],
            "Th_x2_Nm": moment[0], "Th_y2_Nm": moment[1], **named("Rcn", ("x2", "y2"), Rcn.multipliers, "N"),
            "Rcs_z4_N": gear.multipliers[0], **named("Rb1", ("x1", "y1", "z1"), Rb1.multipliers, "N"),
            **named("Rb2", ("x1", "y1"), Rb2.multipliers, "N"), "Td_z1_Nm": drive.multipliers[0] / case.torque_factor}


def pump_case(number, d):
    """case.toml in SI, with what it leaves to defaults (docs/case_file.md); kept for the next angle."""
    if hasattr(d, "kept"):
        return d.kept
    with open(d.case_path if hasattr(d, "case_path") else FOLDER / d.name / d.case, "rb") as stream:
        tables = tomllib.load(stream, parse_float=Fraction)
    flat = {f"{table}.{key}": value for table, entries in tables.items() if isinstance(entries, dict) for key, value in entries.items()}

    def get(key, default=None):
        value, (name, unit) = flat.get(key, default), key.split(".")[1].split("_", 1) if "_" in key else (key, "")
        scales = {"mm": (Fraction(1, 1000), 0), "deg": (Fraction(1, 180), 1), "rpm": (Fraction(1, 30), 1), "bar": (10**5, 0),
                  "mm2": (Fraction(1, 10**6), 0)}
        ending = "kg_mm2" if key.endswith("kg_mm2") else key.rsplit("_", 1)[-1]
        factor, with_pi = scales.get("mm2" if ending == "kg_mm2" else ending, (1, 0))
        if "per_rpm" in key:
            factor, with_pi = 1, -1
        exact = Fraction(value) * factor
        result = number.array(exact.numerator)[()] / number.array(exact.denominator)[()]
        return result * number.pi if with_pi > 0 else result * 30 / number.pi if with_pi < 0 else result

    real = flat["piston.inertia"] == "real"
    case = SimpleNamespace(
        pistons=flat["pump.pistons"], tilt=get("pump.tilt_deg"), joint_circle_radius=get("pump.joint_circle_radius_mm"),
        bore_circle_radius=get("pump.bore_circle_radius_mm"), axis_offset=get("pump.axis_offset_mm"),
        piston_length=get("pump.piston_length_mm"), bore_diameter=get("pump.bore_diameter_mm"),
        pitch_diameter=get("gear.pitch_diameter_mm"), pressure_angle=get("gear.pressure_angle_deg"),
        tapered_z=get("bearings.tapered_z_mm"), cylindrical_z=get("bearings.cylindrical_z_mm"), real=real,
        mass=get("piston.mass_kg"), shaft_mass=get("shaft.mass_kg"), shaft_centre=get("shaft.centre_of_mass_z_mm"),
        block_mass=get("block.mass_kg"), block_centre=get("block.centre_of_mass_z_mm"), pin_z=get("block.pin_z_mm"),
        bottom_area=get("block.bottom_area_mm2", 0), spring=get("block.spring_force_N", 0),
        block_friction=get("friction.block_viscous_Nm_per_rpm", 0), shaft_friction=get("friction.shaft_viscous_Nm_per_rpm", 0),
        torque_factor=get("friction.shaft_torque_factor", 1), speed=get("operation.speed_rpm"),
        gravity=get("operation.gravity_m_per_s2", Fraction(980665, 100000)))
    if real:
        case.centre_of_mass, case.spin = get("piston.centre_of_mass_mm"), get("piston.spin_rpm", 0)
        case.transverse_inertia, case.axial_inertia = get("piston.transverse_inertia_kg_mm2"), get("piston.axial_inertia_kg_mm2")
    else:
        case.joint_mass_fraction, case.spin = get("piston.joint_mass_fraction", Fraction(1, 2)), 0
        case.centre_of_mass = (1 - case.joint_mass_fraction) * case.piston_length
    coulomb, viscous = get("friction.piston_coulomb_N", 0), get("friction.piston_viscous_N_s_per_m", 0)
    regular = get("friction.regularization_m_per_s", Fraction(1, 100))
    case.friction = lambda v: coulomb * number.math.tanh(v / regular) + viscous * v
    low, high = get("pressure.suction_bar"), get("pressure.delivery_bar")
    width, start = Fraction(flat["pressure.transition_deg"]), Fraction(flat.get("pressure.delivery_start_deg", 180))

    def pressure(degrees):
        """Delivery for half a turn from `start`, with S(t) = t^2 (3 - 2 t) over `width` at both edges."""
        past = (degrees - start + width / 2) % 360

        def step(t):
            s = t * t * (3 - 2 * t)
            return number.array(s.numerator)[()] / number.array(s.denominator)[()]

        if past < 180:
            return low + (high - low) * (step(past / width) if past < width else 1)
        return high + (low - high) * (step((past - 180) / width) if past - 180 < width else 1)

    case.pressure = pressure
    case.ports = []
    if "port_plate.inner_land_mm" in flat:
        exact = lambda f: number.array(Fraction(f).numerator)[()] / number.array(Fraction(f).denominator)[()]  # noqa: E731
        case.radii = [exact(r) / 1000 for r in flat["port_plate.inner_land_mm"] + flat["port_plate.outer_land_mm"]]
        for p, key in ((high, "delivery_arc_deg"), (low, "suction_arc_deg")):
            case.ports.append((p, *[exact(a) * number.pi / 180 for a in flat[f"port_plate.{key}"]]))
    d.kept = case
    return case


def land_force(number, case):
    """Force along -z2 and moment about O2 in S2: pressure times r over every port, in radius by Gauss's formula of two
    points, exact for cubics, on each of the three rings; over the arc in closed form."""
    force, moment = number.array(0)[()], number.array([0, 0, 0])
    for p, start, end in case.ports:
        r1, r2, r3, r4 = case.radii
        for low, high, at_low, at_high in ((r1, r2, 0, 1), (r2, r3, 1, 1), (r3, r4, 1, 0)):
            for side in (-1, 1):
                share = (1 + side / number.sqrt(number.array(3)[()])) / 2
                r = low + (high - low) * share
                weight = (high - low) / 2 * p * (at_low + (at_high - at_low) * share) * r
                force += weight * (end - start)
                moment += weight * r * number.array([-(number.sin(end) - number.sin(start)), number.cos(end) - number.cos(start), 0])
    return force, moment


MODELS = {"pendulum": pendulum, "spherical_four_bar": spherical_four_bar, "universal_joint": universal_joint, "piston": piston,
          "piston_pair": piston_pair, "gear_pair": gear_pair, "one_sided_wall": one_sided_wall, "step_friction": step_friction,
          "impacts": impacts, "pump_lumped": pump, "pump_real": pump}


def rows_of(number, name, settings, xs):
    """The columns of a problem at every value of its grid."""
    data = data_of(number, settings)
    data.name = name
    if name == "impacts":
        return MODELS[name](number, data, xs)
    return [MODELS[name](number, data, x) for x in xs]
