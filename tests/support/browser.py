"""A headless Chromium, driven through ChromeDriver: the WebDriver protocol is JSON over HTTP."""

import base64
import contextlib
import json
import shutil
import subprocess
import time
import urllib.error
import urllib.request

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which(
    "google-chrome")
DRIVER = shutil.which("chromedriver")
TAB, ENTER = "\ue004", "\ue007"


class Browser:
    """One window."""

    def __init__(self, port, width, height):
        self._address = f"http://127.0.0.1:{port}"
        # No proxy of the environment stands between.
        self._opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        options = {"binary": CHROMIUM, "args": [
            "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
            "--hide-scrollbars", f"--window-size={width},{height}"]}
        found = self._post("/session", {"capabilities": {"alwaysMatch": {
            "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}}})
        self._session = f"/session/{found['sessionId']}"
        # Chromium's windows have a least width; its emulation of a telephone has none.
        self._post(f"{self._session}/goog/cdp/execute", {
            "cmd": "Emulation.setDeviceMetricsOverride",
            "params": {"width": width, "height": height, "deviceScaleFactor": 1,
                       "mobile": width < 600}})

    def _post(self, path, data=None, method="POST"):
        body = None if data is None else json.dumps(data).encode()
        request = urllib.request.Request(self._address + path, body, method=method,
                                         headers={"Content-Type": "application/json"})
        with self._opener.open(request, timeout=120) as answer:
            return json.load(answer)["value"]

    def open(self, address):
        # The same page with another fragment would not be loaded again.
        self._post(f"{self._session}/url", {"url": "about:blank"})
        self._post(f"{self._session}/url", {"url": address})

    def run(self, script, *arguments):
        """Return what a piece of JavaScript returns."""
        return self._post(f"{self._session}/execute/sync",
                          {"script": script, "args": list(arguments)})

    def type(self, keys):
        """Press keys, wherever the focus is."""
        actions = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        self._post(f"{self._session}/actions",
                   {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def complaints(self):
        """Return what the console has."""
        found = self._post(f"{self._session}/se/log", {"type": "browser"})
        return [one["message"] for one in found if one["level"] in ("SEVERE", "WARNING")]

    def screenshot(self):
        return base64.b64decode(self._post(f"{self._session}/screenshot", method="GET"))

    def close(self):
        self._post(self._session, method="DELETE")


@contextlib.contextmanager
def browser(width, height):
    """Start a driver and a window, and end them."""
    driver = subprocess.Popen([DRIVER, "--port=0"], stdout=subprocess.PIPE, text=True,
                              stderr=subprocess.DEVNULL)
    try:
        for line in driver.stdout:
            if "successfully on port" in line:
                port = int(line.rstrip(".\n").rsplit(" ", 1)[1])
                break
        for _ in range(50):
            try:
                window = Browser(port, width, height)
                break
            except urllib.error.URLError:
                time.sleep(0.1)
        try:
            yield window
        finally:
            window.close()
    finally:
        driver.terminate()
        driver.wait()
        driver.stdout.close()
