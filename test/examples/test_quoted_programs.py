"""The documents quote the programs of examples/; test_documents.py runs what they quote."""

import pytest
from documents import ROOT


@pytest.mark.parametrize(
    ("name", "page"), [("fit_imu_record", "truth"), ("particle_filter", "many")]
)
def test_a_page_quotes_the_program_to_the_letter(name, page):
    _, _, code = (ROOT / f"examples/{name}.py").read_text().partition('"""\n\n')
    assert f"```python\n{code}```" in (ROOT / f"docs/{page}.md").read_text()
