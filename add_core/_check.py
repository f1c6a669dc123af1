"""The one place that words complaints about arguments: what was expected, what was found, what to do."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import AddError, GeometryError, ParameterError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
_LARGEST = 1e60
_AnyArray = TypeVar("_AnyArray", bound="np.ndarray[Any, Any]")


def read_only(array: _AnyArray) -> _AnyArray:
    """Mark `array` immutable and return it."""
    array.setflags(write=False)
    return array


def instance_of(name: str, value: object, *kinds: type, remedy: str = "") -> None:
    """Raise ParameterError unless `value` is one of `kinds`."""
    if not isinstance(value, kinds):
        wanted = " or ".join(_with_article(kind.__name__) for kind in kinds)
        raise ParameterError(f"{name} must be {wanted}, but it is {_kind_of(value)}.{remedy and ' '}{remedy}")


def array_of(name: str, value: object, *, error: type[AddError] = ParameterError) -> np.ndarray[Any, Any]:
    """`value` as an array of whatever it holds."""
    try:
        return np.asarray(value)
    except ValueError:
        raise error(f"{name} must be an array, but its rows differ in length. Pad or split them.") from None


def numbers(name: str, value: object, *, error: type[AddError] = ParameterError) -> FloatArray:
    """`value` as float64 of any shape, not copied if it is that already; text and complex numbers are refused."""
    raw = array_of(name, value, error=error)
    try:
        if raw.dtype.kind in "biufO":  # NumPy would read numbers in text, and drop imaginary parts with a warning
            return np.asarray(raw, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    raise error(f"{name} must hold real numbers, but it holds {_kind_of(raw.flat[0]) if raw.size else raw.dtype}.")


def points_array(name: str, value: ArrayLike, *, least: int = 1) -> FloatArray:
    """`value` as a read-only float64 copy of shape (n, 3), n ≥ `least`, all finite."""
    array = numbers(name, value, error=GeometryError).copy()
    if array.ndim != 2 or array.shape[1] != 3:
        raise GeometryError(f"{name} must have shape (n, 3), but it has {array.shape}.")
    if len(array) < least:
        raise GeometryError(f"{name} must hold at least {least} point{'s' * (least > 1)}, but it holds {len(array)}.")
    bad = ~np.isfinite(array).all(axis=1)
    if bad.any():
        raise GeometryError(
            f"{bad.sum()} of {len(array)} {name} {'are' if bad.sum() > 1 else 'is'} not finite "
            f"(first: {np.argmax(bad)}). Remove or repair them first."
        )
    if np.abs(array).max() > _LARGEST:
        raise GeometryError(f"{name} must be smaller than {_LARGEST:g}, or areas overflow. Choose a larger unit.")
    return read_only(array)


def positions_array(name: str, value: ArrayLike, *, least: int = 1) -> FloatArray:
    """`points_array` of points that lie in one place or so far apart that squares of areas can be told from zero."""
    array = points_array(name, value, least=least)
    if 0 < np.ptp(array, axis=0).max() < 1 / _LARGEST:
        raise GeometryError(f"{name} must span {1 / _LARGEST:g} or more, or areas vanish. Choose a smaller unit.")
    return array


def faces_array(value: ArrayLike, vertex_count: int) -> IntArray:
    """`value` as a read-only int64 copy of shape (m, 3) that indexes into `vertex_count` vertices."""
    raw = array_of("faces", value, error=GeometryError)
    if raw.ndim != 2 or raw.shape[1] != 3:
        quads = " Split quads into triangles first." if raw.ndim == 2 and raw.shape[1] == 4 else ""
        raise GeometryError(f"faces must have shape (m, 3), but it has {raw.shape}.{quads}")
    if len(raw) == 0:
        raise GeometryError("faces must hold at least one triangle, but it is empty. Open mere points as a PointCloud.")
    if raw.dtype.kind not in "iu":
        raise GeometryError(f"faces must hold integers, but it holds {raw.dtype}.")
    array = np.array(raw, dtype=np.int64)
    low, high = int(array.min()), int(array.max())
    if low < 0 or high >= vertex_count:
        hint = " Are they 1-based?" if low == 1 and high == vertex_count else ""
        raise GeometryError(
            f"faces must index into {vertex_count} vertices (0 to {vertex_count - 1}), "
            f"but they range from {low} to {high}.{hint}"
        )
    return read_only(array)


def vertex_index(name: str, value: Any, vertex_count: int) -> int:
    """`value` as an index of one of `vertex_count` vertices."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer):
        raise ParameterError(f"{name} must be a vertex number, but it is {value!r}.")
    if not 0 <= value < vertex_count:
        raise ParameterError(f"{name} must be from 0 to {vertex_count - 1}, but it is {value}.")
    return int(value)


def count_in(name: str, value: Any, low: int, high: int) -> int:
    """`value` as a whole number from `low` to `high`."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer):
        raise ParameterError(f"{name} must be a whole number, but it is {value!r}.")
    if not low <= value <= high:
        raise ParameterError(f"{name} must be from {low} to {high}, but it is {value}.")
    return int(value)


def finite(name: str, value: Any) -> float:
    """`value` as a finite number."""
    return _number(name, value, "finite", lambda x: True)


def at_least_zero(name: str, value: Any) -> float:
    """`value` as a finite number ≥ 0."""
    return _number(name, value, "finite and at least 0", lambda x: x >= 0)


def positive(name: str, value: Any) -> float:
    """`value` as a finite number > 0."""
    return _number(name, value, "finite and greater than 0", lambda x: x > 0)


def positive_array(name: str, value: ArrayLike) -> FloatArray:
    """`value` as a non-empty one-dimensional array of finite numbers > 0."""
    array = np.atleast_1d(numbers(name, value))
    if array.ndim != 1 or array.size == 0:
        raise ParameterError(f"{name} must be a list of numbers, but it has shape {array.shape}.")
    bad = ~(np.isfinite(array) & (array > 0))
    if bad.any():
        first = int(np.argmax(bad))
        raise ParameterError(f"{name} must be finite and greater than 0, but number {first} is {array[first]}.")
    return array


def one_of(name: str, value: Any, choices: tuple[str, ...]) -> str:
    """`value` if it is one of `choices`."""
    if not isinstance(value, str) or value not in choices:
        raise ParameterError(f"{name} must be one of {', '.join(map(repr, choices))}, but it is {value!r}.")
    return str(value)


def _kind_of(value: object) -> str:
    return "None" if value is None else _with_article(type(value).__name__)


def _with_article(name: str) -> str:
    return f"{'an' if name[0] in 'AEIOaeio' else 'a'} {name}"


def _number(name: str, value: Any, expectation: str, holds: Any) -> float:
    try:
        if isinstance(value, str | bytes):
            raise TypeError
        number = float(value)
    except (TypeError, ValueError):
        raise ParameterError(f"{name} must be a number, but it is {value!r}.") from None
    if not np.isfinite(number) or not holds(number):
        raise ParameterError(f"{name} must be {expectation}, but it is {value}.")
    return number


def descriptor_array(name: str, value: ArrayLike, *, width: int | None = None) -> FloatArray:
    """`value` as float64 of shape (n, d), one row a point, all finite; d = `width` where that is given."""
    array = np.ascontiguousarray(numbers(name, value))
    if array.ndim != 2 or 0 in array.shape:
        raise ParameterError(f"{name} must have shape (n, d), a row for each point, but it has {array.shape}.")
    if width is not None and array.shape[1] != width:
        raise ParameterError(f"{name} must have {width} numbers a point like the others, but it has {array.shape[1]}.")
    bad = ~np.isfinite(array).all(axis=1)
    if bad.any():
        raise ParameterError(
            f"{name} must be finite, but {bad.sum()} of {len(array)} rows are not (first: {np.argmax(bad)})."
        )
    return array


def index_array(name: str, value: ArrayLike, limit: int, *, count: int | None = None, least: int = 0) -> IntArray:
    """`value` as int64 of shape (count,), each from `least` to `limit` − 1."""
    array = array_of(name, value)
    if array.ndim != 1 or (count is not None and len(array) != count):
        raise ParameterError(f"{name} must have shape ({'n' if count is None else count},), but it has {array.shape}.")
    if array.dtype.kind not in "iu":
        raise ParameterError(f"{name} must hold integers, but it holds {array.dtype}.")
    if array.size and (array.min() < least or array.max() >= limit):
        raise ParameterError(
            f"{name} must be from {least} to {limit - 1}, but it ranges from {array.min()} to {array.max()}."
        )
    return array.astype(np.int64)
