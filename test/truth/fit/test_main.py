"""`top_fit` as its users call it."""

import json
import re

import numpy as np
import pytest
from drawn import Numbers
from truth.fit.cases import CUSPS, TIMES, make_axis, write_table

from symtop_ros import __version__
from symtop_ros.base.progress import Progress
from symtop_ros.physics import Motion, apply_impulse, specific_force
from symtop_ros.truth.fit.main import find_camera, main, make_parser
from symtop_ros.truth.imu.main import main as imu_main
from workshop.fit.records import see

FAR = 5.0  # deviations; a normal number is farther once in two million


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    return write_table(tmp_path_factory.mktemp("fit") / "axis.csv", make_axis())


@pytest.mark.slow
def test_the_text_has_each_number_of_the_json(table, capsys):
    assert main([str(table)]) == 0
    text = capsys.readouterr().out
    assert main([str(table), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert list(facts)[:2] == ["schema", "version"]
    assert facts["version"] == __version__
    rows = re.findall(r"^  (\S+).*? (-?[\d.]+) \+- ([\d.]+)", text, re.M)
    names = {"theta'": "theta_dot", "phi'": "phi_dot", "mean": "mean_precession_rate"}
    names["nutation"] = "nutation_period"
    assert len(rows) == len(facts["values"])
    for name, value, deviation in rows:
        number = facts["values"][names.get(name, name)]
        # half of the last of two digits
        assert abs(float(value) - number["value"]) <= 0.051 * number["deviation"]
        assert abs(float(deviation) - number["deviation"]) <= 0.051 * number["deviation"]
        assert len(value.partition(".")[2]) == len(deviation.partition(".")[2])
    assert facts["model"]["verdict"] == "holds"
    assert all(each["text"] in text for each in facts["unknown"])


@pytest.mark.slow
def test_the_example_comes_along_and_is_not_overwritten(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["--example", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert abs(facts["values"]["Mgl/Ix"]["value"] - 0.068 / 0.000228) < 0.5
    (tmp_path / "example.csv").write_text("mine")
    assert main(["--example"]) == 1
    assert (tmp_path / "example.csv").read_text() == "mine"


def test_a_record_of_top_imu_gives_its_top_back(tmp_path, capsys):
    path = str(tmp_path / "imu.csv")
    arguments = ["--scene", "cusps", "--seconds", "2", "--noise", "consumer", "-o", path]
    assert imu_main(arguments) == 0
    capsys.readouterr()
    assert main([path, "--kind", "rates", "--json"]) == 0
    values = json.loads(capsys.readouterr().out)["values"]
    for name, truth in {"Mgl/Ix": 0.068 / 0.000228, "Iz/Ix": 0.0000572 / 0.000228}.items():
        assert abs(values[name]["value"] - truth) < 5 * values[name]["deviation"]
        assert values[name]["deviation"] < 1e-4 * truth


@pytest.mark.slow
def test_friction_that_was_not_looked_for_is_hinted_at(tmp_path, capsys):
    path = str(tmp_path / "imu.csv")
    assert (
        imu_main(["--scene", "friction", "--seconds", "1", "--noise", "consumer", "-o", path]) == 0
    )
    capsys.readouterr()
    assert main([path, "--kind", "rates"]) == 1
    out = capsys.readouterr().out
    assert "does not hold without friction" in out
    assert {"axial/Iz", "Mgl/Ix"} <= {*read_rows(out)}
    assert main([path, "--kind", "rates", "--friction"]) == 0
    assert "--friction" not in capsys.readouterr().out


@pytest.mark.slow
def test_a_kick_is_named_with_its_place(tmp_path, capsys):
    state = CUSPS.at(1.0)
    kicked = Motion(CUSPS.top, apply_impulse(CUSPS.top, state, (3.0, 0.0, 0.0)))
    before, after = TIMES[TIMES < 1.0], TIMES[TIMES >= 1.0]
    rows = [make_axis(times=before), make_axis(kicked, after - 1.0, seed=3)]
    path = write_table(tmp_path / "kick.csv", np.concatenate(rows))
    assert main([str(path)]) == 1
    found = read_rows(capsys.readouterr().out)
    value, deviation = found["kick after"]
    assert abs(value - 1.0) < FAR * deviation < 8 / 128  # rows that it takes to leave the noise
    value, deviation = found["change of the rates"]
    assert abs(value - 3.0) < FAR * deviation < 0.5
    value, deviation = found["Mgl/Ix"]
    assert abs(value - 300.0) < FAR * deviation < 5.0
    run = tmp_path / "run.json"  # it would go on as if there was no kick
    assert main([str(path), "--run", str(run)]) == 1
    assert "--run must have one free motion, got two that a kick joins" in capsys.readouterr().err
    assert not run.exists()


@pytest.mark.slow
def test_a_kick_of_a_body_with_an_accelerometer_is_named(tmp_path, capsys):
    kicked = Motion(CUSPS.top, apply_impulse(CUSPS.top, CUSPS.at(1.0), (3.0, 0.0, 0.0)))
    position = (0.0625, 0.0, 0.125)
    rows = []
    for motion, times in ((CUSPS, TIMES[TIMES < 1.0]), (kicked, TIMES[TIMES >= 1.0] - 1.0)):
        state = motion.at(times)
        forces = specific_force(motion, state, position)
        rows.append(np.concatenate([state.angular_velocity, forces], axis=1))
    seen = np.concatenate(rows) + 0.0625 * Numbers(6).normals(len(TIMES), 6)
    path = write_table(tmp_path / "kick.csv", seen, head="t,wx,wy,wz,fx,fy,fz")
    assert main([str(path), "--position", *map(str, position)]) == 1
    value, deviation = read_rows(capsys.readouterr().out)["kick after"]
    assert abs(value - 1.0) < 2 / 128  # of a row in which the rates jump
    assert deviation < 2 / 128


def read_rows(text):
    """Return the numbers of a report with their deviations, by the names that stand there."""
    rows = re.findall(r"^  (\S.*?)  +(\S+) \+- (\S+)", text, re.M)
    return {name: (float(value), float(deviation)) for name, value, deviation in rows}


BAD = {
    "few rows": (slice(5), "a record must have at least 12 rows, got 5"),
    "back in time": ([*range(20), 22, 21], "times must grow, got "),
}


@pytest.mark.parametrize("name", BAD)
def test_rows_that_are_no_record_are_one_line(name, tmp_path, capsys):
    chosen, reason = BAD[name]
    path = write_table(tmp_path / "bad.csv", make_axis()[chosen], TIMES[chosen])
    assert main([str(path)]) == 1
    assert capsys.readouterr().err.startswith(f"top_fit: {reason}")


def test_a_point_that_does_not_move_is_no_record(tmp_path, capsys):
    path = write_table(tmp_path / "still.csv", np.broadcast_to([0.0, 0.6, 0.8], (240, 3)))
    assert main([str(path)]) == 1
    assert "must show a motion, got axis that do not change: 0, 0.6, 0.8" in capsys.readouterr().err


def test_options_of_another_kind_are_refused(table, capsys):
    assert main([str(table), "--mount", "1"]) == 1
    assert "--mount must be used with a record of rates, got axis" in capsys.readouterr().err
    assert main([str(table), "--scale", "100"]) == 1
    assert "--scale must be used with a record of pixels, got axis" in capsys.readouterr().err
    assert main([str(table), "--perspective"]) == 1
    assert "--perspective must be used with a record of pixels, got axis" in capsys.readouterr().err
    assert main([str(table), "--size", "640", "480"]) == 1
    assert "--size must be used with a record of pixels, got axis" in capsys.readouterr().err


def test_a_centre_is_given_once(tmp_path, capsys):
    path = write_table(tmp_path / "film.csv", make_axis()[:, :2], head="t,u,v")
    assert main([str(path), "--size", "640", "480", "--centre", "320", "240"]) == 1
    assert "--centre must not be given with --size, which sets it" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [[], ["a.csv", "--example"], ["a.csv", "--Ix", "1"]])
def test_misuse_has_status_2(arguments):
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2


@pytest.mark.slow
def test_a_plot_is_written(table, tmp_path):
    pytest.importorskip("matplotlib")
    assert main([str(table), "--plot", str(tmp_path / "fit.png")]) == 0
    assert (tmp_path / "fit.png").stat().st_size > 10_000


def test_progress_is_written_after_two_seconds_on_a_terminal(capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    times = iter([0.0, 1.0, 4.0])
    progress = Progress("top_fit", lambda: next(times))
    progress.report(0.5, "fitting")
    assert not capsys.readouterr().err
    progress.report(0.5, "fitting")
    progress.end()
    assert capsys.readouterr().err == "\rtop_fit: fitting, 50%, at most 4 s more \n"


@pytest.mark.slow
def test_what_was_clicked_is_known_to_its_deviation(tmp_path, capsys):
    """A pivot off by a pixel is not taken exactly: it makes the pivot better known than before."""
    camera = {"u": 300.0, "v": 200.0, "log_scale": 5.5, "elevation": 0.5, "roll": 0.0}
    exact = see(CUSPS, "pixels", TIMES[:60], camera)
    seen = exact + Numbers("clicks").normals(*exact.shape)
    path = tmp_path / "measured.csv"
    rows = np.column_stack([TIMES[:60], seen]).tolist()
    path.write_text("t,u,v\n" + "".join(f"{t!r},{u!r},{v!r}\n" for t, u, v in rows))

    def fit(*options):
        assert main([str(path), "--json", *options]) == 0
        return json.loads(capsys.readouterr().out)["values"]

    free = fit()
    pivot = [str(round(free[n]["value"] + free[n]["deviation"])) for n in "uv"]
    known = fit("--pivot", *pivot, "--pivot-deviation", "1")
    for name, clicked in zip("uv", map(float, pivot), strict=True):
        mean, size = free[name]["value"], free[name]["deviation"]
        both = (mean / size**2 + clicked) / (1 / size**2 + 1)  # two measurements of one number
        # the fit weighs by noise that it finds again, and other numbers are not quite linear
        assert known[name]["value"] == pytest.approx(both, abs=0.2 * size)
        assert known[name]["deviation"] == pytest.approx((1 / size**2 + 1) ** -0.5, rel=0.15)
    wide = fit("--scale", "245", "--scale-deviation", "1e6")
    assert wide["scale"]["value"] == pytest.approx(free["scale"]["value"], rel=1e-3)
    assert main([str(path), "--scale-deviation", "1"]) == 1
    assert "--scale-deviation must be used with --scale, got none" in capsys.readouterr().err


def test_what_is_known_of_a_camera_is_in_the_numbers_of_the_model():
    words = ["a.csv", "--pivot", "300", "200", "--scale", "250", "--distance", "8"]
    options = make_parser().parse_args([*words, "--elevation", "30"])
    known = {"u": 300.0, "v": 200.0, "log_scale": np.log(250.0), "nearness": 0.125}
    assert find_camera(options) == known | {"elevation": pytest.approx(np.pi / 6)}
    near = make_parser().parse_args(["a.csv", "--perspective", "--size", "1280", "720"])
    assert find_camera(near) == {"centre_u": 640.0, "centre_v": 360.0}
    aimed = make_parser().parse_args(["a.csv", "--perspective", "--centre", "-3", "5"])
    assert find_camera(aimed) == {"centre_u": -3.0, "centre_v": 5.0}
    clicked = make_parser().parse_args([*words[:6], "--pivot-deviation", "1"])
    assert find_camera(clicked) == {"log_scale": np.log(250.0)}
