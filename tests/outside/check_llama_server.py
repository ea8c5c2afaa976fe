"""The stage `caption` with a teacher, against the real server of llama.cpp's Python package and a tiny model of random weights.

Usage: `check_llama_server.py COSFLY WORK`. Needs the packages gguf and llama-cpp-python[server], whose build takes some minutes; says so where they
are absent. The server's grammar makes every answer a JSON object with a text; what random weights write is never true, so every text must be the
template's, and marked."""

import importlib.util
import json
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

if any(importlib.util.find_spec(name) is None for name in ("gguf", "llama_cpp", "uvicorn")):
    print("skipped: the server is not installed (pip install gguf 'llama-cpp-python[server]')")
    sys.exit()

import gguf
import numpy as np
from shared import rows as rows_of
from shared import run

WIDTH, LAYERS, HEADS, INNER = 64, 2, 4, 128


def tiny_model(path):
    """A llama of two layers, whose tokens are bytes."""
    writer = gguf.GGUFWriter(str(path), "llama")
    tokens = [b"<unk>", b"<s>", b"</s>"] + [f"<0x{byte:02X}>".encode() for byte in range(256)]
    for key, value in {
        "name": "tiny", "context_length": 8192, "embedding_length": WIDTH, "block_count": LAYERS, "feed_forward_length": INNER,
        "head_count": HEADS, "head_count_kv": HEADS, "layer_norm_rms_eps": 1e-5, "rope_dimension_count": WIDTH // HEADS,
        "vocab_size": len(tokens), "tokenizer_model": "llama", "token_list": tokens, "token_scores": [0.0] * len(tokens),
        "token_types": [2, 3, 3] + [6] * 256, "bos_token_id": 1, "eos_token_id": 2, "unk_token_id": 0,
    }.items():
        getattr(writer, f"add_{key}")(value)
    random = np.random.default_rng(1)
    shapes = {"token_embd": (len(tokens), WIDTH), "output": (len(tokens), WIDTH), "output_norm": WIDTH}
    for layer in range(LAYERS):
        shapes |= {f"blk.{layer}.{name}": (WIDTH, WIDTH) for name in ("attn_q", "attn_k", "attn_v", "attn_output")}
        shapes |= {f"blk.{layer}.ffn_gate": (INNER, WIDTH), f"blk.{layer}.ffn_up": (INNER, WIDTH), f"blk.{layer}.ffn_down": (WIDTH, INNER)}
        shapes |= {f"blk.{layer}.attn_norm": WIDTH, f"blk.{layer}.ffn_norm": WIDTH}
    for name, shape in shapes.items():
        weights = np.ones(shape) if isinstance(shape, int) else 0.05 * random.standard_normal(shape)
        writer.add_tensor(f"{name}.weight", weights.astype(np.float32))
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.write_tensors_to_file()
    writer.close()


cosfly, work = (Path(argument).resolve() for argument in sys.argv[1:])
shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
tiny_model(work / "tiny.gguf")
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    port = free.getsockname()[1]
server = [sys.executable, "-m", "llama_cpp.server", "--model", work / "tiny.gguf", "--port", str(port), "--n_ctx", "8192", "--chat_format", "chatml"]
with open(work / "server.txt", "w") as log:
    process = subprocess.Popen(server, stdout=log, stderr=log)
try:
    address = f"http://127.0.0.1:{port}/v1"
    for _ in range(120):
        try:
            urllib.request.urlopen(f"{address}/models", timeout=5).read()
            break
        except OSError:
            time.sleep(0.5)
    settings = {
        "stages.walkers.count": 1, "stages.frames.width": 64, "stages.frames.height": 36,
        "stages.captions.writer": "teacher", "stages.captions.teacher.model": "tiny", "stages.captions.teacher.json": "object_schema",
        "stages.captions.teacher.max_tokens": 200, "stages.captions.teacher.server.address": address,
        "stages.captions.teacher.server.timeout_s": 120.0, "stages.captions.teacher.server.concurrency": 1,
    }
    sets = [word for key, value in settings.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    run(cosfly, "run", "recipes/small.toml", "--out", work / "dataset", "--store", work / "store", "--quiet", *sets)
finally:
    process.terminate()
    process.wait()
rows = rows_of(work / "dataset", "captions")
answers = sum(row["attempts"] for row in rows)
with_text = sum(why != "the answer has no `text`, or an empty one" and "one JSON object" not in why for row in rows for why in row["refused_because"])
print(f"{len(rows)} texts, {answers} answers of the server, {with_text} with a text by its grammar, all refused")
assert rows and answers and all(row["writer"] == "template" and row["fallback"] for row in rows)
assert with_text, "the grammar gave no text"
