"""The parts of the running app, wired to each other."""

from __future__ import annotations

import logging
import os
import sys
from pathlib import Path

os.environ.setdefault("QT_API", "pyside6")

from PySide6.QtCore import QSettings, QTimer
from PySide6.QtWidgets import QApplication

from add_core.io import SHIPPED

from .controllers import disk
from .controllers.carrying import CarryingController
from .controllers.curves import CurvesController
from .controllers.directions import DirectionsController
from .controllers.exploration import Exploration
from .controllers.exporting import curves_table, write_atomically
from .controllers.job_folders import default_home
from .controllers.jobs import JobsController
from .controllers.keeping import KeepingController, Outside, Process
from .controllers.kernel import KernelController
from .controllers.opening import OpeningController, Read, read_shape
from .controllers.operators import OperatorStore
from .controllers.rereading import Rereading
from .controllers.running import explain
from .controllers.script_fields import WRITERS
from .controllers.scripting import script_of
from .controllers.training import TrainingController
from .models.display import Display
from .models.insights import Insights
from .models.jobs import Jobs
from .models.results import Results
from .models.session import Session
from .models.session_file import ENDING
from .models.shapes import OpenShape
from .models.training import TrainingRequest
from .tasks.delay import Delay
from .tasks.disposal import dispose
from .tasks.identity import ProcessIdentity
from .tasks.memory import give_back, spare_what_is_here
from .tasks.processes import ProcessRunner
from .tasks.worker import Worker
from .views.animation import Recorder
from .views.animation_export import AnimationExport
from .views.background import BackgroundViews
from .views.exploring import ExploringViews
from .views.figure_export import FigureExport
from .views.main_window import MainWindow
from .views.saving import Saving, save_image
from .views.session_files import Recovery, SessionFiles
from .views.settings import Settings
from .views.settings_dialog import Disk
from .views.start_page import Gallery

KEEPING_PAUSE = 700
"""Milliseconds after a change until the session is kept: a drag writes its file once or twice, not for every step."""

LIBRARIES_PAUSE = 10000
"""Milliseconds after which the libraries of a first picture and its curves have been loaded."""

RESTING_PAUSE = 3000
"""Milliseconds after shapes came or went until the memory that they left is given back."""

CURVE_PAUSE = 180
"""Milliseconds without a change before curves are computed: a kernel that the person waits for comes first."""

PICTURE_DEADLINE = 120_000
"""Milliseconds after which a picture that is not ready is given up."""

LONG_WORK = {"kernel": "Computing heat …", "fields": "Computing the field …", "curves": "Computing curves …"}
"""What the status line says about work of the thread that takes long, by lane."""

_TITLES = {"humans": "People", "poses": "Poses", "dogs": "Dogs", "remeshed": "Remeshed", "clouds": "Point clouds"}


def application() -> QApplication:
    """The one QApplication."""
    existing = QApplication.instance()
    return existing if isinstance(existing, QApplication) else QApplication(["add-viewer"])


class Assembly:
    """Models, controllers, tasks and the window."""

    def __init__(
        self,
        files: list[str],
        screenshot: Path | None = None,
        *,
        app: QApplication | None = None,
        size: tuple[int, int] | None = None,
        theme: str | None = None,
        pick: list[int] | None = None,
        store: QSettings | None = None,
        read: Read | None = None,
        session: Path | None = None,
    ) -> None:
        self.app = application() if app is None else app
        self._files, self._screenshot, self._picks = files, screenshot, pick or []
        self._failures: list[str] = []
        self.session, self.results, self.display = Session(), Results(), Display()
        self.worker, self._curve_delay = Worker(), Delay(CURVE_PAUSE)
        if screenshot is not None and store is None:  # a picture must not depend on what somebody set up earlier
            store = QSettings(os.devnull, QSettings.Format.IniFormat)
        self.window = MainWindow(self.session, self.results, self.display, Settings(store), _galleries())
        self._reread = Rereading(read or read_shape)
        self._control(self._reread)
        self._keep(self._reread, session)
        self._run_jobs(restore=screenshot is None)
        self._explore()
        if theme is not None:
            self.display.set("theme", theme)
        if size is not None:
            self.window.resize(*size)

    def _control(self, read: Read) -> None:
        run, operators = self.worker.submit, OperatorStore()
        self.operators = operators
        self.opening = OpeningController(self.session, self.results, run, read)
        self.opening.opened, self.opening.failed = self._opened, self._failed
        self.carrying = CarryingController(self.session, self.results)
        self.kernel = KernelController(self.session, self.results, self.display, run, operators)
        self.directions = DirectionsController(self.session, self.results, self.display, run, operators)
        self.curves = CurvesController(self.session, self.results, run, self._curve_delay, operators)
        self.window.open_requested.connect(self._open)
        self.worker.progressed.connect(self._show_work)
        self.window.cancel_requested.connect(self.worker.cancel)
        self.saving = Saving(self.window, write_atomically, curves_table, explain)
        self.figures = FigureExport(self.window, self.saving, run)
        self.recorder = Recorder(self.window, lambda: self.worker.is_idle)
        self.animations = AnimationExport(self.window, self.saving, self.recorder, run)
        self.saving.write_script = lambda: script_of(self.session.state, self.results.carried, WRITERS)

    def _show_work(self, lane: str, share: float) -> None:
        """Say how far long work of the thread is, unless something else is being said."""
        if self.results.busy in ("", *LONG_WORK.values()):
            self.results.set_busy(LONG_WORK.get(lane, ""), share if lane else None)

    def _keep(self, read: Read, session: Path | None) -> None:
        self._session_path = session
        identity = ProcessIdentity.of(os.getpid())
        process = Process(identity.pid, identity.began, lambda pid, began: ProcessIdentity(pid, began).is_alive)
        run, later = self.worker.submit, Delay(KEEPING_PAUSE)
        self.keeping = KeepingController(self.session, self.results, run, later, process, read=read)
        self.keeping.opened = self._session_opened
        self.keeping.failed = self._session_failed
        self.session_files = SessionFiles(self.window, self.keeping, explain)
        files = self.session_files
        self.keeping.outside = Outside(files.cameras, files.layout, files.apply)
        self._keep_settings()
        self._resting = Delay(RESTING_PAUSE)
        self.session.shapes_changed.connect(lambda: self._resting(self._give_back))
        self.recovery = Recovery(self.keeping, files.banner)
        if self._screenshot is None:
            self.recovery.offer()

    def _give_back(self) -> None:
        """Let go of what closed shapes left, on the thread that the operators belong to."""
        shapes = self.session.state.shapes

        def work() -> None:
            self.operators.keep_only(shapes)
            self._reread.lighten(shapes)
            give_back()

        self.worker.submit("rest", work, done=lambda _: None, failed=self.results.report)

    def _keep_settings(self) -> None:
        settings = self.window.settings

        def set_limit(gigabytes: float) -> None:
            settings.cache_limit = gigabytes
            disk.set_limit(gigabytes)

        if settings.cache_limit is not None and disk.LIMIT not in os.environ:
            disk.set_limit(settings.cache_limit)
        self.window.aids.disk = Disk(disk.used, disk.limit, set_limit, disk.clear)
        self.display.changed.connect(self._show_autosave)
        self._show_autosave()

    def _show_autosave(self, _name: str = "autosave") -> None:
        self.keeping.autosaves = self._screenshot is None and self.display["autosave"]

    def _open(self, reference: str) -> None:
        if reference.endswith(ENDING):
            self.keeping.open(Path(reference))
        else:
            self.opening.open(reference)

    def _run_jobs(self, *, restore: bool) -> None:
        self.jobs = Jobs(default_home())
        self.job_control = JobsController(self.jobs, ProcessRunner(), self.results.report, dispose=dispose)
        self.training = TrainingController(self.jobs, dispose, self.results.report)
        self.background = BackgroundViews(self.window, self.jobs, self.job_control.log, self.training)
        self.background.training_panel.submitted.connect(self._train)
        self.background.training_panel.deleted.connect(self.training.delete)
        if restore:
            self.job_control.restore()
            self.background.offer_to_go_on()

    def _train(self, request: TrainingRequest) -> None:
        self.window.message.begin()
        id = self.training.start(request)
        if id is not None:
            self.window.message.succeed()
            self.background.training_panel.select(id)

    def _explore(self) -> None:
        insights = Insights()
        self.exploration = Exploration(
            self.session, self.results, insights, self.jobs, self.worker.submit, self.operators
        )
        self.exploration.models = self.training.models
        self.training.models_changed.connect(self.exploration.improve)
        self.exploration.refresh_names()
        self.exploring = ExploringViews(self.window, insights)
        self.exploring.symmetry.find_wanted.connect(self.exploration.symmetry.find)
        self.exploring.symmetry.compare_wanted.connect(self.exploration.symmetry.compare)

    def _session_opened(self, path: Path) -> None:
        self.window.message.succeed()
        self.window.remember(str(path))

    def _opened(self, shape: OpenShape) -> None:
        self.window.message.succeed()
        self.window.show_shapes()
        self.window.remember(shape.reference)
        if self._picks and len(self.session.state.shapes) >= len(set(self._files)):
            self.session.show_shape(self.session.state.shapes[0].key)  # picks are meant on the first
            for vertex in self._picks:
                self.session.pick(vertex, add=True)
            self._picks = []

    def _session_failed(self, reason: str) -> None:
        self._failures.append(reason)
        for reference in self.window.settings.recent:
            if reference.endswith(ENDING):
                self._forget_if_gone(reference)

    def _forget_if_gone(self, reference: str) -> None:
        path = Path(reference)
        if path.is_absolute() and not path.exists():  # the name of a shipped shape is no absolute path
            self.window.forget(reference)

    def _failed(self, reference: str, reason: str) -> None:
        self._forget_if_gone(reference)
        self._failures.append(f"{reference}: {reason}" if reference not in reason else reason)

    # -- running ------------------------------------------------------------------------------------------------------

    def show(self) -> None:
        """Show the window. What libraries made by then, or soon after for its first pictures, is never searched."""
        self.window.show()
        spare_what_is_here()
        QTimer.singleShot(LIBRARIES_PAUSE, spare_what_is_here)

    def run(self) -> int:
        """Show the window until it is closed, or save a picture of it and end."""
        logging.basicConfig(level=logging.WARNING, format="%(name)s: %(message)s")
        self.show()
        if self._session_path is not None:
            self.keeping.open(self._session_path)
        for reference in self._files:
            self._open(reference)
        if self._screenshot is not None:
            self._watch = QTimer(interval=50)
            self._watch.timeout.connect(self._take_screenshot)
            self._watch.start()
            late = "The picture was not ready after two minutes. Is the shape very large?"
            QTimer.singleShot(PICTURE_DEADLINE, lambda: self._leave(2, late))
        status = self.app.exec()
        self.stop()
        return status

    def stop(self) -> None:
        """End the thread and close the window."""
        self.recorder.cancel()
        self.keeping.end()
        self._curve_delay.cancel()
        self._resting.cancel()
        self.worker.stop()
        self.window.close()
        self.job_control.stop()

    def _take_screenshot(self) -> None:
        if self._failures:
            self._leave(2, self._failures[0])
        elif self._settled():
            self._watch.stop()
            QTimer.singleShot(100, self._save_screenshot)  # one more paint

    def _settled(self) -> bool:
        if self.results.busy or len(self.session.state.shapes) < len(set(self._files)):
            return False
        if any(view.canvas.is_moving for view in self.window.scene.views):
            return False
        picks = self.session.state.active_picks
        if not picks:
            return True
        curves, heats = self.results.curves, any(choice.kind == "heat" for choice in self.session.state.choices)
        return (
            (self.results.kernel is not None or not heats)
            and len(curves) == len(picks)
            and all(c.is_complete for c in curves)
            and not self.window.curves.is_due
        )

    def _save_screenshot(self) -> None:
        assert self._screenshot is not None
        image = self.window.grab().toImage()
        try:
            write_atomically(self._screenshot, lambda temporary: save_image(image, temporary))
        except OSError as error:
            self._leave(2, f"{self._screenshot}: {explain(error)}")
        else:
            self._leave(0)

    def _leave(self, status: int, problem: str = "") -> None:
        self._watch.stop()
        if problem:
            sys.stderr.write(f"add-viewer: {' '.join(problem.split())}\n")
        self.app.exit(status)


def _galleries() -> tuple[Gallery, ...]:
    return tuple(Gallery(name, _TITLES[name], collection().names) for name, collection in SHIPPED.items())
