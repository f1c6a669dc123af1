"""What a newcomer sees first: shapes to open with one click."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QRect, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QPixmap
from PySide6.QtWidgets import (
    QButtonGroup,
    QFrame,
    QHBoxLayout,
    QLabel,
    QListView,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from .icons import icon
from .theme import GRID, Theme

THUMBNAIL = QSize(96, 128)
_SPRITES = Path(__file__).parent.parent / "thumbnails"
_SPRITE_COLUMNS = 10


@dataclass(frozen=True)
class Gallery:
    """One shipped collection: its name in references, its title here, and what its shapes are called."""

    name: str
    title: str
    shapes: tuple[str, ...]


def title_of(reference: str, galleries: tuple[Gallery, ...]) -> str:
    """What the person knows it by: a shipped shape's name, a file's path."""
    name, _, number = reference.partition("/")
    for gallery in galleries:
        if gallery.name == name and number.isdecimal() and int(number) < len(gallery.shapes):
            return _capital(gallery.shapes[int(number)])
    return reference


class StartPage(QWidget):
    """The shipped shapes as pictures, recent files, and a place to drop one.

    chosen : the reference of a shape to open. browse : the person looks for a file. left : back to the open shape.
    """

    chosen = Signal(str)
    browse = Signal()
    left = Signal()

    def __init__(self, galleries: tuple[Gallery, ...], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.galleries = galleries
        self.list = QListWidget()
        self.buttons: list[QPushButton] = []
        self.recent: list[QPushButton] = []
        self.open_button, self.back_button = QPushButton("Open file…"), QPushButton()
        self.back_button.clicked.connect(self.left)
        self._recent_box = QVBoxLayout()
        self.setSizePolicy(
            QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored
        )  # hidden, it must not hold the window wide
        self._lay_out()
        self.show_gallery(0)

    def _lay_out(self) -> None:
        layout = QHBoxLayout(self)
        layout.setContentsMargins(5 * GRID, 4 * GRID, 4 * GRID, 2 * GRID)
        layout.setSpacing(5 * GRID)
        layout.addLayout(self._left_column())
        layout.addLayout(self._right_column(), 1)

    def _left_column(self) -> QVBoxLayout:
        title = QLabel("Anisotropic Diffusion Descriptors")
        title.setWordWrap(True)
        font = title.font()
        font.setPointSizeF(1.7 * font.pointSizeF())
        font.setBold(True)
        title.setFont(font)
        text = QLabel("Open a shape, click a point, and see how heat runs from it in any direction.")
        text.setWordWrap(True)
        text.setProperty("role", "muted")
        self.open_button.setProperty("primary", True)
        self.open_button.clicked.connect(self.browse)
        self._drop = QLabel("or drop a file anywhere\nOFF · OBJ · PLY · STL · VTK · VTP · glTF · GLB · XYZ")
        self._drop.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._drop.setWordWrap(True)
        self._recent_title = QLabel("Recent")
        self._recent_title.setProperty("role", "heading")
        column = QVBoxLayout()
        column.setSpacing(2 * GRID)
        for widget in (self.back_button, title, text, self.open_button, self._drop, self._recent_title):
            widget.setFixedWidth(31 * GRID)
            column.addWidget(widget)
        self._recent_box.setSpacing(0)
        column.addLayout(self._recent_box)
        column.addStretch(1)
        return column

    def _right_column(self) -> QVBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(GRID)
        group = QButtonGroup(self)
        for index, gallery in enumerate(self.galleries):
            button = QPushButton(f"{gallery.title}  {len(gallery.shapes)}")
            button.setCheckable(True)
            button.clicked.connect(lambda _checked, index=index: self.show_gallery(index))
            group.addButton(button)
            self.buttons.append(button)
            row.addWidget(button)
        row.addStretch(1)
        self.list.setViewMode(QListView.ViewMode.IconMode)
        self.list.setResizeMode(QListView.ResizeMode.Adjust)
        self.list.setMovement(QListView.Movement.Static)
        self.list.setIconSize(THUMBNAIL)
        self.list.setGridSize(QSize(16 * GRID, 21 * GRID))
        self.list.setWordWrap(True)
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.list.setUniformItemSizes(True)
        self.list.setFrameShape(QFrame.Shape.NoFrame)
        self.list.viewport().setAutoFillBackground(False)
        self.list.itemClicked.connect(self._choose)
        self.list.itemActivated.connect(self._choose)
        column = QVBoxLayout()
        column.setSpacing(2 * GRID)
        column.addLayout(row)
        column.addWidget(self.list, 1)
        return column

    def _choose(self, item: QListWidgetItem) -> None:
        self.chosen.emit(item.data(Qt.ItemDataRole.UserRole))

    def show_gallery(self, index: int) -> None:
        """Show one collection's shapes."""
        gallery = self.galleries[index]
        self.buttons[index].setChecked(True)
        sprites = QPixmap(str(_SPRITES / f"{gallery.name}.png"))
        self.list.clear()
        for number, name in enumerate(gallery.shapes):
            item = QListWidgetItem(_thumbnail(sprites, number), _capital(name))
            item.setData(Qt.ItemDataRole.UserRole, f"{gallery.name}/{number}")
            item.setToolTip(f"Open {name} ({gallery.name}/{number})")
            item.setTextAlignment(Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop)
            self.list.addItem(item)

    def show_way_back(self, name: str | None) -> None:
        """Offer to go back to the open shape `name`, if there is one."""
        self.back_button.setVisible(name is not None)
        self.back_button.setText(f"Back to {name}".replace("&", "&&"))
        self.back_button.setShortcut(Qt.Key.Key_Escape)
        self.back_button.setToolTip("Leave this page (Esc)")

    def show_recent(self, references: list[str]) -> None:
        """List what was opened lately."""
        for button in self.recent:
            self._recent_box.removeWidget(button)
            button.deleteLater()
        self.recent = [self._recent_button(reference) for reference in references[:6]]
        for button in self.recent:
            self._recent_box.addWidget(button)
        self._recent_title.setVisible(bool(self.recent))

    def _recent_button(self, reference: str) -> QPushButton:
        button = QPushButton()
        button.setProperty("recent", True)
        text = Path(reference).name if reference.startswith("/") else title_of(reference, self.galleries)
        button.setText(button.fontMetrics().elidedText(text, Qt.TextElideMode.ElideMiddle, 29 * GRID))
        button.setToolTip(reference)
        button.setCursor(Qt.CursorShape.PointingHandCursor)
        button.clicked.connect(lambda: self.chosen.emit(reference))
        return button

    def show_theme(self, theme: Theme) -> None:
        """Icons and the drop target in the theme's colours."""
        self.open_button.setIcon(icon("mdi6.folder-open-outline", theme.on_accent))
        self.back_button.setIcon(icon("mdi6.arrow-left", theme.text))
        self._drop.setStyleSheet(
            f"border: 1px dashed {theme.muted}; border-radius: 8px; padding: 16px; color: {theme.muted};"
        )


def _capital(name: str) -> str:
    return name[:1].upper() + name[1:]


def _thumbnail(sprites: QPixmap, number: int) -> QIcon:
    if sprites.isNull():
        return QIcon()
    width, height = sprites.width() // _SPRITE_COLUMNS, sprites.width() // _SPRITE_COLUMNS * 4 // 3
    column, row = number % _SPRITE_COLUMNS, number // _SPRITE_COLUMNS
    picture = sprites.copy(QRect(column * width, row * height, width, height))
    return QIcon(picture)
