"""Rerun's own reader makes arrows of a log: those of its messages, in their frame."""

import sys

import numpy as np
import pytest
from documents import ROOT
from programs import execute

chunk = pytest.importorskip("rerun.chunk")
SCALES = {"angular_momentum": 20.0, "angular_velocity": 1e-3, "torque": 2.0}
FIELDS = {"angular_momentum": ["vector"], "angular_velocity": ["twist", "angular"]}


@pytest.fixture(scope="module")
def arrows(tmp_path_factory):
    """The columns of each topic with arrows, by name."""
    target = tmp_path_factory.mktemp("arrows") / "run.rrd"
    program = ROOT / "examples/arrows_in_rerun.py"
    execute([sys.executable, program, ROOT / "test/run/check/run_0.3.0.mcap", target], check=True)
    batches = [each.to_record_batch() for each in chunk.RrdReader(target).stream()]
    found = [each for each in batches if "Arrows3D:vectors" in each.schema.names]
    paths = [each.schema.metadata[b"rerun:entity_path"].decode() for each in found]
    return dict(zip(paths, found, strict=True))


@pytest.mark.parametrize("topic", SCALES)
def test_an_arrow_is_the_vector_of_its_message_in_its_frame(arrows, topic):
    batch = arrows[f"/top/{topic}"]
    (name,) = [each for each in batch.schema.names if each.startswith("geometry_msgs")]
    columns = (name, "Arrows3D:vectors", "CoordinateFrame:frame")
    for message, vector, frame in zip(*(batch[c].to_pylist() for c in columns), strict=True):
        inner = message[0]
        for field in FIELDS.get(topic, ["wrench", "torque"]):
            inner = inner[field]
        exact = SCALES[topic] * np.array([inner[axis] for axis in "xyz"])
        # Arrows are floats: half a unit in the last place, of 24 bits.
        np.testing.assert_allclose(vector[0], exact, rtol=2.0**-24, atol=1e-40)
        assert frame == [message[0]["header"]["frame_id"]] == ["world"]


def test_arrows_have_the_type_that_the_viewer_draws(arrows):
    """Of a list whose numbers may be null it draws nothing, and says nothing."""
    for batch in arrows.values():
        inner = batch.schema.field("Arrows3D:vectors").type.value_type
        assert not inner.value_field.nullable
