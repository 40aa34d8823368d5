"""Composes the layers of OpenRaster files as Krita does, with nothing but Python's own modules.

usage: ora.py FILE.ora...; prints the largest difference from the picture that a file says they make.
       ora.py FILE.png; whether its colours are straight: some are lighter than their alpha.
"""
import struct
import sys
import xml.etree.ElementTree as xml
import zipfile
import zlib


def read_png(data):
    """Returns width, height and rows of RGBA bytes of an 8-bit file with filters 0 and 3."""
    at, stream = 8, b''
    while at < len(data):
        length, = struct.unpack('>I', data[at:at + 4])
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b'IHDR':
            width, height, depth, colours = struct.unpack('>IIBB', body[:10])
        if kind == b'IDAT':
            stream += body
    assert depth == 8 and b'sRGB' in data[:80]
    n = {2: 3, 6: 4}[colours]
    raw, rows, above = zlib.decompress(stream), [], bytearray(width * n)
    for y in range(height):
        start = y * (width * n + 1)
        row = bytearray(raw[start + 1:start + 1 + width * n])
        if raw[start] == 3:
            for i in range(width * n):
                row[i] = row[i] + ((row[i - n] if i >= n else 0) + above[i]) // 2 & 255
        above = row
        rows.append(row if n == 4 else bytes(v for x in range(width) for v in (*row[3 * x:3 * x + 3], 255)))
    return width, height, rows


def blend(mode, below, above):
    if mode == 'svg:multiply':
        return below * above
    if mode == 'svg:color-dodge':
        return min(1, below / (1 - above)) if above < 1 else 1
    assert mode == 'svg:src-over', mode
    return above


def put(canvas, mode, x0, y0, layer):
    """Straight alpha, as the compositing specification has it."""
    for y, row in enumerate(layer[2]):
        for x in range(layer[0]):
            a = row[4 * x + 3] / 255
            if a == 0:
                continue
            below = canvas[y0 + y][x0 + x]
            b = below[3]
            whole = a + b - a * b
            for c in range(3):
                s = row[4 * x + c] / 255
                mixed = (1 - b) * s + b * blend(mode, below[c], s)
                below[c] = (a * mixed + (1 - a) * b * below[c]) / whole
            below[3] = whole


def difference(path):
    with zipfile.ZipFile(path) as file:
        image = xml.fromstring(file.read('stack.xml'))
        width, height, merged = read_png(file.read('mergedimage.png'))
        canvas = [[[0, 0, 0, 0] for _ in range(width)] for _ in range(height)]
        for layer in reversed(image.findall('stack/layer')):
            put(canvas, layer.get('composite-op'), int(layer.get('x')), int(layer.get('y')),
                read_png(file.read(layer.get('src'))))
    return max(abs(255 * canvas[y][x][c] * canvas[y][x][3] - merged[y][4 * x + c] * merged[y][4 * x + 3] / 255)
               for y in range(height) for x in range(width) for c in range(3))


if sys.argv[1].endswith('.png'):
    with open(sys.argv[1], 'rb') as picture:
        pixels = [row[i:i + 4] for row in read_png(picture.read())[2] for i in range(0, len(row), 4)]
    sys.exit(not any(max(pixel[:3]) > pixel[3] > 0 for pixel in pixels))
print(round(max(map(difference, sys.argv[1:])), 1))
