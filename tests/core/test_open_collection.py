"""Folders laid out as FAUST, SCAPE and TOSCA are, made from shipped shapes, and folders of anything."""

import shutil

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.io import savemat

from add_core.errors import ParameterError, ShapeFileError
from add_core.geometry import TriangleMesh
from add_core.geometry.shapes import rectangle, sphere
from add_core.io import dogs, humans, open_collection, poses, save_shape


def write_column(path, numbers):
    path.parent.mkdir(exist_ok=True)
    path.write_text("".join(f"{number}\n" for number in numbers))


@pytest.fixture(scope="module")
def faust(tmp_path_factory):
    """Two subjects to train on and two to test on, in two poses, where FAUST unpacks them, scans beside them."""
    top = tmp_path_factory.mktemp("data") / "MPI-FAUST"
    folder = top / "training" / "registrations"
    folder.mkdir(parents=True)
    for number in (0, 1, 70, 71, 80, 81, 90, 91):
        save_shape(humans()[number], folder / f"tr_reg_{number:03}.ply")
    (folder / "tr_reg_000.png").write_bytes(b"picture")
    (top / "training" / "scans").mkdir()
    save_shape(sphere(1), top / "training" / "scans" / "tr_scan_000.ply")
    write_column(folder / "symmetry.txt", humans().symmetry + 1)
    return top


def test_faust_is_split_by_subject(faust):
    collection = open_collection(faust)
    assert collection.title == "FAUST"
    assert collection.names[2] == "subject 8, pose 1"
    assert_array_equal(collection.split("train"), [0, 1, 2, 3])
    assert_array_equal(collection.split("test"), [4, 5, 6, 7])
    assert (collection.unit, collection.up, collection.front) == ("m", "+y", "+z")
    assert "non-commercial" in collection.licence


def test_faust_corresponds_vertex_by_vertex_and_has_its_mirror_map(faust):
    collection = open_collection(faust / "training" / "registrations")
    assert_array_equal(collection[3].vertices, humans()[71].vertices)
    assert_array_equal(collection.correspondence(0, 7), np.arange(6890))
    assert_array_equal(collection.symmetry, humans().symmetry)


def test_scape_trains_on_shapes_10_to_70(tmp_path):
    for number in (0, 9, 10, 50, 52, 70, 71):
        save_shape(poses()[min(number, 70)], tmp_path / f"mesh{number:03}.off")
    collection = open_collection(tmp_path)
    assert collection.title == "SCAPE"
    assert_array_equal(collection.split("train"), [2, 3, 4, 5])
    assert_array_equal(collection.split("test"), [0, 1, 6])
    assert collection.poses[1] == "pose 9"


def _tosca_matlab(path, mesh):
    x, y, z = mesh.vertices.T
    savemat(path, {"surface": {"X": x[:, None], "Y": y[:, None], "Z": z[:, None], "TRIV": mesh.faces + 1.0}})


@pytest.mark.parametrize("kind", ["off", "mat", "vert"])
def test_tosca_keeps_kinds_apart_in_every_form(tmp_path, kind):
    dog, cat = dogs()[0], sphere(2)
    for name, mesh in (("dog0", dog), ("dog10", dogs()[5]), ("dog2", dogs()[7]), ("cat0", cat)):
        if kind == "mat":
            _tosca_matlab(tmp_path / f"{name}.mat", mesh)
        elif kind == "vert":
            np.savetxt(tmp_path / f"{name}.vert", mesh.vertices, fmt="%.17g")
            np.savetxt(tmp_path / f"{name}.tri", mesh.faces + 1, fmt="%d")
        else:
            save_shape(mesh, tmp_path / f"{name}.off")
    collection = open_collection(tmp_path)
    assert collection.title == "TOSCA"
    assert collection.names == ("cat 0", "dog 0", "dog 2", "dog 10")
    assert collection.subjects == ("cat", "dog", "dog", "dog")
    assert_array_equal(collection[1].vertices, dog.vertices)
    assert_array_equal(collection[1].faces, dog.faces)
    assert_array_equal(collection.correspondence(1, 3), np.arange(6890))
    with pytest.raises(ParameterError, match="cat 0 and dog 0 have different faces and no correspondence file"):
        collection.correspondence(0, 1)
    with pytest.raises(ParameterError, match="TOSCA has no customary split"):
        collection.split("train")
    assert open_collection(tmp_path, only="dog*").names == ("dog 0", "dog 2", "dog 10")


def test_one_of_several_formats_of_a_shape_is_taken(tmp_path):
    save_shape(sphere(1), tmp_path / "cat0.off")
    _tosca_matlab(tmp_path / "cat0.mat", sphere(2))
    collection = open_collection(tmp_path)
    assert len(collection) == 1
    assert collection[0].vertex_count == sphere(1).vertex_count


def _shuffled(mesh, seed):
    """The same surface with its vertices renumbered, and the new number of each old vertex."""
    number = np.random.default_rng(seed).permutation(mesh.vertex_count)
    vertices = np.empty_like(mesh.vertices)
    vertices[number] = mesh.vertices
    return TriangleMesh(vertices, number[mesh.faces]), number


@pytest.mark.parametrize("base", [0, 1])
@pytest.mark.parametrize("place", [".", "corres", "../corres"])
def test_vts_files_lead_through_the_template(tmp_path, base, place):
    """Line k is the vertex at place k of a template of 50 places; the others have no counterpart."""
    shapes, numbers = zip(*(_shuffled(rectangle(2.0, 1.0, n=6), seed) for seed in (1, 2)), strict=True)
    folder = tmp_path / "off"
    folder.mkdir()
    for name, mesh, number in zip("ab", shapes, numbers, strict=True):
        save_shape(mesh, folder / f"{name}.off")
        write_column(folder / place / f"{name}.vts", number[: 50 if base == 1 else 91] + base)
    places = 50 if base == 1 else 91
    expected = np.full(91, -1)
    expected[numbers[0][:places]] = numbers[1][:places]
    assert_array_equal(open_collection(folder).correspondence(0, 1), expected)


def test_map_files_lead_through_the_template(tmp_path):
    """Line v is the place of vertex v; two vertices may share a place, and then the first answers."""
    save_shape(rectangle(1.0, 1.0, n=1), tmp_path / "a.off")
    save_shape(rectangle(1.0, 1.0, n=1), tmp_path / "b.off")
    write_column(tmp_path / "a.map", [1, 2, 3, 7])
    write_column(tmp_path / "b.map", [3, 3, 1, 9])
    collection = open_collection(tmp_path)
    assert_array_equal(collection.correspondence(0, 1), [2, -1, 0, -1])
    assert_array_equal(collection.correspondence(1, 0), [2, 2, 0, -1])
    assert collection.symmetry is None


@pytest.mark.parametrize(
    ("files", "complaint"),
    [
        ({"a.vts": [1, 2]}, r"1 of 2 .vts files are missing \(first: b.vts\)"),
        ({"a.vts": [1, 2], "b.vts": [1, 99]}, "b.vts: names vertex 99, but the shape has 4"),
        ({"a.map": [1, 2], "b.map": [1, 2]}, "a.map: holds 2 lines, but the shape has 4 vertices"),
        ({"a.vts": [1, 2], "b.vts": [1, -2]}, "b.vts: holds a negative number"),
        ({"a.vts": [1, 2], "b.vts": ["x"]}, "b.vts: line 1 should be the number of a vertex"),
        ({"a.vts": [1, 2], "b.vts": []}, "b.vts: holds no numbers"),
        ({"symmetry.txt": [2, 3, 1, 4]}, "symmetry.txt: is no mirror map"),
    ],
)
def test_wrong_correspondence_files_are_explained(tmp_path, files, complaint):
    for name in "ab":
        save_shape(rectangle(1.0, 1.0, n=1), tmp_path / f"{name}.off")
    for name, numbers in files.items():
        write_column(tmp_path / name, numbers)
    with pytest.raises(ShapeFileError, match=complaint):
        [open_collection(tmp_path).correspondence(i, 1 - i) for i in (0, 1)]


def test_any_folder_of_one_connectivity_is_a_collection(tmp_path):
    for number in (1, 2, 10):
        save_shape(dogs()[number], tmp_path / f"frame {number}.ply")
    collection = open_collection(tmp_path)
    assert collection.names == ("frame 1", "frame 2", "frame 10")
    assert collection.title == tmp_path.name
    assert (collection.subjects, collection.training, collection.up) == (None, None, "")
    assert_array_equal(collection.correspondence(0, 2), np.arange(6890))


def test_a_missing_data_set_says_where_to_get_it(tmp_path):
    with pytest.raises(ShapeFileError) as error:
        open_collection(tmp_path / "FAUST")
    for words in ("there is no such folder", "Nothing is downloaded", "http://faust.is.tue.mpg.de", "non-commercial"):
        assert words in str(error.value)
    assert "TOSCA" not in str(error.value)
    (tmp_path / "shapes").mkdir()
    with pytest.raises(ShapeFileError, match=r"holds no shapes.*FAUST.*SCAPE.*TOSCA"):
        open_collection(tmp_path / "shapes")


def test_an_ambiguous_folder_asks_for_one(tmp_path):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        save_shape(sphere(1), tmp_path / name / "ball.off")
    with pytest.raises(ShapeFileError, match=r"several folders in it hold shapes \(one, two\). Open one of them"):
        open_collection(tmp_path)
    shutil.rmtree(tmp_path / "two")
    assert open_collection(tmp_path).names == ("ball",)
    with pytest.raises(ShapeFileError, match=r"no shape in it is named cat\*"):
        open_collection(tmp_path, only="cat*")
    with pytest.raises(ShapeFileError, match="is a file, not a folder"):
        open_collection(tmp_path / "one" / "ball.off")


def test_a_damaged_shape_is_met_when_it_is_asked_for(faust, tmp_path):
    folder = tmp_path / "copy"
    shutil.copytree(faust / "training" / "registrations", folder)
    (folder / "tr_reg_071.ply").write_bytes(b"ply\nformat ascii 1.0\n")
    collection = open_collection(folder)
    assert collection[0].vertex_count == 6890
    with pytest.raises(ShapeFileError, match=r"tr_reg_071\.ply: has no line end_header"):
        collection[3]


def test_matlab_files_without_a_surface_are_explained(tmp_path):
    from add_core.io import load_shape

    savemat(tmp_path / "a.mat", {"spectrum": np.arange(3.0)})
    with pytest.raises(ShapeFileError, match=r"holds no surface with VERT \(or X, Y, Z\) and TRIV, only spectrum"):
        load_shape(tmp_path / "a.mat")
    (tmp_path / "b.mat").write_bytes((tmp_path / "a.mat").read_bytes()[:150])
    with pytest.raises(ShapeFileError, match=r"b\.mat: claims 80 bytes of numbers, but only 14 follow. Is it cut off"):
        load_shape(tmp_path / "b.mat")
    savemat(tmp_path / "c.mat", {"VERT": np.eye(3), "TRIV": np.array([[1, 2, 3]])})
    assert load_shape(tmp_path / "c.mat").area == pytest.approx(np.sqrt(3) / 2)
    (tmp_path / "d.vert").write_text("0 0 0\n1 0 0\n0 1 0\n")
    with pytest.raises(ShapeFileError, match=r"needs its faces in d\.tri beside it"):
        load_shape(tmp_path / "d.vert")


@pytest.mark.parametrize("base", [0, 1])
@pytest.mark.parametrize("place", [".", "../groundtruth", "../corres"])
def test_map_files_of_pairs_lead_from_the_first_to_the_second(tmp_path, base, place):
    """SHREC'19 has a file for each pair that it compares, and none for the others."""
    shapes, numbers = zip(*(_shuffled(rectangle(2.0, 1.0, n=6), seed) for seed in (1, 2)), strict=True)
    folder = tmp_path / "off"
    folder.mkdir()
    for name, mesh in zip(("1", "2"), shapes, strict=True):
        save_shape(mesh, folder / f"{name}.off")
    expected = numbers[1][np.argsort(numbers[0])]
    write_column(folder / place / "1_2.map", expected + base)
    collection = open_collection(tmp_path if place != "." else folder)
    assert_array_equal(collection.correspondence(0, 1), expected)
    assert_array_equal(collection.correspondence(1, 1), np.arange(91))
    assert collection.symmetry is None
    with pytest.raises(ParameterError, match="2 and 1 have different faces and no correspondence file"):
        collection.correspondence(1, 0)


@pytest.mark.parametrize(
    ("lines", "complaint"),
    [
        ([1, 2, 3], "a_b.map: holds 3 lines, but a has 4 vertices"),
        ([1, 2, 3, 5], "a_b.map: names vertex 5, but b has 4"),
        ([1, 2, 3, -1], "a_b.map: holds a negative number"),
    ],
)
def test_wrong_files_of_pairs_are_explained(tmp_path, lines, complaint):
    for name in "ab":
        save_shape(rectangle(1.0, 1.0, n=1), tmp_path / f"{name}.off")
    write_column(tmp_path / "a_b.map", lines)
    with pytest.raises(ShapeFileError, match=complaint):
        open_collection(tmp_path).correspondence(0, 1)


def test_a_zero_among_numbers_that_count_from_one_is_no_counterpart(tmp_path):
    for name in "ab":
        save_shape(rectangle(1.0, 1.0, n=1), tmp_path / f"{name}.off")
    write_column(tmp_path / "a_b.map", [4, 0, 1, 2])
    assert_array_equal(open_collection(tmp_path).correspondence(0, 1), [3, -1, 0, 1])


def test_a_collection_takes_one_number_at_a_time(tmp_path):
    save_shape(rectangle(1.0, 1.0, n=1), tmp_path / "a.off")
    with pytest.raises(ParameterError, match=r"index must be the number of one shape, but it is slice\(0, 1, None\)"):
        open_collection(tmp_path)[0:1]
