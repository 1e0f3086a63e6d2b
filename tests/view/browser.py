"""Chromium without a window, driven over the DevTools protocol through a pipe: no other package is needed.

WebGL is drawn in software (SwiftShader), so that the same pixels come without a graphics processor."""

import base64
import json
import os
import pathlib
import select
import shutil
import subprocess
import tempfile
import time


def executable():
    """That of Chromium, or None."""
    for name in ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"):
        if found := shutil.which(name):
            return found
    return None


class Browser:
    """`with Browser() as browser: page = browser.open(path)`. Raises OSError where Chromium does not start."""

    def __init__(self, width=1160, height=900, dark=False, graphics=True, software=True, script=True):
        self.folder = tempfile.mkdtemp(prefix="bernal-browser-")
        self.script = script
        self.next_id = 0
        self.events = []
        self.pending = b""
        down, self.to_browser = os.pipe()
        self.from_browser, up = os.pipe()
        # Chromium reads commands from descriptor 3 and writes answers to 4.
        def take_pipes():
            high = [os.dup(down), os.dup(up)]
            os.dup2(high[0], 3), os.dup2(high[1], 4)

        flags = ["--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run", "--remote-debugging-pipe",
                 "--disable-background-networking", "--disable-component-update", "--disable-sync",
                 "--hide-scrollbars", "--force-device-scale-factor=1", "--enable-precise-memory-info",
                 "--disable-backgrounding-occluded-windows", "--disable-renderer-backgrounding",
                 f"--user-data-dir={self.folder}", f"--window-size={width},{height}"]
        flags += ([] if graphics and not software else
                  ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if graphics
                  else ["--disable-gpu", "--disable-3d-apis"])
        self.process = subprocess.Popen([executable(), *flags, "about:blank"], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, close_fds=False,
                                        preexec_fn=take_pipes)
        os.close(down), os.close(up)
        target = next(t for t in self.call("Target.getTargets", session=None)["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", session=None, targetId=target["targetId"],
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        if not script:
            self.call("Emulation.setScriptExecutionDisabled", value=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Browser.close", session=None, timeout=10)
        except OSError:
            self.process.kill()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
        os.close(self.to_browser), os.close(self.from_browser)
        shutil.rmtree(self.folder, ignore_errors=True)

    def receive(self, timeout):
        """The next message, or None."""
        end = time.monotonic() + timeout
        while b"\0" not in self.pending:
            left = end - time.monotonic()
            if left <= 0 or not select.select([self.from_browser], [], [], left)[0]:
                return None
            part = os.read(self.from_browser, 1 << 20)
            if not part:
                raise OSError("Chromium has ended")
            self.pending += part
        message, self.pending = self.pending.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, session="", timeout=120, **parameters):
        self.next_id += 1
        message = {"id": self.next_id, "method": method, "params": parameters}
        if session is not None:
            message["sessionId"] = self.session
        os.write(self.to_browser, json.dumps(message).encode() + b"\0")
        while answer := self.receive(timeout):
            if answer.get("id") == self.next_id:
                if "error" in answer:
                    raise OSError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            if "method" in answer:
                self.events.append(answer)
        raise OSError(f"{method}: no answer in {timeout} s")

    def open(self, file, timeout=120):
        """Shows a file and waits until it is whole."""
        self.events.clear()
        self.call("Page.navigate", url=pathlib.Path(file).resolve().as_uri())
        end = time.monotonic() + timeout
        while not any(e["method"] == "Page.loadEventFired" for e in self.events):
            if time.monotonic() > end:
                raise OSError(f"{file} does not load")
            if event := self.receive(1):
                self.events.append(event)
        self.settle()

    def settle(self, seconds=0.4):
        """Lets frames that were asked for be drawn."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if event := self.receive(left):
                self.events.append(event)
        if self.script:
            self.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def run(self, script, timeout=120):
        """The value of an expression, or of its promise. Raises RuntimeError for what it throws."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True,
                           timeout=timeout)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise RuntimeError(details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def complaints(self):
        """What the page wrote to the console, and what it threw."""
        texts = []
        for event in self.events:
            parameters = event.get("params", {})
            if event["method"] == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
                texts.append(" ".join(str(a.get("value", a.get("description"))) for a in parameters["args"]))
            elif event["method"] == "Runtime.exceptionThrown":
                texts.append(str(parameters["exceptionDetails"].get("exception", {}).get("description")))
            elif event["method"] == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
                texts.append(parameters["entry"]["text"])
        return texts

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, x, y):
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", clickCount=1)

    def drag(self, start, end, steps=6, modifiers=0):
        self.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1, modifiers=modifiers)
        for k in range(1, steps + 1):
            at = [a + (b - a) * k / steps for a, b in zip(start, end)]
            self.mouse("mouseMoved", *at, button="left", buttons=1, modifiers=modifiers)
        self.mouse("mouseReleased", *end, button="left", clickCount=1, modifiers=modifiers)

    def key(self, key, modifiers=0):
        text = {} if len(key) > 1 else {"text": key}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, modifiers=modifiers, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, modifiers=modifiers)

    def screenshot(self, file, whole=False):
        """Saves the window, or all of the page, as PNG."""
        shot = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        pathlib.Path(file).write_bytes(base64.b64decode(shot["data"]))
