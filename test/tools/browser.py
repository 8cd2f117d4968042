# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Headless Chromium by its DevTools protocol, over a pair of pipes."""
import json
import os
import shutil
import subprocess
import tempfile
import time

PROGRAM = shutil.which("chromium")
LIMIT_S = 60


class Browser:
    """One page. What it says on its console in error is in `complaints`."""

    def __init__(self, url):
        self.folder, self.complaints, self.calls, self.rest = tempfile.TemporaryDirectory(), [], 0, b""
        hears, tells = os.pipe()
        self.answers, answers = os.pipe()
        command = [PROGRAM, "--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1280,1000",
                   f"--user-data-dir={self.folder.name}", "--remote-debugging-pipe", "about:blank"]
        # Chromium hears on descriptor 3 and answers on 4.
        self.process = subprocess.Popen(
            ["sh", "-c", f'exec 3<&{hears} 4>&{answers} "$@"', "sh", *command],
            pass_fds=(hears, answers), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(hears)
        os.close(answers)
        self.orders, self.session = tells, {}
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.session = {"sessionId": session}
        self.call("Runtime.enable")
        self.call("Log.enable")
        self.call("Page.navigate", url=url)
        self.wait_for("document.readyState === 'complete'")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        for descriptor in (self.orders, self.answers):
            os.close(descriptor)
        shutil.rmtree(self.folder.name, ignore_errors=True)
        self.folder.cleanup()

    def call(self, method, **parameters):
        self.calls += 1
        order = {"id": self.calls, "method": method, "params": parameters, **self.session}
        os.write(self.orders, json.dumps(order).encode() + b"\0")
        while True:
            told = self._next()
            if told.get("id") == self.calls:
                assert "error" not in told, told
                return told["result"]
            self._note(told)

    def _next(self):
        while b"\0" not in self.rest:
            piece = os.read(self.answers, 1 << 20)
            assert piece, "Chromium has ended"
            self.rest += piece
        told, _, self.rest = self.rest.partition(b"\0")
        return json.loads(told)

    def _note(self, told):
        entry = told.get("params", {}).get("entry", {})
        if told.get("method") == "Runtime.exceptionThrown" or entry.get("level") == "error":
            self.complaints.append(told["params"])

    def evaluate(self, script):
        told = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        assert "exceptionDetails" not in told, (script, told)
        return told["result"].get("value")

    def wait_for(self, script):
        """The value, once it is true."""
        end = time.monotonic() + LIMIT_S
        while not (value := self.evaluate(script)):
            assert time.monotonic() < end, f"in vain: {script}"
            time.sleep(0.05)
        return value

    def text(self, element):
        return self.evaluate(f"document.getElementById({element!r}).textContent")

    def drawn(self, canvas):
        """A number that changes with what a canvas shows; 0 where it is blank."""
        return self.evaluate(
            f"(() => {{ const c = document.getElementById({canvas!r});"
            "const d = new Uint32Array(c.getContext('2d').getImageData(0, 0, c.width, c.height).data.buffer);"
            "return d.reduce((sum, pixel, i) => pixel ? (sum * 31 + pixel + i) % 4294967291 : sum, 0); })()")
