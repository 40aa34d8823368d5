#!/usr/bin/env python3
"""Saves a look, paints by it elsewhere, and tries looks that a stranger may have made.

usage: looks.py FLUIDY-SVG FIXTURES; speaks TAP."""

import io
import os
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile

program, fixtures = (os.path.abspath(path) for path in sys.argv[1:3])
folder = tempfile.mkdtemp(prefix="fluidy-test-")
os.chdir(folder)
os.environ["XDG_CACHE_HOME"] = os.path.join(folder, "cache")
os.environ["FLUIDY_CACHE"] = "off"
n_tests = 0


def report(name, good, why=""):
    global n_tests
    n_tests += 1
    print(("ok" if good else "not ok"), n_tests, "-", name)
    if not good:
        print("# " + why.replace("\n", "\n# "))


def run(*arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def paint(name, *arguments):
    code, text = run("d_1.svg", "-W", "48", "-q", "-y", "-o", name + ".png", *arguments)
    return code == 0, text


def pixels(name):
    """The bytes of a picture without its text chunks, which say how it was made."""
    data, at, kept = open(name + ".png", "rb").read(), 8, b""
    while at < len(data):
        length = int.from_bytes(data[at:at + 4], "big")
        if data[at + 4:at + 8] in (b"IHDR", b"IDAT"):
            kept += data[at + 8:at + 8 + length]
        at += length + 12
    return kept


def look_of(files):
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w") as archive:
        for name, text in files:
            archive.writestr(name, text)
    return memory.getvalue()


def refused(name, files, words, *more):
    data = files if isinstance(files, bytes) else look_of(files)
    with open("bad.fluidy", "wb") as file:
        file.write(data)
    code, text = run("d_1.svg", "-W", "48", "-o", "never.png", "--look", "bad.fluidy", *more)
    left = [os.path.join(path, file) for path, _, found in os.walk(folder) for file in found
            if file in ("evil", "never.png")]
    kept = os.path.join(folder, "cache", "fluidy-svg", "looks")
    parts = [file for file in os.listdir(kept) if "." in file] if os.path.isdir(kept) else []
    report(name, code not in (0, -6, -11) and words in text and text.count("\n") == 1 and
           not left and not parts and not os.path.exists("/tmp/evil"), text + str(left + parts))


with open("d_1.svg", "w", encoding="utf-8") as drawing:
    drawing.write('<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">'
                  '<g id="hat"><circle cx="50" cy="30" r="22" fill="#335588"/></g>'
                  '<g id="coat"><path d="M10 55h80v40h-80z" fill="#aa5533"/></g></svg>')
os.makedirs("own/deep")
shutil.copytree(os.path.join(fixtures, "style-small"), "own/deep/small")
with open("own/show.conf", "w", encoding="utf-8") as config:
    config.write("[project]\nversion = 1\npaper = kraft\nseed = 3\noutput = elsewhere_%04d.png\n"
                 "[defaults]\nstyle = deep/small\ngranulation = 0.2\ncarry = 1@1 0@9\n"
                 "[region hat]\nmatch-id = hat; cap\nmatch-tolerance = 2.5\nwash = 0.5\n"
                 "[region c*]\nstyle = deep/small@1\n")
with open("shot.conf", "w", encoding="utf-8") as config:
    config.write("[project]\nversion = 1\ninclude = own/show.conf\n[region hat]\nwash = 0.7\n")

wanted, text = paint("wanted", "-c", "shot.conf", "--stain", "0.4")
saved, more = run("d_1.svg", "-c", "shot.conf", "--stain", "0.4", "--save-look", "my.fluidy")
with zipfile.ZipFile("my.fluidy") as archive:
    names, conf = archive.namelist(), archive.read("look.conf").decode()
    thumbnail = archive.read("thumbnail.png")[:8]
report("a look has a config, a style and a thumbnail", wanted and saved == 0 and
       thumbnail == b"\x89PNG\r\n\x1a\n" and "styles/1-small/style.ini" in names and
       "saved the look: my.fluidy" in more and "painted" not in more, text + more)
report("a look says how to paint, and not where", "wash = 0.7" in conf and "stain = 0.4" in conf and
       "wash = 0.5" not in conf and "output" not in conf and "include" not in conf, conf)
shutil.rmtree("own")
os.remove("shot.conf")
good, text = paint("by_look", "--look", "my.fluidy")
report("a look paints the same without the files it was made from",
       good and pixels("wanted") == pixels("by_look"), text)
shutil.copy("my.fluidy", "MY.FLUIDY")
good, text = paint("upper", "--look", "MY.FLUIDY")
report("the end of a look's name may be in capitals",
       good and pixels("wanted") == pixels("upper"), text)
good, text = paint("other", "--look", "my.fluidy", "--tint", "#00ff00")
report("options override a look", good and pixels("other") != pixels("wanted"), text)
with open("over.conf", "w", encoding="utf-8") as config:
    config.write("[project]\nversion = 1\n[defaults]\nstain = 0\nwash = 0\n[region hat]\nwash = 0\n")
good, text = paint("over", "-c", "over.conf", "--look", "my.fluidy")
report("configs override a look, before it or after it", good and pixels("over") != pixels("wanted"),
       text)
code, text = run("d_1.svg", "-s", "01", "--save-look", "my.fluidy")
report("a look is replaced on request only", code != 0 and "already exists" in text, text)

code, text = run("d_1.svg", "-s", "01", "--save-look", "dry.fluidy", "--dry-run")
report("a dry run saves no look", code == 0 and not os.path.exists("dry.fluidy") and
       "CRITICAL" not in text, text)

conf = "[project]\nversion = 1\n[defaults]\nstyle = 01\n"
refused("a file that is no archive", b"no archive", "is no look")
refused("an archive that ends too early", open("my.fluidy", "rb").read()[:2000], "is no look")
refused("an archive without a config", [("files/a", "")], "it has no look.conf")
for bad in ("../evil", "/tmp/evil", "styles/../../evil", "styles\\evil", "evil", "styles//evil",
            "files/.evil", "files/\x1bevil", "files/" + "e" * 300, "C:/evil", "files/C:evil", "files/evil?"):
    refused("a file named " + ascii(bad)[:30], [("look.conf", conf), (bad, "x")], "does not belong to a look")
link = zipfile.ZipInfo("files/evil")
link.external_attr = 0o120777 << 16
refused("a file that is there twice", [("look.conf", conf), ("files/a", "1"), ("files/a", "2")],
        "is there twice")
refused("too many files", [("look.conf", conf)] + [(f"files/{k}", "") for k in range(4100)],
        "expected at most 4096")
refused("more than the limit", [("look.conf", conf), ("files/a", bytes(3 << 20))],
        "--limit look=", "--limit", "look=2")
packed = io.BytesIO()
with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
    archive.writestr("look.conf", conf)
    archive.writestr("files/a", bytes(9 << 20))
refused("little that unpacks to much", packed.getvalue(), "--limit look=", "--limit", "look=2")
damaged = bytearray(packed.getvalue())
damaged[300:360] = b"\xff" * 60
refused("damaged bytes", bytes(damaged), "is damaged")
for line, words in (("paper = /etc/passwd", "outside of the look"),
                    ("background = files/../../x.png", "outside of the look"),
                    ("directions = ~/x.png", "outside of the look"),
                    ("include = /etc/passwd", "expected no such key"),
                    ("output = evil", "expected no such key")):
    refused("a config with " + line, [("look.conf", "[project]\nversion = 1\n" + line + "\n")], words)
for line in ("style = /tmp/x", "style = 01@1 ../x@9", "style = 01@1\f/tmp/x@9",
             "style = 01@1\u2003/tmp/x@9", "map-front = /tmp/x.png"):
    refused("a config with " + ascii(line), [("look.conf", conf.replace("style = 01", line))],
            "outside of the look")
small = os.path.join(fixtures, "style-small")
refused("a style that names a map", [("look.conf", conf.replace("01", "styles/1-s"))] +
        [("styles/1-s/" + name, open(os.path.join(small, name), "rb").read())
         for name in sorted(f"frames/{k}" for k in os.listdir(os.path.join(small, "frames")))] +
        [("styles/1-s/style.ini", "[region]\nmap-front = /etc/passwd\n")],
        "style.ini:2: map-front: a style does not say that")
refused("a config that is wrong", [("look.conf", conf + "stile = 3\n")], "bad.fluidy:5: ")

with open("linked.fluidy", "wb") as file:
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w") as archive:
        archive.writestr("look.conf", conf)
        archive.writestr(link, "/etc/passwd")
    file.write(memory.getvalue())
for part, days in ("aa.killed", 2), ("bb.atwork", 0):
    os.makedirs(os.path.join("cache/fluidy-svg/looks", part, "files"))
    os.utime(os.path.join("cache/fluidy-svg/looks", part), (time.time() - 86400 * days,) * 2)
good, text = paint("linked", "--look", "linked.fluidy")
links = [file for path, _, found in os.walk("cache") for file in found
         if os.path.islink(os.path.join(path, file))]
report("a link in a look is unpacked as a file", good and not links, text + str(links))
parts = [name for name in os.listdir("cache/fluidy-svg/looks") if "." in name]
report("what is left of a look whose unpacking was killed goes after a day", parts == ["bb.atwork"], str(parts))
print(f"1..{n_tests}")
shutil.rmtree(folder)
