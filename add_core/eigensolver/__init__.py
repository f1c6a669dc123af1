"""Eigenpairs of one sparse symmetric pencil after another: nothing here knows of shapes, so that a process that only
solves starts quickly.
"""

from .solver import Eigenpairs, PencilSolver

__all__ = ["Eigenpairs", "PencilSolver"]
