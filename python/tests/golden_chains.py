"""Chains and platforms of the report against closed forms and other programs; tolerances are those of the Rust tests."""

from __future__ import annotations

import numpy as np
from golden_orthoglide import close

import kinetostat as ks
from kinetostat.curves import Judged, critical_load


def column(name, joints, at, end):
    """Hinge, rigid links of 1 m with springs of 1 N m/rad between them (angles of rest and home), hinge; in the plane x y."""
    builder = ks.MachineBuilder(name)
    builder.platform("tool", [end, 0, 0])
    limb = builder.limb("arm", to="tool").passive("q", "revolute", "z", home=at).rigid([1, 0, 0])
    for i, angle in enumerate(joints):
        limb.node(f"n{i + 1}").spring(f"th{i + 1}", "revolute", "z", 1.0, rest=angle, home=angle).rigid([1, 0, 0])
    return builder, limb.passive("e", "revolute", "z", home=-at - sum(joints))


def null_vector(q, a, b):
    """Motion of (q, th1, th2) of three links of 1 m with the end held in x and y: the unit one."""
    absolute = np.cumsum([q, a, b])
    # Column i: links from i on turn.
    x = -np.cumsum(np.sin(absolute)[::-1])[::-1]
    y = np.cumsum(np.cos(absolute)[::-1])[::-1]
    return np.linalg.svd(np.array([x, y]))[2][2]


def shape_criterion(coordinates, share):
    """S_c of [R 5.20]: n^T (H - K) n, from the share n^T H n / n^T K n of the way to buckling."""
    n = null_vector(*coordinates[:3])
    stiff = n[1] ** 2 + n[2] ** 2
    return (share - 1.0) * stiff


def z_chain(file):
    """All equilibria of the Z for each place of its end: number, shape, force, stiffness, criterion, stability."""
    posture = ks.Machine.preset("three_link_z").posture()
    deltas = sorted({row["delta"] for row in file["cases"]})
    assert len(deltas) == 6
    for delta in deltas:
        rows = [row for row in file["cases"] if row["delta"] == delta]
        found = posture.shapes(displaced=[-delta, 0, 0])
        assert found.settled
        assert found.chance_of_more < 0.03
        assert found.names == ("q", "th1", "th2", "e")
        assert len(found.energy) == len(rows), f"{delta}: {found}"
        assert (np.diff(found.energy) >= 0).all()
        # Closed form: springs of 1 N m/rad, at rest at -30 and 30 deg, are the only energy.
        rest = np.deg2rad([-30, 30])
        own = 0.5 * ((found.coordinates[:, 1:3] - rest) ** 2).sum(axis=1)
        close(found.energy - found.energy[0], own - own[0], 1e-9, f"{delta}")
        # And the end is where it is held: three links of 1 m.
        angles = np.cumsum(found.coordinates[:, :3], axis=1)
        close(np.cos(angles).sum(axis=1), np.full(len(rows), np.sqrt(5 + 4 * np.cos(np.pi / 6)) - delta), 1e-9)
        close(np.sin(angles).sum(axis=1), np.zeros(len(rows)), 1e-9)
        for row in rows:
            label = f"delta {delta}, q {row['q_deg']}"
            i = int(np.abs(np.rad2deg(found.coordinates[:, 0]) - row["q_deg"]).argmin())
            degrees = np.rad2deg(found.coordinates[i, :3])
            close(degrees, [row["q_deg"], row["theta1_deg"], row["theta2_deg"]], 2e-6, label)
            close(found.wrench[i, 0], row["F_x"], 2e-8, label)
            close(found.stiffness[i, 0, 0], row["K_x"], 1e-6, label)
            close(found.share_to_buckling[i], row["mu"], 1e-7, label)
            close(shape_criterion(found.coordinates[i], found.share_to_buckling[i]), row["S_c"], 1e-7, label)
            assert found.stable[i] == found.shape_stable[i] == row["stable"], label


def figure_5_7(file):
    """Both shapes of the straight chain, and their mirror images."""
    posture = ks.Machine.preset("three_link_s").posture()
    assert len(file["cases"]) >= 7
    for row in file["cases"]:
        found = posture.shapes(displaced=[-row["delta"], 0, 0])
        assert found.settled
        assert len(found.energy) == 4, f"two shapes and their mirror images at {row['delta']}"
        for shape, stable in (("stable", True), ("unstable", False)):
            same = np.flatnonzero(found.shape_stable == stable)
            assert len(same) == 2
            for i in same:
                label = f"{shape} at {row['delta']}"
                close(found.wrench[i, 0], row[shape]["F_x"], 2e-8, label)
                close(found.stiffness[i, 0, 0], row[shape]["K_x"], 3e-7, label)
                close(shape_criterion(found.coordinates[i], found.share_to_buckling[i]), row[shape]["S_c"], 3e-7, label)


def table_5_2(file):
    """Two rigid links with a preloaded spring under a load on their middle: the closed form [R 4.31, 4.32]."""
    a0 = np.deg2rad(file["alpha0_deg"])
    assert len(file["cases"]) == 12
    criteria = 0
    for row in file["cases"]:
        label, own = f"G/G* {row['g']}, dx {row['dx']}", row["computed"]
        load = 4 * np.sin(a0) * row["g"]
        builder, limb = column("two links", [-2 * a0], a0, 2 * np.cos(a0))
        limb.wrench("G", "n1", [0, -load, 0])
        found = builder.machine().posture().shapes(displaced=[row["dx"], 0, 0], fruitless=30)
        assert found.names == ("q", "th1", "e")
        i = int(np.abs(found.coordinates[:, 0] - own["alpha"]).argmin())
        close(found.coordinates[i, :2], [own["alpha"], -2 * own["alpha"]], 1e-9, label)
        close(found.wrench[i, 0], own["F_x"], 2e-9 * (1 + load), label)
        close(found.wrench[i, 1], own["F_y"], 1e-9, label)
        close(found.wrench[i, 5], 0.0, 1e-12, label)
        k = found.stiffness[i]
        close(k[0, 0], own["K_x"], 1e-7 * (1 + abs(own["K_x"])), label)
        close(k[1, 1], own["K_y"], 1e-7, label)
        close([k[0, 1], k[1, 0], k[5, 5]], [0, 0, 0], 1e-9, label)
        # Both x and y held: nothing inside is left to move.
        assert found.shape_stable[i], label
        assert np.isnan(found.share_to_buckling[i]), label
        criteria += sliding(row, a0, load, label)
    assert criteria == 11, "at G = G*, dx = 0 the tangent vanishes: a fold, where no iteration is regular"


def sliding(row, a0, load, label):
    """The same with a hinge that slides along x under the force F_x: one freedom inside, so that S_c is seen."""
    own = row["computed"]
    share = 1 + 1.5 * own["S_c"]  # of the unit vector (2, -1, -1) / sqrt 6 of (theta, q1, q2)
    if abs(share - 1) < 1e-3:
        return 0
    a = own["alpha"]
    builder = ks.MachineBuilder("two links, x free")
    builder.platform("tool", [2, 0, 0])
    limb = builder.limb("arm", to="tool").passive("q1", "revolute", "z", home=a).rigid([1, 0, 0]).node("middle")
    limb.spring("theta", "revolute", "z", 1.0, rest=-2 * a0, home=-2 * a).rigid([1, 0, 0]).passive("q2", "revolute", "z", home=a)
    limb.node("hinge").passive("x", "prismatic", "x", home=2 - 2 * np.cos(a))
    limb.wrench("G", "middle", [0, -load, 0]).wrench("F_x", "hinge", [own["F_x"], 0, 0])
    found = builder.machine().posture().shapes(displaced=[0, 0, 0], fruitless=30, starts=100)
    i = int(np.abs(found.coordinates[:, 0] - a).argmin())
    close(found.coordinates[i, 0], a, 1e-7, label)
    close(found.share_to_buckling[i], share, 1e-6, label)
    assert found.shape_stable[i] == (own["S_c"] < 0), label
    return 1


def cantilever(e, g, length, area, y, z, torsion):
    """Stiffness of a straight beam at its end by flexibility, corrected as [R 3.26] must be: slender, x along it."""
    flexibility = np.zeros((6, 6))
    flexibility[0, 0], flexibility[3, 3] = length / (e * area), length / (g * torsion)
    for i, j, bending, sign in ((1, 5, e * z, 1), (2, 4, e * y, -1)):
        flexibility[i, i], flexibility[j, j] = length**3 / (3 * bending), length / bending
        flexibility[i, j] = flexibility[j, i] = sign * length**2 / (2 * bending)
    return np.linalg.inv(flexibility)


def entries(table):
    """A symmetric matrix from its entries of the upper triangle."""
    out = np.zeros((6, 6))
    for key, value in table.items():
        i, j = int(key[0]) - 1, int(key[1]) - 1
        out[i, j] = out[j, i] = value
    return out


def beam(file, case=None, at_root=False):
    """A beam from a section by its rigidities, with the case's joint at its root or its end."""
    b = file["beam"]
    builder = ks.MachineBuilder("beam")
    builder.platform("tool", [b["L"], 0, 0])
    builder.section(
        "bar",
        rigidities={
            "axial_n": b["E"] * b["A"],
            "bending_y_n_mm2": 1e6 * b["E"] * b["Iy"],
            "bending_z_n_mm2": 1e6 * b["E"] * b["Iz"],
            "torsion_n_mm2": 1e6 * b["G"] * b["J"],
        },
    )
    limb = builder.limb("beam", to="tool")
    if case and at_root:
        limb.passive("q", case["kind"], case["axis"])
    limb.link("beam", "bar", b["L"])
    if case and not at_root:
        limb.passive("q", case["kind"], case["axis"])
    return builder.machine().posture().stiffness()


def beam_table(file, at_root):
    """Ratios of a table to the stiffness of the beam alone."""
    b = file["beam"]
    alone = cantilever(b["E"], b["G"], b["L"], b["A"], b["Iy"], b["Iz"], b["J"])
    size = np.sqrt(np.outer(np.diag(alone), np.diag(alone)))
    for case in file["cases"]:
        found = beam(file, case, at_root)
        worst = np.abs(found.matrix - entries(case["printed"]) * alone) / size
        assert np.isfinite(worst).all()
        assert worst.max() < 1e-10, case["joint"]
        assert found.rank == 5, case["joint"]
    return alone, size


def table_3_2(file):
    """A beam with a joint at its end, and the beam alone [R 3.26, corrected]."""
    assert len(file["cases"]) == 6
    alone, size = beam_table(file, at_root=False)
    wanted = entries(file["computed_beam"])
    for found in (alone, beam(file).matrix):
        worst = np.abs(found - wanted) / size
        assert worst.max() < 1e-11
    assert beam(file).rank == 6


def table_3_3(file):
    """A beam with a joint at its root."""
    assert len(file["cases"]) == 2
    beam_table(file, at_root=True)


def pinned_column(file):
    """Plain chains of a translation and a spring of six freedoms buckle late in compression, and falsely in tension."""
    euler = np.pi**2
    for case in file["cases"]:
        n = case["segments"]
        spring = cantilever(1.0, 1.0, 1.0 / n, 1e7, 1e4, 1.0, 1e4)
        builder = ks.MachineBuilder("column")
        builder.platform("tool", [1, 0, 0])
        limb = builder.limb("column", to="tool").passive("q", "revolute", "z")
        for i in range(n):
            limb.rigid([1 / n, 0, 0]).spring6(f"s{i}", spring)
        limb.passive("e", "revolute", "z")
        posture = builder.machine().posture()
        for key, sign in (("compression", -1), ("tension", 1)):
            critical = case[key]
            most = 50.0 if critical is None else 1.1 * critical
            if critical is None and key == "tension":
                continue
            found = critical_load(posture, [sign * euler, 0, 0], most=most, free="x,rz")
            factor = next(c for c in found.critical_loads if c.judged is Judged.SHAPE_AND_TOOL).factor
            if critical is None:
                assert np.isnan(factor), "one segment never buckles in compression"
                continue
            digits = len(str(critical).split(".")[1])
            close(factor, critical, 10.0**-digits, f"{n} segments, {key}")


def stewart_gough(file):
    """Two platforms on six legs [R 3.34, 3.35]."""
    assert [case["name"] for case in file["cases"]] == ["A", "B"]
    for case in file["cases"]:
        found = ks.Machine.preset(f"stewart_gough_{case['name'].lower()}").posture().stiffness()
        close(found.matrix, entries(case["computed"]), 1e-5, case["name"])
        assert found.rank == case["rank"]
