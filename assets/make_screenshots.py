"""Take the README's pictures of the real window, or the same in other looks to judge them.

On a screen: xvfb-run -a -s "-screen 0 1440x900x24" python assets/make_screenshots.py [SCENE…]
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Callable
from math import radians
from pathlib import Path

from PIL import Image

FOLDER = Path(__file__).parent / "screenshots"
THIGH, SHOULDER, BACK = 6868, 5056, 1000
PATIENCE = 900.0


class Photographer:
    """Sets the window up as a person would, waits until it has settled, and saves what it shows."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        from PySide6.QtCore import QSettings

        from add_viewer.assembly import Assembly

        self.folder, self.theme = arguments.output, arguments.theme
        store = QSettings(str(Path(tempfile.mkdtemp()) / "settings.ini"), QSettings.Format.IniFormat)
        size = tuple(int(side) for side in arguments.size.split("x"))
        self.assembly = Assembly([], store=store, size=size, theme=arguments.theme)
        self.window, self.session = self.assembly.window, self.assembly.session
        self.window.show()

    def wait(self, condition: Callable[[], bool]) -> None:
        end = time.perf_counter() + PATIENCE
        while not condition():
            self.assembly.app.processEvents()
            time.sleep(0.002)
            if time.perf_counter() > end:
                raise TimeoutError("the window did not settle")

    def open(self, *references: str) -> None:
        """These shapes and no others, the first being the source."""
        for shape in self.session.state.shapes:
            self.session.close_shape(shape.key)
        for reference in references:
            self.assembly.opening.open(reference)
            self.wait(lambda reference=reference: self.session.state.active_key == reference)
        self.session.show_shape(references[0])
        self.session.choose_comparison(None)
        self.session.choose_field(kind="heat", name="")
        self.session.arrange(layout="grid")
        self.rest()

    def rest(self) -> None:
        """Until the fields, the curves and the jobs of the shown state are there."""
        results, session = self.assembly.results, self.session
        waits = bool(session.state.active_picks)

        def is_settled() -> bool:
            fields = [results.fields.get((view.panel, view.key or "")) for view in self.window.scene.views]
            curves = [each.pick for each in results.curves if each.is_complete]
            drawn = [field is not None and (field.values is not None or field.colors is not None) for field in fields]
            return all(drawn) and curves == list(session.state.active_picks)

        if waits:
            self.wait(is_settled)
        end = time.perf_counter() + 3.0
        self.wait(lambda: time.perf_counter() > end)

    def rest_at(self, theta: float) -> None:
        """Until the heat of this direction is drawn."""
        results = self.assembly.results
        self.wait(lambda: results.kernel is not None and results.kernel.diffusion.theta == theta)
        self.rest()

    def save(self, name: str) -> None:
        self.rest()
        _pillow(self.window.grab().toImage()).convert("RGB").save(self.folder / f"{name}.png", optimize=True)


def start(camera: Photographer) -> None:
    """The page that offers shapes."""
    end = time.perf_counter() + 1.0
    camera.wait(lambda: time.perf_counter() > end)
    camera.save("start")


def window(camera: Photographer) -> None:
    """Heat on a thigh."""
    camera.open("humans/0")
    camera.session.pick(THIGH)
    camera.session.diffuse(theta=radians(60))
    camera.save("window")


def angles(camera: Photographer) -> None:
    """One person, four directions, side by side."""
    camera.open("humans/0")
    camera.session.pick(THIGH)
    images = []
    for theta in (0, 45, 90, 135):
        camera.session.diffuse(theta=radians(theta))
        camera.rest_at(radians(theta))
        images.append(_pillow(camera.window.view.picture(2, labels=False, transparent=True)))
    width, height = images[0].size
    parts = [image.crop((round(0.34 * width), 0, round(0.66 * width), height)) for image in images]
    strip = Image.new("RGBA", (sum(part.width for part in parts), height), (250, 250, 248, 255))
    for index, part in enumerate(parts):
        strip.alpha_composite(part, (index * part.width, 0))
    strip = strip.convert("RGB").resize((strip.width // 2, strip.height // 2), Image.Resampling.LANCZOS)
    strip.save(camera.folder / "angles.png", optimize=True)


def mirror(camera: Photographer) -> None:
    """A point and its mirror image."""
    camera.open("humans/0")
    camera.session.pick(THIGH)
    camera.session.pick_mirror(THIGH)
    camera.session.diffuse(theta=radians(45))
    camera.save("mirror")


def dark(camera: Photographer) -> None:
    """The directions on the skin, in the dark."""
    camera.open("humans/0")
    camera.session.pick(THIGH)
    camera.assembly.display.set("theme", "dark")
    camera.assembly.display.set("arrows", True)
    camera.wait(lambda: bool(camera.assembly.results.directions))
    camera.save("dark")
    camera.assembly.display.set("arrows", False)
    camera.assembly.display.set("theme", camera.theme)


def dog(camera: Photographer) -> None:
    """Heat on a dog."""
    camera.open("dogs/3")
    camera.session.pick(BACK)
    camera.save("dog")


def several(camera: Photographer) -> None:
    """A person as it is, another remeshed, and a third as a cloud of points."""
    camera.open("humans/83", "remeshed/4", "clouds/12")
    camera.session.pick(SHOULDER)
    camera.session.diffuse(theta=radians(90))
    camera.save("several")


def distances(camera: Photographer) -> None:
    """What resembles a shoulder: to the wave kernel signature, and to the learned descriptor."""
    from add_viewer.models.fields import FieldChoice

    camera.open("humans/80", "humans/93")
    camera.session.pick(SHOULDER)
    camera.session.choose_field(kind="distance", descriptor="wks")
    camera.session.choose_comparison(FieldChoice("distance", "humans-madd3"))
    camera.save("distances")


def symmetry(camera: Photographer) -> None:
    """A point and its mirror image, which HKS cannot tell apart and AHKS can."""
    camera.open("humans/83")
    camera.session.pick(SHOULDER)
    camera.window.menus.actions["explore_symmetry"].trigger()
    camera.save("symmetry")


def transfer(camera: Photographer) -> None:
    """Colours of one person on two others, by the learned descriptor refined by ZoomOut."""
    camera.open("humans/83", "humans/94", "clouds/12")
    camera.session.pick(SHOULDER)
    camera.window.menus.actions["transfer"].trigger()
    camera.session.match(method="zoomout", descriptor="humans-madd3", refined=True)
    camera.save("transfer")


def training(camera: Photographer) -> None:
    """A network that learns in the background."""
    from add_viewer.models.training import TrainingRequest

    camera.open("humans/0")
    jobs, panel = camera.assembly.jobs, camera.assembly.background.training_panel
    panel.submitted.emit(TrainingRequest())
    camera.wait(lambda: any(job.request.kind == "train" and job.is_finished for job in jobs.listed))
    camera.assembly.background.open_training()
    camera.save("training")


SCENES = (start, window, angles, mirror, dark, dog, several, distances, symmetry, transfer, training)


def main() -> None:
    """Take the pictures that were asked for, or all."""
    names = [scene.__name__ for scene in SCENES]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", metavar="SCENE", nargs="*", help=", ".join(names))
    parser.add_argument("--theme", choices=("light", "dark"), default="light")
    parser.add_argument("--size", default="1440x900")
    parser.add_argument("--scale", choices=("1", "2"), default="1", help="pixels for each point of the screen")
    parser.add_argument("-o", "--output", type=Path, default=FOLDER)
    arguments = parser.parse_args()
    if unknown := set(arguments.scenes) - set(names):
        parser.error(f"unknown scenes: {', '.join(sorted(unknown))}")
    os.environ["QT_SCALE_FACTOR"] = arguments.scale
    os.environ["ADD_DATA_DIR"] = tempfile.mkdtemp()
    arguments.output.mkdir(parents=True, exist_ok=True)
    camera = Photographer(arguments)
    for scene in SCENES:
        if not arguments.scenes or scene.__name__ in arguments.scenes:
            scene(camera)
    camera.assembly.stop()


def _pillow(image) -> Image.Image:  # type: ignore[no-untyped-def]
    from PySide6.QtGui import QImage

    image = image.convertToFormat(QImage.Format.Format_RGBA8888)
    size = (image.width(), image.height())
    return Image.frombytes("RGBA", size, bytes(image.constBits()), "raw", "RGBA", image.bytesPerLine())


if __name__ == "__main__":
    main()
