"""Puts what is for looking closer into the window: the choice of fields, and panels that belong to some of them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtWidgets import QFrame, QVBoxLayout, QWidget

from add_core.geometry import TriangleMesh

from ..models.commands import Command
from ..models.field_catalogue import entry_of
from ..models.fields import MATCHED, FieldChoice
from ..models.insights import Insights
from ..models.picks import Pick
from ..models.session import SessionState
from ..models.shapes import IntArray, OpenShape
from .best_list import BestList
from .field_chooser import FieldChooser
from .field_controls import FieldControls
from .matching_panel import MatchingPanel
from .quality_plot import QualityPlot
from .symmetry_panel import SCENES, SymmetryPanel, alike
from .theme import GRID, Theme

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .main_window import MainWindow


class ExploringViews:
    """The chooser above the diffusion controls, its sections below it, the quality plot beside the curves."""

    def __init__(self, window: MainWindow, insights: Insights) -> None:
        self._window, self._session, self._insights = window, window.session, insights
        self.chooser = FieldChooser(self._session, insights, window)
        self.controls = (FieldControls(self._session, 0), FieldControls(self._session, 1))
        self.best = BestList(self._session, insights)
        self.symmetry = SymmetryPanel(self._session, insights, window.display)
        self.matching = MatchingPanel(self._session, insights)
        self.quality = QualityPlot(self._session, insights)
        self.section = QWidget()
        self._had_curves = self._was_matched = False
        self._lay_out()
        self.quality_dock = window.panels.add_beside(window.curve_dock, "Quality of the matching", self.quality)
        self._connect()
        window.add_part(self)
        self._show()

    def _lay_out(self) -> None:
        column = QVBoxLayout(self.section)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(int(1.5 * GRID))
        for widget in (self.chooser, *self.controls, self.symmetry, self.matching, self.best):
            column.addWidget(widget)
        line = QFrame()
        line.setFixedHeight(1)
        line.setStyleSheet("background: palette(mid); border: none;")
        column.addWidget(line)
        self._window.parameters.add_section(self.section)

    def _connect(self) -> None:
        window, session = self._window, self._session
        session.field_changed.connect(self._show)
        session.shapes_changed.connect(self._show)
        self._insights.qualities_changed.connect(self._show_quality)
        self.best.chosen.connect(lambda key, vertex: session.pick(vertex, shape=key))
        window.menus.on("choose_field", lambda: self._open_list(0))
        window.menus.on("choose_comparison", lambda: self._open_list(1))
        window.menus.on("explore_symmetry", self.explore_symmetry)
        window.menus.on("transfer", self.transfer_colours)
        window.aids.palette.sources.append(self._commands)

    # -- models to view -----------------------------------------------------------------------------------------------

    def _show(self) -> None:
        state = self._session.state
        kinds = {choice.kind for choice in state.choices}
        self.symmetry.setVisible(self.explores_symmetry(state))
        self.matching.setVisible(bool(kinds & MATCHED))
        self._bring_forward(bool(kinds & MATCHED))
        self.best.show_if("distance" in kinds and not self.explores_symmetry(state))
        entries = self.chooser.entries
        controls = frozenset().union(*(entry_of(entries, choice).controls for choice in state.choices))
        self._window.parameters.show_relevance(controls)

    def _bring_forward(self, matched: bool) -> None:
        """The quality is in front while a matching is shown, otherwise the curves; a third panel stays in front."""
        if matched != self._was_matched:
            self._was_matched = matched
            docks = (self._window.curve_dock, self.quality_dock)
            before, after = docks if matched else docks[::-1]
            if not after.isHidden() and not before.visibleRegion().isEmpty():
                after.raise_()

    def _show_quality(self) -> None:
        """Bring the plot to the front when the first curves of a transfer are there."""
        has_curves = any(quality.curves for quality in self._insights.qualities)
        if has_curves and not self._had_curves and self.matching.isVisibleTo(self.section):
            self.quality_dock.show()
            self.quality_dock.raise_()
        self._had_curves = has_curves

    @staticmethod
    def explores_symmetry(state: SessionState) -> bool:
        """Whether what is shown is about mirror images."""
        choices = (state.field, state.compare)
        if any(choice is not None and choice.kind == "ambiguity" for choice in choices):
            return True
        return state.field.name == "mirror" or alike(choices, SCENES["distances"][2:])

    def show_theme(self, theme: Theme) -> None:
        """Icons and plots in the theme's colours."""
        self.chooser.show_theme(theme)
        self.symmetry.show_theme(theme)
        self.quality.show_theme(theme)

    # -- what a person does -------------------------------------------------------------------------------------------

    def _open_list(self, panel: int) -> None:
        if self._session.state.active is not None:
            self._window.parameter_dock.show()
            self._window.parameter_dock.raise_()
            self.chooser.open(panel)

    def explore_symmetry(self) -> None:
        """A point and its mirror image, with HKS and AHKS side by side: one step that undo takes back."""
        state = self._session.state
        shape = state.active
        if shape is not None:
            _, _, field, compare = SCENES["distances"]
            self._session.set_scene(field=field, compare=compare, picks=telling_picks(state, shape), layout="single")
            self.symmetry.compare_wanted.emit("hks")
            self.symmetry.compare_wanted.emit("ahks")

    def transfer_colours(self) -> None:
        """The source's place colours on all shapes, and the plot of quality at hand."""
        if self._session.state.active is not None:
            self._session.set_scene(field=FieldChoice("transfer"), compare=None, layout="grid")

    def _commands(self) -> Iterator[Command]:
        for entry in self.chooser.entries if self._session.state.active is not None else ():
            yield Command(
                name=f"field {entry.choice.kind} {entry.choice.descriptor} {entry.choice.name}",
                title=f"Show {entry.title}",
                section=entry.group,
                do=partial(self.chooser.choose, entry.choice),
                help=entry.help,
                on_search=True,
            )


def telling_picks(state: SessionState, shape: OpenShape) -> tuple[Pick, ...]:
    """The last picked point and its mirror image; without any, a point where there is much to see."""
    if shape.symmetry is None or any(pick.is_mirror for pick in state.active_picks):
        return state.picks
    plain = [pick.vertex for pick in state.active_picks if shape.mirror(pick.vertex) is not None]
    vertex = plain[-1] if plain else showy_vertex(shape, shape.symmetry)
    mirror = int(shape.symmetry[vertex])
    return (Pick(shape.key, vertex, 0), Pick(shape.key, mirror, 0, mirror_of=vertex))


HEIGHT, SIDE = 0.42, 0.2
"""Where heat shows well: a little below the middle (a person's thigh), and clearly on one side."""


def showy_vertex(shape: OpenShape, symmetry: IntArray) -> int:
    """A vertex that looks forward, at `HEIGHT`, at least `SIDE` of the greatest width away from its mirror image.

    symmetry : (n,). Where up and front are unknown, the vertex farthest from its mirror image.
    """
    vertices, mesh = shape.shape.vertices, shape.shape
    ways = np.linalg.norm(vertices - vertices[symmetry], axis=1)
    if not (shape.up and shape.front and isinstance(mesh, TriangleMesh)):
        return int(np.argmax(ways))
    axes = {name: np.eye(3)[row] for row, name in enumerate("xyz")}
    up, front = (axes[axis[-1]] * (-1.0 if axis.startswith("-") else 1.0) for axis in (shape.up, shape.front))
    height = vertices @ up
    share = (height - height.min()) / max(float(np.ptp(height)), 1e-12)
    fits = (mesh.vertex_normals @ front > 0.9) & (ways > SIDE * ways.max())
    return int(np.argmin(np.where(fits, np.abs(share - HEIGHT), np.inf))) if fits.any() else int(np.argmax(ways))
