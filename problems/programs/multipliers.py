"""Rigid bodies and constraints with Lagrange multipliers, for the problem set: positions by Newton's method, velocities
and accelerations from the constraints, reactions as multipliers.

Nothing here is specific to a problem. Numbers are doubles, and numpy is all that is needed; given an mpmath context,
the same lines compute with as many digits as it has.

A body has the place r of its centre of mass and a matrix R whose columns are its axes, both in the fixed frame; v and
w are its velocity and angular velocity there. A reaction is what its constraint exerts on the first body.
"""
import numpy as np


class Numbers:
    """Doubles, or the numbers of an mpmath context."""

    def __init__(self, mp=None):
        self.mp, self.math = mp, mp if mp else np
        self.pi = +mp.pi if mp else np.pi

    def array(self, values):
        if self.mp is None:
            return np.array(values, dtype=float)
        flat = np.array(values, dtype=object)
        return np.array([self.mp.mpf(x) for x in flat.ravel()], dtype=object).reshape(flat.shape)

    def cos(self, x):
        return self.math.cos(x)

    def sin(self, x):
        return self.math.sin(x)

    def sqrt(self, x):
        return self.math.sqrt(x)

    def tiny(self):
        return 1e-14 if self.mp is None else self.mp.mpf(10) ** (8 - self.mp.dps)

    def solve(self, matrix, right):
        """x of matrix x = right, by elimination with pivots; zeros are passed over."""
        if self.mp is None:
            return np.linalg.solve(matrix, right)
        rows = [list(row) + [b] for row, b in zip(matrix, right)]
        n = len(rows)
        for k in range(n):
            pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
            if rows[pivot][k] == 0:
                raise ValueError("the constraints are redundant or too few")
            rows[k], rows[pivot] = rows[pivot], rows[k]
            head = rows[k]
            places = [j for j in range(k + 1, n + 1) if head[j] != 0]
            for row in rows[k + 1:]:
                if row[k] != 0:
                    factor = row[k] / head[k]
                    for j in places:
                        row[j] -= factor * head[j]
        x = [None] * n
        for k in range(n - 1, -1, -1):
            x[k] = (rows[k][n] - sum(rows[k][j] * x[j] for j in range(k + 1, n) if rows[k][j] != 0)) / rows[k][k]
        return np.array(x, dtype=object)


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


class Body:
    def __init__(self, number, mass=0, inertia=(0, 0, 0), r=(0, 0, 0), R=np.eye(3)):
        """inertia: about the centre of mass in body axes: three moments, or a matrix."""
        self.number, self.mass = number, mass
        inertia = number.array(inertia)
        self.inertia = inertia if inertia.ndim == 2 else number.array(np.diag(inertia))
        self.r, self.R = number.array(r), number.array(R)
        self.v, self.w = number.array([0, 0, 0]), number.array([0, 0, 0])

    def direction(self, a):
        return self.R.dot(a)

    def point(self, s):
        return self.r + self.R.dot(s)


class Ground:
    """Fixed; its axes are those of the fixed frame."""

    def __init__(self, number):
        self.number = number
        self.v = self.w = self.r = number.array([0, 0, 0])

    def direction(self, a):
        return self.number.array(a)

    point = direction


class Constraint:
    """Scalar equations of two bodies: rows() gives (row of body 1, row of body 2), each of six numbers (v, w)."""

    def __init__(self, one, two):
        self.one, self.two, self.multipliers = one, two, None

    def errors(self):
        return [self.one.number.array(0)[()]] * len(self.rows())

    def speeds(self):
        return [self.one.number.array(0)[()]] * len(self.rows())

    def wrench(self, about):
        """Force and moment on body 1 about a point of the fixed frame."""
        force, moment = 0, 0
        for (row, _), x in zip(self.rows(), self.multipliers):
            force, moment = force + x * row[:3], moment + x * row[3:]
        return force, moment + cross(self.one.r - about, force)


class Ball(Constraint):
    """Points of two bodies coincide along fixed axes (all three by default). The multipliers are the force on body 1
    along them. With `sliding` the force on body 2 acts where body 1's point is, not at body 2's own."""

    def __init__(self, one, s1, two, s2, axes=np.eye(3), sliding=False):
        super().__init__(one, two)
        self.s1, self.s2, self.sliding = one.number.array(s1), one.number.array(s2), sliding
        self.axes = one.number.array(axes)

    def arms(self):
        p1 = self.one.point(self.s1)
        return p1 - self.one.r, (p1 if self.sliding else self.two.point(self.s2)) - self.two.r

    def errors(self):
        return list(self.axes.dot(self.one.point(self.s1) - self.two.point(self.s2)))

    def rows(self):
        arm1, arm2 = self.arms()
        return [(np.concatenate([a, cross(arm1, a)]), -np.concatenate([a, cross(arm2, a)])) for a in self.axes]

    def bias(self):
        arm1, arm2 = self.arms()
        w1, w2 = self.one.w, self.two.w
        return list(-self.axes.dot(cross(w1, cross(w1, arm1)) - cross(w2, cross(w2, arm2))))


class Angle(Constraint):
    """Directions of two bodies keep the cosine of their angle (0: a right angle)."""

    def __init__(self, one, a1, two, a2, cosine=0):
        super().__init__(one, two)
        self.a1, self.a2, self.cosine = one.number.array(a1), one.number.array(a2), cosine

    def errors(self):
        return [self.one.direction(self.a1).dot(self.two.direction(self.a2)) - self.cosine]

    def rows(self):
        normal = cross(self.one.direction(self.a1), self.two.direction(self.a2))
        none = self.one.number.array([0, 0, 0])
        return [(np.concatenate([none, normal]), -np.concatenate([none, normal]))]

    def bias(self):
        a1, a2, w1, w2 = self.one.direction(self.a1), self.two.direction(self.a2), self.one.w, self.two.w
        return [-(w1 - w2).dot(cross(cross(w1, a1), a2) + cross(a1, cross(w2, a2)))]


class Drive(Constraint):
    """A body turns about a fixed axis: its direction a points to `target`, with given speed and acceleration. The
    multiplier is the torque."""

    def __init__(self, one, a, axis, target, speed, acceleration=0):
        super().__init__(one, Ground(one.number))
        array = one.number.array
        self.a, self.axis, self.target = array(a), array(axis), array(target)
        self.speed, self.acceleration = speed, acceleration

    def errors(self):
        return [cross(self.target, self.one.direction(self.a)).dot(self.axis)]

    def speeds(self):
        return [self.speed]

    def rows(self):
        none = self.one.number.array([0, 0, 0])
        return [(np.concatenate([none, self.axis]), np.concatenate([none, none]))]

    def bias(self):
        return [self.acceleration]


class Spin(Constraint):
    """The absolute spin of a body about its own direction a."""

    def __init__(self, one, a, speed):
        super().__init__(one, Ground(one.number))
        self.a, self.speed = one.number.array(a), speed

    def speeds(self):
        return [self.speed]

    def rows(self):
        none = self.one.number.array([0, 0, 0])
        return [(np.concatenate([none, self.one.direction(self.a)]), np.concatenate([none, none]))]

    def bias(self):
        return [self.one.number.array(0)[()]]


class Mesh(Constraint):
    """Both bodies have the same velocity along a fixed direction at a fixed point: teeth in contact. Where the bodies
    start in mesh, the angles follow."""

    def __init__(self, one, two, point, direction):
        super().__init__(one, two)
        self.point, self.k = one.number.array(point), one.number.array(direction)

    def rows(self):
        return [(np.concatenate([self.k, cross(self.point - self.one.r, self.k)]),
                 -np.concatenate([self.k, cross(self.point - self.two.r, self.k)]))]

    def bias(self):
        return [cross(self.one.v, self.k).dot(self.one.w) - cross(self.two.v, self.k).dot(self.two.w)]


class System:
    """Bodies with constraints. Loads are (body, point, force) in the fixed frame, couples (body, moment)."""

    def __init__(self, number, bodies, constraints):
        self.number, self.bodies, self.constraints = number, bodies, constraints
        self.place = {id(body): 6 * i for i, body in enumerate(bodies)}

    def matrix(self):
        rows = []
        for constraint in self.constraints:
            for one, two in constraint.rows():
                row = self.number.array(np.zeros(6 * len(self.bodies)))
                for body, part in ((constraint.one, one), (constraint.two, two)):
                    if id(body) in self.place:
                        at = self.place[id(body)]
                        row[at:at + 6] += part
                rows.append(row)
        return np.array(rows)

    def each(self, what):
        return self.number.array([x for constraint in self.constraints for x in getattr(constraint, what)()])

    def assemble(self):
        """Moves the bodies until no constraint is violated, each step the smallest that its linear part asks for."""
        for _ in range(60):
            errors = self.each("errors")
            if max(abs(x) for x in errors) < self.number.tiny():
                return
            G = self.matrix()
            step = -G.T.dot(self.number.solve(G.dot(G.T), errors))
            for body in self.bodies:
                at = self.place[id(body)]
                body.r = body.r + step[at:at + 3]
                body.R = turned(self.number, body.R, step[at + 3:at + 6])
        raise ValueError("the mechanism does not assemble")

    def move(self):
        """Velocities from the constraints, where these determine them."""
        velocities = self.number.solve(self.matrix(), self.each("speeds"))
        for body in self.bodies:
            at = self.place[id(body)]
            body.v, body.w = velocities[at:at + 3], velocities[at + 3:at + 6]

    def solve(self, loads=(), couples=()):
        """Multipliers of every constraint; returns the accelerations (v', w') of the bodies."""
        n = 6 * len(self.bodies)
        G, bias = self.matrix(), self.each("bias")
        mass, known = self.number.array(np.zeros((n, n))), self.number.array(np.zeros(n))
        for body in self.bodies:
            at = self.place[id(body)]
            inertia = body.R.dot(body.inertia).dot(body.R.T)
            for i in range(3):
                mass[at + i, at + i] = body.mass
            mass[at + 3:at + 6, at + 3:at + 6] = inertia
            known[at + 3:at + 6] -= cross(body.w, inertia.dot(body.w))
        for body, point, force in loads:
            at = self.place[id(body)]
            known[at:at + 3] += force
            known[at + 3:at + 6] += cross(point - body.r, force)
        for body, moment in couples:
            at = self.place[id(body)]
            known[at + 3:at + 6] += moment
        if len(G) == n:  # the motion is given: two systems of half the size
            accelerations = self.number.solve(G, bias)
            multipliers = self.number.solve(G.T, mass.dot(accelerations) - known)
        else:
            whole = np.concatenate([np.concatenate([mass, -G.T], axis=1),
                                    np.concatenate([G, self.number.array(np.zeros((len(G), len(G))))], axis=1)])
            both = self.number.solve(whole, np.concatenate([known, bias]))
            accelerations, multipliers = both[:n], both[n:]
        at = 0
        for constraint in self.constraints:
            count = len(constraint.rows())
            constraint.multipliers = multipliers[at:at + count]
            at += count
        return accelerations


def turned(number, R, step):
    """R after a rotation by the vector `step`, exactly orthonormal (Cayley's formula), for Newton's steps."""
    half = step / 2
    a, b, c = half
    square = a * a + b * b + c * c
    skew = number.array([[0, -c, b], [c, 0, -a], [-b, a, 0]])
    unit = number.array(np.eye(3))
    return (unit + (skew + skew.dot(skew)) * (2 / (1 + square))).dot(R)
