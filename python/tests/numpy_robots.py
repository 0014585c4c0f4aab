"""Random robots and their mechanics in plain numpy, written apart from the core: the saddle system of springs and passive joints.

A limb is a list of ``("move", pose)``, ``("spring", kind, axis, stiffness)``, ``("passive", kind, axis)`` and ``("spring6", matrix)``.
Coordinates of springs are zero at rest. SI units, base axes; Jacobians about the tool's reference point [R 3.13 ff., 4.16 ff.].
"""

from __future__ import annotations

import numpy as np


def hat(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def turn(axis, angle):
    h = hat(axis)
    return np.eye(3) + np.sin(angle) * h + (1 - np.cos(angle)) * h @ h


def frame(rotation=None, position=(0, 0, 0)):
    out = np.eye(4)
    out[:3, :3] = np.eye(3) if rotation is None else rotation
    out[:3, 3] = position
    return out


def moved(kind, axis, amount):
    return frame(turn(axis, amount)) if kind == "revolute" else frame(position=amount * np.asarray(axis))


def walk(limb, springs, passive):
    """Pose of the limb's end, and its Jacobians by springs and by passive joints."""
    at, ks, kq, columns_s, columns_q = np.eye(4), 0, 0, [], []
    for kind, *what in limb:
        if kind == "move":
            at = at @ what[0]
            continue
        if kind == "spring6":
            # Linear: only at rest.
            assert not np.any(springs[ks : ks + 6])
            for axis in np.eye(3):
                columns_s.append(("prismatic", at[:3, :3] @ axis, at[:3, 3]))
            for axis in np.eye(3):
                columns_s.append(("revolute", at[:3, :3] @ axis, at[:3, 3]))
            ks += 6
            continue
        joint, axis = what[0], np.asarray(what[1])
        columns = columns_s if kind == "spring" else columns_q
        columns.append((joint, at[:3, :3] @ axis, at[:3, 3]))
        if kind == "spring":
            at = at @ moved(joint, axis, springs[ks])
            ks += 1
        else:
            at = at @ moved(joint, axis, passive[kq])
            kq += 1

    def jacobian(columns):
        out = np.zeros((6, len(columns)))
        for i, (joint, axis, place) in enumerate(columns):
            linear = np.cross(axis, at[:3, 3] - place) if joint == "revolute" else axis
            out[:, i] = [*linear, *(axis if joint == "revolute" else (0, 0, 0))]
        return out

    return at, jacobian(columns_s), jacobian(columns_q)


def spring_matrix(limb):
    blocks = [np.atleast_2d(what[-1]) for kind, *what in limb if kind in ("spring", "spring6")]
    out = np.zeros((sum(map(len, blocks)),) * 2)
    at = 0
    for block in blocks:
        out[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return out


def counts(limb):
    return len(spring_matrix(limb)), sum(kind == "passive" for kind, *_ in limb)


def cartesian_stiffness(limbs):
    """Sum over limbs of the leading block of the inverse of [J C J^T, J_q; J_q^T, 0] [R 3.20]."""
    total = np.zeros((6, 6))
    for limb in limbs:
        springs, passive = counts(limb)
        _, by_springs, by_passive = walk(limb, np.zeros(springs), np.zeros(passive))
        compliance = by_springs @ np.linalg.inv(spring_matrix(limb)) @ by_springs.T
        saddle = np.block([[compliance, by_passive], [by_passive.T, np.zeros((passive, passive))]])
        total += np.linalg.inv(saddle)[:6, :6]
    return total


def rotation_vector(r):
    angle = np.arccos(np.clip((np.trace(r) - 1) / 2, -1, 1))
    v = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / 2
    return v if angle < 1e-8 else v * angle / np.sin(angle)


def equilibrium(limbs, wrench, rounds=400):
    """Pose of the tool under a wrench, and its residual: Newton's steps without the change of the Jacobians, to the end."""
    shapes = [counts(limb) for limb in limbs]
    springs, passive = [np.zeros(n) for n, _ in shapes], [np.zeros(m) for _, m in shapes]
    tool = walk(limbs[0], springs[0], passive[0])[0]
    size = 6 + sum(n + m + 6 for n, m in shapes)
    forces = [np.zeros(6) for _ in limbs]
    for _ in range(rounds):
        # Unknown steps: tool (6); of each limb springs, passive joints, and its wrench on the tool.
        matrix, right = np.zeros((size, size)), np.zeros(size)
        right[:6] = wrench - sum(forces)
        at = 6
        for i, limb in enumerate(limbs):
            n, m = shapes[i]
            end, by_springs, by_passive = walk(limb, springs[i], passive[i])
            k = spring_matrix(limb)
            s, q, f = slice(at, at + n), slice(at + n, at + n + m), slice(at + n + m, at + n + m + 6)
            matrix[:6, f] = np.eye(6)
            matrix[s, s], matrix[s, f] = k, -by_springs.T
            matrix[q, f] = by_passive.T
            matrix[f, s], matrix[f, q], matrix[f, :6] = by_springs, by_passive, -np.eye(6)
            right[s] = by_springs.T @ forces[i] - k @ springs[i]
            right[q] = -by_passive.T @ forces[i]
            right[f] = [*(tool[:3, 3] - end[:3, 3]), *rotation_vector(tool[:3, :3] @ end[:3, :3].T)]
            at += n + m + 6
        step = np.linalg.solve(matrix, right)
        angle = np.linalg.norm(step[3:6])
        tool[:3, 3] += step[:3]
        if angle > 0:
            tool[:3, :3] = turn(step[3:6] / angle, angle) @ tool[:3, :3]
        at = 6
        for i, (n, m) in enumerate(shapes):
            springs[i] += step[at : at + n]
            passive[i] += step[at + n : at + n + m]
            forces[i] = forces[i] + step[at + n + m : at + n + m + 6]
            at += n + m + 6
        if np.abs(step[:6]).max() < 1e-15:
            break
    return tool, float(np.abs(step[:6]).max())


def unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def positive(rng, linear, angular):
    """A random stiffness (6, 6) of six independent springs somewhere off the axes."""
    a = rng.normal(size=(6, 6)) + 3 * np.eye(6)
    d = np.diag(np.sqrt([linear] * 3 + [angular] * 3))
    return d @ a @ a.T @ d / 10


def serial(rng, with_spring6):
    """One limb of six drives of any kind and axis."""
    limb = []
    for i in range(6):
        kind = "revolute" if i < 3 or rng.random() < 0.6 else "prismatic"
        stiffness = rng.uniform(1e5, 1e6) if kind == "revolute" else rng.uniform(1e6, 1e7)
        limb.append(("spring", kind, unit(rng), stiffness))
        limb.append(("move", frame(position=rng.uniform(-0.5, 0.5, 3))))
        if with_spring6 and i % 3 == 2:
            limb.append(("spring6", positive(rng, 1e7, 1e5)))
    return [limb]


def parallel(rng, with_spring6):
    """Three limbs of drives, passive joints and springs that meet at the tool."""
    tool = frame(position=rng.uniform(-0.1, 0.1, 3))
    limbs = []
    for _ in range(3):
        root = rng.uniform(-0.8, 0.8, 3)
        limb = [("move", frame(position=root)), ("spring", "prismatic", unit(rng), rng.uniform(1e6, 1e7))]
        middle = 0.5 * (tool[:3, 3] - root) + rng.uniform(-0.2, 0.2, 3)
        limb.append(("passive", "revolute", unit(rng)))
        limb.append(("move", frame(position=middle)))
        if with_spring6:
            limb.append(("spring6", positive(rng, 1e7, 1e5)))
        else:
            limb += [("spring", kind, unit(rng), 1e6 if kind == "prismatic" else 1e5) for kind in ("prismatic", "revolute") * 3]
        limb.append(("passive", "revolute", unit(rng)))
        limb.append(("move", frame(position=tool[:3, 3] - root - middle)))
        limbs.append(limb)
    return limbs


def document(limbs, name):
    """The same robot as a model file: a dictionary for ``Machine.from_dict``."""
    tables, chains, springs = [], {}, {}
    for i, limb in enumerate(limbs):
        elements = []
        for j, (kind, *what) in enumerate(limb):
            if kind == "move":
                elements.append({"rigid": {"translation_mm": (1e3 * what[0][:3, 3]).tolist()}})
            elif kind == "spring6":
                # Of (mm, rad): N/mm, N, N mm.
                scale = np.diag([1e-3] * 3 + [1.0] * 3)
                springs[f"s{i}-{j}"] = {"matrix_n_mm_rad": (1e3 * scale @ what[0] @ scale).tolist()}
                elements.append({"spring6": f"s{i}-{j}", "name": f"s{j}"})
            elif kind == "passive":
                elements.append({"passive": what[0], "axis": list(what[1]), "name": f"q{j}"})
            else:
                turning = what[0] == "revolute"
                # The first of a limb that has passive joints is its drive, and so is every one of a serial arm.
                drives = len(limbs) == 1 or j == 1
                value = {"stiffness_n_m_per_rad": what[2]} if turning else {"stiffness_n_per_mm": 1e-3 * what[2]}
                elements.append({"actuator" if drives else "spring": what[0], "axis": list(what[1]), "name": f"j{j}", **value})
        chains[f"c{i}"] = {"elements": elements}
        tables.append({"name": f"limb {i}", "from": "base", "to": "tool", "chain": f"c{i}"})
    home = walk(limbs[0], *map(np.zeros, counts(limbs[0])))[0]
    found = {
        "schema": 1,
        "mechanism": {"name": name},
        "platform": [{"name": "tool", "home": {"position_mm": (1e3 * home[:3, 3]).tolist()}}],
        "chain": chains,
        "limb": tables,
    }
    if springs:
        found["stiffness"] = springs
    return found
