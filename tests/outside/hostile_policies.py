"""A hundred hostile policies for `check_hostile.py`: modules in Python, and servers that speak (or do not speak) WebSocket.

`MODULES` has the text of a module by name; its function is `act`. `SERVERS` has functions by name that get a connection after its request was read.
Each comes with whether the policy may count as set up: then its faults are scored."""

import base64
import contextlib
import hashlib
import itertools
import os
import socket
import struct
import threading
import time

GOOD = "import numpy as np\ndef good(o): return np.zeros(5)\n"


FAULTS = {
    "nan": "return np.full(5, np.nan)",
    "inf": "return np.full(5, -np.inf)",
    "huge": "return np.full(5, 1e23)",
    "wrong_shape": "return np.zeros((3, 7))",
    "scalar": "return 3.0",
    "three_dimensions": "return np.zeros((2, 2, 5))",
    "no_rows": "return np.zeros((0, 5))",
    "many_rows": "return np.zeros((1 << 22, 5), dtype=np.float32)",
    "objects": "return np.array([object()] * 5)",
    "texts": "return ['a', 'b', 'c', 'd', 'e']",
    "nothing": "return None",
    "ragged": "return [[1, 2, 3, 4, 5], [1]]",
    "complex": "return np.zeros(5, dtype=complex)",
    "dates": "return np.zeros(5, dtype='M8[s]')",
    "truths": "return np.zeros(5, dtype=bool)",
    "long_doubles": "return np.zeros(5, dtype=np.longdouble)",
    "halves": "return np.full(5, 65504, dtype=np.float16)",
    "big_endian": "return np.zeros(5, dtype='>f8')",
    "empty_map": "return {}",
    "map_of_none": "return {'actions': None}",
    "deep": "x = []\n    for _ in range(200): x = [x]\n    return {'actions': x}",
    "very_deep": "x = []\n    for _ in range(400): x = {'a': x}\n    return {'actions': np.zeros(5), 'x': x}",
    "many_values": "return {'actions': np.zeros(5), 'x': [None] * 12_000_000}",
    "huge_text": "return {'actions': np.zeros(5), 'x': 'x' * (1 << 28)}",
    "negative_zero": "return -np.zeros(5)",
    "surrogates": "raise ValueError('\\ud800 \\x1b[2J \\x00')",
    "raises": "raise KeyError('no such feature')",
    "raises_much": "raise ValueError('x' * (1 << 26))",
    "recursion": "return act(o)",
    "exits": "import sys; sys.exit(3)",
    "dies": "import os; os._exit(9)",
    "aborts": "import os; os.abort()",
    "interrupts": "raise KeyboardInterrupt",
    "hangs": "import time; time.sleep(1000)",
    "spins": "while True: pass",
    "closes_pipes": "import os; [os.close(n) for n in range(3, 20) if n]; return good(o)",
    "floods_errors": "import sys\n    for _ in range(50): sys.stderr.write('x' * 100000)\n    return good(o)",
    "prints": "print('x' * (1 << 20)); return good(o)",
    "reads_input": "import sys; sys.stdin.read(); return good(o)",
    "answers_twice": "import struct, gc\n    send = __import__('__main__').send\n    send(b'b', b'\\x80'); return good(o)",
    "raw_garbage": "import __main__; __main__.answers.write(b'\\xff' * 4096); __main__.answers.flush(); return good(o)",
    "raw_endless": "import __main__\n    while True: __main__.answers.write(b'b\\x00\\x00\\x00\\x00' * 10000)",
    "raw_cut": "import __main__, os; __main__.answers.write(b'b\\xff\\xff\\x00\\x00abc'); __main__.answers.flush(); os._exit(0)",
    "drips": "import __main__, time\n    for _ in range(1000): __main__.answers.write(b'b'); __main__.answers.flush(); time.sleep(0.2)",
    "forks": "import os\n    for _ in range(3):\n        if os.fork() == 0:\n            import time; time.sleep(1000)\n    os._exit(4)",
    "kills_group": "import os, signal; os.killpg(0, signal.SIGKILL)",
    "ignores_signals": "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(1000)",
}
LOADS = {
    "missing": "import no_such_module_at_all\n",
    "no_function": "x = 1\n",
    "not_callable": "act = 3\n",
    "syntax": "def act(:\n",
    "bytes_of_nowhere": "\x00\x01",
    "exits_at_load": "import sys; sys.exit(5)\n",
    "dies_at_load": "import os; os._exit(6)\n",
    "hangs_at_load": "import time; time.sleep(1000)\n",
    "floods_at_load": "import sys\nwhile True: sys.stderr.write('y' * 100000)\n",
    "prints_at_load": "print('z' * (1 << 25))\nimport numpy as np\ndef act(o): return np.zeros(5)\n",
    "garbage_at_load": "import __main__\n__main__.answers.write(bytes(range(256)) * 1000)\n__main__.answers.flush()\nact = len\n",
    "raises_at_load": "raise RuntimeError('the weights are missing')\n",
    "closes_at_load": "import os; [os.close(n) for n in range(0, 30)]\n",
}
MODULES = LOADS | {f"first_{name}": f"{GOOD}def act(o):\n    {body}\n" for name, body in FAULTS.items()}
MODULES |= {f"later_{name}": f"{GOOD}def act(o):\n    if o['step'] < 3: return good(o)\n    {body}\n" for name, body in FAULTS.items()}

HOLD = b"\x81\xa7actions\x95\x00\x00\x00\x00\x00"
ARRAY = b"\x81\xa7actions\x84\xc4\x0b__ndarray__\xc3\xc4\x04data\xc4\x01\x00\xc4\x05dtype"  # up to the name of its type


def frame(data, opcode=2, fin=True):
    head, size = bytes([(0x80 if fin else 0) | opcode]), len(data)
    length = bytes([size]) if size < 126 else struct.pack(">BH", 126, size) if size < 1 << 16 else struct.pack(">BQ", 127, size)
    return head + length + data


def accept(connection, request):
    key = next(line.split(b":")[1].strip() for line in request if line.lower().startswith(b"sec-websocket-key"))
    token = base64.b64encode(hashlib.sha1(key + b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11").digest())
    connection.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " + token + b"\r\n\r\n")


def receive(stream):
    """The kind of one message of the client, which is masked and in one frame."""

    def exactly(count):
        data = stream.read(count)
        if len(data) < count:
            raise ConnectionError
        return data

    kind, size = exactly(2)
    size &= 0x7F
    if size > 125:
        size = int.from_bytes(exactly(2 if size == 126 else 8), "big")
    exactly(4 + size)
    return kind & 0x0F


def endless(connection, data):
    while True:
        connection.sendall(data)


def drip(connection, data, pause):
    for byte in data:
        connection.sendall(bytes([byte]))
        time.sleep(pause)


def half_closed(connection):
    connection.shutdown(socket.SHUT_WR)
    time.sleep(1000)


def reset(connection):
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.close()


RAW = {
    "closes": lambda it: it.close(),
    "resets": reset,
    "silent": lambda it: time.sleep(1000),
    "half_closed": half_closed,
    "not_http": lambda it: it.sendall(b"SSH-2.0-OpenSSH_9.6\r\n"),
    "random": lambda it: it.sendall(os.urandom(4096)),
    "endless_zeros": lambda it: endless(it, bytes(65536)),
    "endless_headers": lambda it: (it.sendall(b"HTTP/1.1 101 X\r\n"), endless(it, b"a: b\r\n" * 100)),
    "endless_status": lambda it: endless(it, b"HTTP/1.1 "),
    "dripping_headers": lambda it: drip(it, b"HTTP/1.1 101 Switching Protocols\r\n" * 100, 0.05),
    "redirect": lambda it: it.sendall(b"HTTP/1.1 302 Found\r\nLocation: ws://169.254.169.254/\r\n\r\n"),
    "page": lambda it: it.sendall(b"HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nhello"),
    "forbidden": lambda it: it.sendall(b"HTTP/1.1 403 Forbidden\r\n\r\n"),
    "not_found": lambda it: it.sendall(b"HTTP/1.1 404 \xff\xfe\r\n\r\n"),
    "unavailable": lambda it: it.sendall(b"HTTP/1.1 503 Busy\r\nContent-Length: 99999999999\r\n\r\n"),
    "wrong_token": lambda it: it.sendall(b"HTTP/1.1 101 X\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: AAAA\r\n\r\n"),
}
MESSAGES = {
    "empty": lambda it: it.sendall(frame(b"")),
    "garbage": lambda it: it.sendall(frame(os.urandom(1000))),
    "text": lambda it: it.sendall(frame(b"Traceback: \x1b[31mno such policy", 1)),
    "text_not_utf8": lambda it: it.sendall(frame(b"\xff\xfe\xfd", 1)),
    "huge_claim": lambda it: it.sendall(b"\x82\x7f" + struct.pack(">Q", 1 << 40)),
    "largest_claim": lambda it: (it.sendall(b"\x82\x7f" + b"\xff" * 8), time.sleep(1000)),
    "sixteen_mib_of_nil": lambda it: it.sendall(frame(b"\xdd" + struct.pack(">I", (16 << 20) - 64) + b"\xc0" * ((16 << 20) - 64))),
    "sixteen_mib_of_arrays": lambda it: it.sendall(frame(b"\x91" * ((16 << 20) - 64))),
    "endless_fragments": lambda it: (it.sendall(frame(b"x" * 65536, 2, False)), endless(it, frame(b"x" * 65536, 0, False))),
    "endless_empty_fragments": lambda it: (it.sendall(frame(b"", 2, False)), endless(it, frame(b"", 0, False) * 1000)),
    "endless_pings": lambda it: endless(it, frame(b"p" * 100, 9)),
    "endless_pongs": lambda it: endless(it, frame(b"p" * 100, 10) * 100),
    "bad_opcode": lambda it: it.sendall(frame(b"x", 5)),
    "reserved_bits": lambda it: it.sendall(b"\xf2\x01x"),
    "masked": lambda it: it.sendall(b"\x82\x81\x00\x00\x00\x00x"),
    "close_frame": lambda it: it.sendall(frame(struct.pack(">H", 1011) + b"out of memory", 8)),
    "bad_close_frame": lambda it: it.sendall(frame(b"\x00", 8)),
    "closes": lambda it: it.close(),
    "resets": reset,
    "half_closed": half_closed,
    "silent": lambda it: time.sleep(1000),
    "drips": lambda it: drip(it, frame(HOLD) * 100, 0.4),
    "cut": lambda it: (it.sendall(frame(HOLD)[:5]), it.close()),
    "two_messages": lambda it: it.sendall(frame(HOLD) * 2),
    "trailing": lambda it: it.sendall(frame(HOLD + b"\x00")),
    "lying_array": lambda it: it.sendall(frame(b"\x81\xa7actions\xdd\xff\xff\xff\xff")),
    "lying_numpy": lambda it: it.sendall(frame(ARRAY + b"\xa3<f4\xc4\x05shape\x92\xcf" + b"\xff" * 8 + b"\x05")),
    "unknown_type": lambda it: it.sendall(frame(ARRAY + b"\xda\x40\x00" + b"q" * 0x4000 + b"\xc4\x05shape\x91\x01")),
}


class Server:
    """A server that behaves badly: on a new connection, in the place of its metadata, or in the place of an answer."""

    def __init__(self, stage, behave):
        self.stage, self.behave = stage, behave
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        with contextlib.suppress(OSError):
            while True:
                connection, _ = self.listener.accept()
                threading.Thread(target=self.handle, args=(connection, connection.makefile("rb")), daemon=True).start()

    def handle(self, connection, stream):
        with contextlib.suppress(OSError):
            request = list(itertools.takewhile(b"\r\n".__ne__, iter(stream.readline, b"")))
            if not request:
                return
            if self.stage == "connection":
                return self.behave(connection)
            accept(connection, request)
            if self.stage == "metadata":
                return self.behave(connection)
            connection.sendall(frame(b"\x80"))
            for number in itertools.count():
                if receive(stream) == 8:
                    return
                if number == (0 if self.stage == "first" else 3):
                    self.behave(connection)
                else:
                    connection.sendall(frame(HOLD))

    def stop(self):
        self.listener.close()


SERVERS = {f"connection_{name}": ("connection", behave) for name, behave in RAW.items()}
for stage in ("metadata", "first", "later"):
    SERVERS |= {f"{stage}_{name}": (stage, behave) for name, behave in MESSAGES.items()}
