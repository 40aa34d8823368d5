#!/usr/bin/env python3
"""Clicks in the page of a report, in a headless Chromium, as a mouse does it; speaks lines of "ok - " and "not ok - ".

usage: visit_report.py BROWSER PAGE PROFILE
The page shows a disc, painted, that is the first region of its list; beside it there is nothing."""
import json, os, pathlib, subprocess, sys, time

class Browser:
    """Chromium's DevTools protocol over a pair of pipes: messages end with a zero byte."""

    def __init__(self, program, profile):
        to_browser, self.out = os.pipe()
        self.read_end, from_browser = os.pipe()
        command = [program, "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
                   "--window-size=1200,1000", f"--user-data-dir={profile}", "about:blank"]
        # the browser wants 3 and 4; sh moves them there
        moved = ["sh", "-c", f'exec "$@" 3<&{to_browser} 4>&{from_browser}', "sh", *command]
        self.process = subprocess.Popen(moved, pass_fds=(to_browser, from_browser), stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.rest, self.number, self.session, self.complaints = b"", 0, None, []

    def message(self):
        while b"\0" not in self.rest:
            more = os.read(self.read_end, 1 << 16)
            if not more:
                sys.exit("not ok - the browser runs to the end")
            self.rest += more
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        os.write(self.out, json.dumps(request).encode() + b"\0")
        while (answer := self.message()).get("id") != self.number:
            if answer.get("method") == "Runtime.exceptionThrown":
                self.complaints.append(answer["params"]["exceptionDetails"]["text"])
        return answer.get("result", {})

    def open(self, address):
        target = self.call("Target.createTarget", url=address)["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Runtime.enable")
        # until the address is there, the tab shows an empty page, which is complete as well
        while not self.ask('location.protocol === "file:" && document.readyState === "complete"'):
            time.sleep(0.05)

    def ask(self, script):
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        return answer.get("result", {}).get("value")

    def mouse(self, *places):
        """Presses at the first place, moves, and releases at the last."""
        for kind, (x, y) in [("mousePressed", places[0]), *[("mouseMoved", p) for p in places[1:]],
                             ("mouseReleased", places[-1])]:
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)


def main():
    browser = Browser(sys.argv[1], sys.argv[3])
    browser.open(pathlib.Path(sys.argv[2]).resolve().as_uri())
    tell = lambda sentence, good: print(("ok - " if good else "not ok - ") + sentence)
    place = lambda of, x, y: browser.ask(f"(() => {{ const b = {of}.getBoundingClientRect();"
                                         f"return [b.left + {x} * b.width, b.top + {y} * b.height]; }})()")
    picked = lambda: browser.ask('[...byId("regions").rows].findIndex((r) => r.classList.contains("picked"))')
    view, row = 'byId("view")', 'byId("regions").rows[0]'
    seam = browser.ask("state.seam")
    browser.mouse(place(view, 0.42, 0.5))
    tell("a click in a region picks its row", picked() == 0)
    tell("which comes into sight", 0 <= place(row, 0, 0)[1] and place(row, 0, 1)[1] <= browser.ask("innerHeight"))
    tell("and leaves the seam where it is", browser.ask("state.seam") == seam)
    browser.ask("scrollTo(0, 0)")
    browser.mouse(place(view, 0.42, 0.5))
    tell("another click lets it go", picked() == -1)
    browser.mouse(place(view, 0.42, 0.5))
    browser.ask("scrollTo(0, 0)")
    browser.mouse(place(view, 0.02, 0.03))
    tell("so does one beside all regions", picked() == -1)
    browser.mouse(place(view, 0.5, 0.5), place(view, 0.6, 0.5), place(view, 0.8, 0.5))
    tell("a drag moves the seam and picks nothing", picked() == -1 and abs(browser.ask("state.seam") - 0.8) < 0.02)
    browser.ask(f"{row}.scrollIntoView()")
    browser.mouse(place(f"{row}.cells[1]", 0.5, 0.5))
    tell("a click on a row picks it, too", picked() == 0)
    tell("no script complains", not browser.complaints)
    browser.call("Browser.close")


main()
