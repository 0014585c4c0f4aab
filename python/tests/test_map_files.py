"""Files of `kinetostat map`, read back by other programs, and variables of maps against numpy."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import _core

PLACES = ["--x", "-60", "60", "9", "--y", "-60", "60", "7", "--z", "-20", "20", "5"]
GRID = ["orthoglide", *PLACES, "--force", "100", "0", "0", "--force", "0", "100", "0"]
VARIABLES = "margin,joint_efforts,singularity_distance,principal_stiffness"


def run(*words: object) -> str:
    code, _, said = _core.run_command(["map", *GRID, "--variables", VARIABLES, *map(str, words)])
    assert code == 0, said
    return said


def worst_by_numpy() -> dict[str, np.ndarray]:
    machine = _core.Machine.preset("orthoglide")
    axes = [np.linspace(-0.06, 0.06, 9), np.linspace(-0.06, 0.06, 7), np.linspace(-0.02, 0.02, 5)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    poses = np.tile(machine.home_pose(), (x.size, 1, 1))
    poses[:, :3, 3] = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    loads = [np.array([[100.0, 0, 0, 0, 0, 0]]), np.array([[0, 100.0, 0, 0, 0, 0]])]
    found = [_core.equilibrium_of_many(machine, load, 2, poses=poses) for load in loads]
    compliance = [np.linalg.inv(f["stiffness"]) for f in found]
    return {
        "stiffness_x": np.min([1 / c[:, 0, 0] for c in compliance], axis=0),
        "margin": np.min([1 - f["stability"][:, 2] for f in found], axis=0),
        "effort": np.max([abs(f["actuator_forces"][:, 0]) for f in found], axis=0),
    }


def test_files_hold_the_worst_of_the_loads(tmp_path: Path) -> None:
    pytest.importorskip("netCDF4")
    xarray, meshio = pytest.importorskip("xarray"), pytest.importorskip("meshio")
    pyarrow, polars = pytest.importorskip("pyarrow.parquet"), pytest.importorskip("polars")
    nc, vtk, parquet = tmp_path / "a.nc", tmp_path / "a.vtk", tmp_path / "a.parquet"
    run("--netcdf", nc, "--vtk", vtk, "--parquet", parquet)
    wanted = worst_by_numpy()
    with xarray.open_dataset(nc, engine="netcdf4") as data:
        assert data["stiffness_x"].dims == ("z", "y", "x")
        assert data["stiffness_x"].attrs["units"] == "N/m"
        assert data["x"].values == pytest.approx(np.linspace(-0.06, 0.06, 9))
        netcdf = {name: data[name].values.ravel() for name in data.data_vars}
    mesh = meshio.read(vtk)
    table, frame = pyarrow.read_table(parquet), polars.read_parquet(parquet)
    assert mesh.points.shape == (315, 3)
    for name, column in netcdf.items():
        assert np.isfinite(column).all(), name
        np.testing.assert_array_equal(mesh.point_data[name].ravel(), column, err_msg=name)
        np.testing.assert_array_equal(table[name].to_numpy(), column, err_msg=name)
        np.testing.assert_array_equal(frame[name].to_numpy(), column, err_msg=name)
    np.testing.assert_allclose(frame["x"].to_numpy(), mesh.points[:, 0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(netcdf["stiffness_x"], wanted["stiffness_x"], rtol=1e-9)
    np.testing.assert_allclose(netcdf["margin"], wanted["margin"], rtol=1e-9)
    np.testing.assert_allclose(abs(netcdf["joint_efforts_1"]), wanted["effort"], rtol=1e-9)


def test_an_interrupted_map_goes_on_and_is_the_same(tmp_path: Path) -> None:
    whole, again = tmp_path / "whole.csv", tmp_path / "again.csv"
    rows = tmp_path / "rows"
    run("--csv", whole, "--resume", rows)
    file = rows / "rows.bin"
    complete = file.read_bytes()
    # Cut in the middle of a row.
    file.write_bytes(complete[: len(complete) * 9 // 10 + 3])
    run("--csv", again, "--resume", rows)
    assert again.read_bytes() == whole.read_bytes()
    assert file.read_bytes() == complete
    code, _, said = _core.run_command(["map", "orthoglide", "--x", "-60", "60", "9", "--force", "1", "0", "0", "--resume", str(rows)])
    assert code == 1
    assert "grid_" in said


def test_variables_against_numpy() -> None:
    machine = _core.Machine.preset("orthoglide")
    random = np.random.default_rng(0)
    poses = np.tile(machine.home_pose(), (100, 1, 1))
    poses[:, :3, 3] += random.uniform(-0.06, 0.06, (100, 3))
    wrench = np.array([[30.0, -50, 20, 1, 2, -0.5]])
    # Frequencies need masses, which this machine has none of.
    own = _core.evaluate_many(machine, poses, wrench, [v[0] for v in _core.map_variables() if v[1] != "Hz"])
    found = _core.equilibrium_of_many(machine, wrench, 2, poses=poses)
    compliance = np.linalg.inv(found["stiffness"])
    for k, axis in enumerate("xyz"):
        np.testing.assert_allclose(own[f"stiffness_{axis}"], 1 / compliance[:, k, k], rtol=1e-9)
        turning = 1 / compliance[:, 3 + k, 3 + k]
        np.testing.assert_allclose(own[f"rotational_stiffness_{axis}"], turning, rtol=1e-9)
    force = compliance[:, :3, :3]
    values = np.linalg.eigvalsh((force + force.transpose(0, 2, 1)) / 2)[:, ::-1]
    np.testing.assert_allclose(own["principal_compliance"], values, rtol=1e-9)
    np.testing.assert_allclose(own["deflection"], np.linalg.norm(found["displacement"][:, :3], axis=1))
    np.testing.assert_array_equal(own["joint_efforts"], found["actuator_forces"])
    # Rates of the commands by differences of the inverse kinematics: translations are all that Orthoglide drives.
    step = 1e-5
    rates = np.empty((100, 3, 3))
    for k in range(3):
        beside = [poses.copy(), poses.copy()]
        beside[0][:, k, 3] += step
        beside[1][:, k, 3] -= step
        up, down = (_core.stiffness_of_many(machine, poses=p)["commands"] for p in beside)
        rates[:, :, k] = (up - down) / (2 * step)
    values = np.linalg.svd(rates, compute_uv=False)
    np.testing.assert_allclose(own["singularity_distance"], values[:, 2] / values[:, 0], rtol=1e-6)


def test_other_endings_of_vtk_files_are_refused_in_words(tmp_path):
    pytest.importorskip("meshio")
    found = ks.Machine.preset("orthoglide").map(x=[0.0, 0.01])
    with pytest.raises(ks.ArgumentError, match=r"map\.vtr', expected an ending of \.vtu, \.vtk"):
        ks.maps.to_vtk(found, tmp_path / "map.vtr")
    assert list(tmp_path.iterdir()) == []


def test_names_with_spaces_are_read_by_all(tmp_path):
    """Names of the user's loads and orientations; of a VTK file without a unit nobody knows what a number is."""
    meshio = pytest.importorskip("meshio")
    loads = {"mill down": [215.0, -10, -25, 0, 0, 0], "mill_down": [0.0, 80, -25, 0, 0, 0], '50 % "fast" <a&b> --': [10.0, 20, 30, 0, 0, 0]}
    found = ks.Machine.preset("heavy_6r").map(x=[1.4, 1.5, 1.6], y=[0.1, 0.2], z=0.9, loads=loads)
    names = ["deflection[load=mill_down]", "deflection[load=mill_down]_2", "deflection[load=50_fast_a_b_--]"]
    for ending in ("vtu", "vtk"):
        path = tmp_path / f"map.{ending}"
        ks.maps.to_vtk(found, path)
        data = meshio.read(path).point_data
        assert not any(re.search(r"\s", name) for name in data)
        for load, name in zip(loads, names, strict=True):
            np.testing.assert_array_equal(data[name], found.deflection.sel(load=load).values.reshape(-1))
    assert sorted(each.name for each in tmp_path.iterdir()) == ["map.vtk", "map.vtu"]
    xml = pytest.importorskip("vtkmodules.vtkIOXML")
    reader = xml.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "map.vtu"))
    reader.Update()
    arrays = reader.GetOutput().GetPointData()
    units = {"deflection": "m", "deflection_xyz": "m", "stiffness_x": "N/m"}
    key = pytest.importorskip("vtkmodules.vtkCommonCore").vtkDataArray.UNITS_LABEL()
    seen = 0
    for k in range(arrays.GetNumberOfArrays()):
        unit = units.get(arrays.GetArray(k).GetName().partition("[")[0])
        if unit is not None:
            assert arrays.GetArray(k).GetInformation().Get(key) == unit
            seen += 1
    assert seen == 9
    np.testing.assert_array_equal([arrays.GetArray(names[0]).GetValue(i) for i in range(6)], found.deflection[0].values.reshape(-1))
    text = (tmp_path / "map.vtu").read_text(encoding="utf-8")
    assert f"{names[0]}: {found.deflection.attrs['long_name']} [load=mill down], m" in text


def test_falling_axes_rise_in_files_for_vtk(tmp_path):
    """Coordinates may fall in a map; cells of VTK turn inside out where they do."""
    meshio = pytest.importorskip("meshio")
    x, y, z = np.linspace(-0.06, 0.05, 4), np.linspace(-0.05, 0.06, 3), np.array([-0.02, 0.01, 0.04])
    machine = ks.Machine.preset("orthoglide")
    load = [100.0, -20, 30, 0, 0, 0]
    rising = machine.map(x=x, y=y, z=z, loads=load)
    falling = machine.map(x=x[::-1], y=y, z=z[::-1], loads=load)
    np.testing.assert_array_equal(falling.x, x[::-1])
    np.testing.assert_array_equal(falling.deflection_xyz, rising.deflection_xyz.values[::-1, :, ::-1])
    for ending in ("vtu", "vtk"):
        meshes = []
        for name, found in (("rising", rising), ("falling", falling)):
            ks.maps.to_vtk(found, tmp_path / f"{name}.{ending}")
            meshes.append(meshio.read(tmp_path / f"{name}.{ending}"))
        np.testing.assert_array_equal(meshes[0].points, meshes[1].points)
        assert set(meshes[0].point_data) == set(meshes[1].point_data)
        for name, values in meshes[0].point_data.items():
            np.testing.assert_array_equal(meshes[1].point_data[name], values, err_msg=name)
        corners = meshes[1].points[meshes[1].cells[0].data]
        edges = [corners[:, k] - corners[:, 0] for k in (1, 3, 4)]
        assert (np.einsum("ni,ni->n", edges[2], np.cross(edges[0], edges[1])) > 0).all()
    one = machine.posture([x[0], y[2], z[1]]).deflected_by(load).displacement[:3]
    at = np.flatnonzero((abs(meshes[1].points - [x[0], y[2], z[1]]) < 1e-12).all(axis=1))
    np.testing.assert_allclose(meshes[1].point_data["deflection_xyz"][at[0]], one, rtol=0, atol=1e-12)


def test_falling_axes_in_grids_of_pyvista():
    pytest.importorskip("pyvista")
    x = np.array([0.05, 0.01, -0.06])
    found = ks.Machine.preset("orthoglide").map(x=x, y=[0.0, 0.03], z=[0.02, -0.02])
    grid = ks.maps.to_pyvista(found)
    np.testing.assert_array_equal(grid.x, x[::-1])
    np.testing.assert_array_equal(grid.z, [-0.02, 0.02])
    for index, point in enumerate(grid.points):
        own = found.stiffness_x.sel(dict(zip("xyz", point, strict=True)), method="nearest")
        assert grid.point_data["stiffness_x"][index] == float(own)


def test_pictures_of_falling_axes_are_those_of_rising_ones():
    pyplot = pytest.importorskip("matplotlib.pyplot", reason="matplotlib (extra plot) is not installed")
    x, y = np.linspace(-0.06, 0.05, 9), np.linspace(-0.04, 0.06, 7)
    machine = ks.Machine.preset("orthoglide")
    drawn = []
    for places in ((x, y), (x[::-1], y[::-1])):
        found = machine.map(x=places[0], y=places[1], z=0.02)
        ends = ks.maps.best_and_worst(found, "stiffness_x")
        ax = ks.maps.plot(found, "stiffness_x")
        marks = {line.get_label(): line.get_xydata().tolist() for line in ax.lines}
        levels = next(each for each in ax.collections if hasattr(each, "levels"))
        lines = [np.sort(path.vertices, axis=0) for path in levels.get_paths()]
        drawn.append((ends, marks, levels.levels.tolist(), lines, ax.get_xlim(), ax.get_ylim()))
    pyplot.close("all")
    assert drawn[0][:3] == drawn[1][:3]
    assert drawn[0][4] == drawn[1][4]
    assert drawn[0][5] == drawn[1][5]
    assert len(drawn[0][3]) == len(drawn[1][3]) > 3
    for one, other in zip(drawn[0][3], drawn[1][3], strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)
