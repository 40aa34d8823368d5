#!/usr/bin/env python3
"""The Python package, and the example of its manual. usage: python.py SOURCE STYLE HEADERS MANUAL; speaks TAP."""
import os, re, struct, sys, tempfile, warnings, zlib
source, style, headers, manual = map(os.path.abspath, sys.argv[1:])
sys.path.insert(0, source)
import fluidy
import numpy
from fluidy._library import DECLARATIONS

count = 0


def tell(sentence, good):
    global count
    count += 1
    print(("ok" if good else "not ok"), count, "-", sentence, flush=True)


def raises(kind, words, call):
    """True if the call raises such an exception with these words."""
    try:
        call()
    except kind as error:
        return words in str(error)
    return False


def declarations(text):
    """Of a header or a cdef, without comments and spaces."""
    text = re.sub(r"/\*.*?\*/|\bFL_API\b", "", text, flags=re.S)
    return re.sub(r"\s+", "", text)


known = declarations("".join(open(f"{headers}/{name}").read() for name in os.listdir(headers) if name.endswith(".h")))
ours = DECLARATIONS.split("\n\n", 1)[1]  # without GLib's
parts = [declarations(part) for part in re.findall(r"typedef struct \w+ \{.*?\} \w+;|^\w[^\n{}]*;", ours, re.S | re.M)]
unlike = [part for part in parts if part.replace("uint32_tfl_error", "GQuarkfl_error") not in known]
tell("declarations are those of the headers", len(parts) > 20 and not unlike)
if unlike:
    print("#", unlike)

folder = tempfile.TemporaryDirectory()
os.chdir(folder.name)
for k in range(1, 6):
    with open(f"walk_{k:04d}.svg", "w") as file:
        file.write(f"<svg xmlns='http://www.w3.org/2000/svg' width='64' height='48'><circle id='ball' cx='{15 + 3 * k}' "
                   f"cy='20' r='12' fill='#aa3311'/><rect id='box' x='36' y='22' width='20' height='20' fill='#225588'/></svg>")
stages = []
film = fluidy.Film("walk_%04d.svg", style=style, paper="none", progress=lambda told: stages.append(told.stage))
frames = list(film)
tell("a film is a sequence of frames", len(film) == 5 and film.shape == (5, 48, 64, 4) and len(frames) == 5)
tell("of bytes", frames[2].shape == (48, 64, 4) and frames[2].dtype == numpy.uint8 and frames[2].number == 3)
tell("in any order", (film[-3] == frames[2]).all() and film[-3].number == 3)
tell("it tells its progress", "paint" in stages or "guides" in stages)
tell("it has regions", [region.style is not None for region in film.regions] == [True, True] and
     {region.paint for region in film.regions} == {"#aa3311", "#225588"})
painted = film.n_painted
film["tint"] = "#11aa55"
tell("another tint changes frames", (film[2] != frames[2]).any())
tell("and paints nothing", film.n_painted == painted)
film["tint"] = None
tell("the default comes back", (film[2] == frames[2]).all())
film.set("tint", "#11aa55", region=film.regions[0].name)
tell("a region has a tint of its own", (film[2] != frames[2]).any())
film.set("tint", None, region=film.regions[0].name)
layers = film.layers(2)
tell("each region has a layer", len(layers) == 2 and all(0 < layer[..., 3].mean() < 128 for layer in layers.values()))
tell("and then all are there again", (film[2] == frames[2]).all())
film["region"] = film.regions[1].name
tell("or the region that was chosen before", len(film.layers(2)) == 1 and (film[2] != frames[2]).any())
film["region"] = None
film["loop"] = False
tell("False is off", raises(fluidy.UsageError, "“off”", lambda: film.set("tint", False)))
tell("a draft is small", max(film.draft(1, 20).shape[:2]) <= 20 and film.drawing(1).shape[2] == 4 and film.map(1).any())
png = frames[0]._repr_png_()
size, data = struct.unpack(">II", png[16:24]), zlib.decompress(png[41:-16])
tell("a notebook shows a picture", size == (64, 48) and data[1:257] == frames[0][0].tobytes())
tell("and a film, but no part of a picture", film._repr_png_()[:4] == b"\x89PNG" and frames[0][..., 0]._repr_png_() is None)

tell("a wrong value is refused with its words", raises(fluidy.UsageError, "tint", lambda: film.set("tint", "blu")))
tell("so is an unknown option", raises(ValueError, "no option", lambda: fluidy.Film("x", tnit="fill")))
tell("a frame that is not there is an IndexError", raises(IndexError, "", lambda: film[5]))
tell("input that is not there is told", raises(fluidy.InputError, "nowhere", lambda: len(fluidy.Film("nowhere"))))
tell("a style as well", raises(fluidy.StyleError, "", lambda: fluidy.Film("walk_%04d.svg", style="/none")[0]))


def stop(told):
    raise KeyError("enough")


tell("an exception of the progress arrives", raises(KeyError, "enough", lambda: fluidy.Film("walk_%04d.svg", style=style, progress=stop)[0]))
tell("False stops", raises(fluidy.InterruptedError, "", lambda: fluidy.Film("walk_%04d.svg", style=style, progress=lambda told: False)[0]))
with open("odd.svg", "w") as file:
    file.write("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><image href='none.png' width='9' height='9'/></svg>")
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    fluidy.Film("odd.svg", style=style)[0]
tell("warnings are Python's", any("none.png" in str(warning.message) for warning in told))
with warnings.catch_warnings():
    warnings.simplefilter("error")
    tell("and may be errors", raises(UserWarning, "none.png", lambda: fluidy.Film("odd.svg", style=style)[0]))

with open("film.conf", "w") as file:
    file.write(f"[defaults]\nstyle = {style}\ntint = #11aa55\n")
film["tint"] = "#11aa55"
tell("a config is taken", (fluidy.Film(["walk_%04d.svg"], config="film.conf", paper="none")[2] == film[2]).all())
film["output"] = "out_%d.png"
film.render()
tell("files are written", os.path.getsize("out_5.png") > 100)

masks = numpy.zeros((3, 40, 50), numpy.uint8)
for k in range(3):
    masks[k, 10:30, 8 + 3 * k:28 + 3 * k] = 255
cut = fluidy.paint(masks, style, tint=None)
tell("masks are painted", len(cut) == 3 and (cut[1][..., 3] > 128).sum() > 300 and cut[1][0, 0, 3] == 0)
flow = numpy.zeros((3, 40, 50, 2), numpy.float32)
flow[..., 0] = 3
tell("with their motion", (fluidy.paint(masks, style, flow=flow, seed=2, tint="#112233")[2] != cut[2]).any())
tell("of the same size", raises(fluidy.UsageError, "flow", lambda: fluidy.paint(masks, style, flow=flow[:2])))

example = re.search(r"\.Bd.*?\n(.*?)\.Ed", open(manual).read(), re.S)[1].replace('style="01"', f"style={style!r}").replace("240", "64")
out = os.dup(1)
os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
sys.stdout.flush()
try:
    exec(example, {})
    works = os.path.getsize("frame.png") > 100
finally:
    sys.stdout.flush()
    os.dup2(out, 1)
tell("the example of fluidy-python(7) works", works)
print(f"1..{count}")
