"""Put a trained model into assets/models, in half precision, with its card.

    python ship_model.py RUN NAME --fact data="…" --fact command="…" [--scores SCORES.json]

SCORES.json : from `compare_networks.py --only-models`, a JSON object of numbers for each variant.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

from add_core.learning import load_model

MODELS = Path(__file__).parents[1] / "models"


def main() -> None:
    """Write assets/models/NAME.safetensors."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("name")
    parser.add_argument("--fact", action="append", default=[], metavar="NAME=TEXT")
    parser.add_argument("--scores", type=Path)
    parser.add_argument("--smoothing", type=float, help="In place of the model's own.")
    given = parser.parse_args()
    model = load_model(given.run)
    facts = dict(fact.split("=", 1) for fact in given.fact)
    if given.scores is not None:
        facts["scores"] = json.loads(given.scores.read_text(encoding="utf-8"))
    smoothing = model.smoothing if given.smoothing is None else given.smoothing
    replace(model, card=dict(model.card) | facts, smoothing=smoothing).save(
        MODELS / f"{given.name}.safetensors", precision="float16"
    )


if __name__ == "__main__":
    main()
