"""The package as users get it: by pip, with a library that is there, is not there, or is another; with types."""
import importlib.util
import os
import re
import shutil
import subprocess
import sys

import pytest

SOURCE = os.path.join(os.path.dirname(__file__), "..", "..", "python")
SHOW = "import weft; print(weft.version(), weft.Lobe('lambert').id, weft.__file__)"


def run(*command, fails=False, cwd=None, **changed):
    """Runs a command without what this test was given by the environment, and returns what it prints."""
    kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "WEFT_LIBRARY")}
    done = subprocess.run(command, env={**kept, **changed}, cwd=cwd, capture_output=True, text=True)
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture
def copy(tmp_path):
    """A copy of the package's sources, in which pip may leave files."""
    return shutil.copytree(
        SOURCE, tmp_path / "python", ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info")
    )


@pytest.mark.skipif("WEFT_LIBRARY" not in os.environ, reason="WEFT_LIBRARY does not name the library that was built")
@pytest.mark.skipif(
    "WEFT_PRELOAD" in os.environ, reason="pip under sanitizers takes minutes, and tests nothing of ours"
)
def test_pip_installs_it_beside_an_installed_library(tmp_path, copy):
    for module in ("venv", "ensurepip", "setuptools", "wheel"):
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"{module} is not installed: Debian's python3-venv, -setuptools and -wheel")
    library = os.environ["WEFT_LIBRARY"]
    run(sys.executable, "-m", "venv", "--system-site-packages", str(tmp_path / "env"))
    python = str(tmp_path / "env" / "bin" / "python")
    run(python, "-m", "pip", "install", "--no-index", "--no-deps", "--no-build-isolation", str(copy))
    shown = run(python, "-c", SHOW, LD_LIBRARY_PATH=os.path.dirname(library), cwd="/")
    assert re.match(r"\d+\.\d+\.\d+ lambert .*/env/lib/python3.*/site-packages/weft/__init__\.py", shown)
    assert "lambert" in run(python, "-c", SHOW, WEFT_LIBRARY=library)
    assert re.search(r"Version: \d+\.\d+\.\d+", run(python, "-m", "pip", "show", "weft"))
    assert (
        (tmp_path / "env")
        .joinpath("lib", f"python3.{sys.version_info[1]}", "site-packages", "weft", "py.typed")
        .exists()
    )


def test_a_library_that_is_missing_is_named(copy):
    said = run(
        sys.executable, "-c", "import weft", fails=True, PYTHONPATH=str(copy), WEFT_LIBRARY="/nowhere/libweft.so"
    )
    assert "ImportError: /nowhere/libweft.so: the library of weft cannot be loaded" in said and "WEFT_LIBRARY" in said


def test_a_library_of_another_version_is_refused(copy):
    file = copy / "weft" / "_abi.py"
    file.write_text(re.sub(r'VERSION = "\d+\.\d+', 'VERSION = "77.7', file.read_text()))
    said = run(
        sys.executable,
        "-c",
        "import weft",
        fails=True,
        PYTHONPATH=str(copy),
        **{k: os.environ[k] for k in ("WEFT_LIBRARY",) if k in os.environ},
    )
    assert re.search(r"ImportError: .*: is version \d+\.\d+\.\d+ of weft, and this package was made for 77\.7", said)


def test_types_are_complete():
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("mypy is not installed: Debian's package mypy")
    if importlib.util.find_spec("numpy") is None:
        pytest.skip("the types of arrays are NumPy's")
    run(sys.executable, "-m", "mypy", "--strict", "--no-incremental", "--cache-dir", os.devnull, "weft", cwd=SOURCE)


def test_everything_public_says_what_it_is():
    import inspect
    import weft

    for name in weft.__all__:
        thing = getattr(weft, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            assert (thing.__doc__ or "").strip(), name
        if inspect.isclass(thing) and thing.__module__.startswith("weft"):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert (value.__doc__ or "").strip(), f"{name}.{member}"
