"""Frequencies after a loaded step by OpenSees, for comparison with kinetostat-dynamics.

Reads one JSON object from the standard input:
  section   E, G, A, Iy, Iz, J, density
  points    corners of the axis of the frame, m; the first is clamped
  elements  elements of each straight piece
  ends      "free" (only the first point is clamped) or "pinned" (both ends hinged in the plane x-y)
  plane     true: only x, y and the turn about z move
  force     dead force on the last point, N
  tip_mass  kg at the last point, without inertia
  count     how many frequencies

The corotational transformation carries bending and axial load together; mass along the elements is consistent.
Writes {"frequencies_hz": [...], "tip": [x, y, z], "version": "..."}. Exit code 3: OpenSees is not installed.
"""

import json
import os
import sys

try:
    # OpenSees writes its banner and its farewell where it likes.
    kept = os.dup(1)
    os.dup2(2, 1)
    import openseespy.opensees as ops
    import numpy as np
except (ImportError, RuntimeError, OSError):
    sys.exit(3)


def main():
    asked = json.load(sys.stdin)
    s = asked["section"]
    points = np.array(asked["points"], float)
    n = asked["elements"]
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    nodes = [points[0]]
    for a, b in zip(points[:-1], points[1:]):
        nodes += [a + (b - a) * (i + 1) / n for i in range(n)]
    for i, p in enumerate(nodes):
        ops.node(i + 1, *map(float, p))
    last = len(nodes)
    if asked["ends"] == "pinned":
        ops.fix(1, 1, 1, 1, 1, 1, 0)
        ops.fix(last, 0, 1, 1, 1, 1, 0)
    else:
        ops.fix(1, 1, 1, 1, 1, 1, 1)
    if asked.get("plane"):
        for i in range(2, last):
            ops.fix(i, 0, 0, 1, 1, 1, 0)
        if asked["ends"] != "pinned":
            ops.fix(last, 0, 0, 1, 1, 1, 0)
    # Local y lies in the plane x-y: local z is base z, so Iz bends in the plane.
    ops.geomTransf("Corotational", 1, 0.0, 0.0, 1.0)
    for i in range(last - 1):
        ops.element(
            "elasticBeamColumn", i + 1, i + 1, i + 2, s["A"], s["E"], s["G"], s["J"], s["Iy"], s["Iz"], 1,
            "-mass", s["density"] * s["A"], "-cMass",
        )
    if asked.get("tip_mass"):
        m = asked["tip_mass"]
        ops.mass(last, m, m, m, 0.0, 0.0, 0.0)
    force = asked["force"]
    if any(force):
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        ops.load(last, *map(float, force), 0.0, 0.0, 0.0)
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormDispIncr", 1e-12, 100)
        ops.algorithm("Newton")
        ops.integrator("LoadControl", 0.05)
        ops.analysis("Static")
        if ops.analyze(20) != 0:
            sys.exit("the loaded step did not converge")
    values = ops.eigen(asked["count"])
    found = {
        "frequencies_hz": [float(np.sign(v) * np.sqrt(abs(v)) / 2 / np.pi) for v in values],
        "tip": [float(x + d) for x, d in zip(nodes[-1], ops.nodeDisp(last)[:3])],
        "version": str(ops.version()),
    }
    os.write(kept, json.dumps(found).encode())


main()
