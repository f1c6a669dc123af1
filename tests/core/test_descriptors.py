"""Signatures against their formulas, and against what they must not see."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.descriptors import (
    angular_contrast,
    anisotropic_heat_kernel_signature,
    anisotropic_heat_kernel_times,
    geometry_vectors,
    heat_kernel_signature,
    heat_kernel_times,
    heat_window,
    scale_invariant_heat_kernel_signature,
    scaled_heat_kernel_signature,
    spectral_kernel,
    spectral_signature,
    spline_reach,
    wave_kernel_energies,
    wave_kernel_signature,
    windowed_fourier_descriptor,
    windowed_fourier_transform,
)
from add_core.descriptors.splines import splines_at
from add_core.errors import ParameterError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import ellipsoid, sphere
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow, compute_spectra, compute_spectrum


@pytest.fixture(scope="module")
def mesh():
    return ellipsoid(1.0, 0.8, 0.6, subdivisions=3)


@pytest.fixture(scope="module")
def family(mesh):
    return compute_spectra(mesh, alphas=(0.0, 20.0), angles=4, count=60, workers=1, cache=False)


@pytest.fixture(scope="module")
def spectrum(family):
    return family[0]


def test_wave_signature_is_its_formula(spectrum):
    energies, width = np.array([1.0, 2.5, 4.0]), 0.6
    lam, phi = spectrum.eigenvalues[1:], spectrum.eigenfunctions[:, 1:]
    band = np.exp(-((energies - np.log(lam)[:, None]) ** 2) / (2 * width**2))
    expected = phi**2 @ band / band.sum(axis=0)
    assert_allclose(wave_kernel_signature(spectrum, energies, width=width), expected, rtol=1e-12)


def test_wave_signature_far_from_every_eigenvalue_is_the_nearest_eigenfunction(spectrum):
    far = wave_kernel_signature(spectrum, [1000.0], width=0.1)
    assert_allclose(far[:, 0], spectrum.eigenfunctions[:, -1] ** 2)


def test_wave_energies_follow_aubry(spectrum):
    chosen = wave_kernel_energies(spectrum, 50)
    step = np.diff(chosen.energies)
    assert_allclose(step, step[0])
    assert_allclose(chosen.width, 7 * step[0])
    assert_allclose(chosen.energies[0], np.log(spectrum.eigenvalues[1]) + 2 * chosen.width)
    assert_allclose(chosen.energies[-1], np.log(spectrum.eigenvalues[-1]) - 2 * chosen.width)


@pytest.mark.parametrize("signature", ["scaled heat", "wave"])
def test_normalised_signatures_sum_to_one_over_the_shape(spectrum, signature):
    if signature == "wave":
        values = wave_kernel_signature(spectrum, [1.0, 3.0], width=0.5)
    else:
        values = scaled_heat_kernel_signature(spectrum, [0.01, 1.0])
    assert_allclose(spectrum.mass @ values, 1)


def test_scale_invariant_signature_does_not_see_the_scale():
    """Twice the size makes a quarter of the heat signature, and next to nothing of the invariant one."""
    mesh = ellipsoid(subdivisions=3)
    small = compute_spectrum(AnisotropicLaplacian(mesh, alpha=0), count=200)
    large = compute_spectrum(AnisotropicLaplacian(TriangleMesh(2 * mesh.vertices, mesh.faces), alpha=0), count=200)
    one, two = scale_invariant_heat_kernel_signature(small), scale_invariant_heat_kernel_signature(large)
    assert one.shape == (642, 6)
    assert_allclose(two, one, rtol=1e-6)
    fixed = {"first": -12.0, "last": 10.0}
    shifted = scale_invariant_heat_kernel_signature(large, **fixed)
    assert_allclose(shifted, scale_invariant_heat_kernel_signature(small, **fixed), atol=0.01 * one.max())
    assert np.ptp(one, axis=0).min() > 1e-3 * one.max()
    assert_allclose(heat_kernel_signature(small, 0.01), 4 * heat_kernel_signature(large, 0.04), rtol=1e-6)


def test_a_band_pass_kernel_with_heat_for_its_band_is_the_heat_kernel(mesh):
    laplacian = AnisotropicLaplacian(mesh, alpha=20.0)
    everything = compute_spectrum(laplacian, theta=0.5, count=642)
    kernel = spectral_kernel(everything, 30, lambda values: np.exp(-0.3 * values))
    assert_allclose(kernel[:, 0], HeatFlow(laplacian).kernel(30, theta=0.5, time=0.3), atol=1e-5 * kernel.max())


def test_signatures_of_a_transfer_function_or_of_its_values_agree(spectrum):
    values = np.stack([spectrum.eigenvalues, spectrum.eigenvalues**2], axis=1)
    by_function = spectral_signature(spectrum, lambda x: np.stack([x, x**2], axis=1))
    assert_allclose(spectral_signature(spectrum, values), by_function)
    assert_allclose(spectral_signature(spectrum, values)[:, 0], spectrum.eigenfunctions**2 @ spectrum.eigenvalues)


def test_anisotropic_signature_is_the_heat_that_stays_at_every_angle(mesh, family):
    times = anisotropic_heat_kernel_times(family, 5)[:, 2:]
    signature = anisotropic_heat_kernel_signature(family, times)
    assert signature.shape == (642, 5, 3)
    flow = HeatFlow(AnisotropicLaplacian(mesh, alpha=20.0))
    for channel in range(1, 5):
        stays = flow.autodiffusion(100, thetas=family.thetas[channel], times=times[channel])
        assert_allclose(signature[100, channel], stays[0], rtol=1e-4)


def test_anisotropic_times_are_shared_by_the_angles_of_one_alpha(family):
    times = anisotropic_heat_kernel_times(family, 8)
    assert_allclose(times[1:], np.tile(times[1], (4, 1)))
    assert (times[1] > times[0]).all()  # heat runs slower at α = 20


def test_anisotropic_times_end_where_heat_forgets_its_direction(family):
    times = anisotropic_heat_kernel_times(family, 8)
    last = np.log(family.eigenvalues[1:, -1]).mean()
    assert_allclose(times[1, 0], np.log(10) / np.exp(last))
    assert times[1, -1] <= 64.001 * times[1, 0]
    assert_allclose(np.diff(np.log(times)), np.log(times[:, -1:] / times[:, :1]) / 7 * np.ones((1, 7)))
    lowest = np.log(family.eigenvalues[:, 1])
    assert (np.log(times[1:, -1]) <= np.log(4 * np.log(10)) - lowest[1:].mean() + 1e-9).all()


def test_angular_contrast_is_the_logarithm_in_two_parts():
    values = np.random.default_rng(0).uniform(0.5, 2.0, size=(9, 5, 3))
    alphas = np.array([0.0, 20.0, 50.0, 50.0, 20.0])
    contrast = angular_contrast(values, alphas)
    assert contrast.shape == (9, 8, 3)
    assert_allclose(contrast[:, :5] + contrast[:, 5:][:, [0, 1, 2, 2, 1]], np.log(values))
    assert_allclose(contrast[:, 0], 0.0)
    assert_allclose(contrast[:, 2] + contrast[:, 3], 0.0, atol=1e-15)
    assert_allclose(angular_contrast(7.0 * values, alphas)[:, :5], contrast[:, :5])
    with pytest.raises(ParameterError, match=r"one of alphas for each channel, but they are \(9, 5, 3\) and \(4,\)"):
        angular_contrast(values, alphas[:4])
    with pytest.raises(ParameterError, match="values must be at least 0"):
        angular_contrast(-values, alphas)


def test_anisotropic_signatures_of_a_mirror_image_run_backwards(mesh, family):
    """One curve over θ is the reflection of the other, Figure 3: channel l of the mirror image is channel L − l."""
    mirror = TriangleMesh(mesh.vertices * [1, -1, 1], mesh.faces[:, ::-1])
    mirrored = compute_spectra(mirror, alphas=(0.0, 20.0), angles=4, count=60, workers=1, cache=False)
    times = anisotropic_heat_kernel_times(family, 4)
    here = anisotropic_heat_kernel_signature(family, times)
    there = anisotropic_heat_kernel_signature(mirrored, times)
    assert_allclose(there[:, [0, 1, 4, 3, 2]], here, rtol=1e-5)
    assert np.abs(there[:, 2] - here[:, 2]).max() > 1e-2 * here.max()


def test_splines_are_a_partition_of_unity_with_local_support():
    values = splines_at(np.linspace(0, 7, 200), count=20, reach=7.0)
    assert_allclose(values.sum(axis=1), 1)
    assert ((values > 0).sum(axis=1) <= 4).all()
    assert not splines_at(np.array([7.1]), count=20, reach=7.0).any()


def test_geometry_vectors_are_their_formula_and_rows_of_length_one(family):
    reach = np.full(5, 50.0)
    raw = geometry_vectors(family, count=12, reach=reach, normalize=False)
    spectrum = family[2]
    expected = spectrum.eigenfunctions**2 @ splines_at(spectrum.eigenvalues, count=12, reach=50.0)
    assert raw.shape == (642, 5, 12)
    assert_allclose(raw[:, 2], expected)
    unit = geometry_vectors(family, count=12, reach=reach)
    assert_allclose(np.linalg.norm(unit, axis=2), 1)
    assert_allclose(unit * np.linalg.norm(raw, axis=2, keepdims=True), raw)


def test_splines_reach_to_the_99th_percentile_of_each_alpha(family):
    reach = spline_reach([family, family])
    assert_allclose(reach[0], np.percentile(np.tile(family.eigenvalues[0], 2), 99))
    assert_allclose(reach[1:], np.percentile(np.tile(family.eigenvalues[1:], 2), 99))


def test_windowed_transform_is_the_product_with_its_atoms(spectrum):
    """Eq. (14) against eq. (15), built one atom at a time."""
    rng = np.random.default_rng(0)
    signal, window = rng.normal(size=642), heat_window(spectrum)
    phi = spectrum.eigenfunctions
    transform = windowed_fourier_transform(spectrum, signal, window=window)
    assert transform.shape == (642, 1, 60)
    for x, frequency in [(0, 0), (17, 5), (600, 59)]:
        atom = phi[:, frequency] * (phi @ (window * phi[x]))
        assert_allclose(transform[x, 0, frequency], spectrum.mass @ (signal * atom), rtol=1e-10)


def test_windowed_descriptor_does_not_see_the_signs_of_eigenfunctions(spectrum):
    signs = np.where(np.arange(60) % 3, 1.0, -1.0)
    flipped = type(spectrum)(spectrum.eigenvalues, spectrum.eigenfunctions * signs, spectrum.mass)
    signal = heat_kernel_signature(spectrum, [0.05, 0.5])
    one, two = (windowed_fourier_descriptor(s, signal, frequencies=10) for s in (spectrum, flipped))
    assert one.shape == (642, 2, 10)
    assert_allclose(one, two, atol=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s, f: wave_kernel_signature(s, [1.0], width=0.0), "width must be finite and greater than 0"),
        (lambda s, f: wave_kernel_signature(s, [np.nan], width=1.0), "energies must be a list of finite numbers"),
        (lambda s, f: spectral_signature(s, np.ones(3)), r"transfer must have one row for each of the 60 eigenvalues"),
        (lambda s, f: spectral_kernel(s, 642, np.ones(60)), "source must be from 0 to 641, but it is 642"),
        (lambda s, f: geometry_vectors(f, count=3), "count must be from 4 to 100000, but it is 3"),
        (lambda s, f: geometry_vectors(f, reach=[1.0]), "reach must have one number for each of the 5 channels"),
        (lambda s, f: anisotropic_heat_kernel_signature(f, np.ones((2, 3))), r"times must be \(T,\) or \(5, T\)"),
        (lambda s, f: windowed_fourier_transform(s, np.ones(3), window=np.ones(60)), "signals must be finite"),
        (lambda s, f: windowed_fourier_transform(s, np.ones(642), window=np.ones(3)), "window must be finite"),
    ],
)
def test_bad_arguments_are_explained(spectrum, family, call, message):
    with pytest.raises(ParameterError, match=message):
        call(spectrum, family)


def test_a_vertex_without_mass_has_zeros_and_nothing_is_nan():
    mesh = TriangleMesh(np.vstack([sphere(2).vertices, [9, 9, 9]]), sphere(2).faces)
    family = compute_spectra(mesh, alphas=(0.0, 5.0), angles=2, count=20, workers=1, cache=False)
    vectors = geometry_vectors(family, count=8)
    invariant = scale_invariant_heat_kernel_signature(family[0])
    assert not vectors[-1].any()
    assert not invariant[-1].any()
    assert np.isfinite(vectors).all()
    assert np.isfinite(invariant).all()


def test_slow_heat_is_no_standing_heat():
    """In a small unit α = 50 slows heat by many orders below the isotropic pace of the area: λ_1 is no zero for it."""
    tiny = ellipsoid(1e-9, 0.8e-9, 0.6e-9, subdivisions=2)
    slow = compute_spectrum(AnisotropicLaplacian(tiny, alpha=50.0), count=20)
    large = compute_spectrum(AnisotropicLaplacian(ellipsoid(1.0, 0.8, 0.6, subdivisions=2), alpha=50.0e9), count=20)
    assert_allclose(heat_kernel_times(slow, 5), heat_kernel_times(large, 5) * 1e-18, rtol=1e-6)


def test_zeros_of_another_solver_are_rounding(spectrum):
    """eigsh gives 1e-13 of either sign for the constant, which is no lowest frequency."""
    values = spectrum.eigenvalues.copy()
    values[0] = 1e-13
    assert heat_kernel_times(replace(spectrum, eigenvalues=values), 2)[1] == heat_kernel_times(spectrum, 2)[1]
    with pytest.raises(ParameterError, match="all are zero"):
        heat_kernel_times(replace(spectrum, eigenvalues=values[:1]), 2)
