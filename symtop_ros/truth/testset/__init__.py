"""`top_testset`: seventy motions of heavy tops to 30 digits, packed, and their scorer.

`folders.py` writes the set or a problem for engines, with models from `run/models` and programs
from `snippets.py`; `scoreboard.py` compares many scores. `score.py` stands alone in each copied
folder; the judge takes angles between attitudes from it.
"""
