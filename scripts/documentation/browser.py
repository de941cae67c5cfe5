"""Headless Chromium by its DevTools protocol over a pipe: opens pages, runs scripts in them, keeps what they load and complain of."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

SECONDS = 60  # for any answer
WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")


def find():
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Browser:
    """with Browser() as browser: browser.open(file, width); browser.evaluate(script)"""

    def __init__(self, graphics=("--disable-gpu",)):
        """graphics: options of Chromium for what is drawn; WEBGL: with WebGL, in software."""
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, from_us = os.pipe()
        to_us, from_browser = os.pipe()

        def hand_over():  # Chromium reads descriptor 3 and writes 4
            os.setsid()
            read, write = os.dup(to_browser), os.dup(from_browser)
            os.dup2(read, 3)
            os.dup2(write, 4)

        self._process = subprocess.Popen(
            [find(), "--headless", "--no-sandbox", *graphics, "--disable-quic", "--no-first-run", "--disable-sync",
             "--disable-background-networking", "--disable-component-update", "--disable-extensions", "--hide-scrollbars",
             f"--user-data-dir={self._profile.name}", "--remote-debugging-pipe", "about:blank"],
            preexec_fn=hand_over, close_fds=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self._out, self._in = from_us, to_us
        os.set_blocking(to_us, False)
        self._rest, self._number, self._session = b"", 0, None
        self.requests, self.complaints = [], []
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(target for target in targets if target["type"] == "page")
        self._session = self.call("Target.attachToTarget", targetId=page["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.call(domain + ".enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self._out)  # Chromium ends with its pipe
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        os.close(self._in)
        self._profile.cleanup()

    def _messages(self, deadline):
        while time.monotonic() < deadline:
            try:
                piece = os.read(self._in, 1 << 20)
                if not piece:
                    raise RuntimeError("Chromium has ended")
                self._rest += piece
            except BlockingIOError:
                if self._process.poll() is not None:
                    raise RuntimeError("Chromium has ended") from None
                time.sleep(0.01)
            *whole, self._rest = self._rest.split(b"\0")
            for text in whole:
                yield json.loads(text)

    def _note(self, message):
        method, values = message.get("method"), message.get("params", {})
        if method == "Network.requestWillBeSent":
            self.requests.append(values["request"]["url"])
        elif method == "Runtime.exceptionThrown":
            details = values["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description") or details["text"])
        elif method == "Runtime.consoleAPICalled" and values["type"] in ("error", "assert", "warning"):
            self.complaints.append(" ".join(str(value.get("value", value.get("description"))) for value in values["args"]))
        elif method == "Log.entryAdded" and values["entry"]["level"] in ("error", "warning"):
            self.complaints.append(f"{values['entry']['text']} {values['entry'].get('url', '')}")

    def call(self, method, **values):
        self._number += 1
        number = self._number
        message = {"id": number, "method": method, "params": values}
        if self._session:
            message["sessionId"] = self._session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._out, data):]
        for answer in self._messages(time.monotonic() + SECONDS):
            self._note(answer)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
        raise RuntimeError(f"{method}: no answer within {SECONDS} s")

    def evaluate(self, script):
        """Value of an expression in the page; a promise is waited for."""
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", "script failed"))
        return result["result"].get("value")

    def wait_for(self, script, seconds=90):
        """The expression's value as soon as it is true; its last value where it never is."""
        deadline = time.monotonic() + seconds
        while True:
            value = self.evaluate(script)
            if value or time.monotonic() > deadline:
                return value
            time.sleep(0.1)

    def open(self, file, width, height=900):
        """Opens a file in a window of that width and waits until it is loaded. Complaints and requests start anew."""
        self.requests.clear()
        self.complaints.clear()
        self.resize(width, height)
        # A page of the same address is not loaded again for another anchor.
        self.call("Page.navigate", url="about:blank")
        url = pathlib.Path(file).resolve().as_uri()
        self.call("Page.navigate", url=url)
        if not self.wait_for(f"document.readyState === 'complete' && location.href === {json.dumps(url)}"):
            raise RuntimeError(f"{file} does not load")

    def resize(self, width, height=900):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def type(self, text):
        for letter in text:
            self.call("Input.dispatchKeyEvent", type="keyDown", text=letter)
            self.call("Input.dispatchKeyEvent", type="keyUp")

    def picture(self, file):
        import base64
        file.write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))
