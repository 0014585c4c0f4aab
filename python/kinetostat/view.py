"""Machines as objects of PyVista, to be turned in a window, put beside other things, or saved for ParaView (extra ``view``)."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat._arguments import of_kind
from kinetostat._arrays import positive

if TYPE_CHECKING:
    from kinetostat.posture import Posture

__all__ = ["to_pyvista"]


def library() -> Any:
    """PyVista, imported now."""
    try:
        import pyvista
    except ImportError as absent:
        raise ImportError("three-dimensional views need PyVista: pip install 'kinetostat[view]'") from absent
    return pyvista


def to_pyvista(posture: Posture, *, axes: float | None = None) -> Any:
    """A machine at a posture: its limbs as lines through their joints, its platform, the axes of its tool, its workspace.

    Parameters
    ----------
    posture : Posture
        Where the machine stands, unloaded.
    axes : float, optional
        Length of the axes of the tool, m; a tenth of the machine's size without it.

    Returns
    -------
    pyvista.MultiBlock
        In m, base axes. One block for each limb, by its name (a polyline from its start to its end); ``platform`` (lines from the ends
        of limbs to the tool, where they are apart); ``tool`` (three lines, cell data ``axis`` 0, 1, 2 for x, y, z); ``workspace``
        (its edges, where the model states one). ``blocks.plot()`` shows it; ``blocks.save("machine.vtm")`` writes it.

    Raises
    ------
    ImportError
        PyVista is not installed.

    Examples
    --------
    >>> import kinetostat as ks
    >>> blocks = to_pyvista(ks.Machine.preset("orthoglide").posture())
    >>> blocks.keys()
    ['leg x', 'leg y', 'leg z', 'tool', 'workspace']
    """
    from kinetostat.posture import Posture

    pyvista = library()
    of_kind("posture", posture, Posture, "a Posture")
    machine, lines, tool = posture.machine, posture.limb_lines(), posture.target
    everything = np.concatenate([*lines, tool[None, :3, 3]])
    size = float(np.ptp(everything, axis=0).max())
    length = 0.1 * size if axes is None else positive("axes", axes)
    blocks = pyvista.MultiBlock()
    for name, line in zip(machine.limbs, lines, strict=True):
        blocks.append(_polyline(pyvista, line), name)
    # The last platform carries the tool.
    ends = [line[-1] for line, to in zip(lines, _ends(posture), strict=True) if to == machine.platforms[-1]]
    arms = [np.array([end, tool[:3, 3]]) for end in ends if np.linalg.norm(end - tool[:3, 3]) > 1e-9 * max(size, 1e-9)]
    if arms:
        blocks.append(_segments(pyvista, arms), "platform")
    along = _segments(pyvista, [np.array([tool[:3, 3], tool[:3, 3] + length * tool[:3, k]]) for k in range(3)])
    along.cell_data["axis"] = np.arange(3)
    blocks.append(along, "tool")
    if machine.workspace is not None:
        corners = np.array(list(itertools.product(*np.stack(machine.workspace, axis=-1))))
        edges = [np.array(pair) for pair in itertools.combinations(corners, 2) if np.count_nonzero(pair[0] != pair[1]) == 1]
        blocks.append(_segments(pyvista, edges), "workspace")
    return blocks


def _ends(posture: Posture) -> list[str]:
    """Platforms where limbs end, in the order of limbs."""
    return [str(limb["to"]) for limb in posture.machine.to_dict()["limb"]]


def _polyline(pyvista: Any, points: Any) -> Any:
    return pyvista.PolyData(np.array(points), lines=np.array([len(points), *range(len(points))]))


def _segments(pyvista: Any, pairs: list[Any]) -> Any:
    cells = [[2, 2 * k, 2 * k + 1] for k in range(len(pairs))]
    return pyvista.PolyData(np.concatenate(pairs), lines=np.array(cells).reshape(-1))
