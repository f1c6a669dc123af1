"""Anisotropic Diffusion Descriptors: the headless core.

`geometry` and `io` hold shapes, `operators` the anisotropic Laplacian of eq. (8), `spectra` its eigenfunctions and
heat, `eigensolver` how they are computed, `descriptors` the signatures built from them, `correspondence` and
`evaluation` what they are good for, `learning` the networks. NOTATION.md beside this file lists symbols, units and
signs.
"""

__version__ = "0.1.0"
