"""The heat kernel signature against its formula and its limits."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.descriptors import heat_kernel_signature, heat_kernel_times
from add_core.errors import ParameterError
from add_core.geometry.shapes import sphere
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import HeatFlow, compute_spectrum


@pytest.fixture(scope="module")
def laplacian():
    return AnisotropicLaplacian(sphere(2), alpha=0.0)


def test_all_eigenfunctions_give_the_heat_that_stays(laplacian):
    spectrum = compute_spectrum(laplacian, count=162)
    signature = heat_kernel_signature(spectrum, [0.05, 0.5])
    stays = HeatFlow(laplacian).autodiffusion(7, thetas=0.0, times=[0.05, 0.5])[0]
    assert signature.shape == (162, 2)
    assert_allclose(signature[7], stays, rtol=1e-5)


def test_its_mass_weighted_sum_is_the_heat_trace(laplacian):
    spectrum = compute_spectrum(laplacian, count=30)
    signature = heat_kernel_signature(spectrum, [0.1, 1.0])
    assert_allclose(laplacian.mass @ signature, np.exp(-np.outer([0.1, 1.0], spectrum.eigenvalues)).sum(axis=1))


def test_in_the_end_heat_is_everywhere_the_same(laplacian):
    signature = heat_kernel_signature(compute_spectrum(laplacian, count=10), 100.0)
    assert_allclose(signature[:, 0], 1 / laplacian.mass.sum(), rtol=1e-8)


def test_default_times_span_the_spectrum(laplacian):
    spectrum = compute_spectrum(laplacian, count=30)
    times = heat_kernel_times(spectrum, 16)
    assert_allclose(times[[0, -1]], 4 * np.log(10) / spectrum.eigenvalues[[-1, 1]])
    assert_allclose(times[1:] / times[:-1], times[1] / times[0])
    with pytest.raises(ParameterError, match="non-zero eigenvalue"):
        heat_kernel_times(compute_spectrum(laplacian, count=1))


def test_times_must_be_positive(laplacian):
    with pytest.raises(ParameterError, match=r"times must be finite and greater than 0, but number 1 is 0\.0"):
        heat_kernel_signature(compute_spectrum(laplacian, count=5), [1.0, 0.0])
