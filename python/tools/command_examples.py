"""Examples of the functions of kinetostat.commands: short, on machines that come along, run as doctests.

What stands here goes into the Examples section of the function; answers are asked for by their keys, with few digits.
"""

from __future__ import annotations

import textwrap

_FILE = """
>>> import tempfile
>>> from pathlib import Path
>>> import kinetostat as ks
>>> with tempfile.TemporaryDirectory() as folder:
...     file = Path(folder, "{name}")
...     _ = file.write_text({text!r})
"""

_PROGRAM = "G21 G90 G54\nG0 X-20 Y0 Z10\nG1 Z-1 F600\nG1 X20\nG0 Z10\nM30\n"
_CRANE = (
    '<robot name="crane"><link name="post"/><link name="boom"/><joint name="shoulder" type="revolute"><parent link="post"/>'
    '<child link="boom"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="0" velocity="1"/></joint></robot>'
)

_SLOT = (
    'schema = 1\nmodel = "heavy_6r"\nprogram = "slot.ngc"\n[placement]\npart_origin_mm = [1450, 70, 500]\n[tool]\nlength_mm = 200\n'
    'cutter = { shape = "flat", diameter_mm = 12, teeth = 2 }\n[material]\nname = "linear aluminium"\n'
    '[engagement]\nwidth_mm = 12\ndepth_mm = 3\npart = "right"\n'
)


def _with_file(name: str, text: str, rest: str) -> str:
    return _FILE.format(name=name, text=text).strip() + "\n" + textwrap.dedent(rest).strip()


EXAMPLES: dict[str, str] = {
    "assemble": """
>>> import kinetostat as ks
>>> found = ks.commands.assemble("orthoglide", deviation="leg x:foot arm:1deg about x")
>>> found["over_constraint"]["degree"], found["most_strained_limb"]
(3, 'leg x')
""",
    "chatter": _with_file(
        "slot.toml",
        _SLOT,
        """
        ...     _ = Path(folder, "slot.ngc").write_text(
        ...         "G21 G90 G17\\nT1 M6\\nS3000 M3\\nG0 X0 Y0 Z5\\nG1 Z-3 F600\\nG1 X40\\nG0 Z5\\nM30\\n"
        ...     )
        ...     found = ks.commands.chatter(file, damping=[0.03])
        >>> found["chatters"], [stretch["first_line"] for stretch in found["stretches"]]
        (True, [6])
        """,
    ),
    "check": """
>>> import kinetostat as ks
>>> found = ks.commands.check("orthoglide", force=[100, 0, 0])
>>> found["home"]["mobility"], found["home"]["degrees_of_over_constraint"], found["warnings"]
(3, 3, [])
""",
    "compare": """
>>> import kinetostat as ks
>>> found = ks.commands.compare("stewart_gough_a", "stewart_gough_b")
>>> place = found["places"][0]
>>> place["b"]["smallest_stiffness_n_per_mm"] > place["a"]["smallest_stiffness_n_per_mm"]
True
""",
    "compensate": _with_file(
        "groove.ngc",
        _PROGRAM,
        """
        ...     found = ks.commands.compensate(
        ...         model="orthoglide", program=file, force=[100, -20, -30], out=Path(folder, "corrected.ngc")
        ...     )
        >>> found["tolerance"]["held"], found["summary"]["blocks"]
        (True, 6)
        """,
    ),
    "convert": _with_file(
        "groove.ngc",
        _PROGRAM,
        """
        ...     said = ks.commands.convert(file, to="apt", out=Path(folder, "groove.apt"))
        ...     text = Path(folder, "groove.apt").read_text()
        >>> text.count("GOTO/")
        4
        """,
    ),
    "curve": """
>>> import kinetostat as ks
>>> found = ks.commands.curve("three_link_z", direction=[1, 0, 0], displacement_mm=[0, -200])
>>> [point["kind"] for point in found["named_points"]]
['start', 'pitchfork', 'end', 'end', 'end']
""",
    "deflect": """
>>> import kinetostat as ks
>>> found = ks.commands.deflect("orthoglide", force=[100, 0, 0])
>>> found["stable"], round(found["displacement_mm"][0], 4)
(True, 0.0333)
""",
    "demo": """
>>> import os, tempfile
>>> import kinetostat as ks
>>> with tempfile.TemporaryDirectory() as folder:
...     found = ks.commands.demo(out=folder)
...     files = os.listdir(folder)
>>> found["tolerance"]["held"], "report.html" in files
(True, True)
""",
    "dialect_list": """
>>> import kinetostat as ks
>>> "krl" in ks.commands.dialect_list()
True
""",
    "dialect_show": """
>>> import kinetostat as ks
>>> found = ks.commands.dialect_show("krl")
>>> next(word["treatment"] for word in found["words"] if word["word"] == "LIN")
'followed'
""",
    "engagement": _with_file(
        "groove.ngc",
        _PROGRAM,
        """
        ...     found = ks.commands.engagement(
        ...         program=file, material="soft aluminium", tool="flat", diameter_mm=10, teeth=2, rpm=6000,
        ...         width_mm=5, depth_mm=1, part="left", rotation="clockwise",
        ...     )
        >>> found["cutting"]["largest_force"]["depth_mm"], found["warnings"]
        (1.0, [])
        """,
    ),
    "equilibria": """
>>> import kinetostat as ks
>>> found = ks.commands.equilibria("three_link_z", displaced_mm=[-1, 0, 0])
>>> [shape["stable"] for shape in found["equilibria"]]
[True, False]
""",
    "expand": _with_file(
        "loop.ngc",
        "G21 G90\n#1=0\nO1 WHILE [#1 LT 3]\nG1 X[#1*10] F600\n#1=[#1+1]\nO1 ENDWHILE\nM30\n",
        """
        ...     text = ks.commands.expand(file)
        >>> text.count("X")
        3
        """,
    ),
    "force": """
>>> import kinetostat as ks
>>> found = ks.commands.force(
...     material="soft aluminium", tool="flat", diameter_mm=10, teeth=2, helix_deg=30, width_mm=5, depth_mm=1, climb=True,
...     rpm=6000, feed_per_tooth_mm=0.05,
... )
>>> len(found["mean"]["force_n"]), found["cut"]["milling"]
(3, 'climb')
""",
    "import_link_displacements": """
>>> import tempfile
>>> from pathlib import Path
>>> import numpy as np
>>> import kinetostat as ks
>>> arms = np.array([[0, 5, 0], [0, -5, 3], [0, 0, -6], [2, 1, 1]])  # of nodes from the end at 10 mm along x
>>> lines = ["case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm"]
>>> for case, shift, turn in [(f"f{a}", e / 20, 0 * e) for a, e in zip("xyz", np.eye(3))] + [
...     (f"m{a}", 0 * e, e / 5000) for a, e in zip("xyz", np.eye(3))
... ]:
...     for node, arm in enumerate(arms):
...         numbers = [*(arm + [10, 0, 0]), *(shift + np.cross(turn, arm))]
...         lines.append(",".join([case, str(node), *(repr(float(x)) for x in numbers)]))
>>> with tempfile.TemporaryDirectory() as folder:
...     file = Path(folder, "u.csv")
...     _ = file.write_text("\\n".join(lines))
...     found = ks.commands.import_link_displacements(file, end_mm=[10, 0, 0], force_n=100, moment_n_mm=1000)
>>> round(found["stiffness_n_mm_rad"][0][0]), round(found["stiffness_n_mm_rad"][3][3])
(2000, 5000000)
""",
    "import_matrix": """
>>> import tempfile
>>> from pathlib import Path
>>> import numpy as np
>>> import kinetostat as ks
>>> rows = [",".join(str(x) for x in row) for row in np.diag([1e5, 1e4, 1e4, 1e7, 1e8, 1e8])]
>>> with tempfile.TemporaryDirectory() as folder:
...     file = Path(folder, "boom.csv")
...     _ = file.write_text("\\n".join(rows))
...     found = ks.commands.import_matrix(file, units="n-mm")
>>> found["name"], found["rank"]
('boom', 6)
""",
    "import_urdf": _with_file(
        "crane.urdf",
        _CRANE,
        """
        ...     found = ks.commands.import_urdf(file, joint_stiffness=2e5)
        >>> found["robot"], found["actuators"]
        ('crane', ['shoulder'])
        """,
    ),
    "map": """
>>> import kinetostat as ks
>>> found = ks.commands.map("orthoglide", x=[-50, 50, 3])
>>> found["places"]["regular"], found["figures"][0]["unit"]
(3, 'N/mm')
""",
    "mirror": _with_file(
        "groove.ngc",
        "G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\nM30\n",
        """
        ...     measured = Path(folder, "trial1.csv")
        ...     _ = measured.write_text("x_mm,y_mm,z_mm\\n" + "".join(f"{x},0.05,0\\n" for x in range(41)))
        ...     found = ks.commands.mirror(file, measured=measured, register="none", out=Path(folder, "trial2.ngc"))
        >>> found["outcome"], round(found["left_mm"], 3), round(found["largest_correction_mm"], 3)
        ('go_on', 0.05, 0.05)
        """,
    ),
    "model_compare": """
>>> import kinetostat as ks
>>> found = ks.commands.model_compare("heavy_6r", "heavy_6r")
>>> found["same"]
True
""",
    "model_draw": """
>>> import kinetostat as ks
>>> ks.commands.model_draw("two_link").lstrip().startswith("<svg")
True
""",
    "model_list": """
>>> import kinetostat as ks
>>> "orthoglide" in ks.commands.model_list()
True
""",
    "model_schema": """
>>> import json
>>> import kinetostat as ks
>>> "mechanism" in json.loads(ks.commands.model_schema())["properties"]
True
""",
    "model_show": """
>>> import kinetostat as ks
>>> "[mechanism]" in ks.commands.model_show("two_link")
True
""",
    "modes": """
>>> import kinetostat as ks
>>> found = ks.commands.modes("heavy_6r", damping=[0.03])
>>> found["stable"], found["modes"][0]["damping_ratio"]
(True, 0.03)
""",
    "frf": """
>>> import kinetostat as ks
>>> found = ks.commands.frf("heavy_6r", damping=[0.03], frequencies=[1, 50, 100])
>>> [curve["unit"] for curve in found["curves"]], len(found["frequencies_hz"])
(['m/N', 'm/N', 'm/N'], 100)
""",
    "lobes": """
>>> import kinetostat as ks
>>> cut = {"teeth": 2, "coefficients_n_per_mm2": [800, 240, 0], "rpm": [3000, 3600, 2]}
>>> found = ks.commands.lobes("heavy_6r", damping=[0.03], immersion=0.5, up=True, **cut)
>>> len(found["points"])
2
""",
    "place": _with_file(
        "groove.ngc",
        _PROGRAM,
        """
        ...     part = {"part_origin_mm": [1500, 0, 600], "x_mm": [1300, 1700], "weight": "all"}
        ...     found = ks.commands.place(program=file, model="heavy_6r", force=[0, 0, 200], samples=16, **part)
        >>> found["best"]["figure"] < found["centre"]["figure"], len(found["next_best"]) <= 10
        (True, True)
        """,
    ),
    "reproduce": """
>>> import kinetostat as ks
>>> found = ks.commands.reproduce("eq-3.34")
>>> found[0]["id"], next(item["status"] for item in found[0]["items"] if item["name"] == "K11")
('eq-3.34', 'agrees')
""",
    "shares": """
>>> import kinetostat as ks
>>> found = ks.commands.shares("heavy_6r", direction="z")
>>> round(sum(part["share"] for part in found["parts"]), 12)
1.0
""",
    "stiffness": """
>>> import kinetostat as ks
>>> found = ks.commands.stiffness("orthoglide", at=[10, 0, 0])
>>> found["rank"], len(found["stiffness_n_m_rad"])
(6, 6)
""",
    "identify": """
>>> import tempfile
>>> from pathlib import Path
>>> import kinetostat as ks
>>> with tempfile.TemporaryDirectory() as folder:
...     table = Path(folder, "pulls.csv")
...     plan = ks.commands.plan_measurement("kuka_kr270_like", pull_n=1000, count=6, candidates=30, csv=table)
...     _ = table.write_text(table.read_text().replace(",,,,", ",0.1,0.2,0.3,"))
...     found = ks.commands.identify("kuka_kr270_like", measured=table)
>>> found["readings"], len(found["numbers"])
(18, 6)
""",
    "plan_measurement": """
>>> import kinetostat as ks
>>> plan = ks.commands.plan_measurement("kuka_kr270_like", pull_n=1000, count=6, candidates=30)
>>> len(plan["measurements"]), 0 < plan["efficiency"] <= 1
(6, True)
""",
    "tolerance": _with_file(
        "uncertain.toml",
        'schema = 1\n[[uncertain]]\nparameter = "chain.leg.q2.length_mm"\nnormal = 0.02\n',
        """
        ...     found = ks.commands.tolerance("orthoglide", uncertain=file, force=[100, 0, 0], machines=256)
        >>> error = next(r for r in found["places"][0]["results"] if r["name"] == "error_mm")
        >>> error["draws"]["answered"], found["uncertain"][0]["distribution"]
        (256, 'normal')
        """,
    ),
    "verify": _with_file(
        "groove.ngc",
        _PROGRAM,
        """
        ...     question = {"model": "orthoglide", "force": [100, -20, -30]}
        ...     out = Path(folder, "corrected.ngc")
        ...     _ = ks.commands.compensate(program=file, out=out, **question)
        ...     found = ks.commands.verify(out, against=file, **question)
        >>> found["held"], found["max_position_error_mm"] < 1e-3
        (True, True)
        """,
    ),
    "view": """
>>> import os, tempfile
>>> import kinetostat as ks
>>> with tempfile.TemporaryDirectory() as folder:
...     _ = ks.commands.view("orthoglide", force=[215, -10, -25], export=os.path.join(folder, "orthoglide.html"))
...     os.listdir(folder)
['orthoglide.html']
""",
}
