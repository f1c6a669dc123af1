"""The lines of a script that compute one kind of field, as the fields of the window are computed."""

from __future__ import annotations

from math import degrees, pi

from add_core.evaluation.baselines import UNDIRECTED
from add_core.io import SHIPPED

from ..models.descriptor_names import PLAIN
from ..models.fields import FieldChoice, FieldKind
from ..models.picks import Pick
from .descriptors import COUNT
from .fields_of_descriptors import asked_point
from .fields_of_heat import PETALS
from .fields_of_spectra import FILTERS, WAVE_WIDTH
from .scripting import Script, Writer
from .spectra import SpectrumQuestion

LOOP = "for name, shape in shapes.items():"
_DIRECTED = ("ahks", "geometry-vectors")


def _skin(script: Script, _choice: FieldChoice) -> None:
    script.say("# Bare skin: no field is shown.")


def _heat(script: Script, _choice: FieldChoice) -> None:
    if not _has_picks(script):
        return
    _operator(script)
    theta = script.state.diffusion.theta
    script.say(
        f"    kernels = np.stack([heat.kernel(vertex, theta={theta!r}, time=time) for vertex in picks[name]])",
        '    fields[name]["heat"] = kernels.sum(axis=0)  # 1/length²',
    )


def _rose(script: Script, choice: FieldChoice) -> None:
    if not _has_picks(script):
        return
    _operator(script)
    if choice.name == "mirror":
        theta = script.state.diffusion.theta
        mirrored = {pick.vertex for pick in script.state.picks if pick.is_mirror}
        script.say(
            f"    for vertex in picks[name]:  # f_θ∘η = f_−θ: the mirror images {sorted(mirrored)} have −θ",
            f"        theta = {(-theta) % pi!r} if vertex in {sorted(mirrored)} else {theta!r}",
            '        fields[name][f"heat_{vertex}"] = heat.kernel(vertex, theta=theta, time=time)',
        )
    else:
        script.say(
            f"    for degrees in {[180 * number // PETALS for number in range(PETALS)]}:",
            "        kernels = [heat.kernel(vertex, theta=np.radians(degrees), time=time) for vertex in picks[name]]",
            '        fields[name][f"heat_{degrees}"] = np.sum(kernels, axis=0)',
        )


def _kernel(script: Script, choice: FieldChoice) -> None:
    if not _has_picks(script):
        return
    chosen = next((each for each in FILTERS if each.name == choice.name), FILTERS[0])
    response = {
        "wave": f"np.exp(-0.5 * (np.log(np.maximum(x, 1e-12)) / {WAVE_WIDTH}) ** 2)",
        "mexican-hat": "x * np.exp(1.0 - x)",
    }[chosen.name]
    _spectrum(script)
    script.say(
        f"    time = {script.state.diffusion.reach!r} / laplacian.weyl_eigenvalue(1)",
        "    x = np.maximum(spectrum.eigenvalues, 0.0) * time",
        f"    weights = {response}  # {chosen.formula}",
        "    at_picks = spectrum.eigenfunctions[picks[name]].sum(axis=0)",
        '    fields[name]["kernel"] = spectrum.eigenfunctions @ (weights * at_picks)',
    )


def _eigenfunction(script: Script, choice: FieldChoice) -> None:
    _spectrum(script)
    script.say(
        f"    index = min({choice.index}, len(spectrum.eigenvalues) - 1)",
        '    fields[name]["eigenfunction"] = spectrum.eigenfunctions[:, index]  # its sign is arbitrary',
    )


def _distance(script: Script, choice: FieldChoice) -> None:
    pick = asked_point(script.state)
    owner = None if pick is None else script.shapes.get(pick.shape)
    if pick is None or owner is None:
        script.say("# No point is picked whose distances could be shown.")
        return
    _descriptor(script, choice.descriptor)
    script.say(
        f"point = descriptors[{owner!r}][{pick.vertex}]",
        "for name in shapes:",
        '    fields[name]["distance"] = np.linalg.norm(descriptors[name] - point, axis=1)',
    )


def _signature(script: Script, choice: FieldChoice) -> None:
    _descriptor(script, choice.descriptor)
    script.say("for name in shapes:", f'    fields[name]["signature"] = descriptors[name][:, {choice.index}]')


def _ambiguity(script: Script, choice: FieldChoice) -> None:
    _descriptor(script, choice.descriptor)
    script.use("add_core.correspondence", "intrinsic_symmetry")
    known = {
        script.shapes[shape.key]: f"{shape.reference.partition('/')[0]}().symmetry"
        for shape in script.state.shown
        if shape.symmetry is not None and shape.reference.partition("/")[0] in SHIPPED
    }
    script.say(
        "known = {" + ", ".join(f"{name!r}: {code}" for name, code in known.items()) + "}  # true mirror maps",
        LOOP,
        "    mirror = known[name] if name in known else intrinsic_symmetry(shape).candidate",
        "    gaps = np.linalg.norm(descriptors[name] - descriptors[name][mirror], axis=1)",
        "    some = descriptors[name][np.unique(np.linspace(0, len(gaps) - 1, min(400, len(gaps))).astype(int))]",
        "    pairs = np.linalg.norm(some[:, None] - some[None], axis=2)[np.triu_indices(len(some), 1)]",
        '    fields[name]["ambiguity"] = gaps / np.median(pairs)',
    )


def _curvature(script: Script, choice: FieldChoice) -> None:
    formula = {
        "max": "frames.max_curvature",
        "min": "frames.min_curvature",
        "mean": "0.5 * (frames.max_curvature + frames.min_curvature)",
        "gaussian": "frames.max_curvature * frames.min_curvature",
        "confidence": "frames.confidence",
    }[choice.name or "max"]
    script.use("add_core.geometry", "TriangleMesh", "principal_curvatures")
    script.say(
        LOOP,
        "    frames = principal_curvatures(shape)",
        f"    values = {formula}",
        "    if isinstance(shape, TriangleMesh):  # from faces to vertices, weighted by area",
        "        corners, areas = shape.faces.ravel(), np.repeat(shape.face_areas, 3)",
        "        total = np.bincount(corners, areas, shape.vertex_count)",
        "        weighted = np.bincount(corners, areas * np.repeat(values, 3), shape.vertex_count)",
        "        values = weighted / np.maximum(total, 1e-300)",
        '    fields[name]["curvature"] = values',
    )


def _file(script: Script, choice: FieldChoice) -> None:
    script.use("add_core.io", "load_fields")
    for shape in script.state.shown:
        if choice.name in shape.fields:
            column = f"[:, {choice.index}]" if shape.fields[choice.name].ndim == 2 else ""
            values = f"load_fields({shape.reference!r})[{choice.name!r}]{column}"
            script.say(f"fields[{script.shapes[shape.key]!r}][{choice.name!r}] = {values}")


def _transfer(script: Script, choice: FieldChoice) -> None:
    _matches(script)
    script.use("add_core.correspondence", "transfer_colors")
    if choice.name == "heat":
        if not _has_picks(script):
            return
        _operator(script, "for name, shape in [(source, shapes[source])]:")
        theta = script.state.diffusion.theta
        script.say(
            f"    colors = sum(heat.kernel(vertex, theta={theta!r}, time=time) for vertex in picks[name])[:, None]"
        )
    else:
        script.use("add_core.drawing", "position_colours")
        script.say("colors = position_colours(shapes[source].vertices)  # sRGB by place")
    script.say(
        "for name, match in matches.items():",
        "    carried = transfer_colors(shapes[source], match, colors=colors).raw",
        '    fields[name]["match"] = match',
        '    fields[name]["transfer"] = carried if carried.shape[1] > 1 else carried[:, 0]',
    )


def _error(script: Script, _choice: FieldChoice) -> None:
    _matches(script)
    script.use("add_core.geometry", "geodesic_distances")
    script.say(
        "for name, match in matches.items():  # where equal numbers are the same place",
        "    truth = np.arange(len(match))",
        "    at, back = np.unique(match, return_inverse=True)",
        "    rows = geodesic_distances(shapes[source], at)",
        '    fields[name]["error"] = rows[back, truth]',
    )


WRITERS: dict[FieldKind, Writer] = {
    "skin": _skin,
    "heat": _heat,
    "rose": _rose,
    "kernel": _kernel,
    "distance": _distance,
    "ambiguity": _ambiguity,
    "eigenfunction": _eigenfunction,
    "signature": _signature,
    "curvature": _curvature,
    "file": _file,
    "transfer": _transfer,
    "error": _error,
}
"""Who writes which kind."""


# -- parts ------------------------------------------------------------------------------------------------------------


def _has_picks(script: Script) -> bool:
    picked: tuple[Pick, ...] = script.state.picks
    if not picked:
        script.say("# No point is picked: there is no heat to show.")
    return bool(picked)


def _operator(script: Script, loop: str = LOOP) -> None:
    """Operator, time and heat flow, within a loop over shapes."""
    diffusion = script.state.diffusion
    script.use("add_core.operators", "AnisotropicLaplacian")
    script.use("add_core.spectra", "HeatFlow")
    script.say(
        f"# α = {diffusion.alpha:g}, θ = {degrees(diffusion.theta):g}°, t·λ₁ = {diffusion.reach:g}",
        loop,
        f"    laplacian = AnisotropicLaplacian(shape, alpha={diffusion.alpha!r}, "
        f'conductivity="{diffusion.conductivity}")',
        f"    time = {diffusion.reach!r} / laplacian.weyl_eigenvalue(1)",
        "    heat = HeatFlow(laplacian)",
    )


def _spectrum(script: Script) -> None:
    """The eigenpairs of one operator, within a loop over shapes."""
    asked = SpectrumQuestion.of(script.state.shown[0], script.state.diffusion)
    counts = {SpectrumQuestion.of(shape, script.state.diffusion).count for shape in script.state.shown}
    script.use("add_core.operators", "AnisotropicLaplacian")
    script.use("add_core.spectra", "compute_spectrum")
    script.say(
        LOOP,
        f'    laplacian = AnisotropicLaplacian(shape, alpha={asked.alpha!r}, conductivity="{asked.conductivity}")',
        f"    spectrum = compute_spectrum(laplacian, theta=np.radians({asked.degrees!r}), count={min(counts)})",
    )


def _descriptor(script: Script, name: str) -> None:
    """`descriptors`: by shape, (n, d)."""
    if not any(plain.name == name for plain in PLAIN):
        script.use("add_core.learning", "load_model")
        script.say(
            f"model = load_model({name!r})",
            "descriptors = {name: np.asarray(model.embed(shape)) for name, shape in shapes.items()}",
        )
        return
    alphas = "(0.0, 50.0)" if name in _DIRECTED else "(0.0,)"
    count = min(COUNT, *(shape.vertex_count for shape in script.state.shown))
    script.use("add_core.spectra", "compute_spectra")
    script.use("add_core.evaluation", "describe_with")
    script.say(
        "descriptors = {",
        f"    name: describe_with({name!r}, compute_spectra(shape, alphas={alphas}, angles=16, count={count}))",
        "    for name, shape in shapes.items()",
        "}",
    )


def _matches(script: Script) -> None:
    """`source`, and `matches`: by shape, (n,) the source vertex of each vertex."""
    state = script.state
    source = script.shapes[state.active_key or ""]
    script.say(f"source = {source!r}")
    if state.matching.method == "true":
        script.say("# Equal numbers are the same place: the shapes share their faces.")
        script.say("matches = {name: np.arange(shape.vertex_count) for name, shape in shapes.items()}")
        return
    _found_matches(script)


def _found_matches(script: Script) -> None:
    matching = script.state.matching
    fewest = min(shape.vertex_count for shape in script.state.shown)
    count, size = min(COUNT, fewest - 1), max(4, min(120, fewest - 1))
    script.use("add_core.spectra", "compute_spectra")
    plain = any(each.name == matching.descriptor for each in PLAIN)
    directed = matching.descriptor in _DIRECTED and matching.method != "functional-map"
    guided = matching.method == "zoomout" and matching.refined and matching.descriptor in UNDIRECTED
    alphas = "(0.0, 50.0)" if directed or guided else "(0.0,)"
    spectra = f"compute_spectra(shape, alphas={alphas}, angles=16, count={count})"
    script.say(f"families = {{name: {spectra} for name, shape in shapes.items()}}")
    if matching.method == "functional-map":
        script.use("add_core.evaluation", "functional_map_matches")
        pair = "functional_map_matches(families[source], family)"
    elif plain:
        script.use("add_core.evaluation", "describe_with")
        script.use("add_core.correspondence", "nearest_matches")
        described = [f"describe_with({matching.descriptor!r}, {family})" for family in ("family", "families[source]")]
        pair = f"nearest_matches({', '.join(described)})"
    else:
        script.use("add_core.learning", "load_model")
        script.use("add_core.correspondence", "nearest_matches")
        script.say(f"model = load_model({matching.descriptor!r})")
        pair = "nearest_matches(model.embed(shapes[name]), model.embed(shapes[source]))"
    script.say(f"matches = {{name: {pair} for name, family in families.items() if name != source}}")
    if matching.refined:
        _refined(script, size)
    script.say("matches[source] = np.arange(shapes[source].vertex_count)")


def _guides(descriptor: str) -> str:
    """What leads ZoomOut to the right side: the descriptor itself, or AHKS, which need not be named."""
    if descriptor in UNDIRECTED or descriptor == "ahks":
        return ""
    if descriptor in _DIRECTED:
        each = (f"describe_with({descriptor!r}, families[{key}])" for key in ("source", "name"))
    else:
        each = (f"model.embed(shapes[{key}])" for key in ("source", "name"))
    return f"guides=({', '.join(each)}), "


def _refined(script: Script, size: int) -> None:
    method = script.state.matching.method
    script.use("add_core.evaluation", "isotropic")
    script.say("one = isotropic(families[source])", "for name, match in matches.items():")
    script.say("    two = isotropic(families[name])")
    if method == "zoomout":
        script.use("add_core.evaluation", "refined_matches")
        guides = _guides(script.state.matching.descriptor)
        options = f"{guides}size={size}" if guides else f"size={size}"
        script.say(
            f"    found = refined_matches(families[source], families[name], match, {options})",
            "    matches[name] = found.match_21",
        )
    else:
        script.use("add_core.correspondence", "FunctionalMap", *(["icp"] if method == "functional-map" else []))
        found = f"FunctionalMap.from_matches(one, two, match, count={size})"
        script.say(f"    matches[name] = {f'icp({found})' if method == 'functional-map' else found}.match_21")
