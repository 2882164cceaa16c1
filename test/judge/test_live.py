"""`top_judge --live` and a running node."""

from programs import run, running_node

from workshop.load.domains import claim_domain

DOMAIN = claim_domain()


def test_the_nodes_own_attitude_is_exact_while_it_runs():
    with running_node(DOMAIN, "scene:=looping"):
        arguments = ("--live", "--topic", "/top/orientation", "--max-error", "1e-15")
        done = run("top_judge", *arguments, "--seconds", "2.5", domain=DOMAIN)
        assert (done.returncode, done.stderr) == (0, "")
        assert " estimates: attitude " in done.stdout
