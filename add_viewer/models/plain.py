"""Frozen dataclasses of numbers and words as plain data for JSON, and back with every value checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, fields, is_dataclass
from math import isfinite
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

from add_core.errors import AddError

Record = TypeVar("Record")


class PlainDataError(AddError, ValueError):
    """A value in a file is not what it must be; the message names it."""


def to_plain(record: Any) -> dict[str, Any]:
    """A dataclass of numbers, words and tuples of them as a dictionary."""
    return asdict(record)


def from_plain(kind: type[Record], data: object, where: str) -> Record:
    """A dataclass from a dictionary: what is missing has its default, what is unknown is left out.

    where : how a message names this place in the file, "" for the whole of it.
    Raises PlainDataError for a value that does not fit.
    """
    if not isinstance(data, Mapping):
        raise PlainDataError(f"{where or 'it'} must be an object with names and values, but it is {_shown(data)}.")
    hints, before = get_type_hints(kind), f"{where}." if where else ""
    known = {each.name for each in fields(kind)}  # type: ignore[arg-type]
    values = {name: _checked(hints[name], value, before + name) for name, value in data.items() if name in known}
    try:
        return kind(**values)
    except TypeError as error:  # a value without a default is missing
        raise PlainDataError(
            f"{where or 'it'} is incomplete: {str(error).partition('argument')[2].strip(': ')}."
        ) from None


def _checked(hint: Any, value: object, where: str) -> Any:
    origin, options = get_origin(hint), get_args(hint)
    if origin is Literal:
        if value not in options:
            raise PlainDataError(f"{where} must be one of {', '.join(map(repr, options))}, but it is {_shown(value)}.")
        return value
    if origin in (Union, UnionType):
        chosen = next(option for option in options if option is not NoneType)
        return None if value is None else _checked(chosen, value, where)
    if origin is tuple:
        return _checked_tuple(options, value, where)
    if is_dataclass(hint):
        return from_plain(hint, value, where)  # type: ignore[arg-type]
    return _checked_value(hint, value, where)


def _checked_tuple(options: tuple[Any, ...], value: object, where: str) -> tuple[Any, ...]:
    if not isinstance(value, list) or (options[-1] is not Ellipsis and len(value) != len(options)):
        wanted = "a list" if options[-1] is Ellipsis else f"a list of {len(options)}"
        raise PlainDataError(f"{where} must be {wanted}, but it is {_shown(value)}.")
    return tuple(_checked(options[0], each, f"{where}[{index}]") for index, each in enumerate(value))


def _checked_value(hint: type, value: object, where: str) -> Any:
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
    if hint is float and is_number:
        return float(value)  # type: ignore[arg-type]
    if (hint is int and is_number and isinstance(value, int)) or (hint in (bool, str) and isinstance(value, hint)):
        return value
    words = {float: "a number", int: "a whole number", bool: "true or false", str: "a text"}
    raise PlainDataError(f"{where} must be {words[hint]}, but it is {_shown(value)}.")


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"
