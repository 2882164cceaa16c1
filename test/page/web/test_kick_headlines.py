"""Headlines on kicks, read as a person would, against the two sampled motions.

The words and numbers of the headline, of the labels at the brackets and of the answer to the first
question are held against the tilts of the motion with the kick and of the one without it. Nothing
is taken from the records of which they are made.
"""

import math
import re
from dataclasses import dataclass

import numpy as np
import pytest
from drawn import PI, Numbers
from page.web.modules import load_kernel
from physics.tops import find_roots
from trials import choose, trials

from symtop_ros.page.web.join import LANGUAGES
from symtop_ros.physics import Motion, State, Top

# rad; a change of the tilt up to this is not seen (docs/panel.md)
SEEN = 5e-4
SAMPLES = 257  # of a nutation
FINER = 33  # between the neighbours of the extreme sample, three times
# Times end up 1/256/16^3 = 1e-6 of a nutation apart. Through the vertical the tilt is |x|, which
# is missed by half of that times its slope: a range of tilts in an eighth of a nutation at most.
SAMPLED = 1e-5


def draw_kicks(count):
    """Kicks of tops of every family: both signs of Mgl, discs, no weight, slow, fast, at roots."""
    rng = Numbers("headlines of kicks")
    for _ in range(count):
        Ix = rng.power(-4, -1)
        Iz = Ix * rng.choice([rng.uniform(0.05, 1.0), rng.uniform(1.0, 2.0), 1.0])
        Mgl = rng.choice([1, 1, -1, -1, 0]) * rng.power(0, 3) * Ix
        top = {"Ix": Ix, "Iz": Iz, "Mgl": Mgl}
        scale = float(np.sqrt(abs(Mgl) / Ix)) or 1.0
        theta = rng.choice([rng.uniform(0.01, 3.13), 0.5, PI / 2, rng.power(-4, -1)])
        spin = rng.choice([0.0, rng.uniform(-10, 10) * scale, rng.uniform(-50, 50) * scale])
        roots = find_roots(Top(**top), theta, spin)
        phi_dot = rng.choice([0.0, rng.uniform(-3, 3) * scale, *roots, *roots])
        rates = {"phi": phi_dot, "theta": rng.choice([0.0, rng.uniform(-1, 1) * scale])}
        angles = {"phi": rng.uniform(-3, 3), "theta": theta, "psi": 0.0}
        kick = draw_kick(rng, Ix * scale, phi_dot, scale)
        yield {"top": top, "angles": angles, "rates": rates | {"psi": spin}, "kick": kick}


def draw_kick(rng, momentum, phi_dot, scale):
    kind = rng.choice(["factor", "factor", "rate", "impulse"])
    if kind == "impulse":
        return {"kind": kind, "value": [momentum * rng.uniform(-1, 1) for _ in range(3)]}
    rate = rng.choice([phi_dot + 0.01 * scale, 0.0, rng.uniform(-3, 3) * scale])
    factor = rng.choice([1.4, 1 / 1.4, 1.0, -1.0, 2.5, 1.001])
    value = rate if kind == "rate" else factor
    return {"kind": kind, "value": value, "hold": rng.choice(["spin_rate", "spin_momentum"])}


@dataclass(frozen=True)
class Sampled:
    """Tilts of a motion: now, the smallest, the largest, and which way it leaves the one of now."""

    now: float
    top: float
    bottom: float
    first: str

    @property
    def range(self):
        return self.bottom - self.top


def find_tilts(motion, times):
    _, x, y, _ = motion.at(times).orientation.T
    return 2 * np.arcsin(np.minimum(np.hypot(x, y), 1.0))


def sample(top, state):
    """Sample a nutation; no number of the kernel but states is used, and the period as a length."""
    motion = Motion(Top(**top), State(*state))
    period = motion.nutation_period
    if not math.isfinite(period):
        period = 40 * float(np.sqrt(top["Ix"] / (abs(top["Mgl"]) or 1.0)))
    if period == 0.0:
        period = 1.0
    times = np.linspace(0.0, period, SAMPLES)
    tilts = find_tilts(motion, times)
    now = float(tilts[0])
    extremes = [find_extreme(motion, times, tilts, way) for way in (1, -1)]
    return Sampled(now, *extremes, find_first(motion, now, period))


def find_first(motion, now, period):
    """Return where the tilt leads first, as far as it is seen; next to the vertical soon."""
    tilts = find_tilts(motion, period * np.exp2(np.arange(-100, 1) / 5))
    left = tilts[np.abs(tilts - now) > SEEN]
    if not len(left):
        return ""
    return "falls" if left[0] > now else "rises"


def find_extreme(motion, times, tilts, way):
    """Return the smallest tilt (way 1) or the largest (-1), sampled more and more finely."""
    for _ in range(3):
        k = int(np.argmin(way * tilts))
        step = times[1] - times[0]
        times = np.linspace(times[k] - step, times[k] + step, FINER)
        tilts = find_tilts(motion, times)
    return float(tilts[np.argmin(way * tilts)])


NUMBER = r"([\d.]+)"
SAYS = {
    "rises higher": rf"rises {NUMBER}(?: rad|°) higher",
    "rises less high": rf"rises {NUMBER}(?: rad|°) less high",
    "falls lower": rf"falls {NUMBER}(?: rad|°) lower",
    "falls less far": rf"falls {NUMBER}(?: rad|°) less far",
}
PARTS = "|".join(SAYS.values())
HEADLINE = re.compile(
    r"The (top|axis)(?: moves (up|down) at first, but)? "
    rf"((?:{PARTS})(?: and (?:{PARTS}))?) than without the push(?:, and no longer (rises|falls))?\."
)
WAYS = {"up": "rises", "down": "falls", None: None}  # by what it is called if it goes far
LOST = re.compile(r"The (top|axis) no longer (rises|falls|rises or falls)\.")
SAME = re.compile(
    r"(To the eye, t|T)he (top|axis) reaches the same highest and lowest points as .*\."
)


def read(headline):
    """Return the subject, the first way, the changes by their words, and the ways that are lost."""
    if found := HEADLINE.fullmatch(headline):
        subject, first, parts, *_ = found.groups()
        lost = [found.groups()[-1]] if found.groups()[-1] else []
        return subject, WAYS[first], dict(read_part(each) for each in parts.split(" and ")), lost
    if found := LOST.fullmatch(headline):
        return found[1], None, {}, found[2].split(" or ")
    found = SAME.fullmatch(headline)
    assert found, headline
    return found[2], None, {}, []


def read_part(text):
    for words, form in SAYS.items():
        if found := re.fullmatch(form, text):
            return words, found[1]
    raise AssertionError(text)


def is_rounded(text, value, off, digits):
    """Return True if a number is that value, known to `off`, with so many digits."""
    assert "e" not in text, text
    last = 10 ** (math.floor(math.log10(float(text))) + 1 - digits)
    return abs(float(text) - value) <= (0.5 + 1e-6) * last + off


DIGITS = {"radians": (1.0, 2), "degrees": (180 / PI, 3)}  # units in rad, and digits of a change


def check_headline(headline, name, with_it, without):
    """Check each word and number of a headline."""
    subject, first, changes, lost = read(headline)
    unit, digits = DIGITS[name]
    off = SAMPLED * max(with_it.range, without.range) + 1e-12
    higher = without.top - with_it.top
    lower = with_it.bottom - without.bottom
    values = {
        "rises higher": higher,
        "rises less high": -higher,
        "falls lower": lower,
        "falls less far": -lower,
    }
    for words, text in changes.items():
        value = values[words] * unit
        assert is_rounded(text, value, off * unit, digits), (words, text, value)
    rises, falls = with_it.now - with_it.top, with_it.bottom - with_it.now
    moves = {"rises": rises, "falls": falls}
    would = {"rises": without.now - without.top, "falls": without.bottom - without.now}
    for words in changes:  # what is compared happens
        assert moves[words.split()[0]] > SEEN - off, (words, moves)
    for way in lost:
        assert moves[way] <= SEEN + off, (way, moves)
        assert would[way] > SEEN - off, (way, would)
    named = {words.split()[0] for words in changes} | set(lost)
    for way, change in (("rises", higher), ("falls", lower)):
        assert way in named or abs(change) <= SEEN + off, (way, change)
    only = named if not lost else set()
    if first:
        assert first == with_it.first, (first, with_it)
        assert first not in named
    elif len(only) == 1 and changes and min(moves.values()) > SEEN + off:
        assert with_it.first in only, (only, with_it.first)
    return subject


@pytest.mark.wording
@pytest.mark.parametrize("count", trials(100, 10_000))
def test_every_word_and_number_of_a_headline_is_what_the_motions_do(tab, count):
    cases = list(draw_kicks(count))
    heard = set()
    for case, said in zip(cases, tab.evaluate("sayKicks", cases), strict=True):
        without, with_it = (sample(case["top"], state) for state in said["states"])
        for name, text in said["texts"].items():
            subject = check_headline(text, name, with_it, without)
            assert subject == ("axis" if case["top"]["Mgl"] < 0 else "top")
        _, first, changes, lost = read(said["texts"]["radians"])
        check_labels(said["labels"], changes, lost, with_it, without)
        check_answer(said["happened"], changes, lost)
        heard |= {f"first {first}", *changes, *(f"no longer {way}" for way in lost)}
    assert heard >= {*SAYS, "first rises", "first falls", "no longer rises", "no longer falls"}


def check_labels(labels, changes, lost, with_it, without):
    """Check that brackets stand at the levels of both motions and say what the headline says."""
    off = SAMPLED * max(with_it.range, without.range) + 1e-12
    seen = {}
    for begin, end, text in labels:
        way = re.match("no longer (rises|falls)|(rises|falls)", text)
        name = way[1] or way[2]
        places = (without.top, with_it.top) if name == "rises" else (without.bottom, with_it.bottom)
        assert (begin, end) == pytest.approx(places, abs=off), (text, places)
        seen |= {f"no longer {name}": ""} if way[1] else dict([read_part(text)])
    assert seen == changes | {f"no longer {way}": "" for way in lost}


HAPPENED = {
    "it rose": "rises higher",
    "it rose less high": "rises less high",
    "it fell": "falls lower",
    "it fell less far": "falls less far",
    "it no longer rises": "rises",
    "it no longer falls": "falls",
}


def check_answer(text, changes, lost):
    told = text.removeprefix("You were right: ").removesuffix(".")
    if told.endswith("its height is the same"):
        assert not changes
        assert not lost
    else:
        assert {HAPPENED[each] for each in told.split(" and ")} == {*changes, *lost}


@pytest.mark.parametrize("language", choose([*LANGUAGES], ("tr",)))
def test_a_headline_has_the_same_numbers_in_each_language(tab, language):
    cases = list(draw_kicks(50))
    english = tab.evaluate("sayKicks", cases)
    load_kernel(tab, language)
    try:
        other = tab.evaluate("sayKicks", cases)
    finally:
        load_kernel(tab)
    for one, two in zip(english, other, strict=True):
        for unit in ("radians", "degrees"):
            assert list_numbers(one["texts"][unit]) == list_numbers(two["texts"][unit])


def list_numbers(text):
    return sorted(re.findall(r"\d[\d.]*", text.replace(",", ".").rstrip(".")))
