"""Machines and maps as objects of PyVista, against the numbers they are made of, and read back from files by VTK."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import kinetostat as ks

WEB = [2e-3, -1e-3, 3e-3]


@pytest.fixture(scope="module")
def pyvista():
    return pytest.importorskip("pyvista", reason="PyVista (extra view) is not installed")


@pytest.mark.parametrize("name", ["orthoglide", "heavy_6r", "stewart_gough_a", "puu3"])
def test_a_machine_is_its_limbs_and_its_tool(pyvista, name):
    machine = ks.Machine.preset(name)
    posture = machine.posture(machine.home[:3, 3] + WEB)
    blocks = posture.to_pyvista(axes=0.125)
    assert isinstance(blocks, pyvista.MultiBlock)
    assert blocks.keys()[: len(machine.limbs)] == list(machine.limbs)
    for limb, line in zip(machine.limbs, posture.limb_lines(), strict=True):
        block = blocks[limb]
        assert (block.n_cells, block.n_points) == (1, len(line))
        np.testing.assert_array_equal(block.points, line)
        assert np.isclose(block.length, np.linalg.norm(np.ptp(line, axis=0)))
    tool = blocks["tool"]
    assert tool.cell_data["axis"].tolist() == [0, 1, 2]
    for k in range(3):
        start, end = tool.points[2 * k : 2 * k + 2]
        np.testing.assert_allclose(start, posture.target[:3, 3], rtol=0, atol=1e-15)
        np.testing.assert_allclose(end - start, 0.125 * posture.target[:3, k], rtol=0, atol=1e-15)
    if machine.workspace is not None:
        low, high = np.minimum(*machine.workspace), np.maximum(*machine.workspace)
        np.testing.assert_allclose(blocks["workspace"].bounds, np.stack([low, high], axis=-1).reshape(-1), rtol=0, atol=1e-15)
        assert blocks["workspace"].n_cells == 12


def test_a_machine_without_a_posture_stands_at_home(pyvista):
    machine = ks.Machine.preset("orthoglide")
    np.testing.assert_array_equal(machine.to_pyvista()["leg y"].points, machine.posture().limb_lines()[1])
    with pytest.raises(ks.ArgumentError, match="not of this machine"):
        machine.to_pyvista(ks.Machine.preset("heavy_6r").posture())
    with pytest.raises(ks.ArgumentError, match="axes is -1"):
        machine.to_pyvista(axes=-1)


def test_a_machine_is_written_and_read_back(pyvista, tmp_path):
    blocks = ks.Machine.preset("orthoglide").to_pyvista()
    blocks.save(tmp_path / "machine.vtm")
    found = pyvista.read(tmp_path / "machine.vtm")
    assert found.keys() == blocks.keys()
    np.testing.assert_allclose(found["leg z"].points, blocks["leg z"].points, rtol=0, atol=1e-15)


def test_a_map_is_a_grid_whose_points_have_their_values(pyvista):
    pytest.importorskip("xarray", reason="xarray (extra io) is not installed")
    machine = ks.Machine.preset("orthoglide")
    x, y, z = np.linspace(-0.05, 0.05, 4), np.array([-0.02, 0.0, 0.05]), np.array([0.0, 0.04])
    loads = {"mill": [100.0, -20.0, -30.0, 0.0, 0.0, 0.0], "drill": [0.0, 0.0, -200.0, 0.0, 0.0, 0.0]}
    found = machine.map(x=x, y=y, z=z, loads=loads, variables=["deflection", "deflection_xyz", "stiffness_softest"])
    grid = ks.maps.to_pyvista(found)
    assert isinstance(grid, pyvista.RectilinearGrid)
    assert grid.dimensions == (4, 3, 2)
    assert set(grid.point_data) >= {"deflection[load=mill]", "deflection[load=drill]", "deflection_xyz[load=mill]"}
    assert "stiffness_softest: N/m" in list(grid.field_data["units"])
    for name, load in loads.items():
        # The machine itself at the places of the grid's points.
        wanted = machine.equilibrium(np.array(grid.points, dtype=float), load).displacement[:, :3]
        np.testing.assert_allclose(grid.point_data[f"deflection_xyz[load={name}]"], wanted, rtol=1e-9, atol=1e-15)
        sizes = np.linalg.norm(wanted, axis=1)
        np.testing.assert_allclose(grid.point_data[f"deflection[load={name}]"], sizes, rtol=1e-9, atol=1e-15)


def test_flat_maps_and_places_without_an_answer(pyvista):
    pytest.importorskip("xarray", reason="xarray (extra io) is not installed")
    found = ks.Machine.preset("orthoglide").map(x=[0.0, 0.01, 9.0], variables="stiffness_softest")
    grid = ks.maps.to_pyvista(found)
    assert grid.dimensions == (3, 1, 1)
    assert np.isnan(grid.point_data["stiffness_softest"]).tolist() == [False, False, True]
    assert grid.point_data["status"].tolist() == [0, 0, 2]


def test_without_pyvista_it_is_said_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"pip install 'kinetostat\[view\]'"):
        ks.Machine.preset("orthoglide").to_pyvista()
