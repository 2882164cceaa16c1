"""What tests leave behind is theirs, and never that of the user's other programs."""

import mmap
import os
import tempfile
import time

import pytest
import traces

from workshop.load import domains

DOMAIN = 14
PORT = 7400 + 250 * DOMAIN + 13


@pytest.fixture(name="found")
def _found(monkeypatch, tmp_path):
    for name in ("home", "shared", "domains"):
        (tmp_path / name).mkdir()
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(traces, "SHARED", tmp_path / "shared")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(domains, "FOLDER", tmp_path / "domains")
    monkeypatch.setattr(domains, "DOMAINS", (DOMAIN,))
    monkeypatch.setattr(domains, "_held", {})
    found = traces.Traces()
    yield found
    for number in list(domains._held):
        domains.release_domain(number)
    found.close()


def claim(monkeypatch, folder):
    """Claim the domain for a run with a temporary folder."""
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    assert domains.claim_domain() == DOMAIN
    domains.release_domain(DOMAIN)


@pytest.mark.parametrize("name", [f"fastrtps_port{PORT}", f"sem.fastrtps_port{PORT}_mutex"])
def test_a_port_of_a_domain_that_the_run_has_claimed_is_left_behind(
    found, name, monkeypatch, tmp_path
):
    claim(monkeypatch, found.folder)
    (tmp_path / "shared" / name).touch()
    assert [path.name for path in found.find()] == [name]


def test_a_port_that_the_process_still_uses_is_not_left_behind_yet(found, monkeypatch, tmp_path):
    claim(monkeypatch, found.folder)
    path = tmp_path / "shared" / f"fastrtps_port{PORT}"
    (tmp_path / "shared" / f"sem.{path.name}_mutex").touch()
    with path.open("w+b") as file:
        file.truncate(4096)
        with mmap.mmap(file.fileno(), 4096):
            assert list(found.find()) == []
    assert len(list(found.find())) == 2


def test_a_port_of_a_domain_of_another_run_is_none_of_the_tests(found, monkeypatch, tmp_path):
    (tmp_path / "shared" / f"fastrtps_port{PORT}").touch()
    assert list(found.find()) == []  # of a program that claims nothing
    claim(monkeypatch, tmp_path / "other")
    assert list(found.find()) == []


def test_a_port_that_was_there_before_the_claim_is_none_of_the_tests(found, monkeypatch, tmp_path):
    (tmp_path / "shared" / f"fastrtps_port{PORT}").touch()
    claim(monkeypatch, found.folder)
    later = time.time() + 60
    os.utime(tmp_path / "domains" / str(DOMAIN), (later, later))  # clocks of files are coarse
    assert list(found.find()) == []


@pytest.mark.parametrize("name", ["fastrtps_24276a90ab4376da", "psm_12345678", "other"])
def test_files_of_which_nobody_can_say_who_made_them_are_none_of_the_tests(
    found, name, monkeypatch, tmp_path
):
    claim(monkeypatch, found.folder)
    (tmp_path / "shared" / name).touch()
    assert list(found.find()) == []


def test_only_names_that_tests_may_write_are_looked_for_in_the_home(found, tmp_path):
    for name in ("notes.txt", ".viminfo", ".rerun", ".ros"):
        (tmp_path / "home" / name).touch()
    assert [path.name for path in found.find()] == [".rerun", ".ros"]


def test_shared_memory_of_a_browser_process_that_was_ended_is_not_blamed_on_tests(found):
    (found.folder / ".org.chromium.Chromium.ffeps5").write_bytes(bytes(4096))
    (found.folder / "left").touch()
    assert [path.name for path in found.find()] == ["left"]
    (found.folder / "left").unlink()
