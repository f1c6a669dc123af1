"""Draw the colour-transfer figure, like the paper's Figures 9 and 10: one reference, several people and poses.

    xvfb-run -a -s "-screen 0 1440x900x24" python assets/scripts/color_transfer_figure.py [mesh|cloud]...

Points are matched by AHKS (α = 50, sixteen angles) and refined by ZoomOut that AHKS guides; no learning. Writes
assets/reports/color_transfer_mesh.png and _cloud.png, and prints mean geodesic errors.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from add_core.correspondence import coordinate_colors, guided_zoomout, nearest_matches, transfer_colors
from add_core.evaluation import match_errors
from add_core.evaluation.baselines import describe_with, isotropic
from add_core.evaluation.samples import sample, truth_between
from add_core.geometry import TriangleMesh, normalize
from add_core.io import humans
from add_core.spectra import compute_spectra

REFERENCE, TARGETS = 83, (87, 84, 89, 92, 98)
FOLDER = Path(__file__).parents[1] / "reports"
SIZE = (330, 560)


def spectra_of(shape):
    return compute_spectra(normalize(shape), alphas=(0.0, 50.0), angles=16, count=200)


def drawn(plotter, shape, colors):
    """One shape, seen from the front."""
    if isinstance(shape, TriangleMesh):
        faces = np.column_stack([np.full(len(shape.faces), 3), shape.faces])
        data = pv.PolyData(shape.vertices, faces)
        plotter.add_mesh(data, scalars=colors, rgb=True, smooth_shading=True, specular=0.1, show_scalar_bar=False)
    else:
        data = pv.PolyData(shape.points)
        plotter.add_mesh(
            data, scalars=colors, rgb=True, point_size=6, render_points_as_spheres=True, show_scalar_bar=False
        )
    plotter.view_vector((0.35, -1.0, 0.12), viewup=(0, 0, 1))
    plotter.camera.zoom(1.25)


def main(variants):
    collection = humans()
    FOLDER.mkdir(exist_ok=True)
    for variant in variants:
        reference = sample(collection, REFERENCE, variant)
        spectra = spectra_of(reference.shape)
        colors = 0.08 + 0.87 * coordinate_colors(reference.shape)
        plotter = pv.Plotter(
            off_screen=True, shape=(1, 1 + len(TARGETS)), border=False, window_size=(SIZE[0] * 6, SIZE[1])
        )
        plotter.set_background("white")
        drawn(plotter, reference.shape, colors)
        for column, number in enumerate(TARGETS, start=1):
            target = sample(collection, number, variant)
            family = spectra_of(target.shape)
            described = describe_with("ahks", spectra), describe_with("ahks", family)
            raw = nearest_matches(described[1], described[0])
            found = guided_zoomout(isotropic(spectra), isotropic(family), *described)
            errors = [
                match_errors(match, truth_between(target, reference), shape=reference.shape).mean()
                for match in (raw, found.match_21)
            ]
            print(variant, collection.names[number], "mean error ÷ √area: raw {:.3f}, ZoomOut {:.3f}".format(*errors))
            plotter.subplot(0, column)
            drawn(plotter, target.shape, transfer_colors(reference.shape, found, colors=colors).smooth)
        plotter.screenshot(FOLDER / f"color_transfer_{variant}.png")
        plotter.close()


if __name__ == "__main__":
    main(sys.argv[1:] or ["mesh", "cloud"])
