"""Draw the start page's pictures of the shipped shapes: xvfb-run -a python assets/make_thumbnails.py [COLLECTION…]"""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QMainWindow

from add_core.io import SHIPPED
from add_viewer.models.shapes import OpenShape
from add_viewer.views.canvas import Canvas

WIDTH, HEIGHT, COLUMNS = 144, 192, 10
FOLDER = Path(__file__).parent.parent / "add_viewer" / "thumbnails"
AZIMUTHS = {"dogs": 55.0}


def main() -> None:
    """Write one sheet of pictures a collection, ten a row, on a transparent background."""
    app = QApplication([])
    window = QMainWindow()
    canvas = Canvas(window)
    window.setCentralWidget(canvas)
    window.resize(2 * WIDTH, 2 * HEIGHT)
    window.show()
    FOLDER.mkdir(exist_ok=True)
    for name in sys.argv[1:] or SHIPPED:
        shapes = SHIPPED[name]()
        sheet = Image.new("RGBA", (COLUMNS * WIDTH, -(-len(shapes) // COLUMNS) * HEIGHT))
        for index in range(len(shapes)):
            opened = OpenShape(key=name, reference=name, name=name, shape=shapes[index], diameter=1.0)
            canvas.show_shape(opened, shapes.up, shapes.front)
            canvas.camera_model.azimuth = AZIMUTHS.get(name, 20.0)
            canvas.fit()
            app.processEvents()
            sheet.paste(_picture(canvas), (index % COLUMNS * WIDTH, index // COLUMNS * HEIGHT))
        sheet.quantize(96, method=Image.Quantize.FASTOCTREE).save(FOLDER / f"{name}.png", optimize=True)
        print(name, len(shapes), (FOLDER / f"{name}.png").stat().st_size)
    canvas.close()


def _picture(canvas: Canvas) -> Image.Image:
    image = canvas.picture(1, transparent=True)
    smooth = Qt.TransformationMode.SmoothTransformation
    image = image.scaled(WIDTH, HEIGHT, Qt.AspectRatioMode.IgnoreAspectRatio, smooth)
    image = image.convertToFormat(QImage.Format.Format_RGBA8888)
    return Image.frombytes("RGBA", (WIDTH, HEIGHT), bytes(image.constBits()), "raw", "RGBA", image.bytesPerLine())


if __name__ == "__main__":
    main()
