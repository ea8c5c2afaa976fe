"""Serves a function to `cosfly fly`: observations come on standard input, answers go to standard output.

A message is a byte ('b': msgpack, 't': text), its length (four bytes, little-endian), and its bytes.
"""

import importlib
import os
import struct
import sys
import traceback

# The policy gets neither end: what it prints goes to standard error, and what it reads is empty.
answers = os.fdopen(os.dup(1), "wb")
questions = os.fdopen(os.dup(0), "rb")
os.dup2(2, 1)
os.dup2(os.open(os.devnull, os.O_RDONLY), 0)


def send(kind, data):
    answers.write(kind + struct.pack("<I", len(data)) + data)
    answers.flush()


def refuse(text):
    send(b"t", text.encode("utf-8", "replace"))
    sys.exit(1)


def pack_array(value):
    if isinstance(value, np.generic):
        value = np.asarray(value)
    if isinstance(value, np.ndarray):
        if value.dtype.kind == "V" and value.dtype.names is None and value.dtype.name != f"void{8 * value.itemsize}":
            value = value.astype(np.float32)  # bfloat16 and the like, which numpy itself has no name for
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
except ImportError as error:
    refuse(
        f"{error}: policies in Python need the packages numpy and msgpack, and `{sys.executable}` lacks one:"
        " install it there, or name another Python with `--python`"
    )
module, function = sys.argv[1], sys.argv[2]
try:
    sys.path.insert(0, os.getcwd())
    loaded = importlib.import_module(module)
except ModuleNotFoundError as error:
    if error.name != module.split(".")[0]:
        traceback.print_exc()
    refuse(f"{error}: it is looked for in `{os.getcwd()}` and where `{sys.executable}` looks (PYTHONPATH)")
except Exception:
    refuse(traceback.format_exc())
policy = getattr(loaded, function, None)
if not callable(policy):
    refuse(f"the module `{module}` has no function `{function}`")
send(b"b", msgpack.packb({"policy": f"{module}:{function}"}))
while True:
    size = questions.read(4)
    if len(size) < 4:
        break
    observation = msgpack.unpackb(questions.read(struct.unpack("<I", size)[0]), object_hook=unpack_array)
    try:
        action = policy(observation)
        answer = action if isinstance(action, dict) else {"actions": np.asarray(action)}
        for key, given in answer.items():
            if given is None or getattr(given, "dtype", None) == object:
                said = "nothing (`None`)" if action is None else f"`{action!r:.200}`"
                raise ValueError(f"`{function}` returned {said}: `{key}` must be rows of numbers")
        send(b"b", msgpack.packb(answer, default=pack_array))
    except Exception:
        send(b"t", traceback.format_exc().encode("utf-8", "replace"))
