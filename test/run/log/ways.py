"""Runs that are recorded, and ways in which their logs are damaged at random.

Each way takes a log, or the bytes of a file, and a generator of random numbers.
"""

from dataclasses import replace

FILTER, OWN, TF = "/filter", "/top/orientation", "/tf"


def kick(recorded):
    recorded.run(1.2)
    recorded.kick()
    recorded.run(1.3)


def jump_back(recorded):
    recorded.jump(100.0)
    recorded.run(1.3)
    recorded.kick()
    recorded.run(0.2)
    recorded.jump(100.6)
    recorded.run(1.5)


def jump_forth(recorded):
    recorded.run(1.0)
    recorded.jump(5.0)
    recorded.run(0.6)
    recorded.kick()
    recorded.run(0.5)


def jump_forth_only(recorded):
    recorded.run(1.0)
    recorded.jump(5.0)
    recorded.run(1.0)


def pause_recording(recorded):
    recorded.run(0.8)
    recorded.ask("record", False)
    recorded.run(0.3)
    recorded.kick()
    recorded.run(0.3)
    recorded.ask("record", True)
    recorded.run(1.0)


RUNS = {
    "kicked": ("hurry_slow", kick),
    "back": ("hurry_slow", jump_back),
    "forth": ("cusps", jump_forth),
    "off": ("hurry_slow", pause_recording),
    "upwards back": ("hanging", jump_back),
    "flat": ("disc", kick),
    "weightless": ("free", kick),
    "driven": ("friction", kick),
    "slow": ("separatrix", jump_back),
    "vertical": ("sleeping", jump_forth_only),
}


# Ways of damage: the first ones change messages, the others bytes.


def lose_some(log, rng):
    count = rng.choice((1, 5, 30))
    return log.without(rng.randrange(len(log.messages)) for _ in range(count))


def lose_stretch(log, rng):
    begin = rng.randrange(len(log.messages))
    return log.without(range(begin, begin + rng.choice((3, 20, 100, 400))))


def lose_of_topic(log, rng):
    topics = FILTER, OWN, TF, "/top/torque", "/top/events", "/diagnostics"
    places = log.places(rng.choice(topics))
    begin = rng.randrange(len(places) or 1)
    return log.without(places[begin : begin + rng.choice((1, 2, 10, 40))])


def lose_before_jump(log, rng):
    times = [each.log_time for each in log.messages]
    jumps = [k for k in range(1, len(times)) if times[k] < times[k - 1]] or [len(times)]
    places = [k for k in log.places(rng.choice((OWN, TF))) if k < jumps[0]]
    return log.without(places[-rng.choice((1, 2, 5, 20)) :])


def lose_topics(log, rng):
    kept = ("/top/events", FILTER, "/diagnostics")[: rng.choice((2, 3))]
    return log.without(k for k, each in enumerate(log.messages) if log.topic(each) not in kept)


def double(log, rng):
    again = {rng.randrange(len(log.messages)) for _ in range(rng.choice((1, 5, 50)))}
    pairs = [(each,) * (1 + (k in again)) for k, each in enumerate(log.messages)]
    return replace(log, messages=[each for pair in pairs for each in pair])


def double_stretch(log, rng):
    begin = rng.randrange(len(log.messages))
    end = begin + rng.choice((10, 200, 2000))
    return replace(log, messages=log.messages[:end] + log.messages[begin:])


def exchange(log, rng):
    messages = list(log.messages)
    for _ in range(rng.choice((1, 10, 200))):
        k = rng.randrange(len(messages) - 1)
        other = min(len(messages) - 1, k + rng.choice((1, 5, 30)))
        messages[k], messages[other] = messages[other], messages[k]
    return replace(log, messages=messages)


def sort(log, rng):
    return replace(log, messages=sorted(log.messages, key=lambda each: each.log_time))


def delay_event(log, rng):
    messages = list(log.messages)
    place = rng.choice(log.places("/top/events"))
    event = messages.pop(place)
    messages.insert(place + rng.choice((1, 20, 100)), event)
    return replace(log, messages=messages)


def lose_begin(log, rng):
    return log.without(range(rng.randrange(len(log.messages) // 2)))


def lose_nothing(log, rng):
    return log


def flip(data, rng):
    place = rng.randrange(8, len(data))
    return data[:place] + bytes([data[place] ^ 1 << rng.randrange(8)]) + data[place + 1 :]


def cut(data, rng):
    return data[: rng.randrange(len(data) // 4, len(data))]


def zero(data, rng):
    place = rng.randrange(8, len(data))
    size = len(data[place : place + rng.choice((1, 40, 3000))])
    return data[:place] + bytes(size) + data[place + size :]


def take_out(data, rng):
    place = rng.randrange(8, len(data))
    return data[:place] + data[place + rng.choice((1, 40, 3000)) :]


OF_MESSAGES = (
    *(lose_some, lose_stretch, lose_of_topic, lose_before_jump, lose_topics, lose_begin),
    *(double, double_stretch, exchange, sort, delay_event, lose_nothing),
)
OF_BYTES = flip, cut, zero, take_out


def write_damaged(logs, way, rng, folder):
    """Write the files of a run, of which one is damaged; return their paths."""
    paths = [folder / f"{number}.mcap" for number in range(len(logs))]
    which = rng.randrange(len(paths))
    for number, (log, path) in enumerate(zip(logs, paths, strict=True)):
        is_damaged = number == which
        (way(log, rng) if is_damaged and way in OF_MESSAGES else log).write(path)
        if is_damaged and way in OF_BYTES:
            path.write_bytes(way(path.read_bytes(), rng))
    return paths
