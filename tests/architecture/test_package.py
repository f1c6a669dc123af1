"""What an installed wheel holds: the same shapes and resources as a checkout, and nothing that only developers need."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Path:
    """A folder that holds what a wheel of this checkout would put into site-packages."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True, timeout=120)
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site-packages")
    return folder / "site-packages"


def run(installed: Path, script: str) -> str:
    """What `script` prints when the wheel, and not the checkout, is what `import` finds."""
    environment = os.environ | {"PYTHONPATH": str(installed)}
    command = [sys.executable, "-c", script]
    process = subprocess.run(
        command, cwd=installed.parent, env=environment, capture_output=True, text=True, timeout=120
    )
    assert process.returncode == 0, process.stderr
    return process.stdout.strip()


def test_the_wheel_holds_the_two_packages_and_their_licence(installed):
    entries = {path.name for path in installed.iterdir()}
    (information,) = (name for name in entries if name.endswith(".dist-info"))
    assert entries - {information} == {"add_core", "add_viewer"}
    assert (installed / information / "licenses" / "LICENSE").is_file()


@pytest.mark.parametrize("shapes", ["humans", "poses", "dogs"])
def test_shipped_shapes_open_from_the_wheel(installed, shapes):
    script = f"import add_core; from add_core.io import {shapes}; print(add_core.__file__, {shapes}()[0].vertex_count)"
    origin, vertex_count = run(installed, script).rsplit(" ", 1)
    assert Path(origin).is_relative_to(installed)
    assert int(vertex_count) > 6000


def test_every_shipped_data_file_is_in_the_wheel(installed):
    """What git keeps under assets/, but for the screenshots of the README and the scripts that made the data."""
    kept = [path for folder in ("shapes", "models") for path in (ROOT / "assets" / folder).rglob("*")]
    data = [path for path in kept if path.suffix in {".npz", ".safetensors", ".md"}]
    assert data
    for path in data:
        packed = installed / "add_core" / "assets" / path.relative_to(ROOT / "assets")
        assert packed.read_bytes() == path.read_bytes()


def test_every_resource_inside_a_package_is_in_the_wheel(installed):
    """Icons, NOTATION.md and the like: whatever lies between the modules goes where the modules go."""
    for package in ("add_core", "add_viewer"):
        for path in (ROOT / package).rglob("*"):
            if path.is_file() and "__pycache__" not in path.parts:
                assert (installed / path.relative_to(ROOT)).is_file(), f"{path.relative_to(ROOT)} is not packed"


def test_both_commands_are_installed(installed):
    (entry_points,) = installed.glob("*.dist-info/entry_points.txt")
    text = entry_points.read_text(encoding="utf-8")
    assert "add-core = add_core.cli:main" in text
    assert "add-viewer = add_viewer.app:main" in text
