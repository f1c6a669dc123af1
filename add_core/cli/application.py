"""The program around the commands: finding them, and ending with a status and one line instead of a traceback."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

import click

from .. import __version__
from ..errors import AddError, Cancelled
from .stopping import ending_in_order

COMMANDS = ("info", "kernel", "spectra", "describe", "match", "symmetry", "evaluate", "train", "figures", "cache")
"""Each is a module of this package with a click command named `command`."""

OPTIONAL = {
    "torch": "torch safetensors",
    "safetensors": "safetensors",
    "matplotlib": "matplotlib",
    "sklearn": "scikit-learn",
}
"""Modules that not every installation has, and what to install for them."""

SUCCESS, FAILURE, MISTAKE, INTERRUPTED = 0, 1, 2, 130


class _Commands(click.Group):
    """Imports a command's module when it is asked for: `info` does not wait for what `train` needs."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f".{cmd_name}", __package__).command
        return command


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="add-core", message="%(prog)s %(version)s")
@click.option("-v", "--verbose", is_flag=True, help="Say what is done along the way.")
def application(verbose: bool) -> None:
    """Anisotropic diffusion descriptors of shapes.

    A shape is a file (OFF, OBJ, PLY, STL, VTP, VTK, GLB, XYZ, NPZ) or one that ships with the program: humans/0 to
    humans/99, poses/0 to poses/70, dogs/0 to dogs/39.
    """
    logging.basicConfig(level=logging.INFO if verbose else logging.WARNING, format="add-core: %(message)s")


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run `add-core` with `arguments`, the program's own by default, and exit.

    Status 0: done. 1: it failed, though nothing was wrong with the request. 2: a mistake in the request or in a file,
    explained in one line. 130: interrupted.
    """
    sys.exit(_run(None if arguments is None else list(arguments)))


def complain(message: object) -> None:
    """One line on stderr."""
    click.echo(f"add-core: {' '.join(str(message).split())}", err=True)


def _run(arguments: list[str] | None) -> int:
    try:
        with ending_in_order():
            status = application.main(arguments, prog_name="add-core", standalone_mode=False)
        return status if isinstance(status, int) else SUCCESS
    except click.exceptions.NoArgsIsHelpError as request:
        click.echo(request.ctx.get_help() if request.ctx else "", err=True)
        return MISTAKE
    except click.ClickException as error:
        complain(f"{error.format_message()} Try {_path_of(error)} --help.")
        return MISTAKE
    except Cancelled as error:
        complain(error)
        return INTERRUPTED
    except AddError as error:
        complain(error)
        return MISTAKE
    except (KeyboardInterrupt, click.Abort):
        complain("interrupted.")
        return INTERRUPTED
    except ModuleNotFoundError as error:
        if error.name not in OPTIONAL:
            raise
        complain(f"this needs {error.name}, which is not installed. Run: pip install {OPTIONAL[error.name]}")
        return MISTAKE
    except MemoryError:
        complain("there is not enough memory for this.")
        return FAILURE
    except BrokenPipeError:
        # The reader of our output has gone, e.g. `head`. Python would complain about it once more at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILURE


def _path_of(error: click.ClickException) -> str:
    context = getattr(error, "ctx", None)
    return context.command_path if context is not None else "add-core"
