from workshop.load import alone


def test_the_first_sample_after_a_kick_precedes_its_answer(monkeypatch):
    monkeypatch.setattr(alone, "KICKS", 3)
    figures = alone.measure()
    assert [row.partition("kick ")[2] for row in figures] == [
        "at once: to first sample, ms",
        "at once: to answer, ms",
        "after 14 ms: to first sample, ms",
        "after 14 ms: to answer, ms",
    ]
    samples, answers = [*figures.values()][::2], [*figures.values()][1::2]
    assert all(0 < first < whole for first, whole in zip(samples, answers, strict=True))
