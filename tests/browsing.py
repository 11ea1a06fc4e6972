"""A real browser without a window, for what is seen in one."""

import os
import shutil
from contextlib import contextmanager
from pathlib import Path

import pytest

REQUIRED = "DRAKE_FORMATION_BROWSER"
"""Where this is in the environment, tests that find no browser fail instead of being skipped."""

FLAGS = (
    "--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-extensions",
    "--disable-background-networking", "--disable-component-update", "--no-first-run",
)  # fmt: skip
"""Without a window, in any container, with WebGL in software, and nothing of its own beside the page."""

SIZE = (800, 500)
"""Of the window (pixels); software draws a larger one more slowly."""


def chromium(size=(1280, 800)):
    """Debian's Chromium and its driver, started, with a window of a size (px)."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    programs = shutil.which("chromium"), shutil.which("chromedriver")
    if None in programs:
        (pytest.fail if os.environ.get(REQUIRED) else pytest.skip)("there is no chromium with chromedriver")
    options = webdriver.ChromeOptions()
    options.binary_location = programs[0]
    for flag in (*FLAGS, f"--window-size={size[0]},{size[1]}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(options=options, service=Service(programs[1]))


WHERE = """
const object = viewer.scene_tree.find(arguments[0].split('/')).object;
object.updateWorldMatrix(true, true);
const place = object.position.clone();
object.getWorldPosition(place);
const seen = place.clone();
seen.y += arguments[1];
seen.project(viewer.camera);
const size = viewer.renderer.domElement.getBoundingClientRect();
return {x: place.x, y: -place.z, shown: object.visible,
        column: (1 + seen.x) / 2 * size.width, row: (1 - seen.y) / 2 * size.height};
"""


@contextmanager
def opened(address, *, offline=False, size=SIZE):
    """A page with a recording, in a browser of its own; one that has hung, as on a busy machine, is tried once more.

    Offline, everything that is not a file fails to load, which the console tells.
    """
    from selenium.common.exceptions import TimeoutException

    view = View(chromium(size))
    try:
        view.go(address, offline=offline)
    except TimeoutException:
        view.driver.quit()
        view = View(chromium(size))
        view.go(address, offline=offline)
    try:
        yield view
    finally:
        view.driver.quit()


class View:
    """A page with a recording, open in a browser."""

    def __init__(self, driver):
        self.driver = driver
        driver.set_page_load_timeout(60)
        driver.set_script_timeout(60)
        driver.execute_cdp_cmd("Network.enable", {})

    def go(self, address, *, offline=False):
        """Go to a page."""
        unlimited = {"latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
        self.driver.execute_cdp_cmd("Network.emulateNetworkConditions", {"offline": offline, **unlimited})
        self.driver.get(address)

    def scrub(self, time):
        """Go to a time of the recording (s)."""
        self.driver.execute_script("viewer.animator.pause(); viewer.animator.seek(arguments[0]);", time)

    def where(self, path, height=0.0):
        """Where an object is (m), whether it is shown, and in which pixel a point some height above it (m) is."""
        return self.driver.execute_script(WHERE, path, height)

    def duration(self):
        return self.driver.execute_script("return viewer.animator.duration")

    def complaints(self):
        """What was written to the console."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def picture(self):
        """What is seen, as an array of pixels."""
        from io import BytesIO

        import numpy as np
        from PIL import Image

        self.driver.execute_async_script("viewer.set_dirty(); setTimeout(arguments[0], 300)")
        return np.asarray(Image.open(BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")).astype(int)


def page_address(path: Path) -> str:
    return path.resolve().as_uri()
