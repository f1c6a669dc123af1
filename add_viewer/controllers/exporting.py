"""Writing what is shown to files, whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ..models.results import AutodiffusionCurves, FloatArray


def write_atomically(path: Path, write: Callable[[Path], None]) -> None:
    """Call `write` with a temporary path beside `path` (same ending), then move it there: no file is ever half lost.

    Raises OSError about `path` if it cannot be written, and whatever else `write` raises; `path` is then as it was.
    """
    try:
        _write_beside(path, write)
    except OSError as error:
        if Path(error.filename or "").name.startswith(f".{path.stem}-"):  # temporary: nobody has asked for that file
            raise OSError(error.errno, error.strerror, str(path)) from None
        raise


def _write_beside(path: Path, write: Callable[[Path], None]) -> None:
    handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        write(temporary)
        if path.exists():
            temporary.chmod(path.stat().st_mode & 0o777)
        else:
            temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def curves_table(curves: tuple[AutodiffusionCurves, ...], alpha: float) -> str:
    """The curves as CSV: one line a point, angle and time; lengths in geodesic diameters, full precision.

    Lines with alpha 0 and no angle are the heat kernel signature.
    """
    lines = ["vertex,mirror_of,alpha,theta_degrees,time,time_times_lambda1,heat_kernel"]
    for each in curves:
        point = f"{each.pick.vertex},{'' if each.pick.mirror_of is None else each.pick.mirror_of}"
        for theta, row in zip(each.thetas, each.values, strict=True):
            lines += _rows(f"{point},{alpha:g},{np.degrees(theta):.10g}", each.weyl_eigenvalue, each.reaches, row)
        if each.isotropic is not None:
            lines += _rows(f"{point},0,", each.isotropic_weyl_eigenvalue, each.reaches, each.isotropic)
    return "\n".join(lines) + "\n"


def _rows(start: str, scale: float, reaches: FloatArray, values: FloatArray) -> list[str]:
    pairs = zip(reaches.tolist(), values.tolist(), strict=True)
    return [f"{start},{reach / scale!r},{reach!r},{value!r}" for reach, value in pairs]


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
