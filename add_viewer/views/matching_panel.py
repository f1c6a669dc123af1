"""How points and colours go from the source to the targets, and how well that works."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QCheckBox, QComboBox, QGridLayout, QLabel, QVBoxLayout, QWidget

from ..models.descriptor_names import descriptor_name
from ..models.insights import Insights, MatchQuality
from ..models.matching import Method
from ..models.session import Session
from .theme import GRID

METHODS: dict[Method, tuple[str, str]] = {
    "true": ("True, where known", "Shapes of one mesh: equal vertex numbers are the same place."),
    "nearest": (
        "Nearest descriptor",
        "Points go where their descriptor is most alike; refined: as a functional map.",
    ),
    "functional-map": ("Functional map", "A map between low frequencies that fits wave signatures; refined: by ICP."),
    "zoomout": ("ZoomOut", "Nearest descriptors; refined: a functional map that grows frequency by frequency."),
}
REFINED_HELP = "The smooth correspondence instead of the raw one, point by point."


class MatchingPanel(QWidget):
    """Method, descriptor, and the switch from raw to refined; below, the error of every target."""

    def __init__(self, session: Session, insights: Insights) -> None:
        super().__init__()
        self._session, self._insights = session, insights
        self.method, self.descriptor = QComboBox(), QComboBox()
        self.descriptor_label = QLabel("&By")
        self.refined = QCheckBox("&Refined")
        self.errors = QLabel()
        self._lay_out()
        self.method.activated.connect(self._choose_method)
        self.descriptor.activated.connect(lambda: session.match(descriptor=self.descriptor.currentData()))
        self.refined.toggled.connect(lambda on: session.match(refined=on))
        for signal in (session.matching_changed, session.shapes_changed, session.active_changed):
            signal.connect(self._show)
        for signal in (insights.qualities_changed, insights.descriptors_changed):
            signal.connect(self._show)
        self._show()

    def _lay_out(self) -> None:
        for method, (words, help_text) in METHODS.items():
            self.method.addItem(words, method)
            self.method.setItemData(self.method.count() - 1, help_text, 3)  # tool tip
        heading, label = QLabel("Matching"), QLabel("M&ethod")
        heading.setProperty("role", "heading")
        label.setBuddy(self.method)
        self.descriptor_label.setBuddy(self.descriptor)
        self.refined.setToolTip(REFINED_HELP)
        self.errors.setWordWrap(True)
        self.errors.setProperty("role", "muted")
        grid = QGridLayout()
        grid.setHorizontalSpacing(GRID // 2)
        grid.setVerticalSpacing(GRID // 2)
        for row, (name, widget) in enumerate(((label, self.method), (self.descriptor_label, self.descriptor))):
            name.setFixedWidth(6 * GRID)
            grid.addWidget(name, row, 0)
            grid.addWidget(widget, row, 1)
        grid.addWidget(self.refined, 2, 1)
        grid.setColumnStretch(1, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GRID)
        column.addWidget(heading)
        column.addLayout(grid)
        column.addWidget(self.errors)

    def _choose_method(self) -> None:
        method = self.method.currentData()
        self._session.match(method=method, refined=method == "zoomout" or self._session.state.matching.refined)

    def _show(self) -> None:
        matching = self._session.state.matching
        with QSignalBlocker(self.method), QSignalBlocker(self.descriptor), QSignalBlocker(self.refined):
            self.method.setCurrentIndex(self.method.findData(matching.method))
            self.method.setToolTip(METHODS[matching.method][1])
            self._show_descriptors(matching.descriptor)
            self.refined.setChecked(matching.refined)
        chooses = matching.method in ("nearest", "zoomout")
        for widget in (self.descriptor_label, self.descriptor):
            widget.setVisible(chooses)
        self.refined.setVisible(matching.method != "true")
        lines = [self._line(quality) for quality in self._insights.qualities]
        self.errors.setText("\n".join(lines) or self._empty())
        self.errors.setVisible(bool(self.errors.text()))

    def _show_descriptors(self, current: str) -> None:
        names = self._insights.descriptors or (current,)
        if [self.descriptor.itemData(row) for row in range(self.descriptor.count())] != list(names):
            self.descriptor.clear()
            for name in names:
                known = descriptor_name(name)
                self.descriptor.addItem(known.title, name)
                self.descriptor.setItemData(self.descriptor.count() - 1, known.help, 3)
        self.descriptor.setCurrentIndex(self.descriptor.findData(current))

    def _line(self, quality: MatchQuality) -> str:
        state = self._session.state
        shape = state.shape(quality.target)
        name = "" if shape is None else shape.name
        curve = quality.curves.get((state.matching.refined, False))
        if quality.message:
            return quality.message
        if curve is None:
            return f"{name}: matched; the truth is not known"
        return f"{name}: off by {curve.mean:.3f} ⌀ on average, {100 * curve.exact:.0f} % exact"

    def _empty(self) -> str:
        alone = len(self._session.state.shapes) < 2
        return "Open another shape: this one's colours will land on it." if alone else ""
