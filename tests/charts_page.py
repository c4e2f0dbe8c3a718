#!/usr/bin/env python3
"""Moves the mouse onto a point of each chart of report.html, in headless Chromium without a
network, and looks at what the page then tells; then taps the same points on a window as wide as a
phone's.

    charts_page.py REPORT FOLDER [SCREENSHOT]

The page must show the command of a point there and, where it has them, its pictures, decoded; and
must ask for nothing from outside itself. Until a point is chosen it says what to do. No two series
of a chart have the same marker. On a phone nothing is cut off at the side, charts have the width of
the window, and the panel leaves them half of its height.
Exit status 77: there is no page, or no Chromium to look with.
"""
import base64
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

SKIPPED = 77
# Of chart i: where the last point of its first series lies in the window, what it should tell and
# what else lies there
AIM = """(() => {
  const chart = built[%d], set = chart.data.datasets[0], at = set.data.length - 1;
  const mark = chart.getDatasetMeta(0).data[at];
  window.scrollBy(0, chart.canvas.getBoundingClientRect().top + mark.y - innerHeight / 4);
  const box = chart.canvas.getBoundingClientRect();
  const there = chart.data.datasets.flatMap((d, k) => d.series ? d.data.filter((_, j) => {
    const m = chart.getDatasetMeta(k).data[j];
    return Math.hypot(m.x - mark.x, m.y - mark.y) < 16; }) : []);
  return {x: box.left + mark.x, y: box.top + mark.y, title: chart.options.plugins.title.text,
          commands: there.map(p => p.command), pictures: "picture" in set.data[at] ? 2 : 0};
})()"""
LOOK = """new Promise(async done => {
  await new Promise(wait => setTimeout(wait, 60));
  const widths = [];
  for (const id of ["crop", "error"]) {
    const image = document.getElementById(id);
    if (image.parentElement.hidden) continue;
    await Promise.race([image.decode().catch(() => 0),
                        new Promise(late => setTimeout(late, 3000))]);
    widths.push(image.naturalWidth);
  }
  done({command: document.getElementById("command").textContent,
        name: document.getElementById("name").textContent, widths});
})"""


# Markers that several series of a chart share, over all its panels
SHARED = """(() => {
  const shared = [];
  let next = 0;
  for (const chart of data.charts) {
    const names = {};
    for (const {data: {datasets}} of built.slice(next, next += chart.panels.length))
      for (const d of datasets.filter(d => d.series)) {
        const marker = [d.pointStyle, d.pointRotation || 0, d.backgroundColor === "#fff"];
        (names[marker] ??= new Set()).add(d.label);
      }
    for (const [marker, series] of Object.entries(names))
      if (series.size > 1) shared.push([chart.name, marker, ...series]);
  }
  return shared;
})()"""
PANEL = """(() => {
  const aside = document.querySelector("aside");
  return {words: aside.innerText, command: document.getElementById("command").offsetHeight,
          height: aside.getBoundingClientRect().height, right: document.documentElement.scrollWidth,
          narrowest: Math.min(...built.map(chart => chart.width))};
})()"""
PHONE = (390, 844)


class Chromium:
    """Talks Chromium's own protocol over two pipes, which it has as descriptors 3 and 4."""

    def __init__(self, program, profile):
        (to_read, self.to), (self.back, from_write) = os.pipe(), os.pipe()
        words = [
            program, "--headless", "--no-sandbox", "--disable-gpu",
            "--disable-background-networking", "--host-resolver-rules=MAP * ~NOTFOUND",
            f"--user-data-dir={profile}", "--window-size=1500,1000", "--remote-debugging-pipe"]
        shell = ["/bin/bash", "-c", f'exec "$@" 3<&{to_read} 4>&{from_write}', "bash"]
        self.process = subprocess.Popen([*shell, *words], pass_fds=(to_read, from_write),
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read), os.close(from_write)
        self.rest, self.count, self.session, self.asked = b"", 0, None, []

    def message(self):
        while b"\0" not in self.rest:
            more = os.read(self.back, 1 << 20)
            if not more:
                sys.exit("Chromium went away")
            self.rest += more
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def __call__(self, method, **parameters):
        self.count += 1
        request = {
            "id": self.count, "method": method, "params": parameters,
            **({"sessionId": self.session} if self.session else {})}
        os.write(self.to, json.dumps(request).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("method") == "Network.requestWillBeSent":
                self.asked.append(answer["params"]["request"]["url"])
            if answer.get("id") == self.count:
                if "error" in answer:
                    sys.exit(f"{method}: {answer['error']}")
                return answer["result"]

    def value(self, expression):
        told = self("Runtime.evaluate", expression=expression, returnByValue=True,
                    awaitPromise=True)
        if "exceptionDetails" in told:
            sys.exit(f"the page failed: {told['exceptionDetails']}")
        return told["result"].get("value")

    def open(self, address, phone=None):
        target = self("Target.createTarget", url="about:blank")["targetId"]
        self.session = self("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self("Network.enable")
        self("Page.enable")
        if phone:
            self("Emulation.setDeviceMetricsOverride",
                 width=phone[0],
                 height=phone[1],
                 deviceScaleFactor=2,
                 mobile=True)
        self("Page.navigate", url=address)
        for _ in range(200):
            if self.value("document.readyState == 'complete' && typeof built != 'undefined'"):
                return
            time.sleep(.1)
        sys.exit("the page does not become complete")


def point_at(browser, x, y, phone):
    if not phone:
        browser("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        return
    browser("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
    browser("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])


def tells(browser, phone=None):
    """Points at a point of each chart: what the page does not tell, and how many had pictures."""
    wrong, with_pictures = [], 0
    for i in range(browser.value("built.length")):
        aim = browser.value(AIM % i)
        point_at(browser, aim["x"], aim["y"], phone)
        seen = browser.value(LOOK)
        with_pictures += len(seen["widths"]) == 2
        if seen["command"] not in aim["commands"] or len(
                seen["widths"]) != aim["pictures"] or 0 in seen["widths"]:
            wrong.append((aim["title"], seen))
        if phone and browser.value(PANEL)["height"] > phone[1] / 2:
            wrong.append((aim["title"], "the panel takes more than half the window"))
    return wrong, with_pictures


def lies(browser, phone=None):
    """Returns the errors of the page before the pointer is over any element."""
    panel = browser.value(PANEL)
    if "tap" not in panel["words"] or panel["command"]:
        yield "the empty panel", panel
    for shared in browser.value(SHARED):
        yield "one marker for several series", shared
    if phone and (panel["right"] > phone[0] or panel["narrowest"] < .9 * phone[0]
                  or panel["height"] > phone[1] / 2):
        yield "on a phone", panel


def main():
    program = shutil.which("chromium")
    if not program or not pathlib.Path(sys.argv[1]).exists():
        print("not looked at: no " + ("page" if program else "chromium"))
        sys.exit(SKIPPED)
    report, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    browser = Chromium(program, folder / "profile")
    browser.open(report.as_uri())
    expected = browser.value("data.charts.reduce((n, c) => n + c.panels.length, 0)")
    charts, wrong = browser.value("built.length"), list(lies(browser))
    missed, with_pictures = tells(browser)
    wrong += missed
    if len(sys.argv) > 3:
        pathlib.Path(sys.argv[3]).write_bytes(
            base64.b64decode(browser("Page.captureScreenshot")["data"]))
    browser.open(report.as_uri(), PHONE)
    wrong += lies(browser, PHONE)
    wrong += tells(browser, PHONE)[0]
    outside = [
        address for address in browser.asked if not address.startswith(("data:", report.as_uri()))]
    browser("Browser.close")
    browser.process.wait(20)
    print(
        f"{charts} charts of {expected}, {with_pictures} points with pictures, {len(wrong)} wrong, "
        f"asked for from outside: {outside}"
    )
    for title, seen in wrong:
        print(f"{title}: {seen}")
    sys.exit(bool(wrong or outside or charts != expected or not charts))


if __name__ == "__main__":
    main()
