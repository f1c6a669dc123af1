"""Named arrays in one NPZ file, as numpy.load reads them."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ..errors import ShapeFileError
from .atomic import write_atomically


def save_arrays(path: str | Path, arrays: Mapping[str, ArrayLike]) -> None:
    """Write `arrays`, of any shapes, to the NPZ file `path`, which appears whole or not at all. Nothing is pickled.

    Raises ShapeFileError if the name does not end in .npz or the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() != ".npz":
        raise ShapeFileError(f"{path}: arrays are written to NPZ files. Choose a name that ends in .npz.")
    buffer = BytesIO()
    np.savez(buffer, allow_pickle=False, **{name: np.asarray(array) for name, array in arrays.items()})
    write_atomically(path, buffer.getvalue())
