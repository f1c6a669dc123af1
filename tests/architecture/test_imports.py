"""What `import` loads. Directions of import are import-linter's business (`make check`); this is about weight."""

import subprocess
import sys
from importlib.util import find_spec

import pytest

HEAVY = ["torch", "trimesh", "matplotlib", "vtk", "vtkmodules", "pyvista", "pyvistaqt", "PySide6", "add_viewer"]
LIGHT_PARTS = ["add_core", "add_core.geometry", "add_core.operators", "add_core.spectra", "add_core.descriptors"]


def loaded_by(statement: str) -> set[str]:
    """Top-level names of the modules that a fresh interpreter holds after `statement`."""
    return {name.partition(".")[0] for name in modules_after(statement)}


def modules_after(statement: str) -> set[str]:
    script = f"{statement}\nimport sys; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stderr
    return set(run.stdout.split())


@pytest.mark.parametrize("part", LIGHT_PARTS)
def test_the_numerical_core_starts_light(part):
    """Half a second to import, because what is slow to load is loaded where it is used."""
    assert loaded_by(f"import {part}").isdisjoint(HEAVY)


def test_a_process_that_only_solves_loads_nothing_about_shapes():
    """Every worker of a family pays for its imports, a third of which were frames, neighbours and their SciPy parts."""
    loaded = modules_after("import add_core.eigensolver.worker")
    ours = {".".join(name.split(".")[:2]) for name in loaded if name.startswith("add_core.")}
    assert ours == {"add_core.eigensolver", "add_core._check", "add_core.errors"}
    assert loaded.isdisjoint({"scipy.spatial", "scipy.special", "scipy.interpolate", "scipy.optimize"})


def test_reading_shapes_loads_its_readers_when_a_file_is_opened():
    assert loaded_by("import add_core.io").isdisjoint(HEAVY)


@pytest.mark.parametrize("part", ["models", "controllers"])
def test_state_and_behaviour_of_the_viewer_need_no_window_system(part):
    loaded = loaded_by(f"import add_viewer.{part}")
    assert loaded.isdisjoint({"PySide6", "qtpy", "vtkmodules", "pyvista", "pyvistaqt"})


@pytest.mark.parametrize("name", HEAVY)
def test_what_must_not_be_loaded_could_have_been(name):
    """Otherwise the tests above would pass because nothing is installed."""
    assert find_spec(name) is not None
