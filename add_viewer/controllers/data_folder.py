"""Where a person's own data lives: sessions that run, jobs, trained models."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs


def data_folder() -> Path:
    """$ADD_DATA_DIR, or where the platform keeps a person's data."""
    chosen = os.environ.get("ADD_DATA_DIR")
    root = Path(chosen) if chosen else platformdirs.user_data_path("anisotropic-diffusion-descriptors", False)
    return root.absolute()
