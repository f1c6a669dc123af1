"""A button whose words end in an ellipsis where there is no room for all of them."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import QPushButton, QSizePolicy, QStyle, QStyleOptionButton, QStylePainter

_BESIDE = 4
"""Pixels between the icon and the words: what styles leave."""


class ElidedButton(QPushButton):
    """Takes whatever width is left and never asks for more.

    help : its tooltip, below the whole words while they are cut.
    """

    def __init__(self, help: str = "") -> None:
        super().__init__()
        self.help = help
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    def minimumSizeHint(self) -> QSize:
        return QSize(0, super().minimumSizeHint().height())

    @property
    def shown_text(self) -> str:
        """The words as they fit."""
        return self._shown(self._option())

    def _option(self) -> QStyleOptionButton:
        option = QStyleOptionButton()
        self.initStyleOption(option)
        return option

    def _shown(self, option: QStyleOptionButton) -> str:
        room = self.style().subElementRect(QStyle.SubElement.SE_PushButtonContents, option, self).width()
        room -= 0 if self.icon().isNull() else option.iconSize.width() + _BESIDE
        return self.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, room)

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter, option = QStylePainter(self), self._option()
        option.text = self._shown(option)
        whole = [] if option.text == self.text() else [self.text()]
        self.setToolTip("\n".join((*whole, self.help)))
        painter.drawControl(QStyle.ControlElement.CE_PushButton, option)
        painter.end()
