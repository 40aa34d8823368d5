#!/usr/bin/env python3
"""Paints the drawing that is open in Inkscape with fluidy-svg.

Inkscape runs `fluidy_paint.py --NAME=VALUE... FILE.svg` and takes what is printed as the new document.
The painting comes back as a layer of images above the drawing, or as a folder of frames. Nothing but
Python's own modules and the fluidy-svg program is needed.
"""
import argparse
import base64
import glob
import os
import shlex
import subprocess
import sys
import tempfile
from xml.dom import minidom

PAINTED = 'fluidy-painted'  # the id of the layer, which the next run replaces
INKSCAPE = 'http://www.inkscape.org/namespaces/inkscape'
XLINK = 'http://www.w3.org/1999/xlink'
DRAFT_PX = '640'


def arguments(words):
    parser = argparse.ArgumentParser(allow_abbrev=False)
    parser.add_argument('--tab', help='of the dialog; it says nothing')
    parser.add_argument('--style', default='watercolour')
    parser.add_argument('--other_style', default='', help='a name or folder, if style is "other"')
    parser.add_argument('--frames', choices=['drawing', 'layers'], default='drawing')
    parser.add_argument('--range', default='', help='frames to paint, as for --frames')
    parser.add_argument('--detail', choices=['draft', 'normal', 'fine', 'finest'], default='draft')
    parser.add_argument('--result', choices=['layer', 'folder'], default='layer')
    parser.add_argument('--folder', default='', help='for the frames')
    parser.add_argument('--options', default='', help='more options of fluidy-svg')
    parser.add_argument('--program', default='fluidy-svg')
    parser.add_argument('--id', action='append', help='what is selected, which Inkscape tells')
    parser.add_argument('--selected-nodes', action='append', help='likewise')
    parser.add_argument('file')
    return parser.parse_args(words)


def fail(message):
    """Inkscape shows what is written here, and leaves the document alone."""
    sys.exit(message.strip())


def remove_painted(document):
    for group in document.getElementsByTagName('g'):
        if group.getAttribute('id') == PAINTED:
            group.parentNode.removeChild(group)


def command(choice, drawing, output):
    style = choice.other_style if choice.style == 'other' else choice.style
    words = [choice.program, drawing, '--style', style, '--detail', choice.detail, '--output', output,
             '--progress', 'none', '--overwrite']
    words += ['--frames-from', 'layers' if choice.frames == 'layers' else 'files']
    if choice.range:
        words += ['--frames', choice.range]
    if choice.detail == 'draft':
        words += ['--width', DRAFT_PX]
    return words + shlex.split(choice.options)


def run(words):
    """Paints. Returns what the program said: notes and warnings."""
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    except OSError as problem:
        fail(f'{words[0]}: {problem.strerror}. Install fluidy-svg, or name the program in the last tab.')
    if done.returncode != 0:
        fail(done.stderr or f'{words[0]} ended with status {done.returncode}')
    return done.stderr


def page(root):
    """x, y, width and height of the page in the document's own units."""
    box = root.getAttribute('viewBox').replace(',', ' ').split()
    if len(box) == 4:
        return box
    sides = [root.getAttribute(side) or '100%' for side in ('width', 'height')]
    return ['0', '0', *sides]


def new_layer(document, parent, label, shown):
    layer = document.createElement('g')
    layer.setAttribute('inkscape:groupmode', 'layer')
    layer.setAttribute('inkscape:label', label)
    layer.setAttribute('style', 'display:inline' if shown else 'display:none')
    parent.appendChild(layer)
    return layer


def add_image(document, layer, path, place):
    with open(path, 'rb') as file:
        data = base64.b64encode(file.read()).decode('ascii')
    image = document.createElement('image')
    for name, value in zip(('x', 'y', 'width', 'height'), place):
        image.setAttribute(name, value)
    image.setAttribute('preserveAspectRatio', 'none')
    image.setAttribute('xlink:href', 'data:image/png;base64,' + data)
    layer.appendChild(image)


def add_painting(document, style, frames):
    """A layer above the drawing, with one inside for each frame if there are several."""
    root = document.documentElement
    root.setAttribute('xmlns:inkscape', INKSCAPE)
    root.setAttribute('xmlns:xlink', XLINK)
    layer = new_layer(document, root, f'painted: {style} (static)', True)
    layer.setAttribute('id', PAINTED)
    for n, path in enumerate(frames):
        name = os.path.splitext(os.path.basename(path))[0]
        inside = layer if len(frames) == 1 else new_layer(document, layer, name, n == 0)
        add_image(document, inside, path, page(root))


def main(words):
    choice = arguments(words)
    document = minidom.parse(choice.file)
    remove_painted(document)
    if choice.result == 'folder' and not choice.folder:
        fail('Choose a folder for the frames.')
    with tempfile.TemporaryDirectory(prefix='fluidy-') as scratch:
        drawing = os.path.join(scratch, 'drawing.svg')
        with open(drawing, 'w', encoding='utf-8') as file:
            document.writexml(file, encoding='utf-8')
        folder = choice.folder if choice.result == 'folder' else os.path.join(scratch, 'painted')
        said = run(command(choice, drawing, os.path.join(folder.replace('%', '%%'), 'painted_%04d.png')))
        frames = sorted(glob.glob(os.path.join(glob.escape(folder), 'painted_*.png')))
        if choice.result == 'layer':
            add_painting(document, choice.other_style or choice.style, frames)
    sys.stdout.write(document.documentElement.toxml())
    warnings = [line for line in said.splitlines() if 'warning:' in line]
    sys.stderr.write('\n'.join(warnings))


if __name__ == '__main__':
    main(sys.argv[1:])
