"""Films of one SVG each, drawn at 24 moments by the program and by Chromium. Prints TAP.
usage: moving.py PROGRAM CHROMIUM [NAME.svg...]    others than its own films"""
import base64, io, pathlib, subprocess, sys, tempfile, time
from browser import Browser
try:
    import numpy
    from PIL import Image
except ImportError as missing:
    print(f"1..0 # SKIP {missing}")
    sys.exit()

SIDE, FPS, FRAMES, LEAST_DB = 200, 12, 24, 40
RED, BLUE = "fill='#aa3311'", "fill='#2255aa'"
BOX = f"<rect x='10' y='10' width='30' height='20' {RED}>%s</rect>"
FILMS = {
    "from and to": BOX % "<animate attributeName='x' from='10' to='60' dur='2s'/>",
    "values, times and splines": BOX % "<animate attributeName='width' values='10;60;30' keyTimes='0;.3;1' calcMode='spline' keySplines='.4 0 .2 1;0 0 1 1' dur='2s'/>",
    "steps": BOX % "<animate attributeName='y' values='0;20;50' calcMode='discrete' dur='1.8s' repeatCount='indefinite'/>",
    "equal speed": BOX % "<animate attributeName='x' values='0;10;60' calcMode='paced' dur='2s'/>",
    "by, summed over rounds": BOX % "<animate attributeName='x' by='12' accumulate='sum' repeatCount='4' dur='.5s'/>",
    "added": BOX % "<animate attributeName='x' values='0;20' additive='sum' dur='1s' fill='freeze'/>",
    "set between moments": BOX % f"<set attributeName='fill' to='#22aa55' begin='.55s' end='1.45s'/>",
    "one begins when another ends": BOX % "<animate id='a' attributeName='x' to='50' dur='.7s' fill='freeze'/><animate attributeName='y' begin='a.end+.2s' to='50' dur='.8s' fill='freeze'/>",
    "one that begins again": BOX % "<animate id='a' attributeName='x' begin='0;b.end+.1s' values='30;60' calcMode='discrete' dur='.4s' fill='freeze'/><animate id='b' attributeName='x' begin='a.end+.2s' to='5' dur='.3s' fill='freeze'/>",
    "colours": BOX % "<animate attributeName='fill' values='#aa3311;#22aa55;#2255aa' dur='2s'/>",
    "paths": f"<path {BLUE} d='M10 10h30v30h-30z'><animate attributeName='d' dur='2s' values='M10 10h30v30h-30z;M20 5h60v70h-40z;M10 10h30v30h-30z'/></path>",
    "rotation about a point": BOX % "<animateTransform attributeName='transform' type='rotate' from='0 50 50' to='360 50 50' dur='2s'/>",
    "scale over translation": f"<g transform='translate(50 50)'><rect width='20' height='20' {RED}><animateTransform attributeName='transform' type='scale' values='1;2;.5' dur='2s' additive='sum'/></rect></g>",
    "along a path": f"<rect x='-5' y='-5' width='16' height='10' {RED}><animateMotion path='M20 20C80 20 80 80 20 80' dur='2s' rotate='auto'/></rect>",
    "key frames": f"<style>@keyframes k {{ 50% {{ transform: translateX(40px) rotate(90deg) }} }} rect {{ animation: k 2s; transform-origin: 25px 20px }}</style>" + BOX % "",
    "there and back": f"<style>@keyframes k {{ to {{ transform: translate(40px, 30px) scale(1.5) }} }} rect {{ animation: k .8s ease-in-out infinite alternate }}</style>" + BOX % "",
    "delay and fill": f"<style>@keyframes k {{ from {{ opacity: .2 }} to {{ opacity: 1; fill: #22aa55 }} }} rect {{ animation: k 1s linear .4s both }}</style>" + BOX % "",
    "a share of steps": f"<style>@keyframes k {{ to {{ transform: translateX(60px) }} }} rect {{ animation: k 1.5s steps(5, jump-start) }}</style>" + BOX % "",
    "a Bezier of its own": f"<style>@keyframes k {{ to {{ transform: translateY(50px) }} }} rect {{ animation: k 2s cubic-bezier(.7, -.4, .3, 1.4) }}</style>" + BOX % "",
    "begun before, in reverse": f"<style>@keyframes k {{ to {{ transform: rotate(180deg) }} }} rect {{ animation: k 2s linear -.5s 2 reverse; transform-box: fill-box; transform-origin: center }}</style>" + BOX % "",
    "two animations of one": f"<style>@keyframes a {{ to {{ translate: 40px 0 }} }} @keyframes b {{ to {{ rotate: 45deg }} }} rect {{ animation: a 1s linear infinite, b 2s ease; transform-origin: 25px 20px }}</style>" + BOX % "",
    "outlines of CSS": f"<style>@keyframes k {{ to {{ d: path('M60 60h30v30h-30z') }} }} path {{ animation: k 2s ease-out }}</style><path {BLUE} d='M10 10h30v30h-30z'/>",
    "ends that no key frame names": f"<style>@keyframes a {{ to {{ offset-distance: 100% }} }} @keyframes b {{ to {{ filter: invert(1) }} }} @keyframes c {{ to {{ transform: rotate(90deg) }} }} @keyframes d {{ 50% {{ --c: #22aa55 }} }} .a {{ offset-path: path('M20 15 L80 15'); animation: a 2s linear }} .b {{ animation: b 2s linear }} .c {{ transform: translate(60px, 60px); animation: c 2s linear; animation-composition: add }} g {{ animation: d 2s linear }} .d {{ fill: var(--c, #2255aa) }}</style><rect class='a' x='-6' y='-4' width='12' height='8' {RED}/><rect class='b' x='10' y='40' width='30' height='30' {RED}/><rect class='c' width='20' height='12' {BLUE}/><g><rect class='d' x='55' y='30' width='30' height='15'/></g>",
    "key frames of one name, numbers and px": f"<style>@-webkit-keyframes a {{ to {{ stroke-width: 20px }} }} @-webkit-keyframes a {{ to {{ stroke-width: 2px; transform: translateX(calc(10% + 20px)) }} }} @layer b, c; @layer c {{ @keyframes b {{ to {{ fill: #22aa55 }} }} }} @layer b {{ @keyframes b {{ to {{ fill: #000000 }} }} }} rect {{ animation: a 2s linear, b 2s linear; stroke: #2255aa; stroke-width: 10 }}</style>" + BOX % "",
    "key frames over SMIL": f"<style>@keyframes k {{ to {{ opacity: .2 }} }} rect {{ animation: k 2s linear; fill: #2255aa !important }}</style>" + BOX % "<animate attributeName='opacity' values='1;0;1' dur='1s'/><animate attributeName='fill' values='#000000;#ffffff' dur='2s'/>",
    "variables": f"<style>@keyframes k {{ to {{ transform: translateX(var(--far)) }} }} svg {{ --far: 55px }} rect {{ animation: k 2s linear }}</style>" + BOX % "",
}

# Runs before the page's own scripts: pauses its animations at once, since the browser forgets those that have ended.
HOLD = """addEventListener("DOMContentLoaded", () => {
  window.held = document.getAnimations(); for (const a of held) a.pause(); document.documentElement.pauseAnimations(); })"""
SEEK = """(t) => { for (const a of held) a.currentTime = t * 1000;
  document.documentElement.setCurrentTime(t); return true; }"""


def on_white(data):
    picture = Image.open(io.BytesIO(data)).convert("RGBA")
    page = Image.new("RGBA", picture.size, "white")
    page.alpha_composite(picture)
    return numpy.asarray(page.convert("RGB")).astype(float)


def near_edges(picture):
    """The pixels at and beside a change of colour."""
    edge = numpy.zeros(picture.shape[:2], bool)
    for axis in (0, 1):
        step = numpy.abs(numpy.diff(picture, axis=axis)).max(-1) > 8
        for shift in (0, 1):
            part = [slice(None), slice(None)]
            part[axis] = slice(shift, step.shape[axis] + shift)
            edge[tuple(part)] |= step
    wide = edge.copy()
    for axis in (0, 1):
        for shift in (-1, 1):
            wide |= numpy.roll(edge, shift, axis)
    return wide


def difference(mine, theirs):
    """The PSNR of the pixels away from edges, dB."""
    flat = ~(near_edges(mine) | near_edges(theirs))
    error = ((mine - theirs)[flat] ** 2).mean() if flat.any() else 0
    return 10 * numpy.log10(255 ** 2 / max(error, 1e-9))


def play(browser, program, folder, name, file):
    out = folder / "out"
    done = subprocess.run([program, str(file), "--flat", "--frames-from", "time", "--fps", str(FPS), "--to", str(FRAMES / FPS),
                           "-W", str(SIDE), "-b", "#ffffff", "-y", "--progress", "none", "-o", f"{out}/%d.png"],
                          capture_output=True, text=True)
    if done.returncode:
        return f"drawn: {done.stderr.strip()}"
    browser.open("data:text/html,")
    browser.call("Page.enable")
    browser.call("Page.addScriptToEvaluateOnNewDocument", source=HOLD)
    browser.call("Page.navigate", url=file.as_uri())
    while not browser.ask('location.protocol === "file:" && document.readyState === "complete"'):
        time.sleep(0.02)
    worst, at = 999, 0
    for number in range(1, FRAMES + 1):
        path = out / f"{number}.png"
        if not path.exists():
            break
        browser.ask(f"({SEEK})({(number - 1) / FPS})")
        shot = browser.call("Page.captureScreenshot", clip={"x": 0, "y": 0, "width": SIDE, "height": SIDE, "scale": 1})
        mine, theirs = on_white(path.read_bytes()), on_white(base64.b64decode(shot["data"]))
        if mine.shape != theirs.shape:
            return f"frame {number} has {mine.shape}, expected {theirs.shape}"
        found = difference(mine, theirs)
        if found < worst:
            worst, at = found, number
        path.unlink()
    if not at:
        return "no frame was drawn"
    return None if worst >= LEAST_DB else f"{worst:.1f} dB in frame {at}"


def run(folder):
    program, chromium = sys.argv[1:3]
    files = [(pathlib.Path(name).name, pathlib.Path(name).resolve()) for name in sys.argv[3:]]
    for n, (name, body) in enumerate(FILMS.items() if not files else []):
        file = folder / f"film{n}.svg"
        file.write_text(f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100' width='{SIDE}' height='{SIDE}'>{body}</svg>")
        files.append((name, file))
    browser = Browser(chromium, str(folder / "profile"))
    for n, (name, file) in enumerate(files, 1):
        problem = play(browser, program, folder, name, file)
        print(f"{'not ' if problem else ''}ok {n} - {name}" + (f"\n# {problem}" if problem else ""), flush=True)
    print(f"1..{len(files)}")
    browser.call("Browser.close")


with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch:
    run(pathlib.Path(scratch))
