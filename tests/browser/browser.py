"""A headless Chromium that Python talks to through two pipes (the DevTools protocol), with nothing but the standard
library: --remote-debugging-pipe needs neither a port nor a WebSocket."""
import importlib.util
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SCREENS = {"desktop": {"width": 1280, "height": 900}, "phone": {"width": 390, "height": 844, "touch": True}}


class Browser:
    """One browser, with an empty profile of its own; a context manager. `draws_space`: with WebGL, computed by the processor."""

    def __init__(self, program="chromium", patience=30, draws_space=False):
        self.patience = patience
        self.profile = tempfile.mkdtemp(prefix="rouleau-browser-")
        to_browser, self.output = os.pipe()
        self.input, from_browser = os.pipe()

        def hand_over():  # the browser reads from descriptor 3 and writes to 4
            os.dup2(to_browser, 103)
            os.dup2(from_browser, 104)
            os.dup2(103, 3)
            os.dup2(104, 4)

        self.process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
             *(("--use-angle=swiftshader", "--enable-unsafe-swiftshader") if draws_space else ("--disable-gpu",)),
             "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--hide-scrollbars", "--mute-audio",
             "--remote-debugging-pipe", f"--user-data-dir={self.profile}", "about:blank"],
            preexec_fn=hand_over, pass_fds=(3, 4), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer = b""
        self.number = 0
        self.events = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Browser.close")
        except (OSError, RuntimeError):
            self.process.kill()
        self.process.wait()
        os.close(self.output)
        os.close(self.input)
        shutil.rmtree(self.profile, ignore_errors=True)

    def receive(self, deadline):
        """The next message, or None when none has come in time."""
        while b"\0" not in self.buffer:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self.input], [], [], left)[0]:
                return None
            piece = os.read(self.input, 1 << 20)
            if not piece:
                raise RuntimeError("the browser has ended")
            self.buffer += piece
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, session=None, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.output, data):]
        deadline = time.monotonic() + self.patience
        while (answer := self.receive(deadline)) is not None:
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            if "method" in answer:
                self.events.append(answer)
        raise RuntimeError(f"{method}: no answer within {self.patience} s")

    def open(self, url, width=1280, height=900, scheme="light", touch=False, still=True):
        return Page(self, url, width, height, scheme, touch, still)


class Page:
    """A tab with a page in it. Whatever goes wrong in the page stands in `faults()`."""

    def __init__(self, browser, url, width, height, scheme, touch, still):
        self.browser = browser
        self.url = url
        self.target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.call("Target.attachToTarget", targetId=self.target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if touch else 1, mobile=touch)
        self.media(scheme, still=still)
        self.call("Page.navigate", url=url)
        self.wait("document.readyState === 'complete'", browser.patience)

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def media(self, scheme, kind="", still=True):
        self.call("Emulation.setEmulatedMedia", media=kind, features=[{"name": "prefers-color-scheme", "value": scheme},
                  {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"}])

    def run(self, expression):
        """Value of a JavaScript expression; a promise is waited for."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise RuntimeError(f"{expression}: {details.get('exception', {}).get('description', details['text'])}")
        return answer["result"].get("value")

    def wait(self, condition, patience=20):
        """Until a JavaScript condition holds in the page."""
        self.until(lambda: self.run(condition), condition, patience)

    def until(self, holds, words, patience=20):
        deadline = time.monotonic() + patience
        while not holds():
            if time.monotonic() > deadline:
                raise RuntimeError(f"still not so after {patience} s: {words}")
            self.run("new Promise(r => setTimeout(r, 15))")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.mouse(kind, x, y, button="left", clickCount=1, buttons=1)

    def key(self, key):
        """Presses a key where the focus is."""
        code = {" ": ("Space", 32), "ArrowRight": ("ArrowRight", 39), "ArrowLeft": ("ArrowLeft", 37), "+": ("BracketRight", 187), "0": ("Digit0", 48), "Enter": ("Enter", 13)}[key]
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code[0], windowsVirtualKeyCode=code[1])

    def faults(self):
        """Exceptions, console errors and warnings, failed loads, and every request but that for the page itself."""
        found = []
        for event in self.browser.events:
            if event.get("sessionId") != self.session:
                continue
            kind, details = event["method"], event["params"]
            if kind == "Runtime.exceptionThrown":
                exception = details["exceptionDetails"]
                found.append("exception: " + exception.get("exception", {}).get("description", exception["text"]))
            elif kind == "Runtime.consoleAPICalled" and details["type"] in ("error", "warning", "assert"):
                found.append("console: " + " ".join(str(a.get("value", a.get("description"))) for a in details["args"]))
            elif kind == "Log.entryAdded" and details["entry"]["level"] in ("error", "warning"):
                found.append("log: " + details["entry"]["text"])
            elif kind == "Network.requestWillBeSent":
                url = details["request"]["url"]
                if url != self.url.split("#")[0] and not url.startswith("data:"):
                    found.append("request: " + url)
        return found

    def screenshot(self, whole=True):
        """PNG bytes in base64."""
        return self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]

    def print_pdf(self):
        return self.call("Page.printToPDF", printBackground=True, preferCSSPageSize=False, paperWidth=8.27, paperHeight=11.69)["data"]


class BrowserCase(unittest.TestCase):
    """A test that looks at pages; `browser` is given to the class before the first one."""
    browser = None

    def open(self, file, screen="desktop", scheme="light", still=True, part=""):
        page = self.browser.open(Path(file).as_uri() + part, scheme=scheme, still=still, **SCREENS[screen])
        self.addCleanup(page.close)
        return page


SKIPPED = 77  # for ctest


def main(*modules):
    """Runs the tests of the script that calls it. Without a browser, or one of the Python modules, they are skipped."""
    missing = [] if shutil.which("chromium") else ["chromium"]
    missing += [module for module in modules if importlib.util.find_spec(module) is None]
    if missing:
        print(f"skipped: {', '.join(missing)} missing (scripts/install-dependencies --full)")
        sys.exit(SKIPPED)
    program = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False)
    failed = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)
