"""Machines in three dimensions in a notebook: the page holds what the package computes, and a live one is answered by it."""

import html
import json
import re
from pathlib import Path

import numpy as np
import pytest

import kinetostat as ks

DATA = re.compile(r'<script id="kinetostat-data" type="application/json">(.*?)</script>', re.DOTALL)


def held(page: str) -> dict:
    """Results in a page."""
    found = DATA.search(page)
    assert found is not None
    return json.loads(found[1])


def test_a_page_holds_the_state_that_was_asked_for() -> None:
    machine = ks.Machine.preset("heavy_6r")
    posture = machine.posture(joints=machine.posture().commands + 0.1)
    loaded = posture.deflected_by([300, 100, -500, 10, 0, 0])
    for page in (machine.view(posture, force=[300, 100, -500], moment=[10, 0, 0]).html, loaded.view().html):
        state = held(page)["state"]
        np.testing.assert_allclose(state["displacement_mm"], 1e3 * loaded.displacement[:3], rtol=0, atol=1e-9)
        np.testing.assert_allclose(np.deg2rad(state["actuators"]), posture.commands, rtol=0, atol=1e-12)
        assert state["stable"] == loaded.stable


def test_a_tool_of_the_machine_is_on_the_page() -> None:
    machine = ks.Machine.preset("heavy_6r").with_tool(length=0.2)
    state = held(machine.view().html)["state"]
    np.testing.assert_allclose(state["tool"]["position_mm"], 1e3 * machine.posture().target[:3, 3], rtol=0, atol=1e-6)


def test_a_notebook_gets_a_frame_that_may_do_nothing_else(tmp_path: Path) -> None:
    view = ks.Machine.preset("orthoglide").view()
    shown = view._repr_html_()
    assert shown.startswith('<iframe title="A machine in three dimensions" sandbox="allow-scripts" style=')
    frame = re.search(r'srcdoc="([^"]*)"', shown)
    assert frame is not None
    assert html.unescape(frame[1]) == view.html
    view.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == view.html
    assert held(view.html)["live"] is False


def test_a_live_page_is_answered() -> None:
    pytest.importorskip("anywidget")
    machine = ks.Machine.preset("heavy_6r")
    widget = machine.view().live(height=400)
    assert widget.height == 400
    assert held(widget.page)["live"] is True
    said: list[dict] = []
    widget.send = said.append
    joints = (np.rad2deg(machine.posture().commands) + 5).tolist()
    ask = widget._msg_callbacks
    ask(widget, {"kinetostat": "state", "id": 1, "request": {"actuators": joints, "force_n": [0, 0, -100]}}, [])
    ask(widget, {"kinetostat": "modes", "id": 2, "request": {"actuators": joints}}, [])
    ask(widget, {"kinetostat": "state", "id": 3, "request": {"at_mm": [9000, 0, 0]}}, [])
    ask(widget, {"kinetostat": "open", "id": 4}, [])
    ask(widget, "nonsense", [])
    assert [message["id"] for message in said] == [1, 2, 3]
    loaded = machine.posture(joints=np.deg2rad(joints)).deflected_by([0, 0, -100, 0, 0, 0])
    np.testing.assert_allclose(said[0]["answer"]["displacement_mm"], 1e3 * loaded.displacement[:3], rtol=0, atol=1e-9)
    assert len(said[1]["answer"]["modes"]) == 6
    assert "reached" in said[2]["error"]


def test_wrong_arguments_are_refused() -> None:
    machine = ks.Machine.preset("orthoglide")
    with pytest.raises(ks.ArgumentError, match="force"):
        machine.view(force=[1, 2])
    with pytest.raises(ks.ArgumentError, match="posture"):
        machine.view("home")
    with pytest.raises(ks.ArgumentError, match="height"):
        machine.view().live(height=1)
