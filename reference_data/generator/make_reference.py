#!/usr/bin/env python3
"""High-precision reference curves for bentaxis: reactions and drive torque of a bent-axis pump.

An independent solver for the equations of docs/theory.md; it shares no code and no formula beyond them with the
program it checks:

* only *positions* are written down, as functions of the shaft angle; velocities and accelerations are second-order
  jets (truncated Taylor series) of them;
* every body is one dense 6 x 6 system, three forces and three moments about O1, all in frame S1, by LU decomposition;
* arithmetic has 50 decimal digits; the numbers of the case file are taken from their text as exact fractions.

Equation numbers in brackets are those of Roccatello & Nervegna, Int. J. Fluid Power 10 (2009) no. 2, pp. 57-72.
Units are SI throughout; suffixes of the case file's keys are removed once, in `Case`.

    make_reference.py CASE.toml -o CURVE.csv       compute and write (20 digits)
    make_reference.py CASE.toml --check CURVE.csv  compute and compare
    make_reference.py --all DIR                    compare every DIR/NAME/case.toml with DIR/NAME/reference.csv

A row whose power balance or piston-axis moment does not close to 1e-25 of its own terms stops the run.
Needs Python >= 3.11 and mpmath (Debian: python3-mpmath).
"""
import argparse
import csv
import multiprocessing
import os
import sys
import tempfile
import tomllib
from fractions import Fraction
from pathlib import Path

from mpmath import mp, mpf

mp.dps = 50
IDENTITY_TOLERANCE = mpf(10) ** -25  # far above 50-digit round-off, far below anything a double can show
DIGITS = 20


class Refused(Exception):
    """A case that cannot be read or solved, or a row that violates an identity."""


def number(x):
    """An exact fraction or integer as a high-precision number."""
    return mpf(x.numerator) / mpf(x.denominator)


# ---------------------------------------------------------------------------------------------------------------------
# Jets: value, first and second derivative with respect to the shaft angle theta
# ---------------------------------------------------------------------------------------------------------------------
class Jet:
    """f + f' t + f'' t^2 / 2, truncated. Arithmetic is the product and chain rule, nothing else."""

    __slots__ = ("f", "d", "dd")

    def __init__(self, f, d=0, dd=0):
        self.f, self.d, self.dd = mpf(f), mpf(d), mpf(dd)

    @staticmethod
    def of(x):
        return x if isinstance(x, Jet) else Jet(x)

    def __add__(self, other):
        o = Jet.of(other)
        return Jet(self.f + o.f, self.d + o.d, self.dd + o.dd)

    def __neg__(self):
        return Jet(-self.f, -self.d, -self.dd)

    def __sub__(self, other):
        return self + (-Jet.of(other))

    def __rsub__(self, other):
        return Jet.of(other) + (-self)

    def __mul__(self, other):
        o = Jet.of(other)
        return Jet(self.f * o.f, self.d * o.f + self.f * o.d, self.dd * o.f + 2 * self.d * o.d + self.f * o.dd)

    __radd__, __rmul__ = __add__, __mul__

    def sqrt(self):
        root = mp.sqrt(self.f)
        first = self.d / (2 * root)
        return Jet(root, first, (self.dd / 2 - first * first) / root)


def cos_sin_jets(degrees):
    """cos and sin of an angle that turns with the shaft, as jets; the degrees are an exact fraction."""
    half_turns = number(degrees / 180)
    c, s = mp.cospi(half_turns), mp.sinpi(half_turns)
    return Jet(c, -s, -c), Jet(s, c, -s)


# ---------------------------------------------------------------------------------------------------------------------
# Vectors (lists of three numbers or jets)
# ---------------------------------------------------------------------------------------------------------------------
def add(*vectors):
    return [sum(components[1:], components[0]) for components in zip(*vectors)]


def scale(factor, v):
    return [factor * c for c in v]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a):
    return mp.sqrt(sum(c * c for c in a))


X1, Y1, Z1 = [mpf(1), mpf(0), mpf(0)], [mpf(0), mpf(1), mpf(0)], [mpf(0), mpf(0), mpf(1)]


# ---------------------------------------------------------------------------------------------------------------------
# The case file
# ---------------------------------------------------------------------------------------------------------------------
class Case:
    """A case file with every quantity in SI units. Only what the solver uses is read; ranges are the program's job."""

    def __init__(self, path):
        self.path = Path(path)
        with open(path, "rb") as stream:
            data = tomllib.load(stream, parse_float=Fraction)  # exact: "0.1" is 1/10; "nan" and "inf" are refused

        def get(table, key, unit=Fraction(1), default=None):
            value = data.get(table, {}).get(key, default)
            if isinstance(value, bool) or not isinstance(value, (int, Fraction)):
                raise Refused(f"{path}: [{table}] {key}: a number is needed, found {value!r}")
            return number(value * unit)

        milli, bar, per_rpm, kg_mm2 = Fraction(1, 1000), Fraction(10**5), 30 / mp.pi, Fraction(1, 10**6)
        if data.get("schema") != 1 or data["pump"].get("type", "bent_axis") not in ("bent_axis", "bent_axis_bevel") or "transfer" in data:
            raise Refused(f"{path}: only schema 1 and pumps with a bevel gear are known")
        pump, operation, pressure = data["pump"], data["operation"], data["pressure"]

        self.pistons = pump["pistons"]
        self.tilt = get("pump", "tilt_deg") * mp.pi / 180
        self.Ra = get("pump", "joint_circle_radius_mm", milli)
        self.Rd = get("pump", "bore_circle_radius_mm", milli)
        self.b = get("pump", "axis_offset_mm", milli)
        self.b1 = get("pump", "piston_length_mm", milli)
        self.area = mp.pi / 4 * get("pump", "bore_diameter_mm", milli) ** 2
        self.pitch_diameter = get("gear", "pitch_diameter_mm", milli)
        self.pressure_angle = get("gear", "pressure_angle_deg") * mp.pi / 180
        self.z_C1 = get("bearings", "tapered_z_mm", milli)
        self.z_C2 = get("bearings", "cylindrical_z_mm", milli)

        self.lumped = {"lumped": True, "real": False}[data["piston"]["inertia"]]
        self.m_piston = get("piston", "mass_kg")
        if self.lumped:
            self.chi = get("piston", "joint_mass_fraction", default=Fraction(1, 2))
            self.s_G = (1 - self.chi) * self.b1
            self.I_t = self.I_a = self.spin = mpf(0)
        else:
            self.s_G = get("piston", "centre_of_mass_mm", milli)
            self.I_t = get("piston", "transverse_inertia_kg_mm2", kg_mm2)
            self.I_a = get("piston", "axial_inertia_kg_mm2", kg_mm2)
            self.spin = get("piston", "spin_rpm", default=0) / per_rpm
        self.m_shaft = get("shaft", "mass_kg")
        self.z_shaft = get("shaft", "centre_of_mass_z_mm", milli)
        self.I_shaft = get("shaft", "axial_inertia_kg_mm2", kg_mm2, 2000)
        self.m_block = get("block", "mass_kg")
        self.z_block = get("block", "centre_of_mass_z_mm", milli)
        self.z_pin = get("block", "pin_z_mm", milli)
        self.A_bottom = get("block", "bottom_area_mm2", kg_mm2, 0)
        self.spring = get("block", "spring_force_N", default=0)
        self.I_block = get("block", "axial_inertia_kg_mm2", kg_mm2, 1500)

        self.F_coulomb = get("friction", "piston_coulomb_N", default=0)
        self.c_viscous = get("friction", "piston_viscous_N_s_per_m", default=0)
        self.v_reg = get("friction", "regularization_m_per_s", default=Fraction(1, 100))
        self.Cc = get("friction", "block_viscous_Nm_per_rpm", default=0) * per_rpm  # N m s
        self.Cs = get("friction", "shaft_viscous_Nm_per_rpm", default=0) * per_rpm
        self.Ct = get("friction", "shaft_torque_factor", default=1)

        self.omega = get("operation", "speed_rpm") / per_rpm
        self.gravity = get("operation", "gravity_m_per_s2", default=Fraction(980665, 10**5))
        self.samples = operation.get("samples_per_revolution", 720)

        self.p_suction = get("pressure", "suction_bar", bar)
        self.p_delivery = get("pressure", "delivery_bar", bar)
        if pressure["kind"] == "ideal":
            start, width = Fraction(pressure.get("delivery_start_deg", 180)), Fraction(pressure["transition_deg"])
            self.pressure = lambda deg: ideal_pressure(deg, start, width, self.p_suction, self.p_delivery)
        elif pressure["kind"] == "curve":
            with open(self.path.parent / pressure["file"], newline="") as stream:
                rows = list(csv.DictReader(stream))
            self.pressure = periodic_spline([Fraction(r["theta_deg"]) for r in rows],
                                            [number(Fraction(r["pressure_bar"]) * bar) for r in rows])
        else:
            raise Refused(f"{path}: pressure kind {pressure['kind']!r} is not an input of this solver")

        self.ports = []  # (pressure, psi1, psi2)
        if "port_plate" in data:
            plate = data["port_plate"]
            self.lands = [number(r * milli) for r in plate["inner_land_mm"] + plate["outer_land_mm"]]
            self.ports = [(p, *[number(Fraction(a) / 180) * mp.pi for a in plate[key]])
                          for p, key in ((self.p_delivery, "delivery_arc_deg"), (self.p_suction, "suction_arc_deg"))]


# ---------------------------------------------------------------------------------------------------------------------
# Chamber pressure over the piston's own angle, in degrees (exact fractions, so that an edge is an edge)
# ---------------------------------------------------------------------------------------------------------------------
def ideal_pressure(degrees, start, width, low, high):
    """Suction / delivery with smooth steps S(t) = t^2 (3 - 2 t) of the given width about `start` and `start` + 180."""
    past = (degrees - start) % 360
    for edge in (0, 180, 360):
        if abs(past - edge) <= Fraction(1, 10**9):
            past = Fraction(edge % 360)
    if width == 0:
        return high if past < 180 else low

    def step(t):
        t = number(t)
        return t * t * (3 - 2 * t)

    half = width / 2
    if past < half or past >= 360 - half:  # rising
        return low + (high - low) * step(((past + 180) % 360 - 180 + half) / width)
    if past < 180 - half:
        return high
    if past < 180 + half:  # falling
        return high - (high - low) * step((past - 180 + half) / width)
    return low


def periodic_spline(knots, values):
    """The periodic cubic spline through (knots [deg, Fraction], values); returns a function of degrees."""
    n = len(knots)
    if n < 3 or any(b <= a for a, b in zip(knots, knots[1:])) or knots[-1] - knots[0] >= 360:
        raise Refused("pressure curve: needs >= 3 points, strictly increasing, spanning less than 360 deg")
    h = [number(b - a) for a, b in zip(knots, knots[1:] + [knots[0] + 360])]  # h[i] from knot i to its successor
    slope = [(values[(i + 1) % n] - values[i]) / h[i] for i in range(n)]
    # h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (slope[i] - slope[i-1]), cyclic. The two corners
    # are split off as a rank-one term (Sherman-Morrison); what is left is tridiagonal and diagonally dominant.
    diagonal, corner = [2 * (h[i - 1] + h[i]) for i in range(n)], h[n - 1]
    gamma = -diagonal[0]
    diagonal[0] -= gamma
    diagonal[-1] -= corner * corner / gamma

    def tridiagonal(rhs):
        d, x = list(diagonal), list(rhs)
        for i in range(1, n):
            f = h[i - 1] / d[i - 1]
            d[i] -= f * h[i - 1]
            x[i] -= f * x[i - 1]
        x[-1] /= d[-1]
        for i in range(n - 2, -1, -1):
            x[i] = (x[i] - h[i] * x[i + 1]) / d[i]
        return x

    y = tridiagonal([6 * (slope[i] - slope[i - 1]) for i in range(n)])
    q = tridiagonal([gamma] + [mpf(0)] * (n - 2) + [corner])
    factor = (y[0] + y[-1] * corner / gamma) / (1 + q[0] + q[-1] * corner / gamma)
    M = [yi - factor * qi for yi, qi in zip(y, q)]  # second derivatives at the knots

    def evaluate(degrees):
        t = (degrees - knots[0]) % 360 + knots[0]
        i = max(j for j in range(n) if knots[j] <= t)
        u = number(t - knots[i]) / h[i]
        w, j, c = 1 - u, (i + 1) % n, h[i] ** 2 / 6
        return w * values[i] + u * values[j] + c * ((w**3 - w) * M[i] + (u**3 - u) * M[j])

    return evaluate


# ---------------------------------------------------------------------------------------------------------------------
# Geometry: positions in S1, and nothing but positions
# ---------------------------------------------------------------------------------------------------------------------
class Geometry:
    def __init__(self, case):
        self.case = case
        c, s = mp.cos(case.tilt), mp.sin(case.tilt)
        self.x2, self.y2, self.z2 = X1, [mpf(0), c, -s], [mpf(0), s, c]  # columns of R12 (7)
        self.O2 = scale(case.b, Z1)
        d, half = case.pitch_diameter, case.tilt / 2
        delta = mp.pi / 2 - half  # pitch cone of two equal bevel gears with axes bent by the tilt
        self.O4 = [mpf(0), d / 2, case.b - d / 2 * mp.tan(half)]  # (19)
        sign, ap = (-1 if case.omega < 0 else 1), case.pressure_angle
        self.k4 = scale(sign, [-mp.cos(ap), mp.sin(ap) * mp.cos(delta), mp.sin(ap) * mp.sin(delta)])  # (22)

    def from_S2(self, x, y, z):
        """A vector (not a point) with the given components in S2."""
        return add(scale(x, self.x2), scale(y, self.y2), scale(z, self.z2))

    def piston(self, degrees):
        """Jets of A, B and the axis e = AB/b1 of the piston whose own angle is `degrees`: (9), (11), (12), (13)."""
        c, cos_sin = self.case, cos_sin_jets(degrees)
        A = [-c.Ra * cos_sin[1], c.Ra * cos_sin[0], Jet(0)]
        x_B, y_B = -c.Rd * cos_sin[1], c.Rd * cos_sin[0]
        A_O2 = sub(A, self.O2)
        dx, dy = x_B - dot(A_O2, self.x2), y_B - dot(A_O2, self.y2)
        root = c.b1**2 - dx * dx - dy * dy
        if root.f <= 0:
            missing = mp.nstr(mp.sqrt(dx.f**2 + dy.f**2) - c.b1, 6)
            raise Refused(f"cannot be assembled: at piston angle {float(degrees)} deg the piston (b1) is {missing} m "
                          "too short for Ra, Rd, b and the tilt")
        B = add(self.O2, self.from_S2(x_B, y_B, dot(A_O2, self.z2) + root.sqrt()))
        return A, B, scale(1 / c.b1, sub(B, A))


# ---------------------------------------------------------------------------------------------------------------------
# Bodies: wrenches (force, moment about O1) in S1
# ---------------------------------------------------------------------------------------------------------------------
def force_at(point, force):
    return force + cross(point, force)


def couple(moment):
    return [mpf(0)] * 3 + moment


def solve_body(unknowns, loads):
    """Magnitudes of the six unknown unit wrenches that balance the loads."""
    matrix = mp.matrix(6, 6)
    for j, wrench in enumerate(unknowns):
        for i in range(6):
            matrix[i, j] = wrench[i]
    return list(mp.lu_solve(matrix, mp.matrix([-sum(load[i] for load in loads) for i in range(6)])))


def land_wrench(case, geometry):
    """Port-plate force on the block (49): pressure of each port over its arc, linear to zero over both lands."""
    fz = mx = my = mpf(0)
    for p, psi1, psi2 in case.ports:
        r1, r2, r3, r4 = case.lands
        inner, outer = r2 - r1, r4 - r3
        # integrals of f(r) r and f(r) r^2 over [r1, r4], f = 0..1 over the inner land, 1, 1..0 over the outer
        first = inner * (r1 / 2 + inner / 3) + (r3**2 - r2**2) / 2 + outer * (r4 / 2 - outer / 3)
        second = (inner * (r1**2 / 2 + 2 * r1 * inner / 3 + inner**2 / 4) + (r3**3 - r2**3) / 3
                  + outer * (r4**2 / 2 - 2 * r4 * outer / 3 + outer**2 / 4))
        fz -= p * first * (psi2 - psi1)
        mx -= p * second * (mp.sin(psi2) - mp.sin(psi1))  # y dFz, y = r cos(psi)
        my += p * second * (mp.cos(psi2) - mp.cos(psi1))  # -x dFz, x = -r sin(psi)
    at_O2 = force_at(geometry.O2, geometry.from_S2(0, 0, fz))
    return [a + b for a, b in zip(at_O2, couple(geometry.from_S2(mx, my, 0)))]


def velocity(jets, omega):
    return [c.d * omega for c in jets]


def acceleration(jets, omega, omega_dot):
    return [c.dd * omega**2 + c.d * omega_dot for c in jets]


def value(jets):
    return [c.f for c in jets]


def gradient(jets):
    return [c.d for c in jets]


def negative(wrench):
    return scale(-1, wrench)


class Piston:
    """One piston at its own angle: loads, inertia, the solved reactions (31)-(33) and share of the power balance."""

    def __init__(self, case, g, degrees, omega_dot):
        omega = case.omega
        A, B, e = g.piston(degrees)
        G = add(A, scale(case.s_G, e))
        self.a, self.b, self.e = value(A), value(B), value(e)
        self.pressure = case.pressure(degrees)
        Fp = scale(-case.area * self.pressure, g.z2)  # (24)
        Fpf = scale(-friction(case, dot(velocity(B, omega), g.z2)), g.z2)  # (25)
        weight = scale(-case.m_piston * case.gravity, Y1)  # (26)
        self.fluid, self.friction = force_at(self.b, Fp), force_at(self.b, Fpf)
        self.weight = force_at(value(G), weight)
        if case.lumped:  # (27), (28)
            masses = ((case.chi * case.m_piston, A), ((1 - case.chi) * case.m_piston, B))
        else:
            masses = ((case.m_piston, G),)
        spin_moment = add(scale(case.I_t, cross(self.e, acceleration(e, omega, omega_dot))),
                          scale(case.I_a * case.spin, velocity(e, omega)))  # d/dt (It e x e' + Ia ws e); 0 when lumped
        self.inertia = [force_at(value(P), scale(-m, acceleration(P, omega, omega_dot))) for m, P in masses]
        self.inertia.append(couple(scale(-1, spin_moment)))

        self.unknowns = [force_at(self.a, u) for u in (g.x2, g.y2, g.z2)] + [force_at(self.b, u) for u in (g.x2, g.y2)]
        self.loads = [self.fluid, self.friction, self.weight] + self.inertia
        *self.reactions, axial_moment = solve_body(self.unknowns + [couple(self.e)], self.loads)
        self.Rs, self.Rc = g.from_S2(*self.reactions[:3]), g.from_S2(*self.reactions[3:], 0)
        closes("moment about the piston's own axis", [axial_moment], load_scale(case) * case.b1)

        # power of what acts on the piston from outside the mechanism, less dT/dt, divided by omega
        self.power = [dot(Fp, gradient(B)), dot(Fpf, gradient(B)), dot(weight, gradient(G)),
                      -case.I_t * dot(acceleration(e, omega, omega_dot), gradient(e))]
        self.power += [-m * dot(acceleration(P, omega, omega_dot), gradient(P)) for m, P in masses]


def friction(case, v):
    """Friction force along -z2 on a piston that moves with v along z2 in its bore."""
    if case.v_reg > 0:
        coulomb = mp.tanh(v / case.v_reg)
    else:
        coulomb = mpf(0) if abs(v) <= mpf(10) ** -12 * abs(case.omega) * case.Ra else mp.sign(v)
    return case.F_coulomb * coulomb + case.c_viscous * v


def block_system(case, g, pistons, omega_dot):
    """(56), (57): unit wrenches of Fh, Th_x, Th_y, Rcn_x, Rcn_y, Rcs; loads from inside the pump; from outside."""
    pin, centre = (add(g.O2, scale(z, g.z2)) for z in (case.z_pin, case.z_block))
    unknowns = [force_at(g.O2, g.z2), couple(g.x2), couple(g.y2), force_at(pin, g.x2), force_at(pin, g.y2),
                force_at(g.O4, g.k4)]
    inside = [force_at(g.O2, scale(case.spring, g.z2))]
    outside = [land_wrench(case, g), force_at(centre, scale(-case.m_block * case.gravity, Y1)),
               couple(scale(-case.Cc * case.omega - case.I_block * omega_dot, g.z2))]  # (49), (46), (47)
    for piston in pistons:
        inside += [force_at(piston.b, scale(-1, piston.Rc)), negative(piston.friction)]
        outside.append(force_at(piston.b, scale(case.A_bottom * piston.pressure, g.z2)))  # (48), on the bore axis
    return unknowns, inside, outside


def shaft_system(case, g, pistons, Rcs, omega_dot):
    """(42), (43) corrected: unit wrenches of Rb1_x, Rb1_y, Rb1_z, Rb2_x, Rb2_y, Td; loads from inside; outside."""
    C1, C2 = scale(case.z_C1, Z1), scale(case.z_C2, Z1)
    unknowns = [force_at(C1, u) for u in (X1, Y1, Z1)] + [force_at(C2, u) for u in (X1, Y1)]
    unknowns.append(couple(scale(case.Ct, Z1)))  # Td - Td (1 - Ct)
    inside = [force_at(piston.a, scale(-1, piston.Rs)) for piston in pistons]
    inside += [force_at(g.O4, scale(-Rcs, g.k4)), force_at(g.O2, scale(-case.spring, g.z2))]
    outside = [force_at(scale(case.z_shaft, Z1), scale(-case.m_shaft * case.gravity, Y1)),
               couple(scale(-case.Cs * case.omega - case.I_shaft * omega_dot, Z1))]  # (37), (38)
    return unknowns, inside, outside


def solve_row(case, degrees, omega_dot=mpf(0)):
    """All reactions at one shaft angle (exact fraction), in the header's order, SI. Raises if an identity fails."""
    try:
        g = Geometry(case)
        pistons = [Piston(case, g, degrees - Fraction(360 * k, case.pistons), omega_dot) for k in range(case.pistons)]
        unknowns, inside, outside = block_system(case, g, pistons, omega_dot)
        block = solve_body(unknowns, inside + outside)
        external = outside + [scale(x, u) for x, u in zip(block[:5], unknowns)]
        unknowns, inside, outside = shaft_system(case, g, pistons, block[5], omega_dot)
        shaft = solve_body(unknowns, inside + outside)
        external += outside + [scale(x, u) for x, u in zip(shaft, unknowns)]

        power = [case.Ct * shaft[5], -case.Cs * case.omega, -case.Cc * case.omega,
                 -(case.I_shaft + case.I_block) * omega_dot]
        for piston in pistons:
            power += piston.power
            external += [piston.fluid, piston.weight] + piston.inertia
        floor = load_scale(case) * mpf(10) ** -10
        closes("power balance (over omega; virtual work at standstill)", power, floor * case.Ra)
        for i, name in enumerate(("x force", "y force", "z force", "x moment", "y moment", "z moment")):
            closes(f"{name} on the whole pump", [wrench[i] for wrench in external], floor * (1 if i < 3 else case.Ra))
    except Refused as error:
        raise Refused(f"theta {float(degrees)} deg: {error}") from None
    return [x for piston in pistons for x in piston.reactions] + block + shaft


def closes(what, terms, floor):
    """The terms must cancel, to 1e-25 of their magnitudes (of the floor, where all of them are round-off)."""
    if abs(sum(terms)) > IDENTITY_TOLERANCE * max(sum(abs(t) for t in terms), floor):
        raise Refused(f"{what} is off by {mp.nstr(sum(terms), 5)}")


def load_scale(case):
    """Largest applied force of the case: what round-off is measured against where a reaction is zero."""
    return max(case.area * abs(case.p_delivery), case.area * abs(case.p_suction), case.spring, case.F_coulomb,
               case.gravity * max(case.m_piston, case.m_block, case.m_shaft), case.m_piston * case.omega**2 * case.Ra,
               mpf(10) ** -300)


# ---------------------------------------------------------------------------------------------------------------------
# Curves
# ---------------------------------------------------------------------------------------------------------------------
def header(pistons):
    columns = ["theta_deg"]
    for k in range(1, pistons + 1):
        columns += [f"Rs_{k}_{c}_N" for c in ("x2", "y2", "z2")] + [f"Rc_{k}_{c}_N" for c in ("x2", "y2")]
    return columns + ["Fh_z2_N", "Th_x2_Nm", "Th_y2_Nm", "Rcn_x2_N", "Rcn_y2_N", "Rcs_z4_N",
                      "Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N", "Rb2_x1_N", "Rb2_y1_N", "Td_z1_Nm"]


def solve_curve(case):
    """[(angle in degrees as Fraction, values)] for one driven turn."""
    geometry = Geometry(case)
    for degree in range(360):  # the pump must go together everywhere, not only at the samples
        geometry.piston(Fraction(degree))
    angles = [Fraction(360 * i, case.samples) for i in range(case.samples)]
    return [(angle, solve_row(case, angle)) for angle in angles]


def write_curve(case, curve, path):
    text = [",".join(header(case.pistons))]
    for angle, row in curve:
        text.append(",".join([repr(float(angle))] + [mp.nstr(x, DIGITS, min_fixed=0, max_fixed=0) for x in row]))
    folder = os.path.dirname(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(dir=folder, suffix=".csv")  # whole or not at all
    with os.fdopen(handle, "w") as stream:
        stream.write("\n".join(text) + "\n")
    os.chmod(temporary, 0o644)
    os.replace(temporary, path)


def differences(case, curve, path):
    """Largest difference from a stored curve per reaction, over the peak of that reaction (its whole vector)."""
    with open(path, newline="") as stream:
        names, *rows = list(csv.reader(stream))
    if names != header(case.pistons):
        raise Refused(f"{path}: header differs from the one of this case")
    if [float(r[0]) for r in rows] != [float(angle) for angle, _ in curve]:
        raise Refused(f"{path}: angles differ from the ones of this case")
    groups = {}
    for i, name in enumerate(names[1:]):
        parts = name.split("_")
        vector = parts[0] + ("_" + parts[1] if parts[0] in ("Rs", "Rc") else "")  # Rs and Rc: one vector per piston
        groups.setdefault(parts[0], {}).setdefault(vector, []).append(i)
    result = {}
    for group, vectors in groups.items():
        peak = max(norm([row[i] for i in columns]) for _, row in curve for columns in vectors.values())
        reference = load_scale(case) * (case.Ra if group in ("Th", "Td") else 1)
        if peak < mpf(10) ** -30 * reference:
            peak = reference
        largest = max(abs(row[i] - mpf(stored[i + 1])) for (_, row), stored in zip(curve, rows)
                      for columns in vectors.values() for i in columns)
        result[group] = largest / peak
    return result


def check(job):
    """One case against one curve: (name, {group: difference} or error text)."""
    name, case_path, csv_path = job
    try:
        case = Case(case_path)
        return name, differences(case, solve_curve(case), csv_path)
    except (Refused, OSError, KeyError, ValueError) as error:
        return name, f"{type(error).__name__}: {error}"


def report(results, tolerance):
    """Print the results; 0 when all are within tolerance, else 1 (comparison) or 3 (could not be computed)."""
    status = 0
    for name, result in results:
        if isinstance(result, str):
            print(f"FAIL {name}: {result}", file=sys.stderr)
            status = 3
            continue
        worst = max(result.values())
        print(f"{'ok  ' if worst <= tolerance else 'FAIL'} {name:24s} max {mp.nstr(worst, 3):>10s}   "
              + "  ".join(f"{group} {mp.nstr(d, 2)}" for group, d in result.items()), flush=True)
        if worst > tolerance:
            status = max(status, 1)
    return status


def main():
    parser = argparse.ArgumentParser(description="High-precision reference curves of a bent-axis pump.")
    parser.add_argument("case", nargs="?", help="case file (TOML)")
    parser.add_argument("-o", "--output", help="write the curve here")
    parser.add_argument("--check", metavar="CSV", help="compare with this curve instead of writing")
    parser.add_argument("--all", metavar="DIR", help="compare every DIR/NAME/case.toml with DIR/NAME/reference.csv")
    parser.add_argument("--tolerance", type=mpf, default=mpf("1e-15"), help="of the reaction's peak (default 1e-15)")
    parser.add_argument("--jobs", type=int, default=2, help="processes for --all (default 2)")
    options = parser.parse_args()
    if options.all:
        folders = sorted(p.parent for p in Path(options.all).glob("*/case.toml"))
        if not folders or options.case or options.output or options.check:
            parser.error("--all needs a folder of NAME/case.toml and goes with no other job")
        jobs = [(f.name, f / "case.toml", f / "reference.csv") for f in folders]
        with multiprocessing.Pool(options.jobs) as pool:
            return report(pool.imap(check, jobs), options.tolerance)
    if not options.case or bool(options.output) == bool(options.check):
        parser.error("give CASE with either -o or --check, or --all DIR")
    if options.check:
        return report([check((Path(options.case).stem, options.case, options.check))], options.tolerance)
    try:
        case = Case(options.case)
        write_curve(case, solve_curve(case), options.output)
    except (Refused, OSError, KeyError, ValueError) as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
