"""Multifrontal factorisations against dense solutions and dense eigenvalue counts."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse import csr_array, diags_array

from add_core.eigensolver import factorisation
from add_core.eigensolver.factorisation import factorise, factorise_near
from add_core.eigensolver.fronts import FrontTree
from add_core.eigensolver.ordering import nested_dissection
from add_core.errors import ConvergenceError
from add_core.geometry.shapes import rectangle, sphere
from add_core.operators import AnisotropicLaplacian


def standard_form(shape, *, alpha=20.0, theta=0.4) -> csr_array:
    laplacian = AnisotropicLaplacian(shape, alpha=alpha, conductivity="constant")
    scaling = diags_array(1 / np.sqrt(laplacian.mass))
    pattern = laplacian.pattern
    matrix = pattern.matrix(laplacian.stiffness_values(theta).copy())
    rows = np.repeat(np.arange(pattern.vertex_count), np.diff(pattern.indptr))
    matrix.data *= scaling.diagonal()[rows] * scaling.diagonal()[pattern.indices]
    return matrix


def tree_of(matrix: csr_array) -> FrontTree:
    return FrontTree.of(matrix.indptr, matrix.indices, nested_dissection(matrix.indptr, matrix.indices))


@pytest.fixture(scope="module")
def ball() -> tuple[csr_array, FrontTree, np.ndarray]:
    matrix = standard_form(sphere(3))
    return matrix, tree_of(matrix), np.linalg.eigvalsh(matrix.toarray())


@pytest.mark.parametrize("share", [-0.01, 0.1, 0.5, 2.0])
def test_solutions_equal_dense_ones_for_shifts_below_and_inside_the_spectrum(ball, share):
    matrix, tree, spectrum = ball
    shift = share * spectrum[100]
    order = tree.dissection.permutation
    right = np.random.default_rng(0).standard_normal((tree.size, 7))
    solution = np.empty_like(right)
    solution[order] = factorise_near(tree, matrix.data, shift).solve(right[order])
    expected = np.linalg.solve(matrix.toarray() - shift * np.eye(tree.size), right)
    assert_allclose(solution, expected, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("index", [1, 5, 60, 300, 641])
def test_inertia_counts_the_eigenvalues_below_a_shift(ball, index):
    matrix, tree, spectrum = ball
    gaps = np.diff(spectrum)
    index += int(np.argmax(gaps[index - 1 : index + 12]))  # between two clusters of the sphere
    shift = 0.5 * (spectrum[index - 1] + spectrum[index])
    assert factorise(tree, matrix.data, shift, count=True).negatives == index


def test_one_symbolic_analysis_serves_every_operator_on_the_pattern():
    shape = rectangle(2.0, 1.0, n=12)
    tree = tree_of(standard_form(shape))
    for theta in (0.0, 1.1, 2.5):
        matrix = standard_form(shape, theta=theta)
        right = np.ones((tree.size, 1))
        order = tree.dissection.permutation
        x = np.empty_like(right)
        x[order] = factorise(tree, matrix.data, -1.0).solve(right[order])
        assert_allclose(matrix @ x + x, right, atol=1e-9)


def test_a_matrix_smaller_than_a_leaf_is_one_front():
    matrix = csr_array(np.array([[2.0, -1.0], [-1.0, 2.0]]))
    tree = tree_of(matrix)
    factors = factorise(tree, matrix.data, 1.5, count=True)
    order = tree.dissection.permutation
    x = np.empty((2, 1))
    x[order] = factors.solve(np.array([[1.0], [0.0]])[order])
    assert_allclose(x[:, 0], np.linalg.solve([[0.5, -1.0], [-1.0, 0.5]], [1.0, 0.0]))
    assert factors.negatives == 1


def test_a_shift_on_an_eigenvalue_of_a_front_moves_aside():
    """A diagonal matrix is all fronts and no couplings: at one of its entries a pivot block is exactly singular."""
    values = np.arange(1.0, 301.0)
    matrix = csr_array((values, np.arange(300), np.arange(301)), shape=(300, 300))
    factors = factorise_near(tree_of(matrix), matrix.data, 150.0)
    assert factors.shift != 150.0
    assert factors.shift == pytest.approx(150.0, rel=0.041)


def test_a_hopeless_matrix_is_refused(ball, monkeypatch):
    matrix, tree, spectrum = ball
    monkeypatch.setattr(factorisation, "SOLVE_TOLERANCE", 0.0)
    monkeypatch.setattr(factorisation, "ROUNDING", 0.0)
    with pytest.raises(ConvergenceError, match=r"No shift within 4 % of .* gives an accurate factorisation"):
        factorise_near(tree, matrix.data, spectrum[50] * 1.01)


def test_refinement_makes_every_entry_accurate_where_slivers_spread_the_scale():
    """Entries over twelve orders of magnitude: the plain solve loses digits here and there, refinement returns them."""
    matrix = standard_form(sphere(3))
    scale = np.where(np.arange(642) % 50 == 0, 1e6, 1.0)
    rows = np.repeat(np.arange(642), np.diff(matrix.indptr))
    matrix.data *= scale[rows] * scale[matrix.indices]
    tree = tree_of(matrix)
    right = np.random.default_rng(0).standard_normal((642, 1))
    plain = factorise(tree, matrix.data, 3.0)

    def worst(factors):
        x = factors.solve(right)
        size = abs(factors.matrix) @ np.abs(x) + 3.0 * np.abs(x) + np.abs(right)
        return (np.abs(factors.matrix @ x - 3.0 * x - right) / size).max()

    assert worst(plain.refining()) < 1e-14
    assert worst(plain.refining()) < worst(plain)
