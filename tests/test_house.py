"""The tree as its own tables of contents describe it: docstrings of packages, docs/architecture.md, names that are there once."""

import ast
import collections
import importlib
import itertools
import pathlib
import re
import statistics
import sys
import tomllib
from collections.abc import Iterator

import pytest

ROOT = pathlib.Path(__file__).parents[1]
MODULES = sorted((ROOT / "wm").rglob("*.py"))
PACKAGES = sorted({path.parent for path in MODULES if path.name == "__init__.py"})
ARCHITECTURE = (ROOT / "docs" / "architecture.md").read_text()
SHARED_CLASSES = {"Settings"}
"""Classes that several modules have by design: each backend module has the record of its settings under this name."""
ROOMY = {"wm/offline/furniture", "wm/offline/world/materials"}
"""Catalogues, which may hold more than 22 modules."""


def dotted(package: pathlib.Path) -> str:
    return ".".join(package.relative_to(ROOT).parts)


def submodules(package: pathlib.Path) -> list[str]:
    """The modules and packages of a package, by name."""
    files = [path.stem for path in package.glob("*.py") if path.stem != "__init__"]
    return sorted([*files, *(path.parent.name for path in package.glob("*/__init__.py"))])


def entries(package: pathlib.Path) -> list[tuple[str, str]]:
    """(name, text) of each line of the table in a package's docstring."""
    text = ast.get_docstring(ast.parse((package / "__init__.py").read_text()), clean=False) or ""
    return re.findall(r"^ {4}(\w+)/? +(\S.*)", text, flags=re.MULTILINE)


def rows(section: str) -> list[str]:
    """The rows of the table in a section of docs/architecture.md, without its head."""
    text = ARCHITECTURE.partition(f"## {section}\n")[2].partition("\n## ")[0]
    return [line for line in text.splitlines() if line.startswith("|")][2:]


def classes() -> Iterator[tuple[str, pathlib.Path]]:
    for path in MODULES:
        yield from ((node.name, path) for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ClassDef))


@pytest.mark.parametrize("package", PACKAGES, ids=dotted)
def test_the_docstring_of_a_package_has_one_line_for_each_of_its_modules(package):
    assert sorted(name for name, _ in entries(package)) == submodules(package)


@pytest.mark.parametrize("package", PACKAGES, ids=dotted)
def test_what_the_docstring_of_a_package_says_of_a_module_is_in_it(package):
    for child, text in entries(package):
        names = re.match(r"(\w+(?:, \w+)*):", text)
        module = importlib.import_module(f"{dotted(package)}.{child}")
        for name in names[1].split(", ") if names else ():
            assert hasattr(module, name) or hasattr(importlib.import_module(dotted(package)), name), f"{child} has no {name}"


@pytest.mark.parametrize("package", PACKAGES, ids=dotted)
def test_no_name_of_a_package_hides_one_of_its_modules(package):
    name = dotted(package)
    loaded = importlib.import_module(name)
    for child in submodules(package):
        module = importlib.import_module(f"{name}.{child}")
        assert getattr(loaded, child) is module is sys.modules[f"{name}.{child}"]


def test_no_class_is_defined_twice():
    places = collections.defaultdict(list)
    for name, path in classes():
        places[name].append(str(path.relative_to(ROOT)))
    assert {name: where for name, where in places.items() if len(where) > 1 and name not in SHARED_CLASSES} == {}


def test_files_are_short_and_folders_have_few_modules():
    assert statistics.median(len(path.read_text().splitlines()) for path in MODULES) <= 120
    crowded = [str(path.relative_to(ROOT)) for path in PACKAGES if len(list(path.glob("*.py"))) - 1 > 22]
    assert set(crowded) <= ROOMY


def test_the_architecture_page_has_every_module_of_the_top_and_every_package():
    assert set(re.findall(r"`wm\.(\w+)`", " ".join(rows("Floors")))) == set(submodules(ROOT / "wm"))
    named = set(re.findall(r"\w+", " ".join(row.split("|")[1] for row in rows("Rooms"))))
    for parent in ("geometry", "splat", "synth", "offline"):
        assert {path.name for path in PACKAGES if path.parent == ROOT / "wm" / parent} <= named


def test_the_architecture_page_orders_the_floors_as_the_import_contract_does():
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    layers = next(contract for contract in contracts if contract["name"].startswith("Floors"))["layers"]
    level = {name: number for number, line in enumerate(layers) for name in re.findall(r"[\w.]+", line)}
    page = [[level[name] for name in re.findall(r"`(wm\.\w+)`", row)] for row in rows("Floors")]
    assert all(max(upper) <= min(lower) for upper, lower in itertools.pairwise(page))


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`((?:wm|conf|docs|tests)[/.][\w/.]*)`", ARCHITECTURE))))
def test_what_the_architecture_page_names_is_there(name):
    if "/" in name:
        assert (ROOT / name).exists()
    else:
        module, found = name, None
        while found is None:
            try:
                found = importlib.import_module(module)
            except ModuleNotFoundError:
                module = module.rpartition(".")[0]
        assert found.__name__ == name or hasattr(found, name.removeprefix(f"{module}."))


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`([A-Z][a-z]+[A-Z]\w*)`", ARCHITECTURE))))
def test_records_that_the_architecture_page_names_exist(name):
    assert name in {defined for defined, _ in classes()}
