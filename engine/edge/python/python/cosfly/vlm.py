"""A vision-language model as a policy: ``cosfly fly SUITE --policy python:cosfly.vlm:act --obs rgb --size-px 224 --every 10``.

The model answers over an OpenAI-compatible endpoint (``/chat/completions``): ``COSFLY_VLM_URL`` is its address, such as
``http://127.0.0.1:8080/v1``, ``COSFLY_VLM_MODEL`` its name, ``COSFLY_API_KEY`` the key where there is one. It gets the task, the state and the
pictures that the flight asks for, and answers with the object of :data:`SCHEMA`. An answer that is none is named to the model, which is asked once
more; if that fails, too, the drone stops, and the answer counts as malformed. ``COSFLY_VLM_LOG`` names a file that gets a line of JSON for each answer.
"""

from __future__ import annotations

import base64
import http.client
import json
import os
import re
import struct
import sys
import time
import urllib.error
import urllib.request
import zlib
from typing import Any

import numpy as np

from ._cosfly import ACTION, STATE
from ._errors import InvalidValue

SYSTEM = (
    "You fly a drone that follows a moving target. Answer with one JSON object of five numbers: velocity ahead, right and up in m/s (at most 12), "
    "rates of the camera's pitch (positive: up) and yaw (positive: to the right) in degrees/s (at most 60). Vectors are along the heading of the "
    "camera. Keep the target in the middle of the picture, 10 to 40 m away, and touch nothing."
)
"""Standing rules for the model."""
SCHEMA: dict[str, Any] = {
    "type": "object",
    "properties": {name: {"type": "number"} for name in ACTION},
    "required": list(ACTION),
    "additionalProperties": False,
}
"""Form of an answer."""

_OWN = slice(6, 14)  # what the drone knows of itself: motion, pitch of the camera, height
_ROWS = 64  # an answer holds until `--every` asks for the next
_BUSY = (408, 429, 500, 502, 503, 504)
_PAUSES_S = (0.5, 1.0, 2.0, 4.0)  # before a busy server is asked again
_MOST_MALFORMED = 20  # in a row: then the policy has failed
_malformed = {"all": 0, "row": 0, "answers": 0}


def act(observation: dict[str, Any]) -> np.ndarray:
    """Action of the model for the state and the pictures."""
    return _act(observation, slice(0, len(STATE)))


def act_on_pictures(observation: dict[str, Any]) -> np.ndarray:
    """Action of the model for the pictures and the drone's own motion: where the target is, it must see."""
    return _act(observation, _OWN)


def _act(observation: dict[str, Any], known: slice) -> np.ndarray:
    state = zip(STATE[known], np.asarray(observation["state"], np.float64)[known])
    told = ", ".join(f"{name} {value:.2f}" for name, value in state)
    content: list[dict[str, Any]] = [{"type": "text", "text": f"{observation['prompt']}\n{told}"}]
    for name in ("rgb", "mask", "depth"):
        if name in observation:
            url = "data:image/png;base64," + base64.b64encode(_png(_grey(name, observation[name]))).decode()
            content += [{"type": "text", "text": f"{name}:"}, {"type": "image_url", "image_url": {"url": url}}]
    messages: list[dict[str, Any]] = [{"role": "system", "content": SYSTEM}, {"role": "user", "content": content}]
    numbers, fault = None, ""
    if observation["step"] == 0:
        _malformed["row"] = 0  # an episode does not depend on those that this process flew before
    for _ in range(2):
        text = _ask(messages)
        numbers, fault = _read(text)
        _log(observation, text, fault)
        if numbers is not None:
            break
        again = f"That is no answer: {fault}. Answer with the JSON object alone."
        messages += [{"role": "assistant", "content": text[:2000]}, {"role": "user", "content": again}]
    _malformed["answers"] += 1
    _malformed["row"] = 0 if numbers is not None else _malformed["row"] + 1
    if numbers is None:
        _malformed["all"] += 1
        print(f"malformed: {_malformed['all']} of {_malformed['answers']} answers; {fault}", file=sys.stderr, flush=True)
        if _malformed["row"] >= _MOST_MALFORMED:
            raise InvalidValue(f"{_malformed['row']} malformed answers in a row, the last: {fault}")
    return np.tile(np.asarray(numbers or [0.0] * len(ACTION), np.float32), (_ROWS, 1))


def _read(text: str) -> tuple[list[float] | None, str]:
    """The five numbers in a text, or what is wrong with it. Words and fences around the object are allowed."""
    found = re.search(r"\{[^{}]*\}", text)
    try:
        answer = json.loads(found[0]) if found else None
    except (ValueError, RecursionError) as error:
        return None, f"the object is no JSON ({error})"
    if not isinstance(answer, dict):
        return None, "there is no JSON object in it"
    if missing := [name for name in ACTION if name not in answer]:
        return None, f"`{missing[0]}` is missing; there must be {', '.join(ACTION)}"
    numbers = [answer[name] for name in ACTION]
    for name, number in zip(ACTION, numbers):
        if isinstance(number, bool) or not isinstance(number, (int, float)) or not abs(number) <= 1e6:
            return None, f"`{name}` is {json.dumps(number)[:40]}; it is a number"
    return [float(number) for number in numbers if number is not None], ""


def _ask(messages: list[dict[str, Any]]) -> str:
    """The model's text. A server that is busy is asked again. Where there is none, the process ends: the flight is begun anew."""
    form = {"type": "json_schema", "json_schema": {"name": "action", "strict": True, "schema": SCHEMA}}
    address = os.environ.get("COSFLY_VLM_URL", "http://127.0.0.1:8080/v1").rstrip("/") + "/chat/completions"
    model = os.environ.get("COSFLY_VLM_MODEL", "default")
    body = {"model": model, "temperature": 0, "seed": 0, "max_tokens": 400, "messages": messages, "response_format": form}
    headers = {"Content-Type": "application/json"}
    if key := os.environ.get("COSFLY_API_KEY"):
        if not (key.isascii() and key.isprintable()):
            raise SystemExit("COSFLY_API_KEY holds what no key has, such as the end of a line")
        headers["Authorization"] = f"Bearer {key}"
    try:
        request = urllib.request.Request(address, json.dumps(body).encode(), headers)
        told = _answer(request)
        return str(told["choices"][0]["message"]["content"] or "")
    except urllib.error.HTTPError as error:
        raise SystemExit(f"{address} answers with status {error.code}: {error.read(300).decode('utf-8', 'replace')}") from None
    except (OSError, ValueError, RecursionError, http.client.HTTPException) as error:
        raise SystemExit(f"{address} cannot be asked: {error}; COSFLY_VLM_URL names an OpenAI-compatible server") from None
    except (KeyError, IndexError, TypeError):
        raise SystemExit(f"{address} gave no `choices[0].message.content`: it is no OpenAI-compatible server") from None


def _answer(request: urllib.request.Request) -> Any:
    """What the server answers; one that is busy is asked again, after longer and longer pauses."""
    for pause_s in _PAUSES_S:
        try:
            with urllib.request.urlopen(request, timeout=600) as answer:
                return json.load(answer)
        except urllib.error.HTTPError as error:
            if error.code not in _BUSY:
                raise
        time.sleep(pause_s)
    with urllib.request.urlopen(request, timeout=600) as answer:
        return json.load(answer)


def _log(observation: dict[str, Any], text: str, fault: str) -> None:
    if path := os.environ.get("COSFLY_VLM_LOG"):
        line = {"episode": observation["episode"], "step": observation["step"], "answer": text, "malformed": fault or None}
        with open(path, "a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")


def _grey(name: str, picture: np.ndarray) -> np.ndarray:
    """A picture with values of 8 bits: masks are white where the target is, depth is black from 100 m on."""
    if name == "rgb":
        return picture
    return picture * np.uint8(255) if name == "mask" else (255 * (1 - np.clip(picture / 100, 0, 1))).astype(np.uint8)


def _png(picture: np.ndarray) -> bytes:
    """A picture, (rows, columns) or (rows, columns, 3), as a PNG file."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows, columns = picture.shape[:2]
    head = struct.pack(">IIBBBBB", columns, rows, 8, 2 if picture.ndim == 3 else 0, 0, 0, 0)
    lines = np.ascontiguousarray(picture, np.uint8).reshape(rows, -1)
    data = zlib.compress(np.hstack([np.zeros((rows, 1), np.uint8), lines]).tobytes())
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
