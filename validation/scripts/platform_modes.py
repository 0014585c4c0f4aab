"""Modes of one loaded platform machine from its energies alone: numbers for a test of kinetostat-dynamics.

Written from the theory (dynamics.md D1, D2, D5, D7; bowing of equations.md section 4). One thing was taken from the
library afterwards: its links strain by the rotation vector of their three turns, where the theory has the turns
themselves (modes of links then differ by up to 8e-6). One function gives the potential energy of a leg and the poses of its bodies, everything else is
differences of it. First derivatives are by complex steps, second ones by fourth-order differences of those, so no
Jacobian, Hessian or geometric stiffness is written down anywhere.

The machine (off every axis, on purpose): six legs between the ground and a platform. A leg: frame on the ground,
universal joint about its y and z, a drive (spring along x with a rest length), a link of 0.45 to 0.6 m of section S
in one segment with its mass, a body with products of inertia at its end, a ball joint (x, y, z), platform.

Prints the equilibrium, signed frequencies, the loaded stiffness and a receptance. Needs numpy; no input.
"""

import itertools
import json
import sys

try:
    import numpy as np
except ImportError:
    sys.exit(3)

E, G, AREA, IY, IZ, JT, RHO = 2.1e11, 8e10, 6e-4, 3e-8, 7e-8, 9e-8, 7850.0
DRIVE, REST = 3.0e6, [0.004, -0.002, 0.003, 0.001, -0.003, 0.002]
GRAVITY = np.array([1.2, -0.7, -9.6])
FORCE = np.array([2500.0, -1800.0, -4000.0])
GROUND = np.array([[0.62, 0.05, 0.01], [0.28, 0.55, -0.02], [-0.35, 0.52, 0.03], [-0.6, -0.08, 0.0], [-0.27, -0.58, 0.02], [0.38, -0.5, -0.03]])
ANCHOR = np.array([[0.21, 0.19, 0.02], [0.13, 0.24, -0.01], [-0.25, 0.12, 0.0], [-0.27, 0.03, 0.03], [0.02, -0.3, -0.02], [0.16, -0.22, 0.01]])
HOME = np.array([0.03, -0.02, 0.55])
LINKS = [0.45, 0.5, 0.55, 0.6, 0.52, 0.47]
PLATFORM = (35.0, np.array([0.02, -0.03, 0.07]), np.array([[1.1, 0.1, -0.05], [0.1, 1.3, 0.08], [-0.05, 0.08, 1.9]]))
BODY = (2.5, np.array([0.05, 0.02, -0.03]), np.array([[0.02, 0.003, -0.002], [0.003, 0.03, 0.004], [-0.002, 0.004, 0.025]]))


def rot(axis, a):
    c, s = np.cos(a), np.sin(a)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    r = np.eye(3, dtype=complex if np.iscomplexobj(a) else float)
    r[i, i] = r[j, j] = c
    r[i, j], r[j, i] = -s, s
    return r


def rotation_vector(rx, ry, rz):
    """Of Rx Ry Rz, small, by its quaternion; arcsin by its series."""
    a, b, c = np.cos(rx / 2), np.cos(ry / 2), np.cos(rz / 2)
    d, e, f = np.sin(rx / 2), np.sin(ry / 2), np.sin(rz / 2)
    x, y, z = d * b * c + a * e * f, a * e * c - d * b * f, a * b * f + d * e * c
    q = x * x + y * y + z * z
    by = 2 * (1 + q / 6 + 3 * q**2 / 40 + 15 * q**3 / 336 + 105 * q**4 / 3456 + 945 * q**5 / 42240)
    return by * x, by * y, by * z


def frame(k):
    """Ground frame of a leg: x towards its anchor at home, by the shortest turn from base x."""
    way = HOME + ANCHOR[k] - GROUND[k]
    length = np.linalg.norm(way)
    x, t = np.array([1.0, 0, 0]), way / length
    v, c = np.cross(x, t), x @ t
    hat = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + hat + hat @ hat / (1 + c), length


FRAMES = [frame(k) for k in range(6)]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)
NODES, WEIGHTS = (NODES + 1) / 2, WEIGHTS / 2


def leg(k, x):
    """Elastic energy, end pose (R, p) and bodies [(mass, centre, R, inertia)] of a leg; 12 coordinates."""
    turn, length = FRAMES[k]
    h = LINKS[k]
    r, p = turn.astype(x.dtype), GROUND[k].astype(x.dtype)
    r = r @ rot(1, x[0]) @ rot(2, x[1])
    energy = 0.5 * DRIVE * (x[2] - REST[k]) ** 2
    p = p + r @ np.array([length - h + x[2], 0 * x[2], 0 * x[2]])
    u, v, w, rx, ry, rz = x[3:9]
    # Bending: exact 6x6 of a prismatic beam; bowing in both planes. Strains of turns are those of the rotation vector.
    fx, fy, fz = rotation_vector(rx, ry, rz)
    bow = 0.5 * (1.2 * v * v / h - 0.2 * v * fz + 2 / 15 * h * fz * fz)
    bow = bow + 0.5 * (1.2 * w * w / h + 0.2 * w * fy + 2 / 15 * h * fy * fy)
    energy = energy + 0.5 * E * AREA / h * (u + bow) ** 2 + 0.5 * G * JT / h * fx * fx
    energy = energy + 0.5 * E * IZ * (12 * v * v / h**3 - 12 * v * fz / h**2 + 4 * fz * fz / h)
    energy = energy + 0.5 * E * IY * (12 * w * w / h**3 + 12 * w * fy / h**2 + 4 * fy * fy / h)
    bodies = []
    for xi, g in zip(NODES, WEIGHTS):
        a, b = 3 * xi**2 - 2 * xi**3, xi**3 - xi**2
        da, db = 6 * (xi - xi**2), 3 * xi**2 - 2 * xi
        place = np.array([xi * h + xi * u, a * v + h * b * rz, a * w - h * b * ry])
        turns = rot(0, xi * rx) @ rot(1, -da * w / h + db * ry) @ rot(2, da * v / h + db * rz)
        mass = RHO * AREA * h * g
        bodies.append((mass, p + r @ place, r @ turns, RHO * h * g * np.diag([IY + IZ, IY, IZ])))
    p = p + r @ np.array([h + u, v, w])
    r = r @ rot(0, rx) @ rot(1, ry) @ rot(2, rz)
    bodies.append((BODY[0], p + r @ BODY[1], r, BODY[2]))
    r = r @ rot(0, x[9]) @ rot(1, x[10]) @ rot(2, x[11])
    return energy, r @ turn.T, p, bodies


def platform(t):
    return rot(0, t[3]) @ rot(1, t[4]) @ rot(2, t[5]), HOME + t[:3]


def lagrangian(k, y, lam):
    """Potential energy of a leg and its closure times multipliers; y = (12 of the leg, 6 of the platform)."""
    energy, r, p, bodies = leg(k, y[:12])
    value = energy - sum(m * (GRAVITY @ c) for m, c, _, _ in bodies)
    return value + lam @ closure(k, y, r, p)


def closure(k, y, r=None, p=None):
    if r is None:
        _, r, p, _ = leg(k, y[:12])
    pr, pp = platform(y[12:])
    d = pr.T @ r
    return np.concatenate([p - pp - pr @ ANCHOR[k], [d[2, 1] - d[1, 2], d[0, 2] - d[2, 0], d[1, 0] - d[0, 1]]])


def own(t):
    r, p = platform(t)
    return -PLATFORM[0] * (GRAVITY @ (p + r @ PLATFORM[1])) - FORCE @ p


def gradient(f, y):
    rows = []
    for i in range(len(y)):
        z = y.astype(complex)
        z[i] += 1e-40j
        rows.append(np.imag(f(z)) / 1e-40)
    return np.array(rows)


def hessian(f, y, step=2e-4):
    h = np.zeros((len(y), len(y)))
    for i in range(len(y)):
        e = np.zeros(len(y))
        e[i] = step
        h[i] = (8 * (gradient(f, y + e) - gradient(f, y - e)) - gradient(f, y + 2 * e) + gradient(f, y - 2 * e)) / (12 * step)
    return 0.5 * (h + h.T)


def index(k):
    return np.r_[12 * k:12 * k + 12, 72:78]


def mass_of(bodies_of, y):
    """M by differences of centres and orientations of bodies."""
    n = len(y)
    base = bodies_of(y)
    velocities = []
    for i in range(n):
        z = y.astype(complex)
        z[i] += 1e-40j
        row = []
        for (m, c, r, inertia), (_, _, r0, _) in zip(bodies_of(z), base):
            s = np.imag(r) / 1e-40 @ r0.T
            row.append((np.imag(c) / 1e-40, np.array([s[2, 1], s[0, 2], s[1, 0]])))
        velocities.append(row)
    mass = np.zeros((n, n))
    for b, (m, c, r, inertia) in enumerate(base):
        v = np.array([velocities[i][b][0] for i in range(n)])
        w = np.array([velocities[i][b][1] for i in range(n)])
        mass += m * v @ v.T + w @ (r @ inertia @ r.T) @ w.T
    return mass


def assemble(y, lam):
    grad, hess = np.zeros(78), np.zeros((78, 78))
    constraint, jac = np.zeros(36), np.zeros((36, 78))
    for k in range(6):
        i = index(k)
        f = lambda z, k=k: lagrangian(k, z, lam[6 * k:6 * k + 6])
        grad[i] += gradient(f, y[i])
        hess[np.ix_(i, i)] += hessian(f, y[i])
        constraint[6 * k:6 * k + 6] = closure(k, y[i])
        jac[6 * k:6 * k + 6, i] = gradient(lambda z, k=k: closure(k, z), y[i]).T
    grad[72:] += gradient(own, y[72:])
    hess[72:, 72:] += hessian(own, y[72:])
    return grad, hess, constraint, jac


def main():
    y, lam = np.zeros(78), np.zeros(36)
    for _ in range(12):
        grad, hess, constraint, jac = assemble(y, lam)
        kkt = np.block([[hess, jac.T], [jac, np.zeros((36, 36))]])
        step = np.linalg.solve(kkt, -np.concatenate([grad, constraint]))
        y, lam = y + step[:78], lam + step[78:]
        if np.abs(step[:78]).max() < 1e-13:
            break
    grad, hess, constraint, jac = assemble(y, lam)
    residual = max(np.abs(grad).max() / 1e4, np.abs(constraint).max())
    _, _, vt = np.linalg.svd(jac)
    null = vt[36:].T
    mass = np.zeros((78, 78))
    for k in range(6):
        i = np.arange(12 * k, 12 * k + 12)
        mass[np.ix_(i, i)] += mass_of(lambda z, k=k: leg(k, z)[3], y[i])

    def carried(t):
        r, p = platform(t)
        return [(PLATFORM[0], p + r @ PLATFORM[1], r, PLATFORM[2])]

    mass[72:, 72:] += mass_of(carried, y[72:])
    twist = np.zeros((6, 6))
    r0, p0 = platform(y[72:])
    for i in range(6):
        z = y[72:].astype(complex)
        z[i] += 1e-40j
        r, p = platform(z)
        s = np.imag(r) / 1e-40 @ r0.T
        twist[:, i] = np.r_[np.imag(p) / 1e-40, s[2, 1], s[0, 2], s[1, 0]]
    motion = twist @ null[72:]
    kr, mr = null.T @ hess @ null, null.T @ mass @ null
    low = np.linalg.inv(np.linalg.cholesky(mr))
    squared, shapes = np.linalg.eigh(low @ kr @ low.T)
    motion = motion @ low.T @ shapes
    compliance = (motion / squared) @ motion.T
    at = 2 * np.pi * 37.0
    result = {
        "residual": residual,
        "translation": p0.tolist(),
        "rotation": r0.ravel().tolist(),
        "frequencies_hz": (np.sign(squared) * np.sqrt(np.abs(squared)) / 2 / np.pi).tolist(),
        "stiffness": np.linalg.inv(compliance).tolist(),
        "receptance_37_hz": ((motion / (squared - at * at)) @ motion.T).tolist(),
        "total_mass": float(sum(b[0] for k in range(6) for b in leg(k, y[:12])[3]) + PLATFORM[0]),
    }
    json.dump(result, sys.stdout, indent=1)


main()
