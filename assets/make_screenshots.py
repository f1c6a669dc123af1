"""Take the README's pictures of the real window.

Run on a screen: xvfb-run -a -s "-screen 0 1440x900x24" python assets/make_screenshots.py
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from math import radians
from pathlib import Path

from PIL import Image
from PySide6.QtCore import QSettings
from PySide6.QtGui import QImage

from add_viewer.assembly import Assembly

FOLDER = Path(__file__).parent / "screenshots"
THIGH, SHOULDER, BACK = 6868, 5056, 1000
PATIENCE = 120.0


class Photographer:
    """Sets the window up as a person would, waits until it has settled, and saves what it shows."""

    def __init__(self, *, width: int = 1440, height: int = 900) -> None:
        store = QSettings(str(Path(tempfile.mkdtemp()) / "settings.ini"), QSettings.Format.IniFormat)
        self.assembly = Assembly([], store=store, size=(width, height), theme="light")
        self.window, self.session = self.assembly.window, self.assembly.session
        self.window.show()

    def wait(self, condition: Callable[[], bool]) -> None:
        end = time.perf_counter() + PATIENCE
        while not condition():
            self.assembly.app.processEvents()
            time.sleep(0.001)
            if time.perf_counter() > end:
                raise TimeoutError("the window did not settle")

    def open(self, reference: str) -> None:
        self.assembly.opening.open(reference)
        self.wait(lambda: self.session.state.active_key == reference)
        self.rest()

    def rest(self) -> None:
        """Until the kernel, the curves and the pictures are there."""
        results, state = self.assembly.results, self.session.state
        if state.active_picks:
            self.wait(lambda: results.kernel is not None and results.kernel.diffusion == state.diffusion)
            self.wait(lambda: [curves.pick for curves in results.curves] == list(state.active_picks))
            self.wait(lambda: all(curves.is_complete for curves in results.curves))
        end = time.perf_counter() + 0.5
        self.wait(lambda: time.perf_counter() > end)

    def save_window(self, name: str) -> None:
        self.rest()
        _pillow(self.window.grab().toImage()).convert("RGB").save(FOLDER / f"{name}.png", optimize=True)

    def picture(self, theta: float) -> QImage:
        self.session.diffuse(theta=radians(theta))
        self.rest()
        return self.window.view.picture(2, labels=False, transparent=True)


def main() -> None:
    """Write every picture."""
    FOLDER.mkdir(exist_ok=True)
    photographer = Photographer()
    photographer.save_window("start")
    photographer.open("humans/0")
    photographer.session.pick(THIGH)
    photographer.session.diffuse(theta=radians(60))
    photographer.save_window("window")
    _angles(photographer)
    photographer.session.pick(THIGH)
    photographer.session.pick_mirror(THIGH)
    photographer.session.diffuse(theta=radians(45))
    photographer.save_window("mirror")
    photographer.assembly.display.set("arrows", True)
    photographer.assembly.display.set("theme", "dark")
    photographer.wait(lambda: photographer.assembly.results.directions)
    photographer.save_window("dark")
    photographer.assembly.display.set("arrows", False)
    photographer.open("dogs/3")
    photographer.session.pick(BACK)
    photographer.save_window("dog")
    photographer.assembly.stop()


def _angles(photographer: Photographer) -> None:
    """One person, four directions, side by side."""
    images = [_pillow(photographer.picture(theta)) for theta in (0, 45, 90, 135)]
    width, height = images[0].size
    trim = (round(0.34 * width), 0, round(0.66 * width), height)
    parts = [image.crop(trim) for image in images]
    strip = Image.new("RGBA", (sum(part.width for part in parts), height), (250, 250, 248, 255))
    for index, part in enumerate(parts):
        strip.alpha_composite(part, (index * part.width, 0))
    strip = strip.convert("RGB").resize((strip.width // 2, strip.height // 2), Image.Resampling.LANCZOS)
    strip.save(FOLDER / "angles.png", optimize=True)


def _pillow(image: QImage) -> Image.Image:
    image = image.convertToFormat(QImage.Format.Format_RGBA8888)
    size = (image.width(), image.height())
    return Image.frombytes("RGBA", size, bytes(image.constBits()), "raw", "RGBA", image.bytesPerLine())


if __name__ == "__main__":
    main()
