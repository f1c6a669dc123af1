"""Messages above the view: they wait for the person, never block them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QWidget

from ..models.results import Notice
from .icons import icon
from .theme import GRID, Theme

MOST, LENGTH = 5, 160
"""How many notices are listed, and how long each may be in a list."""


class MessageBar(QFrame):
    """What went wrong, until it is closed or something that the person began later has succeeded.

    notices : the oldest first. Several that one action brought, such as files dropped together, are listed.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("message")
        self.notices: tuple[Notice, ...] = ()
        self._earlier: tuple[Notice, ...] = ()
        self._icon, self.text, self.close_button = QLabel(), QLabel(), QToolButton()
        self.text.setWordWrap(True)
        self.text.setTextFormat(Qt.TextFormat.PlainText)
        self.text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.text.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.close_button.setToolTip("Close this message")
        self.close_button.setAccessibleName("Close this message")
        self.close_button.setProperty("quiet", True)
        self.close_button.clicked.connect(self.clear)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(2 * GRID, GRID, GRID, GRID)
        layout.setSpacing(GRID)
        layout.addWidget(self._icon, 0, Qt.AlignmentFlag.AlignTop)
        layout.addWidget(self.text, stretch=1)
        layout.addWidget(self.close_button, 0, Qt.AlignmentFlag.AlignTop)
        self.hide()

    def show_notice(self, notice: Notice) -> None:
        """Show the notice below those that are there."""
        self._show((*(each for each in self.notices if each != notice), notice))

    def begin(self) -> None:
        """The person does something: if it succeeds, what is here now is out of date."""
        self._earlier = self.notices

    def succeed(self) -> None:
        """What was begun has succeeded: what was here before goes; what it brought itself stays."""
        self._show(tuple(each for each in self.notices if not any(each is earlier for earlier in self._earlier)))

    def clear(self) -> None:
        """Forget every notice."""
        self._show(())

    def _show(self, notices: tuple[Notice, ...]) -> None:
        self.notices = notices
        texts = [notice.text for notice in notices]
        self.text.setText(texts[0] if len(texts) == 1 else "\n".join(_listed(texts)))
        self.text.setToolTip("\n\n".join(texts) if len(texts) > 1 else "")
        self.setVisible(bool(texts))

    def show_theme(self, theme: Theme) -> None:
        """The bar in the theme's warning colour."""
        self._icon.setPixmap(icon("mdi6.alert-circle-outline", theme.danger).pixmap(18, 18))
        self.close_button.setIcon(icon("mdi6.close", theme.muted))
        self.setStyleSheet(
            f"#message {{ background: {theme.panel}; border: none; border-left: 4px solid {theme.danger};"
            f" border-bottom: 1px solid {theme.line}; }}"
        )


def _listed(texts: list[str]) -> list[str]:
    """One line for each, the newest `MOST`; the tool tip has them in full."""
    more = len(texts) - MOST
    head = [f"{more} earlier {'message' if more == 1 else 'messages'}; point here to read all"] if more > 0 else []
    return head + [f"• {_cut(text)}" for text in texts[-MOST:]]


def _cut(text: str) -> str:
    """At most `LENGTH` letters, ending with a whole word if that is not much shorter."""
    if len(text) <= LENGTH:
        return text
    head = text[: LENGTH - 2]
    return f"{head.rsplit(' ', 1)[0] if ' ' in head[LENGTH // 2 :] else head} …"
