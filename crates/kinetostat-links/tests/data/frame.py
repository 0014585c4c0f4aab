"""Golden values of a space frame, independent of kinetostat: numpy, dense.

Seven nodes, eight Timoshenko beams in skew directions. Nodes 1, 2 are fixed; nodes 5, 6, 7 are the
interface. Writes frame.bdf (GRID and DMIG, large field, N and mm) and frame.json: the 6 x 6 stiffness at a
stated end in stated axes when the interface is one rigid body, and when it carries node 5 alone.
"""
import json
import numpy as np

rng = np.random.default_rng(20241)
P = {1: (0, 0, 0), 2: (0, 300, 20), 3: (250, 40, 60), 4: (260, 280, -30), 5: (600, 60, 10), 6: (610, 260, 30), 7: (590, 150, 190)}
BEAMS = [(1, 3), (2, 4), (3, 4), (3, 5), (4, 6), (3, 6), (5, 7), (4, 7)]
E, NU = 70000.0, 0.33
G = E / (2 + 2 * NU)


def beam(a, b, k):
    p, q = np.array(P[a], float), np.array(P[b], float)
    L = np.linalg.norm(q - p)
    x = (q - p) / L
    t = np.array([0, 0, 1.0]) if abs(x[2]) < 0.9 else np.array([1.0, 0, 0])
    y = np.cross(t, x)
    y /= np.linalg.norm(y)
    R = np.vstack([x, y, np.cross(x, y)])  # rows: own axes
    w, h = 30 + 3 * k, 40 + 2 * k
    A, Iy, Iz = w * h, w * h**3 / 12, h * w**3 / 12
    J = 0.2 * w * h * min(w, h) ** 2
    kap = 5 / 6
    K = np.zeros((12, 12))

    def put(i, v):
        for a_, s in i:
            for b_, r in i:
                K[a_, b_] += s * r * v

    put([(0, 1), (6, -1)], E * A / L)
    put([(3, 1), (9, -1)], G * J / L)
    for (d, r, I, s) in [(1, 5, Iz, 1), (2, 4, Iy, -1)]:
        f = 12 * E * I / (kap * G * A * L**2)
        c = E * I / ((1 + f) * L**3)
        m = c * np.array([[12, 6 * L, -12, 6 * L], [6 * L, (4 + f) * L**2, -6 * L, (2 - f) * L**2],
                          [-12, -6 * L, 12, -6 * L], [6 * L, (2 - f) * L**2, -6 * L, (4 + f) * L**2]])
        sg = np.array([1, s, 1, s])
        m = m * np.outer(sg, sg)
        ix = [d, r, d + 6, r + 6]
        K[np.ix_(ix, ix)] += m
    T = np.kron(np.eye(4), R)
    return T.T @ K @ T


n = sorted(P)
at = {v: 6 * i for i, v in enumerate(n)}
K = np.zeros((42, 42))
for k, (a, b) in enumerate(BEAMS):
    ix = list(range(at[a], at[a] + 6)) + list(range(at[b], at[b] + 6))
    K[np.ix_(ix, ix)] += beam(a, b, k)

ROUND = {}
lines = ["$ space frame, N and mm; written by frame.py"]
for v in n:
    lines.append("%-8s%16d%16s%16.6f%16.6f" % ("GRID*", v, "", P[v][0], P[v][1]))
    lines.append("%-8s%16.6f" % ("*", P[v][2]))
lines.append("%-8s%-8s%8d%8d%8d%8d" % ("DMIG", "KAAX", 0, 6, 2, 0))
Kr = np.zeros_like(K)
for j in range(42):
    col = [(i, K[i, j]) for i in range(j, 42) if K[i, j] != 0]
    lines.append("%-8s%-16s%16d%16d" % ("DMIG*", "KAAX", n[j // 6], j % 6 + 1))
    for i, v in col:
        t = "%16.9E" % v
        Kr[i, j] = Kr[j, i] = float(t)
        lines.append("%-8s%16d%16d%16s" % ("*", n[i // 6], i % 6 + 1, t.replace("E", "D")))
open("frame.bdf", "w").write("\n".join(lines) + "\n")
K = Kr


def hat(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


END = np.array([620.0, 150.0, 70.0])
a = np.array([1.0, 0.2, -0.1]); a /= np.linalg.norm(a)
b = np.array([0.0, 1.0, 0.3]); b -= a * (a @ b); b /= np.linalg.norm(b)
AX = np.column_stack([a, b, np.cross(a, b)])


def answer(interface, end):
    """Compliance from six unit wrenches on the constrained system: u = T q."""
    free = [v for v in n if v not in (1, 2) and v not in interface]
    T = np.zeros((42, 6 * len(free) + 6))
    for c, v in enumerate(free):
        T[at[v]:at[v] + 6, 6 * c:6 * c + 6] = np.eye(6)
    for v in interface:
        T[at[v]:at[v] + 3, -6:-3] = np.eye(3)
        T[at[v]:at[v] + 3, -3:] = -hat(np.array(P[v]) - end)
        T[at[v] + 3:at[v] + 6, -3:] = np.eye(3)
    C = np.linalg.inv(T.T @ K @ T)[-6:, -6:]
    turn = np.kron(np.eye(2), AX)
    return np.linalg.inv(turn.T @ C @ turn).tolist()


json.dump({"end_mm": END.tolist(), "axes": AX.tolist(), "rigid_5_6_7_n_mm_rad": answer([5, 6, 7], END),
           "node_5_n_mm_rad": answer([5], np.array(P[5], float))}, open("frame.json", "w"), indent=1)
