"""Block Lanczos on matrices whose spectra are known to the last digit."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from add_core.eigensolver import lanczos
from add_core.eigensolver.lanczos import shift_invert_lanczos
from add_core.errors import ConvergenceError


def solve_with(spectrum, turn, shift):
    """(A − shift I)⁻¹ for A = turn diag(spectrum) turnᵀ."""
    return lambda right: turn @ ((turn.T @ right) / (spectrum - shift)[:, None])


def run(spectrum, count, *, shift, turn=None, tolerance=1e-8, most=None, **options):
    n = len(spectrum)
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((n, n)))[0] if turn is None else turn
    zeros = int((spectrum == 0).sum())
    pairs = shift_invert_lanczos(
        solve_with(spectrum, turn, shift),
        np.ascontiguousarray(turn[:, :zeros].T),
        count,
        shift=shift,
        first_check=2 * count,
        most=most or n - 40,
        tolerance=tolerance,
        floor=1e-6 * shift,
        **options,
    )
    return pairs, turn, zeros


def residuals(pairs, spectrum, turn):
    values, u = pairs.values[: pairs.vectors.shape[1]], pairs.vectors
    return np.linalg.norm(turn @ (spectrum[:, None] * (turn.T @ u)) - u * values, axis=0) / values


SPECTRUM = np.concatenate([[0.0, 0.0], np.sort(np.random.default_rng(1).uniform(1.0, 500.0, 498))])


@pytest.mark.parametrize("always", [False, True])
@pytest.mark.parametrize("block", [4, 12])
def test_the_smallest_eigenvalues_on_both_sides_of_the_shift_are_found(block, always):
    pairs, turn, zeros = run(SPECTRUM, 60, shift=0.6 * SPECTRUM[61], block=block, always=always)
    assert_allclose(pairs.values[:60], SPECTRUM[zeros : zeros + 60], rtol=1e-9)
    assert residuals(pairs, SPECTRUM, turn).max() < 1e-7
    assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(60), atol=1e-9)


def test_the_predicted_residual_is_the_real_one():
    pairs, turn, _ = run(SPECTRUM, 60, shift=0.6 * SPECTRUM[61], tolerance=1e-5)
    real = residuals(pairs, SPECTRUM, turn).max()
    assert 0.3 * pairs.estimate < real < 3 * pairs.estimate + 1e-10


def test_vectors_are_orthogonal_to_the_known_kernel():
    pairs, turn, zeros = run(SPECTRUM, 40, shift=0.6 * SPECTRUM[41])
    assert np.abs(turn[:, :zeros].T @ pairs.vectors).max() < 1e-9


def test_multiplicities_up_to_the_block_are_complete():
    spectrum = np.repeat(np.arange(50.0) * (np.arange(50.0) + 1), [1] + [9] * 49)
    pairs, _, _ = run(spectrum, 90, shift=0.6 * spectrum[91], block=12)
    assert_allclose(pairs.values[:90], spectrum[1:91], rtol=1e-9)


def test_skipping_passes_beside_an_eigenvalue_is_noticed_unless_its_vector_is_kept_out(monkeypatch):
    """One direction dominates every step: overlaps with it grow from rounding to 1e-6 within two blocks."""
    monkeypatch.setattr(lanczos, "NEAREST", 0)
    with pytest.raises(ConvergenceError, match="a shift too close to an eigenvalue"):
        run(SPECTRUM, 60, shift=SPECTRUM[40] * (1 + 1e-7))


def test_a_pass_that_came_late_makes_the_next_ones_come_sooner(monkeypatch):
    monkeypatch.setattr(lanczos, "NEAREST", 0)
    shift = SPECTRUM[100] * (1 + 1e-3)
    pairs, *_ = run(SPECTRUM, 150, shift=shift)
    assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(150), atol=1e-9)
    monkeypatch.setattr(lanczos, "CLOSE", 1.0)
    with pytest.raises(ConvergenceError, match="a shift too close to an eigenvalue"):
        run(SPECTRUM, 150, shift=shift)


@pytest.mark.parametrize("always", [False, True])
def test_a_shift_almost_on_an_eigenvalue_costs_no_accuracy(always):
    pairs, _, zeros = run(SPECTRUM, 60, shift=SPECTRUM[40] * (1 + 1e-7), always=always)
    assert_allclose(pairs.values[:60], SPECTRUM[zeros : zeros + 60], rtol=1e-6)
    assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(60), atol=1e-8)


def test_an_exhausted_krylov_space_is_filled_with_fresh_directions():
    """Two distinct eigenvalues: after two blocks of 4 every further direction is new only by chance."""
    spectrum = np.repeat([1.0, 3.0], [30, 170])
    pairs, turn, _ = run(spectrum, 30, shift=1.8, block=4)
    assert residuals(pairs, spectrum, turn).max() < 1e-8
    assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(30), atol=1e-9)


def test_a_basis_that_is_too_small_is_reported():
    with pytest.raises(ConvergenceError, match=r"Lanczos vectors reached .* where 1.0e-08 was asked for"):
        run(SPECTRUM, 60, shift=0.6 * SPECTRUM[61], most=70)


def test_the_same_seed_gives_the_same_bits():
    first, turn, _ = run(SPECTRUM, 30, shift=0.6 * SPECTRUM[31])
    second, _, _ = run(SPECTRUM, 30, shift=0.6 * SPECTRUM[31], turn=turn)
    assert np.array_equal(first.vectors, second.vectors)
