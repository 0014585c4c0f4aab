"""Maps: the right numbers under the right labels, and read back by other programs."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import maps, sweep

xarray = pytest.importorskip("xarray")

# Processes that are forked: Python warns where this one has threads; ours are made anew in a child.
pytestmark = pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")

MACHINE = ks.Machine.preset("orthoglide")
ARM = ks.Machine.preset("heavy_6r")
ARM6 = Path(__file__).resolve().parents[2] / "crates/kinetostat-cli/tests/cli/vibration_models/arm6.toml"
X, Y, Z = np.linspace(-0.07, 0.09, 5), np.linspace(-0.06, 0.1, 4), np.array([-0.02, 0.03, 0.11])
LOADS = {"mill": [215.0, -10, -25, 1.0, 21.5, 0], "drill": [0.0, 0, 300, 0, 0, 2]}
TURNED = [ks.rotation_from_vector(v) for v in ([0.0, 0.0, 0.0], [0.1, -0.2, 0.05], [-0.15, 0.1, 0.3])]


def principal(compliance: np.ndarray) -> np.ndarray:
    """Compliances against forces, falling: eigenvalues of the block of forces."""
    return np.linalg.eigvalsh(compliance[..., :3, :3])[..., ::-1]


def test_numbers_are_those_of_the_compliance() -> None:
    names = ["stiffness_x", "stiffness_y", "stiffness_z", "stiffness_softest", "rotational_stiffness_z", "principal_compliance"]
    found = MACHINE.map(x=X, y=Y, z=Z, variables=names)
    assert found.stiffness_x.dims == ("x", "y", "z")
    places = np.stack(np.meshgrid(X, Y, Z, indexing="ij"), axis=-1)
    compliance = MACHINE.stiffness(places).compliance
    assert np.isfinite(compliance).all()
    for k, name in enumerate(["stiffness_x", "stiffness_y", "stiffness_z"]):
        np.testing.assert_allclose(found[name], 1 / compliance[..., k, k], rtol=1e-9)
    np.testing.assert_allclose(found.rotational_stiffness_z, 1 / compliance[..., 5, 5], rtol=1e-9)
    np.testing.assert_allclose(found.principal_compliance, principal(compliance), rtol=1e-9)
    np.testing.assert_allclose(found.stiffness_softest, 1 / principal(compliance)[..., 0], rtol=1e-9)
    # By coordinates, at an off-axis place, against one posture.
    one = MACHINE.posture(position=[X[3], Y[1], Z[2]]).stiffness().compliance
    np.testing.assert_allclose(found.stiffness_y.sel(x=X[3], y=Y[1], z=Z[2]), 1 / one[1, 1], rtol=1e-9)


def test_loads_and_orientations_are_dimensions() -> None:
    x, y = np.linspace(1.3, 1.6, 3), np.linspace(-0.2, 0.3, 2)
    turned = {"straight": ARM.home[:3, :3] @ TURNED[0], "leaning": ARM.home[:3, :3] @ TURNED[1]}
    names = ["deflection", "deflection_xyz", "rotation_xyz", "joint_efforts", "commands", "stable"]
    found = ARM.map(x=x, y=y, z=0.9, orientations=turned, loads=LOADS, variables=names)
    assert found.deflection_xyz.dims == ("load", "orientation", "x", "y", "axis")
    assert found.joint_efforts.dims == ("load", "orientation", "x", "y", "actuator")
    assert found.joint_efforts.attrs["units"] == "N m"
    assert found.commands.attrs["units"] == "rad"
    assert (found.status == ks.Status.SOLVED).all()
    for load, wrench in LOADS.items():
        for name, rotation in turned.items():
            for place in ((x[0], y[1]), (x[2], y[0])):
                own = found.sel(load=load, orientation=name, x=place[0], y=place[1])
                pose = ks.pose([*place, 0.9], rotation)
                one = ARM.equilibrium(pose, wrench)
                np.testing.assert_allclose(own.deflection_xyz, one.displacement[:3], rtol=1e-9, atol=1e-15)
                np.testing.assert_allclose(own.rotation_xyz, one.displacement[3:], rtol=1e-9, atol=1e-15)
                np.testing.assert_allclose(own.deflection, np.linalg.norm(one.displacement[:3]), rtol=1e-9)
                np.testing.assert_allclose(own.joint_efforts, one.actuator_forces, rtol=1e-9, atol=1e-9)
                np.testing.assert_allclose(own.wrench, wrench)
                np.testing.assert_allclose(own.orientation_matrix, rotation)


@pytest.mark.parametrize("kept", [False, True], ids=["in memory", "in a folder"])
def test_every_variable_with_orientations(tmp_path: Path, kept: bool) -> None:
    place = np.array([1.4, 0.1, 0.9])
    turned = {"straight": ARM.home[:3, :3], "leaning": ARM.home[:3, :3] @ TURNED[2]}
    names = list(maps.variables())
    folder = tmp_path / "map" if kept else None
    found = ARM.map(x=[1.3, place[0]], y=place[1], z=place[2], orientations=turned, loads=LOADS, variables=names, folder=folder)
    assert set(found.data_vars) == {*names, "status"}
    assert not set(found.data_vars) & set(found.coords)
    for load, wrench in LOADS.items():
        for name, rotation in turned.items():
            own = found.sel(load=load, orientation=name, x=place[0])
            one = ARM.equilibrium(ks.pose(place, rotation), wrench)
            np.testing.assert_allclose(own["rotation"], np.linalg.norm(one.displacement[3:]), rtol=1e-9)
            np.testing.assert_allclose(own.orientation_matrix, rotation)
    # One orientation, and the worst of several, have the matrices as a coordinate, too.
    single = ARM.map(x=place[:1], y=place[1], z=place[2], orientations=turned["leaning"], loads=LOADS["mill"], variables=names)
    np.testing.assert_allclose(single.orientation_matrix, turned["leaning"])
    with_worst = [name for name, about in maps.variables().items() if about.worse != "neither"]
    question = {"x": place[:1], "y": place[1], "z": place[2], "loads": LOADS["mill"], "variables": with_worst}
    worst = ARM.map(orientations=turned, over_orientations="worst", **question)
    assert worst["rotation"][0] == found["rotation"].sel(load="mill", x=place[0]).max("orientation")
    # The file has all of them, too.
    found.to_netcdf(tmp_path / "map.nc", engine="scipy")
    with xarray.open_dataset(tmp_path / "map.nc", engine="scipy") as back:
        np.testing.assert_array_equal(back["rotation"], found["rotation"])


def test_worst_over_orientations() -> None:
    turned = np.array([ARM.home[:3, :3] @ each for each in TURNED])
    names = ["deflection", "stiffness_softest", "joint_efforts", "deflection_xyz", "margin"]
    question = {"x": np.linspace(1.2, 2.7, 7), "z": np.linspace(0.5, 1.8, 3), "y": 0.1, "loads": LOADS, "variables": names}
    all_of_them = ARM.map(orientations=turned, **question)
    worst = ARM.map(orientations=turned, over_orientations="worst", **question)
    assert worst.deflection.dims == ("load", "x", "z")
    unsolved = (all_of_them.status == 2).any("orientation").values
    assert unsolved.any()
    assert not unsolved.all()
    assert np.array_equal(worst.status, all_of_them.status.max("orientation"))
    for name, reduced in (
        ("deflection", all_of_them.deflection.max("orientation", skipna=False)),
        ("stiffness_softest", all_of_them.stiffness_softest.min("orientation", skipna=False)),
        ("margin", all_of_them.margin.min("orientation", skipna=False)),
    ):
        assert np.array_equal(worst[name].values[~unsolved], reduced.values[~unsolved], equal_nan=True), name
        assert np.isnan(worst[name].values[unsolved]).all(), name
    size = np.abs(all_of_them.joint_efforts).max("orientation", skipna=False)
    assert np.array_equal(np.abs(worst.joint_efforts.values[~unsolved]), size.values[~unsolved])
    assert np.isin(worst.joint_efforts.values[~unsolved], all_of_them.joint_efforts.values).all()
    with pytest.raises(ks.ArgumentError, match="principal_directions has no worst"):
        ARM.map(x=[1.3, 1.4], orientations=turned, over_orientations="worst", variables="principal_directions")


def test_what_is_out_of_reach_has_no_numbers() -> None:
    found = MACHINE.map(x=[0.0, 0.12, 5.0], variables=["stiffness_softest", "principal_directions", "commands"])
    assert found.status.values[0] == ks.Status.SOLVED
    assert found.status.values[2] == ks.Status.UNSOLVED
    assert found.principal_directions.dims == ("x", "principal", "axis")
    for name in found.data_vars:
        if name != "status":
            assert np.isnan(found[name].values[2]).all(), name
            assert np.isfinite(found[name].values[0]).all(), name


def test_a_machine_that_turns_as_it_moves_takes_the_nearest_orientation() -> None:
    machine = ks.Machine.preset("prs3")
    assert machine.turns_as_it_moves
    home = machine.home[:3, 3]
    x, y = home[0] + np.array([-0.01, 0.02]), home[1] + np.array([0.01, 0.02, 9.0])
    found = machine.map(x=x, y=y, variables=["stiffness_x", "commands"])
    assert (found.status.values[:, :2] == ks.Status.SOLVED).all()
    assert (found.status.values[:, 2] == ks.Status.UNSOLVED).all()
    one = machine.posture(position=[x[1], y[0], home[2]])
    assert np.abs(one.target[:3, :3] - machine.home[:3, :3]).max() > 1e-3
    np.testing.assert_allclose(found.commands.sel(x=x[1], y=y[0]), one.commands, atol=1e-9)
    compliance = one.stiffness().compliance
    np.testing.assert_allclose(found.stiffness_x.sel(x=x[1], y=y[0]), 1 / compliance[0, 0], rtol=1e-9)


def test_a_machine_without_drives_has_no_efforts(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    chain = ks.Machine.preset("three_link_s")
    question = {"x": [3.0, 3.001], "loads": [1, 0, 0, 0, 0, 0], "variables": ["joint_efforts", "deflection"]}
    stored = chain.map(**question, folder=tmp_path)
    assert stored.joint_efforts.shape == (2, 0)
    xarray.testing.assert_identical(stored, chain.map(**question))


def test_how_near_a_singular_posture_is_known_or_refused() -> None:
    for name in ("tricept_like", "prs3"):  # turn as they move
        machine = ks.Machine.preset(name)
        x, y, z = machine.home[:3, 3]
        found = machine.map(x=[x, x + 0.02], y=y, z=[z, z + 0.02], variables="singularity_distance")
        assert (found.status == ks.Status.SOLVED).all()
        assert ((found.singularity_distance > 0) & (found.singularity_distance <= 1)).all()
    with pytest.raises(ks.ArgumentError, match="a question about drives: 'three_link_s' has none"):
        ks.Machine.preset("three_link_s").map(x=[3.0, 3.001], variables="singularity_distance")


def test_natural_frequencies_of_the_reference_arm() -> None:
    """`dynamics-reference-values.md`, D3, and those of postures one by one."""
    arm = ks.Machine.open(ARM6)
    x, y, z = arm.home[:3, 3]
    load = [120.0, -80.0, -300.0, 0, 0, 0]
    weight = arm.map(x=[x, x + 0.03], y=y, z=z, loads=np.zeros(6), variables=["f1", "natural_frequencies"])
    expected = [9.98746752, 11.5425353, 23.2012812, 49.0179614, 53.7168096, 126.52171]
    np.testing.assert_allclose(weight.natural_frequencies[0], expected, rtol=1e-8)
    assert weight.natural_frequencies.dims == ("x", "mode")
    assert weight.f1.attrs["units"] == "Hz"
    places = np.array([[x - 0.05, y + 0.04, z + 0.06], [x, y - 0.07, z]])
    found = arm.map(x=places[:, 0], y=places[0, 1], z=places[0, 2], loads=load, variables=["f1", "f3"])
    for k, place in enumerate(found.x.values):
        posture = arm.posture([place, *places[0, 1:]], rotation=arm.home[:3, :3])
        np.testing.assert_allclose([found.f1[k], found.f3[k]], posture.vibration(load).frequencies_hz[[0, 2]], rtol=1e-7)
    with pytest.raises(ks.ArgumentError, match="no mass anywhere"):
        MACHINE.map(x=X, y=0, z=0, loads=load, variables="f1")
    with pytest.raises(ks.ArgumentError, match="needs a load"):
        arm.map(x=[x, x + 0.03], y=y, z=z, variables="f1")


def refused() -> ProcessPoolExecutor:
    raise AssertionError("a question without sense made workers")


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ({}, "runs along x, y or z"),
        ({"x": 0.1}, "runs along x, y or z"),
        ({"x": [[0.1]]}, r"x has shape \(1, 1\)"),
        ({"x": []}, r"x has shape \(0,\)"),
        ({"x": [0.0, np.nan]}, "finite"),
        ({"x": [0.0, 0.1, 0.1]}, "grow or fall"),
        ({"x": [0, 1], "orientations": np.eye(4)}, r"orientations has shape \(4, 4\), expected \(\.\.\., 3, 3\)"),
        ({"x": [0, 1], "orientations": np.diag([1, 1, -1])}, "no rotation matrix"),
        ({"x": [0, 1], "orientations": [np.eye(3), 2 * np.eye(3)]}, r"orientations\[1\] is no rotation matrix"),
        ({"x": [0, 1], "orientations": np.eye(3), "over_orientations": "worst"}, "several orientations"),
        ({"x": [0, 1], "over_orientations": "best"}, "expected 'worst'"),
        ({"x": [0, 1], "loads": [1, 2, 3]}, r"loads has shape \(3,\), expected \(\.\.\., 6\)"),
        ({"x": [0, 1], "loads": {}}, "loads is empty"),
        ({"x": [0, 1], "variables": "softness"}, "variables has 'softness', expected some of stiffness_x"),
        ({"x": [0, 1], "variables": []}, "one or more names"),
        ({"x": [0, 1], "variables": "deflection"}, "needs a load"),
        (
            {"x": np.linspace(0, 1, 100_000), "y": np.linspace(0, 1, 100_000), "variables": "stiffness_x"},
            r"1e\+10 places would have 1e\+10 numbers \(80 GB\), expected at most 2e\+09",
        ),
    ],
)
def test_questions_that_make_no_sense(question: dict[str, object], message: str) -> None:
    with pytest.raises(ks.ArgumentError, match=message):
        MACHINE.map(**question, executor=refused)


def test_in_a_folder_on_processes_and_in_memory_are_the_same_bits(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    question = {"x": X, "y": Y, "z": Z, "loads": LOADS}
    memory = MACHINE.map(**question)
    stored = MACHINE.map(**question, folder=tmp_path, executor=partial(ProcessPoolExecutor, 2), chunk=17)
    xarray.testing.assert_identical(memory, stored)
    for name in memory.data_vars:
        assert memory[name].values.tobytes() == stored[name].values.tobytes()
    assert sweep.verify(tmp_path).complete
    with pytest.raises(ks.ArgumentError, match=r"settings\.wrenches\.sha256"):
        MACHINE.map(**{**question, "loads": {**LOADS, "drill": [0, 0, 301, 0, 0, 2]}}, folder=tmp_path, chunk=17)
    # The Parquet files say themselves where each row is.
    rows = sweep.read(tmp_path, ["load", "x", "y", "z", "stiffness_x"])
    own = memory.sel(load="drill").stiffness_x
    of_drill = rows["load"] == 1
    at = [rows[name][of_drill] for name in "xyz"]
    again = xarray.DataArray(rows["stiffness_x"][of_drill].reshape(own.shape), {"x": X, "y": Y, "z": Z}, ("x", "y", "z"))
    assert np.array_equal(again, own)
    assert all(np.array_equal(at[k].reshape(own.shape), grid) for k, grid in enumerate(np.meshgrid(X, Y, Z, indexing="ij")))


@pytest.mark.parametrize("engine", ["netcdf4", "scipy"])
def test_netcdf_is_read_back_by_xarray(tmp_path: Path, engine: str) -> None:
    pytest.importorskip({"netcdf4": "netCDF4"}.get(engine, engine))
    found = MACHINE.map(x=X, y=Y, z=0.01, loads=LOADS)
    found.to_netcdf(tmp_path / "map.nc", engine=engine)
    with xarray.open_dataset(tmp_path / "map.nc", engine=engine) as back:
        xarray.testing.assert_equal(found, back.load())
        assert back.deflection.attrs["units"] == "m"
        assert back.x.attrs["units"] == "m"
        assert back.attrs["machine_sha256"] == MACHINE.fingerprint


def test_parquet_is_read_back_by_pyarrow_and_polars(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    polars = pytest.importorskip("polars")
    found = MACHINE.map(x=X, y=Y, z=0.01, loads=LOADS)
    maps.to_parquet(found, tmp_path / "map.parquet")
    assert os.listdir(tmp_path) == ["map.parquet"]
    table = parquet.read_table(tmp_path / "map.parquet")
    assert table.num_rows == found.status.size
    assert table.schema.field("deflection").metadata[b"unit"] == b"m"
    frame = polars.read_parquet(tmp_path / "map.parquet")
    row = frame.filter((polars.col("load") == "drill") & (polars.col("x") == X[2]) & (polars.col("y") == Y[3]))
    assert row.height == 1
    own = found.sel(load="drill", x=X[2], y=Y[3])
    assert row["deflection"][0] == float(own.deflection)
    assert row["deflection_xyz"].to_list()[0] == own.deflection_xyz.values.tolist()
    assert row["z"][0] == 0.01


@pytest.mark.parametrize("ending", ["vtu", "vtk"])
@pytest.mark.parametrize(
    ("question", "kind", "cells"),
    [
        ({"x": X, "y": Y, "z": Z}, "hexahedron", 4 * 3 * 2),
        ({"x": X, "z": Z, "y": 0.02}, "quad", 4 * 2),
        ({"y": Y}, "line", 3),
    ],
)
def test_vtk_is_read_back_by_meshio_and_vtk(tmp_path: Path, ending: str, question: dict[str, object], kind: str, cells: int) -> None:
    meshio = pytest.importorskip("meshio")
    found = MACHINE.map(**question, loads=LOADS)
    path = tmp_path / f"map.{ending}"
    maps.to_vtk(found, path)
    back = meshio.read(path)
    assert [(block.type, len(block.data)) for block in back.cells] == [(kind, cells)]
    point = back.points[-2]
    own = found.sel({name: value for name, value in zip("xyz", point, strict=True) if name in found.dims}, method="nearest")
    for load in LOADS:
        assert back.point_data[f"deflection[load={load}]"][-2] == float(own.deflection.sel(load=load))
        assert np.array_equal(back.point_data[f"deflection_xyz[load={load}]"][-2], own.deflection_xyz.sel(load=load))
    if ending == "vtu":
        xml = pytest.importorskip("vtkmodules.vtkIOXML")
        reader = xml.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        grid = reader.GetOutput()
        assert grid.GetNumberOfCells() == cells
        bounds = grid.GetBounds()
        assert np.isclose(bounds[2:4], [found.y.values.min(), found.y.values.max()]).all()
        if kind == "hexahedron":
            # Corners in VTK's order: every cell has its own positive volume.
            p = back.points[back.cells[0].data]
            volume = np.einsum("ni,ni->n", p[:, 4] - p[:, 0], np.cross(p[:, 1] - p[:, 0], p[:, 3] - p[:, 0]))
            assert (volume > 0).all()


@pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")
def test_best_and_worst_are_within_the_limits() -> None:
    found = MACHINE.map(x=np.linspace(-0.15, 0.15, 13), y=np.linspace(-0.15, 0.15, 13), variables="stiffness_softest")
    assert (found.status != ks.Status.SOLVED).any()
    best, worst = maps.best_and_worst(found, "stiffness_softest")
    good = found.stiffness_softest.where(found.status == ks.Status.SOLVED)
    assert best["value"] == float(good.max())
    assert worst["value"] == float(good.min())
    assert float(found.stiffness_softest.sel(x=worst["x"], y=worst["y"])) == worst["value"]
    with pytest.raises(ks.ArgumentError, match="no place has an answer"):
        maps.best_and_worst(MACHINE.map(x=[5.0, 6.0]), "stiffness_x")


@pytest.mark.filterwarnings("ignore")
def test_pictures(tmp_path: Path) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    found = MACHINE.map(x=np.linspace(-0.15, 0.15, 25), y=np.linspace(-0.15, 0.15, 25), z=0.0, loads=LOADS)
    ax = maps.plot(found.sel(load="mill"), "deflection", machine=MACHINE)
    labels = ax.get_legend_handles_labels()[1]
    assert any(label.startswith("best: ") for label in labels)
    assert any(label.startswith("worst: ") for label in labels)
    ax.figure.savefig(tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 10_000
    assert maps.plot(found.sel(load="drill").isel(y=3)).get_xlabel() == "x, mm"
    with pytest.raises(ks.ArgumentError, match="select the others first"):
        maps.plot(found, "deflection")
    with pytest.raises(ks.ArgumentError, match="several numbers"):
        maps.plot(found.sel(load="mill"), "deflection_xyz")
    matplotlib.pyplot.close("all")


def test_limbs_as_lines_end_at_the_tool_and_have_the_lengths_of_their_links() -> None:
    place = np.array([0.03, -0.02, 0.05])
    lines = MACHINE.posture(position=place).limb_lines()
    assert len(lines) == 3
    for k, line in enumerate(lines):
        np.testing.assert_allclose(line[-1], place, atol=1e-12)
        lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
        # The bars of 310 mm, and the arm of the platform of 40.5 mm behind them, along the leg's own axis.
        assert np.isclose(lengths, 0.31, atol=1e-12).sum() == 1
        np.testing.assert_allclose(line[-1] - line[-2], 0.0405 * np.eye(3)[k], atol=1e-12)
    # An arm of rigid and elastic links, closed by hand: shoulder, elbow and wrist at home.
    arm = ks.Machine.preset("two_link").posture().limb_lines()[0]
    np.testing.assert_allclose(arm[-1], ks.Machine.preset("two_link").home[:3, 3], atol=1e-9)


MEMORY = """
import sys
import numpy as np
import kinetostat as ks
def most():
    # Not ru_maxrss: that begins with the parent's.
    return next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmHWM"))
machine = ks.Machine.preset("orthoglide")
machine.map(x=[0.0, 0.01])
before = most()
a = np.linspace(-0.06, 0.1, int(sys.argv[1]))
found = machine.map(x=a, y=a, z=a, chunk=4096)
after = most()
print((after - before) * 1024 / found.nbytes)
"""


def test_memory_is_at_most_four_times_the_answer() -> None:
    env = {**os.environ, "PYTHONPATH": str(Path(ks.__file__).parents[1])}
    run = subprocess.run([sys.executable, "-c", MEMORY, "56"], capture_output=True, text=True, check=True, env=env)
    assert 0.5 < float(run.stdout) < 4, run.stdout


def test_which_value_is_worse_is_told_by_the_core():
    worse = {name: variable.worse for name, variable in ks.maps.variables().items()}
    assert set(worse.values()) == {"smaller", "larger", "larger size", "neither"}
    known = {
        "stiffness_softest": "smaller",
        "margin": "smaller",
        "stable": "smaller",
        "deflection": "larger",
        "share_to_buckling": "larger",
        "principal_compliance": "larger",
        "deflection_xyz": "larger size",
        "joint_efforts": "larger size",
        "commands": "neither",
        "principal_directions": "neither",
    }
    assert {name: worse[name] for name in known} == known


def test_two_maps_in_one_figure_have_legends_of_their_own():
    pyplot = pytest.importorskip("matplotlib.pyplot", reason="matplotlib (extra plot) is not installed")
    x = np.linspace(-0.05, 0.05, 5)
    found = ks.Machine.preset("orthoglide").map(x=x, y=x)
    figure, (left, right) = pyplot.subplots(1, 2, layout="constrained", figsize=(10, 5))
    for ax, variable in ((left, "stiffness_softest"), (right, "stiffness_x")):
        ks.maps.plot(found, variable, ax=ax)
    texts = [[text.get_text() for text in ax.get_legend().get_texts()] for ax in (left, right)]
    assert figure.legends == []
    assert [len(own) for own in texts] == [2, 2]
    assert texts[0] != texts[1]
    alone = ks.maps.plot(found, "stiffness_softest")
    assert len(alone.figure.legends) == 1
    pyplot.close("all")
