"""The Rerun viewer: it leaves the home of the user unchanged."""

import sys

from programs import execute

from symtop_ros.playback import viewer


def test_in_a_venv_its_settings_are_there_without_statistics(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "venv"))
    for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME"):
        monkeypatch.delenv(name, raising=False)
    words = [viewer.PROGRAM, "analytics", "config"]
    config = execute(words, env=viewer.settings(), check=True).stdout
    assert '"analytics_enabled": false' in config
    assert not (tmp_path / "home").exists()
