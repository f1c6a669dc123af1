"""What was computed for the session, and what is happening: shown, never saved, never undone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from psygnal import Signal

from .diffusion import Diffusion
from .fields import ShapeField
from .picks import Pick

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class KernelField:
    """A heat kernel on one shape.

    columns : (P, n) h(pick, ·) of each pick, unit 1/length².
    diffusion, time : what it was computed for; time in length².
    """

    shape: str
    columns: FloatArray
    diffusion: Diffusion
    time: float
    picks: tuple[Pick, ...]

    @cached_property
    def values(self) -> FloatArray:
        """(n,) the heat of all picks together, unit 1/length²."""
        total: FloatArray = self.columns.sum(axis=0)
        return total

    @cached_property
    def shares(self) -> FloatArray:
        """(n,) in [0, 1]: the largest of the kernels, each divided by its own maximum: none outshines another."""
        tops = np.maximum(self.columns.max(axis=1, keepdims=True), np.finfo(np.float64).tiny)
        largest: FloatArray = (self.columns / tops).max(axis=0)
        return largest


@dataclass(frozen=True, eq=False)
class AutodiffusionCurves:
    """h(x, x) of one picked point over angles and times: its anisotropic heat kernel signature.

    thetas : (L,) ascending, radians; fewer while the computation runs.
    reaches : (T,) t·λ₁, ascending; time is reach / λ₁ of the operator with this α.
    values : (L, T), unit 1/length².
    weyl_eigenvalue : λ₁ of this operator; times are reaches / λ₁.
    isotropic : (T,) the heat kernel signature (α = 0) at the same reaches, or None while it is not computed yet.
    isotropic_weyl_eigenvalue : λ₁ at α = 0.
    expected : L once everything is computed.
    """

    pick: Pick
    thetas: FloatArray
    reaches: FloatArray
    values: FloatArray
    weyl_eigenvalue: float = 1.0
    isotropic: FloatArray | None = None
    isotropic_weyl_eigenvalue: float = 1.0
    expected: int = 0

    @property
    def times(self) -> FloatArray:
        """(T,) diffusion times, unit length²."""
        return self.reaches / self.weyl_eigenvalue

    @property
    def is_complete(self) -> bool:
        return len(self.thetas) == self.expected and self.isotropic is not None


@dataclass(frozen=True, eq=False)
class DirectionField:
    """Where the axes of maximum curvature point, at places spread evenly over one shape.

    positions, normals, max_directions : (s, 3); normals and directions unit, tangent and orthogonal to each other.
    spacing : typical distance between neighbouring places.
    """

    shape: str
    positions: FloatArray
    normals: FloatArray
    max_directions: FloatArray
    spacing: float


@dataclass(frozen=True)
class Notice:
    """A message to the person: what happened, why, and what to do."""

    text: str
    kind: str = "error"


class Results:
    """Latest answers of the core. None where nothing is known.

    kernel : heat on the active shape. fields : what each view draws, by panel (0, or 1 in a split view) and shape.
    carried : the active shape's picks on the other shapes. maps : by source and target, the source vertex of each
        target vertex as the chosen matching found it.
    """

    kernel_changed = Signal()
    fields_changed = Signal(int, str)
    carried_changed = Signal()
    maps_changed = Signal()
    curves_changed = Signal()
    directions_changed = Signal()
    scale_changed = Signal()
    busy_changed = Signal()
    noticed = Signal(Notice)

    def __init__(self) -> None:
        self.kernel: KernelField | None = None
        self.fields: dict[tuple[int, str], ShapeField] = {}
        self.carried: dict[str, tuple[Pick, ...]] = {}
        self.maps: dict[tuple[str, str], IntArray] = {}
        self.curves: tuple[AutodiffusionCurves, ...] = ()
        self.directions: dict[str, DirectionField] = {}
        self.weyl_eigenvalue: float | None = None
        self.busy: str = ""
        self.progress: float | None = None

    def set_kernel(self, kernel: KernelField | None) -> None:
        if kernel is not self.kernel:
            self.kernel = kernel
            self.kernel_changed.emit()

    def set_field(self, panel: int, shape: str, field: ShapeField | None) -> None:
        """Draw `field` on that shape in that panel; None is bare skin."""
        if field is not self.fields.get((panel, shape)):
            if field is None:
                del self.fields[panel, shape]
            else:
                self.fields[panel, shape] = field
            self.fields_changed.emit(panel, shape)

    def set_carried(self, carried: dict[str, tuple[Pick, ...]]) -> None:
        """Where the active shape's picks lie on other shapes."""
        if carried != self.carried:
            self.carried = carried
            self.carried_changed.emit()

    def set_map(self, source: str, target: str, match: IntArray | None) -> None:
        """`match` (n_target,): the source vertex of each target vertex; None forgets it."""
        if match is not self.maps.get((source, target)):
            if match is None:
                del self.maps[source, target]
            else:
                self.maps[source, target] = match
            self.maps_changed.emit()

    def set_curves(self, curves: tuple[AutodiffusionCurves, ...]) -> None:
        if curves or self.curves:
            self.curves = curves
            self.curves_changed.emit()

    def set_directions(self, directions: DirectionField) -> None:
        self.directions[directions.shape] = directions
        self.directions_changed.emit()

    def keep_directions(self, shapes: set[str]) -> None:
        """Forget the direction fields of other shapes."""
        self.directions = {key: field for key, field in self.directions.items() if key in shapes}

    def set_weyl_eigenvalue(self, value: float | None) -> None:
        """λ₁ of the current operator by Weyl's law, unit 1/length²; t = reach / λ₁."""
        if value != self.weyl_eigenvalue:
            self.weyl_eigenvalue = value
            self.scale_changed.emit()

    def set_busy(self, text: str, progress: float | None = None) -> None:
        """Say what is being computed ("" for nothing) and which share of it is done."""
        if (text, progress) != (self.busy, self.progress):
            self.busy, self.progress = text, progress
            self.busy_changed.emit()

    def report(self, error: BaseException | str) -> None:
        """Tell the person about a failure."""
        self.noticed.emit(Notice(str(error)))
