"""The description that `cosfly.onnx` writes into files."""

import json

import pytest

import cosfly.onnx
from cosfly._env_config import CHANNELS


def entries(data):
    """Entries of `metadata_props`, read by the module's own reader of fields."""
    found = []
    for number, field, key in cosfly.onnx._fields(data):
        if number == 14:
            found.append((key, json.loads(field[field.index(b"{") :])))
    return found


def test_a_description_is_added_and_replaced(tmp_path):
    file = tmp_path / "policy.onnx"
    other = cosfly.onnx._number(14 << 3 | 2)  # an entry of another maker
    entry = cosfly.onnx._text(1, "by") + cosfly.onnx._text(2, "{}")
    graph = cosfly.onnx._text(7, "a graph" * 40)
    file.write_bytes(graph + other + cosfly.onnx._number(len(entry)) + entry)
    cosfly.onnx.describe(file, {"seen": "depth"}, "actions")
    first = file.read_bytes()
    assert first.startswith(graph) and [key for key, _ in entries(first)] == ["by", "cosfly"]
    cosfly.onnx.describe(file, {"seen": {"observation": "rgb", "unit": "0..1", "history": 4}}, "actions", states={"h": "h_out"}, every=5)
    (_, (key, described)) = entries(file.read_bytes())
    assert key == "cosfly" and described["every"] == 5 and described["states"] == {"h": "h_out"}
    assert described["inputs"] == {"seen": {"observation": "rgb", "unit": "0..1", "history": 4}}
    assert described["output"] == {"name": "actions", "actions": "velocity", "unit": "m/s, degrees/s"}
    assert list(tmp_path.iterdir()) == [file]


def test_wrong_files_and_actions_are_refused(tmp_path):
    file = tmp_path / "policy.onnx"
    file.write_bytes(b"no network")
    with pytest.raises(ValueError, match="not in ONNX"):
        cosfly.onnx.describe(file, {"seen": "state"}, "actions")
    with pytest.raises(ValueError, match="allowed are velocity"):
        cosfly.onnx.describe(file, {"seen": "state"}, "actions", actions="speed")
    with pytest.raises(cosfly.InvalidValue, match="no key 'histori'; did you mean `history`"):
        cosfly.onnx.describe(file, {"seen": {"observation": "rgb", "histori": 4}}, "actions")
    with pytest.raises(cosfly.InvalidValue, match="allowed are simple, full"):
        cosfly.onnx.describe(file, {"seen": "rgb"}, "actions", look="ful")
    assert file.read_bytes() == b"no network"


def test_each_channel_has_its_own_unit(tmp_path):
    file = tmp_path / "policy.onnx"
    file.write_bytes(cosfly.onnx._text(7, "a graph"))
    cosfly.onnx.describe(file, {name: name for name in CHANNELS}, "actions")
    (_, described), = entries(file.read_bytes())
    units = {name: fed["unit"] for name, fed in described["inputs"].items()}
    assert units == {name: channel.unit for name, channel in CHANNELS.items()}
    assert [units[name] for name in ("rgb", "depth", "mask")] == ["0..255", "m", "0, 1"]
