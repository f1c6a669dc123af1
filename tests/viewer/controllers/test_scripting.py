"""The script is run, and its numbers are those of the window."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from add_core.evaluation import describe_with
from add_core.geometry import shapes
from add_core.io import load_fields, load_shape, save_shape
from add_core.operators import AnisotropicLaplacian
from add_core.spectra import compute_spectra, compute_spectrum
from add_viewer.controllers.carrying import carried_picks
from add_viewer.controllers.fields_of_geometry import at_vertices, curvature
from add_viewer.controllers.kernel import KernelController
from add_viewer.controllers.opening import read_shape
from add_viewer.controllers.operators import OperatorStore
from add_viewer.controllers.script_fields import WRITERS
from add_viewer.controllers.scripting import script_of
from add_viewer.models.display import Display
from add_viewer.models.fields import FIELD_KINDS
from add_viewer.models.results import Results
from add_viewer.models.session import Session


@pytest.fixture
def session(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Session:
    """Two tori from files with one connectivity, a point and its partner picked on the second, which is the source."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ADD_CACHE_DIR", str(tmp_path))
    made = Session()
    for number, minor in enumerate((0.3, 0.4)):
        ring = shapes.torus(major=1.0, minor=minor, around=24, through=12)
        path = tmp_path / f"ring {number}.ply"
        save_shape(ring, path, fields={"height": ring.vertices[:, 2]})
        made.add_shape(replace(read_shape(str(path)), name="Ring, wide"))
    made.diffuse(alpha=7.0, theta=0.7, reach=0.05)
    made.pick(17)
    made.pick_partner(17, 130)
    return made


def fields_of(session: Session) -> dict[str, dict[str, np.ndarray]]:
    """What the script saves, by shape and name."""
    carried = carried_picks(session.state, {})
    script = script_of(session.state, carried, WRITERS)
    assert "add_viewer" not in script
    exec(compile(script, "script.py", "exec"), {"__name__": "__main__"})
    names = ("ring-wide", "ring-wide-2")
    return {
        shape.key: load_fields(f"{name}.ply") if Path(f"{name}.ply").exists() else {}
        for shape, name in zip(session.state.shapes, names, strict=True)
    }


def test_heat_of_the_script_is_the_heat_of_the_window(session, run):
    results = Results()
    KernelController(session, results, Display(), run, OperatorStore())
    session.diffuse(theta=0.9)
    run.answer_all()
    source = session.state.shapes[1]
    (heat,) = fields_of(session)[source.key].values()
    assert results.kernel is not None
    np.testing.assert_allclose(heat, results.kernel.values, rtol=2e-3, atol=2e-4 * heat.max())


def test_curvature_of_the_script_is_that_of_the_window(session):
    session.choose_field(kind="curvature", name="gaussian")
    for shape in session.state.shapes:
        frames = AnisotropicLaplacian(shape.shape, alpha=0.0).frames
        expected = at_vertices(shape.shape, curvature(frames, "gaussian"))
        np.testing.assert_allclose(fields_of(session)[shape.key]["curvature"], expected, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("name", ["hks", "ahks"])
def test_distances_of_the_script_are_those_between_compared_descriptors(session, name):
    session.choose_field(kind="distance", descriptor=name)
    one, two = session.state.shapes
    alphas = (0.0,) if name == "hks" else (0.0, 50.0)
    described = [
        describe_with(name, compute_spectra(shape.shape, alphas=alphas, count=shape.vertex_count))
        for shape in (one, two)
    ]
    expected = np.linalg.norm(described[0] - described[1][17], axis=1)
    np.testing.assert_allclose(fields_of(session)[one.key]["distance"], expected, rtol=1e-4, atol=1e-5)


def test_an_eigenfunction_of_the_script_is_that_of_the_operator(session):
    session.choose_field(kind="eigenfunction", index=3)
    shape = session.state.shapes[0]
    angle = np.radians(round(2 * np.degrees(0.7)) / 2)
    laplacian = AnisotropicLaplacian(shape.shape, alpha=7.0)
    expected = compute_spectrum(laplacian, theta=angle, count=shape.vertex_count - 1).eigenfunctions[:, 3]
    found = fields_of(session)[shape.key]["eigenfunction"]
    assert abs(np.corrcoef(found, expected)[0, 1]) == pytest.approx(1.0, abs=1e-4)


def test_a_field_of_the_file_is_read_from_it(session):
    session.choose_field(kind="file", name="height")
    for shape in session.state.shapes:
        height = load_shape(shape.reference).vertices[:, 2]
        np.testing.assert_allclose(fields_of(session)[shape.key]["height"], height, atol=1e-6)


@pytest.mark.parametrize("kind", FIELD_KINDS)
def test_every_kind_of_field_makes_a_script_that_runs(session, kind):
    session.choose_field(kind=kind, name={"file": "height"}.get(kind, ""))
    fields = fields_of(session)
    assert all(fields.values()) or kind == "skin"
    assert all(np.isfinite(values).all() for own in fields.values() for values in own.values())


@pytest.mark.parametrize("method", ["nearest", "functional-map", "zoomout"])
@pytest.mark.parametrize("refined", [False, True])
def test_every_matching_makes_a_script_that_runs(session, method, refined):
    session.choose_field(kind="transfer")
    session.match(method=method, refined=refined, descriptor="hks")
    target, source = session.state.shapes
    match = fields_of(session)[target.key]["match"].astype(int)
    assert match.shape == (target.vertex_count,)
    assert match.max() < source.vertex_count


def test_shipped_shapes_and_trained_models_are_named_as_the_core_names_them(session, make_torus):
    session.add_shape(replace(make_torus("humans/3"), reference="humans/3"))
    session.choose_field(kind="distance", descriptor="humans-madd3")
    session.pick(5)
    script = script_of(session.state, {}, WRITERS)
    assert "normalize(humans()[3])" in script
    assert "load_model('humans-madd3')" in script
    compile(script, "script.py", "exec")


def test_nothing_shown_is_no_script():
    assert script_of(Session().state, {}, WRITERS) == ""
