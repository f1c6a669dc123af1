"""Train the models in assets/models from the shipped shapes.

    python train_models.py humans-1 -o RUN1 --inputs INPUTS
    python train_models.py humans-2 -o RUN2 --inputs INPUTS --start RUN1
    python train_models.py humans-3 -o RUN3 --inputs INPUTS --start RUN2
    python train_models.py humans-4 -o RUN4 --inputs INPUTS --start RUN3
    python train_models.py humans-5 -o RUN5 --inputs INPUTS --start RUN4
    python train_models.py humans-6 -o RUN6 --inputs INPUTS --start RUN5
    python train_models.py humans-7 -o RUN7 --inputs INPUTS --start RUN6
    python mix_models.py RUN5=0.2 RUN6=0.4 RUN7=0.4 -o START8.safetensors
    python train_models.py humans-8 -o RUN8 --inputs INPUTS --start START8.safetensors
    python mix_models.py RUN6=0.4 RUN8=0.6 -o START9.safetensors
    python train_models.py humans-9 -o RUN9 --inputs INPUTS --start START9.safetensors
    python train_models.py humans-10 -o RUN10 --inputs INPUTS --start START9.safetensors
    python mix_models.py RUN9=0.5 RUN10=0.5 -o START11.safetensors
    python train_models.py humans-11 -o RUN11 --inputs INPUTS --start START11.safetensors
    python train_models.py correspondence -o NAMED1 --inputs INPUTS --start RUN11
    python train_models.py correspondence-2 -o NAMED2 --inputs INPUTS --start NAMED1
    python train_models.py humans-12 -o RUN12 --inputs INPUTS --start START11.safetensors
    python mix_models.py RUN9=0.25 RUN10=0.25 RUN11=0.5 -o START13.safetensors
    python train_models.py humans-13 -o RUN13 --inputs INPUTS --start START13.safetensors
    python mix_models.py RUN11=0.33 RUN12=0.33 RUN13=0.34 -o MIXED.safetensors
    python train_models.py dogs -o RUN
    python train_models.py osd -o RUN --inputs INPUTS

humans-madd3 learns in thirteen stages, at first from more and more bodies, from the seventh on with nearest vertices
of other meshings as counterparts, in the last five from bodies that other programs meshed too (pymeshlab must be
installed for these), and is the mean of three of them. About half of the time goes into spectra: 17 operators for each
body, 7 to 15 seconds on a core, and 20 MB of disk each in INPUTS. Each may be stopped and started again;
RUN/model.safetensors is the best so far.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass, replace
from pathlib import Path

import training_bodies

from add_core.geometry import PointCloud
from add_core.io import dogs, humans
from add_core.learning import InputRecipe, LearningTask, Model, TrainingSettings, TrainingShape, load_model
from add_core.learning.architectures import build_network
from add_core.learning.optimal_spectral import linear_part, linear_recipe, optimal_spectral_descriptor
from add_core.learning.training import fit
from add_core.learning.training_set import PreparedShape, prepare

RECIPE = InputRecipe(angles=8, eigenpairs=300, splines=96)
CORRESPONDENCE = "ASF256 ReLU ASF256 ReLU SC FC512 ReLU FC512 ReLU FCreference Softmax"
"""mADD4 with a quarter to a half of its widths; its first layers begin as those of humans-madd3."""
OSD = range(0, 112, 2)
"""Training bodies of the optimal spectral descriptors."""
COMMON = TrainingSettings(pairs=160, noise=0.15, averaging=0.998, arithmetic="bfloat16", validate_every=500)
LATER = replace(COMMON, noise=0.1, seed=1, validate_every=1000)
LAST = replace(LATER, noise=0.04, learning_rate=4e-4)
FOREIGN = replace(LAST, averaging=0.999)
NAMED = replace(COMMON, loss="multinomial")
NEW = range(training_bodies.REPOSED_FROM, 1140)
"""Bodies in poses of others, and those that other programs meshed."""


@dataclass(frozen=True)
class Stage:
    """bodies : the numbers of `training_bodies.person` or `dog` that are learned from. clouds : how often each cloud
    is among them. nearby : counterparts on other meshings are the nearest vertices, see `add_core.learning.nearby`,
    and not exact ones alone.
    """

    bodies: range
    settings: TrainingSettings
    nearby: bool = False
    clouds: int = 1


STAGES = {
    "humans-1": Stage(range(112), replace(COMMON, steps=10000)),
    "humans-2": Stage(range(132), replace(LATER, steps=12000, learning_rate=7e-4, validate_every=500)),
    "humans-3": Stage(range(376), replace(LATER, steps=14000, learning_rate=7e-4)),
    "humans-4": Stage(range(490), replace(LATER, steps=9000, learning_rate=6e-4, seed=2)),
    "humans-5": Stage(range(980), replace(LATER, steps=15000, learning_rate=7e-4, seed=3)),
    "humans-6": Stage(range(980), replace(LATER, steps=10000, learning_rate=5e-4, noise=0.04, seed=4)),
    "humans-7": Stage(range(980), replace(LAST, steps=1800, seed=5, validate_every=600), nearby=True),
    "humans-8": Stage(range(980), replace(LAST, steps=5000, seed=7, averaging=0.999), nearby=True),
    "humans-9": Stage(NEW, replace(FOREIGN, steps=7000, learning_rate=6e-4, seed=8, validate_every=1750), nearby=True),
    "humans-10": Stage(NEW, replace(FOREIGN, steps=7000, learning_rate=4e-4, seed=9, validate_every=1750), nearby=True),
    "humans-11": Stage(
        NEW, replace(FOREIGN, steps=8000, learning_rate=5e-4, seed=10, validate_every=4000), nearby=True
    ),
    "humans-12": Stage(
        NEW, replace(FOREIGN, steps=9000, learning_rate=5e-4, seed=11, validate_every=4500), nearby=True
    ),
    "humans-13": Stage(
        NEW, replace(FOREIGN, steps=8000, learning_rate=4e-4, seed=12, validate_every=4000), nearby=True, clouds=2
    ),
    "correspondence": Stage(NEW, replace(NAMED, steps=5000, noise=0.1, seed=13, validate_every=1250)),
    "correspondence-2": Stage(
        NEW, replace(NAMED, steps=4000, noise=0.05, learning_rate=7e-4, seed=14, validate_every=1000)
    ),
    "dogs": Stage(range(36), replace(COMMON, steps=3000, validate_every=250)),
}


def task(data: str) -> LearningTask:
    """Bodies to train on and to validate by."""
    numbers = STAGES[data].bodies
    if data == "dogs":
        middles = training_bodies.dog_middles()
        bodies = [training_bodies.dog(number) for number in numbers]
        return LearningTask(bodies, training_bodies.validation_dogs(), middles.symmetry, dogs()[0])
    bodies = [training_bodies.person(number) for number in numbers]
    bodies += [body for body in bodies if isinstance(body.shape, PointCloud)] * (STAGES[data].clouds - 1)
    middles = training_bodies.people_middles()
    return LearningTask(bodies, training_bodies.validation_people(), middles.symmetry, humans()[0])


def learn(data: str, run: Path, inputs: Path, start: Path | None, steps: int | None) -> Model:
    """Prepare the inputs and train, or go on with either."""
    chosen = task(data)

    def prepared(shapes: list[TrainingShape]) -> list[PreparedShape]:
        return prepare(shapes, RECIPE, inputs, report=lambda name, done, total: print(name, done, total, flush=True))

    training, validation = prepared(list(chosen.training)), prepared(list(chosen.validation))
    settings = STAGES[data].settings
    if steps is not None:
        settings = replace(settings, steps=steps)
    named = STAGES[data].settings.loss == "multinomial"
    network = build_network(
        "mADD4" if named else "mADD3",
        angles=RECIPE.angles,
        splines=RECIPE.splines,
        reference_size=humans()[0].vertex_count,
        layers=CORRESPONDENCE if named else None,
    )
    if named:
        training, validation = ([shape.below(network.outputs) for shape in part] for part in (training, validation))
    return fit(
        network.architecture,
        RECIPE,
        training,
        run,
        settings=settings,
        validation=validation,
        symmetry=chosen.symmetry,
        positions=training_bodies.people_positions() if STAGES[data].nearby else None,
        reference=chosen.reference if named else None,
        start=None if start is None else load_model(start).network,
        report=_say,
    )


def learn_osd(inputs: Path) -> Model:
    """Optimal spectral descriptors of half of the people, in closed form."""
    bodies = [training_bodies.person(number) for number in OSD]
    shapes = [linear_part(shape) for shape in prepare(bodies, RECIPE, inputs)]
    symmetry = training_bodies.people_middles().symmetry
    return optimal_spectral_descriptor(shapes, linear_recipe(RECIPE), symmetry=symmetry)


def _say(event: dict[str, object]) -> None:
    if event["event"] != "step" or int(str(event["step"])) % 50 == 0:
        print(json.dumps(event), flush=True)


def main() -> None:
    """Train one model, and write it once more with weights of half precision, as it ships."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", choices=[*STAGES, "osd"])
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--inputs", type=Path, help="Folder of prepared inputs. [default: inputs in the run's folder]")
    parser.add_argument(
        "--start", type=Path, help="Model whose first layers are taken over; all, as far as they agree."
    )
    parser.add_argument("--steps", type=int)
    given = parser.parse_args()
    inputs = given.inputs or given.output / "inputs"
    if given.data == "osd":
        model = learn_osd(inputs)
    else:
        model = learn(given.data, given.output, inputs, given.start, given.steps)
    model.save(given.output / "shipped.safetensors", precision="float16")


if __name__ == "__main__":
    main()
