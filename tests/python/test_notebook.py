"""The notebook runs from its first cell to its last, and shows plots. Its own lines assert what its words say."""
import os

import pytest

NOTEBOOK = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "notebook", "cloth.ipynb")
for module, package in (
    ("numpy", "numpy"),
    ("matplotlib", "matplotlib"),
    ("nbformat", "nbformat"),
    ("nbclient", "nbclient"),
    ("ipykernel", "ipykernel"),
):
    pytest.importorskip(module, reason=f"{module} is not installed: Debian's python3-{package} has it")


def test_the_notebook_tells_the_cloth_problem_with_plots(tmp_path):
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells)  # it is kept without what it shows
    os.environ.pop("MPLBACKEND", None)  # plots are shown in the notebook
    os.environ.update(JUPYTER_RUNTIME_DIR=str(tmp_path), IPYTHONDIR=str(tmp_path), MPLCONFIGDIR=str(tmp_path))
    NotebookClient(notebook, timeout=240, resources={"metadata": {"path": str(tmp_path)}}).execute()
    plots = [
        output for cell in notebook.cells for output in cell.get("outputs", ()) if "image/png" in output.get("data", {})
    ]
    assert len(plots) == 5
    if os.environ.get("WEFT_TEST_KEEP"):
        nbformat.write(notebook, os.path.join(os.environ["WEFT_TEST_KEEP"], "cloth.ipynb"))
