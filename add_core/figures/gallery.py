"""All figures of the paper: what draws each, what it shows, and where it honestly differs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module

from .drawn import Drawn
from .studio import Studio


@dataclass(frozen=True)
class PaperFigure:
    """One figure. module, function : of this package, loaded when it is drawn. shows : in the paper, in one phrase.
    difference : how ours differs, in a sentence or two. can_train : whether it trains networks on request.
    """

    number: int
    module: str
    shows: str
    difference: str
    function: str = "draw"
    can_train: bool = False

    @property
    def stem(self) -> str:
        """Name of its files without the ending."""
        return f"figure_{self.number:02d}"

    def draw(self, studio: Studio) -> Drawn:
        """Make it. Takes seconds to minutes."""
        make: Callable[[Studio], Drawn] = getattr(import_module(f".{self.module}", __package__), self.function)
        return make(studio)


_OURS = "Our shapes, not the paper's."

FIGURES: tuple[PaperFigure, ...] = (
    PaperFigure(
        1,
        "heat_kernels",
        "Anisotropic heat kernels on meshes and point clouds for different α, θ and t",
        f"{_OURS} α and t are in units of the geodesic diameter; kernels come from Krylov spaces, not from 300 "
        "eigenfunctions, which err by half at small t.",
    ),
    PaperFigure(
        2,
        "signatures",
        "AHKS at three points of two poses",
        f"{_OURS} Angles are equally spaced in [0°, 180°): the paper samples 360°, where half of the operators repeat.",
    ),
    PaperFigure(
        3,
        "reflection",
        "The ambiguity under intrinsic symmetry: kernels and signatures of two mirror points",
        f"{_OURS} The mirror point is exact, from the collection's map.",
    ),
    PaperFigure(
        4,
        "architecture",
        "The network, from spectra to a descriptor",
        "The paper draws a single-layer scheme; here the filters and responses are those of the first layer of a "
        "trained network, which acts on logarithms of geometry vectors.",
    ),
    PaperFigure(
        5,
        "discretisation",
        "Principal frames on two triangles, and turned by θ",
        "The paper's is a sketch; here it is drawn from two faces of a mesh, with their computed frames.",
    ),
    PaperFigure(
        6,
        "distance_maps",
        "Distance in descriptor space from one point to all others, saturated at the median",
        f"{_OURS} The paper shows mADD3 alone; here hand-made descriptors stand above it, with a remeshed body and a "
        "point cloud among the shapes.",
    ),
    PaperFigure(
        7,
        "quality_curves",
        "CMC, ROC and Princeton curves of descriptors on two collections",
        f"{_OURS} Ten people in place of FAUST and one person in many poses in place of SCAPE, with one network "
        "trained on both where the paper trains one for each. ShapeNet (a geodesic CNN) is not among the rivals, and "
        "the false positive rate is logarithmic.",
    ),
    PaperFigure(
        8,
        "network_curves",
        "CMC, ROC and Princeton curves of the networks of the family",
        f"{_OURS} Losses, optimisers and training times are not the paper's: see the model card or --train.",
        can_train=True,
    ),
    PaperFigure(
        9,
        "colour_transfer",
        "Correspondence on meshes: Princeton curves, and colours carried from a reference",
        f"{_OURS} Blended intrinsic maps are not among the rivals. Matches are nearest neighbours in a learned "
        "descriptor unless a correspondence network is at hand.",
        "draw_meshes",
    ),
    PaperFigure(
        10,
        "colour_transfer",
        "Correspondence on point clouds: Princeton curves, and colours carried from a reference",
        f"{_OURS} Clouds of 4,000 vertices, no two of the same ones. As Figure 9; the random forest knows meshes only.",
        "draw_clouds",
    ),
)


def by_number(number: int) -> PaperFigure | None:
    """The figure of that number, or None."""
    return next((figure for figure in FIGURES if figure.number == number), None)
