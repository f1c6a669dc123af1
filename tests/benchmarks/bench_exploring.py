"""Three shapes of 6,890 vertices: turning θ, and click to distance map, descriptors being there; software rendering.

Run on a screen: xvfb-run -a -s "-screen 0 1440x900x24" python tests/benchmarks/bench_exploring.py
"""

from __future__ import annotations

import os
import resource
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

os.environ.setdefault("ADD_DATA_DIR", tempfile.mkdtemp())

from PySide6.QtCore import QPoint, QPointF, QSettings, Qt
from PySide6.QtTest import QTest

from add_viewer.assembly import Assembly

PEOPLE = ("humans/3", "humans/13", "humans/0")
CLICKS = 12
APART = 60
"""Pixels between clicks."""
PATIENCE = 300.0


class Bench:
    """A real window with three people, clicked by a mouse."""

    def __init__(self) -> None:
        store = QSettings(str(Path(tempfile.mkdtemp()) / "settings.ini"), QSettings.Format.IniFormat)
        self.assembly = Assembly([], store=store, size=(1440, 900))
        self.assembly.show()
        for key in PEOPLE:
            self.assembly.opening.open(key)
            self.wait(lambda key=key: self.assembly.session.state.active_key == key)
        self.drawn: dict[str, int] = {}
        self.last = 0.0, 0.0
        self.assembly.results.fields_changed.connect(self._answered)
        for view in self.assembly.window.scene.views:
            view.canvas.painted.connect(lambda key=view.key: self._painted(key))

    def _answered(self, _panel: int, key: str) -> None:
        self.drawn[key] = 0

    def _painted(self, key: str) -> None:
        if key in self.drawn:
            self.drawn[key] += 1
            self.last = time.perf_counter(), _cpu()

    def wait(self, condition: Callable[[], bool]) -> None:
        end = time.perf_counter() + PATIENCE
        while not condition():
            self.assembly.app.processEvents()
            time.sleep(0.001)
            if time.perf_counter() > end:
                raise TimeoutError("the window did not get there")

    def settle(self, seconds: float = 1.5) -> None:
        end = time.perf_counter() + seconds
        self.wait(lambda: time.perf_counter() > end)

    def show(self, **field: object) -> None:
        """This field on all shapes."""
        session, results = self.assembly.session, self.assembly.results
        session.pick(6868)
        session.choose_field(**field)

        def there() -> bool:
            fields = [results.fields.get((0, key)) for key in PEOPLE]
            return all(field is not None and field.values is not None for field in fields)

        self.wait(there)
        self.settle()

    def places(self) -> list[QPoint]:
        """Pixels where a click hits the source, each far from the one before."""
        canvas = self.assembly.window.scene.active_view.canvas
        chosen: list[QPoint] = []
        for vertex in range(11, self.assembly.session.state.active.vertex_count, 97):
            place = canvas.place_of(vertex).toPoint()
            apart = not chosen or (place - chosen[-1]).manhattanLength() > APART
            if apart and canvas.vertex_at(QPointF(place)) >= 0:
                chosen.append(place)
        return chosen

    def click(self, place: QPoint) -> tuple[float, float]:
        """What `latency` says of a click."""
        canvas = self.assembly.window.scene.active_view.canvas
        button, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
        return self.latency(lambda: QTest.mouseClick(canvas, button, keys, place))

    def latency(self, act: Callable[[], object]) -> tuple[float, float]:
        """Milliseconds from what is done to the last of the three pictures: on the clock, and of CPU."""
        self.drawn.clear()
        start, used = time.perf_counter(), _cpu()
        act()
        self.wait(lambda: len(self.drawn) == len(PEOPLE) and all(self.drawn.values()))
        return 1000 * (self.last[0] - start), 1000 * (self.last[1] - used)


def _cpu() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def _print(name: str, aim: int, taken: list[tuple[float, float]]) -> None:
    clock, work = (statistics.median(column) for column in zip(*taken, strict=True))
    print(f"{name:36s} {clock:8.0f} ms   (aim {aim})   {work:5.0f} ms of CPU", flush=True)


def main() -> None:
    """Print the table."""
    bench = Bench()
    bench.show(kind="heat")
    taken = []
    for turn in range(CLICKS):
        taken.append(bench.latency(lambda turn=turn: bench.assembly.session.diffuse(theta=0.2 * turn + 0.1)))
        bench.settle(0.4)
    _print("θ to three pictures", 200, taken)
    for descriptor in ("hks", "wks", "ahks", "humans-madd3"):
        bench.show(kind="distance", descriptor=descriptor)
        taken = []
        for place in bench.places()[:CLICKS]:
            taken.append(bench.click(place))
            bench.settle(0.4)
        _print(f"click to distance map, {descriptor}", 150, taken)
    bench.assembly.stop()


if __name__ == "__main__":
    main()
