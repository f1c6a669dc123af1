"""What a person wants to train, and in which words it is offered."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from add_core.errors import AddError
from add_core.io import open_collection

FEWEST = 4
"""Shapes that a training needs: some to learn from, some to validate on."""

MODEL_FILE = Path("run") / "model.safetensors"
"""Where a training's best model so far is, in the folder of its job."""


@dataclass(frozen=True)
class Option:
    """One of several choices: its name for the command, its title and a sentence of help."""

    name: str
    title: str
    help: str


ARCHITECTURES = (
    Option("ADD1", "ADD1", "One anisotropic layer: the smallest network, for a first look."),
    Option("ADD2", "ADD2", "Two anisotropic layers at one degree of anisotropy."),
    Option("ADD3", "ADD3", "Three anisotropic layers at one degree of anisotropy: the paper's network for meshes."),
    Option("mADD1", "mADD1", "One layer that sees several degrees of anisotropy at once."),
    Option("mADD2", "mADD2", "Two layers that see several degrees of anisotropy at once."),
    Option(
        "mADD3", "mADD3", "Three layers that see several degrees of anisotropy at once: the paper's best descriptor."
    ),
    Option("mADD4", "mADD4", "Names the point of a reference shape for each point: learns by classification."),
)
DATA = (
    Option("humans", "People", "100 people: ten bodies in ten poses each, with exact correspondence."),
    Option("poses", "Poses", "One body in 71 poses."),
    Option("dogs", "Dogs", "40 poses of a dog."),
    Option("", "A folder…", "Shapes of your own."),
)
LOSSES = (
    Option(
        "soft-nearest", "Soft nearest neighbour", "Each point must be nearer to its counterpart than to all others."
    ),
    Option("siamese", "Siamese, eq. (21)", "The paper's: counterparts close together, other points a margin apart."),
)
CLASSIFICATION = Option("multinomial", "Multinomial, eq. (22)", "The only one for mADD4, whose outputs are classes.")


@dataclass(frozen=True)
class Effort:
    """How much is learned from: shapes (None: all), angles L, eigenpairs K, splines M, pairs in a mini-batch, steps."""

    title: str
    help: str
    shapes: int | None
    angles: int
    eigenpairs: int
    splines: int
    pairs: int
    steps: int


EFFORTS = (
    Effort(
        "Quick look",
        "First curves within a minute or two, to see whether the data learn at all.",
        6,
        4,
        60,
        32,
        96,
        200,
    ),
    Effort("Over lunch", "A useful descriptor in about an hour.", 24, 8, 150, 64, 128, 1500),
    Effort("As in the paper", "All shapes, 16 angles and 300 eigenpairs: several hours.", None, 16, 300, 96, 192, 3000),
)


@dataclass(frozen=True)
class TrainingRequest:
    """Everything that a training depends on.

    data : "humans", "poses", "dogs", or a folder. isotropic : the twin without directions.
    steps, minutes : the budget, one of the two; the other is None. For the rest see `Effort`.
    """

    architecture: str = "mADD3"
    isotropic: bool = False
    data: str = "humans"
    shapes: int | None = 6
    angles: int = 4
    eigenpairs: int = 60
    splines: int = 32
    pairs: int = 96
    loss: str = "soft-nearest"
    steps: int | None = 200
    minutes: float | None = None
    seed: int = 0

    def with_effort(self, effort: Effort) -> TrainingRequest:
        """The same with another effort; a budget in minutes stays."""
        steps = None if self.steps is None else effort.steps
        names = ("shapes", "angles", "eigenpairs", "splines", "pairs")
        return replace(self, steps=steps, **{name: getattr(effort, name) for name in names})

    @property
    def effort(self) -> Effort | None:
        """The effort that this is, None if a person changed its numbers."""
        return next((each for each in EFFORTS if self.with_effort(each) == self), None)

    @property
    def is_classifier(self) -> bool:
        return self.architecture == "mADD4"

    @property
    def title(self) -> str:
        known = {option.name: option.title.lower() for option in DATA if option.name}
        twin = "isotropic " if self.isotropic else ""
        return f"{twin}{self.architecture} on {known.get(self.data, Path(self.data).name)}"

    @property
    def validate_every(self) -> int:
        """Steps between two validations: some fifteen points of each curve."""
        return 50 if self.steps is None else min(max(self.steps // 15, 5), 250)

    def arguments(self, folder: Path) -> tuple[str, ...]:
        """What follows `add-core` to train this in a folder."""
        every = self.validate_every
        chosen = {
            "--architecture": self.architecture,
            "--data": self.data,
            "--angles": self.angles,
            "--count": self.eigenpairs,
            "--splines": self.splines,
            "--pairs": self.pairs,
            "--loss": CLASSIFICATION.name if self.is_classifier else self.loss,
            "--validate-every": every,
            "--checkpoint-every": min(every, 50),
            "--seed": self.seed,
            "--output": folder / MODEL_FILE.parent,
        }
        chosen |= {"--minutes": self.minutes} if self.steps is None else {"--steps": self.steps}
        chosen |= {} if self.shapes is None else {"--shapes": self.shapes}
        words = [str(word) for pair in chosen.items() for word in pair]
        return ("train", *words, *(("--isotropic",) if self.isotropic else ()))


def problem_of_data(data: str) -> str:
    """Why `data`, the name of a shipped collection or a folder, cannot be trained on; "" if it can."""
    if any(data == option.name for option in DATA if option.name):
        return ""
    folder = Path(data)
    if not data or not folder.is_absolute() or not folder.is_dir():
        return f"There is no folder {data!r} to train on. Choose one that holds at least four shapes."
    try:
        count = len(open_collection(folder))
    except (AddError, OSError) as error:
        reason = str(error).partition(". ")[0].rstrip(".")  # what follows tells of data to download
        return f"{reason}. Choose a folder that holds at least four shapes."
    few = f"{folder.name} holds {count} {'shape' if count == 1 else 'shapes'}, but a training needs at least {FEWEST}."
    return few if count < FEWEST else ""
