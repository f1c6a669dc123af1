"""The file formats that are read and written, by file name extension."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from . import gltf, npz, obj, off, ply, stl, tosca, vtk_legacy, vtk_writing, vtk_xml, xyz
from .contents import Fields, FileContents, Shape


@dataclass(frozen=True)
class Format:
    """How one kind of file is read and written.

    name : what people call it. looks : what its content may look like (`sniffing.looks_like`), its own name first.
    holds_fields : whether it carries quantities at the vertices.
    """

    name: str
    read: Callable[[bytes, Path], FileContents]
    write: Callable[[Shape, Fields], bytes] | None
    looks: tuple[str, ...]
    holds_fields: bool = False


def _whole(read: Callable[[bytes], FileContents]) -> Callable[[bytes, Path], FileContents]:
    return lambda data, path: read(data)


FORMATS: dict[str, Format] = {
    ".off": Format("OFF", _whole(off.read), off.write, ("OFF",)),
    ".obj": Format("OBJ", _whole(obj.read), obj.write, ("OBJ",)),
    ".ply": Format("PLY", _whole(ply.read), ply.write, ("PLY",), holds_fields=True),
    ".stl": Format("STL", _whole(stl.read), stl.write, ("STL",)),
    ".vtp": Format("VTP", _whole(vtk_xml.read), vtk_writing.write_xml, ("VTP",), holds_fields=True),
    ".vtk": Format("VTK", _whole(vtk_legacy.read), vtk_writing.write_legacy, ("VTK",), holds_fields=True),
    ".glb": Format("GLB", gltf.read, gltf.write, ("GLB", "glTF")),
    ".gltf": Format("glTF", gltf.read, None, ("glTF", "GLB")),
    ".xyz": Format("XYZ", _whole(xyz.read), xyz.write, ("XYZ",)),
    ".mat": Format("MATLAB", _whole(tosca.read_matlab), None, ("MATLAB",)),
    ".vert": Format("TOSCA vertex", tosca.read_vert, None, ("TOSCA vertex",)),
    ".npz": Format("NPZ", _whole(npz.read), npz.write, ("ZIP",), holds_fields=True),
}


def extensions(*, writable: bool = False, holding_fields: bool = False) -> tuple[str, ...]:
    """Extensions that shapes can be read from; only those that can also be written, or that hold fields, on request."""
    return tuple(
        ext
        for ext, known in FORMATS.items()
        if (known.write is not None or not writable) and (known.holds_fields or not holding_fields)
    )
