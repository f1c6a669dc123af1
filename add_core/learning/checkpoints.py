"""Where a training stands, in one file that is always whole."""

from __future__ import annotations

import os
import pickle
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import torch

from ..errors import ShapeFileError

FORMAT = "add_core checkpoint 1"


@dataclass
class Checkpoint:
    """All that a training needs to go on bit by bit; batches and noise follow from the step alone.

    about : settings and data, as JSON: a run goes on only with the same. step : steps done. history : scores so far.
    network, average, optimizer : state dictionaries; average : of the weights' moving average.
    best : averaged weights of the best validation so far, None before the first.
    """

    about: str
    step: int
    network: dict[str, Any]
    optimizer: dict[str, Any]
    average: dict[str, Any] | None = None
    best: dict[str, Any] | None = None
    history: list[dict[str, Any]] = field(default_factory=list)

    def save(self, path: Path) -> None:
        """Write to `path` in one move: a process killed at any moment leaves the old file or the new."""
        unfinished = path.with_name(f".{path.name}.part")
        with unfinished.open("wb") as file:
            torch.save({"format": FORMAT, **vars(self)}, file)
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)

    @classmethod
    def load(cls, path: Path) -> Checkpoint | None:
        """What `path` holds, or None if there is no such file. Runs no code from it.

        Raises ShapeFileError if the file is damaged or something else.
        """
        if not path.exists():
            return None
        try:
            content = torch.load(path, weights_only=True, map_location="cpu")
            if content.pop("format") != FORMAT:
                raise KeyError("format")
            return cls(**content)
        except (
            RuntimeError,
            pickle.UnpicklingError,
            BadZipFile,
            EOFError,
            KeyError,
            TypeError,
            AttributeError,
        ):
            raise ShapeFileError(
                f"{path}: is damaged, or no checkpoint of this program. Remove it to start anew."
            ) from None
