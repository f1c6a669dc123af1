"""The menus: every action with its words, its key and its icon, in one table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QMainWindow, QMenu

from ..models.arrangement import Arrangement
from ..models.display import Display
from .action_tour import plain
from .icons import icon
from .theme import Theme


@dataclass(frozen=True)
class Entry:
    """One action: its words, key, icon and one sentence of help."""

    name: str
    text: str
    key: str = ""
    icon: str = ""
    help: str = ""


FILE = (
    Entry("open", "&Open…", "Ctrl+O", "mdi6.folder-open-outline", "Open shapes from files"),
    Entry("start", "Open &shipped shape…", "Ctrl+Shift+O", "mdi6.human-handsup", "Choose one of the people and dogs"),
    Entry("recent", "Open &recent"),
    Entry("", ""),
    Entry("save_session", "&Save session", "Ctrl+S", "mdi6.content-save-outline", "Shapes, picks, views and panels"),
    Entry("save_session_as", "Save session &as…", "Ctrl+Shift+S", "mdi6.content-save-edit-outline"),
    Entry("open_session", "Open sessio&n…", "", "mdi6.folder-clock-outline", "Go on where a session was saved"),
    Entry("last_session", "Go on with the &last session", "", "mdi6.history", "As it was when the app was closed last"),
    Entry("", ""),
    Entry(
        "screenshot", "Save &picture…", "Ctrl+P", "mdi6.camera-outline", "Save the view as a PNG, up to 4×, transparent"
    ),
    Entry(
        "figure",
        "Export &figure…",
        "Ctrl+Shift+E",
        "mdi6.file-image-outline",
        "Views and curves as PDF, SVG or PNG",
    ),
    Entry(
        "animation", "Export &animation…", "", "mdi6.movie-open-outline", "A turntable or a sweep of θ or t as a GIF"
    ),
    Entry("curves", "&Export curves…", "Ctrl+E", "mdi6.chart-line", "Save the curves as PNG, SVG, PDF or CSV"),
    Entry("", ""),
    Entry("close", "&Close shape", "Ctrl+W", "mdi6.close", "Close the source: the shape in bold in the list"),
    Entry("quit", "&Quit", "Ctrl+Q", "mdi6.exit-to-app"),
)
EDIT = (
    Entry("undo", "&Undo", "Ctrl+Z", "mdi6.undo"),
    Entry("redo", "&Redo", "Ctrl+Shift+Z", "mdi6.redo"),
    Entry("", ""),
    Entry("go_to", "Pick &vertex by number…", "Ctrl+G", "mdi6.crosshairs", "Type the number of a vertex"),
    Entry(
        "pick_mirror", "Pick the &mirror point", "M", "mdi6.flip-horizontal", "Add the mirror image of the last pick"
    ),
    Entry("clear", "&Clear picks", "Esc", "mdi6.close-circle-outline"),
    Entry("", ""),
    Entry("play", "&Play θ", "Space", "mdi6.play", "Turn θ from 0° to 180°"),
    Entry("", ""),
    Entry("script", "Copy as &script", "Ctrl+Shift+C", "mdi6.language-python", "The Python lines that compute this"),
    Entry("settings", "Se&ttings…", "Ctrl+,", "mdi6.cog-outline", "Colours, edges, what is kept, and resetting it all"),
)
LOOKS = (
    Entry("fit", "&Fit to view", "F", "mdi6.fit-to-page-outline", "The whole shape, from the same side"),
    Entry("front", "Fr&ont", "1"),
    Entry("back", "&Back", "3"),
    Entry("left", "Its &left side", "4"),
    Entry("right", "Its &right side", "6"),
    Entry("top", "&Top", "7"),
)
TOOLS = (
    Entry("train", "&Train a descriptor…", "Ctrl+T", "mdi6.school-outline", "Learn from shapes, in the background"),
    Entry("jobs", "&Jobs", "Ctrl+J", "mdi6.format-list-checks", "What runs in the background"),
)
HELP = (
    Entry("palette", "&Command palette…", "Ctrl+Shift+P", "mdi6.text-search", "Do anything by typing its name"),
    Entry("shortcuts", "&Mouse and keyboard", "F1; ?", "mdi6.keyboard-outline", "What mouse and keys do, on one sheet"),
    Entry("about", "&About", "", "mdi6.information-outline"),
)
FIELDS = (
    Entry("choose_field", "&Choose a field…", "Ctrl+F", "mdi6.palette-outline", "What is drawn on the shapes"),
    Entry("choose_comparison", "Choose a &second field…", "Ctrl+Shift+F", "mdi6.view-split-vertical", "Side by side"),
    Entry("explore_symmetry", "E&xplore symmetry", "S", "mdi6.compare-horizontal", "A point and its mirror image"),
    Entry("transfer", "&Transfer colours", "T", "mdi6.transfer", "The source's colours on the other shapes"),
)
SWITCHES = (
    Entry("arrows", "&Directions on the skin", "D", "mdi6.arrow-top-right", "Where heat runs, turned by θ"),
    Entry("wireframe", "&Wireframe", "W", "mdi6.grid", "The triangles' edges"),
    Entry("colour_bar", "&Colour bar", "B", "mdi6.gradient-vertical"),
    Entry("reflected_curves", "&Read mirror curves backwards", "I", "mdi6.swap-horizontal", "f at −θ instead of θ"),
    Entry("relative_curves", "Curves ÷ their &mean over θ", "N", "mdi6.chart-bell-curve", "Or as they are"),
)
ARRANGING = (
    Entry("linked", "&Link the cameras", "L", "mdi6.link-variant", "Turn one view, and all turn"),
    Entry("common_range", "One &range of colours", "R", "mdi6.arrow-expand-vertical", "The same for all shapes"),
)
ON_A_SHAPE = (
    *("undo", "redo", "go_to", "pick_mirror", "clear", "play", "script"),
    *("screenshot", "figure", "animation", "curves", "close"),
    *(entry.name for entry in (*LOOKS, *FIELDS, *SWITCHES, *ARRANGING)),
)
"""Actions that change or show what is drawn: none of them works unseen, behind the start page."""
LAYOUT_NAMES = {"grid": "&Grid", "strip": "&One row", "single": "The &source alone"}
CHOICES = {
    "theme": ("&Theme", {"system": "As the &system", "light": "&Light", "dark": "&Dark"}),
    "kernel_scale": ("Colour &scale", {"linear": "&Linear", "log": "Lo&garithmic, two decades"}),
    "up_axis": ("&Up axis", {"auto": "&Automatic", "+y": "&Y", "+z": "&Z"}),
}


class Menus:
    """Builds the menu bar; `on(name, do)` says what an action does."""

    def __init__(self, window: QMainWindow, display: Display) -> None:
        self._window, self._display = window, display
        self.actions: dict[str, QAction] = {}
        self._icons: list[tuple[QAction, str]] = []
        self._on_a_shape = QActionGroup(window)
        self._on_a_shape.setExclusionPolicy(QActionGroup.ExclusionPolicy.None_)
        bar = window.menuBar()
        self.file = self._menu(bar.addMenu("&File"), FILE)
        self.edit = self._menu(bar.addMenu("&Edit"), EDIT)
        self.view = self._view_menu(bar.addMenu("&View"))
        self.tools = self._menu(bar.addMenu("&Tools"), TOOLS)
        self.help = self._menu(bar.addMenu("&Help"), HELP)
        for name in ON_A_SHAPE:
            self._on_a_shape.addAction(self.actions[name])
        display.changed.connect(self._show_display)

    def show_hidden(self, hidden: bool) -> None:
        """Let nothing be done to shapes that are `hidden`; seen again, each action is as enabled as it would be."""
        for group in (self._on_a_shape, self._layouts):
            group.setEnabled(not hidden)

    def on(self, name: str, do: Callable[[], object]) -> None:
        """Let action `name` call `do`."""
        self.actions[name].triggered.connect(lambda _checked=False: do())

    def say(self, name: str, text: str) -> None:
        """Let an action's words tell what it would do now; "" brings back those that it has always."""
        entry = _BY_NAME[name]
        self.actions[name].setText(text or entry.text)
        self.actions[name].setToolTip(_tool_tip(entry, text or entry.text))

    def _menu(self, menu: QMenu, entries: tuple[Entry, ...]) -> QMenu:
        for entry in entries:
            if not entry.name:
                menu.addSeparator()
            elif entry.name == "recent":
                self.recent = menu.addMenu(entry.text)
            else:
                menu.addAction(self._action(entry))
        return menu

    def _view_menu(self, menu: QMenu) -> QMenu:
        self._menu(menu, FIELDS)
        menu.addSeparator()
        for entry in SWITCHES:
            action = self._action(entry)
            action.setCheckable(True)
            action.setChecked(self._display[entry.name])
            action.toggled.connect(lambda on, name=entry.name: self._display.set(name, on))
            menu.addAction(action)
        for name in ("kernel_scale",):
            menu.addMenu(self._choice(name))
        menu.addSeparator()
        self._menu(menu, LOOKS)
        menu.addMenu(self._choice("up_axis"))
        menu.addSeparator()
        self._arrangement_menu(menu)
        menu.addSeparator()
        self.docks = menu.addMenu("&Panels")
        menu.addMenu(self._choice("theme"))
        return menu

    def _arrangement_menu(self, menu: QMenu) -> None:
        """What the session says of several views, unlike the switches, which are a person's taste."""
        layouts = menu.addMenu("&Views of several shapes")
        group = self._layouts = QActionGroup(self._window)
        for value, text in LAYOUT_NAMES.items():
            action = QAction(text, self._window, checkable=True, checked=value == "grid")
            self.actions[f"layout:{value}"] = group.addAction(action)
            layouts.addAction(action)
        for entry in ARRANGING:
            action = self._action(entry)
            action.setCheckable(True)
            menu.addAction(action)
        self.show_arrangement(Arrangement())

    def on_arrangement(self, arrange: Callable[..., object]) -> None:
        """Let the arrangement's actions call `arrange(layout=…, linked=…, common_range=…)`."""
        for value in LAYOUT_NAMES:
            self.actions[f"layout:{value}"].triggered.connect(lambda _on, value=value: arrange(layout=value))
        for entry in ARRANGING:
            self.actions[entry.name].triggered.connect(lambda on, name=entry.name: arrange(**{name: on}))

    def show_arrangement(self, arrangement: Arrangement) -> None:
        """Tick what the session says."""
        self.actions[f"layout:{arrangement.layout}"].setChecked(True)
        for entry in ARRANGING:
            self.actions[entry.name].setChecked(getattr(arrangement, entry.name))

    def _choice(self, name: str) -> QMenu:
        title, options = CHOICES[name]
        menu, group = QMenu(title, self._window), QActionGroup(self._window)
        for value, text in options.items():
            action = QAction(text, self._window, checkable=True, checked=self._display[name] == value)
            action.triggered.connect(lambda _checked, value=value: self._display.set(name, value))
            self.actions[f"{name}:{value}"] = group.addAction(action)
            menu.addAction(action)
        return menu

    def _action(self, entry: Entry) -> QAction:
        action = QAction(entry.text, self._window)
        if entry.key:
            action.setShortcuts(QKeySequence.listFromString(entry.key))
        action.setData(entry.text)
        action.setToolTip(_tool_tip(entry, entry.text))
        if entry.icon:
            self._icons.append((action, entry.icon))
        self.actions[entry.name] = action
        self._window.addAction(action)
        return action

    def _show_display(self, name: str) -> None:
        value = self._display[name]
        if isinstance(value, bool) and name in self.actions:
            self.actions[name].setChecked(value)
        elif f"{name}:{value}" in self.actions:
            self.actions[f"{name}:{value}"].setChecked(True)

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's text colour."""
        for action, name in self._icons:
            action.setIcon(icon(name, theme.text))


_BY_NAME = {
    entry.name: entry for entry in (*FILE, *EDIT, *LOOKS, *TOOLS, *HELP, *FIELDS, *SWITCHES, *ARRANGING) if entry.name
}


def _tool_tip(entry: Entry, text: str) -> str:
    key = f" ({entry.key.replace('; ', ', ')})" if entry.key else ""
    return f"{plain(text)}{key}" + (f"\n{entry.help}" if entry.help else "")
