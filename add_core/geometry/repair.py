"""Mending what can be mended without moving, removing or renumbering a vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._check import instance_of
from ..errors import GeometryError
from .inspection import Defect, inspect, repeated_rows
from .mesh import TriangleMesh
from .orientation import orientation


@dataclass(frozen=True)
class Repair:
    """A mended mesh and what was done.

    mesh : the same vertices in the same order, and the faces that are left, in their order.
    flat_faces, repeated_faces : how many faces were dropped. turned_faces : how many were turned around.
    remaining : the defects that are left, because mending them would change vertices or need a choice.
    """

    mesh: TriangleMesh
    flat_faces: int
    repeated_faces: int
    turned_faces: int
    remaining: tuple[Defect, ...]

    @property
    def messages(self) -> tuple[str, ...]:
        """One sentence for each thing that was done; empty if nothing was."""
        done = (
            (self.flat_faces, "without area dropped"),
            (self.repeated_faces, "that repeated earlier ones dropped"),
            (self.turned_faces, "turned around"),
        )
        return tuple(f"{count} {'faces' if count > 1 else 'face'} {what}." for count, what in done if count)


def repair(mesh: TriangleMesh) -> Repair:
    """Drop faces without area and repeated faces; turn others so that neighbours agree and closed pieces face outward.

    Vertices stay as they are, so that correspondences and fields stay valid. A mesh without such defects is returned
    itself. A closed piece inside another one faces outward, too: it is a surface of its own, not a cavity's wall.

    Raises GeometryError if no face has an area.
    """
    instance_of("mesh", mesh, TriangleMesh)
    if not mesh.has_area.any():
        raise GeometryError(
            f"none of the {len(mesh.faces)} faces has an area. Check the vertices; are they all on one line?"
        )
    flat = ~mesh.has_area
    faces = mesh.faces[~flat]
    repeated = repeated_rows(np.sort(faces, axis=1))
    faces = faces[~repeated]
    turned = orientation(TriangleMesh(mesh.vertices, faces)).turned
    faces = np.where(turned[:, None], faces[:, ::-1], faces)
    changed = bool(flat.any() or repeated.any() or turned.any())
    mended = TriangleMesh(mesh.vertices, faces, name=mesh.name) if changed else mesh
    return Repair(mended, int(flat.sum()), int(repeated.sum()), int(turned.sum()), inspect(mended).defects)
