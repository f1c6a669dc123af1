"""Average the weights of models that were trained from one another: better on other meshings than any of them.

python mix_models.py RUN6=0.4 RUN8=0.6 -o MIXED.safetensors
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import torch

from add_core.learning import Model, load_model


def mixed(models: list[Model], shares: list[float]) -> Model:
    """The last of the models, with the weighted mean of all weights."""
    if not math.isclose(sum(shares), 1.0):
        raise SystemExit(f"Shares must add up to 1, but they add up to {sum(shares):g}.")
    parts = [model.network.state_dict() for model in models]
    mean = {name: sum(share * part[name] for share, part in zip(shares, parts, strict=True)) for name in parts[-1]}
    models[-1].network.load_state_dict(mean)
    return models[-1]


def main() -> None:
    """Write one model file."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="+", metavar="RUN=SHARE")
    parser.add_argument("-o", "--output", type=Path, required=True)
    given = parser.parse_args()
    runs, shares = zip(*(part.rsplit("=", 1) for part in given.parts), strict=True)
    with torch.no_grad():
        mixed([load_model(Path(run)) for run in runs], [float(share) for share in shares]).save(given.output)


if __name__ == "__main__":
    main()
