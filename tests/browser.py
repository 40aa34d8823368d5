"""A headless Chromium that a test can click in."""
import json, os, subprocess, sys, time

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
                self.complaints.append(str(answer["params"]["exceptionDetails"].get("exception",{}).get("description"))[:400])
        return answer.get("result", {})

    def open(self, address):
        target = self.call("Target.createTarget", url=address)["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Runtime.enable")
        # until the address is there, the tab shows an empty page, which is complete as well
        while not self.ask('location.protocol !== "about:" && document.readyState === "complete"'):
            time.sleep(0.05)

    def ask(self, script):
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        return answer.get("result", {}).get("value")

    def mouse(self, *places):
        """Presses at the first place, moves, and releases at the last."""
        for kind, (x, y) in [("mousePressed", places[0]), *[("mouseMoved", p) for p in places[1:]],
                             ("mouseReleased", places[-1])]:
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)

    def key(self, name):
        """Presses a key, and lets it go."""
        text = {"Enter": "\r"}.get(name, name if len(name) == 1 else "")
        code = {"Enter": 13, "ArrowDown": 40}.get(name, 0)
        for kind in "keyDown", "keyUp":
            self.call("Input.dispatchKeyEvent", type=kind, key=name, text=text if kind == "keyDown" else "",
                      windowsVirtualKeyCode=code)

    def type(self, text):
        for letter in text:
            self.key(letter)
