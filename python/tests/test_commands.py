"""Commands as functions give the JSON of the command line, run as a process."""

from __future__ import annotations

import inspect
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import kinetostat as ks


def program():
    """The command that the package installs; in a source tree the binary that cargo built."""
    beside = Path(sys.executable).with_name("kinetostat")
    built = Path(__file__).resolve().parents[2] / "target/debug/kinetostat"
    found = next((path for path in (beside, built) if path.is_file()), None) or shutil.which("kinetostat")
    assert found, "there is no kinetostat command beside this Python"
    return str(found)


CASES = [
    (lambda m: ks.commands.stiffness("orthoglide"), ["stiffness", "orthoglide"]),
    (lambda m: ks.commands.stiffness(m), ["stiffness", "orthoglide"]),
    (lambda m: ks.commands.deflect("orthoglide", force=[100, -20, -30]), ["deflect", "orthoglide", "--force", "100", "-20", "-30"]),
    (lambda m: ks.commands.map("orthoglide", x=[-50, 50, 5]), ["map", "orthoglide", "--x", "-50", "50", "5"]),
    (lambda m: ks.commands.model_list(), ["model", "list"]),
    (lambda m: ks.commands.model_show("heavy_6r"), ["model", "show", "heavy_6r"]),
]


def without_file(value):
    """The name of the model's file is another where a machine was handed over."""
    return (
        {key: inner for key, inner in value.items() if key not in ("file", "model", "model_source")} if isinstance(value, dict) else value
    )


@pytest.mark.parametrize(("ask", "words"), CASES, ids=[f"{i} {' '.join(words)}" for i, (_, words) in enumerate(CASES)])
def test_same_answer_as_the_command_line(ask, words):
    found = ask(ks.Machine.preset("orthoglide"))
    if isinstance(found, str):
        assert found == subprocess.run([program(), *words], check=True, capture_output=True, text=True).stdout
        return
    said = subprocess.run([program(), *words, "--json"], check=True, capture_output=True, text=True).stdout
    assert without_file(found) == without_file(json.loads(said))


def test_options_that_a_command_refuses_are_not_offered():
    refused = {"report", "free_turn", "stiff_turn", "turn_plot", "uncertain", "machines", "part_lines"}

    def offered(command):
        return set(inspect.signature(command).parameters)

    assert not refused & offered(ks.commands.verify)
    assert not (refused | {"points", "vtk"}) & offered(ks.commands.place)
    assert (refused | {"points", "vtk"}) - offered(ks.commands.compensate) == {"part_lines"}
    # A name of before is taken as long as the command line takes it.
    assert {"controller", "pendant"} <= offered(ks.commands.stiffness)


def test_wrong_input_and_no_answer_are_errors():
    with pytest.raises(ks.ArgumentError):
        ks.commands.stiffness("no_such_machine")
    with pytest.raises(ks.KinetostatError):
        ks.commands.stiffness("orthoglide", at=[1e9, 0, 0])
    assert ks.commands.run(["stiffness", "no_such_machine"]).code == 1


def test_machines_are_named_as_themselves_not_as_files_that_are_gone():
    machine = ks.Machine.preset("orthoglide")
    found = ks.commands.compare(machine, "puu3")
    assert (found["a"], found["b"]) == ("orthoglide", "puu3")
    document = machine.to_dict()
    document["mechanism"]["name"] = 'my "own" machine'
    assert ks.commands.compare("puu3", ks.Machine.from_dict(document))["b"] == 'my "own" machine'
    with pytest.raises(ks.KinetostatError) as refused:
        ks.commands.stiffness(machine, at=[9000, 0, 0])
    assert "kinetostat-" not in str(refused.value)


def test_an_error_of_a_command_has_its_faults() -> None:
    with pytest.raises(ks.UnansweredError, match="cannot be reached") as far:
        ks.commands.stiffness("orthoglide", at=[0, 0, 9000])
    assert [fault["code"] for fault in far.value.diagnostics] == ["unreachable"]
    with pytest.raises(ks.ArgumentError) as refused:
        ks.commands.map("orthoglide")
    assert refused.value.diagnostics[0]["code"] == "missing"
