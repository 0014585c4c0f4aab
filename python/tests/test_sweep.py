"""Sweeps: complete, resumed, and the same bits on any executor."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
import sweep_functions as functions

import kinetostat as ks
from kinetostat import sweep
from kinetostat.sweep._example import squares

# Processes that are forked: Python warns where this one has threads; ours are made anew in a child.
pytestmark = pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")

MACHINE = ks.Machine.preset("orthoglide")
PLACES = np.random.default_rng(3).uniform(-0.12, 0.12, (600, 3))
SETTINGS = {"machine": MACHINE, "places": PLACES}


def same_bits(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> None:
    assert list(one) == list(other)
    for name in one:
        assert one[name].dtype == other[name].dtype
        assert one[name].shape == other[name].shape
        assert one[name].tobytes() == other[name].tobytes(), name


@pytest.fixture(scope="module")
def serial() -> dict[str, np.ndarray]:
    whole = sweep.run(functions.stiff, len(PLACES), SETTINGS, chunk=len(PLACES))
    # Not the code with itself alone: the vectorised call gives the same.
    direct = MACHINE.equilibrium(PLACES, [100, -20, -30, 1, 2, 3])
    assert np.array_equal(whole["displacement"], direct.displacement, equal_nan=True)
    assert direct.solved.sum() > 500
    return whole


def test_any_chunk_gives_the_same_bits(serial: dict[str, np.ndarray]) -> None:
    same_bits(serial, sweep.run(functions.stiff, len(PLACES), SETTINGS, chunk=7))


def test_threads_as_executor_and_bounded_under_way(serial: dict[str, np.ndarray]) -> None:
    most = 0
    now = 0
    lock = threading.Lock()

    class Counting(ThreadPoolExecutor):
        def submit(self, *args, **kwargs):  # type: ignore[no-untyped-def]
            nonlocal most, now
            with lock:
                now += 1
                most = max(most, now)
            future = super().submit(*args, **kwargs)
            future.add_done_callback(self.one_less)
            return future

        def one_less(self, _: object) -> None:
            nonlocal now
            with lock:
                now -= 1

    with Counting(2) as pool:
        same_bits(serial, sweep.run(functions.stiff, len(PLACES), SETTINGS, chunk=20, executor=pool, under_way=3))
    assert 2 <= most <= 3


def test_a_killed_process_costs_its_chunk(serial: dict[str, np.ndarray], tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    mark = tmp_path / "killed"
    settings = {**SETTINGS, "kill": str(mark), "at": 300, "wait": 0.01}
    done = sweep.to_folder(tmp_path / "out", functions.stiff, 600, settings, chunk=25, executor=partial(ProcessPoolExecutor, 2))
    assert mark.exists()
    assert done == sweep.Done(24, 24, 0)
    assert sweep.verify(tmp_path / "out").complete
    same_bits(serial, sweep.read(tmp_path / "out"))


def test_a_pool_without_a_factory_keeps_what_is_done(serial: dict[str, np.ndarray], tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    settings = {**SETTINGS, "kill": str(tmp_path / "killed"), "at": 400}
    out = tmp_path / "out"
    with ProcessPoolExecutor(1) as pool, pytest.raises(sweep.SweepError, match="Give a function that makes the executor"):
        sweep.to_folder(out, functions.stiff, 600, settings, chunk=25, executor=pool, under_way=1)
    found = sweep.verify(out)
    assert found.sound == tuple(range(16))
    assert found.damaged == ()
    with pytest.raises(ks.ArgumentError, match="16 of 24 chunks"):
        sweep.read(out)
    assert sweep.to_folder(out, functions.stiff, 600, settings, chunk=25).computed == 8
    same_bits(serial, sweep.read(out))


def test_workers_that_always_die_end_the_sweep() -> None:
    with pytest.raises(sweep.SweepError, match="3 times without a finished chunk"):
        sweep.run(functions.always_killed, 10, chunk=5, executor=partial(ProcessPoolExecutor, 1))


def test_a_failing_chunk_is_named_and_the_others_are_kept(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    settings = {"log": str(tmp_path / "log"), "fail": 60}
    with ThreadPoolExecutor(1) as pool, pytest.raises(sweep.SweepError, match=r"chunk 6 \(rows 60 to 69\).*ZeroDivisionError"):
        sweep.to_folder(tmp_path / "out", functions.counted, 100, settings, chunk=10, executor=pool, under_way=1)
    assert sweep.verify(tmp_path / "out").sound == tuple(range(6))
    assert (tmp_path / "log").read_text().split() == ["0", "10", "20", "30", "40", "50", "60", "60"]


@pytest.mark.parametrize("harm", ["cut", "altered", "gone"])
def test_damaged_chunks_are_found_and_computed_again(tmp_path: Path, harm: str) -> None:
    pytest.importorskip("pyarrow")
    log = tmp_path / "log"
    out = tmp_path / "out"
    go = partial(sweep.to_folder, out, functions.counted, 95, {"log": str(log)}, chunk=10)
    assert go() == sweep.Done(10, 10, 0)
    whole = sweep.read(out)
    assert whole["row"].tolist() == list(range(95))
    log.unlink()
    assert go() == sweep.Done(10, 0, 0)
    assert not log.exists()
    file = out / "chunks" / "00000004.parquet"
    content = bytearray(file.read_bytes())
    if harm == "cut":
        file.write_bytes(content[:-20])
    elif harm == "altered":
        content[len(content) // 3] ^= 1
        file.write_bytes(content)
    else:
        file.unlink()
    found = sweep.verify(out)
    assert (found.damaged, found.missing, found.complete) == ((4,), (4,), False)
    with pytest.raises(ks.ArgumentError, match="1 damaged"):
        sweep.read(out)
    assert go() == sweep.Done(10, 1, 1)
    assert log.read_text().split() == ["40"]
    same_bits(whole, sweep.read(out))


def test_another_sweep_in_the_folder_is_an_error_that_names_the_field(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    out = tmp_path / "out"
    part = {"machine": MACHINE, "places": PLACES[:20]}
    sweep.to_folder(out, functions.stiff, 20, part, chunk=10)
    with pytest.raises(ks.ArgumentError, match="count is 20 there and 19 here"):
        sweep.to_folder(out, functions.stiff, 19, part, chunk=10)
    # A run without a size takes that of the folder.
    assert sweep.to_folder(out, functions.stiff, 20, part) == sweep.Done(chunks=2, computed=0, damaged=0)
    with pytest.raises(ks.ArgumentError, match="chunk is 10 there and 5 here"):
        sweep.to_folder(out, functions.stiff, 20, part, chunk=5)
    with pytest.raises(ks.ArgumentError, match=r"settings\.places\.sha256"):
        sweep.to_folder(out, functions.stiff, 20, {**part, "places": PLACES[1:21]}, chunk=10)
    other = {**part, "machine": ks.Machine.preset("two_link")}
    with pytest.raises(ks.ArgumentError, match=r"settings\.machine\.machine is \"orthoglide\" there and \"two_link\" here"):
        sweep.to_folder(out, functions.stiff, 20, other, chunk=10)
    longer = {**part, "machine": MACHINE.with_tool(length=0.1)}
    with pytest.raises(ks.ArgumentError, match=r"settings\.machine\.sha256"):
        sweep.to_folder(out, functions.stiff, 20, longer, chunk=10)
    with pytest.raises(ks.ArgumentError, match=r"settings\.wait is \"nothing\" there and 0\.0 here"):
        sweep.to_folder(out, functions.stiff, 20, {**part, "wait": 0.0}, chunk=10)
    manifest = json.loads((out / "manifest.json").read_text())
    manifest["version"] = "0.0.1"
    (out / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(ks.ArgumentError, match=r"version is \"0\.0\.1\" there"):
        sweep.to_folder(out, functions.stiff, 20, part, chunk=10)
    # Nothing of this touched what is there.
    assert sweep.verify(out).complete


DAMAGES: dict[str, dict[str, object]] = {
    "chunks is a list": {"chunks": []},
    "chunks is null": {"chunks": None},
    "chunk without a number": {"chunks": {"first": "0" * 64}},
    "digest is none": {"chunks": {"0": 7}},
    "digest is short": {"chunks": {"0": "ab"}},
    "count is text": {"count": "x"},
    "count is a fraction": {"count": 10.5},
    "count below zero": {"count": -1},
    "chunk of no rows": {"chunk": 0},
    "schema is a dictionary": {"schema": {"a": 1}},
    "schema is null": {"schema": None},
    "schema without shape": {"schema": [{"name": "square", "dtype": "float64"}]},
    "schema of no type": {"schema": [{"name": "square", "dtype": "spring", "shape": []}]},
    "schema with a name twice": {"schema": 2 * [{"name": "square", "dtype": "float64", "shape": []}]},
    "complete is text": {"complete": "yes"},
    "settings is a list": {"settings": []},
}


def altered(folder: Path, change: dict[str, object]) -> None:
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps({**manifest, **change}))


@pytest.mark.parametrize("change", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_manifest_is_said_to_be_one(tmp_path: Path, change: dict[str, object]) -> None:
    pytest.importorskip("pyarrow")
    sweep.to_folder(tmp_path, squares, 10, chunk=4)
    altered(tmp_path, change)
    for ask in (sweep.verify, sweep.read, lambda path: list(sweep.chunks(path)), lambda path: sweep.to_folder(path, squares, 10, chunk=4)):
        with pytest.raises(ks.ArgumentError, match=r"manifest\.json is a damaged manifest"):
            ask(tmp_path)


@pytest.mark.parametrize("index", ["999", "3", "-1"])
def test_a_chunk_of_no_place_is_damaged_and_goes_with_the_next_run(tmp_path: Path, index: str) -> None:
    pytest.importorskip("pyarrow")
    sweep.to_folder(tmp_path, squares, 10, chunk=4)
    recorded = json.loads((tmp_path / "manifest.json").read_text())["chunks"]
    altered(tmp_path, {"chunks": {**recorded, index: recorded["0"]}})
    # Even with a file as it is said to be.
    (tmp_path / "chunks" / f"{int(index):08}.parquet").write_bytes((tmp_path / "chunks" / "00000000.parquet").read_bytes())
    found = sweep.verify(tmp_path)
    assert (found.sound, found.damaged, found.missing, found.complete) == ((0, 1, 2), (int(index),), (), False)
    with pytest.raises(ks.ArgumentError, match="1 damaged"):
        sweep.read(tmp_path)
    with pytest.raises(ks.ArgumentError, match=f"chunk {index} is none of the 3"):
        list(sweep.chunks(tmp_path))
    assert sweep.to_folder(tmp_path, squares, 10, chunk=4).computed == 0
    assert sweep.verify(tmp_path).complete
    assert sweep.read(tmp_path)["square"].tolist() == [float(k**2) for k in range(10)]


@pytest.mark.parametrize(
    "change",
    [
        {"schema": [{"name": "cube", "dtype": "float64", "shape": []}]},
        {"schema": []},
        {"schema": [{"name": "square", "dtype": "float32", "shape": []}]},
        {"schema": [{"name": "square", "dtype": "float64", "shape": [2]}]},
        {"count": 11},
    ],
)
def test_a_manifest_of_other_columns_is_not_read(tmp_path: Path, change: dict[str, object]) -> None:
    pytest.importorskip("pyarrow")
    sweep.to_folder(tmp_path, squares, 10, chunk=4)
    altered(tmp_path, change)
    with pytest.raises(ks.ArgumentError, match="one of them is damaged"):
        sweep.read(tmp_path)


def test_what_is_no_sweep_is_said(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    with pytest.raises(ks.ArgumentError, match=r"no manifest\.json"):
        sweep.verify(tmp_path)
    (tmp_path / "manifest.json").write_text("[1, 2")
    with pytest.raises(ks.ArgumentError, match="is no manifest"):
        sweep.verify(tmp_path)
    with pytest.raises(ks.ArgumentError, match="count is -1"):
        sweep.run(functions.short, -1)
    with pytest.raises(ks.ArgumentError, match="chunk is 0"):
        sweep.run(functions.short, 5, chunk=0)
    with pytest.raises(ks.ArgumentError, match="under_way is 0"):
        sweep.run(functions.short, 5, under_way=0)
    with pytest.raises(ks.ArgumentError, match="expected 5 rows"):
        sweep.run(functions.short, 5)
    with pytest.raises(ks.ArgumentError, match="dtype <U1"):
        sweep.run(functions.texts, 5)
    with pytest.raises(ks.ArgumentError, match="top of a module"):
        sweep.run(lambda first, last, threads: {}, 5)
    with pytest.raises(ks.ArgumentError, match=r"settings\['log'\] is a PosixPath"):
        sweep.to_folder(tmp_path / "out", functions.counted, 5, {"log": tmp_path})
    assert sweep.run(functions.counted, 0, {"log": ""}) == {}


def test_two_runs_do_not_write_one_folder(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    settings = {"log": str(tmp_path / "log"), "wait": 0.3}
    first = threading.Thread(target=sweep.to_folder, args=(tmp_path / "out", functions.counted, 10, settings), kwargs={"chunk": 5})
    first.start()
    time.sleep(0.2)
    with pytest.raises(ks.ArgumentError, match="written by another run"):
        sweep.to_folder(tmp_path / "out", functions.counted, 10, settings, chunk=5)
    first.join()
    assert sweep.verify(tmp_path / "out").complete


def test_progress_counts_rows(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    sweep.run(functions.counted, 95, {"log": str(tmp_path / "log")}, chunk=10, progress=lambda done, of, _: seen.append((done, of)))
    assert seen == [(min(10 * i, 95), 95) for i in range(1, 11)]


@pytest.mark.filterwarnings("ignore::kinetostat.ToleranceMissedWarning")
def test_a_set_of_programs(tmp_path: Path) -> None:
    names = [f"{k}.ngc" for k in range(4)]
    for k, name in enumerate(names):
        text = f"G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z0 F500\nG1 X{10 + 10 * k} Y10 F1000\nG1 X0\nM2\n"
        (tmp_path / name).write_text(text, encoding="utf-8")
    settings = {"folder": str(tmp_path), "names": names}
    found = sweep.run(functions.programs, 4, settings, chunk=1, executor=partial(ProcessPoolExecutor, 2))
    assert all((tmp_path / f"out-{name}").exists() for name in names)
    # The largest error is at least what the machine gives way at the first place of the cut.
    gives_way = np.linalg.norm(MACHINE.equilibrium([[0.0, 0, 0]], [100, -20, -30, 0, 0, 0]).displacement[0, :3]) * 1e3
    assert (found["error_before_mm"] >= 0.99 * gives_way).all()
    assert (np.diff(found["error_before_mm"]) >= 0).all()


def test_the_bar_of_tqdm(tmp_path: Path) -> None:
    pytest.importorskip("tqdm")
    with open(tmp_path / "shown", "w", encoding="utf-8") as shown, ks.bar(file=shown) as progress:
        sweep.run(functions.counted, 95, {"log": str(tmp_path / "log")}, chunk=10, progress=progress)
    assert "95/95" in (tmp_path / "shown").read_text(encoding="utf-8")


STOPPED = """
import signal
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from kinetostat import sweep
import sweep_functions
executor = partial(ProcessPoolExecutor, 2) if sys.argv[3] == "pool" else None
if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where the tests run in the background
    print("begins", flush=True)
    sweep.to_folder(sys.argv[1], sweep_functions.counted, 400, {"log": sys.argv[2], "wait": 0.05}, chunk=10, executor=executor)
"""


@pytest.mark.parametrize("where", ["serial", "pool"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_a_stopped_run_loses_no_finished_chunk(tmp_path: Path, where: str, number: int) -> None:
    pytest.importorskip("pyarrow")
    out, log = tmp_path / "out", tmp_path / "log"
    words = [sys.executable, "-c", STOPPED, str(out), str(log), where]
    here = Path(functions.__file__).parent
    paths = ":".join([str(here), str(Path(ks.__file__).parents[1])])
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={"PYTHONPATH": paths}, start_new_session=True) as run:
        assert run.stdout is not None
        run.stdout.readline()
        # A chunk counts once the journal has its line, which is written behind its file.
        journal = out / "journal.jsonl"
        while not journal.exists() or journal.read_text().count("sha256") < 6:
            time.sleep(0.01)
        run.send_signal(number)
        run.wait(timeout=60)
        assert run.stderr is not None
        if number == signal.SIGINT:
            assert b"KeyboardInterrupt" in run.stderr.read()
    time.sleep(0.3)  # workers of a killed process end their chunk
    kept = len(sweep.verify(out).sound)
    assert 6 <= kept < 40
    begun = len(log.read_text().split())
    assert begun - kept <= 5
    # With workers of a killed process still there: they hold no lock.
    done = sweep.to_folder(out, functions.counted, 400, {"log": str(log), "wait": 0.05}, chunk=10)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(run.pid, signal.SIGKILL)
    assert done.computed == 40 - kept
    assert sweep.verify(out).complete
    assert sweep.read(out)["row"].tolist() == list(range(400))


def test_read_by_pyarrow_and_polars(tmp_path: Path, serial: dict[str, np.ndarray]) -> None:
    pyarrow = pytest.importorskip("pyarrow.dataset")
    sweep.to_folder(tmp_path, functions.stiff, 600, SETTINGS, chunk=100, units={"displacement": "m and rad"})
    table = pyarrow.dataset(tmp_path / "chunks").to_table()
    assert table.schema.field("displacement").metadata[b"unit"] == b"m and rad"
    rows = np.array(table["displacement"].to_pylist())
    assert np.array_equal(rows, serial["displacement"], equal_nan=True)
    polars = pytest.importorskip("polars")
    frame = polars.read_parquet(tmp_path / "chunks")
    assert np.array_equal(frame["displacement"].to_numpy(), serial["displacement"], equal_nan=True)
    assert np.array_equal(frame["force"].to_numpy(), serial["force"], equal_nan=True)


@pytest.mark.filterwarnings("ignore")
def test_dask_with_four_workers_and_one_killed(tmp_path: Path, serial: dict[str, np.ndarray]) -> None:
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("pyarrow")
    mark = tmp_path / "killed"
    settings = {**SETTINGS, "kill": str(mark), "at": 300, "wait": 0.02}
    with (
        distributed.LocalCluster(n_workers=4, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path)) as cluster,
        distributed.Client(cluster) as client,
    ):
        done = sweep.to_folder(tmp_path / "out", functions.stiff, 600, settings, chunk=15, executor=client.get_executor())
    assert mark.exists()
    assert done == sweep.Done(40, 40, 0)
    assert sweep.verify(tmp_path / "out").complete
    same_bits(serial, sweep.read(tmp_path / "out"))


def impatient(done: int, count: int, _: str) -> None:
    if done > count / 2:
        raise KeyboardInterrupt


@pytest.mark.filterwarnings("ignore")
def test_dask_goes_on_at_once_with_what_was_stopped(tmp_path: Path, serial: dict[str, np.ndarray]) -> None:
    """Dask takes calls with equal arguments for one task: those of the stopped run are being cancelled when the next run asks for them."""
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("pyarrow")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path)) as cluster,
        distributed.Client(cluster) as client,
    ):
        for attempt in range(12):
            out = tmp_path / f"out-{attempt}"
            how = {"chunk": 15, "executor": client.get_executor()}
            settings = {**SETTINGS, "wait": 0.001 * attempt}
            with pytest.raises(KeyboardInterrupt):
                sweep.to_folder(out, functions.stiff, 600, settings, progress=impatient, **how)
            assert 0 < len(sweep.verify(out).sound) < 40
            sweep.to_folder(out, functions.stiff, 600, settings, **how)
            same_bits(serial, sweep.read(out))


def test_no_two_submissions_are_equal(tmp_path: Path) -> None:
    """A library that knows tasks by their arguments gives an equal call the answer of the first, or its error."""

    class ByArguments(ThreadPoolExecutor):
        tasks: ClassVar[dict[bytes, Future[Any]]] = {}

        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            key = pickle.dumps((fn, args, kwargs))
            if key not in self.tasks:
                self.tasks[key] = super().submit(fn, *args, **kwargs)
            return self.tasks[key]

    log = tmp_path / "log"
    with ByArguments(1) as pool:
        for _ in range(2):
            found = sweep.run(functions.fails_once, 20, {"mark": str(tmp_path / "failed"), "log": str(log)}, chunk=5, executor=pool)
            assert found["row"].tolist() == list(range(20))
    assert log.read_text(encoding="utf-8").split() == ["0", "5", "10", "5", "15", "0", "5", "10", "15"]


def test_a_cancelled_chunk_is_asked_for_once_more() -> None:
    class Cancelling(ThreadPoolExecutor):
        """Gives the third chunk back cancelled, as Dask does where its scheduler did not answer for a while."""

        asked = 0

        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            self.asked += 1
            if self.asked != 3:
                return super().submit(fn, *args, **kwargs)
            cancelled: Future[Any] = Future()
            cancelled.cancel()
            return cancelled

    with Cancelling(2) as pool:
        assert sweep.run(squares, 20, chunk=4, executor=pool)["square"].tolist() == [n * n for n in range(20)]
        assert pool.asked == 6
    with pytest.raises(sweep.SweepError, match=r"the executor takes no more chunks, from chunk 0 on: .*shutdown"):
        sweep.run(squares, 20, chunk=4, executor=pool)


MPI = """
import sys
import numpy as np
from mpi4py.futures import MPIPoolExecutor
import kinetostat as ks
from kinetostat import sweep
import sweep_functions
if __name__ == "__main__":
    places = np.load(sys.argv[2])
    settings = {"machine": ks.Machine.preset("orthoglide"), "places": places}
    with MPIPoolExecutor() as pool:
        print("ranks that work", pool.num_workers)
        sweep.to_folder(sys.argv[1], sweep_functions.stiff, len(places), settings, chunk=25, executor=pool)
"""


def test_mpi_with_three_ranks(tmp_path: Path, serial: dict[str, np.ndarray]) -> None:
    mpi4py = pytest.importorskip("mpi4py")
    pytest.importorskip("pyarrow")
    beside = [Path(sys.executable).parent, Path(mpi4py.__file__).parents[4] / "bin"]
    mpiexec = next((folder / "mpiexec" for folder in beside if (folder / "mpiexec").exists()), None)
    if mpiexec is None:
        pytest.skip("no mpiexec beside mpi4py (pip install mpich)")
    np.save(tmp_path / "places.npy", PLACES)
    (tmp_path / "job.py").write_text(MPI)
    here = Path(functions.__file__).parent
    paths = ":".join([str(here), str(Path(ks.__file__).parents[1])])
    words = [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", tmp_path / "job.py", tmp_path / "out", tmp_path / "places.npy"]
    env = {"PYTHONPATH": paths, "PATH": "/usr/bin:/bin", "LD_LIBRARY_PATH": str(mpiexec.parents[1] / "lib")}
    run = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=env, timeout=60, check=False)
    assert run.returncode == 0, run.stderr
    assert "ranks that work 2" in run.stdout
    assert sweep.verify(tmp_path / "out").complete
    same_bits(serial, sweep.read(tmp_path / "out"))


def test_only_a_fitting_folder_is_written_to(tmp_path: Path) -> None:
    (tmp_path / "of somebody.txt").write_text("mine")
    with pytest.raises(ks.ArgumentError, match=r"is not empty and holds no sweep \(it has 'of somebody.txt'"):
        sweep.to_folder(tmp_path, squares, 10)
    assert [entry.name for entry in tmp_path.iterdir()] == ["of somebody.txt"]
    with pytest.raises(ks.ArgumentError, match=r"of somebody\.txt is a file, expected a folder"):
        sweep.to_folder(tmp_path / "of somebody.txt", squares, 10)
    # A run that was killed before its manifest was written left these.
    begun = tmp_path / "begun"
    (begun / "chunks").mkdir(parents=True)
    (begun / "journal.jsonl").write_text("")
    assert sweep.to_folder(begun, squares, 10, chunk=4).computed == 3
    assert sweep.to_folder(begun, squares, 10, chunk=4).computed == 0
