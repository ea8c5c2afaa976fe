"""The stage `caption` with a teacher, against the real server of llama.cpp's Python package and a tiny model of random weights.

    check_llama_server.py COSFLY WORK

Needs the packages gguf and llama-cpp-python[server], whose build takes some minutes; says so where they are absent. The server's grammar makes
every answer a JSON object with a text; what random weights write is never true, so every text must be the template's, and marked.
"""

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
    writer.add_name("tiny")
    writer.add_context_length(8192)
    writer.add_embedding_length(WIDTH)
    writer.add_block_count(LAYERS)
    writer.add_feed_forward_length(INNER)
    writer.add_head_count(HEADS)
    writer.add_head_count_kv(HEADS)
    writer.add_layer_norm_rms_eps(1e-5)
    writer.add_rope_dimension_count(WIDTH // HEADS)
    tokens = [b"<unk>", b"<s>", b"</s>"] + [f"<0x{byte:02X}>".encode() for byte in range(256)]
    writer.add_vocab_size(len(tokens))
    writer.add_tokenizer_model("llama")
    writer.add_token_list(tokens)
    writer.add_token_scores([0.0] * len(tokens))
    writer.add_token_types([2, 3, 3] + [6] * 256)
    writer.add_bos_token_id(1)
    writer.add_eos_token_id(2)
    writer.add_unk_token_id(0)
    random = np.random.default_rng(1)
    weights = lambda *shape: (random.standard_normal(shape) * 0.05).astype(np.float32)
    writer.add_tensor("token_embd.weight", weights(len(tokens), WIDTH))
    writer.add_tensor("output.weight", weights(len(tokens), WIDTH))
    writer.add_tensor("output_norm.weight", np.ones(WIDTH, np.float32))
    for layer in range(LAYERS):
        for name in ("attn_q", "attn_k", "attn_v", "attn_output"):
            writer.add_tensor(f"blk.{layer}.{name}.weight", weights(WIDTH, WIDTH))
        for name, shape in {"ffn_gate": (INNER, WIDTH), "ffn_up": (INNER, WIDTH), "ffn_down": (WIDTH, INNER)}.items():
            writer.add_tensor(f"blk.{layer}.{name}.weight", weights(*shape))
        for name in ("attn_norm", "ffn_norm"):
            writer.add_tensor(f"blk.{layer}.{name}.weight", np.ones(WIDTH, np.float32))
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.write_tensors_to_file()
    writer.close()


def main():
    cosfly, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
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


main()
