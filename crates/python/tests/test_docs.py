"""The page about the package: its code runs."""

import re

from conftest import ROOT


def test_the_code_of_the_page_runs(capsys):
    page = (ROOT / "docs/python.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 5
    names = {}
    for block in blocks:
        exec(block, names)
    assert "radius of the disk: 0.3" in capsys.readouterr().out


def test_the_page_names_every_array_of_a_result():
    import vibrissa

    page = (ROOT / "docs/python.md").read_text()
    result = vibrissa.run("disk", world="quasistatic", time_limit_s=0.1)
    assert [name for name in result.ticks if f"`{name}`" not in page] == []
