"""Pictures of the scene for files: any size, smooth edges, transparent if wanted."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QImage
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

from .view3d import View3D

_SAMPLES = 8


def take_picture(view: View3D, factor: int, *, transparent: bool) -> QImage:
    """What `view` shows, `factor` times as fine as it is on the screen."""
    with _fine_render(view, transparent=transparent):
        pixels = _read_pixels(view, factor)
    height, width, _ = pixels.shape
    image = QImage(pixels.data, width, height, 4 * width, QImage.Format.Format_RGBA8888_Premultiplied)
    return image.convertToFormat(QImage.Format.Format_ARGB32)


@contextmanager
def _fine_render(view: View3D, *, transparent: bool) -> Iterator[None]:
    """Smooth edges from many samples, too slow for live pictures; transparent is black, as premultiplied needs."""
    renderer, window = view.renderer, view.render_window
    kept = renderer.GetBackground(), renderer.GetGradientBackground(), window.GetMultiSamples()
    window.SetMultiSamples(_SAMPLES)
    window.SetAlphaBitPlanes(1)
    if transparent:
        renderer.SetGradientBackground(False)
        renderer.SetBackground(0.0, 0.0, 0.0)
    renderer.SetBackgroundAlpha(0.0 if transparent else 1.0)
    try:
        with view.rendering_at_once():
            yield
    finally:
        renderer.SetBackground(kept[0])
        renderer.SetGradientBackground(kept[1])
        renderer.SetBackgroundAlpha(1.0)
        window.SetMultiSamples(kept[2])


def _read_pixels(view: View3D, factor: int) -> NDArray[np.uint8]:
    """(height, width, 4) of a fresh render."""
    view.render_window.MakeCurrent()
    grab = vtkWindowToImageFilter()
    grab.SetInput(view.render_window)
    grab.SetScale(factor)
    grab.SetInputBufferTypeToRGBA()
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 4)
    return np.ascontiguousarray(pixels[::-1])
