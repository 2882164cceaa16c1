"""Rerun's own MCAP reader finds no fault in our logs."""

import pytest
from log_files import LAYOUTS, Run, topic
from programs import execute
from run.log.test_bag import split_with_heads

from symtop_ros.replay import viewer
from symtop_ros.run.log.catalog import read_catalog
from symtop_ros.run.log.names import Names
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.repair import repair


@pytest.mark.parametrize("part", [1.0, 0.75, 0.5])
def test_rerun_finds_no_fault_in_a_log_that_is_complete_or_repaired(part, tmp_path):
    content = Run(seconds=1.0, described=True).write(tmp_path).read_bytes()
    (path := tmp_path / "cut.mcap").write_bytes(content[: round(part * len(content))])
    if part < 1:
        assert execute([viewer.PROGRAM, "mcap", "check", path]).returncode == 1
        file = McapFile(path)
        repair(file, path := tmp_path / "repaired.mcap", read_catalog(file, Names(file)))
    done = execute([viewer.PROGRAM, "mcap", "check", "--full", path])
    assert done.returncode == 0, done.stdout
    assert all(topic(name) in done.stdout for name in LAYOUTS)


def test_rerun_finds_no_fault_in_a_split_bag_with_repeated_latched_messages(tmp_path):
    files = sorted(split_with_heads(tmp_path).glob("*.mcap"))
    assert len(files) == 3
    for path in files:
        done = execute([viewer.PROGRAM, "mcap", "check", "--full", path])
        assert done.returncode == 0, done.stdout
        assert all(topic(name) in done.stdout for name in LAYOUTS)
