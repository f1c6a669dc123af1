"""Every error that the core raises on purpose."""


class AddError(Exception):
    """A mistake that the caller can mend; its message says what was expected, what was found and what to do."""


class GeometryError(AddError, ValueError):
    """A shape, or an array that describes one, cannot be used as it is."""


class ParameterError(AddError, ValueError):
    """A parameter of a method lies outside its range."""


class ShapeFileError(AddError, ValueError):
    """A file does not hold a shape that can be read, or a shape cannot be written to it."""


class ConvergenceError(AddError, ArithmeticError):
    """A numerical method did not reach the accuracy that it promises."""


class Cancelled(AddError):
    """A caller's `progress` function asked to stop."""
