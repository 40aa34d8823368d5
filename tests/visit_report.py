#!/usr/bin/env python3
"""Clicks in the page of a report, in a headless Chromium, as a mouse does it; speaks lines of "ok - " and "not ok - ".

usage: visit_report.py BROWSER PAGE PROFILE
The page shows a disc, painted, that is the first region of its list; beside it there is nothing."""
import pathlib, sys
from browser import Browser

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
