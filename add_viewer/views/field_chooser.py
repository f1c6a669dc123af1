"""What is drawn on the shapes, and what beside it in a split view."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QToolButton, QWidget

from ..models.field_catalogue import FieldEntry, catalogue, entry_of
from ..models.fields import FieldChoice
from ..models.insights import Insights
from ..models.session import Session
from .elided_button import ElidedButton
from .field_list import FieldList
from .icons import icon
from .theme import GRID, Theme

_NAMES = ("&Show", "Besid&e")
_HELP = (
    "What is drawn on every shape (Ctrl+F)",
    "A second field, on the same shapes beside the first: two descriptors, or −θ",
)


class FieldChooser(QWidget):
    """Two buttons that open the list of fields. Shows the session's choices; changes them when a person chooses.

    opened : the person wants to choose for that panel.
    """

    opened = Signal(int)

    def __init__(self, session: Session, insights: Insights, window: QWidget) -> None:
        super().__init__()
        self._session, self._insights = session, insights
        self.list = FieldList(window)
        self.buttons = tuple(ElidedButton(words) for words in _HELP)
        self.close_button = QToolButton()
        self._panel = 0
        self._build()
        for panel, button in enumerate(self.buttons):
            button.clicked.connect(lambda _checked=False, panel=panel: self.open(panel))
        self.close_button.clicked.connect(lambda: session.choose_comparison(None))
        self.list.chosen.connect(self._choose)
        for signal in (session.field_changed, session.shapes_changed, insights.descriptors_changed):
            signal.connect(self._show)
        self._show()

    def _build(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(GRID // 2)
        grid.setVerticalSpacing(GRID // 2)
        for row, (name, button, words) in enumerate(zip(_NAMES, self.buttons, _HELP, strict=True)):
            label = QLabel(name)
            label.setBuddy(button)
            label.setFixedWidth(6 * GRID)
            label.setToolTip(words)
            button.setProperty("choice", True)
            button.setAccessibleName(name.replace("&", ""))
            button.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
            grid.addWidget(label, row, 0)
            grid.addWidget(button, row, 1)
        self.close_button.setProperty("quiet", True)
        self.close_button.setToolTip("One field again")
        self.close_button.setAccessibleName("Leave the second field")
        self.close_button.setFixedWidth(3 * GRID)
        grid.addWidget(self.close_button, 1, 2)
        grid.setColumnStretch(1, 1)

    @property
    def entries(self) -> tuple[FieldEntry, ...]:
        """Everything that can be chosen now."""
        return catalogue(self._session.state, self._insights.descriptors)

    def open(self, panel: int) -> None:
        """Offer the list for the first or the second field."""
        self._panel = panel
        self.opened.emit(panel)
        state = self._session.state
        self.list.open(self.entries, state.field if panel == 0 else state.compare, self.buttons[panel])

    def _choose(self, choice: FieldChoice) -> None:
        self.choose(choice, self._panel)

    def choose(self, choice: FieldChoice, panel: int = 0) -> None:
        """Draw `choice`; a saturation that the person has set stays."""
        shown = self._session.state.field if panel == 0 else self._session.state.compare
        if choice.kind == "distance" and shown is not None:
            choice = choice.with_changes(saturation=shown.saturation)
        if panel == 0:
            self._session.choose_field(**vars(choice))
        else:
            self._session.choose_comparison(choice)

    def _show(self) -> None:
        state, entries = self._session.state, self.entries
        for button, choice in zip(self.buttons, (state.field, state.compare), strict=True):
            button.setText("Nothing" if choice is None else entry_of(entries, choice).title)
        self.close_button.setVisible(state.compare is not None)

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colours."""
        self.list.show_theme(theme)
        self.close_button.setIcon(icon("mdi6.close", theme.muted))
        for button in self.buttons:
            button.setIcon(icon("mdi6.chevron-down", theme.muted))
