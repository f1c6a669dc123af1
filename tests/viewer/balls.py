"""Small shapes with a known mirror plane and known correspondence, and a core that answers in this process."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from click.testing import CliRunner
from scipy.spatial import KDTree

from add_core.cli.application import application
from add_core.geometry import TriangleMesh, normalize
from add_core.geometry.shapes import sphere
from add_core.io import save_shape
from add_viewer.models.jobs import Jobs
from add_viewer.models.shapes import OpenShape


def lopsided_ball(subdivisions: int = 2, *, bent: float = 0.0) -> TriangleMesh:
    """An egg with two unlike bumps, the same on both sides of the plane x = 0; `bent` along its length."""
    ball = sphere(subdivisions)
    places = ball.vertices * [1.0, 1.3, 1.7]
    for centre, height in (([0.0, 0.9, 1.1], 0.5), ([0.0, -0.5, 1.5], -0.2)):
        places = places * (1 + height * np.exp(-4 * ((places - centre) ** 2).sum(axis=1)))[:, None]
    places = places + bent * np.outer(places[:, 2] ** 2, [0.0, 1.0, 0.0])
    return TriangleMesh(places, ball.faces)


def mirror_of(mesh: TriangleMesh) -> np.ndarray:
    """(n,): the image of every vertex in the plane x = 0."""
    return KDTree(mesh.vertices).query(mesh.vertices * [-1, 1, 1])[1]


def open_ball(folder: Path, name: str = "egg", *, bent: float = 0.0, symmetric: bool = True) -> OpenShape:
    """The ball in a file of its own, as the app opens it."""
    mesh = lopsided_ball(bent=bent)
    path = folder / f"{name}.off"
    save_shape(mesh, path)
    symmetry = mirror_of(mesh) if symmetric else None
    return OpenShape(
        key=str(path), reference=str(path), name=name, shape=normalize(mesh), diameter=1.0, symmetry=symmetry
    )


class Core:
    """Runs the commands of jobs in this process, when a test says so."""

    def __init__(self, jobs: Jobs) -> None:
        self.jobs = jobs
        self.waiting: list[str] = []
        jobs.asked.connect(self._asked)

    def _asked(self, verb: str, id: str) -> None:
        if verb in ("start", "retry"):
            self.jobs.put(replace(self.jobs[id], state="running"))
            self.waiting.append(id)
        elif verb == "dismiss":
            self.jobs.remove(id)

    def answer(self, index: int = 0) -> None:
        """Let one job end."""
        job = self.jobs[self.waiting.pop(index)]
        job.request.folder.mkdir(parents=True, exist_ok=True)
        said = CliRunner().invoke(application, [*job.request.arguments, "--json"])
        if said.exit_code == 0:
            result = json.loads(said.stdout.splitlines()[-1])
            self.jobs.put(replace(job, state="done", result=result))
        else:
            self.jobs.put(replace(job, state="failed", message=str(said.exception)))
