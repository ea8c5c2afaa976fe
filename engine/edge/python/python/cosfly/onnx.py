"""Networks in ONNX that fly: :func:`describe` writes what ``cosfly fly --policy onnx:FILE`` must know into the file.

The packages ``onnx`` and ``onnxruntime`` are not needed.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Mapping

from ._env_config import CHANNELS, LOOKS
from ._errors import InvalidValue, keys_of

KEY = "cosfly"
"""Key of the description in the file's metadata (``metadata_props``)."""

UNITS = {"state": "m, s, degrees", **{name: channel.unit for name, channel in CHANNELS.items()}}
"""Units of observations, unless others are asked for; sensors have those of the state."""

ACTIONS = {
    "velocity": "m/s, degrees/s",
    "thrust-rates": "weights, degrees/s",
    "rotors": "rev/min, degrees/s",
    "deltas-world": "m, degrees",
    "deltas-body": "m, degrees",
}
"""Kinds of actions, with their units."""

FED = ("observation", "unit", "history")
"""Keys of an input that is more than the name of an observation."""

_METADATA = 14  # the field `metadata_props` of a `ModelProto`


def describe(
    path: str | os.PathLike[str],
    inputs: Mapping[str, str | Mapping[str, Any]],
    output: str,
    *,
    actions: str = "velocity",
    states: Mapping[str, str] | None = None,
    every: int = 1,
    look: str = "simple",
) -> None:
    """Writes into the file what its inputs and outputs are, in place of an earlier description.

    ``inputs`` maps the name of an input to the observation that it is fed with, such as ``"state"`` or ``"depth"``, or to a dictionary
    with ``observation`` and, where others than the usual are wanted, ``unit`` (``"0..1"`` for colours) and ``history`` (how many of the
    last observations). ``output`` names the output with the actions, ``states`` maps each input with a memory to the output that is its
    value in the next call. The network is asked again after ``every`` steps. ``look`` is that of colours: ``simple`` or ``full``.
    """
    if actions not in ACTIONS:
        raise InvalidValue(f"actions={actions!r}; allowed are {', '.join(ACTIONS)}")
    if look not in LOOKS:
        raise InvalidValue(f"look={look!r}; allowed are {', '.join(LOOKS)}")
    fed = {name: _fed(name, value) for name, value in inputs.items()}
    described = {
        "version": 1,
        "inputs": fed,
        "output": {"name": output, "actions": actions, "unit": ACTIONS[actions]},
        "states": dict(states or {}),
        "every": every,
        "look": look,
    }
    file = Path(path)
    kept = b"".join(field for number, field, key in _fields(file.read_bytes()) if (number, key) != (_METADATA, KEY))
    entry = _text(1, KEY) + _text(2, json.dumps(described))
    whole = file.with_name(f".{file.name}.{os.getpid()}")
    whole.write_bytes(kept + _number(_METADATA << 3 | 2) + _number(len(entry)) + entry)
    whole.replace(file)


def _fed(name: str, value: str | Mapping[str, Any]) -> dict[str, Any]:
    fed = {"observation": value} if isinstance(value, str) else dict(keys_of(f"input {name!r}", value, FED))
    fed.setdefault("unit", UNITS.get(fed.get("observation", ""), UNITS["state"]))
    return fed


def _number(value: int) -> bytes:
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def _text(number: int, text: str) -> bytes:
    data = text.encode()
    return _number(number << 3 | 2) + _number(len(data)) + data


def _fields(data: bytes) -> list[tuple[int, bytes, str | None]]:
    """Fields of a message: number, bytes, and for entries of metadata the key."""
    fields, at = [], 0
    try:
        while at < len(data):
            start = at
            tag, at = _read(data, at)
            length = {0: 0, 1: 8, 5: 4}.get(tag & 7)
            if tag & 7 == 0:
                _, at = _read(data, at)
            elif length is None:
                if tag & 7 != 2:
                    raise IndexError
                length, at = _read(data, at)
            inside, at = data[at : at + (length or 0)], at + (length or 0)
            if at > len(data):
                raise IndexError
            key = None
            if tag >> 3 == _METADATA:
                size, first = _read(inside, 1)
                key = inside[first : first + size].decode("utf-8", "replace")
            fields.append((tag >> 3, data[start:at], key))
    except IndexError:
        raise InvalidValue("the file is not in ONNX, or it is cut off") from None
    return fields


def _read(data: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[at]
        value, shift, at = value | (byte & 0x7F) << shift, shift + 7, at + 1
        if byte < 0x80:
            return value, at
