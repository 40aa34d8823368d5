#!/usr/bin/env python3
"""Uses the page of --serve in a headless Chromium, with mouse and keyboard; speaks lines of "ok - " and "not ok - ".

usage: visit_live.py BROWSER ADDRESS PROFILE FOLDER COMMAND…
FOLDER has six drawings, w_0001.svg and so on, of a disc over a square. COMMAND paints them for comparison, into full/. Leaves
the config in kept.conf."""
import base64, shutil, subprocess, sys, time
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
    """A point of an element in the window, once the page around it stands still."""
    browser.ask(f"{of}.scrollIntoView({{ block: 'nearest' }})")
    last, still = None, 0
    while still < 3:
        at = browser.ask(f"(() => {{ const b = {of}.getBoundingClientRect();"
                         f"return [b.left + {x} * b.width, b.top + {y} * b.height]; }})()")
        still = still + 1 if at == last else 0
        last = at
        time.sleep(0.05)
    return at


def slide(of, x, wanted):
    """Clicks on a slider; again, if the page moved under the click."""
    for _ in range(6):
        browser.mouse(place(of, x))
        if until(wanted, 10):
            return True
    return False


def control(key, part="input, select"):
    return f"document.querySelector('[data-key=\"{key}\"]').querySelector('{part}')"


def config():
    return browser.ask('byId("config").textContent')


REFINED = ("live.sent === 0 && frames.length && "
           "frames.every((f) => f.generation === live.generation && f.level === REFINED)")
DRAWN = "frames.filter((f) => f.images.after && f.images.map).length === 6"


def done(section, key, value):
    """Whether the config says so in a section, and the film is refined by it."""
    return until(f'(live.settings["{section}"] || {{}})["{key}"] === {value} && {REFINED}')


def pixels(k):
    """A digest of a frame's painting."""
    return browser.ask(f"""(async () => {{ const image = frames[{k}].images.after;
        const data = image.getContext("2d").getImageData(0, 0, image.width, image.height).data;
        return [...new Uint8Array(await crypto.subtle.digest("SHA-256", data))].join(); }})()""")


tell("the film appears", until(DRAWN))
tell("with the regions of the drawing", browser.ask('byId("regions").rows.length') == 2)
tell("and plays", until("state.playing") and until("state.at === 2") and until("state.at === 4"))
tell("and is refined", until(REFINED) and until('byId("status").textContent.includes("byte for byte")'))
tell("a frame that was never painted shows the last one that was", browser.ask("""(() => {
    const was = frames.map((f) => ({ ...f })), playing = state.playing;
    frames.forEach((f, k) => { if (k !== 4) Object.assign(f, { generation: -1, images: {} }); });
    state.playing = true;
    const stands = standIn(2);
    Object.assign(frames[4], { generation: -1 });
    const old = standIn(2);
    state.playing = playing;
    frames.forEach((f, k) => Object.assign(f, was[k]));
    return stands === 4 && old === 4; })()"""))
browser.ask("play(false), show(3)")
tell("each style has a picture", until("live.samples.every((s) => !s.canvas.classList.contains('old'))"))
before = pixels(3)
browser.mouse(place('byId("view")', 0.55, 0.5))
name = browser.ask("state.region")
tell("a click in the picture picks the region", name is not None and browser.ask('byId("scope").textContent') == name)
section = f"region {name}"

slider = control("carry", "input[type=range]")
tell("a click on a slider chooses", slide(slider, 0.3, f'live.settings["{section}"]'))
tell("what it shows", 0.2 < browser.ask(f'Number(live.settings["{section}"].carry)') < 0.4)
tell("its end as well", slide(slider, 0.99, f'live.settings["{section}"].carry === "1"'))
browser.ask(control("tint", "select") + ".focus()")
browser.key("ArrowDown")
browser.key("ArrowDown")
tell("a key chooses a tint", done(section, "tint", '"keep"'))
tell("which paints the film anew", pixels(3) != before)
browser.mouse(place('byId("undo")'))
tell("and is taken back", done(section, "tint", '"fill"'))
browser.mouse(place('byId("redo")'))
tell("and done again", done(section, "tint", '"keep"'))
tell("what was before is at hand", browser.ask("frames[3].images.earlier !== frames[3].images.after"))
browser.ask("live.samples.find((s) => s.button && s.style.name === '01').button.focus()")
for _ in range(6):
    browser.key("ArrowRight")
browser.key("Enter")
tell("keys choose a style, for the region alone", done(section, "style", '"07"') and
     browser.ask('[...byId("regions").rows].filter((r) => r.textContent.includes("07")).length') == 1)
browser.ask("choose(scope(), 'style', 'nosuch')")
tell("one that is not there is refused with its words", until(control("style", "small") + ".textContent.includes('nosuch')"))
number = control("style-scale", "input[type=number]")
browser.mouse(place(number))
browser.type("0.7")
browser.key("Enter")
tell("a number is typed", done(section, "style-scale", '"0.7"'))
old = pixels(3)
browser.ask(f"{number}.focus(), {number}.select()")
browser.type("99")
browser.key("Enter")
note = control("style-scale", "small") + ".textContent"
tell("one out of range is refused with its words", until(note + ".includes('99')"))
browser.ask(f"{number}.focus(), {number}.select()")
browser.type("0.00001")
browser.key("Enter")
tell("and one that no style can have", until(note + ".includes('0x0')"))
tell("which change nothing", done(section, "style-scale", '"0.7"') and pixels(3) == old)
browser.mouse(place(control("tint", ".reset")))
tell("what was chosen is given back", done(section, "tint", "undefined") and "tint" not in config())
browser.ask('document.querySelector("#regions input").click(), byId("mode").value = "onion", zoom(), play(true)')
browser.mouse(place('byId("everywhere")'))
browser.mouse(place(control("frames")))
browser.type("2-5")
browser.key("Enter")
tell("a range of frames is painted", done("project", "frames", '"2-5"') and
     browser.ask('frames.map((f) => f.number).join() === "2,3,4,5"'))
tell("which plays, although it had no pictures at first", until("state.at === 1") and until("state.at === 2"))
browser.ask('toggleAll(true), play(false), byId("mode").value = "alone", zoom()')
browser.ask('byId("view").focus(), document.activeElement.blur(), show(0)')
browser.key("ArrowRight")
tell("a key steps", browser.ask("shown[state.at].number") == 3)
browser.ask("show(0), play(true), byId('play').focus()")
browser.key("ArrowLeft")
tell("from the first frame of a loop to the last, and then it no longer plays", browser.ask("state.at === 3 && !state.playing"))
browser.ask("document.activeElement.blur(), show(1)")
browser.ask('byId("regions").rows[0].focus()')
for key in "ArrowDown", "Enter", " ":
    browser.key(key)
tell("keys go down the list of regions, choose one and show its drawing",
     browser.ask("state.region === film.regions[1].name && state.off.has(state.region)"))
for key in " ", "Enter":
    browser.key(key)
browser.mouse(place('byId("pin")'))
tell("a painting stays as A", browser.ask('byId("left").value') == "kept")
for mode in "beside", "onion", "wipe":
    browser.ask(f'byId("mode").value = "{mode}", byId("mode").dispatchEvent(new Event("change"))')
tell("beside others", browser.ask("currentFrame().images.kept === currentFrame().images.after"))

drawing = open(f"{folder}/w_0004.svg").read()
old = pixels(2)
with open(f"{folder}/w_0004.svg", "w") as file:
    file.write(drawing.replace("r='11'", "r='8'"))
generation = browser.ask("live.generation")
tell("a drawing that is edited is painted again", until(f"live.generation > {generation} && {REFINED}") and
     pixels(2) != old)
with open(f"{folder}/w_0004.svg", "w") as file:
    file.write("<svg")
tell("one that is broken is told", until("byId('told').textContent.includes('w_0004.svg')"))
with open(f"{folder}/w_0004.svg", "w") as file:
    file.write(drawing)
tell("until it is mended", until(f"!byId('told').textContent && {REFINED}"))
with open("kept.conf", "w") as file:
    file.write(config())
subprocess.run([*sys.argv[5:], folder, "-q", "-c", "kept.conf", "-o", "full/%d.png"], check=False)
shutil.rmtree("layers")  # which the config wants as well
same = True
for k, number in enumerate(browser.ask("frames.map((f) => f.number)")):
    with open(f"full/{number}.png", "rb") as file:
        picture = base64.b64encode(file.read()).decode()
    same = same and browser.ask(f"""(async () => {{ const file = new Image();
        file.src = "data:image/png;base64,{picture}";
        await file.decode();
        const of = (image) => {{ const c = element("canvas"); [c.width, c.height] = [image.width, image.height];
            c.getContext("2d").drawImage(image, 0, 0); return c.getContext("2d").getImageData(0, 0, c.width, c.height).data; }};
        const a = of(file), b = of(frames[{k}].images.after);
        return a.length === b.length && a.every((v, p) => v === b[p]); }})()""")
tell("what is refined is the command's, to the bit", same)
tell("a folder that is dropped is its drawings", browser.ask("""(() => {
    const file = (name) => ({ name, isFile: true, file: (take) => take(new File([""], name)) }), read = [[file("a.svg"), file("b")], [file("c.css")], []];
    const folder = { isDirectory: true, createReader: () => ({ readEntries: (take) => take(read.shift()) }) };
    return filesOf([{ webkitGetAsEntry: () => folder }]).then((files) => files.map((f) => f.name).join()); })()""") == "a.svg,c.css")
browser.ask("drop(filesOf([{ webkitGetAsEntry: () => ({ isFile: true, file: (take, fail) => fail(new Error('gone')) }) }])), 0")
tell("one that cannot be read is told", until("byId('told').textContent.startsWith('nothing was opened')"))
wide = []
for width in 1440, 1024, 390:
    browser.call("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=False)
    wide.append(browser.ask("document.documentElement.scrollWidth <= innerWidth"))
tell("nothing is wider than a page of 390 px", all(wide))
browser.ask("save(), 0")
tell("a file is replaced after a question only", until("byId('asks').open"))
browser.ask("byId('asks').close('')")
tell("no script complains", not browser.complaints)
browser.call("Browser.close")
