"""Arguments of the wrong kind are named, with what was expected: no error of NumPy's or Python's own comes through."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from add_core.correspondence import (
    FunctionalMap,
    coordinate_colors,
    icp,
    intrinsic_symmetry,
    mirror_symmetry,
    nearest_matches,
    preserved_orientation,
    transfer_colors,
    zoomout,
)
from add_core.descriptors import (
    angular_contrast,
    anisotropic_heat_kernel_signature,
    anisotropic_heat_kernel_times,
    geometry_vectors,
    heat_kernel_signature,
    heat_kernel_times,
    scale_invariant_heat_kernel_signature,
    scaled_heat_kernel_signature,
    spectral_kernel,
    spectral_signature,
    spline_reach,
    wave_kernel_signature,
    windowed_fourier_transform,
)
from add_core.errors import AddError, GeometryError, ParameterError
from add_core.evaluation import SurfacePoints, cmc, princeton, princeton_curve, right_side
from add_core.geometry import (
    PointCloud,
    TriangleMesh,
    farthest_points,
    geodesic_distances,
    inspect,
    mirror_map,
    normalize,
    principal_curvatures,
    repair,
)
from add_core.geometry.shapes import sphere
from add_core.io import load_shape, open_collection, save_shape
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow, compute_spectra, compute_spectrum

MESH = sphere(1)
N, M = MESH.vertex_count, len(MESH.faces)
LAPLACIAN = AnisotropicLaplacian(MESH, alpha=1.0)
SPECTRUM = compute_spectrum(LAPLACIAN, count=10)
FAMILY = compute_spectra(MESH, alphas=(0.0, 1.0), angles=2, count=10, workers=1, cache=False)
CLOUD = PointCloud(MESH.vertices)
RAGGED, WORD, COMPLEX = [[1], [1, 2]], "x", [1j]
POINTS = np.arange(N)


@pytest.mark.parametrize(
    "call",
    [
        principal_curvatures,
        inspect,
        normalize,
        coordinate_colors,
        mirror_symmetry,
        AnisotropicLaplacian,
        lambda shape: compute_spectra(shape, count=5),
        lambda shape: farthest_points(shape, 3),
        lambda shape: save_shape(shape, "never.ply"),
        lambda shape: princeton(MESH.vertices, MESH.vertices, POINTS, shape=shape, distances=lambda i, j: i * 0.0),
    ],
)
@pytest.mark.parametrize("shape", [MESH.vertices, "humans/0"])
def test_what_is_no_shape_is_refused(call, shape):
    with pytest.raises(
        ParameterError, match=rf"shape must be a TriangleMesh or a PointCloud, but it is an? {type(shape).__name__}"
    ):
        call(shape)
    assert not Path("never.ply").exists()


@pytest.mark.parametrize("call", [repair, mirror_map])
def test_what_has_no_faces_is_no_mesh(call):
    with pytest.raises(ParameterError, match="mesh must be a TriangleMesh, but it is a PointCloud"):
        call(CLOUD)


@pytest.mark.parametrize(
    "call",
    [
        lambda s: heat_kernel_signature(s, [1.0]),
        lambda s: scaled_heat_kernel_signature(s, [1.0]),
        heat_kernel_times,
        lambda s: wave_kernel_signature(s, [1.0], width=0.1),
        lambda s: spectral_signature(s, np.ones(10)),
        lambda s: zoomout(SPECTRUM, s, POINTS),
        lambda s: FunctionalMap.from_matches(s, SPECTRUM, POINTS, count=3),
        lambda s: spectral_kernel(s, 0, np.ones(10)),
        lambda s: windowed_fourier_transform(s, np.ones(N), window=np.ones(10)),
    ],
)
def test_a_family_is_not_taken_for_the_spectrum_of_one_operator(call):
    with pytest.raises(ParameterError, match=r"that of one operator, but it is a SpectralFamily\. Take .* family\[0\]"):
        call(FAMILY)


@pytest.mark.parametrize(
    "call",
    [
        lambda f: anisotropic_heat_kernel_signature(f, [1.0]),
        anisotropic_heat_kernel_times,
        geometry_vectors,
        lambda f: spline_reach([f]),
    ],
)
def test_the_spectrum_of_one_operator_is_not_taken_for_a_family(call):
    with pytest.raises(ParameterError, match="what compute_spectra returns, but it is a Spectrum"):
        call(SPECTRUM)


@pytest.mark.parametrize("call", [compute_spectrum, HeatFlow])
def test_a_shape_is_not_taken_for_its_operator(call):
    with pytest.raises(ParameterError, match=r"laplacian must be an AnisotropicLaplacian, .* TriangleMesh\. Anisotr"):
        call(MESH)


@pytest.mark.parametrize(
    "call",
    [
        lambda values: TriangleMesh(values, MESH.faces),
        lambda values: PointCloud(values),
        lambda values: AnisotropicLaplacian.from_directions(MESH, values, along=1.0, across=1.0),
        lambda values: AnisotropicLaplacian.from_tensors(MESH, values),
        lambda values: heat_kernel_signature(SPECTRUM, values),
        lambda values: anisotropic_heat_kernel_signature(FAMILY, values),
        lambda values: angular_contrast(values, FAMILY.alphas),
        lambda values: wave_kernel_signature(SPECTRUM, values, width=0.1),
        lambda values: windowed_fourier_transform(SPECTRUM, values, window=np.ones(10)),
        lambda values: windowed_fourier_transform(SPECTRUM, np.ones(N), window=values),
        lambda values: spectral_signature(SPECTRUM, values),
        lambda values: geometry_vectors(FAMILY, reach=values),
        lambda values: transfer_colors(MESH, POINTS, colors=values),
        lambda values: nearest_matches(values, MESH.vertices),
        lambda values: princeton_curve(values),
        lambda values: princeton_curve([0.1], radii=values),
        lambda values: SurfacePoints(np.zeros((1, 3), dtype=int), values),
        lambda values: HeatFlow(LAPLACIAN).autodiffusion(0, thetas=values, times=[1.0]),
    ],
)
@pytest.mark.parametrize(
    ("values", "found"), [(WORD, "holds a str"), (COMPLEX, "a complex"), (RAGGED, "rows differ in length")]
)
def test_numbers_are_neither_text_nor_complex_nor_ragged(call, values, found):
    with pytest.raises(AddError, match=found):
        call(values)


@pytest.mark.parametrize(
    "call",
    [
        lambda: LAPLACIAN.stiffness("1"),
        lambda: AnisotropicLaplacian(MESH, alpha="50"),
        lambda: HeatFlow(LAPLACIAN).kernel(0, theta=0.0, time="0.1"),
    ],
)
def test_a_number_in_text_is_not_a_number(call):
    with pytest.raises(ParameterError, match="must be a number, but it is '"):
        call()


@pytest.mark.parametrize(
    "call",
    [
        lambda numbers: TriangleMesh(MESH.vertices, numbers),
        lambda numbers: geodesic_distances(MESH, numbers),
        lambda numbers: cmc(MESH.vertices, MESH.vertices, numbers),
        lambda numbers: transfer_colors(MESH, numbers),
        lambda numbers: SurfacePoints(numbers, np.ones((1, 3)) / 3),
        lambda numbers: FunctionalMap.from_matches(SPECTRUM, SPECTRUM, numbers, count=3),
    ],
)
@pytest.mark.parametrize("numbers", [RAGGED, WORD, 2.5, None])
def test_vertex_numbers_are_explained_whatever_comes_in_their_place(call, numbers):
    with pytest.raises((ParameterError, GeometryError)):
        call(numbers)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: load_shape(None), "path must be the name of a file or folder, but it is None"),
        (lambda: open_collection(3), "path must be the name of a file or folder, but it is 3"),
        (lambda: open_collection(".", only=None), "only must be a str, but it is None"),
        (lambda: save_shape(MESH, "never.ply", [1, 2]), "fields must be a Mapping, but it is a list"),
        (lambda: AnisotropicLaplacian(MESH, conductivity=POINTS), "conductivity must be one of 'curvature', 'con"),
        (lambda: AnisotropicLaplacian(MESH, frames=MESH), "frames must be a PrincipalFrames, but it is a Tri"),
        (lambda: AnisotropicLaplacian(MESH, alpha=1e300), r"alpha must be from 0 to 1e\+30"),
        (lambda: scale_invariant_heat_kernel_signature(SPECTRUM, base=1), "base must be greater than 1"),
        (lambda: scale_invariant_heat_kernel_signature(SPECTRUM, step=1e-9), "number of times, .* from 2 to 100000"),
        (lambda: icp(SPECTRUM), "start must be a FunctionalMap, but it is a Spectrum"),
        (lambda: preserved_orientation(MESH, SPECTRUM, POINTS), "shape_1 must be a TriangleMesh or a PointCloud"),
        (lambda: intrinsic_symmetry(MESH, family=SPECTRUM), "family must be what compute_spectra returns"),
        (lambda: wave_kernel_signature(None, [1.0], width=0.1), "spectrum must be that of one operator, .* NoneType"),
        (lambda: LAPLACIAN.weyl_eigenvalue("x"), "index must be a number, but it is 'x'"),
        (lambda: save_shape(MESH, "never.ply", 5), "fields must be a Mapping, but it is an int"),
        (lambda: spline_reach(FAMILY), "families must be a list or a tuple, but it is a SpectralFamily"),
        (lambda: spline_reach([]), "families must hold at least one family"),
        (lambda: FunctionalMap.from_matches(SPECTRUM, SPECTRUM, POINTS, count=[3]), "count must be a whole number"),
        (lambda: intrinsic_symmetry(MESH, family=FAMILY, size=None), "size must be a whole number"),
        (lambda: transfer_colors(MESH, POINTS, smooth_map=SPECTRUM), "smooth_map must be a FunctionalMap"),
        (lambda: princeton_curve([0.1], radii=[0.2, 0.1]), "radii must be a list of numbers that ascend"),
    ],
)
def test_the_argument_is_named(call, message):
    with pytest.raises(ParameterError, match=message):
        call()


def test_whole_numbers_of_any_size_are_angles():
    assert_allclose(LAPLACIAN.stiffness(10**30).toarray(), LAPLACIAN.stiffness(1e30).toarray())


def test_times_of_a_spectrum_of_constants_alone_are_refused():
    """K = 1 holds λ = 0 and nothing else: no time follows from it, and none that is infinite."""
    constants = replace(FAMILY, eigenvalues=FAMILY.eigenvalues[:, :1], eigenfunctions=FAMILY.eigenfunctions[:, :, :1])
    with pytest.raises(ParameterError, match="spectrum must hold a non-zero eigenvalue, but all are zero"):
        anisotropic_heat_kernel_times(constants)


@pytest.mark.parametrize("unit", [1e-200, 1e-160, 1e160, 1e200])
@pytest.mark.parametrize("width", [3, 20])
def test_matches_do_not_depend_on_the_unit_of_a_descriptor(unit, width):
    """Squares of such numbers overflow or vanish, so that every target would be as near as any other."""
    values = np.random.default_rng(0).standard_normal((N, width))
    mirror = np.roll(POINTS, 1)
    assert_array_equal(nearest_matches(values * unit, values * unit), POINTS)
    assert right_side(values * unit, values * unit, POINTS, symmetry=mirror).share == 1.0


@pytest.mark.parametrize("make", [lambda places: TriangleMesh(places, MESH.faces), PointCloud])
def test_a_unit_in_which_areas_vanish_is_refused_but_not_points_in_one_place(make):
    with pytest.raises(GeometryError, match=r"must span 1e-60 or more, or areas vanish\. Choose a smaller unit"):
        make(MESH.vertices * 1e-120)
    assert make(MESH.vertices * 0.0).vertex_count == N
    assert make(MESH.vertices * 1e-59).area == pytest.approx(MESH.area * 1e-118, rel=0.1)
