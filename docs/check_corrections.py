#!/usr/bin/env python3
"""Checks by calculation of docs/theory.md: its table "Corrections to the paper" (C..) and its identities (I..).

    python3 docs/check_corrections.py        prints every check; exit status 1 when one fails

Each check evaluates the equation as printed and as corrected, so that the difference shows. Where a whole pump is
needed it is the case bap63_rated, solved by the high-precision generator of the reference data.
Needs Python >= 3.11 and mpmath (Debian: python3-mpmath).
"""
import copy
import sys
from fractions import Fraction
from pathlib import Path

from mpmath import mp, mpf

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent / "reference_data"
sys.path.insert(0, str(ROOT / "generator"))
import make_reference as ref  # noqa: E402
from make_reference import X1, Y1, Z1, add, cross, dot, norm, scale, sub, value  # noqa: E402

ROUND_OFF = mpf(10) ** -30  # of a quantity of order 1 in 50-digit arithmetic: far above its error, far below a misprint
CASE = ref.Case(ROOT / "high_precision" / "bap63_rated" / "case.toml")
COLUMN = {name: i - 1 for i, name in enumerate(ref.header(CASE.pistons))}
CHECKS = []


def check(tag, title):
    def register(function):
        CHECKS.append((tag, title, function))
        return function
    return register


def show(x):
    return mp.nstr(x, 6)


def variant(**changes):
    """The default case with some attributes (SI) changed."""
    case = copy.copy(CASE)
    for key, new in changes.items():
        assert hasattr(case, key), key
        setattr(case, key, new)
    return case


def ideal(case, width, low=None, high=None):
    """The case with another ideal pressure trace about 180 deg."""
    case = copy.copy(case)
    low, high = case.p_suction if low is None else mpf(low), case.p_delivery if high is None else mpf(high)
    case.pressure = lambda deg: ref.ideal_pressure(deg, Fraction(180), Fraction(width), low, high)
    return case


def bare(**changes):
    """No inertia, weight or friction, step pressure, no port plate: what the closed forms are about."""
    zero = mpf(0)
    changes = dict(m_piston=zero, m_block=zero, m_shaft=zero, gravity=zero, F_coulomb=zero, c_viscous=zero, Cc=zero,
                   Cs=zero, Ct=mpf(1), ports=[], spring=zero) | changes
    return ideal(variant(**changes), 0)


def state(case=CASE, degrees=Fraction(25), omega_dot=mpf(0)):
    """Geometry and solved pistons at one shaft angle."""
    g = ref.Geometry(case)
    n = case.pistons
    return g, [ref.Piston(case, g, degrees - Fraction(360 * k, n), omega_dot) for k in range(n)]


def in_S2(g, v):
    return [dot(v, u) for u in (g.x2, g.y2, g.z2)]


def M(rotation_columns, origin):
    """Homogeneous matrix (4) with the given columns."""
    m = mp.eye(4)
    for j, column in enumerate(rotation_columns + [origin]):
        for i in range(3):
            m[i, j] = column[i]
    return m


def smallest_singular_value(matrix):
    return min(mp.svd_r(matrix, compute_uv=False))


def largest(matrix):
    return max(abs(x) for x in matrix)


# --------------------------------------------------------------------------------------------- frames and kinematics
@check("C01", "(5) the inverse transformation is M_mn = M_nm^-1; (7) and (8) agree with it")
def _():
    c, s, b = mp.cos(CASE.tilt), mp.sin(CASE.tilt), CASE.b
    M12 = mp.matrix([[1, 0, 0, 0], [0, c, s, 0], [0, -s, c, b], [0, 0, 0, 1]])
    M21 = mp.matrix([[1, 0, 0, 0], [0, c, -s, b * s], [0, s, c, -b * c], [0, 0, 0, 1]])
    r2 = mp.matrix([mpf("0.01"), mpf("-0.02"), mpf("0.03"), 1])
    r1 = M12 * r2
    eight = mp.matrix([r2[0], r2[1] * c + r2[2] * s, -r2[1] * s + r2[2] * c + b, 1])
    yield f"|M21 M12 - 1| = {show(largest(M21 * M12 - mp.eye(4)))}", largest(M21 * M12 - mp.eye(4)) < ROUND_OFF
    yield f"|(8) - (6)| = {show(largest(eight - r1))} m", largest(eight - r1) < ROUND_OFF
    printed = largest(M12 * r1 - r2)
    yield f"as printed, M12 applied twice misses the point by {show(printed)} m", printed > mpf("1e-3")


@check("C02", "(9) is the position of A, not of B")
def _():
    g = ref.Geometry(CASE)
    A, B = (value(x) for x in g.piston(Fraction(25))[:2])
    nine = [-CASE.Ra * mp.sin(mp.radians(25)), CASE.Ra * mp.cos(mp.radians(25)), mpf(0)]
    yield (f"(9) is b1 away from the B of (10): {show(norm(sub(B, nine)))} m",
           abs(norm(sub(B, nine)) - CASE.b1) < ROUND_OFF)
    yield (f"and lies in the joint plane on the circle Ra (A): {show(norm(sub(A, nine)))} m",
           norm(sub(A, nine)) < ROUND_OFF)


@check("C03", "(11), (12) read as z_A + sqrt(z_A^2 - a1), a1 = dx^2 + dy^2 + z_A^2 - b1^2")
def _():
    g = ref.Geometry(CASE)
    for degrees in (0, 25, 180, 290):
        A = in_S2(g, sub(value(g.piston(Fraction(degrees))[0]), g.O2))
        t = mp.radians(degrees)
        x, y = -CASE.Rd * mp.sin(t), CASE.Rd * mp.cos(t)
        a1 = (x - A[0]) ** 2 + (y - A[1]) ** 2 + A[2] ** 2 - CASE.b1**2
        B = [x, y, A[2] + mp.sqrt(A[2] ** 2 - a1)]
        yield (f"{degrees} deg: |AB| - b1 = {show(norm(sub(B, A)) - CASE.b1)} m, z_B - z_A = {show(B[2] - A[2])} m",
               abs(norm(sub(B, A)) - CASE.b1) < ROUND_OFF and B[2] > A[2])
    yield f"the negative root puts B on the shaft's side: {show(A[2] - mp.sqrt(A[2]**2 - a1))} m", A[2] ** 2 > a1


@check("C04", "(17) jumps and divides by zero where k3_y changes sign; (0, k3_z, -k3_y) / hypot does not")
def _():
    def printed(k):
        z = 1 / mp.sqrt(1 + (k[2] / k[1]) ** 2)
        return [mpf(0), -k[2] / k[1] * z, z]

    def steady(k):
        return scale(1 / mp.hypot(k[1], k[2]), [mpf(0), k[2], -k[1]])

    g = ref.Geometry(variant(tilt=mpf(0), b=mpf(0)))
    before, after = (value(g.piston(Fraction(d))[2]) for d in (Fraction(8999, 100), Fraction(9001, 100)))
    at = value(g.piston(Fraction(90))[2])
    jump = dot(printed(before), printed(after))
    yield f"tilt 0, 89.99 to 90.01 deg: printed j3.j3 = {show(jump)}", jump < mpf("-0.999")
    yield f"k3_y at 90 deg = {show(at[1])}, where (17) divides by it", at[1] == 0
    yield (f"corrected j3.j3 = {show(dot(steady(before), steady(after)))}",
           dot(steady(before), steady(after)) > mpf("0.999"))
    k = value(ref.Geometry(CASE).piston(Fraction(25))[2])
    i, j = cross(steady(k), k), steady(k)
    frame = M([i, j, k], [mpf(0)] * 3)
    yield "(18) with i3 = j3 x k3 is a right-handed orthonormal frame", (
        largest(frame.T * frame - mp.eye(4)) < ROUND_OFF and abs(dot(cross(i, j), k) - 1) < ROUND_OFF)
    yield "same direction as printed up to one sign", abs(abs(dot(printed(k), j)) - 1) < ROUND_OFF


@check("C05", "footnote 1: piston k + 1 follows k; 'clockwise' is seen from the shaft end")
def _():
    g = ref.Geometry(CASE)
    A1, A2_later = (value(g.piston(Fraction(d))[0]) for d in (10, 10 + 72 - 72))
    yield "A_2 at theta + 72 deg is A_1 at theta", norm(sub(A1, A2_later)) < ROUND_OFF
    t = mp.radians(1)
    turn = cross(Y1, [-mp.sin(t), mp.cos(t), mpf(0)])
    yield (f"theta grows from +y1 to -x1: positive about z1 ({show(turn[2])}), clockwise for who looks along +z1",
           turn[2] > 0)


# --------------------------------------------------------------------------------------------------------------- gear
@check("C06", "(19), (21), (23): O4 is the rolling point of the two pitch cones, i4 (printed 11i) points to O2")
def _():
    g = ref.Geometry(CASE)
    arm = sub(g.O4, g.O2)
    yield (f"velocity of the shaft's less the block's point at O4: {show(norm(sub(cross(Z1, g.O4), cross(g.z2, arm))))}"
           " m/s per rad/s", norm(sub(cross(Z1, g.O4), cross(g.z2, arm))) < ROUND_OFF)
    cot = CASE.b - CASE.pitch_diameter / 2 * mp.cot(mp.pi / 2 - CASE.tilt / 2)
    yield f"(19): z1 of O4 with cot(delta) less tan(alpha/2): {show(cot - g.O4[2])} m", abs(cot - g.O4[2]) < ROUND_OFF
    angles = [mp.acos(dot(arm, axis) / norm(arm)) for axis in (scale(-1, Z1), g.z2)]
    yield (f"half angles of both cones {[show(mp.degrees(x)) for x in angles]} deg = 90 - alpha/2",
           all(abs(x - (mp.pi / 2 - CASE.tilt / 2)) < ROUND_OFF for x in angles))


@check("C07", "(22) k4.i4 = 0 only with delta = 90 deg - alpha/2")
def _():
    for tilt in (40, 25, 7):
        case = variant(tilt=mp.radians(tilt))
        g = ref.Geometry(case)
        i4, ap = scale(-1 / norm(sub(g.O4, g.O2)), sub(g.O4, g.O2)), case.pressure_angle
        for name, delta in (("90 - alpha/2", mp.pi / 2 - case.tilt / 2), ("alpha/2", case.tilt / 2),
                            ("90 - alpha", mp.pi / 2 - case.tilt), ("alpha", case.tilt)):
            k4 = [-mp.cos(ap), mp.sin(ap) * mp.cos(delta), mp.sin(ap) * mp.sin(delta)]
            right = name == "90 - alpha/2"
            yield (f"alpha = {tilt}, delta = {name}: k4.i4 = {show(dot(k4, i4))}",
                   (abs(dot(k4, i4)) < ROUND_OFF) == right and abs(norm(k4) - 1) < ROUND_OFF)


@check("C08", "(22) sign(omega) on all parts, and one line of action for both flanks, pull the gears together")
def _():
    back, g = ref.Geometry(variant(omega=-CASE.omega)), ref.Geometry(CASE)
    ap, delta = CASE.pressure_angle, mp.pi / 2 - CASE.tilt / 2
    apart = [mpf(0), mp.cos(delta), mp.sin(delta)]  # normal of the pitch plane, towards the block's gear
    yield f"that normal leans towards both axes: z1 {show(apart[2])}, z2 {show(dot(apart, g.z2))}", dot(apart, g.z2) > 0
    yield f"omega > 0, Rcs > 0: separating part {show(dot(g.k4, apart))} (apart)", dot(g.k4, apart) > 0
    yield f"omega < 0, Rcs > 0: {show(dot(back.k4, apart))} as printed (together)", dot(back.k4, apart) < 0
    mirrored = [mp.cos(ap), mp.sin(ap) * mp.cos(delta), mp.sin(ap) * mp.sin(delta)]
    yield f"with sign(omega) on the x1 part only: {show(dot(mirrored, apart))} (apart)", dot(mirrored, apart) > 0
    yield f"omega > 0, Rcs < 0: {show(-dot(g.k4, apart))} as printed (together)", -dot(g.k4, apart) < 0
    torque = [dot(cross(sub(x.O4, x.O2), x.k4), x.z2) for x in (g, back)]
    want = CASE.pitch_diameter / 2 * mp.cos(ap)
    yield f"Rcs > 0 drives the block either way: {show(torque[0])}, {show(torque[1])} m = +-(d/2) cos ap", (
        abs(torque[0] - want) < ROUND_OFF and abs(torque[1] + want) < ROUND_OFF)


# ------------------------------------------------------------------------------------------------------------- piston
@check("C09", "(26) takes S1 to S2 with M12; it is M21")
def _():
    c, s = mp.cos(CASE.tilt), mp.sin(CASE.tilt)
    R12 = mp.matrix([[1, 0, 0], [0, c, s], [0, -s, c]])
    P = mp.matrix([0, -1, 0])
    right, printed = R12 * (R12.T * P), R12 * (R12 * P)
    yield f"weight back in S1: {show(right[1])} along y1 with M21", largest(right - P) < ROUND_OFF
    yield (f"with M12 it is turned by 2 alpha: {show(printed[1])} along y1, {show(printed[2])} along z1",
           abs(printed[1] + mp.cos(2 * CASE.tilt)) < ROUND_OFF)


@check("C10", "(26), (34), (35), (46), (55): of a homogeneous matrix only the rotation acts on a force")
def _():
    c, s, b = mp.cos(CASE.tilt), mp.sin(CASE.tilt), CASE.b
    M21 = mp.matrix([[1, 0, 0, 0], [0, c, -s, b * s], [0, s, c, -b * c], [0, 0, 0, 1]])
    point, free = M21 * mp.matrix([0, -10, 0, 1]), M21 * mp.matrix([0, -10, 0, 0])
    yield (f"fourth component 1 adds {show(norm(list(point - free)[:3]))} to a force of 10 N: the length b, in metres",
           abs(norm(list(point - free)[:3]) - b) < ROUND_OFF)
    yield f"fourth component 0 keeps its magnitude: {show(norm(list(free)))} N", abs(norm(list(free)) - 10) < ROUND_OFF


@check("C11", "(28) FiA = -mA aA, FiB = -mB aB")
def _():
    case = bare(m_piston=CASE.m_piston)
    case = ideal(case, 0, 0, 0)
    g, pistons = state(case)
    p = pistons[0]
    # kinetic energy by finite difference, so that no derivative of the generator enters
    def energy(t):
        def point(which, u):
            return value(g.piston(Fraction(u))[which])
        h = Fraction(1, 10**8)
        turn = 2 * ref.number(h) * mp.pi / 180
        speed = [norm(sub(point(i, t + h), point(i, t - h))) / turn * case.omega for i in (0, 1)]
        return case.m_piston / 4 * (speed[0] ** 2 + speed[1] ** 2)
    h = Fraction(1, 10**6)
    rate = (energy(25 + h) - energy(25 - h)) / (2 * ref.number(h) * mp.pi / 180) * case.omega
    A, B, _ = g.piston(Fraction(25))
    def work(rs, rc):
        return dot(rs, ref.velocity(A, case.omega)) + dot(rc, ref.velocity(B, case.omega))
    right = work(p.Rs, p.Rc)
    yield f"power of the reactions {show(right)} W = dT/dt {show(rate)} W", abs(right - rate) < mpf("1e-9") * abs(rate)
    wrong = work(scale(-1, p.Rs), scale(-1, p.Rc))
    yield f"with +m a it is {show(wrong)} W", abs(wrong - rate) > abs(rate)


@check("C12", "remark after (29): Rs is along the piston only when nothing but pressure and Rc acts on it, at B")
def _():
    for name, case in (("no mass", variant(m_piston=mpf(0))), ("as it is", CASE)):
        across = mpf(0)
        for degrees in range(0, 360, 15):
            p = ref.Piston(case, ref.Geometry(case), Fraction(degrees), mpf(0))
            across = max(across, norm(sub(p.Rs, scale(dot(p.Rs, p.e), p.e))))
        yield (f"{name}: Rs across the piston's axis up to {show(across)} N",
               (across < ROUND_OFF * 1e5) == (name == "no mass"))


@check("C13", "(32), (33): six equations, rank five; the moment about the piston's axis is the identity")
def _():
    def equations(p, keep):
        """Rows of (31), (32) for the five unknowns, components in S2, moments about O2."""
        columns = [in_S2(g, w[:3]) + in_S2(g, sub(w[3:], cross(g.O2, w[:3]))) for w in p.unknowns]
        return mp.matrix([[column[i] for column in columns] for i in keep])

    g, pistons = state(degrees=Fraction(0))
    for k in (0, 1):
        p = pistons[k]
        z_A, z_B = (in_S2(g, sub(x, g.O2))[2] for x in (p.a, p.b))
        d = abs(mp.det(equations(p, (0, 1, 2, 3, 4))))
        yield (f"piston {k + 1}: forces and moments about x2, y2: |determinant| = {show(d)} = (z_B - z_A)^2, never 0",
               abs(d - (z_B - z_A) ** 2) < ROUND_OFF)
    least = smallest_singular_value(equations(pistons[0], (0, 1, 2, 4, 5)))
    yield f"at 0 deg with the moment about z2 in place of x2 they are singular: {show(least)}", least < ROUND_OFF
    p = pistons[1]
    total = [sum(w[i] for w in p.loads) for i in range(6)]
    reaction = add(ref.force_at(p.a, p.Rs), ref.force_at(p.b, p.Rc))
    about_A = add(sub(total[3:], cross(p.a, total[:3])), sub(reaction[3:], cross(p.a, reaction[:3])))
    yield f"moment about the piston's axis {show(dot(about_A, p.e))} Nm", abs(dot(about_A, p.e)) < ROUND_OFF


@check("C14", "(30), (32): a normal force anywhere on the ring's circle passes its centre, so C_k = B_k")
def _():
    direction = [mp.cos(1), mp.sin(1), mpf(0)]
    contact = scale(mpf("0.01125"), direction)
    yield f"moment of the contact force about the centre {show(norm(cross(contact, scale(700, direction))))} Nm", (
        norm(cross(contact, scale(700, direction))) < ROUND_OFF)


# ---------------------------------------------------------------------------------------------- signs between bodies
@check("C15", "(34), (42), (43), (45), (56): the printed spring pushes shaft and block the same way")
def _():
    g, pistons = state()
    on_block, on_shaft = scale(CASE.spring, g.z2), scale(-CASE.spring, g.z2)
    yield (f"inside forces of the whole pump, corrected {show(norm(add(on_block, on_shaft)))} N",
           norm(add(on_block, on_shaft)) == 0)
    yield f"as printed {show(norm(add(on_block, on_block)))} N", norm(add(on_block, on_block)) > CASE.spring
    row = ref.solve_row(CASE, Fraction(25))
    unknowns, inside, outside = ref.shaft_system(CASE, g, pistons, row[COLUMN["Rcs_z4_N"]], mpf(0))
    inside[-1] = ref.negative(inside[-1])
    printed = ref.solve_body(unknowns, inside + outside)
    change = printed[2] - row[COLUMN["Rb1_z1_N"]]
    yield (f"Rb1_z1 changes by {show(change)} N = -2 Fm cos(alpha)",
           abs(change + 2 * CASE.spring * mp.cos(CASE.tilt)) < ROUND_OFF * 1e5)


@check("C16", "(29), (35), (42): Rs acts on the piston (the nomenclature says on the shaft); (35) drops the sign")
def _():
    g, pistons = state(bare())
    p = max(pistons, key=lambda q: q.pressure)
    z = in_S2(g, p.Rs)[2]
    yield f"p > 0 pushes the piston to -z2, Rs_z2 = {show(z)} N holds it: on the piston", z > 0 and p.pressure > 0
    yield "its opposite, -Rs, is what (42), (43) sum on the shaft; (35) prints it without the sign after the arrow", (
        abs(in_S2(g, add(p.Rs, p.Rc, p.fluid[:3]))[2]) < ROUND_OFF * 1e5)


@check("C17", "(36), (42), (55), (56): Rcs acts on the block (the nomenclature says on the shaft)")
def _():
    row = ref.solve_row(CASE, Fraction(0))
    Rcs, arm = row[COLUMN["Rcs_z4_N"]], CASE.pitch_diameter / 2 * mp.cos(CASE.pressure_angle)
    drag = -CASE.Cc * CASE.omega
    g, pistons = state(CASE, Fraction(0))
    pistons_torque = sum(dot(cross(sub(p.b, g.O2), scale(-1, p.Rc)), g.z2) for p in pistons)
    yield (f"pistons {show(pistons_torque)} + drag {show(drag)} + Rcs {show(Rcs * arm)} Nm on the block = "
           f"{show(pistons_torque + drag + Rcs * arm)}", abs(pistons_torque + drag + Rcs * arm) < ROUND_OFF * 1e5)
    yield "Rcs > 0: the shaft drives the block, as in section 7 of the paper", Rcs > 0


@check("C18", "(54), (56): Rcn acts on the block (the nomenclature says on the pin)")
def _():
    case = ideal(variant(omega=mpf(0), m_piston=mpf(0), spring=mpf(0), ports=[]), 0, 0, 0)
    row = ref.solve_row(case, Fraction(0))
    Fh, Rcn = row[COLUMN["Fh_z2_N"]], row[COLUMN["Rcn_y2_N"]]
    up = Rcn * mp.cos(case.tilt) + Fh * mp.sin(case.tilt)
    yield (f"block at rest, no pressure: Rcn and Fh lift it by {show(up)} N = m g",
           abs(up - case.m_block * case.gravity) < ROUND_OFF * 1e3)


@check("C19", "(43) takes the moments of both bearings with Rb2; the first is r_C1 x Rb1")
def _():
    g, pistons = state()
    row = ref.solve_row(CASE, Fraction(25))
    unknowns, inside, outside = ref.shaft_system(CASE, g, pistons, row[COLUMN["Rcs_z4_N"]], mpf(0))
    C1 = scale(CASE.z_C1, Z1)
    wrong = [w[:3] + [mpf(0)] * 3 for w in unknowns[:3]] + [add(w, ref.couple(cross(C1, w[:3]))) for w in unknowns[3:5]]
    for name, columns in (("corrected", unknowns), ("printed", wrong + unknowns[5:])):
        x = ref.solve_body(columns, inside + outside)
        total = [sum(w[i] for w in inside + outside) + sum(f * w[i] for f, w in zip(x, unknowns)) for i in range(6)]
        left = norm(total[3:])
        yield (f"{name}: Rb1_y1 {show(x[1])} N, Rb2_y1 {show(x[4])} N; true moment on the shaft {show(left)} Nm",
               (left < ROUND_OFF * 1e5) == (name == "corrected"))


@check("C20", "(56) adds +Fpf, (57) takes -Fpf: on the block it is -Fpf")
def _():
    g, pistons = state()
    inside = [ref.negative(p.friction) for p in pistons] + [p.friction for p in pistons]
    rest = norm([sum(w[i] for w in inside) for i in range(3)])
    yield f"friction inside the whole pump, corrected {show(rest)} N", rest < ROUND_OFF * 100
    printed = 2 * sum(dot(p.friction[:3], g.z2) for p in pistons)
    yield f"as printed in (56) {show(printed)} N along z2, all of it in Fh", abs(printed) > 1


@check("C21", "(57) lists Rcn_y twice: five unknowns; the sixth is Rcn_x")
def _():
    g, pistons = state()
    columns = ref.block_system(CASE, g, pistons, mpf(0))[0]
    for name, chosen in (("with Rcn_x", columns), ("as printed", columns[:3] + [columns[4]] + columns[4:])):
        least = smallest_singular_value(mp.matrix([[w[i] for w in chosen] for i in range(6)]))
        yield f"{name}: smallest singular value {show(least)}", (least > mpf("1e-3")) == (name == "with Rcn_x")


@check("C22", "(53) is right as printed: xh = -Th_y / Fh, yh = Th_x / Fh")
def _():
    row = ref.solve_row(CASE, Fraction(25))
    Fh, Tx, Ty = (row[COLUMN[n]] for n in ("Fh_z2_N", "Th_x2_Nm", "Th_y2_Nm"))
    point = [-Ty / Fh, Tx / Fh, mpf(0)]
    off = norm(sub(cross(point, [mpf(0), mpf(0), Fh]), [Tx, Ty, mpf(0)]))
    where = ", ".join(show(1000 * x) for x in point[:2])
    yield f"moment of Fh at ({where}) mm less Th: {show(off)} Nm", off < ROUND_OFF * 1e3


@check("C23", "(38) as printed: the proportional friction feeds energy in when Td omega < 0")
def _():
    for name, case in (("driving", CASE), ("reversed, motoring", variant(omega=-CASE.omega))):
        Td = ref.solve_row(case, Fraction(25))[COLUMN["Td_z1_Nm"]]
        power = -Td * (1 - case.Ct) * case.omega
        yield (f"{name}: Td omega = {show(Td * case.omega)} W, power of the friction {show(power)} W",
               (power > 0) == (Td * case.omega < 0))


@check("C24", "(25), (47): friction forces take power out, as printed")
def _():
    worst = mpf(0)
    for degrees in range(0, 360, 5):
        g = ref.Geometry(CASE)
        p = ref.Piston(CASE, g, Fraction(degrees), mpf(0))
        worst = max(worst, dot(p.friction[:3], ref.velocity(g.piston(Fraction(degrees))[1], CASE.omega)))
    yield f"largest power of Fpf over the turn {show(worst)} W <= 0", worst <= ROUND_OFF
    yield f"block drag {show(-CASE.Cc * CASE.omega**2)} W", -CASE.Cc * CASE.omega**2 < 0


@check("C25", "(48), (49): land force integrated exactly (the paper prints no formula)")
def _():
    mp.dps = 20
    g = ref.Geometry(CASE)
    exact = ref.land_wrench(CASE, g)
    r1, r2, r3, r4 = CASE.lands
    def profile(r):
        return (r - r1) / (r2 - r1) if r < r2 else (r4 - r) / (r4 - r3) if r > r3 else mpf(1)
    force, moment = [mpf(0)] * 3, [mpf(0)] * 3
    for p, psi1, psi2 in CASE.ports:
        if p:
            for i, f in enumerate((lambda r, a: 1, lambda r, a: r * mp.cos(a), lambda r, a: r * mp.sin(a))):
                q = mp.quad(lambda a: mp.quad(lambda r: p * profile(r) * f(r, a) * r, [r1, r2, r3, r4]), [psi1, psi2])
                force[2] -= q if i == 0 else 0
                moment[0] -= q if i == 1 else 0  # y Fz
                moment[1] -= q if i == 2 else 0  # -x Fz, x = -r sin
    numeric = g.from_S2(*force)
    about_O2 = sub(exact[3:], cross(g.O2, exact[:3]))
    mp.dps = 50
    yield (f"force {show(in_S2(g, exact[:3])[2])} N, off quadrature by {show(norm(sub(numeric, exact[:3])))} N",
           norm(sub(numeric, exact[:3])) < mpf("1e-9"))
    yield f"moment about O2 off quadrature by {show(norm(sub(g.from_S2(*moment), about_O2)))} Nm", (
        norm(sub(g.from_S2(*moment), about_O2)) < mpf("1e-11"))


@check("C26", "numbers the paper prints: Table 5.1 and footnote 9")
def _():
    yield f"63.7 cm3 x 1500 rpm = {63.7 * 1.5:.2f} l/min (95.6)", abs(63.7 * 1.5 - 95.6) < 0.06
    p = 278.8 * 2 * float(mp.pi) / 63.7e-6 / 1e5
    yield f"278.8 Nm is {p:.2f} bar", abs(p - 275) < 0.1
    yield f"329.7 N x 0.050023 m = {329.7 * 0.050023:.2f} Nm (16.49)", abs(329.7 * 0.050023 - 16.49) < 0.005
    arm = CASE.pitch_diameter / 2 * mp.cos(CASE.pressure_angle)
    yield (f"that arm is (d/2) cos ap = {show(arm)} m: the moment arm of k4 about either axis",
           abs(arm - mpf("0.050023")) < mpf("1e-6"))


@check("C27", "section 5.2: signs of Rs in S2 over the delivery half turn")
def _():
    def part(a, b, c):
        return [ref.solve_row(CASE, Fraction(d))[c] for d in range(a, b, 5)]
    yield "x2 < 0 over 185..355 deg", max(part(185, 360, 0)) < 0
    yield "y2 < 0 over 190..265 deg, > 0 over 275..350 deg", max(part(190, 270, 1)) < 0 < min(part(275, 355, 1))


# ---------------------------------------------------------------------------------- identities, closed forms
@check("C28", "Table 5.1: 41.3 cSt at p*r and 60 deg C, from the defaults of [oil]")
def _():
    # Walther's law (ASTM D341) through 46 cSt at 40 deg C and 6.8 cSt at 100 deg C, then Barus' exp(alpha p).
    points = [(mpf("313.15"), mpf(46)), (mpf("373.15"), mpf("6.8"))]
    (x1, y1), (x2, y2) = [(mp.log10(T), mp.log10(mp.log10(nu + mpf("0.7")))) for T, nu in points]
    b = (y1 - y2) / (x2 - x1)
    nu_60 = 10 ** 10 ** (y1 + b * x1 - b * mp.log10(mpf("333.15"))) - mpf("0.7")
    p = mpf("275e5")
    at_default = nu_60 * mp.exp(mpf("20e-9") * p)
    yield f"nu at 60 deg C and 0 bar: {show(nu_60)} cSt; at 275 bar with alpha = 20/GPa {show(at_default)} cSt, not 41.3", \
        abs(at_default - mpf("35.7")) < mpf("0.1")
    alpha = mp.log(mpf("41.3") / nu_60) / p * mpf("1e9")
    yield f"41.3 cSt needs alpha = {show(alpha)} /GPa, within 15..25 for mineral oil to {show(alpha - 25)}", abs(alpha - 25) < 1


@check("C29", "page 65: the forces Rs load the shaft at about 41 deg to its axis")
def _():
    rows = [ref.solve_row(CASE, Fraction(10 * i)) for i in range(36)]
    total = [sum(row[COLUMN[f"Rs_{k}_{axis}2_N"]] for row in rows for k in range(1, CASE.pistons + 1)) for axis in "xyz"]
    c, s = mp.cos(CASE.tilt), mp.sin(CASE.tilt)
    x1, y1, z1 = total[0], c * total[1] + s * total[2], -s * total[1] + c * total[2]
    degrees = mp.degrees(mp.atan2(mp.hypot(x1, y1), z1))
    yield f"default pump (tilt 40 deg): mean resultant at {show(degrees)} deg; the paper's about 41 deg says that its tilt may be larger", \
        abs(degrees - 40) < mpf("0.5")


@check("I01", "angular acceleration: power balance, whole pump and piston axis close with omega_dot = 500 rad/s^2")
def _():
    real = ref.Case(ROOT / "high_precision" / "seven_real_spinning" / "case.toml")
    for name, case in (("lumped", CASE), ("real, spinning", real)):
        a, b = (ref.solve_row(case, Fraction(25), mpf(x))[-1] for x in (0, 500))  # refuses when one does not close
        yield f"{name}: Td {show(a)} -> {show(b)} Nm", b > a
    other = variant(I_shaft=mpf(1), I_block=mpf(1))
    same = max(abs(x - y) for x, y in zip(ref.solve_row(CASE, Fraction(25)), ref.solve_row(other, Fraction(25))))
    yield f"constant speed: axial inertias change nothing ({show(same)})", same == 0


@check("I02", "block speed imposed: T_block = sign(omega) Rcs (d/2) cos ap and Ct (Td_mesh - Td_imposed) = T_block")
def _():
    for name, omega, omega_dot in (("forward", 1, 0), ("reverse", -1, 0), ("accelerated", 1, 500)):
        case = variant(omega=omega * CASE.omega)
        g, pistons = state(case, Fraction(25), mpf(omega_dot))
        mesh = ref.solve_row(case, Fraction(25), mpf(omega_dot))
        unknowns, inside, outside = ref.block_system(case, g, pistons, mpf(omega_dot))
        unknowns[5] = ref.couple(g.z2)
        T_block = ref.solve_body(unknowns, inside + outside)[5]
        unknowns, inside, outside = ref.shaft_system(case, g, pistons, mpf(0), mpf(omega_dot))
        Td = ref.solve_body(unknowns, inside + outside)[5]
        from_gear = mp.sign(omega) * mesh[COLUMN["Rcs_z4_N"]] * case.pitch_diameter / 2 * mp.cos(case.pressure_angle)
        from_Td = case.Ct * (mesh[-1] - Td)
        yield (f"{name}: T_block {show(T_block)} Nm; from Rcs {show(from_gear)}; from Td {show(from_Td)}",
               abs(T_block - from_gear) + abs(T_block - from_Td) < ROUND_OFF * 1e5)


@check("I03", "closed form b = 0, Rd = Ra (1 + cos a)/2: constant tilt of AB, sinusoidal z_B, Rs, Rc, block torque")
def _():
    c = mp.cos(CASE.tilt)
    case = bare(b=mpf(0), Rd=CASE.Ra * (1 + c) / 2)
    e = CASE.Ra * (1 - c) / 2
    h = mp.sqrt(case.b1**2 - e**2)
    g = ref.Geometry(case)
    for degrees in (205, 250, 333):
        p, t = ref.Piston(case, g, Fraction(degrees), mpf(0)), mp.radians(degrees)
        pA = p.pressure * case.area
        want = scale(pA, [e * mp.sin(t) / h, e * mp.cos(t) / h, mpf(1)])
        error = norm(sub(in_S2(g, p.Rs), want)) + norm(sub(in_S2(g, p.Rc), [-want[0], -want[1], mpf(0)]))
        z = in_S2(g, p.b)[2] - (case.Ra * mp.sin(case.tilt) * mp.cos(t) + h)
        torque = dot(cross(p.b, scale(-1, p.Rc)), g.z2) + pA * (e / h) * case.Rd * mp.sin(2 * t)
        yield f"{degrees} deg: Rs, Rc off by {show(error)} N, z_B by {show(z)} m, torque by {show(torque)} Nm", (
            error + abs(z) + abs(torque) < ROUND_OFF * 1e6)


@check("I04", "ideal torque: Td = sum p A dz_B/dtheta; mean displacement x dp / 2 pi; a transition lowers it by w^2/40")
def _():
    case = bare()
    g = ref.Geometry(case)
    row = ref.solve_row(case, Fraction(25))
    gradient = sum(case.pressure(d) * case.area * dot(ref.gradient(g.piston(d)[1]), g.z2)
                   for d in (Fraction(25) - Fraction(72 * k) for k in range(5)))
    yield f"Td - sum p A dz/dtheta = {show(row[-1] - gradient)} Nm", abs(row[-1] - gradient) < ROUND_OFF * 1e5
    def z(d):
        return dot(sub(value(g.piston(Fraction(d))[1]), g.O2), g.z2)
    ideal_mean = 5 * case.area * (z(0) - z(180)) * case.p_delivery / (2 * mp.pi)
    # the mean over a turn of all pistons is N times the mean of one: integrate by Gauss-Legendre between the edges
    def mean(width):
        c = ideal(case, width)
        def f(d):
            d = Fraction(str(mp.nstr(d, 30)))
            return c.pressure(d) * case.area * dot(ref.gradient(g.piston(d)[1]), g.z2)
        half = Fraction(width) / 2
        edges = sorted({mpf(0), ref.number(half), mpf(180) - ref.number(half), mpf(180) + ref.number(half),
                        mpf(360) - ref.number(half), mpf(360)})
        nodes = ((mpf("0.5384693101056830910363144"), mpf("0.4786286704993664680412915")),
                 (mpf("0.9061798459386639927976269"), mpf("0.2369268850561890875142640")))
        total = mpf(0)
        for a, b in zip(edges, edges[1:]):
            n = 12
            for i in range(n):
                lo, step = a + (b - a) * i / n, (b - a) / n
                mid = lo + step / 2
                total += step / 2 * (mpf(128) / 225 * f(mid) + sum(
                    w * (f(mid + x * step / 2) + f(mid - x * step / 2)) for x, w in nodes))
        return 5 * total / 360
    full = mean(0)
    yield (f"mean {show(full)} Nm, displacement x dp / 2 pi = {show(ideal_mean)} Nm",
           abs(full / ideal_mean - 1) < mpf("1e-10"))
    for width in (5, 20):
        loss, rule = 1 - mean(width) / full, mp.radians(width) ** 2 / 40
        yield f"w = {width} deg: lowered by {show(loss)}, w^2/40 = {show(rule)}", abs(loss / rule - 1) < mpf("0.02")


@check("I05", "ripple of the closed form: order 2N, 2/((2N)^2-1) for odd N >= 3; order N, 2/(N^2-1) for even N")
def _():
    for N in (3, 5, 6, 7, 8):
        period = 2 * N if N % 2 else N
        smooth = 360 / mpf(period)  # no piston passes an edge within it
        def f(t):  # sum of -p dz_B/dtheta over the delivering pistons, in units of dp Ra sin(alpha)
            return mp.fsum(-mp.sin(mp.radians(x)) for x in ((t - mpf(360) * k / N) % 360 for k in range(N)) if x >= 180)
        mp.dps = 20
        mean = mp.quad(f, [mpf(0), smooth]) / smooth
        amplitude = 2 * mp.quad(lambda t: f(t) * mp.cos(mp.radians(period * t)), [mpf(0), smooth]) / smooth / mean
        mp.dps = 50
        want = mpf(2) / (period**2 - 1)
        yield (f"N = {N}: order {period}, {show(100 * abs(amplitude))} % (formula {show(100 * want)} %)",
               abs(abs(amplitude) - want) < mpf("1e-12"))
        repeat = max(abs(f(mpf(x) + mpf("0.3")) - f(mpf(x) + mpf("0.3") + smooth)) for x in range(0, 360, 17))
        yield f"N = {N}: repeats after {show(smooth)} deg, so no other multiples ({show(repeat)})", repeat < ROUND_OFF


@check("I06", "stroke: z_B(0) - z_B(180) in closed form; extreme b adds stationary points, then it is max - min")
def _():
    for b_mm in (mpf("0.1"), mpf(4), mpf("-66.5")):
        case = variant(b=b_mm / 1000)
        g = ref.Geometry(case)
        def z(d):
            return dot(sub(value(g.piston(Fraction(d))[1]), g.O2), g.z2)
        s, c = mp.sin(case.tilt), mp.cos(case.tilt)
        formula = 2 * case.Ra * s + mp.sqrt(case.b1**2 - (case.Rd - case.Ra * c - case.b * s) ** 2) - mp.sqrt(
            case.b1**2 - (case.Rd - case.Ra * c + case.b * s) ** 2)
        every = [z(d) for d in range(360)]
        stroke = max(every) - min(every)
        yield (f"b = {show(b_mm)} mm: formula off by {show(formula - (z(0) - z(180)))} m",
               abs(formula - (z(0) - z(180))) < ROUND_OFF)
        yield (f"b = {show(b_mm)} mm: max - min = {show(stroke * 1000)}, z_B(0) - z_B(180) = {show(formula * 1000)} mm",
               (stroke > formula * (1 + mpf("1e-6"))) == (b_mm < -60))


@check("I07", "a shift by 360/N permutes the pistons; pressure forces scale with p, inertia forces with omega^2")
def _():
    a, b = ref.solve_row(CASE, Fraction(25)), ref.solve_row(CASE, Fraction(25 + 72))
    moved = b[5:25] + b[:5]
    permuted = max([abs(x - y) for x, y in zip(a[:25], moved)] + [abs(x - y) for x, y in zip(a[25:], b[25:])])
    yield f"shift by 72 deg: {show(permuted)}", permuted < ROUND_OFF * 1e6
    one, two = bare(), bare()
    two = ideal(two, 0, 0, 2 * CASE.p_delivery)
    p = max(abs(2 * x - y) for x, y in zip(ref.solve_row(one, Fraction(25)), ref.solve_row(two, Fraction(25))))
    yield f"pressure doubled: {show(p)}", p < ROUND_OFF * 1e6
    real = ref.Case(ROOT / "high_precision" / "seven_real_spinning" / "case.toml")
    rows = []
    for factor in (1, 2):
        case = copy.copy(real)
        for key in ("gravity", "F_coulomb", "Cc", "Cs", "spring"):
            setattr(case, key, mpf(0))
        case.ports, case.omega, case.spin = [], factor * real.omega, factor * real.spin
        rows.append(ref.solve_row(ideal(case, 0, 0, 0), Fraction(25)))
    w = max(abs(4 * x - y) for x, y in zip(*rows))
    yield f"speed and spin doubled: {show(w)}", w < ROUND_OFF * 1e6


@check("I08", "the explicit solutions of the three bodies and the explicit derivatives of z_B given in docs/theory.md")
def _():
    case, degrees = CASE, Fraction(25)
    g, pistons = state(case, degrees)
    row, worst, kinematics = ref.solve_row(case, degrees), mpf(0), mpf(0)
    c, s = mp.cos(case.tilt), mp.sin(case.tilt)
    k = [dot(g.k4, u) for u in (g.x2, g.y2, g.z2)]
    for p, d, i in zip(pistons, (degrees - 72 * n for n in range(5)), range(0, 25, 5)):
        total = [sum(w[i] for w in p.loads) for i in range(6)]
        F, M_A, L = (in_S2(g, v) for v in (total[:3], sub(total[3:], cross(p.a, total[:3])), sub(p.b, p.a)))
        X, Y = -M_A[1] / L[2], M_A[0] / L[2]
        worst = max([worst] + [abs(x - y) for x, y in zip([-F[0] - X, -F[1] - Y, -F[2], X, Y], row[i:i + 5])])
        t = mp.radians(ref.number(d))
        C, S = mp.cos(t), mp.sin(t)
        u = [-(case.Rd - case.Ra) * S, (case.Rd - case.Ra * c) * C - case.b * s]
        u1 = [-(case.Rd - case.Ra) * C, -(case.Rd - case.Ra * c) * S]
        u2 = [-u[0], -(case.Rd - case.Ra * c) * C]
        uu, uu1 = u[0] ** 2 + u[1] ** 2, u[0] * u1[0] + u[1] * u1[1]
        q = mp.sqrt(case.b1**2 - uu)
        first = -case.Ra * s * S - uu1 / q
        second = -case.Ra * s * C - (u1[0] ** 2 + u1[1] ** 2 + u[0] * u2[0] + u[1] * u2[1]) / q - uu1**2 / q**3
        B = g.piston(d)[1]
        z = dot(B, g.z2)
        kinematics = max([kinematics, abs(z.d - first), abs(z.dd - second),
                          abs(case.Ra * s * C - case.b * c + q - dot(sub(p.b, g.O2), g.z2))])
    yield f"z_B, its derivatives: {show(kinematics)} m", kinematics < ROUND_OFF
    yield f"pistons: {show(worst)} N", worst < ROUND_OFF * 1e5

    _, inside, outside = ref.block_system(case, g, pistons, mpf(0))
    total = [sum(w[i] for w in inside + outside) for i in range(6)]
    F, M_O2 = in_S2(g, total[:3]), in_S2(g, sub(total[3:], cross(g.O2, total[:3])))
    Rcs = -M_O2[2] / (case.pitch_diameter / 2 * mp.cos(case.pressure_angle))
    Rcn = [-F[0] - Rcs * k[0], -F[1] - Rcs * k[1]]
    m = cross([mpf(0), case.pitch_diameter / 2, case.pitch_diameter / 2 * mp.tan(case.tilt / 2)], scale(Rcs, k))
    block = [-F[2] - Rcs * k[2], -M_O2[0] - m[0] + case.z_pin * Rcn[1], -M_O2[1] - m[1] - case.z_pin * Rcn[0]]
    worst = max(abs(x - y) for x, y in zip(block + Rcn + [Rcs], row[25:31]))
    yield f"block: {show(worst)}", worst < ROUND_OFF * 1e5

    _, inside, outside = ref.shaft_system(case, g, pistons, Rcs, mpf(0))
    total = [sum(w[i] for w in inside + outside) for i in range(6)]
    F, M_C1, D = total[:3], sub(total[3:], cross(scale(case.z_C1, Z1), total[:3])), case.z_C2 - case.z_C1
    Rb2 = [-M_C1[1] / D, M_C1[0] / D]
    shaft = [-F[0] - Rb2[0], -F[1] - Rb2[1], -F[2]] + Rb2 + [-total[5] / case.Ct]
    worst = max(abs(x - y) for x, y in zip(shaft, row[31:]))
    yield f"shaft: {show(worst)}", worst < ROUND_OFF * 1e5


@check("I09", "lumped pistons are real ones with s_G = (1 - chi) b1, It = chi (1 - chi) m b1^2, Ia = 0")
def _():
    lumped = variant(chi=mpf("0.37"), s_G=(1 - mpf("0.37")) * CASE.b1)
    real = variant(lumped=False, s_G=lumped.s_G, I_t=lumped.chi * (1 - lumped.chi) * CASE.m_piston * CASE.b1**2)
    off = max(abs(x - y) for x, y in zip(ref.solve_row(lumped, Fraction(25)), ref.solve_row(real, Fraction(25))))
    yield f"largest difference of any reaction {show(off)}", off < ROUND_OFF * 1e5


@check("I10", "(10.3)-(10.5): free motion, derivatives of a piston's axis where shaft and block move on their own")
def _():
    case, b, b1 = CASE, CASE.b, CASE.b1
    c, s = mp.cos(case.tilt), mp.sin(case.tilt)
    def theta(t):
        return mpf("0.7") + 150 * t + 4000 * t**2
    def psi(t):
        return mpf("0.68") + 140 * t - 2500 * t**2
    def across(t):
        return [-case.Rd * mp.sin(psi(t)) + case.Ra * mp.sin(theta(t)),
                case.Rd * mp.cos(psi(t)) - case.Ra * c * mp.cos(theta(t)) - b * s]
    def length(t):
        return mp.sqrt(b1**2 - sum(u * u for u in across(t)))
    th, ps, w, v, dw, dv = theta(0), psi(0), mpf(150), mpf(140), mpf(8000), mpf(-5000)
    lag, lag1, lag2 = th - ps, w - v, dw - dv
    S, C = mp.sin(th), mp.cos(th)
    versine = 2 * mp.sin(lag / 2) ** 2
    ds, dc = -C * mp.sin(lag) - S * versine, S * mp.sin(lag) - C * versine
    ds1, dc1 = v * dc - lag1 * C, -v * ds + lag1 * S
    ds2 = dv * dc - v**2 * ds - lag2 * C + lag1 * (w + v) * S
    dc2 = -dv * ds - v**2 * dc + lag2 * S + lag1 * (w + v) * C
    S1, C1, S2, C2 = C * w, -S * w, C * dw - S * w**2, -S * dw - C * w**2
    u = [[-(case.Rd - case.Ra) * x - case.Rd * dx, (case.Rd - case.Ra * c) * y + case.Rd * dy - off]
         for x, dx, y, dy, off in ((S, ds, C, dc, b * s), (S1, ds1, C1, dc1, 0), (S2, ds2, C2, dc2, 0))]
    ell = mp.sqrt(b1**2 - sum(x * x for x in u[0]))
    ell1 = -sum(x * y for x, y in zip(u[0], u[1])) / ell
    ell2 = -(sum(x * x for x in u[1]) + sum(x * y for x, y in zip(u[0], u[2])) + ell1**2) / ell
    for order, found in enumerate((ell, ell1, ell2)):
        numeric = mp.diff(length, 0, order, h=mpf("1e-14"))
        error = max([abs(numeric - found) / max(abs(found), 1)] + [
            abs(mp.diff(lambda t: across(t)[i], 0, order, h=mpf("1e-14")) - u[order][i]) for i in (0, 1)])
        yield f"derivative {order}: u and l off by {show(error)}", error < mpf("1e-8")


@check("I11", "(10.11): a mirrored flank changes no torque, and adds 2 |Ft| sin ap across the pitch plane")
def _():
    g = ref.Geometry(CASE)
    ap, half, Ft = CASE.pressure_angle, CASE.tilt / 2, mpf(-100)
    side = [-mp.cos(ap), mpf(0), mpf(0)]
    apart = [mpf(0), mp.sin(ap) * mp.sin(half), mp.sin(ap) * mp.cos(half)]
    one = add(scale(Ft, side), scale(Ft, apart))
    two = add(scale(Ft, side), scale(abs(Ft), apart))
    for name, axis, origin in (("z1", Z1, [mpf(0)] * 3), ("z2", g.z2, g.O2)):
        torque = [dot(cross(sub(g.O4, origin), f), axis) for f in (one, two)]
        yield (f"torque about {name}: {show(torque[0])}, {show(torque[1])} Nm",
               abs(torque[0] - torque[1]) < ROUND_OFF * 1e3)
    change = sub(two, one)
    normal = scale(1 / norm(apart), apart)
    size = 2 * abs(Ft) * mp.sin(ap)
    yield f"change of the force {show(norm(change))} N = 2 |Ft| sin ap, along the normal of the pitch plane", (
        norm(sub(change, scale(size, normal))) < ROUND_OFF * 1e3)
    yield "which is across the line from O4 to O2", abs(dot(change, sub(g.O2, g.O4))) < ROUND_OFF * 1e3


@check("I12", "(13.5): a transition of w lowers the mean torque by w^2/40 (z''(180) - z''(0))/(z(0) - z(180))")
def _():
    mp.dps = 25
    for name, changes in (("default", {}), ("b = -40 mm", {"b": mpf(-40) / 1000})):
        case = bare(**changes)
        c, s = mp.cos(case.tilt), mp.sin(case.tilt)
        def z(t):
            u = [-(case.Rd - case.Ra) * mp.sin(t), (case.Rd - case.Ra * c) * mp.cos(t) - case.b * s]
            return case.Ra * s * mp.cos(t) - case.b * c + mp.sqrt(case.b1**2 - u[0] ** 2 - u[1] ** 2)
        def step(x, w):
            t = (x + w / 2) / w
            return t * t * (3 - 2 * t)
        w = mpf(1) / 50
        def lost(edge, rising):
            def missing(x):
                share = step(x, w) if rising else 1 - step(x, w)
                return ((1 if (x > 0) == rising else 0) - share) * mp.diff(z, edge + x)
            return mp.quad(missing, [-w / 2, 0]) + mp.quad(missing, [0, w / 2])
        loss = (lost(mp.pi, True) + lost(2 * mp.pi, False)) / (z(0) - z(mp.pi))
        factor = (mp.diff(z, mp.pi, 2) - mp.diff(z, 0, 2)) / (z(0) - z(mp.pi))
        rule = w**2 / 40 * factor
        yield f"{name}: factor {show(factor)}, lowered by {show(loss)}, rule {show(rule)}", (
            abs(loss / rule - 1) < mpf("1e-5") and (abs(factor - 1) < mpf("1e-4")) == (name == "default"))
    mp.dps = 50


@check("I13", "(B.9): a force in the plane of action has the moment r F sin(delta_b) about both axes, wherever it acts")
def _():
    g = ref.Geometry(CASE)
    ap, delta = CASE.pressure_angle, mp.pi / 2 - CASE.tilt / 2
    sin_base = mp.sin(delta) * mp.cos(ap)
    u0 = scale(1 / norm(sub(g.O4, g.O2)), sub(g.O4, g.O2))
    n = cross(u0, g.k4)  # normal of the plane of action
    for axis, cone in ((scale(-1, Z1), "shaft"), (g.z2, "block")):
        yield (f"the plane touches the base cone of the {cone}: |n.axis| = {show(abs(dot(n, axis)))} = sin delta_b",
               abs(abs(dot(n, axis)) - sin_base) < ROUND_OFF)
    for degrees in (-20, 0, 15):
        u = add(scale(mp.cos(mp.radians(degrees)), u0), scale(mp.sin(mp.radians(degrees)), g.k4))
        moment = cross(scale(mpf("0.05"), u), scale(100, cross(n, u)))
        yield (f"{degrees} deg along the path: {show(dot(moment, g.z2))} Nm about z2",
               abs(dot(moment, g.z2) - mpf(5) * sin_base) < ROUND_OFF * 1e3
               and abs(dot(moment, Z1) - mpf(5) * sin_base) < ROUND_OFF * 1e3)


def main():
    failed = 0
    for tag, title, function in CHECKS:
        print(f"{tag}  {title}")
        for text, good in function():
            print(f"     {'ok  ' if good else 'FAIL'} {text}")
            failed += not good
    print(f"{len(CHECKS)} checks, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
