"""What a shape is made of, and what is wrong with it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from .._check import BoolArray, IntArray, instance_of
from .cloud import PointCloud
from .mesh import TriangleMesh
from .orientation import orientation


@dataclass(frozen=True)
class Defect:
    """One thing that is wrong with a shape.

    kind : what, in the plural. count : of how many. first : the number of the first one, of its `element` ("vertex",
    "face" or "edge", the latter counted as in TriangleMesh.edges). remedy : what happens to it and what to do.
    """

    kind: str
    count: int
    element: str
    first: int
    remedy: str

    def __str__(self) -> str:
        return f"{self.kind}: {self.count} (first: {self.element} {self.first}). {self.remedy}"


@dataclass(frozen=True)
class ShapeReport:
    """Counts, measures and defects of a shape, in its own length unit.

    components : connected pieces that have faces; unreferenced vertices are no pieces.
    boundary_loops : connected pieces of the boundary.
    euler_characteristic : used vertices - edges + faces, 2 for a sphere.
    volume : enclosed, unit length³, negative if the faces are turned inward; None unless the mesh is closed.
    lower, upper : corners of the bounding box.
    Of a point cloud only the counts, the box and the defects are known; the rest is None.
    """

    name: str
    kind: str
    vertices: int
    lower: tuple[float, float, float]
    upper: tuple[float, float, float]
    defects: tuple[Defect, ...]
    faces: int | None = None
    edges: int | None = None
    components: int | None = None
    boundary_edges: int | None = None
    boundary_loops: int | None = None
    euler_characteristic: int | None = None
    area: float | None = None
    volume: float | None = None
    has_normals: bool | None = None

    @property
    def diagonal(self) -> float:
        """Of the bounding box, in the unit of length."""
        return float(np.linalg.norm(np.subtract(self.upper, self.lower)))

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return asdict(self) | {"diagonal": self.diagonal}


def inspect(shape: TriangleMesh | PointCloud) -> ShapeReport:
    """Counts, measures and defects of `shape`. Nothing is changed; `repair` mends what can be mended safely.

    A boundary or several components are no defects. Faces count as without area if rounding made their normal.
    Raises ParameterError for what is no shape.
    """
    instance_of("shape", shape, TriangleMesh, PointCloud)
    lower, upper = (tuple(map(float, bound(shape.vertices, axis=0))) for bound in (np.min, np.max))
    box: dict[str, Any] = {"name": shape.name, "vertices": shape.vertex_count, "lower": lower, "upper": upper}
    if isinstance(shape, PointCloud):
        defects = _defects((_coincident(shape, "Merge them if neighbours are to be distinct points."),))
        return ShapeReport(kind="point cloud", defects=defects, has_normals=shape.normals is not None, **box)
    boundary = shape.boundary_edges
    is_closed = bool((shape.edge_face_counts == 2).all())
    corners = shape.vertices[shape.faces] - shape.vertices.mean(axis=0)
    volume = float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6.0
    return ShapeReport(
        kind="triangle mesh",
        defects=_mesh_defects(shape),
        faces=len(shape.faces),
        edges=len(shape.edges),
        components=len(np.unique(shape.component_labels[shape.is_referenced])),
        boundary_edges=len(boundary),
        boundary_loops=_pieces(boundary),
        euler_characteristic=int(shape.is_referenced.sum()) - len(shape.edges) + len(shape.faces),
        area=shape.area,
        volume=volume if is_closed else None,
        **box,
    )


def repeated_rows(rows: IntArray | np.ndarray[Any, Any]) -> BoolArray:
    """(n,): whether a row of numbers stands further up already."""
    _, first = np.unique(rows, axis=0, return_index=True)
    repeated = np.ones(len(rows), dtype=bool)
    repeated[first] = False
    return repeated


def _mesh_defects(mesh: TriangleMesh) -> tuple[Defect, ...]:
    turned = orientation(mesh)
    crowded = mesh.edge_face_counts > 2
    ends = mesh.edges[np.argmax(crowded)]
    return _defects(
        (
            ("unreferenced vertices", "vertex", ~mesh.is_referenced, "No face uses them; they get mass 0 and value 0."),
            ("faces without area", "face", ~mesh.has_area, "Repairing drops them; no vertex changes."),
            (
                "repeated faces",
                "face",
                repeated_rows(np.sort(mesh.faces, axis=1)),
                "Repairing keeps the first of each.",
            ),
            (
                "edges of more than two faces",
                "edge",
                crowded,
                f"Cut the surface there; the first joins vertices {ends[0]} and {ends[1]}.",
            ),
            (
                "pinched vertices",
                "vertex",
                _pinched(mesh),
                "Several sheets meet in one point; split it if they should not.",
            ),
            (
                "faces turned against their neighbours",
                "face",
                turned.disagreeing & mesh.has_area,
                "Repairing turns them.",
            ),
            ("faces turned inward", "face", turned.inward, "Repairing turns the closed pieces that they belong to."),
            ("faces without two sides", "face", turned.one_sided, "The surface cannot be oriented; cut it open."),
            _coincident(mesh, "Merge them where the surface should hang together; vertex numbers change."),
        )
    )


_Finding = tuple[str, str, BoolArray, str]


def _defects(findings: tuple[_Finding, ...]) -> tuple[Defect, ...]:
    return tuple(
        Defect(kind, int(found.sum()), element, int(np.argmax(found)), remedy)
        for kind, element, found, remedy in findings
        if found.any()
    )


def _coincident(shape: TriangleMesh | PointCloud, remedy: str) -> _Finding:
    name = "points" if isinstance(shape, PointCloud) else "vertices"
    return f"{name} at the place of an earlier one", "vertex", repeated_rows(shape.vertices), remedy


def _pieces(edges: IntArray) -> int:
    """Into how many connected pieces `edges` fall."""
    if len(edges) == 0:
        return 0
    _, ends = np.unique(edges, return_inverse=True)
    i, j = ends.reshape(-1, 2).T
    size = int(ends.max()) + 1
    return int(connected_components(coo_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(size, size)))[0])


def _pinched(mesh: TriangleMesh) -> BoolArray:
    """(n,): vertices whose faces form several fans, each hanging together by edges."""
    faces = mesh.faces
    corner = np.arange(faces.size).reshape(-1, 3)
    # Corners of one vertex belong together if their faces share an edge at it. Every edge links its faces in a ring.
    links = []
    half = faces[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2)
    ends = corner[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2)
    swap = half[:, 0] > half[:, 1]
    half, ends = np.where(swap[:, None], half[:, ::-1], half), np.where(swap[:, None], ends[:, ::-1], ends)
    order = np.lexsort((half[:, 1], half[:, 0]))
    same = (half[order[1:]] == half[order[:-1]]).all(axis=1)
    for side in (0, 1):
        links.append((ends[order[:-1][same], side], ends[order[1:][same], side]))
    i, j = (np.concatenate(part) for part in zip(*links, strict=True))
    graph = coo_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(faces.size, faces.size))
    fan = connected_components(graph, directed=False)[1]
    fans_at = np.unique(np.stack([faces.ravel(), fan], axis=1), axis=0)[:, 0]
    pinched: BoolArray = np.bincount(fans_at, minlength=mesh.vertex_count) > 1
    return pinched
