"""The page on Python is executed, and shows what it says."""
import os
import re

import pytest

PAGE = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "python.md")
pytest.importorskip("numpy")


def test_the_page_does_what_it_shows(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", open(PAGE, encoding="utf-8").read(), re.M | re.S)
    assert len(blocks) > 5
    printed, names = [], {}
    names["print"] = lambda *values: printed.append(" ".join(map(str, values)))
    for block in blocks:
        exec(compile(block, PAGE, "exec"), names)
    shown = re.findall(r"^ *print\(.*\) +# (.*)$", "".join(blocks), re.M)
    assert printed == shown
    assert (tmp_path / "velvet.png").exists() and (tmp_path / "velvet-1.exr").exists()
