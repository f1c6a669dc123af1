"""A person who does one thing after another, by seed: for soaks, where nothing may break, stick or leak."""

from __future__ import annotations

import gc
import os
import random
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from add_core.geometry import shapes
from add_core.io import save_shape
from add_viewer.controllers.carrying import true_match
from add_viewer.models.field_catalogue import catalogue
from add_viewer.models.session_file import KeptSession
from add_viewer.tasks.memory import give_back

NONE, SHIFT, ALT, CONTROL = (
    Qt.KeyboardModifier.NoModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ControlModifier,
)
QUICK_KINDS = {"skin", "heat", "rose", "curvature", "file", "transfer"}
"""Fields that need no process."""


def small_shapes(folder: Path) -> list[str]:
    """Two tori of one connectivity, an open mesh and a cloud, as files."""
    tori = [shapes.torus(major=1.0, minor=minor, around=30, through=14) for minor in (0.35, 0.45)]
    made = {"ring.off": tori[0], "wide ring.ply": tori[1], "sheet.obj": shapes.rectangle(2.0, 3.0, n=14)}
    for name, shape in made.items():
        save_shape(shape, folder / name)
    points = np.random.default_rng(0).normal(size=(600, 3))
    np.savetxt(folder / "cloud.xyz", points / np.linalg.norm(points, axis=1, keepdims=True))
    return [str(folder / name) for name in (*made, "cloud.xyz")]


class Soaker:
    """Acts on a running app. references : what it opens. thorough : whether it starts processes too."""

    def __init__(self, assembly: Any, seed: int, references: list[str], folder: Path, *, thorough: bool) -> None:
        self.assembly, self.window, self.session = assembly, assembly.window, assembly.session
        self._random = random.Random(seed)
        self._references, self._folder, self._thorough = references, folder, thorough
        self.done: list[str] = []
        self.problems: list[str] = []
        assembly.results.noticed.connect(self._heard)
        sys.excepthook = lambda kind, error, _trace: self.problems.append(f"{kind.__name__}: {error}")
        common = {
            self._open: 5,
            self._close: 2,
            self._pick: 12,
            self._drag: 6,
            self._wheel: 3,
            self._key: 10,
            self._dial: 5,
            self._type: 5,
            self._slide: 6,
            self._undo: 9,
            self._field: 6,
            self._compare: 2,
            self._arrange: 4,
            self._look: 3,
            self._taste: 4,
            self._palette: 3,
            self._panels: 2,
            self._save: 2,
            self._reopen: 1,
            self._script: 1,
        }
        jobs: dict[Callable[[], None], int] = {self._train: 2, self._cancel: 4, self._symmetry: 1}
        self._actions = common | (jobs if thorough else {})

    # -- running ------------------------------------------------------------------------------------------------------

    def act(self, count: int) -> None:
        """Do `count` things."""
        for _ in range(count):
            (action,) = self._random.choices(list(self._actions), weights=list(self._actions.values()))
            self.done.append(action.__name__)
            action()
            self.wait(self._random.choice((0.0, 0.01, 0.03, 0.15)))

    def use_every_view(self) -> None:
        """Have as many views as ever, each drawn in every way and at full size.

        Views are kept, each with a graphics context of its own, which keeps a program for every way of drawing.
        """
        for reference in self._references:
            self.window.open_requested.emit(reference)
        self.settle()
        self.session.choose_comparison(self.session.state.field)
        for shape in self.session.state.shapes:
            self.session.show_shape(shape.key)
            self.session.pick(0)
        for theme in ("light", "dark"):
            self.window.display.set("theme", theme)
            for wireframe in (True, False):
                for shape in self.session.state.shapes:
                    self.session.set_look(shape.key, wireframe=wireframe)
                self._draw_every_field()
        self.session.arrange(layout="single")
        for comparison in (self.session.state.field, None):
            self.session.choose_comparison(comparison)
            for shape in self.session.state.shapes:
                self.session.show_shape(shape.key)
                self.wait(0.5)

    def _draw_every_field(self) -> None:
        for entry in catalogue(self.session.state, ()):
            if entry.choice.kind in QUICK_KINDS:
                self.session.choose_field(kind=entry.choice.kind, name=entry.choice.name, index=entry.choice.index)
                self.session.choose_comparison(entry.choice)
                self.wait(0.3)

    def wait(self, seconds: float) -> None:
        """Let the window work."""
        end = time.perf_counter() + seconds
        self.assembly.app.processEvents()
        while time.perf_counter() < end:
            self.assembly.app.processEvents()
            time.sleep(0.002)

    def settle(self, patience: float = 120.0) -> bool:
        """End what runs and wait until nothing is left to do; whether that came about."""
        self.window.parameters.play.setChecked(False)
        end = time.perf_counter() + patience
        while time.perf_counter() < end:
            running = [job for job in self.assembly.jobs.listed if job.state in ("running", "waiting")]
            for job in running:
                self.assembly.jobs.cancel(job.id)
            self.wait(0.1)
            if not running and self.assembly.worker.is_idle and not self.assembly.results.busy:
                return True
        return False

    def _heard(self, notice: Any) -> None:
        if "unexpected" in notice.text:
            self.problems.append(notice.text)

    def kept(self) -> KeptSession:
        """What the session is, but for the moment and Qt's packing of the panels."""
        return replace(self.assembly.keeping.snapshot(), saved="", layout="")

    def memory(self) -> float:
        """Megabytes that this process holds with no shape open, undo kept: a leak shows, whatever was open before.

        Measured twice after the same preparation (every library loaded, every view used, no shape open), with freed
        memory given back to the system, the difference is what leaks. Caches have limits of their own (800 MB of
        answers, so many factorisations, graphs and maps); they are emptied, each on the thread that it belongs to.
        """
        for shape in self.session.state.shapes:
            self.session.close_shape(shape.key)
        self.settle()
        self.assembly._give_back()  # on the thread that factorised: SciPy frees nothing on another
        self.settle()
        self.assembly.exploration.answers._known.clear()
        self.assembly.exploration.best._graphs.clear()
        true_match.cache_clear()
        gc.collect()
        give_back()
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

    # -- actions ------------------------------------------------------------------------------------------------------

    @property
    def _canvas(self) -> Any:
        return self._random.choice(self.window.scene.views).canvas

    def _place(self, widget: Any) -> QPoint:
        return QPoint(self._random.randrange(max(widget.width(), 1)), self._random.randrange(max(widget.height(), 1)))

    def _open(self) -> None:
        if len(self.session.state.shapes) < 4:
            self.window.open_requested.emit(self._random.choice(self._references))

    def _close(self) -> None:
        QTest.keyClick(self.window, Qt.Key.Key_W, CONTROL)

    def _pick(self) -> None:
        shape = self.session.state.active
        modifier = self._random.choice((NONE, NONE, SHIFT, ALT))
        canvas = self.window.view.canvas
        if shape is not None and canvas.isVisible() and self._random.random() < 0.8:
            place = canvas.place_of(self._random.randrange(shape.vertex_count)).toPoint()
        else:
            place = self._place(canvas)
        QTest.mouseClick(canvas, Qt.MouseButton.LeftButton, modifier, place)

    def _drag(self) -> None:
        canvas, button = self._canvas, self._random.choice((Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton))
        place = self._place(canvas)
        QTest.mousePress(canvas, button, NONE, place)
        for step in range(1, 4):
            QTest.mouseMove(canvas, place + QPoint(12 * step, -7 * step))
        QTest.mouseRelease(canvas, button, NONE, place + QPoint(36, -21))

    def _wheel(self) -> None:
        self._canvas.steer("zoom", (self._random.choice((0.8, 1.25)), 0.1, 0.1))

    def _key(self) -> None:
        keys = "dwbnlrf13467m"
        extra = (Qt.Key.Key_Space, Qt.Key.Key_Escape)
        key = self._random.choice([*(getattr(Qt.Key, f"Key_{letter.upper()}") for letter in keys), *extra])
        QTest.keyClick(self.window, key)

    def _dial(self) -> None:
        dial = self.window.parameters.dial
        place = dial.place_of(self._random.uniform(0, 2 * np.pi)).toPoint()
        QTest.mouseClick(dial, Qt.MouseButton.LeftButton, self._random.choice((NONE, CONTROL)), place)

    def _type(self) -> None:
        panel = self.window.parameters
        field = self._random.choice((panel.alpha.field, panel.theta, panel.time.field, panel.picks.field))
        if not field.isVisible():
            return
        field.setFocus()  # where keys go: Return presses what has the focus
        field.selectAll()
        QTest.keyClicks(field, self._random.choice(("0", "7.5", "200", "-3", "1e9", "nonsense", "", "33")))
        QTest.keyClick(field, Qt.Key.Key_Return)

    def _slide(self) -> None:
        for _ in range(self._random.randrange(1, 6)):
            self.session.diffuse(alpha=self._random.uniform(0, 100), reach=10 ** self._random.uniform(-2.5, 0.5))
            self.wait(0.0)
        self.session.end_gesture()

    def _undo(self) -> None:
        for _ in range(self._random.randrange(1, 6)):
            modifiers = CONTROL | SHIFT if self._random.random() < 0.4 else CONTROL
            QTest.keyClick(self.window, Qt.Key.Key_Z, modifiers)

    def _entries(self) -> list[Any]:
        names = ("hks", "wks", "ahks") if self._thorough else ()
        entries = catalogue(self.session.state, names)
        return [entry for entry in entries if self._thorough or entry.choice.kind in QUICK_KINDS]

    def _field(self) -> None:
        choice = self._random.choice(self._entries()).choice
        self.session.choose_field(kind=choice.kind, descriptor=choice.descriptor, name=choice.name, index=choice.index)

    def _compare(self) -> None:
        choice = self._random.choice(self._entries()).choice
        self.session.choose_comparison(choice if self._random.random() < 0.5 else None)

    def _arrange(self) -> None:
        change = self._random.choice(({"layout": "grid"}, {"layout": "strip"}, {"layout": "single"}))
        self.session.arrange(**change)

    def _look(self) -> None:
        if self.session.state.shapes:
            key = self._random.choice(self.session.state.shapes).key
            change = self._random.choice(
                ({"visible": False}, {"visible": True}, {"wireframe": True}, {"point_size": 2.0})
            )
            self.session.set_look(key, **change)
            self.session.move_shape(key, self._random.randrange(4))
            self.session.show_shape(self._random.choice(self.session.state.shapes).key)

    def _taste(self) -> None:
        changes = {
            "theme": ("light", "dark"),
            "kernel_scale": ("linear", "log"),
            "kernel_colours": ("kernel", "sequential", "grey"),
            "up_axis": ("auto", "+y", "+z"),
        }
        name = self._random.choice(list(changes))
        self.window.display.set(name, self._random.choice(changes[name]))

    def _palette(self) -> None:
        palette = self.window.aids.palette
        QTest.keyClick(self.window, Qt.Key.Key_P, CONTROL | SHIFT)
        QTest.keyClicks(palette.field, self._random.choice(("wire", "theta", "log", "zzz")))
        QTest.keyClick(palette.field, self._random.choice((Qt.Key.Key_Return, Qt.Key.Key_Escape)))
        palette.leave()

    def _panels(self) -> None:
        if self.session.state.shapes:
            self._random.choice((self.window.curve_dock.close, self.window.curve_dock.show, self.window.reset_layout))()

    def _save(self) -> None:
        if self.session.state.shapes:
            self.assembly.session_files.save_as(self._folder / "soak.addsession")

    def _reopen(self) -> None:
        if (self._folder / "soak.addsession").exists():
            self.window.open_requested.emit(str(self._folder / "soak.addsession"))

    def _script(self) -> None:
        self.assembly.saving.copy_script()

    def _train(self) -> None:
        panel = self.assembly.background.training_panel
        panel.submitted.emit(panel.request)

    def _cancel(self) -> None:
        listed = self.assembly.jobs.listed
        if listed:
            self.assembly.jobs.cancel(self._random.choice(listed).id)

    def _symmetry(self) -> None:
        QTest.keyClick(self.window, Qt.Key.Key_S)
