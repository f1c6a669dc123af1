"""What every test runs in: one BLAS thread, folders of its own, and generated examples that do not depend on luck."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

# Set before any test imports NumPy: its thread pool and SciPy's stall each other, here as in the app.
for pool in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(pool, "1")

# No deadline, because two workers share the machine. `--hypothesis-profile=search` looks further than the suite does.
settings.register_profile("steady", deadline=None, derandomize=True, database=None)
settings.register_profile("search", deadline=None, max_examples=2000)
settings.load_profile("steady")


@pytest.fixture(scope="session", autouse=True)
def _folders_of_its_own(tmp_path_factory: pytest.TempPathFactory):
    """No test, and no process that a test starts, reads or writes the user's caches and settings."""
    home = tmp_path_factory.mktemp("home")
    with pytest.MonkeyPatch.context() as patch:
        for variable in ("XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME", "XDG_RUNTIME_DIR"):
            folder: Path = home / variable.lower()
            folder.mkdir(mode=0o700)
            patch.setenv(variable, str(folder))
        yield
