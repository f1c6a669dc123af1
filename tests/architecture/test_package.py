"""What an installed wheel holds: the same shapes and resources as a checkout, and nothing that only developers need."""

import os
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """A wheel of this checkout."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True, timeout=120)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel) -> Path:
    """A folder that holds what the wheel would put into site-packages."""
    folder = wheel.parent / "site-packages"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


@pytest.fixture(scope="module")
def environment(wheel, tmp_path_factory) -> Path:
    """The commands of a fresh environment: the wheel is installed there, and this checkout cannot be seen.

    Other packages are those of this environment, by their plain path: what marks the checkout as installed is not read.
    """
    folder = tmp_path_factory.mktemp("fresh")
    venv.create(folder, with_pip=False)
    commands = folder / ("Scripts" if os.name == "nt" else "bin")
    python = commands / Path(sys.executable).name
    where = [str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    packages = Path(subprocess.run(where, check=True, capture_output=True, text=True).stdout.strip())
    (packages / "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "--no-deps", "--no-index", "--quiet"]
    subprocess.run([*pip, "--ignore-installed", str(wheel)], check=True, capture_output=True, timeout=120)
    return commands


def command(environment: Path, *words: str) -> str:
    """What a command of the fresh environment prints, run far from the checkout."""
    hidden = ("PYTHONPATH", "PYTHONHOME", "WAYLAND_DISPLAY")
    variables = {name: value for name, value in os.environ.items() if name not in hidden}
    run = [str(environment / words[0]), *words[1:]]
    done = subprocess.run(
        run, cwd=environment.parent, env=variables, capture_output=True, text=True, timeout=180, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


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


def test_a_fresh_environment_runs_the_wheel_and_not_the_checkout(environment):
    origin = command(environment, "python", "-c", "import add_core, add_viewer; print(add_core.__file__)")
    assert Path(origin).is_relative_to(environment.parent)
    assert '"vertices": 6890' in command(environment, "add-core", "info", "humans/0", "--json")


def test_the_installed_app_shows_a_shipped_shape_and_its_heat(environment, tmp_path):
    if not os.environ.get("DISPLAY") and shutil.which("xvfb-run") is None:
        pytest.skip("needs a screen, or xvfb-run")
    picture = tmp_path / "window.png"
    command(environment, "add-viewer", "dogs/3", "--pick", "1000", "--screenshot", str(picture), "--size", "1024x700")
    with Image.open(picture) as image:
        pixels = np.asarray(image.convert("RGB"), dtype=int)
    assert pixels.shape == (700, 1024, 3)
    assert (pixels.max(axis=2) - pixels.min(axis=2) > 120).mean() > 0.002, "heat has colours"


def test_the_installed_core_reads_the_shipped_model(environment):
    pytest.importorskip("torch")
    script = "from add_core.learning import load_model; print(type(load_model('humans-madd3')).__name__)"
    assert command(environment, "python", "-c", script) == "Model"
