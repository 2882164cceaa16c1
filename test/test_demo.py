import subprocess
import sys


def test_the_demonstration_hurries_the_top_and_leaves_nothing_running():
    result = subprocess.run(
        [sys.executable, "-m", "symtop_ros.client.demo"],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    said, went = result.stdout.splitlines()[-3:-1]
    assert "the moving top is lifted" in said
    promised = said.split("theta ")[1].split(" rad")[0]
    assert f"theta {promised} rad" in went  # the same to a thousandth of a radian
