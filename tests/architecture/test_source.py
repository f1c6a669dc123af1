"""How the source reads: short modules with one noun each, and nothing public without an explanation."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MOST_LINES_OF_A_MODULE = 400
MOST_LINES_OF_A_FUNCTION = 45  # without its docstring
NAMELESS = {"utils", "util", "helpers", "helper", "common", "manager", "misc"}
ARRAY = re.compile(r"FloatArray|IntArray|BoolArray|NDArray|ndarray|ArrayLike|csr_array|csc_array|Tensor")
SHAPE = re.compile(r"\((\w|[·*+−()]| (?=[+−]|\d))+,|shape")  # (n, 3), (m,), (N + 1,), (len(sources), n), "of one shape"
STARTERS = {"QThread", "QThreadPool", "QRunnable", "QProcess"}

Function = ast.FunctionDef | ast.AsyncFunctionDef
Definition = Function | ast.ClassDef


def sources(*folders: str) -> list[str]:
    """Python files under the project's `folders`, as paths from its root."""
    return sorted(str(path.relative_to(ROOT)) for folder in folders for path in (ROOT / folder).rglob("*.py"))


CORE = sources("add_core")
VIEWER = sources("add_viewer")
ALL = sources("add_core", "add_viewer", "tests", "assets")


def tree_of(source: str) -> ast.Module:
    return ast.parse((ROOT / source).read_text(encoding="utf-8"))


def public(body: list[ast.stmt]) -> Iterator[Definition]:
    return (node for node in body if isinstance(node, Definition) and not node.name.startswith("_"))


def offered_by(package: str) -> set[str]:
    """The names in `__all__` of a package."""
    for node in tree_of(package).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return set(ast.literal_eval(node.value))
    return set()


OFFERED = set().union(*(offered_by(source) for source in CORE if source.endswith("__init__.py")))


def public_with_methods(tree: ast.Module, among: set[str] | None = None) -> Iterator[Definition]:
    """Public classes and functions, and the public methods of those classes, unless they complete another's."""
    for node in public(tree.body):
        if among is not None and node.name not in among:
            continue
        yield node
        if isinstance(node, ast.ClassDef):
            yield from (method for method in public(node.body) if not is_completed_elsewhere(method))


def is_completed_elsewhere(method: Definition) -> bool:
    decorators = {ast.unparse(decorator).rpartition(".")[2] for decorator in method.decorator_list}
    return bool(decorators & {"setter", "overload", "override"})


def is_plain_property(node: Definition) -> bool:
    """A property of one line, which its name and type explain: `vertex_count`."""
    lines = [line for line in node.body if not isinstance(line, ast.Expr)]
    return "property" in map(ast.unparse, node.decorator_list) and len(lines) == 1


def annotations(node: Definition) -> str:
    """The types that a function takes and gives, or that a class holds."""
    if isinstance(node, ast.ClassDef):
        types = [field.annotation for field in node.body if isinstance(field, ast.AnnAssign)]
    else:
        arguments = node.args
        every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
        types = [*(argument.annotation for argument in every), node.returns]
    return " ".join(ast.unparse(annotation) for annotation in types if annotation)


@pytest.mark.parametrize("source", ALL)
def test_a_module_is_short_has_a_noun_and_says_what_it_is_for(source):
    lines = (ROOT / source).read_text(encoding="utf-8").splitlines()
    assert len(lines) <= MOST_LINES_OF_A_MODULE
    assert not NAMELESS & set(Path(source).stem.lower().split("_")), "a name that says nothing"
    assert not lines or ast.get_docstring(tree_of(source)), "the module does not say what it is for"


@pytest.mark.parametrize("source", CORE + VIEWER)
def test_a_function_holds_one_thought(source):
    for node in ast.walk(tree_of(source)):
        if isinstance(node, Function):
            code = node.body[1:] if ast.get_docstring(node) else node.body
            length = code[-1].end_lineno - code[0].lineno + 1 if code else 0
            assert length <= MOST_LINES_OF_A_FUNCTION, f"{node.name} has {length} lines"


@pytest.mark.parametrize("source", CORE)
def test_everything_public_in_the_core_is_explained(source):
    """Every class and function without an underscore, and every method of the classes that a package offers."""
    tree = tree_of(source)
    definitions = {*public(tree.body), *public_with_methods(tree, among=OFFERED)}
    silent = [node for node in definitions if not ast.get_docstring(node)]
    assert not [node.name for node in silent if not is_plain_property(node)]


@pytest.mark.parametrize("source", VIEWER)
def test_every_class_and_function_of_the_viewer_is_explained(source):
    assert not [node.name for node in public(tree_of(source).body) if not ast.get_docstring(node)]


@pytest.mark.parametrize("source", CORE)
def test_whoever_meets_an_array_in_the_core_is_told_its_shape(source):
    """Every name that a package of the core offers, with its methods; a module's inner workings may be terser."""
    untold = [
        node.name
        for node in public_with_methods(tree_of(source), among=OFFERED)
        if ARRAY.search(annotations(node)) and not SHAPE.search(ast.get_docstring(node) or "")
        if not is_plain_property(node)
    ]
    assert not untold


@pytest.mark.parametrize("source", [source for source in VIEWER if "/tasks/" not in source])
def test_only_tasks_start_threads_and_processes(source):
    """import-linter sees modules; these are names inside PySide6.QtCore."""
    names = {node.id for node in ast.walk(tree_of(source)) if isinstance(node, ast.Name)}
    imported = {
        alias.name for node in ast.walk(tree_of(source)) if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    assert not STARTERS & (names | imported)
