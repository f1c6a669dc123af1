"""Whether this screen can draw in three dimensions."""

from __future__ import annotations

from PySide6.QtGui import QOffscreenSurface, QOpenGLContext, QSurfaceFormat

_VERSION = (3, 2)


def graphics_problem() -> str | None:
    """Why VTK could not draw here, in one line; None if it can. Needs a QApplication."""
    wanted = QSurfaceFormat()
    wanted.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
    wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    wanted.setVersion(*_VERSION)
    context, surface = QOpenGLContext(), QOffscreenSurface()
    context.setFormat(wanted)
    surface.setFormat(wanted)
    surface.create()
    if not context.create() or not context.makeCurrent(surface):
        return "This display offers no OpenGL. Install software rendering: sudo apt-get install libgl1-mesa-dri"
    found = context.format().version()
    context.doneCurrent()
    if tuple(found) < _VERSION:
        return f"OpenGL 3.2 is needed, but this display offers {found[0]}.{found[1]}. Update the graphics driver."
    return None
