"""Runs of random sessions of a node, read by the page."""

import json
from functools import partial

import pytest
from drawn import Numbers
from session.test_random_sessions import move
from trials import seeds

from symtop_ros.log.top_log import TopLog, open_run
from symtop_ros.simulation.run_file import record_run, write_run


def has_read(opened, content):
    run = opened.read_run()
    return run["events"] == content["events"] and run["end"] >= content["end"]


@pytest.mark.parametrize("first", seeds(1, 25))
def test_the_page_reads_the_runs_of_sessions_as_python_wrote_them(opened, tmp_path, first):
    for seed in range(12 * first, 12 * (first + 1)):
        folder = tmp_path / str(seed)
        folder.mkdir()
        path, stamp = move(Numbers(seed), folder)
        content = write_run(*record_run(TopLog(open_run([path])).events(), stamp))
        content = json.loads(json.dumps(content))
        opened.drop(content)
        opened.until(partial(has_read, opened, content))
