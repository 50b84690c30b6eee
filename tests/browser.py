"""A real headless browser for tests of pages; its console errors and its requests can be read."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

OPTIONS = (
    "--headless",
    "--window-size=1400,1100",
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
CHROMIUM, DRIVER = ("chromium", "chromium-browser", "google-chrome"), "chromedriver"


def programs() -> tuple[str, str]:
    """Chromium and its driver; the test is skipped where one of them or selenium is not installed."""
    pytest.importorskip("selenium", reason="selenium is not installed: pip install 'mpmkit[test]'")
    browser = next((found for name in CHROMIUM if (found := shutil.which(name))), None)
    driver = shutil.which(DRIVER)
    if browser is None or driver is None:
        pytest.skip(
            "Chromium and its driver are not installed (Debian: apt install chromium chromium-driver)"
        )
    return browser, driver


class Window:
    """A page in a browser."""

    def __init__(self, driver) -> None:
        self.driver = driver

    def look(self, width: int, height: int = 900, dark: bool = False) -> None:
        """Take a size and a colour scheme."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        wishes = {"prefers-color-scheme": "dark" if dark else "light", "prefers-reduced-motion": "reduce"}
        features = [{"name": name, "value": value} for name, value in wishes.items()]
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})

    def open(self, path: Path) -> None:
        """Open a page, and wait until its scripts have drawn it."""
        self.driver.get(path.resolve().as_uri())
        self.until("document.documentElement.dataset.ready === 'yes'")

    def run(self, script: str, *arguments):
        """The result of a script."""
        return self.driver.execute_script(script, *arguments)

    def until(self, condition: str, seconds: float = 10.0) -> None:
        """Wait until an expression is true."""
        from selenium.webdriver.support.ui import WebDriverWait

        WebDriverWait(self.driver, seconds, 0.05).until(lambda _: self.run(f"return {condition}"), condition)

    def find(self, selector: str):
        from selenium.webdriver.common.by import By

        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def actions(self):
        from selenium.webdriver import ActionChains

        return ActionChains(self.driver)

    def errors(self) -> list[str]:
        """Errors in the console since the last call."""
        return [line["message"] for line in self.driver.get_log("browser") if line["level"] == "SEVERE"]

    def requests(self) -> list[str]:
        """Addresses requested since the last call, except files, and data inside the page or the browser."""
        messages = [json.loads(line["message"])["message"] for line in self.driver.get_log("performance")]
        sent = [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]
        return [address for address in sent if not address.startswith(("file:", "data:", "blob:", "chrome"))]


@contextmanager
def window() -> Iterator[Window]:
    """A new browser, which is closed at the end of the block."""
    browser, driver = programs()
    from selenium.webdriver import Chrome, ChromeOptions
    from selenium.webdriver.chrome.service import Service

    with TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = ChromeOptions()
        options.binary_location = browser
        for option in (*OPTIONS, f"--user-data-dir={profile}"):
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        chrome = Chrome(options=options, service=Service(driver))
        try:
            yield Window(chrome)
        finally:
            chrome.quit()
