#!/usr/bin/env python3
"""Makes a folder of HTML from the manuals, the comments of the headers, the styles and the gallery.

usage: pages.py SOURCE BUILD PROGRAM FOLDER [--without-pictures]; needs mandoc and, for films, ffmpeg.
The pages search themselves without a server. A link that leads nowhere is an error.
"""
import configparser
import html
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

MANUALS = ["fluidy-tutorial.7", "fluidy-svg.1", "fluidy-svg.conf.5", "fluidy-exports.7", "fluidy-style.1", "fluidy-style.5",
           "fluidy-recipe.5", "fluidy-frames.1", "fluidy-python.7"]
# Dials, the style that shows each best, and values.
DIALS = [("wash", "05", "0 1 2"), ("light", "05", "0 62 180"), ("passes", "05", "0 1 2"), ("tide", "05", "0 1 2"),
         ("pool", "05", "0 1 2"), ("blooms", "05", "0 1 2"), ("calm", "01", "0 .5 1"), ("hue", "01", "0 2 5"),
         ("palette", "01", "drawing paint"), ("marks", "04", "off charcoal pastel"), ("marks-angle", "10", "0 -58 90"),
         ("gaps", "05", "0 .5 1"), ("edges", "02", "closed soft"), ("front", "01", "0 .8 2"), ("stain", "01", "0 .8 1"),
         ("overrun", "01", "2 5 10"), ("carry", "08", "0 .5 1"), ("line", "05", "plain pen brush"),
         ("paper-relief", "05", "0 .3 1"), ("style-scale", "01", ".5 1 2"), ("strength", "11", ".3 .6 1")]
DRAWING = "fixtures/animations/snowman-wave-layers"
MOVING = ("front", "stain", "overrun", "carry")  # dials of which a first frame shows nothing
# A film for the dials: two shapes that touch, one of them moving, and a line.
FIGURE = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 310 230"><path fill="#2f7f96"
d="M30 150c-16-60 30-116 96-112s84 44 72 96-44 76-96 72-62-16-72-56z"/><g transform="translate({0} 0)"><path fill="#d9742b"
d="M176 128a44 44 0 1 1 88 0a44 44 0 1 1-88 0"/><path fill="none" stroke="#222" stroke-width="3"
d="M196 120q24 40 48 0"/></g></svg>"""
SEARCH = """
const box = document.querySelector("#search"), list = document.querySelector("#found");
box.oninput = () => {
  const words = box.value.toLowerCase().split(/\\s+/).filter(Boolean);
  const found = words.length ? INDEX.filter(([, , text]) => words.every(word => text.includes(word))).slice(0, 12) : [];
  list.replaceChildren(...found.map(([title, url]) => {
    const item = document.createElement("li"), link = item.appendChild(document.createElement("a"));
    link.href = url;
    link.textContent = title;
    return item;
  }));
};
"""


class Reader(html.parser.HTMLParser):
    """Targets, links and headings of a page, with the text below each."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.entries, self.taking = set(), [], [], None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.ids.update(filter(None, (named.get("id"), named.get("name"))))
        self.links += [link for link in (named.get("href"), named.get("src")) if link]
        if named.get("id") and tag in ("h1", "h2", "dt"):
            self.entries.append([named["id"], "", ""])
            self.taking = tag

    def handle_endtag(self, tag):
        if tag == self.taking:
            self.taking = None

    def handle_data(self, data):
        if self.entries:
            self.entries[-1][1 if self.taking else 2] += data


def navigation(has_api):
    pages = [("index.html", "gallery"), ("styles.html", "styles"), ("dials.html", "dials")]
    pages += [(f"{name}.html", "{0}({2})".format(*name.rpartition("."))) for name in MANUALS]
    pages += [("api/index.html", "library")] if has_api else []
    links = "".join(f'<a href="{page}">{title}</a>' for page, title in pages)
    return (f'<nav>{links}<input id="search" type="search" placeholder="search" aria-label="search"></nav>'
            '<ul id="found"></ul>')


def page(title, body, nav):
    return ('<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<title>{title}</title><link rel="stylesheet" href="pages.css"></head><body>{nav}{body}'
            '<script src="search.js"></script></body></html>\n')


def manual(path, nav):
    text = subprocess.run(["mandoc", "-Thtml", "-O", "fragment,man=%N.%S.html", path], check=True, capture_output=True,
                          text=True).stdout
    return page(path.stem, re.sub(r'<a class="Xr" href="(?!fluidy)[^"]*">(.*?)</a>', r"\1", text), nav)


def figure(picture, caption):
    shown = (f'<video src="{picture}" autoplay loop muted playsinline></video>' if picture.endswith(".mp4") else
             f'<img loading="lazy" src="{picture}" alt="{caption}">')
    return f"<figure>{shown}<figcaption>{caption}</figcaption></figure>"


def styles(source, nav):
    body = '<h1>Styles</h1><div class="grid">'
    for file in sorted((source / "fixtures/styles").glob("*/style.ini")):
        read = configparser.ConfigParser(interpolation=None)
        read.read(file, encoding="utf-8")
        number, style = file.parent.name, read["style"]
        rows = "".join(f"<tr><th>{section}</th><td>{html.escape(', '.join(f'{k} {v}' for k, v in read[section].items()))}</td></tr>"
                       for section in read.sections() if section != "style")
        body += (f'<section><h2 id="{number}">{number} {style["name"]}</h2>' +
                 figure(f"pictures/style-{number}.mp4", html.escape(style["character"])) + f"<table>{rows}</table></section>")
    return page("styles", body + "</div>", nav)


def dials(nav):
    body = "<h1>Dials</h1><p>Each at two or three values, on the same frame. fluidy-svg(1) has units, ranges and defaults.</p>"
    for dial, style, values in DIALS:
        pictures = "".join(figure(f"pictures/{dial}-{n}.jpg", f"--{dial} {value}") for n, value in enumerate(values.split()))
        body += f'<h2 id="{dial}">{dial}, in style {style}</h2><div class="row">{pictures}</div>'
    return page("dials", body, nav)


def paint_pictures(source, program, folder):
    folder.mkdir(exist_ok=True)
    drawing = source / DRAWING

    def run(*words):
        subprocess.run([program, *words, "--progress", "none", "-q", "-y"], check=True,
                       env={**os.environ, "FLUIDY_STYLES": str(source / "fixtures/styles")})

    for style in sorted((source / "fixtures/styles").glob("*/style.ini")):
        number = style.parent.name
        run(drawing, "-s", number, "-f", "1-30", "-W", "360", "--no-frames", "-o", folder / f"style-{number}.mp4")
    for frame in range(6):
        (folder / f"figure_{frame}.svg").write_text(FIGURE.format(6 * frame - 20), encoding="utf-8")
    for dial, style, values in DIALS:
        for n, value in enumerate(values.split()):
            run(folder / "figure_%d.svg", "-s", style, "-f", "0-5" if dial in MOVING else "5", "-W", "310",
                f"--{dial}={value}", "-o", folder / "one_%d.png")
            subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-y", "-i", folder / "one_5.png", "-q:v", "3",
                            folder / f"{dial}-{n}.jpg"], check=True)
    for file in [*folder.glob("one_*.png"), *folder.glob("figure_*.svg")]:
        file.unlink()


def dead_links(folder, pages, with_pictures):
    for name, read in pages.items():
        for link in read.links:
            path, _, target = urllib.parse.unquote(link).partition("#")
            if urllib.parse.urlparse(link).scheme or (path.startswith("pictures/") and not with_pictures):
                continue
            if not (folder / (path or name)).exists() or (target and (path or name) in pages and
                                                          target not in pages[path or name].ids):
                yield f"{name}: {link}: leads nowhere"


def main(source, build, program, folder, *flags):
    source, build, folder = pathlib.Path(source), pathlib.Path(build), pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(source / "man/pages.css", folder)
    shutil.copytree(source / "fixtures/gallery", folder / "gallery", ignore=shutil.ignore_patterns("*.md", "*.conf"))
    api = build / "include/fluidy/api"
    if api.is_dir():
        shutil.copytree(api, folder / "api")
    nav = navigation(api.is_dir())
    made = {f"{name}.html": manual(build / "man" / name, nav) for name in MANUALS}
    made["styles.html"], made["dials.html"] = styles(source, nav), dials(nav)
    gallery = "".join(figure(f"gallery/{name}", caption) for name, caption in (
        ("styles.jpg", "twelve styles"), ("fluids.jpg", "fire, smoke and water"), ("carry.jpg", "paint that stays, and paint that travels"),
        ("lines.jpg", "lines by hand")))
    made["index.html"] = page("fluidy-svg", "<h1>fluidy-svg</h1><p>Paints vector animation with moving paint.</p>" +
                              figure("gallery/snowman.gif", "fluidy-svg frames/ --style watercolour") +
                              f'<h2>Gallery</h2><div class="grid">{gallery}</div>', nav)
    pages = {name: Reader(text) for name, text in made.items()}
    index = [[f"{name.removesuffix('.html')}: {' '.join(title.split())}", f"{name}#{target}",
              " ".join(f"{title} {text[:600]}".lower().split())]
             for name, read in pages.items() for target, title, text in read.entries]
    made["search.js"] = f"const INDEX = {json.dumps(index)};{SEARCH}"
    for name, text in made.items():
        (folder / name).write_text(text, encoding="utf-8")
    with_pictures = "--without-pictures" not in flags
    if with_pictures:
        paint_pictures(source, program, folder / "pictures")
    dead = list(dead_links(folder, pages, with_pictures))
    sys.exit("\n".join(dead) if dead else 0)


main(*sys.argv[1:])
