"""Serves a function to `cosfly fly`: observations come on standard input, answers go to standard output.

A message is a byte ('b': msgpack, 't': text), its length (four bytes, little-endian), and its bytes.
"""

import importlib
import os
import struct
import sys
import traceback

answers = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)  # what the policy prints goes to standard error


def send(kind, data):
    answers.write(kind + struct.pack("<I", len(data)) + data)
    answers.flush()


def pack_array(value):
    if isinstance(value, np.generic):
        value = np.asarray(value)
    if isinstance(value, np.ndarray):
        if value.dtype.kind in "VOc":
            raise ValueError(f"arrays of {value.dtype} cannot be sent")
        return {b"__ndarray__": True, b"data": value.tobytes(), b"dtype": value.dtype.str, b"shape": value.shape}
    return value


def unpack_array(value):
    if b"__ndarray__" in value:
        return np.ndarray(buffer=value[b"data"], dtype=np.dtype(value[b"dtype"]), shape=value[b"shape"])
    return value


try:
    import msgpack
    import numpy as np

    sys.path.insert(0, os.getcwd())
    policy = getattr(importlib.import_module(sys.argv[1]), sys.argv[2])
except ImportError as error:
    send(b"t", f"{error} (policies in Python need the packages numpy and msgpack)".encode())
    sys.exit(1)
except Exception:
    send(b"t", traceback.format_exc().encode())
    sys.exit(1)
send(b"b", msgpack.packb({"policy": f"{sys.argv[1]}:{sys.argv[2]}"}))
while True:
    size = sys.stdin.buffer.read(4)
    if len(size) < 4:
        break
    observation = msgpack.unpackb(sys.stdin.buffer.read(struct.unpack("<I", size)[0]), object_hook=unpack_array)
    try:
        action = policy(observation)
        answer = action if isinstance(action, dict) else {"actions": np.asarray(action)}
        send(b"b", msgpack.packb(answer, default=pack_array))
    except Exception:
        send(b"t", traceback.format_exc().encode())
