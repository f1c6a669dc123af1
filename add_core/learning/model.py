"""Trained networks: from a shape to its descriptors, in files that run no code."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save as serialise

from .._assets import asset
from .._check import FloatArray, IntArray, at_least_zero, one_of, read_only
from ..descriptors import smoothed
from ..errors import AddError, ParameterError, ShapeFileError
from ..geometry import PointCloud, TriangleMesh
from ..io import shipped_models
from ..io.atomic import write_atomically
from ..io.files import file_path
from .architectures import Architecture, Network, build
from .inputs import InputRecipe, Inputs, Moments, Progress

FORMAT = "add_core model 1"
RUN_MODEL = "model.safetensors"
"""Name of the model in the folder of a training."""
POINTS_AT_ONCE = 2048
"""Points that go through the network together: some 100 MB of intermediate numbers."""

Standardisation = Literal["shape", "set"]
Precision = Literal["float16", "float32"]


@dataclass(frozen=True, eq=False)
class Matches:
    """vertices : (n,), the reference's vertex that each point most probably is. probabilities : (n,), of being it."""

    vertices: IntArray
    probabilities: FloatArray


@dataclass(frozen=True, eq=False)
class Model:
    """A network with all that it needs to be used on a shape.

    recipe : how inputs come from a shape. standardisation : "shape" brings every shape's inputs to mean 0 and
        deviation 1 by themselves, "set" by the moments of the training set. card : facts about the training, for
        people to read. reference : the shape whose vertices a correspondence network names (its Softmax has one output
        for each), None if it is not known. smoothing : strength with which `smoothed` takes the noise of the
        meshing from descriptors, and from what enters the last FC layer of a correspondence network; 0 leaves it.
    """

    network: Network
    recipe: InputRecipe
    moments: Moments
    standardisation: Standardisation = "shape"
    card: Mapping[str, Any] = field(default_factory=dict)
    reference: TriangleMesh | None = None
    smoothing: float = 0.0

    def __post_init__(self) -> None:
        one_of("standardisation", self.standardisation, ("shape", "set"))
        at_least_zero("smoothing", self.smoothing)
        wanted, given = self.network.architecture, self.recipe
        if (wanted.channels, wanted.splines) != (given.channels, given.splines):
            raise ParameterError(
                f"the network takes {wanted.channels} channels × {wanted.splines} splines, "
                f"but the recipe makes {given.channels} × {given.splines}."
            )

    def describe(
        self,
        shape: TriangleMesh | PointCloud,
        *,
        progress: Progress | None = None,
        workers: int | None = None,
        cache: bool = True,
    ) -> FloatArray:
        """Descriptors of every vertex, shape (n, Q), without unit; probabilities if the network ends in Softmax.

        The shape is brought to unit geodesic diameter first, so its unit of length does not matter. progress, workers,
        cache : as for `compute_spectra`, which takes nearly all of the time.
        """
        return self.describe_inputs(*self._inputs_of(shape, progress, workers, cache))

    def describe_inputs(
        self, values: Inputs, mass: FloatArray, shape: TriangleMesh | PointCloud | None = None
    ) -> FloatArray:
        """Descriptors, shape (n, Q), from unstandardised inputs (n, C, M) of points of area `mass` (n,).

        shape : to smooth over; None leaves what the network says of each point by itself.
        """
        return np.concatenate([part.numpy().astype(np.float64) for part in self._outputs(values, mass, shape)])

    def match(
        self,
        shape: TriangleMesh | PointCloud,
        *,
        progress: Progress | None = None,
        workers: int | None = None,
        cache: bool = True,
    ) -> Matches:
        """The vertex of the `reference` that every vertex of the shape most probably is; arguments as of `describe`.

        Raises ParameterError if the network does not end in Softmax: compare descriptors of two shapes then.
        """
        self._check_classifier()
        return self.match_inputs(*self._inputs_of(shape, progress, workers, cache))

    def match_inputs(self, values: Inputs, mass: FloatArray, shape: TriangleMesh | PointCloud | None = None) -> Matches:
        """As `match`, from inputs (n, C, M) and `mass` (n,); arguments as of `describe_inputs`."""
        self._check_classifier()
        best = [part.max(dim=1) for part in self._outputs(values, mass, shape)]
        return Matches(
            read_only(np.concatenate([part.indices.numpy() for part in best])),
            read_only(np.concatenate([part.values.numpy().astype(np.float64) for part in best])),
        )

    def embed_inputs(
        self, values: Inputs, mass: FloatArray, shape: TriangleMesh | PointCloud | None = None
    ) -> FloatArray:
        """Numbers (n, D) in which corresponding points of two shapes are near each other, from inputs (n, C, M).

        The descriptors, or the places on the reference that a correspondence network finds: D = 3. Arguments as of
        `describe_inputs`.
        Raises ParameterError for a correspondence network without a reference.
        """
        if not self.network.is_classifier:
            return self.describe_inputs(values, mass, shape)
        if self.reference is None:
            raise ParameterError("the model must know its reference shape to place points on it, but it has none.")
        return np.asarray(self.reference.vertices[self.match_inputs(values, mass, shape).vertices])

    def embed(
        self,
        shape: TriangleMesh | PointCloud,
        *,
        progress: Progress | None = None,
        workers: int | None = None,
        cache: bool = True,
    ) -> FloatArray:
        """As `embed_inputs`, from the shape; arguments as of `describe`."""
        return self.embed_inputs(*self._inputs_of(shape, progress, workers, cache))

    def _inputs_of(
        self, shape: TriangleMesh | PointCloud, progress: Progress | None, workers: int | None, cache: bool
    ) -> tuple[Inputs, FloatArray, TriangleMesh | PointCloud]:
        """What `describe_inputs` and its like take."""
        family = self.recipe.spectra(shape, progress=progress, workers=workers, cache=cache)
        return self.recipe.inputs(family), family.mass, shape

    def _check_classifier(self) -> None:
        if not self.network.is_classifier:
            name = self.network.architecture.name
            raise ParameterError(
                f"the network must end in Softmax to name vertices of a reference, but {name} gives descriptors. "
                "Describe two shapes and compare: add-core match."
            )

    def _outputs(
        self, values: Inputs, mass: FloatArray, shape: TriangleMesh | PointCloud | None
    ) -> Iterator[torch.Tensor]:
        moments = Moments.of(values, mass) if self.standardisation == "shape" else self.moments
        self.network.eval()
        blocks = [slice(low, low + POINTS_AT_ONCE) for low in range(0, len(values), POINTS_AT_ONCE)]
        with torch.inference_mode():
            features = torch.cat(
                [self.network.features(torch.from_numpy(moments.standardise(values[block]))) for block in blocks]
            )
            if shape is not None and self.smoothing > 0:
                even = smoothed(shape, features.numpy(), strength=self.smoothing)
                features = torch.from_numpy(even.astype(np.float32))
        for block in blocks:
            with torch.inference_mode():
                yield self.network.concluded(features[block])

    def save(self, path: str | Path, *, precision: Precision = "float32") -> None:
        """Write the model as safetensors, replacing what is there only once everything is written.

        precision : of the weights in the file; "float16" halves it and changes descriptors in the fourth digit.
        """
        kept = getattr(torch, one_of("precision", precision, ("float16", "float32")))
        about = {
            "format": FORMAT,
            "architecture": asdict(self.network.architecture),
            "recipe": asdict(self.recipe),
            "standardisation": self.standardisation,
            "smoothing": self.smoothing,
            "card": dict(self.card),
        }
        tensors = {f"network.{name}": value.to(kept).contiguous() for name, value in self.network.state_dict().items()}
        tensors["input.mean"] = torch.from_numpy(np.array(self.moments.mean))
        tensors["input.deviation"] = torch.from_numpy(np.array(self.moments.deviation))
        if self.reference is not None:
            tensors["reference.vertices"] = torch.from_numpy(self.reference.vertices.astype(np.float32, order="C"))
            tensors["reference.faces"] = torch.from_numpy(self.reference.faces.astype(np.int32, order="C"))
        target = Path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        # One entry of metadata: several come in random order.
        write_atomically(target, serialise(tensors, metadata={"about": json.dumps(about)}))


def load_model(model: str | Path) -> Model:
    """The model in a file or in the folder of a training, or one that ships with the project, by its name such as
    "humans-madd3".

    A training's folder has a model from its first validation on, and a better one from time to time.

    Raises ParameterError for a name that is neither, ShapeFileError for a file that holds no model.
    """
    path = file_path(model)
    if path.is_dir() and (path / RUN_MODEL).is_file():
        path = path / RUN_MODEL
    if not path.is_file():
        path = _shipped(str(model))
    try:
        with safe_open(str(path), framework="pt") as file:
            about = json.loads((file.metadata() or {}).get("about", "{}"))
            if about.get("format") != FORMAT:
                raise ShapeFileError(f"{path}: holds no model of this program's format ({FORMAT}).")
            tensors = {name: file.get_tensor(name) for name in file.keys()}
        return _assembled(about, tensors)
    except (SafetensorError, OSError, KeyError, TypeError, ValueError, RuntimeError) as error:
        if isinstance(error, AddError):
            raise
        raise ShapeFileError(f"{path}: is damaged, or holds no model: {error}.") from None


def _shipped(name: str) -> Path:
    if name not in shipped_models():
        known = ", ".join(shipped_models()) or "none"
        raise ParameterError(
            f"model must be a file, the folder of a training or a shipped model ({known}), but it is {name!r}."
        )
    return asset("models", f"{name}.safetensors")


def _assembled(about: dict[str, Any], tensors: dict[str, torch.Tensor]) -> Model:
    recipe = dict(about["recipe"], alphas=tuple(about["recipe"]["alphas"]))
    network = build(Architecture(**about["architecture"]))
    network.load_state_dict(
        {name.removeprefix("network."): value for name, value in tensors.items() if name.startswith("network.")}
    )
    moments = Moments(tensors["input.mean"].numpy(), tensors["input.deviation"].numpy())
    reference = None
    if "reference.vertices" in tensors:
        reference = TriangleMesh(tensors["reference.vertices"].numpy(), tensors["reference.faces"].numpy(), "reference")
    smoothing = float(about.get("smoothing", 0.0))
    return Model(network, InputRecipe(**recipe), moments, about["standardisation"], about["card"], reference, smoothing)
