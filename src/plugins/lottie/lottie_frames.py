#!/usr/bin/python3
"""Writes every frame of a Lottie animation as SVG, with the names of its layers.

usage: lottie_frames.py PLAYER ANIMATION.json FOLDER

PLAYER is lottie.min.js, of the folder build/player in the npm package lottie-web; a Chromium without
a window plays it. The frames are FOLDER/0001.svg and so on.
"""
import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PAGE = """<!doctype html><meta charset="utf-8"><div id="stage"></div>
<script>onerror = message => { document.body.textContent = "<error>" + message + "</error>"; };</script>
<script src="PLAYER"></script>
<script>
const film = (window.lottie || bodymovin).loadAnimation({
    container: document.getElementById("stage"), renderer: "svg", autoplay: false, animationData: ANIMATION});
const frames = [];
function name(layers) { // a layer is drawn when it is first seen
    for (const layer of layers || []) {
        if (layer && layer.baseElement && layer.data.nm)
            layer.baseElement.setAttribute("data-name", layer.data.nm.replace(/^[#.]/, ""));
        name(layer && layer.elements);
    }
}
for (let frame = 0; frame < film.totalFrames; frame++) {
    film.goToAndStop(frame, true);
    name(film.renderer.elements);
    frames.push(new XMLSerializer().serializeToString(document.querySelector("#stage svg")));
}
document.body.textContent = frames.map(svg => "<frame>" + svg + "</frame>").join("");
</script>"""


def play(player, animation):
    """The SVG of each frame."""
    browsers = filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome")))
    browser = next(browsers, None)
    if not browser:
        sys.exit("lottie_frames.py: no chromium, chromium-browser or google-chrome in $PATH")
    data = json.dumps(json.loads(pathlib.Path(animation).read_text("utf-8"))).replace("</", "<\\/")
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder, "page.html")
        page.write_text(PAGE.replace("PLAYER", pathlib.Path(player).resolve(strict=True).as_uri())
                        .replace("ANIMATION", data), "utf-8")
        words = [browser, "--headless", "--disable-gpu", "--dump-dom", page.as_uri()]
        if os.geteuid() == 0:
            words.insert(1, "--no-sandbox")  # without which Chromium does not start for root
        dom = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, encoding="utf-8")
    text = html.unescape(dom.stdout)
    frames = re.findall("<frame>(.*?)</frame>", text, re.DOTALL)
    if not frames:
        error = re.search("<error>(.*?)</error>", text, re.DOTALL)
        sys.exit(f"lottie_frames.py: {animation}: {player} drew no frame: {error[1] if error else 'no error said'}")
    return frames


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    player, animation, folder = sys.argv[1:]
    try:
        os.makedirs(folder, exist_ok=True)
        for number, svg in enumerate(play(player, animation), 1):
            pathlib.Path(folder, f"{number:04d}.svg").write_text(svg + "\n", "utf-8")
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"lottie_frames.py: {error}")


if __name__ == "__main__":
    main()
