"""Figures for papers: what the window shows, as text, curves and pixels on one page."""

import re
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage

from add_viewer.views.figure_dialog import FigureDialog
from add_viewer.views.figure_page import PageChoice
from add_viewer.views.figure_plates import pixels_of

COARSE = PageChoice(dpi=72)


@pytest.fixture
def heated(person, make_torus, qtbot):
    """Two tori with heat on them, and the curves of the picked point."""
    person.session.add_shape(make_torus("left"))
    person.session.add_shape(make_torus("right"))
    person.session.pick(3)
    curves = person.window.curves
    qtbot.waitUntil(lambda: bool(curves.scene().shown) and curves.scene().curves[0].is_complete, timeout=90000)
    qtbot.waitUntil(lambda: all(view.field is not None for view in person.window.scene.views), timeout=90000)
    return person


def save(person, qtbot, path, choice):
    figures = person.assembly.figures
    figures.save(path, choice)
    assert figures.is_running, "the window goes on"
    qtbot.waitUntil(lambda: not figures.is_running, timeout=90000)


def test_an_svg_has_text_curves_and_shapes(heated, qtbot, tmp_path: Path):
    path = tmp_path / "figure.svg"
    save(heated, qtbot, path, COARSE)
    svg = path.read_text(encoding="utf-8")
    words = re.sub(r"<[^>]+>", " ", svg)
    for text in ("left", "right", "Heat kernel h(x, ·)", "AHKS over θ", "direction θ"):
        assert text in words
    assert svg.count("<image") >= 4  # two shapes, two colour bars
    assert re.search(r'width="510\.\d+pt"', svg)  # 180 mm


def test_a_pdf_is_as_wide_as_asked_for(heated, qtbot, tmp_path: Path):
    path = tmp_path / "figure.pdf"
    save(heated, qtbot, path, PageChoice(width=120.0, dpi=72))
    data = path.read_bytes()
    assert data.startswith(b"%PDF")
    width = float(re.search(rb"/MediaBox \[ 0 0 ([\d.]+)", data)[1])
    assert width == pytest.approx(120 / 25.4 * 72, abs=0.1)


def test_a_png_is_white_with_the_shapes_and_their_heat_on_it(heated, qtbot, tmp_path: Path):
    path = tmp_path / "figure.png"
    heated.window.display.set("theme", "dark")
    save(heated, qtbot, path, PageChoice(dpi=100))
    image = QImage(str(path))
    assert image.width() == int(180 / 25.4 * 100)
    pixels = pixels_of(image)[..., :3].astype(int)
    assert (pixels[0] == 255).all()
    assert 0.1 < (pixels.sum(axis=2) < 750).mean() < 0.7
    halves = np.array_split(pixels, 2, axis=1)
    for half in halves:  # heat on both shapes
        assert (half.max(axis=2) - half.min(axis=2) > 100).sum() > 200


def test_what_is_not_wanted_is_left_out(heated):
    figures = heated.assembly.figures
    plates = figures.plates(1.0)
    assert len({plate.pixels.shape for plate in plates}) == 1, "cut alike, so that sizes compare"
    whole = figures.page(plates, PageChoice())
    without = [PageChoice(curves=False), PageChoice(bars=False), PageChoice(names=False)]
    assert all(figures.page(plates, choice).height < whole.height for choice in without)
    narrow = figures.page(plates, PageChoice(width=85.0))
    assert not narrow.figure.subfigs, "three plots need room"


def test_names_of_neighbours_do_not_meet_however_narrow_the_page(heated):
    figures = heated.assembly.figures
    (plate, *_), names = figures.plates(0.5), ("Person 9, neutral, remeshed", "Unbreakablenamewithoutanyspaces", "Dog")
    plates = [replace(plate, column=column, name=name) for column, name in enumerate(names)]
    page = figures.page(plates, PageChoice(width=85.0, dpi=72))
    page.figure.draw_without_rendering()
    bold = [text for text in page.figure.texts if text.get_weight() == "bold"]
    words = [text.get_text() for text in bold]
    assert words[:3] == ["Person 9,", "neutral,", "remeshed"]
    assert words[3].startswith("Unbreak")
    assert words[3].endswith("…")
    assert words[4:] == ["Dog"]
    boxes = [text.get_window_extent() for text in bold]
    cell = page.cell / 85.0 * page.figure.bbox.width
    assert all(box.width < cell for box in boxes)
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


def test_the_dialog_shows_the_page_and_how_large_it_is(heated, qtbot):
    figures = heated.assembly.figures
    plates = figures.plates(1.0)
    dialog = FigureDialog(lambda choice: figures._picture(plates, choice), has_curves=True, parent=heated.window)
    qtbot.addWidget(dialog)
    dialog.show()
    before, size = dialog.preview.pixmap().toImage(), dialog.size_label.text()
    dialog.curves.click()
    qtbot.waitUntil(lambda: dialog.size_label.text() != size)
    assert dialog.preview.pixmap().toImage() != before
    dialog.width_box.setCurrentIndex(0)
    assert not dialog.curves.isEnabled()
    assert dialog.choice == PageChoice(width=85.0, dpi=300, curves=False)
    dialog.reject()


def test_a_figure_that_cannot_be_written_is_told(heated, qtbot, tmp_path: Path):
    save(heated, qtbot, tmp_path / "nowhere" / "figure.svg", COARSE)
    assert "figure.svg was not saved" in heated.window.message.text.text()


def test_a_figure_is_cancelled_between_two_views_and_leaves_nothing(heated, qtbot, tmp_path: Path):
    figures = heated.assembly.figures
    figures.save(tmp_path / "figure.png", COARSE)
    assert not heated.window.menus.actions["figure"].isEnabled()
    qtbot.waitUntil(lambda: figures.bar.progress.value() == 1)
    qtbot.mouseClick(figures.bar.cancel, Qt.MouseButton.LeftButton)
    assert not figures.is_running
    qtbot.wait(50)
    assert list(tmp_path.glob("figure*")) == []
    assert heated.window.menus.actions["figure"].isEnabled()
