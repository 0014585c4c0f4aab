"""Orientations, sections and superelements against SciPy, quadrature and numpy; tolerances are those of the Rust tests."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
from golden_orthoglide import close

import kinetostat as ks

DATA = Path(__file__).resolve().parents[2] / "crates/kinetostat-links/tests/data"


def orientations(file):
    """Every convention of an orientation in a model."""
    document = ks.Machine.preset("two_link").to_dict()
    for case in file["cases"]:
        document["platform"][-1]["home"] = {case["key"]: case["numbers"]}
        close(ks.Machine.from_dict(document).home[:3, :3], case["matrix"], 1e-14, str(case["numbers"]))
    counts = Counter(case["key"] for case in file["cases"])
    assert len(counts) == 7
    assert min(counts.values()) >= 20


def link(shape, length, shear, *, tip=None, youngs=70.0, nu=0.0):
    """Compliance of one straight link at its end."""
    builder = ks.MachineBuilder("link")
    builder.platform("tool", [length, 0, 0])
    builder.section("s", **shape, youngs_modulus_gpa=youngs, poissons_ratio=nu, tip=tip, shear=shear)
    builder.limb("link", to="tool").link("link", "s", length)
    return builder.machine().posture().stiffness().compliance


def sections(file):
    """A tapered link, torsion and shear, from models."""
    root = {"rectangle": {"width_mm": 60, "height_mm": 100}}
    c = link(root, 0.5, "timoshenko", tip={"rectangle": {"width_mm": 30, "height_mm": 40}})
    places = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "rxrx": (3, 3), "ryry": (4, 4), "rzrz": (5, 5), "yrz": (1, 5), "zry": (2, 4)}
    wanted = file["tapered_rectangle_compliance_si"]
    assert set(wanted) == set(places)
    for name, at in places.items():
        close(c[at] / wanted[name], 1.0, 1e-11, name)
    # Torsion: C = L / (G J).
    g, length = 70e9 / 2, 0.1
    bar = link({"rectangle": {"width_mm": 30, "height_mm": 100}}, length, "none")
    close(length / (g * bar[3, 3]) * 1e12 / file["torsion_100_x_30_mm4"], 1.0, 1e-10)
    # Shear: what it adds to the compliance across is L / (G kappa A). A difference of two compliances has fewer digits.
    for name, shape, area in (
        ("thin_i_kappa_nu_0", {"i_beam": {"width_mm": 80, "height_mm": 120, "flange_mm": 6, "web_mm": 8}}, 2 * 80 * 6 + 108 * 8),
        (
            "thin_box_kappa_nu_0",
            {"hollow_box": {"width_mm": 80, "height_mm": 120, "side_wall_mm": 4, "top_wall_mm": 6}},
            2 * 80 * 6 + 2 * 108 * 4,
        ),
    ):
        added = link(shape, length, "timoshenko")[2, 2] - link(shape, length, "none")[2, 2]
        close(length / (g * added * area * 1e-6) / file[name], 1.0, 1e-10, name)


def frame(file):
    """A space frame of seven nodes, condensed by the command that imports matrices."""
    for name, interface, end in (("rigid_5_6_7_n_mm_rad", "5,6,7", file["end_mm"]), ("node_5_n_mm_rad", "5", None)):
        axes = np.array(file["axes"])
        found = ks.commands.import_matrix(
            DATA / "frame.bdf",
            nodes=DATA / "frame.bdf",
            interface=interface,
            fixed="1,2",
            units="n-mm",
            end_mm=end,
            x_axis=axes[:, 0].tolist(),
            y_axis=axes[:, 1].tolist(),
        )
        wanted = np.array(file[name])
        size = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted)))
        worst = np.abs(np.array(found["stiffness_n_mm_rad"]) - wanted) / size
        assert np.isfinite(worst).all()
        assert worst.max() < 1e-9, name
