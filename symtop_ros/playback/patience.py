"""How long a motion under friction or a torque is followed for a check: not for ever."""

from __future__ import annotations

from symtop_ros.physics import Motion

PIECE = 5000  # steps of the engine, about a tenth of a second
STEPS_PER_SAMPLE = 200  # that a node may have taken for each
SPARE = 10_000_000  # steps for what is not among the samples: what came before the log
HOPE = 10.0  # times what is left; a motion that slows down is followed in longer steps


class Patience:
    """Steps that may be spent on one log.

    Parameters
    ----------
    spare : int
        Steps beyond those that the number of samples explains.
    """

    def __init__(self, spare: int = SPARE) -> None:
        self._spare = spare

    def reaches(self, path: Motion, times: tuple[float, ...], samples: int) -> bool:
        """Prepare the states at some times, s; return whether the engine has got to them."""
        try:
            return all(self._reaches(path, t, PIECE + STEPS_PER_SAMPLE * samples) for t in times)
        except ValueError:  # too fast for doubles
            return False

    def _reaches(self, path: Motion, t: float, free: int) -> bool:
        begin = path.reach(t, 0)
        while free + self._spare > 0:
            reached = path.reach(t, PIECE)
            if reached == t:
                return True
            self._spare -= max(0, PIECE - max(0, free))
            free -= PIECE
            left = max(0, free) + self._spare
            if abs(t - reached) * PIECE > HOPE * left * abs(reached - begin):
                return False
            begin = reached
        return False
