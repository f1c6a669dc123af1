"""The viewer under software rendering: slider event to finished picture, idle CPU, time to the first picture.

Run on a screen: xvfb-run -a -s "-screen 0 1440x900x24" python tests/benchmarks/bench_viewer.py
"""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

STARTED = time.perf_counter()

from PySide6.QtCore import QSettings  # noqa: E402

from add_viewer.assembly import Assembly  # noqa: E402

THIGH = 6868
PATIENCE = 30.0


class Bench:
    """A real window on a shipped person, driven by its controls."""

    def __init__(self) -> None:
        store = QSettings(str(Path(tempfile.mkdtemp()) / "settings.ini"), QSettings.Format.IniFormat)
        self.assembly = Assembly([], store=store, size=(1440, 900))
        self.window, self.results = self.assembly.window, self.assembly.results
        self.paints = self.paints_before_kernel = 0
        self.results.kernel_changed.connect(self._answered)
        self.window.view.canvas.painted.connect(self._painted)
        self.window.show()
        self.assembly.opening.open("humans/0")
        self.wait(lambda: self.assembly.session.state.active is not None)
        self.wait_for_paint(self.paints_before_kernel)

    def _answered(self) -> None:
        self.paints_before_kernel = self.paints

    def _painted(self) -> None:
        self.paints += 1

    def wait(self, condition: Callable[[], bool]) -> None:
        end = time.perf_counter() + PATIENCE
        while not condition():
            self.assembly.app.processEvents()
            time.sleep(0.001)
            if time.perf_counter() > end:
                raise TimeoutError("the window did not get there")

    def wait_for_paint(self, before: int) -> None:
        self.wait(lambda: self.paints > before)

    def latency(self, change: Callable[[int], object], repeats: int = 21) -> tuple[float, float]:
        """Median milliseconds from a change to the picture that shows its kernel: on the clock, and of CPU.

        Where other programs share the machine, the clock says more about them.
        """
        times, work = [], []
        for index in range(repeats):
            kernel = self.results.kernel
            start, used = time.perf_counter(), _cpu()
            change(index)
            self.wait(lambda kernel=kernel: self.results.kernel is not kernel)
            self.wait_for_paint(self.paints_before_kernel)
            times.append(1000 * (time.perf_counter() - start))
            work.append(1000 * (_cpu() - used))
        return statistics.median(times), statistics.median(work)

    def idle_share(self, seconds: float = 3.0) -> float:
        """CPU time of this process per second while nobody does anything."""
        self._run_events(0.5)
        before, start = _cpu(), time.perf_counter()
        self._run_events(seconds)
        return (_cpu() - before) / (time.perf_counter() - start)

    def _run_events(self, seconds: float) -> None:
        from PySide6.QtCore import QTimer

        QTimer.singleShot(int(1000 * seconds), self.assembly.app.quit)
        self.assembly.app.exec()


def _cpu() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    """Print the table."""
    bench = Bench()
    print(f"first picture after start            {1000 * (time.perf_counter() - STARTED):8.0f} ms   (aim 3000)")
    session, panel = bench.assembly.session, bench.window.parameters
    session.pick(THIGH)
    bench.wait(lambda: bool(bench.results.curves) and all(c.is_complete for c in bench.results.curves))
    rows = {
        "θ dial to picture": lambda i: panel.dial.turned.emit(0.05 + 0.04 * i),
        "α slider to picture": lambda i: panel.alpha.slider.moved.emit(20.0 + i),
        "t slider to picture": lambda i: panel.time.slider.moved.emit(0.02 + 0.001 * i),
        "another source to picture": lambda i: session.pick(100 * i),
    }
    for name, change in rows.items():
        clock, work = bench.latency(change)
        print(f"{name:36s} {clock:8.0f} ms   (aim 120)   {work:5.0f} ms of CPU")
    bench.wait(lambda: all(c.is_complete for c in bench.results.curves))
    print(f"idle CPU                             {100 * bench.idle_share():8.1f} %    (aim 3)")
    bench.assembly.stop()
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", "import add_viewer.assembly"], check=True)
    print(f"imports in a new process             {1000 * (time.perf_counter() - start):8.0f} ms")


if __name__ == "__main__":
    main()
