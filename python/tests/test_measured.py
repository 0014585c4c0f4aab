"""Programs corrected by measured points, against the formula of the book in plain numpy."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

import kinetostat as ks
from kinetostat.measured import mirror

START, END = np.array([3.0, -2.0, 1.0]), np.array([51.0, 34.0, -19.0])  # mm, along no axis
ALONG = (END - START) / np.linalg.norm(END - START)
LENGTH = float(np.linalg.norm(END - START))
ACROSS = np.array([3.0, -4.0, 0.0]) / 5  # at right angles to it: 48 * 3 = 36 * 4
SMOOTHING = 4.0  # mm


def number(x: float) -> str:
    return format(x, ".4f")


def drawn(folder: Path) -> Path:
    path = folder / "line.ngc"
    words = [" ".join(f"{axis}{number(x)}" for axis, x in zip("XYZ", place, strict=True)) for place in (START, END)]
    path.write_text(f"G21 G90\nG0 {words[0]}\nG1 {words[1]} F600\nM30\n")
    return path


def corners(program: Path) -> np.ndarray:
    """Places of a program of G0 and G1 with all axes or some, mm, by a little parser."""
    at, found = np.full(3, np.nan), []
    for line in program.read_text().splitlines():
        words = line.split("(")[0].split(";")[0].split()
        axes = [word for word in words if word[0] in "XYZ"]
        for word in axes:
            at["XYZ".index(word[0])] = float(word[1:])
        if axes:
            found.append(at.copy())
    places = np.array(found)
    assert np.isfinite(places).all()
    return places


def between(places: np.ndarray, s: np.ndarray) -> np.ndarray:
    """(n, 3): of a path of straight pieces, by the length along the line as drawn, mm."""
    own = (places - START) @ ALONG
    assert (np.diff(own) > 0).all()
    return np.stack([np.interp(s, own, places[:, k]) for k in range(3)], axis=-1)


def smoothed(s: np.ndarray, at: np.ndarray, deviation: np.ndarray) -> np.ndarray:
    """The mean of the book, weights 1: sum of K e over k0 + sum of K."""
    kernel = np.exp(-((s[:, None] - at) ** 2) / (2 * SMOOTHING**2))
    return kernel @ deviation / (np.exp(-4.5) + kernel.sum(axis=1))


def wave(s: np.ndarray) -> np.ndarray:
    """A deviation across the line, mm."""
    return 0.06 * np.cos(2 * np.pi * s / 37.0) + 0.02


def points(at: np.ndarray, deviation: np.ndarray) -> np.ndarray:
    """Measured, m."""
    return 1e-3 * (START + at[:, None] * ALONG + deviation[:, None] * ACROSS)


def test_the_line_is_along_no_axis():
    assert abs(ALONG @ ACROSS) < 1e-15
    assert (np.abs(ALONG) > 0.1).all()


def test_the_smoothed_deviation_is_mirrored(tmp_path: Path):
    at = np.linspace(0, LENGTH, 61)
    found = mirror(
        drawn(tmp_path), points(at, wave(at)), tmp_path / "next.ngc", smoothing=1e-3 * SMOOTHING, register="none", tolerance=0.2e-6
    )
    s = np.linspace(0, LENGTH, 500)
    wanted = START + s[:, None] * ALONG - smoothed(s, at, wave(at))[:, None] * ACROSS
    np.testing.assert_allclose(between(corners(tmp_path / "next.ngc"), s), wanted, rtol=0, atol=6e-4)  # of 80 um
    assert (found.trial, found.outcome, found.floor, found.factor) == (1, "go_on", None, None)
    square = np.trapezoid if hasattr(np, "trapezoid") else np.trapz
    np.testing.assert_allclose(found.left, 1e-3 * np.sqrt(square(smoothed(s, at, wave(at)) ** 2, s) / LENGTH), rtol=5e-3)
    np.testing.assert_allclose(found.largest_correction, 1e-3 * np.abs(smoothed(s, at, wave(at))).max(), rtol=5e-3)
    own = found.measurements[0]
    assert (own.points, own.motion, own.free, len(own.outliers), len(own.left_out)) == (61, None, (), 0, 0)
    np.testing.assert_allclose(own.rms, 1e-3 * np.sqrt(np.mean(wave(at) ** 2)), rtol=1e-9)
    np.testing.assert_allclose(own.largest, 1e-3 * np.abs(wave(at)).max(), rtol=1e-9)


def test_answers_are_those_of_the_command(tmp_path: Path):
    at = np.linspace(0, LENGTH, 61)
    table = tmp_path / "points-1.csv"
    rows = "".join(",".join(repr(float(x)) for x in row) + "\n" for row in points(at, wave(at)))
    table.write_text("x_m,y_m,z_m\n" + rows)
    program = drawn(tmp_path)
    command = ks.commands.mirror(program, measured=table, out=tmp_path / "a.ngc", register="none", repeatability_um=2)
    typed = mirror(program, points(at, wave(at)), tmp_path / "b.ngc", register="none", repeatability=2e-6)
    assert typed.answer == command
    assert (tmp_path / "a.ngc").read_bytes() == (tmp_path / "b.ngc").read_bytes()
    assert typed.floor == 1e-3 * command["floor_mm"] > 0
    of_file = mirror(program, table, tmp_path / "c.ngc", register="none", repeatability=2e-6)
    assert of_file.answer == command


def test_trials_follow_each_other_until_nothing_is_left(tmp_path: Path):
    """A machine that is always 70 um off across the line: the first trial mirrors it, the second finds it corrected."""
    program, state, at = drawn(tmp_path), tmp_path / "mirror.toml", np.linspace(0, LENGTH, 121)
    offset = np.full(len(at), 0.07)
    first = mirror(program, points(at, offset), tmp_path / "2.ngc", state=state, register="none", repeatability=3e-6)
    assert first.outcome == "go_on"
    commanded = between(corners(tmp_path / "2.ngc"), at)
    second = mirror(program, 1e-3 * (commanded + 0.07 * ACROSS), tmp_path / "3.ngc", state=state, register="none", repeatability=3e-6)
    assert (second.trial, second.outcome) == (2, "within_repeatability")
    assert second.left_in_trials.shape == (2,)
    np.testing.assert_allclose(second.left_in_trials, [first.left, second.left], rtol=1e-12)
    assert second.left < 0.02 * first.left
    # The error falls by all that the kernel lets through of a constant: 1 less the share of k0.
    assert second.factor is not None
    assert 0 <= second.factor < 0.02


def test_points_in_another_frame_are_brought_onto_the_path(tmp_path: Path):
    program = tmp_path / "corner.ngc"
    path = np.array([[0.0, 0, 0], [40, 10, 5], [50, 45, -10], [5, 60, 20]])
    lines = [f"G1 X{x} Y{y} Z{z} F600" for x, y, z in path]
    program.write_text("\n".join(["G21 G90", lines[0].replace("G1", "G0").replace(" F600", ""), *lines[1:], "M30"]) + "\n")
    share = np.linspace(0, 1, 40, endpoint=False)[:, None]
    on_path = 1e-3 * np.concatenate([a + share * (b - a) for a, b in itertools.pairwise(path)])
    motion = ks.pose([0.011, -0.023, 0.007], ks.rotation_from_vector([0.02, -0.03, 0.05]))
    measured = on_path @ motion[:3, :3].T + motion[:3, 3]
    found = mirror(program, [measured, measured + np.array([0, 0, 1e-7])], tmp_path / "next.ngc", register="rigid")
    assert len(found.measurements) == 2
    back = found.measurements[0].motion
    assert back is not None
    np.testing.assert_allclose(back @ motion, np.eye(4), rtol=0, atol=1e-7)
    assert found.left < 1e-7
    assert [own.rejected_rows.tolist() for own in found.measurements] == [[], []]
    measured[17] += [0, 0, 7e-3]
    own = mirror(program, measured, tmp_path / "other.ngc", register="rigid").measurements[0]
    assert own.rejected_rows.tolist() == own.left_out.tolist() == [18]


def test_points_that_may_belong_to_the_other_leg_of_a_corner_are_named(tmp_path: Path):
    """A machine that is 0.26 mm inside of both legs and 0.1 mm beyond their end: points nearer to the other leg are beside the corner."""
    program, off, beyond, every = tmp_path / "corner.ngc", 0.26, 0.1, 0.23
    program.write_text("G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG1 Y60\nM30\n")
    along = every * np.arange(261) - beyond  # of the second leg; the first one is its mirror image
    inside = np.full(len(along), 60 - off)
    second = np.stack([inside, along, 0 * along], axis=-1)
    first = np.stack([60 - along, 60 - inside, 0 * along], axis=-1)[::-1]
    found = mirror(program, 1e-3 * np.concatenate([first, second]), tmp_path / "next.ngc", register="none")
    own = found.measurements[0]
    nearer = np.flatnonzero(np.abs(along) < off)
    rows = np.concatenate([261 - nearer, 262 + nearer])
    assert sorted(own.beside_corners) == sorted(rows)
    assert own.beside_corners.dtype == own.rejected_rows.dtype == np.int64
    assert (own.points, own.rejected_rows.tolist()) == (2 * 261 - len(rows), [])


@pytest.mark.parametrize(
    ("measured", "message"),
    [
        (np.zeros((5, 2)), r"measured has shape \(5, 2\), expected \(n, 3\), m, or a path"),
        ([0.0, 0.0, 0.0], r"measured has shape \(3,\)"),
        ([[0.0, 0, 0], [0, np.nan, 0]], r"measured\[1\] is \[0\.0, nan, 0\.0\]: give finite numbers, m"),
        ([np.zeros((4, 3)), np.zeros((4, 4))], r"measured\[1\] has shape \(4, 4\)"),
        (np.ma.masked_equal(np.zeros((4, 3)), 0), "masked"),
        (np.array([[3.0, -2, 1], [10, 3, -2], [20, 10, -6], [30, 18, -10]]), r"^measured: none of the 4 measured points .* check units"),
    ],
)
def test_points_that_make_no_sense(tmp_path: Path, measured: object, message: str):
    program = drawn(tmp_path)
    with pytest.raises(ks.ArgumentError, match=message):
        mirror(program, measured, tmp_path / "next.ngc", register="none")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["line.ngc"]
