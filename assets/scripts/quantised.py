"""How the shipped collections are stored: one connectivity, and vertices as 16-bit steps."""

from pathlib import Path

import numpy as np

SHAPES = Path(__file__).resolve().parent.parent / "shapes"


def save(path, vertices, faces, mirror, *, subjects, poses):
    """Write (shapes, n, 3) vertices as uint16 q with v = lo + scale · q, scale being the largest extent over 65535."""
    vertices = np.asarray(vertices, dtype=np.float32)
    lo = vertices.min(axis=(0, 1))
    scale = np.float32((vertices.max(axis=(0, 1)) - lo).max() / 65535)
    steps = np.round((vertices.astype(np.float64) - lo) / scale)
    np.savez_compressed(
        path,
        vertices_q=steps.astype(np.uint16),
        lo=lo,
        scale=scale,
        faces=faces.astype(np.uint16),
        sym=mirror.astype(np.uint16),
        subject=np.array(subjects, dtype=np.uint8),
        pose=np.array(poses),
    )
    error = np.abs(lo + float(scale) * steps - vertices).max()
    print(f"{path}: {vertices.shape}, {Path(path).stat().st_size:,} bytes, quantisation error {1000 * error:.4f} mm")


def load(path):
    """(vertices, faces, mirror, subjects, poses) of a file written by `save`."""
    with np.load(path, allow_pickle=False) as file:
        vertices = file["lo"].astype(np.float64) + float(file["scale"]) * file["vertices_q"]
        return vertices, file["faces"].astype(np.int64), file["sym"].astype(np.int64), file["subject"], file["pose"]
