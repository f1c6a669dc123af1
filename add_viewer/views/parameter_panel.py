"""How heat runs: the controls on the left."""

from __future__ import annotations

from math import degrees, pi, radians

from PySide6.QtCore import QElapsedTimer, QSignalBlocker, Qt, QTimer
from PySide6.QtWidgets import QComboBox, QFrame, QHBoxLayout, QLabel, QPushButton, QToolButton, QVBoxLayout, QWidget

from ..models.diffusion import ALPHA_MAX, REACH_MAX, REACH_MIN, Diffusion
from ..models.results import Results
from ..models.scales import BrokenLine, Logarithm
from ..models.session import Session
from .dial import ThetaDial
from .icons import icon
from .number_field import NumberField
from .pick_list import PickList
from .shape_list import ShapeList
from .slider import SliderRow
from .theme import GRID, Theme

DEFAULT = Diffusion()
PLAY_SPEED = radians(30.0)
"""θ per second while it plays."""

ALPHA_HELP = "Degree of anisotropy α: 0 lets heat run alike in all directions, more confines it to one."
THETA_HELP = (
    "Direction θ in which heat runs, counter-clockwise from the direction of maximum curvature. "
    "Ctrl snaps to 15°, Space plays."
)
TIME_HELP = (
    "Diffusion time t: how long heat runs. The slider keeps t·λ₁ when α changes, since a larger α slows heat: "
    "λ₁ is Weyl's estimate of the first eigenvalue."
)
MODEL_HELP = "Conductivity D: from the curvatures at each point, eq. (9), or the same everywhere, eq. (10)."


class ParameterPanel(QWidget):
    """Shows the session's diffusion and picks; writes them only when a person acts."""

    def __init__(self, session: Session, results: Results, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._results = session, results
        self.shapes, self.model = ShapeList(session), QComboBox()
        self.alpha, self.time = _alpha_row(), _time_row()
        self.dial = ThetaDial()
        self.theta = NumberField(show_as=lambda value: f"{value:.4g}", step=lambda value, step: value + step)
        self.play = QPushButton("Play")
        self.picks = PickList(session)
        self.model_row = _named("Conductivity", self.model, MODEL_HELP)
        self.theta_row = self._theta_row()
        self.scale_note = QLabel()
        self.fold, self._diffusion = QToolButton(), QWidget()
        self._player = Player(session, self)
        self._build()
        self._connect()
        self._show_scale()
        self._show_diffusion()

    # -- building -----------------------------------------------------------------------------------------------------

    def _build(self) -> None:
        self.model.addItem("From curvature, eq. (9)", "curvature")
        self.model.addItem("Constant, eq. (10)", "constant")
        self.model.setToolTip(MODEL_HELP)
        self.scale_note.setWordWrap(True)
        self.scale_note.setProperty("role", "muted")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(2 * GRID, int(1.5 * GRID), 2 * GRID, GRID)
        layout.setSpacing(int(1.5 * GRID))
        self._build_diffusion()
        for row in (self.shapes, self.fold, self._diffusion, _line(), self.picks):
            layout.addWidget(row)
        layout.addStretch(1)
        layout.addWidget(self.scale_note)

    def _build_diffusion(self) -> None:
        self.fold.setText("Diffusion of the curves")
        self.fold.setCheckable(True)
        self.fold.setToolTip("α, θ and t do not matter for what is drawn, but for the curves at the picked points")
        self.fold.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.fold.setProperty("quiet", True)
        self.fold.setArrowType(Qt.ArrowType.RightArrow)
        self.fold.hide()
        self.fold.toggled.connect(self._unfold)
        column = QVBoxLayout(self._diffusion)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(int(1.5 * GRID))
        for row in (self.model_row, self.alpha, self.theta_row, self.time):
            column.addWidget(row)

    def _unfold(self, on: bool) -> None:
        self.fold.setArrowType(Qt.ArrowType.DownArrow if on else Qt.ArrowType.RightArrow)
        self._diffusion.setVisible(on)

    def add_section(self, section: QWidget) -> None:
        """Put a section between the shapes and the controls of the diffusion."""
        column = self.layout()
        assert isinstance(column, QVBoxLayout)
        column.insertWidget(1, section)

    def show_relevance(self, controls: frozenset[str]) -> None:
        """Let only those controls be used that matter for what is drawn: "model", "alpha", "theta", "time".

        Where none does, they serve the curves alone, and fold away.
        """
        rows = {"model": self.model_row, "alpha": self.alpha, "theta": self.theta_row, "time": self.time}
        matters = controls & set(rows) or frozenset(rows)
        for name, row in rows.items():
            row.setEnabled(name in matters)
        matter = bool(controls & set(rows))
        self.fold.setVisible(not matter)
        self._diffusion.setVisible(matter or self.fold.isChecked())

    def _theta_row(self) -> QWidget:
        label = QLabel("Direction &θ")
        label.setBuddy(self.theta)
        unit = QLabel("°")
        unit.setProperty("role", "muted")
        unit.setFixedWidth(3 * GRID)
        self.theta.setFixedWidth(11 * GRID)
        self.theta.setAccessibleName("Direction θ")
        self.play.setCheckable(True)
        self.play.setToolTip("Turn θ from 0° to 180° (Space)")
        for widget in (label, self.theta, self.dial):
            widget.setToolTip(THETA_HELP)
        top = QHBoxLayout()
        top.setSpacing(GRID // 2)
        top.addWidget(label, 1)
        for control in (self.play, self.theta, unit):
            top.addWidget(control)
        row = QWidget()
        column = QVBoxLayout(row)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(top)
        column.addWidget(self.dial)
        return row

    def _connect(self) -> None:
        session = self._session
        self.model.activated.connect(lambda: session.diffuse(conductivity=self.model.currentData()))
        self.alpha.changed.connect(lambda value: session.diffuse(alpha=value))
        self.alpha.reset.connect(lambda: session.diffuse(alpha=DEFAULT.alpha))
        self.dial.turned.connect(lambda theta: session.diffuse(theta=theta))
        self.dial.reset.connect(lambda: session.diffuse(theta=DEFAULT.theta))
        self.theta.entered.connect(lambda value: session.diffuse(theta=radians(value)))
        self.time.slider.moved.connect(lambda reach: session.diffuse(reach=reach))
        self.time.field.entered.connect(self._time_typed)
        self.time.reset.connect(lambda: session.diffuse(reach=DEFAULT.reach))
        for ended in (self.alpha.finished, self.time.finished, self.dial.released, self.theta.entered):
            ended.connect(session.end_gesture)
        self.play.toggled.connect(self._player.run)
        session.active_changed.connect(self._show_scale)
        session.diffusion_changed.connect(self._show_diffusion)
        self._results.scale_changed.connect(self._show_diffusion)

    def _time_typed(self, time: float) -> None:
        if self._results.weyl_eigenvalue is not None and time > 0:
            self._session.diffuse(reach=time * self._results.weyl_eigenvalue)
        self._show_diffusion()

    # -- models to view -----------------------------------------------------------------------------------------------

    def _show_scale(self) -> None:
        state = self._session.state
        self.setEnabled(state.active is not None)
        note = "" if state.active is None else state.active.scale_sentence + ". α is in ⌀, t in ⌀²."
        self.scale_note.setText(note)

    def _show_diffusion(self) -> None:
        diffusion, scale = self._session.state.diffusion, self._results.weyl_eigenvalue
        with QSignalBlocker(self.model):
            self.model.setCurrentIndex(self.model.findData(diffusion.conductivity))
        self.alpha.show_value(diffusion.alpha)
        self.alpha.unit.setText("⌀" if diffusion.conductivity == "curvature" else "")
        self.dial.show_theta(diffusion.theta)
        self.theta.show_value(degrees(diffusion.theta))
        self.time.show_value(None if scale is None else diffusion.reach / scale, slider_value=diffusion.reach)

    def show_theme(self, theme: Theme) -> None:
        """Icons in the theme's colour."""
        self.play.setIcon(icon("mdi6.play", theme.text))
        self.picks.show_theme(theme)


class Player(QTimer):
    """Turns θ steadily, and stops where it is told to."""

    def __init__(self, session: Session, parent: QWidget) -> None:
        super().__init__(parent, interval=40)
        self._session, self._clock = session, QElapsedTimer()
        self.timeout.connect(self._turn)

    def run(self, on: bool) -> None:
        """Start or stop."""
        if on:
            self._clock.start()
            self.start()
        else:
            self.stop()
            self._session.end_gesture()

    def _turn(self) -> None:
        step = PLAY_SPEED * min(self._clock.restart(), 200) / 1000.0
        self._session.diffuse(theta=(self._session.state.diffusion.theta + step) % pi)


def _alpha_row() -> SliderRow:
    return SliderRow(
        "Anisotropy &α",
        "⌀",
        ALPHA_HELP,
        scale=BrokenLine(10.0, ALPHA_MAX),
        ticks=[(0, "0"), (5, "5"), (10, "10"), (100, "100"), (200, "200")],
        show_as=lambda value: f"{value:.4g}",
        step=lambda value, step: value + step,
    )


def _time_row() -> SliderRow:
    ticks = [(REACH_MIN, "local"), ((REACH_MIN * REACH_MAX) ** 0.5, ""), (REACH_MAX, "global")]
    return SliderRow(
        "Time &t",
        "⌀²",
        TIME_HELP,
        scale=Logarithm(REACH_MIN, REACH_MAX),
        ticks=ticks,
        show_as=lambda value: f"{value:.3g}",
        step=lambda value, step: value * 1.1**step,
    )


def _named(name: str, widget: QWidget, help_text: str = "") -> QWidget:
    label = QLabel(name)
    label.setBuddy(widget)
    label.setToolTip(help_text)
    row = QWidget()
    layout = QHBoxLayout(row)
    layout.setContentsMargins(0, 0, 0, 0)
    label.setFixedWidth(11 * GRID)
    layout.addWidget(label)
    layout.addWidget(widget, 1)
    return row


def _line() -> QFrame:
    line = QFrame()
    line.setFrameShape(QFrame.Shape.HLine)
    line.setFixedHeight(1)
    line.setForegroundRole(line.backgroundRole())
    line.setStyleSheet("background: palette(mid); border: none;")
    line.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
    return line
