"""What to train: every choice with a sentence of help."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QFileDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLayout,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ..models.training import (
    ARCHITECTURES,
    CLASSIFICATION,
    DATA,
    EFFORTS,
    LOSSES,
    Option,
    TrainingRequest,
    problem_of_data,
)
from .number_field import NumberField
from .theme import GRID

_COLUMN, _HELP_COLUMN = 24 * GRID, 40 * GRID
TWIN_HELP = "The same layers without any direction: what directions are worth is the difference."
BUDGET_HELP = (
    "Mini-batches in all, or time on this machine once the inputs are computed. The learning rate falls over it."
)
SEED_HELP = "The same seed gives the same weights again."


class TrainingForm(QDialog):
    """Asks for a `TrainingRequest`; `submitted` carries it."""

    submitted = Signal(object)

    def __init__(self, request: TrainingRequest, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("New training")
        self.request = request
        self._budgets: dict[str, float] = {"minutes": 10.0}
        self.data, self.architecture, self.effort = QComboBox(), QComboBox(), QComboBox()
        self.loss, self.unit = QComboBox(), QComboBox()
        self.folder, self.browse = QLineEdit(), QPushButton("Browse…")
        self.isotropic = QCheckBox("Isotropic twin")
        self.start_button, self.cancel_button = QPushButton("Start training"), QPushButton("Cancel")
        numbers = ("shapes", "angles", "eigenpairs", "budget", "seed")
        self.numbers = {name: NumberField(show_as=_count, step=lambda value, step: value + step) for name in numbers}
        self._help: dict[str, QLabel] = {}
        self._build()
        self._connect()
        self._show_request()

    # -- building -----------------------------------------------------------------------------------------------------

    def _build(self) -> None:
        for box, options in ((self.data, DATA), (self.architecture, ARCHITECTURES), (self.loss, LOSSES)):
            for option in options:
                box.addItem(option.title, option)
        for effort in EFFORTS:
            self.effort.addItem(effort.title, effort)
        self.effort.setPlaceholderText("Numbers of your own")
        self.unit.addItems(["steps", "minutes"])
        buttons = QHBoxLayout()
        buttons.setSpacing(GRID)
        buttons.addStretch(1)
        self.start_button.setProperty("primary", True)
        for button, do in ((self.cancel_button, self.reject), (self.start_button, self._submit)):
            button.clicked.connect(do)
            buttons.addWidget(button)
        for button in (self.browse, self.cancel_button, self.start_button):
            button.setAutoDefault(False)  # Enter in a field enters what was typed
        layout = QVBoxLayout(self)
        layout.setContentsMargins(3 * GRID, 2 * GRID, 3 * GRID, 2 * GRID)
        layout.setSpacing(2 * GRID)
        layout.setSizeConstraint(QLayout.SizeConstraint.SetFixedSize)  # follows the rows that come and go
        layout.addLayout(self._rows())
        layout.addLayout(buttons)

    def _rows(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(2 * GRID)
        grid.setVerticalSpacing(GRID)
        rows: tuple[tuple[str, str, QWidget], ...] = (
            ("data", "&Data", self.data),
            ("folder", "&Folder", self._row(self.folder, self.browse)),
            ("architecture", "&Architecture", self.architecture),
            ("isotropic", "", self.isotropic),
            ("effort", "&Effort", self.effort),
            ("amount", "", self._amounts()),
            ("budget", "&Budget", self._row(self.numbers["budget"], self.unit)),
            ("loss", "&Loss", self.loss),
            ("seed", "&Seed", self.numbers["seed"]),
        )
        for number, (name, title, control) in enumerate(rows):
            label, help_text = QLabel(title), QLabel()
            label.setBuddy(_first_field(control))
            help_text.setProperty("role", "muted")
            help_text.setWordWrap(True)
            help_text.setFixedWidth(_HELP_COLUMN)
            control.setFixedWidth(_COLUMN)
            self._help[name] = help_text
            for column, widget in enumerate((label, control, help_text)):
                grid.addWidget(widget, number, column, Qt.AlignmentFlag.AlignVCenter)
            if name == "folder":
                self._folder_row = (label, control, help_text)
        return grid

    def _amounts(self) -> QWidget:
        widget = QWidget()
        grid = QGridLayout(widget)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(GRID // 2)
        titles = {"shapes": "Shapes", "angles": "Angles L", "eigenpairs": "Eigenpairs K"}
        for column, (name, title) in enumerate(titles.items()):
            label = QLabel(title)
            label.setProperty("role", "muted")
            label.setBuddy(self.numbers[name])
            grid.addWidget(label, 0, column)
            grid.addWidget(self.numbers[name], 1, column)
            self.numbers[name].setAccessibleName(title)
        self.numbers["shapes"].setPlaceholderText("all")
        return widget

    @staticmethod
    def _row(*widgets: QWidget) -> QWidget:
        holder = QWidget()
        row = QHBoxLayout(holder)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(GRID // 2)
        for widget in widgets:
            row.addWidget(widget)
        return holder

    def _connect(self) -> None:
        self.data.activated.connect(lambda: self._change(data=self.data.currentData().name))
        self.folder.editingFinished.connect(self._type_folder)
        self.browse.clicked.connect(self._ask_folder)
        self.architecture.activated.connect(lambda: self._change(architecture=self.architecture.currentData().name))
        self.isotropic.toggled.connect(lambda on: self._change(isotropic=on))
        self.effort.activated.connect(self._choose_effort)
        self.loss.activated.connect(lambda: self._change(loss=self.loss.currentData().name))
        self.unit.activated.connect(self._choose_unit)
        for name, (least, most) in LIMITS.items():
            if name != "budget":
                entered = self.numbers[name].entered
                entered.connect(lambda value, name=name, a=least, b=most: self._change(**{name: _within(value, a, b)}))
        self.numbers["budget"].entered.connect(self._type_budget)

    # -- what a person does -------------------------------------------------------------------------------------------

    def _change(self, **changes: object) -> None:
        self.request = replace(self.request, **changes)  # type: ignore[arg-type]
        self._show_request()

    def _choose_effort(self) -> None:
        self.request = self.request.with_effort(self.effort.currentData())
        self._budgets.pop("steps", None)
        self._show_request()

    def _choose_unit(self) -> None:
        request, is_steps = self.request, self.unit.currentText() == "steps"
        if request.steps is not None:
            self._budgets["steps"] = request.steps
        if request.minutes is not None:
            self._budgets["minutes"] = request.minutes
        steps = round(self._budgets.get("steps", (request.effort or EFFORTS[0]).steps))
        self._change(steps=steps if is_steps else None, minutes=None if is_steps else self._budgets["minutes"])

    def _type_budget(self, value: float) -> None:
        least, most = LIMITS["budget"]
        if self.request.steps is None:
            self._change(minutes=min(max(value, 0.1), float(most)))
        else:
            self._change(steps=_within(value, least, most))

    def _type_folder(self) -> None:
        typed = self.folder.text().strip()
        self._change(data=str(Path(typed).expanduser()) if typed else "")

    def _ask_folder(self) -> None:
        start = self.folder.text() or str(Path.home())
        chosen = QFileDialog.getExistingDirectory(self, "A folder of shapes to train on", start)
        if chosen:
            self._change(data=chosen)

    def _submit(self) -> None:
        self.setFocus()  # what is being typed is entered
        if not self.start_button.isEnabled():
            return
        self.accept()
        self.submitted.emit(self.request)

    # -- showing ------------------------------------------------------------------------------------------------------

    def _show_request(self) -> None:
        request = self.request
        shipped = next((number for number, option in enumerate(DATA) if option.name == request.data), len(DATA) - 1)
        boxes = (self.data, self.architecture, self.effort, self.loss, self.unit, self.isotropic, self.folder)
        blocked = [QSignalBlocker(box) for box in boxes]
        self.data.setCurrentIndex(shipped)
        self.folder.setText(request.data if shipped == len(DATA) - 1 else "")
        self.folder.setToolTip(self.folder.text())
        self.architecture.setCurrentText(request.architecture)
        self.isotropic.setChecked(request.isotropic)
        self.effort.setCurrentIndex(-1 if request.effort is None else EFFORTS.index(request.effort))
        self.unit.setCurrentText("steps" if request.minutes is None else "minutes")
        self._show_losses()
        del blocked
        for name in ("shapes", "angles", "eigenpairs", "seed"):
            self.numbers[name].show_value(getattr(request, name))
        self.numbers["budget"].show_value(request.steps if request.minutes is None else request.minutes)
        for widget in self._folder_row:
            widget.setVisible(shipped == len(DATA) - 1)
        self._show_help(DATA[shipped])
        problem = problem_of_data(request.data)
        self.start_button.setEnabled(not problem)
        self._show_problem(problem if request.data else "")

    def _show_problem(self, problem: str) -> None:
        """Say in the place of the folder's help why it cannot be trained on."""
        label = self._help["folder"]
        label.setProperty("role", "" if problem else "muted")
        label.style().polish(label)
        if problem:
            label.setText(problem)
            label.setFixedHeight(label.heightForWidth(_HELP_COLUMN))

    def _show_losses(self) -> None:
        options = [CLASSIFICATION] if self.request.is_classifier else list(LOSSES)
        if [self.loss.itemData(number) for number in range(self.loss.count())] != options:
            self.loss.clear()
            for option in options:
                self.loss.addItem(option.title, option)
        names = [option.name for option in options]
        self.loss.setCurrentIndex(names.index(self.request.loss) if self.request.loss in names else 0)

    def _show_help(self, data: Option) -> None:
        effort = self.request.effort
        texts = {
            "data": data.help,
            "folder": "At least four shapes with known correspondence: equal faces, or .vts or .map files beside them.",
            "architecture": self.architecture.currentData().help,
            "isotropic": TWIN_HELP,
            "effort": "Choose one to have its numbers again." if effort is None else effort.help,
            "amount": "More of each makes a better descriptor, and takes longer to prepare.",
            "budget": BUDGET_HELP,
            "loss": self.loss.currentData().help,
            "seed": SEED_HELP,
        }
        for name, text in texts.items():
            label = self._help[name]
            label.setText(text)
            label.setFixedHeight(label.heightForWidth(_HELP_COLUMN))


LIMITS = {
    "shapes": (2, 10_000),
    "angles": (1, 64),
    "eigenpairs": (20, 1000),
    "budget": (1, 10_000_000),
    "seed": (0, 2**31 - 1),
}
"""Least and most of what can be typed."""


def _first_field(control: QWidget) -> QWidget:
    """What takes the keyboard in a row of widgets."""
    fields = [each for each in control.findChildren(QWidget) if each.focusPolicy() & Qt.FocusPolicy.TabFocus]
    return control if control.focusPolicy() & Qt.FocusPolicy.TabFocus or not fields else fields[0]


def _within(value: float, least: int, most: int) -> int:
    return min(max(round(value), least), most)


def _count(value: float) -> str:
    return f"{value:g}" if value < 100 else f"{value:.0f}"
