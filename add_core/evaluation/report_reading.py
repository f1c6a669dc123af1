"""Scores read back from the folder of a report."""

from __future__ import annotations

import csv
import json
from collections import defaultdict
from pathlib import Path

import numpy as np

from ..errors import ParameterError
from .scores import Curve, Scores


def load_report(folder: Path) -> list[Scores]:
    """What `save_report` wrote into `folder`, in its order; curves are rounded to six digits.

    Raises ParameterError if scores.json or curves.csv is missing or holds something else.
    """
    try:
        facts = json.loads((folder / "scores.json").read_text(encoding="utf-8"))
        points: dict[tuple[str, str, str], list[tuple[float, float]]] = defaultdict(list)
        with (folder / "curves.csv").open(newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                place = row["method"], row["protocol"], row["setting"]
                points[place].append((float(row["x"]), float(row["y"])))
        return [_scores(entry, points) for entry in facts["methods"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ParameterError(f"{folder} holds no report of add-core evaluate: {error}.") from None


def _scores(entry: dict[str, float | str], points: dict[tuple[str, str, str], list[tuple[float, float]]]) -> Scores:
    method = str(entry["method"])
    curves = [
        Curve(protocol, setting, *np.array(found).T)
        for (name, protocol, setting), found in points.items()
        if name == method
    ]
    numbers = {name: float(value) for name, value in entry.items() if name not in ("method", "pairs")}
    return Scores(method, int(entry["pairs"]), numbers, tuple(curves))
