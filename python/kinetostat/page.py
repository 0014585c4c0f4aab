"""A machine in three dimensions in a notebook: the page of ``kinetostat view`` in a frame, alone or with Python behind it."""

from __future__ import annotations

import html
import json
import os
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike

from kinetostat import _core
from kinetostat._arguments import of_kind
from kinetostat._arguments import path as file_path
from kinetostat._arrays import Floats, one, whole_number
from kinetostat.errors import KinetostatError

if TYPE_CHECKING:
    from kinetostat.posture import Posture

__all__ = ["View"]


@final
class View:
    """A machine in a posture under a load, in three dimensions. A notebook shows it, and a page that is made of the notebook keeps it.

    Examples
    --------
    >>> import kinetostat as ks
    >>> view = ks.Machine.preset("orthoglide").view(force=[215, -10, -25])
    >>> view.html[:15]
    '<!doctype html>'
    """

    __slots__ = ("_native", "_request")

    def __init__(self, posture: Posture, wrench: ArrayLike) -> None:
        """The posture (its commands are shown) and the load on its tool, (6,): N, N m, base axes."""
        from kinetostat.posture import Posture

        machine = of_kind("posture", posture, Posture, "a Posture").machine
        load: Floats = one("wrench", wrench, (6,))
        scales = [1e3 if actuator.kind == "prismatic" else 180 / np.pi for actuator in machine.actuators]
        self._native = _core.Viewed(machine._native, machine.file.removeprefix("preset "))
        self._request = json.dumps(
            {"actuators": (posture.commands * scales).tolist(), "force_n": load[:3].tolist(), "moment_n_m": load[3:].tolist()}
        )

    @property
    def html(self) -> str:
        """The page, which asks no server and no network.

        Raises
        ------
        UnansweredError
            The machine cannot stand like this.
        """
        return self._native.page(self._request, False)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page as a file; one of that name is replaced.

        Examples
        --------
        >>> import os, tempfile
        >>> import kinetostat as ks
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     ks.Machine.preset("orthoglide").view().save(os.path.join(folder, "orthoglide.html"))
        ...     os.listdir(folder)
        ['orthoglide.html']
        """
        page = self.html
        with open(file_path("path", path), "w", encoding="utf-8", newline="\n") as file:
            file.write(page)

    def live(self, height: int = 640) -> Any:
        """The same as a widget: joints, tool and load are moved by hand, and Python computes what follows.

        Parameters
        ----------
        height : int
            Of the frame, pixels.

        Returns
        -------
        anywidget.AnyWidget

        Raises
        ------
        ImportError
            anywidget is not installed.

        Examples
        --------
        >>> import kinetostat as ks
        >>> ks.Machine.preset("orthoglide").view().live(height=400).height
        400
        """
        pixels = whole_number("height", height, 100, 10_000)
        try:
            import anywidget
            import traitlets
        except ImportError as absent:
            raise ImportError("live views need anywidget: pip install 'kinetostat[view]'") from absent
        native = self._native

        parts = {"_esm": _AROUND, "page": traitlets.Unicode().tag(sync=True), "height": traitlets.Int(640).tag(sync=True)}
        widget_of_page = type("LiveView", (anywidget.AnyWidget,), parts)

        def answer(widget: Any, message: Any, buffers: Any) -> None:
            number = message.get("id") if isinstance(message, dict) else None
            if number is None:
                return
            try:
                found = native.answer(str(message.get("kinetostat")), json.dumps(message.get("request")))
                if found is not None:
                    widget.send({"id": number, "answer": json.loads(found)})
            except KinetostatError as refused:
                widget.send({"id": number, "error": str(refused)})

        live: Any = widget_of_page(page=native.page(self._request, True), height=pixels)
        live.on_msg(answer)
        return live

    def _repr_html_(self) -> str:
        page = html.escape(self.html)
        return (
            f'<iframe title="A machine in three dimensions" sandbox="allow-scripts" style="{_STYLE};height:640px" srcdoc="{page}"></iframe>'
        )

    def __repr__(self) -> str:
        return f"View({self._request})"


_STYLE = "width:100%;border:1px solid #8888;border-radius:6px"

_AROUND = f"""
export default {{
  render({{ model, el }}) {{
    const frame = document.createElement("iframe");
    frame.title = "A machine in three dimensions";
    frame.sandbox = "allow-scripts";
    frame.style = "{_STYLE};height:" + model.get("height") + "px";
    frame.srcdoc = model.get("page");
    el.append(frame);
    const asked = (event) => {{
      if (event.source === frame.contentWindow && event.data?.kinetostat) {{
        model.send(event.data);
      }}
    }};
    const answered = (message) => frame.contentWindow?.postMessage(message, "*");
    window.addEventListener("message", asked);
    model.on("msg:custom", answered);
    return () => {{
      window.removeEventListener("message", asked);
      model.off("msg:custom", answered);
    }};
  }},
}};
"""
