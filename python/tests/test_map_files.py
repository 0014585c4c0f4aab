"""Files of `kinetostat map`, read back by other programs, and variables of maps against numpy."""

from __future__ import annotations

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
    own = _core.evaluate_many(machine, poses, wrench, [v[0] for v in _core.map_variables()])
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
