"""A vision-language model as a policy, against a stand-in of an OpenAI-compatible server."""

import base64
import io
import json
import socket
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest

import cosfly
import cosfly.vlm

KEY = "sk-4f0c1d7e9b2a86355aQx"
RIGHT = json.dumps(dict.fromkeys(cosfly.vlm.ACTION, 1.5))
RAMBLING = f"Sure! ```json\n{RIGHT}\n``` The target walks."


def serve(answer):
    """A server whose status and text `answer` gives for a path, a key and a request."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self):
            body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            status, text = answer(self.path, self.headers["Authorization"], body)
            data = json.dumps({"choices": [{"message": {"content": text}}]}).encode()
            self.send_response(status)
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

        def log_message(self, *_):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


@pytest.fixture
def model(monkeypatch):
    """A model whose texts are the list that it gives, over and over; requests are kept."""
    texts, asked = [RIGHT], []

    def answer(path, key, body):
        asked.append((path, key, body))
        return 200, texts[(len(asked) - 1) % len(texts)]

    server = serve(answer)
    monkeypatch.setenv("COSFLY_VLM_URL", f"http://127.0.0.1:{server.server_port}/v1/")
    monkeypatch.setenv("COSFLY_VLM_MODEL", "small-vlm")
    monkeypatch.setenv("COSFLY_API_KEY", KEY)
    yield texts, asked
    server.shutdown()


def observation(**pictures):
    return {"state": np.arange(16, dtype=np.float32), "prompt": "Follow.", "episode": "one", "step": 0, **pictures}


def test_the_model_gets_task_state_pictures_and_schema(model):
    image = pytest.importorskip("PIL.Image")
    _, asked = model
    rgb = np.random.default_rng(1).integers(0, 256, (20, 30, 3), np.uint8)
    rows = cosfly.vlm.act(observation(rgb=rgb, depth=np.full((4, 4), 50, np.float32)))
    assert rows.dtype == np.float32 and rows.shape[1] == 5 and (rows == 1.5).all()
    ((path, key, body),) = asked
    assert (path, key, body["model"]) == ("/v1/chat/completions", f"Bearer {KEY}", "small-vlm")
    assert body["response_format"]["json_schema"]["schema"]["required"] == cosfly.vlm.ACTION
    text, _, first, _, depth = body["messages"][1]["content"]
    assert "Follow." in text["text"] and "target_ahead_m 0.00" in text["text"]
    pixels = [image.open(io.BytesIO(base64.b64decode(it["image_url"]["url"].split(",")[1]))) for it in (first, depth)]
    assert (np.asarray(pixels[0]) == rgb).all() and (np.asarray(pixels[1]) == 127).all()
    cosfly.vlm.act_on_pictures(observation(rgb=rgb))
    told = asked[1][2]["messages"][1]["content"][0]["text"]
    assert "target" not in told and "above_ground_m 13.00" in told


WRONG_NUMBERS = [RIGHT.replace("1.5", number) for number in ("NaN", "true", "1e9", "1" * 400)]


@pytest.mark.parametrize("wrong", ["", "{", "no idea", '{"a": 1}', '{"a": ' + "[" * 100000 + "}", *WRONG_NUMBERS])
def test_malformed_answers_are_named_asked_again_and_counted(model, wrong, monkeypatch, tmp_path, capsys):
    texts, asked = model
    monkeypatch.setenv("COSFLY_VLM_LOG", str(tmp_path / "log"))
    monkeypatch.setattr(cosfly.vlm, "_malformed", {"all": 0, "row": 0, "answers": 0})
    texts[:] = [wrong, RAMBLING]
    assert (cosfly.vlm.act(observation()) == 1.5).all()
    assert "That is no answer" in asked[1][2]["messages"][-1]["content"]
    texts[:] = [wrong]
    assert (cosfly.vlm.act(observation()) == 0).all()
    assert "malformed: 1 of 2 answers" in capsys.readouterr().err
    lines = [json.loads(line) for line in (tmp_path / "log").read_text().splitlines()]
    assert [bool(line["malformed"]) for line in lines] == [True, False, True, True]
    with pytest.raises(cosfly.Error, match="20 malformed answers in a row"):
        for _ in range(20):
            cosfly.vlm.act(observation() | {"step": 10})
    # Another episode of the same process begins to count anew: rows do not depend on jobs.
    assert (cosfly.vlm.act(observation()) == 0).all()


def test_a_missing_number_is_named(model, monkeypatch, capsys):
    texts, _ = model
    texts[:] = ['{"ahead": 1.5}']
    cosfly.vlm.act(observation())
    assert f"`{cosfly.vlm.ACTION[0]}` is missing; there must be {', '.join(cosfly.vlm.ACTION)}" in capsys.readouterr().err


@pytest.mark.parametrize("status", [429, 500, 503])
def test_a_busy_server_is_asked_again(status, monkeypatch):
    statuses = [status, status, 200]
    server = serve(lambda *_: (statuses.pop(0), RIGHT))
    monkeypatch.setenv("COSFLY_VLM_URL", f"http://127.0.0.1:{server.server_port}/v1")
    monkeypatch.setattr(cosfly.vlm, "_PAUSES_S", (0.01, 0.01))
    assert (cosfly.vlm.act(observation()) == 1.5).all() and not statuses
    statuses[:] = [status] * 3
    with pytest.raises(SystemExit, match=f"answers with status {status}"):
        cosfly.vlm.act(observation())
    server.shutdown()


def test_a_key_with_a_line_end_is_refused_and_not_printed(model, monkeypatch):
    monkeypatch.setenv("COSFLY_API_KEY", f"{KEY}\n")
    with pytest.raises(SystemExit, match="the end of a line") as ended:
        cosfly.vlm.act(observation())
    assert KEY not in str(ended.value)


@pytest.mark.parametrize("told", [b"hello\n", b"HTTP/1.1 200 OK\r\nContent-Length: 900\r\n\r\n{", b""])
def test_a_server_that_is_none_is_named(told, monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer():
            connection, _ = server.accept()
            with connection:
                connection.recv(1 << 20)
                connection.sendall(told)

        threading.Thread(target=answer, daemon=True).start()
        monkeypatch.setenv("COSFLY_VLM_URL", f"http://127.0.0.1:{server.getsockname()[1]}/v1")
        with pytest.raises(SystemExit, match="cannot be asked"):
            cosfly.vlm.act(observation())


def test_it_flies_and_its_key_is_nowhere(model, tmp_path):
    _, asked = model
    command = [sys.executable, "-m", "cosfly", "fly", "small/recipe.toml", "--policy", "python:cosfly.vlm:act", "--name", "vlm", "--python", sys.executable]
    command += ["--obs", "rgb", "--size-px", "32", "--every", "20", "--out", str(tmp_path / "fly"), "--clips", "0", "--jobs", "1"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert ended.returncode == 0, ended.stderr
    assert asked and asked[0][2]["messages"][1]["content"][2]["type"] == "image_url"
    written = [file.read_bytes() for file in (tmp_path / "fly").rglob("*") if file.is_file()]
    assert written and not any(KEY.encode() in data for data in written)
