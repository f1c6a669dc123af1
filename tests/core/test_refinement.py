"""Verification of eigenpairs: bad ones are noticed, mended where that is possible, and never handed on."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse import csr_array

from add_core.eigensolver.factorisation import factorise_near
from add_core.eigensolver.fronts import FrontTree
from add_core.eigensolver.ordering import nested_dissection
from add_core.eigensolver.refinement import RESIDUAL, StandardPairs, failing, orient, repaired, residual_norms
from add_core.errors import ConvergenceError
from add_core.geometry.shapes import ellipsoid
from add_core.operators import AnisotropicLaplacian

COUNT = 40


@pytest.fixture(scope="module")
def problem():
    """A of an ellipsoid, its kernel row, and its exact pairs beside the kernel, from LAPACK, in the tree's order."""
    laplacian = AnisotropicLaplacian(ellipsoid(1.0, 0.8, 0.5, subdivisions=3), alpha=5.0)
    root = np.sqrt(laplacian.mass)
    dense = laplacian.stiffness(0.3).toarray() / np.outer(root, root)
    matrix = csr_array(dense)
    values, vectors = np.linalg.eigh(dense)
    tree = FrontTree.of(matrix.indptr, matrix.indices, nested_dissection(matrix.indptr, matrix.indices))
    factors = factorise_near(tree, matrix.data, 0.6 * values[COUNT])
    order = tree.dissection.permutation
    return factors.matrix, factors, (root / np.linalg.norm(root))[None, order], values[1:], vectors[order, 1:]


def spoilt(problem, index: int, amount: float) -> StandardPairs:
    """The exact pairs, but `amount` of a higher eigenvector mixed into number `index`."""
    _, _, _, values, vectors = problem
    mixed = vectors[:, :COUNT].copy()
    mixed[:, index] = np.sqrt(1 - amount**2) * mixed[:, index] + amount * vectors[:, COUNT + 3]
    return StandardPairs(values[:COUNT], mixed)


def test_residuals_are_those_of_the_eigenvalue_equation(problem):
    matrix, _, _, values, _ = problem
    norms = residual_norms(matrix, spoilt(problem, 7, 1e-3))
    assert norms[7] == pytest.approx(1e-3 * (values[COUNT + 3] - values[7]), rel=1e-6)
    assert np.delete(norms, 7).max() < 1e-10 * values[COUNT]


def test_only_the_bad_pair_fails(problem):
    assert_array_equal(np.flatnonzero(failing(problem[0], spoilt(problem, 7, 1e-3))), [7])


@pytest.mark.parametrize("index", [0, 5, 15])
def test_a_bad_low_pair_is_mended(problem, index):
    matrix, factors, kernel, values, _ = problem
    pairs = repaired(factors, kernel, spoilt(problem, index, 1e-5))
    assert_allclose(pairs.values, values[:COUNT], rtol=1e-9)
    assert (residual_norms(matrix, pairs) <= RESIDUAL * pairs.values).all()
    assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(COUNT), atol=1e-8)


def test_a_bad_high_pair_is_refused(problem):
    _, factors, kernel, _, _ = problem
    with pytest.raises(ConvergenceError, match="1 of 40 eigenpairs miss a residual of 1e-06"):
        repaired(factors, kernel, spoilt(problem, 35, 0.1))


def test_good_pairs_are_handed_on_as_they_are(problem):
    _, factors, kernel, values, vectors = problem
    pairs = StandardPairs(values[:COUNT], vectors[:, :COUNT])
    assert repaired(factors, kernel, pairs) is pairs


def test_vectors_that_are_not_quite_orthonormal_are_made_so(problem):
    _, factors, kernel, values, vectors = problem
    skew = vectors[:, :COUNT].copy()
    skew[:, 20] += 1e-8 * skew[:, 21]
    pairs = repaired(factors, kernel, StandardPairs(values[:COUNT], skew))
    assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(COUNT), atol=1e-13)


def test_signs_do_not_depend_on_the_sign_given():
    functions = np.random.default_rng(0).standard_normal((300, 20))
    flipped = functions * np.where(np.arange(20) % 3 == 0, -1.0, 1.0)
    orient(functions)
    orient(flipped)
    assert_array_equal(functions, flipped)


def test_a_column_of_zeros_stays_so():
    functions = np.zeros((5, 2))
    orient(functions)
    assert not functions.any()
