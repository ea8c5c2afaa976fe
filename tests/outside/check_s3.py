#!/usr/bin/env python3
"""check_s3.py COSFLY ONE-WINNER RECIPE FOLDER: a store in a bucket of a server that speaks S3 (the Python package `moto`): the bytes of a local run,
on one machine and on two with HyperQueue; one winner of many writers; servers that refuse, hang or lie give clear errors."""

import http.server
import json
import os
import shutil
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from pathlib import Path

from shared import bytes_of, run

cosfly, race, recipe, folder = (Path(argument).absolute() for argument in sys.argv[1:5])
folder.mkdir(parents=True, exist_ok=True)
PORT = 5555
SERVER = f"http://127.0.0.1:{PORT}"
# moto checks a condition and writes in two steps; S3 promises one, and the lock makes it so.
MOTO = """
import sys, threading
from moto.server import DomainDispatcherApplication, create_backend_app
from werkzeug.serving import run_simple
app, lock = DomainDispatcherApplication(create_backend_app), threading.Lock()
def one_at_a_time(environ, start_response):
    with lock:
        return list(app(environ, start_response))
run_simple("127.0.0.1", int(sys.argv[1]), one_at_a_time, threaded=True)
"""
environment = {
    **os.environ, "AWS_ACCESS_KEY_ID": "key", "AWS_SECRET_ACCESS_KEY": "secret", "AWS_REGION": "us-east-1",
    "AWS_ENDPOINT_URL": SERVER, "AWS_ALLOW_HTTP": "true",
}


def start_server():
    process = subprocess.Popen([sys.executable, "-c", MOTO, str(PORT)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(200):
        try:
            urllib.request.urlopen(urllib.request.Request(f"{SERVER}/bucket", method="PUT")).close()
            return process
        except OSError:
            time.sleep(0.1)
    sys.exit("moto does not start")


def call(*arguments, cache="cache", code=0, **more):
    process = subprocess.run(
        [cosfly, *arguments], cwd=folder, env={**environment, "COSFLY_CACHE": str(folder / cache), **more}, capture_output=True, text=True, timeout=300
    )
    if process.returncode != code:
        sys.exit(f"cosfly {' '.join(map(str, arguments))} ended with {process.returncode}, not {code}:\n{process.stdout}\n{process.stderr}")
    return process.stdout if code == 0 else process.stderr


def tree(out):
    return bytes_of(folder / out)


class Fault(http.server.BaseHTTPRequestHandler):
    """A server with one fault; the first `good` requests go on to the real one."""

    answer, good = (500, b""), 0

    def handle_one(self):
        body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        (status, content), headers = Fault.answer, {}
        if Fault.good > 0:
            Fault.good -= 1
            request = {"data": body or None, "headers": {"Content-type": "application/octet-stream", **self.headers}, "method": self.command}
            try:
                answer = urllib.request.urlopen(urllib.request.Request(SERVER + self.path, **request))
            except urllib.error.HTTPError as error:
                answer = error
            with answer:
                status, headers, content = answer.status, answer.headers, answer.read()
        elif status == 0:
            time.sleep(3600)  # hangs
        self.send_response(status)
        for name in ("ETag", "Last-Modified", "Content-Type"):
            if headers.get(name):
                self.send_header(name, headers[name])
        self.send_header("Content-Length", headers.get("Content-Length", "0") if self.command == "HEAD" else str(len(content)))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)

    do_GET = do_PUT = do_HEAD = do_POST = do_DELETE = handle_one

    def log_message(self, *_):
        pass


def s3_error(code, message):
    return f'<?xml version="1.0"?><Error><Code>{code}</Code><Message>{message}</Message></Error>'.encode()


def check_faults():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", PORT + 1), Fault)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    faulty = {"AWS_ENDPOINT_URL": f"http://127.0.0.1:{PORT + 1}"}
    cases = [
        ((403, s3_error("InvalidAccessKeyId", "The key does not exist")), 0, "remote-credentials", 5),
        ((403, s3_error("SignatureDoesNotMatch", "The signature does not match")), 20, "remote-credentials", 5),
        ((403, s3_error("RequestTimeTooSkewed", "The difference is too large")), 0, "remote-clock", 5),
        ((507, s3_error("XMinioStorageFull", "Storage backend has reached its minimum free drive threshold")), 30, "remote-full", 5),
        ((404, s3_error("NoSuchBucket", "The bucket does not exist")), 0, "remote-bucket", 3),
        ((500, s3_error("InternalError", "We encountered an internal error")), 25, "remote-refused", 5),
        ((0, b""), 12, "remote-refused", 5),
    ]
    for number, (answer, good, code, exit_code) in enumerate(cases):
        Fault.answer, Fault.good = answer, good
        began = time.time()
        place = f"s3://bucket/fault-{number}"
        stderr = call("run", recipe, "--store", place, "--out", f"fault-{number}", cache=f"cache-fault-{number}", code=exit_code, **faulty)
        assert f"[{code}]" in stderr, f"{answer}: {stderr}"
        assert not (folder / f"fault-{number}").exists(), "no dataset"
        print(f"{answer[0]} {code}: told after {time.time() - began:.0f} s")
        # The same store, from another machine, once the server is well.
        if good:
            call("run", recipe, "--store", place, "--out", "mended", cache=f"cache-mended-{number}", code=0)
            assert tree("mended") == tree("here"), "no wrong bytes"
            shutil.rmtree(folder / "mended")
    server.shutdown()


server = start_server()
try:
    call("run", recipe, "--store", "local", "--out", "here")
    place = "s3://bucket/store"
    began = time.time()
    call("run", recipe, "--store", place, "--out", "there")
    print(f"a run into the bucket: {time.time() - began:.1f} s")
    assert tree("here") == tree("there"), "the bytes of a local run"
    began = time.time()
    summary = json.loads(call("run", recipe, "--store", place, "--out", "elsewhere", "--json", cache="other"))
    assert all(stage["ran"] == 0 for stage in summary["stages"]), "another machine finds everything"
    assert tree("here") == tree("elsewhere")
    print(f"the same from another machine, all found: {time.time() - began:.1f} s")
    assert "to_run\": 0" in call("plan", recipe, "--store", place, "--json", cache="third")
    # Commands of any engine, each with a cache of its own.
    lines = call("run", recipe, "--store", "s3://bucket/emitted", "--on", "emit").splitlines()
    for line in lines:
        command = json.loads(line)
        call(*command["command"][1:], cache=f"leaf-{command['id'] % 3}")
    call("run", recipe, "--store", "s3://bucket/emitted", "--out", "emitted")
    assert tree("here") == tree("emitted")
    # Versions and garbage.
    call("dataset", "tag", "v1", recipe, "--store", place)
    assert "v1" in call("dataset", "list", "--store", place, cache="fourth")
    call("dataset", "checkout", "v1", "--out", "checked-out", "--store", place, cache="fourth")
    assert tree("here") == tree("checked-out")
    call("verify", "checked-out")
    for weight in (7, 8):
        call("run", recipe, "--set", f"stages.expert.weights.visibility={weight}", "--store", place, "--out", "changed")
    told = call("gc", "--store", place, "--keep-runs", "1", "--keep-days", "0", "--delete")
    print(told.strip())
    assert "removed 0 blobs" not in told, "the run before the last one goes"
    call("dataset", "checkout", "v1", "--out", "still-there", "--store", place, cache="fifth")
    assert tree("here") == tree("still-there"), "a named version is kept"
    winners = run(race, "s3://bucket/race", env=environment).strip()
    assert winners == "1", f"{winners} winners of 1000 creates"
    check_faults()
    assert "remote-place" in call("run", recipe, "--store", "s3://bucket", code=3)
finally:
    server.kill()
print("a bucket is a store")
