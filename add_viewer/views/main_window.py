"""The window: menus around, the view in the middle, controls on the left, curves below."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QApplication,
    QLabel,
    QMainWindow,
    QMenu,
    QPushButton,
    QScrollArea,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from add_core import __version__

from ..models.display import Display
from ..models.results import Notice, Results
from ..models.session import Session
from ..models.step_words import words_of
from .aids import Aids
from .context_menu import context_menu
from .curve_panel import CurvePanel
from .icons import icon
from .menu_entry import add_entry
from .menus import Menus
from .message_bar import MessageBar
from .panels import Panels
from .parameter_panel import ParameterPanel
from .reading_order import go
from .scene import SceneView
from .settings import Settings
from .shape_view import IDLE_TEXT, ShapeView
from .share_bar import ShareBar
from .start_page import Gallery, StartPage, title_of
from .theme import GRID, apply_theme, theme_of

TITLE = "Anisotropic Diffusion Descriptors"
NEED_A_SHAPE = (
    *("close", "script", "figure", "animation", "screenshot"),
    *("choose_field", "choose_comparison", "explore_symmetry", "transfer"),
)
"""Actions of the menus that need an open shape, beside those of its view."""


class MainWindow(QMainWindow):
    """Puts the parts together and lets them show the models.

    open_requested : a path or a shipped name that the person wants to see. cancel_requested : what the status line
        tells the progress of shall end.
    """

    open_requested = Signal(str)
    cancel_requested = Signal()

    def __init__(
        self, session: Session, results: Results, display: Display, settings: Settings, galleries: tuple[Gallery, ...]
    ) -> None:
        super().__init__()
        self.session, self.results, self.display, self.settings = session, results, display, settings
        settings.restore_display(display)
        self.setWindowTitle(TITLE)
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        self.menus = Menus(self, display)
        self.scene = SceneView(session, results, display)
        self.start = StartPage(galleries)
        self.message = MessageBar()
        self.parameters = ParameterPanel(session, results)
        self.curves = CurvePanel(session, results, display)
        self.panels = Panels(self, self.menus.docks)
        self.aids = Aids(self)
        self._added: list[Any] = []
        self._build()
        self._connect()
        self._show_theme()
        self._show_recent()
        if not settings.restore_window(self):
            self.resize(1440, 900)
        self._show_active()
        self._show_history()

    @property
    def view(self) -> ShapeView:
        """The view of the active shape."""
        return self.scene.active_view

    # -- building -----------------------------------------------------------------------------------------------------

    def _build(self) -> None:
        self.pages = QStackedWidget()
        self.pages.addWidget(self.start)
        self.pages.addWidget(self.scene)
        centre = QWidget()
        column = self._column = QVBoxLayout(centre)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.message)
        column.addWidget(self.pages, 1)
        self.setCentralWidget(centre)
        scroll = QScrollArea()
        scroll.setWidget(self.parameters)
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setCorner(Qt.Corner.BottomLeftCorner, Qt.DockWidgetArea.LeftDockWidgetArea)
        self.parameter_dock = self.panels.add("What is shown", scroll, Qt.DockWidgetArea.LeftDockWidgetArea)
        self.curve_dock = self.panels.add(
            "Curves at the picked points", self.curves, Qt.DockWidgetArea.BottomDockWidgetArea
        )
        self.parameter_dock.setMinimumWidth(37 * GRID)
        self._size_panels()
        self._build_status()

    def _size_panels(self) -> None:
        self.resizeDocks([self.parameter_dock], [38 * GRID], Qt.Orientation.Horizontal)
        self.resizeDocks([self.curve_dock], [30 * GRID], Qt.Orientation.Vertical)

    def reset_layout(self) -> None:
        """Panels where they were at the first start."""
        self.panels.reset()
        self._size_panels()

    def _build_status(self) -> None:
        self.hover_label, self.busy_label, self.progress = QLabel(), QLabel(), ShareBar()
        self.progress.setFixedWidth(15 * GRID)
        self.cancel = QPushButton("Cancel")
        self.cancel.setToolTip("Stop this computation")
        self.cancel.clicked.connect(self.cancel_requested)
        self.progress.hide()
        self.cancel.hide()
        bar = self.statusBar()
        bar.setSizeGripEnabled(False)
        bar.setContentsMargins(GRID, 0, GRID, 0)
        bar.addWidget(self.hover_label, 1)
        bar.addPermanentWidget(self.busy_label)
        bar.addPermanentWidget(self.progress)
        bar.addPermanentWidget(self.cancel)

    def _connect(self) -> None:
        self.open_requested.connect(self.message.begin)
        self.session.active_changed.connect(self._show_active)
        self.session.history_changed.connect(self._show_history)
        self.results.busy_changed.connect(self._show_busy)
        self.results.noticed.connect(self._show_notice)
        self.display.changed.connect(lambda name: self._show_theme() if name == "theme" else None)
        QApplication.styleHints().colorSchemeChanged.connect(self._show_theme)
        self.scene.hovered.connect(self.hover_label.setText)
        self.scene.menu_requested.connect(self._show_context_menu)
        self.start.chosen.connect(self._open_chosen)
        self.start.left.connect(self.show_shapes)
        looks = ("front", "back", "left", "right", "top")
        for name in looks:
            self.menus.on(name, partial(self.scene.look, name))
        tools = ("arrows", "wireframe", "fit", "undo", "redo", "screenshot")
        self.scene.show_tools([self.menus.actions[name] for name in tools])
        self.menus.on("fit", self.scene.fit)
        self.session.arrangement_changed.connect(self._show_arrangement)
        self.menus.on_arrangement(self.session.arrange)
        self.menus.on("undo", self.session.undo)
        self.menus.on("redo", self.session.redo)
        self.menus.on("clear", self.session.clear_picks)
        self.menus.on("pick_mirror", self._pick_mirror)
        self.menus.on("go_to", self._go_to)
        self.menus.on("play", self.parameters.play.toggle)
        self.menus.on("start", self.show_start)
        self.menus.on("close", self._close_shape)
        self.menus.on("quit", self.close)

    # -- models to view -----------------------------------------------------------------------------------------------

    def _show_active(self) -> None:
        shape = self.session.state.active
        self.start.show_way_back(None)
        self.menus.show_hidden(False)
        self.pages.setCurrentWidget(self.start if shape is None else self.scene)
        self.setWindowTitle(TITLE if shape is None else f"{shape.name} — {TITLE}")
        self.parameters.play.setChecked(False)
        self.menus.say("close", "" if shape is None else f"&Close {shape.name.replace('&', '&&')}")
        for name in (*NEED_A_SHAPE, "go_to", "fit", "play", "front", "back", "left", "right", "top"):
            self.menus.actions[name].setEnabled(shape is not None)
        self.hover_label.setText("" if shape is None else IDLE_TEXT)
        self.panels.show(shape is not None and self.pages.currentWidget() is self.scene)

    def show_shapes(self) -> None:
        """Back from the start page to what is open."""
        self._show_active()

    def show_start(self) -> None:
        """Offer shapes to open; the session stays as it is, and nothing is done to it unseen."""
        shape = self.session.state.active
        self.menus.show_hidden(shape is not None)
        self.parameters.play.setChecked(False)
        self.start.show_way_back(None if shape is None else shape.name)
        self.hover_label.clear()
        self.pages.setCurrentWidget(self.start)
        self.panels.show(False)

    def _show_history(self) -> None:
        picks = self.session.state.active_picks
        enabled = {
            "undo": self.session.can_undo,
            "redo": self.session.can_redo,
            "clear": bool(picks),
            "curves": bool(picks),
            "pick_mirror": bool(picks) and self._mirror() is not None,
        }
        for name, on in enabled.items():
            self.menus.actions[name].setEnabled(on)
        for name, step in (("undo", self.session.undo_step), ("redo", self.session.redo_step)):
            words = "" if step is None else words_of(step).replace("&", "&&")
            self.menus.say(name, f"&{name.capitalize()}: {words}" if words else "")

    def _show_arrangement(self) -> None:
        self.menus.show_arrangement(self.session.state.arrangement)

    def _show_busy(self) -> None:
        self.busy_label.setText(self.results.busy)
        self.progress.setVisible(bool(self.results.busy))
        share = self.results.progress
        self.cancel.setVisible(share is not None)
        self.progress.show_share(share)

    def _show_notice(self, notice: Notice) -> None:
        self.message.show_notice(notice)

    def _show_theme(self) -> None:
        theme = theme_of(self.display["theme"])
        apply_theme(theme)
        self.setWindowIcon(icon("mdi6.blur-radial", theme.accent))
        parts: list[Any] = [self.menus, self.scene, self.start, self.message, self.parameters, self.curves, self.panels]
        parts += [self.aids, *self._added]
        for part in parts:
            part.show_theme(theme)

    def add_above(self, bar: QWidget) -> None:
        """Put a bar that comes and goes above the view; it follows the theme."""
        self._column.insertWidget(0, bar)
        self.add_part(bar)

    def add_part(self, part: Any) -> None:
        """Let `part`, which was put into the window later, follow the theme."""
        self._added.append(part)
        part.show_theme(theme_of(self.display["theme"]))

    def _show_recent(self) -> None:
        references = self.settings.recent
        self.start.show_recent(references)
        menu = self.menus.recent
        menu.clear()
        for reference in references:
            title = title_of(reference, self.start.galleries).replace("&", "&&")
            add_entry(menu, title).triggered.connect(lambda _checked, name=reference: self.open_requested.emit(name))
        menu.setEnabled(bool(references))
        if references:
            menu.addSeparator()
            add_entry(menu, "Clear this list").triggered.connect(self._clear_recent)

    def remember(self, reference: str) -> None:
        """Put a reference at the head of the recent ones."""
        self.settings.add_recent(reference)
        self._show_recent()

    def forget(self, reference: str) -> None:
        """Take a reference off the recent ones and say so, if it is one of them."""
        if reference in self.settings.recent:
            self.settings.remove_recent(reference)
            self._show_recent()
            self.statusBar().showMessage(f"Taken off the recent files: {reference}", 6000)

    def _clear_recent(self) -> None:
        self.settings.clear_recent()
        self._show_recent()

    # -- what a person does -------------------------------------------------------------------------------------------

    def _mirror(self) -> int | None:
        state = self.session.state
        plain = [pick for pick in state.active_picks if not pick.is_mirror]
        return state.active.mirror(plain[-1].vertex) if state.active and plain else None

    def _pick_mirror(self) -> None:
        plain = [pick for pick in self.session.state.active_picks if not pick.is_mirror]
        if plain:
            self.session.pick_mirror(plain[-1].vertex)

    def _open_chosen(self, reference: str) -> None:
        shape = self.session.state.active
        if shape is not None and shape.key == reference:
            self.show_shapes()  # it is open already
        else:
            self.open_requested.emit(reference)

    def _go_to(self) -> None:
        self.parameter_dock.show()
        self.parameter_dock.raise_()
        self.parameters.picks.field.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def _close_shape(self) -> None:
        if self.session.state.active_key is not None:
            self.message.begin()
            self.session.close_shape(self.session.state.active_key)
            self.message.succeed()

    def _show_context_menu(self, place: QPoint, key: str, vertex: int) -> None:
        self.context_menu(key, vertex).popup(place)

    def context_menu(self, key: str, vertex: int) -> QMenu:
        """What makes sense at `vertex` of the shape `key`, or beside it (-1)."""
        return context_menu(self, self.session, self.menus.actions, key, vertex)

    def focusNextPrevChild(self, forward: bool) -> bool:
        return go(self, forward=forward)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        for url in event.mimeData().urls():
            if url.isLocalFile():
                self.open_requested.emit(str(Path(url.toLocalFile())))
        event.acceptProposedAction()

    def closeEvent(self, event: QCloseEvent) -> None:
        self.parameters.play.setChecked(False)
        self.panels.show(True)
        self.settings.keep_window(self)
        self.scene.close_views()
        super().closeEvent(event)

    @property
    def about_text(self) -> str:
        return (
            f"<b>{TITLE}</b> {__version__}<p>Shape descriptors that know directions, after Boscaini, Masci, Rodolà, "
            "Bronstein and Cremers, Eurographics 2016.</p><p>MIT licence. People: MakeHuman (CC0). "
            "Dogs: dm_control (Apache-2.0).</p>"
        )
