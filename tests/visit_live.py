#!/usr/bin/env python3
"""Uses the page of --serve in a headless Chromium, with mouse and keyboard; speaks lines of "ok - " and "not ok - ".

usage: visit_live.py BROWSER ADDRESS PROFILE FOLDER
FOLDER has six drawings, w_0001.svg and so on, of a disc over a square. Leaves the config in kept.conf and the page as a
file in kept.html."""
import re, sys, time, urllib.request
from browser import Browser

address, folder = sys.argv[2], sys.argv[4]
browser = Browser(sys.argv[1], sys.argv[3])
browser.open(address)


def tell(sentence, good):
    print(("ok - " if good else "not ok - ") + sentence)


def until(script, seconds=60):
    """Whether it becomes true in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if browser.ask(f"!!({script})"):
            return True
        time.sleep(0.05)
    return False


def place(of, x=0.5, y=0.5):
    browser.ask(f"{of}.scrollIntoView({{ block: 'nearest' }})")
    return browser.ask(f"(() => {{ const b = {of}.getBoundingClientRect();"
                       f"return [b.left + {x} * b.width, b.top + {y} * b.height]; }})()")


def control(key, part="input, select"):
    return f"document.querySelector('[data-key=\"{key}\"]').querySelector('{part}')"


def config():
    return browser.ask('byId("config").textContent')


def says(key, value, section):
    """Whether the config says so in a section, and the film is painted by it."""
    have = f'(live.settings["{section}"] || {{}})["{key}"] === {value}'
    return until(f"{have} && live.step === 'done' && live.from > 0")


PAINTED = "live.step === 'done' && shown.length === 6"
tell("the film appears", until(PAINTED))
tell("with the regions of the drawing", browser.ask('byId("regions").rows.length') == 2)
before = browser.ask("shown[3].after")
browser.mouse(place('byId("view")', 0.55, 0.5))
name = browser.ask("state.region")
tell("a click in the picture picks the region", name is not None and browser.ask('byId("scope").textContent') == name)
section = f"region {name}"

browser.mouse(place(control("carry"), 0.3))
tell("a click on a slider chooses", until(f'live.settings["{section}"]'))
carry = browser.ask(f'Number(live.settings["{section}"].carry)')
tell("what it shows", 0.15 < carry < 0.4)
browser.ask("window.marked = shown.length && shown[0]")
# What the server says of the slider is on its way when the first key is pressed, and knows nothing of it.
browser.ask("window.plainFetch = fetch, window.fetch = (...what) => plainFetch(...what).then((answer) =>"
            "answer.clone().text().then((text) => !text.includes('\"settings\"') ? answer :"
            "new Promise((go) => { window.arrive = () => go(answer); })))")
browser.mouse(place(control("carry"), 0.4))
tell("an answer is on its way", until("window.arrive"))
browser.ask(control("tint", "select") + ".focus()")
browser.key("ArrowDown")
browser.ask("window.fetch = plainFetch, arrive(), new Promise((go) => setTimeout(go, 50))")
browser.key("ArrowDown")
tell("a key chooses a tint, whatever is on its way", says("tint", '"keep"', section))
tell("which paints the film anew", until(PAINTED) and browser.ask("shown[3].after") != before)
browser.ask(control("style", "select") + ".focus()")
browser.type("07")
tell("a style is chosen for the region alone", says("style", '"07"', section) and
     browser.ask('[...byId("regions").rows].filter((r) => r.textContent.includes("07")).length') == 1)
browser.mouse(place(control("style-scale", "input[type=number]")))
browser.type("0.7")
browser.key("Enter")
tell("a number is typed", says("style-scale", '"0.7"', section))
browser.mouse(place(control("tint", "select") + ".parentNode.nextElementSibling"))
tell("what was chosen is given back", says("tint", "undefined", section) and "tint" not in config())
browser.mouse(place('byId("everywhere")'))
browser.mouse(place(control("carry", "input[type=number]")))
browser.type("7")
browser.key("Enter")
tell("a number out of range goes nowhere", browser.ask(control("carry", "input[type=number]") + ".validity.rangeOverflow")
     and browser.ask("(live.settings.defaults || {}).carry === undefined"))
browser.mouse(place(control("frames")))
browser.type("2-5")
browser.key("Enter")
tell("a range of frames is painted", says("frames", '"2-5"', "project") and
     until('shown.map((f) => f.number).join() === "2,3,4,5"'))
browser.mouse(place('byId("sheet").children[2]'))
tell("a frame of the sheet is shown", browser.ask("shown[state.at].number") == 4)

drawing = open(f"{folder}/w_0004.svg").read()
old = browser.ask("shown[2].before")
with open(f"{folder}/w_0004.svg", "w") as file:
    file.write(drawing.replace("r='11'", "r='8'"))
tell("a drawing that is edited is painted again", until(f"shown[2].before !== {old!r} && live.step === 'done'"))
with open(f"{folder}/w_0004.svg", "w") as file:
    file.write("<svg")
tell("one that is broken is told", until("live.step === 'failed'") and
     "w_0004.svg" in browser.ask('byId("told").textContent'))
with open(f"{folder}/w_0004.svg", "w") as file:
    file.write(drawing)
tell("until it is mended", until("live.step === 'done' && !byId('told').textContent"))
steps = 'fetch("state?from=0").then((r) => r.json()).then((told) => [...new Set(told.lines.map((l) => l.step))].join())'
tell("who asks late gets the frames of every step", browser.ask(steps) == "preview,draft,full")
tell("no script complains", not browser.complaints)
for name, what in [("kept.conf", "config"), ("kept.html", "report")]:
    with open(name, "wb") as file:
        file.write(urllib.request.urlopen(address + what).read())
browser.call("Browser.close")
