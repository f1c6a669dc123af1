"""Signatures of points, from the spectra of their shapes."""

from .heat import heat_kernel_signature, heat_kernel_times

__all__ = ["heat_kernel_signature", "heat_kernel_times"]
